/* Harmonic balance against time integration: seconds per point for an error, both at their best.
 *
 *   bench_integrate            the tables
 *   bench_integrate --quick    errors only, on few frequencies
 *   bench_integrate --blade FILE N0 FROM TO   the same with a modal file: contact of
 *                              cases/paper_fig7, preload N, range Hz
 *
 * Scenes: the three-degree model and the tip-contact beam (tests/support/three_degree.h). All
 * frequencies have one stable solution. A point of the balance is solved from the solution at 0.2 %
 * of the frequency away, as in continuation. A point of the integration starts from the state there
 * (a sweep) or from rest. It ends when the return map is within a tenth of the error wanted. Error:
 * of the first harmonics of the contact, relative, largest of all frequencies, against integration
 * with many steps. The exit code depends on errors only, because times depend on the machine. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/progress.h"
#include "mhb/branches/main_branch.h"
#include "mhb/continuation/first_solution.h"
#include "mhb/integration/inertia_modes.h"
#include "mhb/integration/steady_state.h"
#include "tests/support/three_degree.h"

static const double AWAY = .998;

enum { MAX_POINTS = 24, FINE_STEPS = 384 };

typedef struct {
  const char    *name;
  modal_model    model;
  mhb_settings   settings;
  int            n;
  double         w[MAX_POINTS];        /* rad/s */
  double complex exact[MAX_POINTS][3]; /* first harmonics of v, u, w */
} scene;

/* What a setting gives: worst error, median of the seconds a point. */
typedef struct {
  double error, seconds;
} row;

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double error_of(const scene *s, int i, const double complex u[3]) {
  double apart = 0, size = 0;
  for (int c = 0; c < 3; c++) {
    apart += pow(cabs(u[c] - s->exact[i][c]), 2);
    size += pow(cabs(s->exact[i][c]), 2);
  }
  return sqrt(apart / size);
}

static row finish(int n, double *seconds, double worst) {
  qsort(seconds, (size_t)n, sizeof *seconds, ascending);
  return (row){worst, seconds[n / 2]};
}

/* ---- integration ---- */

static void first_harmonics(const mhb_steady_state_result *r, double complex u[3]) {
  for (int c = 0; c < 3; c++) u[c] = r->motion[c * (r->n_harmonics + 1) + 1];
}

/* rest: each point from rest, else from the state at a frequency 0.2 % away. */
static row integrate(const scene *s, int steps, double tolerance, int rest,
                     double complex (*out)[3]) {
  mhb_integrator           *g;
  mhb_steady_state         *orbit;
  mhb_steady_state_settings settings = {tolerance, 100000};
  double                    seconds[MAX_POINTS], worst = 0;
  if (mhb_integrator_create(&s->model, &s->settings, 1, &g) != SHB_OK) return (row){NAN, NAN};
  orbit = mhb_steady_state_create(g);
  for (int i = 0; i < s->n; i++) {
    double complex u[3];
    mhb_integrator_set(g, AWAY * s->w[i], s->settings.n0[0], steps);
    mhb_integrator_rest(g);
    if (!rest) mhb_steady_state_run(orbit, &settings, NULL, NULL);
    double began = shb_seconds();
    mhb_integrator_set(g, s->w[i], s->settings.n0[0], steps);
    if (rest) mhb_integrator_rest(g);
    const mhb_steady_state_result *r = mhb_steady_state_run(orbit, &settings, NULL, NULL);
    seconds[i]                       = shb_seconds() - began;
    first_harmonics(r, out ? out[i] : u);
    if (r->failed || r->multiple != 1) worst = INFINITY;
    if (!out) worst = fmax(worst, error_of(s, i, u));
  }
  mhb_steady_state_destroy(orbit);
  mhb_integrator_destroy(g);
  return finish(s->n, seconds, worst);
}

/* ---- balance ---- */

