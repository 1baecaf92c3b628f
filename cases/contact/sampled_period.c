#include "cases/contact/sampled_period.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/numerics/fourier.h"

enum { SIGNALS = 9, LEAST = 1440, A_HARMONIC = 32 };

/* The integrand over the period. */
typedef struct {
  int           m;
  const double *motion; /* [3][2m+1] */
} source;

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static bool allocate(sampled_period *p, int n) {
  double **array[SIGNALS] = {&p->phase,     &p->motion[0],   &p->motion[1],
                             &p->motion[2], &p->friction[0], &p->friction[1],
                             &p->load,      &p->size,        &p->limit};
  bool     ok             = true;
  for (int i = 0; i < SIGNALS; i++) ok &= (*array[i] = calloc((size_t)n, sizeof(double))) != NULL;
  for (int i = 0; i < PERIOD_STATES; i++)
    ok &= (p->during[i] = calloc((size_t)n, sizeof(bool))) != NULL;
  return ok;
}

void sampled_period_free(sampled_period *p) {
  double *array[SIGNALS] = {p->phase,     p->motion[0],   p->motion[1],
                            p->motion[2], p->friction[0], p->friction[1],
                            p->load,      p->size,        p->limit};
  for (int i = 0; i < SIGNALS; i++) free(array[i]);
  for (int i = 0; i < PERIOD_STATES; i++) free(p->during[i]);
  *p = (sampled_period){0};
}

/* Places samples at equal steps from 0 to 1 and at the transitions. */
static void place(sampled_period *p, int steps, const mhb_contact_info *info) {
  int n = 0;
  for (int i = 0; i <= steps; i++) p->phase[n++] = (double)i / steps;
  for (int i = 0; i < info->n_transitions; i++) p->phase[n++] = info->transition[i].phase;
  qsort(p->phase, (size_t)n, sizeof *p->phase, ascending);
  p->n = 1;
  for (int i = 1; i < n; i++)
    if (p->phase[i] > p->phase[p->n - 1]) p->phase[p->n++] = p->phase[i];
}

static void sum_motion(sampled_period *p, const source *from) {
  int    nb = mhb_real_size(from->m);
  double basis[nb];
  for (int i = 0; i < p->n; i++) {
    mhb_basis(from->m, SHB_TWO_PI * p->phase[i], basis, NULL);
    for (int a = 0; a < 3; a++)
      for (int j = 0; j < nb; j++) p->motion[a][i] += from->motion[a * nb + j] * basis[j];
  }
}

/* Sets a component to zero if it is only round-off of the other. */
static void drop_rounding(sampled_period *p) {
  double most[2] = {0, 0};
  for (int i = 0; i < p->n; i++)
    for (int k = 0; k < 2; k++) most[k] = fmax(most[k], fabs(p->friction[k][i]));
  for (int k = 0; k < 2; k++)
    if (most[k] <= 1e-12 * most[1 - k]) memset(p->friction[k], 0, sizeof(double) * (size_t)p->n);
}

static void take(sampled_period *p, const mhb_law *law, const mhb_contact_sample *sample) {
  for (int i = 0; i < p->n; i++) {
    for (int k = 0; k < 2; k++) p->friction[k][i] = sample[i].f[k];
    p->size[i]  = hypot(sample[i].f[0], sample[i].f[1]);
    p->load[i]  = sample[i].n;
    p->limit[i] = law->mu * sample[i].n;
  }
  drop_rounding(p);
}

/* d(u, w)/d phase. */
static void velocity(const source *from, double phase, double v[2]) {
  int    nb = mhb_real_size(from->m);
  double basis[nb], slope[nb];
  mhb_basis(from->m, SHB_TWO_PI * phase, basis, slope);
  for (int k = 0; k < 2; k++) {
    v[k] = 0;
    for (int j = 0; j < nb; j++) v[k] += SHB_TWO_PI * from->motion[(1 + k) * nb + j] * slope[j];
  }
}

/* Work of friction by Simpson's rule; friction is smooth between samples. middle: [n - 1]
 * midpoints. */
static void integrate(sampled_period *p, const source *from, const mhb_contact_sample *middle) {
  double size[2] = {0, 0}, before[2], half[2], after[2];
  velocity(from, 0, after);
  for (int i = 1; i < p->n; i++) {
    double h = (p->phase[i] - p->phase[i - 1]) / 6;
    memcpy(before, after, sizeof before);
    velocity(from, middle[i - 1].phase, half);
    velocity(from, p->phase[i], after);
    for (int k = 0; k < 2; k++) {
      double work = h * (p->friction[k][i - 1] * before[k] + 4 * middle[i - 1].f[k] * half[k] +
                         p->friction[k][i] * after[k]);
      p->work[k] += work;
      size[k] += fabs(work);
    }
  }
  for (int k = 0; k < 2; k++)
    if (fabs(p->work[k]) <= 1e-10 * size[k] && isfinite(size[k])) p->work[k] = 0;
}

shb_status sampled_period_create(mhb_contact_evaluator *contact, const mhb_law *law, int m,
                                 const double *motion, const mhb_contact_info *info,
                                 sampled_period *p) {
  int steps = A_HARMONIC * m > LEAST ? A_HARMONIC * m : LEAST, n = steps + 1 + info->n_transitions;
  const source from          = {m, motion};
  *p                         = (sampled_period){0};
  mhb_contact_sample *sample = calloc((size_t)n, sizeof *sample);
  mhb_contact_info   *again  = calloc(1, sizeof *again);
  bool                ok     = allocate(p, n) && sample && again;
  if (ok) {
    place(p, steps, info);
    sum_motion(p, &from);
    for (int i = 0; i < p->n; i++) sample[i].phase = p->phase[i];
    mhb_contact_time_history(contact, law, motion, p->n, sample, again);
    take(p, law, sample);
    /* states are taken at midpoints: at a transition round-off would decide */
    for (int i = 1; i < p->n; i++) sample[i - 1].phase = .5 * (p->phase[i - 1] + p->phase[i]);
    mhb_contact_time_history(contact, law, motion, p->n - 1, sample, again);
    for (int i = 1; i < p->n; i++) p->during[sample[i - 1].state][i] = true;
    integrate(p, &from, sample);
  }
  free(sample);
  free(again);
  if (ok) return SHB_OK;
  sampled_period_free(p);
  SHB_FAIL(SHB_ERR_IO, "out of memory");
}
