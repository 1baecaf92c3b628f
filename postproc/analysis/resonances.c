#include "postproc/analysis/resonances.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Peaks below this part of the highest of their curve are not followed. */
static const double LEAST = 0.01;
/* A resonance without a peak of a linear limit has one as high as this somewhere. */
static const double NOTABLE = 0.1;
/* Cost of a peak without a partner, as high as the highest of its curve. */
static const double ALONE = 0.5;

enum { MOST_PEAKS = 32, MOST_CHAINS = 64 }; /* of a curve, of all curves */

/* The peaks of one group, by rising frequency. */
typedef struct {
  int              n;
  double           highest;
  post_track_point peak[MOST_PEAKS];
} column;

/* A resonance on its way: its points, and the last of them. */
typedef struct {
  post_tracking tracking;
  double        at, height; /* of the last peak: Hz, over the highest of its curve */
  double        highest;    /* of all heights */
} chain;

typedef struct {
  const post_analysis *analysis;
  double *const       *values;
  int                  n_chains;
  chain                chain[MOST_CHAINS];
} work;

static const post_track_point NONE = {NAN, NAN, NAN, -1, -1, false, false, false, false};

/* ---------------------------------------------------------------- peaks of a curve */

static int by_place(const void *left, const void *right) {
  const post_track_point *a = left, *b = right;
  return (a->at > b->at) - (a->at < b->at);
}

/* Add a peak; of too many the lowest is left out. */
static void add(column *c, post_track_point peak) {
  int at = c->n;
  if (c->n == MOST_PEAKS) {
    at = 0;
    for (int i = 1; i < c->n; i++)
      if (c->peak[i].amplitude < c->peak[at].amplitude) at = i;
    if (c->peak[at].amplitude >= peak.amplitude) return;
  } else {
    c->n++;
  }
  c->peak[at] = peak;
  c->highest  = fmax(c->highest, peak.amplitude);
}

static shb_status fill(const work *w, int group, column *c) {
  const mhb_response *r = w->analysis->response;
  *c                    = (column){0};
  for (int b = 0; b < r->n_branches; b++) {
    const mhb_branch *branch = &r->branch[b];
    post_peak        *peak   = NULL;
    int               n;
    if (w->analysis->curve[b].group != group || branch->kind == MHB_BRANCH_INTEGRATION) continue;
    SHB_TRY(post_find_peaks(branch->n_points, branch->frequency, w->values[b], &peak, &n));
    for (int i = 0; i < n; i++)
      if (!peak[i].edge && !mhb_branch_marked(branch, peak[i].point))
        add(c, (post_track_point){w->analysis->group[group].n0, peak[i].at, peak[i].amplitude, b,
                                  peak[i].point, false, false, branch->complete, false});
    free(peak);
  }
  int kept = 0;
  for (int i = 0; i < c->n; i++)
    if (c->peak[i].amplitude >= LEAST * c->highest) c->peak[kept++] = c->peak[i];
  c->n = kept;
  qsort(c->peak, (size_t)c->n, sizeof *c->peak, by_place);
  return SHB_OK;
}

/* ---------------------------------------------------------------- joining */

static int by_last_place(const void *left, const void *right) {
  const chain *a = left, *b = right;
  return (a->at > b->at) - (a->at < b->at);
}

/* partner[i] <- the chain of peak i, or -1, at the least cost in order of frequency. */
static void match(const work *w, const column *c, int partner[MOST_PEAKS]) {
  enum { ALONE_PEAK = 1, ALONE_CHAIN, JOINED };
  const int n = c->n, m = w->n_chains;
  double    cost[MOST_PEAKS + 1][MOST_CHAINS + 1];
  int       way[MOST_PEAKS + 1][MOST_CHAINS + 1];
  for (int i = 0; i <= n; i++)
    for (int j = 0; j <= m; j++) {
      const post_track_point *p = i > 0 ? &c->peak[i - 1] : NULL;
      const chain            *k = j > 0 ? &w->chain[j - 1] : NULL;
      cost[i][j]                = i || j ? INFINITY : 0;
      way[i][j]                 = 0;
      double alone              = i ? cost[i - 1][j] + ALONE * p->amplitude / c->highest : INFINITY;
      double ended              = j ? cost[i][j - 1] + ALONE * k->height : INFINITY;
      double both               = i && j ? cost[i - 1][j - 1] + fabs(log(p->at / k->at)) : INFINITY;
      double least              = fmin(alone, fmin(ended, both));
      if (!i && !j) continue;
      cost[i][j] = least;
      way[i][j]  = least == both ? JOINED : least == alone ? ALONE_PEAK : ALONE_CHAIN;
    }
  for (int i = n, j = m; i > 0 || j > 0;) {
    int one = way[i][j];
    if (one != ALONE_CHAIN) partner[i - 1] = one == JOINED ? j - 1 : -1;
    if (one != ALONE_CHAIN) i--;
    if (one != ALONE_PEAK) j--;
  }
}

static void extend(chain *k, const work *w, int group, const column *c, int i) {
  post_tracking *t = &k->tracking;
  k->at            = c->peak[i].at;
  k->height        = c->peak[i].amplitude / c->highest;
  k->highest       = fmax(k->highest, k->height);
  if (w->analysis->group[group].kind == MHB_BRANCH_OPEN)
    t->open = c->peak[i];
  else if (w->analysis->group[group].kind == MHB_BRANCH_STUCK)
    t->stuck = c->peak[i];
  else
    t->point[t->n++] = c->peak[i];
}

