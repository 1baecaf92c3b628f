/* Curves beside the main one: doubled periods, search, and none where there is none. */
#include <complex.h>
#include <math.h>
#include <omp.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "mhb/branches/secondary_branches.h"
#include "tests/support/check.h"
#include "tests/support/main_curve.h"
#include "tests/support/quiet_monitor.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

static mhb_settings settings(double mu, double kv, double n0, int harmonics, double from,
                             double to) {
  mhb_settings s = ground_settings(mu, kv, 0.5, n0, harmonics);
  s.frequency[0] = from / SHB_TWO_PI;
  s.frequency[1] = to / SHB_TWO_PI;
  s.max_points   = 3000;
  s.search       = (mhb_search_settings){.n_orders = 3, .order = {1, 2, 3}};
  return s;
}

static mhb_response *sweep(const modal_model *model, const mhb_settings *s) {
  mhb_response *r = NULL;
  if (mhb_forced_response(model, s, NULL, NULL, NULL, &r) != SHB_OK) fail_msg("%s", shb_message());
  return r;
}

/* ---- a mass on a spring against a second one, integrated without code of the program ---- */

typedef struct {
  double zeta, kv, n0, force, omega;
} oscillator;

static void rate(const oscillator *o, double t, const double y[2], double dy[2]) {
  double n = fmax(o->n0 + o->kv * y[0], 0) - fmax(o->n0, 0);
  dy[0]    = y[1];
  dy[1]    = o->force * cos(o->omega * t) - 2 * o->zeta * y[1] - y[0] - n;
}

