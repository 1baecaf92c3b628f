#include "postproc/analysis/tracked_findings.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mhb/problem/parameter.h"
#include "postproc/draw/number_format.h"

bool post_optimum_told(const mhb_response *r) {
  const mhb_optimum *o = &r->optimum;
  for (int b = 0; b < r->n_branches; b++) {
    const mhb_branch *branch = &r->branch[b];
    int               next   = 0;
    if (branch->kind != MHB_BRANCH_TRACKED || branch->n_points == 0) continue;
    for (int p = 1; p < branch->n_points; p++)
      if (fabs(branch->value[p] - o->value) < fabs(branch->value[next] - o->value)) next = p;
    if (mhb_branch_marked(branch, next)) return false;
  }
  return o->kind != MHB_OPTIMUM_NONE;
}

/* "n₀ = 11.842285 N", with the digits that the bracket allows. */
static void put_value(const post_analysis *analysis, const char *name, post_buffer *out) {
  const mhb_response *r = analysis->response;
  const mhb_optimum  *o = &r->optimum;
  char                number[POST_NUMBER];
  const char         *unit   = mhb_parameter_unit(r->parameter);
  double              ratio  = o->error > 0 ? fabs(o->value) / o->error : 1e8;
  int                 digits = (int)fmax(3, fmin(8, floor(log10(ratio))));
  post_put(out, "%s = %s%s%s", name, post_plain(number, o->value, digits), unit[0] ? "\u00a0" : "",
           unit);
}

/* "0.59 mm", "1.12 mm peak to peak" */
static void put_amplitude(const mhb_response *r, post_buffer *out) {
  const double amplitude = r->optimum.amplitude;
  char         number[POST_NUMBER];
  post_put(out, "%s%s", post_measure(number, amplitude, post_unit_length(amplitude), 4),
           r->quantity == MHB_OUTPUT_PEAK_TO_PEAK ? " peak to peak"
           : r->quantity == MHB_OUTPUT_RSS        ? " (rss)"
                                                  : "");
}

void post_tracked_figure(const post_analysis *analysis, post_buffer *out) {
  const mhb_optimum *o = &analysis->response->optimum;
  char               f[POST_NUMBER];
  if (o->kind == MHB_OPTIMUM_NONE) return;
  if (!post_optimum_told(analysis->response)) {
    post_put(out,
             "<div class=\"figure\"><dt>Least highest peak</dt><dd><b>not known</b><span>its "
             "estimated error is above the tolerance</span></dd></div>\n");
    return;
  }
  post_put(out, "<div class=\"figure\"><dt>Least highest peak, ");
  put_value(analysis, analysis->abscissa.name, out);
  post_put(out, "</dt><dd><b>");
  put_amplitude(analysis->response, out);
  post_put(out, "</b><span>at %s\u00a0Hz</span></dd></div>\n", post_plain(f, o->frequency[0], 6));
}

static void put_kind(const post_analysis *analysis, post_buffer *out) {
  const mhb_optimum *o = &analysis->response->optimum;
  char               f[2][POST_NUMBER];
  switch (o->kind) {
    case MHB_OPTIMUM_EXCHANGE:
      post_put(out, "Two peaks are equally high there, at %s and %s\u00a0Hz: a kink. ",
               post_plain(f[0], o->frequency[0], 6), post_plain(f[1], o->frequency[1], 6));
      break;
    case MHB_OPTIMUM_END:
      post_put(out, "This is an end of the range: a wider one may hold a lower peak. ");
      break;
    case MHB_OPTIMUM_JUMP:
      post_put(out, "A curve of peaks ends there, and the peak beyond was not followed. ");
      break;
    default:
      break;
  }
}

/* The least and the largest of values over all points of all curves. */
static void extent(const mhb_response *r, bool of_frequency, double range[2]) {
  range[0] = INFINITY;
  range[1] = -INFINITY;
  for (int b = 0; b < r->n_branches; b++) {
    const mhb_branch *branch = &r->branch[b];
    for (int i = 0; i < branch->n_points; i++) {
      double at = of_frequency ? branch->frequency[i] : branch->value[i];
      range[0]  = fmin(range[0], at);
      range[1]  = fmax(range[1], at);
    }
  }
}

