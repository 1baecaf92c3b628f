/* The report of a case: controls, and which chart follows which. */
import {escape, unique} from "./numbers.js";
import {$, show, widthOf, offer, save, wirePrint, readData} from "./chart.js";
import {
  readReport, classOf, selectable, topOf, firstState, outputFor
} from "./report_data.js";
import {responseView, readout, spoken, nearest, stepped} from "./response.js";
import {trackingView, stateView} from "./tracking.js";
import {alongView, harmonicsView, spectrumView} from "./curve.js";
import {contactAt, contactViews, contactText} from "./contact.js";
import {bladesView, factorsView} from "./ring.js";
import {safeView} from "./safe.js";
import {axesView} from "./contact_axes.js";
import {openBlade} from "./blade.js";
import {wireChart} from "./gestures.js";

document.documentElement.classList.add("js"); /* shows what a script draws */
const report = readReport(readData()), state = firstState(report);
const blade = report.blade && $("blade-canvas") ? openBlade(report.blade) : null;
let main; /* the panel of the main chart */
const draw = (id, view, ...rest) => {
  if ($(id)) show(id, view(...rest, widthOf(id)));
};

/* ---------------------------------------------------------------- main chart */
function drawResponse() {
  const view = responseView(report, state, widthOf("response"));
  [main] = view.panels;
  show("response", view);
  $("whole").disabled = !state.zoom && !state.zoomY;
  drawHover();
}
function hideHover() {
  $("readout").hidden = true;
  $("hover").innerHTML = "";
}
const sharesBar = shares => `<div class="shares">${
  shares.map((s, k) => `<i style="width:${100 * s}%;background:var(--${
    ["stick", "slip", "gap"][k]})"></i>`).join("")}</div>`;
function drawHover() {
  const box = $("readout"), {at} = state, b = at && report.branches[at.b];
  if (!at || state.hidden.has(b.groupIndex)) return hideHover();
  const x = main.x(b.at[at.i]), y = main.y(b.row(state.output.row)[at.i]);
  if (!main.inside(x, y)) return hideHover();
  $("hover").innerHTML = `<path class="cursor" d="M${x} ${main.box.top}v${
    main.box.height}"/><circle class="probe ${classOf(b.group)}" cx="${x}" cy="${y}" r="5"/>`;
  const r = readout(report, state.output, b, at.i);
  box.innerHTML = `<b>${escape(r.title)}</b><dl>${
    r.rows.map(([k, v]) => `<dt>${k}</dt><dd>${v}</dd>`).join("")}</dl>${
    r.shares ? sharesBar(r.shares) : ""}`;
  box.hidden = false;
  const host = box.parentElement.clientWidth, scale = host / widthOf("response");
  const w = box.offsetWidth, right = x * scale + 18;
  box.style.left = Math.max(0, right + w > host ? x * scale - 18 - w : right) + "px";
  box.style.top = Math.max(0, y * scale - box.offsetHeight - 12) + "px";
}
function announce() {
  if (state.at)
    $("spoken").textContent =
      spoken(readout(report, state.output, report.branches[state.at.b], state.at.i));
}

/* ---------------------------------------------------------------- the chosen point */
function showBlade() {
  if (!blade || state.branch < 0) return;
  const b = report.branches[state.branch], i = state.point;
  blade.choose(state.branch, b.at[i], b.row(report.outputs[0].row)[i],
    x => `${b.group.name}${b.note}, ${report.xText(x)}`);
}
function drawPoint() {
  if (!$("point") || state.branch < 0) return;
  const b = report.branches[state.branch];
  $("point-where").textContent = spoken(readout(report, state.output, b, state.point)) +
    ". Click the curves above to choose another.";
  draw("spectrum", spectrumView, report, state);
  if ($("loop-u")) drawContact();
}
/* The chosen contact at the point: its loops, its load, its numbers. */
function drawContact() {
  const q = contactAt(report, state);
  $("pair-label").hidden = report.contacts.names.length < 2;
  if (!q) return;
  $("contact-where").textContent = contactText(report, state, q);
  for (const [id, view] of contactViews(q, widthOf)) show(id, view);
}
function drawAlong() {
  if (state.branch < 0) return;
  draw("along", alongView, report, state);
  draw("harmonics", harmonicsView, report, state);
}
function drawFixed() {
  draw("blades", bladesView, report.ring);
  draw("factors", factorsView, report.factors);
  draw("safe", safeView, report.safe);
  if ($("contact-axes")) show("contact-axes", axesView(report.axes));
}
function drawAll() {
  choices();
  drawResponse();
  drawPoint();
  draw("tracking", trackingView, report, state);
  draw("state", stateView, report, state);
  drawAlong();
  drawFixed();
}

