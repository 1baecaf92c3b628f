"""robust.not_finite: no stage publishes what is not finite; it is refused in one line.

Usage: test_not_finite.py FOLDER_OF_PROGRAMS CASE_FOLDER. Exit code 77: no h5py.
"""
import os
import subprocess
import sys

try:
    import h5py
    import numpy
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../support'))
from blade import BLADE
from programs import ENVIRONMENT, bring_your_own, run, write

BIN, SCENE = (os.path.abspath(word) for word in sys.argv[1:3])
MODAL, RESPONSE = 'three_degree.modal.h5', 'three_degree.response.h5'


def end_of(stage, case):
    """Exit code and lines of a stage."""
    done = subprocess.run([os.path.join(BIN, f'shroudhb-{stage}'), '--quiet', case],
                          env=ENVIRONMENT, capture_output=True, text=True, timeout=100)
    return done.returncode, done.stderr.splitlines()


def infinite(name):
    """Datasets of motion and force that hold what is no number; residual errors may be unknown."""
    found = []
    with h5py.File(name, 'r') as file:
        for branch in (file[part] for part in file if part.startswith('branch_')):
            found += [branch[key].name for key in ('frequency', 'n0', 'motion', 'force', 'probe')
                      if key in branch and not numpy.isfinite(branch[key][...]).all()]
    return found


def check_modal_file(name, value):
    run(sys.executable, 'write_modal.py')
    with h5py.File(MODAL, 'r+') as file: # harmonics 0 and 1, three displacements
        file[name] = numpy.full(file['load/modal_force'].shape, complex(value))
    code, said = end_of('mhb', 'case.yaml')
    print(f'/{name} of {value:g}: code {code}', *said)
    if os.path.exists(RESPONSE):
        assert code in (0, 3) and not infinite(RESPONSE), (name, value, code, infinite(RESPONSE))
        os.remove(RESPONSE)
    else:
        assert code in (2, 3) and len(said) == 1, (name, value, code, said)
    return code


with bring_your_own(SCENE):
    codes = [check_modal_file(name, value) for value in (1e300, 1.7e308)
             for name in ('probe/load_inertia', 'load/residual_response')]
    assert codes[2] == 2, codes # times the square of the frequency it is no number
    write('blade.yaml', BLADE.replace('SIZE', '18 mm').replace(
        'pressure: 2 kPa}', 'pressure: 2 kPa, harmonics: {1: [1e300, 0 deg]}}'))
    for stage in 'mesh', 'modal':
        code, said = end_of(stage, 'blade.yaml')
        print(stage, code, *said[:1])
        assert code == 2 and 'excitation.harmonics' in said[0], (stage, code, said)
        assert not os.path.exists('blade.modal.h5')
