/* Onset of slip: closed forms, derivatives against differences, agreement with the law. */
#include "mhb/contact/slip_onset.h"

#include <math.h>
#include <string.h>

#include "mhb/contact/contact.h"
#include "tests/support/check.h"

enum { M = 3, NB = 2 * M + 1, N = 3 * NB };

static const mhb_law law = {.mu = 0.21, .kv = 0.23, .ku = {0.61, 0.07, 0.44}, .n0 = 1.9};

/* An odd motion of three harmonics in all directions. */
static void fill(double size, double *x) {
  for (int i = 0; i < N; i++) x[i] = size * cos(1.7 * i * i + 0.3) / (1 + i % NB);
}

/* u = a cos t alone: phases 0 and pi, h = ku a - mu n0, and no mean friction is left. */
static void a_motion_along_a_line_has_the_closed_form(void **state) {
  (void)state;
  const mhb_law  line = {.mu = 0.37, .kv = 0.83, .ku = {0.61, 0, 0.44}, .n0 = 1.9};
  double         x[N] = {[NB + 1] = 2.385, [2 * NB] = 5};
  mhb_slip_onset at;
  mhb_slip_onset_find(&line, M, x, &at);
  assert_near(at.h, 0.61 * 2.385 - 0.37 * 1.9, 1e-15);
  assert_near(at.limit, 0.37 * 1.9, 1e-15);
  assert_small(at.c[0], 1e-15);
  assert_small(at.c[1], 1e-15);
  assert_near(fabs(at.time[0] - at.time[1]), 3.14159265358979, 1e-12);
}

static void derivatives_are_those_of_differences(void **state) {
  (void)state;
  double x[N], by_h[N], by_c[2][N], *const rows[2] = {by_c[0], by_c[1]};
  mhb_slip_onset at;
  double         worst_h = 0, worst_c = 0, size_h = 0, size_c = 0;
  fill(0.9, x);
  mhb_slip_onset_find(&law, M, x, &at);
  mhb_slip_onset_gradient(&law, M, x, &at, by_h, rows);
  for (int i = 0; i < N; i++) {
    static const double place[4] = {-2, -1, 1, 2}, weight[4] = {1, -8, 8, -1};
    const double        step = 2e-4, here = x[i];
    double              h = 0, c[2] = {0};
    for (int j = 0; j < 4; j++) {
      mhb_slip_onset moved;
      x[i] = here + place[j] * step;
      mhb_slip_onset_find(&law, M, x, &moved);
      h += weight[j] * moved.h / (12 * step);
      for (int k = 0; k < 2; k++) c[k] += weight[j] * moved.c[k] / (12 * step);
    }
    x[i]    = here;
    worst_h = fmax(worst_h, fabs(h - by_h[i]));
    size_h  = fmax(size_h, fabs(h));
    for (int k = 0; k < 2; k++) worst_c = fmax(worst_c, fabs(c[k] - by_c[k][i]));
    for (int k = 0; k < 2; k++) size_c = fmax(size_c, fabs(c[k]));
  }
  print_message("by h %.1e, by c %.1e\n", worst_h / size_h, worst_c / size_c);
  assert_below(worst_h, 1e-9 * size_h);
  assert_below(worst_c, 1e-9 * size_c);
}

/* The law slips on one side of h = 0 and not on the other. At h = 0 it has the mean friction c. */
static void the_law_begins_to_slip_there(void **state) {
  (void)state;
  double                  low = 0.1, high = 2, x[N], force[N];
  mhb_slip_onset          at;
  mhb_contact_evaluator  *contact;
  static mhb_contact_info info;
  assert_ok(mhb_contact_evaluator_create(M, M, 1e-10, &contact));
  while (high - low > 1e-14) {
    const double middle = 0.5 * (low + high);
    fill(middle, x);
    mhb_slip_onset_find(&law, M, x, &at);
    if (at.h > 0)
      high = middle;
    else
      low = middle;
  }
  fill(low * (1 - 1e-9), x);
  mhb_contact_force(contact, &law, x, force, NULL, &info);
  mhb_slip_onset_find(&law, M, x, &at);
  print_message("mean friction %.9f, %.9f, of the law %.9f, %.9f\n", at.c[0], at.c[1], force[NB],
                force[2 * NB]);
  assert_near(info.share[MHB_STICK], 1, 1e-15);
  assert_true(hypot(at.c[0], at.c[1]) > 0.01);
  for (int k = 0; k < 2; k++) assert_small(force[(k + 1) * NB] - at.c[k], 1e-4);
  fill(low * (1 + 1e-6), x);
  mhb_contact_force(contact, &law, x, force, NULL, &info);
  assert_true(info.share[MHB_SLIDE] > 0);
  mhb_contact_evaluator_destroy(contact);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_motion_along_a_line_has_the_closed_form),
                                     cmocka_unit_test(derivatives_are_those_of_differences),
                                     cmocka_unit_test(the_law_begins_to_slip_there)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
