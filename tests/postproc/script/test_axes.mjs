/* Ticks and ranges of axes, and the data area. */
import test from "node:test";
import assert from "node:assert/strict";
import * as axes from "../../../postproc/script/axes.js";
import {Panel, table} from "../../../postproc/script/panel.js";

const {linearTicks, logTicks, ticksOf, around, signed, place, valueAt, axis} = axes;
const near = (a, b) => assert.ok(Math.abs(a - b) <= 1e-12 * Math.max(1, Math.abs(b)), `${a}, ${b}`);

test("ticks are round and inside", () => {
  assert.deepEqual(linearTicks(1, 10, 5), [2, 4, 6, 8, 10]);
  assert.deepEqual(linearTicks(92, 138, 4), [100, 120]);
  assert.deepEqual(logTicks(0.5, 200, 8), [0.5, 1, 2, 5, 10, 20, 50, 100, 200]);
  assert.deepEqual(logTicks(1, 1e12, 4), [1, 1e3, 1e6, 1e9, 1e12]);
  for (const [lo, hi] of [[0.13, 0.14], [-7e5, 3e6], [1e-9, 1.1e-9]])
    for (const t of linearTicks(lo, hi, 5)) assert.ok(t >= lo - 1e-15 && t <= hi * (1 + 1e-9));
});
test("there are always two ticks", () => {
  for (let i = 0; i < 200; i++) {
    const lo = 1 + 0.37 * i, hi = lo * (1.001 + 0.01 * i);
    assert.ok(linearTicks(lo, hi, 3).length >= 2, `${lo} to ${hi}`);
  }
});
test("an axis without unit has no ticks", () => {
  assert.deepEqual(ticksOf({lo: 0, hi: 1, log: false, unit: 0}, 5), []);
});
test("a range has air, and one without extent is widened", () => {
  assert.deepEqual(around(0, 100, false), {lo: -4, hi: 104, log: false});
  assert.equal(around(-1, 10, true).log, false);
  const one = around(20, 20, false);
  near(one.hi - one.lo, 2 * 1.08);
  const log = around(1, 100, true);
  near(log.lo * log.hi, 100);
});
test("both signs over decades", () => {
  const a = {...signed(-100, 1000, 1), unit: 1};
  near(place(a, a.lo), 0);
  near(place(a, a.hi), 1);
  const ticks = ticksOf(a, 8);
  assert.ok(ticks.includes(0) && ticks.some(t => t < -9) && ticks.some(t => t > 99));
});
test("places and values are inverse", () => {
  for (const a of [{lo: -3, hi: 8, log: false}, {lo: 0.01, hi: 50, log: true}])
    for (const t of [0, 0.23, 1]) near(place(a, valueAt(a, t)), t);
  assert.ok(Number.isNaN(place({lo: 1, hi: 2, log: true}, -1)));
});

const panel = (x = {lo: 0, hi: 10, log: false}, y = {lo: 0, hi: 1, log: false}) =>
  new Panel("p", {left: 50, top: 20, width: 500, height: 200}, axis(x, 1, "x, s"),
    axis(y, 1, "y, \"m\""));
test("a panel places values and finds them again", () => {
  const p = panel();
  near(p.x(5), 300);
  near(p.y(0.25), 170);
  near(p.value(p.x(3.7)), 3.7);
  near(p.valueY(p.y(0.6)), 0.6);
  assert.ok(p.inside(p.x(0), p.y(1)) && !p.inside(p.x(11), p.y(0.5)));
});
test("a line leaves out points nearer than a quarter of a pixel", () => {
  const p = panel(), x = [...Array(5001).keys()].map(i => i / 500);
  p.line("line", x, x.map(v => v / 10));
  const drawn = /class="line".* d="([^"]*)"/.exec(p.svg)[1].split("L").length;
  assert.ok(drawn > 1000 && drawn < 2600, `${drawn} points`);
});
test("a line is interrupted where it has no place, and by its pieces", () => {
  const p = panel(undefined, {lo: 0.1, hi: 1, log: true}), x = [0, 1, 2, 3, 4];
  p.line("gap", x, [0.5, 0.5, -1, 0.5, 0.5]);
  assert.equal(/class="gap".* d="([^"]*)"/.exec(p.svg)[1].split("M").length - 1, 2);
  p.line("one", x, [0.5, 0.5, 0.5, 0.5, 0.5], i => i === 2);
  assert.equal(/class="one".* d="([^"]*)"/.exec(p.svg)[1].split("L").length - 1, 1);
});
test("text of a label is escaped", () => {
  assert.ok(panel().svg.includes("y, &#34;m&#34;"));
});
test("a table has what is seen, in SI units", () => {
  const p = panel();
  p.line("line c0 ", [1, 20, 3], [0.5, 0.5, 2]);
  p.bar("bar", 4, 6, 0, 0.5);
  assert.equal(table([p]),
    "panel,series,x,y\n1,axes,\"x, s\",\"y, \"\"m\"\"\"\n1,line c0,1,0.5\n1,bar,5,0.5\n");
});
