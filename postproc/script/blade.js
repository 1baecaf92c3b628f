/* The blade in motion: what is chosen, its picture, and how it is turned. */
import {NBSP, LENGTH, number, unit} from "./numbers.js";
import {$, show} from "./chart.js";
import {stillView} from "./still.js";
import {readBlade, ofMode, ofPoint, keptPoint, fieldOf, displacement} from "./motion.js";
import {BladePicture, rampStyle} from "./webgl.js";

const PRESSURE = [["GPa", 1e9], ["MPa", 1e6], ["kPa", 1e3], ["Pa", 1]];
const AT_FIRST = {yaw: 0.7, tilt: 0.3, zoom: 1, x: 0, y: 0};
const NO_WEBGL =
  "The surface of the mesh. It moves in a browser with WebGL 2; this one has none.";
const STEP = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1]};

class BladeView {
  constructor(blade, gl) {
    Object.assign(this, {
      blade, picture: new BladePicture($("blade-canvas"), gl, blade), camera: {...AT_FIRST},
      point: null, pointName: "", motion: null, field: null, time: 0, /* periods */
      playing: !window.matchMedia("(prefers-reduced-motion: reduce)").matches, visible: false,
      last: 0, ticking: false
    });
    $("blade-canvas").hidden = $("blade-bar").hidden = false;
    $("blade-still").hidden = true;
    $("blade-bar").querySelector("i").style.background = rampStyle;
    this.fill("0");
    this.wireControls();
    this.wireCanvas();
    queueMicrotask(() => this.motion || this.load()); /* unless the page chooses a point at once */
  }
  /* ---------------------------------------------------------------- what is shown */
  fill(chosen) {
    const {blade, point} = this, of = m => blade.waves ? `, n = ${blade.waves[m.wave]}` : "";
    const list = blade.modes.map(
      (m, i) => [i, `mode ${i % blade.row + 1}${of(m)}, ${number(m.f, 5)} Hz`]);
    if (point) list.unshift(["point", "the chosen point"]);
    $("blade-shown").innerHTML =
      list.map(([v, text]) => `<option value="${v}">${text}</option>`).join("");
    $("blade-shown").value = chosen;
  }
  load() {
    const key = $("blade-shown").value, colour = $("blade-colour").value;
    this.motion = key === "point" && this.point ?
      ofPoint(this.blade, this.point, this.pointName) :
      ofMode(this.blade, Math.max(0, +key || 0));
    this.field = fieldOf(this.blade, this.motion, colour);
    const list = colour === "motion" ? LENGTH : PRESSURE, w = unit(list, this.field.top);
    const [low, high] = $("blade-bar").querySelectorAll("span");
    low.textContent = colour === "motion" ? "displacement, amplitude 0" : "von Mises stress 0";
    high.textContent = this.motion.real ? number(this.field.top / w[1], 3) + NBSP + w[0] :
      "largest";
    this.picture.upload(this.field);
    this.draw();
    this.note();
  }
  /* How many times as large the motion is drawn. */
  factor() { return $("blade-scale").value / 100 * 0.3 * this.blade.radius / this.field.most; }
  note() {
    const text = [this.motion.name], u = unit(LENGTH, this.field.most);
    if (this.motion.real)
      text.push(
        `largest displacement ${number(this.field.most / u[1], 3)}${NBSP}${u[0]}, drawn ×${
          number(this.factor(), 2, false)}`,
        "sum of the modes in this page: stress is the vibration's, to about 1 % of the " +
        "largest, without the static share of higher modes");
    if (this.blade.modesLeftOut) text.push(`${this.blade.modesLeftOut} higher modes left out`);
    $("blade-note").textContent = text.join("; ") + ".";
  }
  draw() {
    if (this.field)
      this.picture.draw(this.motion, this.camera, $("blade-ring").value, this.time, this.factor());
  }
  /* The kept point of branch b nearest to abscissa x and amplitude a becomes the chosen one. */
  choose(b, x, a, name) {
    const best = keptPoint(this.blade, b, x, a), first = !this.point;
    if (!best) return;
    this.point = best;
    this.pointName = name(best.x);
    this.fill(first ? "point" : $("blade-shown").value);
    if ($("blade-shown").value === "point") this.load();
  }
  /* Displacement [node][3], m, of a blade in its own place, at an instant 0..1 of the period. */
  motionOf(which, instant) {
    return displacement(this.blade, this.motion, this.field.harmonics, which, instant);
  }
  dataUrl() {
    this.draw();
    return $("blade-canvas").toDataURL("image/png");
  }
  /* A copy of the picture that a printer gets: it has none of WebGL. */
  print() {
    const from = $("blade-canvas"), to = $("blade-print");
    this.draw();
    to.width = from.width;
    to.height = from.height;
    to.getContext("2d").drawImage(from, 0, 0);
  }
  /* ---------------------------------------------------------------- time */
  tick(now) {
    this.ticking = this.playing && this.visible;
    if (!this.ticking) return;
    this.time += Math.min(0.1, (now - this.last) / 1000) / 2 * this.motion.order;
    this.last = now;
    this.draw();
    requestAnimationFrame(t => this.tick(t));
  }
  run() {
    $("blade-play").textContent = this.playing ? "Pause" : "Play";
    if (this.ticking || !this.playing || !this.visible || !this.motion) return;
    this.ticking = true;
    this.last = performance.now();
    requestAnimationFrame(t => this.tick(t));
  }
  /* ---------------------------------------------------------------- controls */
  wireControls() {
    $("blade-shown").onchange = $("blade-colour").onchange = () => this.load();
    $("blade-scale").oninput = () => {
      this.note();
      this.draw();
    };
    if (this.blade.blades < 2) $("blade-ring").parentElement.hidden = true;
    $("blade-ring").onchange = () => this.draw();
    $("blade-play").onclick = () => {
      this.playing = !this.playing;
      this.run();
    };
    $("blade-home").onclick = () => {
      Object.assign(this.camera, AT_FIRST);
      this.draw();
    };
    new IntersectionObserver(entries => {
      this.visible = entries[entries.length - 1].isIntersecting;
      this.run();
    }).observe($("blade-canvas"));
  }
  turn(yaw, tilt) {
    this.camera.yaw += yaw;
    this.camera.tilt = Math.max(-1.5, Math.min(1.5, this.camera.tilt + tilt));
  }
  drag(fingers, e, before) {
    const dx = e.clientX - before[0], dy = e.clientY - before[1], {camera} = this;
    const spread = () => {
      const [a, b] = [...fingers.values()];
      return Math.hypot(a[0] - b[0], a[1] - b[1]);
    };
    const old = fingers.size === 2 ? spread() : 0;
    fingers.set(e.pointerId, [e.clientX, e.clientY]);
    if (fingers.size === 2) {
      camera.zoom *= spread() / Math.max(old, 1);
    } else if (e.shiftKey) {
      camera.x += 2 * dx / $("blade-canvas").clientWidth;
      camera.y -= 2 * dy / $("blade-canvas").clientHeight;
    } else {
      this.turn(0.01 * dx, 0.01 * dy);
    }
    this.draw();
  }
  wireCanvas() {
    const canvas = $("blade-canvas"), fingers = new Map();
    canvas.addEventListener("pointerdown", e => {
      fingers.set(e.pointerId, [e.clientX, e.clientY]);
      if (e.isTrusted) canvas.setPointerCapture(e.pointerId);
    });
    canvas.addEventListener("pointermove", e => {
      const before = fingers.get(e.pointerId);
      if (before) this.drag(fingers, e, before);
    });
    for (const type of ["pointerup", "pointercancel", "lostpointercapture"])
      canvas.addEventListener(type, e => fingers.delete(e.pointerId));
    canvas.addEventListener("wheel", e => {
      e.preventDefault();
      const zoom = this.camera.zoom * Math.exp(-0.0015 * e.deltaY);
      this.camera.zoom = Math.max(0.3, Math.min(30, zoom));
      this.draw();
    }, {passive: false});
    canvas.addEventListener("keydown", e => {
      if (!STEP[e.key]) return;
      this.turn(...STEP[e.key]);
      e.preventDefault();
      this.draw();
    });
  }
}

/* Shows the blade of a page (report.blade); null: only the still one, without WebGL. */
function openBlade(data) {
  const blade = readBlade(data), gl = $("blade-canvas").getContext("webgl2", {antialias: true});
  show("still", stillView(blade.base, blade.index, blade.axis));
  if (gl) return new BladeView(blade, gl);
  $("blade-note").textContent = NO_WEBGL;
  for (const e of document.querySelectorAll("#blade .tools, #blade .hint")) e.remove();
  return null;
}

export {openBlade};
