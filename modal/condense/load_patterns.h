/* Load: patterns of nodal forces and their weight in each harmonic, from the case or from a field
 * file. */
#ifndef MODAL_CONDENSE_LOAD_PATTERNS_H
#define MODAL_CONDENSE_LOAD_PATTERNS_H

#include "fem/element/load.h"
#include "modal/condense/dofs.h"

/* Force of harmonic k: sum_c weight[k][c] pattern[c]. */
typedef struct {
  int             n_harmonics; /* K */
  double complex *weight;      /* [K + 1][dofs.n] */
  modal_dofs      dofs;        /* one dof for each pattern: its work on the displacement */
} modal_load;

/* Create the patterns of n loads that act together. A load of the case gives one pattern. A field
 * gives the real and the imaginary part of every harmonic. n = 0: no pattern, one harmonic.
 *
 * A field file (HDF5) holds
 *
 *   /node      [n]       numbers of nodes in the mesh file
 *   /harmonic  [m]       whole numbers from 0 to 64, each once
 *   /force     [m, n, 3] N in mesh axes, complex or real; or
 *   /pressure  [m, n]    Pa, positive into the surface of group load, complex or real
 *
 * Pressure between the nodes follows the shape functions; every node of the group needs one.
 *
 *   fallback  in  where a force without a place of its own acts; NULL: none
 *
 * Errors: SHB_ERR_INPUT missing group or nodes, wrong numbers, zeros only; SHB_ERR_IO unreadable
 * file. */
shb_status modal_load_create(const mesh_fe *mesh, int n, const fem_load *loads,
                             const double *fallback, modal_load *out);

void modal_load_free(modal_load *load); /* also on a zeroed struct */

#endif
