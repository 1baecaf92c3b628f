/* The linearised contact law: jumps at transitions against their equations, and the invariants of
 * slip. */
#include "mhb/variation/linearised_law.h"
#include "tests/support/check.h"

static const mhb_law LAW = {.mu = 0.37, .kv = 2.1, .ku = {1.6, 0.3, 1.2}, .n0 = 0.8};

/* A contact with friction along the angle 0.7 rad. */
static mhb_contact_state contact_in(mhb_state state) {
  mhb_contact_state point = {.law = &LAW, .state = state, .n = 0.9, .rate = {0.23, -0.51, 0.34}};
  point.e[0]              = cos(0.7);
  point.e[1]              = sin(0.7);
  return point;
}

/* Row of a jump times y = (dv, sigma). */
static double times(const double row[3], const double y[3]) {
  return row[0] * y[0] + row[1] * y[1] + row[2] * y[2];
}

static void set_spring(const double x[2], double f[2]) {
  f[0] = LAW.ku[0] * x[0] + LAW.ku[1] * x[1];
  f[1] = LAW.ku[1] * x[0] + LAW.ku[2] * x[1];
}

/* Stick to slip: tau of df - Ku e (e.df - mu dn)/(e.Ku e), which has e.df = mu dn. */
static void onset_of_slip(void **state) {
  (void)state;
  mhb_contact_state point = contact_in(MHB_STICK);
  mhb_saltation     jump  = {.contact = 0};
  const double     *e = point.e, y[3] = {0.13, -0.29, 0.41}, *df = y + 1;
  double            Ke[2], dn = LAW.kv * y[0], after[2];
  mhb_saltation_at(&point, MHB_SLIDE, &jump);
  set_spring(e, Ke);
  double factor = (e[0] * df[0] + e[1] * df[1] - LAW.mu * dn) / (e[0] * Ke[0] + e[1] * Ke[1]);
  for (int i = 0; i < 2; i++) after[i] = df[i] - Ke[i] * factor;
  assert_near(e[0] * after[0] + e[1] * after[1], LAW.mu * dn, 1e-15);
  assert_near(times(jump.set[0], y), e[0] * after[1] - e[1] * after[0], 1e-15);
  assert_true(times(jump.set[1], y) == 0);
}

/* Slip to stick: no jump, df = mu dn e + tau q in other rows. */
static void end_of_slip(void **state) {
  (void)state;
  mhb_contact_state point = contact_in(MHB_SLIDE);
  mhb_saltation     jump  = {.contact = 0};
  const double     *e = point.e, y[3] = {0.13, -0.29, 0};
  mhb_saltation_at(&point, MHB_STICK, &jump);
  double along = LAW.mu * LAW.kv * y[0];
  assert_near(times(jump.set[0], y), along * e[0] - y[1] * e[1], 1e-15);
  assert_near(times(jump.set[1], y), along * e[1] + y[1] * e[0], 1e-15);
}

/* Closing into stick: df = Ku s' dn/n'. Into slip and at an opening: nothing is left. */
static void opening_and_closing(void **state) {
  (void)state;
  mhb_contact_state point = contact_in(MHB_SEPARATE);
  mhb_saltation     jump  = {.contact = 0};
  const double      y[3]  = {0.13, 0, 0};
  double            rate[2];
  mhb_saltation_at(&point, MHB_STICK, &jump);
  set_spring(point.rate + 1, rate);
  for (int i = 0; i < 2; i++)
    assert_near(times(jump.set[i], y), rate[i] * y[0] / point.rate[0], 1e-15);
  const mhb_state from[] = {MHB_SEPARATE, MHB_STICK, MHB_SLIDE};
  for (int k = 0; k < 3; k++) {
    point.state = from[k];
    mhb_saltation_at(&point, from[k] == MHB_SEPARATE ? MHB_SLIDE : MHB_SEPARATE, &jump);
    for (int i = 0; i < 6; i++) assert_true(jump.set[i / 3][i % 3] == 0);
  }
}

/* In slip the force along e is mu dn: mean force, tangent stiffness. */
static void slip_follows_its_limit(void **state) {
  (void)state;
  mhb_contact_state  point = contact_in(MHB_SLIDE);
  mhb_linearised_law law;
  double             G[3][3];
  mhb_linearised_law_at(&point, 0.01, &law);
  mhb_linearised_law_rate(&point, G);
  for (int k = 0; k < 3; k++) {
    double wanted = k == 0 ? LAW.mu * LAW.kv : 0;
    assert_near(point.e[0] * law.mean_y[1][k] + point.e[1] * law.mean_y[2][k], wanted, 1e-15);
    assert_near(point.e[0] * law.mean_du[1][k] + point.e[1] * law.mean_du[2][k], wanted, 1e-15);
    assert_near(point.e[0] * G[1][k] + point.e[1] * G[2][k], wanted, 1e-15);
  }
}

/* A stuck contact is a spring: mean force df + Ku D/2, change of force Ku D, friction df + Ku D. */
static void stick_is_a_spring(void **state) {
  (void)state;
  mhb_contact_state  point = contact_in(MHB_STICK);
  mhb_linearised_law law;
  const double       y[3] = {0.13, -0.29, 0.41}, D[3] = {0.7, 0.2, -0.6};
  double             KD[2];
  mhb_linearised_law_at(&point, 0.01, &law);
  set_spring(D + 1, KD);
  assert_near(times(law.mean_y[0], y) + times(law.mean_du[0], D) / 2, LAW.kv * (y[0] + D[0] / 2),
              1e-15);
  for (int i = 0; i < 2; i++) {
    assert_near(times(law.mean_y[1 + i], y) + times(law.mean_du[1 + i], D) / 2,
                y[1 + i] + KD[i] / 2, 1e-15);
    assert_near(times(law.df_y[1 + i], y) + times(law.df_du[1 + i], D), KD[i], 1e-15);
    assert_near(times(law.state_y[i], y) + times(law.state_du[i], D), y[1 + i] + KD[i], 1e-15);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(onset_of_slip),       cmocka_unit_test(end_of_slip),
      cmocka_unit_test(opening_and_closing), cmocka_unit_test(slip_follows_its_limit),
      cmocka_unit_test(stick_is_a_spring),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
