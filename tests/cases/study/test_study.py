"""cases.study.study: a study on the programs: results, ranks, resumption, crashes, faults.

Usage: test_study.py BIN CASE_FOLDER, with the programs in BIN. Exit code 77: h5py is missing.
"""
import os
import re
import signal
import subprocess
import sys
import time

try:
    import h5py
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../support'))
from programs import ENVIRONMENT, bring_your_own, near, read, rows, run, run_on_terminal, write

BIN, SCENE = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])

GRID = """name: grid
case: case.yaml
vary:
  contact.n0: {from: 0.1 N, to: 0.5 N, points: 5}
  contact.mu: [0.3, 0.4]
plan: grid
outputs: [peak, frequency, peak_to_peak, stable, dissipation, mass, modes[1].frequency]
"""


def program(name):
    return os.path.join(BIN, name)


def largest(a):
    """Largest length of Re(a exp(jt)) in a cycle."""
    return float(((abs(a) ** 2).sum() + abs((a ** 2).sum())) / 2) ** 0.5


def check_values():
    """The peak at n0 = 0.3 N, mu = 0.4 is the located one of a whole run."""
    table = rows('grid.study.csv')
    assert len(table) == 10 and all(row['status'] == 'done' for row in table), table
    row = table[5]
    assert float(row['contact.n0']) == 0.3 and float(row['contact.mu']) == 0.4, row
    run(program('shroudhb'), 'run', '--quiet', 'case.yaml')
    with h5py.File('three_degree.response.h5') as source:
        branches = [source[name] for name in source if name.startswith('branch_')]
        peak, place, stable = max(
            (largest(b['probe'][p, 0, :, 1]), float(b['frequency'][p]), int(b['stable'][p]))
            for b in branches if 'harmonics' in b
            for p in range(len(b['frequency'])) if b['n0'][p] == 0.3)
    print(f"study {row['peak']} m, run {peak} m, stable {row['stable']} and {stable}")
    near(float(row['peak']), peak, 1e-4)
    assert stable == -1 or row['stable'] in ('', str(stable)) # one verdict, or none
    near(float(row['frequency']), place, 1e-3)
    assert row['mass'] == row['peak'], row
    near(6.283185307179586 * float(row['modes[1].frequency']), 0.94827, 1e-5)
    assert row['stable'] in ('1', '0'), row
    said = run(program('shroudhb'), 'study', 'grid.yaml', '--design', '6')
    told = re.search(r'highest +(\S+) m at \S+ Hz; in the study (\S+) m', said)
    near(float(told[1]), float(told[2]), 1e-4)
    near(float(told[2]), float(row['peak']), 1e-5)
    assert float(row['peak_to_peak']) > 1.9 * float(row['peak'])
    assert float(row['dissipation']) > 0
    with h5py.File('grid.study.h5') as source:
        assert source.attrs['kind'] in (b'study', 'study') and source.attrs['finished'] == 1
        assert source['design/value'].shape == (10, 2)
        assert list(source['design/status'][:]) == [1] * 10
        start = source['curve/start'][:]
        assert start[0] == 0 and all(0 < b - a <= 200 for a, b in zip(start, start[1:]))


def check_derivatives():
    """The derivatives are those of differences of studied peaks: smooth, corner and stuck ones."""
    values, step = {'contact.n0': 0, 'contact.mu': 0.4, 'contact.ku': 0.5, 'contact.kv': 0.8,
                    'mhb.scale': 1}, 1e-3
    for n0 in (0.15, 1.0, 1e3):
        values['contact.n0'] = n0
        moves = [(key, k) for key in values for k in (-2, -1, 1, 2)]
        designs = [values] + [{**values, key: values[key] * (1 + k * step)} for key, k in moves]
        write('moved.csv', '\n'.join([','.join(values)] + [
            ','.join(repr(design[key]) for key in values) for design in designs]) + '\n')
        write('moved.yaml', 'case: case.yaml\nplan: {table: moved.csv}\noutputs: [peak]\n')
        run(program('shroudhb-study'), '--quiet', 'moved.yaml')
        table = rows('moved.study.csv')
        peak = [float(row['peak']) for row in table]
        for i, key in enumerate(values):
            a, b, c, d = peak[1 + 4 * i:5 + 4 * i]
            relative = (a - 8 * b + 8 * c - d) / (12 * step) / peak[0]
            own = float(table[0]['dpeak_d' + key.split('.')[1]]) * values[key] / peak[0]
            print(f'n0 {n0}: {key} {own:.9f}, by differences {relative:.9f}')
            assert abs(own - relative) < 1e-6, (key, own, relative)
            if n0 == 1e3 and key in ('contact.n0', 'contact.mu'): # nothing slips
                assert abs(own) < 1e-9, (key, own)
    with h5py.File('moved.study.h5') as source:
        names = [name.decode() for name in source['derivative/key'][:]]
        assert names == ['n0', 'scale', 'mu', 'ku', 'kv', 'damping_factor'], names
        assert source['derivative/value'].shape == (21, 6)
        assert abs(source['derivative/case_value'][2] - 0.4) < 1e-15