/* ---------------------------------------------------------------- controls */
function fill(box, options, chosen) {
  box.innerHTML =
    options.map(([v, text]) => `<option value="${escape(String(v))}">${escape(text)}</option>`)
      .join("");
  box.value = String(chosen);
}
function choices() {
  const o = state.output, here = report.outputs.filter(e => e.place === o.place);
  fill($("place"), unique(report.outputs.map(e => e.place)).map(p => [p, p]), o.place);
  fill($("axis"), unique(here.map(e => e.axis)).map(a => [a, a]), o.axis);
  for (const button of document.querySelectorAll("[data-quantity]")) {
    const {quantity} = button.dataset;
    button.setAttribute("aria-pressed", String(quantity === o.quantity));
    button.disabled = !here.some(e => e.axis === o.axis && e.quantity === quantity);
  }
  for (const button of document.querySelectorAll("[data-scale]"))
    button.setAttribute("aria-pressed", String((button.dataset.scale === "log") === state.log));
}
function choose(place, ax, quantity) {
  state.zoomY = null;
  state.output = outputFor(report, place, ax, quantity);
  drawAll();
}
function select(index, point) {
  if (index < 0 || !selectable(report.branches[index])) return;
  state.branch = index;
  state.point = point === undefined ? topOf(report.branches[index], state.output) : point;
  showBlade();
  if ($("curve")) $("curve").value = String(index);
  drawResponse();
  drawPoint();
  drawAlong();
}
function setZoom(range, rangeY = null) {
  state.zoom = range;
  state.zoomY = rangeY;
  drawResponse();
  drawAlong();
}
function wireOutput() {
  $("place").onchange = e => choose(e.target.value, null, state.output.quantity);
  $("axis").onchange = e => choose(state.output.place, e.target.value, state.output.quantity);
  for (const b of document.querySelectorAll("[data-quantity]"))
    b.onclick = () => choose(state.output.place, state.output.axis, b.dataset.quantity);
  for (const b of document.querySelectorAll("[data-scale]"))
    b.onclick = () => {
      state.log = b.dataset.scale === "log";
      state.zoomY = null;
      drawAll();
    };
  $("whole").onclick = () => setZoom(null);
}
function wireCurve() {
  if ($("pair")) {
    fill($("pair"), report.contacts.names.map((name, i) => [i, name]), 0);
    $("pair").onchange = e => {
      state.pair = +e.target.value;
      drawPoint();
    };
  }
  if (!$("curve")) return;
  const all = report.branches, list = [...all.keys()].filter(i => selectable(all[i]));
  list.sort((i, j) => all[i].groupIndex - all[j].groupIndex || i - j);
  const many = i => list.filter(j => all[j].groupIndex === all[i].groupIndex).length > 1;
  const name = i => all[i].group.name + all[i].note + (many(i) ? ` (curve ${i})` : "");
  fill($("curve"), list.map(i => [i, name(i)]), state.branch);
  $("curve").onchange = e => select(+e.target.value);
}
/* The keys below the chart become buttons that hide their curves. */
function wireKeys() {
  for (const key of document.querySelectorAll(".key[data-group]")) {
    const button = document.createElement("button"), group = +key.dataset.group;
    button.type = "button";
    button.className = key.className;
    button.innerHTML = key.innerHTML;
    button.setAttribute("aria-pressed", "true");
    button.dataset.group = group;
    button.onclick = () => {
      if (!state.hidden.delete(group)) state.hidden.add(group);
      button.setAttribute("aria-pressed", String(!state.hidden.has(group)));
      drawResponse();
    };
    key.replaceWith(button);
  }
}
const chart = {
  element: $("response"), panel: () => main, width: () => widthOf("response"),
  range: report.X.range, zoom: () => [state.zoom, state.zoomY], setZoom,
  /* Read the point nearest to a place, px; true if there is one. */
  point(x, y) {
    state.at = nearest(report, state, main, x, y);
    drawHover();
    return state.at !== null;
  },
  leave() {
    state.at = null;
    drawHover();
  },
  choose() {
    if (state.at) select(state.at.b, state.at.i);
  },
  band(box) {
    $("readout").hidden = true;
    $("hover").innerHTML = `<rect class="band" x="${box.left}" y="${box.top}" width="${
      box.width}" height="${box.height}"/>`;
  },
  /* True if the key means something here. */
  key(key, far) {
    if (/^Arrow/.test(key)) {
      const to = stepped(report, state, key, far);
      if (!to) return false;
      state.at = to;
    } else if (key === "Enter" && state.at) {
      select(state.at.b, state.at.i);
    } else if (key === "Escape") {
      state.at = null;
      if (state.zoom || state.zoomY) setZoom(null);
    } else {
      return false;
    }
    drawHover();
    announce();
    return true;
  }
};

/* ---------------------------------------------------------------- start */
function start() {
  const name = document.querySelector("h1").textContent.replace(/[^\w.-]+/g, "_");
  let timer;
  wireOutput();
  wireCurve();
  wireKeys();
  wireChart(chart);
  if (blade) wirePrint(() => blade.print());
  drawAll();
  showBlade();
  offer(name);
  if (blade) $("blade-save").onclick = () => save(name + "_blade.png", blade.dataUrl());
  window.addEventListener("resize", () => {
    clearTimeout(timer);
    timer = setTimeout(drawAll, 80);
  });
}
start();

export {blade};
