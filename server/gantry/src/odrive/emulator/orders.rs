//! What goes wrong, as orders of one line each, from the command line or while it runs: [`ORDERS`].

use std::str::FromStr;

use covr_engine::time::Span;

use super::firmware::{FIRMWARE_NAMES, Firmware};
use crate::emulation::words::{Words, Wrong};
use crate::sim::faults::Direction;

pub use crate::emulation::Axis;
pub use crate::emulation::words::BadOrder;

/// Every order, with its meaning, for people.
pub const ORDERS: &str = "\
lose P               a byte is lost on the line, either way, with probability P
flip P               a bit of a byte is flipped, with probability P
late P MS            an answer comes MS milliseconds late, with probability P
missing P            a line is obeyed and not answered, with probability P
gap P MS             an answer pauses for MS milliseconds in its middle, with probability P
brown-out MS         the board is without power for MS milliseconds, and starts anew with what it has saved
error AXIS NAME      an axis has an error, and lets its motor go: encoder, controller, motor or estop
slip AXIS SHARE      the encoder of x or y misses this share of the motion
jam AXIS on|off      the carriage is jammed
runaway AXIS WAY     the bridge is stuck: full supply `positive` or `negative` unless it is open; `off` ends it
push AXIS NEWTONS    somebody leans on the column
supply VOLTS         the supply is at so many volts
temperature DEGREES  the bridges are so hot
firmware NAME        the board starts anew with another firmware
after SECONDS ORDER  that order, later
";

/// One order.
#[derive(Debug, Clone, PartialEq)]
pub enum Order {
    /// Bytes are lost.
    Lose(f64),
    /// Bits are flipped.
    Flip(f64),
    /// Answers come late.
    Late(f64, Span),
    /// Answers are missing.
    Missing(f64),
    /// Answers have gaps.
    Gap(f64, Span),
    /// No power for so long.
    BrownOut(Span),
    /// These bits of an axis's error, once.
    Error(Axis, u32),
    /// An encoder misses a share of the motion.
    Slip(Axis, f64),
    /// A carriage is jammed, or not.
    Jam(Axis, bool),
    /// A bridge is stuck.
    Runaway(Axis, Option<Direction>),
    /// A force on the column, N.
    Push(Axis, f64),
    /// The supply, V.
    Supply(f64),
    /// The bridges' temperature, degrees Celsius.
    Temperature(f64),
    /// Another firmware.
    Firmware(Firmware),
    /// An order for later.
    After(Span, Box<Self>),
}

impl FromStr for Order {
    type Err = BadOrder;

    fn from_str(line: &str) -> Result<Self, BadOrder> {
        BadOrder::unless(line, order)
    }
}

fn order(words: &mut Words<'_>) -> Result<Order, Wrong> {
    Ok(match words.next().as_deref() {
        Some("lose") => Order::Lose(words.probability()?),
        Some("flip") => Order::Flip(words.probability()?),
        Some("late") => Order::Late(words.probability()?, words.millis()?),
        Some("missing") => Order::Missing(words.probability()?),
        Some("gap") => Order::Gap(words.probability()?, words.millis()?),
        Some("brown-out") => Order::BrownOut(words.millis()?),
        Some("error") => {
            let errors = [("encoder", 0x100), ("controller", 0x200), ("motor", 0x40), ("estop", 0x4000)];
            Order::Error(words.axis()?, words.one_of(&errors, "encoder, controller, motor or estop")?)
        }
        Some("slip") => Order::Slip(words.axis()?, words.number(0.0, 1.0, "a share from 0 to 1")?),
        Some("jam") => Order::Jam(words.axis()?, words.one_of(&[("on", true), ("off", false)], "on or off")?),
        Some("runaway") => {
            let (up, down) = (Some(Direction::Positive), Some(Direction::Negative));
            let ways = [("positive", up), ("negative", down), ("off", None)];
            Order::Runaway(words.axis()?, words.one_of(&ways, "positive, negative or off")?)
        }
        Some("push") => Order::Push(words.axis()?, words.number(-5e3, 5e3, "newtons from -5000 to 5000")?),
        Some("supply") => Order::Supply(words.number(0.0, 70.0, "volts from 0 to 70")?),
        Some("temperature") => Order::Temperature(words.number(0.0, 200.0, "degrees from 0 to 200")?),
        Some("firmware") => {
            let name = words.next();
            let firmware = name.as_ref().and_then(|name| name.parse().ok());
            Order::Firmware(firmware.ok_or((name, FIRMWARE_NAMES))?)
        }
        Some("after") => {
            let span = Span::from_secs(words.number(0.0, 86_400.0, "seconds from 0 to 86400")?);
            Order::After(span, Box::new(order(words)?))
        }
        found => return Err((found.map(str::to_owned), ORDER_NAMES)),
    })
}

const ORDER_NAMES: &str = "lose, flip, late, missing, gap, brown-out, error, slip, jam, runaway, push, supply, temperature, \
                           firmware or after";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_help_names_every_order_and_no_other() {
        let mut named: Vec<_> = ORDERS.lines().filter_map(|line| line.split(' ').next()).collect();
        let mut known: Vec<_> =
            ORDER_NAMES.split([',', ' ']).filter(|word| !["", "or"].contains(word)).collect();
        named.sort_unstable();
        known.sort_unstable();
        assert_eq!(named, known);
    }

    #[test]
    fn orders_are_understood_and_what_is_none_is_refused_by_name() {
        assert_eq!("error y encoder".parse(), Ok(Order::Error(Axis::Y, 0x100)));
        assert_eq!("firmware 0.5.4".parse(), Ok(Order::Firmware("0.5.4".parse().unwrap())));
        for (line, expected) in
            [("press", "lose, flip"), ("error x", "encoder, controller"), ("firmware 3", "0.5.1, 0.5.4")]
        {
            let refused = line.parse::<Order>().unwrap_err().to_string();
            assert!(refused.contains(expected), "{refused}");
        }
    }
}
