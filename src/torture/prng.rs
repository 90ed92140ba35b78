//! A small generator of pseudo-random numbers, so that a case is the same on every platform for ever.

/// SplitMix64: 64 bits of state, every seed good, no global state.
///
/// Source: G. L. Steele, D. Lea, C. H. Flood, Fast splittable pseudorandom number generators,
/// OOPSLA 2014 (the constants are those of its reference code).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Prng {
    state: u64,
}

/// The odd increment of SplitMix64: 2^64 divided by the golden ratio.
const GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;

impl Prng {
    /// The stream of a seed.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// The stream of one member of a seed's family of streams.
    #[must_use]
    pub fn of(seed: u64, index: u64) -> Self {
        let mut mixer = Self::new(seed);
        let base = mixer.next_u64();
        let mut member = Self::new(base ^ index.wrapping_mul(GAMMA));
        Self::new(member.next_u64())
    }

    /// The next 64 bits.
    pub fn next_u64(&mut self) -> u64 {
        self.state = self.state.wrapping_add(GAMMA);
        let z = self.state;
        let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `n`, which is above 0; the bias is below n / 2^64.
    pub fn below(&mut self, n: u64) -> u64 {
        let wide = u128::from(self.next_u64()) * u128::from(n);
        (wide >> 64) as u64
    }

    /// A number from `low` to `high`, both included.
    pub fn range(&mut self, low: i64, high: i64) -> i64 {
        low + self.below((high - low) as u64 + 1) as i64
    }

    /// An index below `n`, which is above 0.
    pub fn index(&mut self, n: usize) -> usize {
        self.below(n as u64) as usize
    }

    /// True once in `n`.
    pub fn one_in(&mut self, n: u64) -> bool {
        self.below(n) == 0
    }

    /// A positive number below 2^`bits` whose magnitude, not whose value, is evenly spread.
    pub fn magnitude(&mut self, bits: u32) -> i64 {
        let width = 1 + self.below(u64::from(bits)) as u32;
        1 + self.below((1 << width) - 1) as i64
    }

    /// Any of the items, of which there is at least one.
    pub fn pick<'a, T>(&mut self, items: &'a [T]) -> &'a T {
        &items[self.index(items.len())]
    }

    /// Brings the items into any order.
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.index(i + 1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stream_is_that_of_the_reference_code() {
        let mut prng = Prng::new(1_234_567);
        let first: Vec<u64> = (0..3).map(|_| prng.next_u64()).collect();
        let expected =
            [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423];
        assert_eq!(first, expected);
    }

    #[test]
    fn numbers_keep_to_their_range() {
        let mut prng = Prng::of(1, 2);
        for _ in 0..1000 {
            assert!((-3..=4).contains(&prng.range(-3, 4)));
            assert!((1..256).contains(&prng.magnitude(8)));
            assert_eq!(prng.below(1), 0);
        }
    }

    #[test]
    fn streams_of_one_seed_differ() {
        let firsts: std::collections::BTreeSet<u64> =
            (0..1000).map(|i| Prng::of(7, i).next_u64()).collect();
        assert_eq!(firsts.len(), 1000);
        assert_ne!(Prng::of(7, 0).next_u64(), Prng::of(8, 0).next_u64());
    }

    #[test]
    fn shuffling_loses_nothing() {
        let mut items: Vec<u32> = (0..50).collect();
        Prng::new(3).shuffle(&mut items);
        assert_ne!(items, (0..50).collect::<Vec<_>>());
        items.sort_unstable();
        assert_eq!(items, (0..50).collect::<Vec<_>>());
    }
}
