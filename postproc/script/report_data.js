/* The numbers of a report page (report.schema.json), decoded. */
import {NBSP, number, decode} from "./numbers.js";
import {around} from "./axes.js";

const FORMAT = "shroudhb report page", VERSION = 1;
const STATES = ["stuck", "slipping", "open"];

/* Rows of numbers as objects; names: of their columns. */
const named = (names, rows) =>
  (rows || []).map(r => Object.fromEntries(names.map((n, i) => [n, r[i]])));
/* {word: code} as a function from code to word. */
const wordsOf = codes => {
  const words = new Map(Object.entries(codes).map(([word, code]) => [code, word]));
  return code => words.get(code) || "";
};

function readBranch(b, d, words) {
  const all = decode(b.data, Float32Array), {mark} = d.codes;
  const row = r => all.subarray(r * b.n, (r + 1) * b.n), field = name => row(d.fields[name]);
  const marked = bit => Array.from(field("mark"), m => (m & bit) !== 0);
  return {
    ...b, row, at: field("abscissa"), shares: STATES.map(field),
    energy: field("dissipation"), error: field("error"),
    verdict: Array.from(field("stability"), words.stability),
    special: Array.from(field("special"), words.special),
    above: marked(mark.aboveTolerance), undetermined: marked(mark.undetermined),
    notJudged: marked(mark.notJudged), group: d.groups[b.group], groupIndex: b.group,
    lasting: named(d.columns.lasting, b.lasting)
  };
}

/* What the charts need, from the JSON of the page. */
function readReport(d) {
  if (d.format !== FORMAT || d.version !== VERSION)
    throw new Error(`This script reads "${FORMAT}" ${VERSION}, not "${d.format}" ${d.version}.`);
  const words = {stability: wordsOf(d.codes.stability), special: wordsOf(d.codes.special)};
  const {track, peak, resonance} = d.columns;
  const places = (names, rows) => named(names, rows)
    .map(p => ({...p, group: d.groups[p.group], groupIndex: p.group}));
  const outputs = d.outputs.map(o => ({
    ...o, track: places(track, o.track), limits: places(peak, o.limits),
    peaks: places(peak, o.peaks), folds: places(peak, o.folds),
    resonances: o.resonances.map(r => named(resonance, r))
  }));
  const X = d.abscissa, sweep = X.parameter === "frequency";
  return {
    ...d, outputs, X, sweep, branches: d.branches.map(b => readBranch(b, d, words)),
    rpm: sweep ? d.rpm : undefined, /* speed over frequency, of a run-up */
    xLabel: X.name + (X.unit ? ", " + X.unit : ""),
    xText: v => number(v / X.scale, sweep ? 6 : 5, sweep) + (X.unit ? NBSP + X.unit : "")
  };
}

const classOf = g => {
  if (g.kind !== "nonlinear") return "limit " + g.kind;
  return g.rank < 0 ? "varying" : "c" + g.rank;
};
/* A curve by the balance, of which a point can be chosen. */
const selectable = b => b.group.kind === "nonlinear" && !b.dots && b.n > 0;

/* The highest point of a branch in an output. */
function topOf(branch, output) {
  const a = branch.row(output.row);
  let top = 0;
  for (let i = 1; i < a.length; i++)
    if (a[i] > a[top]) top = i;
  return top;
}

/* What a page shows at first; hidden: indices of groups. */
function firstState(report) {
  const state = {
    output: report.outputs[0], log: report.log,
    zoom: null, /* abscissa [lo, hi] */
    zoomY: null, /* amplitude [lo, hi], m */
    branch: report.chosen, point: 0, /* of the chosen branch */
    pair: 0, /* index into report.contacts */
    at: null, /* {b, i}: the point under the pointer */
    hidden: new Set()
  };
  if (state.branch >= 0) state.point = topOf(report.branches[state.branch], state.output);
  return state;
}
/* The abscissa of the charts. */
function rangeOf(report, state) {
  const [lo, hi] = state.zoom || report.X.range;
  return hi > lo ? {lo, hi, log: report.X.log} : around(lo, hi, false);
}
/* The output of a place; axis and quantity as far as it has them (null: any). */
function outputFor(report, place, axis, quantity) {
  const match = (a, q) => report.outputs.find(
    e => e.place === place && (a === null || e.axis === a) && (q === null || e.quantity === q));
  return match(axis, quantity) || match(axis, null) || match(null, quantity) || match(null, null);
}

export {
  STATES, named, readReport, classOf, selectable, topOf, firstState, rangeOf, outputFor
};
