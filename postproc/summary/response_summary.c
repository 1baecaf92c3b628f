#include "postproc/summary/response_summary.h"

#include <math.h>
#include <stdlib.h>

#include "mhb/problem/parameter.h"
#include "postproc/analysis/findings.h"
#include "postproc/analysis/stability_findings.h"
#include "postproc/analysis/tracked_findings.h"

/* What all curves need. */
typedef struct {
  const post_analysis      *analysis;
  const post_stress_source *stress;
  post_json                *json;
} work;

static const char *verdict_name(const mhb_branch *branch, int point) {
  static const char *const name[POST_N_VERDICTS] = {"stable", "not judged", "modulated",
                                                    "unstable"};
  return name[post_verdict_of(branch, point)];
}

static const char *lasting_name(int kind) {
  static const char *const name[MHB_LASTING_KINDS] = {NULL,        "wave",      "mildly modulated",
                                                      "modulated", "irregular", "several"};
  return name[kind];
}

/* ---- one curve ---- */

static void put_lasting(const work *w, const mhb_branch *b, int point) {
  const char *name = b->lasting_kind ? lasting_name(b->lasting_kind[point]) : NULL;
  if (!name) {
    post_json_null(w->json, "lasting");
    return;
  }
  post_json_object(w->json, "lasting");
  post_json_text(w->json, "kind", name);
  post_json_number(w->json, "mean", b->lasting_mean[point]);
  post_json_number(w->json, "worst", b->lasting_worst[point]);
  if (b->lasting_starts[point] > 0) {
    post_json_integer(w->json, "starts", b->lasting_starts[point]);
    post_json_integer(w->json, "reached", b->lasting_reached[point]);
    post_json_number(w->json, "missed", mhb_response_lasting_missed(b->lasting_starts[point]));
  }
  if (b->lasting_least[point] > 0) {
    post_json_number(w->json, "least", b->lasting_least[point]);
    post_json_number(w->json, "least_worst", b->lasting_least_worst[point]);
  }
  post_json_end(w->json);
}

static shb_status put_peak(const work *w, int branch, const post_peak *peak) {
  const mhb_response *r = w->analysis->response;
  const mhb_branch   *b = &r->branch[branch];
  const int           p = peak->point;
  const bool in_hertz   = !post_at_one_frequency(w->analysis) && b->kind != MHB_BRANCH_TRACKED;
  post_json_object(w->json, "peak");
  post_json_number(w->json, "amplitude", peak->amplitude);
  post_json_number(w->json, "frequency", in_hertz ? peak->at : b->frequency[p]);
  post_json_number(w->json, "parameter", in_hertz ? NAN : peak->at);
  post_json_bool(w->json, "at_end", peak->edge);
  post_json_bool(w->json, "of_grid", post_undamped(r) > 0 && !(post_state(r, b, p, 1) > 0));
  post_json_text(w->json, "stability", verdict_name(b, p));
  post_json_number(w->json, "bandwidth", in_hertz ? peak->bandwidth : NAN);
  post_json_number(w->json, "damping", in_hertz ? peak->damping : NAN);
  post_json_number(w->json, "dissipation", post_dissipation(r, b, p));
  post_json_number(w->json, "sticking", post_state(r, b, p, 0));
  post_json_number(w->json, "slipping", post_state(r, b, p, 1));
  post_json_number(w->json, "open", post_state(r, b, p, 2));
  post_json_number(w->json, "error", post_error(b, p));
  put_lasting(w, b, p);
  SHB_TRY(post_stress_put(w->stress, b, p, w->json));
  post_json_integer(w->json, "branch", branch);
  post_json_integer(w->json, "point", p);
  post_json_end(w->json);
  return SHB_OK;
}

/* Highest peak of the branches of a group; -1 if they hold no point. */
static int highest(const post_analysis *analysis, int group, const post_peak **peak) {
  int best = -1;
  *peak    = NULL;
  for (int b = 0; b < analysis->response->n_branches; b++) {
    const post_curve *c = &analysis->curve[b];
    int               i = c->group == group ? post_highest_peak(c->n_peaks, c->peak) : -1;
    if (i < 0 || (*peak && c->peak[i].amplitude <= (*peak)->amplitude)) continue;
    *peak = &c->peak[i];
    best  = b;
  }
  return best;
}

