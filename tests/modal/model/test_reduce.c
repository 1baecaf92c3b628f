/* Fewer modes: exact statics, and an error of fourth order in the frequency. */
#include "modal/model/reduce.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "mhb/structure/receptance.h"
#include "tests/support/random_model.h"

enum {
  PAIRS          = 2,
  ROWS           = 3 * PAIRS,
  PARTS          = WITH_LEFT | WITH_RESIDUAL,
  UNDAMPED       = 16,
  NO_FOURTH      = 32,
  PARTS_OF_MODEL = 15 | WITH_RESIDUAL_MODES
};

static mhb_receptance *receptance_of(const modal_model *model, const mhb_settings *s,
                                     double omega) {
  mhb_receptance *r;
  if (mhb_receptance_create(model, s, 2, &r) != SHB_OK) fail_msg("%s", shb_message());
  mhb_receptance_at(r, omega, 2);
  return r;
}

static double difference(int n, const double complex *a, const double complex *b) {
  double most = 0, size = 0;
  for (int i = 0; i < n; i++) {
    most = fmax(most, cabs(a[i] - b[i]));
    size = fmax(size, cabs(a[i]));
  }
  return most / size;
}

static void undamp(modal_model *model) {
  for (int i = 0; i < model->n_modes; i++) model->damping_ratio[i] = 0;
}

static void drop_fourth(modal_model *model) {
  free(model->residual_fourth);
  model->residual_fourth = NULL;
}

/* Errors at harmonic 1 of R, of the free response and of the probes, against the model with all
 * modes. */
static void errors_at(int parts, int modes, bool residuals, double omega, double error[3]) {
  modal_model  all, few;
  mhb_settings s = random_settings(2);
  random_model(PAIRS, parts & PARTS_OF_MODEL, 71, &all);
  random_model(PAIRS, parts & PARTS_OF_MODEL, 71, &few);
  if (parts & UNDAMPED) {
    undamp(&all);
    undamp(&few);
  }
  if (parts & NO_FOURTH) {
    drop_fourth(&all);
    drop_fourth(&few);
  }
  if (modal_model_reduce(&few, modes, residuals) != SHB_OK) fail_msg("%s", shb_message());
  assert_int_equal(few.n_modes, modes);
  mhb_receptance *a = receptance_of(&all, &s, omega), *b = receptance_of(&few, &s, omega);
  double complex  p[ROWS], q[2][6];
  for (int i = 0; i < ROWS; i++) p[i] = 0.3 + 0.1 * i - 0.07 * I * i * i;
  mhb_receptance_probe(a, 1, p, q[0]);
  mhb_receptance_probe(b, 1, p, q[1]);
  error[0] = difference(ROWS * ROWS, a->R + ROWS * ROWS, b->R + ROWS * ROWS);
  error[1] = difference(ROWS, a->free + ROWS, b->free + ROWS);
  error[2] = difference(6, q[0], q[1]);
  mhb_receptance_destroy(a);
  mhb_receptance_destroy(b);
  modal_model_free(&all);
  modal_model_free(&few);
}

/* Without damping the modes left out stay exact, in files with residual terms and modes and in
 * files without either. With residual terms only, R errs with omega^6, since its series is bounded.
 * In files of earlier versions, without the term of omega^4, all errors are of order omega^4. */
static void errors_have_their_order(void **state) {
  (void)state;
  const int parts[]     = {PARTS | WITH_RESIDUAL_MODES | UNDAMPED, WITH_LEFT | UNDAMPED,
                           PARTS | UNDAMPED, PARTS | UNDAMPED | NO_FOURTH};
  const int order[4][3] = {{0, 0, 0}, {0, 0, 0}, {6, 0, 0}, {4, 4, 4}}; /* 0: exact */
  for (int i = 0; i < 4; i++) {
    double at[3], half[3];
    errors_at(parts[i], 3, true, 0.16, at);
    errors_at(parts[i], 3, true, 0.08, half);
    for (int k = 0; k < 3; k++) {
      print_message("error %.2e, %.2e at half the frequency: order %.3f\n", at[k], half[k],
                    log2(at[k] / half[k]));
      assert_true(order[i][k] ? fabs(log2(at[k] / half[k]) - order[i][k]) < 0.05 : at[k] < 1e-13);
    }
  }
}

/* The modes left out are damped, their residual terms are not: the error is 2 zeta omega/omega_i,
 * for damping of 0.01 to 0.03. */
static void statics_stay(void **state) {
  (void)state;
  const int parts[] = {PARTS, WITH_LEFT};
  for (int i = 0; i < 2; i++) {
    double at[3], half[3], none[3];
    errors_at(parts[i], 3, true, 1e-4, at);
    errors_at(parts[i], 3, true, 0.5e-4, half);
    errors_at(parts[i], 3, false, 1e-4, none);
    for (int k = 0; k < 3; k++) {
      assert_true(at[k] < 1e-5);
      assert_true(fabs(log2(at[k] / half[k]) - 1) < 0.05);
      assert_true(none[k] > 1e-2);
    }
  }
}

static void all_modes_change_nothing(void **state) {
  (void)state;
  double error[3];
  errors_at(PARTS, 6, true, 0.7, error);
  for (int k = 0; k < 3; k++) assert_true(error[k] == 0);
}

/* Without residual parts, all modes kept: the result of a file without them. */
static void bare(void **state) {
  (void)state;
  modal_model  with, without;
  mhb_settings s = random_settings(2);
  random_model(PAIRS, PARTS, 71, &with);
  assert_int_equal(modal_model_reduce(&with, 6, false), SHB_OK);
  assert_null(with.residual_flexibility);
  assert_true(!with.residual_fourth && !with.load_inertia && !with.probe_load_residual &&
              !with.probe_load_inertia);
  random_model(PAIRS, PARTS, 71, &without);
  void *part[] = {
      without.residual_flexibility,   without.residual_inertia,      without.residual_fourth,
      without.probe_contact_residual, without.probe_contact_inertia, without.load_residual,
      without.load_inertia,           without.probe_load_residual,   without.probe_load_inertia};
  for (int i = 0; i < 9; i++) free(part[i]);
  without.residual_flexibility = without.residual_inertia = without.residual_fourth = NULL;
  without.probe_contact_residual = without.probe_contact_inertia = NULL;
  without.load_residual = without.load_inertia = NULL;
  without.probe_load_residual = without.probe_load_inertia = NULL;
  mhb_receptance *a = receptance_of(&with, &s, 0.9), *b = receptance_of(&without, &s, 0.9);
  assert_true(difference(3 * ROWS * ROWS, a->R, b->R) == 0);
  mhb_receptance_destroy(a);
  mhb_receptance_destroy(b);
  modal_model_free(&with);
  modal_model_free(&without);
}

static void wrong_numbers(void **state) {
  (void)state;
  modal_model model;
  random_model(1, PARTS, 5, &model);
  assert_int_equal(modal_model_reduce(&model, 0, true), SHB_ERR_INPUT);
  assert_int_equal(modal_model_reduce(&model, 7, true), SHB_ERR_INPUT);
  assert_string_equal(shb_message(), "7 modes are to be kept; there are 1 to 6");
  assert_int_equal(model.n_modes, 6);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(statics_stay),
                                     cmocka_unit_test(errors_have_their_order),
                                     cmocka_unit_test(all_modes_change_nothing),
                                     cmocka_unit_test(bare), cmocka_unit_test(wrong_numbers)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
