"""cases.scenes.read_results: the scripts of cases/read_results on a small blade.

Usage: test_read_results.py SHROUDHB CASE FOLDER. Exit code 77: h5py or matplotlib is missing.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

try:
    import h5py  # noqa: F401
    import matplotlib  # noqa: F401
except ImportError:
    sys.exit(77)

SHROUDHB, CASE, SCRIPTS = (os.path.abspath(word) for word in sys.argv[1:4])


def run(*words):
    done = subprocess.run(words, capture_output=True, text=True, timeout=300)
    if done.returncode != 0:
        raise AssertionError(f'{words}: code {done.returncode}\n{done.stdout}{done.stderr}')
    return done.stdout


def has_vtk():
    return subprocess.run([sys.executable, '-c', 'from vtkmodules.vtkIOHDF import vtkHDFReader'],
                          capture_output=True).returncode == 0


def main(folder):
    shutil.copy(CASE, os.path.join(folder, 'blade.yaml'))
    os.chdir(folder)
    summary = json.loads(run(
        SHROUDHB, 'run', '--json', '--no-report', '--set', 'name=blade', '--set',
        'mesh.blade.size=14 mm', '--set', 'contact.n0=[60 N, 80 N]', '--set',
        'mhb.frequency=[255 Hz, 280 Hz]', '--set', 'mhb.stability=never', 'blade.yaml'))
    said = run(sys.executable, os.path.join(SCRIPTS, 'read_results.py'), 'blade')
    print(said)
    for i, mode in enumerate(summary['modes'][:6]):
        assert f"mode {i + 1}: {mode['frequency']:.2f} Hz" in said
    peaks = {}  # a preload may have further curves beside its main one
    for n0, a in re.findall('^([0-9.]+) N: ([0-9.e-]+) m', said, re.M):
        peaks[float(n0)] = max(float(a), peaks.get(float(n0), 0))
    curves = [c for c in summary['curves'] if c['kind'] == 'nonlinear']
    assert len(curves) == 2
    for curve in curves:  # that of the summary is refined between points
        assert abs(peaks[curve['n0']] / curve['peak']['amplitude'] - 1) < 1e-2
    for picture in ('blade.modes.png', 'blade.response.png'):
        assert open(picture, 'rb').read(8) == b'\x89PNG\r\n\x1a\n'
    if has_vtk():
        said = run(sys.executable, os.path.join(SCRIPTS, 'read_vtk.py'), 'blade')
        print(said)
        assert f"mode_001 {summary['modes'][0]['frequency']:.6g} Hz" in said
        assert 'mode_001' in open('blade.mode_1.vtu', errors='replace').read(5000)
    else:
        print('no VTK: read_vtk.py was not run')


where = tempfile.mkdtemp()
try:
    main(where)
finally:
    os.chdir('/')
    shutil.rmtree(where)
