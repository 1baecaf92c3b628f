#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mesh/base/progress.h"
#include "mhb/balance/modal_error.h"
#include "mhb/branches/linear_limits.h"
#include "mhb/branches/record.h"
#include "mhb/continuation/linear_resonances.h"
#include "mhb/continuation/outputs.h"

static const double TOLERANCE = 2e-3;

enum { LEAST_DEPTH = 8, MOST_DEPTH = 30 }; /* of the halvings of an interval */

typedef struct {
  mhb_balance  *balance;
  mhb_response *response;
  int           branch, stuck, n_outputs;
  double       *x, *r;
} sampler;

/* Every probe, then v, u, w of the first two pairs: of a ring too, where each blade has its own. */
static int all_outputs(const mhb_balance *b) {
  return b->receptance->model->n_probes + 3 * (b->n_pairs < 2 ? b->n_pairs : 2);
}

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

/* Record the last point of amplitudes. `later` points that follow it are recorded already. */
static shb_status record(sampler *s, double value, int later) {
  double started = shb_seconds();
  for (int a = 0; a < s->balance->n_pairs; a++) {
    mhb_contact_info *info = &s->balance->eval->info[a];
    memset(info, 0, offsetof(mhb_contact_info, transition));
    info->share[s->stuck ? MHB_STICK : MHB_SEPARATE] = 1;
  }
  mhb_curve_point point = {.x = s->x, .value = value};
  point.modal           = mhb_modal_error(s->balance, s->x, NULL);
  mhb_record(s->response, s->branch, s->balance, &point, MHB_ORDINARY, shb_seconds() - started);
  mhb_branch *branch                   = &s->response->branch[s->branch];
  branch->stable[branch->n_points - 1] = 1;
  mhb_response_place(s->response, s->branch, branch->n_points - 1 - later);
  return SHB_OK;
}

/* Record everything in (lo, hi), where hi and `later` - 1 points behind it are recorded. Halve
 * while the middle is off the straight line. */
static shb_status refine(sampler *s, double lo, const double *at_lo, double hi, const double *at_hi,
                         int depth, int later) {
  double mid = 0.5 * (lo + hi), at_mid[s->n_outputs + 1];
  SHB_TRY(amplitudes(s, mid, at_mid));
  int rough = 0;
  for (int o = 0; o < s->n_outputs; o++) {
    double line = 0.5 * (at_lo[o] + at_hi[o]);
    rough |= fabs(at_mid[o] - line) > TOLERANCE * fmax(line, at_mid[o]);
  }
  if (!rough || depth == 0) return SHB_OK;
  SHB_TRY(record(s, mid, later));
  SHB_TRY(refine(s, lo, at_lo, mid, at_mid, depth - 1, later + 1));
  return refine(s, mid, at_mid, hi, at_hi, depth - 1, later);
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

/* Values at which the limit is computed in any case, ascending. */
typedef struct {
  double *at;
  int     n;
} grid;

static int by_value(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* A uniform grid, the natural frequencies, and the ends of their half-power widths.
 *   narrowest  out  the least half width, INFINITY without resonances */
static void make_grid(const sampler *s, grid *g, double *narrowest) {
  const mhb_balance *b    = s->balance;
  const double       from = mhb_parameter_end(b->settings, b->parameter, 0);
  const double       to   = mhb_parameter_end(b->settings, b->parameter, 1);
  const int          n    = first_grid(b);
  mhb_resonances     all;
  *narrowest = INFINITY;
  mhb_resonances_of_limit(b, s->stuck, from, to, &all);
  g->at = shb_alloc((size_t)n + 1 + 3 * (size_t)all.n, sizeof *g->at);
  g->n  = 0;
  for (int i = 0; i <= n; i++) g->at[g->n++] = i == n ? to : from + i * ((to - from) / n);
  for (int i = 0; i < all.n; i++) {
    *narrowest = fmin(*narrowest, all.at[i].half_width);
    for (int side = -1; side <= 1; side++) {
      const double value = all.at[i].value + side * all.at[i].half_width;
      if (value > from && value < to) g->at[g->n++] = value;
    }
  }
  mhb_resonances_destroy(&all);
  qsort(g->at, (size_t)g->n, sizeof *g->at, by_value);
  int kept = 1;
  for (int i = 1; i < g->n; i++)
    if (g->at[i] - g->at[kept - 1] > 1e-12 * fabs(to)) g->at[kept++] = g->at[i];
  g->at[kept - 1] = to;
  g->n            = kept;
}

/* Halvings of an interval: to a small part of the narrowest resonance. */
static int depth_of(double length, double narrowest) {
  return (int)fmin(MOST_DEPTH, fmax(LEAST_DEPTH, ceil(log2(length / (0.05 * narrowest)))));
}

static shb_status sample_grid(sampler *s, const grid *g, double narrowest) {
  double at_lo[s->n_outputs + 1], at_hi[s->n_outputs + 1];
  SHB_TRY(amplitudes(s, g->at[0], at_lo));
  SHB_TRY(record(s, g->at[0], 0));
  for (int i = 1; i < g->n; i++) {
    const double lo = g->at[i - 1], hi = g->at[i];
    SHB_TRY(amplitudes(s, hi, at_hi));
    SHB_TRY(record(s, hi, 0));
    SHB_TRY(refine(s, lo, at_lo, hi, at_hi, depth_of(hi - lo, narrowest), 1));
    memcpy(at_lo, at_hi, sizeof at_lo);
  }
  return SHB_OK;
}

static shb_status sample(sampler *s) {
  grid   g = {0};
  double narrowest;
  make_grid(s, &g, &narrowest);
  const shb_status status = sample_grid(s, &g, narrowest);
  free(g.at);
  return status;
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
  sampler s         = {.balance   = balance,
                       .response  = response,
                       .branch    = branch,
                       .stuck     = response->branch[branch].kind == MHB_BRANCH_STUCK,
                       .n_outputs = all_outputs(balance)};
  s.x               = shb_alloc_zeroed((size_t)balance->n, sizeof(double));
  shb_status status = sample(&s);
  free(s.x);
  SHB_TRY(status);
  mark_peaks(&response->branch[branch], balance, response->n_probes, response->n_harmonics);
  response->branch[branch].reason   = shb_text("end of range");
  response->branch[branch].complete = true;
  return SHB_OK;
}
