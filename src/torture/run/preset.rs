//! Meshers that are known by name: how they are called, what they read, how they are installed.

use super::running::Running;
use super::tool::Tool;
use crate::check::Id;
use crate::torture::export::BoundaryForm;
use std::path::Path;

/// A mesher known by name.
#[derive(Clone, Copy, Debug)]
pub struct Preset {
    /// Its name for `--preset`.
    pub name: &'static str,
    /// Command line with `{in}`, `{out}` and `{stem}`; `{self}` is this program.
    pub command: &'static str,
    /// What it reads.
    pub form: BoundaryForm,
    /// Its answer: an extension for `{out}`, or a path that starts with `{stem}`.
    pub answer: &'static str,
    /// Findings that its documentation announces.
    pub allow: &'static [Id],
    /// How to install it.
    pub install: &'static str,
}

/// Reads `.in2d`, meshes, writes `.vol`.
const NETGEN: &str = "python3 -c 'import sys; from netgen.geom2d import SplineGeometry; \
    SplineGeometry(sys.argv[1]).GenerateMesh(maxh=1e300, quad_dominated=False).Save(sys.argv[2])' {in} {out}";

/// All of them.
pub const PRESETS: [Preset; 6] = [
    Preset {
        name: "self",
        command: "{self} mesh {in} -o {out} --no-check --quiet --threads 1",
        form: BoundaryForm::Json,
        answer: "msh",
        allow: &[],
        install: "nothing to install: it is this program",
    },
    Preset {
        name: "gmsh",
        command: "gmsh -2 -bin -v 1 {in} -o {out}",
        form: BoundaryForm::Geo,
        answer: "msh",
        allow: &[Id::UnusedVertex],
        install: "`pip install gmsh`, or a package of your system, or https://gmsh.info",
    },
    Preset {
        name: "triangle",
        command: "triangle -pQ {in}",
        form: BoundaryForm::Poly,
        answer: "{stem}.1.ele",
        // Without -j its output keeps points of the input that no triangle uses.
        allow: &[Id::UnusedVertex],
        install: "`apt install triangle-bin`, or build https://www.cs.cmu.edu/~quake/triangle.html",
    },
    Preset {
        name: "netgen",
        command: NETGEN,
        form: BoundaryForm::In2d,
        answer: "vol",
        allow: &[Id::UnusedVertex],
        install: "`pip install netgen-mesher`",
    },
    Preset {
        name: "mmg2d",
        command: "mmg2d_O3 -v 0 -in {in} -out {out}",
        form: BoundaryForm::Medit,
        answer: "mesh",
        allow: &[Id::UnusedVertex],
        install: "`pip install mmgpy`, or a package of your system, or https://www.mmgtools.org",
    },
    Preset {
        name: "spade",
        command: "spade_mesher {in} {out}",
        form: BoundaryForm::Json,
        answer: "off",
        allow: &[Id::UnusedVertex],
        install: "in trigrade's source tree: `cargo build --release --example spade_mesher`, and \
                  put target/release/examples into PATH",
    },
];

impl Preset {
    /// The preset with a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        PRESETS.into_iter().find(|preset| preset.name == name)
    }

    /// The tool; `program` is the path of this program.
    #[must_use]
    pub fn tool(&self, program: &Path) -> Tool {
        let command = self.command.replace("{self}", &super::command::quoted(program));
        Tool {
            name: self.name.to_owned(),
            command,
            form: self.form,
            answer: self.answer.to_owned(),
            // Only our own words are known for sure.
            limit: (self.name == "self").then_some("above the limit of"),
            allow: self.allow.to_vec(),
            install: Some(self.install),
            running: Running::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_name_their_input_and_have_a_name_each() {
        for preset in PRESETS {
            assert!(preset.command.contains("{in}"), "{}", preset.name);
            let is_out = preset.command.contains("{out}") != preset.answer.contains("{stem}");
            assert!(is_out, "{}", preset.name);
            assert_eq!(Preset::named(preset.name).map(|p| p.command), Some(preset.command));
        }
        assert!(Preset::named("no such").is_none());
    }
}
