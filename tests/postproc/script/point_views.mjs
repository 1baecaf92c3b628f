/* What a report page says and draws at chosen points, without a browser.
 *
 *   node point_views.mjs PAGE.html
 *
 * Prints what point_actions.js leaves in the title of the page: the same keys are pressed, the same
 * contacts and outputs are chosen. */
import {readFileSync} from "node:fs";
import {unique} from "../../../postproc/script/numbers.js";
import {table} from "../../../postproc/script/panel.js";
import {
  readReport, firstState, outputFor, selectable
} from "../../../postproc/script/report_data.js";
import {readout, spoken, stepped} from "../../../postproc/script/response.js";
import {spectrumView} from "../../../postproc/script/curve.js";
import {contactAt, contactViews, contactText} from "../../../postproc/script/contact.js";

const WIDTH = 540; /* px: tables do not depend on it */
const page = readFileSync(process.argv[2], "utf8");
const report = readReport(JSON.parse(/ id="data">(.*?)<\/script>/s.exec(page)[1]));
const state = firstState(report), seen = [];

const press = (key, far) => {
  state.at = stepped(report, state, key, far);
};
const enter = () => {
  if (selectable(report.branches[state.at.b]))
    [state.branch, state.point] = [state.at.b, state.at.i];
};
const point = () =>
  spoken(readout(report, state.output, report.branches[state.branch], state.point)) +
  ". Click the curves above to choose another.";
const look = end => {
  const q = contactAt(report, state);
  const views = [...contactViews(q, () => WIDTH), ["spectrum", spectrumView(report, state, WIDTH)]];
  seen.push({
    end, branch: state.branch, point: point(), contact: contactText(report, state, q),
    name: report.contacts.names[state.pair],
    tables: Object.fromEntries(views.map(([id, view]) => [id, table(view.panels)]))
  });
};
const contacts = end => report.contacts.names.forEach((name, i) => {
  state.pair = i;
  look(end);
});
/* Each place, axis and quantity, and what is said of the point then. */
function outputs() {
  const places = unique(report.outputs.map(o => o.place)), list = [];
  const quantities = unique(report.outputs.map(o => o.quantity));
  for (const place of new Set([places[0], places[1], places[places.length - 1]])) {
    const here = report.outputs.filter(o => o.place === place);
    for (const axis of unique(here.map(o => o.axis)))
      for (const quantity of quantities) {
        if (!here.some(o => o.axis === axis && o.quantity === quantity)) continue;
        state.output = outputFor(report, place, axis, quantity);
        list.push({place, axis, quantity, point: point()});
      }
  }
  seen[seen.length - 1].outputs = list;
}

contacts(); /* at the highest point, which the page begins with */
for (let step = 0; step < 5; step++) {
  for (let i = 0; i < 3; i++) press("ArrowRight");
  enter();
  contacts();
}
for (const [end, key] of [["first", "ArrowLeft"], ["last", "ArrowRight"]]) {
  for (let i = 0; i < 60; i++) press(key, true); /* ten points each */
  enter();
  contacts(end);
}
outputs();
process.stdout.write(JSON.stringify(seen));
