/* Numbers, axes and panels of the charts: shared by the scripts of all pages. */
const Plot = (() => {
  "use strict";
  const $ = id => document.getElementById(id);
  const NBSP = "\u00a0";

  /* ---------------------------------------------------------------- numbers */
  const superscript = n => String(n).replace("-", "⁻").replace(/\d/g, d => "⁰¹²³⁴⁵⁶⁷⁸⁹"[d]);
  function number(value, digits, keep = true) {
    if (!Number.isFinite(value)) return "–";
    if (value === 0) return "0";
    const power = Math.floor(Math.log10(Math.abs(value)) + 1e-12);
    let text;
    if (power < -4 || power >= Math.max(digits, 6)) {
      const mantissa = (value / 10 ** power).toFixed(Math.max(digits - 1, 0));
      text = (keep ? mantissa : String(+mantissa)) + "×10" + superscript(power);
    } else {
      text = (+value.toPrecision(digits)).toFixed(Math.max(0, digits - 1 - power));
      if (!keep) text = String(+text);
    }
    return text.replace("-", "−");
  }
  const LENGTH = [["m", 1], ["mm", 1e-3], ["µm", 1e-6], ["nm", 1e-9], ["pm", 1e-12]];
  const ENERGY = [["kJ", 1e3], ["J", 1], ["mJ", 1e-3], ["µJ", 1e-6], ["nJ", 1e-9]];
  function unit(list, largest) {
    if (!(largest > 0)) return list[2];
    return list.find(u => largest >= 0.9995 * u[1]) || list[list.length - 1];
  }
  const percent = x => Number.isFinite(x) ? number(100 * x, 2, false) + NBSP + "%" : "–";
  const escape = s => s.replace(/[&<>"']/g, c => "&#" + c.charCodeAt(0) + ";");

  /* The bytes of a text in base64. */
  function bytes(text) {
    const all = atob(text), out = new Uint8Array(all.length);
    for (let i = 0; i < all.length; i++) out[i] = all.charCodeAt(i);
    return out;
  }

  /* ---------------------------------------------------------------- axes */
  function evenTicks(lo, hi, wanted) {
    const raw = (hi - lo) / wanted, power = 10 ** Math.floor(Math.log10(raw)), m = raw / power;
    const step = power * (m <= 1.0001 ? 1 : m <= 2.0001 ? 2 : m <= 5.0001 ? 5 : 10), ticks = [];
    for (let k = Math.ceil(lo / step - 1e-9); k * step <= hi + 1e-9 * step && ticks.length < 40;
         k++)
      ticks.push(k * step);
    return ticks;
  }
  /* A step rounded up past the range leaves a single tick: then take finer steps. */
  function linearTicks(lo, hi, wanted) {
    let ticks = [];
    for (let w = wanted; ticks.length < 2 && w <= 3 * wanted; w++) ticks = evenTicks(lo, hi, w);
    return ticks;
  }
  function logTicks(lo, hi, wanted) {
    const decades = Math.log10(hi / lo), ticks = [];
    if (decades < 0.5) return linearTicks(lo, hi, wanted);
    const parts = decades <= wanted / 2.5 ? [1, 2, 5] : [1], skip = Math.ceil(decades / wanted);
    for (let d = Math.floor(Math.log10(lo)); d <= Math.ceil(Math.log10(hi)); d++)
      for (const p of parts) {
        const t = p * 10 ** d;
        if (t >= lo * (1 - 1e-9) && t <= hi * (1 + 1e-9) && d % skip === 0) ticks.push(t);
      }
    return ticks;
  }
  function signedTicks(a, wanted) {
    const lowest = Math.floor(Math.log10(a.knee / a.unit)),
          highest = Math.ceil(Math.log10(Math.max(Math.abs(a.lo), Math.abs(a.hi)) / a.unit));
    const ticks = a.lo <= 0 && a.hi >= 0 ? [0] : [];
    for (const sign of [1, -1]) {
      let last = Panel.place(a, 0);
      for (let i = 0; i < 3 * (highest - lowest + 1); i++) {
        const t = sign * [1, 2, 5][i % 3] * 10 ** (lowest + Math.floor(i / 3)),
              at = Panel.place(a, t * a.unit);
        if (at < 0 || at > 1 || Math.abs(at - last) < 0.7 / wanted) continue;
        ticks.push(t);
        last = at;
      }
    }
    return ticks;
  }
  /* Axis by asinh(value / knee): both signs over decades. */
  function signed(lo, hi, knee) {
    const a = Math.asinh(lo / knee), b = Math.asinh(hi / knee), air = 0.04 * (b - a);
    return {lo: knee * Math.sinh(a - air), hi: knee * Math.sinh(b + air), log: false, knee};
  }
  function around(lo, hi, log) {
    if (!(lo <= hi)) [lo, hi] = [0, 1];
    log = log && lo > 0;
    if (hi - lo <= 1e-12 * Math.max(Math.abs(lo), Math.abs(hi))) {
      const extent = lo === 0 ? 1 : 0.05 * Math.abs(lo);
      lo -= extent;
      hi += extent;
    }
    const air = 0.04 * (log ? Math.log(hi / lo) : hi - lo);
    return log ? {lo: lo * Math.exp(-air), hi: hi * Math.exp(air), log} :
                 {lo: lo - air, hi: hi + air, log};
  }
  const axis = (range, unitScale, label) => ({...range, unit: unitScale, label});

  /* One data area: box {left, top, width, height} in px, axes {lo, hi, log, unit, label}. */
  class Panel {
    constructor(id, box, x, y) {
      Object.assign(this, {id, box, ax: x, ay: y, svg: "", series: []});
      this.frame();
    }
    static place(a, v) {
      if (a.knee)
        return (Math.asinh(v / a.knee) - Math.asinh(a.lo / a.knee)) /
            (Math.asinh(a.hi / a.knee) - Math.asinh(a.lo / a.knee));
      return a.log ? (v > 0 ? Math.log(v / a.lo) / Math.log(a.hi / a.lo) : NaN) :
                     (v - a.lo) / (a.hi - a.lo);
    }
    x(v) { return this.box.left + this.box.width * Panel.place(this.ax, v); }
    y(v) {
      return Math.max(
          -9e3, Math.min(9e3, this.box.top + this.box.height * (1 - Panel.place(this.ay, v))));
    }
    value(px) {
      const a = this.ax, t = (px - this.box.left) / this.box.width;
      return a.log ? a.lo * (a.hi / a.lo) ** t : a.lo + t * (a.hi - a.lo);
    }
    valueY(py) {
      const a = this.ay, t = 1 - (py - this.box.top) / this.box.height;
      return a.log ? a.lo * (a.hi / a.lo) ** t : a.lo + t * (a.hi - a.lo);
    }
    /* What is drawn, for the table of the chart. */
    note(classes, xs, ys, piece) { this.series.push({classes, xs, ys, piece}); }
    ticks(a, wanted) {
      return a.knee  ? signedTicks(a, wanted) :
          a.unit > 0 ? (a.log ? logTicks : linearTicks)(a.lo / a.unit, a.hi / a.unit, wanted) :
                       [];
    }
    frame() {
      const {left, top, width, height} = this.box, bottom = top + height, right = left + width;
      this.svg += `<clipPath id="${this.id}-clip"><rect x="${left}" y="${top}" width="${
          width}" height="${height}"/></clipPath>`;
      for (const t of this.ticks(this.ax, Math.max(3, Math.floor(width / 90)))) {
        const x = this.x(t * this.ax.unit).toFixed(1);
        this.svg += `<path class="grid" d="M${x} ${top}V${bottom}"/>`;
        if (this.ax.label)
          this.svg += `<text class="tick" x="${x}" y="${bottom + 17}" text-anchor="middle">${
              number(t, 7, false)}</text>`;
      }
      for (const t of this.ticks(this.ay, Math.max(2, Math.floor(height / 55)))) {
        const y = this.y(t * this.ay.unit);
        this.svg += `<path class="grid" d="M${left} ${y.toFixed(1)}H${right}"/>`;
        if (this.ay.label)
          this.svg += `<text class="tick" x="${left - 8}" y="${
              (y + 4).toFixed(1)}" text-anchor="end">${number(t, 7, false)}</text>`;
      }
      if (this.ax.label)
        this.svg += `<text class="axis" x="${right}" y="${bottom + 36}" text-anchor="end">${
            escape(this.ax.label)}</text>`;
      if (this.ay.label)
        this.svg +=
            `<text class="axis" x="${left - 48}" y="${top - 12}">${escape(this.ay.label)}</text>`;
      this.svg += `<path class="base" d="M${left} ${bottom}H${right}"/>`;
    }
    /* the area between two curves */
    band(classes, xs, low, high) {
      const at = [...xs.keys()], back = at.slice().reverse();
      const points = [...at.map(i => [xs[i], low[i]]), ...back.map(i => [xs[i], high[i]])];
      const d = points.map(([x, y]) => [this.x(x), this.y(y)])
                    .filter(p => p.every(Number.isFinite))
                    .map(([x, y], i) => (i ? "L" : "M") + x.toFixed(1) + " " + y.toFixed(1));
      if (d.length > 2)
        this.svg += `<path class="${classes}" clip-path="url(#${this.id}-clip)" d="${d.join("")}Z"/>`;
    }
    line(classes, xs, ys, piece) {
      this.note(classes, xs, ys, piece);
      if (xs.length === 1 && !piece) this.dot(classes, xs[0], ys[0], 2);
      let d = "", at = -1, px = NaN, py = NaN, lastX = NaN, lastY = NaN;
      for (let i = 0; i < xs.length; i++) {
        const x = this.x(xs[i]), y = this.y(ys[i]);
        if (!Number.isFinite(x + y) || !Number.isFinite(px + py) || (piece && !piece(i))) {
          at = -1;
        } else {
          const more = i + 1 < xs.length && (!piece || piece(i + 1));
          if (!(at >= 0 && Math.hypot(x - lastX, y - lastY) < 0.25 && more)) {
            if (at < 0) d += `M${px.toFixed(2)} ${py.toFixed(2)}`;
            d += `L${x.toFixed(2)} ${y.toFixed(2)}`;
            lastX = x;
            lastY = y;
          }
          at = i;
        }
        px = x;
        py = y;
      }
      if (d) this.svg += `<path class="${classes}" clip-path="url(#${this.id}-clip)" d="${d}"/>`;
    }
    inside(x, y) {
      const b = this.box;
      return x >= b.left - 1 && x <= b.left + b.width + 1 && y >= b.top - 1 &&
          y <= b.top + b.height + 1;
    }
    dot(classes, vx, vy, r) {
      this.note(classes, [vx], [vy]);
      const x = this.x(vx), y = this.y(vy);
      if (this.inside(x, y))
        this.svg +=
            `<circle class="${classes}" cx="${x.toFixed(2)}" cy="${y.toFixed(2)}" r="${r}"/>`;
    }
    bar(classes, x0, x1, y0, y1) {
      this.note(classes, [(x0 + x1) / 2], [y1 - y0]);
      const low = this.y(y0), high = this.y(y1);
      if (low - high >= 0.01)
        this.svg +=
            `<rect class="${classes}" x="${this.x(x0).toFixed(2)}" y="${high.toFixed(2)}" width="${
                (this.x(x1) - this.x(x0)).toFixed(2)}" height="${(low - high).toFixed(2)}"/>`;
    }
    text(classes, vx, vy, dx, dy, anchor, text) {
      const x = this.x(vx), y = this.y(vy);
      if (this.inside(x, y))
        this.svg += `<text class="${classes}" x="${(x + dx).toFixed(1)}" y="${
            (y + dy).toFixed(1)}" text-anchor="${anchor}">${escape(text)}</text>`;
    }
    level(classes, v) {
      const y = this.y(v);
      if (Number.isFinite(y))
        this.svg += `<path class="${classes}" clip-path="url(#${this.id}-clip)" d="M${
            this.box.left} ${y.toFixed(2)}H${this.box.left + this.box.width}"/>`;
    }
  }

  /* ---------------------------------------------------------------- export */
  const shown = {}; /* panels of the charts drawn last */
  const inside = (a, v) => Number.isFinite(v) && v >= Math.min(a.lo, a.hi) && v <= Math.max(a.lo, a.hi);
  /* The numbers of what is seen of a chart: a row a point, in SI units. */
  function table(id) {
    const rows = [["panel", "series", "x", "y"]];
    shown[id].forEach((p, k) => {
      rows.push([k + 1, "axes", p.ax.label || "", p.ay.label || ""]);
      for (const s of p.series)
        for (let i = 0; i < s.xs.length; i++)
          if ((!s.piece || s.piece(i)) && inside(p.ax, s.xs[i]) && inside(p.ay, s.ys[i]))
            rows.push([k + 1, s.classes.trim(), s.xs[i], s.ys[i]]);
    });
    const field = v => /[",\n]/.test(v) ? `"${String(v).replaceAll('"', '""')}"` : v;
    return rows.map(r => r.map(field).join()).join("\n") + "\n";
  }
  /* A chart as a picture of its own, with the style of the page. */
  function picture(id) {
    const svg = $(id), copy = svg.cloneNode(true), [, , w, h] = svg.getAttribute("viewBox").split(" ");
    for (const e of copy.querySelectorAll("#hover")) e.remove();
    copy.setAttribute("width", w);
    copy.setAttribute("height", h);
    const style = document.createElementNS(svg.namespaceURI, "style");
    style.textContent = [...document.querySelectorAll("style")].map(e => e.textContent).join("");
    const paper = document.createElementNS(svg.namespaceURI, "rect");
    paper.setAttribute("width", "100%");
    paper.setAttribute("height", "100%");
    paper.setAttribute("style", "fill:var(--card)");
    copy.prepend(style, paper);
    return new XMLSerializer().serializeToString(copy);
  }
  function save(name, data, type) {
    const link = document.createElement("a");
    link.download = name;
    link.href = type ? URL.createObjectURL(new Blob([data], {type})) : data;
    link.click();
    if (type) setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }
  /* Twice the size in the page, as a data URL. */
  async function raster(id) {
    const image = new Image(), text = picture(id);
    image.src = "data:image/svg+xml;charset=utf-8," + encodeURIComponent(text);
    await image.decode();
    const canvas = document.createElement("canvas");
    canvas.width = 2 * image.width;
    canvas.height = 2 * image.height;
    canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
    return canvas.toDataURL("image/png");
  }
  /* Buttons below every chart of the page. name: of the files. */
  function offer(name) {
    for (const svg of document.querySelectorAll(".chart > svg.plot")) {
      const id = svg.id, box = document.createElement("div"), file = `${name}_${id}`;
      box.className = "export";
      const add = (word, act) => {
        const button = document.createElement("button");
        button.type = "button";
        button.textContent = word;
        button.title = `Save this chart as ${word}`;
        button.dataset.save = word;
        button.onclick = act;
        box.append(button);
      };
      add("SVG", () => save(file + ".svg", picture(id), "image/svg+xml"));
      add("PNG", async () => save(file + ".png", await raster(id)));
      if (shown[id]) add("CSV", () => save(file + ".csv", table(id), "text/csv"));
      svg.parentElement.append(box);
    }
  }

  /* Replace a chart's SVG by panels; its title and description remain. */
  function show(id, height, panels, extra = "") {
    shown[id] = panels;
    const svg = $(id),
          keep = [...svg.querySelectorAll("title, desc")].map(e => e.outerHTML).join("");
    svg.setAttribute("viewBox", `0 0 ${widthOf(id)} ${height}`);
    svg.innerHTML = keep + panels.map(p => p.svg).join("") + extra;
  }
  const widthOf = id => Math.max(300, Math.round($(id).parentElement.clientWidth || 1100));
  const extent = (list, pick = x => x) => {
    let lo = Infinity, hi = -Infinity;
    for (const e of list) {
      const v = pick(e);
      if (v < lo) lo = v;
      if (v > hi) hi = v;
    }
    return [lo, hi];
  };

  return {
    $, NBSP, number, LENGTH, ENERGY, unit, percent, escape, linearTicks, logTicks, signed, around,
    axis, Panel, show, widthOf, extent, offer, save, table, picture, raster, bytes
  };
})();
