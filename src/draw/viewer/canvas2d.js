// Drawing without WebGL: polygons on a plain canvas, back to front for meshes in space.

function canvasRenderer(canvas) {
  const context = canvas.getContext("2d", { alpha: false });
  let shades = new Uint8Array(count), colours = [];
  const x = new Float64Array(points.n), y = new Float64Array(points.n), z = new Float64Array(points.n);

  function place(dots) {
    for (let v = 0; v < points.n; v++) {
      const p = projectPoint(v);
      x[v] = p[0] * dots; y[v] = p[1] * dots; z[v] = p[2];
    }
  }

  /** Triangles that touch the canvas, far ones first in space. */
  function visible(frame) {
    const out = [];
    for (let t = 0; t < frame; t++) {
      if (!drawable[t]) continue;
      const a = triangles[3 * t], b = triangles[3 * t + 1], c = triangles[3 * t + 2];
      if (Math.max(x[a], x[b], x[c]) < 0 || Math.min(x[a], x[b], x[c]) > canvas.width) continue;
      if (Math.max(y[a], y[b], y[c]) < 0 || Math.min(y[a], y[b], y[c]) > canvas.height) continue;
      out.push(t);
    }
    const depth = (t) => z[triangles[3 * t]] + z[triangles[3 * t + 1]] + z[triangles[3 * t + 2]];
    if (spatial) out.sort((s, t) => depth(s) - depth(t));
    else out.sort((s, t) => shades[s] - shades[t]);
    return out;
  }

  function trace(t) {
    const a = triangles[3 * t], b = triangles[3 * t + 1], c = triangles[3 * t + 2];
    context.moveTo(x[a], y[a]);
    context.lineTo(x[b], y[b]);
    context.lineTo(x[c], y[c]);
    context.closePath();
  }

  function drawTriangles(list, dots, wire) {
    const crowded = list.length > (canvas.width * canvas.height) / 60;
    let i = 0;
    while (i < list.length) {
      // One path for each run of one shade; in space each triangle hides what is behind it.
      const shade = shades[list[i]];
      context.beginPath();
      do trace(list[i++]); while (!spatial && i < list.length && shades[list[i]] === shade);
      const [r, g, b] = colours[shade];
      context.fillStyle = context.strokeStyle = `rgb(${r},${g},${b})`;
      context.lineWidth = 0.7 * dots;
      context.fill();
      context.stroke();
      if (wire && !crowded) { context.strokeStyle = "#101114a0"; context.lineWidth = 0.5 * dots; context.stroke(); }
    }
  }

  function drawLines(dots, { of, list, width, ink }) {
    context.beginPath();
    for (let i = 0; i < list.length; i += 2) {
      const a = project(unitOf(of, list[i])), b = project(unitOf(of, list[i + 1]));
      context.moveTo(a[0] * dots, a[1] * dots);
      context.lineTo(b[0] * dots, b[1] * dots);
    }
    context.strokeStyle = `rgb(${ink.join()})`;
    context.lineWidth = width * dots;
    context.stroke();
  }

  return {
    kind: "canvas",
    setShades(of) { shades = of; },
    setPalette(list) { colours = list; },
    draw({ dots, wire, frame, moving, lines }) {
      context.fillStyle = "#fff";
      context.fillRect(0, 0, canvas.width, canvas.height);
      place(dots);
      const list = visible(frame);
      // A picture in motion shows the outline alone where the triangles would hold it up.
      if (!(moving && list.length > 60000)) drawTriangles(list, dots, wire);
      context.lineJoin = context.lineCap = "round";
      for (const set of lines) drawLines(dots, set);
    },
  };
}
