#!/usr/bin/env python3
"""Write ring.modal.h5: modes by nodal diameter of a ring of sectors that shroudhb did not mesh.

A sector has a mass of the disc, held by springs to the axis and to the next ones. On it stands the
blade mass of write_modal.py. Needs numpy and h5py. Replace frequency and shape by those of your FE
program's cyclic symmetry: real part from the base sector, imaginary part from its duplicate.
"""
import h5py
import numpy as np

N = 12  # sectors
M = np.diag([2.0, 2, 2, 1, 1, 1])  # kg: disc, blade; tangential, axial, radial
ON_DISC = np.array([[1, 0.2, 0.1], [0.2, 1.3, 0.15], [0.1, 0.15, 1.6]])  # N/m, blade on disc
TO_NEXT = np.array([[1, 0.3, 0], [0, 1, 0.3], [0.2, 0, 1]])  # three springs to the next sector:
FROM_LAST = np.array([[1, 0, 0.3], [0.3, 1, 0], [0, 0.2, 1]])  # directions of their two ends
BLADE = slice(3, 6)
F = np.array([0, 0, 0, 0.04, 0.06, 0.03])  # N on the blade, once per engine-order period


def stiffness(theta):
    """K of a wave in which the next sector lags by theta."""
    K = np.zeros((6, 6), complex)
    stretch = TO_NEXT - np.exp(-1j * theta) * FROM_LAST
    K[:3, :3] = 0.3 * np.eye(3) + 0.2 * stretch.conj().T @ stretch + ON_DISC
    K[:3, 3:] = K[3:, :3] = -ON_DISC
    K[3:, 3:] = ON_DISC
    return K


def modes(theta):
    """Frequencies (rad/s, ascending) and shapes, phi^H M phi = 1."""
    root = np.sqrt(np.diag(M))
    square, Q = np.linalg.eigh(stiffness(theta) / np.outer(root, root))
    return np.sqrt(square), Q / root[:, None]


with h5py.File("ring.modal.h5", "w") as file:
    file.attrs["format"] = "shroudhb modal model"
    file.attrs["format_version"] = 3
    file.attrs["blades"] = N
    file.attrs["nodal_diameters"] = np.arange(N // 2 + 1)
    for n in range(N // 2 + 1):
        omega, Phi = modes(2 * np.pi * n / N)
        wave = n > 0 and 2 * n < N  # else shapes are real
        group = file.create_group(f"nodal_diameter_{n}")
        blade = Phi[BLADE] if wave else Phi[BLADE].real
        group["modes/frequency"] = omega / (2 * np.pi)  # Hz
        group["modes/damping_ratio"] = 0.01 * omega
        group["contact/right/shape"] = blade[None]  # [pair, axis, mode]; both shroud faces move
        group["contact/left/shape"] = blade[None]  # with the blade mass
        group["load/modal_force"] = np.array([0 * F, F]) @ Phi.conj()  # phi^H f, harmonics 0, 1
        group["probe/name"] = ["blade"]
        group["probe/shape"] = blade[None]  # [probe, axis, mode]
