"""cases.study.study_inputs: what a study file says is what is meant, or is asked back.

Usage: test_study_inputs.py BIN CASE_FOLDER, with the programs in BIN. Exit code 77: no
h5py.
"""
import os
import subprocess
import sys
import time

try:
    import h5py # for write_modal.py
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../support'))
from programs import bring_your_own, run, write

BIN, SCENE = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])


def check(text, code=0, name='s.yaml', case='case.yaml'):
    """What `shroudhb check` says of a study of the case."""
    write(name, f'case: {case}\n' + text)
    return run(os.path.join(BIN, 'shroudhb'), 'check', name, code=code)


def refuses(text, message):
    said = check(text, 2)
    assert message in said and said.count('error:') == 1, f'{text}: {said}'


def check_percent():
    """A deviation in percent is relative to the mean, unless the mean is in percent."""
    for numbers, said in (('{normal: [0.3, 10 %]}', 'normal, mean 0.3, deviation 0.03 (10 %)'),
                          ('{normal: [0.3, 0.1]}', 'normal, mean 0.3, deviation 0.1 (33.3 %)'),
                          ('{lognormal: [0.3, 5%]}', 'lognormal, mean 0.3, deviation 0.015 (5 %)'),
                          ('{normal: [30 %, 3 %]}', 'normal, mean 0.3, deviation 0.03 (10 %)'),
                          ('{truncated_normal: [0.3, 10 %, 0.25, 0.35]}',
                           'mean 0.3, deviation 0.03 (10 %), from 0.25, to 0.35')):
        out = check(f'uncertain: {{contact.mu: {numbers}}}\nsamples: 8\n')
        assert f'uncertain contact.mu: {numbers[1:numbers.index(":")]}' in out and said in out, out
    out = check('uncertain: {contact.n0: {normal: [0.4 N, 10 %]}}\nsamples: 8\n')
    assert 'contact.n0: normal, mean 0.4 N, deviation 0.04 N (10 %)' in out, out
    for numbers in '{uniform: [0.2, 10 %]}', '{triangular: [0.1, 0.2, 30 %]}', \
            '{truncated_normal: [0.3, 0.03, 20 %, 0.4]}':
        refuses(f'uncertain: {{contact.mu: {numbers}}}\nsamples: 8\n', 'percent of what?')
    for numbers in '{triangular: [10 %, 0.2, 30 %]}', '{normal: [30 %, 0.03]}', \
            '{uniform: [20 %, 0.4]}':
        refuses(f'uncertain: {{contact.mu: {numbers}}}\nsamples: 8\n', 'percent of what?')
    refuses('uncertain: {modal.damping: {lognormal: [0.2 %, 10 %]}}\nsamples: 8\n',
            "'10 %' of a mean of '0.2 %': is it relative to the mean?")


def check_commas():
    """A decimal comma is told where it stands, as in a case file."""
    for values, told in (('[0,2, 0,4]', '0,2 has a decimal comma; write 0.2'),
                         ('[0.2, 0,4]', '0,4 has a decimal comma; write 0.4'),
                         ('[0,05]', '0,05 has a decimal comma; write 0.05'),
                         ('[0,2,0,4]', '0,2 has a decimal comma; write 0.2'),
                         ('[0,25,1,5]', '0,25 has a decimal comma; write 0.25'),
                         ('{from: 0,1, to: 0.4, points: 3}',
                          'vary.contact.n0.from: 0,1 has a decimal comma; write 0.1'),
                         ('{from: 0.1, to: 0,4, points: 3}',
                          'vary.contact.n0.to: 0,4 has a decimal comma; write 0.4'),
                         ('{from: 0.1, to: 0.4, points: 2,5}',
                          'vary.contact.n0.points: 2,5 has a decimal comma'),
                         ('0,3', 'write 0.3 with a decimal point')):
        refuses(f'vary: {{contact.n0: {values}}}\n' if values[0] != '0' else
                f'vary:\n  contact.n0: {values}\n', told)
    refuses('vary: {contact.n0: [0,2 N, 0,4 N]}\n', '0,2 N has a decimal comma; write 0.2 N')
    refuses('uncertain: {contact.mu: {normal: [0,3, 0,05]}}\nsamples: 8\n',
            '0,3 has a decimal comma')
    refuses('vary: {contact.n0: 0,3}\n', 'vary.contact.n0: 0,3 has a decimal comma; write 0.3')
    refuses('vary: {contact.n0: {from: 0.1, to: 1}}\n'
            'optimise: {minimise: peak, at_most: {peak: 0,1 mm}}\n',
            'optimise.at_most.peak: 0,1 mm has a decimal comma; write 0.1 mm')
    for values in '[0,2,4]', '[1,2,3,4]', '[1, 2, 4]', '[0.2,0.4, 0.6]', '[ 1 , 2 ]':
        check(f'vary: {{contact.n0: {values}}}\n')


