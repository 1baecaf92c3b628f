"""cases.study.study_process: how a study and its processes end, what they leave, what they read.

Usage: test_study_process.py BIN CASE_FOLDER, with the programs in BIN. Exit code 77: no
h5py.
"""
import os
import signal
import subprocess
import sys
import time

try:
    import h5py # for write_modal.py
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../support'))
from programs import ENVIRONMENT, bring_your_own, read, rows, run, write

BIN, SCENE = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
FRONT = os.path.join(BIN, 'shroudhb')
MANY = 'vary: {contact.n0: {from: 0.101 N, to: 0.9 N, points: 60}}\noutputs: [peak]\n'


def start(name, **more):
    return subprocess.Popen([FRONT, 'study', '--quiet', f'{name}.yaml'], env=ENVIRONMENT, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, **more)


def workers_of(parent):
    """The processes below parent that compute designs."""
    found = []
    for entry in filter(str.isdigit, os.listdir('/proc')):
        try:
            with open(f'/proc/{entry}/stat', encoding='utf-8') as source:
                text = source.read()
        except OSError:
            continue
        if '(shroudhb-design)' in text and int(text[text.rindex(')') + 2:].split()[1]) == parent:
            found.append(int(entry))
    return found


def has_answered(worker):
    """Whether a worker has written a design to its manager; it copies the case before."""
    try:
        with open(f'/proc/{worker}/io', encoding='utf-8') as source:
            written = int(dict(line.split(': ') for line in source)['wchar'])
            return written > os.path.getsize('case.yaml')
    except OSError:
        return False


def wait_for_designs(study, name):
    """Until a worker of the study has done a design."""
    while not any(map(has_answered, workers_of(study.pid))):
        assert study.poll() is None, f'{name} is done already'
        time.sleep(0.01)


def alive(process):
    try:
        with open(f'/proc/{process}/stat', encoding='utf-8') as source:
            return source.read().rsplit(')', 1)[1].split()[0] != 'Z'
    except OSError:
        return False


def check_interrupt():
    """130 and one line, from a terminal or to the manager alone; the study then goes on."""
    write('whole.yaml', 'case: case.yaml\n' + MANY)
    run(FRONT, 'study', '--quiet', '--force', 'whole.yaml')
    os.rename('whole.study.h5', 'kept.h5')
    for name, number, group in (('one', signal.SIGINT, False), ('all', signal.SIGINT, True),
                                ('term', signal.SIGTERM, True), ('hup', signal.SIGHUP, True)):
        write(f'{name}.yaml', 'case: case.yaml\n' + MANY)
        study = start(name, start_new_session=True)
        wait_for_designs(study, name)
        workers = workers_of(study.pid)
        if group:
            os.killpg(study.pid, number)
        else:
            study.send_signal(number)
        out, errors = study.communicate(timeout=60)
        assert study.returncode == 130 and out == '', (name, study.returncode, out)
        assert errors == ('shroudhb: error: interrupted; the same command goes on where it '
                          'stopped\n'), errors
        assert not any(map(alive, workers)), workers
        states = {row['status'] for row in rows(f'{name}.study.csv')}
        assert states <= {'done', 'not run'} and 'not run' in states, states
        run(FRONT, 'study', '--quiet', f'{name}.yaml')
        assert read(f'{name}.study.csv') == read('whole.study.csv'), name
        os.remove(f'{name}.study.h5')


def is_mapped(segment):
    """Whether a process that lives, such as one of another test, has a segment in its memory."""
    for entry in filter(str.isdigit, os.listdir('/proc')):
        try:
            with open(f'/proc/{entry}/maps', encoding='utf-8') as source:
                if f'/dev/shm/{segment}' in source.read():
                    return True
        except OSError:
            continue
    return not os.path.exists(f'/dev/shm/{segment}')


def nothing_new_stays(before):
    """What other tests have in memory is theirs to remove; the study's processes are gone."""
    ours = {name for name in set(os.listdir('/dev/shm')) - before
            if os.path.isfile(f'/dev/shm/{name}') and not is_mapped(name)}
    assert not ours, ours


