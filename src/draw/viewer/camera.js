// Where the eye is: a centre in mesh units, pixels a unit, and a rotation for meshes in space.

const camera = { centre: [0, 0, 0], zoom: 1, rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1], width: 1, height: 1 };

const rotate = (v) => {
  const r = camera.rotation;
  return [0, 3, 6].map((i) => r[i] * v[0] + r[i + 1] * v[1] + r[i + 2] * v[2]);
};
const rotateBack = (v) => {
  const r = camera.rotation;
  return [0, 1, 2].map((i) => r[i] * v[0] + r[i + 3] * v[1] + r[i + 6] * v[2]);
};

/** Pixels of a place in mesh units, and its depth (larger is nearer). */
function project(u) {
  const v = rotate([u[0] - camera.centre[0], u[1] - camera.centre[1], u[2] - camera.centre[2]]);
  return [camera.width / 2 + v[0] * camera.zoom, camera.height / 2 - v[1] * camera.zoom, v[2]];
}
const unitOf = (p, v) => [p.unit[3 * v], p.unit[3 * v + 1], p.unit[3 * v + 2]];
const projectPoint = (v) => project(unitOf(points, v));

/** The place in mesh units under a pixel, in the plane of the centre. */
function unproject(x, y) {
  const v = rotateBack([(x - camera.width / 2) / camera.zoom, (camera.height / 2 - y) / camera.zoom, 0]);
  return v.map((a, k) => a + camera.centre[k]);
}

function pan(dx, dy) {
  const v = rotateBack([-dx / camera.zoom, dy / camera.zoom, 0]);
  camera.centre = camera.centre.map((c, k) => c + v[k]);
}

/** Zooms by a factor with the place under (x, y) kept where it is. */
function zoomAt(x, y, factor) {
  const zoom = Math.min(1e15, Math.max(fitZoom() / 50, camera.zoom * factor));
  const f = zoom / camera.zoom;
  pan((camera.width / 2 - x) * (f - 1) / f, (camera.height / 2 - y) * (f - 1) / f);
  camera.zoom = zoom;
}

/** Turns the mesh as if a ball under the pointer rolled. */
function orbit(dx, dy) {
  const turn = (i, j, angle) => {
    const r = camera.rotation, c = Math.cos(angle), s = Math.sin(angle);
    for (let k = 0; k < 3; k++) {
      const a = r[3 * i + k], b = r[3 * j + k];
      r[3 * i + k] = c * a - s * b;
      r[3 * j + k] = s * a + c * b;
    }
  };
  turn(2, 0, dx * 0.008);
  turn(2, 1, -dy * 0.008);
}

/** Turns the mesh so that a triangle seen from behind or edge-on faces the eye. */
function face([a, b, c]) {
  const u = b.map((x, k) => x - a[k]), v = c.map((x, k) => x - a[k]);
  const cross = (p, q) => [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
  const unit = (p) => p.map((x) => x / Math.hypot(...p));
  const n = unit(cross(u, v));
  if (!n.every(Number.isFinite) || rotate(n)[2] > 0.4) return;
  // The mesh's z axis stays upright, unless the triangle looks along it.
  const right = unit(cross(Math.abs(n[2]) < 0.98 ? [0, 0, 1] : [0, 1, 0], n));
  camera.rotation = [...right, ...cross(n, right), ...n];
}

/** Half extents of the mesh in its unit, as seen from the front. */
function halfExtents() {
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  for (let v = 0; v < points.n; v++)
    for (let k = 0; k < 2; k++) {
      const x = points.unit[3 * v + k];
      if (x < low[k]) low[k] = x;
      if (x > high[k]) high[k] = x;
    }
  return low.map((l, k) => (high[k] > l ? (high[k] - l) / 2 : 0.02));
}
const extents = halfExtents();

/** Largest distance of a point from the centre, in the mesh's unit: it turns within that. */
function reach() {
  let most = 0;
  for (let v = 0; v < points.n; v++) {
    const distance = Math.hypot(...unitOf(points, v));
    if (distance > most && Number.isFinite(distance)) most = distance;
  }
  return most || 1;
}
const radius = spatial ? reach() : 1;

function fitZoom() {
  const margin = 0.92;
  if (spatial) return (margin * Math.min(camera.width, camera.height)) / 2 / radius;
  return margin * Math.min(camera.width / 2 / extents[0], camera.height / 2 / extents[1]);
}

function fit() {
  camera.centre = [0, 0, 0];
  camera.zoom = fitZoom();
  if (spatial) {
    camera.rotation = [1, 0, 0, 0, 1, 0, 0, 0, 1];
    orbit(-70, -110);
  }
}

/** Shows the box around places (mesh units), with room around it. */
function show(places, room) {
  const finite = places.filter((u) => u.every(Number.isFinite));
  if (!finite.length) return;
  const low = [0, 1, 2].map((k) => Math.min(...finite.map((u) => u[k])));
  const high = [0, 1, 2].map((k) => Math.max(...finite.map((u) => u[k])));
  camera.centre = low.map((l, k) => (l + high[k]) / 2);
  const size = Math.max(...low.map((l, k) => high[k] - l));
  const least = Math.min(camera.width, camera.height);
  camera.zoom = size > 0 ? Math.min(1e15, least / size / room) : Math.max(camera.zoom, fitZoom() * 8);
}
