"""robust.repeated: a sweep many times, in one process and in many; memory flat, results alike.

Usage: test_repeated.py REPEATED_SWEEP FOLDER_OF_PROGRAMS CASE_FOLDER SWEEPS PROCESSES
Exit code 77: h5py is missing.
"""
import os
import re
import subprocess
import sys

try:
    import h5py  # of write_modal.py
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../support'))
from programs import ENVIRONMENT, bring_your_own, run, write
from results import content

PROGRAM, BIN, SCENE = (os.path.abspath(word) for word in sys.argv[1:4])
SWEEPS, PROCESSES = (int(word) for word in sys.argv[4:6])
RESULT = 'three_degree.response.h5'
ENVIRONMENT.update(OPENBLAS_NUM_THREADS='1', OMP_NUM_THREADS='2')

with bring_your_own(SCENE):
    run(sys.executable, 'write_modal.py')
    text = re.sub(r'n0: .*', 'n0: [0.3 N, 1.0 N]', open('case.yaml').read())
    text = re.sub(r'frequency: .*', 'frequency: [0.2 Hz, 0.22 Hz]', text)
    write('one.yaml', re.sub(r'harmonics: .*', 'harmonics: 3', text))
    words = (os.path.join(BIN, 'shroudhb-mhb'), '--quiet', '--force', 'one.yaml')
    run(*words)
    expected, peaks = content(RESULT), []
    for i in range(PROCESSES):
        process = subprocess.Popen(words, env=ENVIRONMENT)
        _, status, used = os.wait4(process.pid, 0)
        assert status == 0 and content(RESULT) == expected, i
        peaks.append(used.ru_maxrss)
    if peaks:
        print(f'{PROCESSES} processes: results alike, {min(peaks)} to {max(peaks)} kB')
        assert max(peaks) < 1.2 * min(peaks)
    # a block of 16 bytes lost after each sweep is noticed
    for count, lost, code in ((SWEEPS, 0, 0), (10, 16, 1)):
        done = subprocess.run([PROGRAM, str(count), 'one.yaml', str(lost)], env=ENVIRONMENT,
                              text=True, capture_output=True)
        print(done.stdout + done.stderr, end='')
        assert done.returncode == code
    assert content(RESULT) == expected, 'the last sweep gave other numbers'
    assert not [name for name in os.listdir() if '.tmp.' in name]
