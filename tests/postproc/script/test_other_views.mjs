/* Ring, SAFE diagram, contact loops, the blade at rest and in motion, gestures. */
import test from "node:test";
import assert from "node:assert/strict";
import {corners, bladesView, factorsView} from "../../../postproc/script/ring.js";
import {diameterOf, safeView} from "../../../postproc/script/safe.js";
import {stillView} from "../../../postproc/script/still.js";
import * as motion from "../../../postproc/script/motion.js";
import {rectangle, zoomTo, zoomBy, Touch} from "../../../postproc/script/gestures.js";
import {contactAt, contactViews, contactText} from "../../../postproc/script/contact.js";
import {firstState} from "../../../postproc/script/report_data.js";
import {Panel, table} from "../../../postproc/script/panel.js";
import {axis} from "../../../postproc/script/axes.js";
import {makeDocument, makeReport} from "./document.mjs";

const near = (a, b, tolerance = 1e-9) => assert.ok(Math.abs(a - b) <= tolerance, `${a}, ${b}`);
const count = (text, part) => text.split(part).length - 1;
const base64 = array => Buffer.from(array.buffer).toString("base64");

/* ---------------------------------------------------------------- ring and diameters */
test("the share of rings rises at each factor", () => {
  assert.deepEqual(corners([1.3, 1.1, 1.7]),
    [[1.1, 1.1, 1.3, 1.3, 1.7, 1.7], [0, 1 / 3, 1 / 3, 2 / 3, 2 / 3, 1]]);
  assert.deepEqual(corners([]), [[], []]);
});
test("a curve for each preload with factors, in the colour of its rank", () => {
  const {panels: [p]} = factorsView([{n0: 12.5, factor: [1.3, 1.1]}, {n0: 30, factor: []}], 1100);
  assert.equal(count(p.svg, "n0 = 12.5 N"), 1);
  assert.equal(count(p.svg, "class=\"line c0\""), 1);
  assert.equal(count(p.svg, "line c1"), 0);
});
test("a bar for each blade, relative to the highest", () => {
  const one = {n0: 100, value: 322.26, branch: 3, kind: "localised", stable: false};
  const ring = {panels: [{...one, amplitude: [1e-6, 4e-6, 2e-6]}]};
  const {panels: [p]} = bladesView(ring, 1100);
  assert.equal(count(p.svg, "class=\"bar c1\""), 3);
  assert.ok(p.svg.includes("n0 = 100 N, 322.26, curve 3: localised"));
  assert.deepEqual(table([p]).trim().split("\n").slice(2).map(r => +r.split(",")[3]),
    [0.25, 1, 0.5]);
});
test("diameters of orders", () => {
  const wanted = {0: 0, 1: 1, 5: 5, 20: 20, 21: 19, 35: 5, 40: 0, 45: 5};
  for (const [order, d] of Object.entries(wanted)) assert.equal(diameterOf(+order, 40), d);
  assert.equal(diameterOf(4, 7), 3);
});
test("families of the ring, the excitation and its resonances", () => {
  const safe = {
    blades: 7, engineOrder: 2, range: [90, 120], speed: 200, driven: [1, 2],
    open: [0, 1, 2, 3].map(() => [100, 300]), stuck: [0, 1, 2, 3].map(d => [100 + d, null])
  };
  const {panels: [p]} = safeView(safe, 1000);
  assert.equal(count(p.svg, "class=\"line limit open\""), 2);
  assert.equal(count(p.svg, "class=\"line limit stuck\""), 1); /* the other is not known */
  assert.equal(count(p.svg, "class=\"crossing\""), 2); /* 100 and 102 Hz at diameter 2 */
  assert.ok(p.svg.includes(">E = 2<") && p.svg.includes("class=\"order\""));
  near(p.ay.hi, 138);
});

