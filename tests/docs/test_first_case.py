"""The peaks that docs/user/first_case.md prints.

test_first_case.py SHROUDHB ROOT WORK_FOLDER [N0...]   preloads, N; without: all seven
"""
import csv
import re
import shutil
import subprocess
import sys
from pathlib import Path


def printed(page):
    """{n0: (peak um, Hz)} of the page."""
    rows = re.findall(r"^ +(\d+) N +([\d.]+) um at +([\d.]+) Hz$", page, re.M)
    return {float(n0): (float(a), float(f)) for n0, a, f in rows}


def computed(path):
    peaks = {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["kind"] != "nonlinear":
                continue
            n0, a = float(row["n0_N"]), 1e6 * float(row["tip_motion_amplitude_m"])
            if a > peaks.get(n0, (0, 0))[0]:
                peaks[n0] = a, float(row["frequency_Hz"])
    return peaks


def main():
    program, root, folder = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
    only = [float(n0) for n0 in sys.argv[4:]]
    shutil.rmtree(folder, ignore_errors=True)  # nothing is up to date
    folder.mkdir(parents=True)
    shutil.copy(root / "cases/first_case/case.yaml", folder / "case.yaml")
    words = ["--set", f"contact.n0=[{', '.join(f'{n0:g} N' for n0 in only)}]"] if only else []
    subprocess.run([program, "run", "--quiet", *words, str(folder / "case.yaml")], check=True)
    text = (root / "docs/user/first_case.md").read_text(encoding="utf-8")
    page = printed(text)
    found = computed(folder / "first_case.csv")
    assert len(page) == 7 and sorted(found) == (only or sorted(page)), (page, found)
    for n0 in found:
        a, f = page[n0]
        assert abs(found[n0][0] - a) < 5e-3 * a, (n0, a, found[n0])
        assert abs(found[n0][1] - f) < 5e-2 * f, (n0, f, found[n0])  # tops are flat
    assert min(found, key=lambda n0: found[n0][0]) == 15, found


if __name__ == "__main__":
    main()
