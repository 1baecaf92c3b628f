/* Residual terms of more contact dofs than fit into one batch of columns.
 *
 * R and R2 are exact. They come from the condensed mass of subtrees (fem/supernodal/unit_loads.h).
 * With MUMPS, or without room, they take one solution a column in full and one at the contact
 * alone.
 *
 * R3 = V_1^T K V_1 falls off so fast over the face that few contact dofs S hold it. The others are
 * combinations of them, V_1 = V_1S C, where C leaves the least error in the norm of K:
 *
 *   C = (R3_SS)^-1 R3_S,   R3 = C^T R3_SS C + E,   mu_4 = C^T mu_4SS C,   mu_5 = C^T mu_5SS C,
 *
 * with E positive semi-definite (Nystrom). S are the pivots of a Cholesky factor of R2. Each is the
 * dof whose V_0 the ones before represent worst in the norm of M.
 *
 * What is left out is the greatest entry of s^2 E over that of R, at a third of the frequency of
 * the last mode. It is measured at the last dofs of S without them. Above 1e-8, as of a face that
 * is large for the body, all columns take their three solutions, and nothing is left out.
 *
 * There are no residual modes. */
#ifndef MODAL_CONDENSE_MANY_COLUMNS_H
#define MODAL_CONDENSE_MANY_COLUMNS_H

#include "modal/condense/residual_terms.h"

/* Fill the residual terms and tails of the model. Collective.
 *   left_out  out  of R3, as above
 * Errors: SHB_ERR_IO solver; SHB_INTERRUPTED. */
shb_status modal_many_columns_fill(const fem_system *system, const modal_eigen *eigen,
                                   const modal_condensation *to, shb_progress *progress,
                                   modal_model *model, double *left_out);

#endif
