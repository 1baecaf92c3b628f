#include "postproc/report/csv.h"
#include "mhb/response/ring_description.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "postproc/analysis/outputs.h"
#include "postproc/analysis/response_analysis.h"

static void put_number(post_buffer *out, double value) {
  post_put(out, isfinite(value) ? ",%.12g" : ",", value);
}

/* ",PLACE_SUFFIX" */
static void put_name(post_buffer *out, const char *place, const char *part, const char *suffix) {
  char name[256];
  snprintf(name, sizeof name, "%s%s%s", place, part, suffix);
  post_put(out, ",");
  post_put_csv(out, name);
}

static void place_names(post_buffer *out, const char *place, const char *const axis[3]) {
  for (int i = 0; i < 3; i++) {
    put_name(out, place, axis[i], "_amplitude_m");
    put_name(out, place, axis[i], "_phase_deg");
    put_name(out, place, axis[i], "_peak_to_peak_m");
  }
  put_name(out, place, "_motion", "_amplitude_m");
  put_name(out, place, "_motion", "_peak_to_peak_m");
}

/* Column name of the followed parameter, if it has none of its own. */
static const char *followed(const mhb_response *response) {
  static const char *const names[MHB_N_PARAMETERS] = {NULL, NULL,     "scale",
                                                      "mu", "ku_N_m", "kv_N_m"};
  return names[response->parameter];
}

static void put_header(const mhb_response *response, post_buffer *out) {
  static const char *const probe[3]   = {"_tangential", "_axial", "_radial"};
  static const char *const contact[3] = {"_v", "_u", "_w"};
  post_put(out, "branch,kind,n0_N,frequency_Hz");
  if (response->run_up) post_put(out, ",speed_rpm");
  for (int i = 0; i < response->n_interfaces; i++)
    put_name(out, "n0_", response->interface_name[i], "_N");
  if (followed(response)) post_put(out, ",%s", followed(response));
  if (response->ring)
    post_put(out,
             ",worst_blade,worst_amplitude_m,mean_amplitude_m,"
             "ring_motion,participation,load_wave_share,standing_share");
  for (int q = 0; q < response->n_probes; q++) place_names(out, response->probe_name[q], probe);
  for (int p = 0; p < response->n_pairs; p++) {
    char place[128];
    post_contact_name(response, p, "", place);
    place_names(out, place, contact);
    put_name(out, place, "_stuck", "");
    put_name(out, place, "_slipping", "");
    put_name(out, place, "_open", "");
    put_name(out, place, "_dissipation_J", "");
  }
  post_put(
      out,
      ",stable,special,judged,loss,largest_multiplier,iterations,seconds,error_newton,error_"
      "truncation,error_truncation_max,error_sampling,"
      "error_modal,error_spatial,origin,order,lasting_mean,lasting_worst,lasting_kind,lasting_side,"
      "lasting_offset\r\n");
}

/* The columns of one place from its harmonics, [3][m + 1]. */
static void put_place(const mhb_response *response, const mhb_branch *branch,
                      const double complex *a, post_buffer *out) {
  int m = branch->n_harmonics, first = mhb_response_harmonic(response, branch);
  for (int i = 0; i < 3; i++) {
    const double complex *axis = a + i * (m + 1);
    put_number(out, cabs(axis[first]));
    put_number(out, carg(axis[first]) * 180 / SHB_PI);
    put_number(out, post_peak_to_peak(1, m, axis));
  }
  put_number(out, post_semi_major_axis(3, a + first, m + 1));
  put_number(out, post_peak_to_peak(3, m, a));
}

/* Basis of the stability, kind of its loss, largest multiplier; empty for the linear limits. */
static void put_stability(const mhb_response *response, const mhb_branch *branch, int point,
                          post_buffer *out) {
  static const char *const judged[] = {"no",        "multipliers", "marginal",
                                       "undecided", "neighbours",  "folds"};
  static const char *const loss[]   = {"", "fold", "flip", "Neimark-Sacker"};
  int                      kept     = response->n_multipliers;
  const bool               flip     = response->track && strcmp(response->track, "flip") == 0;
  if (branch->kind == MHB_BRANCH_TRACKED && branch->multiplier) {
    post_put(
        out, ",multipliers,%s",
        branch->stable[point] == 0 ? "" : loss[flip ? MHB_LOSS_FLIP : MHB_LOSS_NEIMARK_SACKER]);
    put_number(out, cabs(branch->multiplier[point]));
    return;
  }
  if (branch->kind != MHB_BRANCH_NONLINEAR) {
    post_put(out, ",,,");
    return;
  }
  int  how      = branch->judged[point];
  bool computed = kept > 0 && cabs(branch->multipliers[(size_t)point * (size_t)kept]) > 0;
  post_put(out, ",%s,%s", judged[how], loss[branch->loss[point]]);
  put_number(out, computed ? cabs(branch->multipliers[(size_t)point * (size_t)kept]) : NAN);
}

