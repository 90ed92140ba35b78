// The page: what is shown, the side panel, the pointer and the keys.

const $ = (id) => document.getElementById(id);
let scene = $("scene");
const overlay = $("overlay"), pen = overlay.getContext("2d");
const state = { measure: measures[0], range: null, palette: meta.palette, frame: count, chosen: -1, finding: -1, playing: false, moving: 0 };
const wanted = new URLSearchParams(location.hash.slice(1));
let renderer = null, summary = null, dots = 1;

/** Milliseconds above which a drawing is too slow to follow the pointer. */
const SLOW = 60;

/** WebGL where there is one; where it draws in software, filling the pixels here is much faster. */
function chooseRenderer() {
  const webgl = wanted.get("renderer") !== "canvas" && webglRenderer(scene);
  if (!webgl) return canvasRenderer(scene);
  if (wanted.get("renderer") === "webgl2" || timeOfAll(webgl) < 5 * SLOW) return webgl;
  // A canvas that has been drawn to by WebGL cannot be drawn to otherwise.
  const other = scene.cloneNode();
  scene.replaceWith(other);
  scene = other;
  return canvasRenderer(scene);
}

/** How long a drawing takes, judged by that of a few triangles. */
function timeOfAll(candidate) {
  const few = Math.max(4096, count >> 6);
  if (few >= count) return 0;
  const time = (frame) => {
    const start = performance.now();
    candidate.draw({ dots, wire: true, frame, fresh: 0, lines: [], detail: null });
    candidate.finish();
    return performance.now() - start;
  };
  // The first drawing makes the shaders ready.
  const [, none, some] = [time(few), time(0), time(few)];
  return ((some - none) / few) * count;
}

// ---- drawing

/** Acts at the next frame, or soon where none comes: a browser without a screen may stop them. */
function atNextFrame(action) {
  let done = false;
  const once = () => { if (!done) { done = true; action(); } };
  requestAnimationFrame(once);
  setTimeout(once, 100);
}

let scheduled = false;
function redraw() {
  if (scheduled) return;
  scheduled = true;
  atNextFrame(() => { scheduled = false; paint(); });
}

function resize() {
  const box = scene.parentElement.getBoundingClientRect(), relative = camera.zoom / fitZoom();
  dots = Math.min(2, window.devicePixelRatio || 1);
  [camera.width, camera.height] = [Math.max(1, box.width), Math.max(1, box.height)];
  for (const c of [scene, overlay]) [c.width, c.height] = [Math.round(camera.width * dots), Math.round(camera.height * dots)];
  camera.zoom = relative * fitZoom();
  redraw();
}

function lineSets() {
  const whole = state.frame === count, sets = [];
  if (background && $("background").checked) sets.push({ name: "background", of: background.points, list: background.edges, width: 1, ink: [123, 63, 160] });
  if ($("constraints").checked && whole) sets.push({ name: "constraints", of: points, list: constraints, width: 1.6, ink: [194, 24, 91] });
  // While the front is laid its outline is the domain's, so that one sees what is to come.
  if ($("boundary").checked) sets.push({ name: "boundary", of: points, list: boundaryEdges, width: 1.8, ink: [0, 0, 0] });
  return sets;
}

/** What the last full drawing took, in ms, and the camera it was made with. */
let cost = 0, drawn = null;

/** Moves the last drawing along with the camera, where a new one would take too long. */
function carryAlong() {
  const slow = cost > SLOW && state.moving > 0 && drawn && !spatial;
  if (!slow) { scene.style.transform = ""; return false; }
  const f = camera.zoom / drawn.zoom, [x, y] = project(drawn.centre);
  scene.style.transform = `translate(${x - camera.width / 2}px, ${y - camera.height / 2}px) scale(${f})`;
  return true;
}

function drawScene() {
  const start = performance.now(), fresh = Math.max(1, Math.round(count / 150));
  const isSlow = cost > SLOW || wanted.get("detail") === "coarse";
  const detail = isSlow && state.moving > 0 && spatial && state.frame === count ? coarse() : null;
  document.body.dataset.drawn = detail ? detail.kept.length : state.frame;
  renderer.draw({ dots, wire: $("wire").checked, frame: state.frame, fresh, lines: lineSets(), detail });
  drawn = { centre: [...camera.centre], zoom: camera.zoom };
  if (state.moving || state.playing) return;
  renderer.finish();
  cost = performance.now() - start;
}

