#include "mhb/branches/record.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846, FLAT = 1e-9;

static void record_signals(mhb_response *response, mhb_branch *branch, int point,
                           const mhb_balance *b, const double *x) {
  int            K = branch->n_harmonics + 1, n3 = 3 * b->n_pairs, q = 3 * response->n_probes;
  double complex p[n3], motion[q + 1];
  for (int k = 0; k <= b->m; k++) {
    mhb_balance_contact_force(b, k, p);
    for (int row = 0; row < n3; row++) {
      const double *a    = x + (size_t)row * (size_t)b->nb;
      size_t        at   = ((size_t)point * (size_t)n3 + (size_t)row) * (size_t)K + (size_t)k;
      branch->motion[at] = k == 0 ? a[0] : CMPLX(a[2 * k - 1], a[2 * k]);
      branch->force[at]  = p[row];
    }
    mhb_receptance_probe(b->receptance, k, p, motion);
    for (int s = 0; s < q; s++)
      branch->probe[((size_t)point * (size_t)q + (size_t)s) * (size_t)K + (size_t)k] = motion[s];
  }
}

static void record_states(mhb_branch *branch, int point, const mhb_balance *b) {
  double worst = 0;
  for (int a = 0; a < b->n_pairs; a++) {
    size_t at = (size_t)point * (size_t)b->n_pairs + (size_t)a;
    memcpy(branch->state + 3 * at, b->info[a].share, sizeof b->info[a].share);
    branch->dissipation[at] = b->info[a].dissipation;
    worst                   = fmax(worst, b->info[a].error);
  }
  branch->error_sampling[point] = worst;
}

shb_status mhb_record(mhb_response *response, int index, mhb_balance *b,
                      const mhb_curve_point *point, int special, double seconds) {
  int at;
  SHB_TRY(mhb_response_point(response, index, &at));
  mhb_branch *branch    = &response->branch[index];
  branch->frequency[at] = b->at.omega / (2 * PI);
  branch->n0[at]        = b->at.n0;
  for (int i = 0; i < response->n_interfaces; i++)
    branch->interface_n0[at * response->n_interfaces + i] = b->own[i].n0;
  branch->value[at]        = mhb_parameter_shown(b->parameter, point->value);
  branch->special[at]      = special;
  branch->stable[at]       = -1; /* until the branch is judged */
  branch->iterations[at]   = point->iterations;
  branch->seconds[at]      = seconds;
  branch->error_newton[at] = point->residual;
  record_signals(response, branch, at, b, point->x);
  record_states(branch, at, b);
  branch->error_truncation[at] = point->truncation;
  if (branch->harmonics) branch->harmonics[at] = b->m;
  if (branch->truncation_kind) branch->truncation_kind[at] = point->truncation_kind;
  branch->error_modal[at] = point->modal;
  return SHB_OK;
}

int mhb_outputs(const mhb_balance *b) {
  int pairs = b->n_pairs < 2 ? b->n_pairs : 2;
  return b->receptance->model->n_probes + 3 * pairs;
}

/* Change of the contact forces along dx and with the parameter by dvalue, harmonic k. */
static void force_change(const mhb_balance *b, const double *dx, double dvalue, int k,
                         double complex *dp) {
  int block = 3 * b->nb;
  for (int row = 0; row < 3 * b->n_pairs; row++) {
    int           pair = row / 3, first = (row % 3) * b->nb + (k ? 2 * k - 1 : 0);
    const double *re     = b->dp + ((size_t)pair * (size_t)block + (size_t)first) * (size_t)block;
    const double *by     = b->by_parameter + (size_t)pair * (size_t)block + first;
    double        sum[2] = {dvalue * by[0], k ? dvalue * by[1] : 0};
    for (int j = 0; j < block; j++) {
      sum[0] += re[j] * dx[pair * block + j];
      if (k) sum[1] += re[block + j] * dx[pair * block + j];
    }
    dp[row] = CMPLX(sum[0], sum[1]);
  }
}

static double dot(double complex a, double complex b) {
  return creal(a) * creal(b) + cimag(a) * cimag(b);
}

/* Along a stretch on which nothing changes (another parameter than the frequency, stuck) the sign of a slope is noise. */
static double unless_flat(double slope, double square) {
  return fabs(slope) > FLAT * square ? slope : 0;
}

void mhb_probe_change(const mhb_arclength *path, const mhb_curve_point *point, int k,
                      double complex *q, double complex *dq) {
  const mhb_balance *b      = path->residual;
  double             dvalue = point->tangent[path->n];
  double complex     p[b->receptance->n], dp[b->receptance->n];
  mhb_receptance_update(b->receptance, k);
  mhb_balance_contact_force(b, k, p);
  force_change(b, point->tangent, dvalue, k, dp);
  mhb_receptance_probe(b->receptance, k, p, q);
  mhb_receptance_probe_change(b->receptance, k, p, dp,
                              b->parameter == MHB_IN_FREQUENCY ? dvalue : 0,
                              b->parameter == MHB_IN_SCALE ? dvalue : 0, dq);
}

double mhb_output_slope(const mhb_arclength *path, const mhb_curve_point *point, int o) {
  const mhb_balance    *b      = path->residual;
  const mhb_receptance *r      = b->receptance;
  int                   probes = r->model->n_probes, k = r->nu <= b->m ? r->nu : b->m;
  if (o >= probes) {
    size_t        at = (size_t)(o - probes) * (size_t)b->nb + (size_t)(2 * k - 1);
    const double *a = point->x + at, *da = point->tangent + at;
    return unless_flat(2 * (a[0] * da[0] + a[1] * da[1]), a[0] * a[0] + a[1] * a[1]);
  }
  double complex q[3 * probes], dq[3 * probes];
  mhb_probe_change(path, point, k, q, dq);
  double sum = 0, square = 0;
  for (int axis = 0; axis < 3; axis++) {
    sum += 2 * dot(q[3 * o + axis], dq[3 * o + axis]);
    square += dot(q[3 * o + axis], q[3 * o + axis]);
  }
  return unless_flat(sum, square);
}

void mhb_recorded_motion(const mhb_branch *branch, int point, const mhb_balance *b, double *x) {
  size_t                K = (size_t)branch->n_harmonics + 1, rows = 3 * (size_t)b->n_pairs;
  size_t                held = K < (size_t)b->m + 1 ? K : (size_t)b->m + 1;
  const double complex *A    = branch->motion + (size_t)point * rows * K;
  memset(x, 0, sizeof *x * (size_t)b->n);
  for (size_t row = 0; row < rows; row++)
    for (size_t k = 0; k < held; k++) {
      double *to = x + row * (size_t)b->nb;
      if (k > 0) to[2 * k] = cimag(A[row * K + k]);
      to[k > 0 ? 2 * k - 1 : 0] = creal(A[row * K + k]);
    }
}
