//! What goes wrong, as orders of one line each, from the command line or while it runs: [`ORDERS`].

use std::str::FromStr;

use covr_engine::time::Span;

use super::firmware::Firmware;
use crate::emulation::words::{Words, Wrong};
use crate::sim::faults::Direction;

pub use crate::emulation::Axis;
pub use crate::emulation::words::BadOrder;

/// Every order, with its meaning, for people.
pub const ORDERS: &str = "\
lose P               a byte is lost on the line, either way, with probability P
flip P               a bit of a byte is flipped, with probability P
late P MS            a reply comes MS milliseconds late, with probability P
missing P            a command is done and not answered, with probability P
gap P MS             a reply pauses for MS milliseconds in its middle, with probability P
brown-out MS         the boards are without power for MS milliseconds, and start anew
press, release       the e-stop button on S3
stick LEVEL          the e-stop pin is stuck at `pressed` or `released`, whatever the button does; `off` ends it
switch AXIS LEVEL    the end switch of x or y is stuck at `active` or `inactive`; `off` ends it
slip AXIS SHARE      the encoder of x or y misses this share of the motion
jam AXIS on|off      the carriage is jammed
runaway AXIS WAY     the bridge is stuck: full supply `positive` or `negative` unless it is open; `off` ends it
push AXIS NEWTONS    somebody leans on the column
supply VOLTS         the supply is at so many volts
temperature DEGREES  the boards are so hot
firmware NAME        the boards start anew with another firmware and its factory settings
after SECONDS ORDER  that order, later
";

/// One order.
#[derive(Debug, Clone, PartialEq)]
pub enum Order {
    /// Bytes are lost.
    Lose(f64),
    /// Bits are flipped.
    Flip(f64),
    /// Replies come late.
    Late(f64, Span),
    /// Replies are missing.
    Missing(f64),
    /// Replies have gaps.
    Gap(f64, Span),
    /// No power for so long.
    BrownOut(Span),
    /// The e-stop button is pressed, or not.
    Press(bool),
    /// The e-stop pin is stuck at active, or not, or follows the button.
    Stick(Option<bool>),
    /// An end switch is stuck at active, or not, or follows the column.
    Switch(Axis, Option<bool>),
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
    /// The boards' temperature, degrees Celsius.
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
        Some("press") => Order::Press(true),
        Some("release") => Order::Press(false),
        Some("stick") => {
            let levels = [("pressed", Some(true)), ("released", Some(false)), ("off", None)];
            Order::Stick(words.one_of(&levels, "pressed, released or off")?)
        }
        Some("switch") => {
            let levels = [("active", Some(true)), ("inactive", Some(false)), ("off", None)];
            Order::Switch(words.axis()?, words.one_of(&levels, "active, inactive or off")?)
        }
        Some("slip") => Order::Slip(words.axis()?, words.number(0.0, 1.0, "a share from 0 to 1")?),
        Some("jam") => Order::Jam(words.axis()?, words.one_of(&[("on", true), ("off", false)], "on or off")?),
        Some("runaway") => {
            let (up, down) = (Some(Direction::Positive), Some(Direction::Negative));
            let ways = [("positive", up), ("negative", down), ("off", None)];
            Order::Runaway(words.axis()?, words.one_of(&ways, "positive, negative or off")?)
        }
        Some("push") => Order::Push(words.axis()?, words.number(-5e3, 5e3, "newtons from -5000 to 5000")?),
        Some("supply") => Order::Supply(words.number(0.0, 60.0, "volts from 0 to 60")?),
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

const ORDER_NAMES: &str = "lose, flip, late, missing, gap, brown-out, press, release, stick, switch, slip, jam, \
                           runaway, push, supply, temperature, firmware or after";
const FIRMWARE_NAMES: &str = "older, newer, 4.1.24, 4.1.34, 4.2.8, 4.3.6 or unknown";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_order_is_understood() {
        let millis = Span::from_millis;
        let [older, _] = ["older", "newer"].map(|name| name.parse().unwrap());
        for (line, order) in [
            ("lose 0.01", Order::Lose(0.01)),
            ("flip 1", Order::Flip(1.0)),
            ("late 0.5 30", Order::Late(0.5, millis(30))),
            ("missing 0.1", Order::Missing(0.1)),
            ("gap 1 12.5", Order::Gap(1.0, Span::from_micros(12_500))),
            (" brown-out  200 ", Order::BrownOut(millis(200))),
            ("press", Order::Press(true)),
            ("release", Order::Press(false)),
            ("stick released", Order::Stick(Some(false))),
            ("stick off", Order::Stick(None)),
            ("switch x inactive", Order::Switch(Axis::X, Some(false))),
            ("slip y 0.02", Order::Slip(Axis::Y, 0.02)),
            ("jam x on", Order::Jam(Axis::X, true)),
            ("runaway x negative", Order::Runaway(Axis::X, Some(Direction::Negative))),
            ("push y -40", Order::Push(Axis::Y, -40.0)),
            ("supply 22", Order::Supply(22.0)),
            ("temperature 90", Order::Temperature(90.0)),
            ("firmware older", Order::Firmware(older)),
            ("after 2.5 press", Order::After(millis(2_500), Box::new(Order::Press(true)))),
        ] {
            assert_eq!(line.parse(), Ok(order), "{line}");
        }
    }

    #[test]
    fn the_help_names_every_order_and_no_other() {
        let named: Vec<_> =
            ORDERS.lines().filter_map(|line| line.split([' ', ',']).next()).chain(["release"]).collect();
        let mut known: Vec<_> =
            ORDER_NAMES.split([',', ' ']).filter(|word| !["", "or"].contains(word)).collect();
        let mut named = named;
        named.sort_unstable();
        known.sort_unstable();
        assert_eq!(named, known);
    }

    #[test]
    fn what_is_no_order_is_refused_by_name() {
        for (line, found, expected) in [
            ("", "nothing more", "lose, flip"),
            ("explode", "\"explode\"", "lose, flip"),
            ("lose", "nothing more", "a probability from 0 to 1"),
            ("lose NaN", "\"NaN\"", "a probability from 0 to 1"),
            ("lose 1.1", "\"1.1\"", "a probability from 0 to 1"),
            ("late 0.1 -3", "\"-3\"", "milliseconds"),
            ("slip z 0.1", "\"z\"", "x or y"),
            ("jam x maybe", "\"maybe\"", "on or off"),
            ("press hard", "\"hard\"", "the end of the line"),
            ("firmware 3.0", "\"3.0\"", "older, newer"),
            ("after 1", "nothing more", "lose, flip"),
        ] {
            let refused = line.parse::<Order>().unwrap_err().to_string();
            assert!(refused.contains(&format!("found {found}, expected {expected}")), "{refused}");
        }
    }
}
