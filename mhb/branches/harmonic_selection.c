#include "mhb/branches/harmonic_selection.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of the tolerance: what an estimate may be; what a lower rung must promise; error of the first-order estimate. */
static const double SAFETY = .7, PROMISE = .35, FIRST_ORDER = 3;

/* Share of the period that is nearly all of it. */
static const double MOSTLY = .75;

/* A move that ends farther off, relative to the motion, has met another branch. */
static const double NEAR                  = .3;
static const int    STEPS[MHB_MAX_LEVELS] = {1, 3, 5, 7, 9, 13, 17, 21, 31};
enum { QUIET = 3, HOLD = 6, ONSET = 7 };

/* Highest harmonic of the fundamental that the load has, at least nu. */
static int load_harmonics(const modal_model *model, const mhb_settings *s) {
  int top = 1;
  for (int h = 2; h <= model->n_load; h++) {
    double size = 0;
    for (int i = 0; i < model->n_modes; i++)
      size += cabs(model->modal_force[h * model->n_modes + i]);
    if (size > 0) top = h;
  }
  return top * s->subharmonics;
}

int mhb_harmonic_levels_ladder(const modal_model *model, const mhb_settings *s,
                               int m[MHB_MAX_LEVELS]) {
  int n = 0, least = load_harmonics(model, s);
  m[0] = s->harmonics;
  if (!(s->motion_tolerance > 0)) return 1;
  for (int i = 0; i < MHB_MAX_LEVELS; i++) {
    int next = (int)fmin(MHB_MOST_HARMONICS, STEPS[i] * s->subharmonics);
    if (next >= least && (n == 0 || next > m[n - 1])) m[n++] = next;
  }
  if (n == 0) m[n++] = least;
  return n;
}

static void rung_destroy(mhb_harmonic_level *r) {
  if (!r) return;
  mhb_truncation_destroy(r->truncation);
  mhb_arclength_destroy(r->path);
  if (r->owned) mhb_balance_destroy(r->residual);
  free(r);
}

/* residual: NULL, or the one to use. */
static shb_status rung_create(const mhb_harmonic_levels *h, int m, mhb_balance *residual,
                              mhb_harmonic_level **out) {
  mhb_harmonic_level *r = calloc(1, sizeof *r);
  SHB_CHECK(r, SHB_ERR_IO, "out of memory");
  r->settings           = *h->settings;
  r->settings.harmonics = m;
  r->residual           = residual;
  r->owned              = !residual;
  shb_status status     = SHB_OK;
  if (!residual) status = mhb_balance_create(h->model, &r->settings, &r->residual);
  if (status == SHB_OK && !residual) {
    mhb_balance_set_operating_point(r->residual, &h->at_start);
    mhb_balance_set_parameter(r->residual, h->parameter);
  }
  if (status == SHB_OK) status = mhb_truncation_create(r->residual, &r->truncation);
  if (status == SHB_OK) status = mhb_arclength_create(r->residual, h->low, h->high, &r->path);
  if (status != SHB_OK) {
    rung_destroy(r);
    return status;
  }
  *out = r;
  return SHB_OK;
}

shb_status mhb_harmonic_levels_create(mhb_balance *residual, mhb_harmonic_levels **out) {
  mhb_harmonic_levels *h = calloc(1, sizeof *h);
  SHB_CHECK(h, SHB_ERR_IO, "out of memory");
  h->settings  = residual->settings;
  h->model     = residual->receptance->model;
  h->at_start  = residual->eval->at;
  h->parameter = residual->parameter;
  h->low       = mhb_parameter_end(h->settings, h->parameter, 0);
  h->high      = mhb_parameter_end(h->settings, h->parameter, 1);
  h->n         = mhb_harmonic_levels_ladder(h->model, h->settings, h->m);
  while (h->at + 1 < h->n && h->m[h->at] < residual->m) h->at++;
  h->m[h->at] = residual->m;
  h->highest = h->wanted = h->at;
  shb_status status      = rung_create(h, residual->m, residual, &h->rung[h->at]);
  if (status != SHB_OK) {
    mhb_harmonic_levels_destroy(h);
    return status;
  }
  *out = h;
  return SHB_OK;
}

void mhb_harmonic_levels_destroy(mhb_harmonic_levels *h) {
  if (!h) return;
  for (int i = 0; i < h->n; i++) rung_destroy(h->rung[i]);
  free(h);
}

shb_status mhb_harmonic_levels_make(mhb_harmonic_levels *h, int rung) {
  return h->rung[rung] ? SHB_OK : rung_create(h, h->m[rung], NULL, &h->rung[rung]);
}

/* Sum of squares of harmonic k over rows of nb coefficients. */
static double power(const double *x, int rows, int nb, int k) {
  double sum = 0;
  for (int i = 0; i < rows; i++)
    sum += x[i * nb + 2 * k - 1] * x[i * nb + 2 * k - 1] + x[i * nb + 2 * k] * x[i * nb + 2 * k];
  return sum;
}

/* share[k] = |all harmonics above k|^2, k = 0..MHB_MOST_LOOKED_AT: the solution's up to m, the estimate's beyond. */
static void tail(const mhb_harmonic_level *r, const double *x, double *share) {
  const mhb_balance *b   = r->residual;
  double             sum = 0;
  for (int k = MHB_MOST_LOOKED_AT; k > 0; k--) {
    share[k] = sum;
    sum += k <= b->m ? power(x, 3 * b->n_pairs, b->nb, k) : mhb_truncation_power(r->truncation, k);
  }
}