function paint() {
  if (!carryAlong()) drawScene();
  pen.setTransform(dots, 0, 0, dots, 0, 0);
  pen.clearRect(0, 0, camera.width, camera.height);
  if (background && $("spacing").checked) paintSpacing();
  if ($("marks").checked) meta.highlights.forEach(paintMark);
  if (state.chosen >= 0) outline(state.chosen, "#d55e00", 2.5);
  paintScale();
  const at = fromCamera();
  document.body.dataset.centre = at.map((x) => x.toPrecision(6)).join(" ");
}

const fromCamera = () => camera.centre.map((u, k) => fromUnit(points.frame, u, k));

function outline(t, colour, width) {
  if (!drawable[t]) return;
  pen.beginPath();
  for (let c = 0; c < 3; c++) pen.lineTo(...projectPoint(triangles[3 * t + c]));
  pen.closePath();
  [pen.strokeStyle, pen.lineWidth, pen.lineJoin] = [colour, width, "round"];
  pen.stroke();
}

function paintSpacing() {
  pen.strokeStyle = "#7b3fa0";
  pen.lineWidth = 1;
  pen.beginPath();
  for (let v = 0; v < background.points.n; v++) {
    const [x, y] = project(unitOf(background.points, v));
    const r = (background.spacing[v] / points.frame.half / 2) * camera.zoom;
    if (!(r > 0.3) || x < -r || y < -r || x > camera.width + r || y > camera.height + r) continue;
    pen.moveTo(x + r, y);
    pen.arc(x, y, r, 0, 2 * Math.PI);
  }
  pen.stroke();
}

const unitOfPlace = ([x, y]) => [toUnit(points.frame, x, 0), toUnit(points.frame, y, 1), 0];

/** Places of a finding in mesh units. */
function placesOf(mark) {
  const corners = mark.triangles.filter((t) => drawable[t]).flatMap((t) => [0, 1, 2].map((c) => triangles[3 * t + c]));
  const inMesh = [...corners, ...mark.edges.flat(), ...mark.vertices].filter((v) => v < points.n);
  return [...inMesh.map((v) => unitOf(points, v)), ...mark.lines.flat().map(unitOfPlace)];
}

function paintMark(mark, i) {
  const places = placesOf(mark).map(project).filter((p) => p.every(Number.isFinite));
  if (!places.length) return;
  const colour = i === state.finding ? "#b30000" : "#d55e00";
  for (const t of mark.triangles) outline(t, colour, 2);
  pen.strokeStyle = pen.fillStyle = colour;
  pen.lineWidth = 3;
  for (const edge of mark.edges) {
    if (!edge.every((v) => v < points.n)) continue;
    pen.beginPath();
    for (const v of edge) pen.lineTo(...projectPoint(v).slice(0, 2));
    pen.stroke();
  }
  for (const line of mark.lines) {
    pen.beginPath();
    for (const place of line) pen.lineTo(...project(unitOfPlace(place)).slice(0, 2));
    pen.stroke();
  }
  const spots = [...mark.vertices.filter((v) => v < points.n).map((v) => unitOf(points, v)), ...mark.lines.filter((l) => l.length === 1).flat().map(unitOfPlace)];
  for (const [x, y] of spots.map(project)) {
    pen.beginPath();
    pen.arc(x, y, 3, 0, 2 * Math.PI);
    pen.fill();
  }
  const low = [0, 1].map((k) => Math.min(...places.map((p) => p[k])));
  const high = [0, 1].map((k) => Math.max(...places.map((p) => p[k])));
  const reach = Math.max(high[0] - low[0], high[1] - low[1]) / 2;
  const [x, y] = [0, 1].map((k) => (low[k] + high[k]) / 2);
  pen.lineWidth = 1.5;
  if (reach < 8) { pen.beginPath(); pen.arc(x, y, reach + 6, 0, 2 * Math.PI); pen.stroke(); }
  // Hundreds of numbers would hide the mesh.
  if (meta.highlights.length > 60 && i !== state.finding) return;
  const away = Math.min(reach, 40) * 0.75 + 6;
  pen.font = "bold 12px system-ui, sans-serif";
  [pen.strokeStyle, pen.lineWidth] = ["#fff", 3];
  pen.strokeText(i + 1, x + away, y - away);
  pen.fillText(i + 1, x + away, y - away);
}

