"use strict";
// Three-dimensional replay of a run: skin, wheels and barrier over time, drawn with WebGL 2 and nothing else.
// replayPanel(box, data) puts a picture with its buttons and its scale into `box`; .show(ms) draws an instant.

function replayPanel(box, data) {
  const element = (name, more, ...inner) => {
    const made = Object.assign(document.createElement(name), more);
    made.append(...inner);
    return made;
  };
  const replay = makeReplay(box, data);
  if (!replay.drawn) {
    box.append(element("p", { className: "replay-note" },
      "This browser does not draw in three dimensions (WebGL 2 is missing or switched off)."));
    return replay;
  }
  const views = Object.keys(data.views).map((name) =>
    element("button", { type: "button", textContent: name, onclick: () => replay.look(name) }));
  const sees = element("input", { type: "checkbox", checked: data.seeThrough });
  sees.addEventListener("change", () => replay.seeThrough(sees.checked));
  const closer = [["+", 0.8, "closer"], ["\u2212", 1.25, "farther"]].map(([text, factor, title]) =>
    element("button", { type: "button", textContent: text, title, onclick: () => replay.zoom(factor) }));
  const bar = element("span", { className: "replay-bar" });
  bar.style.background = `linear-gradient(to right, ${data.colors.join(", ")})`;
  box.append(
    element("div", { className: "replay-tools" }, ...views, ...closer,
      element("label", {}, sees, " see through the barrier")),
    element("div", { className: "replay-scale" }, "moved 0 ", bar, ` ${data.greatest.toFixed(2)} m`),
    element("p", { className: "replay-note" },
      "Drag to turn, Shift and wheel or two fingers to zoom, double click to go back. Lines on the ground are 1 m apart."),
  );
  return replay;
}

