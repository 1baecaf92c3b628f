#include "mhb/branches/secondary_branches.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/balance/subharmonics.h"
#include "mhb/branches/harmonic_selection.h"
#include "mhb/branches/multistart.h"
#include "mhb/branches/period_doubling.h"
#include "mhb/numerics/fourier.h"

static const double TOLERANCE = 1e-10;

/* Beyond this the balance of twice the order is regular: what flips has not the form of its wave. */
static const double SINGULAR = .1;

/* The doubled branch that ends here, relative to the parameter and the motion, is the one that leaves from here. */
static const double SAME_VALUE = 2e-3, SAME_MOTION = 3e-2;

/* With harmonics: auto, those that solutions are looked for with, times the order. */
enum { LOOK_HARMONICS = 7, N_PLACES = 6, MAX_SITES = 16 };

/* Everything for one order. */
typedef struct {
  int              order; /* in all: times the main branch's */
  mhb_settings     settings;
  mhb_balance     *residual;
  mhb_newton      *newton;
  mhb_solution_set found; /* at the value at hand */
} site;

typedef struct {
  const modal_model  *model;
  const mhb_settings *settings;
  mhb_response       *response;
  int                 main;
  mhb_monitor        *monitor;
  int                 n_sites;
  site               *sites[MAX_SITES];
  int                 n_further, further[MHB_MAX_SECONDARY]; /* branches appended */
  bool                go_on;
} hunt;

bool mhb_secondary_branches_wanted(const mhb_settings *s) {
  return s->search.starts > 0 || (s->flips && s->stability != MHB_STABILITY_NEVER);
}

static void lock(hunt *h, bool locked) {
  h->monitor->lock(h->monitor, locked);
}

static mhb_branch *branch_at(const hunt *h, int index) {
  return &h->response->branch[index];
}

/* ---- the balance of an order ---- */

static void site_destroy(site *s) {
  mhb_solution_set_free(&s->found);
  mhb_newton_destroy(s->newton);
  mhb_balance_destroy(s->residual);
  free(s);
}

/* Highest harmonic that a branch of this order may have. */
static int most_harmonics(const hunt *h, const site *s) {
  int m[MHB_MAX_LEVELS], n = mhb_harmonic_levels_ladder(h->model, &s->settings, m);
  return m[n - 1];
}

static int look_harmonics(const hunt *h, const site *s) {
  int m[MHB_MAX_LEVELS], n = mhb_harmonic_levels_ladder(h->model, &s->settings, m), i = 0;
  if (!(s->settings.motion_tolerance > 0)) return m[0];
  while (i + 1 < n && m[i] < LOOK_HARMONICS * s->order) i++;
  return m[i];
}

/* SHB_ERR_INPUT: a wave of that many periods does not close around the ring. */
static shb_status site_fill(hunt *h, site *s) {
  const mhb_settings *asked = h->settings;
  s->settings               = *asked;
  s->settings.subharmonics  = s->order;
  s->settings.harmonics     = asked->harmonics * s->order / asked->subharmonics;
  s->settings.harmonics     = look_harmonics(h, s);
  SHB_TRY(mhb_balance_create(h->model, &s->settings, &s->residual));
  mhb_balance_set_preload(s->residual, branch_at(h, h->main)->n0[0]);
  mhb_balance_set_parameter(s->residual, asked->parameter);
  return mhb_newton_create(s->residual->n, &s->newton);
}

/* *out: NULL if there is no such wave. */
static shb_status site_of(hunt *h, int order, site **out) {
  *out = NULL;
  for (int i = 0; i < h->n_sites; i++)
    if (h->sites[i]->order == order) *out = h->sites[i];
  if (*out || h->n_sites == MAX_SITES) return SHB_OK;
  site *s = calloc(1, sizeof *s);
  SHB_CHECK(s, SHB_ERR_IO, "out of memory");
  s->order = order;
  lock(h, true); /* FFTW's planner */
  shb_status status = site_fill(h, s);
  if (status != SHB_OK) site_destroy(s);
  lock(h, false);
  if (status == SHB_ERR_INPUT) return SHB_OK;
  SHB_TRY(status);
  h->sites[h->n_sites++] = *out = s;
  return SHB_OK;
}

