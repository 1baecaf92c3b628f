#!/usr/bin/env python3
"""Every number that a page shows and draws at a clicked point, against the response file.

    test_point_numbers.py MAKER NODE [CHROMIUM]

MAKER point_numbers keep writes pages, response files and NAME.json with areas and settings
(test_point_numbers.c): a wave, a disc, rings of equal and of different blades, several pairs,
several interfaces, gaps. Shares of pairs, loads and limits are computed here once more. Loads of
equal blades are also those of the wave, at the ends of the range.

The modules of the page's script run under node (point_views.mjs). A browser then shows one page
and must say and draw the very same.
"""
import csv
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / 'support'))
from browser import visit
from page_schema import document, first_fault, schema_of

try:
    import h5py
    import numpy as np
except ImportError:
    print('skipped: python3 has no h5py')
    sys.exit(77)

ACTIONS = (Path(__file__).parent / 'point_actions.js').read_text()
VIEWS = Path(__file__).parents[1] / 'script' / 'point_views.mjs'
SHOWN = 'sides'  # the page of the browser: several contacts of several interfaces
SCENES = ('wave', 'equal', 'ring', 'sides', 'parted', 'disc', 'gap', 'pressed', 'doubled')
UNITS = {'Hz': 1, 'm': 1, 'mm': 1e-3, 'µm': 1e-6, 'N': 1, 'mN': 1e-3, 'µN': 1e-6, 'kN': 1e3,
         'J': 1, 'mJ': 1e-3, 'µJ': 1e-6, 'nJ': 1e-9, '%': 0.01}
NUMBER = r'−?[\d.]+(?:[e×][-−\d^⁻]+)?'
DRAWN = 3e-3  # samples are thinned to 0.2 % of what a signal spans, and stored in 16 bits


def value(text, unit='', scale=None):
    """A number of the page in SI, and half a unit of its last digit."""
    plain = text.replace('−', '-')
    digits = len(plain.split('.')[1]) if '.' in plain else 0
    factor = scale or UNITS.get(unit, 1)
    return float(plain) * factor, 0.5001 * 10 ** -digits * factor


class Scene:
    """A response file, and what its pairs are."""

    def __init__(self, folder, name):
        self.file = h5py.File(folder / f'{name}.response.h5')
        case = json.loads((folder / f'{name}.json').read_text())
        self.interfaces = case['interfaces']
        self.pressed = case['pressed']
        pairs = self.branch(2)['motion'].shape[1]
        own = pairs // case['blades']
        areas = case['area'] or [1] * own
        which = self.file['interface'][:] if 'interface' in self.file else np.zeros(pairs, int)
        self.pairs, self.order = own, case['order']
        self.ring = case['blades'] > 1
        self.names = []
        self.law = []
        labels = [n.decode() for n in self.file['interface_name'][:]] if len(
            self.interfaces) > 1 else ['contact']
        for p in range(pairs):
            total = sum(a for q, a in enumerate(areas) if which[q] == which[p])
            law = self.interfaces[which[p]]
            share = areas[p % own] / total
            self.law.append({'mu': law['mu'], 'kv': law['kv'] * share, 'n0': law['n0'] * share})
            alike = [q for q in range(pairs) if which[q] == which[p]]
            label = labels[which[p]]
            self.names.append(label if len(alike) == 1 else f'{label} {alike.index(p) + 1}')

    def branch(self, i):
        return self.file[f'branch_{i}']


def complex_of(data):
    return data['r'] + 1j * data['i'] if data.dtype.names else data


def series(harmonics, time):
    return sum((a * np.exp(2j * np.pi * k * time)).real for k, a in enumerate(harmonics))


def semi_major(a):
    return np.sqrt((np.sum(abs(a) ** 2) + abs(np.sum(a * a))) / 2)


def peak_to_peak(a):
    """Largest distance of two instants of a vector's motion."""
    time = np.linspace(0, 1, 1001)[:-1]
    x = np.array([series(row, time) for row in np.atleast_2d(a)])
    if len(x) == 1:
        return np.ptp(x)
    return np.sqrt(max(((x[:, i:i + 1] - x) ** 2).sum(axis=0).max() for i in range(len(time))))


