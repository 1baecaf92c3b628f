/* Random laws and motions over the whole range: no NaN, no hang, no friction beyond its limit, no
 * negative dissipation.
 *
 *   SHROUDHB_RANDOM_CASES   number of cases (default 30000, some seconds); a long run by hand:
 *                           SHROUDHB_RANDOM_CASES=1000000 tests/bin/test_mhb_contact_random
 *   SHROUDHB_RANDOM_SEED    another sequence
 *   SHROUDHB_RANDOM_FROM    index to begin at; with CASES=1, one case again
 *
 * Each failure reports its seed and index (random_motion.h). Mild motions are compared with the
 * reference as well. */
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "mesh/base/progress.h"
#include "mhb/contact/contact.h"
#include "mhb/contact/time_history.h"
#include "tests/support/random_motion.h"
#include "tests/support/reference_law.h"

/* Tolerance of the evaluations, and the error of force or work that it permits. */
static const double TOLERANCE = 1e-8;

enum { PHASES = 48, HANG_SECONDS = 120, SHOWN = 8, MILD = 300 };

/* The first ones must not happen, the others rarely. */
typedef enum { FINITE, WITHIN_LIMIT, WORK_GAINED, SHARES, WORK_DIFFERS, LOST, FAULTS } fault;

static const char *const fault_text[FAULTS] = {
    "not finite",          "friction beyond its limit", "work gained",
    "shares not within 1", "loop and slip work differ", "lost (periodicity or a panel)"};

typedef struct {
  unsigned long          seed, first, cases;
  mhb_contact_evaluator *contact[RANDOM_SIZES];
  unsigned long          count[FAULTS], shown[FAULTS][SHOWN];
  double                 worst[FAULTS];
} run;

static unsigned long from_environment(const char *name, unsigned long otherwise) {
  const char *text = getenv(name);
  return text ? strtoul(text, NULL, 10) : otherwise;
}

/* Reports the case at a hang. */
static char current[64];

static void hung(int unused) {
  (void)unused;
  ssize_t done = write(STDERR_FILENO, current, strlen(current));
  (void)done;
  abort();
}

static void blame(run *r, fault what, double size, unsigned long index) {
  if (r->count[what] < SHOWN) r->shown[what][r->count[what]] = index;
  r->count[what]++;
  if (!(size <= r->worst[what])) r->worst[what] = size;
}

/* Largest force and largest work the motion could do: the scales of rounding and tolerance. */
static void scales_of(const random_motion *c, double *force, double *work) {
  int           m = random_size[c->size], width = 2 * m + 1;
  const double *v = c->motion, *u = v + width, *w = u + width, *ku = c->law.ku;
  double        load = fabs(c->law.n0), friction = 0, path = 0;
  for (int i = 0; i < width; i++) {
    load += c->law.kv * fabs(v[i]);
    friction += hypot(ku[0] * u[i] + ku[1] * w[i], ku[1] * u[i] + ku[2] * w[i]);
    path += (i + 1) / 2 * hypot(u[i], w[i]);
  }
  *force = fmax(load, friction);
  *work  = 3.2 * path * *force;
}

static int all_finite(const double *a, size_t n) {
  for (size_t i = 0; i < n; i++)
    if (!isfinite(a[i])) return 0;
  return 1;
}

/* |f| <= mu n at many phases, and no force while open. */
static double beyond_limit(const random_motion *c, mhb_contact_evaluator *contact, double scale) {
  mhb_contact_sample      sample[PHASES];
  static mhb_contact_info info;
  double                  worst = 0;
  for (int i = 0; i < PHASES; i++) sample[i].phase = (i + .37) / PHASES;
  mhb_contact_time_history(contact, &c->law, c->motion, PHASES, sample, &info);
  if (info.lost) return 0; /* counted where the force is evaluated */
  for (int i = 0; i < PHASES; i++) {
    double size = hypot(sample[i].f[0], sample[i].f[1]);
    double room = sample[i].state == MHB_SEPARATE ? 0 : c->law.mu * sample[i].n;
    double over = (size - room) / scale;
    if (!(over <= worst)) worst = over;
  }
  return worst;
}

