"""robust.damaged: files that are damaged at random. No stage crashes, hangs, or leaves half a file.

Usage: test_damaged.py SERVER CASE_FOLDER MUTANTS [SEED [INPUT]...]
SERVER is stage_server. MUTANTS of each input: bits flipped, blocks lost, zeroed or swapped, the
head of another file. Exit code 77: h5py is missing.

A stage that reads a damaged file ends with 0, 2, 3 or 4. Where it fails it says so in one line, and
an older result is what it was. Where it ends with 0, its results are those of the sound file, or it
has warned that the checksum does not fit; a file without a checksum may hold other numbers.
"""
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile

try:
    import h5py  # of write_modal.py
except ImportError:
    sys.exit(77)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../support'))
from blade import BLADE
from programs import ENVIRONMENT, bring_your_own, read, write
from results import content

SERVER, SCENE = (os.path.abspath(word) for word in sys.argv[1:3])
MUTANTS = int(sys.argv[3])
SEED = int(sys.argv[4]) if len(sys.argv) > 4 else 1
CHOSEN = sys.argv[5:]
DICE = random.Random(SEED)
ENVIRONMENT.update(OPENBLAS_NUM_THREADS='1', OMP_NUM_THREADS='1')
CRASH = 'crashed while it was read'


def flipped(data, _):
    for _ in range(DICE.randint(1, 8)):
        at = DICE.randrange(len(data))
        data[at] ^= 1 << DICE.randrange(8)
    return data


