/* What the harmonics chosen at each point are worth: the error that a point tells, beside its true
 * one, over random cases.
 *
 *   bench_harmonics            200 cases
 *   bench_harmonics --quick    12 of them
 *   bench_harmonics FIRST N    N cases from one on, a line each
 *
 * A curve has 300 points at most. Gaps, low and high preloads, soft and stiff contacts, narrow and
 * wide ranges, three tolerances.
 *
 * The true error is the distance to the solution of 63 harmonics at the same frequency. It is found
 * by Newton's method from the point. A point without such a solution near by is one of no motion,
 * unless the curve of 63 harmonics passes near it (beside a fold). Exit code 1: a point that is not
 * marked is farther off than three times what it tells, or is no motion. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/clock.h"
#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "mhb/continuation/nearest_solution.h"
#include "mhb/numerics/fourier.h"
#include "tests/support/random_model.h"

enum { CASES = 200, FEW = 12, EXACT = 63, LOOKED_AT = 12, MOST_POINTS = 300, CLASSES = 4 };

/* Errors of Newton's method and of 63 harmonics themselves. */
static const double FLOOR = 1e-7;

static const char *const class_name[CLASSES] = {"gap", "low preload", "medium preload",
                                                "high preload"};

typedef struct {
  modal_model  model;
  mhb_settings settings;
  int class;
} random_case;

/* Of one case, or of a class of them. */
typedef struct {
  int    cases, points, marked, looked_at; /* looked_at: of the points that are not marked */
  int    beyond;                           /* farther off than three times what they tell */
  int    lost;                             /* no motion */
  int    beside_fold; /* no solution at their frequency, but the curve is near */
  int    incomplete;  /* cases */
  double worst;       /* true error over told one */
  double largest;     /* true error over the tolerance */
  double seconds;
} tally;

static double between(unsigned long long *seed, double low, double high) {
  return low + (high - low) * 0.5 * (random_unit(seed) + 1);
}

static double preload(unsigned long long *seed, int class) {
  static const double range[CLASSES][2] = {{-0.6, -0.02}, {0, 0.05}, {0.05, 0.6}, {0.6, 4}};
  return between(seed, range[class][0], range[class][1]);
}

static void make_case(int index, random_case *c) {
  static const double tolerance[] = {1e-2, 1e-3, 1e-4};
  unsigned long long  seed        = (unsigned long long)(index + 1) * 0x9E3779B97F4A7C15ULL;
  for (int i = 0; i < 8; i++) random_unit(&seed);
  random_model(index % 7 == 3 ? 2 : 1, WITH_LEFT | WITH_RESIDUAL, 77 + (unsigned)index, &c->model);
  modal_model  *model = &c->model;
  mhb_settings *s     = &c->settings;
  const double  light = pow(10, between(&seed, -1, 0));
  for (int i = 0; i < model->n_modes; i++) model->damping_ratio[i] *= light;
  model->n_load       = index % 5 ? 1 : 2;
  *s                  = random_settings(1);
  c->class            = index % CLASSES;
  s->n0[0]            = preload(&seed, c->class);
  s->kv               = pow(10, between(&seed, -1, 2));
  s->ku[0]            = s->kv * between(&seed, 0.3, 1);
  s->ku[2]            = s->kv * between(&seed, 0.3, 1);
  s->ku[1]            = 0.2 * sqrt(s->ku[0] * s->ku[2]);
  s->mu               = between(&seed, 0.1, 0.6);
  s->preload          = index % 3 ? MHB_EQUILIBRIUM : MHB_INTERFERENCE;
  s->scale            = pow(10, between(&seed, -0.5, 0.7));
  s->tolerance        = 1e-8;
  s->motion_tolerance = tolerance[index / CLASSES % 3];
  s->stability        = MHB_STABILITY_NEVER;
  s->max_points       = MOST_POINTS;
  const double middle = between(&seed, 0.8, 2.4), half = index % 2 ? 0.01 * middle : 0.5;
  s->frequency[0] = fmax(0.4, middle - half) / SHB_TWO_PI;
  s->frequency[1] = (middle + half) / SHB_TWO_PI;
}

/* ---- the true error of a point ---- */

typedef struct {
  mhb_balance *balance; /* of 63 harmonics */
  mhb_newton  *newton;
  double      *x, *fine, *normal; /* [n], [n], [n + 1] */
} exact;