/* Peaks of a main curve of a ring of different blades. */
static void put_amplification(const work *w, int branch) {
  const mhb_response *r    = w->analysis->response;
  const int           main = r->branch[branch].main;
  if (main < 0 || main >= r->n_branches || !(r->branch[main].amplification.factor > 0)) return;
  const mhb_amplification *a = &r->branch[main].amplification;
  post_json_object(w->json, "amplification");
  post_json_number(w->json, "factor", a->factor);
  post_json_number(w->json, "worst", a->worst);
  post_json_number(w->json, "worst_frequency", a->worst_at);
  post_json_integer(w->json, "blade", a->blade);
  post_json_number(w->json, "mean", a->mean);
  post_json_number(w->json, "mean_frequency", a->mean_at);
  post_json_number(w->json, "tuned", a->tuned);
  post_json_number(w->json, "tuned_frequency", a->tuned_at);
  post_json_end(w->json);
}

static shb_status put_curve(const work *w, int group) {
  const post_analysis *analysis = w->analysis;
  const post_group    *g        = &analysis->group[group];
  const post_peak     *peak;
  int                  branch = highest(analysis, group, &peak), folds = 0, points = 0, marked = 0;
  bool                 complete = true;
  const char          *reason   = NULL;
  for (int b = 0; b < analysis->response->n_branches; b++) {
    const mhb_branch *one = &analysis->response->branch[b];
    if (analysis->curve[b].group != group) continue;
    folds += analysis->curve[b].n_folds;
    points += one->n_points;
    for (int p = 0; p < one->n_points; p++) marked += mhb_branch_marked(one, p);
    if (complete && !one->complete) reason = one->reason;
    complete = complete && one->complete;
  }
  const bool told =
      branch >= 0 && !mhb_branch_marked(&analysis->response->branch[branch], peak->point);
  post_json_object(w->json, NULL);
  post_json_text(w->json, "kind", mhb_branch_kind_name(g->kind));
  post_json_number(w->json, "n0", g->n0);
  post_json_bool(w->json, "complete", complete);
  post_json_text(w->json, "reason", reason);
  if (told)
    SHB_TRY(put_peak(w, branch, peak));
  else
    post_json_null(w->json, "peak");
  if (branch >= 0) put_amplification(w, branch);
  post_json_integer(w->json, "folds", folds);
  post_json_integer(w->json, "points", points);
  post_json_integer(w->json, "marked", marked);
  post_json_end(w->json);
  return SHB_OK;
}

/* Distribution of the amplification factor of random rings, a preload each. */
static void put_samples(const work *w) {
  static const struct {
    const char *name;
    double      p;
  } quantile[]         = {{"median", 0.5}, {"percentile_95", 0.95}, {"percentile_99", 0.99}};
  const mhb_samples *s = w->analysis->response->samples;
  if (!s) return;
  post_json_list(w->json, "samples");
  for (int i = 0; i < s->preloads; i++) {
    const int worst = mhb_samples_worst(s, i);
    post_json_object(w->json, NULL);
    post_json_number(w->json, "n0", s->n0[i]);
    post_json_integer(w->json, "samples", mhb_samples_done(s, i));
    post_json_integer(w->json, "marked", mhb_samples_marked(s, i));
    for (int q = 0; q < 3; q++) {
      double value[3];
      mhb_samples_quantile(s, i, quantile[q].p, value);
      post_json_numbers(w->json, quantile[q].name, 3, value);
    }
    post_json_integer(w->json, "worst_sample", worst);
    post_json_number(w->json, "largest", worst < 0 ? NAN : s->factor[i * s->n + worst]);
    post_json_end(w->json);
  }
  post_json_end(w->json);
}

/* ---- the best preload ---- */

