/* Response curves of all designs. */
import {LENGTH, unit, extent, decode} from "./numbers.js";
import {around, axis} from "./axes.js";
import {Panel} from "./panel.js";
import {$, show, widthOf} from "./chart.js";
import {place} from "./study_columns.js";
import {
  D, CHARTS, keys, state, ids, active, css, colourOf, scaleBar, section, card, plot, canvas,
  clip
} from "./study_state.js";
import {pointable} from "./study_design.js";

const curves = D.curves && decodeCurves(D.curves);
function decodeCurves(c) {
  const all = decode(c.data, Float32Array), n = all.length / 2;
  return {...c, f: all.subarray(0, n), a: all.subarray(n), n, of: runsOf(c)};
}
/* First and last run of each design. */
function runsOf(c) {
  let j = 0;
  return D.status.map((s, i) => {
    const first = j;
    while (j < c.run.length && c.run[j] < c.start[i + 1]) j++;
    return [first, j];
  });
}
/* Path of design i through the panel; kind(code & 3) tells which runs. */
function trace(g, p, i, kind) {
  const [first, last] = curves.of[i];
  for (let j = first; j < last; j++) {
    const code = curves.code[j], end = j + 1 < last ? curves.run[j + 1] : curves.start[i + 1];
    if (!kind(code & 3)) continue;
    const from = code & 4 ? curves.run[j] : curves.run[j] - 1;
    for (let k = from; k < end; k++) {
      const x = p.x(curves.f[k]), y = p.y(Math.max(curves.a[k], 1e-9 * p.ay.hi));
      if (k === from)
        g.moveTo(x, y);
      else
        g.lineTo(x, y);
    }
  }
}
function drawCurves() {
  const id = "curves-chart", height = widthOf(id) < 640 ? 380 : 500, width = widthOf(id);
  const shown = ids.filter(i => active(i) && curves.start[i + 1] > curves.start[i]);
  let most = 0;
  for (const i of shown)
    for (let k = curves.start[i]; k < curves.start[i + 1]; k++)
      if (curves.a[k] > most) most = curves.a[k];
  const u = unit(LENGTH, most), top = most > 0 ? most : u[1];
  const y = state.log ? {lo: 1e-3 * top, hi: 1.4 * top, log: true} :
                        {lo: 0, hi: 1.06 * top, log: false};
  const [lo, hi] = extent(curves.f);
  const p = new Panel(
      id, {left: 60, top: 34, width: width - 80, height: height - 84},
      axis(hi > lo ? {lo, hi, log: false} : around(lo, hi, false), 1, "frequency, Hz"),
      axis(y, u[1], `amplitude of the first harmonic, ${u[0]}`));
  show(id, {height, panels: [p]});
  const g = canvas(id, height), c = keys[state.colour], many = shown.length;
  clip(g, p.box, 1);
  g.lineJoin = "round";
  g.globalAlpha = Math.max(0.12, Math.min(1, 60 / Math.max(many, 1)));
  const order = shown.slice().sort((a, b) => place(c, c.list[a]) - place(c, c.list[b]));
  const styles = many > 120 ?
      [[1.1, [], () => true]] :
      [[1.7, [], k => k === 2], [0.9, [], k => k === 0], [1.7, [2, 3], k => k === 1]];
  for (const i of order) {
    g.strokeStyle = colourOf(c, c.list[i]);
    for (const [w, dash, kind] of styles) {
      g.lineWidth = w;
      g.setLineDash(dash);
      g.beginPath();
      trace(g, p, i, kind);
      g.stroke();
    }
  }
  g.globalAlpha = 1;
  g.setLineDash([]);
  if (state.chosen >= 0) {
    for (const [w, colour] of [[6, css("--card")], [3, css("--ink")]]) {
      g.lineWidth = w;
      g.strokeStyle = colour;
      g.beginPath();
      trace(g, p, state.chosen, () => true);
      g.stroke();
    }
  }
  g.restore();
  $(id).spots = shown.flatMap(i => {
    const list = [];
    for (let k = curves.start[i]; k < curves.start[i + 1]; k++)
      list.push([p.x(curves.f[k]), p.y(curves.a[k]), i]);
    return list;
  });
  $("curves-scale").innerHTML = scaleBar(c, "Colour:");
}
function buildCurves() {
  if (!curves || !curves.n) return;
  section(
      "curves", "Response curves",
      "Each curve is one design; its colour is the value of the chosen variable. " +
          (ids.length > 120 ? "" : "Solid: stable. Dotted: not stable. Thin: not judged."),
      card(
          `<div class="tools"><fieldset><legend>Amplitude</legend><span class="switch">
          <button type="button" data-log="0">Linear</button><button type="button"
          data-log="1">Logarithmic</button></span></fieldset></div>` +
          plot("curves-chart", "Amplitude over frequency for each design") +
          `<div id="curves-scale"></div>`));
  const buttons = [...document.querySelectorAll("[data-log]")];
  const press = () => buttons.forEach(
      b => b.setAttribute("aria-pressed", String((b.dataset.log === "1") === state.log)));
  for (const b of buttons)
    b.onclick = () => {
      state.log = b.dataset.log === "1";
      press();
      drawCurves();
    };
  press();
  pointable("curves-chart");
  CHARTS.push(drawCurves);
}

export {buildCurves};
