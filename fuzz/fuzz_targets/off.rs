#![no_main]
//! See `tests/fuzzing/targets.rs`.

#[path = "../../tests/fuzzing/targets.rs"]
#[allow(dead_code, reason = "helpers of other targets")]
mod targets;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| targets::TARGETS[2].1(bytes));
