/* Shapes and residual columns of a sector at all nodes: against dense solutions. */
#include "modal/cyclic/wave_fields.h"

#include "fem/body/stress.h"
#include "modal/common/session.h"
#include "tests/support/fem.h"
#include "tests/support/small_wave.h"

enum { MODES = 4, DIAMETER = 1 };

typedef struct {
  small_sector  sector;
  dense_wave    dense;
  wave_operator op;
  wave_modes    modes;
} scene;

static int set_up(void **state) {
  static scene        s;
  const wave_settings wanted = {.modes = MODES};
  small_sector_create(&s.sector);
  dense_wave_create(&s.sector, DIAMETER, &s.dense);
  assert_ok(wave_operator_create(&s.sector.sector, s.sector.order, DIAMETER, SMALL_BLADES, &s.op));
  assert_ok(wave_modes_solve(&s.op, &wanted, &s.sector.body, NULL, &s.modes));
  *state = &s;
  return 0;
}

static int tear_down(void **state) {
  scene *s = *state;
  wave_modes_free(&s->modes);
  wave_operator_free(&s->op);
  dense_wave_free(&s->dense);
  small_sector_free(&s->sector);
  return 0;
}

/* C X of count columns. */
static double complex *expand(const dense_wave *w, int count, const double complex *X) {
  double complex *nodal = calloc((size_t)(w->nodal * count), sizeof *nodal);
  for (int c = 0; c < count; c++)
    for (int j = 0; j < w->n; j++)
      for (int i = 0; i < w->nodal; i++)
        nodal[c * w->nodal + i] += w->C[(size_t)j * (size_t)w->nodal + (size_t)i] * X[c * w->n + j];
  return nodal;
}

/* Stresses [count][n_nodes][6] of motions against those of each motion by itself. */
static void check_stress(const scene *s, int count, const double complex *motion,
                         const float complex *stress) {
  const size_t   each = 2 * (size_t)s->dense.nodal;
  float complex *own  = malloc(each * sizeof *own);
  for (int c = 0; c < count; c++) {
    double most = 0;
    fem_nodal_stress_wave(&s->sector.body, NULL, s->dense.phase, 1, motion + c * s->dense.nodal,
                          own);
    for (size_t i = 0; i < each; i++) most = fmax(most, cabs(own[i]));
    for (size_t i = 0; i < each; i++)
      assert_small(cabs(own[i] - stress[(size_t)c * each + i]), 1e-5 * most);
  }
  free(own);
}

static void shapes_and_their_stresses(void **state) {
  const scene       *s = *state;
  modal_condensation to;
  wave_fields        f;
  small_condensation(&s->sector, 1, &to);
  wave_fields_create((wave_operator *)&s->op, &s->modes, &to, &s->sector.body, NULL, false, &f);
  assert_int_equal(f.n_modes, MODES);
  assert_int_equal(f.n_columns, 0);
  assert_null(f.residual);
  assert_null(f.residual_stress);
  double complex *shape = expand(&s->dense, MODES, s->modes.phi);
  assert_below(complex_difference((size_t)(MODES * s->dense.nodal), f.shape, shape), 1e-13);
  check_stress(s, MODES, shape, f.stress);
  free(shape);
  wave_fields_free(&f);
  small_condensation_free(&to);
}

/* 38 columns are three batches: contact dofs, then load patterns. */
static void residual_columns_and_their_stresses(void **state) {
  const scene       *s = *state;
  modal_condensation to;
  wave_fields        f;
  small_condensation(&s->sector, 6, &to);
  wave_fields_create((wave_operator *)&s->op, &s->modes, &to, &s->sector.body, NULL, true, &f);
  const int    n    = to.contact.n + to.load.dofs.n;
  const size_t size = (size_t)(n * s->dense.nodal);
  assert_int_equal(n, 38);
  assert_int_equal(f.n_columns, n);
  double complex *contact = dense_wave_columns(&s->dense, &to.contact);
  double complex *load    = dense_wave_columns(&s->dense, &to.load.dofs);
  double complex *X       = malloc((size_t)(n * s->dense.n) * sizeof *X);
  memcpy(X, contact, (size_t)(to.contact.n * s->dense.n) * sizeof *X);
  memcpy(X + to.contact.n * s->dense.n, load, (size_t)(to.load.dofs.n * s->dense.n) * sizeof *X);
  dense_wave_solve(&s->dense, n, X);
  dense_wave_project_out(&s->dense, MODES, n, X);
  double complex *motion = expand(&s->dense, n, X), *given = malloc(size * sizeof *given);
  for (size_t i = 0; i < size; i++) given[i] = f.residual[i];
  const double off = complex_difference(size, given, motion);
  print_message("%d columns off by %.1e, stored in single precision\n", n, off);
  assert_below(off, 1e-7);
  check_stress(s, n, motion, f.residual_stress);
  free(contact);
  free(load);
  free(X);
  free(motion);
  free(given);
  wave_fields_free(&f);
  small_condensation_free(&to);
}

static void nothing_is_freed_twice(void **state) {
  (void)state;
  wave_fields f = {0};
  wave_fields_free(&f);
  wave_fields_free(&f);
  assert_null(f.shape);
}

int main(int argc, char **argv) {
  modal_session           session;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shapes_and_their_stresses),
      cmocka_unit_test(residual_columns_and_their_stresses),
      cmocka_unit_test(nothing_is_freed_twice),
  };
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failed = cmocka_run_group_tests(tests, set_up, tear_down);
  modal_session_end(&session, SHB_OK);
  return failed;
}
