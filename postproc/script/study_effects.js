/* Outputs over each variable. */
import {percent} from "./numbers.js";
import {around, axis} from "./axes.js";
import {Panel} from "./panel.js";
import {$, show, widthOf} from "./chart.js";
import {
  D, CHARTS, best, keys, known, state, ids, active, css, colourOf, scaleBar, section, card, plot,
  canvas, clip, disc, U
} from "./study_state.js";
import {pointable} from "./study_design.js";

const rangeOf = c => around(c.range[0], c.range[1], c.log);
const marks = ({length}) => length > 600 && 1.8 || length > 150 && 2.6 || 3.8;
function dots(g, p, xs, ys, colour, spots) {
  const shown = ids.filter(i => Number.isFinite(xs(i)) && Number.isFinite(ys(i))),
        r = marks(shown);
  clip(g, p.box, 6);
  for (const i of shown) {
    const x = p.x(xs(i)), y = p.y(ys(i));
    g.globalAlpha = active(i) ? 0.85 : 0.1;
    disc(g, x, y, r, colour(i));
    if (active(i)) spots.push([x, y, i]);
  }
  g.globalAlpha = 1;
  g.lineWidth = 2;
  for (const [i, ink] of [[best, css("--accent")], [state.chosen, css("--ink")]])
    if (i >= 0 && Number.isFinite(xs(i) + ys(i)))
      disc(g, p.x(xs(i)), p.y(ys(i)), r + 3.5, null, ink);
  g.restore();
}
function drawEffects() {
  const o = state.output, height = 250, c = keys[state.colour];
  keys.forEach((k, j) => {
    if (!k.many) return;
    const id = "effect-" + j, effect = D.effects[o.index][j];
    const p = new Panel(
        id, {left: 60, top: 34, width: widthOf(id) - 76, height: height - 84},
        axis(rangeOf(k), k.scale, k.label), axis(rangeOf(o), o.scale, o.label));
    if (effect.at.length > 1 && !D.optimum) p.line("mean", effect.at, effect.mean);
    const share = effect.share === null || (U && U.total) ?
        "" :
        `<text class="axis end" x="${widthOf(id) - 16}" y="20" text-anchor="end">${
            percent(effect.share)}</text>`;
    show(id, {height, panels: [p], extra: share});
    const spots = [];
    dots(
        canvas(id, height), p, i => k.list[i], i => o.list[i], i => colourOf(c, c.list[i]),
        spots);
    $(id).spots = spots;
  });
  $("effects-scale").innerHTML = scaleBar(c, "Colour:");
}
function buildEffects() {
  if (!known.length || !keys.some(k => k.many)) return;
  const judged = D.effects.some(row => row.some(e => e.share !== null));
  section(
      "effects", "Over each variable",
      (D.optimum ? "Each dot is one design; the search crowds them at the optimum." :
                   "Each dot is one design. Dashed: the mean over the designs of one level or " +
               "of neighbouring values." +
               (judged && !(U && U.total) ?
                    " Percent: share of the variance that the variable explains by itself." :
                    "")) +
          (best >= 0 ? " Ring: the lowest." : ""),
      card(`<div class="small${keys.filter(k => k.many).length === 4 ? " four" : ""}">${
          keys.map((k, j) => k.many ? plot("effect-" + j, "Output over " + k.name) : "")
              .join("")}</div><div id="effects-scale"></div>`));
  keys.forEach((k, j) => k.many && pointable("effect-" + j));
  CHARTS.push(drawEffects);
}

export {rangeOf, marks, dots, buildEffects};
