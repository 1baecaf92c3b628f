/* Chooses points of the first curve by the keyboard, and every contact there. Chooses the motion of
 * some places along every axis. Leaves in the title what the page says and draws. */
(() => {
  const $ = id => document.getElementById(id), svg = $("response"), seen = [];
  const press = (key, shiftKey) =>
      svg.dispatchEvent(new KeyboardEvent("keydown", {key, shiftKey, bubbles: true}));
  const take = (id, value) => {
    $(id).value = value;
    $(id).dispatchEvent(new Event("change"));
  };
  const values = id => [...$(id).options].map(e => e.value);
  const charts = ["loop-u", "loop-w", "path", "period", "spectrum"];
  const look = end => seen.push({
    end,
    branch: +$("curve").value,
    point: $("point-where").textContent,
    contact: $("contact-where").textContent,
    name: $("pair").selectedOptions.length ? $("pair").selectedOptions[0].textContent : "contact",
    tables: Object.fromEntries(charts.map(id => [id, module_panel.table(module_chart.shown[id])]))
  });
  const contacts = end => {
    for (const o of values("pair")) {
      take("pair", o);
      look(end);
    }
  };
  /* Each place, axis and quantity, and what is said of the point then. */
  const outputs = () => {
    const list = [], places = values("place");
    for (const place of new Set([places[0], places[1], places.at(-1)])) {
      take("place", place);
      for (const axis of values("axis")) {
        take("axis", axis);
        for (const button of document.querySelectorAll("[data-quantity]")) {
          if (button.disabled) continue;
          button.click();
          list.push({place, axis, quantity: button.dataset.quantity, point: $("point-where").textContent});
        }
      }
    }
    take("place", places[0]);
    seen.at(-1).outputs = list;
  };
  contacts(); /* at the highest point, which the page begins with */
  for (let step = 0; step < 5; step++) {
    for (let i = 0; i < 3; i++) press("ArrowRight");
    press("Enter");
    contacts();
  }
  for (const [end, key] of [["first", "ArrowLeft"], ["last", "ArrowRight"]]) {
    for (let i = 0; i < 60; i++) press(key, true); /* ten points each */
    press("Enter");
    contacts(end);
  }
  outputs();
  document.title = "seen " + JSON.stringify(seen);
})();