function paintScale() {
  if (spatial) return;
  // The longest of 1, 2, 5 x 10^k that fits 120 pixels.
  const width = (120 / camera.zoom) * points.frame.half;
  const power = 10 ** Math.floor(Math.log10(width));
  if (!(power > 0) || !Number.isFinite(power)) return;
  const nice = [5, 2, 1].map((m) => m * power).find((l) => l <= width) || power;
  const length = (nice / points.frame.half) * camera.zoom, y = camera.height - 16;
  pen.strokeStyle = pen.fillStyle = "#22262c";
  pen.lineWidth = 2;
  pen.beginPath();
  pen.moveTo(16, y - 4); pen.lineTo(16, y); pen.lineTo(16 + length, y); pen.lineTo(16 + length, y - 4);
  pen.stroke();
  pen.font = "11px system-ui, sans-serif";
  pen.lineWidth = 3; pen.strokeStyle = "#fff";
  const label = Number(nice.toPrecision(1)).toString();
  pen.strokeText(label, 20, y - 6);
  pen.fillText(label, 20, y - 6);
}

// ---- the side panel

function recolour() {
  const colours = paletteColours(meta.palettes[state.palette]);
  summary = summarise(state.measure, state.range);
  renderer.setPalette(colours);
  renderer.setShades(shadesOf(state.measure, summary));
  $("low").value = Number(summary.low.toPrecision(6));
  $("high").value = Number(summary.high.toPrecision(6));
  const bound = { low: ["≤", "max"], high: ["≥", "min"], "": ["≤", "max"] }[state.measure.better];
  $("summary").textContent = summary.n ? `mean ${short(summary.mean)}, 99 % ${bound[0]} ${short(summary.percentile)}, ${bound[1]} ${short(summary.worst)}` : "no values";
  paintLegend(colours);
  listWorst();
  redraw();
}

function paintLegend(colours) {
  const c = $("legend").getContext("2d"), [w, base, bar] = [560, 92, 20];
  c.clearRect(0, 0, 560, 150);
  const most = Math.max(1, ...summary.bars), n = summary.bars.length;
  summary.bars.forEach((k, i) => {
    const f = (i + 0.5) / n, shade = Math.round(254 * (state.measure.better === "high" ? 1 - f : f));
    c.fillStyle = `rgb(${colours[shade].join()})`;
    const h = k ? Math.max(3, (k / most) * (base - 6)) : 0;
    c.fillRect((i * w) / n, base - h, w / n + 1, h + bar);
    c.fillStyle = "#5a6068";
    if (h) c.fillRect((i * w) / n, base - h - 1, w / n + 1, 1.5);
  });
  c.strokeStyle = "#5a6068";
  c.strokeRect(0.5, base, w - 1, bar);
  c.fillStyle = "#4a4f57";
  c.font = "21px system-ui, sans-serif";
  for (let i = 0; i <= 4; i++) {
    c.textAlign = i === 0 ? "left" : i === 4 ? "right" : "center";
    const sign = i === 0 && summary.below ? "≤ " : i === 4 && summary.above ? "≥ " : "";
    c.fillText(sign + short(summary.at(i / 4), 3), (i * w) / 4, base + bar + 26);
  }
}

function item(list, text, action) {
  const li = document.createElement("li");
  li.textContent = text;
  li.tabIndex = 0;
  li.onclick = action;
  li.onkeydown = (e) => { if (e.key === "Enter") action(); };
  list.append(li);
}

/** The ten worst by one pass; ties by index. */
function listWorst() {
  const values = valuesOf(state.measure.id), sign = state.measure.better === "high" ? -1 : 1, worst = [];
  for (let t = 0; t < count; t++) {
    const badness = sign * values[t];
    if (Number.isNaN(badness) || (worst.length === 10 && badness <= worst[9].badness)) continue;
    const at = worst.findIndex((w) => badness > w.badness);
    worst.splice(at < 0 ? worst.length : at, 0, { t, badness });
    worst.length = Math.min(worst.length, 10);
  }
  $("worst-title").textContent = state.measure.better ? "Worst elements" : "Largest values";
  $("worst").replaceChildren();
  for (const { t, badness } of worst) item($("worst"), `triangle ${t}: ${short(sign * badness)}`, () => choose(t, true));
}

