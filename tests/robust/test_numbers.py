"""robust.numbers: odd numbers in every numeric key of a small case.

Usage: test_numbers.py FOLDER_OF_PROGRAMS CASE_FOLDER [KEY]... Exit code 77: no h5py.

A number is refused in one line, or the sweep ends in ten seconds of CPU time with results that are
finite. `refused` are texts that are no numbers at all.
"""
import os
import re
import resource
import subprocess
import sys

try:
    import h5py
    import numpy
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../support'))
from programs import ENVIRONMENT, bring_your_own, run, write

BIN, SCENE = (os.path.abspath(word) for word in sys.argv[1:3])
RESPONSE = 'three_degree.response.h5'
KEYS = {'contact.psi': 'deg', 'contact.phi': 'deg', 'contact.mu': '', 'contact.ku': 'N/m',
        'contact.kv': 'N/m', 'contact.n0[0]': 'N', 'mhb.frequency[0]': 'Hz',
        'mhb.frequency[1]': 'Hz', 'mhb.harmonics': '', 'mhb.tolerance': '', 'mhb.max_points': '',
        'mhb.search.starts': '', 'converge.seconds': ''}
NUMBERS = ('1e308', '-1e308', '1e-308', '5e-324', '+0', '-0', '0.0', '1e400', '-1e400',
           '99999999999999999999999999', '-99999999999999999999999999', '2147483648',
           '1' + 400 * '0', '0.' + 400 * '0' + '1')
REFUSED = ('0x10', '1_000', '1,5', 'nan', 'inf', '-inf', '.inf', '.nan', '1e', '--1', '1e1e1',
           '0o7')
SECONDS = 10 # of CPU time
ENVIRONMENT.update(OMP_NUM_THREADS='1', OPENBLAS_NUM_THREADS='1')


def attempt(stage, *words):
    """Exit code and lines. A run beyond its CPU time ends by a signal."""
    done = subprocess.run([os.path.join(BIN, stage), *words], env=ENVIRONMENT, capture_output=True,
                          text=True, timeout=500, preexec_fn=lambda: resource.setrlimit(
                              resource.RLIMIT_CPU, (SECONDS, SECONDS)))
    return done.returncode, (done.stdout + done.stderr).splitlines()


def not_finite():
    """Datasets of results that hold what is no number; errors may be unknown."""
    found = []
    with h5py.File(RESPONSE, 'r') as file:
        for branch in (file[part] for part in file if part.startswith('branch_')):
            found += [branch[key].name for key in ('frequency', 'n0', 'motion', 'force', 'probe')
                      if key in branch and not numpy.isfinite(branch[key][...]).all()]
    return found


def outcome(key, text):
    """refused, or computed; AssertionError: neither."""
    word = f'{key}={text}'
    code, said = attempt('shroudhb', 'check', '--quiet', '--set', word, 'case.yaml')
    errors = [line for line in said if 'error: ' in line]
    # a unit or a mapping may be told with the number
    assert code == (2 if errors else 0) and len(errors) <= 2, (word, code, said)
    if errors:
        assert key.partition('[')[0] in errors[0], (word, said)
        return 'refused'
    if os.path.exists(RESPONSE):
        os.remove(RESPONSE)
    code, said = attempt('shroudhb-mhb', '--quiet', '--set', word, 'case.yaml')
    errors = [line for line in said if 'error: ' in line]
    assert code in (0, 2, 3) and len(errors) == (code == 2), (word, code, said)
    if code == 2:
        return 'refused'
    assert not not_finite(), (word, not_finite())
    return 'computed'


def check(key, unit):
    faults, ends = [], {}
    for number in NUMBERS + REFUSED:
        try:
            end = outcome(key, f'{number} {unit}'.strip())
            assert end == 'refused' or number not in REFUSED, (key, number, 'is taken for a number')
            ends[end] = ends.get(end, 0) + 1
        except AssertionError as fault:
            faults.append(str(fault))
    print(key, ends, *faults, sep='\n  ', flush=True)
    return faults


with bring_your_own(SCENE):
    run(sys.executable, 'write_modal.py')
    case = re.sub(r'n0: .*', 'n0: [0.3 N]', open('case.yaml').read())
    write('case.yaml', re.sub(r'harmonics: .*', 'harmonics: 3', case))
    bad = [fault for key, unit in KEYS.items() if key in (sys.argv[3:] or KEYS)
           for fault in check(key, unit)]
    assert not bad, f'{len(bad)} numbers'
