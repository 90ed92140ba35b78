//! From the coordinates of a mesh to those of the page.

use crate::mesh::MeshData;
use std::str::FromStr;

/// A rectangle in the coordinates of the mesh: the part that a picture shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Left.
    pub x0: f64,
    /// Bottom.
    pub y0: f64,
    /// Right.
    pub x1: f64,
    /// Top.
    pub y1: f64,
}

impl View {
    /// Whether all four numbers are finite and the rectangle has a width and a height.
    #[must_use]
    pub fn is_proper(self) -> bool {
        [self.x0, self.y0, self.x1, self.y1].iter().all(|x| x.is_finite())
            && self.half_size().iter().all(|&half| half > 0.0)
    }

    /// The rectangle around every triangle that can be drawn, or around the finite points when
    /// there is none; `None` when there are neither. A flat one is widened to a proper view.
    #[must_use]
    pub fn of(mesh: &MeshData) -> Option<Self> {
        let corners = mesh.triangles.iter().filter_map(|&t| super::layer::corners(mesh, t));
        Self::around(corners.flatten())
            .or_else(|| Self::around(mesh.points.iter().copied()))
            .map(Self::widened)
    }

    /// The rectangle around finite points, widened if it is flat; the unit square without a point.
    pub(super) fn around_points(points: &[crate::point::Point2]) -> Self {
        let unit = Self { x0: 0.0, y0: 0.0, x1: 1.0, y1: 1.0 };
        Self::around(points.iter().map(|p| [p.x, p.y, 0.0])).map_or(unit, Self::widened)
    }

    fn around(points: impl Iterator<Item = [f64; 3]>) -> Option<Self> {
        points.filter(|p| p[0].is_finite() && p[1].is_finite()).fold(None, |view, [x, y, _]| {
            let v = view.unwrap_or(Self { x0: x, y0: y, x1: x, y1: y });
            Some(Self { x0: v.x0.min(x), y0: v.y0.min(y), x1: v.x1.max(x), y1: v.y1.max(y) })
        })
    }

    /// At least a thousandth as wide as high and the other way round, and never empty.
    fn widened(self) -> Self {
        let size = half_span(self.x0, self.x1).max(half_span(self.y0, self.y1));
        let magnitude = self.x0.abs().max(self.x1.abs()).max(self.y0.abs()).max(self.y1.abs());
        let least = (size * 1e-3).max(magnitude * 1e-12).max(f64::MIN_POSITIVE);
        let widen = |low: f64, high: f64| {
            let add = if half_span(low, high) < least { least } else { 0.0 };
            ((low - add).max(f64::MIN), (high + add).min(f64::MAX))
        };
        let ((x0, x1), (y0, y1)) = (widen(self.x0, self.x1), widen(self.y0, self.y1));
        Self { x0, y0, x1, y1 }
    }

    /// Half the width and half the height: halves, because the whole may overflow.
    pub(super) fn half_size(self) -> [f64; 2] {
        [half_span(self.x0, self.x1), half_span(self.y0, self.y1)]
    }
}

fn half_span(low: f64, high: f64) -> f64 {
    high / 2.0 - low / 2.0
}

impl std::fmt::Display for View {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{},{},{},{}", self.x0, self.y0, self.x1, self.y1)
    }
}

/// Why a text is no [`View`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("'{text}' is no view: give x0,y0,x1,y1 with x0 < x1 and y0 < y1")]
pub struct ParseViewError {
    text: String,
}

impl FromStr for View {
    type Err = ParseViewError;

    /// Reads `x0,y0,x1,y1`.
    fn from_str(text: &str) -> Result<Self, ParseViewError> {
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|s| s.trim().parse()).collect();
        match numbers.as_deref() {
            Ok(&[x0, y0, x1, y1]) => Some(Self { x0, y0, x1, y1 }).filter(|v| v.is_proper()),
            _ => None,
        }
        .ok_or_else(|| ParseViewError { text: text.to_owned() })
    }
}

/// Where a view lies on the page, and how fine the coordinates of its paths are.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    view: View,
    /// Half the view's width and height.
    half: [f64; 2],
    /// Page coordinates of the top left corner.
    pub corner: [f64; 2],
    /// Width and height on the page.
    pub size: [f64; 2],
    /// Pixels of one step of the paths' integer coordinates; a power of ten.
    pub unit: f64,
}

impl Frame {
    /// The view drawn into the rectangle of `size` at `corner` of the page.
    pub fn new(view: View, corner: [f64; 2], size: [f64; 2]) -> Self {
        Self { view, half: view.half_size(), corner, size, unit: 0.01 }
    }

    /// Page coordinates relative to the corner; far outside the view they may be huge or infinite.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let t = half_span(self.view.x0, x) / self.half[0];
        let u = half_span(y, self.view.y1) / self.half[1];
        [t * self.size[0], u * self.size[1]]
    }

    /// Steps of the path coordinates for a place, clamped to what any viewer can hold.
    pub fn grid(&self, [x, y]: [f64; 2]) -> [i64; 2] {
        // The cast saturates; clip() has brought everything near the page before.
        [(x / self.unit).round() as i64, (y / self.unit).round() as i64]
    }

    /// How far outside the frame a place may lie without being cut off, in pixels: enough to
    /// hide the widest line.
    const MARGIN: f64 = 8.0;

    /// Whether a place lies in the frame or near it.
    pub fn holds(&self, [x, y]: [f64; 2]) -> bool {
        let m = Self::MARGIN;
        x >= -m && x <= self.size[0] + m && y >= -m && y <= self.size[1] + m
    }

    /// The part of a convex polygon (or, with two places, a line) that lies in the frame or near
    /// it (Sutherland and Hodgman, 1974); empty when nothing does.
    pub fn clip(&self, polygon: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let m = Self::MARGIN;
        let bounds =
            [(0, -m, 1.0), (0, self.size[0] + m, -1.0), (1, -m, 1.0), (1, self.size[1] + m, -1.0)];
        let mut kept = polygon.to_vec();
        for (axis, bound, side) in bounds {
            kept = clip_half_plane(&kept, axis, bound, side);
        }
        kept
    }
}

