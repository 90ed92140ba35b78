//! trigrade generates graded triangulations and grades triangulations.
//!
//! ```text
//! file -> domain -> background -> size field -> front -> mesh -> file
//!         PSLG      CDT of the    spacing L     lays     plain
//!         loops     boundary      at a point    triangles arrays
//!
//! file(domain) + file(mesh) -> check -> report      no arrow from the line above but plain data
//! ```
//!
//! The guarantees, each with its strength and its test, are in `SPEC.md`.

#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod background;
pub mod delaunay;
pub mod front;
pub mod improve;
pub mod mesher;
pub mod predicates;
pub mod refine;
pub mod remesh;
pub mod size;
pub mod skin;
pub mod structured;
pub mod subdivide;
pub mod surface_mesher;
pub mod triangulate;
pub mod triangulation;
pub mod voronoi;

pub mod curve;
pub mod domain;
pub mod mesh;
pub mod metric;
pub mod model;
pub mod point;
pub mod surface;
pub mod vector;

pub mod check;
pub mod draw;
pub mod format;
pub mod torture;

#[cfg(feature = "cli")]
pub mod cli;

/// The Rust code in the guide compiles and runs.
#[cfg(doctest)]
mod guide {
    #[doc = include_str!("../docs/guide/library.md")]
    struct Library;
    #[doc = include_str!("../docs/guide/torture.md")]
    struct Torture;
}
