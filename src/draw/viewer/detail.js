// A coarser mesh for the time that a large one turns: its outline and colours, not its triangles.

/** Triangles of the coarser mesh, about. */
const COARSE = 24000;

/**
 * Corners are drawn together in the cells of a grid, to the first one there; triangles whose corners
 * lie in three cells stay (Rossignac and Borrel 1993). Gives the triangles kept, three points for
 * each, and the points used.
 */
function coarser() {
  const n = Math.round(Math.sqrt(COARSE / 12)), first = new Int32Array(n * n * n).fill(-1);
  const cell = (u) => Math.min(n - 1, Math.max(0, Math.floor(((u + 1) / 2) * n)));
  const of = new Uint32Array(points.n), used = [];
  for (let v = 0; v < points.n; v++) {
    const [x, y, z] = unitOf(points, v);
    if (!Number.isFinite(x + y + z)) continue;
    const k = (cell(x) * n + cell(y)) * n + cell(z);
    if (first[k] < 0) { first[k] = v; used.push(v); }
    of[v] = first[k];
  }
  const kept = [], corners = [];
  for (let t = 0; t < count; t++) {
    if (!drawable[t]) continue;
    const [a, b, c] = [of[triangles[3 * t]], of[triangles[3 * t + 1]], of[triangles[3 * t + 2]]];
    if (a === b || b === c || c === a) continue;
    kept.push(t);
    corners.push(a, b, c);
  }
  return { kept, corners, used };
}

let coarseMesh = null;
/** The coarser mesh, made when first wanted; null where it would be no coarser. */
function coarse() {
  if (count < 2 * COARSE) return null;
  if (!coarseMesh) coarseMesh = coarser();
  return coarseMesh;
}
