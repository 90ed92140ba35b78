//! A boundary on the integer lattice, and how it is dressed as a domain of doubles.

use super::lattice::{LIMIT, Site};
use crate::domain::{Domain, Inside, Loop, LoopRole, Segment};
use crate::point::Point2;
use crate::torture::prng::Prng;
use std::collections::BTreeMap;

/// A closed ring of sites.
#[derive(Clone, Debug, PartialEq)]
pub struct Ring {
    /// The corners, the first one not repeated.
    pub sites: Vec<Site>,
    /// What it claims to be.
    pub role: LoopRole,
}

/// Rings, segments and isolated points on the lattice.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Draft {
    /// Closed rings.
    pub rings: Vec<Ring>,
    /// Free segments.
    pub segments: Vec<[Site; 2]>,
    /// Isolated points; each becomes a point of its own, even where another one lies.
    pub points: Vec<Site>,
    /// Whether faces are carved by Triangle's rule, without hole points.
    pub carved: bool,
}

impl Draft {
    /// One ring that claims nothing.
    #[must_use]
    pub fn ring(sites: Vec<Site>) -> Self {
        Self { rings: vec![Ring { sites, role: LoopRole::Any }], ..Self::default() }
    }

    /// An axis-parallel square that claims to be an outer boundary.
    #[must_use]
    pub fn square(side: i64) -> Self {
        let mut draft = Self::ring(rectangle([0, 0], [side, side]));
        draft.rings[0].role = LoopRole::Outer;
        draft
    }

    /// Adds a ring.
    pub fn add(&mut self, sites: Vec<Site>, role: LoopRole) {
        self.rings.push(Ring { sites, role });
    }

    /// Every site in use.
    pub fn sites_mut(&mut self) -> impl Iterator<Item = &mut Site> {
        let rings = self.rings.iter_mut().flat_map(|ring| ring.sites.iter_mut());
        rings.chain(self.segments.iter_mut().flatten()).chain(self.points.iter_mut())
    }

    /// Every site in use.
    pub fn sites(&self) -> impl Iterator<Item = Site> + '_ {
        let rings = self.rings.iter().flat_map(|ring| ring.sites.iter());
        rings.chain(self.segments.iter().flatten()).chain(self.points.iter()).copied()
    }

    /// Corners of the box around all sites, of which there is at least one.
    #[must_use]
    pub fn bounds(&self) -> [Site; 2] {
        let start = [[i64::MAX; 2], [i64::MIN; 2]];
        self.sites().fold(start, |[low, high], p| {
            [[low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])]]
        })
    }

    /// Larger side of the box around all sites.
    #[must_use]
    pub fn extent(&self) -> i64 {
        let [low, high] = self.bounds();
        (high[0] - low[0]).max(high[1] - low[1])
    }

    /// Moves everything so that the box starts at `corner`.
    pub fn move_to(&mut self, corner: Site) {
        let [low, _] = self.bounds();
        for site in self.sites_mut() {
            *site = [site[0] - low[0] + corner[0], site[1] - low[1] + corner[1]];
        }
    }

    /// Appends another draft, whose rings then follow.
    pub fn append(&mut self, mut other: Self) {
        let first = self.rings.len();
        for ring in &mut other.rings {
            if let LoopRole::HoleOf(of) = &mut ring.role {
                *of += first;
            }
        }
        self.rings.append(&mut other.rings);
        self.segments.append(&mut other.segments);
        self.points.append(&mut other.points);
    }

    /// The domain, dressed. Rings and segments share the points they have in common.
    #[must_use]
    pub fn domain(&self, dress: &Dress) -> Domain {
        let mut index = BTreeMap::new();
        let mut domain = Domain::new(Vec::new());
        let mut vertex = |site: Site, domain: &mut Domain| {
            *index.entry(site).or_insert_with(|| {
                domain.points.push(dress.point(site));
                domain.points.len() as u32 - 1
            })
        };
        for (ring, marker) in self.rings.iter().zip(1..) {
            let vertices = ring.sites.iter().map(|&s| vertex(s, &mut domain)).collect();
            domain.loops.push(Loop::new(vertices, marker, ring.role));
        }
        for segment in &self.segments {
            let vertices = segment.map(|s| vertex(s, &mut domain));
            domain.segments.push(Segment { vertices, marker: 0 });
        }
        domain.points.extend(self.points.iter().map(|&site| dress.point(site)));
        if self.carved {
            domain.inside = Inside::Carve(Vec::new());
        }
        domain
    }
}

/// The corners of an axis-parallel rectangle, counterclockwise.
#[must_use]
pub fn rectangle(low: Site, high: Site) -> Vec<Site> {
    vec![low, [high[0], low[1]], high, [low[0], high[1]]]
}

/// How lattice sites become doubles. Every step is exact, so what holds of the sites holds of the
/// points: quarter turns, a mirror, a shift by integers, a power of two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dress {
    /// What it is called in reports.
    pub name: &'static str,
    /// Quarter turns, 0 to 3.
    pub turns: u8,
    /// Whether x and y are exchanged first.
    pub mirrored: bool,
    /// Added after the turns.
    pub shift: Site,
    /// The unit is 2 to this power.
    pub exponent: i32,
}

impl Dress {
    /// Sites as they are.
    pub const PLAIN: Self =
        Self { name: "plain", turns: 0, mirrored: false, shift: [0, 0], exponent: 0 };