static shb_status exact_create(const random_case *c, exact *e) {
  mhb_settings *s     = calloc(1, sizeof *s);
  *s                  = c->settings;
  s->harmonics        = EXACT;
  s->motion_tolerance = 0;
  SHB_TRY(mhb_balance_create(&c->model, s, &e->balance));
  mhb_balance_set_preload(e->balance, s->n0[0]);
  e->newton      = mhb_newton_create(e->balance->n);
  const size_t n = (size_t)e->balance->n + 1;
  e->x           = calloc(3 * n, sizeof(double));
  e->fine        = e->x + n;
  e->normal      = e->fine + n;
  return SHB_OK;
}

static void exact_destroy(exact *e) {
  free((void *)e->balance->settings);
  mhb_newton_destroy(e->newton);
  mhb_balance_destroy(e->balance);
  free(e->x);
}

static void motion_at(const exact *e, const mhb_branch *b, int p, double *x) {
  const int rows = 3 * e->balance->n_pairs, K = b->n_harmonics + 1, nb = e->balance->nb;
  double    own[mhb_real_size(b->n_harmonics)];
  memset(x, 0, sizeof *x * (size_t)e->balance->n);
  for (int row = 0; row < rows; row++) {
    mhb_to_real(K - 1, b->motion + ((size_t)p * (size_t)rows + (size_t)row) * (size_t)K, own);
    memcpy(x + (size_t)row * (size_t)nb, own, sizeof own);
  }
}

static double distance(const exact *e) {
  double sum = 0;
  for (int i = 0; i < e->balance->n; i++) sum += pow(e->x[i] - e->fine[i], 2);
  return sqrt(sum) / mhb_balance_vibration(e->balance, e->fine);
}

/* e->normal <- along the curve at point p. */
static bool along(const exact *e, const mhb_branch *b, int p) {
  const int n = e->balance->n, a = p > 0 ? p - 1 : 0, z = p + 1 < b->n_points ? p + 1 : p;
  motion_at(e, b, a, e->fine);
  motion_at(e, b, z, e->normal);
  const double size = mhb_norm(e->x, n);
  double       sum  = 0;
  e->normal[n]      = (b->frequency[z] - b->frequency[a]) / b->frequency[p];
  for (int i = 0; i < n; i++) e->normal[i] = (e->normal[i] - e->fine[i]) / size;
  for (int i = 0; i <= n; i++) sum += e->normal[i] * e->normal[i];
  for (int i = 0; i <= n; i++) e->normal[i] /= sqrt(sum);
  return sum > 0;
}

/* Whether the curve of 63 harmonics passes within a tenth of the tolerance of the frequency, and
 * three tolerances of the motion. */
static bool passes_near(exact *e, const mhb_branch *b, int p, double tolerance) {
  double omega = SHB_TWO_PI * b->frequency[p];
  motion_at(e, b, p, e->x);
  if (!along(e, b, p)) return false;
  memcpy(e->fine, e->x, sizeof(double) * (size_t)e->balance->n);
  if (!mhb_nearest_solution(e->newton, e->balance, e->normal, mhb_norm(e->x, e->balance->n), omega,
                            1e-9, e->fine, &omega))
    return false;
  return distance(e) <= 3 * tolerance &&
         fabs(omega / (SHB_TWO_PI * b->frequency[p]) - 1) <= 0.1 * tolerance;
}

static void look_at(exact *e, const mhb_branch *b, int p, const mhb_settings *s, bool tells,
                    tally *t) {
  int          iterations;
  const double told = b->error_truncation[p] + b->error_newton[p] + b->error_sampling[p] + FLOOR;
  motion_at(e, b, p, e->x);
  memcpy(e->fine, e->x, sizeof(double) * (size_t)e->balance->n);
  mhb_reason   reason = mhb_newton_solve(e->newton, e->balance, SHB_TWO_PI * b->frequency[p], 1e-10,
                                         e->fine, &iterations);
  const double error  = reason == MHB_CONVERGED ? distance(e) : INFINITY;
  t->looked_at++;
  if (error <= 3 * told) {
    t->worst   = fmax(t->worst, error / told);
    t->largest = fmax(t->largest, error / s->motion_tolerance);
    return;
  }
  const bool near = passes_near(e, b, p, s->motion_tolerance);
  t->beside_fold += near;
  t->lost += !near && !(error < 0.3);
  t->beyond += !near && error < 0.3;
  if (tells && !near)
    printf("  case point %d: %.6g Hz, %d harmonics, told %.2e, true %.2e\n", p, b->frequency[p],
           b->harmonics[p], told, error);
}

