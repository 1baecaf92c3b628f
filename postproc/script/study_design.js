/* One design: in the dock, and under the pointer. */
import {NBSP, number, escape} from "./numbers.js";
import {$, widthOf} from "./chart.js";
import {D, best, keys, outputs, state, drawAll, STATES} from "./study_state.js";

const rowsOf = i =>
    [...keys.map(k => [k.short, k.text(k.list[i])]), ...outputs.map(o => [o.name, textOf(o, i)])];
function textOf(o, i) {
  const error = o.error[i], value = o.all[i];
  if (!(error > 0) || !Number.isFinite(value)) return o.text(value, 5);
  return `${number(value / o.scale, 5, false)} ± ${number(error / o.scale, 1, false)}` +
      (o.unit ? NBSP + o.unit : "");
}
function choose(i) {
  state.chosen = i;
  drawDock();
  drawAll();
}
function drawDock() {
  const dock = $("dock"), i = state.chosen;
  dock.hidden = i < 0;
  if (i < 0) return;
  const path = D.path || D.name + ".yaml", file = /^[\w./-]+$/.test(path) ? path : `"${path}"`,
        command = `shroudhb study ${file} --design ${i + 1}`;
  dock.innerHTML = `<div class="row" style="margin:0"><h3>Design ${i + 1}</h3><span>${
      STATES[D.status[i]]}${i === best ? ", the lowest" : ""}</span><button type="button"
      class="close"
      aria-label="Close">Close</button></div><dl>${
      rowsOf(i)
          .map(([k, v]) => `<div><dt>${escape(k)}</dt><dd>${escape(v)}</dd></div>`)
          .join("")}</dl>${D.reason[i] ? `<p class="reason">${escape(D.reason[i])}</p>` : ""}
      <div class="row" style="margin:0"><span>Full report:</span><code>${
      escape(command)}</code><button type="button" class="copy">Copy</button></div>`;
  dock.querySelector(".close").onclick = () => choose(-1);
  dock.querySelector(".copy").onclick = e => {
    const done = () => {
      e.target.textContent = "Copied";
    };
    if (navigator.clipboard) navigator.clipboard.writeText(command).then(done, () => {});
  };
}
/* Point at designs: spots is a list of [x, y, design], or a function of (x, y). */
function pointable(id) {
  const svg = $(id), box = svg.parentElement.querySelector(".readout");
  let at = -1;
  const find = e => {
    const r = svg.getBoundingClientRect(), s = widthOf(id) / r.width,
          x = (e.clientX - r.left) * s, y = (e.clientY - r.top) * s;
    let found = -1, least = 400;
    for (const [px, py, i] of svg.spots || []) {
      const d = (px - x) ** 2 + (py - y) ** 2;
      if (d < least) [found, least] = [i, d];
    }
    return [found, x / s, y / s, r.width];
  };
  svg.addEventListener("pointermove", e => {
    const [i, x, y, width] = find(e);
    if (i !== at) {
      at = i;
      box.hidden = i < 0;
      svg.style.cursor = i < 0 ? "" : "pointer";
      if (i >= 0)
        box.innerHTML = `<b>Design ${i + 1}</b><dl>` +
            rowsOf(i).map(([k, v]) => `<dt>${escape(k)}</dt><dd>${escape(v)}</dd>`).join("") +
            "</dl>";
    }
    if (i < 0) return;
    const w = box.offsetWidth;
    box.style.left = Math.max(0, x + 16 + w > width ? x - 16 - w : x + 16) + "px";
    box.style.top = y + 12 + "px";
  });
  svg.addEventListener("pointerleave", () => {
    at = -1;
    box.hidden = true;
  });
  svg.addEventListener("click", e => {
    const [i] = find(e);
    if (i >= 0) choose(i === state.chosen ? -1 : i);
  });
}

export {choose, pointable};
