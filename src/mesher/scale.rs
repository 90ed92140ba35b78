//! Scaling by an exact power of two, so that squares of lengths neither overflow nor vanish.
//!
//! Only ranking arithmetic profits; the predicates are right at any scale. Multiplying by a power
//! of two is exact unless bits fall below the smallest subnormal number: then nothing is scaled.

use crate::domain::validate::{Plc, PlcInside};
use crate::point::Point2;

/// An exact scaling: coordinates inside the mesher are the user's times 2^-exponent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Scale {
    exponent: i32,
}

/// Numbers of size 1 keep all their bits when multiplied by 2^-960: their last bit is 2^-52.
const LOSSLESS_EXPONENT_MIN: i32 = -900;

impl Scale {
    /// The scaling that brings the largest coordinate between 1 and 2, if it loses no bit.
    pub(super) fn of(points: &[Point2]) -> Self {
        let largest = points.iter().flat_map(|p| [p.x.abs(), p.y.abs()]).fold(0.0, f64::max);
        if largest == 0.0 {
            return Self { exponent: 0 };
        }
        let scale = Self { exponent: libm::ilogb(largest) };
        let lossless = points.iter().all(|&p| scale.grow(scale.shrunk(p)) == p);
        if lossless { scale } else { Self { exponent: 0 } }
    }

    pub(super) fn shrink(&self, plc: &mut Plc) {
        for p in &mut plc.points {
            *p = self.shrunk(*p);
        }
        if let PlcInside::Carve(holes) = &mut plc.inside {
            for p in holes {
                *p = self.shrunk(*p);
            }
        }
        for region in &mut plc.regions {
            region.seed = self.shrunk(region.seed);
            region.area_max = region.area_max.map(|area| self.shrink_area(area));
        }
    }

    pub(super) fn shrunk(&self, p: Point2) -> Point2 {
        Point2::new(libm::scalbn(p.x, -self.exponent), libm::scalbn(p.y, -self.exponent))
    }

    /// Back to the user's coordinates.
    pub(super) fn grow(&self, p: Point2) -> Point2 {
        Point2::new(libm::scalbn(p.x, self.exponent), libm::scalbn(p.y, self.exponent))
    }

    pub(super) fn grow_length(&self, h: f64) -> f64 {
        libm::scalbn(h, self.exponent)
    }

    pub(super) fn shrink_area(&self, area: f64) -> f64 {
        libm::scalbn(area, -2 * self.exponent)
    }

    pub(super) fn shrink_length(&self, h: f64) -> f64 {
        libm::scalbn(h, -self.exponent)
    }

    /// New points must be multiples of this, or growing back would round them; `None` where every
    /// new point keeps its bits anyhow.
    pub(super) fn quantum(&self) -> Option<f64> {
        (self.exponent < LOSSLESS_EXPONENT_MIN).then(|| libm::scalbn(1.0, -1074 - self.exponent))
    }
}
