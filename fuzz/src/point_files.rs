//! Target: the readers of points. Any bytes give finite points, a domain, or an error with its rule;
//! what was read is triangulated and tessellated without a panic.

use trigrade::format::points::{PointFile, PointForm, read_points};
use trigrade::triangulate::{Options, triangulate_points};
use trigrade::voronoi::{ClipBox, voronoi};

/// More points would only be slow: the triangulation is not what this target is about.
const POINTS_MAX: usize = 200;

/// One input: the first byte chooses the form, the rest is the file.
pub fn run(bytes: &[u8]) {
    let Some((&choice, file)) = bytes.split_first() else { return };
    let forms = [PointForm::Node, PointForm::Csv, PointForm::Xyz, PointForm::Npy, PointForm::Json];
    let form = forms[usize::from(choice) % forms.len()];
    let set = match read_points(file, form, None) {
        Ok(PointFile::Points(set)) => set,
        Ok(PointFile::Domain(_)) => return,
        Err(error) => {
            assert!(!error.to_string().is_empty() && !error.rule().is_empty());
            return;
        }
    };
    assert!(set.points.len() <= file.len(), "{} points", set.points.len());
    assert!(set.points.iter().all(|point| point.is_finite()), "{:?}", set.points);
    if set.points.len() > POINTS_MAX {
        return;
    }
    let result = triangulate_points(&set.points, Options::default());
    let result = result.expect("finite points have a triangulation");
    assert_eq!(result.map.len(), set.points.len());
    let cells = voronoi(&set.points, false).expect("finite points have cells");
    if let Some(bounds) = ClipBox::around(&set.points) {
        let clipped = cells.clip_to_box(bounds);
        assert!(clipped.points.iter().all(|point| point.is_finite()));
    }
}
