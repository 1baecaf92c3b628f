#!/usr/bin/env python3
"""How long a browser takes to show the report of a fine mesh with many curves.

    bench_page.py SHROUDHB CHROMIUM [SIZE]

SIZE is mesh.blade.size of the example, 2.9 mm by default (58 000 nodes); 36 preloads.
A row holds the median of five loads, to the second frame after the load event, beside that of an
empty page.
"""
import json
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / 'support'))
from browser import OFFLINE, WEBGL
from programs import ENVIRONMENT

CASE = Path(__file__).resolve().parents[2] / 'cases/z_notch_blade/case.yaml'
PRELOADS = [round(5 * 1.16 ** i, 3) for i in range(36)]
WATCH = """<script>addEventListener('load', () => requestAnimationFrame(() =>
requestAnimationFrame(() => console.log('LOADED ' + performance.now()))));</script></body>"""
EMPTY = '<!DOCTYPE html><html><body><p>empty</p></body></html>'
BROWSER = ['--headless', '--no-sandbox', '--disable-gpu', *WEBGL, '--enable-logging=stderr',
           '--window-size=1200,900', '--timeout=10000']


def report(shroudhb, size, folder):
    """The page and the summary of the example."""
    preloads = ', '.join(f'{n0} N' for n0 in PRELOADS)
    subprocess.run([shroudhb, 'run', '--quiet', str(CASE), '--into', str(folder), '--set',
                    f'mesh.blade.size={size}', '--set', f'contact.n0=[{preloads}]'], check=True,
                   env=ENVIRONMENT, stdout=subprocess.DEVNULL)
    summary = json.loads((folder / 'z_notch_blade.summary.json').read_text())
    return (folder / 'z_notch_blade.html').read_text(), summary


def load_time(chromium, page, folder):
    """Median time in s."""
    watched = folder / 'watched.html'
    at, times = page.rindex('</body>'), []
    watched.write_text(page[:at] + WATCH + page[at + len('</body>'):])
    for _ in range(5):
        said = subprocess.run([chromium, *BROWSER, *OFFLINE, f'--user-data-dir={folder}/user',
                               f'--screenshot={folder}/page.png', watched.as_uri()],
                              capture_output=True, text=True, timeout=120, check=False).stderr
        times.append(float(re.search(r'LOADED ([\d.]+)', said).group(1)) / 1e3)
    return statistics.median(times)


def main():
    shroudhb, chromium = sys.argv[1:3]
    size = sys.argv[3] if len(sys.argv) > 3 else '2.9 mm'
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        page, summary = report(shroudhb, size, folder)
        nodes = subprocess.run([shroudhb, 'inspect', str(folder / 'z_notch_blade.modal.h5'),
                                '/mesh/nodes', '--csv'], capture_output=True, text=True,
                               check=True).stdout.count('\n') - 1
        surface = re.search(r'"nodes":(\d+)', page).group(1)
        numbers = json.loads(re.search(r'id="data">(.*?)</script>', page, re.S).group(1))
        blade = len(json.dumps(numbers['blade']))
        print('  nodes  surface  curves  page MB  blade MB  shown s  empty page s')
        print(f'{nodes:7d} {surface:>8} {len(summary["curves"]):7d} {len(page) / 1e6:8.2f} '
              f'{blade / 1e6:9.2f} {load_time(chromium, page, folder):8.2f} '
              f'{load_time(chromium, EMPTY, folder):13.2f}')


main()
