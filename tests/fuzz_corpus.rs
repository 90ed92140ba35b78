//! The fuzz targets as plain tests: each over its committed corpus, over mutations of it, and over
//! pseudo-random bytes from a fixed seed. `TRIGRADE_FUZZ_SECONDS=N` runs each for N seconds
//! instead of a fixed number of inputs.

#[path = "../fuzz/src/lib.rs"]
mod fuzz;

use fuzz::{TARGETS, Target};
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

/// Inputs a target gets in the plain test run.
const INPUTS: u64 = 400;

/// The corpus of a target in the order of its file names.
fn corpus(name: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(name);
    let mut paths: Vec<_> = fs::read_dir(&folder)
        .unwrap_or_else(|e| panic!("{}: {e}", folder.display()))
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    paths.iter().map(|path| fs::read(path).expect("readable")).collect()
}

/// splitmix64: every run is the same.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    fn bytes(&mut self) -> Vec<u8> {
        let length = self.below(400);
        (0..length).map(|_| self.next() as u8).collect()
    }

    /// A corpus entry with a few bytes changed, cut out, repeated, or the end missing.
    fn mutated(&mut self, corpus: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = corpus[self.below(corpus.len())].clone();
        for _ in 0..=self.below(4) {
            if bytes.is_empty() {
                break;
            }
            let (at, other) = (self.below(bytes.len()), self.below(bytes.len()));
            match self.below(6) {
                0 => bytes[at] = self.next() as u8,
                1 => bytes[at] = b"0123456789-.eEnN[]{},\n \t"[self.below(24)],
                2 => bytes.truncate(at),
                3 => drop(bytes.drain(at.min(other)..at.max(other))),
                4 => bytes.swap(at, other),
                _ => {
                    let piece = bytes[at.min(other)..at.max(other)].to_vec();
                    bytes.splice(at..at, piece);
                }
            }
        }
        bytes
    }
}

/// Runs one input; a fault names the input in hexadecimal, so that it can go into the corpus.
fn run_one((name, body): Target, bytes: &[u8]) {
    let outcome = std::panic::catch_unwind(|| body(bytes));
    if outcome.is_err() {
        let hex: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        panic!("{name} fails on this input (hexadecimal, `xxd -r -p` makes a file of it): {hex}");
    }
}

fn run(target: Target) {
    let corpus = corpus(target.0);
    assert!(!corpus.is_empty(), "{} has no corpus", target.0);
    corpus.iter().for_each(|bytes| run_one(target, bytes));
    let seconds = std::env::var("TRIGRADE_FUZZ_SECONDS").ok().map(|text| {
        Duration::from_secs(text.parse().expect("TRIGRADE_FUZZ_SECONDS is a whole number"))
    });
    let start = Instant::now();
    let is_over = |count| match seconds {
        Some(limit) => start.elapsed() >= limit,
        None => count >= INPUTS,
    };
    let mut random = Random(0x7121_6ade);
    let mut count = 0;
    while !is_over(count) {
        let bytes = if count % 2 == 0 { random.mutated(&corpus) } else { random.bytes() };
        run_one(target, &bytes);
        count += 1;
    }
    println!("{}: {} of the corpus and {count} made inputs", target.0, corpus.len());
}

#[test]
fn predicates() {
    run(TARGETS[0]);
}

#[test]
fn domain_parsers() {
    run(TARGETS[1]);
}

#[test]
fn mesh_readers() {
    run(TARGETS[2]);
}

#[test]
fn cdt() {
    run(TARGETS[3]);
}

#[test]
fn pipeline() {
    run(TARGETS[4]);
}

#[test]
fn point_files() {
    run(TARGETS[5]);
}

// spec: R13
#[test]
fn torture() {
    run(TARGETS[6]);
}

// spec: X63
#[test]
fn model_files() {
    run(TARGETS[7]);
}

#[test]
#[should_panic(expected = "fails on this input")]
fn a_fault_is_not_swallowed() {
    run_one(("canary", |bytes| assert!(bytes.len() < 3, "a fault on purpose")), b"abc");
}
