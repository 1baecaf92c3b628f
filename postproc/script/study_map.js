/* Map of two variables. */
import {NBSP, number, escape, extent} from "./numbers.js";
import {linearTicks, logTicks, axis} from "./axes.js";
import {Panel} from "./panel.js";
import {$, show, widthOf} from "./chart.js";
import {place, levels} from "./study_columns.js";
import {gridField, scatterField, refine, contour} from "./study_field.js";
import {
  D, CHARTS, best, keys, known, state, ids, active, css, colourOf, blend, scaleBar, section,
  card, plot, select, canvas, clip, disc, FAILED
} from "./study_state.js";
import {pointable} from "./study_design.js";
import {rangeOf, marks} from "./study_effects.js";

const others = () =>
    keys.map((k, j) => j).filter(j => j !== state.x && j !== state.y && keys[j].many);
/* Is every combination of levels there, as a grid has them? */
const isGrid = D.plan.startsWith("grid") &&
    keys.reduce((n, k) => n * Math.max(1, levels(k).length), 1) <= D.n;
function mapSlice() {
  return ids.filter(i => others().every(j => !isGrid || keys[j].list[i] === state.fixed[j]));
}
/* The output over the map [ny][nx], kept until the map shows something else. */
const kept = {};
function fieldOf(a, b, o, full, slice, nx, ny) {
  const name = [state.x, state.y, o.index, full, ...state.fixed].join();
  if (kept.name === name) return kept.field;
  const at = full ? gridField(a, b, o, slice) :
                    scatterField(a, b, o, slice, keys.filter(k => k.many).length > 2),
        step = full ? 1 : 2;
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
/* A map of output o over keys a and b: its field, colours and place. */
function mapOf(p, slice) {
  const a = keys[state.x], b = keys[state.y], o = state.output, nx = 121, ny = 81;
  const full = isGrid && levels(a).length > 1 && levels(b).length > 1;
  const field = fieldOf(a, b, o, full, slice, nx, ny);
  const seen = [...field].filter(Number.isFinite), range = seen.length ? extent(seen) : [0, 1];
  const c = {...o, range, many: range[1] > range[0], log: range[0] > 0 && range[1] > 20 * range[0]};
  const [left, right] = a.range.map(v => p.x(v)), [low, high] = b.range.map(v => p.y(v));
  const ticks = c.log ? logTicks : linearTicks;
  return {
    a, b, o, c, nx, ny, full, field, left, right, low, high,
    lines: c.many ? ticks(range[0] / o.scale, range[1] / o.scale, 9) : []
  };
}
/* The field fills the range of the designs, not the air around it. Returns [line, where]. */
function drawField(g, m) {
  const dx = (m.right - m.left) / (m.nx - 1), dy = (m.low - m.high) / (m.ny - 1);
  clip(g, {left: m.left, top: m.high, width: m.right - m.left, height: m.low - m.high});
  g.drawImage(
      painted(m.field, m.nx, m.ny, z => blend(place(m.c, z))), m.left - dx / 2, m.high - dy / 2,
      m.right - m.left + dx, m.low - m.high + dy);
  g.lineWidth = 1;
  g.strokeStyle = css("--card");
  g.globalAlpha = 0.75;
  g.beginPath();
  const labels = m.lines.map(t => [t, contour(g, m.field, m.nx, m.ny, t * m.o.scale,
      i => m.left + dx * i, j => m.low - dy * j)]);
  g.stroke();
  g.restore();
  return labels;
}
function drawCross(g, x, y) {
  g.strokeStyle = css("--bad");
  g.lineWidth = 2;
  g.beginPath();
  for (const s of [-1, 1]) {
    g.moveTo(x - 4, y - 4 * s);
    g.lineTo(x + 4, y + 4 * s);
  }
  g.stroke();
}
/* The designs of the map. Returns those that can be pointed at. */
function drawDesigns(g, p, m, slice) {
  const spots = [], ring = css("--card"), size = marks(slice) - 0.6;
  for (const i of slice) {
    const x = p.x(m.a.list[i]), y = p.y(m.b.list[i]);
    g.globalAlpha = active(i) ? 1 : 0.2;
    g.lineWidth = 1.2;
    if (Number.isFinite(m.o.list[i])) disc(g, x, y, size, colourOf(m.c, m.o.list[i]), ring);
    else if (D.status[i] === FAILED) drawCross(g, x, y);
    if (active(i)) spots.push([x, y, i]);
  }
  g.globalAlpha = 1;
  for (const [i, colour] of [[best, css("--accent")], [state.chosen, css("--ink")]]) {
    if (i < 0 || !slice.includes(i)) continue;
    for (const [w, ink] of [[5, css("--card")], [2.4, colour]]) {
      g.lineWidth = w;
      disc(g, p.x(m.a.list[i]), p.y(m.b.list[i]), 8, null, ink);
    }
  }
  return spots;
}
/* The values of the lines, where they do not touch. */
function nameLines(g, m, labels) {
  const used = [], near = ([x, y], at) => Math.abs(x - at[0]) < 44 && Math.abs(y - at[1]) < 16;
  g.font = "600 12px " + css("--text");
  g.textAlign = "center";
  g.lineWidth = 4;
  g.strokeStyle = css("--card");
  g.fillStyle = css("--ink");
  for (const [t, at] of labels) {
    if (!at || used.some(other => near(other, at))) continue;
    used.push(at);
    const x = Math.max(m.left + 16, Math.min(m.right - 16, at[0])),
          y = Math.max(m.high + 14, Math.min(m.low - 6, at[1] + 4));
    g.strokeText(number(t, 4, false), x, y);
    g.fillText(number(t, 4, false), x, y);
  }
}
function mapNote(m, slice) {
  const more = others().length, text = [];
  if (m.full)
    text.push("Dots are the designs. Between them the map is interpolated bilinearly.");
  else if (more)
    text.push(
        "Dots are the designs, the other variables of each differ. The map is the mean of a " +
        "neighbourhood, not a section.");
  else
    text.push("Dots are the designs. Between them the map is interpolated by inverse distance.");
  if (m.full && more) text.push("The other variables are held at the chosen values.");
  if (m.full && slice.some(i => !Number.isFinite(m.o.list[i])))
    text.push("It is blank beside designs without a result.");
  if (slice.some(i => D.status[i] === FAILED)) text.push("Crosses: designs that failed.");
  return text.join(" ");
}
function drawMap() {
  const id = "map-chart", width = widthOf(id), height = Math.min(560, Math.max(360, 0.55 * width));
  const a = keys[state.x], b = keys[state.y], slice = mapSlice();
  const p = new Panel(
      id, {left: 60, top: 34, width: width - 80, height: height - 84},
      axis(rangeOf(a), a.scale, a.label), axis(rangeOf(b), b.scale, b.label));
  show(id, {height, panels: [p]});
  const g = canvas(id, height), m = mapOf(p, slice), labels = drawField(g, m);
  $(id).spots = drawDesigns(g, p, m, slice);
  nameLines(g, m, labels);
  const list = m.lines.map(t => number(t, 4, false)).join(", ");
  $("map-scale").innerHTML = scaleBar(m.c, "Colour:") + (list ?
      `<p class="note">Lines at ${list}${m.o.unit ? NBSP + escape(m.o.unit) : ""}.</p>` : "");
  $("map-note").textContent = mapNote(m, slice);
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

export {buildMap};
