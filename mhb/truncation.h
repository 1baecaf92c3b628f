/* What a solution of m harmonics leaves out: the harmonics m+1..2m, and modes.
 *
 * The solution u of m harmonics is put into the balance of 2m. There its residual r no longer vanishes; the motion that
 * the forces m+1..2m cause, |r|/|u|, is the first-order estimate: their feedback into the low harmonics is left out. */
#ifndef MHB_TRUNCATION_H
#define MHB_TRUNCATION_H

#include "mhb/residual.h"

typedef struct {
  const mhb_residual *narrow;
  mhb_settings        settings; /* of the doubled balance */
  mhb_residual       *doubled;  /* harmonics 0..2m */
  double             *x, *r;    /* [doubled->n] */
} mhb_truncation;

/* Not thread safe (FFTW's planner). The residual must outlive it. Errors: as mhb_residual_create. */
shb_status mhb_truncation_create(const mhb_residual *residual, mhb_truncation **truncation);
void       mhb_truncation_destroy(mhb_truncation *truncation);

/* Estimated error of the solution x[n] at omega (rad/s) from the harmonics left out, relative to |x|. */
double mhb_truncation_error(mhb_truncation *truncation, const double *x, double omega);

/* Estimated error from the modes left out of the solution that the residual was just evaluated at, relative to |x|: the
 * next term of the residual series; -1 if the file holds no residual flexibility. */
double mhb_modal_error(const mhb_residual *residual, const double *x);

#endif
