/* The main chart: amplitude over the abscissa, what is read at a point, and the nearest point. */
import {NBSP, LENGTH, ENERGY, number, unit, percent} from "./numbers.js";
import {axis, linearTicks} from "./axes.js";
import {Panel} from "./panel.js";
import {classOf, rangeOf} from "./report_data.js";

const VERDICTS = ["stable", "not judged", "modulated", "never seen"]; /* the later one is drawn */
const KINDS = ["line ", "line unjudged ", "line modulated ", "line unstable "];

/* ---------------------------------------------------------------- axes */
/* [least positive, largest] amplitude within the range. */
function amplitudes(report, state) {
  const range = state.zoom || report.X.range;
  let least = Infinity, most = 0;
  for (const b of report.branches) {
    if (state.hidden.has(b.groupIndex)) continue;
    b.row(state.output.row).forEach((a, i) => {
      if (b.at[i] < range[0] || b.at[i] > range[1]) return;
      if (a > most) most = a;
      if (a > 0 && a < least) least = a;
    });
  }
  return [least, most];
}
function amplitudeRange([least, most], state, empty) {
  if (state.zoomY) return {lo: state.zoomY[0], hi: state.zoomY[1], log: state.log && most > 0};
  if (!(most > 0)) return {lo: 0, hi: empty, log: false};
  return state.log ? {lo: Math.max(least / 1.2, 1e-4 * most), hi: 1.4 * most, log: true} :
    {lo: 0, hi: 1.06 * most, log: false};
}
/* Where the speed follows the frequency: the speed above the chart, at round numbers. */
function speedAxis(p, rpm) {
  const {left, top, width} = p.box, places = [], LABEL = 210; /* px of the amplitude's label */
  for (const at of linearTicks(p.ax.lo * rpm, p.ax.hi * rpm, Math.floor(width / 110))) {
    const x = p.x(at / rpm);
    places.push(`<path class="base" d="M${x.toFixed(1)} ${top}v-4"/>`);
    if (x > left + LABEL)
      places.push(`<text class="tick" x="${x.toFixed(1)}" y="${
        top - 7}" text-anchor="middle">${number(at, 7, false)}</text>`);
  }
  return `<g id="rpm">${places.join("")}<path class="base" d="M${left} ${top}h${
    width}"/><text class="axis" x="${left + width}" y="${
    top - 22}" text-anchor="end">rotor speed, rpm</text></g>`;
}

/* ---------------------------------------------------------------- curves */
/* Points by time integration: dots, or rings where the motion is not periodic. */
function drawDots(p, b, a) {
  for (let k = 0; k < b.n; k++)
    p.dot((b.verdict[k] === "stable" ? "integration " : "integration aperiodic ") +
      classOf(b.group), b.at[k], a[k], 2.6);
}
/* The motion that lasts: the sweep of the ring as bands, settled points as bars. */
function drawLasting(p, b) {
  const ring = b.ring, style = classOf(b.group);
  for (let i = 0, n = 0; ring && i < ring.at.length; i += n + 1) {
    for (n = 0; ring.lasts[i + n];) n++;
    const part = list => list.slice(i, i + n);
    p.band("swing " + style, part(ring.at), part(ring.mean), part(ring.worst));
  }
  for (const {at, mean, worst} of b.lasting) {
    p.line("line lasting " + style, [at, at], [mean, worst], () => true);
    p.dot("dot " + style, at, worst, 2);
  }
}
/* A line for each verdict: a piece has the later verdict of its two ends. No line where the curve
 * leaves the range and returns. */
