/* The slider through one period: its fixed point, its transitions, its work. */
#include "mesh/base/constants.h"
#include "mhb/contact/force_integrals.h"
#include "mhb/contact/internal.h"
#include "mhb/contact/slider.h"
#include "tests/support/check.h"

enum { M = 3, H = 8, NB = 2 * M + 1, NF = 2 * H + 1 };

static const mhb_law SLIPPING = {.mu = .4, .kv = 1, .ku = {1, .2, .8}, .n0 = 3},
                     OPENING  = {.mu = .4, .kv = 1, .ku = {1, .2, .8}, .n0 = .3};

static const double MOTION[3 * NB] = {.1, .5,  .2, -.1, .05, .02, .07, /* v */
                                      .3, 3,   -1, .4,  .3,  -.2, .1,  /* u */
                                      .2, -.8, 1,  .2,  -.3, .1,  .2}; /* w */

/* The friction is the same from any first guess, and laps count as they are run. */
static void fixed_point_forgets_the_guess(void **state) {
  (void)state;
  double                 guess[][2] = {{0, 0}, {2, -1}, {-7, 5}, {.1, 30}};
  mhb_contact_evaluator *c          = NULL;
  double                 force[3 * NF], first[2 * NF];
  mhb_contact_info       info;
  assert_ok(mhb_contact_evaluator_create(M, H, 1e-10, &c));
  mhb_contact_force(c, &SLIPPING, MOTION, force, NULL, &info);
  memcpy(first, c->f, sizeof first);
  for (int g = 0; g < 4; g++) {
    double worst = 0;
    info.laps    = 0;
    c->mode      = MHB_NO_COLUMNS;
    mhb_force_integrals_clear(c);
    assert_true(mhb_slider_periodic(c, 0, guess[g]));
    mhb_force_integrals_finish(c);
    for (int i = 0; i < 2 * NF; i++) worst = fmax(worst, fabs(c->f[i] - first[i]));
    print_message("guess %d: %d laps, %.1e apart\n", g, info.laps, worst);
    assert_true(worst < 1e-9);
    assert_true(info.laps >= 1 && info.laps < 20);
  }
  mhb_contact_evaluator_destroy(c);
}

/* States alternate as the physics permits, shares add up, slip work is the loop's dissipation. */
static void period_is_consistent(void **state) {
  (void)state;
  const mhb_law          laws[] = {SLIPPING, OPENING};
  mhb_contact_evaluator *c      = NULL;
  double                 force[3 * NF];
  assert_ok(mhb_contact_evaluator_create(M, H, 1e-10, &c));
  for (int l = 0; l < 2; l++) {
    mhb_contact_info info;
    mhb_contact_force(c, &laws[l], MOTION, force, NULL, &info);
    assert_int_equal(info.lost, 0);
    assert_near(info.share[0] + info.share[1] + info.share[2], 1, 1e-12);
    assert_near(info.slip_work, info.dissipation, 1e-8 * info.dissipation);
    assert_true(info.n_transitions >= 2);
    for (int i = 0; i < info.n_transitions; i++) {
      const mhb_transition *now  = &info.transition[i],
                           *next = &info.transition[(i + 1) % info.n_transitions];
      assert_true(now->state != next->state);
      assert_true(now->phase >= 0 && now->phase < 1);
    }
  }
  mhb_contact_evaluator_destroy(c);
}

/* Every closed interval is a fresh start: an opening and a closing each, at the roots of n. */
static void openings_are_transitions(void **state) {
  (void)state;
  mhb_contact_evaluator *c = NULL;
  double                 force[3 * NF];
  mhb_contact_info       info;
  int                    opens = 0;
  assert_ok(mhb_contact_evaluator_create(M, H, 1e-10, &c));
  mhb_contact_force(c, &OPENING, MOTION, force, NULL, &info);
  for (int i = 0; i < info.n_transitions; i++) opens += info.transition[i].state == MHB_SEPARATE;
  assert_true(c->intervals.n > 0);
  assert_int_equal(opens, c->intervals.n);
  assert_int_equal(info.laps, 0);
  mhb_contact_evaluator_destroy(c);
}

/* The slider of a motion nearby saves laps. The force is the same to the tolerance, and does not
 * depend on a slider that is far off. */