OPTIMISE = """case: case.yaml
vary:
  contact.n0: {from: 0.1 N, to: 1 N, scale: log}
  contact.mu: {from: 0.1, to: 0.8}
optimise: {minimise: peak, at_most: {frequency: 0.217 Hz}, evaluations: 24, starts: 2}
outputs: [peak]
"""


def check_optimise():
    """The optimum meets its limit and is the least of them, on one and three ranks, resumed."""
    write('best.yaml', OPTIMISE)
    said = run(program('shroudhb-study'), '--check', 'best.yaml')
    assert 'peak by sbplx, 2 starts of 12 evaluations' in said, said
    run(program('shroudhb-study'), '--quiet', 'best.yaml')
    table, bytes_alone = rows('best.study.csv'), read('best.study.csv')
    good = [i for i, row in enumerate(table) if float(row['frequency']) <= 0.217]
    with h5py.File('best.study.h5') as source:
        optimum = source['optimum']
        best, history = int(optimum.attrs['best']), list(optimum['history'][:])
        assert 'SBPLX of NLopt' in str(optimum.attrs['method']), optimum.attrs['method']
        assert sorted(set(history)) == list(range(len(table))) and len(history) <= 24, history
    assert best == min(good, key=lambda i: float(table[i]['peak'])), (best, good)
    run('mpiexec', '-n', '3', '--oversubscribe', program('shroudhb-study'), '--quiet', '--force',
        'best.yaml')
    assert read('best.study.csv') == bytes_alone
    said = run(program('shroudhb-study'), 'best.yaml') # nothing is computed again
    assert read('best.study.csv') == bytes_alone
    assert 'optimum' in said and 'used up their 12 evaluations' in said, said
    for text, fault in ((('peak,', 'peek,'), "'peek' is no output of this case"),
                        (('0.217 Hz', '0.217 N'), 'frequency: '),
                        (('evaluations: 24', 'evaluations: 8'), 'too few for 2 starts'),
                        (('starts: 2', 'seeds: 2'), 'seeds: unknown key'),
                        (('{from: 0.1, to: 0.8}', '[0.1, 0.8]'), 'needs a range'),
                        (('minimise: peak, ', ''), 'minimise is missing'),
                        (('outputs:', 'plan: grid\noutputs:'), 'leave plan out')):
        write('bad.yaml', OPTIMISE.replace(*text))
        said = run(program('shroudhb-study'), 'bad.yaml', code=2)
        assert fault in said, said


ONE_KEY = """case: case.yaml
vary:
  contact.n0: {from: 0.1 N, to: 1 N, scale: log}
optimise: {minimise: peak, starts: 2, evaluations: 80}
outputs: [peak]
"""