/* ---- solutions of recorded branches ---- */

/* Point i with its share of the next, as a solution of the site's order; its own order divides that. */
static void take(const hunt *h, const mhb_branch *b, int i, double share, const site *s,
                 double *x) {
  int    rows = 3 * h->response->n_pairs, m = b->n_harmonics, nb = mhb_real_size(m);
  int    next = i + 1 < b->n_points ? i + 1 : i;
  double own[rows * nb];
  for (int row = 0; row < rows; row++) {
    const double complex *a =
        b->motion + ((size_t)i * (size_t)rows + (size_t)row) * (size_t)(m + 1);
    const double complex *c =
        b->motion + ((size_t)next * (size_t)rows + (size_t)row) * (size_t)(m + 1);
    double complex A[m + 1];
    for (int k = 0; k <= m; k++) A[k] = (1 - share) * a[k] + share * c[k];
    mhb_to_real(m, A, own + row * nb);
  }
  mhb_subharmonic_embed(rows, own, m, s->order / b->order, x, s->residual->m);
}

/* A point's value of the parameter, as the residual takes it. */
static double value_at(const hunt *h, const mhb_branch *b, int point) {
  return mhb_parameter_value(h->settings->parameter, b->value[point]);
}

/* Where the branch crosses a value between points i and i + 1: the solution there becomes known. */
static shb_status know_crossing(const hunt *h, const mhb_branch *b, int i, double share, site *s,
                                double value) {
  const double shares[] = {share, 0, 1};
  double       x[s->residual->n];
  int          iterations;
  for (int k = 0; k < 3; k++) {
    take(h, b, i, shares[k], s, x);
    if (mhb_newton_solve(s->newton, s->residual, value, TOLERANCE, x, &iterations) == MHB_CONVERGED)
      return mhb_solution_set_add_shifts(&s->found, s->residual, x);
  }
  return SHB_OK;
}

static shb_status know_branch(const hunt *h, const mhb_branch *b, site *s, double value) {
  if (s->order % b->order) return SHB_OK;
  for (int i = 0; i + 1 < b->n_points; i++) {
    double from = value_at(h, b, i) - value, to = value_at(h, b, i + 1) - value;
    if (from * to > 0 || (from == 0 && to == 0)) continue;
    SHB_TRY(know_crossing(h, b, i, from / (from - to), s, value));
  }
  return SHB_OK;
}

/* All but one, -1: none. */
static shb_status know_all(const hunt *h, site *s, double value, int but) {
  s->found.n_found = 0;
  SHB_TRY(know_branch(h, branch_at(h, h->main), s, value));
  for (int i = 0; i < h->n_further; i++)
    if (h->further[i] != but) SHB_TRY(know_branch(h, branch_at(h, h->further[i]), s, value));
  return SHB_OK;
}

/* ---- following ---- */

static shb_status append(hunt *h, const site *s, mhb_origin origin, int *index) {
  lock(h, true);
  shb_status status = mhb_response_branch(h->response, MHB_BRANCH_NONLINEAR, index);
  if (status == SHB_OK) {
    mhb_branch *b  = branch_at(h, *index);
    b->origin      = origin;
    b->order       = s->order;
    b->n_harmonics = most_harmonics(h, s);
    b->main        = h->main;
  }
  lock(h, false);
  return status;
}

/* Whether the middle of a branch lies on another one: it ran into that, or is that, followed from its other end. */
static shb_status is_another(hunt *h, site *s, int index, bool *another) {
  const mhb_branch *b     = branch_at(h, index);
  int               point = b->n_points / 2, iterations;
  double            value = value_at(h, b, point), x[s->residual->n];
  take(h, b, point, 0, s, x);
  *another = false;
  if (mhb_newton_solve(s->newton, s->residual, value, TOLERANCE, x, &iterations) != MHB_CONVERGED)
    return SHB_OK;
  SHB_TRY(know_all(h, s, value, index));
  *another = mhb_solution_set_has(&s->found, x);
  return SHB_OK;
}

