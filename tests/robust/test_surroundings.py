"""robust.surroundings: full disks, closed descriptors, leftovers, locales, odd names.

Usage: test_surroundings.py FOLDER_OF_PROGRAMS LIBRARY CASE_FOLDER [SCENE]...
LIBRARY is locale.c, which takes the locale of the user. Exit code 77: h5py is missing.
"""
import os
import re
import resource
import shutil
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
from results import content, table

BIN, LIBRARY, CASES = (os.path.abspath(word) for word in sys.argv[1:4])
SHROUDHB = os.path.join(BIN, 'shroudhb')
ENVIRONMENT.update(OPENBLAS_NUM_THREADS='1', OMP_NUM_THREADS='2')
STUDY = 'name: study\ncase: case.yaml\nvary: {contact.mu: [0.3, 0.4]}\n'


RESULTS = ['three_degree.' + kind for kind in ('response.h5', 'svg', 'csv')]


def short_case():
    """One preload, three harmonics: a second."""
    run(sys.executable, 'write_modal.py')
    text = re.sub(r'n0: .*', 'n0: [0.3 N]', open('case.yaml').read())
    write('case.yaml', re.sub(r'harmonics: .*', 'harmonics: 3', text))


def attempt(*words, before=None, closed=(), seconds=120, more=()):
    """Exit code of a run and the lines that it said. more: of the environment."""
    def prepare():
        if before:
            before()
        for number in closed:
            os.close(number)
    done = subprocess.run([SHROUDHB, *words], env=dict(ENVIRONMENT, **dict(more)),
                          capture_output=True, text=True, stdin=subprocess.DEVNULL,
                          errors='replace', timeout=seconds, preexec_fn=prepare)
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


def read_results(folder):
    """What the results of the case hold."""
    return [(table if name.endswith('.csv') else content)(os.path.join(folder, name))
            for name in RESULTS]


def locale():
    """Numbers are read and written with a point, also where the locale has a comma."""
    write('blade.yaml', BLADE.replace('SIZE', '14 mm'))
    names = ['blade.msh', 'blade.modal.h5', 'blade.response.h5', 'blade.svg']
    if subprocess.run(['localedef', '-i', 'de_DE', '-f', 'UTF-8', './de_DE.UTF-8'],
                      capture_output=True).returncode:
        print('locale: left out, localedef has no de_DE')
        return
    german = {'LOCPATH': os.getcwd(), 'LC_ALL': 'de_DE.UTF-8'}
    preloaded = dict(german, LD_PRELOAD=LIBRARY)
    comma = subprocess.run(['/usr/bin/printf', '%.1f', '1'], env=dict(os.environ, **german),
                           capture_output=True, text=True).stdout
    assert comma == '1,0', comma
    whole = None
    for more in {}, german, preloaded:
        code, said = attempt('run', '--quiet', '--force', 'blade.yaml', more=more)
        found = [content(name) for name in names]
        whole = whole or found
        assert code == 0 and not said and found == whole, (more, code, said)
    print('locale with a comma: results alike')


def odd_names():
    """Blanks, other letters, a leading dash, symbolic links: results as ever, at their place."""
    short_case()
    assert attempt('run', '--quiet', 'case.yaml') == (0, [])
    expected = read_results('.')
    os.mkdir('real')
    os.symlink('real', 'link')
    for into in 'a b', 'ä€', '-x', "it's", 'link':
        assert attempt('run', '--quiet', '--into', into, 'case.yaml') == (0, []), into
        assert read_results(into) == expected, into
    assert os.path.islink('link') and sorted(os.listdir('real')) == sorted(
        [*RESULTS, 'three_degree.html', 'three_degree.summary.json'])
    for case in '-case.yaml', 'a b ä€.yaml', '-d/case.yaml':
        os.makedirs(os.path.dirname(case) or '.', exist_ok=True)
        shutil.copy('case.yaml', case)
        if os.path.dirname(case):
            shutil.copy('three_degree.modal.h5', os.path.dirname(case))
        assert attempt('run', '--quiet', '--into', 'other', '--', case) == (0, []), case
        assert read_results('other') == expected, case
        shutil.rmtree('other')
    os.symlink('case.yaml', 'linked.yaml')
    assert attempt('run', '--quiet', '--into', 'other', 'linked.yaml') == (0, [])
    assert read_results('other') == expected
    print('odd names: results alike')


def refuses(words, text, codes, before=None):
    """A run ends soon, with a line that says why."""
    code, said = attempt(*words, before=before)
    lines = [line for line in said if 'error: ' in line]
    assert code in codes and len(lines) == 1 and text in lines[0], (words, code, said)
    assert not [line for line in said if 'warning: ' in line], (words, said)