static void slider_nearby_saves_laps(void **state) {
  (void)state;
  const double           off[] = {0, 1e-6, 1e-3, 30};
  mhb_contact_evaluator *c     = NULL;
  double                 force[3 * NF], near[3 * NF], jacobian[9 * NF * NB], dp[9 * NF * NB];
  mhb_contact_info       info, of;
  assert_ok(mhb_contact_evaluator_create(M, H, 1e-10, &c));
  mhb_contact_force(c, &SLIPPING, MOTION, force, jacobian, &info);
  for (int i = 0; i < 4; i++) {
    const double start[2] = {info.slider[0] * (1 + off[i]), info.slider[1] - off[i]};
    double       worst = 0, worst_dp = 0;
    mhb_contact_force_near(c, &SLIPPING, start, MOTION, near, dp, &of);
    for (int j = 0; j < 3 * NF; j++) worst = fmax(worst, fabs(near[j] - force[j]));
    for (int j = 0; j < 9 * NF * NB; j++) worst_dp = fmax(worst_dp, fabs(dp[j] - jacobian[j]));
    print_message("slider off by %.0e: %d laps, was %d; force %.0e, derivative %.0e apart\n",
                  off[i], of.laps, info.laps, worst, worst_dp);
    assert_below(worst, 1e-9);
    assert_below(worst_dp, 1e-7);
    if (i < 2) assert_true(of.laps < info.laps);
    mhb_contact_force_near(c, &SLIPPING, start, MOTION, near, NULL, &of);
    for (int j = 0; j < 3 * NF; j++) assert_near(near[j], force[j], 1e-9);
    if (i == 0) assert_int_equal(of.laps, 0); /* but the one that records */
  }
  mhb_contact_force_near(c, &OPENING, info.slider, MOTION, near, NULL, &of);
  mhb_contact_force(c, &OPENING, MOTION, force, NULL, &info);
  assert_memory_equal(near, force, sizeof force);
  assert_true(isnan(info.slider[0]) && isnan(info.slider[1]));
  mhb_contact_evaluator_destroy(c);
}

/* The slider at phase 0 by samples, of a motion u with harmonics 1 to m at constant load. */
static double sampled_slider(int m, const double *u, double limit) {
  enum { SAMPLES = 4096 };
  double y[SAMPLES + 1] = {0}, z = 0;
  for (int t = 0; t <= SAMPLES; t++)
    for (int k = 1; k <= m; k++) {
      const double phase = SHB_TWO_PI * k * t / SAMPLES;
      y[t] += u[2 * k - 1] * cos(phase) - u[2 * k] * sin(phase);
    }
  for (int t = 0; t <= 2 * SAMPLES; t++) {
    const double at = y[t <= SAMPLES ? t : t - SAMPLES];
    z               = fmax(at - limit, fmin(at + limit, z));
  }
  return z;
}

/* Nearly rigid friction: the limit is a two-hundredth of the motion, and small harmonics reverse it
 * for moments. A lap that misses one closes at another slider than the lap that is recorded. */
static void moments_of_reversal_lose_no_slider(void **state) {
  (void)state;
  enum { MANY = 31, WIDE = 2 * MANY + 1, MOTIONS = 200 };
  static double          x[3 * WIDE], force[3 * WIDE], jacobian[9 * WIDE * WIDE];
  const double           limit = .005, ripple[] = {.1, .3};
  const mhb_law          law   = {.mu = 1, .ku = {1, 0, 1}, .n0 = limit, .mean_offset = limit};
  mhb_contact_evaluator *c     = NULL;
  int                    lost  = 0;
  double                 worst = 0;
  unsigned               seed  = 20;
  assert_ok(mhb_contact_evaluator_create(MANY, MANY, 1e-8, &c));
  for (int i = 0; i < MOTIONS; i++) {
    mhb_contact_info info;
    double          *u = x + WIDE;
    memset(x, 0, sizeof x);
    u[1] = 1;
    for (int k = 3; k < WIDE; k++) {
      const int order = (k + 1) / 2;
      seed            = seed * 1664525u + 1013904223u;
      u[k]            = ripple[i % 2] * (seed / 2147483648. - 1) / (order * order);
    }
    mhb_contact_force(c, &law, x, force, i % 4 < 2 ? jacobian : NULL, &info);
    lost += info.lost;
    worst = fmax(worst, fabs(info.slider[0] - sampled_slider(MANY, u, limit)) / limit);
  }
  print_message("%d of %d lost, sliders %.1e of the limit apart\n", lost, MOTIONS, worst);
  assert_int_equal(lost, 0);
  assert_below(worst, 1e-3); /* of the samples: y'' (2 pi/4096)^2/8, up to 6e-4 */
  mhb_contact_evaluator_destroy(c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fixed_point_forgets_the_guess),
      cmocka_unit_test(period_is_consistent),
      cmocka_unit_test(openings_are_transitions),
      cmocka_unit_test(slider_nearby_saves_laps),
      cmocka_unit_test(moments_of_reversal_lose_no_slider),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
