"""How fast `shroudhb study` is: new blades a minute, and seconds for 1000 designs of contacts.

Usage: bench_study_rates.py BIN [--quick], with the programs in BIN. The machine should be idle.

Both studies vary cases/z_notch_blade. Blades are meshed and their modes solved, one by one; the
contacts share one modal file. Goals on two cores: 30 blades a minute, 60 s for 1000 contacts.
"""
import os
import resource
import shutil
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, '../support'))
from programs import rows, run, write

CASE = os.path.join(HERE, '../../cases/z_notch_blade/case.yaml')
BLADES = """case: {case}
vary:
  contact.n0: [50 N]
  mesh.blade.sections[4].thickness: {{from: 4 mm, to: 6 mm, points: {n}}}
  mesh.blade.sections[3].thickness: {{from: 4.6 mm, to: 6 mm, points: {n}}}
"""
CONTACTS = """case: {case}
vary:
  contact.n0: {{from: 5 N, to: 500 N, points: {n0}, scale: log}}
  contact.mu: {{from: 0.1, to: 0.5, points: {n}}}
  contact.ku: {{from: 0.3 MN/m, to: 0.7 MN/m, points: {n}}}
"""


def processor():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def measure(program, name, text):
    """Seconds and processor seconds of a study, and the number of its designs."""
    write(f'{name}.yaml', text)
    began, cpu = time.monotonic(), processor()
    run(program, 'study', '--quiet', f'{name}.yaml')
    seconds, cpu = time.monotonic() - began, processor() - cpu
    table = rows(f'{name}.study.csv')
    assert all(row['status'] == 'done' for row in table), f'{name}: a design has no result'
    return seconds, cpu, len(table)


def main():
    quick = '--quick' in sys.argv
    program, folder = os.path.join(os.path.abspath(sys.argv[1]), 'shroudhb'), tempfile.mkdtemp()
    os.chdir(folder)
    try:
        blades, preloads, others = (2, 2, 2) if quick else (4, 40, 5)
        for name, text in (('blades', BLADES.format(case=CASE, n=blades)),
                           ('contacts', CONTACTS.format(case=CASE, n0=preloads, n=others))):
            seconds, cpu, n = measure(program, name, text)
            print(f'{name:9} {n:5} designs {seconds:7.1f} s, {cpu / n:6.3f} CPU s a design, '
                  f'{60 * n / seconds:6.1f} a minute')
    finally:
        os.chdir('/')
        shutil.rmtree(folder)


main()
