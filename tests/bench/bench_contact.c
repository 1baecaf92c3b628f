/* Contact law: error against time, beside sampled laws in the same run.
 *
 *   bench_contact [--rounds N] [--svg FILE]     the table; FILE: the work-precision plot
 *   bench_contact --quick                       errors only, in a second or so
 *
 * A row is a motion and a method. It gives the microseconds for the force and for the force with
 * its derivative (medians). It gives the error of the force harmonics 0..H relative to the largest.
 * For the law it gives a verdict: is the error within the tolerance asked for? Medians over the
 * suite and goals follow. The exit code depends on errors only, because times depend on the
 * machine. The reference is tests/support/reference_law.h, which shares no code with the law. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "method.h"
#include "summary.h"
#include "tests/support/reference_law.h"
#include "work_precision.h"

enum { MAX_MOTIONS = 64, MAX_ROUNDS = 10001 };

typedef struct {
  int         quick, rounds;
  const char *svg;
} options;

static int read_options(int argc, char **argv, options *o) {
  *o = (options){.rounds = 101};
  for (int i = 1; i < argc; i++) {
    if (!strcmp(argv[i], "--quick"))
      o->quick = 1;
    else if (!strcmp(argv[i], "--rounds") && i + 1 < argc)
      o->rounds = atoi(argv[++i]);
    else if (!strcmp(argv[i], "--svg") && i + 1 < argc)
      o->svg = argv[++i];
    else
      return 0;
  }
  return o->rounds >= 1 && o->rounds <= MAX_ROUNDS && !(o->quick && o->svg);
}

/* The independent reference, [3][2 METHOD_H + 1]; 0 if it did not converge. */
static int refer(const suite_motion *s, double *force) {
  static reference out;
  reference_force(&s->law, SUITE_HARMONICS, &s->motion[0][0], METHOD_H, 24, 1e-18, &out);
  for (int i = 0; i < 3; i++)
    memcpy(force + i * (2 * METHOD_H + 1), out.force[i], sizeof(double) * (2 * METHOD_H + 1));
  return !out.lost;
}

/* One row; returns 1 if the law missed its tolerance. */
static int row(const suite_motion *s, const method *m, const measurement *v) {
  char us[2][16];
  for (int d = 0; d < 2; d++)
    snprintf(us[d], sizeof us[d], isnan(v->us[d]) ? "-" : "%.1f", v->us[d]);
  int law = m->family == METHOD_LAW, holds = v->error <= m->tolerance;
  printf("%-17s %-20s %2d %4d %9s %9s  %9.1e  %s\n", s->name, m->name, m->H, v->laps, us[0], us[1],
         v->error,
         !law    ? ""
         : holds ? "PASS"
                 : "FAIL");
  return law && !holds;
}

/* Everything about one motion; *failed counts verdicts. */
static shb_status bench_motion(const options *o, int i, method *all, int n,
                               measurement measured[METHOD_MAX], int *failed) {
  suite_motion s = suite_at(i);
  double       exact[3 * (2 * METHOD_H + 1)];
  SHB_CHECK(refer(&s, exact), SHB_NOT_CONVERGED, "%s: the reference did not converge", s.name);
  for (int j = 0; j < n; j++) measured[j] = method_judge(&all[j], &s, exact);
  if (!o->quick) SHB_TRY(methods_time(all, n, &s, o->rounds, measured));
  for (int j = 0; j < n; j++) {
    int told = all[j].family == METHOD_LAW ? all[j].accuracy != NULL : all[j].H == SUITE_HARMONICS;
    int law_missed = all[j].family == METHOD_LAW && !(measured[j].error <= all[j].tolerance);
    if (told || law_missed) *failed += row(&s, &all[j], &measured[j]);
  }
  fflush(stdout);
  return SHB_OK;
}

static shb_status bench(const options *o, method *all, int *n, int *failed) {
  static measurement measured[MAX_MOTIONS][METHOD_MAX];
  static summary     sum[METHOD_MAX];
  int                motions = suite_size();
  SHB_CHECK(motions <= MAX_MOTIONS, SHB_ERR_INPUT, "the suite has more than %d motions",
            MAX_MOTIONS);
  SHB_TRY(methods_create(o->quick, all, n));
  printf("%-17s %-20s %2s %4s %9s %9s  %9s  %s\n", "motion", "method", "H", "laps", "force us",
         "+deriv us", "error", "verdict");
  for (int i = 0; i < motions; i++) SHB_TRY(bench_motion(o, i, all, *n, measured[i], failed));
  for (int j = 0; j < *n; j++) sum[j] = summary_of(motions, measured, j);
  *failed += summary_print(all, sum, *n);
  if (o->svg) SHB_TRY(work_precision_svg(all, sum, *n, motions, o->svg));
  return SHB_OK;
}

int main(int argc, char **argv) {
  static method all[METHOD_MAX];
  options       o;
  int           n = 0, failed = 0;
  if (!read_options(argc, argv, &o)) {
    fprintf(stderr, "bench_contact: usage: bench_contact [--quick | --rounds N --svg FILE]\n");
    return SHB_ERR_INPUT;
  }
  shb_status status = bench(&o, all, &n, &failed);
  methods_destroy(all, n);
  if (status != SHB_OK) {
    fprintf(stderr, "bench_contact: %s\n", shb_message());
    return status;
  }
  printf("\n%d verdicts on errors failed\n", failed);
  return failed != 0;
}
