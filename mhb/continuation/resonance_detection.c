#include "mhb/continuation/resonance_detection.h"

#include <math.h>
#include <string.h>

#include "mhb/continuation/corrector.h"
#include "mhb/continuation/outputs.h"

static const double TWO_PI = 6.283185307179586476925;

/* What is felt: part of the response, at the peak and within a width. A step of so many half widths passes nothing. */
static const double FELT = .05, RESOLVED = 2;

static double square(double complex z) {
  return creal(z) * creal(z) + cimag(z) * cimag(z);
}

/* Motions of the probes under the forces of the last evaluation, [k][3 probes]; size[probes], if any: all harmonics k > 0 together. */
static void probes(const mhb_balance *b, double complex *q, double *size) {
  mhb_receptance *r = b->receptance;
  int             n = 3 * r->model->n_probes;
  double complex  p[r->n];
  for (int k = 1; k <= b->m; k++) {
    mhb_balance_contact_force(b, k, p);
    mhb_receptance_update(r, k);
    mhb_receptance_probe(r, k, p, q + k * n);
  }
  for (int o = 0; size && o < n / 3; o++) {
    double sum = 0;
    for (int k = 1; k <= b->m; k++)
      for (int s = 0; s < 3; s++) sum += square(q[k * n + 3 * o + s]);
    size[o] = sqrt(sum);
  }
}

/* Peak of the mode under the forces of the last evaluation, against the motions of the contact and of the probes. */
static int may_be_felt(const mhb_arclength *path, const mhb_resonance *place, const double *probe,
                       double contact) {
  const mhb_receptance *r = path->residual->receptance;
  const modal_model    *m = r->model;
  int                   i = place->mode, k = place->k;
  double complex        p[r->n];
  if (i < 0) return 1;
  mhb_balance_contact_force(path->residual, k, p);
  double complex drive = r->scale * r->F[k * r->n_modes + i];
  double         shape = 0, omega = TWO_PI * m->frequency[i];
  for (int row = 0; row < r->n; row++) {
    double complex b = r->B[((size_t)k * (size_t)r->n + (size_t)row) * (size_t)r->n_modes + i];
    drive -= conj(b) * p[row];
    shape += square(b);
  }
  double peak = cabs(drive) / (2 * m->damping_ratio[i] * omega * omega);
  if (peak == 0) return 0;
  int felt = peak * sqrt(shape) >= FELT * contact;
  for (int o = 0; o < m->n_probes && !felt; o++) {
    double own = 0;
    for (int axis = 0; axis < 3; axis++) own += pow(m->probe[(3 * o + axis) * r->n_modes + i], 2);
    felt = peak * sqrt(own) >= FELT * probe[o];
  }
  return felt;
}

/* The response at the probe, with its tangent, changes within a half width, more than along the chord. q: at now and next. */
static int changes(const mhb_arclength *path, const mhb_resonance *place,
                   const double complex *q_now, const double complex *q_next) {
  const mhb_curve_point *probe = &path->probe, *now = &path->now, *next = &path->next;
  const mhb_balance     *b = path->residual;
  int                    n = 3 * b->receptance->model->n_probes, all = n * (b->m + 1);
  double                 way = next->value - now->value, part = place->half / way, sum = 0;
  double                 along = place->half / probe->tangent[path->n], size[n / 3 + 1];
  for (int i = 0; i < path->n; i++)
    sum += pow(along * probe->tangent[i] - part * (next->x[i] - now->x[i]), 2);
  if (sqrt(sum) >= FELT * mhb_norm(probe->x, path->n)) return 1;
  double complex q[all + 1], own[n + 1], dq[n + 1];
  probes(b, q, size);
  mhb_probe_change(path, probe, place->k, own, dq);
  for (int o = 0; o < n / 3; o++) {
    sum = 0;
    for (int s = 3 * o; s < 3 * o + 3; s++) {
      int at = place->k * n + s;
      sum += square(along * dq[s] - part * (q_next[at] - q_now[at]));
    }
    if (size[o] > 0 && sqrt(sum) >= FELT * size[o]) return 1;
  }
  return 0;
}

/* probe <- the solution at the place, from the chord, with its tangent. */
static int go_there(mhb_arclength *path, const mhb_resonance *place) {
  const mhb_curve_point *now = &path->now, *next = &path->next;
  double                 part = (place->value - now->value) / (next->value - now->value);
  double                 axis[path->n + 1];
  memset(axis, 0, sizeof axis);
  axis[path->n] = path->span;
  for (int i = 0; i < path->n; i++) path->probe.x[i] = now->x[i] + part * (next->x[i] - now->x[i]);
  path->probe.value = place->value;
  return mhb_arclength_correct(path, axis, .5, &path->probe) &&
         mhb_arclength_set_tangent(path, axis, &path->probe);
}

/* Whether one of those in list is felt. Where there is no solution, nothing is smooth. */
static int look(mhb_arclength *path, mhb_resonance *const *list, int n) {
  const mhb_balance *b   = path->residual;
  int                all = 3 * b->receptance->model->n_probes * (b->m + 1), known = 0;
  double             unused[path->n], contact = mhb_norm(path->next.x, path->n),
                          size[b->receptance->model->n_probes + 1];
  double complex q_now[all + 1], q_next[all + 1];
  probes(b, q_next, size);
  for (int i = 0; i < n; i++) {
    if (!may_be_felt(path, list[i], size, contact)) continue;
    if (known++ == 0) {
      mhb_balance_evaluate(path->residual, path->now.x, path->now.value, unused, NULL, NULL);
      probes(b, q_now, NULL);
    }
    list[i]->felt = !go_there(path, list[i]) || changes(path, list[i], q_now, q_next);
    if (list[i]->felt) return 1;
  }
  if (known) mhb_arclength_measure(path, &path->next);
  return 0;
}

int mhb_resonance_skipped(mhb_arclength *path) {
  const mhb_resonances *all  = &path->resonances;
  double                from = path->now.value, way = path->next.value - from;
  mhb_resonance        *list[all->n + 1];
  int                   n = 0;
  for (int i = 0; i < all->n; i++) {
    mhb_resonance *place = &all->at[way > 0 ? i : all->n - 1 - i];
    double         part  = (place->value - from) / way;
    if (part > 0 && part < 1 && !place->felt && fabs(way) >= RESOLVED * place->half)
      list[n++] = place;
  }
  return n > 0 && look(path, list, n);
}
