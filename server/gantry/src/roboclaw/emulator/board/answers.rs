//! What a board does when a packet for it has come.

use covr_engine::time::Time;

use super::{Answer, Board, CURRENT_UNIT_AMPS, LOGIC_TENTHS};
use crate::roboclaw::emulator::commands::Values;
use crate::roboclaw::emulator::firmware::PinFunction;
use crate::roboclaw::emulator::settings::{PositionPid, VelocityPid};

impl Board {
    /// Do as told, at `now`.
    pub(crate) fn answer(&mut self, now: Time, command: u8, data: &[u8]) -> Answer {
        self.heard_at = now;
        let mut values = Values::new(data);
        let answer = match command {
            0..=13 | 32..=46 | 50..=54 | 65..=67 => self.move_motors(command, &mut values),
            14 | 26..=29 | 57 | 58 | 61 | 62 | 68 | 69 | 74 | 92..=95 | 109 | 112 | 133 | 134 => {
                self.configure(command, &mut values)
            }
            20 | 22 | 23 => self.set_encoders(command, &mut values),
            command => Answer::Values(self.read(command)),
        };
        debug_assert!(answer == Answer::None || values.are_used(), "{command} has values that nobody used");
        answer
    }

    fn set_encoders(&mut self, command: u8, values: &mut Values<'_>) -> Answer {
        match command {
            22 => self.channels[0].encoder.set(values.long()),
            23 => self.channels[1].encoder.set(values.long()),
            _ => self.channels.iter_mut().for_each(|channel| channel.encoder.set(0)),
        }
        Answer::Acknowledged
    }

    fn configure(&mut self, command: u8, values: &mut Values<'_>) -> Answer {
        let settings = &mut self.settings;
        match command {
            14 => settings.serial_timeout = values.byte(),
            // Steps of 0.2 V from 6 V; 5.12ths of a volt (manual).
            26 => settings.logic_battery[0] = 60 + 2 * u16::from(values.byte()),
            27 => settings.logic_battery[1] = (f64::from(values.byte()) / 5.12 * 10.0).round() as u16,
            28 | 29 => {
                let [d, p, i, qpps] = [(); 4].map(|()| values.long());
                settings.velocity[usize::from(command - 28)] = VelocityPid { p, i, d, qpps };
            }
            57 => settings.main_battery = [(); 2].map(|()| values.word()),
            58 => settings.logic_battery = [(); 2].map(|()| values.word()),
            61 | 62 => {
                let [d, p, i, max_i, deadzone] = [(); 5].map(|()| values.long());
                let [min, max] = [(); 2].map(|()| values.signed_long());
                settings.position[usize::from(command - 61)] =
                    PositionPid { p, i, d, max_i, deadzone, min, max };
            }
            68 | 69 => settings.duty_acceleration[usize::from(command - 68)] = values.long(),
            74 => {
                settings.pins = [(); 3].map(|()| values.byte());
                self.put_pins_in_force();
            }
            92 | 93 => settings.encoder_modes[usize::from(command - 92)] = values.byte(),
            94 => {
                if values.long() != SAVE_KEY {
                    return Answer::None;
                }
                self.eeprom = self.settings.clone();
            }
            95 => {
                self.settings = self.eeprom.clone();
                self.put_pins_in_force();
            }
            109 => settings.speed_error_limits = [(); 2].map(|()| values.long()),
            112 => settings.position_error_limits = [(); 2].map(|()| values.long()),
            133 | 134 => {
                settings.maximum_current[usize::from(command - 133)] = values.long();
                // The least current: "always 0" (manual, "135").
                let _ = values.long();
            }
            _ => return Answer::None,
        }
        Answer::Acknowledged
    }

    fn put_pins_in_force(&mut self) {
        for pin in 0..3 {
            let code = self.settings.pins[pin];
            let is_a_switch = matches!(
                self.firmware.pin_function(pin, code),
                PinFunction::Home { .. } | PinFunction::Limit { .. }
            );
            if !(is_a_switch && self.firmware.switches_wait_for_restart) {
                self.pins_in_force[pin] = code;
            }
        }
    }

