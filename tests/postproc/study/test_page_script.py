#!/usr/bin/env python3
"""The script of a study's page in a browser: no error, every chart drawn, charts follow each other.

    test_page_script.py MAKER CHROMIUM [all]

MAKER keep writes page_KIND.study.html of every kind of study into the folder (test_study_page).
"""
import csv
import io
import re
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / 'support'))
from browser import visit

# Acts on a page as a reader does, then leaves what it saw in the document.
ACTIONS = """
<script>
(() => {
  const seen = {}, $ = id => document.getElementById(id);
  /* no canvas is used */
  const plain = ["spread-chart", "sobol-chart", "tornado-chart", "robust-chart"];
  const ink = svg => {
    if (plain.includes(svg.id)) return svg.querySelectorAll("path,rect").length > 1;
    const c = svg.parentElement.querySelector("canvas");
    const d = c.getContext("2d").getImageData(0, 0, c.width || 1, c.height || 1).data;
    return d.some((v, i) => i % 4 === 3 && v > 0);
  };
  const send = (target, type, x, y) => target.dispatchEvent(new PointerEvent(
      type, {clientX: x, clientY: y, button: 0, pointerId: 1, bubbles: true}));
  const charts = [...document.querySelectorAll("svg.plot")];
  seen.charts = charts.map(s => s.id).join();
  seen.blank = charts.filter(s => !ink(s)).map(s => s.id).join();
  seen.rows = document.querySelectorAll("#rows tr").length;
  for (const id of ["output", "colour", "map-x", "map-y"])
    if ($(id))
      for (const o of [...$(id).options].map(e => e.value)) {
        if (!$(id)) continue;
        $(id).value = o;
        $(id).dispatchEvent(new Event("change"));
      }
  for (const b of document.querySelectorAll("[data-log]")) b.click();
  for (const b of [...document.querySelectorAll("#heads button")].keys())
    document.querySelectorAll("#heads button")[b].click();
  /* each column of numbers, sorted up and down by a click */
  seen.unsorted = [...document.querySelectorAll("#heads th:not(.words)")].map((h, j) => {
    const column = () => [...document.querySelectorAll("#rows tr")]
        .map(r => parseFloat(r.cells[j].textContent.replace("\u2212", "-").replace(/\u202f/g, "")))
        .filter(Number.isFinite);
    const click = () => document.querySelectorAll("#heads button")[j].click();
    click();
    if (document.querySelectorAll("#heads th")[j].ariaSort !== "ascending") click();
    const up = column();
    click();
    const down = column();
    return up.every((v, i) => !i || v >= up[i - 1]) && down.every((v, i) => !i || v <= down[i - 1])
        ? "" : h.textContent;
  }).join("");
  seen.outside = [...document.querySelectorAll(".whisker")].filter(w => {
    const a = w.getBoundingClientRect(), b = w.closest("svg").getBoundingClientRect();
    return a.left < b.left - 1 || a.right > b.right + 1 || a.top < b.top - 1 ||
        a.bottom > b.bottom + 1;
  }).length;
  seen.between = [...document.querySelectorAll("#uncertainty td .note, #robust td .note")]
      .map(n => n.textContent)
      .filter(t => !/^((above|below) )?[-\d.]+\s\S+( to [-\d.]+\s\S+)?$/.test(t)).join();
  for (const svg of charts) {
    const r = svg.getBoundingClientRect();
    for (const t of [0.3, 0.5, 0.7]) {
      send(svg, "pointermove", r.left + t * r.width, r.top + t * r.height);
      svg.dispatchEvent(new MouseEvent("click", {clientX: r.left + t * r.width,
                                                 clientY: r.top + t * r.height, bubbles: true}));
    }
    send(svg, "pointerleave", r.left, r.top);
  }
  const row = document.querySelector("#rows tr");
  if (row) {
    if ($("dock").hidden || !row.classList.contains("chosen")) row.click();
    seen.dock = $("dock").textContent.replace(/\\s+/g, " ");
  }
  const grip = document.querySelector(".grip"), par = $("parallel-chart");
  if (grip) {
    par.setPointerCapture = () => {};
    const r = grip.getBoundingClientRect(), x = r.left + r.width / 2;
    send(grip, "pointerdown", x, r.top + 0.95 * r.height);
    send(par, "pointermove", x, r.top + 0.5 * r.height);
    send(par, "pointerup", x, r.top + 0.5 * r.height);
    seen.brushed = $("count").textContent;
    $("free").click();
    seen.free = $("count").textContent;
  }
  for (const type of ["beforeprint", "afterprint"]) window.dispatchEvent(new Event(type));
  if ($("all")) $("all").click();
  seen.all = document.querySelectorAll("#rows tr").length;
  const kept = [], made = URL.createObjectURL;
  URL.createObjectURL = blob => kept.push(blob) && made.call(URL, blob);
  if ($("csv")) $("csv").click();
  Promise.all(kept.map(blob => blob.text())).then(text => {
    seen.csv = text.join("");
    document.title = "seen " + JSON.stringify(seen);
  });
})();
</script>"""

