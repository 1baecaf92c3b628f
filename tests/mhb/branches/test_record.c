/* Recorded points: every figure of a point arrives in the response, and its motion comes back. */
#include "mhb/branches/record.h"

#include "mesh/base/constants.h"
#include "tests/support/check.h"
#include "tests/support/main_curve.h"
#include "tests/support/random_model.h"

enum { PAIRS = 2, PROBES = 2, H = 3, NB = 2 * H + 1, N = PAIRS * 3 * NB };

typedef struct {
  modal_model     model;
  mhb_settings    settings;
  mhb_balance    *balance;
  mhb_response   *response;
  mhb_curve_point point;
  double          x[N], r[N];
} fixture;

/* A balance evaluated at a random motion, and a response of wide harmonics. */
static void set_up(fixture *f, mhb_parameter parameter, double value, int wide) {
  unsigned long long seed = 5;
  random_model(PAIRS, WITH_LEFT | WITH_RESIDUAL, 4, &f->model);
  f->settings = random_settings(H);
  assert_ok(mhb_balance_create(&f->model, &f->settings, &f->balance));
  mhb_balance_set_preload(f->balance, 0.3);
  mhb_balance_set_value(f->balance, 1.2);
  mhb_balance_set_parameter(f->balance, parameter);
  for (int i = 0; i < N; i++) f->x[i] = 0.4 * random_unit(&seed);
  mhb_balance_linearise(f->balance, f->x, value, f->r, NULL);
  f->point    = (mhb_curve_point){.x               = f->x,
                                  .value           = value,
                                  .iterations      = 4,
                                  .residual        = 1e-11,
                                  .truncation      = 2e-3,
                                  .truncation_max  = 5e-3,
                                  .modal           = 3e-4,
                                  .truncation_kind = 2};
  f->response = mhb_response_create(PAIRS, PROBES, wide);
  assert_non_null(f->response);
  mhb_response_branch(f->response, MHB_BRANCH_NONLINEAR);
}

static void tear_down(fixture *f) {
  mhb_response_destroy(f->response);
  mhb_balance_destroy(f->balance);
  modal_model_free(&f->model);
}

static void a_point_arrives_with_all_its_figures(void **state) {
  (void)state;
  fixture f;
  set_up(&f, MHB_IN_FREQUENCY, 1.3, H);
  for (int i = 0; i < 2; i++)
    mhb_record(f.response, 0, f.balance, &f.point, i ? MHB_FOLD : MHB_ORDINARY, 0.5 + i);
  const mhb_branch *b = &f.response->branch[0];
  assert_int_equal(b->n_points, 2);
  for (int i = 0; i < 2; i++) {
    assert_near(b->frequency[i], 1.3 / SHB_TWO_PI, 1e-15);
    assert_near(b->value[i], 1.3 / SHB_TWO_PI, 1e-15); /* Hz, as the file shows it */
    assert_true(b->n0[i] == 0.3 && b->seconds[i] == 0.5 + i);
    assert_int_equal(b->special[i], i ? MHB_FOLD : MHB_ORDINARY);
    assert_int_equal(b->stable[i], -1);
    assert_int_equal(b->iterations[i], 4);
    assert_int_equal(b->harmonics[i], H);
    assert_int_equal(b->truncation_kind[i], 2);
    assert_true(b->error_newton[i] == 1e-11 && b->error_truncation[i] == 2e-3);
    assert_true(b->error_modal[i] == 3e-4 && b->error_truncation_max[i] == 5e-3);
    double worst    = 0;
    int    at_limit = 0;
    for (int a = 0; a < PAIRS; a++) {
      at_limit += f.balance->eval->kind[a] == MHB_PAIR_AT_LIMIT;
      const double *share = b->state + 3 * (i * PAIRS + a);
      assert_near(share[0] + share[1] + share[2], 1, 1e-12);
      assert_true(b->dissipation[i * PAIRS + a] == f.balance->eval->info[a].dissipation);
      worst = fmax(worst, f.balance->eval->info[a].error);
    }
    assert_true(b->error_sampling[i] == worst);
    assert_int_equal(b->at_limit[i], at_limit);
  }
  tear_down(&f);
}