static row balance(const scene *s, int harmonics, double tolerance) {
  mhb_settings settings = s->settings;
  mhb_balance *b;
  mhb_newton  *newton;
  double       seconds[MAX_POINTS], worst = 0;
  settings.harmonics = harmonics;
  if (mhb_balance_create(&s->model, &settings, &b) != SHB_OK) return (row){NAN, NAN};
  newton = mhb_newton_create(b->n);
  mhb_balance_set_preload(b, settings.n0[0]);
  double *x = calloc((size_t)b->n, sizeof *x);
  for (int i = 0; x && i < s->n; i++) {
    int            iterations;
    double complex u[3];
    mhb_reason     away   = mhb_first_solution(newton, b, AWAY * s->w[i], 1e-8, x, &iterations);
    double         began  = shb_seconds();
    mhb_reason     reason = mhb_newton_solve(newton, b, s->w[i], .01 * tolerance, x, &iterations);
    seconds[i]            = shb_seconds() - began;
    if (away <= 0 || reason <= 0) worst = INFINITY;
    for (int c = 0; c < 3; c++) u[c] = CMPLX(x[c * b->nb + 1], x[c * b->nb + 2]);
    worst = fmax(worst, error_of(s, i, u));
  }
  free(x);
  mhb_newton_destroy(newton);
  mhb_balance_destroy(b);
  return finish(s->n, seconds, worst);
}

/* ---- scenes ---- */

static mhb_settings ground(double mu, double kv, double ku, double n0) {
  return (mhb_settings){.to_ground    = true,
                        .blades       = 1,
                        .mu           = mu,
                        .kv           = kv,
                        .ku           = {ku, 0, ku},
                        .n_preloads   = 1,
                        .n0           = {n0},
                        .harmonics    = 1,
                        .subharmonics = 1,
                        .scale        = 1,
                        .tolerance    = 1e-8};
}

static void spread(scene *s, int n, double from, double to) {
  s->n = n;
  for (int i = 0; i < n; i++) s->w[i] = from + (to - from) * (i + .5) / n;
}

static void three_degrees(scene *s, double n0, int quick) {
  s->name = n0 > 0 ? "three degrees, n0 = .3: stick, slip, separation"
                   : "three degrees, n0 = 0: separation half the time";
  three_degree_model(&s->model);
  s->settings = ground(.4, .8, .5, n0);
  spread(s, quick ? 4 : MAX_POINTS, n0 > 0 ? 1.42 : .9, n0 > 0 ? 1.6 : 1.6);
}

static void beam(scene *s, int quick) {
  s->name = "tip-contact beam, 20 modes, 8 N: stick and slip";
  tip_contact_beam_model(8, &s->model);
  s->settings = ground(.3, 2e5, 2e5, 100);
  spread(s, quick ? 2 : 12, SHB_TWO_PI * 264, SHB_TWO_PI * 272);
}

/* Contact of cases/paper_fig7. Both methods get a structure that can be integrated: residual modes
 * in place of residual inertia. */
static shb_status blade(scene *s, modal_model *read, char **argument) {
  static char name[96];
  SHB_TRY(modal_model_read(argument[0], read));
  SHB_TRY(mhb_inertia_modes(read, &s->model));
  snprintf(name, sizeof name, "blade to the ground, n0 = %s N, %s to %s Hz", argument[1],
           argument[2], argument[3]);
  s->name             = name;
  s->settings         = ground(.3, 5e4, 5e4, atof(argument[1]));
  s->settings.has_psi = true;
  s->settings.psi     = 35 * SHB_PI / 180;
  spread(s, MAX_POINTS, SHB_TWO_PI * atof(argument[2]), SHB_TWO_PI * atof(argument[3]));
  return SHB_OK;
}

/* ---- tables ---- */

static const int harmonics[] = {1, 3, 5, 7, 9, 13, 17, 21, 31},
                 steps[]     = {6, 8, 12, 16, 24, 32, 48, 64};
enum { N_HARMONICS = sizeof harmonics / sizeof *harmonics, N_STEPS = sizeof steps / sizeof *steps };

