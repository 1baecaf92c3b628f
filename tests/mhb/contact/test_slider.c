/* The slider through one period: its fixed point, its transitions, its work. */
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

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fixed_point_forgets_the_guess),
      cmocka_unit_test(period_is_consistent),
      cmocka_unit_test(openings_are_transitions),
      cmocka_unit_test(slider_nearby_saves_laps),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