static void judge(run *r, const random_motion *c) {
  enum { WIDTH = 2 * RANDOM_HARMONICS + 1 };
  static mhb_contact_info info;
  static double           force[3 * WIDTH], jacobian[9 * WIDTH * WIDTH];
  int    m = random_size[c->size], derivative = m < RANDOM_HARMONICS && c->index % 4 == 0;
  size_t width = 2 * (size_t)m + 1;
  double force_scale, work_scale;
  scales_of(c, &force_scale, &work_scale);
  mhb_contact_force(r->contact[c->size], &c->law, c->motion, force, derivative ? jacobian : NULL,
                    &info);
  int finite =
      all_finite(force, 3 * width) && isfinite(info.dissipation + info.slip_work + info.error);
  if (!finite || (derivative && !all_finite(jacobian, 9 * width * width)))
    blame(r, FINITE, NAN, c->index);
  if (info.lost) {
    blame(r, LOST, info.error, c->index);
    return;
  }
  double gained = -fmin(info.dissipation, info.slip_work) / work_scale;
  double apart  = fabs(info.dissipation - info.slip_work) / work_scale;
  double whole  = fabs(info.share[0] + info.share[1] + info.share[2] - 1);
  if (gained > TOLERANCE) blame(r, WORK_GAINED, gained, c->index);
  if (apart > 10 * TOLERANCE) blame(r, WORK_DIFFERS, apart, c->index);
  if (!(whole < 1e-9)) blame(r, SHARES, whole, c->index);
  double over = beyond_limit(c, r->contact[c->size], force_scale);
  if (!(over <= TOLERANCE)) blame(r, WITHIN_LIMIT, over, c->index);
}

static void report(const run *r) {
  print_message("%lu cases, seed %lu, from %lu\n", r->cases, r->seed, r->first);
  for (int i = 0; i < FAULTS; i++) {
    if (!r->count[i]) continue;
    print_message("%8lu %s (worst %.1e), index", r->count[i], fault_text[i], r->worst[i]);
    for (unsigned long k = 0; k < r->count[i] && k < SHOWN; k++)
      print_message(" %lu", r->shown[i][k]);
    print_message("\n");
  }
}

static void whole_range(void **state) {
  (void)state;
  run r = {.seed  = from_environment("SHROUDHB_RANDOM_SEED", 1),
           .first = from_environment("SHROUDHB_RANDOM_FROM", 0),
           .cases = from_environment("SHROUDHB_RANDOM_CASES", 30000)};
  for (int i = 0; i < RANDOM_SIZES; i++)
    assert_int_equal(
        mhb_contact_evaluator_create(random_size[i], random_size[i], TOLERANCE, &r.contact[i]), 0);
  signal(SIGALRM, hung);
  for (unsigned long i = r.first; i < r.first + r.cases; i++) {
    random_motion c = random_motion_of(r.seed, i, 0);
    snprintf(current, sizeof current, "seed %lu, index %lu hangs\n", r.seed, i);
    if (i % 64 == 0 || r.cases < 64) alarm(HANG_SECONDS);
    judge(&r, &c);
  }
  alarm(0);
  for (int i = 0; i < RANDOM_SIZES; i++) mhb_contact_evaluator_destroy(r.contact[i]);
  report(&r);
  for (int i = 0; i < WORK_DIFFERS; i++) assert_int_equal(r.count[i], 0);
  assert_true(r.count[WORK_DIFFERS] <=
              r.cases / 500); /* friction released within 1e-6 rad of an opening */
  assert_true(r.count[LOST] <= r.cases / 1000);
}

/* Moderate ratios against the independent reference, harmonics 0-15. */
static void mild_motions_are_accurate(void **state) {
  (void)state;
  enum { H = 15, WIDTH = 2 * H + 1 };
  static mhb_contact_info info;
  static double           force[3][WIDTH];
  static reference        r;
  mhb_contact_evaluator  *contact[RANDOM_SIZES] = {NULL};
  int                     compared = 0, failed = 0;
  for (int i = 1; i < 3; i++)
    assert_int_equal(mhb_contact_evaluator_create(random_size[i], H, TOLERANCE, &contact[i]), 0);
  for (unsigned long i = 0; i < MILD; i++) {
    random_motion c = random_motion_of(1, i, 1);
    mhb_contact_force(contact[c.size], &c.law, c.motion, &force[0][0], NULL, &info);
    reference_force(&c.law, random_size[c.size], c.motion, H, 20, 1e-16, &r);
    if (r.lost || r.stuck) continue;
    double top = 0, off = 0;
    for (int k = 0; k < 3; k++) {
      for (int j = 0; j < WIDTH; j++) {
        double load = k == 0 && j == 0 ? c.law.mean_offset : 0,
               e    = fabs(force[k][j] - r.force[k][j]);
        top         = fmax(top, fabs(r.force[k][j] + load));
        if (!(e <= off)) off = e;
      }
    }
    compared++;
    if (off <= 10 * TOLERANCE * top && !info.lost) continue;
    print_message("mild, index %lu: error %.1e of the largest, lost %d\n", i, off / top, info.lost);
    failed++;
  }
  for (int i = 1; i < 3; i++) mhb_contact_evaluator_destroy(contact[i]);
  assert_true(compared > MILD / 2);
  assert_int_equal(failed, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(whole_range),
                                     cmocka_unit_test(mild_motions_are_accurate)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