/* Without a point, to be dropped at the end: other branches keep their places. */
static void forget(hunt *h, int index) {
  lock(h, true);
  branch_at(h, index)->n_points = 0;
  lock(h, false);
}

static shb_status follow(hunt *h, site *s, mhb_origin origin, const mhb_start *start) {
  int  index;
  bool none, another = false;
  if (h->n_further == MHB_MAX_SECONDARY) return SHB_OK;
  SHB_TRY(append(h, s, origin, &index));
  h->further[h->n_further++] = index;
  SHB_TRY(mhb_trace_branch(s->residual, h->response, index, h->monitor, start, &none));
  const char *reason = branch_at(h, index)->reason;
  if (reason && strncmp(reason, "interrupted", 11) == 0) h->go_on = false;
  if (!none && h->go_on) SHB_TRY(is_another(h, s, index, &another));
  if (another) forget(h, index);
  return SHB_OK;
}

/* ---- doubled periods ---- */

/* Whether a doubled branch that was followed ends at the motion x. */
static bool is_followed(const hunt *h, site *s, const double *x, double value) {
  double end[s->residual->n], size = mhb_norm(x, s->residual->n);
  for (int i = 0; i < h->n_further; i++) {
    const mhb_branch *b = branch_at(h, h->further[i]);
    if (b->origin != MHB_FROM_FLIP || b->n_points == 0) continue;
    if (fabs(value_at(h, b, b->n_points - 1) - value) > SAME_VALUE * fabs(value)) continue;
    take(h, b, b->n_points - 1, 0, s, end);
    for (int k = 0; k < s->residual->n; k++) end[k] -= x[k];
    if (mhb_norm(end, s->residual->n) < SAME_MOTION * size) return true;
  }
  return false;
}

static shb_status follow_flip(hunt *h, site *s, int point) {
  const mhb_branch *main  = branch_at(h, h->main);
  int               n     = s->residual->n, iterations;
  double            value = value_at(h, main, point), least;
  double            x[n], part[n], along[n];
  take(h, main, point, 0, s, x);
  if (is_followed(h, s, x, value)) return SHB_OK;
  if (mhb_newton_solve(s->newton, s->residual, value, TOLERANCE, x, &iterations) != MHB_CONVERGED)
    return SHB_OK;
  mhb_subharmonic_component(s->residual, x, s->order / 2, part);
  for (int i = 0; i < n; i++) x[i] -= part[i];
  SHB_TRY(mhb_period_doubling_direction(s->residual, x, value, along, &least));
  if (!(least < SINGULAR)) return SHB_OK;
  return follow(h, s, MHB_FROM_FLIP, &(mhb_start){x, value, along});
}

static shb_status follow_flips(hunt *h) {
  site *s = NULL;
  for (int i = 0; h->go_on && i < branch_at(h, h->main)->n_points; i++) {
    if (branch_at(h, h->main)->special[i] != MHB_FLIP) continue;
    if (!s) SHB_TRY(site_of(h, 2 * h->settings->subharmonics, &s));
    if (!s) return SHB_OK;
    SHB_TRY(follow_flip(h, s, i));
  }
  return SHB_OK;
}

/* ---- search ---- */

/* A solution of the site is followed as one of the lowest order that it is, of those that the main branch's divides. */
static shb_status follow_found(hunt *h, site *s, const double *x, double value) {
  int least = mhb_subharmonic_period(s->residual, x), base = h->settings->subharmonics,
      order = base;
  site *own = s;
  while (order < s->order && (s->order % order || order % least)) order += base;
  if (order < s->order) SHB_TRY(site_of(h, order, &own));
  if (!own) return SHB_OK;
  double narrow[own->residual->n];
  mhb_subharmonic_restrict(3 * s->residual->n_pairs, x, s->residual->m, s->order / order, narrow,
                           own->residual->m);
  return follow(h, own, MHB_FROM_SEARCH, &(mhb_start){narrow, value, NULL});
}