function drawCurve(p, b, a, classes) {
  const rank = k => VERDICTS.indexOf(b.verdict[k]);
  const verdict = k => k > 0 ? Math.max(rank(k), rank(k - 1)) : rank(k);
  const low = Math.min(...b.at), high = Math.max(...b.at);
  const left = k => b.at[k] === b.at[k - 1] && (b.at[k] === low || b.at[k] === high);
  KINDS.forEach((kind, v) =>
    p.line(kind + classes, b.at, a, k => verdict(k) === v && !left(k)));
  if (b.n === 1) p.dot("dot " + classes, b.at[0], a[0], 3);
  for (let k = 0; k < b.n; k++) {
    if (b.above[k]) p.dot("doubtful " + classes, b.at[k], a[k], 2.2);
    if (b.special[k] === "flip" || b.special[k] === "Neimark-Sacker point")
      p.dot("bifurcation " + classes, b.at[k], a[k], 2.6);
  }
}
/* Names of the linear limits above their peaks, inside the frame and apart from each other. */
function nameLimits(p, limits) {
  const NAME = 44, ABOVE = 7; /* width of a name and its height above the peak, px */
  const {left, width} = p.box, half = NAME / 2;
  const clamp = (v, air) => Math.max(left + air, Math.min(left + width - air, v));
  const names = limits.map(l => ({...l, x: clamp(p.x(l.at), half), y: p.y(l.amplitude) - ABOVE}))
    .filter(l => p.inside(p.x(l.at), p.y(l.amplitude)))
    .sort((a, b) => p.x(a.at) - p.x(b.at));
  if (names.length === 2 && names[1].x - names[0].x < NAME) {
    const middle = clamp((names[0].x + names[1].x) / 2, NAME);
    names[0].x = middle - half;
    names[1].x = middle + half;
  }
  for (const l of names)
    p.label("mark " + l.group.kind, l.x, l.y, "middle", l.group.kind);
}
/* Limits lie below nonlinear curves, those below the chosen one, all below time integration. */
function orderOf(report, state) {
  const rank = i => {
    const b = report.branches[i];
    if (b.dots) return 3;
    if (b.group.kind !== "nonlinear") return 0;
    return i === state.branch ? 2 : 1;
  };
  return [...report.branches.keys()].sort((i, j) => rank(i) - rank(j));
}

function responseView(report, state, width) {
  const {output, hidden} = state, height = width < 640 ? 420 : 540, {rpm} = report;
  const range = amplitudes(report, state), u = unit(LENGTH, range[1]), top = rpm ? 54 : 34;
  const p = new Panel("response", {left: 60, top, width: width - 80, height: height - top - 50},
    axis(rangeOf(report, state), report.X.scale, report.xLabel),
    axis(amplitudeRange(range, state, u[1]), u[1],
      `${output.place} ${output.axis}, ${output.quantity}, ${u[0]}`));
  if (rpm) p.svg += speedAxis(p, rpm);
  for (const i of orderOf(report, state)) {
    const b = report.branches[i], a = b.row(output.row);
    if (hidden.has(b.groupIndex)) continue;
    if (b.dots) drawDots(p, b, a);
    else drawCurve(p, b, a, classOf(b.group) + (i === state.branch ? " chosen" : ""));
    if (output === report.outputs[0] && report.sweep) drawLasting(p, b);
  }
  const shown = list => list.filter(e => !hidden.has(e.groupIndex));
  for (const f of shown(output.folds))
    p.dot("fold " + classOf(f.group), f.at, f.amplitude, 2.6);
  nameLimits(p, shown(output.limits));
  const chosen = report.branches[state.branch];
  if (chosen && !hidden.has(chosen.groupIndex))
    p.dot("here", chosen.at[state.point], chosen.row(output.row)[state.point], 4.5);
  return {height, panels: [p], extra: "<g id=\"hover\"></g>"};
}

/* ---------------------------------------------------------------- reading a point */
const sharesText = shares =>
  shares.map(s => (100 * s).toFixed(s > 0 && s < 0.0995 ? 1 : 0)).join(" · ") + NBSP + "%";

