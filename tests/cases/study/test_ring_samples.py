"""cases.study.ring_samples: samples of random rings shared over MPI: the numbers of one process.

Usage: test_ring_samples.py BIN SCENE_FOLDER, with the programs in BIN.
"""
import os
import re
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../support'))
from programs import ENVIRONMENT, run

BIN, SCENE = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
FILE = 'ring.response.h5'
SAMPLES = 6

# four coarse blades with few modes: a sample takes a tenth of a second
SETTINGS = {'name': 'ring', 'mesh.blade.size': '15 mm', 'rotor.blades': '4',
            'excitation.engine_order': '1', 'modal.modes': '4',
            'contact.n0': '[20 N, 60 N]', 'mhb.harmonics': '3', 'mhb.stability': 'never',
            'rotor.mistuning': f'{{deviation: 0.5 %, seed: 7, samples: {SAMPLES}}}'}
WORDS = [word for key, value in SETTINGS.items() for word in ('--set', f'{key}={value}')]


def program(name):
    return os.path.join(BIN, name)


def shared(ranks):
    words = ['mpiexec', '-n', str(ranks), '--oversubscribe'] if ranks else []
    return words + [program('shroudhb-samples'), '--quiet', *WORDS, 'case.yaml']


def result():
    """Every dataset of the samples, as printed with all digits."""
    return [run(program('shroudhb'), 'inspect', FILE, f'samples/{name}', '--csv')
            for name in ('factor', 'frequency', 'blade', 'deviation', 'distribution', 'worst')]


def n_done():
    try:
        text = run(program('shroudhb'), 'inspect', FILE, 'samples/factor', '--csv')
    except AssertionError: # there is no file yet
        return 0
    rows = text.split('\n')[1:]
    return sum(float(cell) > 0 for row in rows if row for cell in row.split(',')[1:])


def check_ranks():
    """Threads, two ranks and three give the same bits."""
    run(program('shroudhb-mhb'), '--quiet', *WORDS, 'case.yaml')
    assert n_done() == 2 * SAMPLES, result()[0]
    whole = result()
    for ranks in 0, 2, 3:
        os.remove(FILE)
        run(*shared(ranks))
        assert result() == whole, ranks
    said = run(*shared(3))
    assert said == '' and result() == whole # up to date
    return whole


def check_stop(whole):
    """A run that was stopped or killed goes on and ends on the same bits."""
    os.remove(FILE)
    for sent, wait in (signal.SIGKILL, 1), (signal.SIGINT, 2), (signal.SIGKILL, 0.7):
        work = subprocess.Popen(shared(3), stderr=subprocess.PIPE, env=ENVIRONMENT,
                                start_new_session=True)
        time.sleep(wait)
        os.killpg(work.pid, sent)
        work.communicate(timeout=300)
        print(f'{sent.name} after {wait} s: {n_done()} of {2 * SAMPLES} samples')
    run(*shared(3))
    assert result() == whole


def check_faults():
    """What is wrong is said once, whatever the number of ranks."""
    words = shared(3)[:-1] + ['--set', 'rotor.mistuning={deviation: 0.5 %, seed: 7}', 'case.yaml']
    done = subprocess.run(words, capture_output=True, text=True, env=ENVIRONMENT, check=False)
    told = done.stderr.count('has no samples; give rotor.mistuning')
    assert done.returncode == 2 and told == 1, (done.returncode, done.stderr)


def check_memory():
    """Designs whose rings do not fit beside each other are refused before one begins."""
    sizes = 'vary: {contact.n0: [20 N, 60 N]}\noutputs: [peak]\n'
    large = text.replace('  harmonics: 3\n', '  harmonics: 200\n').replace('blades: 40',
                                                                          'blades: 1000')
    for name, what in ('large.yaml', large), ('study.yaml', f'case: large.yaml\n{sizes}'):
        with open(name, 'w', encoding='utf-8') as out:
            out.write(what)
    told = {}
    for ranks in 1, 4:
        done = subprocess.run(['mpiexec', '-n', str(ranks), '--oversubscribe', '--quiet',
                               program('shroudhb-study'), '--quiet', 'study.yaml'],
                              capture_output=True, text=True, env=ENVIRONMENT, timeout=100,
                              check=False)
        found = re.search(r'1000 different blades, 1 contact point and 200 harmonics needs about '
                          r'(\d+) GB more memory, and ([\d.]+) GB are left(.*); mhb.harmonics: '
                          r'(\d+) fits, or rotor.blades: (\d+) fits', done.stderr)
        assert done.returncode == 2 and found, (ranks, done.returncode, done.stderr)
        assert len(done.stderr.splitlines()) == 1, done.stderr
        told[ranks] = float(found[2]), found[3], int(found[5])
    assert told[1][1] == '' and told[4][1] == ' for each of 3 processes', told
    assert 2 < told[1][0] / told[4][0] < 4 and told[4][2] < told[1][2], told
    assert not os.path.exists('study.study.h5')
    print(f'alone and beside two others (GB left, blades that fit): {told}')


with tempfile.TemporaryDirectory() as folder:
    with open(os.path.join(SCENE, 'case.yaml'), encoding='utf-8') as source:
        text = source.read()
    os.chdir(folder)
    with open('case.yaml', 'w', encoding='utf-8') as case:
        case.write(text)
    run(program('shroudhb'), 'modal', '--quiet', *WORDS, 'case.yaml')
    check_stop(check_ranks())
    check_faults()
    check_memory()
