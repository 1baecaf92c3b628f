"""robust.fail_nth: the n-th call of a function fails, in every stage of a small case.

Usage: test_fail_nth.py FOLDER_OF_PROGRAMS LIBRARY CASE_FOLDER [MOST [STAGE]...]
MOST calls of each function fail in turn, of a negative MOST the first ones; without it all.
Without a stage: all of mhb, integrate, post, study, mesh, modal.
STAGE:FUNCTION takes one function only.
Exit code 77: no h5py.

A run must end with a code of its own and say why, or publish what it would have published.
Without memory it ends with one line and code 4, but for a study whose table tells it.
A result of another run lies in its way: it must be untouched, or replaced by a whole one. A sweep
of more than a second may have replaced it by the curves that it had then. A study may end with a
whole table in which failed designs have their reason, also if its page cannot be written then.
"""
import collections
import csv
import os
import shutil
import subprocess
import sys

try:
    import h5py
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../support'))
from blade import BLADE
from programs import ENVIRONMENT, bring_your_own, run, write
from results import content

BIN, LIBRARY, SCENE = (os.path.abspath(word) for word in sys.argv[1:4])
MOST = int(sys.argv[4]) if len(sys.argv) > 4 else None
WORDS = [word.partition(':')
         for word in sys.argv[5:] or ['mhb', 'integrate', 'post', 'study', 'mesh', 'modal']]
STAGES = {stage: only for stage, _, only in WORDS} # the only function that fails; empty: all
H5 = ('H5Fcreate', 'H5Fopen', 'H5Fclose', 'H5Gcreate2', 'H5Gopen2', 'H5Dcreate2', 'H5Dopen2',
      'H5Dwrite', 'H5Dread', 'H5Dclose', 'H5Screate_simple', 'H5Awrite', 'H5Aread')
CALLS = ('malloc', 'open', 'write', 'close', 'fsync', 'rename', 'thread') + H5
LIBRARIES = ('libgomp: Thread creation failed', 'MPI_Init', 'PMIX ERROR', 'orte_init')
LINES = 12 # a refusal is short, also with warnings before it
BLAMES = ('is not an HDF5 file', 'is damaged', 'is truncated') # the file, which is whole


def program(stage):
    return os.path.join(BIN, f'shroudhb-{stage}')


def attempt(stage, words, call, nth, count=''):
    """Run a stage; its code and what it said. A run of 60 s counts as an endless one."""
    more = dict(LD_PRELOAD=LIBRARY, FAIL_CALL=call, FAIL_NTH=str(nth), OPENBLAS_NUM_THREADS='1',
                OMP_NUM_THREADS='2')
    if count:
        more['FAIL_COUNT'] = count
    done = subprocess.run([program(stage), *words], env=dict(ENVIRONMENT, **more), text=True,
                          capture_output=True, timeout=60, errors='replace')
    return done.returncode, done.stdout + done.stderr


def counted(stage, words, call):
    """How often one process of an undisturbed run calls a function at most."""
    if os.path.exists('count'):
        os.remove('count')
    code, said = attempt(stage, words, call, 0, os.path.abspath('count'))
    assert code == 0, (stage, call, code, said)
    return max(int(word) for word in open('count').read().split()) # a child may do the work


def chosen(total):
    """Which calls fail: all; the first, the last and some between; the first ones (MOST < 0)."""
    if MOST is not None and MOST < 0:
        return range(1, min(total, -MOST) + 1)
    if MOST is None or total <= MOST:
        return range(1, total + 1)
    return sorted({1 + round(i * (total - 1) / max(MOST - 1, 1)) for i in range(MOST)})


def library_ended(code, said):
    """OpenMP and MPI end the process with code 1 where they cannot start."""
    return code == 1 and any(text in said for text in LIBRARIES)


def is_under_way(name):
    """Whether the file is that of a run with more to do: published whole before a later failure."""
    if not name.endswith('.h5'):
        return False
    with h5py.File(name, 'r') as file:
        return file.attrs.get('finished', 1) == 0


def tells_failed_designs(name):
    """Whether the table of a study gives a reason in each row of a design that failed."""
    if not name.endswith('.study.csv'):
        return False
    with open(name, newline='') as table:
        rows = [row for row in csv.DictReader(table) if row['status'] == 'failed']
    return bool(rows) and all(row['reason'] for row in rows)