const STABILITY = {
  "stable": "stable", "modulated": "modulated", "never seen": "beyond a fold: never seen",
  "not judged": "not judged"
};
function errorRow(b, i) {
  const size = b.error[i] > 1 ? "no bound" : percent(b.error[i]);
  if (b.above[i]) return [["error estimate", size + ", above the tolerance: no result"]];
  if (b.notJudged[i]) return [["error estimate", "not judged"]];
  return b.error[i] > 0 ? [["error estimate", size]] : [];
}
function motionRows(b, i, shares) {
  const rows = [], e = unit(ENERGY, b.energy[i]);
  if (shares)
    rows.push(["stuck · slipping · open", sharesText(shares)],
      ["dissipated", number(b.energy[i] / e[1], 3) + NBSP + e[0]]);
  if (b.dots) rows.push(["motion", b.verdict[i] === "stable" ? "periodic" : "not periodic"]);
  else rows.push(["stability", STABILITY[b.verdict[i]]]);
  rows.push(...errorRow(b, i));
  if (b.undetermined[i])
    rows.push(["mean friction", b.shares[0][i] < 1 ?
      "not determined where contacts stick: one of many answers" :
      "not determined: all contacts stick, the vibration is the same"]);
  return rows;
}
const SPECIAL = {
  "fold": ", fold", "peak": ", peak", "flip": ", flip (period doubling)",
  "Neimark-Sacker point": ", Neimark-Sacker point"
};
/* {title, rows [[name, text]], shares or null} of point i of branch b. */
function readout(report, output, b, i) {
  const a = b.row(output.row)[i], u = unit(LENGTH, a), nonlinear = b.group.kind === "nonlinear";
  const shares = nonlinear && Number.isFinite(b.shares[0][i]) ? b.shares.map(s => s[i]) : null;
  const rows = [[report.X.name, report.xText(b.at[i])]];
  if (report.rpm)
    rows.push(["rotor speed", number(b.at[i] * report.rpm, 5, false) + NBSP + "rpm"]);
  rows.push([output.quantity, number(a / u[1], 4) + NBSP + u[0]]);
  if (nonlinear) rows.push(...motionRows(b, i, shares));
  const what = SPECIAL[b.special[i]] || (b.dots ? ", time integration" : "");
  return {
    title: (nonlinear ? b.group.name + b.note : "linear limit, " + b.group.name) + what,
    rows, shares
  };
}
/* A read-out as one sentence. */
const spoken = r => r.title + ": " + r.rows.map(([k, v]) => k + " " + v).join(", ");

/* {b, i} of the point nearest to (px, py) of the main panel, within 40 px; null: none. */
function nearest(report, state, panel, px, py) {
  let best = null, least = 40 * 40;
  report.branches.forEach((b, j) => {
    if (state.hidden.has(b.groupIndex)) return;
    const a = b.row(state.output.row);
    for (let i = 0; i < b.n; i++) {
      const dx = panel.x(b.at[i]) - px;
      if (dx * dx > least) continue;
      const dy = panel.y(a[i]) - py, d = dx * dx + dy * dy;
      if (d < least) {
        least = d;
        best = {b: j, i};
      }
    }
  });
  return best;
}
/* The point that a key leads to from the one that is read (state.at), or null. */
function stepped(report, state, key, far) {
  const shown = [...report.branches.keys()].filter(
    i => !state.hidden.has(report.branches[i].groupIndex) && report.branches[i].n > 0);
  if (!shown.length) return null;
  const from = state.at ||
    {b: shown.includes(state.branch) ? state.branch : shown[0], i: 0};
  const b = report.branches[from.b], forward = key === "ArrowRight" || key === "ArrowUp";
  if (key === "ArrowRight" || key === "ArrowLeft") {
    const by = (forward ? 1 : -1) * (far ? 10 : 1);
    return {b: from.b, i: state.at ? Math.max(0, Math.min(b.n - 1, from.i + by)) : 0};
  }
  const j = shown[(shown.indexOf(from.b) + (forward ? 1 : shown.length - 1)) % shown.length];
  const {at} = report.branches[j];
  let i = 0;
  at.forEach((f, k) => {
    if (Math.abs(f - b.at[from.i]) < Math.abs(at[i] - b.at[from.i])) i = k;
  });
  return {b: j, i};
}

export {responseView, readout, spoken, sharesText, nearest, stepped, nameLimits};
