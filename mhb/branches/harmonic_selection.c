#include "mhb/branches/harmonic_selection.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/numerics/fourier.h"

/* Parts of the tolerance: an estimate that is accepted, and one that a lower level must keep. */
static const double SAFETY = 0.7, DOWNWARD_MARGIN = 0.35;

/* Factor on an estimate of first order, which can be several times too small. */
static const double FIRST_ORDER = 3;

/* Without a tolerance the curve is looked at from this error on: a hundred times the default
 * tolerance. Beside a fold the error is far more. */
static const double WITHOUT_TOLERANCE = 1e-2;

/* Share of the period that is nearly all of it. */
static const double NEARLY_ALL = 0.75;

/* A move that ends farther off, relative to the motion, has met another branch. */
static const double NEAR = 0.3;

/* The order of a tail is known to this only (mhb/balance/truncation_error). */
static const double ORDER_MARGIN          = 0.75;
static const int    STEPS[MHB_MAX_LEVELS] = {1, 3, 5, 7, 9, 13, 17, 21, 31, 45, 63, 91, 127};
enum {
  AFFORDABLE        = 1600, /* unknowns of twice the harmonics: some 0.3 s a point */
  N_USUAL           = 9,    /* steps up to MHB_USUAL_HARMONICS */
  LOWER_AFTER       = 3,    /* points in a row that ask for a lower level */
  LOWER_AFTER_ONSET = 6,    /* more of them after the level was raised */
  AT_ONSET          = 7     /* harmonics where slip begins */
};

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

/* The most harmonics that are affordable. */
static int most_harmonics(const modal_model *model, const mhb_settings *s) {
  const modal_nodal_diameters *d    = s->nodal_diameters;
  const int                    rows = 3 * (model->n_pairs > 0 ? model->n_pairs : 1);
  if (d && d->n <= d->blades / 2) return MHB_USUAL_HARMONICS;
  const int affordable = (AFFORDABLE / rows - 1) / 4;
  return affordable < MHB_MOST_HARMONICS ? affordable : MHB_MOST_HARMONICS;
}

int mhb_harmonic_levels_ladder(const modal_model *model, const mhb_settings *s,
                               int m[MHB_MAX_LEVELS]) {
  int n = 0, least = load_harmonics(model, s);
  m[0] = s->harmonics;
  if (!(s->motion_tolerance > 0)) return 1;
  for (int i = 0; i < N_USUAL; i++) {
    int next = (int)fmin(MHB_USUAL_HARMONICS, STEPS[i] * s->subharmonics);
    if (next >= least && (n == 0 || next > m[n - 1])) m[n++] = next;
  }
  if (n == 0) m[n++] = least;
  const int most = most_harmonics(model, s);
  for (int i = N_USUAL; i < MHB_MAX_LEVELS; i++)
    if (STEPS[i] > m[n - 1] && STEPS[i] <= most) m[n++] = STEPS[i];
  return n;
}

int mhb_harmonic_levels_usual(int n, const int *m) {
  while (n > 1 && m[n - 1] > MHB_USUAL_HARMONICS) n--;
  return m[n - 1];
}

static void level_destroy(mhb_harmonic_level *level) {
  if (!level) return;
  mhb_truncation_destroy(level->truncation);
  mhb_spatial_error_destroy(level->spatial);
  mhb_events_destroy(&level->events);
  mhb_arclength_destroy(level->curve);
  if (level->owns_balance) mhb_balance_destroy(level->balance);
  free(level);
}

/* balance: NULL, or the one to use. */
static shb_status level_create(const mhb_harmonic_levels *h, int m, mhb_balance *balance,
                               mhb_harmonic_level **out) {
  mhb_harmonic_level *level = shb_alloc_zeroed(1, sizeof *level);
  level->settings           = *h->settings;
  level->settings.harmonics = m;
  level->balance            = balance;
  level->owns_balance       = !balance;
  shb_status status         = SHB_OK;
  if (!balance) status = mhb_balance_create(h->model, &level->settings, &level->balance);
  if (status == SHB_OK && !balance) {
    mhb_balance_set_operating_point(level->balance, &h->at_start);
    mhb_balance_set_parameter(level->balance, h->parameter);
  }
  if (status == SHB_OK) status = mhb_truncation_create(level->balance, &level->truncation);
  if (status == SHB_OK && h->settings->other_pairs && !h->settings->outline)
    status = mhb_spatial_error_create(level->balance, &level->spatial);
  if (status == SHB_OK) level->curve = mhb_balance_curve_create(level->balance, h->low, h->high);
  if (status != SHB_OK) {
    level_destroy(level);
    return status;
  }
  level->truncation->factors = mhb_balance_curve_of(level->curve)->newton->system->ring;
  *out                       = level;
  return SHB_OK;
}