/* Motion that the contact takes notice of: the gap or the approach at rest, and what the known branches do. */
static double usual_size(const hunt *h, const site *s) {
  const mhb_settings *c   = h->settings;
  double              top = c->kv > 0 ? fabs(branch_at(h, h->main)->n0[0]) / c->kv : 0;
  for (int f = 0; f < s->found.n_found; f++) {
    double most = 0;
    for (int i = 0; i < s->found.n; i++) most = fmax(most, fabs(s->found.x[f * s->found.n + i]));
    top = fmax(top, most);
  }
  return top;
}

static bool still_looking(hunt *h, double value, double share) {
  if (!h->monitor->looking) return true;
  lock(h, true);
  h->go_on = h->go_on && h->monitor->looking(h->monitor, h->main, value, share);
  lock(h, false);
  return h->go_on;
}

static shb_status look_at(hunt *h, site *s, double value, unsigned long long seed, double share) {
  static const double sizes[] = {1, 2, 4, .5};
  double              x[s->residual->n];
  SHB_TRY(know_all(h, s, value, -1));
  double size = usual_size(h, s);
  if (!(size > 0)) return SHB_OK;
  for (int i = 0; i < h->settings->search.starts && still_looking(h, value, share); i++) {
    bool is_new;
    SHB_TRY(mhb_multistart_once(s->newton, s->residual, value, size * sizes[i % 4], &seed,
                                &s->found, x, &is_new));
    if (!is_new) continue;
    SHB_TRY(follow_found(h, s, x, value));
    SHB_TRY(know_all(h, s, value, -1));
    SHB_TRY(mhb_solution_set_add_shifts(&s->found, s->residual, x)); /* whatever became of it */
  }
  return SHB_OK;
}

/* Evenly over the range unless given. */
static double place(const mhb_settings *s, int i) {
  double low = mhb_parameter_end(s, s->parameter, 0), high = mhb_parameter_end(s, s->parameter, 1);
  if (s->search.n_at > 0) return mhb_parameter_value(s->parameter, s->search.at[i]);
  return low + (i + .5) / N_PLACES * (high - low);
}

static shb_status look_everywhere(hunt *h) {
  const mhb_search_settings *c = &h->settings->search;
  int                        n = c->n_at ? c->n_at : N_PLACES;
  for (int o = 0; c->starts > 0 && o < c->n_orders && h->go_on; o++) {
    site *s;
    SHB_TRY(site_of(h, c->order[o] * h->settings->subharmonics, &s));
    for (int i = 0; s && i < n && h->go_on; i++)
      SHB_TRY(look_at(h, s, place(h->settings, i), (unsigned long long)(1000 * c->order[o] + i + 1),
                      (double)(o * n + i) / (c->n_orders * n)));
  }
  return SHB_OK;
}

shb_status mhb_secondary_branches(const modal_model *model, const mhb_settings *settings,
                                  mhb_response *response, int main, mhb_monitor *monitor) {
  hunt       h      = {.model    = model,
                       .settings = settings,
                       .response = response,
                       .main     = main,
                       .monitor  = monitor,
                       .go_on    = true};
  shb_status status = SHB_OK;
  for (int i = 0; i < response->n_branches; i++)
    if (response->branch[i].main == main && i != main) h.further[h.n_further++] = i;
  if (branch_at(&h, main)->n_points > 0) {
    if (settings->flips) status = follow_flips(&h);
    if (status == SHB_OK) status = look_everywhere(&h);
  }
  lock(&h, true);
  if (status == SHB_OK && h.go_on) branch_at(&h, main)->searched = true;
  for (int i = 0; i < h.n_sites; i++) site_destroy(h.sites[i]);
  lock(&h, false);
  return status;
}
