/* Inertia of rigid motions of the body, as excited by a moving root.
 *
 * Motions r: translation by 1 along x, y, z, and rotation by 1 rad about the engine axis. The
 * clamped nodes move as well. */
#ifndef FEM_BODY_RIGID_BODY_H
#define FEM_BODY_RIGID_BODY_H

#include "fem/body/assemble.h"
#include "fem/body/rotating_body.h"

enum { FEM_RIGID = 4 };

/* Inertia forces M r at the free dofs, and r^T M r of the whole body. The latter is three times its
 * mass, and its moment of inertia about the engine axis. Collective.
 *   u        in   [n_nodes][3] m, the rotation is about the deformed position; NULL: at rest
 *   load     out  M r, vectors of the system; kg and kg m
 *   inertia  out  kg, kg, kg, kg m2; the same on every rank */
PetscErrorCode fem_rigid_load(const fem_body *body, const double *u, const fem_system *system,
                              Vec load[FEM_RIGID], double inertia[FEM_RIGID]);

#endif
