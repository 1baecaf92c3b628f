"""cases.study.blade_study: a study with meshes: stress, safety and strain, and their faults.

Usage: test_blade_study.py BIN, with the programs in BIN.
"""
import glob
import json
import os
import shutil
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../support'))
from programs import near, rows, run, write

BIN = os.path.abspath(sys.argv[1])

CASE = """name: short
mesh:
  blade:
    root: {length: 60 mm, width: 35 mm, height: 18 mm}
    sections:
      - {radius: 250 mm, chord: 55 mm, thickness: 8 mm, camber: 9 mm, twist: -15 deg}
      - {radius: 350 mm, chord: 48 mm, thickness: 5 mm, camber: 5 mm, twist: -30 deg}
    shroud: {length: 46 mm, thickness: 7 mm, contact: 24 mm}
    size: 20 mm
material: {E: 210 GPa, nu: 0.3, rho: 7850, fatigue: {endurance: 300 MPa, ultimate: 900 MPa}}
rotor: {blades: 40, speed: 0 rpm, axis: x}
modal: {modes: 4, damping: 0.005}
excitation: {engine_order: 5, pressure: 1 kPa, harmonics: {1: [1, 0 deg]}}
probe: {tip: [0 mm, 0 mm, 357 mm]}
contact: {to: neighbour, psi: 35 deg, phi: 0 deg, points: 1, mu: 0.3, ku: 1 MN/m, kv: 1 MN/m,
          n0: [20 N, 60 N], preload: equilibrium}
mhb: {frequency: [250 Hz, 900 Hz], harmonics: 5, stability: never, save: [300 Hz]}
gauge: {g1: {at: [-10 mm, 2 mm, 300 mm], direction: [0.2, 0, 1]}}
"""

STUDY = """case: case.yaml
vary: {contact.n0: [20 N, 60 N]}
outputs: [peak, frequency, stress, safety, g1]
"""


def program(name):
    return os.path.join(BIN, name)


def check_values():
    """Stress, safety and strain are those of a whole run at the highest peak of each preload."""
    run(program('shroudhb'), 'study', '--quiet', write('stress.yaml', STUDY))
    run(program('shroudhb'), 'run', '--quiet', '--set', 'mhb.save=peaks', 'case.yaml')
    stress, gauge = rows('short.stress.csv'), rows('short.gauge.csv')
    for row in rows('stress.study.csv'):
        def distance(other):
            return abs(float(other['frequency_Hz']) - float(row['frequency']))
        own = [s for s in stress if s['n0_N'] and float(s['n0_N']) == float(row['contact.n0'])]
        at = min((s for s in own if s['place'] == '1'), key=distance)
        print(row['frequency'], at['frequency_Hz'], row['stress'], at['amplitude_Pa'])
        near(row['frequency'], at['frequency_Hz'], 1e-4)
        near(row['safety'], at['safety'], 1e-3)
        near(row['stress'], max(float(s['amplitude_Pa']) for s in own
                                if s['frequency_Hz'] == at['frequency_Hz']), 1e-3)
        near(row['g1'], min((g for g in gauge if g['n0_N']), key=distance)['amplitude'], 1e-3)


def check_common_modes():
    """Damping and pressure keep the modes: one solution for all, and the peaks of whole runs."""
    write('load.yaml', 'case: case.yaml\nvary: {modal.damping: [0.004, 0.01], '
          'excitation.pressure: [2 kPa, 3 kPa]}\noutputs: [peak, stress]\n')
    before = set(glob.glob('*.study.d/*.modal.h5'))
    run(program('shroudhb-study'), '--quiet', 'load.yaml')
    table = rows('load.study.csv')
    assert len(table) == 4, table
    new = set(glob.glob('*.study.d/*.modal.h5')) - before
    said = [run(program('shroudhb'), 'inspect', '--verbose', name) for name in new]
    solved = [text for text in said if 'shroudhb-modal' in text]
    assert len(new) - len(solved) == 4 and len(solved) <= 1, (new, solved)
    os.mkdir('whole')
    for row in table[1], table[3]:
        run(program('shroudhb'), 'run', '--quiet', 'case.yaml', '--into', 'whole', '--force',
            '--set', f'modal.damping={row["modal.damping"]}',
            '--set', f'excitation.pressure={row["excitation.pressure"]} Pa')
        with open('whole/short.summary.json') as source:
            whole = max(one['peak']['amplitude'] for one in json.load(source)['curves']
                        if one['kind'] == 'nonlinear')
        print(row['peak'], whole)
        near(row['peak'], whole, 1e-5)