/* ---- a case ---- */

static void judge(const random_case *c, const mhb_response *r, bool tells, tally *t) {
  exact e;
  int   total = 0, seen = 0;
  if (exact_create(c, &e) != SHB_OK) exit(4);
  for (int i = 2; i < r->n_branches; i++) total += r->branch[i].n_points;
  const int every = total > LOOKED_AT ? total / LOOKED_AT : 1;
  for (int i = 2; i < r->n_branches; i++) {
    const mhb_branch *b = &r->branch[i];
    for (int p = 0; p < b->n_points; p++, seen++) {
      const bool marked = b->mark[p] & MHB_ABOVE_TOLERANCE;
      t->points++;
      t->marked += marked;
      if (tells && marked)
        printf("  marked point %d: %.6g Hz, %d harmonics, told %.2e, special %d\n", p,
               b->frequency[p], b->harmonics[p], b->error_truncation[p], b->special[p]);
      const bool looks = seen % every == 0 || b->special[p] == MHB_PEAK;
      if (looks && !marked) look_at(&e, b, p, &c->settings, tells, t);
    }
  }
  exact_destroy(&e);
}

static void run(int index, bool tells, tally *of_class) {
  random_case   c;
  tally         t = {.cases = 1};
  mhb_response *r = NULL;
  make_case(index, &c);
  const double     started = shb_processor_seconds();
  const shb_status status  = mhb_forced_response(&c.model, &c.settings, NULL, NULL, NULL, &r);
  t.seconds                = shb_processor_seconds() - started;
  if (!r) exit(4);
  t.incomplete = status != SHB_OK;
  judge(&c, r, tells, &t);
  if (tells)
    printf(
        "%3d %-14s n0 %7.3f kv %7.2f tolerance %.0e: %3d points, %d marked, %d looked at, %d "
        "beyond, %d lost, %d beside a fold, worst %.2f, %.2f s%s\n",
        index, class_name[c.class], c.settings.n0[0], c.settings.kv, c.settings.motion_tolerance,
        t.points, t.marked, t.looked_at, t.beyond, t.lost, t.beside_fold, t.worst, t.seconds,
        t.incomplete ? shb_message() : "");
  of_class += c.class;
  of_class->cases++;
  of_class->points += t.points;
  of_class->marked += t.marked;
  of_class->looked_at += t.looked_at;
  of_class->beyond += t.beyond;
  of_class->lost += t.lost;
  of_class->beside_fold += t.beside_fold;
  of_class->incomplete += t.incomplete;
  of_class->worst   = fmax(of_class->worst, t.worst);
  of_class->largest = fmax(of_class->largest, t.largest);
  of_class->seconds += t.seconds;
  fflush(stdout);
  mhb_response_destroy(r);
  modal_model_free(&c.model);
}

int main(int argc, char **argv) {
  const bool quick = argc == 2 && strcmp(argv[1], "--quick") == 0, some = argc == 3;
  const int  first = some ? atoi(argv[1]) : 0, n = some ? atoi(argv[2]) : quick ? FEW : CASES;
  tally      t[CLASSES] = {{0}};
  int        bad        = 0;
  for (int i = first; i < first + n; i++) run(i, some, t);
  puts(
      "| cases | | points | marked | looked at | beyond 3 told | no motion | beside a fold | worst "
      "over told | worst over tolerance | not whole | CPU s "
      "|\n|---|---|---|---|---|---|---|---|---|"
      "---|---|---|");
  for (int k = 0; k < CLASSES; k++) {
    printf("| %s | %d | %d | %d | %d | %d | %d | %d | %.2f | %.2f | %d | %.1f |\n", class_name[k],
           t[k].cases, t[k].points, t[k].marked, t[k].looked_at, t[k].beyond, t[k].lost,
           t[k].beside_fold, t[k].worst, t[k].largest, t[k].incomplete, t[k].seconds);
    bad += t[k].beyond + t[k].lost;
  }
  return bad > 0;
}
