/* The contact law on every motion of the suite: error against the independent reference, accuracy
 * of the estimate, identities, derivative. m = 7, harmonics 0-15; errors relative to the largest
 * force harmonic. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/motion_suite.h"
#include "tests/support/reference_law.h"

enum { M = SUITE_HARMONICS, H = 15, NB = SUITE_WIDTH, NF = 2 * H + 1, COLUMNS = 3 * NB };

typedef struct {
  double           force[3][NF];
  mhb_contact_info info;
} answer;

static void evaluate(mhb_contact_evaluator *contact, const suite_motion *s, double *jacobian,
                     answer *a) {
  mhb_contact_force(contact, &s->law, &s->motion[0][0], &a->force[0][0], jacobian, &a->info);
}

static mhb_contact_evaluator *workspace_of(double tolerance) {
  mhb_contact_evaluator *contact;
  assert_int_equal(mhb_contact_evaluator_create(M, H, tolerance, &contact), SHB_OK);
  return contact;
}

static double largest(const double force[3][NF]) {
  double top = 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < NF; j++) top = fmax(top, fabs(force[i][j]));
  return top;
}

static double apart(const double a[3][NF], const double b[3][NF]) {
  double worst = 0;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < NF; j++) {
      double off = fabs(a[i][j] - b[i][j]);
      if (!(off <= worst)) worst = off;
    }
  }
  return worst;
}

/* ---- against the reference ---- */

static const reference *witness(int i) {
  static reference kept[64];
  static int       known[64];
  if (!known[i]) {
    suite_motion s = suite_at(i);
    reference_force(&s.law, M, &s.motion[0][0], H, 24, 1e-18, &kept[i]);
    assert_false(kept[i].lost || kept[i].stuck);
    known[i] = 1;
  }
  return &kept[i];
}

/* reference.force is wider than H */
static double true_error(int i, const answer *a) {
  double wanted[3][NF];
  for (int k = 0; k < 3; k++) memcpy(wanted[k], witness(i)->force[k], sizeof wanted[k]);
  return apart(a->force, wanted) / largest(wanted);
}

static const double asked[] = {1e-3, 1e-5, 1e-8};

enum { ASKED = sizeof asked / sizeof asked[0] };

static void tolerance_is_met(void **state) {
  (void)state;
  int failed = 0;
  for (int k = 0; k < ASKED; k++) {
    mhb_contact_evaluator *contact = workspace_of(asked[k]);
    for (int i = 0; i < suite_size(); i++) {
      suite_motion s = suite_at(i);
      answer       a;
      evaluate(contact, &s, NULL, &a);
      double error = true_error(i, &a);
      if (error <= asked[k] && !a.info.lost) continue;
      print_message("tolerance %.0e, %s: error %.1e, lost %d\n", asked[k], s.name, error,
                    a.info.lost);
      failed++;
    }
    mhb_contact_evaluator_destroy(contact);
  }
  assert_int_equal(failed, 0);
}

/* The estimate is within a factor of ten of the true error. It may be smaller only below 1e-12,
 * where rounding decides. It may be larger only if both are below a twentieth of the tolerance.
 * Errors of panels may cancel, as on a circle, and the true error then has no lower bound. */
static void estimate_is_honest(void **state) {
  (void)state;
  int failed = 0;
  for (int k = 0; k < ASKED; k++) {
    mhb_contact_evaluator *contact = workspace_of(asked[k]);
    for (int i = 0; i < suite_size(); i++) {
      suite_motion s = suite_at(i);
      answer       a;
      evaluate(contact, &s, NULL, &a);
      double error = true_error(i, &a), estimate = a.info.error;
      int    optimistic  = error > 1e-12 && error > 10 * estimate;
      int    pessimistic = estimate > 10 * error && estimate > .05 * asked[k];
      if (!optimistic && !pessimistic) continue;
      print_message("tolerance %.0e, %s: error %.1e, estimate %.1e\n", asked[k], s.name, error,
                    estimate);
      failed++;
    }
    mhb_contact_evaluator_destroy(contact);
  }
  assert_int_equal(failed, 0);
}

