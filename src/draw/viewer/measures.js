// Quality measures of triangles, and how their values become shades.

/** Side vectors of a triangle, side i opposite to corner i, over `size`, their largest coordinate:
 *  scaled so, squares neither overflow nor underflow. One object for all, as there are millions. */
const scaled = { size: 0, side: new Float64Array(9), length: new Float64Array(3), cross: 0, twice: 0 };

function scale(t) {
  const s = scaled.side;
  let size = 0;
  for (let i = 0; i < 3; i++) {
    const from = triangles[3 * t + (i + 1) % 3], to = triangles[3 * t + (i + 2) % 3];
    for (let k = 0; k < 3; k++) {
      const d = points.coordinate(to, k) - points.coordinate(from, k);
      s[3 * i + k] = d;
      if (!(Math.abs(d) <= size)) size = Math.abs(d);
    }
  }
  scaled.size = size;
  if (size > 0) for (let i = 0; i < 9; i++) s[i] /= size;
  for (let i = 0; i < 3; i++) scaled.length[i] = Math.sqrt(dot(i, i));
  const x = s[4] * s[8] - s[5] * s[7], y = s[5] * s[6] - s[3] * s[8], z = s[3] * s[7] - s[4] * s[6];
  scaled.cross = z;
  scaled.twice = Math.sqrt(x * x + y * y + z * z);
}
const dot = (i, j) => {
  const s = scaled.side;
  return s[3 * i] * s[3 * j] + s[3 * i + 1] * s[3 * j + 1] + s[3 * i + 2] * s[3 * j + 2];
};

// Measures of the triangle scaled last.
const ratio = () => {
  const [a, b, c] = scaled.length;
  return scaled.size === 0 ? Infinity : (a * b * c * (a + b + c)) / (4 * scaled.twice * scaled.twice);
};
const area = () => ((!spatial && scaled.cross < 0 ? -1 : 1) * scaled.twice * scaled.size * scaled.size) / 2;
const angle = (i) => (scaled.size > 0 ? (Math.atan2(scaled.twice, -dot((i + 1) % 3, (i + 2) % 3)) * 180) / Math.PI : NaN);
const length = (i) => scaled.length[i] * scaled.size;

const perimeter = () => length(0) + length(1) + length(2);

/** Largest ratio of a size to that of a neighbour, or its inverse. */
function neighbourRatios(size) {
  const out = new Float64Array(count).fill(NaN);
  const first = new Int32Array(edges.other.length).fill(-1);
  const meet = (s, t) => {
    const r = size[s] / size[t], worst = Math.abs(r < 1 && r > -1 ? 1 / r : r);
    for (const x of [s, t]) if (!(out[x] >= worst)) out[x] = worst;
  };
  for (let i = 0; i < 3 * count; i++) {
    const e = edges.side[i], t = (i / 3) | 0;
    if (e === 0xffffffff) continue;
    if (first[e] < 0) first[e] = t;
    else meet(first[e], t);
  }
  return out;
}

const shaped = (of) => () => {
  const out = new Float64Array(count);
  for (let t = 0; t < count; t++) {
    if (drawable[t]) scale(t);
    out[t] = drawable[t] ? of() : NaN;
  }
  return out;
};

const lengths = () => [length(0), length(1), length(2)];
const angles = () => [angle(0), angle(1), angle(2)];
/** R = abc / (4 A) with lengths scaled as the area is. */
const circumradius = () => (scaled.length[0] * scaled.length[1] * scaled.length[2]) / (2 * scaled.twice);
const inradius = () => scaled.twice / (scaled.length[0] + scaled.length[1] + scaled.length[2]);
const spread = () => {
  const of = valuesOf("area"), least = of.reduce((m, a) => (a < m ? a : m), Infinity);
  return of.map((a) => a / least);
};

/** Every measure, by the names and formulas of the checker: better is "low", "high" or ""
 *  (neither); log ones are binned by logarithm. */
