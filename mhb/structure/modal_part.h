/* One modal model as the contact sees it: the part of the receptance without the frequency.
 *
 * At harmonic k, with the shroud axes T0 of each pair (columns v, u, w; eq. 2) and e_k = exp(-j k
 * phi/nu):
 *   B_k[3 a + c][i] = T0^T (right - e_k left)      relative motion of pair a in mode i, kg^-1/2
 *   F_k[i]                                         modal force of the load at scale 1, N kg^-1/2
 * and the residual terms (residual_terms.h). In a run-up the derivative of the model by the
 * frequency is a second modal part. */
#ifndef MHB_STRUCTURE_MODAL_PART_H
#define MHB_STRUCTURE_MODAL_PART_H

#include <complex.h>

#include "mesh/base/arena.h"
#include "mesh/base/status.h"
#include "mhb/structure/relative_motion.h"
#include "mhb/structure/residual_terms.h"

typedef struct {
  const modal_model    *model;
  mhb_relative          relative;
  int                   n, n_modes, n_harmonics, nu; /* n = 3 pairs; harmonics 0..n_harmonics */
  const double complex *phase;                       /* [k] e_k, the caller's */
  double complex       *B;                           /* [k][n][modes] */
  double complex       *F;                           /* [k][modes] */
  double             *split; /* [k][2 (re, im)][n + 1][modes] B, then F: for the loops over modes */
  int                *driven; /* [k] whether the load has this harmonic */
  mhb_residual_terms *residual_terms;
  shb_arena           arena;
} mhb_modal_part;

/* model, relative.T0 and phase[n_harmonics + 1] must outlive it. Load harmonic h drives harmonic nu
 * h. like: as of mhb_residual_terms_create, or NULL. SHB_ERR_IO: no memory. */
shb_status mhb_modal_part_create(const modal_model *model, mhb_relative relative, int nu,
                                 int n_harmonics, const double complex *phase,
                                 const mhb_residual_terms *like, mhb_modal_part **part);
void       mhb_modal_part_destroy(mhb_modal_part *part);

/* Anew from the model, whose arrays have other values. */
void mhb_modal_part_update(mhb_modal_part *part);

/* Real or imaginary part of B_k and F_k: [n + 1][modes]. */
static inline const double *mhb_modal_part_split(const mhb_modal_part *part, int k, int imaginary) {
  return part->split + (size_t)(2 * k + imaginary) * ((size_t)part->n + 1) * (size_t)part->n_modes;
}

/* Force on mode i at harmonic k: load F - B^H p. */
double complex mhb_modal_part_force(const mhb_modal_part *part, int k, const double complex *p,
                                    int i, double load);

#endif