/* Motion that lasts; empty where it was not computed. */
static void put_lasting(const mhb_branch *branch, int point, post_buffer *out) {
  static const char *const kind[] = {"",          "wave",      "mildly modulated",
                                     "modulated", "irregular", "several motions"};
  if (branch->kind != MHB_BRANCH_NONLINEAR || !branch->lasting_kind[point]) {
    post_put(out, ",,,,,");
    return;
  }
  put_number(out, branch->lasting_mean[point]);
  put_number(out, branch->lasting_worst[point]);
  post_put(out, ",%s", kind[branch->lasting_kind[point]]);
  bool found = branch->lasting_side[point] >= 0;
  put_number(out, found ? branch->lasting_side[point] : NAN);
  put_number(out, found ? branch->lasting_offset[point] : NAN);
}

static void put_quality(const mhb_response *response, const mhb_branch *branch, int point,
                        post_buffer *out) {
  static const char *const origin[] = {"end", "search", "flip", "aside"};
  post_put(out, branch->stable[point] < 0 ? "," : ",%d", branch->stable[point]);
  post_put(out, ",%s", mhb_special_name(branch->special[point]));
  put_stability(response, branch, point, out);
  post_put(out, ",%d", branch->iterations[point]);
  put_number(out, branch->seconds[point]);
  put_number(out, branch->error_newton[point]);
  put_number(out, branch->error_truncation[point]);
  put_number(out, branch->error_truncation_max && branch->error_truncation_max[point] >= 0
                      ? branch->error_truncation_max[point]
                      : NAN);
  put_number(out, branch->error_sampling[point]);
  put_number(out, branch->error_modal[point]);
  put_number(out, post_spatial_error(branch, point));
  post_put(out, ",%s,%d", origin[branch->origin], branch->order);
  put_lasting(branch, point, out);
  post_put(out, "\r\n");
}

/* Of a ring of different blades: the one that swings highest, and the mean. */
static void put_ring(const mhb_response *response, const mhb_branch *branch, int point,
                     post_buffer *out) {
  const int first = post_first_harmonic(branch);
  for (post_place place = POST_PLACE_WORST; place <= POST_PLACE_MEAN; place++) {
    const post_output output = {place, 0, POST_WHOLE};
    if (place == POST_PLACE_WORST) post_put(out, ",%d", post_worst_blade(response, branch, point));
    put_number(out, post_amplitude(response, branch, point, output, first));
  }
  const bool known = branch->ring_kind != NULL;
  post_put(out, ",%s", known ? mhb_ring_kind_name(branch->ring_kind[point]) : "");
  put_number(out, known ? branch->ring_participation[point] : NAN);
  put_number(out, known ? branch->ring_wave[(size_t)point * (size_t)response->ring] : NAN);
  put_number(out, known ? branch->ring_standing[point] : NAN);
}

static void put_point(const mhb_response *response, int b, int point, post_buffer *out) {
  const mhb_branch *branch = &response->branch[b];
  size_t            m1 = (size_t)branch->n_harmonics + 1, i = (size_t)point;
  size_t            pairs = (size_t)response->n_pairs, probes = (size_t)response->n_probes;
  post_put(out, "%d,%s", b, mhb_branch_kind_name(branch->kind));
  bool nonlinear = branch->kind != MHB_BRANCH_OPEN && branch->kind != MHB_BRANCH_STUCK;
  put_number(out, nonlinear || response->parameter == MHB_IN_N0 ? branch->n0[point] : NAN);
  put_number(out, branch->frequency[point]);
  if (response->run_up) put_number(out, 60 * branch->frequency[point] / response->engine_order);
  for (size_t k = 0; k < (size_t)response->n_interfaces; k++)
    put_number(out, branch->interface_n0[i * (size_t)response->n_interfaces + k]);
  if (followed(response)) put_number(out, branch->value[point]);
  if (response->ring) put_ring(response, branch, point, out);
  for (size_t q = 0; q < probes; q++)
    put_place(response, branch, branch->probe + (i * probes + q) * 3 * m1, out);
  for (size_t p = 0; p < pairs; p++) {
    put_place(response, branch, branch->motion + (i * pairs + p) * 3 * m1, out);
    for (size_t s = 0; s < 3; s++) put_number(out, branch->state[(i * pairs + p) * 3 + s]);
    put_number(out, branch->dissipation[i * pairs + p]);
  }
  put_quality(response, branch, point, out);
}

void post_csv(const mhb_response *response, post_buffer *out) {
  put_header(response, out);
  for (int b = 0; b < response->n_branches; b++)
    for (int p = 0; p < response->branch[b].n_points; p++) put_point(response, b, p, out);
}
