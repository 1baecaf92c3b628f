#include "postproc/report/ring_data.h"

#include <math.h>

#include "mhb/response/ring_description.h"

enum { PANELS = 12 };

/* Point of a curve that is shown: the highest of a main one. -1: none. */
static int shown_point(const mhb_response *r, const mhb_branch *b) {
  const int least = mhb_ring_most_localised(r, b),
            each  = r->n_probes > 0 ? r->n_probes : r->n_pairs;
  int    best     = -1;
  double most     = 0;
  if (b->kind != MHB_BRANCH_NONLINEAR || least < 0) return -1;
  if (b->origin != MHB_FROM_END) return least;
  for (int i = 0; i < b->n_points; i++)
    for (int place = 0; place < each; place += each / r->ring) {
      const double amplitude = mhb_response_amplitude(r, b, i, place);
      if (amplitude > most) best = i;
      most = fmax(most, amplitude);
    }
  return best;
}

/* Places of a blade. */
static int places_of(const mhb_response *r) {
  return (r->n_probes > 0 ? r->n_probes : r->n_pairs) / r->ring;
}

static void put_panel(const mhb_response *r, int branch, int point, bool first, post_buffer *out) {
  const mhb_branch *b = &r->branch[branch];
  post_put(out, "%s{\"n0\":%.9g,\"value\":%.9g,\"branch\":%d,\"kind\":", first ? "" : ",",
           b->n0[point], b->value[point], branch);
  post_put_json(out, mhb_ring_kind_name(b->ring_kind[point]));
  post_put(out, ",\"stable\":%s,\"amplitude\":[", b->stable[point] == 0 ? "false" : "true");
  for (int i = 0; i < r->ring; i++)
    post_put(out, "%s%.7g", i ? "," : "", mhb_response_amplitude(r, b, point, i * places_of(r)));
  post_put(out, "]}");
}

static bool moves(const mhb_response *r, int branch, int point) {
  for (int i = 0; i < r->ring; i++)
    if (mhb_response_amplitude(r, &r->branch[branch], point, i * places_of(r)) > 0) return true;
  return false;
}

/* The curves of the panels: main ones first. Returns their number. */
static int choose_panels(const mhb_response *r, int branch[PANELS], int point[PANELS]) {
  int n = 0;
  for (int others = 0; others < 2; others++)
    for (int b = 0; b < r->n_branches && n < PANELS; b++) {
      if ((r->branch[b].origin != MHB_FROM_END) != (others == 1)) continue;
      const int at = shown_point(r, &r->branch[b]);
      if (at < 0 || !moves(r, b, at)) continue;
      branch[n]  = b;
      point[n++] = at;
    }
  return n;
}

int post_put_blades(const mhb_response *r, post_buffer *out) {
  int       branch[PANELS], point[PANELS];
  const int n = r->ring ? choose_panels(r, branch, point) : 0;
  if (n == 0) return 0;
  post_put(out, ",\n\"ring\":{\"panels\":[");
  for (int i = 0; i < n; i++) put_panel(r, branch[i], point[i], i == 0, out);
  post_put(out, "]}");
  return n;
}

static bool is_result(const mhb_samples *s, int at) {
  return s->factor[at] > 0 && !s->mark[at];
}

bool post_put_factors(const mhb_samples *s, post_buffer *out) {
  bool any = false;
  for (int p = 0; s && p < s->preloads; p++)
    any = any || mhb_samples_done(s, p) - mhb_samples_marked(s, p) > 1;
  if (!any) return false;
  for (int p = 0; p < s->preloads; p++) {
    const char *comma = "";
    post_put(out, p ? ",{\"n0\":%.9g,\"factor\":[" : ",\n\"factors\":[{\"n0\":%.9g,\"factor\":[",
             s->n0[p]);
    for (int i = p * s->n; i < (p + 1) * s->n; i++) {
      if (!is_result(s, i)) continue;
      post_put(out, "%s%.9g", comma, s->factor[i]);
      comma = ",";
    }
    post_put(out, "]}");
  }
  post_put(out, "]");
  return true;
}
