#!/usr/bin/env python3
"""Reads NAME.modal.h5 and NAME.response.h5 and plots them: read_results.py FOLDER/NAME

Writes NAME.modes.png and NAME.response.png, and prints modes and peaks.
Needs python3-h5py and python3-matplotlib.
"""
import sys

import h5py
import matplotlib
import numpy as np

matplotlib.use('Agg')  # no window; leave it out to see the pictures
import matplotlib.pyplot as plt  # noqa: E402


def modes(path, picture):
    with h5py.File(path) as f:
        frequency = f['modes/frequency'][:]                        # Hz
        shape = f['modes/shape'][:]                                # [mode, node, 3], kg^-1/2
        nodes = f['mesh/nodes'][:]                                 # [node, 3], m
        mass = f['modes/effective_mass'][:] / f.attrs['mass']      # [mode, 3], shares
    for i, hz in enumerate(frequency[:6]):
        print(f'mode {i + 1}: {hz:.2f} Hz, effective mass', np.round(100 * mass[i], 1), '%')
    x, first = nodes[:, 2], shape[0]
    plt.figure()
    plt.scatter(x, np.linalg.norm(first, axis=1), s=2)
    plt.xlabel('z, m')
    plt.ylabel('mode 1, kg$^{-1/2}$')
    plt.title(f'{frequency[0]:.2f} Hz')
    plt.savefig(picture, dpi=100)
    plt.close()


def response(path, picture):
    plt.figure()
    with h5py.File(path) as f:
        for i in range(f.attrs['branches']):
            b = f[f'branch_{i}']
            if b.attrs['kind'] == 'integration':
                continue
            x = b['probe'][:, 0, :, 1]                             # first probe, first harmonic
            a2, c = np.sum(np.abs(x) ** 2, 1), np.abs(np.sum(x * x, 1))
            a = np.sqrt((a2 + c) / 2)                              # largest displacement, m
            k = np.argmax(a)
            limit = b.attrs['kind'] in ('open', 'stuck')
            label = b.attrs['kind'] if limit else f"{b['n0'][k]:g} N"
            print(f"{label}: {a[k]:.4g} m at {b['frequency'][k]:.2f} Hz")
            plt.semilogy(b['frequency'][:], a, 'k--' if limit else '-', lw=1, label=label)
    plt.xlabel('frequency, Hz')
    plt.ylabel('amplitude, m')
    plt.legend()
    plt.savefig(picture, dpi=100)
    plt.close()


if __name__ == '__main__':
    name = sys.argv[1]
    modes(name + '.modal.h5', name + '.modes.png')
    response(name + '.response.h5', name + '.response.png')
