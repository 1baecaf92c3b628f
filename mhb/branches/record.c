#include "mhb/branches/record.h"

#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/search/ring_motion.h"
#include "mhb/structure/ring_receptance.h"

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
    mhb_balance_update_probes(b, k); /* it may have been at another frequency since */
    mhb_receptance_probe(b->receptance, k, p, motion);
    for (int s = 0; s < q; s++)
      branch->probe[((size_t)point * (size_t)q + (size_t)s) * (size_t)K + (size_t)k] = motion[s];
  }
}

/* A pair that sticks has a mean friction only where it reaches the friction limit. */
static bool is_at_limit(const mhb_balance *b, int a) {
  const mhb_contact_info *info = &b->eval->info[a];
  const double           *p    = b->eval->p + 3 * (size_t)a * (size_t)b->nb;
  return info->share[MHB_STICK] == 1 && info->undetermined && (p[b->nb] != 0 || p[2 * b->nb] != 0);
}

/* A pair sticks throughout although it can slip. */
static bool has_free_mean(const mhb_balance *b, int a) {
  const mhb_law *law = &b->law[a];
  return law->mu > 0 && (law->ku[0] > 0 || law->ku[2] > 0) && b->eval->info[a].undetermined;
}

static bool has_undetermined_friction(const mhb_balance *b) {
  const mhb_ring_receptance *ring = b->receptance->ring;
  bool                       free_mean[b->n_pairs];
  double                     share[3 * b->n_pairs];
  for (int a = 0; a < b->n_pairs; a++) {
    free_mean[a] = has_free_mean(b, a);
    memcpy(share + 3 * a, b->eval->info[a].share, 3 * sizeof *share);
  }
  return mhb_friction_loads_others(b->n_pairs, ring ? ring->ring->n_pairs : b->n_pairs, free_mean,
                                   share);
}

static int mark_of(const mhb_balance *b, const mhb_curve_point *point) {
  const double tolerance = b->settings->motion_tolerance;
  int          mark      = has_undetermined_friction(b) ? MHB_TRACTION_UNDETERMINED : 0;
  if (!isfinite(point->truncation)) return mark | MHB_ERROR_NOT_JUDGED;
  return tolerance > 0 && point->truncation > tolerance ? mark | MHB_ABOVE_TOLERANCE : mark;
}

static void record_states(mhb_branch *branch, int point, const mhb_balance *b) {
  double worst = 0;
  for (int a = 0; a < b->n_pairs; a++) {
    size_t at = (size_t)point * (size_t)b->n_pairs + (size_t)a;
    memcpy(branch->state + 3 * at, b->eval->info[a].share, sizeof b->eval->info[a].share);
    branch->dissipation[at] = b->eval->info[a].dissipation;
    worst                   = fmax(worst, b->eval->info[a].error);
    if (branch->at_limit) branch->at_limit[point] += is_at_limit(b, a);
  }
  branch->error_sampling[point] = worst;
}

/* How the motion is spread over the blades of a ring. */
static void record_ring(const mhb_response *response, mhb_branch *branch, int point,
                        const mhb_balance *b) {
  const int N      = response->ring;
  double   *energy = branch->ring_energy + (size_t)point * (size_t)N;
  double   *wave   = branch->ring_wave + (size_t)point * (size_t)N;
  mhb_ring_motion_energies(b, energy, wave, &branch->ring_standing[point]);
  branch->ring_participation[point] = mhb_ring_participation(N, energy);
  branch->ring_kind[point] =
      mhb_ring_kind_of(branch->ring_participation[point], wave[0], branch->ring_standing[point]);
}

void mhb_record(mhb_response *response, int index, mhb_balance *b, const mhb_curve_point *point,
                int special, double seconds) {
  int at;
  mhb_balance_use(b, point->evaluation);
  mhb_response_widen(response, &response->branch[index], b->m);
  at                    = mhb_response_point(response, index);
  mhb_branch *branch    = &response->branch[index];
  branch->frequency[at] = b->eval->at.omega / SHB_TWO_PI;
  branch->n0[at]        = b->eval->at.n0;
  for (int i = 0; i < response->n_interfaces; i++)
    branch->interface_n0[at * response->n_interfaces + i] = b->eval->own[i].n0;
  branch->value[at]        = mhb_parameter_shown(b->parameter, point->value);
  branch->special[at]      = special;
  branch->stable[at]       = -1; /* until the branch is judged */
  branch->iterations[at]   = point->iterations;
  branch->seconds[at]      = seconds;
  branch->error_newton[at] = point->residual;
  record_signals(response, branch, at, b, point->x);
  record_states(branch, at, b);
  branch->error_truncation[at] = point->truncation;
  if (branch->error_truncation_max) branch->error_truncation_max[at] = point->truncation_max;
  if (branch->harmonics) branch->harmonics[at] = b->m;
  if (branch->error_spatial) branch->error_spatial[at] = -1;
  if (branch->error_multiplier) branch->error_multiplier[at] = -1;
  if (branch->truncation_kind) branch->truncation_kind[at] = point->truncation_kind;
  branch->error_modal[at] = point->modal;
  branch->mark[at]        = mark_of(b, point);
  if (branch->ring_kind) record_ring(response, branch, at, b);
}

void mhb_recorded_motion(const mhb_branch *branch, int point, const mhb_balance *b, double *x) {
  size_t                K = (size_t)branch->n_harmonics + 1, rows = 3 * (size_t)b->n_pairs;
  size_t                n_common = K < (size_t)b->m + 1 ? K : (size_t)b->m + 1;
  const double complex *A        = branch->motion + (size_t)point * rows * K;
  memset(x, 0, sizeof *x * (size_t)b->n);
  for (size_t row = 0; row < rows; row++)
    for (size_t k = 0; k < n_common; k++) {
      double *to = x + row * (size_t)b->nb;
      if (k > 0) to[2 * k] = cimag(A[row * K + k]);
      to[k > 0 ? 2 * k - 1 : 0] = creal(A[row * K + k]);
    }
}
