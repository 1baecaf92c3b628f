/* Contact law: error against time, beside marching by radial return in the same run.
 *
 *   bench_contact [repeats]
 *
 * One row a motion and method: microseconds for the force and for force with derivative (medians), error of the force
 * harmonics 0..7 relative to the largest, and a verdict: whether the error is within what the setting promises.
 * Reference: the law at tolerance 1e-14, which tests/mhb/test_contact checks against closed forms and a march. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/progress.h"
#include "mhb/contact.h"
#include "mhb/fourier.h"

enum { M = 7, NB = 2 * M + 1, MOTIONS = 10 };

static const double PI = 3.14159265358979323846;

typedef struct {
  const char *name;
  mhb_law     law;
  double      motion[3][NB];
} scene;

static void set(scene *s, int i, int k, double a, double phase) {
  s->motion[i][k ? 2 * k - 1 : 0] = k ? a * cos(phase) : a;
  if (k) s->motion[i][2 * k] = a * sin(phase);
}

static scene scene_of(int i) {
  static const char *const names[MOTIONS] = {
      "one direction", "circle", "ellipse",         "in phase", "quadrature",
      "opening",       "gap",    "three harmonics", "grazing",  "skew Ku"};
  scene s = {.name = names[i], .law = {.mu = .4, .kv = 5e5, .ku = {1e6, 0, 1e6}, .n0 = 100}};
  set(&s, 1, 1, 2e-4, 0);
  switch (i) {
    case 1:
      set(&s, 2, 1, 2e-4, -PI / 2);
      break;
    case 2:
      set(&s, 2, 1, 1.1e-4, -1);
      break;
    case 3:
      set(&s, 0, 1, 1e-4, 0);
      break;
    case 4:
      set(&s, 0, 1, 1e-4, -PI / 2);
      break;
    case 5:
      set(&s, 0, 1, 3e-4, .9);
      set(&s, 2, 1, .7e-4, 2);
      break;
    case 6:
      s.law.n0 = -60;
      set(&s, 0, 1, 3e-4, -.4);
      set(&s, 2, 1, .9e-4, 2.4);
      break;
    case 7:
      set(&s, 0, 1, 3e-4, .9);
      set(&s, 0, 3, 1.5e-4, .2);
      set(&s, 1, 2, 1e-4, 2);
      set(&s, 2, 1, .7e-4, 2);
      set(&s, 2, 3, .3e-4, 1);
      break;
    case 8:
      set(&s, 0, 1, 1.9999e-4, .9);
      set(&s, 2, 1, .7e-4, 2);
      break;
    case 9:
      memcpy(s.law.ku, (double[3]){1.2e6, .35e6, .6e6}, sizeof s.law.ku);
      set(&s, 0, 1, 1.5e-4, .9);
      set(&s, 2, 1, 1.2e-4, 2);
      break;
    default:
      break;
  }
  return s;
}

/* Marching by radial return, two laps, N samples; the tables of the basis are made outside the timing. */
static void march(const scene *s, int N, const double *basis, double force[3][NB]) {
  double f[2] = {0, 0}, x0[2] = {0, 0};
  memset(force, 0, sizeof(double) * 3 * NB);
  for (int step = 0; step < 2 * N; step++) {
    const double *b    = basis + (size_t)(step % N) * NB;
    double        y[3] = {0, 0, 0};
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < NB; j++) y[i] += s->motion[i][j] * b[j];
    double x[2] = {s->law.ku[0] * y[1] + s->law.ku[1] * y[2],
                   s->law.ku[1] * y[1] + s->law.ku[2] * y[2]};
    double n = fmax(0, s->law.n0 + s->law.kv * y[0]), limit = s->law.mu * n;
    for (int k = 0; k < 2; k++) f[k] += step ? x[k] - x0[k] : 0;
    double size = hypot(f[0], f[1]);
    if (size > limit)
      for (int k = 0; k < 2; k++) f[k] *= limit / size;
    memcpy(x0, x, sizeof x);
    if (step < N) continue;
    for (int j = 0; j < NB; j++) {
      double w = (j ? 2. : 1.) / N * b[j];
      force[0][j] += w * n;
      force[1][j] += w * f[0];
      force[2][j] += w * f[1];
    }
  }
}

