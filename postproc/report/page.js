(() => {
  "use strict";
  const {$, NBSP, number, LENGTH, ENERGY, unit, percent, escape, signed, around, axis} = Plot,
        {Panel, show, widthOf, extent} = Plot;
  const D = JSON.parse($("data").textContent);
  /* f: the abscissa, the frequency unless another parameter is followed */
  const ROW = {f: 0, stick: 1, slip: 2, gap: 3, energy: 4, error: 5, stable: 6, special: 7, mark: 8};
  const ABOVE = 1, UNDETERMINED = 2, NOT_JUDGED = 4; /* bits of mark */

  /* ---------------------------------------------------------------- data */
  for (const b of D.branches) {
    const all = new Float32Array(Plot.bytes(b.data).buffer);
    b.row = r => all.subarray(r * b.n, (r + 1) * b.n);
    b.f = b.row(ROW.f);
    delete b.data;
  }
  const outputs = D.outputs, hidden = new Set();
  const unique = list => [...new Set(list)];
  const state = {
    output: outputs[0],
    log: D.log,
    zoom: null,  /* abscissa [lo, hi] */
    zoomY: null, /* amplitude [lo, hi], m */
    branch: D.chosen,
    point: 0, /* of the chosen branch */
    pair: 0,  /* index into D.contacts */
    at: null
  };

  /* ---------------------------------------------------------------- abscissa */
  const X = D.abscissa, sweep = X.parameter === "frequency";
  const xLabel = X.name + (X.unit ? ", " + X.unit : "");
  const xText = v => number(v / X.scale, sweep ? 6 : 5, sweep) + (X.unit ? NBSP + X.unit : "");
  const classOf = g =>
      g.kind === "nonlinear" ? (g.rank < 0 ? "varying" : "c" + g.rank) : "limit " + g.kind;
  const groupOf = b => D.groups[b.group];
  /* ---------------------------------------------------------------- forced response */
  let main;
  function drawResponse() {
    const o = state.output, width = widthOf("response"), height = width < 640 ? 420 : 540;
    const range = state.zoom || X.range;
    let least = Infinity, most = 0;
    for (const b of D.branches) {
      if (hidden.has(b.group)) continue;
      const a = b.row(o.row);
      for (let i = 0; i < b.n; i++) {
        if (b.f[i] < range[0] || b.f[i] > range[1]) continue;
        if (a[i] > most) most = a[i];
        if (a[i] > 0 && a[i] < least) least = a[i];
      }
    }
    const u = unit(LENGTH, most);
    const y = !(most > 0) ? {lo: 0, hi: u[1], log: false} :
        state.log         ? {lo: Math.max(least / 1.2, 1e-4 * most), hi: 1.4 * most, log: true} :
                            {lo: 0, hi: 1.06 * most, log: false};
    if (state.zoomY) Object.assign(y, {lo: state.zoomY[0], hi: state.zoomY[1]});
    const x = fullRange();
    const label = `${o.place} ${o.axis}, ${o.quantity}, ${u[0]}`;
    main = new Panel(
        "response", {left: 60, top: D.rpm ? 54 : 34, width: width - 80, height: height - (D.rpm ? 104 : 84)},
        axis(x, X.scale, xLabel), axis(y, u[1], label));
    main.unit = u;
    if (D.rpm && sweep) main.svg += speedAxis(main);
    const order = D.branches.map((b, i) => i).sort((i, j) => rankOf(i) - rankOf(j));
    for (const i of order) {
      const b = D.branches[i], g = groupOf(b), a = b.row(o.row), stable = b.row(ROW.stable);
      if (hidden.has(b.group)) continue;
      if (b.dots) {
        for (let k = 0; k < b.n; k++)
          main.dot(
              (stable[k] === 1 ? "integration " : "integration aperiodic ") + classOf(g), b.f[k],
              a[k], 2.6);
        continue;
      }
      const classes = classOf(g) + (i === state.branch ? " chosen" : "");
      const ranks = [1, -1, 2, 0]; /* stable, not judged, modulated, never seen */
      const rank = k => ranks.indexOf(stable[k]);
      const verdict = k => k > 0 ? Math.max(rank(k), rank(k - 1)) : rank(k);
      const kinds = ["line ", "line unjudged ", "line modulated ", "line unstable "];
      const low = Math.min(...b.f),
            high = Math.max(...b.f); /* no line where the curve leaves the range and returns */
      const left = k => b.f[k] === b.f[k - 1] && (b.f[k] === low || b.f[k] === high);
      kinds.forEach((kind, v) =>
          main.line(kind + classes, b.f, a, k => verdict(k) === v && !left(k)));
      if (o === outputs[0] && sweep && b.ringAt)
        for (let i = 0, n = 0; i < b.ringAt.length; i += n + 1) {
          for (n = 0; b.ringLasts[i + n]; n++);
          const part = list => list.slice(i, i + n);
          main.band(
              "swing " + classOf(g), part(b.ringAt), part(b.ringMean), part(b.ringWorst));
        }
      for (const [f, mean, worst, kind] of o === outputs[0] && sweep && b.lasting || []) {
        if (kind < 2) continue;
        main.line("line lasting " + classOf(g), [f, f], [mean, worst], () => true);
        main.dot("dot " + classOf(g), f, worst, 2);
      }
      if (b.n === 1) main.dot("dot " + classes, b.f[0], a[0], 3);
      b.row(ROW.mark).forEach((mark, k) => {
        if (mark & ABOVE) main.dot("doubtful " + classes, b.f[k], a[k], 2.2);
      });
      b.row(ROW.special).forEach((special, k) => {
        if (special > 2) main.dot("bifurcation " + classes, b.f[k], a[k], 2.6);
      });
    }
    for (const [g, f, a] of o.folds)
      if (!hidden.has(g)) main.dot("fold " + classOf(D.groups[g]), f, a, 2.6);
    for (const [g, f, a] of o.limits)
      if (!hidden.has(g))
        main.text("mark " + D.groups[g].kind, f, a, 0, -7, anchor(f), D.groups[g].kind);
    if (state.branch >= 0) {
      const b = D.branches[state.branch];
      if (!hidden.has(b.group))
        main.dot("here", b.f[state.point], b.row(o.row)[state.point], 4.5);
    }
    show("response", height, [main], `<g id="hover"></g>`);
    $("whole").disabled = !state.zoom && !state.zoomY;
    drawHover();
  }
  /* Where the speed follows the frequency: the speed above the chart, at round numbers. */
  function speedAxis(p) {
    const {left, top, width} = p.box, places = [], LABEL = 210; /* px of the amplitude's label */
    for (const rpm of Plot.linearTicks(p.ax.lo * D.rpm, p.ax.hi * D.rpm, Math.floor(width / 110))) {
      const x = p.x(rpm / D.rpm);
      places.push(`<path class="base" d="M${x.toFixed(1)} ${top}v-4"/>`);
      if (x > left + LABEL)
        places.push(`<text class="tick" x="${x.toFixed(1)}" y="${
            top - 7}" text-anchor="middle">${number(rpm, 7, false)}</text>`);
    }
    return `<g id="rpm">${places.join("")}<path class="base" d="M${left} ${top}h${
        width}"/><text class="axis" x="${left + width}" y="${
        top - 22}" text-anchor="end">rotor speed, rpm</text></g>`;
  }
  /* Text anchor that keeps the label of a limit inside the parameter's range. */
  function anchor(f) {
    const [lo, hi] = X.range, air = 1e-6 * (hi - lo);
    return sweep ? "middle" : f <= lo + air ? "start" : f >= hi - air ? "end" : "middle";
  }
  const rankOf = i => D.branches[i].dots          ? 3 :
      groupOf(D.branches[i]).kind !== "nonlinear" ? 0 :
      i === state.branch                          ? 2 :
                                                    1;

  /* ---------------------------------------------------------------- read-out */
  const sharesOf = shares =>
      shares.map(s => (100 * s).toFixed(s > 0 && s < 0.0995 ? 1 : 0)).join(" · ") + NBSP + "%";
  function readout(b, i) {
    const g = groupOf(b), a = b.row(state.output.row)[i], stable = b.row(ROW.stable)[i],
          error = b.row(ROW.error)[i];
    const shares = ["stick", "slip", "gap"].map(s => b.row(ROW[s])[i]),
          energy = b.row(ROW.energy)[i], e = unit(ENERGY, energy);
    const u = unit(LENGTH, a);
    const rows =
        [[X.name, xText(b.f[i])], [state.output.quantity, number(a / u[1], 4) + NBSP + u[0]]];
    if (D.rpm && sweep)
      rows.splice(1, 0, ["rotor speed", number(b.f[i] * D.rpm, 5, false) + NBSP + "rpm"]);
    if (g.kind === "nonlinear") {
      if (Number.isFinite(shares[0]))
        rows.push(
            [
              "stuck · slipping · open",
              sharesOf(shares)
            ],
            ["dissipated", number(energy / e[1], 3) + NBSP + e[0]]);
      rows.push(b.dots ? ["motion", stable === 1 ? "periodic" : "not periodic"] : [
        "stability",
        stable === 1     ? "stable" :
            stable === 2 ? "modulated" :
            stable === 0 ? "beyond a fold: never seen" :
                           "not judged"
      ]);
      const mark = b.row(ROW.mark)[i], size = error > 1 ? "no bound" : percent(error);
      if (mark & ABOVE) rows.push(["error estimate", size + ", above the tolerance: no result"]);
      else if (mark & NOT_JUDGED)
        rows.push(["error estimate", "not judged"]);
      else if (error > 0)
        rows.push(["error estimate", size]);
      if (mark & UNDETERMINED)
        rows.push([
          "mean friction",
          shares[0] < 1 ? "not determined where contacts stick: one of many answers" :
                          "not determined: all contacts stick, the vibration is the same"
        ]);
    }
    const special = b.row(ROW.special)[i],
          what =
              [
                "", ", fold", ", peak", ", flip (period doubling)", ", Neimark-Sacker point"
              ][special] ||
        (b.dots ? ", time integration" : "");
    return {
      title: (g.kind === "nonlinear" ? g.name + b.note : "linear limit, " + g.name) + what,
      rows,
      shares: g.kind === "nonlinear" && Number.isFinite(shares[0]) ? shares : null
    };
  }
  function drawHover() {
    const box = $("readout"), at = state.at, layer = $("hover");
    if (!at || hidden.has(D.branches[at.b].group)) {
      box.hidden = true;
      layer.innerHTML = "";
      return;
    }
    const b = D.branches[at.b], x = main.x(b.f[at.i]), y = main.y(b.row(state.output.row)[at.i]);
    if (!main.inside(x, y)) {
      box.hidden = true;
      layer.innerHTML = "";
      return;
    }
    layer.innerHTML = `<path class="cursor" d="M${x} ${main.box.top}V${
        main.box.top + main.box.height}"/><circle class="probe ${classOf(groupOf(b))}" cx="${
        x}" cy="${y}" r="5"/>`;
    const r = readout(b, at.i);
    box.innerHTML = `<b>${escape(r.title)}</b><dl>` +
        r.rows.map(([k, v]) => `<dt>${k}</dt><dd>${v}</dd>`).join("") + "</dl>" +
        (r.shares ? `<div class="shares">` +
                 r.shares
                     .map(
                         (s, k) => `<i style="width:${100 * s}%;background:var(--${
                                 ["stick", "slip", "gap"][k]})"></i>`)
                     .join("") +
                 "</div>" :
                    "");
    box.hidden = false;
    const host = box.parentElement.clientWidth, scale = host / widthOf("response"),
          w = box.offsetWidth;
    const left = x * scale + 18 + w > host ? x * scale - 18 - w : x * scale + 18;
    box.style.left = Math.max(0, left) + "px";
    box.style.top = Math.max(0, y * scale - box.offsetHeight - 12) + "px";
  }
  function announce() {
    if (!state.at) return;
    const r = readout(D.branches[state.at.b], state.at.i);
    $("spoken").textContent = r.title + ": " + r.rows.map(([k, v]) => k + " " + v).join(", ");
  }
  function nearest(px, py) {
    let best = null, least = 40 * 40;
    D.branches.forEach((b, j) => {
      if (hidden.has(b.group)) return;
      const a = b.row(state.output.row);
      for (let i = 0; i < b.n; i++) {
        const dx = main.x(b.f[i]) - px;
        if (dx * dx > least) continue;
        const dy = main.y(a[i]) - py, d = dx * dx + dy * dy;
        if (d < least) {
          least = d;
          best = {b: j, i};
        }
      }
    });
    return best;
  }

  /* ---------------------------------------------------------------- tracking */
  const T = {group: 0, n0: 1, a: 2, f: 3, edge: 4, stick: 5, slip: 6, gap: 7, energy: 8};
  function drawTracking() {
    const o = state.output, track = o.track;
    if (!$("tracking") || track.length < 2) return;
    const width = widthOf("tracking"), forces = extent(track, t => t[T.n0]),
          big = Math.max(...forces.map(Math.abs)) >= 1e4;
    const fu = big ? ["kN", 1e3] : ["N", 1],
          least = Math.min(...track.map(t => Math.abs(t[T.n0])).filter(v => v > 0));
    const wide = Math.max(...forces.map(Math.abs)) >= 8 * least;
    const amps = extent([...track.map(t => t[T.a]), ...o.limits.map(t => t[2])].filter(v => v > 0)),
          u = unit(LENGTH, amps[1]);
    const places =
        extent([...track.map(t => t[T.f]), ...(sweep ? o.limits.map(t => t[1]) : [])].filter(
            Number.isFinite));
    const x = wide && forces[0] <= 0 ? signed(forces[0], forces[1], least) :
                                       around(forces[0], forces[1], wide);
    const y = state.log && amps[0] > 0 ?
        {lo: amps[0] / (1.15 * (amps[1] / amps[0]) ** 0.14), hi: amps[1] * 1.2, log: true} :
        {lo: 0, hi: 1.1 * amps[1], log: false};
    const above = new Panel(
        "tracking-a", {left: 60, top: 34, width: width - 80, height: 280}, axis(x, fu[1], null),
        axis(y, u[1], `highest peak, ${o.place} ${o.axis}, ${o.quantity}, ${u[0]}`));
    const below = new Panel(
        "tracking-f", {left: 60, top: 374, width: width - 80, height: 170},
        axis(x, fu[1], "preload n₀, " + fu[0]),
        axis(
            around(places[0], places[1], X.log && places[1] > 8 * places[0]), X.scale,
            "its " + xLabel));
    const best = o.best;
    for (const [p, value, limit] of [[above, T.a, 2], [below, T.f, 1]]) {
      for (const l of p === above || sweep ? o.limits : []) {
        const kind = D.groups[l[0]].kind, open = kind === "open";
        p.level("line limit " + kind, l[limit]);
        p.text(
            "mark " + kind, open ? p.ax.lo : p.ax.hi, l[limit], open ? 6 : -6, -5,
            open ? "start" : "end", kind);
      }
      for (const t of o.peaks)
        if (D.groups[t[0]].rank >= 0) p.dot("lesser", D.groups[t[0]].n0, t[limit], 2.4);
      for (const r of o.resonances)
        p.line("line resonance", r.map(t => t[0]), r.map(t => t[limit]));
      p.line("line track", track.map(t => t[T.n0]), track.map(t => t[value]));
      track.forEach(
          (t, i) => p.dot(
              ["dot", "ring", "doubtful"][t[T.edge]] + " " + classOf(D.groups[t[0]]), t[T.n0], t[value],
              i === best ? 5.5 : 4));
    }
    if (best >= 0)
      above.text(
          "mark strong", track[best][T.n0], track[best][T.a], 0, 21,
          best === 0                    ? "start" :
              best === track.length - 1 ? "end" :
                                          "middle",
          `lowest: ${number(track[best][T.n0] / fu[1], 4, false)}${NBSP}${fu[0]}`);
    show("tracking", 600, [above, below]);
  }

  /* ---------------------------------------------------------------- contact */
  function twoPanels(id, x, xUnit, energyMost, lowerLabel) {
    const width = widthOf(id), e = unit(ENERGY, energyMost), box = {left: 60, width: width - 76};
    const most = energyMost > 0 ? 1.08 * energyMost : e[1];
    return [
      new Panel(
          id + "-s", {...box, top: 34, height: 180}, axis(x, xUnit, null),
          axis(
              {lo: lowerLabel ? -0.02 : 0, hi: lowerLabel ? 1.02 : 1, log: false}, 0.01,
              "share of the period, %")),
      new Panel(
          id + "-d", {...box, top: 266, height: 150}, axis(x, xUnit, lowerLabel),
          axis({lo: 0, hi: most, log: false}, e[1], "dissipated a cycle, " + e[0]))
    ];
  }
  function drawState() {
    const track = state.output.track;
    if (!$("state") || !track.length) return;
    const [shares, energy] = twoPanels(
        "state", {lo: -0.6, hi: track.length - 0.4, log: false}, 0,
        Math.max(...track.map(t => t[T.energy] || 0)), null);
    const every =
              1 + Math.floor((track.length - 1) / Math.max(2, Math.floor(shares.box.width / 40))),
          b = energy.box;
    track.forEach((t, i) => {
      let low = 0;
      ["stick", "slip", "gap"].forEach(s => {
        shares.bar("state " + s, i - 0.36, i + 0.36, low, low + t[T[s]]);
        low += t[T[s]];
      });
      energy.bar("bar " + classOf(D.groups[t[0]]), i - 0.36, i + 0.36, 0, t[T.energy]);
      if (i % every === 0)
        energy.svg += `<text class="tick" x="${energy.x(i).toFixed(1)}" y="${
            b.top + b.height + 17}" text-anchor="middle">${number(t[T.n0], 4, false)}</text>`;
    });
    energy.svg += `<text class="axis" x="${b.left + b.width}" y="${
        b.top + b.height + 36}" text-anchor="end">preload n₀, N</text>`;
    show("state", 470, [shares, energy]);
  }
  const fullRange = () => {
    const [lo, hi] = state.zoom || X.range;
    return hi > lo ? {lo, hi, log: X.log} : around(lo, hi, false);
  };
  function drawAlong() {
    if (!$("along") || state.branch < 0) return;
    const b = D.branches[state.branch],
          [shares, energy] =
              twoPanels("along", fullRange(), X.scale, extent(b.row(ROW.energy))[1], xLabel);
    ["stick", "slip", "gap"].forEach(s => shares.line("line " + s, b.f, b.row(ROW[s])));
    energy.line("line " + classOf(groupOf(b)), b.f, b.row(ROW.energy));
    show("along", 470, [shares, energy]);
  }
  function drawHarmonics() {
    if (!$("harmonics") || state.branch < 0) return;
    const s = D.spectra.find(e => e.place === state.output.place);
    if (!s) {
      show(
          "harmonics", 60, [],
          `<text x="0" y="30">The harmonics of ${
              escape(
                  state.output.place)} are not in this page; the response file has them.</text>`);
      return;
    }
    const b = D.branches[state.branch], shown = Math.min(s.n, 8), width = widthOf("harmonics");
    let most = 0, least = Infinity;
    for (let k = 0; k < shown; k++) {
      const a = b.row(s.row + k).filter(v => v > 0), [lo, hi] = extent(a);
      if (a.length) {
        most = Math.max(most, hi);
        least = Math.min(least, lo);
      }
    }
    const u = unit(LENGTH, most);
    if (!(most > 0)) most = least = u[1];
    const p = new Panel(
        "harmonics", {left: 60, top: 34, width: width - 120, height: 272},
        axis(fullRange(), X.scale, xLabel),
        axis(
            {lo: Math.max(1e-6 * most, least / 2), hi: 2 * most, log: true}, u[1],
            `${s.place}, amplitude of each harmonic, ${u[0]}`));
    const used = [];
    for (let k = 0; k < shown; k++) {
      const a = b.row(s.row + k);
      p.line("line h" + k, b.f, a);
      let end = -1; /* label the rightmost visible point */
      for (let i = 0; i < b.n; i++)
        if (b.f[i] <= p.ax.hi * (1 + 1e-9) && a[i] > p.ay.lo && (end < 0 || b.f[i] > b.f[end]))
          end = i;
      if (end < 0) continue;
      let y = p.y(a[end]) + 4;
      while (used.some(v => Math.abs(v - y) < 14)) y += 14;
      used.push(y);
      p.svg += `<text class="mark h${k}" x="${p.x(b.f[end]) + 6}" y="${y}">k = ${k}${
          k > 0 && b.order > 1 ? "/" + b.order : ""}</text>`;
    }
    show("harmonics", 360, [p]);
  }

  /* ---------------------------------------------------------------- the chosen point */
  const FORCE = [["MN", 1e6], ["kN", 1e3], ["N", 1], ["mN", 1e-3], ["µN", 1e-6]];
  const forceUnit = largest =>
      largest >= 1e4 ? unit(FORCE, largest) : largest >= 1 ? FORCE[2] : unit(FORCE, largest);
  const STATES = ["stick", "slip", "gap"];
  /* The highest point of a branch. */
  function topOf(b) {
    const a = D.branches[b].row(state.output.row);
    let top = 0;
    for (let i = 1; i < a.length; i++)
      if (a[i] > a[top]) top = i;
    return top;
  }
  /* Index into contact.at of the stored point nearest along the curve. */
  function storedAt(contact, i) {
    let best = 0;
    contact.at.forEach((p, j) => {
      if (Math.abs(p - i) < Math.abs(contact.at[best] - i)) best = j;
    });
    return best;
  }
  /* One period of the chosen contact at stored point j, as the program computed it. */
  function unpack(b, j) {
    const FULL = 32767, SIGNALS = 7, place = j * D.contacts.length + state.pair;
    if (!b.samples) {
      b.samples = new Int16Array(Plot.bytes(b.contact.data).buffer);
      let at = 0;
      b.start = b.contact.loops.map(l => (at += SIGNALS * l[0]) - SIGNALS * l[0]);
    }
    const [n, u, w, fu, fw, load, limit, stick, slip, open, work] = b.contact.loops[place];
    const row = i => b.samples.subarray(b.start[place] + i * n, b.start[place] + (i + 1) * n);
    const signal = (i, scale) => Float64Array.from(row(i), v => v * scale / FULL);
    return {
      n, work, shares: [stick, slip, open], most: load, bound: limit, time: signal(0, b.order),
      u: signal(1, u), w: signal(2, w), fu: signal(3, fu), fw: signal(4, fw),
      load: signal(5, load), limit: signal(5, limit), state: row(6),
      index: b.contact.at[j], order: b.order
    };
  }
  function period() {
    const b = D.branches[state.branch];
    if (!b || !b.contact || !b.contact.at.length) return null;
    return unpack(b, storedAt(b.contact, state.point));
  }
  function states(p, xs, ys, s) {
    STATES.forEach((name, k) => p.line("line " + name, xs, ys, i => s[i] === k));
  }
  /* Arrowhead along a path, at a share of the period. */
  function arrow(p, xs, ys, share) {
    const i = Math.round(share * (xs.length - 1)), x = p.x(xs[i]), y = p.y(ys[i]);
    for (let j = i + 1; j < xs.length; j++) {
      const dx = p.x(xs[j]) - x, dy = p.y(ys[j]) - y, size = Math.hypot(dx, dy);
      if (size < 4) continue;
      const c = dx / size, s = dy / size, f = v => v.toFixed(1);
      p.svg += `<path class="arrow" d="M${f(x + 7 * c)} ${f(y + 7 * s)}L${f(x - 4 * c - 4.5 * s)} ${
          f(y - 4 * s + 4.5 * c)}L${f(x - 4 * c + 4.5 * s)} ${f(y - 4 * s - 4.5 * c)}Z"/>`;
      return;
    }
  }
  const moderate = ([lo, hi], least) =>
      hi - lo > least ? around(lo, hi, false) : {lo: lo - least, hi: hi + least, log: false};
  function drawLoop(id, x, f, q, name, force) {
    const span = extent(x), u = unit(LENGTH, Math.max(Math.abs(span[0]), Math.abs(span[1])));
    const width = widthOf(id), most = q.bound || 1;
    const p = new Panel(
        id, {left: 60, top: 34, width: width - 80, height: 290},
        axis(moderate(span, 1e-3 * u[1]), u[1], `relative motion ${name}, ${u[0]}`),
        axis(moderate(extent(f), 1e-3 * most), force[1], `friction along ${name}, ${force[0]}`));
    states(p, x, f, q.state);
    for (const share of [0.12, 0.62]) arrow(p, x, f, share);
    show(id, 380, [p]);
  }
  function drawPath(q, force) {
    const width = widthOf("path"), box = {left: 60, top: 34, width: width - 80, height: 290};
    const radii = extent(q.limit), most = 1.08 * (radii[1] || force[1]),
          wide = most * box.width / box.height;
    const p = new Panel(
        "path", box, axis({lo: -wide, hi: wide, log: false}, force[1], "friction along u, " + force[0]),
        axis({lo: -most, hi: most, log: false}, force[1], "friction along w, " + force[0]));
    for (const r of radii)
      if (r > 0)
        p.svg += `<circle class="circle" cx="${p.x(0)}" cy="${p.y(0)}" r="${
            (p.x(r) - p.x(0)).toFixed(1)}"/>`;
    states(p, q.fu, q.fw, q.state);
    for (const share of [0.12, 0.62]) arrow(p, q.fu, q.fw, share);
    show("path", 380, [p]);
  }
  function drawPeriod(q, force) {
    const width = widthOf("period"), {time, limit, most} = q;
    const size = q.fu.map((f, i) => Math.hypot(f, q.fw[i]));
    const x = {lo: 0, hi: q.order, log: false}, u = forceUnit(most), box = {left: 60, width: width - 80};
    const above = new Panel(
        "period-n", {...box, top: 34, height: 95}, axis(x, 1, null),
        axis({lo: 0, hi: 1.08 * most || 1, log: false}, u[1], "normal load, " + u[0]));
    const below = new Panel(
        "period-f", {...box, top: 172, height: 118}, axis(x, 1, null),
        axis({lo: 0, hi: 1.08 * q.bound || 1, log: false}, force[1],
             `friction and its limit μn (dashed), ${force[0]}`));
    const bar = new Panel(
        "period-s", {...box, top: 298, height: 22},
        axis(x, 1, "time, periods of the excitation"), axis({lo: 0, hi: 1, log: false}, 0, null));
    above.line("line load", time, q.load);
    below.line("line bound", time, limit);
    states(below, time, size, q.state);
    for (let i = 1, from = 0; i < q.n; i++)
      if (i === q.n - 1 || q.state[i + 1] !== q.state[i]) {
        bar.bar("state " + STATES[q.state[i]], time[from], time[i], 0, 1);
        from = i;
      }
    show("period", 380, [above, below, bar]);
  }
  function drawSpectrum() {
    const b = D.branches[state.branch], s = D.spectra.find(e => e.place === state.output.place);
    if (!s) {
      show("spectrum", 60, [], `<text x="0" y="30">The harmonics of ${
          escape(state.output.place)} are not in this page; the response file has them.</text>`);
      return;
    }
    const a = [...Array(s.n).keys()].map(k => b.row(s.row + k)[state.point]);
    const most = Math.max(...a) || 1e-6, u = unit(LENGTH, most), width = widthOf("spectrum");
    const p = new Panel(
        "spectrum", {left: 60, top: 34, width: width - 80, height: 190},
        axis({lo: -0.6, hi: s.n - 0.4, log: false}, 0, null),
        axis({lo: 1e-6 * most, hi: 2 * most, log: true}, u[1], `${s.place}, amplitude, ${u[0]}`));
    a.forEach((v, k) => {
      if (v > p.ay.lo) p.bar("bar h" + Math.min(k, 7), k - 0.36, k + 0.36, p.ay.lo, v);
      p.svg += `<text class="tick" x="${p.x(k).toFixed(1)}" y="241" text-anchor="middle">${k}${
          b.order > 1 && k ? "/" + b.order : ""}</text>`;
    });
    p.svg += `<text class="axis" x="${width - 20}" y="260" text-anchor="end">harmonic k</text>`;
    show("spectrum", 270, [p]);
  }
  function showBlade() {
    if (typeof Blade === "undefined" || !Blade || state.branch < 0) return;
    const b = D.branches[state.branch], i = state.point;
    Blade.choose(
        state.branch, b.f[i], b.row(outputs[0].row)[i],
        x => `${groupOf(b).name}${b.note}, ${xText(x)}`);
  }
  function drawPoint() {
    if (!$("point") || state.branch < 0) return;
    const b = D.branches[state.branch], g = groupOf(b), r = readout(b, state.point);
    $("point-where").textContent = r.title + ": " +
        r.rows.map(([k, v]) => k + " " + v).join(", ") +
        ". Click the curves above to choose another.";
    drawSpectrum();
    if (!$("loop-u")) return;
    drawContact(b);
  }
  const LOOPS = ["loop-u", "loop-w", "path", "period"];
  /* The numbers of the contact at the point. */
  function contactText(q) {
    const range = (values, most) => {
      const u = forceUnit(most);
      return `${extent(values).map(v => number(v / u[1], 3)).join(" to ")}${NBSP}${u[0]}`;
    };
    const e = unit(ENERGY, q.work);
    return `${D.contacts[state.pair]}: normal load ${range(q.load, q.most)}, friction limit ${
        range(q.limit, q.bound)}; stuck · slipping · open ${sharesOf(q.shares)}; dissipated ${
        number(q.work / e[1], 3)}${NBSP}${e[0]}.`;
  }
  /* The chosen contact at the point: its loops, its load, its numbers. */
  function drawContact(b) {
    const q = period(), text = [];
    $("pair-label").hidden = D.contacts.length < 2;
    if (!q) return;
    if (q.index !== state.point)
      text.push(`Drawn at the nearest point that this page has the contact of, ${
          xText(b.f[q.index])}: all would make it too large.`);
    if (D.contacts.length < D.pairs)
      text.push(`The page has the ${D.contacts.length} of ${
          D.pairs} contacts that dissipate most.`);
    if (q.n) text.unshift(contactText(q));
    else
      text.unshift("The contact law of the case does not give the forces that the file has here, " +
          "so nothing is drawn. Was the file made from other settings?");
    $("contact-where").textContent = text.join(" ");
    if (!q.n) {
      for (const id of LOOPS) show(id, 380, []);
      return;
    }
    const force = forceUnit(q.bound);
    drawLoop("loop-u", q.u, q.fu, q, "u", force);
    drawLoop("loop-w", q.w, q.fw, q, "w", force);
    drawPath(q, force);
    drawPeriod(q, force);
  }

  /* ---------------------------------------------------------------- controls */
  function fill(select, options, chosen) {
    select.innerHTML =
        options.map(([v, text]) => `<option value="${escape(String(v))}">${escape(text)}</option>`)
            .join("");
    select.value = String(chosen);
  }
  function choices() {
    const o = state.output, here = outputs.filter(e => e.place === o.place);
    fill($("place"), unique(outputs.map(e => e.place)).map(p => [p, p]), o.place);
    fill($("axis"), unique(here.map(e => e.axis)).map(a => [a, a]), o.axis);
    for (const button of document.querySelectorAll("[data-quantity]")) {
      const quantity = button.dataset.quantity;
      button.setAttribute("aria-pressed", String(quantity === o.quantity));
      button.disabled = !here.some(e => e.axis === o.axis && e.quantity === quantity);
    }
    for (const button of document.querySelectorAll("[data-scale]"))
      button.setAttribute("aria-pressed", String((button.dataset.scale === "log") === state.log));
  }
  function choose(place, ax, quantity) {
    state.zoomY = null;
    const match = (a, q) => outputs.find(
        e => e.place === place && (a === null || e.axis === a) && (q === null || e.quantity === q));
    state.output =
        match(ax, quantity) || match(ax, null) || match(null, quantity) || match(null, null);
    drawAll();
  }
  function select(index, point) {
    if (index < 0 || D.branches[index].dots || groupOf(D.branches[index]).kind !== "nonlinear")
      return;
    state.branch = index;
    state.point = point === undefined ? topOf(index) : point;
    showBlade();
    if ($("curve")) $("curve").value = String(index);
    drawResponse();
    drawPoint();
    drawAlong();
    drawHarmonics();
  }
  function drawAll() {
    choices();
    drawResponse();
    drawPoint();
    drawTracking();
    drawState();
    drawAlong();
    drawHarmonics();
  }
  function setZoom(range, rangeY = null) {
    state.zoom = range;
    state.zoomY = rangeY;
    drawResponse();
    drawAlong();
    drawHarmonics();
  }

  function wireControls() {
    $("place").onchange = e => choose(e.target.value, null, state.output.quantity);
    $("axis").onchange = e => choose(state.output.place, e.target.value, state.output.quantity);
    for (const b of document.querySelectorAll("[data-quantity]"))
      b.onclick = () => choose(state.output.place, state.output.axis, b.dataset.quantity);
    for (const b of document.querySelectorAll("[data-scale]"))
      b.onclick = () => {
        state.log = b.dataset.scale === "log";
        state.zoomY = null;
        drawAll();
      };
    $("whole").onclick = () => setZoom(null);
    if ($("pair")) {
      fill($("pair"), D.contacts.map((name, i) => [i, name]), 0);
      $("pair").onchange = e => {
        state.pair = +e.target.value;
        drawPoint();
      };
    }
    if ($("curve")) {
      const list = D.branches.map((b, i) => i)
                       .filter(
                           i => groupOf(D.branches[i]).kind === "nonlinear" &&
                               !D.branches[i].dots && D.branches[i].n > 0);
      list.sort((i, j) => D.branches[i].group - D.branches[j].group || i - j);
      const many = g => list.filter(i => D.branches[i].group === g).length > 1;
      fill(
          $("curve"),
          list.map(
              i =>
                  [i,
                   groupOf(D.branches[i]).name + D.branches[i].note +
                       (many(D.branches[i].group) ? ` (curve ${i})` : "")]),
          state.branch);
      $("curve").onchange = e => select(+e.target.value);
    }
    for (const key of document.querySelectorAll(".key[data-group]")) {
      const button = document.createElement("button");
      button.type = "button";
      button.className = key.className;
      button.innerHTML = key.innerHTML;
      button.setAttribute("aria-pressed", "true");
      const group = +key.dataset.group;
      button.dataset.group = group;
      button.onclick = () => {
        if (hidden.has(group)) hidden.delete(group);
        else
          hidden.add(group);
        button.setAttribute("aria-pressed", String(!hidden.has(group)));
        drawResponse();
      };
      key.replaceWith(button);
    }
  }
  function wireChart() {
    const svg = $("response");
    let from = null;
    const local = e => {
      const r = svg.getBoundingClientRect(), s = widthOf("response") / r.width;
      return [(e.clientX - r.left) * s, (e.clientY - r.top) * s];
    };
    const clamp = ([x, y]) => [
      Math.max(main.box.left, Math.min(main.box.left + main.box.width, x)),
      Math.max(main.box.top, Math.min(main.box.top + main.box.height, y))
    ];
    const ENOUGH = 6, TALL = 14; /* px of a drag: along x, and for the amplitude too */
    /* Zoom from corner to corner, px; a flat rectangle keeps the amplitudes, a narrow one the
     * abscissa. */
    function zoomTo([x0, y0], [x1, y1]) {
      const flat = Math.abs(y1 - y0) < TALL, narrow = Math.abs(x1 - x0) <= ENOUGH;
      setZoom(
          narrow ? state.zoom : [main.value(Math.min(x0, x1)), main.value(Math.max(x0, x1))],
          flat ? state.zoomY : [main.valueY(Math.max(y0, y1)), main.valueY(Math.min(y0, y1))]);
    }
    /* Both ranges by factors about a place, px. */
    function zoomBy(place, factorX, factorY) {
      const [x, y] = clamp(place), b = main.box;
      const low = [x - (x - b.left) * factorX, y - (y - b.top) * factorY],
            high = [x + (b.left + b.width - x) * factorX, y + (b.top + b.height - y) * factorY];
      const xs = [main.value(low[0]), main.value(high[0])],
            ys = [main.valueY(high[1]), main.valueY(low[1])];
      const range = [Math.max(xs[0], X.range[0]), Math.min(xs[1], X.range[1])];
      const whole = range[0] <= X.range[0] && range[1] >= X.range[1];
      if (whole && factorX > 1) setZoom(null);
      else if (range[1] - range[0] > 1e-7 * (X.range[1] - X.range[0]))
        setZoom(whole ? null : range, main.ay.log || ys[0] >= 0 ? ys : [0, ys[1]]);
    }
    const fingers = new Map();
    let spread = 0, tapped = null;
    function pinch() {
      const [p, q] = [...fingers.values()], size = Math.hypot(p[0] - q[0], p[1] - q[1]);
      if (spread > 0 && size > 0)
        zoomBy([(p[0] + q[0]) / 2, (p[1] + q[1]) / 2], spread / size, spread / size);
      spread = size;
    }
    svg.setAttribute("tabindex", "0");
    svg.addEventListener("pointerdown", e => {
      if (e.pointerType === "touch") {
        fingers.set(e.pointerId, local(e));
        tapped = fingers.size === 1 ? local(e) : null;
        spread = 0;
      } else if (e.button === 0) {
        from = clamp(local(e));
        e.preventDefault();
        svg.focus({preventScroll: true});
      }
    });
    svg.addEventListener("pointermove", e => {
      const [x, y] = local(e);
      if (fingers.has(e.pointerId)) {
        fingers.set(e.pointerId, [x, y]);
        if (tapped && Math.hypot(x - tapped[0], y - tapped[1]) > 12) tapped = null;
        if (fingers.size === 2) pinch();
      }
      if (from !== null && Math.hypot(x - from[0], y - from[1]) > ENOUGH) {
        const to = clamp([x, y]), b = main.box, flat = Math.abs(to[1] - from[1]) < TALL,
              narrow = Math.abs(to[0] - from[0]) <= ENOUGH;
        const left = narrow ? b.left : Math.min(from[0], to[0]),
              top = flat ? b.top : Math.min(from[1], to[1]);
        $("readout").hidden = true;
        $("hover").innerHTML = `<rect class="band" x="${left}" y="${top}" width="${
            narrow ? b.width : Math.abs(to[0] - from[0])}" height="${
            flat ? b.height : Math.abs(to[1] - from[1])}"/>`;
        return;
      }
      if (fingers.size > 1) return;
      state.at = nearest(x, y);
      svg.style.cursor = state.at ? "pointer" : "crosshair";
      drawHover();
    });
    const lift = e => {
      if (!fingers.delete(e.pointerId)) return false;
      spread = 0;
      if (e.type === "pointerup" && tapped) {
        state.at = nearest(...tapped);
        if (state.at) select(state.at.b, state.at.i);
        drawHover();
      }
      tapped = null;
      return true;
    };
    window.addEventListener("pointerup", e => {
      if (lift(e) || from === null) return;
      const to = clamp(local(e)), start = from;
      from = null;
      if (Math.hypot(to[0] - start[0], to[1] - start[1]) > ENOUGH) zoomTo(start, to);
      else if (state.at)
        select(state.at.b, state.at.i);
    });
    window.addEventListener("pointercancel", lift);
    svg.addEventListener("wheel", e => {
      if (document.activeElement !== svg && !e.ctrlKey) return; /* else the page scrolls */
      e.preventDefault();
      const factor = Math.exp(0.0015 * e.deltaY);
      zoomBy(local(e), factor, e.shiftKey ? 1 : factor);
    }, {passive: false});
    svg.addEventListener("pointerleave", () => {
      if (from === null) {
        state.at = null;
        drawHover();
      }
    });
    svg.addEventListener("dblclick", () => setZoom(null));
    svg
        .addEventListener(
            "keydown", e => {
              const shown =
                  D.branches.map((b, i) => i)
                      .filter(i => !hidden.has(D.branches[i].group) && D.branches[i].n > 0);
              if (!shown.length) return;
              const at =
                  state.at || {b: shown.includes(state.branch) ? state.branch : shown[0], i: 0};
              const step = e.shiftKey ? 10 : 1, b = D.branches[at.b];
              if (e.key === "ArrowRight" || e.key === "ArrowLeft") {
                const by = e.key === "ArrowRight" ? step : -step;
                state.at = {b: at.b, i: state.at ? Math.max(0, Math.min(b.n - 1, at.i + by)) : 0};
              } else if (e.key === "ArrowUp" || e.key === "ArrowDown") {
                const by = e.key === "ArrowUp" ? 1 : shown.length - 1;
                const j = shown[(shown.indexOf(at.b) + by) % shown.length];
                let i = 0;
                D.branches[j].f.forEach((f, k) => {
                  if (Math.abs(f - b.f[at.i]) < Math.abs(D.branches[j].f[i] - b.f[at.i])) i = k;
                });
                state.at = {b: j, i};
              } else if (e.key === "Enter" && state.at) {
                select(state.at.b, state.at.i);
              } else if (e.key === "Escape") {
                state.at = null;
                if (state.zoom || state.zoomY) setZoom(null);
              } else
                return;
              e.preventDefault();
              drawHover();
              announce();
            });
  }

  document.documentElement.classList.add("js");
  if (state.branch >= 0) state.point = topOf(state.branch);
  wireControls();
  wireChart();
  drawAll();
  showBlade();
  const name = document.querySelector("h1").textContent.replace(/[^\w.-]+/g, "_");
  Plot.offer(name);
  if (typeof Blade !== "undefined" && Blade && $("blade-save"))
    $("blade-save").onclick = () => Plot.save(name + "_blade.png", Blade.picture());
  let timer;
  window.addEventListener("resize", () => {
    clearTimeout(timer);
    timer = setTimeout(drawAll, 80);
  });
})();