/* One whose points have an error above the tolerance has no numbers. */
static void put_tracked(const work *w, const mhb_optimum *o) {
  const bool told = post_optimum_told(w->analysis->response);
  post_json_object(w->json, "optimum");
  post_json_bool(w->json, "marked", !told);
  post_json_number(w->json, "parameter", told ? o->value : NAN);
  post_json_number(w->json, "error", told ? o->error : NAN);
  post_json_number(w->json, "amplitude", told ? o->amplitude : NAN);
  post_json_number(w->json, "frequency", told ? o->frequency[0] : NAN);
  post_json_bool(w->json, "verified", o->verified);
  post_json_end(w->json);
}

static void put_optimum(const work *w) {
  const post_tracking *t = &w->analysis->tracking;
  const mhb_optimum   *o = &w->analysis->response->optimum;
  if (o->kind != MHB_OPTIMUM_NONE) {
    put_tracked(w, o);
    return;
  }
  if (t->best < 0) {
    post_json_null(w->json, "optimum");
    return;
  }
  const post_track_point *best = &t->point[t->best];
  post_json_object(w->json, "optimum");
  post_json_number(w->json, "n0", best->n0);
  post_json_number(w->json, "amplitude", best->amplitude);
  post_json_number(w->json, "frequency", best->at);
  post_json_numbers(w->json, "bracket", 2, t->bracket);
  post_json_number(w->json, "vertex_n0", t->optimum_n0);
  post_json_number(w->json, "vertex_amplitude", t->optimum_amplitude);
  post_json_end(w->json);
}

static void put_resonance_peak(const work *w, const char *key, const post_track_point *p) {
  if (!(p->amplitude > 0)) {
    if (key) post_json_null(w->json, key);
    return;
  }
  post_json_object(w->json, key);
  post_json_number(w->json, "n0", p->n0);
  post_json_number(w->json, "frequency", p->at);
  post_json_number(w->json, "amplitude", p->amplitude);
  post_json_end(w->json);
}

static void put_resonances(const work *w) {
  const post_resonances *r = &w->analysis->resonances;
  post_json_list(w->json, "resonances");
  for (int i = 0; i < r->n; i++) {
    const post_tracking *t = &r->list[i];
    post_json_object(w->json, NULL);
    put_resonance_peak(w, "open", &t->open);
    put_resonance_peak(w, "stuck", &t->stuck);
    if (t->best >= 0) put_resonance_peak(w, "lowest", &t->point[t->best]);
    if (t->best < 0) post_json_null(w->json, "lowest");
    post_json_list(w->json, "peaks");
    for (int k = 0; k < t->n; k++) put_resonance_peak(w, NULL, &t->point[k]);
    post_json_end(w->json);
    post_json_end(w->json);
  }
  post_json_end(w->json);
}

shb_status post_response_put(const post_analysis *analysis, const post_stress_source *stress,
                             post_json *json) {
  const mhb_response *r     = analysis->response;
  const work          w     = {analysis, stress, json};
  const mhb_marks     marks = mhb_response_marks(r);
  char                place[128];
  bool                complete = true;
  for (int b = 0; b < r->n_branches; b++) complete = complete && r->branch[b].complete;
  post_place_name(r, analysis->primary, place);
  post_json_bool(json, "finished", !r->unfinished);
  post_json_bool(json, "complete", complete);
  post_json_integer(json, "undamped_modes", post_undamped(r));
  post_json_integer(json, "marked", marks.marked);
  post_json_number(json, "largest_marked_error", marks.marked > 0 ? marks.largest : NAN);
  post_json_integer(json, "engine_order", r->engine_order);
  post_json_integer(json, "blades", r->blades);
  if (r->ring) post_json_integer(json, "ring", r->ring);
  post_json_text(json, "output", place);
  post_json_text(json, "parameter", mhb_parameter_name(r->parameter));
  post_json_list(json, "curves");
  for (int g = 0; g < analysis->n_groups; g++) SHB_TRY(put_curve(&w, g));
  post_json_end(json);
  put_resonances(&w);
  put_optimum(&w);
  put_samples(&w);
  return SHB_OK;
}
