"""robust.kills: stages stopped by signals at random moments; the next run is as an unbroken one.

Usage: test_kills.py FOLDER_OF_PROGRAMS CASE_FOLDER CYCLES [SEED]
CYCLES of each of mesh, modal, mhb. Exit code 77: h5py is missing.
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


def check(stage, case, name):
    words = [program(stage), '--quiet', case]
    started = time.time()
    run(*words, '--force')
    seconds, whole, codes = time.time() - started, content(name), {}
    for _ in range(CYCLES):
        os.remove(name)
        code = stopped(words, name, 1.1 * seconds)
        codes[code] = codes.get(code, 0) + 1
        if os.path.exists(name):
            content(name) # whole, or refused by h5py
        done = subprocess.run(words, env=ENVIRONMENT, capture_output=True, timeout=300)
        assert done.returncode == 0, (stage, code, done.returncode, done.stderr)
        assert content(name) == whole, (stage, code, 'another result')
        left = [entry for entry in os.listdir() if ".tmp." in entry]
        assert not left, (stage, code, left)
    print(f'{stage}: {CYCLES} cycles, exit codes {codes}, results as of an unbroken run',
          flush=True)


with bring_your_own(SCENE):
    run(sys.executable, 'write_modal.py')
    check('mhb', 'case.yaml', 'three_degree.response.h5')
    write('blade.yaml', BLADE.replace('SIZE', '14 mm'))
    check('mesh', 'blade.yaml', 'blade.msh')
    check('modal', 'blade.yaml', 'blade.modal.h5')