static void print_rows(const scene *s) {
  printf("%-10s %9s %10s | %-6s %9s %12s %10s\n", "harmonics", "error", "ms, sweep", "steps",
         "error", "ms, sweep", "ms, rest");
  for (int i = 0; i < N_HARMONICS || i < N_STEPS; i++) {
    row b = {0}, t = {0}, r = {0};
    if (i < N_HARMONICS) {
      b = balance(s, harmonics[i], 1e-8);
      printf("%-10d %9.1e %10.3f | ", harmonics[i], b.error, 1e3 * b.seconds);
    }
    if (i < N_STEPS) {
      t = integrate(s, steps[i], 1e-8, 0, NULL);
      r = integrate(s, steps[i], 1e-8, 1, NULL);
      printf("%-6d %9.1e %12.3f %10.3f", steps[i], fmax(t.error, r.error), 1e3 * t.seconds,
             1e3 * r.seconds);
    }
    printf("\n");
    fflush(stdout);
  }
}

/* The fewest harmonics, or steps, that reach an error. 0: none does. */
static int reach_balance(const scene *s, double goal, row *best) {
  for (int i = 0; i < N_HARMONICS; i++) {
    *best = balance(s, harmonics[i], goal);
    if (best->error <= goal) return harmonics[i];
  }
  return 0;
}

static int reach_integration(const scene *s, double goal, row *best) {
  for (int i = 0; i < N_STEPS; i++) {
    *best = integrate(s, steps[i], .1 * goal, 0, NULL);
    if (best->error <= goal) return steps[i];
  }
  return 0;
}

static int print_goals(const scene *s, int quick) {
  int missed = 0;
  printf("to reach        balance                integration (sweep)     ratio\n");
  for (double goal = 1e-2; goal > (quick ? 5e-4 : 5e-5); goal /= 10) {
    row b, t;
    int H = reach_balance(s, goal, &b), N = reach_integration(s, goal, &t);
    printf("%-8.0e", goal);
    printf(H ? "  H = %-2d %10.3f ms" : "  not by H = 31      ", H, 1e3 * b.seconds);
    printf(N ? "    N = %-3d %10.3f ms" : "    not by N = 64      ", N, 1e3 * t.seconds);
    if (H && N) printf("   %8.0f", t.seconds / b.seconds);
    printf("\n");
    missed += !H || !N;
  }
  return missed;
}

static int run(scene *s, int quick) {
  integrate(s, quick ? 96 : FINE_STEPS, 1e-9, 1, s->exact);
  printf("\n%s, %d frequencies\n", s->name, s->n);
  if (!quick) print_rows(s);
  int missed = print_goals(s, quick);
  return missed;
}

static int scenes(int quick) {
  int missed = 0;
  for (int i = 0; i < 3; i++) {
    scene s = {0};
    if (i < 2) three_degrees(&s, i ? 0 : .3, quick);
    if (i == 2) beam(&s, quick);
    missed += run(&s, quick);
    modal_model_free(&s.model);
  }
  return missed;
}

static int blade_scene(char **argument) {
  scene       s    = {0};
  modal_model read = {0};
  int         code = SHB_ERR_INPUT;
  if (blade(&s, &read, argument) == SHB_OK)
    code = run(&s, 0) > 0;
  else
    fprintf(stderr, "bench_integrate: %s\n", shb_message());
  mhb_inertia_free(&s.model);
  modal_model_free(&read);
  return code;
}

int main(int argc, char **argv) {
  if (argc == 6 && strcmp(argv[1], "--blade") == 0) return blade_scene(argv + 2);
  if (argc == 1 || (argc == 2 && strcmp(argv[1], "--quick") == 0)) return scenes(argc == 2) > 0;
  fprintf(stderr, "bench_integrate: usage: bench_integrate [--quick | --blade FILE N0 FROM TO]\n");
  return SHB_ERR_INPUT;
}
