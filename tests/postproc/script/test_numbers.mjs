/* Numbers as text, units, base64. */
import test from "node:test";
import assert from "node:assert/strict";
import * as numbers from "../../../postproc/script/numbers.js";

const {number, unit, forceUnit, percent, escape, extent, decode, LENGTH, ENERGY} = numbers;

test("numbers have the digits that are asked for", () => {
  assert.equal(number(322.25818, 7), "322.2582");
  assert.equal(number(100, 6), "100.000");
  assert.equal(number(100, 6, false), "100");
  assert.equal(number(-0.02387, 3), "−0.0239");
  assert.equal(number(99.996, 4, false), "100");
  assert.equal(number(0, 4), "0");
});
test("numbers far from one have a power of ten", () => {
  assert.equal(number(2.387e7, 3), "2.39×10⁷");
  assert.equal(number(-1.2e-6, 2), "−1.2×10⁻⁶");
  assert.equal(number(2e9, 4, false), "2×10⁹");
  assert.equal(number(123456, 3), "123000");
});
test("what is no number is a dash", () => {
  for (const v of [NaN, Infinity, undefined, null]) assert.equal(number(v, 3), "–");
  assert.equal(percent(NaN), "–");
});
test("units follow the largest value", () => {
  assert.deepEqual(unit(LENGTH, 2.385e-5), ["µm", 1e-6]);
  assert.deepEqual(unit(LENGTH, 0.9996e-3), ["mm", 1e-3]);
  assert.deepEqual(unit(LENGTH, 1e-20), ["pm", 1e-12]);
  assert.deepEqual(unit(ENERGY, 0), ["mJ", 1e-3]);
  assert.equal(forceUnit(9999)[0], "N");
  assert.equal(forceUnit(10000)[0], "kN");
  assert.equal(forceUnit(0.3)[0], "mN");
  assert.equal(forceUnit(0)[0], "N");
});
test("text is escaped for HTML", () => {
  assert.equal(escape("<a & \"b'>"), "&#60;a &#38; &#34;b&#39;&#62;");
});
test("an extent leaves out what is no number", () => {
  assert.deepEqual(extent([3, NaN, -2]), [-2, 3]);
  assert.deepEqual(extent([{v: 4}, {v: 2}], e => e.v), [2, 4]);
  assert.deepEqual(extent([]), [Infinity, -Infinity]);
});
test("base64 gives the numbers that went in", () => {
  const values = Float32Array.from([1.5, -2.25, 1e-30, 7]);
  const text = Buffer.from(values.buffer).toString("base64");
  assert.deepEqual(decode(text, Float32Array), values);
  assert.deepEqual([...decode("AAD/fw==", Int16Array)], [0, 32767]);
});
