#include "tests/support/solution.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "mhb/branches/main_branch.h"
#include "mhb/continuation/first_solution.h"

void cold_solution(const modal_model *model, const mhb_settings *settings, double omega,
                   double tolerance, double *x) {
  mhb_balance *residual;
  mhb_newton  *newton;
  int          iterations;
  assert_int_equal(mhb_balance_create(model, settings, &residual), SHB_OK);
  newton = mhb_newton_create(residual->n);
  mhb_balance_set_preload(residual, settings->n0[0]);
  assert_int_equal(mhb_first_solution(newton, residual, omega, tolerance, x, &iterations),
                   MHB_CONVERGED);
  mhb_newton_destroy(newton);
  mhb_balance_destroy(residual);
}
