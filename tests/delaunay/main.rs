//! The triangulation, the Delaunay engines and the background mesh.

mod background;
mod cdt;
mod clouds;
mod engines;
mod naive;
mod split;
mod triangulate;
mod voronoi;
