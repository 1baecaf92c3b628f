"""tests.width and tests.sentences: lines that fit, and comments that are read once.

test_text.py width ROOT       no line is wider than 100 columns, comments included
test_text.py sentences ROOT   no sentence of a comment in a .c or .h file has more than 25 words
test_text.py --self-test      checks that faults are found in made-up text

width reads *.c, *.h, *.py, *.sh, *.cmake, CMakeLists.txt and the scripts without ending.
Columns are characters, not bytes.

sentences is rough. A line indented by two or more columns after the star is a formula or an entry
of a list: it is not read, and the sentence before it ends there. A blank line ends a sentence too.
Terms joined by an operator count as one word, and so do parentheses with symbols.
"""
import os
import re
import sys

WIDTH, WORDS = 100, 25
ENDINGS = ('.c', '.h', '.py', '.sh', '.cmake')
NAMES = ('CMakeLists.txt', 'run')
FOLDERS = ('.ci', 'mesh', 'fem', 'modal', 'mhb', 'postproc', 'cases', 'tests', 'docs')

ABBREVIATION = re.compile(r'\b(?:e\.g|i\.e|[Ee]qs?|[Ff]igs?|[Ss]ecs?|cf|pp?|vol|[Nn]os?|vs|approx|'
                          r'resp|et al|[A-Z])\.$')
COMMENT = re.compile(r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|/\*.*?\*/|//[^\n]*', re.S)
OPERATOR = re.compile(r'\s+(?:[-=<>+*/|^~≈≤≥·×−&]|<=|>=|->|=>|==|!=|&&|\|\||to the power)\s+')
SYMBOLIC = re.compile(r'[\(\[][^()\[\]]*[=<>*/^_|\d{}+,][^()\[\]]*[\)\]]')


def files_of(root, wanted):
    for top in FOLDERS:
        for folder, folders, names in os.walk(os.path.join(root, top)):
            folders[:] = sorted(name for name in folders if name != '__pycache__')
            for name in sorted(names):
                if wanted(name):
                    full = os.path.join(folder, name)
                    yield os.path.relpath(full, root).replace(os.sep, '/'), full
    full = os.path.join(root, 'CMakeLists.txt')
    if wanted('CMakeLists.txt') and os.path.isfile(full):
        yield 'CMakeLists.txt', full


def wide_lines(text):
    for number, line in enumerate(text.split('\n'), 1):
        if len(line) > WIDTH:
            yield number, f'{len(line)} columns'


def paragraphs(comment):
    """(line offset, text) of the running text of one comment, formulas and lists left out."""
    body = comment[2:-2] if comment.startswith('/*') else comment[2:]
    start, text = 0, []
    for offset, line in enumerate(body.split('\n')):
        stripped = re.sub(r'^\s*\*?', '', line) if offset else line
        if not stripped.strip() or (offset and re.match(r' {3,}\S', stripped)):
            if text:
                yield start, ' '.join(text)
            text = []
            continue
        start = start if text else offset
        text.append(stripped.strip())
    if text:
        yield start, ' '.join(text)


def sentences(text):
    sentence = []
    for word in text.split():
        sentence.append(word)
        if re.search(r'[.!?]["\')\]]*$', word) and not ABBREVIATION.search(' '.join(sentence)):
            yield ' '.join(sentence)
            sentence = []
    if sentence:
        yield ' '.join(sentence)


def count_words(sentence):
    short = SYMBOLIC.sub(' symbol ', sentence)
    short = OPERATOR.sub('=', short)
    return sum(1 for word in short.split() if re.search(r'\w', word))


def long_sentences(text):
    for match in COMMENT.finditer(text):
        if match.group()[0] != '/':
            continue
        line = text.count('\n', 0, match.start()) + 1
        for offset, paragraph in paragraphs(match.group()):
            for sentence in sentences(paragraph):
                n = count_words(sentence)
                if n > WORDS:
                    yield line + offset, f'{n} words: {sentence[:70]}...'


CHECKS = {
    'width': (lambda name: name.endswith(ENDINGS) or name in NAMES, wide_lines),
    'sentences': (lambda name: name.endswith(('.c', '.h')), long_sentences),
}


def check(kind, root):
    wanted, faults_of = CHECKS[kind]
    n_files = n_faults = 0
    for path, full in files_of(root, wanted):
        n_files += 1
        with open(full, encoding='utf-8') as file:
            for line, fault in faults_of(file.read()):
                print(f'{path}:{line}: {fault}')
                n_faults += 1
    print(f'{n_faults} faults in {n_files} files')
    return n_faults != 0 or n_files == 0


def self_test():
    words = ' '.join(['word'] * WORDS)
    wide, long = wide_lines, long_sentences
    rows = [  # check, text, faults
        (wide, 'x' * WIDTH, 0),
        (wide, 'x' * (WIDTH + 1), 1),
        (wide, '\u00b5' * WIDTH, 0),
        (wide, 'a\n' + 'x' * 200 + '\nb', 1),
        (long, f'/* {words}. {words}. */', 0),
        (long, f'/* {words} more. */', 1),
        (long, f'// {words} more', 1),
        (long, f'char *s = "/* {words} more";', 0),
        (long, f'/* {words}\n * more. */', 1),
        (long, f'/* {words}\n *\n * more */', 0),
        (long, f'/* Text:\n *   {words} {words}\n * end. */', 0),
        (long, f'/* {words[5:]} e.g. more words. */', 1),
        (long, f'/* {words[5:]} (a = b + 2, c). */', 0),
        (long, f'/* {words[5:]} a = b. */', 0),
        (long, f'/* {words[5:]} a b. */', 1),
    ]
    failed = 0
    for function, text, wanted in rows:
        found = len(list(function(text)))
        failed += found != wanted
        print(f'{"ok" if found == wanted else "FAILED"}: {found} of {wanted} in {text[:40]!r}')
    return failed != 0


if __name__ == '__main__':
    sys.exit(self_test() if sys.argv[1:] == ['--self-test'] else check(*sys.argv[1:]))
