//! The status of the sweep: the pieces that the sweep line meets, from bottom to top.
//!
//! A list in chunks of bounded length, searched by halving twice: insertion moves at most a chunk,
//! and the memory is touched in order. A balanced tree would do the same with more code; one flat
//! list would move half the status for each long piece, which is quadratic on bundles of long pieces.

/// Longest chunk; a power of two around which the running time is flat.
const CHUNK_MAX: usize = 256;

/// A position in the status: chunk and index within it. One past the end is `(chunks, 0)`.
pub(super) type Position = (usize, usize);

/// Pieces from bottom to top; no chunk is empty.
#[derive(Debug, Default)]
pub(super) struct Status {
    chunks: Vec<Vec<u32>>,
}

impl Status {
    /// The first position at which `below` does not hold. REQUIRES: it holds for a prefix.
    pub fn partition(&self, mut below: impl FnMut(u32) -> bool) -> Position {
        let full = |chunk: &Vec<u32>, below: &mut dyn FnMut(u32) -> bool| {
            chunk.last().is_some_and(|&top| below(top))
        };
        let chunk = self.chunks.partition_point(|chunk| full(chunk, &mut below));
        match self.chunks.get(chunk) {
            Some(pieces) => (chunk, pieces.partition_point(|&piece| below(piece))),
            None => (chunk, 0),
        }
    }

    /// The piece at a position, if it is not the end.
    pub fn get(&self, (chunk, index): Position) -> Option<u32> {
        self.chunks.get(chunk)?.get(index).copied()
    }

    /// The piece just below a position.
    pub fn before(&self, (chunk, index): Position) -> Option<u32> {
        match index.checked_sub(1) {
            Some(index) => self.get((chunk, index)),
            None => self.chunks.get(chunk.checked_sub(1)?)?.last().copied(),
        }
    }

    /// The position above that of a piece.
    pub fn above(&self, (chunk, index): Position) -> Position {
        if index + 1 == self.chunks[chunk].len() { (chunk + 1, 0) } else { (chunk, index + 1) }
    }

    /// Removes the piece at a position and returns the position of the one that was above it.
    pub fn remove(&mut self, (chunk, index): Position) -> Position {
        self.chunks[chunk].remove(index);
        if self.chunks[chunk].is_empty() {
            self.chunks.remove(chunk);
            (chunk, 0)
        } else if index == self.chunks[chunk].len() {
            (chunk + 1, 0)
        } else {
            (chunk, index)
        }
    }

    /// Inserts a piece at a position and returns the position above it.
    pub fn insert(&mut self, (mut chunk, mut index): Position, piece: u32) -> Position {
        if chunk == self.chunks.len() {
            match self.chunks.last() {
                None => self.chunks.push(Vec::new()),
                Some(last) => (chunk, index) = (chunk - 1, last.len()),
            }
        }
        if self.chunks[chunk].len() == CHUNK_MAX {
            let upper = self.chunks[chunk].split_off(CHUNK_MAX / 2);
            self.chunks.insert(chunk + 1, upper);
            if index > CHUNK_MAX / 2 {
                (chunk, index) = (chunk + 1, index - CHUNK_MAX / 2);
            }
        }
        self.chunks[chunk].insert(index, piece);
        self.above((chunk, index))
    }

    /// Removes `piece`, which stands at `from` or just below or somewhere above it.
    pub fn remove_near(&mut self, from: Position, piece: u32) {
        let (mut chunk, mut index) = match from {
            (chunk, index) if index > 0 => (chunk, index - 1),
            (chunk, _) if chunk > 0 => (chunk - 1, self.chunks[chunk - 1].len() - 1),
            first => first,
        };
        while let Some(found) = self.get((chunk, index)) {
            if found == piece {
                self.remove((chunk, index));
                return;
            }
            (chunk, index) = self.above((chunk, index));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pieces(status: &Status) -> Vec<u32> {
        status.chunks.concat()
    }

    fn filled(count: u32) -> Status {
        let mut status = Status::default();
        for piece in 0..count {
            let end = status.partition(|_| true);
            status.insert(end, 2 * piece);
        }
        status
    }

    #[test]
    fn keeps_order_through_splits_of_chunks() {
        let mut status = filled(1000);
        for piece in (0..1000).rev() {
            let at = status.partition(|p| p < 2 * piece + 1);
            let above = status.insert(at, 2 * piece + 1);
            assert_eq!(status.before(above), Some(2 * piece + 1));
            assert_eq!(status.get(above), (piece < 999).then_some(2 * piece + 2));
        }
        assert_eq!(pieces(&status), (0..2000).collect::<Vec<_>>());
        assert!(status.chunks.iter().all(|c| (1..=CHUNK_MAX).contains(&c.len())));
    }

    #[test]
    fn removal_yields_the_position_above() {
        let mut status = filled(600);
        let mut at = status.partition(|p| p < 100);
        for piece in 50..590 {
            assert_eq!(status.get(at), Some(2 * piece));
            at = status.remove(at);
        }
        assert_eq!((status.before(at), status.get(at)), (Some(98), Some(1180)));
        while status.get((0, 0)).is_some() {
            status.remove((0, 0));
        }
        assert_eq!(status.before((0, 0)), None);
    }

    #[test]
    fn remove_near_finds_the_piece_below_and_those_above() {
        let mut status = filled(300);
        let at = status.partition(|p| p < 256);
        status.remove_near(at, 254);
        let at = status.partition(|p| p < 256);
        status.remove_near(at, 266);
        let left = pieces(&status);
        assert_eq!(left.len(), 298);
        assert!(!left.contains(&254) && !left.contains(&266));
    }

    #[test]
    fn remove_near_without_the_piece_changes_nothing() {
        let mut status = filled(3);
        status.remove_near((0, 0), 7);
        assert_eq!(pieces(&status), [0, 2, 4]);
    }
}