function makeReplay(box, data) {
  const canvas = document.createElement("canvas");
  canvas.className = "replay-canvas";
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", "three-dimensional view of the run");
  // Without alpha: what lies below the picture must not shine through what is drawn half transparent.
  const gl = canvas.getContext("webgl2", { alpha: false, antialias: true, preserveDrawingBuffer: true });
  if (!gl) return { show() {}, drawn: false };
  box.appendChild(canvas);

  // ---- numbers of the page -------------------------------------------------------------------------------
  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
  const lengths = (text) => Float32Array.from(new Int16Array(bytes(text)), (mm) => mm * data.unit);
  const units = data.units.map((unit) => ({
    rest: lengths(unit.rest),
    faces: new Uint32Array(bytes(unit.faces)),
    moving: new Uint32Array(bytes(unit.moving)),
    moved: lengths(unit.moved),
    center: unit.center,
    rotation: unit.rotation,
    wheels: unit.wheels,
  }));

  // ---- drawing -------------------------------------------------------------------------------------------
  const vertexText = `#version 300 es
    in vec3 place; in float crush;
    uniform mat4 pose, view, lens;
    out vec3 seen; out float depth;
    void main() {
      vec4 p = view * pose * vec4(place, 1.0);
      seen = p.xyz; depth = crush;
      gl_Position = lens * p;
      gl_PointSize = 5.0; // of a vehicle that is nodes without a skin
    }`;
  const fragmentText = `#version 300 es
    precision highp float;
    in vec3 seen; in float depth;
    uniform vec4 color; uniform float greatest; uniform vec3 scale[6]; uniform bool flatLight;
    out vec4 pixel;
    vec3 crushColor(float x) {
      float k = clamp(x / greatest, 0.0, 1.0) * 5.0;
      int i = min(int(k), 4);
      return mix(scale[i], scale[i + 1], k - float(i));
    }
    void main() {
      vec3 base = greatest > 0.0 ? crushColor(depth) : color.rgb;
      float light = 1.0;
      if (flatLight) {
        vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
        light = 0.45 + 0.55 * abs(dot(normal, normalize(vec3(0.35, 0.55, 0.75))));
      }
      pixel = vec4(base * light, color.a);
    }`;
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertexText], [gl.FRAGMENT_SHADER, fragmentText]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  gl.useProgram(program);
  const at = {};
  for (const name of ["pose", "view", "lens", "color", "greatest", "scale", "flatLight"]) {
    at[name] = gl.getUniformLocation(program, name);
  }
  const placeAt = gl.getAttribLocation(program, "place");
  const crushAt = gl.getAttribLocation(program, "crush");
  const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255);
  gl.uniform3fv(at.scale, data.colors.flatMap(rgb));

  function body(vertices, indices, mode = gl.TRIANGLES) {
    const places = gl.createBuffer();
    const crushes = gl.createBuffer();
    const order = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, places);
    gl.bufferData(gl.ARRAY_BUFFER, vertices, gl.DYNAMIC_DRAW);
    gl.bindBuffer(gl.ARRAY_BUFFER, crushes);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(vertices.length / 3), gl.DYNAMIC_DRAW);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, order);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    return { places, crushes, order, count: indices.length, mode };
  }
  function draw(part, pose, color, { greatest = 0, light = true, alpha = 1 } = {}) {
    gl.bindBuffer(gl.ARRAY_BUFFER, part.places);
    gl.enableVertexAttribArray(placeAt);
    gl.vertexAttribPointer(placeAt, 3, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, part.crushes);
    gl.enableVertexAttribArray(crushAt);
    gl.vertexAttribPointer(crushAt, 1, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, part.order);
    gl.uniformMatrix4fv(at.pose, false, pose);
    gl.uniform4f(at.color, ...rgb(color), alpha);
    gl.uniform1f(at.greatest, greatest);
    gl.uniform1i(at.flatLight, light ? 1 : 0);
    gl.drawElements(part.mode, part.count, gl.UNSIGNED_INT, 0);
  }
  function cylinder([x, y, z, radius]) {
    const sides = 24, half = 0.3 * radius, vertices = [], indices = [];
    for (let i = 0; i < sides; i += 1) {
      const angle = (2 * Math.PI * i) / sides;
      for (const side of [-half, half]) {
        vertices.push(x + radius * Math.cos(angle), y + side, z + radius * Math.sin(angle));
      }
      const a = 2 * i, b = (2 * i + 2) % (2 * sides);
      indices.push(a, a + 1, b, b, a + 1, b + 1, 2 * sides, a, b, 2 * sides + 1, b + 1, a + 1);
    }
    vertices.push(x, y - half, z, x, y + half, z);
    return body(Float32Array.from(vertices), Uint32Array.from(indices));
  }
  function lines(low, high) {
    const vertices = [], indices = [];
    const add = (...ends) => {
      indices.push(vertices.length / 3, vertices.length / 3 + 1);
      vertices.push(...ends);
    };
    for (let x = low[0]; x <= high[0]; x += 1) add(x, low[1], 0, x, high[1], 0);
    for (let y = low[1]; y <= high[1]; y += 1) add(low[0], y, 0, high[0], y, 0);
    return body(Float32Array.from(vertices), Uint32Array.from(indices), gl.LINES);
  }
  for (const unit of units) {
    unit.now = unit.rest.slice();
    unit.crush = new Float32Array(unit.rest.length / 3);
    unit.skin = unit.faces.length > 0 ? body(unit.now, unit.faces)
      : body(unit.now, Uint32Array.from(unit.crush.keys()), gl.POINTS);
    unit.tires = unit.wheels.map(cylinder);
    // Quads come as two halves of the list of triangles, abc and acd: edges ab, bc, cd, da.
    const half = unit.faces.length / 2, edges = [];
    for (let k = 0; k < half; k += 3) {
      const [a, b, c, d] = [unit.faces[k], unit.faces[k + 1], unit.faces[k + 2], unit.faces[half + k + 2]];
      edges.push(a, b, b, c, c, d, d, a);
    }
    const order = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, order);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, Uint32Array.from(edges), gl.STATIC_DRAW);
    unit.mesh = { ...unit.skin, order, count: edges.length, mode: gl.LINES };
  }
  const barrier = data.barrier.map((part) => ({
    ...part,
    mesh: body(new Float32Array(bytes(part.vertices)), new Uint32Array(bytes(part.faces))),
  }));
  const [low, high] = data.ground;
  const floor = body(Float32Array.of(low[0], low[1], -0.02, high[0], low[1], -0.02, high[0], high[1], -0.02,
    low[0], high[1], -0.02), Uint32Array.of(0, 1, 2, 0, 2, 3));
  const grid = lines(low, high);
  const still = Float32Array.of(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);

  // ---- places at an instant, linear between the frames ---------------------------------------------------
  function between(ms) {
    const t = data.time;
    let k = 0;
    while (k < t.length - 2 && t[k + 1] <= ms) k += 1;
    const share = t.length < 2 ? 0 : Math.min(1, Math.max(0, (ms - t[k]) / (t[k + 1] - t[k])));
    return [k, Math.min(k + 1, t.length - 1), share];
  }
  const mixed = (a, b, s) => a.map((x, i) => x + s * (b[i] - x));
  function poseOf([w, x, y, z], [px, py, pz]) {
    const n = 2 / (w * w + x * x + y * y + z * z);
    return Float32Array.of(
      1 - n * (y * y + z * z), n * (x * y + w * z), n * (x * z - w * y), 0,
      n * (x * y - w * z), 1 - n * (x * x + z * z), n * (y * z + w * x), 0,
      n * (x * z + w * y), n * (y * z - w * x), 1 - n * (x * x + y * y), 0,
      px, py, pz, 1,
    );
  }
  function move(unit, [i, j, share]) {
    const m = unit.moving.length, a = 3 * m * i, b = 3 * m * j;
    for (let k = 0; k < m; k += 1) {
      let square = 0;
      for (let axis = 0; axis < 3; axis += 1) {
        const from = unit.moved[a + 3 * k + axis];
        const by = from + share * (unit.moved[b + 3 * k + axis] - from);
        unit.now[3 * unit.moving[k] + axis] = unit.rest[3 * unit.moving[k] + axis] + by;
        square += by * by;
      }
      unit.crush[unit.moving[k]] = Math.sqrt(square);
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, unit.skin.places);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, unit.now);
    gl.bindBuffer(gl.ARRAY_BUFFER, unit.skin.crushes);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, unit.crush);
    unit.pose = poseOf(mixed(unit.rotation[i], unit.rotation[j], share), mixed(unit.center[i], unit.center[j], share));
  }
  // Of an element of the barrier that moves: p -> turn (p - center) + center + shift. The turn is stored row by row.
  function poseOfElement(part, [i, j, share]) {
    if (!part.center) return still;
    const t = mixed(part.turn[i], part.turn[j], share), shift = mixed(part.shift[i], part.shift[j], share);
    const at = part.center.map((x, a) => x + shift[a] - t[3 * a] * part.center[0] - t[3 * a + 1] * part.center[1]
      - t[3 * a + 2] * part.center[2]);
    return Float32Array.of(t[0], t[3], t[6], 0, t[1], t[4], t[7], 0, t[2], t[5], t[8], 0, ...at, 1);
  }

  // ---- camera --------------------------------------------------------------------------------------------
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const unitOf = (a) => a.map((x) => x / Math.hypot(...a));
  const camera = { ...data.camera };
  let seeThrough = data.seeThrough, instant = data.time[0];
  function eye() { // from the point that is looked at
    const flat = Math.cos(camera.up);
    const away = [flat * Math.cos(camera.around), flat * Math.sin(camera.around), Math.sin(camera.up)];
    return away.map((x) => camera.far * x);
  }
  function render() {
    const ratio = Math.min(2, globalThis.devicePixelRatio || 1);
    const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
    if (width === 0 || height === 0) return;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const now = between(instant);
    const target = data.targets.length === 1 ? data.targets[0]
      : mixed(data.targets[now[0]], data.targets[now[1]], now[2]);
    const away = eye();
    const place = target.map((x, i) => x + away[i]);
    const back = unitOf(away);
    const right = unitOf(cross([0, 0, 1], back));
    const up = cross(back, right);
    const view = Float32Array.of(right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2],
      back[2], 0, -dot(right, place), -dot(up, place), -dot(back, place), 1);
    // A tall, narrow picture sees as much across as a square one.
    const aspect = width / height, f = 1 / Math.tan(0.3) * Math.min(1, aspect);
    const near = 0.02 * camera.far, far = camera.far * 4 + 200;
    const lens = Float32Array.of(f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0,
      (2 * far * near) / (near - far), 0);
    gl.viewport(0, 0, width, height);
    gl.clearColor(0.94, 0.96, 0.98, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.uniformMatrix4fv(at.view, false, view);
    gl.uniformMatrix4fv(at.lens, false, lens);
    if (data.hasGround) {
      draw(floor, still, "#e4e6e2", { light: false });
      draw(grid, still, "#c3c7c0", { light: false });
    }
    for (const unit of units) {
      move(unit, now);
      gl.enable(gl.POLYGON_OFFSET_FILL);
      gl.polygonOffset(1, 1);
      draw(unit.skin, unit.pose, "#dce2e8", { greatest: data.greatest });
      gl.disable(gl.POLYGON_OFFSET_FILL);
      gl.enable(gl.BLEND);
      gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
      draw(unit.mesh, unit.pose, "#404040", { light: false, alpha: 0.22 });
      gl.disable(gl.BLEND);
      for (const tire of unit.tires) draw(tire, unit.pose, "#2b2b2b");
    }
    if (seeThrough) {
      gl.enable(gl.BLEND);
      gl.depthMask(false);
    }
    for (const part of barrier) {
      draw(part.mesh, poseOfElement(part, now), "#b9b4aa", { alpha: seeThrough ? 0.3 : 1 });
    }
    gl.depthMask(true);
  }
  let waiting = false;
  function soon() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      render();
    });
  }

  // ---- hand ----------------------------------------------------------------------------------------------
  const fingers = new Map();
  const spread = () => {
    const [a, b] = [...fingers.values()];
    return Math.hypot(a[0] - b[0], a[1] - b[1]);
  };
  canvas.addEventListener("pointerdown", (event) => {
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = fingers.get(event.pointerId);
    if (!last) return;
    const before = fingers.size === 2 ? spread() : 0;
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    if (fingers.size === 2) {
      zoom(before / Math.max(1, spread()));
    } else {
      camera.around -= 0.008 * (event.clientX - last[0]);
      camera.up = Math.min(1.55, Math.max(0.02, camera.up + 0.008 * (event.clientY - last[1])));
      soon();
    }
  });
  for (const name of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(name, (event) => fingers.delete(event.pointerId));
  }
  function zoom(factor) {
    camera.far = Math.min(8, Math.max(0.15, (camera.far * factor) / data.camera.far)) * data.camera.far;
    soon();
  }
  canvas.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && !event.shiftKey) return; // the page scrolls
    event.preventDefault();
    zoom(Math.exp(0.002 * (event.deltaY || event.deltaX)));
  }, { passive: false });
  canvas.addEventListener("dblclick", () => {
    Object.assign(camera, data.camera);
    soon();
  });
  new ResizeObserver(soon).observe(canvas);
  globalThis.addEventListener("beforeprint", render);

  return {
    drawn: true,
    canvas,
    show(ms) {
      instant = ms;
      soon();
    },
    look(view) { // of data.views
      Object.assign(camera, data.camera, data.views[view]);
      soon();
    },
    zoom,
    seeThrough(on) {
      seeThrough = on;
      soon();
    },
  };
}
