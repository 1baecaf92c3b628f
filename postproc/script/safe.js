/* The SAFE diagram: frequencies of the ring over the nodal diameter. */
import {axis} from "./axes.js";
import {Panel} from "./panel.js";

const SHOWN = 3; /* families that set the top of the diagram */

/* The nodal diameter that an engine order meets on a ring of so many blades. */
function diameterOf(order, blades) {
  const rest = order % blades;
  return Math.min(rest, blades - rest);
}
const known = v => v !== null;

/* Upper end of the frequencies, Hz. */
function topOf({range, stuck}) {
  const highest = stuck.map(f => f[Math.min(SHOWN, f.length) - 1]).filter(known);
  return Math.max(1.15 * range[1], ...highest.map(f => Math.min(2 * range[1], 1.05 * f)));
}
/* One family over the diameters that the file has. */
function drawFamily(p, frequencies, family, classes) {
  const d = [...frequencies.keys()].filter(i => known(frequencies[i][family]));
  const f = d.map(i => frequencies[i][family]);
  p.line(classes, d, f);
  d.forEach((at, i) => {
    if (f[i] <= p.ay.hi) p.dot("dot family", at, f[i], 2.2);
  });
}
/* The range of the curves at the diameter of each driven harmonic; rings where it holds a
 * frequency. Harmonic k of the excitation is at k times the frequency of the curve. */
function drawExcitation(p, s) {
  for (const k of s.driven) {
    const order = k * s.engineOrder, d = diameterOf(order, s.blades);
    const lo = k * s.range[0], hi = Math.min(k * s.range[1], p.ay.hi);
    if (lo >= p.ay.hi) continue;
    p.line("line excited", [d, d], [lo, hi]);
    p.text("mark", d, hi, 6, 4, "start", (k === 1 ? "E" : `${k} E`) + ` = ${order}`);
    for (const f of [...s.open[d], ...s.stuck[d]])
      if (known(f) && f >= lo && f <= hi) p.dot("crossing", d, f, 6);
  }
}
/* The zigzag of all engine orders at the speed of the rotor: order k is at k Omega. */
function drawZigzag(p, s) {
  const rate = s.speed / (2 * Math.PI);
  if (!(rate > 0)) return;
  const n = Math.floor(Math.min(4 * s.blades, p.ay.hi / rate)) + 2, k = [...Array(n).keys()];
  p.line("order", k.map(i => diameterOf(i, s.blades)), k.map(i => i * rate));
}
function safeView(s, width) {
  const height = 500, last = s.stuck.length - 1;
  const p = new Panel("safe-a", {left: 66, top: 34, width: width - 106, height: height - 92},
    axis({lo: -0.3, hi: last + 0.3, log: false}, 1, "nodal diameter"),
    axis({lo: 0, hi: topOf(s), log: false}, 1, "frequency, Hz"));
  drawZigzag(p, s);
  for (let i = 0; i < s.stuck[0].length; i++) {
    drawFamily(p, s.open, i, "line limit open");
    drawFamily(p, s.stuck, i, "line limit stuck");
  }
  drawExcitation(p, s);
  return {height, panels: [p]};
}

export {diameterOf, safeView};
