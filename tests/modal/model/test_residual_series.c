/* Contribution of the modes left out against the modes themselves. */
#include "mesh/base/constants.h"
#include "modal/model/residual_series.h"

#include "tests/support/check.h"

enum { OUT = 3 };

static const double lambda[OUT] = {400, 900, 2500}, phi[OUT] = {0.8, -0.5, 0.3};

/* A model to ground of one kept mode and one contact pair; its residual terms are those of the
 * modes above at dof 0. */
typedef struct {
  modal_model model;
  double      frequency[1], damping[1], right[3];
  double      R[3][9], tail[6], residual_frequency[OUT], shape[3 * OUT];
} scene;

static double moment(int j) {
  double sum = 0;
  for (int i = 0; i < OUT; i++) sum += phi[i] * phi[i] / pow(lambda[i], j);
  return sum;
}

/* residual: residual modes of the model, the first of the modes left out. */
static modal_model *make(scene *s, int residual) {
  *s              = (scene){.frequency = {10 / SHB_TWO_PI}};
  s->model        = (modal_model){.n_modes       = 1,
                                  .n_pairs       = 1,
                                  .frequency     = s->frequency,
                                  .damping_ratio = s->damping,
                                  .right         = s->right,
                                  .contact_tail  = s->tail,
                                  .n_residual    = residual};
  double **term[] = {&s->model.residual_flexibility, &s->model.residual_inertia,
                     &s->model.residual_fourth};
  for (int t = 0; t < 3; t++) {
    s->R[t][0] = moment(t + 1);
    *term[t]   = s->R[t];
  }
  for (int i = 0; i < residual; i++) {
    s->residual_frequency[i] = sqrt(lambda[i]) / SHB_TWO_PI;
    s->shape[i]              = phi[i];
  }
  s->model.residual_frequency = s->residual_frequency;
  s->model.residual_shape     = s->shape;
  s->model.tail_order         = 3; /* of what neither terms nor residual modes hold */
  for (int i = residual; i < OUT; i++)
    for (int j = 0; j < 2; j++) s->tail[j] += phi[i] * phi[i] / pow(lambda[i], 4 + j);
  return &s->model;
}

static double exact(double s) {
  double sum = 0;
  for (int i = 0; i < OUT; i++) sum += phi[i] * phi[i] / (lambda[i] - s);
  return sum;
}

static double series(const modal_model *m, double s) {
  const modal_series taken = modal_series_at(m, sqrt(s));
  double             unused, sum = m->residual_flexibility[0];
  sum += taken.weight[1] * m->residual_inertia[0];
  if (m->residual_fourth) sum += taken.weight[2] * m->residual_fourth[0];
  for (int i = 0; i < m->n_residual; i++) {
    const double psi = m->residual_shape[i];
    sum += psi * psi * modal_series_mode(m, i, &taken, &unused);
  }
  return sum;
}

/* All modes left out as residual modes: exact, up to the limit of s. */
static void residual_modes_are_exact(void **state) {
  (void)state;
  scene s;
  make(&s, OUT);
  for (double x = 1; x < 0.5 * lambda[0]; x *= 1.7)
    assert_near(series(&s.model, x) / exact(x), 1, 1e-5);
}

/* Three terms alone: the error is of third order in s, two terms of second order. */
static void terms_have_their_order(void **state) {
  (void)state;
  for (int fourth = 0; fourth <= 1; fourth++) {
    scene        s;
    modal_model *m = make(&s, 0);
    if (!fourth) m->residual_fourth = NULL;
    const double low   = fabs(series(m, 0.5) - exact(0.5));
    const double order = log2(fabs(series(m, 1) - exact(1)) / low);
    assert_near(order, fourth ? 3 : 2, 0.05);
    assert_int_equal(modal_series_has_fourth(m), fourth);
  }
}

/* Far above the modes left out, everything stays finite. */
static void series_is_bounded(void **state) {
  (void)state;
  for (int residual = 0; residual <= OUT; residual += OUT) {
    scene s;
    make(&s, residual);
    assert_true(isfinite(series(&s.model, 1e12)));
    if (residual) assert_near(modal_series_at(&s.model, 1e6).x, 0.9 * lambda[0], 1e-9);
  }
}

