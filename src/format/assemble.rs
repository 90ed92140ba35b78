//! Puts together a [`MeshData`] from points and cells in the order a reader meets them.

use crate::format::error::{At, ReadError, ReadFault};
use crate::format::scan::Scanner;
use crate::mesh::{BadEdge, BadReference, MarkedEdge, MeshData, NO_POINT, OtherCells};
use std::collections::BTreeMap;

/// How the numbers of a file's points lead to indices.
#[derive(Debug)]
pub(crate) enum Numbering {
    /// Point i has number i + base. The number of points may still be unknown: a reference beyond
    /// the last point is found by [`Assembler::finish`].
    Base(i64),
    /// Entry `number - first` of the table is the index, or [`NO_POINT`].
    Table { first: i64, indices: Vec<u32> },
    /// Number i is the point with index first + i, for i < count.
    Window { first: u32, count: u32 },
    /// Numbers with large gaps: `(number, index)` by rising number.
    Sorted(Vec<(i64, u32)>),
}

impl Numbering {
    /// The numbering of points that have `numbers`; the index of one
    /// whose number was given before is the error.
    fn of(numbers: &[i64]) -> Result<Self, u32> {
        let first = numbers.iter().copied().min().unwrap_or(0);
        let last = numbers.iter().copied().max().unwrap_or(0);
        if numbers.iter().zip(first..).all(|(&number, expected)| number == expected) {
            return Ok(Self::Base(first));
        }
        // At most four table entries a point, so that one huge number costs no memory.
        match usize::try_from(last.wrapping_sub(first)) {
            Ok(span) if span / 4 <= numbers.len() => Self::table(numbers, first, span + 1),
            _ => Self::sorted(numbers),
        }
    }

    fn table(numbers: &[i64], first: i64, span: usize) -> Result<Self, u32> {
        let mut indices = vec![NO_POINT; span];
        for (index, &number) in numbers.iter().enumerate() {
            let entry = &mut indices[(number - first) as usize];
            if *entry != NO_POINT {
                return Err(index as u32);
            }
            *entry = index as u32;
        }
        Ok(Self::Table { first, indices })
    }

    fn sorted(numbers: &[i64]) -> Result<Self, u32> {
        let mut pairs: Vec<_> = numbers.iter().copied().zip(0_u32..).collect();
        pairs.sort_unstable();
        match pairs.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            Some(pair) => Err(pair[1].1),
            None => Ok(Self::Sorted(pairs)),
        }
    }

    /// The index of the point with `number`, or [`NO_POINT`].
    #[inline]
    fn resolve(&self, number: i64) -> u32 {
        match self {
            Self::Base(base) => number
                .checked_sub(*base)
                .and_then(|index| u32::try_from(index).ok())
                .unwrap_or(NO_POINT),
            Self::Window { first, count } => match u32::try_from(number) {
                Ok(index) if index < *count => first + index,
                _ => NO_POINT,
            },
            Self::Table { first, indices } => number
                .checked_sub(*first)
                .and_then(|offset| usize::try_from(offset).ok())
                .and_then(|offset| indices.get(offset).copied())
                .unwrap_or(NO_POINT),
            Self::Sorted(pairs) => pairs
                .binary_search_by_key(&number, |&(n, _)| n)
                .map_or(NO_POINT, |position| pairs[position].1),
        }
    }

    /// The number of the point with `index`, for a [`Numbering::Base`].
    fn number(&self, index: u32) -> i64 {
        match self {
            Self::Base(base) => i64::from(index) + base,
            _ => i64::from(index),
        }
    }
}

/// A cell as a reader hands it over.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    /// The file's number of the cell, or its rank.
    pub(crate) number: i64,
    /// Marker of an edge, region of a triangle or quadrilateral.
    pub(crate) marker: i64,
    /// Line of a text file.
    pub(crate) line: Option<u64>,
}

/// A mesh under construction.
#[derive(Debug)]
pub(crate) struct Assembler {
    data: MeshData,
    numbering: Numbering,
    numbers: Vec<i64>,
    triangle_numbers: Vec<i64>,
    regions: Vec<i32>,
    edge_cells: Vec<Cell>,
    large_marker: Option<Cell>,
    others: BTreeMap<i64, OtherCells>,
    kinds: BTreeMap<String, i64>,
    split_quads: bool,
}

