//! How far two triangulated surfaces are from each other, by samples.

use super::tree::{Corners, Tree};
use crate::vector::{Vector, scale};
use rayon::prelude::*;

/// Distances of a remeshed surface and the surface it was made of: at vertices and centres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// Largest distance of a new vertex from the input.
    pub vertices: f64,
    /// Largest distance of a new vertex or triangle's centre from the input.
    pub to_input: f64,
    /// Largest distance of an input vertex or triangle's centre from the output.
    pub from_input: f64,
}

/// Measures both ways, in O(n log n).
pub(super) fn measure(input: (&Tree, Corners<'_>), output: Corners<'_>) -> Deviation {
    let (tree, corners) = input;
    let new_tree = Tree::new(output);
    let vertices = farthest(output.points, tree, corners);
    let to_input = vertices.max(farthest(&centres(output), tree, corners));
    let from_input = farthest(corners.points, &new_tree, output).max(farthest(
        &centres(corners),
        &new_tree,
        output,
    ));
    Deviation { vertices, to_input, from_input }
}

fn centres(corners: Corners<'_>) -> Vec<Vector> {
    let centre = |t: u32| {
        let [a, b, c] = corners.of(t);
        scale(1.0 / 3.0, std::array::from_fn(|i| a[i] + b[i] + c[i]))
    };
    (0..corners.triangles.len() as u32).map(centre).collect()
}

fn farthest(points: &[Vector], tree: &Tree, corners: Corners<'_>) -> f64 {
    let away = |&p: &Vector| {
        tree.nearest(corners, p, None, |_| true).map_or(0.0, |nearest| nearest.distance_sq)
    };
    points.par_iter().map(away).reduce(|| 0.0, f64::max).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    // spec: U6
    #[test]
    fn a_tent_over_a_square_is_as_far_as_it_is_high() {
        let flat: Vec<Vector> =
            vec![[0.0; 3], [3.0, 0.0, 0.0], [3.0, 3.0, 0.0], [0.0, 3.0, 0.0], [1.5, 1.5, 0.0]];
        let mut tent = flat.clone();
        tent[4][2] = 0.25;
        let triangles = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
        let [flat, tent] = [&flat, &tent].map(|points| Corners { points, triangles: &triangles });
        let tree = Tree::new(flat);
        let found = measure((&tree, flat), tent);
        assert_eq!((found.vertices, found.to_input), (0.25, 0.25));
        assert!(found.from_input > 0.2 && found.from_input < 0.25, "{found:?}");
        let none = measure((&tree, flat), flat);
        assert_eq!(none, Deviation::default());
    }
}
