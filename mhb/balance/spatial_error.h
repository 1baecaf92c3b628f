/* Error of a solution by the number of contact pairs, from another model of the same faces.
 *
 * Finer model: its pairs are joined to those of the balance (modal/model/joined_pairs.h). The
 * forces p of the balance are spread by area; the motion that follows, u = free - R p, is put into
 * the balance of the finer model. One Newton step, delta = -(I + R J)^-1 (u - free + R p(u)), is
 * the error of u.
 *
 * Coarser model: the pairs of the balance are joined to half as many. The mean motion of each patch
 * is put into the coarser balance, and delta leads to the solution there. The error falls with the
 * number of pairs n at least as 1/n. So that from n/2 to n is at most the one that is left.
 *
 * Both are relative to the vibration, each pair counting by its area. At a fold they have no bound:
 * they compare motions at the same frequency. */
#ifndef MHB_BALANCE_SPATIAL_ERROR_H
#define MHB_BALANCE_SPATIAL_ERROR_H

#include "mhb/balance/condensation.h"
#include "mhb/problem/other_pairs.h"

typedef struct {
  const mhb_balance     *balance;
  const mhb_other_pairs *pairs;
  mhb_settings           settings;
  mhb_balance           *other;
  mhb_condensation      *system;
  double                *x, *step;       /* [other->n] start; delta of the last estimate */
  double complex        *force, *spread; /* [3 pairs], [3 pairs of the other model] */
  shb_arena              arena;
} mhb_spatial_error;

/* For a balance whose settings name other pairs; it must outlive it. Errors: as
 * mhb_balance_create. */
shb_status mhb_spatial_error_create(const mhb_balance *balance, mhb_spatial_error **error);
void       mhb_spatial_error_destroy(mhb_spatial_error *error);

/* Estimated error of the solution x[n], the point of the balance's evaluation in use. -1: not
 * known, as the step does not exist (at a fold). */
double mhb_spatial_error_at(mhb_spatial_error *error, const double *x);

#endif