def no_files():
    """Folders, pipes and devices in the place of files, and a case of 100 MB, are refused."""
    short_case()
    for name in RESULTS:
        os.makedirs(f'into/{name}/inner')
        refuses(('run', '--quiet', '--into', 'into', 'case.yaml'),
                f'into/{name}: cannot be written', (4,))
        shutil.rmtree('into')
    with open('large.yaml', 'w') as large:
        large.write('# nothing but a remark\n' * (100 * 10 ** 6 // 23))
    os.mkfifo('pipe.yaml')
    for command in 'run', 'check', 'study', 'contact':
        refuses((command, 'large.yaml'), 'larger than 1 MiB', (2,))
        for path in 'pipe.yaml', '/dev/zero', '/dev/tty':
            refuses((command, path), f'{path}: is a pipe or a device, not a file', (4,))
    given = open('case.yaml').read()
    brought = re.sub(r'(?s)mesh:.*?SIZE', 'mesh: {file: FILE}', BLADE)
    for key, name in ('mesh', 'pipe.msh'), ('mesh', 'pipe.inp'), ('modal', 'pipe.h5'):
        os.mkfifo(name)
        text = given.replace('three_degree.modal.h5', name)
        write('of_pipe.yaml', brought.replace('FILE', name) if key == 'mesh' else text)
        refuses(('run', '--quiet', 'of_pipe.yaml'),
                f'{key}.file: {name}: is a pipe or a device, not a file', (4,))
    for command in 'post', 'inspect', 'field':
        refuses((command, 'pipe.h5'), 'not a file', (4,))
    print('no files: one line, exit code')


def as_nobody():
    """Root may write everywhere."""
    if os.geteuid() == 0:
        os.setgroups([])
        os.setgid(65534)
        os.setuid(65534)


def read_only():
    """Where nothing may be written it is told before any work, and nothing changes."""
    os.chmod('.', 0o755)
    os.mkdir('fixed')
    write('fixed/blade.yaml', BLADE.replace('SIZE', '14 mm').replace('n0: [20 N]', 'n0: [9 N]') +
          'integrate: {frequencies: [100 Hz], start: rest}\n')
    write('fixed/study.yaml', STUDY.replace('case.yaml', 'blade.yaml'))
    os.chdir('fixed')
    assert attempt('run', '--quiet', 'blade.yaml') == (0, [])
    refuses(('run', '--quiet', '--into', '/proc/self', 'blade.yaml'), 'cannot be written', (4,))
    refuses(('run', '--quiet', '--into', '/proc/new', 'blade.yaml'), 'cannot be made', (4,))
    there = sorted(os.listdir())
    os.chmod('.', 0o555)
    reachable = subprocess.run([SHROUDHB, '--version'], preexec_fn=as_nobody, env=ENVIRONMENT,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    for stage in ('run', 'mesh', 'modal', 'mhb', 'integrate', 'converge', 'study', 'field'):
        file = {'study': 'study.yaml', 'field': 'blade.response.h5'}.get(stage, 'blade.yaml')
        if reachable.returncode:
            break
        words = (stage, '--quiet' if stage == 'run' else '--verbose', '--force', file)
        code, said = attempt(*words, before=as_nobody)
        said = [line for line in said if ' s in all' not in line]
        assert code == 4 and len(said) == 1 and 'cannot be written: Perm' in said[0], (words, said)
    assert sorted(os.listdir()) == there, os.listdir()
    print('read-only folder: one line before any work, exit code 4')


def leftovers():
    """A run without work removes the temporary files of killed stages, not those of others."""
    write('blade.yaml', BLADE.replace('SIZE', '14 mm'))
    assert attempt('run', '--quiet', '--into', 'into', 'blade.yaml') == (0, [])
    killed = subprocess.Popen(['sleep', '100'])
    killed.kill()
    killed.wait()
    kinds = ['msh', 'modal.h5', 'response.h5', 'html', 'csv', 'svg', 'summary.json', 'inp']
    orphans = [f'blade.{kind}.tmp.{killed.pid}' for kind in kinds]
    orphans.append(f'blade.msh.tmp.{killed.pid}.msh')
    others = [f'blade.msh.tmp.{os.getpid()}', f'blades.msh.tmp.{killed.pid}',
              f'blade.msh.tmp.{killed.pid}.old', 'blade.msh.tmp.', f'blade.tmp.{killed.pid}']
    before = os.listdir('into')
    for name in orphans + others:
        write(os.path.join('into', name), 'half')
    assert attempt('run', '--quiet', '--into', 'into', 'blade.yaml') == (0, [])
    assert sorted(os.listdir('into')) == sorted(before + others), os.listdir('into')
    print('leftovers: removed at the start')


def two_runs():
    """Of two runs over the same results at the same moment one refuses, or both are whole."""
    short_case()
    other = write('other.yaml', open('case.yaml').read().replace('0.3 N', '0.2 N'))
    whole = []
    for case in 'case.yaml', other:
        assert attempt('run', '--quiet', '--into', 'alone', case) == (0, [])
        whole.append(read_results('alone'))
    both = [subprocess.Popen([SHROUDHB, 'run', '--quiet', case], env=ENVIRONMENT, text=True,
                             stderr=subprocess.PIPE) for case in ('case.yaml', other)]
    said = [one.communicate(timeout=300)[1] for one in both]
    codes = [one.returncode for one in both]
    assert 0 in codes and read_results('.') in whole, (codes, said)
    for code, text in zip(codes, said):
        assert code == 0 or (code == 4 and text.count('\n') == 1 and 'another run' in text), said
    print(f'two runs at a moment: exit codes {codes}, results whole')


SCENES = {'two_runs': two_runs, 'leftovers': leftovers,
          'full_disk': full_disk, 'closed_descriptors': closed_descriptors, 'locale': locale,
          'odd_names': odd_names, 'no_files': no_files, 'read_only': read_only}
for scene in sys.argv[4:] or SCENES:
    with bring_your_own(CASES):
        SCENES[scene]()
