#include "mhb/ring/side_waves.h"

#include <complex.h>
#include <fftw3.h>
#include <math.h>
#include <stdlib.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"

/* Bins that a line of Hann's window fills on either side. */
enum { LOBE = 2 };

/* Smaller lines, relative to the wave, are not reported. */
static const double LEAST = 1e-4;

typedef struct {
  int             n, periods, blades, wave; /* samples */
  double complex *X;                        /* [3][n][blades] */
  double         *power;                    /* [bin][blades], 0: taken */
} field;

static double size_of(const field *s, int bin, int diameter) {
  double square = 0;
  for (int axis = 0; axis < 3; axis++) {
    double complex a =
        s->X[((size_t)axis * (size_t)s->n + (size_t)bin) * (size_t)s->blades + (size_t)diameter];
    square += creal(a * conj(a));
  }
  return square;
}

/* FFTW's sign in time is exp(-j), that over the blades is inverted by reading -n. */
static void transform(const double *x, field *s) {
  int       n = s->n, N = s->blades, size[2] = {n, N};
  double    sum  = 0;
  fftw_plan plan = NULL;
#pragma omp critical(fftw_planner)
  plan = fftw_plan_many_dft(2, size, 3, s->X, NULL, 1, n * N, s->X, NULL, 1, n * N, FFTW_FORWARD,
                            FFTW_ESTIMATE);
  if (!plan) shb_out_of_memory(0);
  for (int i = 0; i < n; i++) sum += 1 - cos(SHB_TWO_PI * (i + 0.5) / n);
  for (int i = 0; i < n; i++) {
    double window = 2 * (1 - cos(SHB_TWO_PI * (i + 0.5) / n)) / (sum * N);
    for (int axis = 0; axis < 3; axis++)
      for (int b = 0; b < N; b++) /* blades backwards: exp(+j 2 pi n b/N) */
        s->X[((size_t)axis * (size_t)n + (size_t)i) * (size_t)N + (size_t)((N - b) % N)] =
            window * x[((size_t)i * 3 + (size_t)axis) * (size_t)N + (size_t)b];
  }
  fftw_execute(plan);
#pragma omp critical(fftw_planner)
  fftw_destroy_plan(plan);
}

/* Power of the bins around one, which is taken away. */
static double take(const field *s, int bin, int diameter) {
  double sum = 0;
  for (int k = bin - LOBE; k <= bin + LOBE; k++) {
    if (k < 0 || k >= 2 * s->periods) continue;
    double *power = &s->power[k * s->blades + diameter];
    sum += *power;
    *power = 0;
  }
  return sum;
}

/* Largest line that is left. */
static mhb_side_wave largest(const field *s, double wave) {
  int           low = s->periods / 2, high = 3 * s->periods / 2, at = -1;
  mhb_side_wave line = {.diameter = -1};
  for (int k = low * s->blades; k < (high + 1) * s->blades; k++)
    if (s->power[k] > (at < 0 ? 0 : s->power[at])) at = k;
  if (at < 0 || !(sqrt(s->power[at]) > LEAST * wave)) return line;
  int    bin = at / s->blades, n = at % s->blades;
  double here = sqrt(size_of(s, bin, n)), below = sqrt(size_of(s, bin - 1, n)),
         above = sqrt(size_of(s, bin + 1, n));
  double ratio = fmax(below, above) / here, part = (2 * ratio - 1) / (1 + ratio);
  double x      = SHB_PI * part;
  line.diameter = n;
  line.offset   = (bin + (above > below ? part : -part)) / s->periods - 1;
  line.size     = here * (1 - part * part) * (fabs(x) > 1e-6 ? x / sin(x) : 1) / wave;
  return line;
}

static void find(const field *s, mhb_side_waves *found) {
  int    n_bins = 2 * s->periods;
  double wave = sqrt(size_of(s, s->periods, s->wave)), total = 0, lines = 0;
  for (int k = 0; k < n_bins * s->blades; k++)
    s->power[k] = size_of(s, k / s->blades, k % s->blades);
  take(s, s->periods, s->wave);
  for (int k = s->periods / 2 * s->blades; k < (3 * s->periods / 2 + 1) * s->blades; k++)
    total += s->power[k];
  for (int i = 0; i < MHB_SIDE_WAVES; i++) {
    found->wave[i] = largest(s, wave);
    if (found->wave[i].diameter < 0) continue;
    int bin = (int)lround((found->wave[i].offset + 1) * s->periods);
    lines += take(s, bin, found->wave[i].diameter);
  }
  found->share = total > 0 ? lines / total : 1;
}

void mhb_side_waves_find(const double *x, int periods, int blades, int engine_order,
                         mhb_side_waves *found) {
  field s = {.n       = periods * MHB_SIDE_SAMPLES,
             .periods = periods,
             .blades  = blades,
             .wave    = (engine_order % blades + blades) % blades};
  s.X     = shb_alloc_aligned(64, 3 * (size_t)s.n * (size_t)blades, sizeof *s.X);
  s.power = shb_alloc_zeroed(2 * (size_t)periods * (size_t)blades, sizeof *s.power);
  transform(x, &s);
  find(&s, found);
  free(s.X);
  free(s.power);
}
