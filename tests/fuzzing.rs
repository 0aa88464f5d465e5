//! Every fuzz target on its seeds, on what was once found, and on a few thousand changes of both.

#[path = "fuzzing/targets.rs"]
#[allow(dead_code, reason = "helpers of other tests")]
mod targets;

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use targets::TARGETS;

/// Time for the changes of each target; a busy machine makes fewer of them.
const PATIENCE: Duration = Duration::from_secs(2);
const CHANGES: u64 = 2_000;

/// Random numbers that are the same in every run (splitmix64).
struct Dice(u64);

impl Dice {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % end.max(1) as u64) as usize
    }
}

fn files(folder: &Path) -> Vec<Vec<u8>> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<_> = entries.map(|e| e.unwrap().path()).collect();
    paths.sort();
    paths.iter().map(|path| fs::read(path).unwrap()).collect()
}

/// The seed with a few places changed, cut, doubled, or filled from another seed.
fn changed(seeds: &[Vec<u8>], dice: &mut Dice) -> Vec<u8> {
    let mut bytes = seeds[dice.below(seeds.len())].clone();
    for _ in 0..=dice.below(4) {
        let at = dice.below(bytes.len());
        let end = at + dice.below(bytes.len() - at + 1).min(40);
        match dice.below(5) {
            0 if !bytes.is_empty() => bytes[at] ^= 1 << dice.below(8),
            1 => drop(bytes.drain(at..end)),
            2 => {
                let part = bytes[at..end].to_vec();
                bytes.splice(at..at, part);
            }
            3 => {
                let words: [&[u8]; 6] = [b"-1", b"0", b" 1e999 ", b"4294967296", b"nan", b"\n"];
                bytes.splice(at..at, words[dice.below(6)].iter().copied());
            }
            _ => {
                let other = &seeds[dice.below(seeds.len())];
                let start = dice.below(other.len());
                let part = &other[start..other.len().min(start + 40)];
                bytes.splice(at..end, part.iter().copied());
            }
        }
    }
    bytes
}

#[test]
fn seeds_finds_and_changes_of_them_come_back() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzzing");
    for &(name, target) in TARGETS {
        let seeds = files(&root.join("seeds").join(name));
        assert!(!seeds.is_empty(), "{name} has no seeds");
        seeds.iter().chain(&files(&root.join("finds").join(name))).for_each(|seed| target(seed));
        let (mut dice, began, mut made) = (Dice(1), Instant::now(), 0);
        while made < CHANGES && began.elapsed() < PATIENCE {
            target(&changed(&seeds, &mut dice));
            made += 1;
        }
        assert!(made > 10, "{name} is slow: {made} changes in {PATIENCE:?}");
    }
}

#[test]
fn every_target_can_be_fuzzed() {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/Cargo.toml");
    let manifest = fs::read_to_string(manifest).unwrap();
    for (name, _) in TARGETS {
        assert!(
            manifest.contains(&format!("name = \"{name}\"")),
            "{name} is not in fuzz/Cargo.toml"
        );
    }
}
