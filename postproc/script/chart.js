/* Charts in the page: their SVG elements, and how they are saved. */
import {table} from "./panel.js";

const $ = id => document.getElementById(id);
const shown = {}; /* panels of the charts drawn last */
const widthOf = id => Math.max(300, Math.round($(id).parentElement.clientWidth || 1100));

/* Replace a chart's SVG by a view {height, panels, extra, width}; title and description remain. */
function show(id, {height, panels, extra = "", width = widthOf(id)}) {
  shown[id] = panels;
  const svg = $(id),
    keep = [...svg.querySelectorAll("title, desc")].map(e => e.outerHTML).join("");
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.innerHTML = keep + panels.map(p => p.svg).join("") + extra;
}

/* A chart as a picture of its own, with the style of the page. */
function picture(id) {
  const svg = $(id), copy = svg.cloneNode(true);
  const [, , w, h] = svg.getAttribute("viewBox").split(" ");
  for (const e of copy.querySelectorAll("#hover")) e.remove();
  copy.setAttribute("width", w);
  copy.setAttribute("height", h);
  const style = document.createElementNS(svg.namespaceURI, "style");
  style.textContent = [...document.querySelectorAll("style")].map(e => e.textContent).join("");
  const paper = document.createElementNS(svg.namespaceURI, "rect");
  paper.setAttribute("width", "100%");
  paper.setAttribute("height", "100%");
  paper.setAttribute("style", "fill:var(--card)");
  copy.prepend(style, paper);
  return new XMLSerializer().serializeToString(copy);
}
function save(name, data, type) {
  const link = document.createElement("a");
  link.download = name;
  link.href = type ? URL.createObjectURL(new Blob([data], {type})) : data;
  link.click();
  if (type) setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
/* Twice the size in the page, as a data URL. */
async function raster(id) {
  const image = new Image(), text = picture(id);
  image.src = "data:image/svg+xml;charset=utf-8," + encodeURIComponent(text);
  await image.decode();
  const canvas = document.createElement("canvas");
  canvas.width = 2 * image.width;
  canvas.height = 2 * image.height;
  canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
  return canvas.toDataURL("image/png");
}
/* Buttons below every chart of the page. name: of the files. */
function offer(name) {
  for (const svg of document.querySelectorAll(".chart > svg.plot")) {
    const id = svg.id, box = document.createElement("div"), file = `${name}_${id}`;
    box.className = "export";
    const add = (word, act) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = word;
      button.title = `Save this chart as ${word}`;
      button.dataset.save = word;
      button.onclick = act;
      box.append(button);
    };
    add("SVG", () => save(file + ".svg", picture(id), "image/svg+xml"));
    add("PNG", async () => save(file + ".png", await raster(id)));
    if (shown[id]) add("CSV", () => save(file + ".csv", table(shown[id]), "text/csv"));
    svg.parentElement.append(box);
  }
}
/* Draws anew for a printer: what a canvas holds has the colours of the screen. */
function wirePrint(draw) {
  const set = on => () => {
    document.documentElement.classList.toggle("printing", on);
    draw();
  };
  window.addEventListener("beforeprint", set(true));
  window.addEventListener("afterprint", set(false));
}
/* The numbers of the page. */
const readData = () => JSON.parse($("data").textContent);

export {$, shown, widthOf, show, picture, save, raster, offer, wirePrint, readData};
