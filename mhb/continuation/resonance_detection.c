#include "mhb/continuation/resonance_detection.h"

#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/continuation/corrector.h"
#include "mhb/continuation/outputs.h"

/* Share of the response, at the peak and within a width, that counts. */
static const double SIGNIFICANT = 0.05;

/* A step of so many half widths skips nothing. */
static const double RESOLVED = 2;

static double square(double complex z) {
  return creal(z) * creal(z) + cimag(z) * cimag(z);
}

/* Motions of the probes at a point, [k][3 probes]; size[probes], or NULL: the root of the sum of
 * squares over k > 0. */
static void probe_motions(mhb_balance *b, const mhb_curve_point *point, double complex *q,
                          double *size) {
  mhb_receptance *r = b->receptance;
  int             n = 3 * r->model->n_probes;
  double complex  p[r->n];
  mhb_balance_use(b, point->evaluation);
  for (int k = 1; k <= b->m; k++) {
    mhb_balance_contact_force(b, k, p);
    mhb_balance_update_probes(b, k);
    mhb_receptance_probe(r, k, p, q + k * n);
  }
  for (int o = 0; size && o < n / 3; o++) {
    double sum = 0;
    for (int k = 1; k <= b->m; k++)
      for (int axis = 0; axis < 3; axis++) sum += square(q[k * n + 3 * o + axis]);
    size[o] = sqrt(sum);
  }
}

/* Whether the mode's peak is significant beside the motions of the contact and of the probes. Its
 * forces are those of the evaluation in use. */
static bool may_be_significant(const mhb_balance *b, const mhb_resonance *resonance,
                               const double *probe, double contact) {
  const mhb_receptance *r    = b->receptance;
  int                   mode = resonance->mode, k = resonance->k;
  const modal_model    *m = mhb_receptance_model(r, k);
  double complex        p[r->n];
  if (mode < 0) return true;
  mhb_balance_contact_force(b, k, p);
  double complex load  = r->scale * r->F[k * r->n_modes + mode];
  double         shape = 0, omega = SHB_TWO_PI * m->frequency[mode];
  for (int row = 0; row < r->n; row++) {
    double complex B = r->B[((size_t)k * (size_t)r->n + (size_t)row) * (size_t)r->n_modes + mode];
    load -= conj(B) * p[row];
    shape += square(B);
  }
  double peak = cabs(load) / (2 * m->damping_ratio[mode] * omega * omega);
  if (peak == 0) return false;
  bool significant = peak * sqrt(shape) >= SIGNIFICANT * contact;
  for (int o = 0; o < m->n_probes && !significant; o++) {
    double own = 0;
    for (int axis = 0; axis < 3; axis++)
      own += square(mhb_modal_part_probe(r->part, k, 3 * o + axis, mode, 1));
    significant = peak * sqrt(own) >= SIGNIFICANT * probe[o];
  }
  return significant;
}

/* trial <- the solution at the resonance's place, from the chord, with its tangent. */
static bool solve_at_resonance(mhb_arclength *curve, const mhb_resonance *resonance) {
  const mhb_curve_point *current = &curve->current, *next = &curve->next;
  double part = (resonance->value - current->value) / (next->value - current->value);
  double axis[curve->n + 1];
  memset(axis, 0, sizeof axis);
  axis[curve->n] = curve->parameter_scale;
  for (int i = 0; i < curve->n; i++)
    curve->trial.x[i] = current->x[i] + part * (next->x[i] - current->x[i]);
  curve->trial.value = resonance->value;
  return mhb_arclength_correct(curve, axis, 0.5, &curve->trial) &&
         mhb_arclength_set_tangent(curve, axis, &curve->trial);
}

/* Whether the response at the trial changes within a half width, beyond the change along the chord,
 * by a significant part. q: probe motions at current and next. */
static bool changes(mhb_arclength *curve, mhb_balance *b, const mhb_resonance *resonance,
                    const double complex *q_current, const double complex *q_next) {
  const mhb_curve_point *trial = &curve->trial, *current = &curve->current, *next = &curve->next;
  int                    n = 3 * b->receptance->model->n_probes, all = n * (b->m + 1);
  double                 part = resonance->half_width / (next->value - current->value), sum = 0;
  double                 along = resonance->half_width / trial->tangent[curve->n], size[n / 3 + 1];
  for (int i = 0; i < curve->n; i++)
    sum += pow(along * trial->tangent[i] - part * (next->x[i] - current->x[i]), 2);
  if (sqrt(sum) >= SIGNIFICANT * mhb_norm(trial->x, curve->n)) return true;
  double complex q[all + 1], own[n + 1], dq[n + 1];
  probe_motions(b, trial, q, size);
  mhb_probe_change(b, trial, resonance->k, own, dq);
  for (int o = 0; o < n / 3; o++) {
    sum = 0;
    for (int axis = 3 * o; axis < 3 * o + 3; axis++) {
      int at = resonance->k * n + axis;
      sum += square(along * dq[axis] - part * (q_next[at] - q_current[at]));
    }
    if (size[o] > 0 && sqrt(sum) >= SIGNIFICANT * size[o]) return true;
  }
  return false;
}

bool mhb_resonance_skipped(mhb_arclength *curve, mhb_balance *b, const mhb_resonances *resonances) {
  double         from = curve->current.value, way = curve->next.value - from;
  int            n = 0, probes = b->receptance->model->n_probes, all = 3 * probes * (b->m + 1);
  double         size[probes + 1], contact = mhb_norm(curve->next.x, curve->n);
  double complex q_current[all + 1], q_next[all + 1];
  bool           have_current = false;
  for (int i = 0; i < resonances->n; i++) {
    mhb_resonance *resonance = &resonances->at[way > 0 ? i : resonances->n - 1 - i];
    double         part      = (resonance->value - from) / way;
    if (!(part > 0 && part < 1) || resonance->significant ||
        !(fabs(way) >= RESOLVED * resonance->half_width))
      continue;
    if (n++ == 0) probe_motions(b, &curve->next, q_next, size);
    mhb_balance_use(b, curve->next.evaluation);
    if (!may_be_significant(b, resonance, size, contact)) continue;
    if (!have_current) probe_motions(b, &curve->current, q_current, NULL);
    have_current = true;
    resonance->significant =
        !solve_at_resonance(curve, resonance) || changes(curve, b, resonance, q_current, q_next);
    if (resonance->significant) return true;
  }
  return false;
}