/* Flips and Neimark-Sacker points: where there are any, and what they border. */
static void put_crossings(const post_analysis *analysis, post_buffer *out) {
  const mhb_response *r    = analysis->response;
  const bool          flip = strcmp(r->track, "flip") == 0;
  const char         *unit = mhb_parameter_unit(r->parameter);
  int                 n = 0, border = 0;
  double              value[2], frequency[2];
  char                a[4][POST_NUMBER];
  for (int b = 0; b < r->n_branches; b++) {
    n += r->branch[b].n_points;
    for (int i = 0; i < r->branch[b].n_points; i++) border += r->branch[b].stable[i] == 1;
  }
  if (n == 0) {
    post_put(out, "<li>The sweeps have no %s point.</li>\n", flip ? "flip" : "Neimark-Sacker");
    return;
  }
  extent(r, false, value);
  extent(r, true, frequency);
  post_put(out,
           "<li>At each point %s: the motion %s on one side. Such points are found from %s = %s to "
           "%s%s%s, at %s to %s\u00a0Hz.</li>\n",
           flip ? "a Floquet multiplier is −1" : "a pair of Floquet multipliers has modulus 1",
           flip ? "doubles its period" : "is modulated", analysis->abscissa.name,
           post_plain(a[0], value[0], 6), post_plain(a[1], value[1], 6), unit[0] ? "\u00a0" : "",
           unit, post_plain(a[2], frequency[0], 6), post_plain(a[3], frequency[1], 6));
  post_put(out,
           "<li>At %d of %d points no other multiplier is outside the unit circle: they border the "
           "stable motions.</li>\n",
           border, n);
}

/* Why each curve of such points ends. */
static void put_ends(const mhb_response *r, post_buffer *out) {
  char a[2][POST_NUMBER];
  for (int b = 0; b < r->n_branches; b++) {
    const mhb_branch *branch = &r->branch[b];
    if (branch->n_points == 0 || !branch->reason) continue;
    post_put(out, "<li>Curve %d, from %s to %s%s%s: ", b + 1, post_plain(a[0], branch->value[0], 6),
             post_plain(a[1], branch->value[branch->n_points - 1], 6),
             mhb_parameter_unit(r->parameter)[0] ? "\u00a0" : "", mhb_parameter_unit(r->parameter));
    post_put(out, "%s.</li>\n", branch->reason);
  }
}

void post_tracked_findings(const post_analysis *analysis, post_buffer *out) {
  const mhb_response *r = analysis->response;
  const mhb_optimum  *o = &r->optimum;
  char                error[POST_NUMBER];
  if (!r->track) return;
  if (r->tracks_multiplier) {
    put_crossings(analysis, out);
    put_ends(r, out);
    return;
  }
  if (post_optimum_told(r)) {
    post_put(out, "<li>The highest peak is least at ");
    put_value(analysis, analysis->abscissa.name, out);
    post_put(out, ": ");
    put_amplitude(r, out);
    if (o->error > 0)
      post_put(out, ". It lies in a bracket of %s%s%s", post_number(error, o->error, 1),
               mhb_parameter_unit(r->parameter)[0] ? "\u00a0" : "",
               mhb_parameter_unit(r->parameter));
    post_put(out, ". ");
    put_kind(analysis, out);
    post_put(out, "%s</li>\n",
             o->verified ? "A frequency sweep there finds no higher peak."
                         : "No frequency sweep has confirmed that no higher peak exists there.");
  }
  post_put(out,
           "<li>Each point is a %s of the frequency response; its frequency is an unknown. "
           "Stability is not judged on these curves.</li>\n",
           r->track);
}

void post_tracked_summary(const post_analysis *analysis, post_buffer *out) {
  const mhb_response *r = analysis->response;
  const mhb_optimum  *o = &r->optimum;
  char                f[POST_NUMBER];
  if (o->kind == MHB_OPTIMUM_NONE) return;
  if (!post_optimum_told(r)) {
    post_put(out, "%soptimum not known: its estimated error is above the tolerance",
             out->length ? "; " : "");
    return;
  }
  post_put(out, "%soptimum ", out->length ? "; " : "");
  put_value(analysis, mhb_parameter_name(r->parameter), out);
  post_put(out, ": ");
  put_amplitude(r, out);
  post_put(out, " at %s Hz%s", post_plain(f, o->frequency[0], 6),
           o->verified ? "" : ", not verified");
}
