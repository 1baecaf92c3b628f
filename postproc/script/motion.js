/* The blade of a page in numbers: its surface, and motion and stress as sums of its modes. */
import {NBSP, number, decode} from "./numbers.js";
import {cross} from "./still.js";

const INSTANTS = 24; /* of a period with several harmonics */
const MOTION = {from: 0, width: 3, scale: "d"}, STRESS = {from: 3, width: 6, scale: "s"};
const FULL = 127, ROW = 9; /* of the bytes of a mode: largest, and numbers a node */

/* Surface, modes and kept points of report.blade. */
function readBlade(d) {
  const n = d.nodes, wide = n >= 65536;
  const position = decode(d.position, Uint16Array).subarray(0, 3 * n);
  return {
    ...d, n, wide, radius: Math.hypot(...d.size) / 2,
    base: Float32Array.from(position, (v, i) => d.lo[i % 3] + d.size[i % 3] * v / 65535),
    index: decode(d.index, wide ? Uint32Array : Uint16Array).subarray(0, 3 * d.triangles),
    modes: d.modes.map(m => ({
      ...m, wave: m.w || 0, data: decode(m.data, Int8Array),
      im: m.im && decode(m.im, Int8Array) /* a travelling wave of a disc */
    })),
    points: d.points.map(p => ({...p, q: decode(p.q, Float32Array)})),
    centre: d.lo.map((v, i) => v + d.size[i] / 2)
  };
}

/* ---------------------------------------------------------------- what moves */
/* A mode: harmonics ks, amplitudes of the modes of a wave for each, the order of a subharmonic
 * motion, the lag of the right neighbour, and its name. */
function ofMode(blade, i) {
  const q = new Float32Array(2 * blade.row), {wave, f} = blade.modes[i];
  const of = blade.waves ? ` of nodal diameter ${blade.waves[wave]}` : "";
  q[2 * (i % blade.row)] = 1;
  return {
    ks: [1], parts: [{q, wave, back: false}], order: 1, real: false,
    lag: blade.waves ? 2 * Math.PI * blade.waves[wave] / blade.blades : blade.lag,
    name: `Mode ${i % blade.row + 1}${of}, ${number(f, 5)}${NBSP}Hz, the contact free`
  };
}
/* A kept point. */
function ofPoint(blade, point, name) {
  const part = (k, j) => ({
    q: point.q.subarray(2 * j * blade.row, 2 * (j + 1) * blade.row),
    wave: point.w ? point.w[j] : 0, back: Boolean(point.back && point.back[j])
  });
  return {
    ks: point.k, parts: point.k.map(part), order: point.order, lag: point.lag, real: true, name
  };
}
/* The kept point of branch b nearest to abscissa x and amplitude a; undefined: there is none. */
function keptPoint(blade, b, x, a) {
  const far = p =>
    Math.abs(p.x / x - 1) + 0.05 * Math.abs(Math.log((p.a || 1e-30) / (a || 1e-30)));
  return blade.points.filter(p => p.b === b).sort((p, q) => far(p) - far(q))[0];
}

/* ---------------------------------------------------------------- sums over modes */
/* A harmonic of displacement or stress. A wave that runs backwards has the conjugate shapes. */
function harmonic(blade, {q, wave, back}, {from, width, scale}) {
  const {n} = blade, re = new Float32Array(width * n), im = new Float32Array(width * n);
  const sign = back ? -1 : 1;
  blade.modes.filter(m => m.wave === wave).forEach((m, i) => {
    const a = q[2 * i] * m[scale] / FULL, b = q[2 * i + 1] * m[scale] / FULL;
    if (a === 0 && b === 0) return;
    for (let at = 0; at < width * n; at++) {
      const to = ROW * Math.floor(at / width) + from + at % width;
      const x = m.data[to], y = m.im ? sign * m.im[to] : 0;
      re[at] += a * x - b * y;
      im[at] += b * x + a * y;
    }
  });
  return {re, im};
}
const square = (x, i) => x[i] ** 2 + x[i + 1] ** 2 + x[i + 2] ** 2;
/* square of the von Mises stress of components xx, yy, zz, xy, yz, xz from i on */
const mises = (s, i) =>
  ((s[i] - s[i + 1]) ** 2 + (s[i + 1] - s[i + 2]) ** 2 + (s[i + 2] - s[i]) ** 2) / 2 +
  3 * (s[i + 3] ** 2 + s[i + 4] ** 2 + s[i + 5] ** 2);

