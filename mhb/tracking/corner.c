#include "mhb/tracking/corner.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/tracking/corner_point.h"
#include "mhb/tracking/peak_places.h"

/* A seed may be near a corner of a pair whose h is this part of its friction limit at most. */
static const double CANDIDATE = 0.4;

/* The slipping side is judged at the first of these distances from the corner, relative, at which
 * Newton's method converges to SETTLED. There the amplitude differs from that of the corner by no
 * more than NEIGHBOUR, or it is another solution. */
enum { N_BESIDE = 4 };
static const double BESIDE[N_BESIDE] = {1e-5, 1e-4, 3e-4, 1e-3}, SETTLED = 1e-8, NEIGHBOUR = 1e-2;

/* A point whose residual is larger is none: more than two discs touch. At a corner the residual is
 * of the order of the root of round-off, for two circles touch. The means of a stuck motion
 * are iterated to SETTLED_MEANS. */
static const double BALANCED = 1e-5, SETTLED_MEANS = 1e-12;

typedef struct {
  mhb_peak_family base; /* first: its functions get it back */
  mhb_corner     *at;
  int             sense;
  double         *beside; /* [n] motion beside the corner */
} corner_family;

/* Amplitude of the output at a motion that was evaluated last. */
static double output_of(corner_family *t, const double *x) {
  mhb_corner   *c = t->at;
  mhb_amplitude a = {.by_x = c->by_x, .weight = c->weight, .size = c->tracking->size};
  mhb_output_amplitude(c->balance, x, c->tracking->output, &a);
  return a.amplitude;
}

/* Amplitude of the slipping side beside a corner, or NAN. The nearest distance at which Newton's
 * method finds it, with every pair's own law. The corner's motion stays. */
static double slipping_side(corner_family *t, const mhb_peak_place *at) {
  mhb_corner  *c = t->at;
  mhb_balance *b = c->balance;
  double       start[b->n];
  memcpy(start, c->x, sizeof start);
  for (int i = 0; i < N_BESIDE; i++) {
    const double omega = at->omega * (1 + t->sense * BESIDE[i]);
    int          iterations;
    /* the touching motion itself does not slip, this one does */
    mhb_corner_evaluate(c, omega, at->value);
    memcpy(t->beside, c->x, sizeof start);
    memcpy(c->x, start, sizeof start);
    mhb_reason   reason = mhb_newton_solve(c->newton, b, omega, SETTLED, t->beside, &iterations);
    const double a      = output_of(t, t->beside);
    if (reason == MHB_CONVERGED && fabs(a - at->amplitude) <= NEIGHBOUR * at->amplitude) return a;
  }
  return NAN;
}

static bool is_peak(mhb_peak_family *family, mhb_peak_place *at, mhb_end *why) {
  corner_family      *t        = (corner_family *)family;
  mhb_corner         *c        = t->at;
  const mhb_tracking *tracking = c->tracking;
  *why                         = MHB_END_TURNED;
  at->margin                   = NAN;
  if (!mhb_corner_solve(c, at->value, t->sense, &at->omega)) return false;
  const mhb_corner_state s = mhb_corner_linearise(c, at->omega, at->value);
  if (!isfinite(s.by_value)) return false;
  at->amplitude = s.amplitude;
  at->rate      = c->stuck ? 0 : -s.onset_by_value / s.onset_by_omega;
  at->slope     = c->stuck ? s.by_value : s.by_value + s.by_omega * at->rate;
  /* n0 and mu do not reach a stuck motion: what remains is round-off */
  if (fabs(at->slope) * (tracking->high - tracking->low) < 1e-9 * at->amplitude) at->slope = 0;
  *why = MHB_END_FREQUENCY;
  if (at->omega < tracking->frequency[0] || at->omega > tracking->frequency[1]) return false;
  *why       = MHB_END_CORNER;
  at->peak   = at->omega;
  at->margin = c->stuck ? -s.onset : s.by_omega * copysign(1, s.onset_by_omega);
  if (at->margin <= 0) return false; /* it slips; the amplitude rises into the stuck side */
  if (c->stuck) return true;
  *why = MHB_END_TURNED;
  if (!(slipping_side(t, at) < at->amplitude)) return false;
  if (mhb_corner_overhangs(c, at->omega, at->value, t->sense, t->beside, &at->peak))
    at->amplitude = output_of(t, t->beside);
  else
    at->peak = at->omega;
  return true;
}

