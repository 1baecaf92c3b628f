/* What a solution of m harmonics leaves out: the harmonics m+1..2m.
 *
 * The solution u of m harmonics is put into the balance of 2m, where its residual r no longer vanishes. One Newton step
 * there, delta = -(I + R J)^-1 r, is the estimate of the error at this frequency, and u + delta a good start for more
 * harmonics. |r| alone (first order) leaves out the feedback into the low harmonics and is up to fifteen times too small.
 *
 * A harmonic beyond 2m can meet a resonance. Those are estimated one by one, u_k = -(I + R_k D)^-1 r_k, with D the stiffness
 * of the contact at harmonic 2m; where they are not small, r is evaluated anew with them before the Newton step. */
#ifndef MHB_BALANCE_TRUNCATION_ERROR_H
#define MHB_BALANCE_TRUNCATION_ERROR_H

#include "mhb/balance/condensation.h"
#include "mhb/balance/higher_harmonics.h"

/* Beyond this many moving unknowns of the doubled balance (3 (4m+1) a pair that moves) the estimate is of first order. */
enum { MHB_MOST_DOUBLED = 3000 };

/* Harmonics looked at: four times those of the solution, within these. */
enum { MHB_LEAST_LOOKED_AT = 12, MHB_MOST_LOOKED_AT = 64 };

/* How an estimate was made. */
typedef enum {
  MHB_TRUNCATION_NONE, /* nothing is left out: open or stuck throughout, all pairs */
  MHB_TRUNCATION_FIRST_ORDER,
  MHB_TRUNCATION_NEWTON
} mhb_truncation_kind;

typedef struct {
  const mhb_balance    *narrow;
  mhb_settings          settings;
  mhb_receptance       *receptance; /* all harmonics looked at */
  mhb_balance          *doubled;    /* harmonics 0..2m */
  mhb_condensation     *system;     /* of the doubled balance */
  mhb_higher_harmonics *beyond;
  double               *x,
      *step; /* [doubled->n] the solution, zero beyond m; delta of the last estimate, or -r, or zero */
  double             *residual, *trial, *change; /* [doubled->n] */
  double              far;                       /* |u_k|, k > 2m, of the last estimate */
  mhb_truncation_kind kind;                      /* of the last estimate */
} mhb_truncation;

/* The residual must outlive it. Errors: as mhb_balance_create. */
shb_status mhb_truncation_create(const mhb_balance *residual, mhb_truncation **truncation);
void       mhb_truncation_destroy(mhb_truncation *truncation);

/* Estimated error of the solution x[n] that the residual was just evaluated at, from the harmonics left
 * out, relative to |x|. First order also where the Newton step does not exist (a fold). */
double mhb_truncation_error(mhb_truncation *truncation, const double *x);

/* Sum of squares of harmonic k > 0 of the last estimate. */
double mhb_truncation_power(const mhb_truncation *truncation, int k);

#endif
