//! All engines give the same triangles.

use crate::clouds;
use crate::naive::finite_triangles;
use trigrade::delaunay::{fast_for_now, lawson_for_now};

#[test]
fn engines_agree_on_hard_clouds() {
    for n in [20, 100, 1000] {
        for (name, points) in clouds::all(n) {
            let fast = fast_for_now(&points, false);
            fast.verify_geometry(&points).expect(name);
            assert_eq!(
                finite_triangles(&lawson_for_now(&points)),
                finite_triangles(&fast),
                "{name}"
            );
        }
    }
}
