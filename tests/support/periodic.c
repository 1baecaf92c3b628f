#include "tests/support/periodic.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mhb/continuation/first_solution.h"

void periodic_create(const modal_model *model, const mhb_settings *settings, double omega,
                     const double *guess, periodic *p) {
  mhb_newton *newton;
  int         iterations;
  *p = (periodic){.settings = *settings, .omega = omega};
  assert_int_equal(mhb_balance_create(model, &p->settings, &p->residual), SHB_OK);
  mhb_balance *b = p->residual;
  newton         = mhb_newton_create(b->n);
  mhb_balance_set_preload(b, settings->n0[0]);
  p->x = calloc((size_t)b->n, sizeof(double));
  if (guess) {
    memcpy(p->x, guess, sizeof(double) * (size_t)b->n);
    assert_int_equal(mhb_newton_solve(newton, b, omega, 1e-10, p->x, &iterations), MHB_CONVERGED);
  } else {
    assert_int_equal(mhb_first_solution(newton, b, omega, 1e-10, p->x, &iterations), MHB_CONVERGED);
  }
  mhb_balance_evaluate(b, p->x, omega, newton->r, NULL, NULL);
  mhb_newton_destroy(newton);
  p->solution = (mhb_solution){omega, b->law, b->eval->info, p->x, b->eval->p, b->m};
}

void periodic_destroy(periodic *p) {
  mhb_balance_destroy(p->residual);
  free(p->x);
}

mhb_multipliers periodic_multipliers(const periodic *p, int substeps, double complex *copy) {
  mhb_floquet    *stability;
  mhb_multipliers out;
  assert_int_equal(
      mhb_floquet_create(p->residual->receptance, &p->settings, substeps, 0, &stability), SHB_OK);
  mhb_floquet_evaluate(stability, &p->solution, &out);
  for (int i = 0; i < out.n; i++) copy[i] = out.multiplier[i];
  out.multiplier = copy;
  mhb_floquet_destroy(stability);
  return out;
}

double distance_to(const double complex *wanted, int n_wanted, const double complex *there,
                   int n_there) {
  int    taken[n_there + 1];
  double worst = 0;
  memset(taken, 0, sizeof taken);
  for (int i = 0; i < n_wanted; i++) {
    int best = -1;
    for (int j = 0; j < n_there; j++)
      if (!taken[j] && (best < 0 || cabs(there[j] - wanted[i]) < cabs(there[best] - wanted[i])))
        best = j;
    if (best < 0) return INFINITY;
    taken[best] = 1;
    worst       = fmax(worst, cabs(there[best] - wanted[i]));
  }
  return worst;
}
