//! A headset on virtual time: every pose goes out as a client would write it, and is read as the server would read it.

use covr_engine::frames::{Pose, RigidMap, Room};
use covr_engine::observation::{Hands, PoseSample};
use covr_engine::time::Time;
use covr_wire::client::{Convention, Encoding, Frame, FromClient, HeadPose, decode};
use covr_wire::convention::ClientFrame;

/// One headset.
#[derive(Debug)]
pub(super) struct Headset {
    frame: ClientFrame,
    sequence: u32,
}

impl Headset {
    /// OpenXR, its tracking frame on the room's corner.
    pub fn new() -> Self {
        let room_from_tracking = RigidMap::from_yaw(0.0, [0.0; 3].into());
        Self { frame: ClientFrame::new(Convention::Openxr, room_from_tracking), sequence: 0 }
    }

    /// The pose as it arrives in the engine, with the hands: through the message and back.
    pub fn seen(&mut self, taken_at: Time, pose: &Pose<Room>, hands: &Hands) -> PoseSample {
        let (position, orientation) = self.frame.client_pose(pose);
        self.sequence = self.sequence.wrapping_add(1);
        let said = FromClient::Pose(HeadPose {
            person: "visitor".into(),
            sequence: self.sequence,
            client_time_micros: taken_at.micros(),
            position,
            orientation,
            tracked: true,
            worn: true,
            hands: self.frame.client_hands(hands),
        });
        match heard(&said) {
            Some(FromClient::Pose(pose)) => PoseSample {
                taken_at,
                pose: self.frame.room_pose(pose.position, pose.orientation),
                tracked: pose.tracked,
                worn: pose.worn,
                hands: self.frame.room_hands(pose.hands),
            },
            // A pose that the protocol would refuse is one that the server never saw: not tracked.
            _ => PoseSample { taken_at, pose: *pose, tracked: false, worn: true, hands: Hands::UNKNOWN },
        }
    }
}

fn heard(said: &FromClient) -> Option<FromClient> {
    match Encoding::Json.encode(said).ok()? {
        Frame::Text(text) => decode(Encoding::Json, text.as_bytes()).ok(),
        Frame::Binary(bytes) => decode(Encoding::MessagePack, &bytes).ok(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use covr_engine::frames::Point;

    #[test]
    fn a_pose_arrives_where_it_was_taken() {
        let pose = Pose {
            position: Point::new(1.0, 2.0, 1.6),
            orientation: nalgebra::UnitQuaternion::from_euler_angles(0.1, 0.2, 0.7),
        };
        let hands = Hands { left: None, right: Some(Point::new(1.3, 2.2, 1.1)) };
        let seen = Headset::new().seen(Time::ZERO, &pose, &hands);
        assert!(seen.tracked && seen.hands.left.is_none());
        assert!(seen.hands.right.unwrap().distance_m(&hands.right.unwrap()) < 1e-9);
        assert!(seen.pose.position.distance_m(&pose.position) < 1e-9);
        assert!((seen.pose.view() - pose.view()).norm() < 1e-9);
    }
}
