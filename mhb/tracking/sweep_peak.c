#include "mhb/tracking/sweep_peak.h"

#include <math.h>
#include <string.h>

#include "mhb/branches/record.h"

/* Relative frequency within which a located peak is that of a curve interpolated linearly. */
static const double LOCATED = 5e-4;

/* Contacts stick for this share of the period at least. */
static const double NO_SLIP = 0.998;

/* Between three points some pair begins to slip, or all stick at one of them. */
static bool some_pair_sticks(const mhb_branch *branch, int n_pairs, int first) {
  int all[3] = {0};
  for (int pair = 0; pair < n_pairs; pair++) {
    int times = 0;
    for (int i = 0; i < 3; i++) {
      const double *state = branch->state + 3 * ((first + i) * n_pairs + pair);
      const bool    stuck = state[MHB_STICK] >= NO_SLIP;
      times += stuck;
      all[i] += stuck;
    }
    if (times == 1 || times == 2) return true;
  }
  return all[0] == n_pairs || all[1] == n_pairs || all[2] == n_pairs;
}

/* The top of the parabola through three points, if it lies between the outer ones. */
static void interpolate(const double f[3], const double a[3], mhb_sweep_peak *peak) {
  const double left = f[0] - f[1], right = f[2] - f[1];
  if (!(left * right < 0)) return; /* the curve turns */
  const double down = (a[0] - a[1]) / left, up = (a[2] - a[1]) / right;
  const double bend = (up - down) / (right - left);
  if (!(bend < 0)) return;
  const double to = 0.5 * (left - down / bend); /* slope down + bend (2 to - left) = 0 */
  if (!((to - left) * (to - right) < 0)) return;
  peak->frequency = f[1] + to;
  peak->amplitude = a[1] + to * (down + bend * (to - left));
  peak->weight[0] = to * (to - right) / (left * (left - right));
  peak->weight[2] = to * (to - left) / (right * (right - left));
  peak->weight[1] = 1 - peak->weight[0] - peak->weight[2];
}

bool mhb_sweep_peak_at(const mhb_response *sweep, const mhb_branch *branch, int point, int output,
                       bool outline, mhb_sweep_peak *peak) {
  double f[3], a[3];
  *peak = (mhb_sweep_peak){.branch = branch, .point = point, .weight = {0, 1, 0}};
  for (int i = 0; i < 3; i++) {
    f[i] = branch->frequency[point - 1 + i];
    a[i] = mhb_response_amplitude(sweep, branch, point - 1 + i, output);
  }
  if (a[0] > a[1] || a[2] > a[1]) return false;
  peak->sticks    = some_pair_sticks(branch, sweep->n_pairs, point - 1);
  peak->frequency = f[1];
  peak->amplitude = a[1];
  peak->reach     = LOCATED;
  if (!outline) return true;
  if (!peak->sticks) interpolate(f, a, peak);
  for (int i = 0; i < 3; i++) peak->reach = fmax(peak->reach, fabs(f[i] / peak->frequency - 1));
  return true;
}

void mhb_sweep_peak_motion(const mhb_sweep_peak *peak, const mhb_balance *balance, double *x,
                           double *work) {
  memset(x, 0, sizeof *x * (size_t)balance->n);
  for (int i = 0; i < 3; i++) {
    if (peak->weight[i] == 0) continue;
    mhb_recorded_motion(peak->branch, peak->point - 1 + i, balance, work);
    for (int j = 0; j < balance->n; j++) x[j] += peak->weight[i] * work[j];
  }
}
