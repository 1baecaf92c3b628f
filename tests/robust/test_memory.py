"""robust.memory: what is larger than the memory is refused at once, with what would fit.

Usage: test_memory.py FOLDER_OF_PROGRAMS CASE_FOLDER. Exit code 77: no h5py.
"""
import os
import re
import resource
import signal
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

BIN, SCENE = (os.path.abspath(word) for word in sys.argv[1:3])
MHB = os.path.join(BIN, 'shroudhb-mhb')
LIMIT = 310 << 20 # bytes of address space; below 300 MB no library starts
ENVIRONMENT.update(OPENBLAS_NUM_THREADS='1', OMP_NUM_THREADS='1')


def case_of(harmonics):
    """A short piece of the sweep at one preload."""
    text = re.sub(r'n0: .*', 'n0: [0.3 N]', open('case.yaml').read())
    text = re.sub(r'frequency: .*', 'frequency: [0.2 Hz, 0.2001 Hz]', text)
    return write('one.yaml', re.sub(r'harmonics: .*', f'harmonics: {harmonics}', text))


def start(harmonics, limit=None):
    before = (lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit))) if limit else None
    return subprocess.Popen([MHB, '--quiet', '--force', case_of(harmonics)], env=ENVIRONMENT,
                            stderr=subprocess.PIPE, text=True, preexec_fn=before)


def peak(harmonics):
    """Most address space of a run, GB. It holds what is reserved for a step that few points need,
    the second Jacobian of the truncation error, so the refusal must count it."""
    process, most = start(harmonics), 0
    while process.poll() is None:
        with open(f'/proc/{process.pid}/status') as status: # without sizes once it has ended
            found = re.search(r'VmPeak:\s*(\d+) kB', status.read())
        most = int(found[1]) if found else most
        time.sleep(0.05)
    assert process.returncode == 0, (harmonics, process.stderr.read())
    return 1024e-9 * most


def refused(harmonics):
    """The numbers of the refusal: GB needed, GB left, harmonics that fit."""
    process = start(harmonics, LIMIT)
    said = process.communicate(timeout=60)[1]
    assert process.returncode == 2 and len(said.splitlines()) == 1, (process.returncode, said)
    found = re.search(r'1 contact point and (\d+) harmonics needs about ([\d.]+) GB more memory, '
                      r'and ([\d.]+) GB are left; mhb.harmonics: (\d+) fits$', said.strip())
    assert found and int(found[1]) == harmonics, said
    return float(found[2]), float(found[3]), int(found[4])


def is_begun(harmonics):
    process = start(harmonics, LIMIT)
    time.sleep(2)
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=60)[1]
    return 'GB are left' not in said


def refused_integration():
    """Points of the time integration that fit, of ten thousand."""
    case_of(200)
    preloads = ', '.join(f'{0.3 + 0.01 * i:.2f} N' for i in range(10))
    text = re.sub(r'n0: .*', f'n0: [{preloads}]', open('one.yaml').read())
    text += '\nintegrate: {frequencies: 1000, harmonics: 200, start: rest}\n'
    done = subprocess.run([os.path.join(BIN, 'shroudhb-integrate'), '--quiet',
                           write('one.yaml', text)], env=ENVIRONMENT, capture_output=True,
                          text=True, timeout=60, preexec_fn=lambda: resource.setrlimit(
                              resource.RLIMIT_AS, (LIMIT, LIMIT)))
    assert done.returncode == 2 and len(done.stderr.splitlines()) == 1, done
    found = re.search(r'the time integration of 1 contact point, 200 harmonics and 10000 points '
                      r'needs about .* or points: (\d+) fits$', done.stderr.strip())
    assert found, done.stderr
    return int(found[1])


def refused_mesh():
    """The mesh size, mm, that fits into a small address space. No mesh is begun."""
    limit = 1400 << 20
    done = subprocess.run([os.path.join(BIN, 'shroudhb-mesh'), '--quiet',
                           write('blade.yaml', BLADE.replace('SIZE', '0.6 mm'))], env=ENVIRONMENT,
                          capture_output=True, text=True, timeout=60,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
    assert done.returncode == 2 and len(done.stderr.splitlines()) == 1, done
    found = re.search(r'mesh.blade.size: 0.6 mm would give about [\d.e+]+ nodes; give at least '
                      r'([\d.]+) mm, which gives [\d.e+]+, the most that the free memory holds',
                      done.stderr)
    assert found and not os.path.exists('blade.msh'), done.stderr
    return float(found[1])


with bring_your_own(SCENE):
    assert 0.6 < refused_mesh() < 5
    run(sys.executable, 'write_modal.py')
    needed, left, fits = refused(200)
    assert needed > left and 100 < fits < 200, (needed, left, fits)
    assert is_begun(fits)
    refused(fits + 3) # what is left varies by some pages
    assert 10 < refused_integration() < 10000
    grown = peak(200) - peak(1)
    print(f'200 harmonics: told {needed} GB, reserved {grown:.3f} GB')
    assert 0.8 < needed / grown < 1.8
