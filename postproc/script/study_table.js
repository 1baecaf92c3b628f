/* The table of designs. */
import {number, escape} from "./numbers.js";
import {$} from "./chart.js";
import {
  D, CHARTS, best, keys, outputs, state, ids, active, section, DONE, STATES
} from "./study_state.js";
import {choose} from "./study_design.js";

const heads = [
  {name: "design", label: "design", list: ids, cell: i => String(i + 1)},
  ...keys.map(k => ({...k, cell: i => number(k.list[i] / k.scale, 5, false)})),
  ...outputs.map(o => ({...o, list: o.all, cell: i => number(o.all[i] / o.scale, 5, false)})), {
    name: "status",
    label: "status",
    list: D.status,
    words: true,
    cell: i => STATES[D.status[i]] + (D.reason[i] ? ": " + D.reason[i] : "")
  }
];
function sorted() {
  const list = ids.filter(active), h = heads[state.sort || 0], sign = state.down ? -1 : 1;
  return list.sort((a, b) => {
    const x = h.list[a], y = h.list[b];
    if (Number.isFinite(x) !== Number.isFinite(y)) return Number.isFinite(x) ? -1 : 1;
    return sign * (x - y) || a - b;
  });
}
function drawTable() {
  const list = sorted(), shown = list.slice(0, state.rows);
  $("heads").innerHTML =
      heads
          .map(
              (h, j) => `<th scope="col"${h.words ? " class=\"words\"" : ""}${
                  state.sort === j ? ` aria-sort="${state.down ? "descending" : "ascending"}"` :
                                     ""}
      title="${escape(h.name)}"><button type="button" data-sort="${j}">${
                  escape(h.label)}</button></th>`)
          .join("");
  $("rows").innerHTML =
      shown
          .map(
              i => `<tr data-design="${i}"${i === state.chosen ? " class=\"chosen\"" : ""}>${
                  heads
                      .map(
                          h => `<td${
                              h.words ? ` class="words${D.status[i] === DONE ? "" : " bad"}"` :
                                        ""}>${
                              h === heads[0] ?
                                  `<button type="button" class="key">${h.cell(i)}</button>` :
                                  escape(h.cell(
                                      i))}${h === heads[0] && i === best ? " ★" : ""}</td>`)
                      .join("")}</tr>`)
          .join("");
  $("all").hidden = shown.length >= list.length;
  $("all").textContent = `Show all ${list.length}`;
}
function csv() {
  const quote = s => /[",\r\n]/.test(s) ? `"${s.replace(/"/g, "\"\"")}"` : s,
        put = v => v === null ? "" : String(v);
  const names = [
    "design", ...D.keys.map(k => k.name), ...D.outputs.map(o => o.name),
    ...D.derivatives.map(d => "dpeak_d" + d.name), "status", "reason"
  ];
  const rows = sorted().map(
      i =>
          [String(i + 1), ...[...D.key, ...D.value, ...D.derivative].map(c => put(c[i])),
           STATES[D.status[i]], D.reason[i] || ""]);
  return [names, ...rows].map(r => r.map(quote).join(",")).join("\r\n") + "\r\n";
}
function buildTable() {
  section(
      "designs", "Designs", "Click a heading to sort, a row to see the design in every chart.",
      `<div class="scroll"><table><thead><tr id="heads"></tr></thead>
      <tbody id="rows"></tbody></table></div>
      <div class="row"><button type="button" id="all"></button><button type="button"
      id="csv">Download CSV</button><span class="note">The download holds the designs that are not
      filtered out, in SI units.</span></div>`);
  $("heads").onclick = e => {
    const j = e.target.dataset.sort;
    if (j === undefined) return;
    state.down = state.sort === +j ? !state.down : false;
    state.sort = +j;
    drawTable();
  };
  $("rows").onclick = e => {
    const row = e.target.closest("tr");
    if (row) choose(+row.dataset.design === state.chosen ? -1 : +row.dataset.design);
  };
  $("all").onclick = () => {
    state.rows = Infinity;
    drawTable();
  };
  $("csv").onclick = () => {
    const a = document.createElement("a");
    a.href = URL.createObjectURL(new Blob([csv()], {type: "text/csv"}));
    a.download = D.name + ".study.csv";
    a.click();
    URL.revokeObjectURL(a.href);
  };
  if (state.output)
    state.sort = heads.findIndex(h => h.name === state.output.name && h.kind === "output");
  CHARTS.push(drawTable);
}

export {buildTable};
