"""Curves along the preload, and tracked peaks, of cases/bladed_disc against frequency sweeps.

usage: test_disc_vary.py BIN SCENE   BIN: folder of shroudhb; SCENE: cases/bladed_disc
Exit code 77 without h5py.
"""
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import h5py
    import numpy as np
except ImportError:
    sys.exit(77)

bin_folder, scene = Path(sys.argv[1]), Path(sys.argv[2])
FREQUENCY = 155.0  # Hz
PRELOADS = (40.0, 100.0)  # N


def run(folder, *settings):
    """Run the scene with five harmonics into the folder; the response file."""
    words = [bin_folder / "shroudhb", "run", "--quiet", "--no-report", "--into", folder]
    for setting in ("mhb.harmonics=5", *settings):
        words += ["--set", setting]
    subprocess.run(words + [scene / "case.yaml"], check=True)
    return h5py.File(folder / "bladed_disc.response.h5")


def curves(response, kind):
    branches = [response[name] for name in response if name.startswith("branch_")]
    return [b for b in branches if b.attrs["kind"] == kind]


def curve_at(response, n0):
    return next(b for b in curves(response, "nonlinear") if abs(b["n0"][0] - n0) < 1e-9)


def amplitude(branch):
    """First harmonic of the first probe: root of the sum over its axes, m."""
    return np.linalg.norm(branch["probe"][:, 0, :, 1], axis=1)


def peak_of(branch, near):
    """Height of the maximum of a sweep near a frequency, from a parabola through three points."""
    f, a = branch["frequency"][()], amplitude(branch)
    inside = np.flatnonzero(abs(f - near) < 5)
    top = inside[np.argmax(a[inside])]
    p = np.polyfit(f[top - 1:top + 2] - f[top], a[top - 1:top + 2], 2)
    return p[2] - p[1] ** 2 / (4 * p[0])


def main():
    scratch = tempfile.TemporaryDirectory()
    top = Path(scratch.name)
    names = [top / name for name in ("sweep", "vary", "track")]
    for name in names:
        name.mkdir()
    sweep = run(names[0], f"mhb.frequency=[{FREQUENCY} Hz, 165 Hz]", "contact.n0=[40 N, 100 N]")
    for name in names[1:]:  # the same mesh and modes
        for file in ("bladed_disc.msh", "bladed_disc.modal.h5"):
            shutil.copy2(names[0] / file, name)
    vary = run(names[1], f"mhb.frequency={FREQUENCY} Hz", "contact.n0=40 N",
               "mhb.vary.n0=[40 N, 100 N]")
    (along,) = curves(vary, "nonlinear")
    for end, n0 in zip((0, -1), PRELOADS):
        wanted, found = curve_at(sweep, n0), along["motion"][end]
        exact = wanted["motion"][0]
        error = abs(found - exact).max() / abs(exact).max()
        print(f"{n0:g} N at {FREQUENCY:g} Hz: along the preload against a sweep {error:.1e}")
        assert abs(along["parameter"][end] - n0) < 1e-12 * n0
        assert abs(wanted["frequency"][0] - FREQUENCY) < 1e-12 * FREQUENCY
        assert error < 1e-7, error
        assert along["stable"][end] == wanted["stable"][0]
    track = run(names[2], "mhb.frequency=[150 Hz, 165 Hz]", "contact.n0=40 N",
                "mhb.vary.n0=[60 N, 100 N]", "mhb.track=peak")
    (peaks,) = curves(track, "tracked")
    assert abs(peaks["parameter"][-1] - PRELOADS[1]) < 1e-9 * PRELOADS[1]
    height = peak_of(curve_at(sweep, PRELOADS[1]), peaks["frequency"][-1])
    error = abs(amplitude(peaks)[-1] / height - 1)
    print(f"peak at 100 N: {peaks['frequency'][-1]:.3f} Hz, against the sweep's {error:.1e}")
    assert error < 1e-5, error


main()