def check_one_key():
    """Along one key the root of the slope: no design beside the optimum is lower."""
    write('line.yaml', ONE_KEY)
    run(program('shroudhb-study'), '--quiet', 'line.yaml')
    table = rows('line.study.csv')
    with h5py.File('line.study.h5') as source:
        best = table[int(source['optimum'].attrs['best'])]
        assert 'root of the slope' in str(source['optimum'].attrs['method'])
    print(len(table), 'designs, optimum', best['contact.n0'], 'N')
    assert len(table) <= 40, len(table)
    n0, peak = float(best['contact.n0']), float(best['peak'])
    points = [0.1 * 10 ** (i / 40) for i in range(41)] + [n0 * (1 + d) for d in (-1e-3, 1e-3)]
    write('scan.csv', 'contact.n0\n' + ''.join(f'{n} N\n' for n in points))
    write('scan.yaml', 'case: case.yaml\nplan: {table: scan.csv}\noutputs: [peak]\n')
    run(program('shroudhb-study'), '--quiet', 'scan.yaml')
    assert min(float(row['peak']) for row in rows('scan.study.csv')) > peak * (1 - 1e-7)
    write('bound.yaml', ONE_KEY.replace('from: 0.1 N', 'from: 0.6 N'))
    said = run(program('shroudhb-study'), 'bound.yaml')
    assert 'contact.n0 lies on the lower bound of its range' in said, said
    for text, fault in (((': peak, ', ': frequency, algorithm: slope, '), 'slope minimises peak'),
                        ((': peak, ', ': peak, algorithm: slope, at_most: {peak: 1 m}, '),
                         'slope has no limits'),
                        ((': peak, ', ': peak, algorithm: steep, '), 'direct, slope'),
                        (('scale: log}', 'scale: log}\n  contact.mu: {from: 0.1, to: 0.2}'),
                         None)):
        write('bad.yaml', ONE_KEY.replace(*text))
        said = run(program('shroudhb-study'), '--check', 'bad.yaml', code=2 if fault else 0)
        assert (fault or 'peak by sbplx') in said, said


def check_ranks():
    """Three ranks give the bytes of one."""
    alone = read('grid.study.csv')
    run('mpiexec', '-n', '3', '--oversubscribe', program('shroudhb-study'), '--quiet', '--force',
        'grid.yaml')
    assert read('grid.study.csv') == alone
    run(program('shroudhb'), 'study', '--quiet', '--force', 'grid.yaml')
    assert read('grid.study.csv') == alone


def check_progress():
    """On a terminal a study tells how many designs are done and the time left, on all cores too."""
    for words in ((program('shroudhb-study'),), (program('shroudhb'), 'study')):
        said = run_on_terminal(*words, '--force', 'grid.yaml')
        shown = re.findall(r'study +(\d+) %  design (\d+) of 10  0 failed  (\d+) s left', said)
        print(words[0], shown)
        assert shown, said
        done = [int(design) for _, design, _ in shown]
        assert done == sorted(done) and all(int(share) == 10 * int(design)
                                            for share, design, _ in shown), shown
    said = run(program('shroudhb-study'), '--force', 'grid.yaml')
    assert ' left' not in said, said  # a pipe is no terminal
    write('long.csv', 'contact.n0\n' + ''.join(f'{0.10031 + 1e-3 * i}\n' for i in range(200)))
    write('long.yaml', 'case: case.yaml\nplan: {table: long.csv}\noutputs: [peak]\n')
    began = time.monotonic()
    said = run_on_terminal(program('shroudhb-study'), 'long.yaml')
    took = time.monotonic() - began
    half = re.findall(r'design 1\d\d of 200 .*?(?:(\d+) min )?(\d+) s left', said)[0]
    left = 60 * int(half[0] or 0) + int(half[1])
    print(f'200 designs took {took:.1f} s; half way {left} s were left')
    assert left < took and abs(left - took / 2) < 0.35 * took + 1, (left, took)


def check_reuse():
    """A longer study takes what a shorter one has, and equals a study from nothing."""
    head = 'contact.n0, contact.mu\n'
    lines = ['0.1 N, 0.3\n', '0.45, 0.35\n', '0.1, 0.3\n', '0.2 N, 0.35\n']
    write('table.yaml', 'case: case.yaml\nplan: {table: t.csv}\noutputs: [peak, frequency]\n')
    write('t.csv', head + ''.join(lines[:2]))
    run(program('shroudhb-study'), '--quiet', 'table.yaml')
    write('t.csv', head + ''.join(lines))
    said = run(program('shroudhb-study'), '--verbose', 'table.yaml')
    assert '4 designs, 1 to compute' in said, said # two are known, two are equal
    resumed = read('table.study.csv')
    assert rows('table.study.csv')[0]['peak'] == rows('table.study.csv')[2]['peak']
    run(program('shroudhb-study'), '--quiet', '--force', 'table.yaml')
    assert read('table.study.csv') == resumed
    write('other.yaml', 'case: case.yaml\nvary: {contact.n0: [0.45 N, 0.1 N], contact.mu: 0.35}\n'
          'outputs: [peak, frequency]\n')
    said = run(program('shroudhb-study'), '--verbose', 'other.yaml')
    assert '2 designs, 1 to compute' in said, said # the other file is known too


