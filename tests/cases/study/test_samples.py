"""cases.study.samples: studies of sampled plans and of uncertain keys: samples and statistics.

Usage: test_samples.py BIN CASE_FOLDER, with the programs in BIN. Exit code 77: h5py is missing.
"""
import os
import sys

try:
    import h5py
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../support'))
from programs import bring_your_own, near, read, rows, run, write

BIN, SCENE = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])


def program(name):
    return os.path.join(BIN, name)


SAMPLED = '''name: sampled
case: case.yaml
vary:
  contact.n0: {from: 0.1 N, to: 1.6 N, scale: log}
  contact.mu: [0.3, 0.35, 0.4, 0.45]
  mhb.harmonics: {from: 3, to: 6}
plan: {PLAN}
outputs: [peak]
'''


def sampled(plan):
    write('sampled.yaml', SAMPLED.replace('PLAN', plan))
    run(program('shroudhb-study'), '--quiet', '--force', 'sampled.yaml')
    return rows('sampled.study.csv')


def check_sampled_plans():
    """Samples fill ranges and lists evenly, and a seed fixes them, also over ranks."""
    for kind in 'sobol', 'latin_hypercube':
        table = sampled(f'{kind}: 16, seed: 3')
        n0 = sorted(float(row['contact.n0']) for row in table)
        for i, value in enumerate(n0): # a sixteenth of the logarithmic range each
            assert 0.1 * 2 ** (i / 4) <= value <= 0.1 * 2 ** ((i + 1) / 4), (kind, n0)
        for key, values in ('contact.mu', (0.3, 0.35, 0.4, 0.45)), ('mhb.harmonics', (3, 4, 5, 6)):
            found = [float(row[key]) for row in table]
            assert all(found.count(value) == 4 for value in values), (kind, key, found)
        bytes_of_one = read('sampled.study.csv')
        run('mpiexec', '-n', '3', '--oversubscribe', program('shroudhb-study'), '--quiet',
            '--force', 'sampled.yaml')
        assert read('sampled.study.csv') == bytes_of_one, kind
        assert sampled(f'{kind}: 16, seed: 4') != table, kind
    said = run(program('shroudhb'), 'check', 'sampled.yaml')
    assert 'plan      latin_hypercube\n  designs   16\n' in said, said


UNCERTAIN = """name: {name}
case: case.yaml
{vary}uncertain:
  contact.n0: {n0}
  contact.mu: {{truncated_normal: [0.3, 0.03, 0.2, 0.4]}}
samples: {samples}
outputs: [peak, frequency]
"""


def percentile_rank(values, value):
    """Share of the values below."""
    return sum(v < value for v in values) / len(values)


def check_uncertain():
    """Saltelli's plan; the statistics are those of the rows, failed ones left out."""
    write('unc.yaml', UNCERTAIN.format(name='unc', vary='', n0='{uniform: [0.15 N, 0.45 N]}',
                                       samples=16))
    said = run(program('shroudhb'), 'check', 'unc.yaml')
    assert 'designs   32' in said and 'samples   16' in said, said
    said = run(program('shroudhb-study'), 'unc.yaml')
    assert 'matters most for peak' in said and '16 samples' in said, said
    table = rows('unc.study.csv')
    assert len(table) == 32 and all(row['status'] == 'done' for row in table)
    n0, mu = ([float(row[key]) for row in table] for key in ('contact.n0', 'contact.mu'))
    for a in range(0, 32, 4): # A, B, A with n0 of B, A with mu of B
        assert (n0[a + 2], mu[a + 2], n0[a + 3], mu[a + 3]) == (n0[a + 1], mu[a], n0[a], mu[a + 1])
    peak = [float(row['peak']) for i, row in enumerate(table) if i % 4 < 2]
    mean = sum(peak) / 16
    with h5py.File('unc.study.h5') as source:
        group = source['uncertainty']
        near(group['mean'][0], mean, 1e-12)
        near(group['deviation'][0], (sum((p - mean) ** 2 for p in peak) / 15) ** 0.5, 1e-9)
        assert abs(percentile_rank(peak, group['percentile'][0, 1]) - 0.5) <= 0.07
        assert group['percentile'].shape == (2, 3) and group.attrs['samples'] == 16
        total, first = group['sobol_total'][0], group['sobol_first'][0]
        assert total[0] > 0.6 > 0.2 > total[1] and first[0] > first[1], (first, total)
        assert group['sobol_total_low'][0, 0] < total[0] < group['sobol_total_high'][0, 0]
    resumed = read('unc.study.csv')
    run(program('shroudhb-study'), '--quiet', '--force', 'unc.yaml')
    assert read('unc.study.csv') == resumed


def check_robust():
    """Each design of the varied keys has statistics of its own; a ratio scales the varied key."""
    text = UNCERTAIN.format(name='robust', vary='vary: {contact.n0: [0.2 N, 0.4 N]}\n',
                            n0='{lognormal: [1, 0.1], relative: true}', samples=8)
    write('robust.yaml', text)
    run('mpiexec', '-n', '3', '--oversubscribe', program('shroudhb-study'), '--quiet', '--force',
        'robust.yaml')
    table = rows('robust.study.csv')
    assert [float(row['contact.n0']) for row in table] == [0.2] * 8 + [0.4] * 8
    ratio = [row['contact.n0 (ratio)'] for row in table]
    assert ratio[:8] == ratio[8:] and len(set(ratio)) == 8, ratio
    with h5py.File('robust.study.h5') as source:
        group = source['robust']
        assert list(group['key'][:, 0]) == [0.2, 0.4] and list(group['samples'][:]) == [8, 8]
        for g in range(2):
            peak = [float(row['peak']) for row in table[8 * g:8 * g + 8]]
            near(group['mean'][g, 0], sum(peak) / 8, 1e-12)
            assert min(peak) <= group['percentile'][g, 0, 0] < group['percentile'][g, 0, 2]
            assert group['percentile'][g, 0, 2] <= max(peak)
    row = table[3] # the same preload and friction without a ratio
    n0 = float(row['contact.n0']) * float(row['contact.n0 (ratio)'])
    write('plain.yaml', f'case: case.yaml\nvary: {{contact.n0: {n0!r}, contact.mu: '
          f'{row["contact.mu"]}}}\noutputs: [peak]\n')
    run(program('shroudhb-study'), '--quiet', 'plain.yaml')
    near(float(rows('plain.study.csv')[0]['peak']), float(row['peak']), 1e-8)


def main():
    with bring_your_own(SCENE):
        run(sys.executable, 'write_modal.py')
        for check in check_sampled_plans, check_uncertain, check_robust:
            check()
            print(check.__name__, 'passed')


main()