/* ---------------------------------------------------------------- the blade */
/* A box of a by b by c cells as triangles. */
function box() {
  const node = [], index = [];
  for (const x of [0, 0.04]) for (const y of [0, 0.01]) for (const z of [0.3, 0.46])
    node.push(x, y, z);
  const faces = [
    [0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]
  ];
  for (const [a, b, c, d] of faces) index.push(a, b, c, a, c, d);
  return [Float32Array.from(node), Uint16Array.from(index)];
}
test("nine edges of a box are seen, and no other", () => {
  const [node, index] = box();
  const view = stillView(node, index, [1, 0, 0]);
  assert.equal(count(view.extra, "M"), 9);
  for (const v of view.extra.match(/[\d.]+/g)) assert.ok(+v >= 0 && +v <= 520);
});
/* Two modes of nodal diameter 2 of 12 sectors, whose shapes are a wave. */
function blade() {
  const data = Int8Array.from([127, 0, 0, 127, 0, 0, 0, 0, 0]),
    im = Int8Array.from([0, 127, 0, 0, 127, 0, 0, 0, 0]);
  return motion.readBlade({
    nodes: 1, triangles: 0, lo: [0, 0, 0.3], size: [0.1, 0, 0],
    position: base64(Uint16Array.from([65535, 0, 0, 0])), index: "", axis: [1, 0, 0], blades: 12,
    row: 1, waves: [2], lag: 0, modesLeftOut: 0,
    modes: [{f: 100, d: 2e-3, s: 5e6, w: 0, data: base64(data), im: base64(im)}],
    points: [
      {b: 0, x: 100, a: 1e-5, order: 1, lag: 1, k: [1], w: [0], back: [1],
        q: base64(Float32Array.from([3, 0]))},
      {b: 0, x: 120, a: 1e-5, order: 1, lag: 1, k: [1], w: [0], back: [0],
        q: base64(Float32Array.from([1, 0]))}
    ]
  });
}
test("surface and modes are decoded", () => {
  const b = blade();
  near(b.base[0], 0.1, 1e-8);
  assert.deepEqual([b.wide, b.modes[0].data.length], [false, 9]);
  assert.equal(motion.keptPoint(b, 0, 119, 1e-5).x, 120);
  assert.equal(motion.keptPoint(b, 3, 119, 1e-5), undefined);
});
test("a circular motion is as large at every instant", () => {
  const b = blade(), field = motion.fieldOf(b, motion.ofMode(b, 0), "motion");
  near(field.most, 2e-3, 1e-9);
  const sampled = motion.greatest(
    [field.harmonics[0], {re: new Float32Array(3), im: new Float32Array(3)}], [1, 2], 3,
    motion.square);
  near(sampled[0], 2e-3, 1e-9); /* many harmonics: by samples */
});
test("the largest von Mises stress of a mode in closed form", () => {
  const b = blade(), field = motion.fieldOf(b, motion.ofMode(b, 0), "stress");
  /* xx = cos t, yy = -sin t: the root of 1 + sin t cos t is largest at sqrt(3/2) */
  near(field.top, 5e6 * Math.sqrt(1.5), 1);
  near(motion.mises([1, 1, 1, 0, 0, 0], 0), 0);
  near(motion.mises([0, 0, 0, 2, 0, 0], 0), 12);
});
test("a wave that runs backwards has the conjugate shapes", () => {
  const b = blade();
  for (const [point, sign] of [[b.points[0], -1], [b.points[1], 1]]) {
    const m = motion.ofPoint(b, point, "x"), {harmonics: [h]} = motion.fieldOf(b, m, "motion");
    near(h.im[1], sign * 2e-3 * point.q[0], 1e-8);
  }
});
test("a sector moves with its lag, in its own place", () => {
  const b = blade(), m = motion.ofMode(b, 0), {harmonics} = motion.fieldOf(b, m, "motion");
  near(m.lag, 2 * Math.PI * 2 / 12);
  const u = motion.displacement(b, m, harmonics, 3, 0.2), phase = 2 * Math.PI * 0.2 - 3 * m.lag;
  near(u[0], 2e-3 * Math.cos(phase), 1e-8);
  near(u[2], -2e-3 * Math.sin(phase), 1e-8); /* turned by a right angle about x: y to z */
});
test("the ring is as large as its corners", () => {
  const all = motion.extentOf(blade(), "all");
  assert.deepEqual([all.from, all.to], [0, 11]);
  near(all.radius, 0.3, 1e-9);
  assert.equal(motion.extentOf(blade(), "1").from, -1);
});