USUAL = {'parallel-chart', 'tornado-chart', 'curves-chart', 'map-chart'}
CHARTS = {
    'grid': USUAL | {'effect-0', 'effect-1', 'effect-2'},
    'pair': USUAL | {'effect-0', 'effect-1'},
    'optimise': USUAL | {'effect-0', 'effect-1', 'history-chart'},
    'uncertain': USUAL | {'effect-0', 'effect-1', 'spread-chart', 'sobol-chart'},
    'robust': USUAL | {'effect-0', 'effect-1', 'robust-chart'},
    'large': USUAL | {'effect-0', 'effect-1', 'effect-2', 'effect-3'},
    'one': {'curves-chart', 'tornado-chart'},
    'failed': set(),
    'empty': set(),
}
DAILY = ('grid', 'robust', 'empty')  # what modules do is tested under node
DESIGNS = {'grid': 81, 'pair': 40, 'optimise': 60, 'uncertain': 256, 'robust': 200, 'large': 2000,
           'one': 1, 'failed': 4, 'empty': 0}


def faults(kind, page, chromium, folder):
    """What is wrong with the page of a kind."""
    found, seen = visit(chromium, folder, page.read_text(), ACTIONS)
    if not seen:
        return found + ['the actions did not end']
    charts = set(filter(None, seen['charts'].split(',')))
    if charts != CHARTS[kind]:
        found.append(f'charts {sorted(charts)}')
    if seen['blank']:
        found.append(f'nothing drawn in {seen["blank"]}')
    if seen['all'] != DESIGNS[kind]:
        found.append(f'{seen["all"]} rows')
    if seen['unsorted']:
        found.append(f'not sorted by {seen["unsorted"]}')
    if seen['outside']:
        found.append(f'{seen["outside"]} intervals leave their chart')
    if seen['between']:
        found.append(f'intervals {seen["between"]}')
    table = list(csv.DictReader(io.StringIO(seen['csv'])))
    if DESIGNS[kind] and len(table) != DESIGNS[kind]:
        found.append(f'{len(table)} rows in the CSV')
    if table and not {'design', 'contact.n0', 'peak', 'status', 'reason'} <= set(table[0]):
        found.append(f'CSV of {list(table[0])}')
    if sorted(int(row['design']) for row in table) != list(range(1, len(table) + 1)):
        found.append('designs of the CSV')
    command = r'shroudhb study STUDY.yaml --design \d+'
    if seen['rows'] and not re.search(command, seen.get('dock', '')):
        found.append(f'design: {seen.get("dock")}')
    if 'brushed' in seen:
        left = re.match(r'(\d+) of (\d+) designs', seen['brushed'])
        if not left or not 0 < int(left.group(1)) < DESIGNS[kind]:
            found.append(f'after a brush: {seen["brushed"]}')
        if seen['free'] != f'All {DESIGNS[kind]} designs':
            found.append(f'after it: {seen["free"]}')
    return found


def main():
    maker, chromium, *rest = sys.argv[1:]
    bad = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        subprocess.run([Path(maker).resolve(), 'study_page', 'keep'], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for kind in CHARTS if rest else DAILY:
            found = faults(kind, folder / f'page_{kind}.study.html', chromium, folder)
            print(f'{kind}: {"; ".join(found) or "good"}')
            bad += bool(found)
    return 1 if bad else 0


if __name__ == '__main__':
    sys.exit(main())
