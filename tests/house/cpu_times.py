"""Wall and CPU seconds of each test, and the label that fits it; the tests.cmake files follow it.

cpu_times.py BUILD [REGEX] [JOBS]   runs the tests of a build folder, JOBS at a time (default 1)

unit         below UNIT seconds of CPU time, programs that the test starts included
integration  below SLOW seconds
slow         the rest
A line ends in "now LABEL" where the test has another label at present. Nightly tests are left out.
"""
import concurrent.futures
import json
import os
import re
import subprocess
import sys
import time

UNIT, SLOW = 1.0, 20.0


def tests_of(build):
    listing = subprocess.run(['ctest', '--show-only=json-v1'], cwd=build, check=True,
                             capture_output=True, text=True).stdout
    for test in json.loads(listing)['tests']:
        properties = {entry['name']: entry['value'] for entry in test['properties']}
        yield test['name'], test.get('command'), properties


def measure(name, command, properties):
    """Name, wall seconds, CPU seconds of the test and all that it waited for, exit code."""
    environment = dict(os.environ)
    environment.update(entry.split('=', 1) for entry in properties.get('ENVIRONMENT', []))
    began = time.monotonic()
    with open(os.devnull, 'r+b') as null:
        child = subprocess.Popen(command, cwd=properties['WORKING_DIRECTORY'], env=environment,
                                 stdin=null, stdout=null, stderr=null)
        _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    wall = time.monotonic() - began
    return name, wall, usage.ru_utime + usage.ru_stime, child.returncode, properties


def main(build, pattern='.', jobs='1'):
    total, began = {}, time.monotonic()
    chosen = [test for test in tests_of(build) if test[1] and re.search(pattern, test[0])]
    chosen.sort(key=lambda test: -test[2].get('COST', 0))
    print(f'{"wall, s":>8} {"CPU, s":>8}')
    with concurrent.futures.ThreadPoolExecutor(int(jobs)) as pool:
        runs = [pool.submit(measure, *test) for test in chosen]
        for run in concurrent.futures.as_completed(runs):
            name, wall, seconds, code, properties = run.result()
            fits = 'unit' if seconds < UNIT else 'integration' if seconds < SLOW else 'slow'
            now = ' '.join(properties.get('LABELS', []))
            total[now] = total.get(now, 0) + seconds
            failed = code not in (0, properties.get('SKIP_RETURN_CODE', 0))
            print(f'{wall:8.2f} {seconds:8.2f} {fits:12}{name}' + f', exit {code}' * failed
                  + f', now {now}' * (now != fits), flush=True)
    for label, seconds in total.items():
        print(f'{"":8} {seconds:8.2f} {label} together')
    print(f'{time.monotonic() - began:8.2f} {sum(total.values()):8.2f} all')


if __name__ == '__main__':
    main(*sys.argv[1:])