impl Assembler {
    /// Points are numbered from `base` in file order unless they are given numbers.
    pub(crate) fn new(base: i64, split_quads: bool) -> Self {
        Self {
            data: MeshData::default(),
            numbering: Numbering::Base(base),
            numbers: Vec::new(),
            triangle_numbers: Vec::new(),
            regions: Vec::new(),
            edge_cells: Vec::new(),
            large_marker: None,
            others: BTreeMap::new(),
            kinds: BTreeMap::new(),
            split_quads,
        }
    }

    /// Whether quadrilaterals become two triangles each.
    pub(crate) fn splits_quads(&self) -> bool {
        self.split_quads
    }

    /// Makes room for `count` more points; the caller has checked the count.
    pub(crate) fn reserve_points(&mut self, count: usize) {
        self.data.points.reserve(count);
    }

    /// Number of points so far.
    pub(crate) fn point_count(&self) -> usize {
        self.data.points.len()
    }

    /// Adds a point.
    #[inline]
    pub(crate) fn point(&mut self, point: [f64; 3], line: Option<u64>) {
        if let Some(line) = line {
            self.data.point_lines.push(self.data.points.len() as u32, line);
        }
        self.data.points.push(point);
    }

    /// Adds the file's own number of a point; either every point gets one or none.
    #[inline]
    pub(crate) fn point_number(&mut self, number: i64) {
        self.numbers.push(number);
    }

    /// Ends the points of a file that numbers them: cells may follow.
    pub(crate) fn number_points(&mut self, scanner: &Scanner) -> Result<(), ReadError> {
        self.numbering = Numbering::of(&self.numbers).map_err(|index| {
            let number = self.numbers[index as usize];
            let error = scanner.fail(ReadFault::Duplicate { number });
            let line = self.data.point_lines.line(index);
            ReadError { at: line.map_or(error.at, At::Line), ..error }
        })?;
        Ok(())
    }

    /// From here on cells number `count` points from 0, the first of which has index `first`.
    pub(crate) fn window(&mut self, first: usize, count: usize) {
        self.numbering = Numbering::Window { first: first as u32, count: count as u32 };
    }

    /// Adds a triangle.
    #[inline]
    pub(crate) fn triangle(&mut self, corners: [i64; 3], cell: Cell) {
        let triangle = self.data.triangles.len() as u32;
        let indices = corners.map(|number| self.numbering.resolve(number));
        if indices.contains(&NO_POINT) {
            self.note_bad(triangle, indices, corners);
        }
        if let Some(line) = cell.line {
            self.data.triangle_lines.push(triangle, line);
        }
        self.data.triangles.push(indices);
        let region = self.small_marker(cell);
        self.set_region(triangle as usize, region);
        self.set_number(triangle as usize, cell.number);
    }

    #[cold]
    fn note_bad(&mut self, triangle: u32, indices: [u32; 3], corners: [i64; 3]) {
        for (corner, value) in (0..).zip(corners) {
            if indices[usize::from(corner)] == NO_POINT {
                self.data.bad_references.push(BadReference { triangle, corner, value });
            }
        }
    }

    /// Regions are stored from the first one that is not 0.
    #[inline]
    fn set_region(&mut self, triangle: usize, region: i32) {
        if region != 0 || !self.regions.is_empty() {
            self.regions.resize(triangle, 0);
            self.regions.push(region);
        }
    }

    /// Numbers are stored from the first one that is not the triangle's index.
    #[inline]
    fn set_number(&mut self, triangle: usize, number: i64) {
        if !self.triangle_numbers.is_empty() || number != triangle as i64 {
            let known = self.triangle_numbers.len() as i64;
            self.triangle_numbers.extend(known..triangle as i64);
            self.triangle_numbers.push(number);
        }
    }

