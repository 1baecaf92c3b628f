/* Columns of a study: keys and outputs, with names, units and ranges. */
import {NBSP, number, extent} from "./numbers.js";

/* The shortest end of a key that tells it from the others; indices keep their list. */
function shortNames(names) {
  const end = (name, n) => name.split(".").slice(-n).join(".");
  return names.map(name => {
    for (let n = 1; n < name.split(".").length; n++) {
      const short = end(name, n), before = name.split(".").slice(-n - 1)[0];
      if (!before.includes("[") && names.filter(o => end(o, n) === short).length === 1)
        return short;
    }
    return name;
  });
}
/* Decades where a range spans one and a third of the values lie in its lower half. */
function inDecades(values) {
  const known = values.filter(Number.isFinite), [lo, hi] = extent(known);
  return lo > 0 && hi >= 10 * lo &&
      3 * known.filter(v => v < Math.sqrt(lo * hi)).length >= known.length;
}
function column(head, values, short, kind) {
  const list = values.map(v => v === null ? NaN : v), known = list.filter(Number.isFinite),
        range = known.length ? extent(known) : [0, 1];
  return {
    ...head,
    short,
    kind,
    list,
    range,
    log: inDecades(list),
    many: range[1] > range[0],
    label: short + (head.unit ? ", " + head.unit : ""),
    text: (v, digits = 4) => head.name === "stable" && !Number.isFinite(v) ? "not judged" :
        number(v / head.scale, digits, false) +
        (head.unit && Number.isFinite(v) ? (head.unit === "°" ? "" : NBSP) + head.unit : "")
  };
}
/* Share of a column's range. */
function place(c, v) {
  if (!c.many) return 0.5;
  const [lo, hi] = c.range;
  return c.log ? Math.log(v / lo) / Math.log(hi / lo) : (v - lo) / (hi - lo);
}
const levels = c => [...new Set(c.list)].filter(Number.isFinite).sort((a, b) => a - b);

export {shortNames, column, place, levels};