def check_death():
    """What a killed study leaves: no process, nothing in /dev/shm, nothing after the next run."""
    before = set(os.listdir('/dev/shm'))
    write('killed.yaml', 'case: case.yaml\n' + MANY)
    study = start('killed', start_new_session=True)
    wait_for_designs(study, 'killed')
    workers = workers_of(study.pid)
    study.kill() # the manager alone
    study.communicate()
    ends = time.monotonic() + 20
    while any(map(alive, workers)) and time.monotonic() < ends:
        time.sleep(0.05)
    assert workers and not any(map(alive, workers)), workers
    nothing_new_stays(before)
    run(FRONT, 'study', '--quiet', 'killed.yaml')
    assert read('killed.study.csv') == read('whole.study.csv')
    left = [name for name in os.listdir('.') if 'tmp' in name] + os.listdir('killed.study.d')
    assert not left, left
    nothing_new_stays(before)
    os.remove('killed.study.h5')


def check_once():
    """All rows are of the case as it was at the start, whatever becomes of it meanwhile."""
    write('edited.yaml', 'case: case.yaml\n' + MANY)
    with open('case.yaml', encoding='utf-8') as source:
        case = source.read()
    study = start('edited')
    wait_for_designs(study, 'edited')
    write('case.yaml', case.replace('kv: 0.8', 'kv: 0.3'))
    write('edited.yaml', 'what: is this\n')
    out, errors = study.communicate(timeout=120)
    write('case.yaml', case)
    assert study.returncode == 0 and errors == '', (out, errors)
    assert read('edited.study.csv') == read('whole.study.csv')
    os.remove('edited.study.h5')


def check_changed_modes():
    """A modal file that changes while a study runs fails the designs that read it."""
    write('swapped.yaml', 'case: case.yaml\n' + MANY)
    study = start('swapped')
    wait_for_designs(study, 'swapped')
    with h5py.File('three_degree.modal.h5', 'r+') as modal:
        modal['modes/damping_ratio'][...] *= 2
    for worker in workers_of(study.pid): # those that come after them read the file again
        os.kill(worker, signal.SIGKILL)
    study.communicate(timeout=120)
    subprocess.run([sys.executable, 'write_modal.py'], check=True)
    table, whole = rows('swapped.study.csv'), rows('whole.study.csv')
    changed = [row for row in table if 'has changed since the study began' in row['reason']]
    assert study.returncode == 3 and changed, study.returncode
    for row, other in zip(table, whole):
        assert row['status'] == 'failed' or row['peak'] == other['peak'], row
    os.remove('swapped.study.h5')


def check_limits():
    """Limits of the system are told once; an option that a study has not likewise."""
    write('few.yaml', 'case: case.yaml\nvary: {contact.n0: [0.3 N, 0.4 N]}\noutputs: [peak]\n')
    for limit, told in (('-n 4', 'the number of open files is limited to 4'),
                        ('-n 24', 'the number of open files is limited to 24'),
                        ('-f 8', 'File too large')):
        done = subprocess.run(['sh', '-c', f'ulimit {limit}; exec "$0" study --force few.yaml',
                               FRONT], capture_output=True, text=True, timeout=120,
                              check=False)
        assert done.returncode == 4 and told in done.stderr, (limit, done.returncode, done.stderr)
        assert done.stderr.count('\n') == 1, (limit, done.stderr)
    said = run(FRONT, 'study', '--nothing', 'few.yaml', code=2)
    assert said.count('error:') == 1, said


with bring_your_own(SCENE):
    subprocess.run([sys.executable, 'write_modal.py'], check=True)
    with open('case.yaml', encoding='utf-8') as text:
        changed = text.read().replace('n0: [-0.2 N, 0 N, 0.3 N, 1.0 N]', 'n0: 0.3 N')
    write('case.yaml', changed)
    check_interrupt()
    check_death()
    check_once()
    check_changed_modes()
    check_limits()