    /// Names of all dresses.
    pub const NAMES: [&'static str; 6] = ["plain", "ulps", "offset", "scaled", "huge", "tiny"];

    /// A dress for a draft: plain in half of all cases.
    ///
    /// - *plain*: integers as they are;
    /// - *ulps*: in [1, 2), the unit being the distance of two doubles there;
    /// - *offset*: far from the origin, as map coordinates are;
    /// - *scaled*: times a power of two within 2^-60 and 2^60;
    /// - *huge*, *tiny*: near the ends of what a double can hold, subnormal numbers included.
    #[must_use]
    pub fn choose(draft: &Draft, prng: &mut Prng) -> Self {
        let [low, high] = draft.bounds();
        let mut dress = Self {
            name: [
                "plain", "plain", "plain", "plain", "plain", "ulps", "offset", "scaled", "huge",
                "tiny",
            ][prng.index(10)],
            turns: prng.below(4) as u8,
            mirrored: prng.one_in(2),
            ..Self::PLAIN
        };
        let corners = [low, high, [low[0], high[1]], [high[0], low[1]]].map(|s| dress.lattice(s));
        let low = [0, 1].map(|axis| corners.iter().map(|c| c[axis]).min().unwrap_or(0));
        dress.fit(draft.extent(), low, prng);
        dress
    }

    /// Sets shift and exponent; `low` is the turned box's corner.
    fn fit(&mut self, extent: i64, low: Site, prng: &mut Prng) {
        let to = |corner: i64| [corner - low[0], corner - low[1]];
        match self.name {
            "ulps" if extent < LIMIT / 2 => (self.shift, self.exponent) = (to(LIMIT / 2), -52),
            "offset" if extent < LIMIT / 4 => {
                let room = (LIMIT - extent) / 2;
                self.shift = to(prng.range(room / 2, room));
            }
            "scaled" => self.exponent = prng.range(-60, 60) as i32,
            "huge" => self.exponent = prng.range(600, 969) as i32,
            "tiny" => self.exponent = prng.range(-1074, -600) as i32,
            _ => self.name = "plain",
        }
    }

    fn lattice(&self, [x, y]: Site) -> Site {
        let [x, y] = if self.mirrored { [y, x] } else { [x, y] };
        let [x, y] = match self.turns {
            0 => [x, y],
            1 => [-y, x],
            2 => [-x, -y],
            _ => [y, -x],
        };
        [x + self.shift[0], y + self.shift[1]]
    }

    /// The point of a site.
    ///
    /// # Panics
    /// When the shifted site leaves the range in which every integer is a double: a generator's
    /// mistake.
    #[must_use]
    pub fn point(&self, site: Site) -> Point2 {
        let [x, y] = self.lattice(site);
        assert!(x.abs() <= LIMIT && y.abs() <= LIMIT, "{site:?} is beyond the lattice");
        let scaled = |k: i64| libm::scalbn(k as f64, self.exponent);
        Point2::new(scaled(x), scaled(y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dress_is_exact_and_one_to_one() {
        let mut prng = Prng::new(5);
        let draft = Draft::square(1000);
        for _ in 0..500 {
            let dress = Dress::choose(&draft, &mut prng);
            assert!(Dress::NAMES.contains(&dress.name));
            let back = |x: f64| libm::scalbn(x, -dress.exponent);
            for site in [[0, 0], [1000, 0], [999, 1000], [1, 2]] {
                let p = dress.point(site);
                assert!(p.is_finite());
                let [x, y] = dress.lattice(site);
                assert_eq!([back(p.x), back(p.y)], [x as f64, y as f64], "{dress:?}");
            }
        }
    }

    #[test]
    fn in_ulps_neighbouring_sites_are_neighbouring_doubles() {
        let draft = Draft::square(10);
        let mut prng = Prng::new(0);
        let dress = std::iter::repeat_with(|| Dress::choose(&draft, &mut prng))
            .find(|d| d.name == "ulps" && d.turns == 0)
            .expect("one in twenty");
        assert_eq!(dress.point([0, 0]), Point2::new(1.0, 1.0));
        assert_eq!(dress.point([1, 0]).x, 1.0f64.next_up());
    }

    #[test]
    #[should_panic(expected = "beyond the lattice")]
    fn sites_beyond_the_lattice_are_a_mistake() {
        let _ = Dress::PLAIN.point([LIMIT + 1, 0]);
    }

    #[test]
    fn rings_share_points_and_isolated_points_do_not() {
        let mut draft = Draft::square(4);
        draft.segments.push([[0, 0], [2, 2]]);
        draft.points.push([4, 4]);
        let domain = draft.domain(&Dress::PLAIN);
        assert_eq!(domain.points.len(), 6);
        assert_eq!(domain.segments[0].vertices, [0, 4]);
        assert_eq!(domain.points[5], domain.points[2]);
    }

    #[test]
    fn appended_roles_name_their_own_rings() {
        let mut draft = Draft::square(10);
        let mut other = Draft::square(10);
        other.add(rectangle([1, 1], [2, 2]), LoopRole::HoleOf(0));
        other.move_to([20, 0]);
        draft.append(other);
        assert_eq!(draft.rings[2].role, LoopRole::HoleOf(1));
        assert_eq!(draft.bounds(), [[0, 0], [30, 10]]);
    }
}