def verdict(call, code, said, name, old, whole):
    """What is wrong with a run; empty: nothing. `old` is the earlier result."""
    ended = library_ended(code, said)
    if code not in (0, 2, 3, 4) and not ended:
        return f'exit code {code}'
    lines = [line for line in said.splitlines() if line.strip()]
    if code and not lines:
        return 'no reason given'
    if call == 'open' and any(text in said for text in BLAMES):
        return 'a whole file is blamed'
    if len(lines) > LINES and not ended:
        return f'{len(lines)} lines'
    left = [entry for entry in os.listdir('.') if '.tmp.' in entry]
    if left:
        return f'left {left}'
    if not os.path.exists(name):
        return 'the earlier result is gone'
    alone = code == 4 and len(lines) == 1 and 'memory' in said
    if call == 'malloc' and code and not alone and not tells_failed_designs(name):
        return f'short memory is told by {len(lines)} lines and code {code}'
    try:
        now = content(name)
    except OSError:
        return 'the result cannot be read'
    if code == 0 and now != whole:
        return 'exit code 0, but another result'
    if code in (3, 4) and tells_failed_designs(name):
        return ''
    if code and now not in (old, whole) and not is_under_way(name):
        return 'a result that is neither the earlier one nor whole'
    return ''


def check(stage, case, name, earlier):
    """All functions fail in turn in one stage. `earlier` leaves another result in the way."""
    words = ['--quiet', '--force', case]
    if stage == 'post':
        words = ['--quiet', case]
    earlier()
    shutil.copy(name, 'old')
    old = content(name)
    run(program(stage), *words)
    whole = content(name)
    assert whole != old, (stage, 'the earlier result must differ')
    bad, runs = [], collections.Counter()
    for call in [STAGES[stage]] if STAGES[stage] else CALLS:
        for nth in chosen(counted(stage, words, call)):
            shutil.copy('old', name)
            try:
                code, said = attempt(stage, words, call, nth)
            except subprocess.TimeoutExpired:
                bad.append((stage, call, nth, 'endless', ''))
                continue
            runs[code] += 1
            wrong = verdict(call, code, said, name, old, whole)
            if wrong:
                bad.append((stage, call, nth, wrong, said[-400:]))
            for entry in os.listdir('.'):
                if '.tmp.' in entry:
                    os.remove(entry)
    print(f'{stage}: {sum(runs.values())} runs, exit codes {dict(runs)}, {len(bad)} wrong')
    return bad


def check_balance():
    run(sys.executable, 'write_modal.py')
    text = open('case.yaml').read()
    lines = [line for line in text.splitlines() if not line.strip().startswith(('n0:', 'harm'))]
    text = '\n'.join(lines).replace('mhb:', 'mhb:\n  harmonics: 3')
    write('case.yaml', text.replace('contact:', 'contact:\n  n0: [0.3 N]'))
    write('other.yaml', text.replace('contact:', 'contact:\n  n0: [0.2 N]'))
    bad = []
    if 'mhb' in STAGES:
        bad += check('mhb', 'case.yaml', 'three_degree.response.h5',
                     lambda: run(program('mhb'), '--quiet', '--force', 'other.yaml'))
    if 'integrate' in STAGES: # a motion that repeats itself, and one that does not in ten periods
        bare = {name: open(name).read() for name in ('case.yaml', 'other.yaml')}
        for periods in 5000, 10:
            block = f'{{frequencies: [0.2 Hz], start: rest, tolerance: 1e-2, periods: {periods}}}'
            for name, text in bare.items():
                write(name, f'{text}\nintegrate: {block}\n')
            bad += check('integrate', 'case.yaml', 'three_degree.integration.h5',
                         lambda: run(program('integrate'), '--quiet', '--force', 'other.yaml'))
    if 'study' in STAGES: # its designs are processes of their own, in which calls fail too
        study = 'name: study\ncase: case.yaml\nvary: {contact.mu: [0.3]}\n'
        write('study.yaml', study)
        write('other_study.yaml', study.replace('0.3', '0.4'))
        bad += check('study', 'study.yaml', 'study.study.csv',
                     lambda: run(program('study'), '--quiet', '--force', 'other_study.yaml'))
    if 'post' in STAGES:
        run(program('mhb'), '--quiet', '--force', 'case.yaml')
        bad += check('post', 'case.yaml', 'three_degree.csv',
                     lambda: write('three_degree.csv', 'an earlier table\n'))
    return bad


def check_blade():
    write('blade.yaml', BLADE.replace('SIZE', '14 mm'))
    write('coarse.yaml', BLADE.replace('SIZE', '18 mm'))
    write('fewer.yaml', BLADE.replace('SIZE', '14 mm').replace('modes: 3', 'modes: 2'))
    bad = []
    if 'mesh' in STAGES:
        bad += check('mesh', 'blade.yaml', 'blade.msh',
                     lambda: run(program('mesh'), '--quiet', '--force', 'coarse.yaml'))
    if 'modal' in STAGES:
        run(program('mesh'), '--quiet', '--force', 'blade.yaml')
        bad += check('modal', 'blade.yaml', 'blade.modal.h5',
                     lambda: run(program('modal'), '--quiet', '--force', 'fewer.yaml'))
    return bad


def main():
    with bring_your_own(SCENE):
        bad = check_balance() + check_blade()
    for row in bad:
        print(*row)
    assert not bad, f'{len(bad)} runs are wrong'


main()
