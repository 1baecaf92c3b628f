/* Tracks of modes over the rotor speeds: which mode of one speed continues which of the one
 * before. */
#ifndef MODAL_STAGE_TRACKS_H
#define MODAL_STAGE_TRACKS_H

#include "mesh/base/status.h"
#include "modal/cyclic/wave_modes.h"
#include "modal/model/sector_speeds.h"

/* Continue the tracks of speeds to speed s. Matched are the largest moduli first, each mode once.
 *
 *   overlap  in  [m][m] |phi_i^H M psi_j|, i of the speed before; NULL at the first speed
 *   next     out [m] mode that continues mode i of the speed before; NULL at the first speed */
void modal_tracks_continue(const double *overlap, int s, int *next, modal_speeds *speeds);

/* Those of a sector with a disc, by nodal diameter from the second on. */
typedef struct {
  modal_sector_speeds *speeds; /* the caller's */
  int                  s;      /* speed that is being solved, from 0 */
  bool                 main;   /* it is the one whose fields are wanted */
  double complex     **first;  /* [nodal diameter] shapes of the first speed, [m][order] */
  double complex     **before; /* those of the speed before */
} modal_sector_tracks;

/* Allocate those of all nodal diameters of the models, with m modes at each of n speeds.
 * modal_sector_tracks_free must be called in any case. */
void modal_sector_tracks_create(const modal_nodal_diameters *models, int n, const double *speed,
                                int m, modal_sector_speeds *speeds, modal_sector_tracks *tracks);
void modal_sector_tracks_free(modal_sector_tracks *tracks); /* the speeds are kept */

/* Continue the tracks of nodal diameter i (an index) to its modes, and take over their shapes.
 * Threads may do so at once for different i. */
void modal_sector_tracks_take(modal_sector_tracks *tracks, int i, wave_modes *modes);

#endif
