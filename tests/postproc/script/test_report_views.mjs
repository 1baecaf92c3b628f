/* What a report says and draws: main chart, reading of points, charts over the preload. */
import test from "node:test";
import assert from "node:assert/strict";
import * as data from "../../../postproc/script/report_data.js";
import * as response from "../../../postproc/script/response.js";
import {trackingView, stateView} from "../../../postproc/script/tracking.js";
import {alongView, harmonicsView, spectrumView} from "../../../postproc/script/curve.js";
import {axesView} from "../../../postproc/script/contact_axes.js";
import {Panel, table} from "../../../postproc/script/panel.js";
import {axis} from "../../../postproc/script/axes.js";
import {makeDocument, makeReport, amplitude} from "./document.mjs";

const {readReport, firstState, topOf, outputFor, rangeOf} = data;
const {responseView, readout, spoken, nearest, stepped, nameLimits} = response;
const view = (more, change) => {
  const report = makeReport(more), state = {...firstState(report), ...change};
  return {report, state, ...responseView(report, state, 1100)};
};
const count = (text, part) => text.split(part).length - 1;

test("another format or version is refused", () => {
  assert.throws(() => readReport(makeDocument({version: 2})), /reads "shroudhb report page" 1/);
  assert.throws(() => readReport(makeDocument({format: "x"})), /not "x" 1/);
});
test("rows are found by their names", () => {
  const d = makeDocument(), moved = {...d.fields, stuck: 2, slipping: 1};
  const [a] = readReport(d).branches, [b] = makeReport({fields: moved}).branches;
  assert.equal(a.shares[0][3], 0.25);
  assert.equal(b.shares[0][3], 0.75);
});
test("a page begins at the highest point of the chosen curve", () => {
  const {report, state} = view();
  assert.equal(state.point, 30);
  assert.equal(topOf(report.branches[1], report.outputs[0]), 70);
});
test("curves, limits and marks are drawn", () => {
  const [p] = view().panels;
  assert.equal(count(p.svg, "class=\"line c0 chosen\""), 1);
  assert.equal(count(p.svg, "class=\"line unstable c0 chosen\""), 1);
  assert.equal(count(p.svg, "class=\"doubtful c0 chosen\""), 1);
  assert.equal(count(p.svg, "class=\"line limit open\""), 1);
  assert.equal(count(p.svg, "class=\"here\""), 1);
  assert.ok(p.svg.indexOf("limit open") < p.svg.indexOf("line c1"));
  assert.ok(!/NaN|undefined|Infinity/.test(p.svg));
});
test("a hidden group is not drawn, nor found", () => {
  const {report, state, panels: [p]} = view({}, {hidden: new Set([0])});
  assert.equal(count(p.svg, " c0"), 0);
  const b = report.branches[0], at = nearest(report, state, p, p.x(96), p.y(1e-5));
  assert.ok(!at || at.b !== 0, `${b.group.name} is found`);
});
test("the amplitude's axis fits what is seen, in a readable unit", () => {
  const [p] = view().panels, [log] = view({}, {log: true}).panels;
  assert.ok(p.ay.lo === 0 && Math.abs(p.ay.hi - 1.06e-5) < 1e-11 && !p.ay.log);
  assert.ok(log.ay.log && log.ay.lo > 0);
  assert.equal(p.ay.label, "tip motion, first harmonic, µm");
  const zoomed = view({}, {zoom: [100, 101], zoomY: [1e-6, 2e-6]});
  assert.deepEqual([zoomed.panels[0].ay.lo, zoomed.panels[0].ay.hi], [1e-6, 2e-6]);
  assert.deepEqual(rangeOf(zoomed.report, zoomed.state), {lo: 100, hi: 101, log: false});
});
test("nothing that moves has an axis too", () => {
  const d = makeDocument(), zero = new Float32Array(12 * 101);
  zero.set([...Array(101).keys()].map(i => 90 + 0.2 * i));
  const text = Buffer.from(zero.buffer).toString("base64");
  const still = {
    branches: d.branches.map(b => ({...b, data: text})),
    outputs: d.outputs.map(o => ({...o, track: [], best: -1, limits: [], peaks: []}))
  };
  const {report, state, panels: [p]} = view(still);
  assert.ok(!/NaN|Infinity/.test(p.svg + harmonicsView(report, state, 1100).panels[0].svg));
});
test("a run-up has the speed above", () => {
  assert.ok(view({rpm: 12}).panels[0].svg.includes("rotor speed, rpm"));
  assert.ok(!view().panels[0].svg.includes("rotor speed"));
});
test("a point is read with its unit and its verdicts", () => {
  const {report} = view(), [b, c] = report.branches, o = report.outputs[0];
  assert.deepEqual(readout(report, o, b, 35), {
    title: "n0 = 10 N", shares: [0.25, 0.75, 0],
    rows: [
      ["frequency", "97.0000\u00a0Hz"], ["first harmonic", "7.071\u00a0µm"],
      ["stuck · slipping · open", "25 · 75 · 0\u00a0%"], ["dissipated", "7.07\u00a0nJ"],
      ["stability", "stable"], ["error estimate", "0.4\u00a0%"]
    ]
  });
  assert.equal(readout(report, o, b, 30).title, "n0 = 10 N, peak");
  assert.match(spoken(readout(report, o, b, 50)), /stability beyond a fold: never seen/);
  assert.match(spoken(readout(report, o, b, 51)), /40\u00a0%, above the tolerance: no result/);
  assert.match(spoken(readout(report, o, c, 70)), /estimate not judged, mean friction not determ/);
  assert.match(spoken(readout(report, o, report.branches[2], 3)), /^linear limit, contact open: /);
});
test("the nearest point within forty pixels", () => {
  const {report, state, panels: [p]} = view();
  const at = nearest(report, state, p, p.x(96.05), p.y(1e-5));
  assert.deepEqual(at, {b: 0, i: 30});
  assert.equal(nearest(report, state, p, p.x(91), p.y(9e-6)), null);
});
test("arrows move along and between curves", () => {
  const {report, state} = view(), move = (key, far) => {
    state.at = stepped(report, state, key, far);
    return state.at;
  };
  assert.deepEqual(move("ArrowRight"), {b: 0, i: 0});
  assert.deepEqual(move("ArrowRight", true), {b: 0, i: 10});
  assert.deepEqual(move("ArrowLeft"), {b: 0, i: 9});
  assert.deepEqual(move("ArrowUp"), {b: 1, i: 9});
  assert.deepEqual(move("ArrowDown"), {b: 0, i: 9});
  assert.deepEqual(move("ArrowDown"), {b: 2, i: 9});
  state.at = {b: 0, i: 98};
  assert.deepEqual(move("ArrowRight", true), {b: 0, i: 100});
  state.hidden = new Set([0, 1, 2]);
  assert.equal(stepped(report, state, "ArrowUp", false), null);
});
test("an output is found as far as a place has it", () => {
  const {report} = view();
  assert.equal(outputFor(report, "tip", "axial", "peak to peak"), report.outputs[0]);
});
/* Wherever the peaks are: inside the frame, 60 to 1080 px, and apart. */
test("the names of the limits stay inside and do not touch", () => {
  for (let i = 0; i <= 40; i++)
    for (let j = 0; j <= 40; j++) {
      const p = new Panel("n", {left: 60, top: 34, width: 1020, height: 400},
        axis({lo: 0, hi: 40, log: false}, 1, "f"), axis({lo: 0, hi: 1, log: false}, 1, "a"));
      p.svg = "";
      nameLimits(p, [["open", i], ["stuck", j]].map(
        ([kind, at]) => ({at, amplitude: 0.9, group: {kind}})));
      const x = [...p.svg.matchAll(/ x="([\d.]+)"/g)].map(m => +m[1]);
      assert.equal(x.length, 2);
      assert.ok(Math.min(...x) >= 82 - 0.1 && Math.max(...x) <= 1058.1, `${i}, ${j}: ${x}`);
      assert.ok(Math.abs(x[0] - x[1]) >= 44 - 0.2, `${i}, ${j}: ${x}`);
    }
});
test("the track over the preload, its lowest peak, and the limits", () => {
  const {report, state} = view(), {panels: [above, below]} = trackingView(report, state, 1100);
  assert.equal(count(above.svg, "class=\"dot c"), 2);
  assert.ok(above.svg.includes("lowest: 40\u00a0N"));
  assert.equal(count(above.svg + below.svg, "line limit open"), 2);
  assert.equal(above.ay.label, "highest peak, tip motion, first harmonic, µm");
  assert.equal(below.ay.label, "its frequency, Hz");
  const edge = report.outputs.map(o => ({...o, track: o.track.map(
    (t, i) => ({...t, edge: 1, doubtful: i}))}));
  const marked = trackingView(report, {...state, output: edge[0]}, 1100).panels[0].svg;
  assert.ok(marked.includes("class=\"ring c0\"") && marked.includes("class=\"doubtful c1\""));
});
test("over another parameter it is on every axis", () => {
  const followed = {
    parameter: "mu", name: "friction coefficient μ", unit: "", scale: 1, log: false,
    range: [0, 0.6]
  };
  const {report, state, panels: [p]} = view({abscissa: followed});
  const [above, below] = trackingView(report, state, 1100).panels;
  assert.equal(p.ax.label, "friction coefficient μ");
  assert.equal(below.ay.label, "its friction coefficient μ");
  assert.equal(count(below.svg, "line limit"), 0); /* they have no place there */
  assert.ok(count(above.svg, "line limit") > 0);
  for (const v of [alongView, harmonicsView])
    assert.equal(v(report, state, 1100).panels.slice(-1)[0].ax.label, "friction coefficient μ");
});
test("shares of the period fill the bars", () => {
  const {report, state} = view(), rows = table(stateView(report, state, 540).panels).split("\n");
  const sum = rows.filter(r => /^1,state/.test(r)).reduce((s, r) => s + +r.split(",")[3], 0);
  assert.ok(Math.abs(sum - 2) < 1e-9);
});
test("the contact along a curve, and its harmonics", () => {
  const {report, state} = view(), along = alongView(report, state, 540);
  assert.equal(count(along.panels[0].svg, "class=\"line "), 3);
  const svg = harmonicsView(report, state, 1100).panels[0].svg;
  assert.ok(svg.includes(">k = 0<") && svg.includes(">k = 1<"));
  const rows = table(spectrumView(report, state, 540).panels).trim().split("\n").slice(2);
  assert.equal(rows.length, 2);
  const bar = +rows[1].split(",")[3];
  assert.ok(Math.abs(bar - amplitude(96, 96) * (1 - 1e-6)) < 1e-12);
});
test("a place without harmonics says so", () => {
  const {report, state} = view({spectra: []});
  assert.match(harmonicsView(report, state, 1100).extra, /tip are not in this page/);
  assert.match(spectrumView(report, state, 1100).extra, /tip are not in this page/);
});
test("the axes of the contact have their angles", () => {
  const {extra} = axesView(makeDocument().axes);
  assert.ok(extra.includes("ψ = 30°") && extra.includes("φ = −5.73°"));
});