/* The tolerance of the settings, and pairs that stick with friction, mark a point. */
static void a_point_is_marked_for_what_it_is_not_worth(void **state) {
  (void)state;
  static const struct {
    double tolerance, truncation, mu;
    int    sticks, mark;
  } rows[] = {{0, 2e-3, 0.4, 0, 0},
              {1e-3, 9e-4, 0.4, 0, 0},
              {1e-3, 2e-3, 0.4, 0, MHB_ABOVE_TOLERANCE},
              {1e-3, 2e-3, 0.4, 1, MHB_ABOVE_TOLERANCE | MHB_TRACTION_UNDETERMINED},
              {1e-3, 9e-4, 0.4, 1, MHB_TRACTION_UNDETERMINED},
              {1e-3, 9e-4, 0, 1, 0},
              {1e-3, NAN, 0.4, 0, MHB_ERROR_NOT_JUDGED}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    fixture f;
    set_up(&f, MHB_IN_FREQUENCY, 1.3, H);
    f.settings.motion_tolerance = rows[i].tolerance;
    f.point.truncation          = rows[i].truncation;
    for (int a = 0; a < PAIRS; a++) {
      f.balance->law[a].mu                  = rows[i].mu;
      f.balance->eval->info[a].undetermined = rows[i].sticks && a == 1;
    }
    mhb_record(f.response, 0, f.balance, &f.point, MHB_ORDINARY, 0);
    assert_int_equal(f.response->branch[0].mark[0], rows[i].mark);
    tear_down(&f);
  }
}

/* Shares of the period stuck and open of two pairs; whether the mean friction of one loads the
 * other. */
static void a_stuck_pair_that_loads_no_other_is_not_marked(void **state) {
  (void)state;
  static const struct {
    double stick[PAIRS], open[PAIRS];
    int    mark;
  } rows[] = {{{1, 1}, {0, 0}, MHB_TRACTION_UNDETERMINED},     /* they share a load */
              {{1, 0.4}, {0, 0.1}, MHB_TRACTION_UNDETERMINED}, /* one slips */
              {{0, 1}, {0.2, 0}, MHB_TRACTION_UNDETERMINED},
              {{1, 0}, {0, 1}, 0}, /* the other is open: a single contact point */
              {{0.5, 0.4}, {0, 0}, 0},
              {{0, 0}, {1, 1}, 0}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    fixture f;
    set_up(&f, MHB_IN_FREQUENCY, 1.3, H);
    for (int a = 0; a < PAIRS; a++) {
      mhb_contact_info *info    = &f.balance->eval->info[a];
      info->share[MHB_STICK]    = rows[i].stick[a];
      info->share[MHB_SEPARATE] = rows[i].open[a];
      info->share[MHB_SLIDE]    = 1 - rows[i].stick[a] - rows[i].open[a];
      info->undetermined        = rows[i].stick[a] == 1;
      f.balance->law[a].mu      = 0.4;
    }
    mhb_record(f.response, 0, f.balance, &f.point, MHB_ORDINARY, 0);
    assert_int_equal(f.response->branch[0].mark[0], rows[i].mark);
    tear_down(&f);
  }
}

static void another_parameter_has_its_own_value(void **state) {
  (void)state;
  fixture f;
  set_up(&f, MHB_IN_N0, 0.7, H);
  mhb_record(f.response, 0, f.balance, &f.point, MHB_ORDINARY, 0);
  const mhb_branch *b = &f.response->branch[0];
  assert_true(b->value[0] == 0.7 && b->n0[0] == 0.7);
  assert_near(b->frequency[0], 1.2 / SHB_TWO_PI, 1e-15);
  tear_down(&f);
}

/* Forces and probes are those of the evaluation, harmonic by harmonic. */
static void signals_are_those_of_the_balance(void **state) {
  (void)state;
  fixture f;
  set_up(&f, MHB_IN_FREQUENCY, 1.3, H);
  mhb_record(f.response, 0, f.balance, &f.point, MHB_ORDINARY, 0);
  const mhb_branch *b = &f.response->branch[0];
  for (int k = 0; k <= H; k++) {
    double complex p[3 * PAIRS], q[3 * PROBES];
    mhb_balance_contact_force(f.balance, k, p);
    mhb_receptance_update(f.balance->receptance, k);
    mhb_receptance_probe(f.balance->receptance, k, p, q);
    for (int row = 0; row < 3 * PAIRS; row++) assert_true(b->force[row * (H + 1) + k] == p[row]);
    for (int row = 0; row < 3 * PROBES; row++) assert_true(b->probe[row * (H + 1) + k] == q[row]);
  }
  tear_down(&f);
}