/// Keeps what lies at `(place[axis] - bound) * side >= 0`.
fn clip_half_plane(polygon: &[[f64; 2]], axis: usize, bound: f64, side: f64) -> Vec<[f64; 2]> {
    let closed = polygon.len() > 2;
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &here) in polygon.iter().enumerate() {
        let inside = |p: [f64; 2]| (p[axis] - bound) * side >= 0.0;
        if inside(here) {
            kept.push(here);
        }
        let next = match polygon.get(i + 1) {
            Some(&next) => next,
            None if closed => polygon[0],
            None => break,
        };
        if inside(here) != inside(next) {
            let t = (bound - here[axis]) / (next[axis] - here[axis]);
            let mut cut = [here[0] + (next[0] - here[0]) * t, here[1] + (next[1] - here[1]) * t];
            cut[axis] = bound;
            kept.push(cut);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame() -> Frame {
        let view = View { x0: 0.0, y0: 0.0, x1: 2.0, y1: 1.0 };
        Frame::new(view, [10.0, 20.0], [200.0, 100.0])
    }

    #[test]
    fn y_points_up_and_corners_meet_corners() {
        let f = frame();
        assert_eq!(f.place([0.0, 1.0]), [0.0, 0.0]);
        assert_eq!(f.place([2.0, 0.0]), [200.0, 100.0]);
        assert_eq!(f.grid(f.place([1.0, 0.5])), [10_000, 5_000]);
    }

    // spec: G1
    #[test]
    fn views_of_extreme_coordinates_are_placed_on_the_page() {
        for (low, high) in [(-1.7e308, 1.7e308), (0.0, 1e-310), (1e9, 1e9 + 1.0)] {
            let view = View { x0: low, y0: low, x1: high, y1: high };
            let f = Frame::new(view, [0.0; 2], [100.0; 2]);
            for (p, place) in [([low, low], [0.0, 100.0]), ([high, high], [100.0, 0.0])] {
                assert_eq!(f.place(p), place, "{low:e}..{high:e}");
            }
        }
    }

    #[test]
    fn a_view_is_read_from_four_numbers_and_nothing_else() {
        assert_eq!("0,-1, 2.5 ,1e3".parse(), Ok(View { x0: 0.0, y0: -1.0, x1: 2.5, y1: 1e3 }));
        for bad in [
            "",
            "1,2,3",
            "1,2,3,4,5",
            "a,b,c,d",
            "0,0,0,1",
            "1,0,0,1",
            "0,0,nan,1",
            "0,0,inf,1",
            "0,0,5e-324,1",
        ] {
            let error = bad.parse::<View>().expect_err(bad);
            assert!(error.to_string().contains("x0,y0,x1,y1"), "{error}");
        }
    }

    #[test]
    fn the_view_of_a_mesh_ignores_what_cannot_be_drawn() {
        let mesh = MeshData {
            points: vec![
                [0.0, 0.0, 0.0],
                [1.0, 0.0, 0.0],
                [0.0, 2.0, 0.0],
                [f64::NAN; 3],
                [9.0, 9.0, 0.0],
            ],
            triangles: vec![[0, 1, 2], [0, 1, 3], [0, 1, u32::MAX]],
            ..MeshData::default()
        };
        assert_eq!(View::of(&mesh), Some(View { x0: 0.0, y0: 0.0, x1: 1.0, y1: 2.0 }));
        assert_eq!(View::of(&MeshData::default()), None);
    }

    #[test]
    fn a_flat_or_single_point_mesh_has_a_proper_view() {
        for points in [
            vec![[3.0, 4.0, 0.0]],
            vec![[0.0; 3], [1.0, 0.0, 0.0]],
            vec![[f64::MAX; 3]],
            vec![[0.0; 3]],
        ] {
            let mesh = MeshData { points, ..MeshData::default() };
            let view = View::of(&mesh).expect("points are finite");
            assert!(view.is_proper(), "{view}");
        }
    }

    #[test]
    fn clipping_keeps_what_is_inside_and_cuts_what_is_not() {
        let f = frame();
        let inside = [[1.0, 1.0], [5.0, 1.0], [1.0, 5.0]];
        assert_eq!(f.clip(&inside), inside);
        assert!(f.clip(&[[500.0, 0.0], [600.0, 0.0], [500.0, 50.0]]).is_empty());
        assert_eq!(f.clip(&[[-1e9, 50.0], [1e9, 50.0]]), [[-8.0, 50.0], [208.0, 50.0]]);
        let covering = f.clip(&[[-1e6, -1e6], [1e6, -1e6], [0.0, 1e6]]);
        assert!(covering.len() >= 4 && covering.iter().all(|&p| f.holds(p)), "{covering:?}");
    }
}
