#include "postproc/analysis/outputs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/numerics/extent.h"

enum { AXES = 3 };

double post_semi_major_axis(int n, const double complex *a, int stride) {
  return mhb_semi_major_axis(n, a, stride);
}

double post_rss(int n, const double complex *a, int stride) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += pow(cabs(a[i * stride]), 2);
  return sqrt(sum);
}

double post_peak_to_peak(int n, int m, const double complex *a) {
  return mhb_extent_of(n, m, a).length;
}

post_output post_output_primary(const mhb_response *response) {
  if (response->ring) return (post_output){POST_PLACE_WORST, 0, POST_WHOLE};
  if (response->output && strcmp(response->output, "contact") == 0)
    return (post_output){POST_PLACE_CONTACT, 0, POST_WHOLE};
  for (int i = 0; response->output && i < response->n_probes; i++)
    if (strcmp(response->output, response->probe_name[i]) == 0)
      return (post_output){POST_PLACE_PROBE, i, POST_WHOLE};
  return (post_output){response->n_probes > 0 ? POST_PLACE_PROBE : POST_PLACE_CONTACT, 0,
                       POST_WHOLE};
}

int post_first_harmonic(const mhb_branch *branch) {
  int first = branch->order > 1 ? branch->order : 1;
  return first <= branch->n_harmonics ? first : branch->n_harmonics;
}

post_quantity post_quantity_primary(const mhb_response *response) {
  static const post_quantity of[] = {[MHB_OUTPUT_HARMONIC]     = POST_QUANTITY_FIRST_HARMONIC,
                                     [MHB_OUTPUT_PEAK_TO_PEAK] = POST_QUANTITY_PEAK_TO_PEAK,
                                     [MHB_OUTPUT_RSS]          = POST_QUANTITY_RSS};
  return of[response->quantity];
}

void post_quantity_name(const mhb_response *response, post_quantity quantity, char out[32]) {
  snprintf(out, 32, "first harmonic");
  if (quantity == POST_QUANTITY_PEAK_TO_PEAK) {
    snprintf(out, 32, "peak to peak");
    return;
  }
  if (response->output_harmonic > 1) snprintf(out, 32, "harmonic %d", response->output_harmonic);
  if (quantity == POST_QUANTITY_RSS) strncat(out, ", rss", 31 - strlen(out));
}

/* Harmonics of an output at a point: [n][m + 1]. */
static const double complex *harmonics_of(const mhb_response *response, const mhb_branch *branch,
                                          int point, post_output output, int *n) {
  bool                  probe  = output.place == POST_PLACE_PROBE;
  size_t                places = (size_t)(probe ? response->n_probes : response->n_pairs);
  const double complex *all    = probe ? branch->probe : branch->motion;
  size_t                at     = ((size_t)point * places + (size_t)output.index) * AXES +
              (size_t)(output.axis < 0 ? 0 : output.axis);
  *n = output.axis < 0 ? AXES : 1;
  return all + at * (size_t)(branch->n_harmonics + 1);
}

/* The first probe of a blade, or its first contact. */
static post_output on_blade(const mhb_response *response, int blade, int axis) {
  const bool probe = response->n_probes > 0;
  const int  each  = (probe ? response->n_probes : response->n_pairs) / response->ring;
  return (post_output){probe ? POST_PLACE_PROBE : POST_PLACE_CONTACT, blade * each, axis};
}

int post_worst_blade(const mhb_response *response, const mhb_branch *branch, int point) {
  const int first = post_first_harmonic(branch);
  double    most  = -1;
  int       worst = 0;
  for (int b = 0; b < response->ring; b++) {
    const double a =
        post_amplitude(response, branch, point, on_blade(response, b, POST_WHOLE), first);
    if (a > most) {
      most  = a;
      worst = b;
    }
  }
  return worst;
}

/* An output of the worst blade as that of this blade. */
static post_output resolve(const mhb_response *response, const mhb_branch *branch, int point,
                           post_output output) {
  if (output.place != POST_PLACE_WORST) return output;
  return on_blade(response, post_worst_blade(response, branch, point), output.axis);
}

static double amplitude_of(const mhb_response *response, const mhb_branch *branch, int point,
                           post_output output, post_quantity quantity, int k) {
  int                   n, m = branch->n_harmonics;
  const double complex *a = harmonics_of(response, branch, point, output, &n);
  if (quantity == POST_QUANTITY_PEAK_TO_PEAK) return post_peak_to_peak(n, m, a);
  if (k > m) return 0;
  return quantity == POST_QUANTITY_RSS ? post_rss(n, a + k, m + 1)
                                       : post_semi_major_axis(n, a + k, m + 1);
}

/* The amplitude, or its mean over the blades. */
static double value_of(const mhb_response *response, const mhb_branch *branch, int point,
                       post_output output, post_quantity quantity, int k) {
  double mean = 0;
  if (output.place != POST_PLACE_MEAN)
    return amplitude_of(response, branch, point, resolve(response, branch, point, output), quantity,
                        k);
  for (int b = 0; b < response->ring; b++)
    mean += amplitude_of(response, branch, point, on_blade(response, b, output.axis), quantity, k) /
            response->ring;
  return mean;
}

double post_amplitude(const mhb_response *response, const mhb_branch *branch, int point,
                      post_output output, int k) {
  return value_of(response, branch, point, output, POST_QUANTITY_FIRST_HARMONIC, k);
}

shb_status post_series(const mhb_response *response, const mhb_branch *branch, post_output output,
                       post_quantity quantity, double **values) {
  int     points = branch->n_points, first = mhb_response_harmonic(response, branch);
  double *out = malloc((size_t)(points > 0 ? points : 1) * sizeof *out);
  SHB_CHECK(out, SHB_ERR_IO, "not enough memory for a curve of %d points", points);
  for (int p = 0; p < points; p++) out[p] = value_of(response, branch, p, output, quantity, first);
  *values = out;
  return SHB_OK;
}

void post_place_name(const mhb_response *response, post_output output, char out[128]) {
  if (output.place == POST_PLACE_WORST || output.place == POST_PLACE_MEAN) {
    const char *name = response->n_probes > 0 ? response->probe_name[0] : "contact";
    const char *dot  = response->n_probes > 0 ? strrchr(name, '.') : NULL; /* "tip.0" */
    snprintf(out, 128, "%.*s, %s", dot ? (int)(dot - name) : (int)strlen(name), name,
             output.place == POST_PLACE_WORST ? "worst blade" : "mean of the blades");
    return;
  }
  if (output.place == POST_PLACE_PROBE)
    snprintf(out, 128, "%s", response->probe_name[output.index]);
  else
    post_contact_name(response, output.index, " ", out);
}

void post_contact_name(const mhb_response *response, int pair, const char *gap, char out[128]) {
  const int  *which = response->interface;
  const char *name  = which ? response->interface_name[which[pair]] : "contact";
  int         n = 0, place = 0;
  for (int p = 0; p < response->n_pairs; p++) {
    if (which && which[p] != which[pair]) continue;
    n++;
    place += p <= pair;
  }
  if (n == 1)
    snprintf(out, 128, "%s", name);
  else
    snprintf(out, 128, "%s%s%d", name, gap, place);
}

const char *post_axis_name(post_output output) {
  static const char *const probe[]   = {"motion", "tangential", "axial", "radial"};
  static const char *const contact[] = {"relative motion", "v, normal", "u, sliding", "w, sliding"};
  return (output.place == POST_PLACE_CONTACT ? contact : probe)[output.axis + 1];
}
