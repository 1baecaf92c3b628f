#!/usr/bin/env python3
"""Write three_degree.modal.h5: the modal file of a structure that shroudhb did not mesh.

Needs numpy and h5py. Replace M, K, the shapes and the load by those of your own FE program.
"""
import h5py
import numpy as np

M = np.eye(3)  # kg
K = np.array([[1, 0.2, 0.1], [0.2, 1.3, 0.15], [0.1, 0.15, 1.6]])  # N/m
F = np.array([0.04, 0.06, 0.03])  # N, once per engine-order period

L = np.linalg.cholesky(M)
square, Q = np.linalg.eigh(np.linalg.solve(L, np.linalg.solve(L, K).T))
Phi = np.linalg.solve(L.T, Q)  # columns are modes, Phi' M Phi = I
omega = np.sqrt(square)  # rad/s, ascending

with h5py.File("three_degree.modal.h5", "w") as file:
    file.attrs["format"] = "shroudhb modal model"
    file.attrs["format_version"] = 1
    file["modes/frequency"] = omega / (2 * np.pi)  # Hz
    file["modes/damping_ratio"] = 0.01 * omega  # damping matrix 0.02 K
    file["contact/right/shape"] = Phi[None]  # [pair, axis, mode]; no left side: contact to ground
    file["load/modal_force"] = np.array([0 * F, F]) @ Phi  # [harmonic 0, 1][mode]
    file["probe/name"] = ["mass"]
    file["probe/shape"] = Phi[None]  # [probe, axis, mode]