def block(data):
    """A random block, of any size alike in logarithm."""
    size = min(int(2 ** DICE.uniform(0, 12)), len(data) // 2)
    at = DICE.randrange(len(data) - size)
    return at, at + size


def cut(data, _):
    return data[:DICE.randrange(len(data))]


def lost(data, _):
    start, end = block(data)
    del data[start:end]
    return data


def filled(data, _):
    start, end = block(data)
    data[start:end] = bytes([DICE.choice((0, 0, 255, DICE.randrange(256)))]) * (end - start)
    return data


def swapped(data, _):
    start, end = block(data)
    other = DICE.randrange(len(data) - (end - start))
    moved = bytes(data[start:end])
    data[start:end] = data[other:other + end - start]
    data[other:other + end - start] = moved
    return data


def spliced(data, other):
    size = min(int(2 ** DICE.uniform(3, 12)), len(data), len(other))
    data[:size] = other[:size]
    return data


def renumbered(data, _):
    """Another number in a text; in a binary file another byte."""
    found = list(re.finditer(rb'-?\d+(\.\d*)?', data[:1 << 16]))
    if not found:
        return flipped(data, _)
    one = DICE.choice(found)
    data[one.start():one.end()] = DICE.choice(
        (b'0', b'-1', b'1', b'2147483648', b'99999999999999999999', b'nan', b'1e400', b'3', b''))
    return data


DAMAGES = (flipped, flipped, cut, lost, filled, swapped, spliced)


class Stages:
    """The server."""

    def __init__(self):
        self.process = subprocess.Popen([SERVER], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        text=True, env=ENVIRONMENT)

    def run(self, *words):
        """Exit code (a signal is negative) and what the stage said."""
        self.process.stdin.write('\t'.join(words) + '\n')
        self.process.stdin.flush()
        code = int(self.process.stdout.readline())
        return code, read('said').decode(errors='replace')


def put(name, data):
    with open(name, 'wb') as out:
        out.write(data)


def remove(names):
    for name in names:
        if os.path.exists(name):
            os.remove(name)


class Input:
    """A file, the run that reads it, and what the run makes."""

    def __init__(self, name, words, made, other, stamped=False, damages=DAMAGES):
        self.name, self.words, self.made = name, words, made
        self.sound, self.other, self.stamped, self.damages = read(name), other, stamped, damages

    def prepare(self, stages):
        """Result of the sound file."""
        code, said = stages.run(*self.words)
        assert code == 0, (self.words, code, said)
        self.results = {made: content(made) for made in self.made}
        self.old = {made: read(made) for made in self.made}
        self.folder = set(os.listdir())

    def check(self, stages, seed):
        """One mutant: how the stage ended."""
        DICE.seed(f'{SEED} {self.name} {self.words[0]} {seed}')
        damage = DICE.choice(self.damages)
        put(self.name, damage(bytearray(self.sound), self.other))
        who = (self.words[0], self.name, seed, damage.__name__)
        code, said = stages.run(*self.words)
        lines = said.splitlines()
        # the checksum, and what would be done about an older result
        warned = [line for line in lines if line.startswith('shroudhb: warning: ')]
        errors = [line for line in lines if line not in warned]
        assert code in (0, 2, 3, 4), (who, code, said)
        assert len(errors) == (code != 0), (who, code, said)
        left = set(os.listdir()) - self.folder
        assert not left, (who, code, left)
        if code == 0:
            self.check_result(who, warned)
        else:
            self.check_old(who, code)
        return 'crash told' if CRASH in said else code

    def check_result(self, who, warned):
        told = not self.stamped or any('checksum' in line or 'damaged' in line for line in warned)
        for made in self.made:
            now = content(made) # h5py reads all of it
            assert told or now == self.results[made], (who, made, 'other numbers, not told')
            put(made, self.old[made])

    def check_old(self, who, code):
        for made in self.made:
            if made != self.name:
                assert read(made) == self.old[made], (who, code, made, 'was changed')

    def run(self, stages, n):
        self.prepare(stages)
        ends = {}
        for seed in range(n):
            try:
                end = self.check(stages, seed)
            except AssertionError:
                kept = os.path.join(tempfile.gettempdir(), f'damaged_{seed}_{self.name}')
                print('kept:', shutil.copy(self.name, kept))
                raise
            ends[end] = ends.get(end, 0) + 1
        put(self.name, self.sound)
        for made in self.made:
            put(made, self.old[made])
        print(f'{self.words[0]}, {self.name}: {n} mutants, ends {ends}', flush=True)


class OldResult(Input):
    """A result that is there only to be replaced: every run ends as the one without it."""

    def check_result(self, who, warned):
        for made in self.made:
            assert content(made) == self.results[made], (who, made, 'another result')

    def check(self, stages, seed):
        end = super().check(stages, seed)
        assert end == 0, (self.words, seed, end, read('said'))
        return end


def inputs(stages):
    """Every input, made one after the other."""
    text = re.sub(r'n0: .*', 'n0: [0.3 N]', open('case.yaml').read())
    text = re.sub(r'frequency: .*', 'frequency: [0.2 Hz, 0.201 Hz]', text)
    text = re.sub(r'harmonics: .*', 'harmonics: 3', text)
    write('one.yaml', text)
    modal, response, integration = (f'three_degree.{stage}.h5'
                                    for stage in ('modal', 'response', 'integration'))
    force = ('--quiet', '--force', 'one.yaml')
    assert stages.run('mhb', *force)[0] == 0
    own = read(response)
    yield Input(modal, ('mhb', *force), [response], own)
    yield OldResult(response, ('mhb', '--quiet', 'one.yaml'), [response], read(modal))
    yield Input(response, ('post', '--quiet', 'one.yaml'),
                [f'three_degree.{kind}' for kind in ('csv', 'svg', 'html', 'summary.json')],
                read(modal), stamped=True)
    yield Input(response, ('inspect', response), [], read(modal), stamped=True)
    yield Input(modal, ('inspect', modal), [], own)
    write('step.yaml', text + 'integrate: {frequencies: [0.2 Hz], tolerance: 1e-3}\n')
    yield Input(response, ('integrate', '--quiet', 'step.yaml'), [integration], read(modal),
                stamped=True)
    write('blade.yaml', BLADE.replace('SIZE', '24 mm'))
    code, said = stages.run('mesh', '--quiet', 'blade.yaml')
    assert code == 0, said
    write('own.yaml', re.sub(r'mesh:\n(  .*\n)*', 'mesh: {file: blade.msh}\n',
                             BLADE).replace('name: blade', 'name: own'))
    texts = DAMAGES + (renumbered, renumbered, renumbered)
    yield Input('blade.msh', ('mesh', '--quiet', '--force', 'own.yaml'), [], own, damages=texts)
    yield Input('blade.msh', ('modal', '--quiet', '--force', 'own.yaml'), ['own.modal.h5'], own,
                damages=texts)
    write('stamped.yaml', re.sub('harmonics: 3', 'harmonics: 1', read('own.yaml').decode())
          .replace('[90 Hz, 200 Hz]', '[150 Hz, 151 Hz]'))
    yield Input('own.modal.h5', ('mhb', '--quiet', '--force', 'stamped.yaml'), ['own.response.h5'],
                own, stamped=True)


if __name__ == '__main__':
    with bring_your_own(SCENE):
        subprocess.run([sys.executable, 'write_modal.py'], check=True)
        server = Stages()
        # a mesh with all its modes takes a second
        share = {'modal': .05, 'integrate': .25}
        for one in inputs(server):
            key = f'{one.words[0]}:{one.name}'
            if CHOSEN and not any(word in key for word in CHOSEN):
                one.prepare(server)
                continue
            one.run(server, max(int(MUTANTS * share.get(one.words[0], 1)), 1))
