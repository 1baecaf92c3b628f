/* The blade in motion: modes and the chosen point, drawn with WebGL 2. */
const Blade = (() => {
  "use strict";
  const {$, NBSP, number, unit, LENGTH} = Plot;
  const HARMONICS = 5, INSTANTS = 24, PRESSURE = [["GPa", 1e9], ["MPa", 1e6], ["kPa", 1e3], ["Pa", 1]];
  const pairs = [...Array(HARMONICS).keys()];
  const VERTEX = `#version 300 es
    in vec3 base; in float value;
    ${pairs.map(k => `in vec3 re${k}; in vec3 im${k};`).join("\n")}
    uniform mat3 turn, view; uniform vec3 centre; uniform vec2 size; uniform vec4 shift;
    uniform float phase[${2 * HARMONICS}];
    out vec3 at; out float shade;
    void main() {
      vec3 x = base;
      ${pairs.map(k => `x += phase[${2 * k}] * re${k} + phase[${2 * k + 1}] * im${k};`).join("\n")}
      at = view * (turn * x - centre);
      shade = value;
      gl_Position = vec4(at.xy * size + shift.xy, -at.z * shift.w, 1);
    }`;
  const RAMP = [[38, 70, 120], [52, 128, 150], [120, 176, 130], [230, 190, 90], [190, 60, 40]];
  const FRAGMENT = `#version 300 es
    precision highp float;
    in vec3 at; in float shade; out vec4 colour; uniform float faint;
    void main() {
      vec3 c[5] = vec3[5](${RAMP.map(c => `vec3(${c.map(v => (v / 255).toFixed(3))})`).join(",")});
      float s = clamp(shade, 0., 1.) * 4.; int i = min(int(s), 3);
      vec3 n = normalize(cross(dFdx(at), dFdy(at)));
      float light = .45 + .55 * abs(dot(n, normalize(vec3(.3, .5, .8))));
      colour = vec4(mix(mix(c[i], c[i + 1], s - float(i)), vec3(.75), faint) * light, 1);
    }`;

  const decode = (text, Type) => {
    const bytes = Plot.bytes(text);
    return new Type(bytes.buffer, 0, Math.floor(bytes.length / Type.BYTES_PER_ELEMENT));
  };
  /* square of the von Mises stress of components xx, yy, zz, xy, yz, xz from i on */
  const mises = (s, i) =>
      ((s[i] - s[i + 1]) ** 2 + (s[i + 1] - s[i + 2]) ** 2 + (s[i + 2] - s[i]) ** 2) / 2 +
      3 * (s[i + 3] ** 2 + s[i + 4] ** 2 + s[i + 5] ** 2);

  if (!$("blade-data") || !$("blade-canvas")) return null;
  const D = JSON.parse($("blade-data").textContent), canvas = $("blade-canvas");
  const gl = canvas.getContext("webgl2", {antialias: true});
  if (!gl) {
    $("blade-note").textContent =
        "The surface of the mesh. It moves in a browser with WebGL 2; this one has none.";
    for (const e of document.querySelectorAll("#blade .tools, #blade .hint")) e.remove();
    return null;
  }

  /* ---------------------------------------------------------------- surface and modes */
  const n = D.nodes, wide = n >= 65536;
  const base = Float32Array.from(
      decode(D.position, Uint16Array).subarray(0, 3 * n),
      (v, i) => D.lo[i % 3] + D.size[i % 3] * v / 65535);
  const index = decode(D.index, wide ? Uint32Array : Uint16Array).subarray(0, 3 * D.triangles);
  for (const m of D.modes) {
    m.data = decode(m.data, Int8Array);
    if (m.im) m.im = decode(m.im, Int8Array); /* a travelling wave of a disc */
  }
  for (const p of D.points) p.q = decode(p.q, Float32Array);
  const centre = D.lo.map((v, d) => v + D.size[d] / 2), radius = Math.hypot(...D.size) / 2;

  /* ---------------------------------------------------------------- what is shown */
  const shown = {key: "", harmonics: [], order: 1, most: 1, value: new Float32Array(n), top: 1};
  /* A harmonic of displacement (3 a node) or stress (6): sum of the modes of its wave by their
   * amplitudes. A wave that runs backwards has the conjugate shapes. */
  function sum({q, wave, back}, from, width) {
    const re = new Float32Array(width * n), im = new Float32Array(width * n), sign = back ? -1 : 1;
    D.modes.filter(m => (m.w || 0) === wave).forEach((m, i) => {
      const scale = (width === 3 ? m.d : m.s) / 127, a = q[2 * i] * scale, b = q[2 * i + 1] * scale;
      if (a === 0 && b === 0) return;
      for (let v = 0; v < n; v++)
        for (let c = 0; c < width; c++) {
          const x = m.data[9 * v + from + c], y = m.im ? sign * m.im[9 * v + from + c] : 0;
          re[width * v + c] += a * x - b * y;
          im[width * v + c] += b * x + a * y;
        }
    });
    return {re, im};
  }
  /* The greatest over the period at every node of the root of a quadratic form. One harmonic has it
   * in closed form: form(re c - im s) = (a + b)/2 + (a - b)/2 cos 2t - mixed sin 2t. */
  function greatest(list, ks, width, form) {
    const most = new Float32Array(n);
    if (list.length === 1) {
      const {re, im} = list[0], both = new Float32Array(width * n);
      for (let i = 0; i < both.length; i++) both[i] = re[i] + im[i];
      for (let v = 0, i = 0; v < n; v++, i += width) {
        const a = form(re, i), b = form(im, i), mixed = (form(both, i) - a - b) / 2;
        most[v] = Math.sqrt(Math.max(0, (a + b) / 2 + Math.hypot((a - b) / 2, mixed)));
      }
      return most;
    }
    const x = new Float32Array(width * n);
    for (let t = 0; t < INSTANTS; t++) {
      x.fill(0);
      list.forEach(({re, im}, j) => {
        const angle = 2 * Math.PI * ks[j] * t / INSTANTS, c = Math.cos(angle), s = Math.sin(angle);
        for (let i = 0; i < x.length; i++) x[i] += re[i] * c - im[i] * s;
      });
      for (let v = 0, i = 0; v < n; v++, i += width) most[v] = Math.max(most[v], form(x, i));
    }
    return most.map(Math.sqrt);
  }
  const square = (x, i) => x[i] ** 2 + x[i + 1] ** 2 + x[i + 2] ** 2;
  let point = null; /* chosen on the curves */
  const title = i =>
      `Mode ${i % D.row + 1}` + (D.waves ? ` of nodal diameter ${D.waves[D.modes[i].w]}` : "");
  function load() {
    const key = $("blade-shown").value, colour = $("blade-colour").value;
    let ks = [1], qs, order = 1, lag = 0, name;
    if (key === "point" && point) {
      ks = point.k;
      order = point.order;
      lag = point.lag;
      qs = ks.map((_, j) => ({
        q: point.q.subarray(2 * j * D.row, 2 * (j + 1) * D.row),
        wave: point.w ? point.w[j] : 0,
        back: point.back && point.back[j]
      }));
      name = point.name;
    } else {
      const i = Math.max(0, +key || 0), q = new Float32Array(2 * D.row), wave = D.modes[i].w || 0;
      q[2 * (i % D.row)] = 1;
      qs = [{q, wave}];
      lag = D.waves ? 2 * Math.PI * D.waves[wave] / D.blades : D.lag;
      name = `${title(i)}, ${number(D.modes[i].f, 5)}${NBSP}Hz, the contact free`;
    }
    const motion = qs.map(q => sum(q, 0, 3)), u = greatest(motion, ks, 3, square);
    const value = colour === "motion" ? u : greatest(qs.map(q => sum(q, 3, 6)), ks, 6, mises);
    shown.most = u.reduce((a, b) => Math.max(a, b), 0) || 1;
    const top = value.reduce((a, b) => Math.max(a, b), 0) || 1;
    shown.harmonics = motion;
    shown.ks = ks;
    shown.order = order;
    shown.lag = lag;
    shown.value = value.map(v => v / top);
    shown.real = key === "point" && !!point;
    const list = colour === "motion" ? LENGTH : PRESSURE, w = unit(list, top);
    const ends = $("blade-bar").querySelectorAll("span");
    ends[0].textContent = colour === "motion" ? "displacement, amplitude 0" : "von Mises stress 0";
    ends[1].textContent = shown.real ? number(top / w[1], 3) + NBSP + w[0] : "largest";
    shown.name = name;
    upload();
    note();
  }
  const factor = () => $("blade-scale").value / 100 * 0.3 * radius / shown.most;
  function note() {
    const text = [shown.name];
    if (shown.real) {
      const u = unit(LENGTH, shown.most);
      text.push(`largest displacement ${number(shown.most / u[1], 3)}${NBSP}${u[0]}, drawn ×${
          number(factor(), 2, false)}`);
      text.push(
          "sum of the modes in this page: stress is the vibration's, to about 1 % of the " +
          "largest, without the static share of higher modes");
    }
    if (D.modesLeftOut) text.push(`${D.modesLeftOut} higher modes left out`);
    $("blade-note").textContent = text.join("; ") + ".";
  }

  /* ---------------------------------------------------------------- WebGL */
  function compile() {
    const program = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS))
        throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    return program;
  }
  const program = compile(), buffers = {};
  gl.useProgram(program);
  gl.enable(gl.DEPTH_TEST);
  const at = name => gl.getUniformLocation(program, name);
  const where = {};
  for (const name of ["turn", "view", "centre", "size", "shift", "phase", "faint"])
    where[name] = at(name);
  function set(name, width, data) {
    const slot = gl.getAttribLocation(program, name);
    if (slot < 0) return;
    if (!data) {
      gl.disableVertexAttribArray(slot);
      gl.vertexAttrib3f(slot, 0, 0, 0);
      return;
    }
    if (!buffers[name]) buffers[name] = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name]);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(slot);
    gl.vertexAttribPointer(slot, width, gl.FLOAT, false, 0, 0);
  }
  function upload() {
    pairs.forEach(k => {
      const h = shown.harmonics[k];
      set("re" + k, 3, h && h.re);
      set("im" + k, 3, h && h.im);
    });
    set("value", 1, shown.value);
    draw();
  }
  set("base", 3, base);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, index, gl.STATIC_DRAW);

  /* ---------------------------------------------------------------- camera */
  const cross = (a, b) =>
      [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const axial = D.axis, radial = Math.abs(axial[2]) > 0.5 ? [1, 0, 0] : [0, 0, 1],
        across = cross(axial, radial);
  const camera = {yaw: 0.7, tilt: 0.3, zoom: 1, x: 0, y: 0};
  const home = () => Object.assign(camera, {yaw: 0.7, tilt: 0.3, zoom: 1, x: 0, y: 0});
  function viewRows() {
    const c = Math.cos(camera.yaw), s = Math.sin(camera.yaw), ct = Math.cos(camera.tilt),
          st = Math.sin(camera.tilt);
    const rows = [[], [], []];
    for (let d = 0; d < 3; d++) {
      const depth = c * axial[d] - s * across[d];
      rows[0][d] = c * across[d] + s * axial[d];
      rows[1][d] = ct * radial[d] + st * depth;
      rows[2][d] = st * radial[d] - ct * depth;
    }
    return rows;
  }
  const columns = rows => [0, 1, 2].flatMap(d => rows.map(r => r[d]));
  /* Rows of the rotation by an angle about the engine axis. */
  function turned(angle) {
    const c = Math.cos(angle), s = Math.sin(angle), a = axial;
    return [0, 1, 2].map(i => [0, 1, 2].map(j => {
      const skew = i === j ? 0 : (j === (i + 1) % 3 ? -1 : 1) * a[3 - i - j];
      return (i === j ? c : 0) + (1 - c) * a[i] * a[j] + s * skew;
    }));
  }
  /* What is drawn: blades from .. to, 0 being this one, and the middle and half size of them all. */
  function extent() {
    const which = $("blade-ring").value;
    if (which !== "all")
      return {from: -which, to: +which, centre, radius, deep: radius * (1 + 2 * which)};
    const along = centre.reduce((sum, c, d) => sum + c * axial[d], 0);
    let ring = 0;
    for (let corner = 0; corner < 8; corner++) {
      const x = D.lo.map((v, d) => v + (corner >> d & 1) * D.size[d]);
      ring = Math.max(ring, Math.hypot(...cross(axial, x)));
    }
    return {from: 0, to: D.blades - 1, centre: axial.map(a => a * along), radius: ring, deep: ring};
  }
  let clock = 0; /* periods */
  function draw() {
    const box = canvas.parentElement, w = Math.max(280, box.clientWidth), h = Math.min(560, 0.7 * w),
          fine = Math.min(2, window.devicePixelRatio || 1);
    if (canvas.width !== Math.round(w * fine)) {
      canvas.width = Math.round(w * fine);
      canvas.height = Math.round(h * fine);
      canvas.style.height = h + "px";
    }
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const all = extent(), scale = camera.zoom * 0.95 / all.radius;
    gl.uniformMatrix3fv(where.view, false, columns(viewRows()));
    gl.uniform3fv(where.centre, all.centre);
    gl.uniform2f(where.size, scale * h / w, scale);
    gl.uniform4f(where.shift, camera.x, camera.y, 0, 0.2 / all.deep);
    const f = factor();
    for (let blade = all.from; blade <= all.to; blade++) {
      const phase = new Float32Array(2 * HARMONICS);
      shown.ks.forEach((k, j) => {
        const angle = k * (2 * Math.PI * clock / shown.order - blade * shown.lag);
        phase[2 * j] = f * Math.cos(angle);
        phase[2 * j + 1] = -f * Math.sin(angle);
      });
      gl.uniform1fv(where.phase, phase);
      gl.uniform1f(where.faint, blade ? 0.35 : 0);
      gl.uniformMatrix3fv(
          where.turn, false, columns(turned(D.blades ? 2 * Math.PI * blade / D.blades : 0)));
      gl.drawElements(gl.TRIANGLES, index.length, wide ? gl.UNSIGNED_INT : gl.UNSIGNED_SHORT, 0);
    }
  }

  /* ---------------------------------------------------------------- time and controls */
  const still = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
  let playing = !still, visible = false, last = 0, ticking = false;
  function tick(now) {
    ticking = playing && visible;
    if (!ticking) return;
    clock += Math.min(0.1, (now - last) / 1000) / 2 * shown.order;
    last = now;
    draw();
    requestAnimationFrame(tick);
  }
  function run() {
    $("blade-play").textContent = playing ? "Pause" : "Play";
    if (!ticking && playing && visible) {
      ticking = true;
      last = performance.now();
      requestAnimationFrame(tick);
    }
  }
  new IntersectionObserver(entries => {
    visible = entries[entries.length - 1].isIntersecting;
    run();
  }).observe(canvas);

  const options = D.modes.map(
      (m, i) => [i, `mode ${i % D.row + 1}${D.waves ? `, n = ${D.waves[m.w]}` : ""}, ${
          number(m.f, 5)} Hz`]);
  function fill(chosen) {
    const list = point ? [["point", "the chosen point"], ...options] : options;
    $("blade-shown").innerHTML =
        list.map(([v, text]) => `<option value="${v}">${text}</option>`).join("");
    $("blade-shown").value = String(chosen);
  }
  $("blade-shown").onchange = load;
  $("blade-colour").onchange = load;
  $("blade-scale").oninput = () => {
    note();
    draw();
  };
  if (D.blades < 2) $("blade-ring").parentElement.hidden = true;
  $("blade-ring").onchange = draw;
  $("blade-play").onclick = () => {
    playing = !playing;
    run();
  };
  $("blade-home").onclick = () => {
    home();
    draw();
  };
  const fingers = new Map();
  canvas.addEventListener("pointerdown", e => {
    fingers.set(e.pointerId, [e.clientX, e.clientY]);
    if (e.isTrusted) canvas.setPointerCapture(e.pointerId);
  });
  canvas.addEventListener("pointermove", e => {
    const before = fingers.get(e.pointerId);
    if (!before) return;
    const spread = () => {
      const [a, b] = [...fingers.values()];
      return Math.hypot(a[0] - b[0], a[1] - b[1]);
    };
    const dx = e.clientX - before[0], dy = e.clientY - before[1];
    if (fingers.size === 2) {
      const old = spread();
      fingers.set(e.pointerId, [e.clientX, e.clientY]);
      camera.zoom *= spread() / Math.max(old, 1);
    } else if (e.shiftKey) {
      camera.x += 2 * dx / canvas.clientWidth;
      camera.y -= 2 * dy / canvas.clientHeight;
    } else {
      camera.yaw += 0.01 * dx;
      camera.tilt = Math.max(-1.5, Math.min(1.5, camera.tilt + 0.01 * dy));
    }
    fingers.set(e.pointerId, [e.clientX, e.clientY]);
    draw();
  });
  for (const type of ["pointerup", "pointercancel", "lostpointercapture"])
    canvas.addEventListener(type, e => fingers.delete(e.pointerId));
  canvas.addEventListener("wheel", e => {
    e.preventDefault();
    camera.zoom = Math.max(0.3, Math.min(30, camera.zoom * Math.exp(-0.0015 * e.deltaY)));
    draw();
  }, {passive: false});
  canvas.addEventListener("keydown", e => {
    const step = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1]}[e.key];
    if (!step) return;
    camera.yaw += step[0];
    camera.tilt = Math.max(-1.5, Math.min(1.5, camera.tilt + step[1]));
    e.preventDefault();
    draw();
  });

  canvas.hidden = $("blade-bar").hidden = false;
  $("blade-still").hidden = true;
  $("blade-bar").querySelector("i").style.background =
      `linear-gradient(90deg,${RAMP.map(c => `rgb(${c})`).join()})`;
  fill(0);
  queueMicrotask(() => shown.name || load()); /* unless the page chooses a point at once */
  return {
    draw,
    /* The kept point of branch b nearest to abscissa x and amplitude a becomes the chosen one. */
    choose(b, x, a, name) {
      const list = D.points.filter(p => p.b === b);
      if (!list.length) return;
      const far = p => Math.abs(p.x / x - 1) + 0.05 * Math.abs(Math.log((p.a || 1e-30) / (a || 1e-30)));
      const best = list.reduce((m, p) => far(p) < far(m) ? p : m);
      const first = !point;
      point = {...best, name: name(best.x)};
      const keep = first ? "point" : $("blade-shown").value;
      fill(keep);
      if (keep === "point") load();
    },
    /* Displacement [node][3], m, of a blade in its own place, at an instant 0..1 of the period. */
    motion(blade, instant) {
      const x = new Float32Array(3 * n), rows = turned(D.blades ? 2 * Math.PI * blade / D.blades : 0);
      shown.harmonics.forEach(({re, im}, j) => {
        const angle = shown.ks[j] * (2 * Math.PI * instant - blade * shown.lag);
        const c = Math.cos(angle), s = Math.sin(angle);
        for (let i = 0; i < x.length; i++) x[i] += re[i] * c - im[i] * s;
      });
      return x.map((_, i) => rows[i % 3].reduce((sum, r, d) => sum + r * x[i - i % 3 + d], 0));
    },
    picture() {
      draw();
      return canvas.toDataURL("image/png");
    }
  };
})();