static void work_and_states_agree(void **state) {
  (void)state;
  mhb_contact_evaluator *contact = workspace_of(1e-12);
  for (int i = 0; i < suite_size(); i++) {
    suite_motion     s = suite_at(i);
    const reference *r = witness(i);
    answer           a;
    evaluate(contact, &s, NULL, &a);
    if (!(fabs(a.info.slip_work - r->work) <= 1e-10 * r->work))
      fail_msg("%s: work %.13g, not %.13g", s.name, a.info.slip_work, r->work);
    if (!(fabs(a.info.dissipation - a.info.slip_work) <= 1e-10 * r->work))
      fail_msg("%s: loop %.13g, slip %.13g", s.name, a.info.dissipation, a.info.slip_work);
    for (int k = 0; k < 3 && s.room > 0; k++)
      if (!(fabs(a.info.share[k] - r->share[k]) <= 1e-9))
        fail_msg("%s: share %d is %.12g, not %.12g", s.name, k, a.info.share[k], r->share[k]);
    if (s.room > 0 && a.info.n_transitions != r->n_transitions)
      fail_msg("%s: %d transitions, not %d", s.name, a.info.n_transitions, r->n_transitions);
  }
  mhb_contact_evaluator_destroy(contact);
}

/* ---- identities ---- */

/* The force of the changed motion, changed back, is the force. */
static void same(const char *name, const char *what, const double a[3][NF], const double b[3][NF],
                 double tolerance) {
  double off = apart(a, b) / largest(a);
  if (!(off <= tolerance)) fail_msg("%s, %s: %.2e > %.0e", name, what, off, tolerance);
}

static void flip(suite_motion *s, double force[3][NF], const int sign[3]) {
  for (int k = 0; k < 3; k++) {
    for (int j = 0; j < NB; j++) s->motion[k][j] *= sign[k];
    for (int j = 0; j < NF; j++) force[k][j] *= sign[k];
  }
  s->law.ku[1] *= sign[1] * sign[2];
}

static void mirrored_motion_mirrors_the_force(void **state) {
  (void)state;
  static const int       sign[3][3] = {{1, -1, -1}, {1, -1, 1}, {1, 1, -1}};
  mhb_contact_evaluator *contact    = workspace_of(1e-12);
  for (int i = 0; i < suite_size(); i++) {
    for (int k = 0; k < 3; k++) {
      suite_motion s = suite_at(i);
      answer       a, b;
      evaluate(contact, &s, NULL, &a);
      flip(&s, a.force, sign[k]);
      evaluate(contact, &s, NULL, &b);
      same(s.name, "mirrored", a.force, b.force, 1e-12);
    }
  }
  mhb_contact_evaluator_destroy(contact);
}

static void shift(double *a, int harmonics, double angle) {
  for (int k = 1; k <= harmonics; k++) {
    double c = cos(k * angle), n = sin(k * angle), x = a[2 * k - 1], y = a[2 * k];
    a[2 * k - 1] = c * x - n * y;
    a[2 * k]     = n * x + c * y;
  }
}

static void shifted_motion_shifts_the_force(void **state) {
  (void)state;
  static const double    angle[] = {.7312, 2.9, 5.77};
  mhb_contact_evaluator *contact = workspace_of(1e-12);
  for (int i = 0; i < suite_size(); i++) {
    for (int k = 0; k < 3; k++) {
      suite_motion s = suite_at(i);
      answer       a, b;
      evaluate(contact, &s, NULL, &a);
      for (int j = 0; j < 3; j++) {
        shift(s.motion[j], M, angle[k]);
        shift(a.force[j], H, angle[k]);
      }
      evaluate(contact, &s, NULL, &b);
      same(s.name, "shifted", a.force, b.force, 1e-10);
    }
  }
  mhb_contact_evaluator_destroy(contact);
}

/* (m, N) -> (um, MN) */
static void units_do_not_matter(void **state) {
  (void)state;
  for (int k = 0; k < ASKED; k++) {
    mhb_contact_evaluator *contact = workspace_of(asked[k]);
    for (int i = 0; i < suite_size(); i++) {
      suite_motion s = suite_at(i);
      answer       a, b;
      evaluate(contact, &s, NULL, &a);
      for (int j = 0; j < COLUMNS; j++) (&s.motion[0][0])[j] *= 1e6;
      for (int j = 0; j < 3 * NF; j++) (&a.force[0][0])[j] *= 1e-6;
      for (int j = 0; j < 3; j++) s.law.ku[j] *= 1e-12;
      s.law.kv *= 1e-12;
      s.law.n0 *= 1e-6;
      evaluate(contact, &s, NULL, &b);
      same(s.name, "other units", a.force, b.force, 1e-12);
    }
    mhb_contact_evaluator_destroy(contact);
  }
}