static void linearise(mhb_balance *b, const mhb_peak_place *at, mhb_curve_point *point) {
  mhb_balance_linearise(b, point->x, at->peak, point->r, NULL);
  point->residual = mhb_norm(point->r, b->n) / mhb_balance_vibration(b, point->x);
}

/* Off the corner the mean friction is the least admissible one, and Newton's method finds the
 * means. false: more than two discs touch, or the pair slips. */
static bool balance_at(mhb_peak_family *family, const mhb_peak_place *at, mhb_curve_point *point) {
  corner_family *t = (corner_family *)family;
  mhb_corner    *c = t->at;
  mhb_balance   *b = c->balance;
  double         unused;
  mhb_corner_evaluate(c, at->omega, at->value);
  if (at->peak == at->omega ||
      !mhb_corner_overhangs(c, at->omega, at->value, t->sense, point->x, &unused))
    memcpy(point->x, c->x, sizeof(double) * (size_t)b->n);
  point->value = at->value;
  linearise(b, at, point);
  point->iterations = 0;
  if (c->stuck && point->residual > SETTLED_MEANS) {
    mhb_newton_solve(c->newton, b, at->peak, SETTLED_MEANS, point->x, &point->iterations);
    linearise(b, at, point);
  }
  return point->residual <= BALANCED;
}

/* The seed as a corner of a pair, or (pair < 0) as a stuck peak. */
static bool start_as(corner_family *t, const mhb_tracking_seed *seed, int pair,
                     mhb_peak_place *at) {
  mhb_end unused;
  *at = (mhb_peak_place){.value = seed->value, .omega = seed->omega};
  mhb_corner_take(t->at, pair, seed->value, seed->x);
  t->sense = pair < 0 ? -1 : 0;
  if (!mhb_corner_solve(t->at, at->value, t->sense, &at->omega)) return false;
  const mhb_corner_state s = mhb_corner_linearise(t->at, at->omega, at->value);
  if (pair >= 0) t->sense = s.onset_by_omega > 0 ? 1 : -1;
  return is_peak(&t->base, at, &unused) && mhb_is_seeded(seed, at->omega, at->amplitude);
}

/* The seed as a corner of one of the pairs near their limit, or else as a stuck peak. */
static bool start(corner_family *t, const mhb_tracking_seed *seed, mhb_peak_place *at) {
  const int    n_pairs = t->at->balance->n_pairs;
  int          pair[n_pairs];
  const double share = n_pairs == 1 ? INFINITY : CANDIDATE;
  const int    n     = mhb_corner_candidates(t->at, seed->value, seed->x, share, pair);
  for (int i = 0; i < n; i++)
    if (start_as(t, seed, pair[i], at)) return true;
  return start_as(t, seed, -1, at);
}

shb_status mhb_trace_corner(mhb_balance *balance, const mhb_tracking *tracking,
                            const mhb_tracking_seed *seed, mhb_response *response, int branch,
                            bool *found, mhb_tracking_end *end) {
  corner_family  t = {.base = {balance, tracking, is_peak, balance_at}};
  mhb_peak_place at;
  *found = false;
  *end   = (mhb_tracking_end){MHB_END_NO_START, MHB_END_NO_START};
  if (tracking->kind != MHB_TRACK_PEAK) return SHB_OK;
  t.at              = mhb_corner_create(balance, tracking);
  t.beside          = shb_alloc_zeroed((size_t)balance->n, sizeof(double));
  shb_status status = SHB_OK;
  if (start(&t, seed, &at))
    status = mhb_trace_peak_places(&t.base, &at, response, branch, found, end);
  free(t.beside);
  mhb_corner_destroy(t.at);
  return status;
}
