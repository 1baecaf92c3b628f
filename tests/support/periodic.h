/* A periodic solution with everything that its stability needs. */
#ifndef TESTS_SUPPORT_PERIODIC_H
#define TESTS_SUPPORT_PERIODIC_H

#include "mhb/balance/balance.h"
#include "mhb/floquet/floquet.h"
#include "tests/support/settings.h"

typedef struct {
  mhb_settings settings;
  mhb_balance *residual; /* evaluated at the solution */
  double      *x;
  double       omega; /* rad/s */
  mhb_solution solution;
} periodic;

/* Solve from a guess, or from a cold start if it is NULL. Fails the test if there is no
 * solution. */
void periodic_create(const modal_model *model, const mhb_settings *settings, double omega,
                     const double *guess, periodic *p);
void periodic_destroy(periodic *p);

/* Multipliers with N sub-steps into copy[n]. Returns the summary, whose multipliers are in copy. */
mhb_multipliers periodic_multipliers(const periodic *p, int substeps, double complex *copy);

/* Largest distance of a wanted multiplier from the nearest computed one; each serves once. */
double distance_to(const double complex *wanted, int n_wanted, const double complex *there,
                   int n_there);

#endif
