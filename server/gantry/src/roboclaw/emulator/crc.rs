//! The check word of a packet: CRC-16 with the polynomial 0x1021, from 0, high bit first (XMODEM). Source: the manual,
//! "CRC16 Checksum Calculation".

/// Over these bytes.
pub(super) fn check_word(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0, |sum, byte| {
        let mut sum = sum ^ (u16::from(*byte) << 8);
        for _ in 0..8 {
            let carried = sum & 0x8000 != 0;
            sum <<= 1;
            if carried {
                sum ^= 0x1021;
            }
        }
        sum
    })
}

#[cfg(test)]
mod tests {
    use super::check_word;

    #[test]
    fn it_is_xmodem() {
        // The check value of the catalogue of parametrised CRC algorithms for CRC-16/XMODEM.
        assert_eq!(check_word(b"123456789"), 0x31C3);
        assert_eq!(check_word(b""), 0);
        // One byte of 1 is the polynomial itself.
        assert_eq!(check_word(&[1]), 0x1021);
    }
}