static void runge_kutta(const oscillator *o, double t, double h, double y[2]) {
  double k[4][2], at[2];
  rate(o, t, y, k[0]);
  for (int s = 1; s < 4; s++) {
    double part = s < 3 ? 0.5 * h : h;
    for (int i = 0; i < 2; i++) at[i] = y[i] + part * k[s - 1][i];
    rate(o, t + part, at, k[s]);
  }
  for (int i = 0; i < 2; i++) y[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
}

/* Amplitudes of harmonics 1 and 2 of omega/2 that the motion from y settles on. */
static void settled(const oscillator *o, double y[2], double amplitude[2]) {
  enum { STEPS = 8000, PERIODS = 400 };
  double         h      = 4 * SHB_PI / o->omega / STEPS;
  double complex sum[2] = {0, 0};
  for (int p = 0; p <= PERIODS; p++)
    for (int i = 0; i < STEPS; i++) {
      for (int k = 0; p == PERIODS && k < 2; k++)
        sum[k] += y[0] * cexp(-I * (k + 1) * 0.5 * o->omega * i * h) * 2 / STEPS;
      runge_kutta(o, i * h, h, y);
    }
  for (int k = 0; k < 2; k++) amplitude[k] = cabs(sum[k]);
}

/* The stable point of the branch nearest to omega. */
static int stable_near(const mhb_branch *b, double omega) {
  int best = -1;
  for (int i = 0; i < b->n_points; i++)
    if (b->stable[i] == 1 && (best < 0 || fabs(SHB_TWO_PI * b->frequency[i] - omega) <
                                              fabs(SHB_TWO_PI * b->frequency[best] - omega)))
      best = i;
  return best;
}

/* At phase 0. */
static void state_of(const mhb_branch *b, int i, double y[2]) {
  const double complex *a = b->motion + (size_t)(i * 3 * (b->n_harmonics + 1));
  y[0] = y[1] = 0;
  for (int k = 0; k <= b->n_harmonics; k++) {
    y[0] += creal(a[k]);
    y[1] -= k * SHB_PI * b->frequency[i] * cimag(a[k]);
  }
}

static int count(const mhb_branch *b, int special) {
  int n = 0;
  for (int i = 0; i < b->n_points; i++) n += b->special[i] == special;
  return n;
}

/* The branch leaves at one flip and comes back at the other. Its stable part is where time
 * integration settles. */
static void doubled_periods(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = settings(0, 9, -1, 16, 2, 3.4);
  one_degree_model(0.02, 0, 1, &model);
  mhb_response *r = sweep(&model, &s);
  assert_int_equal(r->n_branches, 3); /* marked only */
  mhb_response_destroy(r);
  s.flips = true;
  r       = sweep(&model, &s);
  assert_int_equal(r->n_branches, 4);
  const mhb_branch *main = &r->branch[2], *b = &r->branch[3];
  assert_int_equal(count(main, MHB_FLIP), 2);
  assert_true(b->origin == MHB_FROM_FLIP && b->order == 2 && b->n_harmonics == 32 && b->main == 2);
  assert_true(b->complete && main->searched);
  assert_string_equal(b->reason, "joins a curve of lower order");
  double flip[2] = {0, 0};
  for (int i = 0, k = 0; i < main->n_points; i++)
    if (main->special[i] == MHB_FLIP) flip[k++] = main->frequency[i];
  print_message("flips at %.6f, %.6f; the branch from %.6f to %.6f\n", SHB_TWO_PI * flip[0],
                SHB_TWO_PI * flip[1], SHB_TWO_PI * b->frequency[0],
                SHB_TWO_PI * b->frequency[b->n_points - 1]);
  assert_true(b->frequency[0] == flip[0]);
  assert_below(fabs(b->frequency[b->n_points - 1] / flip[1] - 1), 1e-4);
  static const double at[] = {2.3, 2.7, 2.9};
  for (int k = 0; k < 3; k++) {
    int    i = stable_near(b, at[k]), K = b->n_harmonics + 1;
    double y[2], a[2];
    state_of(b, i, y);
    y[0] *= 1 + 1e-3; /* forgotten, since it is stable */
    oscillator o = {0.02, 9, -1, 1, SHB_TWO_PI * b->frequency[i]};
    settled(&o, y, a);
    const double complex *u = b->motion + (size_t)(i * 3 * K);
    print_message("W %.4f: half order %.6f (%.6f), first %.6f (%.6f)\n", o.omega, cabs(u[1]), a[0],
                  cabs(u[2]), a[1]);
    assert_true(a[0] > 0.1);
    assert_below(fabs(cabs(u[1]) - a[0]), 3e-4 * a[0]);
    assert_below(fabs(cabs(u[2]) - a[1]), 3e-4 * a[0]);
  }
  mhb_response_destroy(r);
  modal_model_free(&model);
}

/* A response has room for 24 curves beside the main one. */
static void flips_left_out_are_counted(void **state) {
  (void)state;
  modal_model   model;
  mhb_settings  s     = settings(0, 9, -1, 16, 2, 3.4);
  quiet_monitor quiet = due_monitor_create();
  mhb_response *r;
  one_degree_model(0.02, 0, 1, &model);
  s.flips = true;
  assert_int_equal(main_curve(&model, &s, 16, NULL, &r), SHB_OK);
  assert_int_equal(count(&r->branch[0], MHB_FLIP), 2);
  while (r->n_branches <= 24) mhb_response_branch(r, MHB_BRANCH_NONLINEAR);
  assert_int_equal(mhb_secondary_branches(&model, &s, r, &quiet.base), SHB_OK);
  assert_int_equal(r->n_branches, 25);
  assert_int_equal(r->branch[0].flips_untraced, 2);
  mhb_response_destroy(r);
  modal_model_free(&model);
}

/* Friction and separation of three degrees of freedom: one curve a preload, however long the search
 * is. */
static void nothing_where_nothing_is(void **state) {
  (void)state;
  static const double n0[] = {-0.2, 0, 0.3, 1};
  modal_model         model;
  mhb_settings        s = settings(0.4, 0.8, 0, 5, 0.8, 1.7);
  three_degree_model(&model);
  s.n_preloads = 4;
  memcpy(s.n0, n0, sizeof n0);
  double        before = shb_seconds();
  mhb_response *plain  = sweep(&model, &s);
  double        middle = shb_seconds();
  s.search.starts      = 10;
  s.flips              = true;
  mhb_response *r      = sweep(&model, &s);
  print_message("%.2f s, with the search %.2f s\n", middle - before, shb_seconds() - middle);
  assert_int_equal(r->n_branches, 6);
  for (int b = 2; b < 6; b++) {
    const mhb_branch *one = &plain->branch[b], *two = &r->branch[b];
    assert_true(two->searched && two->main == b);
    assert_int_equal(one->n_points, two->n_points);
    assert_memory_equal(one->frequency, two->frequency, sizeof(double) * (size_t)one->n_points);
  }
  mhb_response_destroy(plain);
  mhb_response_destroy(r);
  modal_model_free(&model);
}

/* Three preloads with isolas and doubled periods beside them. */
static mhb_settings rich(void) {
  mhb_settings s  = settings(0, 9, 0, 6, 2, 3.9);
  s.n_preloads    = 3;
  s.n0[0]         = -4.5;
  s.n0[1]         = -1;
  s.n0[2]         = -4.2;
  s.flips         = true;
  s.search.starts = 12;
  s.search.n_at   = 2;
  s.search.at[0]  = 2.5 / SHB_TWO_PI;
  s.search.at[1]  = 3.6 / SHB_TWO_PI;
  return s;
}

static void assert_same(const mhb_response *a, const mhb_response *b) {
  assert_int_equal(a->n_branches, b->n_branches);
  for (int i = 0; i < a->n_branches; i++) {
    const mhb_branch *p = &a->branch[i], *q = &b->branch[i];
    size_t            n = (size_t)p->n_points, K = (size_t)p->n_harmonics + 1;
    assert_int_equal(p->n_points, q->n_points);
    assert_true(p->order == q->order && p->origin == q->origin && p->main == q->main &&
                p->n_harmonics == q->n_harmonics && p->complete == q->complete &&
                p->searched == q->searched);
    assert_string_equal(p->reason, q->reason);
    assert_memory_equal(p->frequency, q->frequency, n * sizeof(double));
    assert_memory_equal(p->motion, q->motion, n * 3 * K * sizeof(double complex));
    assert_memory_equal(p->special, q->special, n * sizeof(int));
    assert_memory_equal(p->stable, q->stable, n * sizeof(int));
  }
}

static void threads_and_files_do_not_matter(void **state) {
  (void)state;
  modal_model    model;
  mhb_settings   s          = rich();
  mhb_response  *r[4]       = {NULL};
  shb_provenance provenance = {.settings = "these"};
  char           path[64];
  int            before = omp_get_max_threads(), further[3] = {0};
  snprintf(path, sizeof path, "further_%d.response.h5", (int)getpid());
  one_degree_model(0.02, 0, 0.5, &model);
  for (int i = 0; i < 2; i++) {
    omp_set_num_threads(i + 1);
    assert_int_equal(mhb_forced_response(&model, &s, i ? path : NULL, &provenance, NULL, &r[i]),
                     SHB_OK);
  }
  omp_set_num_threads(before);
  assert_same(r[0], r[1]);
  for (int i = 5; i < r[0]->n_branches; i++) {
    further[r[0]->branch[i].main - 2]++;
    assert_true(i == 5 || r[0]->branch[i].main >= r[0]->branch[i - 1].main);
  }
  assert_true(further[0] >= 2 && further[1] >= 1 && further[2] >= 2);
  assert_int_equal(mhb_response_read(path, &r[2]), SHB_OK);
  assert_same(r[0], r[2]);
  s.resume = true; /* all is there */
  assert_int_equal(mhb_forced_response(&model, &s, path, &provenance, NULL, &r[3]), SHB_OK);
  assert_same(r[0], r[3]);
  remove(path);
  for (int i = 0; i < 4; i++) mhb_response_destroy(r[i]);
  modal_model_free(&model);
}

/* An interrupted run left the main branch without those beside it: only these are computed. */
static void a_search_is_resumed(void **state) {
  (void)state;
  modal_model    model;
  mhb_settings   s          = rich();
  mhb_response  *r[2]       = {NULL};
  shb_provenance provenance = {.settings = "these"};
  char           path[64];
  snprintf(path, sizeof path, "resumed_%d.response.h5", (int)getpid());
  one_degree_model(0.02, 0, 0.5, &model);
  s.n_preloads = 1;
  assert_int_equal(mhb_forced_response(&model, &s, path, &provenance, NULL, &r[0]), SHB_OK);
  assert_true(r[0]->n_branches > 4);
  r[0]->branch[2].searched = false; /* as if interrupted after the first one found */
  int all                  = r[0]->n_branches;
  r[0]->n_branches         = 4;
  assert_int_equal(mhb_response_write(r[0], path, &provenance), SHB_OK);
  r[0]->branch[2].searched = true;
  r[0]->n_branches         = all;
  s.resume                 = true;
  assert_int_equal(mhb_forced_response(&model, &s, path, &provenance, NULL, &r[1]), SHB_OK);
  assert_same(r[0], r[1]);
  assert_memory_equal(r[0]->branch[2].seconds, r[1]->branch[2].seconds,
                      sizeof(double) * (size_t)r[0]->branch[2].n_points); /* not computed again */
  remove(path);
  for (int i = 0; i < 2; i++) mhb_response_destroy(r[i]);
  modal_model_free(&model);
}

/* A signal during the search: the main branch is complete, and marked as not searched. */
static int interrupted(const char *path) {
  modal_model    model;
  mhb_settings   s          = rich();
  mhb_response  *r          = NULL, *back;
  shb_provenance provenance = {.settings = "these"};
  one_degree_model(0.02, 0, 0.5, &model);
  s.n_preloads    = 1;
  s.search.starts = 100000;
  shb_interrupt_catch();
  struct sigaction kept;
  if (sigaction(SIGTERM, NULL, &kept) != 0 || sigaction(SIGALRM, &kept, NULL) != 0) return 1;
  alarm(1);
  if (mhb_forced_response(&model, &s, path, &provenance, NULL, &r) != SHB_INTERRUPTED) return 2;
  if (mhb_response_read(path, &back) != SHB_OK) return 3;
  if (!back->branch[2].complete || back->branch[2].searched) return 4;
  return 0;
}

static void an_interrupted_search_is_told(void **state) {
  (void)state;
  char path[64];
  int  status;
  snprintf(path, sizeof path, "stopped_%d.response.h5", (int)getpid());
  fflush(NULL);
  pid_t child = fork();
  if (child == 0) _exit(interrupted(path));
  assert_int_equal(waitpid(child, &status, 0), child);
  remove(path);
  assert_true(WIFEXITED(status));
  assert_int_equal(WEXITSTATUS(status), 0);
}

/* ---- publication ---- */

/* The main curve is in the file while others are searched for, at each start and at each point. */
static void curves_are_published_during_a_search(void **state) {
  (void)state;
  modal_model model;
  three_degree_model(&model);
  mhb_settings  s = settings(.4, .8, .3, 3, 1.2, 1.5);
  mhb_response *r;
  quiet_monitor due = due_monitor_create();
  s.search.starts   = 4;
  assert_int_equal(main_curve(&model, &s, 3, NULL, &r), SHB_OK);
  assert_int_equal(mhb_secondary_branches(&model, &s, r, &due.base), SHB_OK);
  assert_true(due.n_published >= 4 * 3 * 6); /* starts, orders, places */
  assert_int_equal(due.fewest, r->branch[0].n_points);
  mhb_response_destroy(r);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(an_interrupted_search_is_told), /* first: no thread of OpenMP is there yet */
      cmocka_unit_test(doubled_periods),
      cmocka_unit_test(flips_left_out_are_counted),
      cmocka_unit_test(nothing_where_nothing_is),
      cmocka_unit_test(threads_and_files_do_not_matter),
      cmocka_unit_test(a_search_is_resumed),
      cmocka_unit_test(curves_are_published_during_a_search),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
