#include "method.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "mesh/base/progress.h"

static const struct {
  double      tolerance;
  const char *name;
} accuracies[] = {{1e-3, "fast"}, {1e-5, "balanced"}, {1e-8, "exact"}};

static shb_status add_baseline(method_family family, int N, int H, method *m) {
  *m = (method){.family = family, .N = N, .H = H};
  snprintf(m->name, sizeof m->name, "%s %d",
           family == METHOD_RETURN ? "radial return" : "closed form", N);
  return baseline_create(family == METHOD_RETURN ? BASELINE_RETURN : BASELINE_CLOSED, N,
                         SUITE_HARMONICS, H, &m->baseline);
}

static shb_status add_law(double tolerance, int H, method *m) {
  *m = (method){.family = METHOD_LAW, .tolerance = tolerance, .H = H};
  for (int i = 0; i < 3; i++)
    if (accuracies[i].tolerance == tolerance) m->accuracy = accuracies[i].name;
  snprintf(m->name, sizeof m->name, "%s %.0e", m->accuracy ? m->accuracy : "tolerance", tolerance);
  return mhb_contact_evaluator_create(SUITE_HARMONICS, H, tolerance, &m->contact);
}

shb_status methods_create(int quick, method all[METHOD_MAX], int *n) {
  static const double ladder[] = {1e-3, 1e-5, 1e-8, 1e-2, 1e-4, 1e-6, 1e-7, 1e-9, 1e-10, 1e-11};
  *n                           = 0;
  for (int H = SUITE_HARMONICS; H <= METHOD_H; H += METHOD_H - SUITE_HARMONICS) {
    int steps = quick || H == METHOD_H ? 3 : (int)(sizeof ladder / sizeof *ladder);
    for (int N = 64; N <= (quick ? 1024 : 4096); N *= quick ? 4 : 2)
      SHB_TRY(add_baseline(METHOD_RETURN, N, H, &all[(*n)++]));
    for (int N = quick ? 64 : 32; N <= (quick ? 1024 : 4096); N *= quick ? 4 : 2)
      SHB_TRY(add_baseline(METHOD_CLOSED, N, H, &all[(*n)++]));
    for (int i = 0; i < steps; i++) SHB_TRY(add_law(ladder[i], H, &all[(*n)++]));
  }
  return SHB_OK;
}

void methods_destroy(method *all, int n) {
  for (int i = 0; i < n; i++) {
    baseline_destroy(&all[i].baseline);
    mhb_contact_evaluator_destroy(all[i].contact);
  }
}

/* Returns the laps. */
static int run(method *m, const suite_motion *s, double *force, double *jacobian) {
  mhb_contact_info info;
  if (m->family != METHOD_LAW)
    return baseline_force(&m->baseline, &s->law, &s->motion[0][0], force);
  mhb_contact_force(m->contact, &s->law, &s->motion[0][0], force, jacobian, &info);
  return info.laps;
}

static double size_of(const double *a, int k) {
  return k ? hypot(a[2 * k - 1], a[2 * k]) : fabs(a[0]);
}

measurement method_judge(method *m, const suite_motion *s, const double *reference) {
  double force[3 * (2 * METHOD_H + 1)], worst = 0, top = 0;
  int    laps = run(m, s, force, NULL);
  for (int i = 0; i < 3; i++) {
    const double *exact = reference + i * (2 * METHOD_H + 1), *own = force + i * (2 * m->H + 1);
    double        off[2 * METHOD_H + 1];
    for (int j = 0; j <= 2 * m->H; j++) off[j] = own[j] - exact[j];
    for (int k = 0; k <= m->H; k++) {
      top = fmax(top, size_of(exact, k));
      /* not fmax: what is no number must show */
      worst = size_of(off, k) <= worst ? worst : size_of(off, k);
    }
  }
  return (measurement){{NAN, NAN}, worst / top, laps};
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

double median_of(double *t, int n) {
  qsort(t, (size_t)n, sizeof *t, ascending);
  return n % 2 ? t[n / 2] : .5 * (t[n / 2 - 1] + t[n / 2]);
}

/* Microseconds per call, mean of a batch. One call before it fills caches and branch prediction. */
static double batch_time(method *m, const suite_motion *s, int batch, double *jacobian) {
  double force[3 * (2 * METHOD_H + 1)];
  if (batch > 1) run(m, s, force, jacobian);
  double start = shb_seconds();
  for (int i = 0; i < batch; i++) run(m, s, force, jacobian);
  return 1e6 * (shb_seconds() - start) / batch;
}

shb_status methods_time(method *all, int n, const suite_motion *s, int rounds,
                        measurement *measured) {
  static double jacobian[9 * (2 * METHOD_H + 1) * SUITE_WIDTH];
  int           batch[METHOD_MAX][2];
  double       *t = malloc(sizeof *t * 2 * (size_t)n * (size_t)rounds);
  SHB_CHECK(t, SHB_ERR_IO, "no memory for %d rounds", rounds);
  for (int i = 0; i < n; i++)
    for (int d = 0; d < 2; d++) { /* batches of 60 us and more */
      batch_time(&all[i], s, 1, d ? jacobian : NULL);
      batch[i][d] = 1 + (int)fmin(60 / batch_time(&all[i], s, 1, d ? jacobian : NULL), 99);
    }
  for (int r = 0; r < rounds; r++)
    for (int i = 0; i < n; i++)
      for (int d = 0; d < (all[i].family == METHOD_LAW ? 2 : 1); d++)
        t[(2 * i + d) * rounds + r] = batch_time(&all[i], s, batch[i][d], d ? jacobian : NULL);
  for (int i = 0; i < n; i++)
    for (int d = 0; d < (all[i].family == METHOD_LAW ? 2 : 1); d++)
      measured[i].us[d] = median_of(t + (2 * i + d) * rounds, rounds);
  free(t);
  return SHB_OK;
}