int mhb_harmonic_levels_of(const mhb_harmonic_levels *h, int m) {
  int level = 0;
  while (level + 1 < h->n && h->m[level] < m) level++;
  return level;
}

shb_status mhb_harmonic_levels_create(mhb_balance *balance, mhb_harmonic_levels **out) {
  mhb_harmonic_levels *h = shb_alloc_zeroed(1, sizeof *h);
  h->settings            = balance->settings;
  h->model               = balance->receptance->model;
  h->at_start            = balance->eval->at;
  h->parameter           = balance->parameter;
  h->low                 = mhb_parameter_end(h->settings, h->parameter, 0);
  h->high                = mhb_parameter_end(h->settings, h->parameter, 1);
  h->n                   = mhb_harmonic_levels_ladder(h->model, h->settings, h->m);
  h->at                  = mhb_harmonic_levels_of(h, balance->m);
  h->m[h->at]            = balance->m;
  h->highest = h->wanted = h->at;
  shb_status status      = level_create(h, balance->m, balance, &h->level[h->at]);
  if (status != SHB_OK) {
    mhb_harmonic_levels_destroy(h);
    return status;
  }
  *out = h;
  return SHB_OK;
}

void mhb_harmonic_levels_destroy(mhb_harmonic_levels *h) {
  if (!h) return;
  for (int i = 0; i < h->n; i++) level_destroy(h->level[i]);
  free(h);
}

shb_status mhb_harmonic_levels_use(mhb_harmonic_levels *h, int level) {
  if (!h->level[level]) SHB_TRY(level_create(h, h->m[level], NULL, &h->level[level]));
  h->at = level;
  if (level > h->highest) h->highest = level;
  return SHB_OK;
}

/* Sum of squares of harmonic k over rows of nb coefficients. */
static double power(const double *x, int rows, int nb, int k) {
  double sum = 0;
  for (int i = 0; i < rows; i++)
    sum += x[i * nb + 2 * k - 1] * x[i * nb + 2 * k - 1] + x[i * nb + 2 * k] * x[i * nb + 2 * k];
  return sum;
}

/* share[k] = |all harmonics above k|^2, k = 1..top: the solution's up to m, the estimate's
 * beyond. */
static void tail(const mhb_harmonic_level *level, const double *x, int top, double *share) {
  const mhb_balance *b   = level->balance;
  double             sum = 0;
  for (int k = top; k > 0; k--) {
    share[k] = sum;
    sum +=
        k <= b->m ? power(x, 3 * b->n_pairs, b->nb, k) : mhb_truncation_power(level->truncation, k);
  }
}

/* The level above the usual ones that an error asks for, excess times the tolerance with the
 * harmonics in use. It falls like m^(2-p) at least (theory/balance.md, Tail and norms). Where the
 * highest level is not foreseen to keep the tolerance the one in use stays. */
static int choose_beyond(const mhb_harmonic_levels *h, double excess) {
  const double order = mhb_harmonic_levels_current(h)->truncation->order;
  const double m = h->m[h->at], top = h->m[h->n - 1];
  const double rate = fmax(1, order - 2), best = fmax(1, order + ORDER_MARGIN - 2);
  if (excess * pow(m / top, best) > 1) return h->at;
  for (int i = h->at + 1; i < h->n; i++)
    if (excess * pow(m / h->m[i], rate) <= 1 || h->m[i] > 2 * m) return i;
  return h->n - 1;
}

/* The lowest level that keeps the tolerance. Levels above the one in use need no margin. The usual
 * levels are used up first. */
static int choose(const mhb_harmonic_levels *h, const double *x, double error, double size) {
  const int    m = h->m[h->at], top = mhb_truncation_highest(m);
  const int    usual     = mhb_harmonic_levels_of(h, MHB_USUAL_HARMONICS);
  const double tolerance = h->settings->motion_tolerance * size;
  double       share[top + 1];
  tail(mhb_harmonic_levels_current(h), x, top, share);
  double beyond = sqrt(share[m]), gain = beyond > 0 ? fmax(1, error * size / beyond) : 1;
  int    enough = error * size <= (h->at < usual ? SAFETY : 1) * tolerance;
  for (int i = 0; i < h->at; i++)
    if (gain * sqrt(share[h->m[i]]) <= DOWNWARD_MARGIN * tolerance) return i;
  if (enough) return h->at;
  for (int i = h->at + 1; i < usual; i++)
    if (h->m[i] > 2 * m || gain * sqrt(share[h->m[i]]) <= SAFETY * tolerance) return i;
  return h->at < usual ? usual : choose_beyond(h, error / h->settings->motion_tolerance);
}

