// Drawing by WebGL 2: three vertices a triangle, edges by barycentric distance in the shader.

const TRIANGLE_VERTEX = `#version 300 es
precision highp float;
layout(location = 0) in vec3 place;
layout(location = 1) in float shade;
uniform mat3 rotation; uniform vec3 centre; uniform vec2 scale; uniform float depth;
flat out int triangle; flat out float tone; out vec3 corner; out vec3 seen;
void main() {
  triangle = gl_VertexID / 3;
  int c = gl_VertexID % 3;
  corner = vec3(c == 0, c == 1, c == 2);
  tone = shade;
  seen = rotation * (place - centre);
  gl_Position = vec4(seen.xy * scale, -seen.z * depth, 1.0);
}`;

const TRIANGLE_FRAGMENT = `#version 300 es
precision highp float;
flat in int triangle; flat in float tone; in vec3 corner; in vec3 seen;
uniform sampler2D palette; uniform float wire; uniform bool spatial; uniform bool clockwise;
uniform int newest; uniform int fresh; uniform float dots;
out vec4 colour;
void main() {
  vec3 fill = texture(palette, vec2((tone * 255.0 + 0.5) / 256.0, 0.5)).rgb;
  // Distance in dots to each side, and the least height of the triangle.
  vec3 slope = sqrt(dFdx(corner) * dFdx(corner) + dFdy(corner) * dFdy(corner));
  vec3 away = corner / slope;
  vec3 height = 1.0 / slope;
  float least = min(height.x, min(height.y, height.z)) / dots;
  float near = min(away.x, min(away.y, away.z)) / dots;
  float line = 1.0 - smoothstep(0.0, 0.9, near);
  // Elements of a few pixels keep the tone of their lines without the lines.
  float ink = mix(0.11, line * mix(0.35, 0.8, smoothstep(4.0, 24.0, least)), smoothstep(1.5, 5.0, least));
  if (newest >= 0 && newest - triangle < fresh) fill = mix(fill, vec3(0.835, 0.369, 0.0), 0.75);
  if (spatial) {
    vec3 n = normalize(cross(dFdx(seen), dFdy(seen)));
    fill *= 0.62 + 0.38 * abs(n.z);
  } else if (gl_FrontFacing == clockwise) {
    float stripe = mod(gl_FragCoord.x + gl_FragCoord.y, 9.0 * dots);
    if (stripe < 2.5 * dots) fill = vec3(0.76, 0.09, 0.36);
  }
  colour = vec4(mix(fill, vec3(0.06), wire * ink), 1.0);
}`;

const LINE_VERTEX = `#version 300 es
precision highp float;
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
uniform mat3 rotation; uniform vec3 centre; uniform vec2 scale; uniform float depth;
uniform vec2 halfSize; uniform float width; uniform float lift;
out float across;
void main() {
  vec3 a = rotation * (from - centre), b = rotation * (to - centre);
  vec2 p = a.xy * scale * halfSize, q = b.xy * scale * halfSize;
  vec2 along = q - p;
  float size = length(along);
  along = size > 0.0 ? along / size : vec2(1.0, 0.0);
  float end = float(gl_VertexID / 2), side = float(gl_VertexID % 2) * 2.0 - 1.0;
  float reach = width / 2.0 + 0.5;
  vec2 at = mix(p, q, end) + vec2(-along.y, along.x) * side * reach + along * (end * 2.0 - 1.0) * width * 0.4;
  across = side * reach;
  gl_Position = vec4(at / halfSize, -mix(a.z, b.z, end) * depth - lift, 1.0);
}`;

const LINE_FRAGMENT = `#version 300 es
precision highp float;
in float across; uniform vec3 ink; uniform float width; out vec4 colour;
void main() {
  float alpha = clamp(width / 2.0 + 0.5 - abs(across), 0.0, 1.0);
  if (alpha <= 0.0) discard;
  colour = vec4(ink, alpha);
}`;

