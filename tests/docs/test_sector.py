"""What docs/user/sector.md states, on a whole ring: test_sector.py SHROUDHB WORK_FOLDER

Five blades with random shapes at both contact faces, stuck throughout, are solved as one structure:
the right face of blade b and the left face of blade b + 1 are joined by springs along v, u, w, and
the load of blade b lags by 2 pi E b/N. Motion, force and probe of blade 0 must be the program's. A
wave the other way must differ, and is that of a rotor that turns to the right. The drawing must be
what docs/figures/sector.py draws.
"""
import subprocess
import sys
from pathlib import Path

try:
    import h5py
    import numpy as np
except ImportError:
    sys.exit(77)

BLADES, MODES, N0 = 5, 6, 1e9
PSI, PHI = np.radians(35), np.radians(12)
KV, KU = 4e4, np.array([[2e4, 5e3], [5e3, 3e4]])

CASE = """name: ring
modal: {{file: ring.modal.h5}}
rotor: {{blades: {blades}, turns: {turns}}}
excitation: {{engine_order: {order}}}
contact: {{to: neighbour, psi: 35 deg, phi: 12 deg, mu: 1, ku: [2e4, 5e3, 3e4], kv: 4e4, n0: {n0}}}
mhb: {{frequency: [60 Hz, 200 Hz], harmonics: 1}}
"""


def shroud_axes():
    """Columns v, u, w in tangential, axial, radial: eq. 2."""
    c, s, cf, sf = np.cos(PSI), np.sin(PSI), np.cos(PHI), np.sin(PHI)
    return np.array([[c * cf, -s, c * sf], [s * cf, c, s * sf], [-sf, 0, cf]])


def write_model(path, model):
    with h5py.File(path, "w") as file:
        file.attrs["format"] = "shroudhb modal model"
        file.attrs["format_version"] = 1
        file["modes/frequency"] = model["hz"]
        file["modes/damping_ratio"] = model["zeta"]
        file["contact/right/shape"] = model["right"][None]
        file["contact/left/shape"] = model["left"][None]
        file["load/modal_force"] = np.array([0 * model["force"], model["force"]])
        file["probe/name"] = ["tip"]
        file["probe/shape"] = model["right"][None]


def solve_ring(model, order, w, lag):
    """Motion, force, probe of blade 0; lag 1: blade b + 1, turned by +2 pi/N, lags; -1: leads."""
    springs = np.zeros((3, 3))
    springs[0, 0], springs[1:, 1:] = KV, KU
    wi = 2 * np.pi * model["hz"]
    A = np.zeros((BLADES * MODES, BLADES * MODES), complex)
    f = np.zeros(BLADES * MODES, complex)
    right, left = shroud_axes().T @ model["right"], shroud_axes().T @ model["left"]
    for b in range(BLADES):
        own = slice(b * MODES, (b + 1) * MODES)
        after = (b + 1) % BLADES
        next_one = slice(after * MODES, (after + 1) * MODES)
        A[own, own] += np.diag(wi**2 - w**2 + 2j * model["zeta"] * wi * w)
        A[own, own] += right.T @ springs @ right
        A[own, next_one] -= right.T @ springs @ left
        A[next_one, own] -= left.T @ springs @ right
        A[next_one, next_one] += left.T @ springs @ left
        f[own] = model["force"] * np.exp(-2j * np.pi * lag * order * b / BLADES)
    q = np.linalg.solve(A, f).reshape(BLADES, MODES)
    motion = right @ q[0] - left @ q[1]
    return motion, springs @ motion, model["right"] @ q[0]


def distance(a, b):
    return np.abs(a - b).max() / np.abs(b).max()


def check_order(program, folder, model, order, turns):
    case, lag = folder / "ring.yaml", 1 if turns == "left" else -1
    case.write_text(CASE.format(blades=BLADES, order=order, n0=N0, turns=turns))
    subprocess.run([program, "mhb", "--quiet", "--force", str(case)], check=True)
    with h5py.File(folder / "ring.response.h5") as file:
        branch = file["branch_2"]
        assert file.attrs["engine_order"] == order
        assert ("rotor_turns" in file.attrs) == (turns == "right")
        assert branch.attrs["kind"] in ("nonlinear", b"nonlinear")
        i = len(branch["frequency"]) // 3
        w = 2 * np.pi * branch["frequency"][i]
        found = [branch[name][i, 0, :, 1] for name in ("motion", "force", "probe")]
    for a, b in zip(found, solve_ring(model, order, w, lag)):
        assert distance(a, b) < 1e-12, distance(a, b)
    for a, b in zip(found, solve_ring(model, order, w, -lag)):
        assert distance(a, b) > 0.1, distance(a, b)


def check_drawing(root):
    page = root / "docs/user/sector.svg"
    sys.path.insert(0, str(root / "docs/figures"))
    sys.dont_write_bytecode = True
    import sector  # noqa: PLC0415

    drawn = sector.page()
    assert drawn == page.read_text(encoding="utf-8"), "run docs/figures/sector.py"


def main():
    program, folder = sys.argv[1], Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    rng = np.random.default_rng(3)
    model = {"hz": np.array([80.0, 110, 150, 190, 260, 340]), "zeta": np.full(MODES, 0.01),
             "right": rng.normal(size=(3, MODES)), "left": rng.normal(size=(3, MODES)),
             "force": 10 * rng.normal(size=MODES)}
    write_model(folder / "ring.modal.h5", model)
    for order, turns in ((2, "left"), (3, "left"), (2, "right"), (6, "right")):
        check_order(program, folder, model, order, turns)
    check_drawing(Path(__file__).resolve().parents[2])


if __name__ == "__main__":
    main()
