/* Uses every control of a report page, then writes into the title which charts there are and what
 * was wrong. */
(() => {
  const $ = id => document.getElementById(id), faults = [];
  const send = (target, type, x, y, more) => target.dispatchEvent(new PointerEvent(
      type, {clientX: x, clientY: y, button: 0, pointerId: 1, bubbles: true, ...more}));
  const drawn = id => $(id) && $(id).querySelectorAll("path.line, rect.bar, circle").length;
  const changes = (what, id, act) => {
    const before = $(id).innerHTML;
    act();
    if ($(id).innerHTML === before) faults.push(`${what} changes nothing in ${id}`);
  };
  const charts = [...document.querySelectorAll("svg.plot")].map(s => s.id);
  for (const id of charts)
    if (!drawn(id) && !/not in this page/.test($(id).textContent))
      faults.push(`nothing drawn in ${id}`);
  for (const svg of document.querySelectorAll("svg.plot"))
    if (/NaN|undefined|Infinity/.test(svg.innerHTML)) faults.push(`NaN in ${svg.id}`);
  /* selects */
  for (const id of ["place", "axis", "curve", "pair"])
    if ($(id))
      for (const o of [...$(id).options].map(e => e.value)) {
        $(id).value = o;
        $(id).dispatchEvent(new Event("change"));
      }
  for (const b of document.querySelectorAll("[data-quantity],[data-scale]")) b.click();
  for (const b of document.querySelectorAll("button.key")) {
    changes("key " + b.textContent, "response", () => b.click());
    b.click();
  }
  /* read and choose points */
  const svg = $("response"), r = svg.getBoundingClientRect();
  let read = 0, chosen = new Set();
  for (let t = 0.08; t < 0.96; t += 0.02)
    for (let s = 0.1; s < 0.9; s += 0.1) {
      const x = r.left + t * r.width, y = r.top + s * r.height;
      send(svg, "pointermove", x, y);
      if ($("readout").hidden) continue;
      read++;
      if (read % 9) continue;
      send(svg, "pointerdown", x, y);
      send(window, "pointerup", x, y);
      if ($("point-where")) chosen.add($("point-where").textContent);
    }
  if (!read) faults.push("no point can be read");
  if ($("point") && chosen.size < 2) faults.push("a click chooses no point");
  /* zoom and back */
  const zoom = () => {
    send(svg, "pointerdown", r.left + 0.4 * r.width, r.top + 0.3 * r.height);
    send(svg, "pointermove", r.left + 0.6 * r.width, r.top + 0.6 * r.height);
    send(window, "pointerup", r.left + 0.6 * r.width, r.top + 0.6 * r.height);
  };
  changes("drag", "response", zoom);
  changes("double click", "response", () => svg.dispatchEvent(new MouseEvent("dblclick")));
  zoom();
  changes("Whole range", "response", () => $("whole").click());
  /* keyboard */
  for (const key of ["ArrowRight", "ArrowUp", "ArrowDown", "ArrowLeft", "Enter", "Escape"])
    svg.dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true}));
  if (!$("spoken").textContent) faults.push("the keyboard says nothing");
  window.dispatchEvent(new Event("resize"));
  for (const e of document.querySelectorAll("svg.plot"))
    if (/NaN|undefined|Infinity/.test(e.innerHTML)) faults.push(`NaN in ${e.id} at the end`);
  document.title = "seen " + JSON.stringify({charts, faults});
})();
