#include "mhb/integration/spectrum.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

/* Motion of the first contact at the ends of nominal steps. */
typedef struct {
  int     period, room;
  double *u; /* [3][room] */
} tape;

static void keep(void *context, const mhb_integrator *g, double t0, double h) {
  tape  *t    = context;
  double step = (t0 + h) / g->nominal.h, at = round(step);
  int    i = t->period * g->steps + (int)at - 1;
  if (fabs(step - at) > 1e-6 || at < 1 || i >= t->room) return;
  for (int c = 0; c < 3; c++) t->u[c * t->room + i] = g->step[0].u[3 * (MHB_STAGES - 1) + c];
}

/* Less its mean, weighted by Hann's window; the mean square that is left. */
static double prepare(int n, double *x) {
  double mean = 0, size = 0;
  for (int i = 0; i < n; i++) mean += x[i] / n;
  for (int i = 0; i < n; i++) {
    x[i] = (x[i] - mean) * (1 - cos(SHB_TWO_PI * (i + .5) / n));
    size += x[i] * x[i] / n;
  }
  return size;
}

static double amplitude_at(int n, const double *x, int bin) {
  double complex sum = 0, turn = cexp(-SHB_TWO_PI * I * bin / n), phase = 1;
  for (int i = 0; i < n; i++) {
    sum += x[i] * phase;
    phase *= turn;
  }
  return 2 * cabs(sum) / n;
}

/* A line at bin k between its neighbours, into the list if it is among the largest. */
static void add_line(const double a[3], double bin, double width, double *frequency,
                     double *amplitude) {
  int at = MHB_SPECTRUM_LINES;
  while (at > 0 && amplitude[at - 1] < a[1]) at--;
  if (at == MHB_SPECTRUM_LINES) return;
  size_t behind = (size_t)(MHB_SPECTRUM_LINES - 1 - at) * sizeof(double);
  memmove(frequency + at + 1, frequency + at, behind);
  memmove(amplitude + at + 1, amplitude + at, behind);
  /* Hann's main lobe: the larger neighbour tells how far off the bin the line is */
  double side = fmax(a[0], a[2]), off = (2 * side - a[1]) / (side + a[1]);
  frequency[at] = (bin + (a[2] > a[0] ? off : -off)) * width;
  amplitude[at] = a[1];
}

static void find_lines(int n, const double *x, int top, double width, double *frequency,
                       double *amplitude) {
  double a[3] = {0, 0, amplitude_at(n, x, 1)}, largest = 0;
  for (int bin = 1; bin <= top; bin++) {
    a[0] = a[1];
    a[1] = a[2];
    a[2] = amplitude_at(n, x, bin + 1);
    if (a[1] < a[0] || a[1] < a[2]) continue;
    largest = fmax(largest, a[1]);
    if (a[1] > 1e-4 * largest) add_line(a, bin, width, frequency, amplitude);
  }
}

int mhb_spectrum(mhb_integrator *g, int periods, double *frequency, double *amplitude) {
  int    n = periods * g->steps, best = 0, found = 1;
  tape   t = {0, n, calloc(3 * (size_t)n, sizeof(double))};
  double size[3];
  memset(frequency, 0, sizeof(double) * MHB_SPECTRUM_LINES);
  memset(amplitude, 0, sizeof(double) * MHB_SPECTRUM_LINES);
  if (!t.u) return 0;
  g->watch   = keep;
  g->context = &t;
  for (; t.period < periods && found; t.period++) found = mhb_integrator_period(g);
  g->watch = NULL;
  for (int c = 0; c < 3; c++) {
    size[c] = prepare(n, t.u + c * n);
    if (size[c] > size[best]) best = c;
  }
  int top = 10 * periods * g->settings.subharmonics;
  if (found)
    find_lines(n, t.u + best * n, top < n / 2 - 1 ? top : n / 2 - 1, 1 / (periods * g->period),
               frequency, amplitude);
  free(t.u);
  return found;
}