def child_of(parent, name):
    """A process of this name below parent; 0: none yet."""
    for entry in filter(str.isdigit, os.listdir('/proc')):
        try:
            with open(f'/proc/{entry}/stat') as source:
                text = source.read()
        except OSError:
            continue
        own, state = text[text.index('(') + 1:text.rindex(')')], text[text.rindex(')') + 2:].split()
        if own == name[:15] and int(state[1]) == parent:
            return int(entry)
    return 0


def many(name):
    return write(f'{name}.yaml', f'name: {name}\ncase: case.yaml\nvary:\n'
                 '  contact.n0: {from: 0.11 N, to: 0.41 N, points: 12}\noutputs: [peak]\n')


def check_crash():
    """A design whose process dies is a row; the next run computes it, and only it."""
    many('whole')
    many('crash')
    run(program('shroudhb-study'), '--quiet', '--force', 'whole.yaml')
    os.rename('whole.study.h5', 'whole.h5') # not to be found by the next study
    study = subprocess.Popen([program('shroudhb-study'), '--quiet', '--force', 'crash.yaml'],
                             stderr=subprocess.PIPE, env=ENVIRONMENT)
    child, waited = 0, time.time()
    while not child and time.time() < waited + 60:
        child = child_of(study.pid, 'shroudhb-design')
    os.kill(child, signal.SIGKILL)
    study.communicate(timeout=300)
    assert study.returncode == 3, study.returncode
    failed = [row for row in rows('crash.study.csv') if row['status'] == 'failed']
    assert len(failed) == 1 and 'signal 9' in failed[0]['reason'], failed
    said = run(program('shroudhb-study'), '--verbose', 'crash.yaml')
    assert '12 designs, 1 to compute' in said, said
    assert read('crash.study.csv') == read('whole.study.csv')


def check_kill():
    """A study killed on the way leaves files that are whole, and goes on."""
    many('killed')
    os.remove('crash.study.h5')
    study = subprocess.Popen([program('shroudhb-study'), '--quiet', '--force', 'killed.yaml'],
                             env=ENVIRONMENT, start_new_session=True)
    while not child_of(study.pid, 'shroudhb-design'):
        time.sleep(0.01)
    time.sleep(0.3)
    os.killpg(study.pid, signal.SIGKILL)
    study.wait()
    run(program('shroudhb-study'), '--quiet', 'killed.yaml')
    assert read('killed.study.csv') == read('whole.study.csv')


AGAIN = """contact.n0,mhb.max_points
0.1 N,20000
0.15 N,20000
0.13 N,{few}
1.5 N,{few}
"""


