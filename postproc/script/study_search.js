/* History of an optimum, and what moves the peak. */
import {number, escape} from "./numbers.js";
import {around, axis} from "./axes.js";
import {Panel} from "./panel.js";
import {$, show, widthOf} from "./chart.js";
import {
  D, CHARTS, best, keys, outputs, state, ids, active, css, colourOf, section, card, plot, canvas,
  clip, disc, U, R
} from "./study_state.js";
import {pointable} from "./study_design.js";
import {rangeOf} from "./study_effects.js";

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
  show(id, {height, panels: [p]});
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

/* Relative derivative d ln peak / d ln q; the value of q is known where q is a varied key. */
function sensitivities(i) {
  const peak = outputs.find(o => o.name === "peak");
  return D.derivatives.map((d, j) => {
    const last = d.name.split(".").pop();
    const key =
        keys.find(k => k.name === d.name) || keys.find(k => k.name.split(".").pop() === last);
    const value = D.derivative[j][i];
    const alone = D.derivative_at[j] === null ? NaN : D.derivative_at[j];
    const at = key ? key.list[i] : alone;
    const relative = value !== null && Number.isFinite(at) && peak && peak.all[i];
    return {
      name: d.name,
      unit: d.unit,
      value,
      share: relative ? value * at / peak.all[i] : NaN
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
  show(id, {height, panels: [], extra: svg});
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

export {buildHistory, buildTornado};