def amplitude(a, quantity, order):
    a = np.atleast_2d(a)
    return peak_to_peak(a) if quantity == 'peak to peak' else semi_major(a[:, order])


def lines(text, panel, names=None):
    """x and y of the series of a panel of a table, in the order of the table."""
    rows = [r for r in csv.reader(text.splitlines()) if r and r[0] == str(panel)]
    rows = [r for r in rows if r[1] != 'axes' and (not names or r[1] in names)]
    return np.array([[float(r[2]), float(r[3])] for r in rows]).reshape(-1, 2)


def coefficient(time, x, k):
    """Fourier coefficient of a polygon, whose pieces are split finely."""
    fine = np.linspace(0, 1, 20001)
    y = np.interp(fine, time, x) * np.exp(-2j * np.pi * k * fine)
    return (2 if k else 1) * np.trapezoid(y, fine) if hasattr(np, 'trapezoid') else (
        2 if k else 1) * np.trapz(y, fine)


class Check:
    def __init__(self):
        self.faults, self.worst, self.numbers = [], {}, 0

    def near(self, what, got, wanted, tolerance):
        self.numbers += 1
        off = abs(got - wanted) / tolerance if tolerance > 0 else float(got != wanted)
        self.worst[what] = max(self.worst.get(what, 0), off)
        if not off <= 1:
            self.faults.append(f'{what}: {got:.6g}, in the file {wanted:.6g}')

    def shown(self, what, text, unit, wanted):
        got, half = value(text, unit)
        self.near(what, got, wanted, half + 1e-6 * abs(wanted))  # the page has single precision


def find(branch, text):
    """Index of the point that the text names, by frequency and amplitude."""
    f, _ = value(*re.search(rf'frequency ({NUMBER})\xa0(Hz)', text).groups())
    a, half = value(*re.search(rf'first harmonic ({NUMBER})\xa0(\w+)', text).groups())
    return f, a, half, int(np.argmin(abs(branch['frequency'][:] - f)))


def check_point(scene, seen, check):
    """The text at the point; its index in the file."""
    branch, text = scene.branch(seen['branch']), seen['point']
    f, a, half, i = find(branch, text)
    check.near('frequency', f, branch['frequency'][i], 5.1e-6 * f)
    probe = complex_of(branch['probe'][i])
    ring = 'ring' in branch
    each = probe.shape[0] // (len(branch['ring/energy'][i]) if ring else 1)
    places = range(0, probe.shape[0], each) if ring else [0]
    most = max(semi_major(probe[q, :, scene.order]) for q in places)
    check.near('amplitude', a, most, half + 1e-6 * a)
    shares = re.search(rf'open ({NUMBER}) · ({NUMBER}) · ({NUMBER})\xa0%', text).groups()
    for got, wanted in zip(shares, branch['state'][i].mean(axis=0)):
        check.shown('share', got, '%', wanted)
    work = re.search(rf'dissipated ({NUMBER})\xa0(\w+)', text).groups()
    slips = branch['state'][i][:, 1] > 0
    check.shown('work', *work, branch['dissipation'][i][slips].sum())
    told = re.search(rf'error estimate ({NUMBER})\xa0%', text)
    errors = [branch['error'][e][i] for e in ('newton', 'truncation', 'sampling', 'modal')]
    errors += [branch['error/spatial'][i]]
    if told:
        check.shown('error', told.group(1), '%', max(e for e in errors if np.isfinite(e)))
    worst = max(places, key=lambda q: semi_major(probe[q, :, scene.order]))
    bars = lines(seen['tables']['spectrum'], 1)
    most = max(semi_major(probe[worst, :, k]) for k in range(probe.shape[2]))
    for k, height in bars:  # a bar begins at 1e-6 of the largest
        check.near('spectrum', height, semi_major(probe[worst, :, round(k)]), 2e-6 * most)
    return i


AXES = {'motion': slice(None), 'tangential': 0, 'axial': 1, 'radial': 2,
        'relative motion': slice(None), 'v, normal': 0, 'u, sliding': 1, 'w, sliding': 2}