const cornersOf = (t) => [0, 1, 2].map((c) => unitOf(points, triangles[3 * t + c]));

function faceTriangle(t) {
  if (spatial && drawable[t]) face(cornersOf(t));
}

function choose(t, zoom) {
  state.chosen = t;
  if (t >= 0 && zoom && drawable[t]) {
    faceTriangle(t);
    show(cornersOf(t), 6);
  }
  showFacts(t);
  redraw();
}

function showFacts(t) {
  const box = $("facts");
  box.replaceChildren();
  if (t < 0) { box.textContent = "Point at a triangle; click keeps it."; return; }
  const table = document.createElement("table");
  const row = (name, value) => {
    const tr = table.insertRow();
    tr.insertCell().textContent = name;
    tr.insertCell().textContent = value;
  };
  row("triangle", t);
  if (numbers.length) row("number in the file", numbers[t]);
  if (!drawable[t]) row("cannot be drawn", "bad index or coordinate");
  else {
    scale(t);
    row("R/(2r)", short(ratio()));
    row("angles [°]", [0, 1, 2].map((i) => short(angle(i), 4)).join("  "));
    row("edges", [2, 0, 1].map((i) => short(length(i), 4)).join("  "));
    row("area", short(area()) + (area() < 0 ? " (clockwise)" : ""));
  }
  for (let c = 0; c < 3; c++) {
    const v = triangles[3 * t + c];
    const at = v < points.n ? Array.from({ length: meta.dimension }, (_, k) => points.coordinate(v, k)).join(", ") : "does not exist";
    row(`vertex ${v < points.n ? v : "?"}`, at);
  }
  const value = valuesOf(state.measure.id)[t];
  if (state.measure.id !== "radius_ratio") row(state.measure.name, short(value));
  if (wanted.get("facts") === "all") for (const m of measures) row(m.id, short(valuesOf(m.id)[t]));
  box.append(table);
}

function chooseFinding(i) {
  state.finding = i;
  $("marks").checked = true;
  [...$("findings").children].forEach((li, k) => li.classList.toggle("chosen", k === i));
  const first = meta.highlights[i].triangles[0];
  if (first < count) {
    faceTriangle(first);
    showFacts(first);
  }
  show(placesOf(meta.highlights[i]), 5);
  redraw();
}

function setFrame(k) {
  state.frame = Math.max(0, Math.min(count, Math.round(k)));
  $("frame").value = state.frame;
  $("count").textContent = `${state.frame.toLocaleString("en")} of ${count.toLocaleString("en")}`;
  redraw();
}

/** Plays the whole mesh in about twelve seconds, whatever its size. */
function play() {
  state.playing = !state.playing;
  $("play").textContent = state.playing ? "stop" : "play";
  if (!state.playing) return;
  if (state.frame >= count) setFrame(0);
  let before = performance.now(), exact = state.frame;
  const step = (now) => {
    if (!state.playing) return;
    exact += (count / 12000) * Math.max(0, now - before);
    before = now;
    setFrame(exact);
    if (state.frame < count) requestAnimationFrame(step);
    else play();
  };
  requestAnimationFrame(step);
}

// ---- the pointer

/** The triangle under a pixel, the nearest one in space, or -1: one pass over all. */
function pick(px, py) {
  let best = -1, nearest = -Infinity;
  const x = new Float64Array(points.n), y = new Float64Array(points.n), z = new Float64Array(points.n);
  for (let v = 0; v < points.n; v++) { const p = projectPoint(v); x[v] = p[0] - px; y[v] = p[1] - py; z[v] = p[2]; }
  for (let t = 0; t < state.frame; t++) {
    const a = triangles[3 * t], b = triangles[3 * t + 1], c = triangles[3 * t + 2];
    const p = x[a] * y[b] - x[b] * y[a], q = x[b] * y[c] - x[c] * y[b], r = x[c] * y[a] - x[a] * y[c];
    if (!((p >= 0 && q >= 0 && r >= 0) || (p <= 0 && q <= 0 && r <= 0)) || p + q + r === 0 || !drawable[t]) continue;
    const depth = spatial ? (p * z[c] + q * z[a] + r * z[b]) / (p + q + r) : t;
    if (depth > nearest) { nearest = depth; best = t; }
  }
  return best;
}

