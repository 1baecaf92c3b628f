"""robust.kills_ring: a run over a ring of different blades is stopped in the middle of its curve.

Usage: test_kills_ring.py FOLDER_OF_PROGRAMS CASE_FOLDER CYCLES [SEED]
A run is stopped by SIGTERM, which leaves a curve that is not finished. The run that goes on is
killed by SIGKILL. The one after that ends, with the bits of an unbroken run. Exit code 77: h5py is
missing.
"""
import os
import random
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
from programs import ENVIRONMENT, run
from results import numbers

BIN, SCENE = (os.path.abspath(word) for word in sys.argv[1:3])
CYCLES, PARTS = int(sys.argv[3]), 6
DICE = random.Random(int(sys.argv[4]) if len(sys.argv) > 4 else 1)
FILE = 'ring.response.h5'

# coarse blades with few modes, one preload that slips at the resonance: two seconds of a processor
SETTINGS = {'name': 'ring', 'mesh.blade.size': '15 mm', 'rotor.blades': '12',
            'excitation.engine_order': '3', 'modal.modes': '8', 'contact.n0': '[1 N]',
            'mhb.harmonics': '7', 'mhb.stability': 'never', 'mhb.frequency': '[71 Hz, 78 Hz]',
            'rotor.mistuning': '{deviation: 0.5 %, seed: 7}'}
OPTIONS = ['--quiet'] + [word for key, value in SETTINGS.items()
                         for word in ('--set', f'{key}={value}')] + ['case.yaml']
WORDS = [os.path.join(BIN, 'shroudhb-mhb'), *OPTIONS]
ENVIRONMENT['OPENBLAS_NUM_THREADS'] = '1'


def curve():
    """Points of the curve in the file, and whether it stopped in the middle."""
    if not os.path.exists(FILE):
        return 0, False
    with h5py.File(FILE, 'r') as file: # branches 0 and 1 are the linear limits
        branch = file['branch_2'] if 'branch_2' in file else {}
        return len(branch.get('frequency', ())), 'resume' in branch


def stopped(which, seconds):
    """Stop a run by a signal after that time; whether it was still running."""
    process = subprocess.Popen(WORDS, env=ENVIRONMENT, start_new_session=True,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        process.wait(timeout=seconds)
        return False
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, which)
        process.wait(timeout=60)
        return True


def broken(seconds):
    """One run in pieces, seconds long without a break: points of the curve at each cut, kills."""
    cuts, kills = [], 0
    for _ in range(PARTS):
        under_way = stopped(signal.SIGTERM, DICE.uniform(0.3, 1) * seconds)
        points, cut = curve()
        if not cuts and not cut: # too late or too early, as the machine is idle or busy
            seconds *= 1.2 if under_way and not points else 0.7
            if points:
                os.remove(FILE)
        if under_way and cut and points > max(cuts, default=0):
            cuts.append(points)
            # what the killed run computed is lost; the file is still that of the cut, or later
            kills += stopped(signal.SIGKILL, DICE.uniform(0.1, 0.4) * seconds)
            assert curve()[0] >= points, 'the cut curve was lost'
    return cuts, kills


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    with open('case.yaml', 'w') as case, open(os.path.join(SCENE, 'case.yaml')) as scene:
        case.write(scene.read())
    run(os.path.join(BIN, 'shroudhb'), 'modal', *OPTIONS)
    started = time.time()
    run(*WORDS)
    length, whole = time.time() - started, numbers(FILE)
    all_cuts, all_kills = 0, 0
    for _ in range(CYCLES):
        os.remove(FILE)
        cuts, kills = broken(length)
        run(*WORDS)
        resumed = numbers(FILE)
        assert resumed.keys() == whole.keys(), resumed.keys() ^ whole.keys()
        other = [name for name in whole if resumed[name] != whole[name]]
        assert not other, (cuts, other)
        left = [name for name in os.listdir() if '.tmp.' in name]
        assert not left, left
        all_cuts, all_kills = all_cuts + len(cuts), all_kills + kills
    assert all_cuts and all_kills, 'no curve was cut, no run was killed'
    print(f'{CYCLES} cycles, {all_cuts} times a curve was cut, {all_kills} times the run that went '
          'on was killed: the same bits as an unbroken run')
    os.chdir('/')
