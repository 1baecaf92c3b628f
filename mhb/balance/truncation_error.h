/* Truncation error of a solution with m harmonics, from its harmonics m+1..2m.
 *
 * The solution u is put into the balance with 2m harmonics, whose residual r does not vanish there.
 * One Newton step, delta = -(I + R J)^-1 r, estimates the error at this frequency. u + delta is a
 * good start with more harmonics. |r| alone (first order) leaves out the feedback into the low
 * harmonics and is up to fifteen times too small.
 *
 * A harmonic above 2m may be at a resonance. Those harmonics are estimated one by one
 * (higher_harmonics.h). Where they are not small, r is evaluated anew with them before the step.
 *
 * The tail of the spectrum (tail.h) adds what the harmonics looked at leave out. It also tells how
 * slowly the error falls with m: delta is the difference of two errors, of m and of 2m harmonics.
 * The part of delta up to m is divided by 1 - rho, rho the ratio of these errors.
 *
 * Two cases save the factors with 2m harmonics. With many pairs or harmonics Broyden's method finds
 * the step (truncation_step.h). In a ring of different blades GMRES does (doubled_ring.h). There
 * harmonics above 2m are not looked at. */
#ifndef MHB_BALANCE_TRUNCATION_ERROR_H
#define MHB_BALANCE_TRUNCATION_ERROR_H

#include <stdbool.h>

#include "mesh/base/arena.h"
#include "mhb/balance/condensation.h"
#include "mhb/balance/doubled_ring.h"
#include "mhb/balance/higher_harmonics.h"
#include "mhb/balance/truncation_step.h"

/* With more nonlinear unknowns of the doubled balance than this, 3 (4m+1) a nonlinear pair, few
 * pairs are estimated to first order. Many pairs (MHB_MANY_PAIRS) have no limit. */
enum { MHB_MOST_DOUBLED = 3000 };

/* Bounds of the highest harmonic that is estimated, 4m between them. */
enum { MHB_LEAST_LOOKED_AT = 12, MHB_MOST_LOOKED_AT = 64 };

/* Kind of an estimate. */
typedef enum {
  MHB_TRUNCATION_NONE, /* all pairs are linear: the error is 0 */
  MHB_TRUNCATION_FIRST_ORDER,
  MHB_TRUNCATION_NEWTON, /* to the solution with 2m harmonics */
  MHB_TRUNCATION_ACROSS  /* to their curve, of a point: mhb_truncation_across */
} mhb_truncation_kind;

typedef struct {
  const mhb_balance     *balance; /* with m harmonics */
  mhb_settings           settings;
  mhb_receptance        *receptance; /* all harmonics that are estimated */
  mhb_balance           *doubled;    /* with 2m harmonics */
  mhb_condensation      *system;     /* of the doubled balance */
  mhb_higher_harmonics  *higher;     /* above 2m; NULL of a ring */
  mhb_truncation_step   *broyden;    /* of many pairs; else NULL */
  mhb_doubled_ring      *ring;       /* of a ring; else NULL */
  mhb_contact_evaluator *contact;    /* of many pairs: motions of m harmonics, forces of all */
  double                *force;      /* [3][2 highest + 1] of it */
  mhb_ring_system       *factors;    /* of a ring, near its point; the caller's, or NULL */
  double                *x;          /* [doubled->n] the solution, zero above m */
  double                *step;       /* [doubled->n] delta, -r or 0 of the last estimate */
  double                *r, *trial, *feedback; /* [doubled->n] */
  double                *before;               /* [doubled->n] residual at x */
  double                *power;       /* [2m + 1] of harmonics of solution and estimate, m^2 */
  int                    n_times;     /* of a period */
  double                *basis;       /* [n_times][doubled->nb] */
  double                *motion;      /* [3 pairs][n_times] */
  double                 higher_size; /* |u_k|, k > 2m, of the last estimate */
  double                 largest; /* largest |e(t)| over all axes, of the last estimate, relative */
  double                 order;   /* p of the tail |u_k| ~ k^-p seen there */
  double remaining;         /* rho of the last estimate: error of 2m harmonics over that of m */
  mhb_truncation_kind kind; /* of the last estimate */
  bool                by_broyden; /* its step; the system is not factored there */
  bool                by_gmres;   /* its step, from the ring; nor here */
  shb_arena           arena;
} mhb_truncation;

/* Highest harmonic that the estimate for m harmonics looks at. */
int mhb_truncation_highest(int m);

/* The balance must outlive it. Errors: as mhb_balance_create. */
shb_status mhb_truncation_create(const mhb_balance *balance, mhb_truncation **truncation);
void       mhb_truncation_destroy(mhb_truncation *truncation);

/* Estimated error of the solution x[n], the point of the balance's evaluation in use. It is the
 * root-mean-square error in a period over that of the vibration. `largest` is the largest error
 * within the period, relative to the same amplitude. Of first order also where the
 * Newton step does not exist (at a fold). */
double mhb_truncation_error(mhb_truncation *truncation, const double *x);

/* change[doubled->n] <- (I + R J)^-1 change at the point of the last estimate. false: it failed. By
 * Broyden's step and by GMRES: harmonics up to m as with m harmonics, the others stay. In a ring
 * the factors must be those of the estimate. */
bool mhb_truncation_solve(mhb_truncation *truncation, double *change);

/* The solutions that follow are by Newton's linearisation with 2m harmonics, where the last
 * estimate was Broyden's. false: they were, or it failed. */
bool mhb_truncation_linearise(mhb_truncation *truncation);

/* Distance across the curve to that of 2m harmonics, relative to the vibration. Beside a fold the
 * solution at the same value may be far off, or not exist, while the curve passes near by. The last
 * estimate must be of the point, the balance's evaluation in use.
 * `largest` becomes that of the distance; step and order stay those of the estimate.
 *   value    of the balance's parameter
 *   shift    out: relative change of the value
 * INFINITY: not known (many pairs, a ring). */
double mhb_truncation_across(mhb_truncation *truncation, double value, double *shift);

/* Correct a solution x[n] by the harmonics left out, to first order, at the same value. Where that
 * is farther than a tenth of the vibration, as beside a fold, the nearest point of their curve is
 * taken. `x` of the truncation becomes the corrected solution, at which the doubled balance is
 * evaluated. `remaining` is the part of the error left.
 *   value    of the balance's parameter; the balance is linearised there
 * false: not known, or farther than that. */
bool mhb_truncation_correct(mhb_truncation *truncation, const double *x, double value);

/* How much of a change of the solution, step[doubled->n], is left by the curvature of the residual:
 * 1 for a small one. A linearised change is far too long near a fold. The last estimate must be of
 * the present solution, and the step by mhb_truncation_solve, not by Broyden's. */
double mhb_truncation_part(mhb_truncation *truncation, const double *step);

/* Sum of squares of harmonic k > 0 of the last estimate, m^2. */
double mhb_truncation_power(const mhb_truncation *truncation, int k);

#endif
