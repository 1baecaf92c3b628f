/* Lowest modes of K phi = lambda M phi by SLEPc: shift-and-invert with a Cholesky factor
 * (fem/solver/factor.h) and block Lanczos (modal/eigen/block_lanczos.h). The option -eps_type
 * krylovschur selects SLEPc's own solver. */
#ifndef MODAL_EIGEN_EIGEN_H
#define MODAL_EIGEN_EIGEN_H

#include <slepceps.h>

#include "fem/body/assemble.h"
#include "fem/solver/factor.h"
#include "mesh/base/progress.h"
#include "modal/common/completeness.h"

/* A system that may give up K between its uses, since it can be assembled again. */
typedef struct {
  fem_system *system;
  fem_source  source;
} modal_spare_stiffness;

typedef struct {
  int              modes;     /* wanted, >= 1 */
  double           shift;     /* rad2/s2: 0 for a clamped body, below 0 for a free one */
  double           tolerance; /* of the eigensolver; 0: 1e-10 */
  shb_progress    *progress;  /* or NULL */
  modal_check_kind check;
  fem_factor     **factor; /* analysed for the pattern of K, taken over; NULL: it is made */
  const modal_spare_stiffness *spare; /* K is given up once it is factorised; NULL: it stays */
} modal_eigen_settings;

/* The residual of an eigenpair is |phi - (lambda - shift) (K - shift M)^-1 M phi| in the M norm,
 * with |phi| = 1. An eigenvalue lies within this relative distance of lambda - shift. The residual
 * |K phi - lambda M phi| would be dominated by rounding in the stiffest directions. */
typedef struct {
  int         n;
  double     *lambda;         /* [n] rad2/s2, ascending */
  double     *eigen_residual; /* [n] */
  Mat         phi;            /* dense [3 n_free][n], phi^T M phi = 1; the mesh fixes the signs */
  Mat         m_phi;          /* M phi, same layout */
  fem_factor *factor;         /* of K - shift M, also for later solves */
  EPS         eps;
  modal_check check;
} modal_eigen;

/* Order and analyse the pattern of K for that many modes. */
PetscErrorCode modal_eigen_analyse(const fem_system *system, int modes, fem_factor **factor);

/* Solve, and check that no mode below the last one is missing. A missing mode has more copies than
 * the block has columns, or hardly any component in the start block. The solver then repeats with
 * blocks of twice the size.
 *
 * Needs SLEPc initialised. Takes options (-eps_..., -st_mat_mumps_icntl_...) from PETSc's database.
 * Errors: PETSC_ERR_USER_INPUT more modes than dofs, K singular; PETSC_ERR_NOT_CONVERGED, also if a
 * mode stays missing; PETSC_ERR_MEM. After shb_interrupted() it stops early with eigen->n = 0 and
 * no error. */
PetscErrorCode modal_eigen_solve(const fem_system *system, const modal_eigen_settings *settings,
                                 modal_eigen *eigen);

/* X = (K - shift M)^-1 B, all columns at once. */
PetscErrorCode modal_eigen_inverse(const modal_eigen *eigen, Mat B, Mat X);

/* The same at the free nodes of this rank that node marks; the other rows of X mean nothing. */
PetscErrorCode modal_eigen_inverse_at(const modal_eigen *eigen, const bool *node, Mat B, Mat X);

/* X -= phi phi^T M X: remove the modes from every column. */
PetscErrorCode modal_eigen_project_out(const fem_system *system, const modal_eigen *eigen, Mat X);

/* A dense matrix of n columns, distributed like the system's vectors. */
PetscErrorCode modal_dense_create(const fem_system *system, int n, Mat *X);

/* Free the factor, the largest part. Modes stay; nothing can be solved any more. */
PetscErrorCode modal_eigen_drop_factor(modal_eigen *eigen);

PetscErrorCode modal_eigen_destroy(modal_eigen *eigen); /* also on a zeroed struct */

#endif
