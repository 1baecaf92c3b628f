"""What Python tests of the programs share: runs of a program, a case in a folder of its own, files
that are read."""
import contextlib
import csv
import os
import pty
import shutil
import subprocess
import tempfile

ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT='1', OMPI_ALLOW_RUN_AS_ROOT_CONFIRM='1')


def run(*words, code=0):
    """Run a program to its end; what it said. AssertionError: another exit code."""
    done = subprocess.run(words, capture_output=True, text=True, env=ENVIRONMENT, timeout=300)
    if done.returncode != code:
        raise AssertionError(f'{words}: code {done.returncode}, not {code}\n{done.stdout}'
                             f'{done.stderr}')
    return done.stdout + done.stderr


def run_on_terminal(*words):
    """Run a program on a terminal to its end; what it said there. AssertionError: an exit code."""
    said = b''
    child, terminal = pty.fork()
    if child == 0:
        os.execvpe(words[0], words, ENVIRONMENT)
    with open(terminal, 'rb', buffering=0) as source:
        try:
            while part := source.read(4096):
                said += part
        except OSError:  # the other end is closed
            pass
    code = os.waitpid(child, 0)[1]
    if code != 0:
        raise AssertionError(f'{words}: status {code}\n{said.decode()}')
    return said.decode()


def write(name, text):
    """Write a file and return its name."""
    with open(name, 'w') as out:
        out.write(text)
    return name


def read(name):
    """The bytes of a file."""
    with open(name, 'rb') as source:
        return source.read()


def rows(name):
    """The rows of a CSV file, each a dict of text."""
    with open(name, newline='') as source:
        return list(csv.DictReader(source))


def near(value, expected, tolerance):
    """AssertionError: a value, number or text, is further than that from the expected one."""
    if abs(float(value) - float(expected)) > tolerance * abs(float(expected)):
        raise AssertionError(f'{value} is not {expected} within {tolerance}')


@contextlib.contextmanager
def bring_your_own(scene):
    """Work in a folder of its own that holds case.yaml and write_modal.py of the scene."""
    folder, before = tempfile.mkdtemp(), os.getcwd()
    try:
        for name in ('case.yaml', 'write_modal.py'):
            shutil.copy(os.path.join(scene, name), folder)
        os.chdir(folder)
        yield folder
    finally:
        os.chdir(before)
        shutil.rmtree(folder)