def check_damping():
    """The derivative by the damping is that of differences, at a slipping and at a stuck peak."""
    step, damping = 1e-3, 0.005
    write('damping.csv', 'contact.n0,modal.damping\n' + ''.join(
        f'{n0},{damping * (1 + k * step)!r}\n' for n0 in (20, 1e5) for k in (0, -2, -1, 1, 2)))
    write('damping.yaml', 'case: case.yaml\nplan: {table: damping.csv}\noutputs: [peak]\n')
    run(program('shroudhb'), 'study', '--quiet', 'damping.yaml')
    table = rows('damping.study.csv')
    for i in 0, 5:
        peak, a, b, c, d = (float(row['peak']) for row in table[i:i + 5])
        own = float(table[i]['dpeak_ddamping']) * damping / peak
        relative = (a - 8 * b + 8 * c - d) / (12 * step) / peak
        print(f'{table[i]["contact.n0"]} N: damping {own:.9f}, by differences {relative:.9f}')
        assert abs(own - relative) < 1e-6, (own, relative)


def check_limit():
    """A limit of the stress holds at the optimum, and the safety may be one too."""
    write('best.yaml', 'case: case.yaml\nvary: {contact.n0: {from: 20 N, to: 60 N}}\n'
          'optimise: {minimise: frequency, at_most: {stress: 8 MPa}, at_least: {safety: 2},\n'
          '           evaluations: 8, starts: 1}\noutputs: [peak, frequency]\n')
    said = run(program('shroudhb-study'), 'best.yaml')
    table = rows('best.study.csv')
    good = [row for row in table if float(row['stress']) <= 8e6 and float(row['safety']) >= 2]
    assert 0 < len(good) < len(table), [row['stress'] for row in table]
    best = min(good, key=lambda row: float(row['frequency']))
    assert f'optimum   design {best["design"]},' in said, (best, said)


def check_digest():
    """Another line of fatigue is another design; without a use of it, it is the same."""
    for name, outputs, n in (('with', '[peak, safety]', 2), ('without', '[peak]', 1)):
        text = STUDY.replace('[20 N, 60 N]', '60 N')
        text = text.replace('[peak, frequency, stress, safety, g1]', outputs)
        write(f'{name}.yaml', text.replace('vary: {', 'vary: {material.fatigue.endurance: '
                                           '[300 MPa, 200 MPa], '))
        run(program('shroudhb-study'), '--quiet', f'{name}.yaml')
        table = rows(f'{name}.study.csv')
        assert len({row.get('safety') for row in table}) == n, table
        assert table[0]['peak'] == table[1]['peak'], table


def check_faults():
    """What a case cannot give is refused before anything runs."""
    case = CASE.replace(', fatigue: {endurance: 300 MPa, ultimate: 900 MPa}', '')
    write('plain.yaml', case)
    for output, fault in (('safety', "'safety' needs material.fatigue: {endurance, ultimate}"),
                          ('g2', "'g2' is no output of this case; known: peak, frequency, ")):
        write('bad.yaml', f'case: plain.yaml\nvary: {{contact.mu: 0.3}}\noutputs: [{output}]\n')
        said = run(program('shroudhb-study'), 'bad.yaml', code=2)
        assert fault in said, said
    said = run(program('shroudhb-study'), 'bad.yaml', code=2)
    assert 'stress, safety, rss, tip, g1, modes[I].frequency' in said, said


def main():
    folder, before = tempfile.mkdtemp(), os.getcwd()
    os.chdir(folder)
    try:
        write('case.yaml', CASE)
        for check in (check_values, check_common_modes, check_damping, check_limit, check_digest,
                      check_faults):
            check()
            print(check.__name__, 'passed')
    finally:
        os.chdir(before)
        shutil.rmtree(folder)


main()
