#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| trigrade_fuzz::model_files::run(bytes));
