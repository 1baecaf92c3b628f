/* Columns of a study, and the fields between its designs. */
import test from "node:test";
import assert from "node:assert/strict";
import {
  shortNames, column, place, levels
} from "../../../postproc/script/study_columns.js";
import {
  gridField, scatterField, refine, contour
} from "../../../postproc/script/study_field.js";

const near = (a, b, tolerance = 1e-12) => assert.ok(Math.abs(a - b) <= tolerance, `${a}, ${b}`);
const make = list => column({name: "v", unit: "", scale: 1}, list, "v", "key");

test("keys have the shortest end that tells them apart", () => {
  assert.deepEqual(shortNames(["contact.n0", "contact.mu"]), ["n0", "mu"]);
  assert.deepEqual(shortNames(["a.b.x", "a.c.x", "x.y"]), ["b.x", "c.x", "y"]);
  assert.deepEqual(shortNames(["loads[0].force", "mu"]), ["loads[0].force", "mu"]);
});
test("a column that spans decades is logarithmic, if its values do", () => {
  assert.equal(make([1, 2, 5, 10, 100]).log, true);
  assert.equal(make([1, 95, 96, 97, 98, 100]).log, false);
  assert.equal(make([-1, 100]).log, false);
});
test("a column shows values in its unit", () => {
  const c = column({name: "peak", unit: "µm", scale: 1e-6}, [2.385e-6, null], "peak", "output");
  assert.equal(c.text(c.list[0]), "2.385\u00a0µm");
  assert.equal(c.text(c.list[1]), "–");
  assert.deepEqual([c.label, c.many], ["peak, µm", false]);
});
test("places within a column", () => {
  near(place(make([0, 4]), 1), 0.25);
  near(place(make([1, 10, 10, 1, 1, 1, 100]), 10), 0.5);
  near(place(make([3, 3]), 3), 0.5);
  assert.deepEqual(levels(make([3, 1, 3, null])), [1, 3]);
});
test("a grid is interpolated bilinearly, and blank beside a missing design", () => {
  const a = make([0, 1, 0, 1]), b = make([0, 0, 2, 2]), o = make([1, 2, 5, 6]);
  const at = gridField(a, b, o, [0, 1, 2, 3]);
  near(at(0.5, 0.5), 3.5);
  near(at(1, 0.25), 3);
  assert.ok(Number.isNaN(gridField(a, b, o, [0, 1, 2])(0.5, 0.5)));
});
test("scattered designs are met, and far from them it is blank", () => {
  const a = make([0, 1, 0.2]), b = make([0, 1, 0.1]), o = make([1, 2, 5]), all = [0, 1, 2];
  near(scatterField(a, b, o, all, false)(0.2, 0.1), 5, 1e-3);
  const many = make([...Array(40).keys()].map(i => i / 390)).list.concat(1);
  const c = make(many), z = make(many.map(() => 7));
  assert.ok(Number.isNaN(scatterField(c, c, z, many.map((v, i) => i), true)(0, 0.9)));
  near(scatterField(c, c, z, many.map((v, i) => i), true)(0.05, 0.05), 7, 1e-9);
});
test("a field is refined by the means of neighbours", () => {
  const field = [0, NaN, 4, NaN, NaN, NaN, 2, NaN, 6];
  refine(field, 3, 3);
  assert.deepEqual(field, [0, 2, 4, 1, 3, 5, 2, 4, 6]);
});
test("a level line is where the value is", () => {
  const n = 11, field = [], lines = [];
  for (let j = 0; j < n; j++) for (let i = 0; i < n; i++) field.push(i + 2 * j);
  const g = {moveTo: (x, y) => lines.push([x, y]), lineTo: (x, y) => lines.push([x, y])};
  assert.ok(contour(g, field, n, n, 12.3, x => x, y => y));
  assert.ok(lines.length > 10);
  for (const [x, y] of lines) near(x + 2 * y, 12.3, 1e-9);
});
