/* One contact over one period, as the program computed it: loops, friction path, load. */
import {NBSP, LENGTH, ENERGY, number, unit, forceUnit, extent, decode} from "./numbers.js";
import {axis, around} from "./axes.js";
import {Panel} from "./panel.js";
import {named} from "./report_data.js";
import {sharesText} from "./response.js";
import {STYLE} from "./tracking.js";

const CHARTS = ["loop-u", "loop-w", "path", "period"];

/* Index into contact.at of the stored point nearest along the curve. */
function storedAt(contact, i) {
  let best = 0;
  contact.at.forEach((p, j) => {
    if (Math.abs(p - i) < Math.abs(contact.at[best] - i)) best = j;
  });
  return best;
}
/* Samples and loops of a branch, decoded when they are first shown. */
function samplesOf(b, {signals, loop}) {
  if (b.samples) return;
  let at = 0;
  b.samples = decode(b.contact.data, Int16Array);
  b.loops = named(loop, b.contact.loops);
  for (const l of b.loops) {
    l.start = at;
    at += signals.length * l.n;
  }
}
/* The chosen contact at the stored point nearest to the chosen one; null: the page has none. */
function contactAt(report, state) {
  const b = report.branches[state.branch], {names, signals, full} = report.contacts;
  if (!b || !b.contact || !b.contact.at.length) return null;
  samplesOf(b, report.contacts);
  const j = storedAt(b.contact, state.point), loop = b.loops[j * names.length + state.pair];
  const row = name => {
    const from = loop.start + signals.indexOf(name) * loop.n;
    return b.samples.subarray(from, from + loop.n);
  };
  const signal = (name, scale) => Float64Array.from(row(name), v => v * scale / full);
  return {
    n: loop.n, work: loop.dissipation, shares: [loop.stuck, loop.slipping, loop.open],
    most: loop.load, bound: loop.limit, time: signal("phase", b.order), u: signal("u", loop.u),
    w: signal("w", loop.w), fu: signal("fu", loop.fu), fw: signal("fw", loop.fw),
    load: signal("load", loop.load), limit: signal("load", loop.limit), state: row("state"),
    index: b.contact.at[j], order: b.order
  };
}

/* ---------------------------------------------------------------- charts */
function drawStates(p, xs, ys, s) {
  STYLE.forEach((name, k) => p.line("line " + name, xs, ys, i => s[i] === k));
}
/* Arrowhead along a path, at a share of the period. */
function arrow(p, xs, ys, share) {
  const i = Math.round(share * (xs.length - 1)), x = p.x(xs[i]), y = p.y(ys[i]);
  for (let j = i + 1; j < xs.length; j++) {
    const dx = p.x(xs[j]) - x, dy = p.y(ys[j]) - y, size = Math.hypot(dx, dy);
    if (size < 4) continue;
    const c = dx / size, s = dy / size;
    const at = (along, side) =>
      `${(x + along * c - side * s).toFixed(1)} ${(y + along * s + side * c).toFixed(1)}`;
    p.svg += `<path class="arrow" d="M${at(7, 0)}L${at(-4, 4.5)}L${at(-4, -4.5)}Z"/>`;
    return;
  }
}
const moderate = ([lo, hi], least) =>
  hi - lo > least ? around(lo, hi, false) : {lo: lo - least, hi: hi + least, log: false};