    fn read(&mut self, command: u8) -> Vec<u8> {
        let settings = &self.settings;
        let longs = |values: &[u32]| values.iter().flat_map(|value| value.to_be_bytes()).collect();
        let words = |values: &[u16]| values.iter().flat_map(|value| value.to_be_bytes()).collect();
        let both = |value: &dyn Fn(usize) -> i32| longs(&[0, 1].map(|index| value(index).cast_unsigned()));
        let channels = &self.channels;
        match command {
            15 => vec![settings.serial_timeout],
            16 | 17 => {
                let encoder = &mut self.channels[usize::from(command - 16)].encoder;
                let mut bytes = encoder.register().to_be_bytes().to_vec();
                bytes.push(encoder.take_status());
                bytes
            }
            18 | 19 => with_direction(channels[usize::from(command - 18)].encoder.filtered_cps()),
            21 => self.firmware.version(),
            24 => self.main_tenths().to_be_bytes().to_vec(),
            25 => LOGIC_TENTHS.to_be_bytes().to_vec(),
            30 | 31 => with_direction(channels[usize::from(command - 30)].encoder.raw_cps()),
            47 => channels.iter().map(|channel| channel.buffer_depth()).collect(),
            48 => words(&[0, 1].map(|index| {
                let duty = channels[index].duty() * FULL_DUTY;
                (duty.round() as i16).cast_unsigned()
            })),
            // Positive while the motor is driven, negative while it brakes into the supply (unverified).
            49 => words(&[0, 1].map(|index| {
                let drawn = self.senses.amps[index] * self.channels[index].duty().signum();
                let driven = drawn * self.signs(index)[1] as f64;
                ((driven / CURRENT_UNIT_AMPS).round() as i16).cast_unsigned()
            })),
            55 | 56 => {
                let pid = &settings.velocity[usize::from(command - 55)];
                longs(&[pid.p, pid.i, pid.d, pid.qpps])
            }
            59 => words(&settings.main_battery),
            60 => words(&settings.logic_battery),
            63 | 64 => {
                let pid = &settings.position[usize::from(command - 63)];
                let [min, max] = [pid.min, pid.max].map(i32::cast_unsigned);
                longs(&[pid.p, pid.i, pid.d, pid.max_i, pid.deadzone, min, max])
            }
            75 => settings.pins.to_vec(),
            78 => longs(&[0, 1].map(|index| channels[index].encoder.register())),
            79 => both(&|index| channels[index].encoder.raw_cps()),
            81 => longs(&settings.duty_acceleration),
            82 | 83 => ((self.senses.temperature * 10.0).round() as u16).to_be_bytes().to_vec(),
            90 => self.firmware.status(&self.flags()),
            91 => settings.encoder_modes.to_vec(),
            99 => self.standard_configuration().to_be_bytes().to_vec(),
            108 => both(&|index| channels[index].encoder.average_cps()),
            110 => longs(&settings.speed_error_limits),
            111 => both(&|index| channels[index].speed_error().round() as i32),
            113 => longs(&settings.position_error_limits),
            114 => both(&|index| channels[index].position_error().round() as i32),
            135 | 136 => longs(&[settings.maximum_current[usize::from(command - 135)], 0]),
            _ => Vec::new(),
        }
    }

    /// Packet serial, the rate, the address, and whether others share the line (manual, "98").
    fn standard_configuration(&self) -> u16 {
        let rates = [2_400, 9_600, 19_200, 38_400, 57_600, 115_200, 230_400, 460_800];
        let rate = rates.iter().position(|rate| *rate == self.baud).unwrap_or_default() as u16;
        let address = u16::from(self.address & 0x07);
        PACKET_SERIAL | rate << 5 | address << 8 | u16::from(self.shares_its_line) << 15
    }
}

/// Commands 18, 19, 30 and 31: the speed and a byte that is 1 when it goes backward. *Unverified:* that the speed itself
/// has its sign; the maker's example takes it for a signed number.
fn with_direction(cps: i32) -> Vec<u8> {
    let mut bytes = cps.to_be_bytes().to_vec();
    bytes.push(u8::from(cps < 0));
    bytes
}

/// The maker's library sends it with 94; boards do not save without (forum, topics 747 and 1164).
const SAVE_KEY: u32 = 0xE22E_AB7A;
/// Of 100 % duty (manual, "48").
pub(super) const FULL_DUTY: f64 = 32_767.0;
const PACKET_SERIAL: u16 = 0x0003;
