#include "tests/hard/floquet.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/balance/balance.h"
#include "tests/hard/verdict.h"
#include "tests/support/periodic.h"

static floquet summary(const mhb_multipliers *m) {
  return (floquet){m->verdict, m->crossing, m->n_unstable, m->largest};
}

void floquet_branch(const modal_model *model, const mhb_settings *s, const mhb_response *r,
                    const mhb_branch *branch, int substeps, floquet *out) {
  mhb_balance    *b;
  mhb_floquet    *stability;
  mhb_multipliers m;
  assert_int_equal(mhb_balance_create(model, s, &b), SHB_OK);
  assert_int_equal(mhb_floquet_create(b->receptance, s, substeps, 0, &stability), SHB_OK);
  double x[b->n], unused[b->n];
  for (int i = 0; i < branch->n_points; i++) {
    double omega = SHB_TWO_PI * branch->frequency[i];
    mhb_balance_set_preload(b, branch->n0[i]);
    point_of(r, branch, i, 0, x);
    mhb_balance_evaluate(b, x, omega, unused, NULL, NULL);
    mhb_solution solution = {omega, b->law, b->eval->info, x, b->eval->p, b->m};
    mhb_floquet_evaluate(stability, &solution, &m);
    out[i] = summary(&m);
  }
  mhb_floquet_destroy(stability);
  mhb_balance_destroy(b);
}

double floquet_crossing(const modal_model *model, const mhb_settings *s, const mhb_response *r,
                        const mhb_branch *branch, int i, int substeps) {
  double         lo = 0, hi = 1, ends[2], omega = 0;
  double         x[3 * r->n_pairs * (2 * r->n_harmonics + 1)];
  double complex mu[64];
  double from = SHB_TWO_PI * branch->frequency[i], to = SHB_TWO_PI * branch->frequency[i + 1];
  for (int k = -2; k < 30; k++) {
    double   at = k == -2 ? 0 : k == -1 ? 1 : .5 * (lo + hi);
    periodic p;
    omega = (1 - at) * from + at * to;
    point_of(r, branch, i, at, x);
    periodic_create(model, s, omega, x, &p);
    double beyond = periodic_multipliers(&p, substeps, mu).largest - 1;
    periodic_destroy(&p);
    if (k < 0) {
      ends[k + 2] = beyond;
    } else if ((beyond > 0) == (ends[0] > 0)) {
      lo = at;
    } else {
      hi = at;
    }
  }
  return omega;
}
