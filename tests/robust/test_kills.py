"""robust.kills: stages stopped by signals at random moments; the next run is as an unbroken one.

Usage: test_kills.py FOLDER_OF_PROGRAMS CASE_FOLDER CYCLES [SEED]
CYCLES of each of mesh, modal, mhb. A run of mhb is stopped up to three times in a row, so that
curves are cut in the middle and cut again. Exit code 77: h5py is missing.
"""
import os
import random
import signal
import subprocess
import sys
import time

try:
    import h5py
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../support'))
from blade import BLADE
from programs import ENVIRONMENT, bring_your_own, run, write
from results import content

BIN, SCENE = (os.path.abspath(word) for word in sys.argv[1:3])
CYCLES = int(sys.argv[3])
DICE = random.Random(int(sys.argv[4]) if len(sys.argv) > 4 else 1)
ENVIRONMENT['OPENBLAS_NUM_THREADS'] = '1'


def program(stage):
    return os.path.join(BIN, f'shroudhb-{stage}')


def stopped(words, name, seconds):
    """Stop a run by a random signal at a random moment; its exit code."""
    which = DICE.choice((signal.SIGKILL, signal.SIGTERM, signal.SIGINT))
    process = subprocess.Popen(words, env=ENVIRONMENT, start_new_session=True,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    time.sleep(DICE.uniform(0, seconds))
    try:
        os.killpg(process.pid, which)
    except ProcessLookupError:
        pass
    process.communicate(timeout=60)
    # before its handlers are set, and in libraries at start, a signal ends the process at once
    assert process.returncode in (0, 2, 3, 4, 130, -which, 128 + which), (
        name, which, process.returncode)
    return process.returncode


def is_cut(name):
    """Whether the file holds a curve that stopped in the middle."""
    if not os.path.exists(name):
        return False
    with h5py.File(name, 'r') as file:
        return any(part.startswith('branch_') and 'resume' in file[part] for part in file)


def check(stage, case, name, in_a_row=1):
    words = [program(stage), '--quiet', case]
    started = time.time()
    run(*words, '--force')
    seconds, whole, codes, cut = time.time() - started, content(name), {}, 0
    for _ in range(CYCLES):
        os.remove(name)
        for part in range(DICE.randint(1, in_a_row)):
            code = stopped(words, name, 1.1 * seconds / (part + 1))
            codes[code] = codes.get(code, 0) + 1
            if os.path.exists(name):
                content(name) # whole, or refused by h5py
            cut += name.endswith('.response.h5') and is_cut(name)
        done = subprocess.run(words, env=ENVIRONMENT, capture_output=True, timeout=300)
        assert done.returncode == 0, (stage, code, done.returncode, done.stderr)
        assert content(name) == whole, (stage, code, 'another result')
        left = [entry for entry in os.listdir() if ".tmp." in entry]
        assert not left, (stage, code, left)
    print(f'{stage}: {CYCLES} cycles, exit codes {codes}, results as of an unbroken run; '
          f'{cut} times a curve was cut', flush=True)
    assert cut or in_a_row == 1 or CYCLES < 16, 'no curve was cut in the middle'


with bring_your_own(SCENE):
    run(sys.executable, 'write_modal.py')
    check('mhb', 'case.yaml', 'three_degree.response.h5', 3)
    write('blade.yaml', BLADE.replace('SIZE', '14 mm'))
    check('mesh', 'blade.yaml', 'blade.msh')
    check('modal', 'blade.yaml', 'blade.modal.h5')
