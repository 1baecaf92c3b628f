"""cases.study.one_answer: a peak, its optimum and its verdict are the same in a study, in the run
of its design, in `mhb.track`, in `eval` and in the report.

Usage: test_one_answer.py BIN CASE_FOLDER, with the programs in BIN. Exit code 77: h5py is missing.
"""
import json
import os
import sys

try:
    import h5py
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../support'))
from programs import bring_your_own, near, rows, run, write

PROGRAM = os.path.join(os.path.abspath(sys.argv[1]), 'shroudhb')
SCENE = os.path.abspath(sys.argv[2])

OPTIMUM = """name: optimum
case: case.yaml
vary: {contact.n0: {from: 0.1 N, to: 1 N, scale: log}}
optimise: {minimise: peak, starts: 2, evaluations: 60}
outputs: [peak, frequency, rss]
"""
DESIGNS = """name: designs
case: case.yaml
vary: {contact.n0: [0.15 N, 0.44 N, 0.8 N], contact.mu: [0.3, 0.6]}
outputs: [peak, frequency, stable]
"""


def evaluated(n0):
    """The peak of `eval`, m."""
    write('params.in', f'1 variables\n{n0!r} contact__n0\n1 functions\n1 ASV_1:peak\n'
                       '0 derivative_variables\n0 analysis_components\n1 eval_id\n')
    run(PROGRAM, 'eval', 'case.yaml', '--params', 'params.in', '--results', 'results.out')
    with open('results.out') as source:
        return float(source.read().split()[0])


def summary(name, *settings):
    """The summary of a run of the case."""
    words = [word for setting in (f'name={name}', *settings) for word in ('--set', setting)]
    run(PROGRAM, 'run', '--quiet', *words, 'case.yaml')
    with open(f'{name}.summary.json') as source:
        return json.load(source)


def highest(result):
    """The highest peak of the nonlinear curves."""
    return max((curve['peak'] for curve in result['curves'] if curve['kind'] == 'nonlinear'),
               key=lambda peak: peak['amplitude'])


def check_optimum():
    run(PROGRAM, 'study', '--quiet', write('optimum.yaml', OPTIMUM))
    best = min(rows('optimum.study.csv'), key=lambda row: float(row['peak']))
    n0 = float(best['contact.n0'])
    track = ('contact.n0=0.3 N', 'mhb.vary.n0=[0.1 N, 1 N]', 'mhb.track=peak')
    tracked = summary('tracked', *track)['optimum']
    by_rss = summary('by_rss', *track, 'mhb.output_quantity=rss')['optimum']
    peak = highest(summary('swept', f'contact.n0={n0!r} N'))
    told = evaluated(n0)
    print(f"study {n0} N, {best['peak']} m; tracked {tracked['parameter']} N, "
          f"{tracked['amplitude']} m; eval {told} m; report {peak['amplitude']} m; "
          f"by rss {by_rss['parameter']} N, {by_rss['amplitude']} m")
    assert tracked['marked'] is False, tracked
    near(tracked['parameter'], n0, 1e-6)
    near(tracked['amplitude'], best['peak'], 1e-8)
    near(told, best['peak'], 1e-8)
    near(peak['amplitude'], best['peak'], 2e-6) # a located point of a curve
    near(peak['frequency'], best['frequency'], 1e-4)
    assert by_rss['amplitude'] > 1.01 * tracked['amplitude'], by_rss # another size has its name


def check_verdicts():
    run(PROGRAM, 'study', '--quiet', write('designs.yaml', DESIGNS))
    judged = 0
    for i, row in enumerate(rows('designs.study.csv')):
        run(PROGRAM, 'study', '--quiet', '--design', str(i + 1), 'designs.yaml')
        with open(f'designs_{i + 1}.summary.json') as source:
            own = highest(json.load(source))
        keys = (f"contact.n0={row['contact.n0']} N", f"contact.mu={row['contact.mu']}")
        always = highest(summary('always', 'mhb.stability=always', *keys))
        print(i + 1, 'study', row['stable'] or 'not judged', 'own run', own['stability'], 'always',
              always['stability'])
        near(own['amplitude'], row['peak'], 1e-6)
        word = {'1': 'stable', '0': 'unstable', '': 'not judged'}[row['stable']]
        assert len({word, own['stability'], always['stability']} - {'not judged'}) < 2, row
        judged += always['stability'] != 'not judged'
    assert judged == 6, judged


with bring_your_own(SCENE):
    run('/usr/bin/env', sys.executable, 'write_modal.py')
    check_optimum()
    check_verdicts()