/* Into a response of more harmonics and back, and into balances of fewer and of more. */
static void motions_come_back(void **state) {
  (void)state;
  for (int wide = H; wide < H + 3; wide++)
    for (int m = 1; m < 7; m++) {
      fixture      f;
      mhb_balance *other;
      set_up(&f, MHB_IN_FREQUENCY, 1.3, wide);
      mhb_record(f.response, 0, f.balance, &f.point, MHB_ORDINARY, 0);
      f.settings.harmonics = m;
      f.model.n_load       = 1;
      assert_ok(mhb_balance_create(&f.model, &f.settings, &other));
      double back[other->n];
      mhb_recorded_motion(&f.response->branch[0], 0, other, back);
      for (int row = 0; row < 3 * PAIRS; row++)
        for (int i = 0; i < 2 * m + 1; i++)
          assert_true(back[row * (2 * m + 1) + i] == (i < NB ? f.x[row * NB + i] : 0));
      mhb_balance_destroy(other);
      tear_down(&f);
    }
}

/* A point that owns its evaluation is recorded with it, whatever was evaluated since. */
static void a_point_is_recorded_with_its_own_evaluation(void **state) {
  (void)state;
  fixture         f;
  mhb_evaluation *own;
  double          other[N];
  set_up(&f, MHB_IN_FREQUENCY, 1.3, H);
  own = mhb_evaluation_create(f.balance);
  mhb_balance_use(f.balance, own);
  mhb_balance_linearise(f.balance, f.x, 1.3, f.r, NULL);
  double complex wanted[3 * PAIRS], probe[3 * PROBES];
  mhb_balance_contact_force(f.balance, 1, wanted);
  mhb_receptance_update(f.balance->receptance, 1);
  mhb_receptance_probe(f.balance->receptance, 1, wanted, probe);
  mhb_balance_use(f.balance, NULL);
  for (int i = 0; i < N; i++) other[i] = -2 * f.x[i];
  mhb_balance_linearise(f.balance, other, 1.5, f.r, NULL);
  f.point.evaluation = own;
  mhb_record(f.response, 0, f.balance, &f.point, MHB_ORDINARY, 0);
  const mhb_branch *b = &f.response->branch[0];
  for (int row = 0; row < 3 * PAIRS; row++) assert_true(b->force[row * (H + 1) + 1] == wanted[row]);
  for (int row = 0; row < 3 * PROBES; row++) assert_true(b->probe[row * (H + 1) + 1] == probe[row]);
  assert_near(b->frequency[0], 1.3 / SHB_TWO_PI, 1e-15);
  mhb_balance_use(f.balance, NULL);
  mhb_evaluation_destroy(own);
  tear_down(&f);
}

/* On whole curves: one pair is never marked, two and three are where one of them sticks. */
static void curves_are_marked_where_a_stuck_pair_loads_others(void **state) {
  (void)state;
  for (int pairs = 1; pairs <= 3; pairs++) {
    modal_model   model;
    mhb_response *r;
    int           stuck = 0, marked = 0, wrong = 0;
    random_model(pairs, WITH_RESIDUAL, 6, &model);
    mhb_settings s = random_settings(3);
    s.to_ground    = true;
    s.blades       = 1;
    s.preload      = MHB_EQUILIBRIUM;
    s.n0[0]        = 0.6;
    s.stability    = MHB_STABILITY_NEVER;
    s.frequency[0] = 0.7 / SHB_TWO_PI;
    s.frequency[1] = 1.3 / SHB_TWO_PI;
    assert_ok(main_curve(&model, &s, 3, NULL, &r));
    const mhb_branch *b = &r->branch[0];
    for (int p = 0; p < b->n_points; p++) {
      int sticks = 0, touch = 0;
      for (int a = 0; a < pairs; a++) {
        const double *share = b->state + 3 * (p * pairs + a);
        sticks += share[MHB_STICK] == 1;
        touch += share[MHB_SEPARATE] < 1;
      }
      const int mark = (b->mark[p] & MHB_TRACTION_UNDETERMINED) != 0;
      stuck += sticks > 0;
      marked += mark;
      wrong += mark != (sticks > 0 && touch > 1);
    }
    print_message("%d pairs: %d points, %d with a stuck pair, %d marked\n", pairs, b->n_points,
                  stuck, marked);
    assert_true(wrong == 0 && stuck > 5);
    assert_int_equal(marked > 0, pairs > 1);
    mhb_response_destroy(r);
    modal_model_free(&model);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_point_arrives_with_all_its_figures),
      cmocka_unit_test(a_point_is_marked_for_what_it_is_not_worth),
      cmocka_unit_test(a_stuck_pair_that_loads_no_other_is_not_marked),
      cmocka_unit_test(curves_are_marked_where_a_stuck_pair_loads_others),
      cmocka_unit_test(another_parameter_has_its_own_value),
      cmocka_unit_test(signals_are_those_of_the_balance),
      cmocka_unit_test(motions_come_back),
      cmocka_unit_test(a_point_is_recorded_with_its_own_evaluation)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
