/* Chooses points of the first curve by the keyboard, and every contact there. Leaves in the title what
 * the page says and draws. */
(() => {
  const $ = id => document.getElementById(id), svg = $("response"), seen = [];
  const press = key => svg.dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true}));
  const charts = ["loop-u", "loop-w", "path", "period", "spectrum"];
  const look = () => seen.push({
    branch: +$("curve").value,
    point: $("point-where").textContent,
    contact: $("contact-where").textContent,
    name: $("pair").selectedOptions.length ? $("pair").selectedOptions[0].textContent : "contact",
    tables: Object.fromEntries(charts.map(id => [id, Plot.table(id)]))
  });
  const contacts = () => {
    for (const o of [...$("pair").options].map(e => e.value)) {
      $("pair").value = o;
      $("pair").dispatchEvent(new Event("change"));
      look();
    }
  };
  contacts(); /* at the highest point, which the page begins with */
  for (let step = 0; step < 5; step++) {
    for (let i = 0; i < 3; i++) press("ArrowRight");
    press("Enter");
    contacts();
  }
  document.title = "seen " + JSON.stringify(seen);
})();
