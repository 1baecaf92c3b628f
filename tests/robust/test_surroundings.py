"""robust.surroundings: disks that are full, standard descriptors that are closed.

Usage: test_surroundings.py FOLDER_OF_PROGRAMS CASE_FOLDER [SCENE]...
Exit code 77: h5py is missing.
"""
import os
import resource
import subprocess
import sys
import time

try:
    import h5py  # of write_modal.py
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../support'))
from blade import BLADE
from programs import ENVIRONMENT, bring_your_own, run, write
from results import content

BIN, CASES = (os.path.abspath(word) for word in sys.argv[1:3])
SHROUDHB = os.path.join(BIN, 'shroudhb')
ENVIRONMENT.update(OPENBLAS_NUM_THREADS='1', OMP_NUM_THREADS='2')
STUDY = 'name: study\ncase: case.yaml\nvary: {contact.mu: [0.3, 0.4]}\n'


def attempt(*words, before=None, closed=(), seconds=120):
    """Exit code of a run and the lines that it said."""
    def prepare():
        if before:
            before()
        for number in closed:
            os.close(number)
    done = subprocess.run([SHROUDHB, *words], env=ENVIRONMENT, capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, errors='replace', timeout=seconds,
                          preexec_fn=prepare)
    return done.returncode, (done.stdout + done.stderr).splitlines()


def full_disk():
    """What cannot be written is told once, with exit code 4, and nothing goes on in vain."""
    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (8 << 10, 8 << 10))
    run(sys.executable, 'write_modal.py')
    write('study.yaml', STUDY)
    write('blade.yaml', BLADE.replace('SIZE', '14 mm'))
    for words in (('mhb', 'case.yaml'), ('run', 'case.yaml'), ('converge', 'case.yaml'),
                  ('mesh', 'blade.yaml'), ('run', 'blade.yaml')):
        code, said = attempt(words[0], '--quiet', *words[1:], before=limit)
        assert code == 4 and len(said) == 1 and 'cannot be written' in said[0], (words, code, said)
    left = [name for name in os.listdir() if '.tmp.' in name]
    assert not left, left
    print('full disk: one line, exit code 4')


def descriptors_of(stage, case, closed):
    """What the closed descriptors of a running stage are."""
    process = subprocess.Popen([os.path.join(BIN, f'shroudhb-{stage}'), '--force', case],
                               env=ENVIRONMENT, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               preexec_fn=lambda: [os.close(number) for number in closed])
    found, until = [], time.time() + 10
    while found != ['/dev/null'] * len(closed) and process.poll() is None and time.time() < until:
        time.sleep(0.05)
        paths = [f'/proc/{process.pid}/fd/{number}' for number in closed]
        found = [os.readlink(path) if os.path.lexists(path) else 'closed' for path in paths]
    process.kill()
    process.wait()
    return found


def closed_descriptors():
    """No file takes the number of a closed one, so no message gets into a result."""
    run(sys.executable, 'write_modal.py')
    found = descriptors_of('mhb', 'case.yaml', (0, 1, 2))
    assert found == ['/dev/null'] * 3, found
    write('blade.yaml', BLADE.replace('SIZE', '14 mm'))
    names = ['blade.msh', 'blade.modal.h5', 'blade.response.h5', 'blade.svg'] # tables have times
    whole = None
    for closed in (), (0,), (1,), (2,), (0, 1, 2):
        for name in filter(os.path.exists, names):
            os.remove(name)
        code, said = attempt('run', '--force', '--verbose', 'blade.yaml', closed=closed)
        found = [content(name) for name in names]
        whole = whole or found
        different = [name for name, a, b in zip(names, whole, found) if a != b]
        # what `run` prints at its end goes nowhere, which is told by its exit code
        assert code == (4 if 1 in closed else 0) and not different, (closed, code, different, said)
    print('closed descriptors: results alike')


SCENES = {'full_disk': full_disk, 'closed_descriptors': closed_descriptors}
for scene in sys.argv[3:] or SCENES:
    with bring_your_own(CASES):
        SCENES[scene]()