    /// Adds a quadrilateral: two triangles when the caller of the reader asked for that, else one
    /// more of the `kind` with this `code`.
    pub(crate) fn quad(&mut self, corners: [i64; 4], cell: Cell, code: i64, kind: &str) {
        if self.split_quads {
            let [a, b, c, d] = corners;
            self.triangle([a, b, c], cell);
            self.triangle([a, c, d], cell);
        } else {
            self.other(code, 1, || kind.to_owned());
        }
    }

    /// Adds a marked edge.
    pub(crate) fn edge(&mut self, ends: [i64; 2], cell: Cell) {
        let vertices = ends.map(|number| self.numbering.resolve(number));
        let marker = self.small_marker(cell);
        if vertices.contains(&NO_POINT) {
            for (_, value) in vertices.iter().zip(ends).filter(|&(&vertex, _)| vertex == NO_POINT) {
                self.data.bad_edges.push(BadEdge { edge: cell.number, value, line: cell.line });
            }
            return;
        }
        self.data.edges.push(MarkedEdge { vertices, marker });
        self.edge_cells.push(cell);
    }

    /// The marker of `cell` as an i32; a larger one becomes the error of [`Self::finish`].
    #[inline]
    fn small_marker(&mut self, cell: Cell) -> i32 {
        i32::try_from(cell.marker).unwrap_or_else(|_| {
            self.large_marker.get_or_insert(cell);
            0
        })
    }

    /// Counts `count` cells of another kind; `code` tells kinds apart and orders them.
    pub(crate) fn other(&mut self, code: i64, count: u64, kind: impl FnOnce() -> String) {
        let entry = self.others.entry(code);
        entry.or_insert_with(|| OtherCells { kind: kind(), count: 0 }).count += count;
    }

    /// Counts a cell whose kind is only a name; kinds are ordered by first occurrence.
    pub(crate) fn other_named(&mut self, kind: String) {
        let next = self.kinds.len() as i64;
        let code = *self.kinds.entry(kind.clone()).or_insert(next);
        self.other(code, 1, || kind);
    }

    /// The mesh, with references beyond the last point reported.
    pub(crate) fn finish(mut self, scanner: &Scanner) -> Result<MeshData, ReadError> {
        if let Some(cell) = self.large_marker {
            let literal = cell.marker.to_string();
            let error = scanner.fail(ReadFault::Number { literal, range: "32-bit markers" });
            return Err(ReadError { at: cell.line.map_or(error.at, At::Line), ..error });
        }
        self.find_bad_triangles();
        self.find_bad_edges();
        self.data.regions = self.regions;
        self.data.other_cells = self.others.into_values().collect();
        self.data.decimal_digits = scanner.decimal_digits();
        if !self.numbers.iter().copied().eq(0..self.numbers.len() as i64) {
            self.data.point_numbers = self.numbers;
        }
        self.data.triangle_numbers = self.triangle_numbers;
        Ok(self.data)
    }

    /// Replaces indices beyond the last point, which only a [`Numbering::Base`] gives out.
    fn find_bad_triangles(&mut self) {
        let count = self.data.points.len() as u32;
        let known = self.data.bad_references.len();
        for (triangle, corners) in (0..).zip(&mut self.data.triangles) {
            if corners.iter().all(|&index| index < count) {
                continue;
            }
            for (corner, index) in (0..).zip(corners) {
                if *index >= count && *index != NO_POINT {
                    let value = self.numbering.number(*index);
                    self.data.bad_references.push(BadReference { triangle, corner, value });
                    *index = NO_POINT;
                }
            }
        }
        if self.data.bad_references.len() > known {
            self.data.bad_references.sort_by_key(|bad| (bad.triangle, bad.corner));
        }
    }

    fn find_bad_edges(&mut self) {
        let count = self.data.points.len() as u32;
        let (numbering, bad) = (&self.numbering, &mut self.data.bad_edges);
        let mut cells = self.edge_cells.iter();
        self.data.edges.retain(|edge| {
            let cell = cells.next();
            for &vertex in edge.vertices.iter().filter(|&&vertex| vertex >= count) {
                let value = numbering.number(vertex);
                bad.extend(cell.map(|cell| BadEdge { edge: cell.number, value, line: cell.line }));
            }
            edge.vertices.iter().all(|&vertex| vertex < count)
        });
    }
}