static double error_of(const double a[3][NB], const double b[3][NB]) {
  double worst = 0, top = 0;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < NB; j++) {
      worst = fmax(worst, fabs(a[i][j] - b[i][j]));
      top   = fmax(top, fabs(b[i][j]));
    }
  }
  return worst / top;
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double median(double *t, int n) {
  qsort(t, (size_t)n, sizeof *t, ascending);
  return 1e6 * t[n / 2];
}

static void row(const char *name, const char *method, double us, double us_d, double error,
                double promise) {
  char derivative[16] = "-";
  if (us_d > 0) snprintf(derivative, sizeof derivative, "%.1f", us_d);
  printf("%-16s %-18s %9.1f %9s   %8.1e   %s\n", name, method, us, derivative, error,
         promise == 0       ? ""
         : error <= promise ? "PASS"
                            : "FAIL");
}

static int bench_law(const scene *s, const double reference[3][NB], double tolerance, int repeats) {
  static double           force[3][NB], jacobian[9 * NB * NB];
  static mhb_contact_info info;
  mhb_contact            *contact;
  double                  t[2][1001], us[2];
  if (mhb_contact_create(M, M, tolerance, &contact) != SHB_OK) return 1;
  for (int d = 0; d < 2; d++) {
    for (int i = 0; i < repeats; i++) {
      double start = shb_seconds();
      mhb_contact_force(contact, &s->law, &s->motion[0][0], &force[0][0], d ? jacobian : NULL,
                        &info);
      t[d][i] = shb_seconds() - start;
    }
    us[d] = median(t[d], repeats);
  }
  mhb_contact_destroy(contact);
  char method[32];
  snprintf(method, sizeof method, "tolerance %.0e", tolerance);
  double error = error_of(force, reference);
  row(s->name, method, us[0], us[1], error, tolerance);
  return !(error <= tolerance);
}

static void bench_march(const scene *s, const double reference[3][NB], int N, int repeats) {
  static double force[3][NB];
  double       *basis = malloc(sizeof(double) * (size_t)N * NB), t[1001];
  if (!basis) return;
  for (int i = 0; i < N; i++) mhb_basis(M, 2 * PI * i / N, basis + (size_t)i * NB, NULL);
  for (int i = 0; i < repeats; i++) {
    double start = shb_seconds();
    march(s, N, basis, force);
    t[i] = shb_seconds() - start;
  }
  char method[32];
  snprintf(method, sizeof method, "radial return %d", N);
  row(s->name, method, median(t, repeats), 0, error_of(force, reference), 0);
  free(basis);
}

int main(int argc, char **argv) {
  int repeats = argc > 1 ? atoi(argv[1]) : 201, failed = 0;
  if (repeats < 1 || repeats > 1001) repeats = 201;
  printf("%-16s %-18s %9s %9s   %8s   %s\n", "motion", "method", "force us", "+deriv us", "error",
         "verdict");
  for (int i = 0; i < MOTIONS; i++) {
    scene                   s = scene_of(i);
    static double           reference[3][NB];
    static mhb_contact_info info;
    mhb_contact            *exact;
    if (mhb_contact_create(M, M, 1e-14, &exact) != SHB_OK) return 4;
    mhb_contact_force(exact, &s.law, &s.motion[0][0], &reference[0][0], NULL, &info);
    mhb_contact_destroy(exact);
    for (int N = 64; N <= 4096; N *= 8) bench_march(&s, reference, N, repeats < 21 ? repeats : 21);
    for (int k = 4; k <= 10; k += 2) failed += bench_law(&s, reference, pow(10, -k), repeats);
  }
  printf("%d verdicts failed\n", failed);
  return failed != 0;
}