/* One harmonic in closed form: form(re c - im s) = (a + b)/2 + (a - b)/2 cos 2t - mixed sin 2t. */
function greatestOfOne({re, im}, width, form) {
  const both = re.map((v, i) => v + im[i]), most = new Float32Array(re.length / width);
  for (let v = 0, i = 0; v < most.length; v++, i += width) {
    const a = form(re, i), b = form(im, i), mixed = (form(both, i) - a - b) / 2;
    most[v] = Math.sqrt(Math.max(0, (a + b) / 2 + Math.hypot((a - b) / 2, mixed)));
  }
  return most;
}
/* x += Re sum over harmonics (re + j im) e^(j angle) */
function add(x, list, angles) {
  list.forEach(({re, im}, j) => {
    const c = Math.cos(angles[j]), s = Math.sin(angles[j]);
    for (let i = 0; i < x.length; i++) x[i] += re[i] * c - im[i] * s;
  });
}
/* The greatest over the period at every node of the root of a quadratic form. */
function greatest(list, ks, width, form) {
  if (list.length === 1) return greatestOfOne(list[0], width, form);
  const x = new Float32Array(list[0].re.length), most = new Float32Array(x.length / width);
  for (let t = 0; t < INSTANTS; t++) {
    x.fill(0);
    add(x, list, ks.map(k => 2 * Math.PI * k * t / INSTANTS));
    for (let v = 0, i = 0; v < most.length; v++, i += width)
      most[v] = Math.max(most[v], form(x, i));
  }
  return most.map(Math.sqrt);
}
const largest = list => list.reduce((a, b) => Math.max(a, b), 0) || 1;

/* What is drawn of a motion: harmonics of the displacement; value: share of the top at each node,
 * of "stress" or "motion"; most: the largest displacement. */
function fieldOf(blade, motion, colour) {
  const sums = kind => motion.parts.map(p => harmonic(blade, p, kind));
  const harmonics = sums(MOTION), u = greatest(harmonics, motion.ks, MOTION.width, square);
  const value = colour === "motion" ? u :
    greatest(sums(STRESS), motion.ks, STRESS.width, mises);
  const top = largest(value);
  return {harmonics, most: largest(u), top, value: value.map(v => v / top)};
}

/* ---------------------------------------------------------------- the ring */
/* Rows of the rotation by an angle about the engine axis, one of the coordinate axes. */
function turned(axial, angle) {
  const c = Math.cos(angle), s = Math.sin(angle), a = axial;
  return [0, 1, 2].map(i => [0, 1, 2].map(j => {
    const skew = i === j ? 0 : (j === (i + 1) % 3 ? -1 : 1) * a[3 - i - j];
    return (i === j ? c : 0) + (1 - c) * a[i] * a[j] + s * skew;
  }));
}
const angleOf = (blade, which) => blade.blades ? 2 * Math.PI * which / blade.blades : 0;

/* Displacement [node][3], m, of a blade in its own place, at an instant 0..1 of the period. */
function displacement(blade, motion, harmonics, which, instant) {
  const x = new Float32Array(3 * blade.n), rows = turned(blade.axis, angleOf(blade, which));
  add(x, harmonics, motion.ks.map(k => k * (2 * Math.PI * instant - which * motion.lag)));
  return x.map((v, i) => rows[i % 3].reduce((sum, r, d) => sum + r * x[i - i % 3 + d], 0));
}
/* Blades from .. to, 0 being this one, and the middle and half size of them all; which: how many
 * neighbours on each side, or "all". */
function extentOf({lo, size, axis, centre, radius, blades}, which) {
  if (which !== "all")
    return {from: -which, to: +which, centre, radius, deep: radius * (1 + 2 * which)};
  const along = centre.reduce((sum, c, d) => sum + c * axis[d], 0);
  let ring = 0;
  for (let corner = 0; corner < 8; corner++) {
    const x = lo.map((v, d) => v + (corner >> d & 1) * size[d]);
    ring = Math.max(ring, Math.hypot(...cross(axis, x)));
  }
  return {from: 0, to: blades - 1, centre: axis.map(a => a * along), radius: ring, deep: ring};
}

export {
  readBlade, ofMode, ofPoint, keptPoint, fieldOf, greatest, square, mises, turned, angleOf,
  displacement, extentOf
};
