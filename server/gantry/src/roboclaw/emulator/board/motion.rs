//! Commands that move motors: from the values of a packet to what the channels are told.

use super::answers::FULL_DUTY;
use super::{Answer, Board};
use crate::roboclaw::emulator::channel::{Goal, Stage};
use crate::roboclaw::emulator::commands::Values;

impl Board {
    pub(super) fn move_motors(&mut self, command: u8, values: &mut Values<'_>) -> Answer {
        match command {
            0..=7 => self.drive_compatibly(command, values.byte()),
            32..=34 | 52..=54 => self.drive_duty(command, values),
            35..=40 | 50 => self.drive_speed(command, values),
            _ => return self.drive_buffered(command, values),
        }
        Answer::Acknowledged
    }

    /// 0 to 127 forward or backward, or both ways about 64.
    fn drive_compatibly(&mut self, command: u8, value: u8) {
        let value = f64::from(value.min(127));
        let (channel, target) = match command {
            0 => (0, value / 127.0),
            1 => (0, -value / 127.0),
            4 => (1, value / 127.0),
            5 => (1, -value / 127.0),
            command => (usize::from(command - 6), ((value - 64.0) / 63.0).max(-1.0)),
        };
        self.drive_at(channel, target, self.settings.duty_acceleration[channel]);
    }

    fn drive_duty(&mut self, command: u8, values: &mut Values<'_>) {
        let brings_acceleration = command >= 52;
        for channel in channels(command, if brings_acceleration { 52 } else { 32 }) {
            let target = f64::from(values.signed_word()) / FULL_DUTY;
            let default = self.settings.duty_acceleration[*channel];
            let acceleration = if brings_acceleration { values.long() } else { default };
            self.drive_at(*channel, target.max(-1.0), acceleration);
        }
    }

    fn drive_at(&mut self, channel: usize, target: f64, acceleration: u32) {
        self.channels[channel].drive(Goal::Duty { target, slope: f64::from(acceleration) / FULL_DUTY });
    }

    fn drive_speed(&mut self, command: u8, values: &mut Values<'_>) {
        match command {
            35..=37 => {
                for channel in channels(command, 35) {
                    let cps = f64::from(values.signed_long());
                    self.channels[*channel].drive(Goal::Speed { cps, slope: f64::INFINITY });
                }
            }
            38..=40 => {
                // One acceleration for both.
                let slope = f64::from(values.long());
                for channel in channels(command, 38) {
                    let cps = f64::from(values.signed_long());
                    self.channels[*channel].drive(Goal::Speed { cps, slope });
                }
            }
            _ => {
                for channel in &mut self.channels {
                    let slope = f64::from(values.long());
                    let cps = f64::from(values.signed_long());
                    channel.drive(Goal::Speed { cps, slope });
                }
            }
        }
    }

    /// All of it is buffered or, when one buffer is full, none (*unverified*: then it is not acknowledged).
    fn drive_buffered(&mut self, command: u8, values: &mut Values<'_>) -> Answer {
        let distance = |slope: f64, values: &mut Values<'_>| {
            let cps = f64::from(values.signed_long());
            Stage::Distance { cps, slope, counts: f64::from(values.long()) }
        };
        let mut stages = Vec::new();
        match command {
            41..=43 => {
                for channel in channels(command, 41) {
                    stages.push((*channel, distance(f64::INFINITY, values)));
                }
            }
            44..=46 => {
                let slope = f64::from(values.long());
                for channel in channels(command, 44) {
                    stages.push((*channel, distance(slope, values)));
                }
            }
            51 => {
                for channel in 0..2 {
                    let slope = f64::from(values.long());
                    stages.push((channel, distance(slope, values)));
                }
            }
            65..=67 => {
                for channel in channels(command, 65) {
                    let acceleration = f64::from(values.long());
                    let cps = f64::from(values.signed_long());
                    let deceleration = f64::from(values.long());
                    let register = values.signed_long();
                    stages.push((*channel, Stage::Position { acceleration, cps, deceleration, register }));
                }
            }
            _ => return Answer::None,
        }
        let replace = values.byte() == 1;
        let mut channels = self.channels.clone();
        if stages.iter().all(|(channel, stage)| channels[*channel].buffer(*stage, replace)) {
            self.channels = channels;
            Answer::Acknowledged
        } else {
            Answer::None
        }
    }
}

/// Of three commands in a row the first is for M1, the second for M2, the third for both.
const fn channels(command: u8, first: u8) -> &'static [usize] {
    match command - first {
        0 => &[0],
        1 => &[1],
        _ => &[0, 1],
    }
}
