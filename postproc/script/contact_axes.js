/* The axes of the contact, seen from outside and along the engine axis. */
import {number, escape} from "./numbers.js";

const f = v => v.toFixed(1);

function arrow(x, y, dx, dy, classes, name) {
  const length = Math.hypot(dx, dy), c = dx / length, s = dy / length, tx = x + dx, ty = y + dy;
  const level = classes === "other" && dy === 0; /* a long name beside the tip of a level arrow */
  return `<path class="axis-line ${classes}" d="M${f(x)} ${f(y)}L${f(tx)} ${f(ty)}M${
    f(tx - 8 * c - 4 * s)} ${f(ty - 8 * s + 4 * c)}L${f(tx)} ${f(ty)}L${f(tx - 8 * c + 4 * s)} ${
    f(ty - 8 * s - 4 * c)}"/><text class="axis" x="${f(tx + (level ? 6 : 14 * c))}" y="${
    f(ty + 14 * s + 4)}" text-anchor="${level ? "start" : "middle"}">${escape(name)}</text>`;
}
/* Arc about (x, y) from the horizontal to an angle, rad, up in the picture; it is named with a
 * value, rad. */
function arc(x, y, angle, value, name) {
  const radius = 52, degrees = Math.round(value * 180e3 / Math.PI) / 1e3;
  const flat = Math.abs(angle) < 0.25; /* no space beside the axis */
  const path = Math.abs(angle) > 1e-3 ? `<path class="arc" d="M${f(x + radius)} ${
    f(y)}A${radius} ${radius} 0 0 ${+(angle < 0)} ${f(x + radius * Math.cos(angle))} ${
    f(y - radius * Math.sin(angle))}"/>` : "";
  return path + `<text class="axis" x="${f(x + (radius + 10) * Math.cos(angle / 2))}" y="${
    f(flat ? y - 12 : y - (radius + 10) * Math.sin(angle / 2) + 4)}">${name} = ${
    number(degrees, 4, false)}°</text>`;
}
/* Both shrouds beside the line of contact through (x, y), whose direction is (along, up). */
function shrouds(x, y, along, up, half) {
  const dx = half * along, dy = half * up;
  const side = wide => `<path class="shroud" d="M${f(x + dx)} ${f(y - dy)}L${f(x - dx)} ${
    f(y + dy)}L${f(x + wide)} ${f(y + dy)}L${f(x + wide)} ${f(y - dy)}Z"/>`;
  return side(-130) + side(130) + `<path class="face" d="M${f(x + dx)} ${f(y - dy)}L${f(x - dx)} ${
    f(y + dy)}"/>`;
}
const caption = (x, text) => `<text class="tick" x="${x}" y="16">${text}</text>`;

/* Angles psi and phi of the contact, rad. */
function axesView({psi, phi}) {
  const c = Math.cos(psi), s = Math.sin(psi), cp = Math.cos(phi), sp = Math.sin(phi);
  const extra = [
    shrouds(180, 160, -s, c, 80 / Math.max(c, 0.3)), arrow(180, 160, 92 * c, -92 * s, "v", "v"),
    arrow(180, 160, -92 * s, -92 * c, "u", "u"), arc(180, 160, psi, psi, "ψ"),
    arrow(20, 284, 60, 0, "other", "tangential"), arrow(20, 284, 0, -44, "other", "axial"),
    shrouds(540, 160, sp, cp, 34), arrow(540, 160, 92 * cp, 92 * sp, "v", "v"),
    arrow(540, 160, 92 * sp, -92 * cp, "w", "w"), arc(540, 160, -phi, phi, "φ"),
    arrow(380, 284, 60, 0, "other", "tangential"), arrow(380, 284, 0, -44, "other", "radial"),
    caption(60, "from outside: this blade left, its right neighbour right"),
    caption(430, "along the engine axis")
  ];
  return {width: 720, height: 300, panels: [], extra: extra.join("")};
}

export {axesView};
