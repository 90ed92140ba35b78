//! How sizes change with the distance from where the boundary is dense.

use crate::mesh::MeshData;

/// How much longer edges are far from the dense part of the boundary than there: the mean edge
/// length of the quarter of the triangles that lies farthest from the shortest quarter of the
/// boundary's edges, over the mean length of these. Distance is the number of edges crossed. About
/// 1 where everything is equally long, and for a mesh without triangles.
///
/// O(n log n).
#[must_use]
pub fn far_over_dense(mesh: &MeshData) -> f64 {
    let length = |[a, b]: [u32; 2]| {
        let (p, q) = (mesh.points[a as usize], mesh.points[b as usize]);
        libm::hypot(q[0] - p[0], q[1] - p[1])
    };
    let adjacency = Adjacency::of(&mesh.triangles);
    let mut border: Vec<(f64, usize)> =
        adjacency.boundary.iter().map(|&(edge, t)| (length(edge), t)).collect();
    border.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
    border.truncate(border.len().div_ceil(4));
    if border.is_empty() {
        return 1.0;
    }
    let dense = border.iter().map(|(length, _)| length).sum::<f64>() / border.len() as f64;
    let far = adjacency.farthest_quarter(border.iter().map(|&(_, t)| t));
    let inside = far.iter().flat_map(|&t| sides(mesh.triangles[t]));
    inside.map(length).sum::<f64>() / (3 * far.len()) as f64 / dense
}

fn sides([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Who lies beside whom.
struct Adjacency {
    /// The triangles across each side of a triangle, those there are.
    beside: Vec<Vec<usize>>,
    /// Sides of one triangle only, with that triangle.
    boundary: Vec<([u32; 2], usize)>,
}

impl Adjacency {
    fn of(triangles: &[[u32; 3]]) -> Self {
        let each = triangles
            .iter()
            .enumerate()
            .flat_map(|(t, &corners)| sides(corners).map(|[a, b]| ([a.min(b), a.max(b)], t)));
        let mut each: Vec<([u32; 2], usize)> = each.collect();
        each.sort_unstable();
        let mut all = Self { beside: vec![Vec::new(); triangles.len()], boundary: Vec::new() };
        for pair in each.chunk_by(|x, y| x.0 == y.0) {
            match *pair {
                [side] => all.boundary.push(side),
                [(_, s), (_, t), ..] => {
                    all.beside[s].push(t);
                    all.beside[t].push(s);
                }
                [] => {}
            }
        }
        all
    }

    /// The quarter of the triangles that lies farthest from some, at least one; ties by the order
    /// in which they are reached.
    fn farthest_quarter(&self, from: impl Iterator<Item = usize>) -> Vec<usize> {
        let mut seen = vec![false; self.beside.len()];
        let mut order: Vec<usize> =
            from.filter(|&t| !std::mem::replace(&mut seen[t], true)).collect();
        let mut next = 0;
        while next < order.len() {
            for &t in &self.beside[order[next]] {
                if !std::mem::replace(&mut seen[t], true) {
                    order.push(t);
                }
            }
            next += 1;
        }
        let count = order.len().div_ceil(4);
        order.split_off(order.len() - count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A strip of unit squares cut in two triangles each, `n` squares long and high.
    fn grid(n: u32) -> MeshData {
        let at = |i: u32, j: u32| j * (n + 1) + i;
        let points = (0..=n).flat_map(|j| (0..=n).map(move |i| [f64::from(i), f64::from(j), 0.0]));
        let cells = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
        let triangles = cells.flat_map(|(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        });
        MeshData { points: points.collect(), triangles: triangles.collect(), ..MeshData::default() }
    }

    #[test]
    fn the_farthest_quarter_lies_at_the_other_end() {
        let mesh = grid(6);
        let far = Adjacency::of(&mesh.triangles).farthest_quarter([0, 0, 1].into_iter());
        assert_eq!(far.len(), 18);
        for t in far {
            // Two edges are crossed from a square to the one diagonally above, too.
            let reach = mesh.triangles[t].iter().flat_map(|&v| mesh.points[v as usize]);
            assert_eq!(reach.fold(0.0, f64::max), 6.0, "{t} is not at the far sides");
        }
    }

    // spec: K32
    #[test]
    fn a_uniform_mesh_is_as_large_everywhere_and_a_stretched_one_is_not() {
        // Two sides of length 1, one of the square root of 2.
        let even = far_over_dense(&grid(6));
        assert!((even - (2.0 + 2.0_f64.sqrt()) / 3.0).abs() < 1e-12, "{even}");
        let mut stretched = grid(6);
        for p in &mut stretched.points {
            // Columns of width 1, 2, 4, ...
            p[0] = libm::exp2(p[0]) - 1.0;
        }
        assert!(far_over_dense(&stretched) > 8.0, "{}", far_over_dense(&stretched));
        assert_eq!(far_over_dense(&MeshData::default()), 1.0);
    }
}