def check_limits():
    """A bare limit of stress is asked back; limits are shown as engineers write them."""
    optimise = 'vary: {{contact.n0: {{from: 0.1 N, to: 1 N}}}}\noptimise: {{minimise: peak, {}}}\n'
    out = check(optimise.format('at_most: {frequency: 150 Hz, peak: 2 mm}, evaluations: 20'))
    assert 'limit     frequency at most 150 Hz' in out and 'limit     peak at most 2 mm' in out, out
    assert 'cost      at most 20 sweeps' in out, out
    run(sys.executable, '-c', 'import h5py, numpy as np\n'
        'h = h5py.File("three_degree.modal.h5", "r+")\n'
        'n = len(h["modes/frequency"])\nh["modes/stress"] = np.zeros((2, 6, n))\n'
        'h["mesh/points"] = np.zeros((2, 3))\n')
    for bare in '80', '0.5', '8e4', '-80':
        refuses(optimise.format(f'at_most: {{stress: {bare}}}'),
                f'stress: {bare} Pa: did you mean {bare} MPa?')
    for given, shown in ('80 MPa', '80 MPa'), ('80 Pa', '80 Pa'), ('80e6', '80 MPa'), \
            ('12 kPa', '0.012 MPa'):
        out = check(optimise.format(f'at_least: {{stress: {given}}}'))
        assert f'limit     stress at least {shown}' in out, out
    run(sys.executable, 'write_modal.py')
    refuses(optimise.format('at_least: {frequency: -1 Hz}'),
            'frequency: -1 Hz: no design is below 0')
    check(optimise.format('at_most: {peak: 1}')) # the modal file may have any size
    meshed = os.path.join(SCENE, '..', 'first_case', 'case.yaml')
    for bare, code in ('1', 2), ('100', 2), ('0.001', 0), ('60 mm', 0):
        out = check('vary: {contact.n0: {from: 10 N, to: 100 N}}\n'
                    f'optimise: {{minimise: peak, at_most: {{peak: {bare}}}}}\n', code, case=meshed)
        assert code == 0 or f'peak: {bare} m: did you mean {bare} mm?' in out, out


def check_echo():
    """Keys, plan, outputs and what designs of this case took."""
    out = check('name: echo\nvary: {contact.n0: {from: 0.1 N, to: 1 N, points: 4, scale: log}, '
                'contact.psi: [0.1, 0.2], contact.kv: 0.8}\noutputs: [peak, frequency]\n')
    for line in ('vary      contact.n0: 0.1 N to 1 N, 4 points, in equal ratios',
                 'vary      contact.psi: 5.72958 deg, 11.4592 deg', 'vary      contact.kv: 0.8 N/m',
                 'designs   8', 'outputs   peak, frequency',
                 'cost      8 sweeps; no design of this case is known yet'):
        assert line in out, (line, out)
    write('known.yaml', 'case: case.yaml\nvary: {contact.n0: [0.3 N, 0.5 N]}\n')
    run(os.path.join(BIN, 'shroudhb'), 'study', '--quiet', 'known.yaml')
    out = check('vary: {contact.n0: {from: 0.1 N, to: 1 N, points: 4}}\n')
    assert 'as 2 known designs took' in out and 'cost      4 sweeps: about ' in out, out
    out = check('vary: {contact.n0: {from: 0.1 N, to: 1 N, points: 300000}}\n', 2)
    assert 'must be 1 to 100000' in out, out
    refuses('vary: {contact.n0: [0.3 N]}\noutputs: [peak, frequency, peak]\n',
            "'peak' is output 1 already")


def check_names():
    """A study is called as a case may be."""
    for name in '"a b"', 'größe', 'x.1':
        check(f'name: {name}\nvary: {{contact.n0: [0.3]}}\n')
    for name in '"a\\x1b[31mRED"', '"a\\nb"', '"-rf"', '"."', '".."', '"a/b"', '""', \
            '"\\u202egnp.b"', 'x' * 101:
        refuses(f'name: {name}\nvary: {{contact.n0: [0.3]}}\n', 'cannot be a file name')


def check_tables():
    """Tables as spreadsheets write them, and 100,000 rows."""
    def table(data):
        with open('t.csv', 'wb') as out:
            out.write(data)
    plan = 'plan: {table: t.csv}\n'
    for data in (b'\xef\xbb\xbfcontact.n0,contact.mu\n0.2,0.3\n',
                 b'"contact.n0","contact.mu"\n"0.2 N","0.3"\n',
                 b'contact.n0;contact.mu\r\n0.2;0.3\r\n',
                 b'contact.n0\tcontact.mu\r0.2\t0.3\r',
                 b'# from the rig\ncontact.n0,contact.mu\n\n0.2,0.3,\n'):
        table(data)
        out = check(plan)
        assert 'designs   1' in out and 'contact.n0: 0.2 N\n' in out, (data, out)
    for data, message in ((b'contact.n0,contact.mu\n0,2,0,3\n', 'numbers have a decimal point'),
                          (b'contact.n0;contact.mu\n0,2;0.3\n', 'write 0.2 with a decimal point'),
                          (b'0.2,0.3\n0.4,0.5\n', 'it must name the varied keys'),
                          (b'contact.n0,contact.mu\n"0.2,0.3\n', 'is not closed'),
                          (b'contact.n0,contact.mu\n0.2,0.3\n0.2,\n', 't.csv:3: row 2 has 1'),
                          (b'', 'the table is empty')):
        table(data)
        refuses(plan, message)
    table(b'contact.n0,contact.mu\n' + b''.join(b'%g,0.3\n' % (0.1 + 1e-6 * i)
                                                for i in range(100000)))
    began = time.monotonic()
    out = check(plan)
    print(f'100,000 rows are checked in {time.monotonic() - began:.1f} s')
    assert 'designs   100000' in out and 'vary      contact.n0: 0.1 N to 0.199999 N' in out, out
    with open('t.csv', 'ab') as out:
        out.write(b'1,0.3\n')
    refuses(plan, '100001 designs; at most 100000')


with bring_your_own(SCENE):
    subprocess.run([sys.executable, 'write_modal.py'], check=True)
    with open('case.yaml', encoding='utf-8') as source:
        case = source.read()
    write('case.yaml', case.replace('n0: [-0.2 N, 0 N, 0.3 N, 1.0 N]', 'n0: 0.3 N'))
    check_percent()
    check_commas()
    check_limits()
    check_echo()
    check_names()
    check_tables()
