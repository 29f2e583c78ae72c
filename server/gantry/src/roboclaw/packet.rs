//! Packets: address, command, big-endian data, CRC16. After the maker's manual, "Packet Serial".

/// A command that is answered with `0xFF`, as bytes ready to send.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Packet {
    bytes: Vec<u8>,
}

/// The commands in use, by the maker's numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Command {
    SetSerialTimeout = 14,
    ReadSerialTimeout = 15,
    ReadEncoderM1 = 16,
    ReadRawSpeedM1 = 30,
    ReadRawSpeedM2 = 31,
    ReadFirmware = 21,
    SetEncoderM1 = 22,
    SetEncoderM2 = 23,
    ReadMainVolts = 24,
    SetVelocityPidM1 = 28,
    SetVelocityPidM2 = 29,
    DutyBoth = 34,
    SpeedAccelM1 = 38,
    SpeedAccelDistanceM1 = 44,
    ReadCurrents = 49,
    SpeedAccelBoth = 50,
    SpeedAccelDistanceBoth = 51,
    ReadVelocityPidM1 = 55,
    ReadVelocityPidM2 = 56,
    SetPinModes = 74,
    ReadPinModes = 75,
    ReadEncoders = 78,
    ReadTemperature = 82,
    ReadStatus = 90,
    SaveSettings = 94,
    SetMaxCurrentM1 = 133,
    SetMaxCurrentM2 = 134,
    ReadMaxCurrentM1 = 135,
    ReadMaxCurrentM2 = 136,
}

impl Packet {
    /// The beginning of a command to the board at this address.
    pub fn to(address: u8, command: Command) -> Self {
        Self { bytes: vec![address, command as u8] }
    }

    pub fn byte(mut self, value: u8) -> Self {
        self.bytes.push(value);
        self
    }

    pub fn word(mut self, value: u16) -> Self {
        self.bytes.extend(value.to_be_bytes());
        self
    }

    pub fn long(mut self, value: u32) -> Self {
        self.bytes.extend(value.to_be_bytes());
        self
    }

    pub fn signed(self, value: i32) -> Self {
        self.long(value as u32)
    }

    /// With the CRC that every command which sets something ends in.
    pub fn sealed(mut self) -> Vec<u8> {
        let crc = crc16(&self.bytes);
        self.bytes.extend(crc.to_be_bytes());
        self.bytes
    }

    /// As a question: address and command alone; the reply's CRC covers them too.
    pub fn question(self) -> [u8; 2] {
        [self.bytes[0], self.bytes[1]]
    }
}

/// CRC-16/XMODEM: polynomial 0x1021, from 0, most significant bit first.
pub fn crc16(bytes: &[u8]) -> u16 {
    crc16_on(0, bytes)
}

/// The same, going on from the CRC of what came before.
pub fn crc16_on(crc: u16, bytes: &[u8]) -> u16 {
    bytes.iter().fold(crc, |crc, byte| {
        (0..8).fold(crc ^ (u16::from(*byte) << 8), |crc, _| {
            if crc & 0x8000 == 0 { crc << 1 } else { (crc << 1) ^ 0x1021 }
        })
    })
}

/// Big-endian numbers out of a reply that was long enough.
#[derive(Debug, Clone, Copy)]
pub struct Reply<'a>(pub &'a [u8]);

impl Reply<'_> {
    pub fn word(&self, at: usize) -> u16 {
        u16::from_be_bytes([self.0[at], self.0[at + 1]])
    }

    pub fn long(&self, at: usize) -> u32 {
        u32::from_be_bytes([self.0[at], self.0[at + 1], self.0[at + 2], self.0[at + 3]])
    }

    pub fn signed(&self, at: usize) -> i32 {
        self.long(at) as i32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_crc_is_xmodem() {
        // The check value of CRC-16/XMODEM.
        assert_eq!(crc16(b"123456789"), 0x31C3);
        assert_eq!(crc16_on(crc16(b"1234"), b"56789"), 0x31C3);
    }

    #[test]
    fn a_command_is_address_number_data_and_crc() {
        let bytes = Packet::to(0x80, Command::SpeedAccelM1).long(10_000).signed(-2).sealed();
        assert_eq!(bytes[..10], [0x80, 38, 0, 0, 0x27, 0x10, 0xFF, 0xFF, 0xFF, 0xFE]);
        assert_eq!(crc16(&bytes), 0, "a packet with its CRC has the CRC 0");
        assert_eq!(Packet::to(0x81, Command::ReadStatus).question(), [0x81, 90]);
    }

    #[test]
    fn a_reply_is_read_big_endian() {
        let reply = Reply(&[0, 1, 0xFF, 0xFF, 0xFF, 0xFE]);
        assert_eq!((reply.word(0), reply.long(0), reply.signed(2)), (1, 0x1FFFF, -2));
    }
}
