/* Along one curve: contact and harmonics; and the harmonics at one point of it. */
import {LENGTH, unit, extent, escape} from "./numbers.js";
import {axis} from "./axes.js";
import {Panel} from "./panel.js";
import {classOf, rangeOf} from "./report_data.js";
import {STYLE, contactPanels} from "./tracking.js";

const SHOWN = 8; /* harmonics, each with a colour of the style sheet */

function alongView(report, state, width) {
  const b = report.branches[state.branch];
  const [shares, energy] = contactPanels("along", rangeOf(report, state), report.X.scale,
    extent(b.energy)[1], report.xLabel, width);
  b.shares.forEach((s, k) => shares.line("line " + STYLE[k], b.at, s));
  energy.line("line " + classOf(b.group), b.at, b.energy);
  return {height: 470, panels: [shares, energy]};
}

const spectrumOf = (report, output) => report.spectra.find(e => e.place === output.place);
const absent = output => ({
  height: 60, panels: [], extra: `<text x="0" y="30">The harmonics of ${
    escape(output.place)} are not in this page; the response file has them.</text>`
});
/* "2/3": harmonic 2 of a motion of three periods. */
const nameOf = (k, order) => k + (k > 0 && order > 1 ? "/" + order : "");

/* Name a harmonic at its rightmost visible point, below the names that are there. */
function nameEnd(p, b, a, k, used) {
  let end = -1;
  for (let i = 0; i < b.n; i++)
    if (b.at[i] <= p.ax.hi * (1 + 1e-9) && a[i] > p.ay.lo && (end < 0 || b.at[i] > b.at[end]))
      end = i;
  if (end < 0) return;
  let y = p.y(a[end]) + 4;
  const taken = v => Math.abs(v - y) < 14;
  while (used.some(taken)) y += 14;
  used.push(y);
  p.label("mark h" + k, p.x(b.at[end]) + 6, y, "start", "k = " + nameOf(k, b.order));
}
function harmonicsView(report, state, width) {
  const s = spectrumOf(report, state.output), b = report.branches[state.branch];
  if (!s) return absent(state.output);
  const rows = [...Array(Math.min(s.n, SHOWN)).keys()].map(k => b.row(s.row + k));
  let [least, most] = extent(rows.flatMap(a => Array.from(a).filter(v => v > 0)));
  const u = unit(LENGTH, most);
  if (!(most > 0)) most = least = u[1];
  const p = new Panel("harmonics", {left: 60, top: 34, width: width - 120, height: 272},
    axis(rangeOf(report, state), report.X.scale, report.xLabel),
    axis({lo: Math.max(1e-6 * most, least / 2), hi: 2 * most, log: true}, u[1],
      `${s.place}, amplitude of each harmonic, ${u[0]}`));
  const used = [];
  rows.forEach((a, k) => {
    p.line("line h" + k, b.at, a);
    nameEnd(p, b, a, k, used);
  });
  return {height: 360, panels: [p]};
}
/* Amplitude of each harmonic at the chosen point. */
function spectrumView(report, state, width) {
  const s = spectrumOf(report, state.output), b = report.branches[state.branch];
  if (!s) return absent(state.output);
  const a = [...Array(s.n).keys()].map(k => b.row(s.row + k)[state.point]);
  const most = Math.max(...a) || 1e-6, u = unit(LENGTH, most);
  const p = new Panel("spectrum", {left: 60, top: 34, width: width - 80, height: 190},
    axis({lo: -0.6, hi: s.n - 0.4, log: false}, 0, null),
    axis({lo: 1e-6 * most, hi: 2 * most, log: true}, u[1], `${s.place}, amplitude, ${u[0]}`));
  a.forEach((v, k) => {
    if (v > p.ay.lo)
      p.bar("bar h" + Math.min(k, SHOWN - 1), k - 0.36, k + 0.36, p.ay.lo, v);
    p.label("tick", p.x(k), 241, "middle", nameOf(k, b.order));
  });
  p.label("axis", width - 20, 260, "end", "harmonic k");
  return {height: 270, panels: [p]};
}

export {alongView, harmonicsView, spectrumView};
