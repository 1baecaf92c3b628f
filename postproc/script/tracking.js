/* Over the preload: the highest peak, its place, and the contact there. */
import {NBSP, LENGTH, ENERGY, number, unit, extent} from "./numbers.js";
import {axis, around, signed} from "./axes.js";
import {Panel} from "./panel.js";
import {STATES, classOf} from "./report_data.js";

const TENFOLD = 8; /* a range wider than this is drawn in decades */

/* The axis of the preload: range and unit. */
function preloadAxis(track) {
  const forces = extent(track, t => t.n0), most = Math.max(...forces.map(Math.abs));
  const least = Math.min(...track.map(t => Math.abs(t.n0)).filter(v => v > 0));
  const wide = most >= TENFOLD * least, force = most >= 1e4 ? ["kN", 1e3] : ["N", 1];
  return {
    force, range: wide && forces[0] <= 0 ? signed(forces[0], forces[1], least) :
      around(forces[0], forces[1], wide)
  };
}
function peakRange(track, limits, log) {
  const all = [...track, ...limits].map(t => t.amplitude).filter(v => v > 0);
  const [lo, hi] = all.length ? extent(all) : [0, 1e-6];
  return log && lo > 0 ? {lo: lo / (1.15 * (hi / lo) ** 0.14), hi: 1.2 * hi, log: true} :
    {lo: 0, hi: 1.1 * hi, log: false};
}
/* key: what is drawn over the preload, "amplitude" or "at" (the abscissa). */
function drawTrack(p, output, key, limits) {
  for (const l of limits) {
    const {kind} = l.group, open = kind === "open";
    p.level("line limit " + kind, l[key]);
    p.text("mark " + kind, open ? p.ax.lo : p.ax.hi, l[key], open ? 6 : -6, -5,
      open ? "start" : "end", kind);
  }
  for (const t of output.peaks)
    if (t.group.rank >= 0) p.dot("lesser", t.group.n0, t[key], 2.4);
  for (const r of output.resonances)
    p.line("line resonance", r.map(t => t.n0), r.map(t => t[key]));
  p.line("line track", output.track.map(t => t.n0), output.track.map(t => t[key]));
  const kind = t => t.doubtful && "doubtful" || t.edge && "ring" || "dot";
  output.track.forEach((t, i) => p.dot(
    kind(t) + " " + classOf(t.group), t.n0, t[key], i === output.best ? 5.5 : 4));
}
function trackingView(report, state, width) {
  const {output} = state, {track, best} = output, {X} = report;
  const {force, range} = preloadAxis(track), box = {left: 60, width: width - 80};
  const limits = report.sweep ? output.limits : [];
  const places = extent([...track, ...limits].map(t => t.at).filter(Number.isFinite));
  const y = peakRange(track, output.limits, state.log);
  const u = unit(LENGTH, extent([...track, ...output.limits], t => t.amplitude)[1]);
  const above = new Panel("tracking-a", {...box, top: 34, height: 280},
    axis(range, force[1], null),
    axis(y, u[1], `highest peak, ${output.place} ${output.axis}, ${output.quantity}, ${u[0]}`));
  const below = new Panel("tracking-f", {...box, top: 374, height: 170},
    axis(range, force[1], "preload n₀, " + force[0]),
    axis(around(places[0], places[1], X.log && places[1] > TENFOLD * places[0]), X.scale,
      "its " + report.xLabel));
  drawTrack(above, output, "amplitude", output.limits);
  drawTrack(below, output, "at", limits);
  if (best >= 0) {
    const t = track[best], inner = best === track.length - 1 ? "end" : "middle";
    above.text("mark strong", t.n0, t.amplitude, 0, 21, best === 0 ? "start" : inner,
      `lowest: ${number(t.n0 / force[1], 4, false)}${NBSP}${force[0]}`);
  }
  return {height: 600, panels: [above, below]};
}

/* Two panels: shares of the period, and energy up to most, J; below: label of the abscissa. */
function contactPanels(id, x, xUnit, most, below, width) {
  const e = unit(ENERGY, most), box = {left: 60, width: width - 76};
  const shares = below ? {lo: -0.02, hi: 1.02, log: false} : {lo: 0, hi: 1, log: false};
  return [
    new Panel(id + "-s", {...box, top: 34, height: 180}, axis(x, xUnit, null),
      axis(shares, 0.01, "share of the period, %")),
    new Panel(id + "-d", {...box, top: 266, height: 150}, axis(x, xUnit, below),
      axis({lo: 0, hi: most > 0 ? 1.08 * most : e[1], log: false}, e[1],
        "dissipated a cycle, " + e[0]))
  ];
}
const STYLE = ["stick", "slip", "gap"]; /* of STATES */

/* The contact at the highest peak, a bar for each preload. */
function stateView(report, state, width) {
  const {track} = state.output, all = {lo: -0.6, hi: track.length - 0.4, log: false};
  const most = Math.max(...track.map(t => t.dissipation || 0));
  const [shares, energy] = contactPanels("state", all, 0, most, null, width), b = energy.box;
  const every = 1 + Math.floor((track.length - 1) / Math.max(2, Math.floor(b.width / 40)));
  track.forEach((t, i) => {
    let low = 0;
    STATES.forEach((s, k) => {
      shares.bar("state " + STYLE[k], i - 0.36, i + 0.36, low, low + t[s]);
      low += t[s];
    });
    energy.bar("bar " + classOf(t.group), i - 0.36, i + 0.36, 0, t.dissipation);
    if (i % every === 0)
      energy.label("tick", energy.x(i), b.top + b.height + 17, "middle", number(t.n0, 4, false));
  });
  energy.label("axis", b.left + b.width, b.top + b.height + 36, "end", "preload n₀, N");
  return {height: 470, panels: [shares, energy]};
}

export {STYLE, trackingView, contactPanels, stateView};
