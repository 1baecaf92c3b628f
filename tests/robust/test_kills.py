"""robust.kills: stages stopped by signals at random moments; the next run is as an unbroken one.

Usage: test_kills.py FOLDER_OF_PROGRAMS CASE_FOLDER CYCLES [SEED [STAGE]...]
CYCLES of each of mhb, integrate, post, study, mesh, modal, and of run, which goes from the mesh to
the report. A run of mhb, study or run is stopped up to three times in a row, so that curves are cut
in the middle and cut again. Exit code 77: h5py is missing.
"""
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

try:
    import h5py
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../support'))
from blade import BLADE
from programs import ENVIRONMENT, bring_your_own, run, write
from results import content, table

BIN, SCENE = (os.path.abspath(word) for word in sys.argv[1:3])
CYCLES = int(sys.argv[3])
DICE = random.Random(int(sys.argv[4]) if len(sys.argv) > 4 else 1)
STAGES = sys.argv[5:] or ['mhb', 'integrate', 'post', 'study', 'mesh', 'modal', 'run']
STUDY = '''name: study
case: case.yaml
vary:
  contact.n0: {from: 0.1 N, to: 1 N, points: 4}
  contact.mu: [0.2, 0.4]
'''
ENVIRONMENT['OPENBLAS_NUM_THREADS'] = '1'
# of a start of MPI that fails
MPI = ('MPI_Init', 'PMIX ERROR', 'orte_init', 'ORTE_ERROR_LOG', 'orted', 'ess_singleton')


def program(stage):
    """The words of a stage's program; those of `run` are of the front command."""
    return [os.path.join(BIN, 'shroudhb'), stage] if stage == 'run' else [
        os.path.join(BIN, f'shroudhb-{stage}')]


def wait_for_group(group):
    """Stages of a run that was killed may live a moment longer, with their temporary files."""
    for _ in range(600):
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return
        time.sleep(0.05)


def stopped(words, name, seconds):
    """Stop a run by a random signal at a random moment; its exit code."""
    which = DICE.choice((signal.SIGKILL, signal.SIGTERM, signal.SIGINT))
    with tempfile.TemporaryFile() as errors: # a pipe would be held open by the daemon of MPI
        process = subprocess.Popen(words, env=ENVIRONMENT, start_new_session=True,
                                   stdout=subprocess.DEVNULL, stderr=errors)
        time.sleep(DICE.uniform(0, seconds))
        try:
            os.killpg(process.pid, which)
        except ProcessLookupError:
            pass
        process.wait(timeout=60)
        wait_for_group(process.pid)
        errors.seek(0)
        said = errors.read().decode(errors='replace')
    if process.returncode == 1 and any(text in said for text in MPI): # its daemon was stopped too
        return 1
    # before its handlers are set, and in libraries at start, a signal ends the process at once
    assert process.returncode in (0, 2, 3, 4, 130, -which, 128 + which), (
        name, which, process.returncode, said)
    return process.returncode


def is_cut(name):
    """Whether the file holds a curve that stopped in the middle."""
    if not os.path.exists(name):
        return False
    with h5py.File(name, 'r') as file:
        return any(part.startswith('branch_') and 'resume' in file[part] for part in file)


def clear(names):
    for name in names:
        if os.path.isdir(name):
            shutil.rmtree(name)
        elif os.path.exists(name):
            os.remove(name)


def held(stage, name):
    """What a result holds; of a table without the times of the run, if that was run anew."""
    return table(name) if stage == 'run' and name.endswith('.csv') else content(name)


def check(stage, case, names, in_a_row=1, besides=()):
    """names: what must be as of an unbroken run; besides: what else a cycle must not find."""
    if stage not in STAGES:
        return
    words = [*program(stage), '--quiet', case]
    clear((*names, *besides))
    started = time.time()
    run(*words)
    seconds, codes, cut = time.time() - started, {}, 0
    whole = [held(stage, name) for name in names]
    for _ in range(CYCLES):
        clear((*names, *besides))
        for part in range(DICE.randint(1, in_a_row)):
            code = stopped(words, names[0], 1.1 * seconds / (part + 1))
            codes[code] = codes.get(code, 0) + 1
            for name in filter(os.path.exists, names):
                held(stage, name) # whole, or refused by h5py
            cut += names[0].endswith('.response.h5') and is_cut(names[0])
        done = subprocess.run(words, env=ENVIRONMENT, capture_output=True, timeout=300)
        assert done.returncode == 0, (stage, code, done.returncode, done.stderr)
        for name, expected in zip(names, whole):
            assert held(stage, name) == expected, (stage, code, name, 'another result')
        left = [entry for entry in os.listdir() if ".tmp." in entry]
        assert not left, (stage, code, left)
    print(f'{stage}: {CYCLES} cycles, exit codes {codes}, results as of an unbroken run; '
          f'{cut} times a curve was cut', flush=True)
    assert cut or not names[0].endswith('.response.h5') or stage == 'run' or CYCLES < 16, (
        'no curve was cut')


with bring_your_own(SCENE):
    run(sys.executable, 'write_modal.py')
    check('mhb', 'case.yaml', ['three_degree.response.h5'], 3)
    if 'integrate' in STAGES:
        run(*program('mhb'), '--quiet', 'case.yaml')
    check('integrate', 'case.yaml', ['three_degree.integration.h5'])
    write('study.yaml', STUDY)
    check('study', 'study.yaml', ['study.study.csv', 'study.study.svg'], 3,
          ['study.study.h5', 'study.study.html', 'study.study.d'])
    run(*program('mhb'), '--quiet', 'case.yaml')
    check('post', 'case.yaml', ['three_degree.' + kind for kind in
                                ('html', 'svg', 'csv', 'summary.json')])
    write('blade.yaml', BLADE.replace('SIZE', '14 mm'))
    check('mesh', 'blade.yaml', ['blade.msh'])
    if 'mesh' not in STAGES:
        run(*program('mesh'), '--quiet', 'blade.yaml')
    check('modal', 'blade.yaml', ['blade.modal.h5'])
    check('run', 'blade.yaml', ['blade.' + kind for kind in
                                ('response.h5', 'modal.h5', 'msh', 'svg', 'csv')], 3,
          ['blade.html', 'blade.summary.json'])
