/* The study of the page: its columns, what is chosen, colours, and the frames of charts. */
import {escape} from "./numbers.js";
import {$, widthOf, readData} from "./chart.js";
import {shortNames, column, place} from "./study_columns.js";

const D = readData();
const FORMAT = "shroudhb study page", VERSION = 1;
if (D.format !== FORMAT || D.version !== VERSION)
  throw new Error(`This script reads "${FORMAT}" ${VERSION}, not "${D.format}" ${D.version}.`);
const STATES = D.states;
const [WAITING, DONE, FAILED] = ["not run", "done", "failed"].map(s => STATES.indexOf(s));
const CHARTS = [], U = D.uncertainty, R = D.robust;
const best = U || R ? -1 : D.best; /* the lowest sample of uncertain keys is no choice */

const keyNames = shortNames(D.keys.map(k => k.name));
const keys = D.keys.map((k, i) => column(k, D.key[i], keyNames[i], "key"));
const outputs = D.outputs.map(
    (o, i) => ({
      ...column(o, D.value[i].map((v, d) => D.status[d] === DONE ? v : null), o.name, "output"),
      all: D.value[i].map(v => v === null ? NaN : v),
      error: D.error[i],
      index: i
    }));
const known = outputs.filter(o => o.list.some(Number.isFinite));
const state = {
  output: known.find(o => o.index === D.objective) || known[0],
  colour: 0,
  log: false,
  brush: new Map(),
  chosen: -1,
  x: 0,
  y: 1,
  fixed: [],
  sort: null,
  down: false,
  rows: 25
};
const ids = D.status.map((s, i) => i);
const active = i => {
  for (const [c, [lo, hi]] of state.brush)
    if (!(c.list[i] >= lo && c.list[i] <= hi)) return false;
  return true;
};

const dark = matchMedia("(prefers-color-scheme: dark)");
const printing = () => document.documentElement.classList.contains("printing");
const ramp = () => D.ramp[dark.matches && !printing() ? "dark" : "light"];
const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const shade = (c, v) => Math.max(0, Math.min(32, Math.round(32 * place(c, v)))) || 0;
const colourOf = (c, v) => ramp()[shade(c, v)];
/* Colour between two of the ramp. */
function blend(t) {
  const at = Math.max(0, Math.min(31.999, 32 * t)) || 0, i = Math.floor(at), w = at - i;
  const part = (hex, k) => parseInt(hex.slice(1 + 2 * k, 3 + 2 * k), 16), a = ramp()[i],
        b = ramp()[i + 1];
  return [0, 1, 2].map(k => Math.round((1 - w) * part(a, k) + w * part(b, k)));
}
const scaleBar = (c, lead) => `<div class="scale"><span>${lead} <b>${escape(c.short)}</b>${
    c.log ? " (logarithmic)" :
            ""}</span><span>${escape(c.text(c.range[0]))}</span><i style="background:
    linear-gradient(90deg,${ramp().join()})"></i><span>${
    escape(c.text(c.range[1]))}</span></div>`;

function section(id, title, note, body) {
  $("charts").insertAdjacentHTML(
      "beforeend",
      `<section id="${id}"><h2>${title}</h2>${
          note ? `<p class="note" id="${id}-note">${note}</p>` : ""}${body}</section>`);
}
const card = inner => `<div class="card">${inner}</div>`;
const plot = (id, title) =>
    `<div class="chart"><svg class="plot" id="${id}" role="img" aria-labelledby="${
        id}-title"><title id="${id}-title">${escape(title)}</title></svg><canvas></canvas><div
        class="readout" hidden></div></div>`;
const select = (id, label, options, chosen) => `<label>${label}<select id="${id}">${
    options
        .map(
            ([v, text]) =>
                `<option value="${v}"${v === chosen ? " selected" : ""}>${escape(text)}</option>`)
        .join("")}</select></label>`;

/* A canvas over a chart of this height; its units are those of the SVG. */
function canvas(id, height) {
  const c = $(id).parentElement.querySelector("canvas"), width = widthOf(id),
        shown = $(id).parentElement.clientWidth || width, ratio = window.devicePixelRatio || 1;
  c.width = Math.round(width * ratio);
  c.height = Math.round(height * ratio);
  c.style.width = shown + "px";
  c.style.height = height * shown / width + "px";
  const g = c.getContext("2d");
  g.scale(ratio, ratio);
  return g;
}
function clip(g, box, air = 0) {
  g.save();
  g.beginPath();
  g.rect(box.left - air, box.top - air, box.width + 2 * air, box.height + 2 * air);
  g.clip();
}
function disc(g, x, y, r, fill, ring) {
  g.beginPath();
  g.arc(x, y, r, 0, 7);
  if (fill) {
    g.fillStyle = fill;
    g.fill();
  }
  if (ring) {
    g.strokeStyle = ring;
    g.stroke();
  }
}

function count() {
  const n = ids.filter(active).length;
  $("count").textContent = n === D.n ? `All ${D.n} designs` : `${n} of ${D.n} designs`;
  $("free").hidden = !state.brush.size;
}
function drawAll() {
  count();
  for (const draw of CHARTS) draw();
}

export {
  D, WAITING, CHARTS, best, keys, outputs, known, state, ids, active, dark, css, colourOf, blend,
  scaleBar, section, card, plot, select, canvas, clip, disc, count, drawAll, DONE, FAILED,
  STATES, U, R
};