def wanted(scene, branch, i, out):
    """The amplitude of an output at a point of the file."""
    axis, quantity = AXES[out['axis']], out['quantity']
    motion, probe = complex_of(branch['motion'][i]), complex_of(branch['probe'][i])
    names = [n.decode() for n in scene.file['probe/name'][:]]
    if not scene.ring or ', ' not in out['place']:
        of = (probe[names.index(out['place'])] if out['place'] in names
              else motion[scene.names.index(out['place'])])
        return amplitude(of[axis], quantity, scene.order)
    blades = len(motion) // scene.pairs
    each = [probe[b * (len(probe) // blades)] for b in range(blades)]
    all_of = [amplitude(of[axis], quantity, scene.order) for of in each]
    if out['place'].endswith('mean of the blades'):
        return np.mean(all_of)
    return all_of[int(np.argmax([amplitude(of, 'first harmonic', scene.order) for of in each]))]


def check_outputs(scene, seen, i, check):
    branch = scene.branch(seen['branch'])
    for out in seen['outputs']:
        told = re.search(rf"{out['quantity']} ({NUMBER})\xa0(\w+)", out['point']).groups()
        got, half = value(*told)
        exact = wanted(scene, branch, i, out)
        check.near(f"{out['place']} {out['axis']}", got, exact, half + 2e-5 * exact)


def check_contact(scene, seen, i, check):
    """The text of a contact, its load, its limit and its loops."""
    branch, text = scene.branch(seen['branch']), seen['contact']
    pair = scene.names.index(seen['name'])
    law = scene.law[pair]
    motion, force = complex_of(branch['motion'][i, pair]), complex_of(branch['force'][i, pair])
    fine = np.linspace(0, 1, 4001)
    load = np.maximum(law['n0'] + law['kv'] * series(motion[0], fine), 0)
    span = (load.min(), load.max())
    for what, factor in (('normal load', 1), ('friction limit', law['mu'])):
        low, high, unit = re.search(rf'{what} ({NUMBER}) to ({NUMBER})\xa0(\w+)', text).groups()
        for got, wanted in zip((low, high), span):
            number, half = value(got, unit)
            check.near(what, number, factor * wanted, half + DRAWN * factor * span[1])
    shares = re.search(rf'open ({NUMBER}) · ({NUMBER}) · ({NUMBER})\xa0%', text).groups()
    for got, wanted in zip(shares, branch['state'][i, pair]):
        check.shown("contact's share", got, '%', wanted)
    work = re.search(rf'dissipated ({NUMBER})\xa0(\w+)', text).groups()
    slips = branch['state'][i, pair, 1] > 0
    check.shown("contact's work", *work, branch['dissipation'][i, pair] if slips else 0)
    # the charts
    time, drawn = lines(seen['tables']['period'], 1).T
    time = time / scene.order
    most = load.max()
    check.near('load drawn', abs(drawn - np.interp(time, fine, load)).max(), 0, DRAWN * most)
    limit = lines(seen['tables']['period'], 2, ['line bound'])[:, 1]
    check.near('limit drawn', abs(limit - law['mu'] * drawn).max(), 0, 1e-4 * most)
    offset = 0 if scene.pressed else max(law['n0'], 0)
    check.near('mean load', coefficient(time, drawn, 0).real, force[0, 0].real + offset,
               DRAWN * most)
    order = np.argsort(by_state(seen['tables']['period'], 2)[:, 0], kind='stable')
    loops = []
    for axis, chart in ((1, 'loop-u'), (2, 'loop-w')):
        loops.append(by_state(seen['tables'][chart], 1)[order])
        x, f = loops[-1].T
        size = np.ptp(series(motion[axis], fine))
        check.near('motion drawn', abs(x - series(motion[axis], time)).max(), 0, DRAWN * size)
        for k in range(2):
            check.near('friction drawn', abs(coefficient(time, f, k) - force[axis, k]), 0,
                       DRAWN * law['mu'] * most)
    area = sum(np.sum((f[1:] + f[:-1]) / 2 * np.diff(x)) for x, f in (r.T for r in loops))
    size = sum(np.ptp(r[:, 0]) * np.ptp(r[:, 1]) for r in loops)
    check.near('area of loops', area, branch['dissipation'][i, pair], 2 * DRAWN * size)
    path = by_state(seen['tables']['path'], 1)[order]
    check.near('path', abs(path - np.stack([r[:, 1] for r in loops], 1)).max(), 0, 1e-9 * most)
    return span


def check_equal(ends):
    """Loads of a ring of equal blades at the ends of the range, and those of the wave."""
    check, pairs = Check(), len({name for _, name in ends['wave']})
    for (end, name), span in ends['equal'].items():
        pair = (int(name.split()[-1]) - 1) % pairs
        for got, exact in zip(span, ends['wave'][end, f'contact {pair + 1}']):
            check.near(f'{name}, {end}', got, exact, 1e-6 * ends['wave'][end, 'contact 1'][1])
    print(f'equal blades and the wave: {check.numbers} loads; worst '
          f'{max(check.worst.values(), default=0):.2g} of 1e-6 of the load')
    if check.numbers < 4 * pairs:
        check.faults.append('fewer than two contacts at both ends')
    return check.faults


def by_state(text, panel):
    """Samples of a chart, a line a state; each sample is in the line of the piece that it ends."""
    return np.concatenate([lines(text, panel, [f'line {s}']) for s in ('stick', 'slip', 'gap')])


def views(node, page):
    """What the script's modules say and draw."""
    run = subprocess.run([node, VIEWS, page], capture_output=True, text=True, timeout=120,
                         check=False)
    return (json.loads(run.stdout), []) if run.returncode == 0 else ([], [run.stderr])


def differences(chromium, folder, seen):
    """Where a browser says and draws something else."""
    if not chromium:
        print('a page in a browser: skipped, there is none')
        return []
    page = (folder / f'{SHOWN}.html').read_text()
    faults, shown = visit(chromium, folder, page, f'<script>{ACTIONS}</script>')
    for a, b in zip(seen, shown or []):
        faults += [f'{key}: {a[key]!r:.200}, in a browser {b.get(key)!r:.200}' for key in a
                   if a[key] != b.get(key)]
    print(f'{SHOWN} in a browser: {len(shown or [])} views')
    return faults + ([] if len(shown or []) == len(seen) else ['a view is missing'])


def check_scene(scene, seen, faults):
    """Check the views of a page; returns faults, and the loads at the ends of the range."""
    check, ends = Check(), {}
    check.faults += faults
    for at in seen:
        i = check_point(scene, at, check)
        span = check_contact(scene, at, i, check)
        if at.get('end'):
            ends[at['end'], at['name']] = span
        if at.get('outputs'):
            check_outputs(scene, at, i, check)
    if len({at['point'] for at in seen}) < 4:
        check.faults.append('fewer than four points')
    worst = sorted(check.worst.items(), key=lambda w: -w[1])[:3]
    print(f'{check.numbers} numbers of {len(seen)} views; worst of their '
          f'tolerance: {", ".join(f"{w} {x:.2f}" for w, x in worst)}')
    return check.faults, ends


def main():
    maker, node = sys.argv[1:3]
    chromium = sys.argv[3] if len(sys.argv) > 3 else None
    bad, ends = [], {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        subprocess.run([Path(maker).resolve(), 'point_numbers', 'keep'], cwd=folder, check=True)
        for scene_name in SCENES:
            seen, faults = views(node, folder / f'{scene_name}.html')
            print(f'{scene_name}: ', end='')
            faults, ends[scene_name] = check_scene(Scene(folder, scene_name), seen, faults)
            schema = schema_of('report')
            fault = schema and first_fault(schema, document(folder / f'{scene_name}.html'))
            faults += [fault] if fault else []
            if scene_name == SHOWN:
                faults += differences(chromium, folder, seen)
            bad += [f'{scene_name}: {fault}' for fault in faults[:8]]
        bad += check_equal(ends)
    for fault in bad:
        print('  ' + fault)
    return 1 if bad else 0


if __name__ == '__main__':
    sys.exit(main())