/** A renderer on `canvas`, or null where WebGL 2 is missing. */
function webglRenderer(canvas) {
  const gl = canvas.getContext("webgl2", { antialias: true, alpha: false, preserveDrawingBuffer: true });
  if (!gl) return null;
  const program = (vertex, fragment) => {
    const p = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const s = gl.createShader(type);
      gl.shaderSource(s, source);
      gl.compileShader(s);
      gl.attachShader(p, s);
    }
    gl.linkProgram(p);
    if (!gl.getProgramParameter(p, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(p));
    const at = new Map();
    return { use: () => gl.useProgram(p), at: (name) => {
      if (!at.has(name)) at.set(name, gl.getUniformLocation(p, name));
      return at.get(name);
    } };
  };
  const surface = program(TRIANGLE_VERTEX, TRIANGLE_FRAGMENT), line = program(LINE_VERTEX, LINE_FRAGMENT);
  const places = gl.createBuffer(), shades = gl.createBuffer(), texture = gl.createTexture();
  // Places are floats relative to this origin, which follows the eye when it comes very close.
  let origin = [0, 0, 0];
  const sets = new Map();

  function arraysOf(places, shades) {
    const arrays = gl.createVertexArray();
    gl.bindVertexArray(arrays);
    gl.bindBuffer(gl.ARRAY_BUFFER, places);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, shades);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribPointer(1, 1, gl.UNSIGNED_BYTE, true, 0, 0);
    gl.bindVertexArray(null);
    return arrays;
  }
  const surfaceArrays = arraysOf(places, shades);

  const fillBuffer = (buffer, data) => {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
  };

  /** Places of so many corners; corner i is point `pointOf(i)`, and left out if that is below 0. */
  function uploadPlaces(buffer, n, pointOf) {
    const data = new Float32Array(3 * n);
    for (let i = 0; i < n; i++) {
      const v = pointOf(i);
      if (v >= 0) for (let k = 0; k < 3; k++) data[3 * i + k] = points.unit[3 * v + k] - origin[k];
    }
    fillBuffer(buffer, data);
  }

  let tones = new Uint8Array(count);
  function uploadShades(buffer, n, triangleOf) {
    const data = new Uint8Array(3 * n);
    for (let i = 0; i < n; i++) data[3 * i] = data[3 * i + 1] = data[3 * i + 2] = tones[triangleOf(i)];
    fillBuffer(buffer, data);
  }

  function upload() {
    uploadPlaces(places, 3 * count, (i) => (drawable[(i / 3) | 0] ? triangles[i] : -1));
    for (const set of sets.values()) uploadLines(set);
    coarseArrays = null;
  }

  /** The arrays of the coarser mesh, made anew when places or shades are others. */
  let coarseArrays = null;
  function arraysOfCoarse({ kept, corners }) {
    if (coarseArrays) return coarseArrays;
    const [places, shades] = [gl.createBuffer(), gl.createBuffer()];
    uploadPlaces(places, corners.length, (i) => corners[i]);
    uploadShades(shades, kept.length, (i) => kept[i]);
    return (coarseArrays = arraysOf(places, shades));
  }

  function uploadLines(set) {
    const data = new Float32Array(set.pairs.length * 3);
    set.pairs.forEach((v, i) => { for (let k = 0; k < 3; k++) data[3 * i + k] = set.points.unit[3 * v + k] - origin[k]; });
    gl.bindBuffer(gl.ARRAY_BUFFER, set.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
  }

  /** The arrays of a list of edges, made when first drawn. */
  function linesOf(name, of, list) {
    let set = sets.get(name);
    if (set && set.pairs === list) return set;
    set = { buffer: gl.createBuffer(), arrays: gl.createVertexArray(), points: of, pairs: list };
    sets.set(name, set);
    gl.bindVertexArray(set.arrays);
    gl.bindBuffer(gl.ARRAY_BUFFER, set.buffer);
    for (const at of [0, 1]) {
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, 3, gl.FLOAT, false, 24, 12 * at);
      gl.vertexAttribDivisor(at, 1);
    }
    uploadLines(set);
    gl.bindVertexArray(null);
    return set;
  }

  function aim(program) {
    const { centre, zoom, rotation, width, height } = camera;
    gl.uniformMatrix3fv(program.at("rotation"), true, rotation);
    gl.uniform3f(program.at("centre"), ...centre.map((c, k) => c - origin[k]));
    gl.uniform2f(program.at("scale"), (2 * zoom) / width, (2 * zoom) / height);
    gl.uniform1f(program.at("depth"), spatial ? 0.5 : 0);
  }

  function drawLines(dots, { name, of, list, width, ink }) {
    if (!list.length) return;
    const set = linesOf(name, of, list);
    line.use();
    aim(line);
    gl.uniform2f(line.at("halfSize"), canvas.width / 2, canvas.height / 2);
    gl.uniform1f(line.at("width"), width * dots);
    gl.uniform1f(line.at("lift"), spatial ? 0.002 : 0);
    gl.uniform3f(line.at("ink"), ...ink.map((x) => x / 255));
    gl.bindVertexArray(set.arrays);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, list.length / 2);
    gl.disable(gl.BLEND);
  }

  upload();
  return {
    kind: "webgl2",
    setShades(of) {
      tones = of;
      uploadShades(shades, count, (t) => t);
      coarseArrays = null;
    },
    setPalette(colours) {
      gl.bindTexture(gl.TEXTURE_2D, texture);
      const data = new Uint8Array(colours.flatMap((c) => [...c, 255]));
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, data);
      for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    },
    /** Waits until what was drawn is there. */
    finish() { gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); },
    draw({ dots, wire, frame, fresh, lines, detail }) {
      const far = Math.max(...camera.centre.map((c, k) => Math.abs(c - origin[k]))) * camera.zoom;
      if (far > 1 << 19) { origin = [...camera.centre]; upload(); }
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.clearColor(1, 1, 1, 1);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      if (spatial) gl.enable(gl.DEPTH_TEST);
      surface.use();
      aim(surface);
      // Lines of the coarser mesh would show triangles that there are not.
      gl.uniform1f(surface.at("wire"), wire && !detail ? 1 : 0);
      gl.uniform1i(surface.at("spatial"), spatial);
      gl.uniform1i(surface.at("clockwise"), 0);
      gl.uniform1i(surface.at("newest"), frame < count ? frame - 1 : -1);
      gl.uniform1i(surface.at("fresh"), fresh);
      gl.uniform1f(surface.at("dots"), dots);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.bindVertexArray(detail ? arraysOfCoarse(detail) : surfaceArrays);
      gl.drawArrays(gl.TRIANGLES, 0, detail ? detail.corners.length : 3 * frame);
      for (const set of lines) drawLines(dots, set);
      gl.bindVertexArray(null);
    },
  };
}