const measures = [
  { id: "radius_ratio", name: "R/(2r)", better: "low", range: [1, 1.6], make: shaped(ratio) },
  { id: "min_angle", name: "smallest angle [°]", better: "high", range: [0, 60], make: shaped(() => Math.min(...angles())) },
  { id: "max_angle", name: "largest angle [°]", better: "low", range: [60, 180], make: shaped(() => Math.max(...angles())) },
  { id: "edge_ratio", name: "longest / shortest edge", better: "low", range: [1, 3], make: shaped(() => Math.max(...lengths()) / Math.min(...lengths())) },
  { id: "neighbour_area_ratio", name: "area ratio to neighbours", better: "low", range: [1, 4], make: () => neighbourRatios(valuesOf("area")) },
  { id: "edge_length_gradation", name: "edge length ratio to neighbours", better: "low", range: [1, 2], make: () => neighbourRatios(valuesOf("edge_length")) },
  { id: "shape", name: "shape, 4√3 A / Σ l²", better: "high", range: [0, 1], make: shaped(() => (2 * Math.sqrt(3) * scaled.twice) / (dot(0, 0) + dot(1, 1) + dot(2, 2))) },
  { id: "scaled_jacobian", name: "scaled Jacobian", better: "high", range: [0, 1], make: shaped(() => (2 / Math.sqrt(3)) * scaled.twice * Math.min(...scaled.length) / (scaled.length[0] * scaled.length[1] * scaled.length[2])) },
  { id: "equiangle_skew", name: "equiangle skew", better: "low", range: [0, 1], make: shaped(() => Math.max((Math.max(...angles()) - 60) / 120, (60 - Math.min(...angles())) / 60)) },
  { id: "radius_edge_ratio", name: "R / shortest edge", better: "low", range: [0.5, 1.5], make: shaped(() => circumradius() / Math.min(...scaled.length)) },
  { id: "verdict_aspect_ratio", name: "longest edge / (2√3 r)", better: "low", range: [1, 2], make: shaped(() => Math.max(...scaled.length) / (2 * Math.sqrt(3) * inradius())) },
  { id: "area", name: "area", better: "", log: true, make: shaped(area) },
  { id: "area_spread", name: "area / smallest area", better: "", log: true, make: spread },
  { id: "edge_length", name: "mean edge length", better: "", log: true, make: shaped(() => perimeter() / 3) },
  { id: "order", name: "order in the file", better: "", make: () => Float64Array.from({ length: count }, (_, t) => t) },
];
// Layers that the file carries come after the measure that is shown first.
meta.layers.forEach((layer, i) => measures.splice(1 + i, 0, {
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
  const log = measure.log && low > 0, along = log ? Math.log : (x) => x;
  const [from, to] = [along(low), along(high)];
  const fraction = (v) => {
    if (!(to > from)) return v > high ? 1 : 0;
    return Math.min(1, Math.max(0, v <= 0 && log ? 0 : (along(v) - from) / (to - from)));
  };
  const bars = new Uint32Array(70);
  for (const v of values) bars[Math.min(69, Math.floor(fraction(v) * 70))]++;
  const at = (t) => (log ? Math.exp(from + t * (to - from)) : low + t * (high - low));
  return {
    low, high, own, mean, n, fraction, bars, at,
    percentile: values[Math.max(0, Math.ceil(0.99 * n) - 1)], worst: values[n - 1],
    // By more than rounding: R/(2r) of an equilateral triangle is 1, or a little less.
    below: values.some((v) => v < low - 1e-9 * (high - low)), above: values.some((v) => v > high + 1e-9 * (high - low)),
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

/** A number for people, to so many digits. */
function short(x, digits = 5) {
  if (x === undefined || Number.isNaN(x)) return "no value";
  if (!Number.isFinite(x)) return x > 0 ? "∞" : "-∞";
  const size = Math.abs(x);
  if (x === 0 || (size >= 1e-3 && size < 1e6)) return String(Number(x.toPrecision(digits)));
  return x.toExponential(digits - 1).replace(/\.?0*e\+?/, "e");
}
