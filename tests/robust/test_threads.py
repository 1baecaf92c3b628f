"""robust.threads: the thread sanitizer over sweeps, a ring, a study and a disc with two threads.

Usage: test_threads.py FOLDER_OF_PROGRAMS RACE CASE_FOLDER [SCENE]...
The programs are those of the preset tsan; without a scene all run. RACE is a program with a race,
which must be found first. Exit code 77: no h5py, or no libarcher.so.

libarcher.so tells the sanitizer of OpenMP's synchronisation. Libraries that are not instrumented
(OpenBLAS, HDF5, FFTW, PETSc, gmsh, MPI) synchronise unseen, so what they access is not judged.
"""
import glob
import os
import re
import subprocess
import sys

try:
    import h5py  # of write_modal.py
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../support'))
from blade import BLADE
from programs import ENVIRONMENT, bring_your_own, run, write

BIN, RACE, CASES = (os.path.abspath(word) for word in sys.argv[1:4])
FOUND = 66 # exit code of the sanitizer
ENVIRONMENT.update(OMP_NUM_THREADS='2', OPENBLAS_NUM_THREADS='1')

SMALL = BLADE.replace('SIZE', '14 mm').replace('blades: 60', 'blades: 12')
RING = SMALL.replace('engine_order: 56', 'engine_order: 3')
PRELOADS = RING.replace('n0: [20 N]', 'n0: [5 N, 20 N, 80 N]')
MISTUNED = PRELOADS.replace('blades: 12', 'blades: 12, mistuning: {deviation: 1 %, seed: 7}')
SAMPLES = RING.replace('blades: 12',
                       'blades: 6, mistuning: {deviation: 1 %, seed: 7, samples: 2}')
LASTING = PRELOADS.replace('harmonics: 3', 'harmonics: 3, lasting: always')
TRACKED = RING.replace('n0: [20 N]', 'n0: 20 N').replace(
    'harmonics: 3', 'harmonics: 3, track: peak, vary: {n0: [10 N, 40 N]}')
MANY = RING.replace('SIZE', '8 mm').replace('psi:', 'points: all, psi:')
DISC = PRELOADS.replace('modes: 3,', 'modes: 3, nodal_diameters: all,').replace(
    '  blade:\n', '''  blade:
    disc: {bore: 120 mm, web: 12 mm, rim: 25 mm}
    elements: tet10
''', 1)
STUDY = '''name: study
case: preloads.yaml
vary:
  contact.n0: {from: 5 N, to: 80 N, scale: log}
  contact.mu: {from: 0.1, to: 0.5}
'''
GRID = STUDY + 'plan: {sobol: 8, seed: 1}\n'
OPTIMUM = STUDY + 'optimise: {minimise: peak, evaluations: 24, starts: 3, algorithm: sbplx}\n'


def archer():
    found = glob.glob('/usr/lib/llvm-*/lib/libarcher.so')
    if not found:
        sys.exit(77)
    return found[0]


def judged(*words, verbose=0):
    """Run a program; its data races as texts. A run that fails for another reason is an error.
    verbose: archer prints that it is there, on the output where designs send their answers."""
    more = dict(OMP_TOOL_LIBRARIES=archer(), ARCHER_OPTIONS=f'verbose={verbose}',
                TSAN_OPTIONS=f'ignore_noninstrumented_modules=1 exitcode={FOUND} history_size=4')
    done = subprocess.run(words, env=dict(ENVIRONMENT, **more), capture_output=True, text=True,
                          errors='replace', timeout=1200)
    said = done.stdout + done.stderr
    assert done.returncode in (0, FOUND), (words, done.returncode, said[-2000:])
    if done.returncode == 0 or 'ThreadSanitizer' in said:
        return re.findall(r'={18}\n(WARNING: ThreadSanitizer.*?)={18}', said, re.S), said
    raise AssertionError((words, said[-2000:]))


def program(stage):
    return os.path.join(BIN, f'shroudhb-{stage}')


def control():
    """The sanitizer finds a race, and none where OpenMP orders the threads."""
    races, _ = judged(RACE)
    assert races, 'the race of the control program was not found'
    races, said = judged(RACE, 'ordered', verbose=1)
    assert not races and 'Archer detected' in said, (races, said)
    return []


def sweep(name, text, *stages):
    """Mesh and modes are made once a text; then the stages are judged."""
    def judge():
        write(f'{name}.yaml', text.replace('name: blade', f'name: {name}'))
        found = []
        for stage in stages:
            found += judged(program(stage), '--quiet', '--force', f'{name}.yaml')[0]
        return found
    return judge


def own_modes():
    run(sys.executable, 'write_modal.py')
    found = judged(program('mhb'), '--quiet', '--force', 'case.yaml')[0]
    return found + judged(program('integrate'), '--quiet', 'case.yaml')[0]


def study(name, text):
    def judge():
        write('preloads.yaml', PRELOADS.replace('name: blade', 'name: preloads'))
        write(f'{name}.yaml', text.replace('name: study', f'name: {name}'))
        return judged(program('study'), '--quiet', f'{name}.yaml')[0]
    return judge


SCENES = {
    'control': control,
    'own_modes': own_modes,
    'preloads': sweep('preloads', PRELOADS, 'mesh', 'modal', 'mhb'),
    'mistuned': sweep('mistuned', MISTUNED, 'mesh', 'modal', 'mhb'),
    'samples': sweep('samples', SAMPLES, 'mesh', 'modal', 'mhb'),
    'lasting': sweep('lasting', LASTING, 'mesh', 'modal', 'mhb'),
    'tracked': sweep('tracked', TRACKED, 'mesh', 'modal', 'mhb'),
    'many_pairs': sweep('many_pairs', MANY, 'mesh', 'modal', 'mhb'),
    'disc': sweep('disc', DISC, 'mesh', 'modal', 'mhb'),
    'study': study('grid', GRID),
    'optimum': study('optimum', OPTIMUM),
}


def main():
    bad = 0
    with bring_your_own(CASES):
        for name in sys.argv[4:] or SCENES:
            races = SCENES[name]()
            print(f'{name}: {len(races)} races', flush=True)
            for text in races:
                print(text)
            bad += len(races)
    assert bad == 0, f'{bad} races'


main()
