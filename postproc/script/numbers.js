/* Numbers as text, units, and numbers from base64. */
const NBSP = "\u00a0";
const LENGTH = [["m", 1], ["mm", 1e-3], ["µm", 1e-6], ["nm", 1e-9], ["pm", 1e-12]];
const ENERGY = [["kJ", 1e3], ["J", 1], ["mJ", 1e-3], ["µJ", 1e-6], ["nJ", 1e-9]];
const FORCE = [["MN", 1e6], ["kN", 1e3], ["N", 1], ["mN", 1e-3], ["µN", 1e-6]];

const superscript = n => String(n).replace("-", "⁻").replace(/\d/g, d => "⁰¹²³⁴⁵⁶⁷⁸⁹"[d]);

/* A value with so many significant digits; keep: trailing zeros too. */
function number(value, digits, keep = true) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const power = Math.floor(Math.log10(Math.abs(value)) + 1e-12);
  let text;
  if (power < -4 || power >= Math.max(digits, 6)) {
    const mantissa = (value / 10 ** power).toFixed(Math.max(digits - 1, 0));
    text = (keep ? mantissa : String(+mantissa)) + "×10" + superscript(power);
  } else {
    text = (+value.toPrecision(digits)).toFixed(Math.max(0, digits - 1 - power));
    if (!keep) text = String(+text);
  }
  return text.replace("-", "−");
}

/* The unit [name, scale] of a list in which the largest value is written. */
function unit(list, largest) {
  if (!(largest > 0)) return list[2];
  return list.find(u => largest >= 0.9995 * u[1]) || list[list.length - 1];
}
/* Newtons up to 10 kN, as tables have them. */
const forceUnit = largest =>
  largest >= 1 && largest < 1e4 ? FORCE[2] : unit(FORCE, largest);

const percent = x => Number.isFinite(x) ? number(100 * x, 2, false) + NBSP + "%" : "–";
const escape = s => s.replace(/[&<>"']/g, c => "&#" + c.charCodeAt(0) + ";");
const unique = list => [...new Set(list)];

/* [least, largest]; values that are no numbers do not count. */
function extent(list, pick = x => x) {
  let lo = Infinity, hi = -Infinity;
  for (const e of list) {
    const v = pick(e);
    if (v < lo) lo = v;
    if (v > hi) hi = v;
  }
  return [lo, hi];
}

/* The bytes of a text in base64. */
function bytes(text) {
  const all = atob(text), out = new Uint8Array(all.length);
  for (let i = 0; i < all.length; i++) out[i] = all.charCodeAt(i);
  return out;
}
/* Numbers of a type (Float32Array, …) from base64, least significant byte first. */
function decode(text, Type) {
  const b = bytes(text);
  return new Type(b.buffer, 0, Math.floor(b.length / Type.BYTES_PER_ELEMENT));
}

export {
  NBSP, LENGTH, ENERGY, FORCE, number, unit, forceUnit, percent, escape, unique, extent, decode
};
