/* Results of the static equilibrium: stresses at the nodes, reactions of the clamp. */
#ifndef MODAL_CONDENSE_STATIC_RESULTS_H
#define MODAL_CONDENSE_STATIC_RESULTS_H

#include "fem/body/stress.h"
#include "mesh/base/status.h"
#include "modal/hdf5/h5.h"

typedef struct {
  int n_nodes;
  double (*stress)[FEM_STRESSES]; /* [n_nodes][6] Pa, Cauchy, mesh axes */
  double *von_mises;              /* [n_nodes] Pa */
  int     n_clamped;
  int    *clamped;       /* [n_clamped] nodes of group root, ascending */
  double (*reaction)[3]; /* [n_clamped][3] N, force of the clamp on each node */
  double force[3];       /* N, sum of the reactions */
  double moment[3];      /* N m, of the reactions about the origin, at the deformed positions */
  double load[3];        /* N, sum of the loads: -force up to the equilibrium error */
} modal_static_results;

/* Compute out (zeroed before) from the displacement [n_nodes][3] m, on one rank. */
shb_status modal_static_results_create(const fem_body *body, const double *displacement,
                                       modal_static_results *out);

/* Write /static/{nodal_stress, nodal_von_mises, reaction_node, reaction, reaction_force,
 * reaction_moment, load_force}; nothing for a zeroed struct. */
shb_status modal_static_results_write(hid_t file, const modal_static_results *statics);

void modal_static_results_free(modal_static_results *statics); /* also on a zeroed struct */

#endif
