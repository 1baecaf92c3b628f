"""robust.same_bits: numbers do not depend on threads; those of the modes on ranks to 1e-12.

Usage: test_same_bits.py FOLDER_OF_PROGRAMS CASE_FOLDER. Exit code 77: h5py is missing.
"""
import os
import sys

try:
    import h5py
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../support'))
from blade import BLADE
from programs import ENVIRONMENT, bring_your_own, run, write
from results import numbers

BIN, SCENE = (os.path.abspath(word) for word in sys.argv[1:3])


def program(stage):
    return os.path.join(BIN, f'shroudhb-{stage}')


def threads_change_nothing():
    run(sys.executable, 'write_modal.py')
    first = None
    for threads in 1, 2, 3:
        ENVIRONMENT['OMP_NUM_THREADS'] = str(threads)
        run(program('mhb'), '--quiet', '--force', 'case.yaml')
        found = numbers('three_degree.response.h5')
        first = first or found
        different = [name for name in first.keys() | found.keys()
                     if first.get(name) != found.get(name)]
        assert len(found) > 50 and not different, (threads, different)
    print(f'1, 2, 3 threads: {len(first)} datasets alike to the last bit')


def threads_change_no_mode():
    write('blade.yaml', BLADE.replace('SIZE', '14 mm'))
    run(program('mesh'), '--quiet', 'blade.yaml')
    first = None
    for threads in 1, 2, 3:
        ENVIRONMENT['OMP_NUM_THREADS'] = str(threads)
        run(program('modal'), '--quiet', '--force', 'blade.yaml')
        found = numbers('blade.modal.h5')
        first = first or found
        different = [name for name in first.keys() | found.keys()
                     if first.get(name) != found.get(name)]
        assert len(found) > 20 and not different, (threads, different)
    print(f'modal stage, 1, 2, 3 threads: {len(first)} datasets alike to the last bit')


def frequencies(ranks):
    run('mpiexec', '-n', str(ranks), '--oversubscribe', program('modal'), '--quiet', '--force',
        'blade.yaml')
    with h5py.File('blade.modal.h5', 'r') as file:
        return file['modes/frequency'][()], numbers('blade.modal.h5')


def ranks_change_the_last_digits():
    write('blade.yaml', BLADE.replace('SIZE', '14 mm'))
    run(program('mesh'), '--quiet', 'blade.yaml')
    one, all_of_one = frequencies(1)
    again, all_again = frequencies(1)
    assert all_of_one == all_again, 'two runs of one rank differ'
    two, _ = frequencies(2)
    worst = max(abs(two / one - 1))
    print(f'1 and 2 ranks: frequencies differ by {worst:.1e} at most; bound 1e-12')
    assert worst < 1e-12 and len(one) == 3


with bring_your_own(SCENE):
    threads_change_nothing()
    threads_change_no_mode()
    ranks_change_the_last_digits()