def check_again():
    """A design that did not converge is solved from the peak of the nearest one that did. Where
    that fails too it keeps its reason. Ranks and resumption do not change the table."""
    for name, few in ('again', 10), ('enough', 20000):
        write(f'{name}.csv', AGAIN.format(few=few))
        write(f'{name}.yaml', f'case: case.yaml\nplan: {{table: {name}.csv}}\noutputs: [peak, '
              'frequency]\n')
    said = run(program('shroudhb-study'), 'again.yaml', code=3)
    assert '1 not converged' in said, said
    run(program('shroudhb-study'), '--quiet', 'enough.yaml')
    table, whole = rows('again.study.csv'), rows('enough.study.csv')
    solved, left = table[2], table[3]
    assert solved['status'] == 'done' and left['status'] == 'not converged', (solved, left)
    assert solved['reason'].startswith('solved from the peak of design 2; a curve does not cover')
    for output in 'peak', 'frequency', 'dpeak_dn0', 'dpeak_dmu':
        near(float(solved[output]), float(whole[2][output]), 1e-7)
    first, second = left['reason'].split('; tried again from the peak of design ')
    assert first.startswith('a curve does not cover mhb.frequency: ') and second == '2', left
    with h5py.File('again.study.h5') as source:
        assert list(source['design/tried_from'][:]) == [-1, -1, 1, 1]
    bytes_alone = read('again.study.csv')
    said = run(program('shroudhb-study'), '--verbose', 'again.yaml', code=3)
    assert '4 designs, 0 to compute' in said and read('again.study.csv') == bytes_alone, said
    command = ['mpiexec', '-n', '3', '--oversubscribe', program('shroudhb-study'), '--quiet',
               '--force', 'again.yaml']
    subprocess.run(command, env=ENVIRONMENT, check=False, capture_output=True)
    assert read('again.study.csv') == bytes_alone
    write('again.csv', AGAIN.format(few=10) + '0.135 N,20000\n') # a nearer one is solved
    run(program('shroudhb-study'), '--quiet', 'again.yaml', code=3)
    assert 'of design 5; ' in rows('again.study.csv')[2]['reason'], rows('again.study.csv')[2]


