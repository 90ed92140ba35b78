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
//! A domain in, a mesh out, and an answer to whether it is one:
//!
//! ```
//! use trigrade::Mesher;
//! use trigrade::check::check;
//! use trigrade::domain::naca::naca0012;
//! use trigrade::mesh::MeshData;
//!
//! let domain = naca0012();
//! let meshed = Mesher::new().growth(0.4).mesh(&domain)?;
//! let report = check(&MeshData::from(&meshed.mesh), Some(&domain), &Default::default());
//! assert!(report.passed());
//! # Ok::<(), trigrade::mesher::MeshError>(())
//! ```
//!
//! Meshes made by this library look like this:
//!
#![doc = include_str!("../docs/pictures/mesher.svg")]
//!
//! | to do | see |
//! |---|---|
//! | mesh a domain | [`Mesher`], [`mesher`] |
//! | check anybody's mesh | [`check`] |
//! | triangulate points | [`triangulate`], [`delaunay`], [`voronoi`] |
//! | mesh a surface | [`surface_mesher`], [`model`], [`remesh`](mod@remesh) |
//! | read and write files | [`mod@format`] |
//! | draw | [`draw`] |
//! | torture a mesher | [`torture`] |
//!
//! # Features
//!
//! | feature | what it brings |
//! |---|---|
//! | `cli` (default) | the program and what only it needs; without it the library stays small |
//! | `png` | PNG pictures, with a font built in |
//! | `arbitrary`, `proptest`, `quickcheck` | the boundaries of [`torture`] as values of these frameworks |
//!
//! None of them needs a C compiler, and the library without `cli` compiles for WebAssembly.
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
pub mod study;
pub mod torture;

#[cfg(feature = "cli")]
pub mod cli;

pub use mesher::Mesher;

/// The Rust code in the guide compiles and runs.
#[cfg(doctest)]
mod guide {
    #[doc = include_str!("../docs/guide/library.md")]
    struct Library;
    #[doc = include_str!("../docs/guide/torture.md")]
    struct Torture;
}
