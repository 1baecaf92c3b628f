"""h5py's side of test_python.c:  foreign.py write FILE | check FILE"""
import sys

import h5py
import numpy as np


def write(path):
    """A modal file as others may store it: single precision, packed, big-endian, fixed text."""
    shape = np.arange(2 * 3 * 4).reshape(2, 3, 4)
    with h5py.File(path, "w", libver="latest") as file:
        file.attrs["format"] = np.bytes_("shroudhb modal model")
        file.attrs["format_version"] = np.array([1], dtype="u1")
        file["modes/frequency"] = np.array([100, 200, 300, 400], dtype=">i4")
        file["modes/damping_ratio"] = np.full(4, 0.25, dtype="f2")
        file.create_dataset("contact/right/shape", data=shape.astype("f4"), compression="gzip",
                            chunks=(1, 3, 2))
        file["contact/left/shape"] = -shape
        file["load/modal_force"] = (shape[0] + 1j * shape[1]).astype("c8")
        file["probe/name"] = np.array(["tip", "psi \u03c8".encode()], dtype="S6")
        file["probe/shape"] = shape.astype(">f8")
        file["not/ours"] = np.arange(3)  # what we do not know is let be


def check_described(file):
    found = []

    def visit(name, item):
        if isinstance(item, h5py.Dataset):
            assert isinstance(item.attrs["units"], str) and item.attrs["units"], name
            assert isinstance(item.attrs["long_name"], str) and item.attrs["long_name"], name
            item[...]  # every value can be read
            found.append(name)

    file.visititems(visit)
    for name in ("format", "revision", "command", "case_path", "case_text", "settings", "created"):
        assert isinstance(file.attrs[name], str), name
    return found


def check(path):
    """Our own modal file, as test_python.c wrote it."""
    with h5py.File(path, "r") as file:
        assert len(check_described(file)) == 11
        assert file.attrs["format"] == "shroudhb modal model" and file.attrs["format_version"] == 1
        assert file.attrs["case_text"] == "name: \u03c8\n"
        force = file["load/modal_force"]
        assert force.dtype == np.complex128 and force.shape == (2, 2)
        assert force[1, 1] == 2.5 - 0.125j
        assert force.dims[1][0] == file["modes/frequency"]
        assert list(file["probe/name"].asstr()) == ["tip \u03c8"]
        axes = file["contact/right/shape"].dims[1][0].asstr()
        assert list(axes) == ["tangential", "axial", "radial"]


if __name__ == "__main__":
    {"write": write, "check": check}[sys.argv[1]](sys.argv[2])