/* The lowest rung that promises the tolerance; above the rung in use it has no margin. */
static int choose(const mhb_harmonic_levels *h, const double *x, double error, double size) {
  double share[MHB_MOST_LOOKED_AT + 1], tolerance = h->settings->motion_tolerance * size;
  int    m = h->m[h->at];
  tail(mhb_harmonic_levels_current(h), x, share);
  double beyond = sqrt(share[m]), gain = beyond > 0 ? fmax(1, error * size / beyond) : 1;
  int    enough = error * size <= SAFETY * tolerance;
  for (int i = 0; i < h->n; i++) {
    double promised = gain * sqrt(share[h->m[i]]);
    if (i < h->at && promised <= PROMISE * tolerance) return i;
    if (i == h->at && enough) return i;
    if (i > h->at && (promised <= SAFETY * tolerance || h->m[i] > 2 * m)) return i;
  }
  return h->n - 1;
}

/* Where slip or opening begins. */
static int at_onset(const mhb_harmonic_levels *h) {
  int rung = 0;
  while (rung + 1 < h->n && h->m[rung] < ONSET * h->settings->subharmonics) rung++;
  return rung;
}

int mhb_harmonic_levels_most_unknowns(const mhb_harmonic_levels *h) {
  return 3 * h->model->n_pairs * (2 * h->m[h->n - 1] + 1);
}

/* Every pair sticks, or is open, but for a small part of the period: near where that begins or ends curves of few and of many harmonics may turn at
 * different places, however small the estimate. */
static bool barely_moves(const mhb_balance *b) {
  for (int a = 0; a < b->n_pairs; a++)
    if (b->eval->info[a].share[MHB_STICK] < MOSTLY && b->eval->info[a].share[MHB_SEPARATE] < MOSTLY)
      return false;
  return true;
}

void mhb_harmonic_levels_errors(mhb_harmonic_levels *h, mhb_curve_point *point) {
  mhb_harmonic_level *r  = mhb_harmonic_levels_current(h);
  point->truncation      = mhb_truncation_error(r->truncation, point->x);
  point->truncation_kind = r->truncation->kind;
  point->modal           = mhb_modal_error(
                r->residual, point->x,
      point->truncation_kind == MHB_TRUNCATION_NEWTON ? r->truncation->system : NULL);
}

void mhb_harmonic_levels_estimate(mhb_harmonic_levels *h, mhb_curve_point *point) {
  mhb_harmonic_level *r = mhb_harmonic_levels_current(h);
  mhb_harmonic_levels_errors(h, point);
  h->wanted = h->at;
  h->linear = point->truncation_kind == MHB_TRUNCATION_NONE;
  if (h->n == 1) return;
  double factor = point->truncation_kind == MHB_TRUNCATION_FIRST_ORDER ? FIRST_ORDER : 1;
  h->wanted =
      choose(h, point->x, factor * point->truncation, mhb_balance_vibration(r->residual, point->x));
  if (!h->linear && (h->from_linear || barely_moves(r->residual)) && h->wanted < at_onset(h))
    h->wanted = at_onset(h);
}

int mhb_harmonic_levels_higher(const mhb_harmonic_levels *h) {
  return h->wanted > h->at ? h->wanted : -1;
}

void mhb_harmonic_levels_accept(mhb_harmonic_levels *h) {
  h->from_linear = h->linear;
}

int mhb_harmonic_levels_lower(mhb_harmonic_levels *h) {
  if (!h->linear && h->quiet < 0) h->quiet = 0; /* past where slip begins */
  h->quiet = h->wanted < h->at ? h->quiet + 1 : 0;
  return h->quiet >= (h->linear ? 1 : QUIET) ? h->wanted : -1;
}

/* Rows of a solution into those of another number of harmonics; missing ones are left as they are. */
static void copy_rows(int rows, const double *from, int nb, double *to, int wide) {
  size_t length = sizeof(double) * (size_t)(nb < wide ? nb : wide);
  for (int i = 0; i < rows; i++)
    memcpy(to + (size_t)i * (size_t)wide, from + (size_t)i * (size_t)nb, length);
}

mhb_reason mhb_harmonic_levels_move(mhb_harmonic_levels *h, int rung, int step) {
  mhb_harmonic_level *from = mhb_harmonic_levels_current(h), *to = h->rung[rung];
  mhb_balance        *a = from->residual, *b = to->residual;
  mhb_curve_point    *now  = &from->path->now;
  int                 rows = 3 * a->n_pairs, wide = from->truncation->doubled->nb;
  double              x[b->n], near[b->n];
  memset(x, 0, sizeof x);
  copy_rows(rows, now->x, a->nb, x, b->nb);
  memcpy(near, x, sizeof near);
  for (int row = 0; step && row < rows; row++)
    for (int i = 0; i < wide && i < b->nb; i++)
      x[row * b->nb + i] += from->truncation->step[row * wide + i];
  mhb_reason reason =
      mhb_arclength_start(to->path, x, now->value, now->tangent[from->path->n] < 0 ? -1 : 1);
  if (reason != MHB_CONVERGED) return reason;
  double away = 0, size = mhb_norm(near, b->n);
  for (int i = 0; i < b->n; i++) away = fmax(away, fabs(to->path->now.x[i] - near[i]));
  if (away > NEAR * size) return MHB_NO_DESCENT; /* another branch */
  to->path->step = from->path->step;
  h->quiet       = rung > h->at ? -HOLD : 0; /* where slip begins few harmonics lead astray */
  h->at          = rung;
  if (rung > h->highest) h->highest = rung;
  return MHB_CONVERGED;
}
