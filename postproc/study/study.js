(() => {
  "use strict";
  const {$, NBSP, number, percent, escape, linearTicks, logTicks, around, axis, Panel} = Plot, {
    show,
    widthOf,
    extent
  } = Plot;
  const D = JSON.parse($("data").textContent);
  const WAITING = 0, DONE = 1, FAILED = 2, STATES = ["not run", "done", "failed", "not converged"];
  const CHARTS = [], U = D.uncertainty, R = D.robust;
  const best = U || R ? -1 : D.best; /* the lowest sample of uncertain keys is no choice */

  /* ---------------------------------------------------------------- columns */
  /* The shortest end of a key that tells it from the others; indices keep their list. */
  function shortNames(names) {
    const end = (name, n) => name.split(".").slice(-n).join(".");
    return names.map(name => {
      for (let n = 1; n < name.split(".").length; n++) {
        const short = end(name, n), before = name.split(".").slice(-n - 1)[0];
        if (!before.includes("[") && names.filter(o => end(o, n) === short).length === 1)
          return short;
      }
      return name;
    });
  }
  /* Decades where a range spans one and a third of the values lie in its lower half. */
  function inDecades(values) {
    const known = values.filter(Number.isFinite), [lo, hi] = extent(known);
    return lo > 0 && hi >= 10 * lo &&
        3 * known.filter(v => v < Math.sqrt(lo * hi)).length >= known.length;
  }
  function column(head, values, short, kind) {
    const list = values.map(v => v === null ? NaN : v), known = list.filter(Number.isFinite),
          range = known.length ? extent(known) : [0, 1];
    return {
      ...head,
      short,
      kind,
      list,
      range,
      log: inDecades(list),
      many: range[1] > range[0],
      label: short + (head.unit ? ", " + head.unit : ""),
      text: (v, digits = 4) => head.name === "stable" && !Number.isFinite(v) ? "not judged" :
          number(v / head.scale, digits, false) +
          (head.unit && Number.isFinite(v) ? (head.unit === "°" ? "" : NBSP) + head.unit : "")
    };
  }
  const keyNames = shortNames(D.keys.map(k => k.name));
  const keys = D.keys.map((k, i) => column(k, D.key[i], keyNames[i], "key"));
  const outputs = D.outputs.map(
      (o, i) => ({
        ...column(o, D.value[i].map((v, d) => D.status[d] === DONE ? v : null), o.name, "output"),
        all: D.value[i].map(v => v === null ? NaN : v),
        error: D.error[i],
        index: i
      }));
  const known = outputs.filter(o => o.list.some(Number.isFinite));
  const state = {
    output: known.find(o => o.index === D.objective) || known[0],
    colour: 0,
    log: false,
    brush: new Map(),
    chosen: -1,
    x: 0,
    y: 1,
    fixed: [],
    sort: null,
    down: false,
    rows: 25
  };
  const ids = D.status.map((s, i) => i);
  const active = i => {
    for (const [c, [lo, hi]] of state.brush)
      if (!(c.list[i] >= lo && c.list[i] <= hi)) return false;
    return true;
  };

  /* ---------------------------------------------------------------- colours */
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const ramp = () => D.ramp[dark.matches ? "dark" : "light"];
  const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const place = (c, v) => !c.many ? 0.5 :
      c.log                       ? Math.log(v / c.range[0]) / Math.log(c.range[1] / c.range[0]) :
                                    (v - c.range[0]) / (c.range[1] - c.range[0]);
  const shade = (c, v) => Math.max(0, Math.min(32, Math.round(32 * place(c, v)))) || 0;
  const colourOf = (c, v) => ramp()[shade(c, v)];
  /* Colour between two of the ramp. */
  function blend(t) {
    const at = Math.max(0, Math.min(31.999, 32 * t)) || 0, i = Math.floor(at), w = at - i;
    const part = (hex, k) => parseInt(hex.slice(1 + 2 * k, 3 + 2 * k), 16), a = ramp()[i],
          b = ramp()[i + 1];
    return [0, 1, 2].map(k => Math.round((1 - w) * part(a, k) + w * part(b, k)));
  }
  const scaleBar = (c, lead) => `<div class="scale"><span>${lead} <b>${escape(c.short)}</b>${
      c.log ? " (logarithmic)" :
              ""}</span><span>${escape(c.text(c.range[0]))}</span><i style="background:
      linear-gradient(90deg,${ramp().join()})"></i><span>${
      escape(c.text(c.range[1]))}</span></div>`;

  /* ---------------------------------------------------------------- building */
  function section(id, title, note, body) {
    $("charts").insertAdjacentHTML(
        "beforeend",
        `<section id="${id}"><h2>${title}</h2>${
            note ? `<p class="note" id="${id}-note">${note}</p>` : ""}${body}</section>`);
  }
  const card = inner => `<div class="card">${inner}</div>`;
  const plot = (id, title) =>
      `<div class="chart"><svg class="plot" id="${id}" role="img" aria-labelledby="${
          id}-title"><title id="${id}-title">${escape(title)}</title></svg><canvas></canvas><div
          class="readout" hidden></div></div>`;
  const select = (id, label, options, chosen) => `<label>${label}<select id="${id}">${
      options
          .map(
              ([v, text]) =>
                  `<option value="${v}"${v === chosen ? " selected" : ""}>${escape(text)}</option>`)
          .join("")}</select></label>`;

  /* A canvas over a chart of this height; its units are those of the SVG. */
  function canvas(id, height) {
    const c = $(id).parentElement.querySelector("canvas"), width = widthOf(id),
          shown = $(id).parentElement.clientWidth || width, ratio = window.devicePixelRatio || 1;
    c.width = Math.round(width * ratio);
    c.height = Math.round(height * ratio);
    c.style.width = shown + "px";
    c.style.height = height * shown / width + "px";
    const g = c.getContext("2d");
    g.scale(ratio, ratio);
    return g;
  }
  function clip(g, box, air = 0) {
    g.save();
    g.beginPath();
    g.rect(box.left - air, box.top - air, box.width + 2 * air, box.height + 2 * air);
    g.clip();
  }
  function disc(g, x, y, r, fill, ring) {
    g.beginPath();
    g.arc(x, y, r, 0, 7);
    if (fill) {
      g.fillStyle = fill;
      g.fill();
    }
    if (ring) {
      g.strokeStyle = ring;
      g.stroke();
    }
  }

  /* ---------------------------------------------------------------- one design */
  const rowsOf = i =>
      [...keys.map(k => [k.short, k.text(k.list[i])]), ...outputs.map(o => [o.name, textOf(o, i)])];
  function textOf(o, i) {
    const error = o.error[i], value = o.all[i];
    if (!(error > 0) || !Number.isFinite(value)) return o.text(value, 5);
    return `${number(value / o.scale, 5, false)} ± ${number(error / o.scale, 1, false)}` +
        (o.unit ? NBSP + o.unit : "");
  }
  function choose(i) {
    state.chosen = i;
    drawDock();
    drawAll();
  }
  function drawDock() {
    const dock = $("dock"), i = state.chosen;
    dock.hidden = i < 0;
    if (i < 0) return;
    const path = D.path || D.name + ".yaml", file = /^[\w./-]+$/.test(path) ? path : `"${path}"`,
          command = `shroudhb study ${file} --design ${i + 1}`;
    dock.innerHTML = `<div class="row" style="margin:0"><h3>Design ${i + 1}</h3><span>${
        STATES[D.status[i]]}${i === best ? ", the lowest" : ""}</span><button type="button"
        class="close"
        aria-label="Close">Close</button></div><dl>${
        rowsOf(i)
            .map(([k, v]) => `<div><dt>${escape(k)}</dt><dd>${escape(v)}</dd></div>`)
            .join("")}</dl>${D.reason[i] ? `<p class="reason">${escape(D.reason[i])}</p>` : ""}
        <div class="row" style="margin:0"><span>Full report:</span><code>${
        escape(command)}</code><button type="button" class="copy">Copy</button></div>`;
    dock.querySelector(".close").onclick = () => choose(-1);
    dock.querySelector(".copy").onclick = e => {
      const done = () => {
        e.target.textContent = "Copied";
      };
      if (navigator.clipboard) navigator.clipboard.writeText(command).then(done, () => {});
    };
  }
  /* Point at designs: spots is a list of [x, y, design], or a function of (x, y). */
  function pointable(id) {
    const svg = $(id), box = svg.parentElement.querySelector(".readout");
    let at = -1;
    const find = e => {
      const r = svg.getBoundingClientRect(), s = widthOf(id) / r.width,
            x = (e.clientX - r.left) * s, y = (e.clientY - r.top) * s;
      let found = -1, least = 400;
      for (const [px, py, i] of svg.spots || []) {
        const d = (px - x) ** 2 + (py - y) ** 2;
        if (d < least) [found, least] = [i, d];
      }
      return [found, x / s, y / s, r.width];
    };
    svg.addEventListener("pointermove", e => {
      const [i, x, y, width] = find(e);
      if (i !== at) {
        at = i;
        box.hidden = i < 0;
        svg.style.cursor = i < 0 ? "" : "pointer";
        if (i >= 0)
          box.innerHTML = `<b>Design ${i + 1}</b><dl>` +
              rowsOf(i).map(([k, v]) => `<dt>${escape(k)}</dt><dd>${escape(v)}</dd>`).join("") +
              "</dl>";
      }
      if (i < 0) return;
      const w = box.offsetWidth;
      box.style.left = Math.max(0, x + 16 + w > width ? x - 16 - w : x + 16) + "px";
      box.style.top = y + 12 + "px";
    });
    svg.addEventListener("pointerleave", () => {
      at = -1;
      box.hidden = true;
    });
    svg.addEventListener("click", e => {
      const [i] = find(e);
      if (i >= 0) choose(i === state.chosen ? -1 : i);
    });
  }

  /* ---------------------------------------------------------------- response curves */
  const curves = D.curves && decode(D.curves);
  function decode(c) {
    const all = new Float32Array(Uint8Array.from(atob(c.data), b => b.charCodeAt(0)).buffer),
          n = all.length / 2;
    return {...c, f: all.subarray(0, n), a: all.subarray(n), n, of: runsOf(c)};
  }
  /* First and last run of each design. */
  function runsOf(c) {
    let j = 0;
    return D.status.map((s, i) => {
      const first = j;
      while (j < c.run.length && c.run[j] < c.start[i + 1]) j++;
      return [first, j];
    });
  }
  /* Path of design i through the panel; kind(code & 3) tells which runs. */
  function trace(g, p, i, kind) {
    const [first, last] = curves.of[i];
    for (let j = first; j < last; j++) {
      const code = curves.code[j], end = j + 1 < last ? curves.run[j + 1] : curves.start[i + 1];
      if (!kind(code & 3)) continue;
      const from = code & 4 ? curves.run[j] : curves.run[j] - 1;
      for (let k = from; k < end; k++) {
        const x = p.x(curves.f[k]), y = p.y(Math.max(curves.a[k], 1e-9 * p.ay.hi));
        if (k === from)
          g.moveTo(x, y);
        else
          g.lineTo(x, y);
      }
    }
  }
  function drawCurves() {
    const id = "curves-chart", height = widthOf(id) < 640 ? 380 : 500, width = widthOf(id);
    const shown = ids.filter(i => active(i) && curves.start[i + 1] > curves.start[i]);
    let most = 0;
    for (const i of shown)
      for (let k = curves.start[i]; k < curves.start[i + 1]; k++)
        if (curves.a[k] > most) most = curves.a[k];
    const u = Plot.unit(Plot.LENGTH, most), top = most > 0 ? most : u[1];
    const y = state.log ? {lo: 1e-3 * top, hi: 1.4 * top, log: true} :
                          {lo: 0, hi: 1.06 * top, log: false};
    const [lo, hi] = extent(curves.f);
    const p = new Panel(
        id, {left: 60, top: 34, width: width - 80, height: height - 84},
        axis(hi > lo ? {lo, hi, log: false} : around(lo, hi, false), 1, "frequency, Hz"),
        axis(y, u[1], `amplitude of the first harmonic, ${u[0]}`));
    show(id, height, [p]);
    const g = canvas(id, height), c = keys[state.colour], many = shown.length;
    clip(g, p.box, 1);
    g.lineJoin = "round";
    g.globalAlpha = Math.max(0.12, Math.min(1, 60 / Math.max(many, 1)));
    const order = shown.slice().sort((a, b) => place(c, c.list[a]) - place(c, c.list[b]));
    const styles = many > 120 ?
        [[1.1, [], () => true]] :
        [[1.7, [], k => k === 2], [0.9, [], k => k === 0], [1.7, [2, 3], k => k === 1]];
    for (const i of order) {
      g.strokeStyle = colourOf(c, c.list[i]);
      for (const [w, dash, kind] of styles) {
        g.lineWidth = w;
        g.setLineDash(dash);
        g.beginPath();
        trace(g, p, i, kind);
        g.stroke();
      }
    }
    g.globalAlpha = 1;
    g.setLineDash([]);
    if (state.chosen >= 0) {
      for (const [w, colour] of [[6, css("--card")], [3, css("--ink")]]) {
        g.lineWidth = w;
        g.strokeStyle = colour;
        g.beginPath();
        trace(g, p, state.chosen, () => true);
        g.stroke();
      }
    }
    g.restore();
    $(id).spots = shown.flatMap(i => {
      const list = [];
      for (let k = curves.start[i]; k < curves.start[i + 1]; k++)
        list.push([p.x(curves.f[k]), p.y(curves.a[k]), i]);
      return list;
    });
    $("curves-scale").innerHTML = scaleBar(c, "Colour:");
  }
  function buildCurves() {
    if (!curves || !curves.n) return;
    section(
        "curves", "Response curves",
        "Each curve is one design; its colour is the value of the chosen variable. " +
            (ids.length > 120 ? "" : "Solid: stable. Dotted: not stable. Thin: not judged."),
        card(
            `<div class="tools"><fieldset><legend>Amplitude</legend><span class="switch">
            <button type="button" data-log="0">Linear</button><button type="button"
            data-log="1">Logarithmic</button></span></fieldset></div>` +
            plot("curves-chart", "Amplitude over frequency for each design") +
            `<div id="curves-scale"></div>`));
    const buttons = [...document.querySelectorAll("[data-log]")];
    const press = () => buttons.forEach(
        b => b.setAttribute("aria-pressed", String((b.dataset.log === "1") === state.log)));
    for (const b of buttons)
      b.onclick = () => {
        state.log = b.dataset.log === "1";
        press();
        drawCurves();
      };
    press();
    pointable("curves-chart");
    CHARTS.push(drawCurves);
  }

  /* ---------------------------------------------------------------- over each variable */
  const rangeOf = c => around(c.range[0], c.range[1], c.log);
  const marks = shown => shown.length > 600 ? 1.8 : shown.length > 150 ? 2.6 : 3.8;
  function dots(g, p, xs, ys, colour, spots) {
    const shown = ids.filter(i => Number.isFinite(xs(i)) && Number.isFinite(ys(i))),
          r = marks(shown);
    clip(g, p.box, 6);
    for (const i of shown) {
      const x = p.x(xs(i)), y = p.y(ys(i));
      g.globalAlpha = active(i) ? 0.85 : 0.1;
      disc(g, x, y, r, colour(i));
      if (active(i)) spots.push([x, y, i]);
    }
    g.globalAlpha = 1;
    g.lineWidth = 2;
    for (const [i, colour] of [[best, css("--accent")], [state.chosen, css("--ink")]])
      if (i >= 0 && Number.isFinite(xs(i) + ys(i)))
        disc(g, p.x(xs(i)), p.y(ys(i)), r + 3.5, null, colour);
    g.restore();
  }
  function drawEffects() {
    const o = state.output, height = 250, c = keys[state.colour];
    keys.forEach((k, j) => {
      if (!k.many) return;
      const id = "effect-" + j, effect = D.effects[o.index][j];
      const p = new Panel(
          id, {left: 60, top: 34, width: widthOf(id) - 76, height: height - 84},
          axis(rangeOf(k), k.scale, k.label), axis(rangeOf(o), o.scale, o.label));
      if (effect.at.length > 1 && !D.optimum) p.line("mean", effect.at, effect.mean);
      const share = effect.share === null || (U && U.total) ?
          "" :
          `<text class="axis end" x="${widthOf(id) - 16}" y="20" text-anchor="end">${
              percent(effect.share)}</text>`;
      show(id, height, [p], share);
      const spots = [];
      dots(
          canvas(id, height), p, i => k.list[i], i => o.list[i], i => colourOf(c, c.list[i]),
          spots);
      $(id).spots = spots;
    });
    $("effects-scale").innerHTML = scaleBar(c, "Colour:");
  }
  function buildEffects() {
    if (!known.length || !keys.some(k => k.many)) return;
    const judged = D.effects.some(row => row.some(e => e.share !== null));
    section(
        "effects", "Over each variable",
        (D.optimum ? "Each dot is one design; the search crowds them at the optimum." :
                     "Each dot is one design. Dashed: the mean over the designs of one level or " +
                 "of neighbouring values." +
                 (judged && !(U && U.total) ?
                      " Percent: share of the variance that the variable explains by itself." :
                      "")) +
            (best >= 0 ? " Ring: the lowest." : ""),
        card(`<div class="small${keys.filter(k => k.many).length === 4 ? " four" : ""}">${
            keys.map((k, j) => k.many ? plot("effect-" + j, "Output over " + k.name) : "")
                .join("")}</div><div id="effects-scale"></div>`));
    keys.forEach((k, j) => k.many && pointable("effect-" + j));
    CHARTS.push(drawEffects);
  }

  /* ---------------------------------------------------------------- map of two variables */
  const levels = c => [...new Set(c.list)].filter(Number.isFinite).sort((a, b) => a - b);
  const others = () =>
      keys.map((k, j) => j).filter(j => j !== state.x && j !== state.y && keys[j].many);
  /* Is every combination of levels there, as a grid has them? */
  const isGrid = D.plan.startsWith("grid") &&
      keys.reduce((n, k) => n * Math.max(1, levels(k).length), 1) <= D.n;
  function mapSlice() {
    return ids.filter(i => others().every(j => !isGrid || keys[j].list[i] === state.fixed[j]));
  }
  /* Output on the levels of a grid, bilinear between them; NaN where a corner is missing. */
  function gridField(a, b, o, slice) {
    const xs = levels(a), ys = levels(b), table = new Map();
    for (const i of slice) table.set(a.list[i] + "|" + b.list[i], o.list[i]);
    const places = [xs.map(v => place(a, v)), ys.map(v => place(b, v))];
    const cell = (at, t) => {
      let i = 0;
      while (i < at.length - 2 && t > at[i + 1]) i++;
      return [i, (t - at[i]) / (at[i + 1] - at[i])];
    };
    return (u, v) => {
      const [i, s] = cell(places[0], u), [j, t] = cell(places[1], v);
      const z = (p, q) => table.get(xs[i + p] + "|" + ys[j + q]) ?? NaN;
      return (1 - s) * ((1 - t) * z(0, 0) + t * z(0, 1)) + s * ((1 - t) * z(1, 0) + t * z(1, 1));
    };
  }
  /* Scattered designs of two variables: inverse distance to the fourth power. More variables: a
     mean of the neighbourhood, as the others differ from dot to dot. */
  function scatterField(a, b, o, slice) {
    const use = slice.filter(i => Number.isFinite(o.list[i])), n = use.length;
    const xs = Float64Array.from(use, i => place(a, a.list[i])),
          ys = Float64Array.from(use, i => place(b, b.list[i])),
          zs = Float64Array.from(use, i => o.list[i]);
    const smooth = keys.filter(k => k.many).length > 2;
    const width = Math.max(0.06, 0.5 * Math.max(n, 1) ** (-1 / 3)), far = (2.2 * width) ** 2;
    return (u, v) => {
      let sum = 0, weight = 0, least = Infinity;
      for (let k = 0; k < n; k++) {
        const d = (xs[k] - u) ** 2 + (ys[k] - v) ** 2;
        if (d < least) least = d;
        if (smooth && d > 4 * far) continue; /* a weight below 1e-4 */
        const w = smooth ? Math.exp(-d / (2 * width * width)) : 1 / (d * d + 1e-12);
        sum += w * zs[k];
        weight += w;
      }
      return least > far ? NaN : sum / weight;
    };
  }
  /* Every other row and column of a field [ny][nx] becomes the mean of its neighbours. */
  function refine(field, nx, ny) {
    const fill = (to, p, q) => {
      field[to] = (field[p] + field[q]) / 2;
    };
    for (let j = 0; j < ny; j += 2)
      for (let i = 1; i < nx; i += 2) fill(j * nx + i, j * nx + i - 1, j * nx + i + 1);
    for (let j = 1; j < ny; j += 2)
      for (let i = 0; i < nx; i++) fill(j * nx + i, (j - 1) * nx + i, (j + 1) * nx + i);
  }
  /* The output over the map [ny][nx], kept until the map shows something else. */
  const kept = {};
  function fieldOf(a, b, o, full, slice, nx, ny) {
    const name = [state.x, state.y, o.index, full, ...state.fixed].join();
    if (kept.name === name) return kept.field;
    const at = (full ? gridField : scatterField)(a, b, o, slice), step = full ? 1 : 2;
    const field = new Float64Array(nx * ny).fill(NaN);
    for (let j = 0; j < ny; j += step)
      for (let i = 0; i < nx; i += step) field[j * nx + i] = at(i / (nx - 1), j / (ny - 1));
    if (!full) refine(field, nx, ny);
    Object.assign(kept, {name, field});
    return field;
  }
  /* Image of a field [ny][nx] whose rows go upwards; clear where it is not known. */
  function painted(field, nx, ny, colour) {
    const c = document.createElement("canvas");
    c.width = nx;
    c.height = ny;
    const g = c.getContext("2d"), image = g.createImageData(nx, ny);
    field.forEach((z, k) => {
      if (!Number.isFinite(z)) return;
      const to = 4 * ((ny - 1 - Math.floor(k / nx)) * nx + k % nx);
      image.data.set([...colour(z), 255], to);
    });
    g.putImageData(image, 0, 0);
    return c;
  }
  /* Level lines through a field [ny][nx] by marching squares. */
  function contour(g, field, nx, ny, level, X, Y) {
    let middle = null, least = Infinity;
    const cut = (p, q, a, b) => {
      const t = (level - a) / (b - a);
      return [X(p[0] + t * (q[0] - p[0])), Y(p[1] + t * (q[1] - p[1]))];
    };
    for (let j = 0; j + 1 < ny; j++)
      for (let i = 0; i + 1 < nx; i++) {
        const c = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]],
              z = c.map(([p, q]) => field[q * nx + p]);
        if (!z.every(Number.isFinite)) continue;
        const hits = [];
        for (let k = 0; k < 4; k++) {
          const m = (k + 1) % 4;
          if ((z[k] < level) !== (z[m] < level)) hits.push(cut(c[k], c[m], z[k], z[m]));
        }
        for (let k = 0; k + 1 < hits.length; k += 2) {
          g.moveTo(...hits[k]);
          g.lineTo(...hits[k + 1]);
          const d = Math.hypot(i / nx - 0.5, 0.5 * (j / ny - 0.5));
          if (d < least) [middle, least] = [hits[k], d];
        }
      }
    return middle;
  }
  function drawMap() {
    const id = "map-chart", width = widthOf(id),
          height = Math.min(560, Math.max(360, 0.55 * width));
    const a = keys[state.x], b = keys[state.y], o = state.output, slice = mapSlice();
    const p = new Panel(
        id, {left: 60, top: 34, width: width - 80, height: height - 84},
        axis(rangeOf(a), a.scale, a.label), axis(rangeOf(b), b.scale, b.label));
    show(id, height, [p]);
    const g = canvas(id, height), nx = 121, ny = 81;
    const full = isGrid && levels(a).length > 1 && levels(b).length > 1;
    const field = fieldOf(a, b, o, full, slice, nx, ny);
    const seen = [...field].filter(Number.isFinite), range = seen.length ? extent(seen) : [0, 1];
    const c =
        {...o, range, many: range[1] > range[0], log: range[0] > 0 && range[1] > 20 * range[0]};
    /* the field fills the range of the designs, not the air around it */
    const left = p.x(a.range[0]), right = p.x(a.range[1]), low = p.y(b.range[0]),
          high = p.y(b.range[1]);
    const X = i => left + (right - left) * i / (nx - 1), Y = j => low + (high - low) * j / (ny - 1);
    const dx = (right - left) / (nx - 1), dy = (low - high) / (ny - 1);
    clip(g, {left, top: high, width: right - left, height: low - high});
    g.drawImage(
        painted(field, nx, ny, z => blend(place(c, z))), left - dx / 2, high - dy / 2,
        right - left + dx, low - high + dy);
    g.lineWidth = 1;
    g.strokeStyle = css("--card");
    g.globalAlpha = 0.75;
    g.beginPath();
    const at0 = range[0] / o.scale, at1 = range[1] / o.scale;
    const lines = c.many ? (c.log ? logTicks : linearTicks)(at0, at1, 9) : [];
    const labels = lines.map(t => [t, contour(g, field, nx, ny, t * o.scale, X, Y)]);
    g.stroke();
    g.restore();
    const spots = [], ring = css("--card"), size = marks(slice) - 0.6;
    for (const i of slice) {
      const x = p.x(a.list[i]), y = p.y(b.list[i]);
      g.globalAlpha = active(i) ? 1 : 0.2;
      g.lineWidth = 1.2;
      if (Number.isFinite(o.list[i]))
        disc(g, x, y, size, colourOf(c, o.list[i]), ring);
      else if (D.status[i] === FAILED) {
        g.strokeStyle = css("--bad");
        g.lineWidth = 2;
        g.beginPath();
        for (const s of [-1, 1]) {
          g.moveTo(x - 4, y - 4 * s);
          g.lineTo(x + 4, y + 4 * s);
        }
        g.stroke();
      }
      if (active(i)) spots.push([x, y, i]);
    }
    g.globalAlpha = 1;
    g.font = "600 12px " + css("--text");
    g.textAlign = "center";
    g.lineWidth = 4;
    g.strokeStyle = css("--card");
    g.fillStyle = css("--ink");
    const used = [];
    for (const [t, at] of labels) {
      if (!at || used.some(([x, y]) => Math.abs(x - at[0]) < 44 && Math.abs(y - at[1]) < 16))
        continue;
      used.push(at);
      const x = Math.max(left + 16, Math.min(right - 16, at[0])),
            y = Math.max(high + 14, Math.min(low - 6, at[1] + 4));
      g.strokeText(number(t, 4, false), x, y);
      g.fillText(number(t, 4, false), x, y);
    }
    for (const [i, colour] of [[best, css("--accent")], [state.chosen, css("--ink")]]) {
      if (i < 0 || !slice.includes(i)) continue;
      g.lineWidth = 5;
      disc(g, p.x(a.list[i]), p.y(b.list[i]), 8, null, css("--card"));
      g.lineWidth = 2.4;
      disc(g, p.x(a.list[i]), p.y(b.list[i]), 8, null, colour);
    }
    $(id).spots = spots;
    $("map-scale").innerHTML = scaleBar(c, "Colour:") +
        (lines.length ?
             `<p class="note">Lines at ${lines.map(t => number(t, 4, false)).join(", ")}${
                 o.unit ? NBSP + escape(o.unit) : ""}.</p>` :
             "");
    const cross = slice.some(i => D.status[i] === FAILED) ? " Crosses: designs that failed." : "",
          blank = full && slice.some(i => !Number.isFinite(o.list[i])) ?
        " It is blank beside designs without a result." :
        "";
    const more = others().length;
    $("map-note").textContent =
        (full ? "Dots are the designs. Between them the map is interpolated bilinearly." :
             more ?
                "Dots are the designs, the other variables of each differ. The map is the mean " +
                 "of a neighbourhood, not a section." :
                "Dots are the designs. Between them the map is interpolated by inverse distance.") +
        (full && more ? " The other variables are held at the chosen values." : "") + blank + cross;
  }
  function mapTools() {
    const varied = keys.map((k, j) => [j, k.short]).filter(([j]) => keys[j].many);
    let html = select("map-x", "Across", varied, state.x) + select("map-y", "Up", varied, state.y);
    if (isGrid)
      for (const j of others())
        html += select(
            "map-fix-" + j, keys[j].short, levels(keys[j]).map(v => [v, keys[j].text(v)]),
            state.fixed[j]);
    $("map-tools").innerHTML = html;
    const pick = (mine, other) => e => {
      const to = +e.target.value;
      if (to === state[other]) state[other] = state[mine];
      state[mine] = to;
      mapTools();
      drawMap();
    };
    $("map-x").onchange = pick("x", "y");
    $("map-y").onchange = pick("y", "x");
    if (isGrid)
      for (const j of others())
        $("map-fix-" + j).onchange = e => {
          state.fixed[j] = +e.target.value;
          drawMap();
        };
  }
  function buildMap() {
    const varied = keys.map((k, j) => j).filter(j => keys[j].many);
    if (varied.length < 2 || !known.length) return;
    const share = j => D.effects[state.output.index][j].share || 0;
    const ranked = D.effects[state.output.index].some(e => e.share !== null) ?
        varied.slice().sort((i, j) => share(j) - share(i)) :
        varied;
    [state.x, state.y] = ranked;
    state.fixed = keys.map(k => best >= 0 ? k.list[best] : levels(k)[0]);
    section(
        "map", "Map of two variables", "&nbsp;",
        card(
            `<div class="tools" id="map-tools"></div>` + plot("map-chart", "Map of two variables") +
            `<div id="map-scale"></div>`));
    mapTools();
    pointable("map-chart");
    CHARTS.push(drawMap);
  }

  /* ---------------------------------------------------------------- parallel coordinates */
  const axes = [...keys, ...known].filter(c => c.many).slice(0, 12);
  const PAR = {top: 52, height: 290, bottom: 40};
  const parX = j =>
      46 + (widthOf("parallel-chart") - 110) * (axes.length > 1 ? j / (axes.length - 1) : 0.5);
  const parY = (c, v) => PAR.top + PAR.height * (1 - place(c, v));
  /* A name as long as the space between two axes. */
  function cut(name) {
    const most = Math.max(8, Math.floor((parX(1) - parX(0)) / 7.4));
    return name.length > most ? "…" + name.slice(1 - most) : name;
  }
  function drawParallel() {
    const id = "parallel-chart", height = PAR.top + PAR.height + PAR.bottom, c = state.output;
    let svg = "";
    axes.forEach((a, j) => {
      const x = parX(j).toFixed(1), bottom = PAR.top + PAR.height, brush = state.brush.get(a);
      svg += `<path class="rod" d="M${x} ${PAR.top}V${bottom}"/><text class="axis${
          a === c ? " end" : ""}" x="${x}" y="${PAR.top - 28}" text-anchor="middle">${
          escape(cut(a.short))}</text><text x="${x}" y="${PAR.top - 11}" text-anchor="middle">${
          escape(a.text(a.range[1], 3))}</text><text x="${x}" y="${
          bottom + 18}" text-anchor="middle">${escape(a.text(a.range[0], 3))}</text>`;
      if (brush) {
        const y = parY(a, brush[1]), h = parY(a, brush[0]) - y;
        svg += `<rect class="brush" x="${x - 9}" y="${y.toFixed(1)}" width="18" height="${
            Math.max(2, h).toFixed(1)}"/>`;
      }
      svg += `<rect class="grip" data-axis="${j}" x="${x - 24}" y="${
          PAR.top - 6}" width="48" height="${PAR.height + 12}"/>`;
    });
    show(id, height, [], svg);
    const g = canvas(id, height), shown = ids.filter(i => active(i) && D.status[i] !== WAITING);
    const line = i => {
      let pen = false;
      g.beginPath();
      axes.forEach((a, j) => {
        if (!Number.isFinite(a.list[i])) {
          pen = false;
          return;
        }
        if (pen)
          g.lineTo(parX(j), parY(a, a.list[i]));
        else
          g.moveTo(parX(j), parY(a, a.list[i]));
        pen = true;
      });
      g.stroke();
    };
    g.lineJoin = "round";
    g.lineWidth = 0.8;
    g.strokeStyle = css("--gap");
    g.globalAlpha = 0.25;
    if (state.brush.size) ids.filter(i => !active(i)).forEach(line);
    g.globalAlpha = Math.max(0.15, Math.min(0.9, 90 / Math.max(1, shown.length)));
    g.lineWidth = 1.3;
    const value = i => Number.isFinite(c.list[i]) ? c.list[i] : Infinity;
    for (const i of shown.slice().sort((p, q) => value(q) - value(p))) {
      g.strokeStyle = Number.isFinite(c.list[i]) ? colourOf(c, c.list[i]) : css("--bad");
      g.setLineDash(Number.isFinite(c.list[i]) ? [] : [3, 3]);
      line(i);
    }
    g.setLineDash([]);
    g.globalAlpha = 1;
    for (const [i, colour] of [[best, css("--accent")], [state.chosen, css("--ink")]]) {
      if (i < 0) continue;
      for (const [w, s] of [[6, css("--card")], [3, colour]]) {
        g.lineWidth = w;
        g.strokeStyle = s;
        line(i);
      }
    }
    $("parallel-scale").innerHTML = scaleBar(c, "Colour:");
  }
  function buildParallel() {
    if (axes.length < 2 || D.n < 2 || !known.length) return;
    section(
        "parallel", "All designs at once",
        "Each line is one design. Drag along an axis to keep a range: the other charts and the " +
            "table follow. Click an axis to free it." + (best >= 0 ? " Thick: the lowest." : "") +
            (D.status.includes(FAILED) ? " Dashed red: no result." : ""),
        card(
            `<div class="wide" style="--axes:${axes.length}">` +
            plot("parallel-chart", "Parallel coordinates of all designs") +
            `</div><div id="parallel-scale"></div>`));
    const svg = $("parallel-chart");
    let from = null;
    const valueAt = (a, e) => {
      const r = svg.getBoundingClientRect(),
            y = (e.clientY - r.top) * widthOf("parallel-chart") / r.width;
      const t = Math.max(0, Math.min(1, 1 - (y - PAR.top) / PAR.height)), [lo, hi] = a.range;
      return a.log ? lo * (hi / lo) ** t : lo + t * (hi - lo);
    };
    svg.addEventListener("pointerdown", e => {
      const j = e.target.dataset && e.target.dataset.axis;
      if (j === undefined || e.button !== 0) return;
      from = {a: axes[+j], v: valueAt(axes[+j], e), y: e.clientY};
      svg.setPointerCapture(e.pointerId);
      e.preventDefault();
    });
    svg.addEventListener("pointermove", e => {
      if (!from || Math.abs(e.clientY - from.y) < 4) return;
      const to = valueAt(from.a, e), air = 1e-9 * (from.a.range[1] - from.a.range[0]);
      state.brush.set(from.a, [Math.min(from.v, to) - air, Math.max(from.v, to) + air]);
      drawParallel();
      count();
    });
    svg.addEventListener("pointerup", e => {
      if (!from) return;
      if (Math.abs(e.clientY - from.y) < 4) state.brush.delete(from.a);
      from = null;
      drawAll();
    });
    CHARTS.push(drawParallel);
  }

  /* ---------------------------------------------------------------- optimum */
  function drawHistory() {
    const id = "history-chart", o = outputs[D.objective], h = D.optimum.history, height = 320;
    const at = h.map((d, i) => [i + 1, o.list[d], d]).filter(e => Number.isFinite(e[1]));
    const p = new Panel(
        id, {left: 60, top: 34, width: widthOf(id) - 80, height: height - 84},
        axis(around(1, h.length, false), 1, "evaluation"), axis(rangeOf(o), o.scale, o.label));
    const lowest = best < 0 ? NaN : o.list[best];
    if (lowest <= o.range[0]) {
      let least = Infinity;
      const xs = [], ys = [];
      for (const [x, v] of at) {
        if (least < Infinity) {
          xs.push(x);
          ys.push(least);
        }
        least = Math.min(least, v);
        xs.push(x);
        ys.push(least);
      }
      p.line("line best", xs, ys);
    } else if (Number.isFinite(lowest))
      p.level("line best", lowest);
    show(id, height, [p]);
    const g = canvas(id, height), spots = [];
    clip(g, p.box, 6);
    for (const [x, v, d] of at) {
      g.globalAlpha = active(d) ? 0.8 : 0.12;
      disc(g, p.x(x), p.y(v), 3, colourOf(keys[state.colour], keys[state.colour].list[d]));
      spots.push([p.x(x), p.y(v), d]);
    }
    g.globalAlpha = 1;
    g.lineWidth = 2;
    for (const [d, colour] of [[best, css("--accent")], [state.chosen, css("--ink")]])
      for (const e of at)
        if (e[2] === d) disc(g, p.x(e[0]), p.y(e[1]), 7, null, colour);
    g.restore();
    $(id).spots = spots;
  }
  function buildHistory() {
    if (!D.optimum || D.objective < 0 || !D.optimum.history.length) return;
    const o = outputs[D.objective], broken = best >= 0 && o.list[best] > o.range[0];
    section(
        "history", "History of the optimum",
        "Each dot is one evaluation, in their order. " +
            (broken ? "Line: the optimum; dots below it break a constraint." :
                      "Line: the best so far."),
        card(plot("history-chart", "Objective over the evaluations")));
    pointable("history-chart");
    CHARTS.push(drawHistory);
  }

  /* ---------------------------------------------------------------- derivatives */
  /* Relative derivative d ln peak / d ln q; the value of q is known where q is a varied key. */
  function sensitivities(i) {
    const peak = outputs.find(o => o.name === "peak");
    return D.derivatives.map((d, j) => {
      const last = d.name.split(".").pop();
      const key =
          keys.find(k => k.name === d.name) || keys.find(k => k.name.split(".").pop() === last);
      const value = D.derivative[j][i];
      const at = key ? key.list[i] : D.derivative_at[j] ?? NaN;
      const known = value !== null && Number.isFinite(at) && peak && peak.all[i];
      return {
        name: d.name,
        unit: d.unit,
        value,
        share: known ? value * at / peak.all[i] : NaN
      };
    });
  }
  /* Design shown before one is chosen: the lowest, or the median of uncertain keys. */
  function reference() {
    const o = outputs[D.objective];
    if (!(U || R) || !o) return best;
    const list = ids.filter(i => Number.isFinite(o.list[i])).sort((a, b) => o.list[a] - o.list[b]);
    return list.length ? list[list.length >> 1] : -1;
  }
  function drawTornado() {
    const id = "tornado-chart", i = state.chosen >= 0 ? state.chosen : reference(),
          list = i < 0 ? [] : sensitivities(i),
          bars = list.filter(s => Number.isFinite(s.share))
                     .sort((a, b) => Math.abs(b.share) - Math.abs(a.share)),
          rest = list.filter(s => !Number.isFinite(s.share) && s.value !== null);
    const width = widthOf(id), height = 60 + 34 * Math.max(1, bars.length),
          most = Math.max(1e-12, ...bars.map(b => Math.abs(b.share)));
    const left = 110, mid = left + (width - left - 30) / 2, half = (width - left - 30) / 2 - 56;
    let svg = `<path class="base" d="M${mid} 16V${height - 34}"/><text class="axis" x="${
        width - 20}" y="${height - 8}" text-anchor="end">change of the peak for 1 % more, %</text>`;
    bars.forEach((b, k) => {
      const w = half * Math.abs(b.share) / most, y = 22 + 34 * k, up = b.share > 0;
      svg += `<text class="axis" x="${left - 10}" y="${y + 15}" text-anchor="end">${
          escape(b.name)}</text>
          <rect class="bar ${up ? "more" : "less"}" x="${up ? mid : mid - w}" y="${y}" width="${
          Math.max(w, 1)}" height="22"/><text x="${up ? mid + w + 7 : mid - w - 7}" y="${
          y + 16}" text-anchor="${up ? "start" : "end"}">${number(b.share, 3, false)}</text>`;
    });
    show(id, height, [], svg);
    $("tornado-note").textContent = i < 0 ?
        "No design is chosen." :
        `Design ${i + 1}${
            state.chosen < 0 ?
                `, ${U || R ? "the median" : "the lowest"}; click another to see its own` :
                ""}. ` +
            "Relative derivative of the peak by each parameter." +
            (rest.length ? ` Of unknown value, so per unit only: ${
                               rest.map(r => `${r.name} ${number(r.value, 4, false)} ${r.unit}`)
                                   .join(", ")}.` :
                           "");
  }
  function buildTornado() {
    if (!D.derivatives.length || !D.derivative.some(list => list.some(v => v !== null))) return;
    section(
        "tornado", "What moves the peak", "&nbsp;",
        card(plot("tornado-chart", "Relative derivatives of the peak")));
    CHARTS.push(drawTornado);
  }

  /* ---------------------------------------------------------------- uncertainty */
  const confidence = U ? number(100 * U.confidence, 3, false) + NBSP + "%" : "";
  /* An interval in words; so few samples may not give one of its bounds. */
  function interval(o, [, lo, hi]) {
    const text = v => escape(o.text(v, 3));
    if (lo === null && hi === null) return "";
    if (hi === null) return `above ${text(lo)}`;
    return lo === null ? `below ${text(hi)}` : `${text(lo)} to ${text(hi)}`;
  }
  const percentileCell = (o, e) => {
    const bounds = interval(o, e);
    return e[0] === null ? "–" :
                           escape(o.text(e[0])) +
            (bounds ? `<br><span class="note">${bounds}</span>` : "");
  };
  function drawSpread() {
    const id = "spread-chart", o = state.output, height = 340;
    const list = o.list.filter(Number.isFinite).sort((a, b) => a - b);
    const p = new Panel(
        id, {left: 60, top: 34, width: widthOf(id) - 80, height: height - 84},
        axis(rangeOf(o), o.scale, o.label),
        axis({lo: 0, hi: 1, log: false}, 0.01, "share of the samples below, %"));
    p.line("line whole", list, list.map((v, i) => (i + 0.5) / list.length));
    let svg = "";
    U.percentile[o.index].forEach(([v, lo, hi], q) => {
      if (v === null) return;
      const level = U.level[q] / 100, right = p.x(v) < p.box.left + 0.7 * p.box.width;
      for (const end of [lo, hi])
        if (end !== null)
          svg += `<path class="whisker" d="M${p.x(v)} ${p.y(level)}H${p.x(end)}m0 -5v10"/>`;
      p.dot("dot varying", v, level, 4.5);
      p.text(
          "mark", v, level, right ? 12 : -12, right && level > 0.1 ? 16 : -9,
          right ? "start" : "end", `${number(U.level[q], 3, false)} %: ${o.text(v)}`);
    });
    show(id, height, [p], svg);
  }
  function drawSobol() {
    const id = "sobol-chart", o = state.output, first = U.first[o.index], total = U.total[o.index];
    const list = keys.map((k, j) => j)
                     .filter(j => total[j][0] !== null)
                     .sort((a, b) => total[b][0] - total[a][0]);
    const width = widthOf(id), left = Math.min(150, 0.34 * width), full = width - left - 64,
          height = 44 + 46 * Math.max(1, list.length);
    const most = Math.max(1, ...total.map(t => t[2] || 0)),
          x = v => left + full * Math.max(0, v) / most;
    let svg = "";
    for (const t of linearTicks(0, most, 5))
      svg += `<path class="grid" d="M${x(t)} 8V${height - 30}"/><text x="${x(t)}" y="${
          height - 12}" text-anchor="middle">${number(t, 3, false)}</text>`;
    list.forEach((j, k) => {
      const y = 14 + 46 * k;
      svg += `<text class="axis" x="${left - 10}" y="${y + 20}" text-anchor="end">${
          escape(keys[j].short)}</text>`;
      for (const [kind, [v, lo, hi], dy] of [["total", total[j], 16], ["first", first[j], 0]]) {
        if (v === null) continue;
        svg += `<rect class="bar ${kind}" x="${left}" y="${y + dy}" width="${
            Math.max(0.5, x(v) - left)}" height="13"/>`;
        if (lo !== null)
          svg += `<path class="whisker" d="M${x(lo)} ${y + dy + 6.5}H${x(hi)}M${x(lo)} ${
              y + dy + 3}v7M${x(hi)} ${y + dy + 3}v7"/>`;
        svg += `<text x="${x(hi === null ? v : Math.max(hi, v)) + 8}" y="${y + dy + 11}">${
            number(v, 2, false)}</text>`;
      }
    });
    show(id, height, [], svg);
  }
  function percentileTable() {
    return `<div class="scroll"><table><caption>Statistics of ${
        U.samples} samples. Second lines: intervals at ${
        confidence} confidence.</caption><thead><tr><th>Output</th><th>Mean</th><th>Deviation</th>${
        U.level.map(l => `<th>${number(l, 3, false)} %</th>`).join("")}</tr></thead><tbody>${
        outputs.filter(o => U.mean[o.index] !== null)
            .map(
                o =>
                    `<tr><th>${escape(o.name)}</th><td>${escape(o.text(U.mean[o.index]))}</td><td>${
                        escape(o.text(U.deviation[o.index], 3))}</td>${
                        U.percentile[o.index].map(e => `<td>${percentileCell(o, e)}</td>`).join("")}</tr>`)
            .join("")}</tbody></table></div>`;
  }
  function buildUncertainty() {
    if (!U || !known.length) return;
    const sobol = U.first && keys.length > 1;
    section(
        "uncertainty", "Uncertainty",
        `Distribution over the samples, with percentiles and their intervals at ${
            confidence} confidence.` +
            (sobol ? " Sobol’ indices: share of the variance that a variable explains by itself " +
                     "(first, dark) and with all its interactions (total, light)." :
                     ""),
        `<div class="${sobol ? "pair" : ""}">${
            card(
                "<h3 style=\"margin-top:0\">Distribution</h3>" +
                plot("spread-chart", "Distribution of the output"))}${
            sobol ? card(
                        "<h3 style=\"margin-top:0\">Sobol’ indices</h3>" +
                        plot("sobol-chart", "Sobol’ indices")) :
                    ""}</div>` +
            percentileTable());
    CHARTS.push(drawSpread);
    if (sobol) CHARTS.push(drawSobol);
  }

  /* ---------------------------------------------------------------- robust designs */
  const robustAt = (g, o) => R.percentile[g * D.outputs.length + o.index];
  /* Groups in the order of the chosen varied key. */
  const groups = k => R.key.map((v, g) => g).sort((a, b) => R.key[a][k] - R.key[b][k]);
  const varied = R ? R.key[0].map((v, k) => k).filter(k => keys[k].many) : [];
  function drawRobust() {
    const id = "robust-chart", o = state.output, height = 380, k = state.robust, c = keys[k];
    const ends = R.key.flatMap((v, g) => robustAt(g, o).flat()).filter(v => v !== null);
    const y = ends.length ? around(...extent(ends), o.log) : {lo: 0, hi: 1, log: false};
    const p = new Panel(
        id, {left: 60, top: 34, width: widthOf(id) - 90, height: height - 84},
        axis(rangeOf(c), c.scale, c.label), axis(y, o.scale, o.label));
    let svg = "";
    R.level.forEach((level, q) => {
      const shown = groups(k).filter(g => robustAt(g, o)[q][0] !== null);
      if (varied.length === 1)
        p.line("line whole", shown.map(g => R.key[g][k]), shown.map(g => robustAt(g, o)[q][0]));
      for (const g of shown) {
        const [v, lo, hi] = robustAt(g, o)[q], x = p.x(R.key[g][k]);
        for (const end of [lo, hi])
          if (end !== null)
            svg += `<path class="whisker" d="M${x} ${p.y(v)}V${p.y(end)}m-4 0h8"/>`;
        p.dot("dot varying", R.key[g][k], v, 4);
      }
      const last = shown[shown.length - 1];
      if (last !== undefined)
        p.text(
            "mark", R.key[last][k], robustAt(last, o)[q][0], 8, 4, "start",
            `${number(level, 3, false)} %`);
    });
    show(id, height, [p], svg);
    $("robust-table").innerHTML = robustTable();
  }
  function robustTable() {
    const o = state.output;
    const text = v => v === null ? "–" : escape(o.text(v, 4));
    return `<caption>${escape(o.name)} at each design of the varied keys. Second lines: intervals
        at ${number(100 * R.confidence, 3, false)} % confidence.</caption><thead><tr>${
        R.key[0].map((v, k) => `<th>${escape(keys[k].label)}</th>`).join("")}<th>Samples</th>
        <th>Mean</th><th>Deviation</th>${
        R.level.map(l => `<th>${number(l, 3, false)} %</th>`).join("")}</tr></thead><tbody>${
        groups(state.robust)
            .map(
                g => `<tr>${
                    R.key[g].map((v, k) => `<td>${number(v / keys[k].scale, 5, false)}</td>`)
                        .join("")}<td>${R.samples[g]}${
                    R.failed[g] ? ` (${R.failed[g]} failed)` : ""}</td><td>${
                    text(R.mean[g][o.index])}</td><td>${text(R.deviation[g][o.index])}</td>${
                    robustAt(g, o).map(e => `<td>${percentileCell(o, e)}</td>`).join("")}</tr>`)
            .join("")}</tbody>`;
  }
  function buildRobust() {
    if (!R || !known.length) return;
    state.robust = varied.length ? varied[0] : 0;
    section(
        "robust", "Robust design",
        `At each design of the varied keys: percentiles over the samples of the uncertain ones, ` +
            `with intervals at ${number(100 * R.confidence, 3, false)} % confidence.`,
        card(
            (varied.length > 1 ? `<div class="tools">${
                                     select(
                                         "robust-key", "Over", varied.map(k => [k, keys[k].short]),
                                         state.robust)}</div>` :
                                 "") +
            plot("robust-chart", "Percentiles over a varied key")) +
            `<div class="scroll"><table id="robust-table"></table></div>`);
    if ($("robust-key"))
      $("robust-key").onchange = e => {
        state.robust = +e.target.value;
        drawRobust();
      };
    CHARTS.push(drawRobust);
  }

  /* ---------------------------------------------------------------- table */
  const heads = [
    {name: "design", label: "design", list: ids, cell: i => String(i + 1)},
    ...keys.map(k => ({...k, cell: i => number(k.list[i] / k.scale, 5, false)})),
    ...outputs.map(o => ({...o, list: o.all, cell: i => number(o.all[i] / o.scale, 5, false)})), {
      name: "status",
      label: "status",
      list: D.status,
      words: true,
      cell: i => STATES[D.status[i]] + (D.reason[i] ? ": " + D.reason[i] : "")
    }
  ];
  function sorted() {
    const list = ids.filter(active), h = heads[state.sort ?? 0], sign = state.down ? -1 : 1;
    return list.sort((a, b) => {
      const x = h.list[a], y = h.list[b];
      if (Number.isFinite(x) !== Number.isFinite(y)) return Number.isFinite(x) ? -1 : 1;
      return sign * (x - y) || a - b;
    });
  }
  function drawTable() {
    const list = sorted(), shown = list.slice(0, state.rows);
    $("heads").innerHTML =
        heads
            .map(
                (h, j) => `<th scope="col"${h.words ? " class=\"words\"" : ""}${
                    state.sort === j ? ` aria-sort="${state.down ? "descending" : "ascending"}"` :
                                       ""}
        title="${escape(h.name)}"><button type="button" data-sort="${j}">${
                    escape(h.label)}</button></th>`)
            .join("");
    $("rows").innerHTML =
        shown
            .map(
                i => `<tr data-design="${i}"${i === state.chosen ? " class=\"chosen\"" : ""}>${
                    heads
                        .map(
                            h => `<td${
                                h.words ? ` class="words${D.status[i] === DONE ? "" : " bad"}"` :
                                          ""}>${
                                h === heads[0] ?
                                    `<button type="button" class="key">${h.cell(i)}</button>` :
                                    escape(h.cell(
                                        i))}${h === heads[0] && i === best ? " ★" : ""}</td>`)
                        .join("")}</tr>`)
            .join("");
    $("all").hidden = shown.length >= list.length;
    $("all").textContent = `Show all ${list.length}`;
  }
  function csv() {
    const quote = s => /[",\r\n]/.test(s) ? `"${s.replace(/"/g, "\"\"")}"` : s,
          put = v => v === null ? "" : String(v);
    const names = [
      "design", ...D.keys.map(k => k.name), ...D.outputs.map(o => o.name),
      ...D.derivatives.map(d => "dpeak_d" + d.name), "status", "reason"
    ];
    const rows = sorted().map(
        i =>
            [String(i + 1), ...[...D.key, ...D.value, ...D.derivative].map(c => put(c[i])),
             STATES[D.status[i]], D.reason[i] || ""]);
    return [names, ...rows].map(r => r.map(quote).join(",")).join("\r\n") + "\r\n";
  }
  function buildTable() {
    section(
        "designs", "Designs", "Click a heading to sort, a row to see the design in every chart.",
        `<div class="scroll"><table><thead><tr id="heads"></tr></thead>
        <tbody id="rows"></tbody></table></div>
        <div class="row"><button type="button" id="all"></button><button type="button"
        id="csv">Download CSV</button><span class="note">The download holds the designs that are not
        filtered out, in SI units.</span></div>`);
    $("heads").onclick = e => {
      const j = e.target.dataset.sort;
      if (j === undefined) return;
      state.down = state.sort === +j ? !state.down : false;
      state.sort = +j;
      drawTable();
    };
    $("rows").onclick = e => {
      const row = e.target.closest("tr");
      if (row) choose(+row.dataset.design === state.chosen ? -1 : +row.dataset.design);
    };
    $("all").onclick = () => {
      state.rows = Infinity;
      drawTable();
    };
    $("csv").onclick = () => {
      const a = document.createElement("a");
      a.href = URL.createObjectURL(new Blob([csv()], {type: "text/csv"}));
      a.download = D.name + ".study.csv";
      a.click();
      URL.revokeObjectURL(a.href);
    };
    if (state.output)
      state.sort = heads.findIndex(h => h.name === state.output.name && h.kind === "output");
    CHARTS.push(drawTable);
  }

  /* ---------------------------------------------------------------- page */
  function count() {
    const n = ids.filter(active).length;
    $("count").textContent = n === D.n ? `All ${D.n} designs` : `${n} of ${D.n} designs`;
    $("free").hidden = !state.brush.size;
  }
  function drawAll() {
    count();
    for (const draw of CHARTS) draw();
  }
  function buildPanel() {
    $("charts").insertAdjacentHTML(
        "beforeend",
        `<div class="tools panel">${
            known.length > 1 ?
                select("output", "Output", known.map(o => [o.index, o.name]), state.output.index) :
                ""}${
            keys.length > 1 ?
                select("colour", "Colour", keys.map((k, j) => [j, k.short]), state.colour) :
                ""}<button
            type="button" id="free" hidden>Free all axes</button><p class="count"
            id="count"></p></div>`);
    if ($("output"))
      $("output").onchange = e => {
        state.output = outputs[+e.target.value];
        drawAll();
      };
    if ($("colour"))
      $("colour").onchange = e => {
        state.colour = +e.target.value;
        drawAll();
      };
    $("free").onclick = () => {
      state.brush.clear();
      drawAll();
    };
  }
  /* Curves are coloured by the key that matters most. */
  function chiefKey() {
    if (!state.output) return 0;
    const index = U && U.total ? U.total[state.output.index].map(t => t[0]) :
                                 D.effects[state.output.index].map(e => e.share);
    let chief = Math.max(0, keys.findIndex(k => k.many));
    index.forEach((v, j) => {
      if (v !== null && v > (index[chief] ?? 0)) chief = j;
    });
    return chief;
  }

  document.documentElement.classList.add("js");
  document.body.insertAdjacentHTML(
      "beforeend", `<aside id="dock" class="dock" hidden aria-live="polite"
      aria-label="Chosen design"></aside>`);
  if (D.n > 0 && keys.length) {
    state.colour = chiefKey();
    buildPanel();
    buildHistory();
    buildUncertainty();
    buildRobust();
    buildEffects();
    buildCurves();
    buildMap();
    buildParallel();
    buildTornado();
    buildTable();
    drawAll();
    let timer;
    window.addEventListener("resize", () => {
      clearTimeout(timer);
      timer = setTimeout(drawAll, 80);
    });
    window.addEventListener("keydown", e => {
      if (e.key === "Escape" && state.chosen >= 0) choose(-1);
    });
    dark.addEventListener("change", drawAll);
  }
})();
