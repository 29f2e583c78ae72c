#![no_main]
libfuzzer_sys::fuzz_target!(|data: &[u8]| covr_fuzz::supervisor(data));