const pointers = new Map();
let travelled = 0, hoverTimer = 0;

function hover(e) {
  const box = overlay.getBoundingClientRect(), at = [e.clientX - box.left, e.clientY - box.top];
  clearTimeout(hoverTimer);
  hoverTimer = setTimeout(() => {
    const t = pick(...at), tip = $("tip");
    tip.hidden = t < 0;
    if (t < 0) return;
    tip.textContent = `${t}: ${state.measure.name} ${short(valuesOf(state.measure.id)[t])}`;
    [tip.style.left, tip.style.top] = [`${Math.min(at[0] + 14, camera.width - 170)}px`, `${at[1] + 14}px`];
    if (state.chosen < 0) showFacts(t);
  }, count > 200000 ? 60 : 8);
}

function settle() {
  state.moving++;
  redraw();
  setTimeout(() => { state.moving--; if (!state.moving) redraw(); }, 160);
}

overlay.addEventListener("pointerdown", (e) => {
  overlay.setPointerCapture(e.pointerId);
  pointers.set(e.pointerId, [e.clientX, e.clientY]);
  travelled = 0;
  overlay.classList.add("dragging");
});
overlay.addEventListener("pointermove", (e) => {
  const before = pointers.get(e.pointerId);
  if (!before) return hover(e);
  const [dx, dy] = [e.clientX - before[0], e.clientY - before[1]];
  travelled += Math.abs(dx) + Math.abs(dy);
  $("tip").hidden = true;
  if (pointers.size === 2) {
    const other = [...pointers].find(([id]) => id !== e.pointerId)[1];
    const span = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
    const box = overlay.getBoundingClientRect();
    pan(dx / 2, dy / 2);
    zoomAt((e.clientX + other[0]) / 2 - box.left, (e.clientY + other[1]) / 2 - box.top, span([e.clientX, e.clientY]) / span(before));
  } else if (spatial && !(e.shiftKey || e.buttons & 6)) orbit(dx, dy);
  else pan(dx, dy);
  pointers.set(e.pointerId, [e.clientX, e.clientY]);
  settle();
});
for (const kind of ["pointerup", "pointercancel"])
  overlay.addEventListener(kind, (e) => {
    if (kind === "pointerup" && pointers.size === 1 && travelled < 4) {
      const box = overlay.getBoundingClientRect(), t = pick(e.clientX - box.left, e.clientY - box.top);
      choose(t === state.chosen ? -1 : t, false);
    }
    pointers.delete(e.pointerId);
    overlay.classList.remove("dragging");
  });
overlay.addEventListener("pointerleave", () => { clearTimeout(hoverTimer); $("tip").hidden = true; });
overlay.addEventListener("contextmenu", (e) => e.preventDefault());
overlay.addEventListener("wheel", (e) => {
  e.preventDefault();
  const box = overlay.getBoundingClientRect(), unit = e.deltaMode === 1 ? 30 : 1;
  zoomAt(e.clientX - box.left, e.clientY - box.top, Math.exp(-e.deltaY * unit * 0.0015));
  settle();
}, { passive: false });

const refit = () => { fit(); redraw(); };
const toggle = (id) => { $(id).checked = !$(id).checked; redraw(); };
const keys = {
  f: refit, w: () => toggle("wire"), b: () => toggle("boundary"), " ": play, Escape: () => choose(-1, false),
  "+": () => { zoomAt(camera.width / 2, camera.height / 2, 1.3); settle(); },
  "-": () => { zoomAt(camera.width / 2, camera.height / 2, 1 / 1.3); settle(); },
  ArrowLeft: () => { pan(60, 0); settle(); }, ArrowRight: () => { pan(-60, 0); settle(); },
  ArrowUp: () => { pan(0, 60); settle(); }, ArrowDown: () => { pan(0, -60); settle(); },
};
window.addEventListener("keydown", (e) => {
  const action = keys[e.key.length === 1 ? e.key.toLowerCase() : e.key];
  if (!action || /^(INPUT|SELECT|BUTTON|LI)$/.test(e.target.tagName) || e.ctrlKey || e.metaKey) return;
  e.preventDefault();
  action();
});

