#include "postproc/analysis/ring_findings.h"

#include <math.h>

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
}
