//! Equal points: finding them, and finding a point by its coordinates.

/// Coordinates by which equal points are equal: bits, with -0.0 folded into 0.0.
fn key<const D: usize>(point: &[f64; D]) -> [u64; D] {
    point.map(|c| (c + 0.0).to_bits())
}

/// A fixed mixing of the key; the constants are those of SplitMix64 (Steele, Lea, Flood 2014).
fn hash<const D: usize>(key: &[u64; D]) -> u64 {
    key.iter().fold(0x9e37_79b9_7f4a_7c15, |seed, &word| {
        let mut z = (seed ^ word).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 29)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 32)
    })
}

/// Longest probe before a table gives up: input chosen to collide must not cost quadratic time.
const PROBES_MAX: u32 = 256;

/// Points hashed before they are entered: their slots are read together, so that the memory system
/// fetches them side by side instead of one after the other.
const BATCH: usize = 32;

/// A slot holds the upper half of the hash above the index, so that other points are seldom looked
/// at; this one is free.
const VACANT: u64 = u64::MAX;

/// The index of the point in a slot.
#[expect(clippy::cast_possible_truncation, reason = "the lower half is the index")]
fn index_of(slot: u64) -> u32 {
    slot as u32
}

/// Points by coordinates: an open-addressing table of indices, or sorted indices where an
/// adversary made the table's keys collide.
pub(super) enum PointIndex<'a, const D: usize> {
    /// Power-of-two many slots, at most two thirds of them taken.
    Table(&'a [[f64; D]], Vec<u64>),
    /// Indices sorted by key, then by index.
    Sorted(&'a [[f64; D]], Vec<u32>),
}

impl<'a, const D: usize> PointIndex<'a, D> {
    /// Indexes the eligible points; also the pairs (first, again) of equal ones, by `again`.
    pub(super) fn new(
        points: &'a [[f64; D]],
        eligible: impl Fn(u32) -> bool,
    ) -> (Self, Vec<(u32, u32)>) {
        match fill_table(points, &eligible) {
            Some((table, pairs)) => (Self::Table(points, table), pairs),
            None => sort_points(points, eligible),
        }
    }

    /// The first eligible point with these coordinates.
    pub(super) fn find(&self, point: &[f64; D]) -> Option<u32> {
        let wanted = key(point);
        match self {
            Self::Table(points, table) => {
                let hash = hash(&wanted);
                let mut slot = first_slot(hash, table.len());
                while table[slot] != VACANT {
                    let other = index_of(table[slot]);
                    if table[slot] >> 32 == hash >> 32 && key(&points[other as usize]) == wanted {
                        return Some(other);
                    }
                    slot = (slot + 1) & (table.len() - 1);
                }
                None
            }
            Self::Sorted(points, order) => {
                let at = order.partition_point(|&v| key(&points[v as usize]) < wanted);
                order.get(at).copied().filter(|&v| key(&points[v as usize]) == wanted)
            }
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "masked to the table's size")]
fn first_slot(hash: u64, slots: usize) -> usize {
    hash as usize & (slots - 1)
}

type Filled = (Vec<u64>, Vec<(u32, u32)>);

fn fill_table<const D: usize>(
    points: &[[f64; D]],
    eligible: &impl Fn(u32) -> bool,
) -> Option<Filled> {
    let slots = (points.len() + points.len() / 2).next_power_of_two().max(2);
    let mut table = vec![VACANT; slots];
    let mut pairs = Vec::new();
    let mut hashes = [0; BATCH];
    for (batch, coordinates) in (0u32..).zip(points.chunks(BATCH)) {
        let mut seen = 0;
        for (slot, point) in hashes.iter_mut().zip(coordinates) {
            *slot = hash(&key(point));
            seen ^= table[first_slot(*slot, slots)];
        }
        std::hint::black_box(seen);
        let first = batch * BATCH as u32;
        for (v, hash) in (first..).zip(hashes).take(coordinates.len()) {
            if eligible(v) && !insert(points, (v, hash), &mut table, &mut pairs) {
                return None;
            }
        }
    }
    Some((table, pairs))
}

/// Puts a point into the table or, if it is there, notes the pair; `false` after too many probes.
fn insert<const D: usize>(
    points: &[[f64; D]],
    (v, hash): (u32, u64),
    table: &mut [u64],
    pairs: &mut Vec<(u32, u32)>,
) -> bool {
    let mut slot = first_slot(hash, table.len());
    for _ in 0..PROBES_MAX {
        let taken = table[slot];
        if taken == VACANT {
            table[slot] = (hash >> 32 << 32) | u64::from(v);
            return true;
        }
        let other = index_of(taken);
        if taken >> 32 == hash >> 32 && key(&points[other as usize]) == key(&points[v as usize]) {
            pairs.push((other, v));
            return true;
        }
        slot = (slot + 1) & (table.len() - 1);
    }
    false
}

fn sort_points<const D: usize>(
    points: &[[f64; D]],
    eligible: impl Fn(u32) -> bool,
) -> (PointIndex<'_, D>, Vec<(u32, u32)>) {
    let mut order: Vec<u32> = (0u32..).take(points.len()).filter(|&v| eligible(v)).collect();
    order.sort_unstable_by_key(|&v| (key(&points[v as usize]), v));
    let mut pairs = Vec::new();
    let mut first = None;
    for &v in &order {
        match first {
            Some(f) if key(&points[f as usize]) == key(&points[v as usize]) => pairs.push((f, v)),
            _ => first = Some(v),
        }
    }
    pairs.sort_unstable_by_key(|pair| pair.1);
    (PointIndex::Sorted(points, order), pairs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_of_both_signs_are_the_same_place() {
        let points = [[0.0, 1.0, 0.0], [-0.0, 1.0, 0.0], [2.0, 1.0, 0.0]];
        assert_eq!(PointIndex::new(&points, |_| true).1, [(0, 1)]);
        assert_eq!(PointIndex::new(&points, |v| v != 0).1, []);
    }

    #[test]
    fn table_and_sorted_order_agree() {
        let points: Vec<[f64; 2]> =
            (0..1000).map(|i| [f64::from(i % 37), f64::from(i % 11)]).collect();
        let (table, pairs) = PointIndex::new(&points, |v| v % 3 != 0);
        let (sorted, again) = sort_points(&points, |v| v % 3 != 0);
        assert!(matches!(table, PointIndex::Table(..)));
        assert_eq!(pairs, again);
        for point in points.iter().chain(&[[0.5, 0.5]]) {
            assert_eq!(table.find(point), sorted.find(point));
        }
    }
}