/* Ku, motion and force in rotated axes. */
static void turned_axes_turn_the_force(void **state) {
  (void)state;
  double                 c = cos(.831), n = sin(.831);
  mhb_contact_evaluator *contact = workspace_of(1e-12);
  for (int i = 0; i < suite_size(); i++) {
    suite_motion s = suite_at(i), t = s;
    double       k[3];
    answer       a, b;
    memcpy(k, s.law.ku, sizeof k);
    t.law.ku[0] = c * c * k[0] - 2 * c * n * k[1] + n * n * k[2];
    t.law.ku[1] = c * n * (k[0] - k[2]) + (c * c - n * n) * k[1];
    t.law.ku[2] = n * n * k[0] + 2 * c * n * k[1] + c * c * k[2];
    for (int j = 0; j < NB; j++) {
      t.motion[1][j] = c * s.motion[1][j] - n * s.motion[2][j];
      t.motion[2][j] = n * s.motion[1][j] + c * s.motion[2][j];
    }
    evaluate(contact, &s, NULL, &a);
    evaluate(contact, &t, NULL, &b);
    for (int j = 0; j < NF; j++) {
      double u = a.force[1][j], w = a.force[2][j];
      a.force[1][j] = c * u - n * w;
      a.force[2][j] = n * u + c * w;
    }
    same(s.name, "turned", a.force, b.force, 1e-10);
  }
  mhb_contact_evaluator_destroy(contact);
}

/* ---- derivative ---- */

enum { LEVELS = 4 };

/* Central differences of steps d, d/2, d/4, d/8, extrapolated; *spread: change by the last
 * extrapolation. */
static void difference(mhb_contact_evaluator *contact, const suite_motion *s, int column, double d,
                       double out[3 * NF], double *spread) {
  double table[LEVELS][3 * NF];
  answer plus, minus;
  for (int l = 0; l < LEVELS; l++, d *= .5) {
    suite_motion p = *s, q = *s;
    (&p.motion[0][0])[column] += d;
    (&q.motion[0][0])[column] -= d;
    double step = (&p.motion[0][0])[column] - (&q.motion[0][0])[column];
    evaluate(contact, &p, NULL, &plus);
    evaluate(contact, &q, NULL, &minus);
    for (int r = 0; r < 3 * NF; r++)
      table[l][r] = ((&plus.force[0][0])[r] - (&minus.force[0][0])[r]) / step;
  }
  *spread = 0;
  for (int r = 0; r < 3 * NF; r++) {
    double before = 0, factor = 4;
    for (int n = LEVELS - 1; n > 0; n--, factor *= 4) {
      before = table[n][r];
      for (int l = 0; l < n; l++)
        table[l][r] = table[l + 1][r] + (table[l + 1][r] - table[l][r]) / (factor - 1);
      before = table[n - 1][r] - (n > 1 ? table[n - 2][r] : before);
    }
    out[r]  = table[0][r];
    *spread = fmax(*spread, fabs(before));
  }
}

static void derivative_is_exact(void **state) {
  (void)state;
  static double          jacobian[3 * NF * COLUMNS];
  mhb_contact_evaluator *contact = workspace_of(1e-13);
  int                    failed  = 0;
  for (int i = 0; i < suite_size(); i++) {
    suite_motion s = suite_at(i);
    answer       a;
    double       norm = 0, off = 0, doubt = 0;
    if (s.room == 0) continue;
    evaluate(contact, &s, jacobian, &a);
    for (int j = 0; j < COLUMNS; j++) {
      double wanted[3 * NF], spread;
      difference(contact, &s, j, s.room / 4, wanted, &spread);
      doubt = fmax(doubt, spread);
      for (int r = 0; r < 3 * NF; r++) {
        double e = fabs(wanted[r] - jacobian[r * COLUMNS + j]);
        norm     = fmax(norm, fabs(wanted[r]));
        if (!(e <= off)) off = e;
      }
    }
    if (off <= 1e-7 * norm) continue;
    print_message("%s: %.1e of the norm (differences good to %.1e)\n", s.name, off / norm,
                  doubt / norm);
    failed++;
  }
  mhb_contact_evaluator_destroy(contact);
  assert_int_equal(failed, 0);
}

/* Largest entry; NAN if one is not finite. */
static double largest_entry(const double *jacobian) {
  double top = 0;
  for (int j = 0; j < 3 * NF * COLUMNS; j++) {
    if (!isfinite(jacobian[j])) return NAN;
    top = fmax(top, fabs(jacobian[j]));
  }
  return top;
}

static suite_motion scaled(int i, double factor) {
  suite_motion s = suite_at(i);
  for (int j = 0; j < COLUMNS; j++) (&s.motion[0][0])[j] *= factor;
  return s;
}

