//! Places of a few hundred numbers: a small table with open addressing, never iterated over.

/// Twice as many slots as a patch has triangles at most, a power of two.
const SLOTS: usize = 512;
/// No number.
const EMPTY: u32 = u32::MAX;
/// 2^32 over the golden ratio (Knuth, "Sorting and searching", 6.4).
const FACTOR: u32 = 2_654_435_769;

/// For each number a place.
pub(super) struct Places {
    slots: Vec<[u32; 2]>,
}

impl Default for Places {
    fn default() -> Self {
        Self { slots: vec![[EMPTY, 0]; SLOTS] }
    }
}

impl Places {
    /// The slot of a number, or the empty one where it belongs.
    fn slot(&self, number: u32) -> usize {
        let mut at = (number.wrapping_mul(FACTOR) >> 23) as usize;
        while self.slots[at][0] != number && self.slots[at][0] != EMPTY {
            at = (at + 1) % SLOTS;
        }
        at
    }

    /// Gives a number a place if it has none; returns whether it had none. At most 511 fit.
    pub(super) fn insert(&mut self, number: u32, place: u32) -> bool {
        let at = self.slot(number);
        let is_new = self.slots[at][0] == EMPTY;
        if is_new {
            self.slots[at] = [number, place];
        }
        is_new
    }

    /// Gives a number another place.
    pub(super) fn set(&mut self, number: u32, place: u32) {
        let at = self.slot(number);
        self.slots[at] = [number, place];
    }

    pub(super) fn get(&self, number: u32) -> Option<u32> {
        let [found, place] = self.slots[self.slot(number)];
        (found == number).then_some(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_places_where_all_share_a_slot() {
        // Numbers 2^23 apart differ in bits that the product's top nine do not all see.
        let mut places = Places::default();
        let numbers: Vec<u32> = (0..400).map(|i| i * (1 << 23)).collect();
        for (i, &n) in (0..).zip(&numbers) {
            assert!(places.insert(n, i));
            assert!(!places.insert(n, 7777));
        }
        for (i, &n) in (0..).zip(&numbers) {
            assert_eq!(places.get(n), Some(i));
        }
    }

    #[test]
    fn a_number_that_was_not_given_has_no_place() {
        let mut places = Places::default();
        assert_eq!(places.get(3), None);
        places.insert(4, 1);
        assert_eq!(places.get(3), None);
        places.set(4, 2);
        assert_eq!(places.get(4), Some(2));
    }
}