FAULTS = [
    ('vary: {contact.mu: [0.3]}\nplan: {sobl: 12}', "sobl: unknown key; did you mean 'sobol'?"),
    ('vary: {contact.mu: [0.3]}\nplan: {sobol: 0}', 'plan.sobol: is 0, must be 1 to 100000'),
    ('vary: {contact.mu: [0.3]}\nplan: {sobol: 8, latin_hypercube: 8}', 'plan: expected one of'),
    ('plan: {sobol: 12}', 'vary: missing'),
    ('vary: {contact.mu: [0.3]}\nseed: 3', 'seed: is that of uncertain keys'),
    ('vary: {contact.mu: [0.3]}\nsamples: 32', 'samples: needs uncertain'),
    ('uncertain: {contact.mu: {normal: [0.3, 0.1]}}', 'uncertain: needs samples'),
    ('samples: 3\nuncertain: {contact.mu: {normal: [0.3, 0.1]}}',
     'samples: is 3, must be 8 to 100000'),
    ('samples: 32\nuncertain: {contact.mu: {normall: [0.3, 0.1]}}',
     "normall: unknown distribution; did you mean 'normal'?"),
    ('samples: 32\nuncertain: {contact.mu: {normal: [0.3, -0.1]}}', 'deviation must be above 0'),
    ('samples: 32\nuncertain: {contact.mu: {normal: [0.3]}}', 'expected 2 numbers'),
    ('samples: 32\nuncertain: {contact.mu: {normal: [0.3, 1 mm]}}', 'has unit mm'),
    ('samples: 32\nuncertain: {contact.mu: 0.3}', 'expected a distribution'),
    ('samples: 32\nuncertain: {contact.to: {normal: [0.3, 0.1]}}', 'is not a number'),
    ('samples: 32\nuncertain: {contact.mv: {normal: [0.3, 0.1]}}', "did you mean 'contact.mu'?"),
    ('samples: 32\nuncertain: {contact.mu: {triangular: [0.3, 0.2, 0.4]}}', 'mode <= upper end'),
    ('samples: 32\nuncertain: {contact.mu: {normal: [1, 0.1], relative: true}}',
     'relative: true needs the key in vary'),
    ('samples: 32\nvary: {contact.mu: 0.3}\nuncertain: {contact.mu: {normal: [1, 0.1]}}',
     'add relative: true'),
    ('samples: 32\nuncertain: {contact.mu: {normal: [0, 0.1]}}', 'contact.mu: is -'),
    ('vary: {contact.mv: [1, 2]}', "contact.mv: is no key of a case; did you mean 'contact.mu'?"),
    ('vary: {contact.no: [1, 2]}', "contact.no: is no key of a case; did you mean 'contact.n0'?"),
    ('vary: {contct.mu: [1, 2]}', "contct.mu: is no key of a case; did you mean 'contact.mu'?"),
    ('vary: {n0: [1, 2]}', "n0: is no key of a case; did you mean 'contact.n0'?"),
    ('vary: {mesh.blade.section[4].thicknes: [1 mm, 2 mm]}',
     "did you mean 'mesh.blade.sections[4].thickness'?"),
    ('vary: {mesh.blade.sections.thicknes: [1 mm, 2 mm]}',
     "did you mean 'mesh.blade.sections[0].thickness'?"),
    ('vary: {contact.n0.low: [1, 2]}', "did you mean 'contact.n0'?"),
    ('vary: {mhb: [1, 2]}', 'mhb: is no key of a case; known here: frequency, '),
    ('vary: {mhb.huckleberry: [1, 2]}', 'is no key of a case; known here: frequency, '),
    ('vary: {contact.to: [1, 2]}', 'contact.to: is not a number'),
    ('vary: {contact.mu: [0.3, -1]}', 'design 2: contact.mu: is -1, must be 0 to'),
    ('vary: {contact.n0: [1 N], contact.mu: [0.3, -1, -2]}', # at the value at fault
     'fault.yaml:2:45: error: design 2: contact.mu: is -1, must be 0 to 1e+06 (2 designs in all)'),
    ('vary: {contact.n0: [1 N, 2 N], contact.mu: {from: -1, to: 1, points: 3}}',
     'fault.yaml:2:44: error: design 1: contact.mu: is -1, must be 0 to 1e+06 (2 designs in all)'),
    ('vary: {contact.mu: 0.3, contact.n0[7]: 1 N}',
     "fault.yaml:2:40: error: design 1: 'contact.n0' has the entries 0 to 3"),
    ('vary: {contact.mu: 0.3, mhb.frequency[0]: [0.1 Hz, 5 Hz]}',
     'fault.yaml:2:52: error: design 2: mhb.frequency: goes from 5 to '),
    ('samples: 8\nuncertain: {contact.n0: {normal: [1, 0.1]}, contact.mu: {normal: [-1, 0.1]}}',
     'fault.yaml:3:57: error: design 1: contact.mu: is -'),
    ('vary: {contact.mu: []}', 'contact.mu: the list is empty'),
    ('vary: {contact.n0: [1 m]}', 'contact.n0:'),
    ('vary: {contact.n0: {from: 1 N, to: 2 N}}', 'a grid needs the number of points'),
    ('vary: {contact.n0: {from: 2 N, to: 1 N, points: 3}}', 'from below to'),
    ('vary: {contact.n0: {from: 0 N, to: 1 N, points: 3, scale: log}}', 'a range above 0'),
    ('vary: {contact.n0: {form: 0 N, to: 1 N, points: 3}}', "did you mean 'from'?"),
    ('vary: {contact.mu: [0.3]}\noutputs: [peek]', "'peek' is no output of this case"),
    ('vary: {contact.mu: [0.3]}\noutputs: [modes[0].frequency]', 'the modes of the case'),
    ("vary: {contact.mu: [0.3]}\noutputs: ['modes[0].frequency']", 'the modes of the case'),
    ('vary: {contact.mu: [0.3]}\nplan: gird', 'plan: expected grid'),
    ('vray: {contact.mu: [0.3]}', "did you mean 'vary'?"),
    ('plan: {table: none.csv}', 'none.csv: cannot be opened'),
    ('plan: {table: short.csv}', 'short.csv:3: row 1 has 1 columns, the header has 2'),
    ('plan: {table: wrong.csv}',
     "plan: wrong.csv: contact.nu: is no key of a case; did you mean 'contact.n0'?"),
    ('plan: {table: unit.csv}', "plan: unit.csv:3: contact.n0: '1 m' has unit m, expected N"),
    ('plan: {table: twice.csv}', 'plan: twice.csv: contact.mu: is the column 1 and 2'),
    ('plan: {table: nameless.csv}', 'plan: nameless.csv: column 2 has no name'),
    ('plan: {table: semicolons.csv}', "'0,3' is not a number; write 0.3 with a decimal point"),
    ('plan: {table: low.csv}', 'fault.yaml:2:7: error: design 2: contact.mu: is -1, must be 0'),
    ('plan: {table: empty.csv}', 'holds no design'),
]


