/* A design study: which charts the page has. */
import {$, wirePrint} from "./chart.js";
import {D, keys, outputs, known, state, dark, select, drawAll, U} from "./study_state.js";
import {choose} from "./study_design.js";
import {buildCurves} from "./study_curves.js";
import {buildEffects} from "./study_effects.js";
import {buildMap} from "./study_map.js";
import {buildParallel} from "./study_parallel.js";
import {buildHistory, buildTornado} from "./study_search.js";
import {buildUncertainty, buildRobust} from "./study_uncertainty.js";
import {buildTable} from "./study_table.js";

function buildPanel() {
  $("charts").insertAdjacentHTML(
      "beforeend",
      `<div class="tools panel">${
          known.length > 1 ?
              select("output", "Output", known.map(o => [o.index, o.name]), state.output.index) :
              ""}${
          keys.length > 1 ?
              select("colour", "Colour", keys.map((k, j) => [j, k.short]), state.colour) :
              ""}<button
          type="button" id="free" hidden>Free all axes</button><p class="count"
          id="count"></p></div>`);
  if ($("output"))
    $("output").onchange = e => {
      state.output = outputs[+e.target.value];
      drawAll();
    };
  if ($("colour"))
    $("colour").onchange = e => {
      state.colour = +e.target.value;
      drawAll();
    };
  $("free").onclick = () => {
    state.brush.clear();
    drawAll();
  };
}
/* Curves are coloured by the key that matters most. */
function chiefKey() {
  if (!state.output) return 0;
  const index = U && U.total ? U.total[state.output.index].map(t => t[0]) :
                               D.effects[state.output.index].map(e => e.share);
  let chief = Math.max(0, keys.findIndex(k => k.many));
  index.forEach((v, j) => {
    if (v !== null && v > (index[chief] || 0)) chief = j;
  });
  return chief;
}

document.documentElement.classList.add("js");
document.body.insertAdjacentHTML(
    "beforeend", `<aside id="dock" class="dock" hidden aria-live="polite"
    aria-label="Chosen design"></aside>`);
if (D.n > 0 && keys.length) {
  state.colour = chiefKey();
  buildPanel();
  buildHistory();
  buildUncertainty();
  buildRobust();
  buildEffects();
  buildCurves();
  buildMap();
  buildParallel();
  buildTornado();
  buildTable();
  drawAll();
  let timer;
  window.addEventListener("resize", () => {
    clearTimeout(timer);
    timer = setTimeout(drawAll, 80);
  });
  window.addEventListener("keydown", e => {
    if (e.key === "Escape" && state.chosen >= 0) choose(-1);
  });
  dark.addEventListener("change", drawAll);
  wirePrint(drawAll);
}
