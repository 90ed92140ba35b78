// The mesh as the file carries it: typed arrays from base64, and what follows from them.

const meta = JSON.parse(document.getElementById("meta").textContent);

/** Bytes of a data element; absent ones are empty. Decoded in pieces to bound the memory. */
function bytes(id) {
  const element = document.getElementById(`data-${id}`);
  if (!element) return new Uint8Array(0);
  const text = element.textContent.trim();
  const pad = text.endsWith("==") ? 2 : text.endsWith("=") ? 1 : 0;
  const out = new Uint8Array((text.length / 4) * 3 - pad);
  const step = 1 << 22;
  for (let from = 0, at = 0; from < text.length; from += step) {
    const piece = atob(text.slice(from, from + step));
    for (let i = 0; i < piece.length; i++) out[at++] = piece.charCodeAt(i);
  }
  element.remove();
  return out;
}
const doubles = (id) => new Float64Array(bytes(id).buffer);
const indices = (id) => new Uint32Array(bytes(id).buffer);

/** Points as the file has them, and centred on the mesh with its larger half extent as unit. */
function readPoints(id, dim, frame) {
  const raw = doubles(id);
  const n = raw.length / dim;
  const coordinate = (i, k) => (k < dim ? raw[i * dim + k] : 0);
  if (!frame) frame = frameOf(n, coordinate);
  const unit = new Float64Array(3 * n);
  for (let i = 0; i < n; i++)
    for (let k = 0; k < 3; k++) unit[3 * i + k] = toUnit(frame, coordinate(i, k), k);
  return { n, coordinate, unit, frame };
}

// Halves throughout: the difference of two finite doubles may overflow.
const toUnit = (frame, x, k) => (x / 2 - frame.centre[k] / 2) / frame.half * 2;
const fromUnit = (frame, u, k) => frame.centre[k] + u * frame.half;

function frameOf(n, coordinate) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < n; i++)
    for (let k = 0; k < 3; k++) {
      const x = coordinate(i, k);
      if (!Number.isFinite(x)) continue;
      if (x < low[k]) low[k] = x;
      if (x > high[k]) high[k] = x;
    }
  const spans = low.map((l, k) => (high[k] >= l ? high[k] / 2 - l / 2 : 0));
  const centre = low.map((l, k) => (high[k] >= l ? l / 2 + high[k] / 2 : 0));
  return { centre, half: Math.max(...spans) || 1 };
}

const points = readPoints("points", meta.dimension);
const triangles = indices("triangles");
const count = triangles.length / 3;
const numbers = doubles("numbers");
const spatial = meta.dimension === 3;

/** 1 for triangles whose corners exist and are finite. */
const drawable = new Uint8Array(count);
for (let t = 0; t < count; t++) {
  let good = 1;
  for (let c = 3 * t; c < 3 * t + 3; c++) {
    const v = triangles[c];
    if (v >= points.n) good = 0;
    else for (let k = 0; k < 3; k++) if (!Number.isFinite(points.unit[3 * v + k])) good = 0;
  }
  drawable[t] = good;
}

/**
 * The undirected edges of triangles: pairs of points, how many triangles have each, and for each
 * side of a triangle (3 t + i: from corner i to the next) the number of its edge.
 */
function edgesOf(list, m, n, use) {
  const start = new Uint32Array(n + 1);
  const each = (visit) => {
    for (let t = 0; t < m; t++) {
      if (!use(t)) continue;
      for (let i = 0; i < 3; i++) {
        const a = list[3 * t + i], b = list[3 * t + (i + 1) % 3];
        visit(Math.min(a, b), Math.max(a, b), 3 * t + i);
      }
    }
  };
  each((a) => start[a + 1]++);
  for (let v = 0; v < n; v++) start[v + 1] += start[v];
  const other = new Uint32Array(start[n]), uses = new Uint8Array(start[n]);
  const filled = new Uint32Array(n);
  const side = new Uint32Array(3 * m).fill(0xffffffff);
  each((a, b, s) => {
    let k = start[a];
    const end = start[a] + filled[a];
    while (k < end && other[k] !== b) k++;
    if (k === end) { other[k] = b; filled[a]++; }
    if (uses[k] < 255) uses[k]++;
    side[s] = k;
  });
  return { start, other, uses, filled, side };
}

const edges = edgesOf(triangles, count, points.n, (t) => drawable[t]);

/** Pairs of the edges that `keep(uses)` wants, flat. */
function pairs(table, n, keep) {
  const out = [];
  for (let a = 0; a < n; a++)
    for (let k = table.start[a]; k < table.start[a] + table.filled[a]; k++)
      if (keep(table.uses[k])) out.push(a, table.other[k]);
  return out;
}

const boundaryEdges = pairs(edges, points.n, (uses) => uses === 1);

function constraintEdges() {
  const marked = indices("edges"), out = [];
  const find = (a, b) => {
    for (let k = edges.start[a]; k < edges.start[a] + edges.filled[a]; k++)
      if (edges.other[k] === b) return edges.uses[k];
    return 0;
  };
  for (let i = 0; i < marked.length; i += 2) {
    const a = Math.min(marked[i], marked[i + 1]), b = Math.max(marked[i], marked[i + 1]);
    if (b < points.n && find(a, b) !== 1) out.push(a, b);
  }
  return out;
}
const constraints = constraintEdges();

/** The background mesh, or null. */
function readBackground() {
  if (!meta.background) return null;
  const p = readPoints("background-points", meta.background.dimension, points.frame);
  const list = indices("background-triangles");
  const m = list.length / 3;
  const use = (t) => list[3 * t] < p.n && list[3 * t + 1] < p.n && list[3 * t + 2] < p.n;
  return { points: p, edges: pairs(edgesOf(list, m, p.n, use), p.n, () => true), spacing: doubles("spacing") };
}
const background = readBackground();