bool mhb_harmonic_levels_all_usual(const mhb_harmonic_levels *h) {
  return h->at >= mhb_harmonic_levels_of(h, MHB_USUAL_HARMONICS);
}

int mhb_harmonic_levels_most_unknowns(const mhb_harmonic_levels *h) {
  return 3 * h->model->n_pairs * (2 * h->m[h->n - 1] + 1);
}

/* Whether every pair sticks, or is open, for all but a small part of the period. Where slip or
 * opening begins or ends, curves of few and of many harmonics may turn at different places, however
 * small the estimate is. */
static bool is_nearly_linear(const mhb_evaluation *e, int n_pairs) {
  for (int a = 0; a < n_pairs; a++)
    if (e->info[a].share[MHB_STICK] < NEARLY_ALL && e->info[a].share[MHB_SEPARATE] < NEARLY_ALL)
      return false;
  return true;
}

void mhb_harmonic_levels_errors(mhb_harmonic_levels *h, mhb_curve_point *point) {
  if (h->settings->outline && h->n == 1) {
    point->truncation_kind = MHB_TRUNCATION_NONE;
    point->truncation = point->truncation_max = point->modal = NAN;
    return;
  }
  mhb_harmonic_level *level = mhb_harmonic_levels_current(h);
  mhb_balance_use(level->balance, point->evaluation);
  const double error     = mhb_truncation_error(level->truncation, point->x);
  const bool   rough     = level->truncation->kind == MHB_TRUNCATION_FIRST_ORDER;
  const double factor    = rough ? FIRST_ORDER : 1;
  point->truncation      = factor * error;
  point->truncation_max  = factor * level->truncation->largest;
  point->truncation_kind = level->truncation->kind;
  const bool newton      = point->truncation_kind == MHB_TRUNCATION_NEWTON;
  point->modal = mhb_modal_error(level->balance, point->x, newton ? level->truncation : NULL);
}

double mhb_harmonic_levels_spatial(const mhb_harmonic_levels *h, const mhb_curve_point *point) {
  const mhb_harmonic_level *level = mhb_harmonic_levels_current(h);
  if (!level->spatial) return -1;
  mhb_balance_use(level->balance, point->evaluation);
  return mhb_spatial_error_at(level->spatial, point->x);
}

/* The least damping ratio: a shift of the frequency, relative, over it is more than a linear motion
 * changes by that. Of another parameter its value is the unit. */
static double unit_of_shift(const mhb_harmonic_levels *h) {
  double least = INFINITY;
  if (h->parameter != MHB_IN_FREQUENCY) return 1;
  for (int i = 0; i < h->model->n_modes; i++) least = fmin(least, h->model->damping_ratio[i]);
  return least;
}

/* The error that is too large to be told without a look at the curve. */
static bool is_large(const mhb_harmonic_levels *h, const mhb_curve_point *point) {
  const double tolerance = h->settings->motion_tolerance;
  return point->truncation_kind == MHB_TRUNCATION_NEWTON &&
         point->truncation > (tolerance > 0 ? tolerance : WITHOUT_TOLERANCE);
}

void mhb_harmonic_levels_settle(mhb_harmonic_levels *h, mhb_curve_point *point) {
  mhb_truncation *t     = mhb_harmonic_levels_current(h)->truncation;
  double          shift = 0;
  if (!is_large(h, point)) return;
  mhb_balance_use(mhb_harmonic_levels_current(h)->balance, point->evaluation);
  const double distance = mhb_truncation_across(t, point->value, &shift);
  const double unit     = unit_of_shift(h);
  const double moved    = unit > 0 ? shift / unit : INFINITY;
  if (fmax(distance, moved) >= point->truncation) return;
  point->truncation      = fmax(distance, moved);
  point->truncation_max  = fmax(t->largest, moved);
  point->truncation_kind = MHB_TRUNCATION_ACROSS;
}

