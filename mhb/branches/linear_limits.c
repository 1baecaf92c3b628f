#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/progress.h"
#include "mhb/balance/modal_error.h"
#include "mhb/branches/linear_limits.h"
#include "mhb/branches/record.h"
#include "mhb/continuation/outputs.h"

static const double TOLERANCE = 2e-3;

typedef struct {
  mhb_balance  *balance;
  mhb_response *response;
  int           branch, stuck, n_outputs;
  double       *x, *r;
} sampler;

/* Amplitudes of all outputs at a value of the parameter. The balance has the forces there
 * afterwards. */
static shb_status amplitudes(sampler *s, double value, double *out) {
  mhb_balance          *b      = s->balance;
  const mhb_receptance *r      = b->receptance;
  int                   probes = r->model->n_probes, k = r->nu <= b->m ? r->nu : b->m;
  SHB_TRY(mhb_balance_linear_limit(b, value, s->stuck, s->x));
  double complex p[r->n], q[3 * probes + 1];
  mhb_balance_contact_force(b, k, p);
  mhb_receptance_probe(r, k, p, q);
  for (int o = 0; o < probes; o++) {
    double sum = 0;
    for (int axis = 0; axis < 3; axis++) sum += pow(cabs(q[3 * o + axis]), 2);
    out[o] = sqrt(sum);
  }
  for (int o = probes; o < s->n_outputs; o++) {
    const double *a = s->x + (size_t)(o - probes) * (size_t)b->nb + (size_t)(2 * k - 1);
    out[o]          = hypot(a[0], a[1]);
  }
  return SHB_OK;
}

static shb_status record(sampler *s, double value) {
  double unused[s->n_outputs + 1];
  double started = shb_seconds();
  SHB_TRY(amplitudes(s, value, unused));
  for (int a = 0; a < s->balance->n_pairs; a++) {
    mhb_contact_info *info = &s->balance->eval->info[a];
    memset(info, 0, offsetof(mhb_contact_info, transition));
    info->share[s->stuck ? MHB_STICK : MHB_SEPARATE] = 1;
  }
  mhb_curve_point point = {.x = s->x, .value = value};
  point.modal           = mhb_modal_error(s->balance, s->x, NULL);
  SHB_TRY(mhb_record(s->response, s->branch, s->balance, &point, MHB_ORDINARY,
                     shb_seconds() - started));
  mhb_branch *branch                   = &s->response->branch[s->branch];
  branch->stable[branch->n_points - 1] = 1;
  return SHB_OK;
}

/* Record everything in (lo, hi): halve while the middle is off the straight line. */
static shb_status refine(sampler *s, double lo, const double *at_lo, double hi, const double *at_hi,
                         int depth) {
  double mid = 0.5 * (lo + hi), at_mid[s->n_outputs + 1];
  SHB_TRY(amplitudes(s, mid, at_mid));
  int rough = 0;
  for (int o = 0; o < s->n_outputs; o++) {
    double line = 0.5 * (at_lo[o] + at_hi[o]);
    rough |= fabs(at_mid[o] - line) > TOLERANCE * fmax(line, at_mid[o]);
  }
  if (!rough || depth == 0) return SHB_OK;
  SHB_TRY(refine(s, lo, at_lo, mid, at_mid, depth - 1));
  SHB_TRY(record(s, mid));
  return refine(s, mid, at_mid, hi, at_hi, depth - 1);
}

/* First grid: in frequency a quarter of the narrowest half-power width, within reason. */
static int first_grid(const mhb_balance *b) {
  const modal_model *model = b->receptance->model;
  const double      *f     = b->settings->frequency;
  double             least = 0.1;
  if (b->parameter != MHB_IN_FREQUENCY) return 32;
  for (int i = 0; i < model->n_modes; i++) least = fmin(least, model->damping_ratio[i]);
  double wanted = 4 * (f[1] - f[0]) / fmax(2 * least * f[0], 1e-3 * (f[1] - f[0]));
  return (int)fmax(32, fmin(800, wanted));
}

static shb_status sample(sampler *s) {
  const mhb_balance *b    = s->balance;
  int                grid = first_grid(b);
  double             from = mhb_parameter_end(b->settings, b->parameter, 0), lo = from;
  double             to = mhb_parameter_end(b->settings, b->parameter, 1);
  double             at_lo[s->n_outputs + 1], at_hi[s->n_outputs + 1];
  SHB_TRY(amplitudes(s, lo, at_lo));
  SHB_TRY(record(s, lo));
  for (int i = 1; i <= grid; i++) {
    double hi = i == grid ? to : from + i * ((to - from) / grid);
    SHB_TRY(amplitudes(s, hi, at_hi));
    SHB_TRY(refine(s, lo, at_lo, hi, at_hi, 8));
    SHB_TRY(record(s, hi));
    memcpy(at_lo, at_hi, sizeof at_lo);
    lo = hi;
  }
  return SHB_OK;
}

/* Mark peaks for the report: a grid point at which an output is larger than at both neighbours. */
static void mark_peaks(mhb_branch *branch, const mhb_balance *b, int n_probes, int n_harmonics) {
  int K = n_harmonics + 1, k = b->receptance->nu <= b->m ? b->receptance->nu : b->m;
  for (int o = 0; o < n_probes; o++) {
    double a[3] = {0, 0, 0};
    for (int i = 0; i < branch->n_points; i++) {
      double sum = 0;
      for (int axis = 0; axis < 3; axis++)
        sum +=
            pow(cabs(branch->probe[(((size_t)i * (size_t)n_probes + (size_t)o) * 3 + (size_t)axis) *
                                       (size_t)K +
                                   (size_t)k]),
                2);
      a[0] = a[1];
      a[1] = a[2];
      a[2] = sum;
      if (i >= 2 && a[1] > a[0] && a[1] >= a[2]) branch->special[i - 1] = MHB_PEAK;
    }
  }
}

shb_status mhb_linear_limits(mhb_balance *balance, mhb_response *response, int branch) {
  sampler s = {.balance   = balance,
               .response  = response,
               .branch    = branch,
               .stuck     = response->branch[branch].kind == MHB_BRANCH_STUCK,
               .n_outputs = mhb_outputs(balance)};
  s.x       = calloc((size_t)balance->n, sizeof(double));
  SHB_CHECK(s.x, SHB_ERR_IO, "out of memory");
  shb_status status = sample(&s);
  free(s.x);
  SHB_TRY(status);
  mark_peaks(&response->branch[branch], balance, response->n_probes, response->n_harmonics);
  response->branch[branch].reason   = strdup("end of range");
  response->branch[branch].complete = true;
  return SHB_OK;
}
