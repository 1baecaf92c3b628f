/* One data area of a chart as SVG text, and its numbers as a table. Nothing here needs a page. */
import {number, escape} from "./numbers.js";
import {place, valueAt, ticksOf} from "./axes.js";

const fixed = v => v.toFixed(1);

/* box {left, top, width, height} in px, axes {lo, hi, log, unit, label} */
class Panel {
  constructor(id, box, x, y) {
    Object.assign(this, {id, box, ax: x, ay: y, svg: "", series: []});
    this.frame();
  }
  x(v) { return this.box.left + this.box.width * place(this.ax, v); }
  y(v) {
    const y = this.box.top + this.box.height * (1 - place(this.ay, v));
    return Math.max(-9e3, Math.min(9e3, y));
  }
  value(px) { return valueAt(this.ax, (px - this.box.left) / this.box.width); }
  valueY(py) { return valueAt(this.ay, 1 - (py - this.box.top) / this.box.height); }
  /* What is drawn, for the table of the chart. */
  note(classes, xs, ys, piece) { this.series.push({classes, xs, ys, piece}); }
  frame() {
    const {left, top, width, height} = this.box, bottom = top + height, right = left + width;
    this.svg += `<clipPath id="${this.id}-clip"><rect x="${left}" y="${top}" width="${
      width}" height="${height}"/></clipPath>`;
    for (const t of ticksOf(this.ax, Math.max(3, Math.floor(width / 90)))) {
      const x = fixed(this.x(t * this.ax.unit));
      this.svg += `<path class="grid" d="M${x} ${top}V${bottom}"/>`;
      if (this.ax.label)
        this.svg += `<text class="tick" x="${x}" y="${bottom + 17}" text-anchor="middle">${
          number(t, 7, false)}</text>`;
    }
    for (const t of ticksOf(this.ay, Math.max(2, Math.floor(height / 55)))) {
      const y = this.y(t * this.ay.unit);
      this.svg += `<path class="grid" d="M${left} ${fixed(y)}H${right}"/>`;
      if (this.ay.label)
        this.svg += `<text class="tick" x="${left - 8}" y="${
          fixed(y + 4)}" text-anchor="end">${number(t, 7, false)}</text>`;
    }
    if (this.ax.label)
      this.svg += `<text class="axis" x="${right}" y="${bottom + 36}" text-anchor="end">${
        escape(this.ax.label)}</text>`;
    if (this.ay.label)
      this.svg +=
        `<text class="axis" x="${left - 48}" y="${top - 12}">${escape(this.ay.label)}</text>`;
    this.svg += `<path class="base" d="M${left} ${bottom}H${right}"/>`;
  }
  /* A path inside the data area. */
  path(classes, d) {
    if (d) this.svg += `<path class="${classes}" clip-path="url(#${this.id}-clip)" d="${d}"/>`;
  }
  /* the area between two curves */
  band(classes, xs, low, high) {
    const at = [...xs.keys()], back = at.slice().reverse();
    const points = [...at.map(i => [xs[i], low[i]]), ...back.map(i => [xs[i], high[i]])];
    const d = points.map(([x, y]) => [this.x(x), this.y(y)])
      .filter(p => p.every(Number.isFinite))
      .map(([x, y], i) => (i ? "L" : "M") + fixed(x) + " " + fixed(y));
    if (d.length > 2) this.path(classes, d.join("") + "Z");
  }
  /* A curve, or those of its pieces (from point i - 1 to i) that piece(i) chooses. Points nearer
   * than a quarter of a pixel are left out. */
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
    this.path(classes, d);
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
    const low = this.y(y0), high = this.y(y1), width = this.x(x1) - this.x(x0);
    if (low - high >= 0.01)
      this.svg +=
        `<rect class="${classes}" x="${this.x(x0).toFixed(2)}" y="${high.toFixed(2)}" width="${
          width.toFixed(2)}" height="${(low - high).toFixed(2)}"/>`;
  }
  text(classes, vx, vy, dx, dy, anchor, text) {
    const x = this.x(vx), y = this.y(vy);
    if (this.inside(x, y)) this.label(classes, x + dx, y + dy, anchor, text);
  }
  /* A text at a place in px. */
  label(classes, px, py, anchor, text) {
    this.svg += `<text class="${classes}" x="${fixed(px)}" y="${fixed(py)}" text-anchor="${
      anchor}">${escape(text)}</text>`;
  }
  level(classes, v) {
    const y = this.y(v);
    if (Number.isFinite(y))
      this.path(classes, `M${this.box.left} ${y.toFixed(2)}H${this.box.left + this.box.width}`);
  }
}

/* ---------------------------------------------------------------- numbers */
const within = (a, v) =>
  Number.isFinite(v) && v >= Math.min(a.lo, a.hi) && v <= Math.max(a.lo, a.hi);
const field = v => /[",\n]/.test(v) ? `"${String(v).split("\"").join("\"\"")}"` : v;

/* What is seen of the panels of a chart as comma-separated values: a row a point, in SI units. */
function table(panels) {
  const rows = [["panel", "series", "x", "y"]];
  panels.forEach((p, k) => {
    rows.push([k + 1, "axes", p.ax.label || "", p.ay.label || ""]);
    for (const s of p.series)
      for (let i = 0; i < s.xs.length; i++)
        if ((!s.piece || s.piece(i)) && within(p.ax, s.xs[i]) && within(p.ay, s.ys[i]))
          rows.push([k + 1, s.classes.trim(), s.xs[i], s.ys[i]]);
  });
  return rows.map(r => r.map(field).join()).join("\n") + "\n";
}

export {Panel, table};
