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
    if (!["still", "contact-axes"].includes(id) && !drawn(id) && !/not in this page/.test($(id).textContent))
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
  for (let t = 0.08; t < 0.96; t += 0.04)
    for (let s = 0.1; s < 0.9; s += 0.2) {
      const x = r.left + t * r.width, y = r.top + s * r.height;
      send(svg, "pointermove", x, y);
      if ($("readout").hidden) continue;
      read++;
      if (read % 5) continue;
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
  /* a wide flat rectangle keeps the amplitudes, a tall one does not; the wheel in the chart */
  const ticks = () => [...svg.querySelectorAll("text.tick")].map(t => t.textContent).join();
  const wheel = deltaY => svg.dispatchEvent(new WheelEvent("wheel", {
    deltaY, clientX: r.left + 0.5 * r.width, clientY: r.top + 0.5 * r.height, bubbles: true,
    cancelable: true, ctrlKey: true
  }));
  const before = ticks();
  zoom();
  const sides = ticks();
  if (sides === before) faults.push("a rectangle does not zoom");
  wheel(-400);
  if (ticks() === sides) faults.push("the wheel does not zoom");
  for (let i = 0; i < 12; i++) wheel(800);
  if (ticks() !== before) faults.push("the wheel does not come back to the whole range");
  /* touch: a tap chooses, two fingers zoom */
  const touch = (type, id, x, y) => svg.dispatchEvent(new PointerEvent(type, {
    pointerType: "touch", pointerId: id, clientX: r.left + x * r.width,
    clientY: r.top + y * r.height, bubbles: true
  }));
  touch("pointerdown", 11, 0.4, 0.5);
  touch("pointerdown", 12, 0.6, 0.5);
  touch("pointermove", 12, 0.62, 0.5);
  touch("pointermove", 12, 0.8, 0.5);
  if (ticks() === before) faults.push("two fingers do not zoom");
  touch("pointerup", 11, 0.4, 0.5);
  touch("pointerup", 12, 0.8, 0.5);
  $("whole").click();
  /* every chart can be saved */
  const saved = [];
  HTMLAnchorElement.prototype.click = function() { saved.push(this.download); };
  for (const b of document.querySelectorAll("[data-save]"))
    if (b.dataset.save !== "PNG") b.click();
  const wanted = document.querySelectorAll('[data-save="SVG"],[data-save="CSV"]').length;
  if (!wanted || saved.length !== wanted) faults.push(`${saved.length} of ${wanted} files saved`);
  const rows = module_panel.table(module_chart.shown.response).split("\n");
  if (rows.length < 50 || rows.some(l => l && l.split(",").length < 4))
    faults.push(`table of ${rows.length} rows`);
  if (!/^<svg[^>]*xmlns=/.test(module_chart.picture("response"))) faults.push("no picture of the chart");
  /* keyboard */
  for (const key of ["ArrowRight", "ArrowUp", "ArrowDown", "ArrowLeft", "Enter", "Escape"])
    svg.dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true}));
  if (!$("spoken").textContent) faults.push("the keyboard says nothing");
  window.dispatchEvent(new Event("resize"));
  /* the blade: every control changes the picture, which is neither empty nor full */
  let pictures;
  const Blade = module_report_page.blade;
  if (Blade) {
    const gl = $("blade-canvas").getContext("webgl2"), seen = new Set();
    const look = what => {
      const {width, height} = $("blade-canvas"), data = new Uint8Array(4 * width * height);
      Blade.draw();
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, data);
      let drawn = 0, sum = 0;
      for (let i = 0; i < data.length; i += 4) {
        drawn += data[i + 3] > 0;
        sum = (sum * 31 + data[i] + 7 * data[i + 1] + 13 * data[i + 2]) % 4294967291;
      }
      const share = 4 * drawn / data.length;
      if (!(share > 0.01 && share < 0.9)) faults.push(`${what}: ${share} of the picture drawn`);
      if (seen.has(sum)) faults.push(`${what} changes nothing in the picture`);
      seen.add(sum);
    };
    const set = (id, value, type = "change") => {
      $(id).value = value;
      $(id).dispatchEvent(new Event(type));
      look(`${id} = ${value}`);
    };
    look("at first");
    set("blade-shown", "0");
    set("blade-shown", "3");
    set("blade-colour", "motion");
    set("blade-scale", "90", "input");
    set("blade-ring", "1");
    set("blade-ring", "all");
    set("blade-ring", "3");
    const c = $("blade-canvas"), b = c.getBoundingClientRect();
    send(c, "pointerdown", b.left + 100, b.top + 100);
    send(c, "pointermove", b.left + 180, b.top + 130);
    send(c, "pointerup", b.left + 180, b.top + 130);
    look("a turn");
    c.dispatchEvent(new WheelEvent("wheel", {deltaY: -300, bubbles: true, cancelable: true}));
    look("the wheel");
    c.dispatchEvent(new KeyboardEvent("keydown", {key: "ArrowUp", bubbles: true}));
    look("a key");
    const word = $("blade-play").textContent;
    $("blade-play").click();
    if ($("blade-play").textContent === word) faults.push("the motion cannot be stopped");
    if (!Blade.dataUrl().startsWith("data:image/png")) faults.push("no picture of the blade");
    /* paper gets a copy of the picture, in a canvas that is not WebGL's */
    window.dispatchEvent(new Event("beforeprint"));
    const paper = $("blade-print");
    const inked = paper.getContext("2d").getImageData(0, 0, paper.width || 1, paper.height || 1)
        .data.filter((v, i) => i % 4 === 3 && v > 0).length / (paper.width * paper.height);
    if (!(inked > 0.01 && inked < 0.9)) faults.push(`${inked} of the printed picture drawn`);
    if (!document.documentElement.classList.contains("printing")) faults.push("no paper");
    window.dispatchEvent(new Event("afterprint"));
    if (document.documentElement.classList.contains("printing")) faults.push("paper stays");
    $("blade-home").click();
    pictures = seen.size;
  }
  for (const e of document.querySelectorAll("svg.plot"))
    if (/NaN|undefined|Infinity/.test(e.innerHTML)) faults.push(`NaN in ${e.id} at the end`);
  document.title = "seen " + JSON.stringify({charts, faults, pictures, speeds: !!$("rpm")});
})();
