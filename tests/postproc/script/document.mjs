/* A report in closed form for the tests: two curves of different preloads and a linear limit. */
import {readReport} from "../../../postproc/script/report_data.js";

const base64 = numbers => Buffer.from(Float32Array.from(numbers).buffer).toString("base64");
const FIELDS = ["abscissa", "stuck", "slipping", "open", "dissipation", "error", "stability",
  "special", "mark"];

/* Resonance at f0, Hz, of height 1e-5 m: 101 points from 90 to 110 Hz. */
const amplitude = (f, f0) => 1e-5 / Math.hypot(1, f - f0);
const frequencies = [...Array(101).keys()].map(i => 90 + 0.2 * i);

/* change: {point: {field: value}} */
function branch(group, f0, change = {}) {
  const rows = FIELDS.map(() => frequencies.map(() => 0));
  rows[0] = frequencies;
  rows[1] = frequencies.map(() => 0.25);
  rows[2] = frequencies.map(() => 0.75);
  rows[4] = frequencies.map(f => 1e-3 * amplitude(f, f0));
  rows[5] = frequencies.map(() => 0.004);
  for (const [i, values] of Object.entries(change))
    for (const [name, value] of Object.entries(values)) rows[FIELDS.indexOf(name)][i] = value;
  rows.push(frequencies.map(f => amplitude(f, f0)));
  rows.push(frequencies.map(() => 1e-8));
  rows.push(frequencies.map(f => amplitude(f, f0)));
  return {
    group, n: frequencies.length, complete: true, dots: false, reason: "", order: 1, note: "",
    data: base64(rows.flat())
  };
}
const peak = (group, f0) => [group, f0, 1e-5];
const track = (group, n0, f0) => [group, n0, 1e-5, f0, 0, 0, 0.25, 0.75, 0, 1e-8];

function makeDocument(more = {}) {
  return {
    format: "shroudhb report page", version: 1,
    fields: Object.fromEntries(FIELDS.map((name, i) => [name, i])),
    codes: {
      stability: {"stable": 0, "not judged": 1, "modulated": 2, "never seen": 3},
      special: {"fold": 1, "peak": 2, "flip": 3, "Neimark-Sacker point": 4, "optimum": 5},
      mark: {aboveTolerance: 1, undetermined: 2, notJudged: 4}
    },
    columns: {
      track: ["group", "n0", "amplitude", "at", "edge", "doubtful", "stuck", "slipping", "open",
        "dissipation"],
      peak: ["group", "at", "amplitude"], resonance: ["n0", "at", "amplitude"],
      lasting: ["at", "mean", "worst"]
    },
    rows: 12, chosen: 0, log: false,
    abscissa: {
      parameter: "frequency", name: "frequency", unit: "Hz", scale: 1, log: false, range: [90, 110]
    },
    groups: [
      {kind: "nonlinear", rank: 0, n0: 10, name: "n0 = 10 N"},
      {kind: "nonlinear", rank: 1, n0: 40, name: "n0 = 40 N"},
      {kind: "open", rank: -1, n0: null, name: "contact open"},
      {kind: "stuck", rank: -1, n0: null, name: "contact stuck"}
    ],
    outputs: [{
      place: "tip", row: 9, axis: "motion", quantity: "first harmonic",
      track: [track(0, 10, 96), track(1, 40, 104)], best: 1,
      limits: [peak(2, 94), peak(3, 106)], resonances: [], peaks: [peak(0, 96), peak(1, 104)],
      folds: []
    }],
    spectra: [{place: "tip", row: 10, n: 2}],
    contacts: {all: 1, names: [], full: 32767, signals: [], loop: []},
    branches: [
      branch(0, 96, {30: {special: 2}, 50: {stability: 3}, 51: {mark: 1, error: 0.4}}),
      branch(1, 104, {70: {mark: 6}}), branch(2, 94)
    ],
    axes: {psi: Math.PI / 6, phi: -0.1}, ...more
  };
}
const makeReport = more => readReport(makeDocument(more));

export {makeDocument, makeReport, amplitude, frequencies};
