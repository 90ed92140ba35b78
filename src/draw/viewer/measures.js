// Quality measures of triangles, and how their values become shades.

/** Sides (opposite to the corners), area and angles of a triangle, in the unit of the file. */
function shapeOf(t) {
  const p = [0, 1, 2].map((c) => [0, 1, 2].map((k) => points.coordinate(triangles[3 * t + c], k)));
  const side = (a, b) => [0, 1, 2].map((k) => p[b][k] - p[a][k]);
  const vectors = [side(1, 2), side(2, 0), side(0, 1)];
  let size = 0;
  for (const v of vectors) for (const x of v) size = Math.max(size, Math.abs(x));
  if (!(size > 0)) return { sides: [0, 0, 0], area: 0, ratio: size === 0 ? Infinity : NaN, angles: [NaN, NaN, NaN], size };
  // Scaled by the largest difference, so that squares neither overflow nor underflow.
  const [a, b, c] = vectors.map((v) => v.map((x) => x / size));
  const norm = (v) => Math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  const dot = (u, v) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  const cross = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
  const twice = norm(cross), l = [a, b, c].map(norm);
  const angle = (u, v) => (Math.atan2(twice, -dot(u, v)) * 180) / Math.PI;
  const sign = !spatial && cross[2] < 0 ? -1 : 1;
  return {
    sides: l.map((x) => x * size), size,
    area: (sign * twice * size * size) / 2,
    ratio: (l[0] * l[1] * l[2] * (l[0] + l[1] + l[2])) / (4 * twice * twice),
    angles: [angle(b, c), angle(c, a), angle(a, b)],
  };
}

/** Largest ratio of the area to that of a neighbour, or its inverse. */
function neighbourRatios() {
  const area = valuesOf("area"), out = new Float64Array(count).fill(NaN);
  const first = new Int32Array(edges.other.length).fill(-1);
  const meet = (s, t, e) => {
    const r = area[s] / area[t], worst = Math.abs(r < 1 && r > -1 ? 1 / r : r);
    for (const x of [s, t]) if (!(out[x] >= worst)) out[x] = worst;
    return e;
  };
  for (let i = 0; i < 3 * count; i++) {
    const e = edges.side[i], t = (i / 3) | 0;
    if (e === 0xffffffff) continue;
    if (first[e] < 0) first[e] = t;
    else meet(first[e], t, e);
  }
  return out;
}

const shaped = (of) => () => {
  const out = new Float64Array(count);
  for (let t = 0; t < count; t++) out[t] = drawable[t] ? of(shapeOf(t)) : NaN;
  return out;
};

/** Every measure: better is "low", "high" or "" (neither); log ones are binned by logarithm. */
const measures = [
  { id: "radius_ratio", name: "R/(2r)", better: "low", range: [1, 1.6], make: shaped((s) => s.ratio) },
  { id: "min_angle", name: "smallest angle [°]", better: "high", range: [0, 60], make: shaped((s) => Math.min(...s.angles)) },
  { id: "max_angle", name: "largest angle [°]", better: "low", range: [60, 180], make: shaped((s) => Math.max(...s.angles)) },
  { id: "edge_ratio", name: "longest / shortest edge", better: "low", range: [1, 3], make: shaped((s) => Math.max(...s.sides) / Math.min(...s.sides)) },
  { id: "area", name: "area", better: "", log: true, make: shaped((s) => s.area) },
  { id: "area_ratio", name: "area ratio to neighbours", better: "low", range: [1, 4], make: neighbourRatios },
  { id: "edge_length", name: "mean edge length", better: "", log: true, make: shaped((s) => (s.sides[0] + s.sides[1] + s.sides[2]) / 3) },
  { id: "order", name: "order in the file", better: "", make: () => Float64Array.from({ length: count }, (_, t) => t) },
];
meta.layers.forEach((layer, i) => measures.splice(i, 0, {
  id: `layer-${i}`, name: layer.name, better: layer.better, range: layer.range,
  make: () => doubles(`layer-${i}`),
}));

const cache = new Map();
function valuesOf(id) {
  if (!cache.has(id)) cache.set(id, measures.find((m) => m.id === id).make());
  return cache.get(id);
}

/** Range, histogram and figures of a measure. */
function summarise(measure, range) {
  const values = valuesOf(measure.id).filter((v) => !Number.isNaN(v));
  // "Better" first; without a better end the small ones are.
  if (measure.better === "high") values.sort().reverse();
  else values.sort();
  const n = values.length;
  let mean = 0;
  for (const v of values) mean += v / n;
  const finite = values.filter((v) => Number.isFinite(v) && (!measure.log || v > 0));
  const ends = [finite[0], finite[finite.length - 1]].sort((a, b) => a - b);
  const own = measure.range || (finite.length ? ends : [0, 1]);
  const [low, high] = range || own;
  const scale = measure.log && low > 0 ? Math.log : (x) => x;
  const [from, to] = [scale(low), scale(high)];
  const fraction = (v) => {
    if (!(to > from)) return v > high ? 1 : 0;
    return Math.min(1, Math.max(0, v <= 0 && scale === Math.log ? 0 : (scale(v) - from) / (to - from)));
  };
  const bars = new Uint32Array(70);
  for (const v of values) bars[Math.min(69, Math.floor(fraction(v) * 70))]++;
  const at = (t) => (scale === Math.log ? Math.exp(from + t * (to - from)) : low + t * (high - low));
  return {
    low, high, own, mean, n, fraction, bars, at,
    percentile: values[Math.max(0, Math.ceil(0.99 * n) - 1)], worst: values[n - 1],
    below: values.some((v) => v < low), above: values.some((v) => v > high),
  };
}

/** Shade 0 (good, light) to 254 (bad, dark) of every triangle; 255 is "no value". */
function shadesOf(measure, summary) {
  const values = valuesOf(measure.id), out = new Uint8Array(count);
  for (let t = 0; t < count; t++) {
    const v = values[t];
    if (Number.isNaN(v)) { out[t] = 255; continue; }
    const f = summary.fraction(v);
    out[t] = Math.round(254 * (measure.better === "high" ? 1 - f : f));
  }
  return out;
}

/** 255 colours of a palette as [r, g, b], and grey for "no value". */
function paletteColours(stops) {
  const out = [];
  for (let i = 0; i < 255; i++) {
    const at = (i / 254) * (stops.length - 1), low = Math.min(stops.length - 2, Math.floor(at));
    out.push([16, 8, 0].map((s) => {
      const a = (stops[low] >> s) & 255, b = (stops[low + 1] >> s) & 255;
      return Math.round(a + (b - a) * (at - low));
    }));
  }
  out.push([184, 184, 184]);
  return out;
}

/** A number for people, about five digits. */
function short(x) {
  if (x === undefined || Number.isNaN(x)) return "no value";
  if (!Number.isFinite(x)) return x > 0 ? "∞" : "-∞";
  const size = Math.abs(x);
  if (x !== 0 && (size < 1e-3 || size >= 1e6)) return x.toExponential(3);
  return String(Number(x.toPrecision(5)));
}