/* Slopes against central differences in s. */
static void slopes_are_derivatives(void **state) {
  (void)state;
  const double h = 1e-4;
  for (int residual = 0; residual <= OUT; residual += OUT) {
    scene        store;
    modal_model *m = make(&store, residual);
    for (double s = 50; s < 1000; s *= 3) {
      const modal_series at = modal_series_at(m, sqrt(s)), up = modal_series_at(m, sqrt(s + h)),
                         down = modal_series_at(m, sqrt(s - h));
      double slope, unused;
      for (int t = 0; t < MODAL_TERMS; t++) {
        const double d = (up.weight[t] - down.weight[t]) / (2 * h);
        assert_near(at.slope[t], d, 1e-6 * (1 + fabs(d)));
      }
      for (int i = 0; i < residual; i++) {
        modal_series_mode(m, i, &at, &slope);
        const double d =
            (modal_series_mode(m, i, &up, &unused) - modal_series_mode(m, i, &down, &unused)) /
            (2 * h);
        assert_near(slope, d, 1e-9 + 1e-5 * fabs(d));
      }
    }
  }
}

/* The estimate is within a factor of two of the true error, and needs the tail. */
static void error_is_estimated(void **state) {
  (void)state;
  scene        s;
  modal_model *m = make(&s, 1);
  for (double x = 5; x < 0.5 * lambda[0]; x *= 2) {
    const double error    = fabs(series(m, x) - exact(x)),
                 estimate = modal_series_error(m, sqrt(x), 0);
    assert_true(estimate > 0.5 * error && estimate < 2 * error);
  }
  m->contact_tail = NULL;
  assert_true(modal_series_error(m, 1, 0) == -1);
}

/* Weights and estimate need the diagonals of the terms alone. */
static void released_terms_leave_their_diagonals(void **state) {
  (void)state;
  enum { BYTES = 9 * sizeof(double) };
  for (int first = 0; first < 3; first++) {
    scene        s;
    modal_model *m      = make(&s, 1);
    double     **term[] = {&m->residual_flexibility, &m->residual_inertia, &m->residual_fourth};
    const double error  = modal_series_error(m, 7, 0);
    const modal_series taken = modal_series_at(m, 7);
    for (int t = 0; t < 3; t++) {
      *term[t] = malloc(BYTES);
      assert_non_null(*term[t]);
      memcpy(*term[t], s.R[t], BYTES);
    }
    modal_model_release_terms(m, first);
    for (int t = 0; t < 3; t++) {
      assert_true((*term[t] != NULL) == (t < first));
      assert_true(modal_series_diagonal(m, t, 0) == s.R[t][0]);
      assert_true(modal_series_diagonal(m, t, 2) == s.R[t][8]);
    }
    const modal_series now = modal_series_at(m, 7);
    assert_true(modal_series_has_fourth(m));
    assert_memory_equal(&now, &taken, sizeof now);
    assert_true(modal_series_error(m, 7, 0) == error);
    modal_model_release_terms(m, 0); /* once is all */
    assert_true((m->residual_flexibility != NULL) == (first > 0));
    for (int t = 0; t < first; t++) free(*term[t]);
    free(m->residual_diagonal);
  }
}

/* Without R3 the terms stay as they are. */
static void two_terms_are_not_released(void **state) {
  (void)state;
  scene        s;
  modal_model *m     = make(&s, 0);
  m->residual_fourth = NULL;
  modal_model_release_terms(m, 0);
  assert_ptr_equal(m->residual_flexibility, s.R[0]);
  assert_null(m->residual_diagonal);
  assert_false(modal_series_has_fourth(m));
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(residual_modes_are_exact),
                                     cmocka_unit_test(terms_have_their_order),
                                     cmocka_unit_test(series_is_bounded),
                                     cmocka_unit_test(slopes_are_derivatives),
                                     cmocka_unit_test(error_is_estimated),
                                     cmocka_unit_test(released_terms_leave_their_diagonals),
                                     cmocka_unit_test(two_terms_are_not_released)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