static shb_status take_group(work *w, int group) {
  column c;
  int    partner[MOST_PEAKS];
  SHB_TRY(fill(w, group, &c));
  if (c.n > 0) match(w, &c, partner);
  for (int i = 0; i < c.n; i++) {
    chain *k = partner[i] >= 0 ? &w->chain[partner[i]] : NULL;
    if (!k && w->n_chains == MOST_CHAINS) continue;
    if (!k) {
      k                 = &w->chain[w->n_chains++];
      *k                = (chain){.tracking = {.open = NONE, .stuck = NONE, .best = -1}};
      k->tracking.point = calloc((size_t)w->analysis->n_groups, sizeof *k->tracking.point);
      SHB_CHECK(k->tracking.point, SHB_ERR_IO, "not enough memory for the resonances");
    }
    extend(k, w, group, &c, i);
  }
  qsort(w->chain, (size_t)w->n_chains, sizeof *w->chain, by_last_place);
  return SHB_OK;
}

static shb_status take_kind(work *w, mhb_branch_kind kind) {
  for (int g = 0; g < w->analysis->n_groups; g++) { /* nonlinear ones by rising preload */
    const post_group *group = &w->analysis->group[g];
    bool              known = kind != MHB_BRANCH_NONLINEAR || group->rank >= 0;
    if (group->kind == kind && known) SHB_TRY(take_group(w, g));
  }
  return SHB_OK;
}

/* ---------------------------------------------------------------- what is a resonance */

/* Join b to a: at each preload the higher peak. */
static void join(const post_track_point *b, int n, post_tracking *a) {
  for (int i = 0; i < n; i++) {
    int at = 0;
    while (at < a->n && a->point[at].n0 < b[i].n0) at++;
    bool same = at < a->n && a->point[at].n0 == b[i].n0;
    if (same && a->point[at].amplitude >= b[i].amplitude) continue;
    if (!same) {
      memmove(a->point + at + 1, a->point + at, (size_t)(a->n - at) * sizeof *a->point);
      a->n++;
    }
    a->point[at] = b[i];
  }
}

/* A contact that slips may split a peak in two, and end the lower. So a chain from the open limit
 * that ends, and the next that comes to the stuck limit without an open peak, are one resonance. */
static void join_halves(work *w) {
  for (int i = 0; i + 1 < w->n_chains; i++) {
    post_tracking *a = &w->chain[i].tracking, *b = &w->chain[i + 1].tracking;
    bool halves = a->open.amplitude > 0 && !(a->stuck.amplitude > 0) && b->stuck.amplitude > 0 &&
                  !(b->open.amplitude > 0);
    if (!halves) continue;
    join(b->point, b->n, a);
    a->stuck            = b->stuck;
    w->chain[i].highest = fmax(w->chain[i].highest, w->chain[i + 1].highest);
    post_tracking_free(b);
    memmove(&w->chain[i + 1], &w->chain[i + 2], (size_t)(w->n_chains - i - 2) * sizeof(chain));
    w->n_chains--;
  }
}

static bool is_resonance(const work *w, const chain *k) {
  const post_tracking *t       = &k->tracking;
  bool                 limited = t->open.amplitude > 0 || t->stuck.amplitude > 0;
  return 2 * t->n >= w->analysis->n_ranks && (limited || k->highest >= NOTABLE);
}

shb_status post_resonances_find(const post_analysis *analysis, double *const *values,
                                post_resonances *out) {
  work      *w      = calloc(1, sizeof *w);
  shb_status status = SHB_OK;
  *out              = (post_resonances){0};
  SHB_CHECK(w, SHB_ERR_IO, "not enough memory for the resonances");
  w->analysis = analysis;
  w->values   = values;
  if (!post_at_one_frequency(analysis) && !analysis->response->track && analysis->n_ranks > 0) {
    status = take_kind(w, MHB_BRANCH_OPEN);
    if (status == SHB_OK) status = take_kind(w, MHB_BRANCH_NONLINEAR);
    if (status == SHB_OK) status = take_kind(w, MHB_BRANCH_STUCK);
  }
  out->list = calloc(MOST_CHAINS, sizeof *out->list);
  if (!out->list) status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  join_halves(w);
  for (int k = 0; k < w->n_chains; k++) {
    post_tracking *t = &w->chain[k].tracking;
    if (status == SHB_OK && is_resonance(w, &w->chain[k])) {
      post_tracking_optimum(false, t);
      out->list[out->n++] = *t;
    } else {
      post_tracking_free(t);
    }
  }
  free(w);
  if (status != SHB_OK) post_resonances_free(out);
  return status;
}

shb_status post_resonances_add(post_analysis *analysis) {
  return post_resonances_find(analysis, analysis->values, &analysis->resonances);
}

int post_resonance_of(const post_resonances *r, int branch, int point) {
  for (int i = 0; i < r->n; i++) {
    const post_tracking *t = &r->list[i];
    if (t->open.branch == branch && t->open.point == point) return i;
    if (t->stuck.branch == branch && t->stuck.point == point) return i;
    for (int k = 0; k < t->n; k++)
      if (t->point[k].branch == branch && t->point[k].point == point) return i;
  }
  return -1;
}
