// Drawing without WebGL: triangles are filled row by row into an image, so that the time goes with
// the pixels and a million small triangles are no harder than a few large ones.

function canvasRenderer(canvas) {
  const context = canvas.getContext("2d", { alpha: false });
  let shades = new Uint8Array(count), colours = [], image = null, pixels = null, depths = null;
  const x = new Float64Array(points.n), y = new Float64Array(points.n), z = new Float64Array(points.n);

  /** Places points, all or those listed; without arrays for each, for there are millions. */
  function place(dots, list) {
    const r = camera.rotation, [cx, cy, cz] = camera.centre, u = points.unit, f = camera.zoom * dots;
    const [left, top] = [(camera.width / 2) * dots, (camera.height / 2) * dots];
    for (let i = 0, n = list ? list.length : points.n; i < n; i++) {
      const v = list ? list[i] : i, a = u[3 * v] - cx, b = u[3 * v + 1] - cy, c = u[3 * v + 2] - cz;
      x[v] = left + (r[0] * a + r[1] * b + r[2] * c) * f;
      y[v] = top - (r[3] * a + r[4] * b + r[5] * c) * f;
      z[v] = (r[6] * a + r[7] * b + r[8] * c) * f;
    }
  }

  function clear() {
    if (!image || image.width !== canvas.width || image.height !== canvas.height) {
      image = context.createImageData(canvas.width, canvas.height);
      pixels = new Uint32Array(image.data.buffer);
      depths = spatial ? new Float32Array(pixels.length) : null;
    }
    pixels.fill(0xffffffff);
    if (depths) depths.fill(-Infinity);
  }

  const smooth = (from, to, x) => {
    const t = Math.min(1, Math.max(0, (x - from) / (to - from)));
    return t * t * (3 - 2 * t);
  };

  // As in the shader: elements of a few pixels keep the tone of their lines without the lines.
  const TONE = 0.11;
  const darkness = (height) => {
    const lined = smooth(1.5, 5, height);
    return [lined * (0.35 + 0.45 * smooth(4, 24, height)), (1 - lined) * TONE];
  };

  // The triangle in hand: signed distances to its sides are a x + b y + c, positive inside.
  const a = new Float64Array(3), b = new Float64Array(3), c = new Float64Array(3), corner = new Uint32Array(3);

  /** Sets up the triangle in `corner`; returns its signed double area, 0 if there is nothing to fill. */
  function take() {
    const p = corner[0], q = corner[1], r = corner[2];
    if (Math.max(x[p], x[q], x[r]) < 0 || Math.min(x[p], x[q], x[r]) > canvas.width) return 0;
    if (Math.max(y[p], y[q], y[r]) < 0 || Math.min(y[p], y[q], y[r]) > canvas.height) return 0;
    const area = (x[q] - x[p]) * (y[r] - y[p]) - (x[r] - x[p]) * (y[q] - y[p]);
    const sign = area < 0 ? -1 : 1;
    for (let i = 0; i < 3; i++) {
      const from = corner[(i + 1) % 3], to = corner[(i + 2) % 3];
      const length = Math.hypot(x[to] - x[from], y[to] - y[from]) || 1;
      a[i] = (-sign * (y[to] - y[from])) / length;
      b[i] = (sign * (x[to] - x[from])) / length;
      c[i] = -(a[i] * x[from] + b[i] * y[from]);
    }
    return area;
  }

  /** Colour of triangle t: its shade, dimmed by slope in space, marked when just laid. */
  function colourOf(t, area, fresh) {
    let [red, green, blue] = colours[shades[t]];
    if (fresh) [red, green, blue] = [213, 94, 0];
    if (!spatial) return [red, green, blue];
    const [p, q, r] = corner;
    const nx = (y[q] - y[p]) * (z[r] - z[p]) - (z[q] - z[p]) * (y[r] - y[p]);
    const ny = (z[q] - z[p]) * (x[r] - x[p]) - (x[q] - x[p]) * (z[r] - z[p]);
    const light = 0.62 + 0.38 * Math.abs(area / (Math.hypot(nx, ny, area) || 1));
    return [red * light, green * light, blue * light];
  }

  /** Fills the pixels whose centres lie in the triangle; `ink` is the darkness of its edges, `tone` that of all of it. */
  function fill([red, green, blue], [ink, tone], dots, hatched, dz) {
    const top = Math.max(0, Math.ceil(Math.min(y[corner[0]], y[corner[1]], y[corner[2]]) - 0.5));
    const bottom = Math.min(canvas.height - 1, Math.floor(Math.max(y[corner[0]], y[corner[1]], y[corner[2]]) - 0.5));
    for (let row = top; row <= bottom; row++) {
      let left = 0, right = canvas.width - 1;
      for (let i = 0; i < 3; i++) {
        const rest = b[i] * (row + 0.5) + c[i];
        if (a[i] > 0) left = Math.max(left, Math.ceil(-rest / a[i] - 0.5));
        else if (a[i] < 0) right = Math.min(right, Math.floor(-rest / a[i] - 0.5));
        else if (rest < 0) right = -1;
      }
      for (let column = left; column <= right; column++) {
        const at = row * canvas.width + column, px = column + 0.5, py = row + 0.5;
        if (depths) {
          const depth = dz[0] * px + dz[1] * py + dz[2];
          if (!(depth > depths[at])) continue;
          depths[at] = depth;
        }
        const near = Math.min(a[0] * px + b[0] * py + c[0], a[1] * px + b[1] * py + c[1], a[2] * px + b[2] * py + c[2]);
        const keep = 1 - tone - (near < 0.9 * dots ? ink * (1 - smooth(0, 0.9 * dots, near)) : 0);
        const stripe = hatched && (column + row) % (9 * dots) < 2.5 * dots;
        const [r, g, bl] = stripe ? [194, 24, 91] : [red, green, blue];
        pixels[at] = 0xff000000 | ((bl * keep) << 16) | ((g * keep) << 8) | (r * keep);
      }
    }
  }

  /** Depth as a plane over the pixels. */
  function depthPlane(area) {
    const [p, q, r] = corner;
    const u = ((z[q] - z[p]) * (y[r] - y[p]) - (z[r] - z[p]) * (y[q] - y[p])) / area;
    const v = ((x[q] - x[p]) * (z[r] - z[p]) - (x[r] - x[p]) * (z[q] - z[p])) / area;
    return [u, v, z[p] - u * x[p] - v * y[p]];
  }

  function drawTriangles(frame, fresh, dots, wire) {
    for (let t = 0; t < frame; t++) {
      for (let i = 0; i < 3; i++) corner[i] = triangles[3 * t + i];
      const area = drawable[t] ? take() : 0;
      if (area === 0) continue;
      const [p, q, r] = corner;
      const longest = Math.max(Math.abs(x[q] - x[p]), Math.abs(x[r] - x[p]), Math.abs(y[q] - y[p]), Math.abs(y[r] - y[p]));
      const height = Math.abs(area) / longest / dots;
      // On the screen y points down: a counterclockwise triangle has a negative area.
      const colour = colourOf(t, area, frame < count && frame - 1 - t < fresh);
      fill(colour, wire ? darkness(height) : [0, 0], dots, !spatial && area > 0, spatial && depthPlane(area));
    }
  }

  /** The coarser mesh, in the tone of small triangles with their lines. */
  function drawCoarse({ kept, corners }, dots, wire) {
    for (let i = 0; i < kept.length; i++) {
      for (let k = 0; k < 3; k++) corner[k] = corners[3 * i + k];
      const area = take();
      if (area === 0) continue;
      fill(colourOf(kept[i], area, false), [0, wire ? TONE : 0], dots, false, spatial && depthPlane(area));
    }
  }

  /** Lines in space, hidden where triangles lie before them by more than their own width. */
  function drawLinesInSpace(dots, { of, list, width, ink }) {
    const colour = 0xff000000 | (ink[2] << 16) | (ink[1] << 8) | ink[0], reach = Math.max(1, Math.round(width * dots));
    for (let i = 0; i < list.length; i += 2) {
      const [p, q] = [list[i], list[i + 1]].map((v) => {
        const [px, py, pz] = project(unitOf(of, v));
        return [px * dots, py * dots, pz * camera.zoom * dots];
      });
      const steps = Math.ceil(Math.max(Math.abs(q[0] - p[0]), Math.abs(q[1] - p[1]), 1));
      // A line far longer than the canvas is for the most part not on it.
      if (!(steps < 4 * (canvas.width + canvas.height))) continue;
      for (let s = 0; s <= steps; s++) {
        const [lx, ly, lz] = p.map((a, k) => a + ((q[k] - a) * s) / steps);
        for (let k = 0; k < reach * reach; k++) {
          const column = Math.floor(lx - reach / 2) + (k % reach), row = Math.floor(ly - reach / 2) + Math.floor(k / reach);
          if (column < 0 || row < 0 || column >= canvas.width || row >= canvas.height) continue;
          const at = row * canvas.width + column;
          if (lz + 2 * reach > depths[at]) pixels[at] = colour;
        }
      }
    }
  }

  function drawLines(dots, { of, list, width, ink }) {
    context.beginPath();
    for (let i = 0; i < list.length; i += 2) {
      const p = project(unitOf(of, list[i])), q = project(unitOf(of, list[i + 1]));
      context.moveTo(p[0] * dots, p[1] * dots);
      context.lineTo(q[0] * dots, q[1] * dots);
    }
    context.strokeStyle = `rgb(${ink.join()})`;
    context.lineWidth = width * dots;
    context.lineCap = "round";
    context.stroke();
  }

  return {
    kind: "canvas",
    setShades(of) { shades = of; },
    setPalette(list) { colours = list; },
    finish() {},
    draw({ dots, wire, frame, fresh, lines, detail }) {
      place(dots, detail && detail.used);
      clear();
      if (detail) drawCoarse(detail, dots, wire);
      else drawTriangles(frame, fresh, dots, wire);
      if (spatial) for (const set of lines) drawLinesInSpace(dots, set);
      context.putImageData(image, 0, 0);
      if (!spatial) for (const set of lines) drawLines(dots, set);
    },
  };
}
