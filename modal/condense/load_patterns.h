/* The load: patterns of nodal forces and what each harmonic takes of them; from the case, or from a field in a file. */
#ifndef MODAL_CONDENSE_LOAD_PATTERNS_H
#define MODAL_CONDENSE_LOAD_PATTERNS_H

#include "fem/element/load.h"
#include "modal/condense/dofs.h"

/* Force of harmonic k: sum_c weight[k][c] pattern[c]. */
typedef struct {
  int             n_harmonics; /* K */
  double complex *weight;      /* [K + 1][dofs.n] */
  modal_dofs      dofs;        /* one a pattern: its work on the displacement */
} modal_load;

/* The patterns of n loads, which act together: of each one with its factors, or of a field the real and the imaginary part of
 * every harmonic.
 *
 * A field file (HDF5): /node [n] numbers of nodes in the mesh file; /harmonic [m] whole numbers from 0 to 64, each once; and
 * either /force [m, n, 3] N, mesh axes, or /pressure [m, n] Pa, positive into the surface of group load, complex or real. Pressure
 * between the nodes follows the shape functions; every node of the group must have one.
 *   fallback  in  where a force acts that has no place of its own; NULL: none
 * Errors: SHB_ERR_INPUT missing group, nodes, numbers, nothing but zeros; SHB_ERR_IO unreadable file, no memory. */
shb_status modal_load_create(const mesh_fe *mesh, int n, const fem_load *loads,
                             const double *fallback, modal_load *out);

void modal_load_free(modal_load *load); /* also on a zeroed struct */

#endif
