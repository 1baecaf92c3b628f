/* Outputs and their slopes along a tangent, against differences of the amplitudes. */
#include "mhb/continuation/outputs.h"

#include "mhb/continuation/balance_curve.h"
#include "mhb/numerics/extent.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"

enum { PAIRS = 2, H = 3, N = PAIRS * 3 * (2 * H + 1), PROBES = 2, OUTPUTS = PROBES + 3 * PAIRS };

typedef struct {
  modal_model    model;
  mhb_settings   settings;
  mhb_balance   *balance;
  mhb_arclength *curve;
} fixture;

static void set_up(fixture *f, mhb_parameter parameter, double n0) {
  random_model(PAIRS, WITH_LEFT | WITH_RESIDUAL, 4, &f->model);
  f->settings           = random_settings(H);
  f->settings.n0[0]     = n0;
  f->settings.tolerance = 1e-11;
  assert_ok(mhb_balance_create(&f->model, &f->settings, &f->balance));
  mhb_balance_set_preload(f->balance, n0);
  mhb_balance_set_value(f->balance, 1.2);
  mhb_balance_set_parameter(f->balance, parameter);
  f->curve = mhb_balance_curve_create(f->balance, 0.1, 2);
}

static void tear_down(fixture *f) {
  mhb_arclength_destroy(f->curve);
  mhb_balance_destroy(f->balance);
  modal_model_free(&f->model);
}

/* point <- a random motion and direction. */
static void set_random(mhb_curve_point *point, double value) {
  unsigned long long seed = 9;
  for (int i = 0; i < N; i++) {
    point->x[i]       = 0.3 * random_unit(&seed);
    point->tangent[i] = 0.2 * random_unit(&seed);
  }
  point->value      = value;
  point->tangent[N] = 0.7;
}

/* next <- the point s along the tangent of current, evaluated. */
static mhb_curve_point *along(fixture *f, double s) {
  mhb_curve_point *from = &f->curve->current, *to = &f->curve->next;
  for (int i = 0; i < N; i++) to->x[i] = from->x[i] + s * from->tangent[i];
  to->value = from->value + s * from->tangent[N];
  f->curve->system->linearise(f->curve->system, to);
  memset(to->tangent, 0, sizeof(double) * (N + 1));
  return to;
}

/* Squares of all amplitudes at the excitation's frequency. */
static void squares(fixture *f, mhb_curve_point *point, double *square) {
  double complex q[3 * PROBES], unused[3 * PROBES];
  mhb_probe_change(f->balance, point, 1, q, unused);
  for (int o = 0; o < PROBES; o++) {
    double complex w[3];
    square[o] = pow(mhb_semi_major_weight(q + 3 * o, w), 2);
  }
  for (int row = 0; row < 3 * PAIRS; row++) {
    const double *a      = point->x + (size_t)row * (2 * H + 1);
    square[PROBES + row] = a[1] * a[1] + a[2] * a[2];
  }
}

static const struct {
  mhb_parameter parameter;
  double        value;
} PARAMETERS[] = {
    {MHB_IN_FREQUENCY, 1.3}, {MHB_IN_N0, 0.25}, {MHB_IN_SCALE, 0.8}, {MHB_IN_MU, 0.5}};

/* Central differences approach the slope with second order. */
static void slopes_are_those_along_the_tangent(void **state) {
  (void)state;
  for (int i = 0; i < 4; i++) {
    fixture f;
    double  slope[OUTPUTS], worst[2] = {0};
    set_up(&f, PARAMETERS[i].parameter, 0.3);
    assert_int_equal(mhb_outputs(f.balance), OUTPUTS);
    set_random(&f.curve->current, PARAMETERS[i].value);
    f.curve->system->linearise(f.curve->system, &f.curve->current);
    for (int o = 0; o < OUTPUTS; o++) slope[o] = mhb_output_slope(f.balance, &f.curve->current, o);
    for (int k = 0; k < 2; k++) {
      double h = k ? 5e-4 : 1e-3, plus[OUTPUTS], minus[OUTPUTS];
      squares(&f, along(&f, h), plus);
      squares(&f, along(&f, -h), minus);
      for (int o = 0; o < OUTPUTS; o++)
        worst[k] = fmax(worst[k], fabs((plus[o] - minus[o]) / (2 * h) / slope[o] - 1));
    }
    print_message("%s: %.1e %.1e\n", mhb_parameter_name(PARAMETERS[i].parameter), worst[0],
                  worst[1]);
    assert_below(worst[1], 1e-4);
    assert_below(worst[1], 0.4 * worst[0]);
    tear_down(&f);
  }
}

/* All harmonics of the probes, of which slopes take one. */
static void probes_change_as_their_motions_do(void **state) {
  (void)state;
  fixture f;
  set_up(&f, MHB_IN_FREQUENCY, 0.3);
  set_random(&f.curve->current, 1.3);
  f.curve->system->linearise(f.curve->system, &f.curve->current);
  for (int k = 0; k <= H; k++) {
    const double   h = 1e-4;
    double complex q[3 * PROBES], dq[3 * PROBES], plus[3 * PROBES], minus[3 * PROBES];
    double complex unused[3 * PROBES];
    double         size = 0, error = 0;
    mhb_probe_change(f.balance, &f.curve->current, k, q, dq);
    mhb_probe_change(f.balance, along(&f, h), k, plus, unused);
    mhb_probe_change(f.balance, along(&f, -h), k, minus, unused);
    for (int i = 0; i < 3 * PROBES; i++) {
      size  = fmax(size, cabs(dq[i]));
      error = fmax(error, cabs((plus[i] - minus[i]) / (2 * h) - dq[i]));
    }
    print_message("harmonic %d: %.1e of %.1e\n", k, error, size);
    assert_true(size > 0);
    assert_below(error, 1e-5 * size);
  }
  tear_down(&f);
}

/* A preload changes nothing where all pairs stick: the slope of a probe is 0, not its round-off. */
static void a_flat_output_has_no_slope(void **state) {
  (void)state;
  fixture f;
  set_up(&f, MHB_IN_N0, 60);
  mhb_curve_point *p = &f.curve->current;
  set_random(p, 60);
  memset(p->tangent, 0, sizeof(double) * N);
  p->tangent[N] = 1;
  f.curve->system->linearise(f.curve->system, p);
  assert_true(f.curve->system->is_linear(f.curve->system, p));
  for (int o = 0; o < OUTPUTS; o++) assert_true(mhb_output_slope(f.balance, p, o) == 0);
  tear_down(&f);
}

/* Contact outputs are those of the first two pairs at most. */
static void outputs_are_counted(void **state) {
  (void)state;
  for (int pairs = 1; pairs < 4; pairs++) {
    modal_model  model;
    mhb_settings settings = random_settings(H);
    mhb_balance *balance;
    random_model(pairs, WITH_LEFT, 4, &model);
    assert_ok(mhb_balance_create(&model, &settings, &balance));
    assert_int_equal(mhb_outputs(balance), PROBES + (pairs > 1 ? 6 : 3));
    mhb_balance_destroy(balance);
    modal_model_free(&model);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(slopes_are_those_along_the_tangent),
                                     cmocka_unit_test(probes_change_as_their_motions_do),
                                     cmocka_unit_test(a_flat_output_has_no_slope),
                                     cmocka_unit_test(outputs_are_counted)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
