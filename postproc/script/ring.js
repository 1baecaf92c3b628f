/* A ring of different blades: the amplitude of every blade, and the amplification of samples. */
import {number, extent} from "./numbers.js";
import {axis, around} from "./axes.js";
import {Panel} from "./panel.js";

const ACROSS = 3, HEIGHT = 190;

/* A bar for each blade, relative to the highest one; a panel for each curve. */
function bladesView(ring, width) {
  const wide = (width - 80) / ACROSS;
  const panels = ring.panels.map(({n0, value, branch, kind, stable, amplitude}, i) => {
    const p = new Panel("blades" + i, {
      left: 50 + i % ACROSS * wide, top: 30 + Math.floor(i / ACROSS) * HEIGHT, width: wide - 60,
      height: HEIGHT - 75
    }, axis({lo: -0.5, hi: amplitude.length - 0.5, log: false}, 1, "blade"),
    axis({lo: 0, hi: 1.25, log: false}, 1, null));
    const most = Math.max(...amplitude);
    amplitude.forEach((a, k) =>
      p.bar(stable ? "bar c0" : "bar c1", k - 0.4, k + 0.4, 0, a / most));
    p.text("small", -0.5, 1.25, 0, -5, "start",
      `n0 = ${number(n0, 4, false)} N, ${number(value, 5, false)}, curve ${branch}: ${kind}`);
    return p;
  });
  return {height: 20 + Math.ceil(panels.length / ACROSS) * HEIGHT, panels};
}

/* Corners of the distribution of factors: [x, share], two at each factor. */
function corners(factors) {
  const x = factors.slice().sort((a, b) => a - b), n = x.length;
  return [x.flatMap(v => [v, v]), x.flatMap((v, i) => [i / n, (i + 1) / n])];
}
/* Share of the rings whose factor is at most x, a curve for each preload. */
function factorsView(factors, width) {
  const [lo, hi] = extent(factors.flatMap(f => f.factor));
  const p = new Panel("factors", {left: 60, top: 34, width: width - 80, height: 270},
    axis(around(lo, hi, false), 1, "amplification factor"),
    axis({lo: -0.02, hi: 1.02, log: false}, 0.01, "share of the rings, %"));
  factors.forEach(({n0, factor}, i) => {
    const [x, share] = corners(factor);
    if (!x.length) return;
    p.line("line c" + i, x, share);
    const beside = 2 * Math.floor((0.1 + 0.8 * (i + 0.5) / factors.length) * factor.length) + 1;
    p.text("mark c" + i, x[beside], share[beside], 8, 13, "start",
      `n0 = ${number(n0, 4, false)} N`);
  });
  return {height: 360, panels: [p]};
}

export {corners, bladesView, factorsView};
