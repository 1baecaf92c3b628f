"""robust.same_bits: numbers do not depend on threads, on ranks of one machine, or on its load;
frequencies of distributed ranks to 1e-12.

Usage: test_same_bits.py FOLDER_OF_PROGRAMS CASE_FOLDER. Exit code 77: h5py is missing.
"""
import contextlib
import os
import subprocess
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
CORES = len(os.sched_getaffinity(0))


def program(stage):
    return os.path.join(BIN, f'shroudhb-{stage}')


@contextlib.contextmanager
def machine_load(processes):
    """Busy processes beside the run."""
    busy = [subprocess.Popen([sys.executable, '-c', 'while True: pass'])
            for _ in range(processes)]
    try:
        yield
    finally:
        for process in busy:
            process.kill()
            process.wait()


def same_numbers(stage, case, name, least):
    """1, 2 threads, and an odd number above that of cores on a busy machine: the same numbers."""
    first = None
    for threads, load in (1, 0), (2, 0), (2 * CORES + 1, CORES):
        ENVIRONMENT['OMP_NUM_THREADS'] = str(threads)
        with machine_load(load):
            run(program(stage), '--quiet', '--force', case)
        found = numbers(name)
        first = first or found
        different = [key for key in first.keys() | found.keys() if first.get(key) != found.get(key)]
        assert len(found) > least and not different, (stage, threads, load, different)
    print(f'{stage}: 1, 2 threads, and {threads} beside {load} busy processes: {len(first)} '
          'datasets alike to the last bit')


def load_and_threads_change_nothing():
    run(sys.executable, 'write_modal.py')
    same_numbers('mhb', 'case.yaml', 'three_degree.response.h5', 50)
    same_numbers('integrate', 'case.yaml', 'three_degree.integration.h5', 50)
    write('blade.yaml', BLADE.replace('SIZE', '14 mm'))
    run(program('mesh'), '--quiet', 'blade.yaml')
    same_numbers('modal', 'blade.yaml', 'blade.modal.h5', 20)


def modal_numbers(ranks, *options):
    run('mpiexec', '-n', str(ranks), '--oversubscribe', program('modal'), '--quiet', '--force',
        'blade.yaml', *options)
    return numbers('blade.modal.h5')


def ranks_of_one_machine_change_nothing():
    one = modal_numbers(1)
    for ranks in 2, 3:
        assert modal_numbers(ranks) == one, ranks
    print(f'1, 2, 3 ranks: {len(one)} datasets alike to the last bit')


def frequencies(ranks):
    modal_numbers(ranks, '-st_pc_factor_mat_solver_type', 'mumps')
    with h5py.File('blade.modal.h5', 'r') as file:
        return file['modes/frequency'][()], file['phases'].attrs['ranks']


def distributed_ranks_change_the_last_digits():
    one, _ = frequencies(1)
    for ranks in 2, 3:
        found, told = frequencies(ranks)
        worst = max(abs(found / one - 1))
        print(f'1 and {ranks} distributed ranks: frequencies differ by {worst:.1e} at most; '
              'bound 1e-12')
        assert worst < 1e-12 and len(one) == 3 and told == ranks


with bring_your_own(SCENE):
    load_and_threads_change_nothing()
    ranks_of_one_machine_change_nothing()
    distributed_ranks_change_the_last_digits()
