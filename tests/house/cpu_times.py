"""CPU seconds of each test and the label that fits it; the tests.cmake files follow it.

cpu_times.py BUILD [REGEX]   runs the tests of a build folder one by one, without the house tests

unit         below UNIT seconds of CPU time, programs that the test starts included
integration  below SLOW seconds
slow         the rest
A line ends in "now LABEL" where the test has another label at present.
"""
import json
import os
import re
import resource
import subprocess
import sys

UNIT, SLOW = 1.0, 20.0


def tests_of(build):
    listing = subprocess.run(['ctest', '--show-only=json-v1'], cwd=build, check=True,
                             capture_output=True, text=True).stdout
    for test in json.loads(listing)['tests']:
        properties = {entry['name']: entry['value'] for entry in test['properties']}
        yield test['name'], test.get('command'), properties


def cpu_seconds(command, properties):
    environment = dict(os.environ)
    environment.update(entry.split('=', 1) for entry in properties.get('ENVIRONMENT', []))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, cwd=properties['WORKING_DIRECTORY'], env=environment,
                          stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return seconds, done.returncode


def main(build, pattern='.'):
    total = {}
    for name, command, properties in tests_of(build):
        if name.startswith('tests.') or not command or not re.search(pattern, name):
            continue
        seconds, code = cpu_seconds(command, properties)
        fits = 'unit' if seconds < UNIT else 'integration' if seconds < SLOW else 'slow'
        now = ' '.join(properties.get('LABELS', []))
        total[fits] = total.get(fits, 0) + seconds
        failed = f' exit {code}' if code not in (0, properties.get('SKIP_RETURN_CODE', 0)) else ''
        other = f', now {now}' if now != fits else ''
        print(f'{seconds:8.2f} {fits:12}{name}{failed}{other}', flush=True)
    for label, seconds in total.items():
        print(f'{seconds:8.2f} {label} together')


if __name__ == '__main__':
    main(*sys.argv[1:])
