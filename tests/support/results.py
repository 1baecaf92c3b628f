"""Results as numbers: what two HDF5 files of the same run must share."""
import h5py
import numpy as np


def numbers(path):
    """Bytes of every dataset of numbers, by name, with type and shape."""
    found = {}

    def keep(name, item):
        if isinstance(item, h5py.Dataset) and item.dtype.kind in 'iufcbV':
            value = np.asarray(item[()])
            found[name] = (str(value.dtype), value.shape, value.tobytes())
    with h5py.File(path, 'r') as file:
        file.visititems(keep)
    return found
