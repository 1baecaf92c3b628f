"""cases.commands.revision: other damping and load in a modal file, without solving for modes again.

The file must be that of a new solution. Usage: test_revision.py SHROUDHB FIRST_CASE. Exit code 77:
h5py is missing.
"""
import os
import sys
import tempfile

try:
    import h5py
    import numpy as np
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../support'))
from programs import run

SHROUDHB, CASE = (os.path.abspath(word) for word in sys.argv[1:3])
CHANGES = ['--set', 'modal.damping={rayleigh: [5, 1e-6]}', '--set', 'excitation.pressure=3.3 kPa',
           '--set', 'excitation.harmonics={1: [0.5, 90 deg]}']
# Datasets that depend on the scale of a column: their products are compared.
SCALED = ('residual/shape', 'residual/stress', 'residual/load_weight')
TOLERANCE = 1e-6  # of the largest value: terms without the modes are small differences


def modal(*words):
    return run(SHROUDHB, 'modal', CASE, '--into', '.', *words)


def differences(a, b):
    """Largest relative difference of each dataset of numbers."""
    found = {}

    def compare(name, one):
        if not isinstance(one, h5py.Dataset) or one.dtype.kind not in 'fci' or 'phases' in name:
            return
        x, y = one[()], b[name][()]
        assert x.shape == y.shape, name
        found[name] = np.abs(x - y).max() / np.abs(y).max() if x.size and np.abs(y).max() else 0

    a.visititems(compare)
    return found


def load_column(file):
    """Static response of the whole blade to each harmonic of the load."""
    weight, shape = file['residual/load_weight'][()], file['residual/shape'][()]
    return np.einsum('kc,cni->kni', weight, shape[-weight.shape[1]:])


def main():
    modal()
    said = modal('--verbose', *CHANGES)
    assert 'keeps its modes; damping or load changed' in said, said
    assert 'is up to date' in modal('--verbose', *CHANGES)
    os.rename('first_case.modal.h5', 'revised.h5')
    modal(*CHANGES)
    with h5py.File('revised.h5') as a, h5py.File('first_case.modal.h5') as b:
        assert a.attrs['settings'] == b.attrs['settings']
        found = differences(a, b)
        assert len(found) > 30 and 'load/modal_force' in found and 'receptance/contact' in found
        worst = {name: by for name, by in found.items() if by > TOLERANCE and name not in SCALED}
        assert not worst, worst
        assert found['modes/damping_ratio'] < 1e-15 and found['load/modal_force'] < 1e-13, found
        assert found['modes/frequency'] == 0 and found['receptance/contact'] < 1e-12, found
        x, y = load_column(a), load_column(b)
        assert np.abs(x - y).max() < 1e-6 * np.abs(y).max()  # shapes are single precision
    said = run(SHROUDHB, 'modal', CASE, '--into', '.', '--set',
               'modal.damping={rayleigh: [1e5, 0]}', code=2)
    assert 'would have the damping ratio' in said, said
    said = modal('--verbose', *CHANGES, '--set', 'material.E=200 GPa')
    assert 'keeps its modes' not in said and 'is up to date' not in said, said
    print(f'{len(found)} datasets as of a new solution, apart by at most '
          f'{max(by for name, by in found.items() if name not in SCALED):.1e}')


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    main()
    os.chdir('/')
