/* What the static equilibrium means for the part: stresses at the nodes, forces at the clamp. */
#ifndef MODAL_CONDENSE_STATIC_RESULTS_H
#define MODAL_CONDENSE_STATIC_RESULTS_H

#include "fem/body/stress.h"
#include "mesh/base/status.h"
#include "modal/hdf5/h5.h"

typedef struct {
  int n_nodes;
  double (*stress)[FEM_STRESSES]; /* [n_nodes][6] Pa, Cauchy, mesh axes */
  double *von_mises;              /* [n_nodes] Pa, of those */
  int     n_clamped;
  int    *clamped;       /* [n_clamped] nodes of group root, ascending */
  double (*reaction)[3]; /* [n_clamped][3] N, what the clamp exerts on each */
  double force[3],
      moment[3];  /* their sums, N and N m, about the origin at the deformed positions */
  double load[3]; /* resultant of the loads, N: -force but for what is out of balance */
} modal_static_results;

/* Fill out (zeroed before) from the displacement [n_nodes][3]. On one rank. Errors: SHB_ERR_IO no memory. */
shb_status modal_static_results_create(const fem_body *body, const double *displacement,
                                       modal_static_results *out);

/* /static/{nodal_stress, nodal_von_mises, reaction_node, reaction, reaction_force, reaction_moment, load_force}; nothing of a zeroed one. */
shb_status modal_static_results_write(hid_t file, const modal_static_results *statics);

void modal_static_results_free(modal_static_results *statics); /* also on a zeroed struct */

#endif
