/* Uncertain and robust designs. */
import {NBSP, number, escape, extent} from "./numbers.js";
import {linearTicks, around, axis} from "./axes.js";
import {Panel} from "./panel.js";
import {$, show, widthOf} from "./chart.js";
import {
  D, CHARTS, keys, outputs, known, state, section, card, plot, select, U, R
} from "./study_state.js";
import {rangeOf} from "./study_effects.js";

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
  show(id, {height, panels: [p], extra: svg});
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
  show(id, {height, panels: [], extra: svg});
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
                      U.percentile[o.index].map(e => `<td>${percentileCell(o, e)}</td>`)
                          .join("")}</tr>`)
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
  show(id, {height, panels: [p], extra: svg});
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

export {buildUncertainty, buildRobust};
