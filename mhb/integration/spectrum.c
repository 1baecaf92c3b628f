#include "mhb/integration/spectrum.h"

#include <complex.h>
#include <fftw3.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"

/* Peaks below this share of the largest so far are no lines. */
static const double SMALLEST = 1e-4;

/* x <- x without its mean, times Hann's window. Returns the mean square that is left. */
static double apply_window(int n, double *x) {
  double mean = 0, square = 0;
  for (int i = 0; i < n; i++) mean += x[i] / n;
  for (int i = 0; i < n; i++) {
    x[i] = (x[i] - mean) * (1 - cos(SHB_TWO_PI * (i + 0.5) / n));
    square += x[i] * x[i] / n;
  }
  return square;
}

/* Amplitudes of the bins of x[n], [n/2 + 1]; the first is zero. To be freed. */
static double *bin_amplitudes(int n, double *x) {
  int             bins = n / 2 + 1;
  double         *a    = shb_alloc((size_t)bins, sizeof *a);
  double complex *X    = shb_alloc_aligned(64, (size_t)bins, sizeof *X);
  fftw_plan       plan = NULL;
#pragma omp critical(fftw_planner)
  plan = fftw_plan_dft_r2c_1d(n, x, X, FFTW_ESTIMATE | FFTW_PRESERVE_INPUT);
  if (!plan) shb_out_of_memory(0);
  fftw_execute(plan);
  for (int k = 0; k < bins; k++) a[k] = k ? 2 * cabs(X[k]) / n : 0;
#pragma omp critical(fftw_planner)
  fftw_destroy_plan(plan);
  free(X);
  return a;
}

/* A line at a bin with amplitudes a[-1], a[0], a[1] around it, into the sorted list. */
static void add_line(const double *a, double bin, double width, double *frequency,
                     double *amplitude) {
  int at = MHB_SPECTRUM_LINES;
  while (at > 0 && amplitude[at - 1] < a[0]) at--;
  if (at == MHB_SPECTRUM_LINES) return;
  size_t behind = (size_t)(MHB_SPECTRUM_LINES - 1 - at) * sizeof(double);
  memmove(frequency + at + 1, frequency + at, behind);
  memmove(amplitude + at + 1, amplitude + at, behind);
  /* Hann's main lobe: offset of the line from the bin, by the larger neighbour */
  double side = fmax(a[-1], a[1]), offset = (2 * side - a[0]) / (side + a[0]);
  frequency[at] = (bin + (a[1] > a[-1] ? offset : -offset)) * width;
  amplitude[at] = a[0];
}

/* The lines of windowed samples. */
static void find_lines(int n, double *x, double duration, int top, double *frequency,
                       double *amplitude) {
  double *a = bin_amplitudes(n, x), largest = 0;
  for (int bin = 1; bin <= top && bin < n / 2; bin++) {
    if (a[bin] < a[bin - 1] || a[bin] < a[bin + 1]) continue;
    largest = fmax(largest, a[bin]);
    if (a[bin] > SMALLEST * largest) add_line(a + bin, bin, 1 / duration, frequency, amplitude);
  }
  free(a);
}

static void clear_lines(double *frequency, double *amplitude) {
  memset(frequency, 0, sizeof(double) * MHB_SPECTRUM_LINES);
  memset(amplitude, 0, sizeof(double) * MHB_SPECTRUM_LINES);
}

void mhb_spectrum_lines(int n, double *x, double duration, int top, double *frequency,
                        double *amplitude) {
  clear_lines(frequency, amplitude);
  apply_window(n, x);
  find_lines(n, x, duration, top, frequency, amplitude);
}

/* Motion of contact 0 at the ends of nominal steps. */
typedef struct {
  int     period, n; /* now; samples of all periods */
  double *u;         /* [3][n] */
} recording;

static void record(void *context, const mhb_integrator *g, double t0, double h) {
  recording *r    = context;
  double     step = (t0 + h) / g->nominal.h, whole = round(step);
  int        i = r->period * g->steps + (int)whole - 1;
  if (fabs(step - whole) > 1e-6 || whole < 1 || i >= r->n) return;
  for (int c = 0; c < 3; c++) r->u[c * r->n + i] = g->step[0].u[3 * (MHB_STAGES - 1) + c];
}

/* The lines of recorded motion: of the axis that moves most. */
static void largest_lines(const mhb_integrator *g, const recording *r, double *frequency,
                          double *amplitude) {
  int    largest = 0;
  double square[3];
  for (int c = 0; c < 3; c++) {
    square[c] = apply_window(r->n, r->u + c * r->n);
    if (square[c] > square[largest]) largest = c;
  }
  find_lines(r->n, r->u + largest * r->n, r->period * g->period,
             10 * r->period * g->settings.subharmonics, frequency, amplitude);
}

void mhb_spectrum(mhb_integrator *g, int periods, double *frequency, double *amplitude) {
  const int n     = periods * g->steps;
  int       found = 1;
  recording r     = {0, n, shb_alloc_zeroed(3 * (size_t)n, sizeof(double))};
  clear_lines(frequency, amplitude);
  g->watch   = record;
  g->context = &r;
  for (; r.period < periods && found; r.period++) found = mhb_integrator_period(g);
  g->watch = NULL;
  if (found) largest_lines(g, &r, frequency, amplitude);
  free(r.u);
}
