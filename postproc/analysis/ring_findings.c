#include "postproc/analysis/ring_findings.h"

#include <math.h>
#include <stdbool.h>

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

/* "n0 = 12 N: median 1.2, 95 % below 1.4 (1.3 to 1.6)": one item a preload. */
static void put_samples(const mhb_samples *s, int preload, post_buffer *out) {
  char   text[4][POST_NUMBER], n0[POST_NUMBER];
  double median[3], high[3];
  mhb_samples_quantile(s, preload, 0.5, median);
  mhb_samples_quantile(s, preload, 0.95, high);
  const int worst = mhb_samples_worst(s, preload);
  if (worst < 0) return;
  post_put(
      out,
      "<li>%d random rings, n0 = %s\u00a0N: the factor's median is %s; 95\u00a0%% are below %s",
      mhb_samples_done(s, preload), post_plain(n0, s->n0[preload], 4),
      post_plain(text[0], median[0], 4), post_plain(text[1], high[0], 4));
  if (isfinite(high[1]) && isfinite(high[2]))
    post_put(out, " (%s to %s with 95\u00a0%% confidence)", post_plain(text[2], high[1], 4),
             post_plain(text[3], high[2], 4));
  post_put(out, "; the largest is %s (sample %d).</li>\n",
           post_plain(text[2], s->factor[preload * s->n + worst], 4), worst);
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

void post_put_ring(const post_analysis *analysis, post_buffer *out) {
  const mhb_response *r    = analysis->response;
  const int           most = extreme(r, 1), least = extreme(r, -1);
  if (!r->ring || most < 0) return;
  post_put(out, "<li>%d blades that differ: the worst blade's peak is ", r->ring);
  put_factor(&r->branch[most], out);
  if (least != most) {
    post_put(out, " to ");
    put_factor(&r->branch[least], out);
  }
  post_put(out, " that of equal blades. Blades count from 0. Stability is not judged.</li>\n");
  if (tuned_at_end(&r->branch[most]))
    post_put(out,
             "<li>Equal blades are highest at an end of the range, where they have no peak: "
             "widen the range before the factor is used.</li>\n");
  for (int i = 0; r->samples && i < r->samples->preloads; i++) put_samples(r->samples, i, out);
}
