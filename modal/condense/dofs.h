/* Generalised dofs: weighted sums of nodal displacements, such as the mean of a patch, a component
 * along an axis, or the work of a load. A unit force on a dof is spread over the nodes by the same
 * weights. Displacement u_c = b_c^T u and force f_c b_c are thus conjugate. */
#ifndef MODAL_CONDENSE_DOFS_H
#define MODAL_CONDENSE_DOFS_H

#include "fem/body/assemble.h"
#include "mesh/base/status.h"

/* Rows b_c of a sparse matrix over (node, axis). Zero-initialise. */
typedef struct {
  int     n, n_entries;
  int    *start;  /* [n + 1] entries of dof c: start[c] .. start[c + 1] - 1 */
  int    *node;   /* [n_entries] mesh node */
  double *weight; /* [n_entries][3], mesh axes */
} modal_dofs;

/* Append the dof sum_e weight[e] direction . u(node[e]). */
void modal_dofs_add(modal_dofs *dofs, int n_entries, const int *node, const double *weight,
                    const double direction[3]);

/* Append the dof that is the work of nodal forces [n_nodes][3]; zero entries are omitted. */
void modal_dofs_add_forces(modal_dofs *dofs, int n_nodes, const double *force);

/* Append dof c of another; all dofs of another. */
void modal_dofs_append_one(modal_dofs *dofs, const modal_dofs *more, int c);
void modal_dofs_append(modal_dofs *dofs, const modal_dofs *more);

/* B[:, c] = b_(first + c) for c < count; the other columns of the dense matrix B are zeroed. */
PetscErrorCode modal_dofs_spread(const modal_dofs *dofs, const fem_system *system, int first,
                                 int count, Mat B);

/* value[c][x] = b_c^T X[:, x] for all dofs and the first n_columns columns of the dense matrix X.
 * The row length is stride >= n_columns. Every rank gets the result; clamped nodes count as
 * zero. */
PetscErrorCode modal_dofs_sample(const modal_dofs *dofs, const fem_system *system, Mat X,
                                 int n_columns, int stride, double *value);

/* value[c] = b_c^T u of nodal displacements [n_nodes][3]. */
void modal_dofs_sample_nodal(const modal_dofs *dofs, const double *nodal, double *value);

void modal_dofs_free(modal_dofs *dofs);

#endif