/* Amplitude at which slip begins, to rounding. */
static double onset_of(mhb_contact_evaluator *contact, int i) {
  double low = .01, high = 1;
  answer a;
  while (high - low > 1e-16 * high) {
    double mid = .5 * (low + high);
    if (mid <= low || mid >= high) break;
    suite_motion s = scaled(i, mid);
    evaluate(contact, &s, NULL, &a);
    if (a.info.share[MHB_SLIDE] > 0) {
      high = mid;
    } else {
      low = mid;
    }
  }
  return high;
}

/* Columns that the motion of fewer harmonics has too. */
static void derivative_is_that_of_fewer_harmonics(void **state) {
  (void)state;
  static double    all[3 * NF * COLUMNS], few[3 * NF * COLUMNS];
  double           force[3 * NF], worst = 0, norm = 0;
  mhb_contact_info info;
  suite_motion     s = suite_at(2);
  for (int m = M; m >= 1; m--) {
    int                    nb = 2 * m + 1;
    double                 motion[COLUMNS];
    mhb_contact_evaluator *contact;
    assert_int_equal(mhb_contact_evaluator_create(m, H, 1e-8, &contact), SHB_OK);
    for (int i = 0; i < 3; i++) {
      memcpy(motion + i * nb, s.motion[i], sizeof(double) * (size_t)nb);
      for (int k = nb; k < NB; k++) assert_true(s.motion[i][k] == 0);
    }
    mhb_contact_force(contact, &s.law, motion, force, m == M ? all : few, &info);
    for (int r = 0; r < 3 * NF && m < M; r++)
      for (int i = 0; i < 3; i++)
        for (int k = 0; k < nb; k++) {
          double wanted = all[r * COLUMNS + i * NB + k];
          norm          = fmax(norm, fabs(wanted));
          worst         = fmax(worst, fabs(few[r * 3 * nb + i * nb + k] - wanted));
        }
    mhb_contact_evaluator_destroy(contact);
  }
  print_message("columns differ by %.1e of the largest\n", worst / norm);
  assert_true(worst <= 1e-12 * norm);
}

/* Where slip begins under a varying load, the mean friction goes like the square root of the
 * distance, and its derivative is unbounded. The law bounds it by 3e8 times the stiffness, on both
 * sides and at any distance: the determinants are held above 1e-7 and 1e-8. The force is continuous
 * up to its estimated error. */
static void derivative_is_capped_where_slip_begins(void **state) {
  (void)state;
  static double          jacobian[3 * NF * COLUMNS];
  static const int       motion[] = {16, 10, 9};
  mhb_contact_evaluator *contact  = workspace_of(1e-12);
  int                    failed   = 0;
  for (int i = 0; i < 3; i++) {
    double onset = onset_of(contact, motion[i]), highest = 0;
    for (double d = 1e-1; d > 1e-16; d *= .1) {
      suite_motion under = scaled(motion[i], onset * (1 - d)),
                   over  = scaled(motion[i], onset * (1 + d));
      answer a, b;
      double stiff = under.law.ku[0] + under.law.ku[2];
      evaluate(contact, &under, jacobian, &a);
      double slope_a = largest_entry(jacobian) / stiff;
      evaluate(contact, &over, jacobian, &b);
      double slope_b = largest_entry(jacobian) / stiff;
      highest        = fmax(highest, fmax(slope_a, slope_b));
      if (!(slope_a < 3e8 && slope_b < 3e8))
        fail_msg("%s: %.1e, %.1e", under.name, slope_a, slope_b);
      double jump  = apart(a.force, b.force) / largest(b.force);
      double doubt = a.info.error + b.info.error;
      if (jump < 3 * sqrt(d) + 10 * doubt + 1e-8) continue;
      print_message("%s: %.1e across %.0e, estimate %.1e\n", under.name, jump, 2 * d, doubt);
      failed++;
    }
    assert_true(highest > 100); /* it is a square root */
  }
  mhb_contact_evaluator_destroy(contact);
  assert_int_equal(failed, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tolerance_is_met),
      cmocka_unit_test(estimate_is_honest),
      cmocka_unit_test(work_and_states_agree),
      cmocka_unit_test(mirrored_motion_mirrors_the_force),
      cmocka_unit_test(shifted_motion_shifts_the_force),
      cmocka_unit_test(units_do_not_matter),
      cmocka_unit_test(turned_axes_turn_the_force),
      cmocka_unit_test(derivative_is_exact),
      cmocka_unit_test(derivative_is_that_of_fewer_harmonics),
      cmocka_unit_test(derivative_is_capped_where_slip_begins),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
