/* The fast modes of a blade and its residual flexibility as few modes.
 *
 * The contact sees the modes from one on, and residual terms, as R + w^2 R2 + O(w^4). With
 *   R = Q Q^T,  Q^-1 R2 Q^-T = U diag(1/w_i^2) U^T
 * modes of frequency w_i and shape w_i Q u_i have the same R and R2 (MacNeal 1971, Rubin 1975). The
 * output of mode i is w_i G Q^-T u_i. G is its static response to contact forces by what is merged.
 * They are at most as many as contact dofs. */
#ifndef MHB_RING_MERGED_MODES_H
#define MHB_RING_MERGED_MODES_H

#include "mhb/structure/receptance.h"

typedef struct {
  int       n;
  double   *w;     /* [n] rad/s; INFINITY: flexibility without inertia */
  double   *shape; /* [n][side][3 pairs], divided by w, m/N^1/2; left: negative, 0 to ground */
  double   *out;   /* [n][3] of the probe, divided by w */
  shb_arena arena;
} mhb_merged_modes;

/* Merge the modes from first on. probe: index, or -1.
 * Errors: SHB_ERR_INPUT no eigenvalues. */
shb_status mhb_merged_modes_create(const mhb_receptance *receptance, const mhb_settings *settings,
                                   int first, int probe, mhb_merged_modes *merged);
void       mhb_merged_modes_destroy(mhb_merged_modes *merged);

#endif
