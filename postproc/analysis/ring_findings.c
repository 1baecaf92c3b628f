#include "postproc/analysis/ring_findings.h"

#include <math.h>
#include <stdbool.h>

#include "mhb/response/ring_description.h"
#include "postproc/draw/number_format.h"

/* The main curve with the largest or the least factor; -1: none has one. */
static int extreme(const mhb_response *r, double sign) {
  int best = -1;
  for (int b = 0; b < r->n_branches; b++) {
    const double factor = r->branch[b].amplification.factor;
    if (!(factor > 0)) continue;
    if (best < 0 || sign * factor > sign * r->branch[best].amplification.factor) best = b;
  }
  return best;
}

static void put_factor(const mhb_branch *b, post_buffer *out) {
  char factor[POST_NUMBER], n0[POST_NUMBER], at[POST_NUMBER];
  post_put(out, "%s times (blade %d, %s\u00a0Hz, n0 = %s\u00a0N)",
           post_plain(factor, b->amplification.factor, 4), b->amplification.blade,
           post_plain(at, b->amplification.worst_at, 5), post_plain(n0, b->n0[0], 4));
}

/* " (1.3 to 1.6 with 95 % confidence)"; a bound that so few samples cannot give is said to lack. */
static void put_bounds(const double bounds[2], int samples, post_buffer *out) {
  char text[2][POST_NUMBER];
  for (int i = 0; i < 2; i++) post_plain(text[i], bounds[i], 4);
  if (isfinite(bounds[0]) && isfinite(bounds[1]))
    post_put(out, " (%s to %s with 95\u00a0%% confidence)", text[0], text[1]);
  else if (isfinite(bounds[0]) || isfinite(bounds[1]))
    post_put(out, " (%s %s with 97.5\u00a0%% confidence; %d samples give no %s bound)",
             isfinite(bounds[0]) ? "above" : "below", text[isfinite(bounds[0]) ? 0 : 1], samples,
             isfinite(bounds[0]) ? "upper" : "lower");
  else
    post_put(out, " (%d samples give no bound)", samples);
}

/* "n0 = 12 N: median 1.2 (1.1 to 1.3), 95 % quantile 1.4 (1.3 to 1.6)": one item a preload. */
static void put_samples(const mhb_samples *s, int preload, post_buffer *out) {
  char      text[POST_NUMBER], n0[POST_NUMBER];
  const int done = mhb_samples_done(s, preload), marked = mhb_samples_marked(s, preload);
  double    median[3], high[3];
  mhb_samples_quantile(s, preload, 0.5, median);
  mhb_samples_quantile(s, preload, 0.95, high);
  const int worst = mhb_samples_worst(s, preload);
  if (marked > 0)
    post_put(
        out,
        "<li class=\"caution\"><b>Marked:</b> of %d random rings with n0 = %s\u00a0N the peaks "
        "of %d have an estimated error above <code>mhb.tolerance</code>. Their factors may be "
        "any, and bounds allow for that.</li>\n",
        done, post_plain(n0, s->n0[preload], 4), marked);
  if (worst < 0) return;
  post_put(out, "<li>%d random rings, n0 = %s\u00a0N: the factor's median is %s", done,
           post_plain(n0, s->n0[preload], 4), post_plain(text, median[0], 4));
  put_bounds(median + 1, done, out);
  post_put(out, ", its 95\u00a0%% quantile %s", post_plain(text, high[0], 4));
  put_bounds(high + 1, done, out);
  post_put(out, "; the largest is %s (sample %d).</li>\n",
           post_plain(text, s->factor[preload * s->n + worst], 4), worst);
}

/* Whether the tuned ring is highest at an end of the curve: it then has no peak there. */
static bool tuned_at_end(const mhb_branch *b) {
  double low = INFINITY, high = -INFINITY;
  for (int p = 0; p < b->n_points; p++) {
    low  = fmin(low, b->frequency[p]);
    high = fmax(high, b->frequency[p]);
  }
  const double at = b->amplification.tuned_at, hair = 1e-9 * high;
  return at <= low + hair || at >= high - hair;
}

/* "localised: 2 of 6 blades take part (unstable), at 1.03 Hz, n0 = 3 N": one item a curve that was
 * found beside the main ones. */
static void put_motion(const post_analysis *analysis, const mhb_branch *b, post_buffer *out) {
  static const char *const verdict[] = {"not judged", "unstable", "stable"};
  char                     text[MHB_RING_TEXT], at[POST_NUMBER], n0[POST_NUMBER];
  const post_abscissa     *x     = &analysis->abscissa;
  const int                point = mhb_ring_most_localised(analysis->response, b);
  if (point < 0) return;
  mhb_ring_describe(analysis->response, b, text);
  post_put(out, "<li>Another motion of the ring, <b>%s</b>, at %s%s%s, n0 = %s\u00a0N", text,
           post_abscissa_number(x, b->value[point], 5, at), *x->unit.name ? "\u00a0" : "",
           x->unit.name, post_plain(n0, b->n0[point], 4));
  if (b->order > analysis->response->subharmonics)
    post_put(out, ", repeats after %d periods", b->order);
  post_put(out, "; %s there.</li>\n", verdict[b->stable[point] + 1]);
}

static void put_motions(const post_analysis *analysis, post_buffer *out) {
  const mhb_response *r      = analysis->response;
  int                 others = 0;
  for (int b = 0; b < r->n_branches; b++) {
    if (r->branch[b].kind != MHB_BRANCH_NONLINEAR || r->branch[b].origin == MHB_FROM_END) continue;
    put_motion(analysis, &r->branch[b], out);
    others++;
  }
  if (others > 0)
    post_put(out,
             "<li>Each of them is given where the fewest blades take part. Motions that differ "
             "by a turn of equal blades, or by periods of the excitation, are one.</li>\n");
}

void post_put_ring(const post_analysis *analysis, post_buffer *out) {
  const mhb_response *r    = analysis->response;
  const int           most = extreme(r, 1), least = extreme(r, -1);
  if (!r->ring) return;
  put_motions(analysis, out);
  if (most < 0) return;
  post_put(out, "<li>%d blades that differ: the worst blade's peak is ", r->ring);
  put_factor(&r->branch[most], out);
  if (least != most) {
    post_put(out, " to ");
    put_factor(&r->branch[least], out);
  }
  post_put(out, " that of equal blades. Blades count from 0.</li>\n");
  if (tuned_at_end(&r->branch[most]))
    post_put(out,
             "<li>Equal blades are highest at an end of the range, where they have no peak: "
             "widen the range before the factor is used.</li>\n");
  for (int i = 0; r->samples && i < r->samples->preloads; i++) put_samples(r->samples, i, out);
}