/* ---------------------------------------------------------------- a contact */
const SIGNALS = ["phase", "u", "w", "fu", "fw", "load", "state"];
/* A slider of one axis: a rectangle of 2e-6 m by 2 x 30 N. */
function slider() {
  const rows = {
    phase: [0, 0.25, 0.5, 0.75, 1], u: [1, -1, -1, 1, 1], w: [0, 0, 0, 0, 0],
    fu: [-1, -1, 1, 1, -1], fw: [0, 0, 0, 0, 0], load: [1, 1, 1, 1, 1]
  };
  const samples = [...SIGNALS.slice(0, 6).flatMap(s => rows[s].map(v => Math.round(32767 * v))),
    0, 1, 0, 1, 0, 0];
  const d = makeDocument();
  d.branches[0].contact = {
    at: [0, 40], loops: [
      [5, 1e-6, 0, 30, 0, 100, 30, 0.5, 0.5, 0, 1.2e-4], [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]],
    data: base64(Int16Array.from(samples))
  };
  d.contacts = {
    all: 3, names: ["contact 2"], full: 32767, signals: SIGNALS,
    loop: ["n", "u", "w", "fu", "fw", "load", "limit", "stuck", "slipping", "open", "dissipation"]
  };
  const report = makeReport(d), state = {...firstState(report), point: 3};
  return {report, state};
}
test("a loop is drawn with its states, and its numbers are told", () => {
  const {report, state} = slider(), q = contactAt(report, state);
  assert.equal(q.index, 0);
  near(Math.max(...q.fu), 30);
  near(Math.max(...q.limit), 30);
  const views = new Map(contactViews(q, () => 540)), loop = views.get("loop-u").panels[0].svg;
  assert.ok(loop.includes("class=\"line slip\"") && loop.includes("class=\"line stick\""));
  assert.equal(count(loop, "class=\"arrow\""), 2);
  assert.equal(views.get("period").panels.length, 3);
  const text = contactText(report, state, q);
  assert.match(text, /^contact 2: normal load 100 to 100\u00a0N, friction limit 30.0 to 30.0/);
  assert.match(text, /dissipated 120\u00a0µJ\. Drawn at the nearest point .* 1 of 3 contacts/);
});
test("a loop that is not that of the file is not drawn", () => {
  const {report, state} = slider(), q = contactAt(report, {...state, point: 39});
  assert.match(contactText(report, state, q), /does not give the forces that the file has here/);
  for (const [, view] of contactViews(q, () => 540)) assert.equal(view.panels.length, 0);
});
test("a curve without contacts has none", () => {
  const report = makeReport();
  assert.equal(contactAt(report, firstState(report)), null);
});

/* ---------------------------------------------------------------- gestures */
function fakeChart() {
  const p = new Panel("g", {left: 50, top: 20, width: 500, height: 200},
    axis({lo: 0, hi: 10, log: false}, 1, "x"), axis({lo: 0, hi: 1, log: false}, 1, "y"));
  const chart = {
    seen: [], panel: () => p, range: [0, 10], zoom: () => [null, [0.1, 0.2]],
    setZoom: (...all) => chart.seen.push(all), point: () => true,
    choose: () => chart.seen.push("chosen")
  };
  return chart;
}
test("a rectangle zooms; a flat one keeps the amplitudes, a narrow one the abscissa", () => {
  const chart = fakeChart(), area = chart.panel().box;
  zoomTo(chart, rectangle(area, [150, 70], [100, 170]));
  assert.deepEqual(chart.seen.pop(), [[1, 2], [0.25, 0.75]]);
  zoomTo(chart, rectangle(area, [100, 70], [150, 75]));
  assert.deepEqual(chart.seen.pop(), [[1, 2], [0.1, 0.2]]);
  zoomTo(chart, rectangle(area, [100, 70], [104, 170]));
  assert.deepEqual(chart.seen.pop(), [null, [0.25, 0.75]]);
});
test("the wheel keeps the place under the pointer, and stops at the whole range", () => {
  const chart = fakeChart();
  zoomBy(chart, [150, 120], 0.5, 0.5);
  const [[lo, hi], [low, high]] = chart.seen.pop();
  near((2 - lo) / (hi - lo), 0.2);
  near((0.5 - low) / (high - low), 0.5);
  zoomBy(chart, [150, 120], 4, 4);
  assert.deepEqual(chart.seen.pop(), [null]);
});
test("a finger taps, two zoom, and one that wanders does not choose", () => {
  const chart = fakeChart(), touch = new Touch(chart, at => at);
  touch.down(1, [100, 100]);
  touch.up(1, true);
  assert.deepEqual(chart.seen, ["chosen"]);
  touch.down(1, [100, 100]);
  touch.move(1, [140, 100]);
  touch.up(1, true);
  assert.equal(chart.seen.length, 1);
  touch.down(1, [200, 100]);
  touch.down(2, [300, 100]);
  touch.move(2, [310, 100]);
  touch.move(2, [400, 100]);
  assert.equal(chart.seen.length, 2);
  assert.equal(touch.up(7, true), false);
});
