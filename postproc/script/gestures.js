/* Mouse, touch, wheel and keyboard of the main chart. chart: what they act on (report_page.js). */
const ENOUGH = 6, TALL = 14; /* px of a drag: along x, and for the amplitude too */
const TAP = 12; /* px that a finger may move in a tap */

/* The rectangle between two corners, px; a flat one has the whole height, a narrow one the whole
 * width of the box. */
function rectangle(box, [x0, y0], [x1, y1]) {
  const flat = Math.abs(y1 - y0) < TALL, narrow = Math.abs(x1 - x0) <= ENOUGH;
  return {
    flat, narrow, left: narrow ? box.left : Math.min(x0, x1),
    top: flat ? box.top : Math.min(y0, y1),
    width: narrow ? box.width : Math.abs(x1 - x0), height: flat ? box.height : Math.abs(y1 - y0)
  };
}
/* Zoom into a rectangle: a flat one keeps the amplitudes, a narrow one the abscissa. */
function zoomTo(chart, r) {
  const p = chart.panel(), [x, y] = chart.zoom();
  chart.setZoom(r.narrow ? x : [p.value(r.left), p.value(r.left + r.width)],
    r.flat ? y : [p.valueY(r.top + r.height), p.valueY(r.top)]);
}
/* Both ranges by factors about a place, px. */
function zoomBy(chart, [x, y], factorX, factorY) {
  const p = chart.panel(), b = p.box, [least, most] = chart.range;
  const scaled = (end, at, factor) => at + (end - at) * factor;
  const xs = [b.left, b.left + b.width].map(v => p.value(scaled(v, x, factorX)));
  const ys = [b.top + b.height, b.top].map(v => p.valueY(scaled(v, y, factorY)));
  const range = [Math.max(xs[0], least), Math.min(xs[1], most)];
  const whole = range[0] <= least && range[1] >= most;
  if (whole && factorX > 1) chart.setZoom(null);
  else if (range[1] - range[0] > 1e-7 * (most - least))
    chart.setZoom(whole ? null : range, p.ay.log || ys[0] >= 0 ? ys : [0, ys[1]]);
}

/* Fingers: one that taps reads and chooses a point, two zoom. */
class Touch {
  constructor(chart, clamp) {
    Object.assign(this, {chart, clamp, fingers: new Map(), spread: 0, tapped: null});
  }
  down(id, at) {
    this.fingers.set(id, at);
    this.tapped = this.fingers.size === 1 ? at : null;
    this.spread = 0;
  }
  move(id, [x, y]) {
    if (!this.fingers.has(id)) return;
    this.fingers.set(id, [x, y]);
    if (this.tapped && Math.hypot(x - this.tapped[0], y - this.tapped[1]) > TAP)
      this.tapped = null;
    if (this.fingers.size === 2) this.pinch();
  }
  pinch() {
    const [p, q] = [...this.fingers.values()], size = Math.hypot(p[0] - q[0], p[1] - q[1]);
    const middle = [(p[0] + q[0]) / 2, (p[1] + q[1]) / 2], factor = this.spread / size;
    if (this.spread > 0 && size > 0) zoomBy(this.chart, this.clamp(middle), factor, factor);
    this.spread = size;
  }
  /* True if the pointer is a finger of the chart. */
  up(id, ended) {
    if (!this.fingers.delete(id)) return false;
    this.spread = 0;
    if (ended && this.tapped) {
      this.chart.point(...this.tapped);
      this.chart.choose();
    }
    this.tapped = null;
    return true;
  }
}

function wireChart(chart) {
  const svg = chart.element, box = () => chart.panel().box;
  const local = e => {
    const r = svg.getBoundingClientRect(), s = chart.width() / r.width;
    return [(e.clientX - r.left) * s, (e.clientY - r.top) * s];
  };
  const clamp = ([x, y]) => [
    Math.max(box().left, Math.min(box().left + box().width, x)),
    Math.max(box().top, Math.min(box().top + box().height, y))
  ];
  const touch = new Touch(chart, clamp);
  let from = null; /* where a drag began */
  const dragged = to => from && Math.hypot(to[0] - from[0], to[1] - from[1]) > ENOUGH;
  svg.setAttribute("tabindex", "0");
  svg.addEventListener("pointerdown", e => {
    if (e.pointerType === "touch") {
      touch.down(e.pointerId, local(e));
    } else if (e.button === 0) {
      from = clamp(local(e));
      e.preventDefault();
      svg.focus({preventScroll: true});
    }
  });
  svg.addEventListener("pointermove", e => {
    const at = local(e);
    touch.move(e.pointerId, at);
    if (dragged(at)) chart.band(rectangle(box(), from, clamp(at)));
    else if (touch.fingers.size < 2)
      svg.style.cursor = chart.point(...at) ? "pointer" : "crosshair";
  });
  window.addEventListener("pointerup", e => {
    if (touch.up(e.pointerId, true) || !from) return;
    const to = clamp(local(e)), start = from, far = dragged(to);
    from = null;
    if (far) zoomTo(chart, rectangle(box(), start, to));
    else chart.choose();
  });
  window.addEventListener("pointercancel", e => touch.up(e.pointerId, false));
  svg.addEventListener("wheel", e => {
    if (document.activeElement !== svg && !e.ctrlKey) return; /* else the page scrolls */
    e.preventDefault();
    const factor = Math.exp(0.0015 * e.deltaY);
    zoomBy(chart, clamp(local(e)), factor, e.shiftKey ? 1 : factor);
  }, {passive: false});
  svg.addEventListener("pointerleave", () => from || chart.leave());
  svg.addEventListener("dblclick", () => chart.setZoom(null));
  svg.addEventListener("keydown", e => {
    if (chart.key(e.key, e.shiftKey)) e.preventDefault();
  });
}

export {rectangle, zoomTo, zoomBy, Touch, wireChart};
