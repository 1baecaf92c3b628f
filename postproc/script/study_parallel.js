/* All designs at once: parallel coordinates. */
import {escape} from "./numbers.js";
import {$, show, widthOf} from "./chart.js";
import {place} from "./study_columns.js";
import {
  D, WAITING, CHARTS, best, keys, known, state, ids, active, css, colourOf, scaleBar, section,
  card, plot, canvas, count, drawAll, FAILED
} from "./study_state.js";

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
/* An axis with its ends, its name, its brush and where it is gripped. */
function rod(a, j) {
  const x = parX(j).toFixed(1), bottom = PAR.top + PAR.height, brush = state.brush.get(a);
  let svg = `<path class="rod" d="M${x} ${PAR.top}V${bottom}"/><text class="axis${
      a === state.output ? " end" : ""}" x="${x}" y="${PAR.top - 28}" text-anchor="middle">${
      escape(cut(a.short))}</text><text x="${x}" y="${PAR.top - 11}" text-anchor="middle">${
      escape(a.text(a.range[1], 3))}</text><text x="${x}" y="${
      bottom + 18}" text-anchor="middle">${escape(a.text(a.range[0], 3))}</text>`;
  if (brush) {
    const y = parY(a, brush[1]), h = parY(a, brush[0]) - y;
    svg += `<rect class="brush" x="${x - 9}" y="${y.toFixed(1)}" width="18" height="${
        Math.max(2, h).toFixed(1)}"/>`;
  }
  return svg + `<rect class="grip" data-axis="${j}" x="${x - 24}" y="${
      PAR.top - 6}" width="48" height="${PAR.height + 12}"/>`;
}
function drawParallel() {
  const id = "parallel-chart", height = PAR.top + PAR.height + PAR.bottom, c = state.output;
  const svg = axes.map(rod).join("");
  show(id, {height, panels: [], extra: svg});
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

export {axes, buildParallel};