// ---- start

function fillPanel() {
  $("title").textContent = meta.title;
  const bad = drawable.reduce((n, d) => n - d, count);
  $("counts").textContent = `${count.toLocaleString("en")} triangles, ${points.n.toLocaleString("en")} points` + (bad ? `; ${bad} not drawn (bad index or coordinate)` : "");
  for (const m of measures) $("measure").add(new Option(m.name, m.id));
  for (const name of Object.keys(meta.palettes)) $("palette").add(new Option(name, name));
  const offer = (id, there) => { $(id).parentElement.hidden = !there; };
  offer("constraints", constraints.length > 0);
  offer("background", background !== null);
  offer("spacing", background !== null && background.spacing.length > 0);
  offer("marks", meta.highlights.length > 0);
  $("findings-section").hidden = !meta.highlights.length;
  meta.highlights.forEach((mark, i) => item($("findings"), mark.label, () => chooseFinding(i)));
  $("frame").max = count;
}

function listen() {
  $("measure").onchange = () => { [state.measure, state.range] = [measures.find((m) => m.id === $("measure").value), null]; recolour(); };
  $("palette").onchange = () => { state.palette = $("palette").value; recolour(); };
  for (const id of ["low", "high"]) $(id).onchange = () => {
    const range = [Number($("low").value), Number($("high").value)];
    if (range[1] > range[0]) { state.range = range; recolour(); }
  };
  $("reset").onclick = () => { state.range = null; recolour(); };
  for (const id of ["wire", "boundary", "constraints", "background", "spacing", "marks"]) $(id).onchange = redraw;
  $("fit").onclick = refit;
  $("frame").oninput = () => { state.playing = false; $("play").textContent = "play"; setFrame(Number($("frame").value)); };
  $("play").onclick = play;
  window.addEventListener("resize", resize);
}

/** What the address asks for after "#": measure, palette, view, triangle, finding, frame, layers. */
function applyAddress() {
  const measure = measures.find((m) => m.id === wanted.get("measure"));
  if (measure) state.measure = measure;
  if (meta.palettes[wanted.get("palette")]) state.palette = wanted.get("palette");
  for (const id of (wanted.get("show") || "").split(",")) if ($(id) && $(id).type === "checkbox") $(id).checked = true;
  for (const id of (wanted.get("hide") || "").split(",")) if ($(id) && $(id).type === "checkbox") $(id).checked = false;
  $("measure").value = state.measure.id;
  $("palette").value = state.palette;
}

function applyPlace() {
  const number = (key) => (wanted.has(key) ? Number(wanted.get(key)) : NaN);
  const view = (wanted.get("view") || "").split(",").map(Number);
  if (view.length === 4 && view.every(Number.isFinite)) {
    const corner = (x, y) => [toUnit(points.frame, x, 0), toUnit(points.frame, y, 1), 0];
    show([corner(view[0], view[1]), corner(view[2], view[3])], 1);
  }
  if (number("triangle") >= 0 && number("triangle") < count) choose(number("triangle"), !wanted.has("view"));
  if (number("finding") >= 1 && number("finding") <= meta.highlights.length) chooseFinding(number("finding") - 1);
  setFrame(wanted.has("frame") ? number("frame") || 0 : count);
}

/** Moves the picture for some frames, as the pointer would, and tells how long one took. */
function moveFor(frames) {
  const times = [];
  let before = performance.now();
  const step = () => {
    const now = performance.now();
    times.push(now - before);
    before = now;
    if (times.length > frames) {
      document.body.dataset.frame = times.sort((a, b) => a - b)[times.length >> 1].toFixed(1);
      document.body.dataset.moved = document.body.dataset.drawn;
      return;
    }
    if (spatial) orbit(4, 1);
    else pan(4, 1);
    settle();
    atNextFrame(step);
  };
  atNextFrame(step);
}

fillPanel();
listen();
applyAddress();
resize();
fit();
renderer = chooseRenderer();
recolour();
applyPlace();
paint();
document.body.dataset.ready = renderer.kind;
document.body.dataset.seconds = (performance.now() / 1000).toFixed(2);
if (Number(wanted.get("move")) > 0) moveFor(Number(wanted.get("move")));