def check_faults():
    """Every fault is refused by one line, by check and before anything runs."""
    write('short.csv', 'contact.mu,contact.n0\n\n0.3\n')
    write('unit.csv', 'contact.mu,contact.n0\n0.3,1 N\n0.3,1 m\n')
    write('twice.csv', 'contact.mu,contact.mu\n0.3,0.4\n')
    write('nameless.csv', 'contact.mu,\n0.3,0.4\n')
    write('semicolons.csv', 'contact.mu;contact.n0\n0,3;1\n')
    write('low.csv', 'contact.mu,contact.n0\n0.3,1\n-1,1\n')
    write('wrong.csv', 'contact.mu,contact.nu\n0.3,1\n')
    write('empty.csv', 'contact.mu\n')
    for text, message in FAULTS:
        write('fault.yaml', f'case: case.yaml\n{text}\n')
        said = run(program('shroudhb-study'), 'fault.yaml', code=2)
        assert message in said and said.count('error:') == 1, f'{text}: {said}'
        assert not os.path.exists('fault.study.h5'), text
        said = run(program('shroudhb-study'), '--check', 'fault.yaml', code=2)
        assert message in said, f'{text}: {said}'
    assert 'designs   10' in run(program('shroudhb'), 'check', 'grid.yaml')
    said = run(program('shroudhb'), 'study', 'grid.yaml', 'grid.yaml', code=2)
    assert said.count('error:') == 1, said


def check_overrides():
    """--set changes a key as the file would; --into moves the output."""
    write('set.yaml', 'case: case.yaml\nvary: {contact.n0: [0.3 N]}\noutputs: [peak]\n')
    run(program('shroudhb'), 'study', '--quiet', '--set', 'vary.contact.n0=[0.4 N]',
        '--set', 'name=moved_study', '--into', 'apart/study', 'set.yaml')
    table = rows('apart/study/moved_study.study.csv')
    assert [float(row['contact.n0']) for row in table] == [0.4], table
    assert float(table[0]['peak']) > 0 and not os.path.exists('set.study.csv')
    run(program('shroudhb'), 'check', '--quiet', '--into', 'elsewhere', 'case.yaml')
    assert not os.path.exists('elsewhere')  # a check writes nothing
    run(program('shroudhb'), 'mhb', '--quiet', '--set', 'contact.n0=0.3 N',
        '--set', 'mhb.harmonics=3', '--into', 'elsewhere/first', 'case.yaml')
    with h5py.File('elsewhere/first/three_degree.response.h5') as source:
        settings, text = source.attrs['settings'], source.attrs['case_text']
    settings, text = (t.decode() if isinstance(t, bytes) else t for t in (settings, text))
    assert 'contact.n0 = 0.3' in settings.replace('0.29999999999999999', '0.3'), settings
    assert '# --set contact.n0=0.3 N' in text
    for word, message in [('contact.mv=1', "unknown key; did you mean 'mu'?"),
                          ('contact.n0[7]=1', 'has the entries 0 to 3'),
                          ('contact.mu', 'expected KEY=VALUE'),
                          ('contact.mu=-1', 'contact.mu: is -1')]:
        said = run(program('shroudhb'), 'check', '--set', word, 'case.yaml', code=2)
        assert f'--set {word}: error:' in said and message in said, said


def check_one_design():
    """--design=I is the run of that design, with a report of its own."""
    run(program('shroudhb'), 'study', '--design', '6', 'grid.yaml')
    assert os.path.exists('grid_6.html') and os.path.exists('grid_6.response.h5')
    said = run(program('shroudhb'), 'study', '--design=11', 'grid.yaml', code=2)
    assert 'the study has the designs 1 to 10' in said, said


def main():
    with bring_your_own(SCENE):
        run(sys.executable, 'write_modal.py')
        write('grid.yaml', GRID)
        run(program('shroudhb-study'), '--quiet', 'grid.yaml')
        for check in (check_values, check_derivatives, check_optimise, check_one_key,
                      check_ranks, check_progress, check_reuse, check_crash, check_kill,
                      check_again, check_faults, check_overrides, check_one_design):
            check()
            print(check.__name__, 'passed')


main()