void mhb_harmonic_levels_estimate(mhb_harmonic_levels *h, mhb_curve_point *point) {
  mhb_balance *b = mhb_harmonic_levels_current(h)->balance;
  mhb_harmonic_levels_errors(h, point);
  h->wanted = h->at;
  h->linear = point->truncation_kind == MHB_TRUNCATION_NONE;
  if (h->n == 1) {
    mhb_harmonic_levels_settle(h, point);
    return;
  }
  const mhb_truncation *t     = mhb_harmonic_levels_current(h)->truncation;
  const bool            usual = mhb_harmonic_levels_all_usual(h);
  if (usual && !t->by_broyden) mhb_harmonic_levels_settle(h, point);
  h->wanted  = choose(h, point->x, point->truncation, mhb_balance_vibration(b, point->x));
  bool onset = h->from_linear || is_nearly_linear(point->evaluation, b->n_pairs);
  int  least = mhb_harmonic_levels_of(h, AT_ONSET * h->settings->subharmonics);
  if (!h->linear && onset && h->wanted < least) h->wanted = least;
  if (h->wanted < h->least) h->wanted = h->least;
  /* the curve is dear to look at where Broyden's method gave the estimate */
  if (usual && t->by_broyden && h->wanted <= h->at) mhb_harmonic_levels_settle(h, point);
}

int mhb_harmonic_levels_of_event(mhb_harmonic_levels *h, mhb_curve_point *point) {
  mhb_balance *b = mhb_harmonic_levels_current(h)->balance;
  mhb_harmonic_levels_errors(h, point);
  const double error = point->truncation, tolerance = h->settings->motion_tolerance;
  if (!(tolerance > 0) || !(error > tolerance)) return -1;
  mhb_harmonic_levels_settle(h, point);
  if (point->truncation <= tolerance || h->at == h->n - 1) return -1;
  const int level = choose(h, point->x, error, mhb_balance_vibration(b, point->x));
  return level > h->at ? level : -1;
}

int mhb_harmonic_levels_higher(const mhb_harmonic_levels *h) {
  return h->wanted > h->at ? h->wanted : -1;
}

int mhb_harmonic_levels_needed(const mhb_harmonic_levels *h) {
  const int usual = mhb_harmonic_levels_of(h, MHB_USUAL_HARMONICS);
  return h->wanted < usual ? h->wanted : usual;
}

void mhb_harmonic_levels_accept(mhb_harmonic_levels *h) {
  h->from_linear = h->linear;
}

int mhb_harmonic_levels_lower(mhb_harmonic_levels *h) {
  if (!h->linear && h->n_lower_wanted < 0) h->n_lower_wanted = 0; /* past the onset of slip */
  h->n_lower_wanted = h->wanted < h->at ? h->n_lower_wanted + 1 : 0;
  return h->n_lower_wanted >= (h->linear ? 1 : LOWER_AFTER) ? h->wanted : -1;
}

/* Rows of a solution into those of another number of harmonics; missing ones stay as they are. */
static void copy_rows(int rows, const double *from, int nb, double *to, int wide) {
  size_t length = sizeof(double) * (size_t)(nb < wide ? nb : wide);
  for (int i = 0; i < rows; i++)
    memcpy(to + (size_t)i * (size_t)wide, from + (size_t)i * (size_t)nb, length);
}

shb_status mhb_harmonic_levels_move(mhb_harmonic_levels *h, int index, bool with_step,
                                    bool *moved) {
  mhb_harmonic_level *from = mhb_harmonic_levels_current(h);
  int                 old  = h->at;
  SHB_TRY(mhb_harmonic_levels_use(h, index));
  mhb_harmonic_level    *to = h->level[index];
  mhb_balance           *a = from->balance, *b = to->balance;
  const mhb_curve_point *current = &from->curve->current;
  int                    rows = 3 * a->n_pairs, wide = from->truncation->doubled->nb;
  double                 x[b->n], near[b->n], away = 0;
  memset(x, 0, sizeof x);
  copy_rows(rows, current->x, a->nb, x, b->nb);
  memcpy(near, x, sizeof near);
  for (int row = 0; with_step && row < rows; row++)
    for (int i = 0; i < wide && i < b->nb; i++)
      x[row * b->nb + i] += from->truncation->step[row * wide + i];
  int sense = current->tangent[from->curve->n] < 0 ? -1 : 1;
  *moved    = mhb_arclength_start(to->curve, x, current->value, sense) == MHB_CONVERGED;
  for (int i = 0; i < b->n; i++) away = fmax(away, fabs(to->curve->current.x[i] - near[i]));
  if (away > NEAR * mhb_norm(near, b->n)) *moved = false; /* another branch */
  if (!*moved) {
    h->at = old;
    return SHB_OK;
  }
  to->curve->step   = from->curve->step;
  h->n_lower_wanted = index > old ? -LOWER_AFTER_ONSET : 0; /* at onset few harmonics lead astray */
  return SHB_OK;
}