/* Friction over the relative motion along an axis of the contact, "u" or "w". */
function loopView(q, name, width) {
  const x = q[name], f = q["f" + name], force = forceUnit(q.bound), most = q.bound || 1;
  const span = extent(x), u = unit(LENGTH, Math.max(...span.map(Math.abs)));
  const p = new Panel("loop-" + name, {left: 60, top: 34, width: width - 80, height: 290},
    axis(moderate(span, 1e-3 * u[1]), u[1], `relative motion ${name}, ${u[0]}`),
    axis(moderate(extent(f), 1e-3 * most), force[1], `friction along ${name}, ${force[0]}`));
  drawStates(p, x, f, q.state);
  for (const share of [0.12, 0.62]) arrow(p, x, f, share);
  return {height: 380, panels: [p]};
}
/* The path of the friction, inside the circles of its least and greatest limit. */
function pathView(q, width) {
  const force = forceUnit(q.bound), box = {left: 60, top: 34, width: width - 80, height: 290};
  const radii = extent(q.limit), most = 1.08 * (radii[1] || force[1]);
  const wide = most * box.width / box.height;
  const p = new Panel("path", box,
    axis({lo: -wide, hi: wide, log: false}, force[1], "friction along u, " + force[0]),
    axis({lo: -most, hi: most, log: false}, force[1], "friction along w, " + force[0]));
  for (const r of radii)
    if (r > 0)
      p.svg += `<circle class="circle" cx="${p.x(0)}" cy="${p.y(0)}" r="${
        (p.x(r) - p.x(0)).toFixed(1)}"/>`;
  drawStates(p, q.fu, q.fw, q.state);
  for (const share of [0.12, 0.62]) arrow(p, q.fu, q.fw, share);
  return {height: 380, panels: [p]};
}
function periodView(q, width) {
  const size = q.fu.map((f, i) => Math.hypot(f, q.fw[i])), box = {left: 60, width: width - 80};
  const x = {lo: 0, hi: q.order, log: false}, u = forceUnit(q.most), force = forceUnit(q.bound);
  const above = new Panel("period-n", {...box, top: 34, height: 95}, axis(x, 1, null),
    axis({lo: 0, hi: 1.08 * q.most || 1, log: false}, u[1], "normal load, " + u[0]));
  const below = new Panel("period-f", {...box, top: 172, height: 118}, axis(x, 1, null),
    axis({lo: 0, hi: 1.08 * q.bound || 1, log: false}, force[1],
      `friction and its limit μn (dashed), ${force[0]}`));
  const bar = new Panel("period-s", {...box, top: 298, height: 22},
    axis(x, 1, "time, periods of the excitation"), axis({lo: 0, hi: 1, log: false}, 0, null));
  above.line("line load", q.time, q.load);
  below.line("line bound", q.time, q.limit);
  drawStates(below, q.time, size, q.state);
  for (let i = 1, from = 0; i < q.n; i++)
    if (i === q.n - 1 || q.state[i + 1] !== q.state[i]) {
      bar.bar("state " + STYLE[q.state[i]], q.time[from], q.time[i], 0, 1);
      from = i;
    }
  return {height: 380, panels: [above, below, bar]};
}
/* The charts of a contact by the id of their SVG; widths: a function of the id. */
function contactViews(q, widths) {
  if (!q.n) return CHARTS.map(id => [id, {height: 380, panels: []}]);
  return [
    ["loop-u", loopView(q, "u", widths("loop-u"))], ["loop-w", loopView(q, "w", widths("loop-w"))],
    ["path", pathView(q, widths("path"))], ["period", periodView(q, widths("period"))]
  ];
}

/* ---------------------------------------------------------------- in words */
function numbersText(name, q) {
  const range = (values, most) => {
    const u = forceUnit(most);
    return `${extent(values).map(v => number(v / u[1], 3)).join(" to ")}${NBSP}${u[0]}`;
  };
  const e = unit(ENERGY, q.work);
  return `${name}: normal load ${range(q.load, q.most)}, friction limit ${
    range(q.limit, q.bound)}; stuck · slipping · open ${sharesText(q.shares)}; dissipated ${
    number(q.work / e[1], 3)}${NBSP}${e[0]}.`;
}
/* What the page says of the chosen contact. */
function contactText(report, state, q) {
  const {names, all} = report.contacts, text = [];
  text.push(q.n ? numbersText(names[state.pair], q) :
    "The contact law of the case does not give the forces that the file has here, so nothing is " +
    "drawn. Was the file made from other settings?");
  if (q.index !== state.point)
    text.push(`Drawn at the nearest point that this page has the contact of, ${
      report.xText(report.branches[state.branch].at[q.index])}: all would make it too large.`);
  if (names.length < all)
    text.push(`The page has the ${names.length} of ${all} contacts that dissipate most.`);
  return text.join(" ");
}

export {CHARTS, contactAt, contactViews, contactText};
