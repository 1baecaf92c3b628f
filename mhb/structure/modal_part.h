/* One modal model as the contact sees it: the part of the receptance without the frequency.
 *
 * At harmonic k, with the shroud axes T0 of each pair (columns v, u, w; eq. 2) and e_k = exp(-j k
 * phi/nu):
 *   B_k[3 a + c][i] = T0^T (right - e_k left)      relative motion of pair a in mode i, kg^-1/2
 *   F_k[i]                                         modal force of the load at scale 1, N kg^-1/2
 *   G_k[i][j]                                      Coriolis matrix, 1/s, if the model has one
 * and the residual terms (residual_terms.h). In a run-up the derivative of the model by the
 * frequency is a second modal part. */
#ifndef MHB_STRUCTURE_MODAL_PART_H
#define MHB_STRUCTURE_MODAL_PART_H

#include <complex.h>

#include "mesh/base/arena.h"
#include "mesh/base/status.h"
#include "mhb/structure/gyroscopic.h"
#include "mhb/structure/relative_motion.h"
#include "mhb/structure/residual_terms.h"

typedef struct {
  const modal_model    *model; /* of all harmonics, or of the mean */
  modal_wave           *wave;  /* [k] model of each harmonic */
  mhb_relative          relative;
  int                   n, n_modes, n_harmonics, nu; /* n = 3 pairs; harmonics 0..n_harmonics */
  const double complex *phase;                       /* [k] e_k, the caller's */
  double complex       *B;                           /* [k][n][modes] */
  double complex       *F;                           /* [k][modes] */
  double complex       *G; /* [k][modes][modes]; NULL: without Coriolis terms, as the next */
  mhb_gyroscopic       *gyroscopic; /* [k] the modes that G couples, once they are asked for */
  double             *split; /* [k][2 (re, im)][n + 1][modes] B, then F: for the loops over modes */
  int                *driven; /* [k] whether the load has this harmonic */
  mhb_residual_terms *residual_terms;
  shb_arena           arena;
} mhb_modal_part;

/* model, relative.T0 and the arrays of harmonics must outlive it. harmonics->wave NULL: all have
 * the model. Errors: as mhb_residual_terms_create. */
shb_status mhb_modal_part_create(const modal_model *model, mhb_relative relative,
                                 const mhb_harmonics *harmonics, mhb_modal_part **part);
void       mhb_modal_part_destroy(mhb_modal_part *part);

/* Anew from the model, whose arrays have other values. */
void mhb_modal_part_update(mhb_modal_part *part);

/* The modes that G couples at harmonic k; NULL: not found. Not for two threads at once. */
const mhb_gyroscopic *mhb_modal_part_gyroscopic(mhb_modal_part *part, int k);

/* Real or imaginary part of B_k and F_k: [n + 1][modes]. */
static inline const double *mhb_modal_part_split(const mhb_modal_part *part, int k, int imaginary) {
  return part->split + (size_t)(2 * k + imaginary) * ((size_t)part->n + 1) * (size_t)part->n_modes;
}

/* Motion of probe dof row [3 q] in mode i at harmonic k times a. */
static inline double complex mhb_modal_part_probe(const mhb_modal_part *part, int k, int row, int i,
                                                  double complex a) {
  const modal_wave *wave = &part->wave[k];
  const size_t      at   = (size_t)row * (size_t)part->n_modes + (size_t)i;
  if (!wave->imaginary) return wave->model->probe[at] * a;
  return modal_wave_value(wave, wave->model->probe, wave->imaginary->probe, at) * a;
}

/* Force on mode i at harmonic k: load F - B^H p. */
double complex mhb_modal_part_force(const mhb_modal_part *part, int k, const double complex *p,
                                    int i, double load);

#endif
