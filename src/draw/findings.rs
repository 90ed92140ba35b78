//! Findings of the checker as highlights of a picture.

use super::Highlight;
use crate::check::{Finding, Report};

/// What a picture points at so that a reader sees every listed finding that is not allowed; the
/// labels name the rule and say what is wrong.
///
/// ```
/// use trigrade::check::{CheckOptions, check};
/// use trigrade::draw::{self, Options, Panel};
/// use trigrade::mesh::MeshData;
///
/// let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let mesh = MeshData { points, triangles: vec![[0, 1, 2], [0, 1, 3]], ..MeshData::default() };
/// let highlights = draw::highlights(&check(&mesh, None, &CheckOptions::new()));
/// let mut panel = Panel::new(&mesh, "two triangles that overlap");
/// panel.highlights = &highlights;
/// let svg = draw::svg(&[panel], &Options::default())?;
/// assert!(svg.contains("M15: "));
/// # Ok::<(), draw::DrawError>(())
/// ```
#[must_use]
pub fn highlights(report: &Report) -> Vec<Highlight> {
    report.findings.iter().filter(|finding| !finding.allowed).map(highlight).collect()
}

fn highlight(finding: &Finding) -> Highlight {
    let triangles: Vec<u32> = finding.triangles.iter().map(|t| t.index).collect();
    Highlight {
        label: format!("{}: {}", finding.id, finding.message),
        triangles,
        edges: Vec::new(),
        vertices: finding.vertices.iter().map(|v| v.index).collect(),
        lines: finding.domain.iter().map(|d| d.coordinates.clone()).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::{CheckOptions, Id, check};
    use crate::mesh::MeshData;

    #[test]
    fn findings_point_at_their_triangles_and_allowed_ones_at_nothing() {
        let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [5.0, 5.0, 0.0]];
        let mesh = MeshData { points, triangles: vec![[0, 1, 2]], ..MeshData::default() };
        let all = highlights(&check(&mesh, None, &CheckOptions::new()));
        assert_eq!(all.len(), 1, "{all:?}");
        assert!(all[0].label.starts_with("M6: ") && all[0].vertices == [3], "{all:?}");
        let allowed = CheckOptions::new().allow(Id::UnusedVertex);
        assert!(highlights(&check(&mesh, None, &allowed)).is_empty());
    }
}
