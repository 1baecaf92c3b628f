"""Results as numbers: what two files of the same run must share."""
import csv
import os

import h5py
import numpy as np


def is_cost(name):
    """Time and memory of the run, which differ from run to run."""
    return name.startswith('phases/') or os.path.basename(name) == 'seconds'


def numbers(path):
    """Bytes of every dataset of numbers but the cost of the run, by name, with type and shape."""
    found = {}

    def keep(name, item):
        if not is_cost(name) and isinstance(item, h5py.Dataset) and item.dtype.kind in 'iufcbV':
            value = np.asarray(item[()])
            found[name] = (str(value.dtype), value.shape, value.tobytes())
    with h5py.File(path, 'r') as file:
        file.visititems(keep)
    return found


def table(path):
    """The rows of a CSV file without the times of the run."""
    with open(path, newline='') as file:
        return [{name: value for name, value in row.items() if name != 'seconds'}
                for row in csv.DictReader(file)]


def content(path):
    """What a file holds, of an HDF5 file the numbers."""
    if path.endswith('.h5'):
        return numbers(path)
    with open(path, 'rb') as file:
        return file.read()
