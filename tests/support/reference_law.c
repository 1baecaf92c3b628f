#include "tests/support/reference_law.h"

#include <math.h>
#include <string.h>

static const real TWO_PI = 6.283185307179586476925286766559L;

enum { WIDTH = 2 * SERIES_HARMONICS + 1, ROOTS = 128, MAX_STEPS = 4000, MAX_LAPS = 1000 };

typedef struct {
  int        m, H, order;
  real       tolerance, mu, scale, K[2][2];
  real       load[WIDTH], x[2][WIDTH]; /* signals, in units of scale */
  real       node[GAUSS_NODES], weight[GAUSS_NODES];
  real       sum[2][2 * REFERENCE_HARMONICS + 1], work, share[3]; /* of this lap */
  real       longest, middle; /* slip of this lap, and the time of its middle */
  reference *out;
} walk;

/* State at a time t. Stick: f = x - z; if fresh, f.f - mu^2 n^2 has a double zero at t. Slip: f; if
 * fresh, n = 0 at t. */
typedef struct {
  mhb_state state;
  int       fresh;
  real      t, f[2];
} place;

/* Series about a place. In slip after a closing, friction is t F and the slip rate is L/t. */
typedef struct {
  real n[SERIES_ORDER + 2], x[2][SERIES_ORDER + 2], square[SERIES_ORDER + 2]; /* n^2 */
  real f[2][SERIES_ORDER + 2], rate[SERIES_ORDER + 2];
  real pull[SERIES_ORDER +
            2]; /* f.x' - mu^2 n n' = lambda f.Kf: same sign as lambda, without its poles */
} series;

static void solve2(real a, real b, real d, const real r[2], real y[2]) {
  real det = a * d - b * b;
  y[0]     = (d * r[0] - b * r[1]) / det;
  y[1]     = (a * r[1] - b * r[0]) / det;
}

static void times_K(const walk *w, const real a[2], real y[2]) {
  y[0] = w->K[0][0] * a[0] + w->K[0][1] * a[1];
  y[1] = w->K[1][0] * a[0] + w->K[1][1] * a[1];
}

static void signals_about(const walk *w, real t, int closing, series *s) {
  series_of_signal(w->m, w->load, t, w->order + 1, s->n);
  for (int k = 0; k < 2; k++) series_of_signal(w->m, w->x[k], t, w->order + 1, s->x[k]);
  if (closing) s->n[0] = 0;
  for (int j = 0; j <= w->order + 1; j++) s->square[j] = series_product(s->n, s->n, j);
}

/* x'_j less the sum of rate_i (K f)_{j-i} over from <= i < j */
static void slip_rest(const walk *w, const series *s, int j, int from, real r[2]) {
  real sum[2] = {0, 0}, Kf[2];
  for (int i = from; i < j; i++)
    for (int k = 0; k < 2; k++) sum[k] += s->rate[i] * s->f[k][j - i];
  times_K(w, sum, Kf);
  for (int k = 0; k < 2; k++) r[k] = (j + 1) * s->x[k][j + 1] - Kf[k];
}

/* (j+1) f_{j+1} + rate_j K f_0 = rest,  2 f_0.f_{j+1} = mu^2 (n^2)_{j+1} - sum f_i.f_{j+1-i} */
static void slip_series(const walk *w, const real f0[2], series *s) {
  real Kf[2], r[2];
  times_K(w, f0, Kf);
  for (int k = 0; k < 2; k++) s->f[k][0] = f0[k];
  for (int j = 0; j < w->order; j++) {
    real twice = w->mu * w->mu * s->square[j + 1];
    for (int i = 1; i <= j; i++)
      twice -= s->f[0][i] * s->f[0][j + 1 - i] + s->f[1][i] * s->f[1][j + 1 - i];
    slip_rest(w, s, j, 0, r);
    s->rate[j] =
        (f0[0] * r[0] + f0[1] * r[1] - (j + 1) * twice / 2) / (f0[0] * Kf[0] + f0[1] * Kf[1]);
    for (int k = 0; k < 2; k++) s->f[k][j + 1] = (r[k] - s->rate[j] * Kf[k]) / (j + 1);
  }
}

/* |F| of (1 + L K) F = x'. */
static real start_size(const walk *w, const series *s, real L, real F[2]) {
  real pull[2] = {s->x[0][1], s->x[1][1]};
  solve2(1 + L * w->K[0][0], L * w->K[0][1], 1 + L * w->K[1][1], pull, F);
  return hypotl(F[0], F[1]);
}

/* The L at which |F| = mu n' (eqs. 13-15): |F| falls with L. */
static real closing_rate(const walk *w, const series *s, real F[2]) {
  real limit = w->mu * s->n[1], low = 0, high = 1;
  while (start_size(w, s, high, F) > limit && high < 1e100L) high *= 4;
  for (int i = 0; i < 400; i++) {
    real mid = .5L * (low + high);
    if (mid <= low || mid >= high) break;
    if (start_size(w, s, mid, F) > limit) {
      low = mid;
    } else {
      high = mid;
    }
  }
  start_size(w, s, high, F);
  return high;
}

/* Solve for the series of F and L, then f = t F:
 *   ((j+1) + L_0 K) F_j + L_j K F_0 = rest,  2 F_0.F_j = mu^2 (n^2)_{j+2} - sum F_i.F_{j-i} */
static void closing_series(const walk *w, series *s) {
  real F0[2], KF[2], a[2], b[2], r[2], L0 = closing_rate(w, s, F0);
  times_K(w, F0, KF);
  s->rate[0] = L0;
  for (int k = 0; k < 2; k++) s->f[k][0] = F0[k];
  for (int j = 1; j < w->order; j++) {
    real twice = w->mu * w->mu * s->square[j + 2];
    for (int i = 1; i < j; i++) twice -= s->f[0][i] * s->f[0][j - i] + s->f[1][i] * s->f[1][j - i];
    slip_rest(w, s, j, 1, r);
    real diagonal[2] = {j + 1 + L0 * w->K[0][0], j + 1 + L0 * w->K[1][1]};
    solve2(diagonal[0], L0 * w->K[0][1], diagonal[1], r, a);
    solve2(diagonal[0], L0 * w->K[0][1], diagonal[1], KF, b);
    s->rate[j] = (F0[0] * a[0] + F0[1] * a[1] - twice / 2) / (F0[0] * b[0] + F0[1] * b[1]);
    for (int k = 0; k < 2; k++) s->f[k][j] = a[k] - s->rate[j] * b[k];
  }
  for (int k = 0; k < 2; k++) {
    memmove(&s->f[k][1], &s->f[k][0], sizeof(real) * (size_t)w->order);
    s->f[k][0] = 0;
  }
}

static void pull_series(const walk *w, series *s) {
  for (int j = 0; j < w->order; j++) {
    s->pull[j] = -w->mu * w->mu * .5L * (j + 1) * s->square[j + 1];
    for (int i = 0; i <= j; i++)
      for (int k = 0; k < 2; k++) s->pull[j] += s->f[k][i] * (j - i + 1) * s->x[k][j - i + 1];
  }
}

/* Step length at which the last terms of the series equal the tolerance. */
static real step_length(const walk *w, const series *s) {
  real h = 1.L / (w->m > 2 ? w->m : 2);
  for (int j = w->order - 2; j <= w->order; j++) {
    real size = hypotl(s->f[0][j], s->f[1][j]);
    if (size > 0) h = fminl(h, powl(w->tolerance / size, 1.L / j));
  }
  return h;
}

/* ---- force and work ---- */

static void basis_at(int H, real t, real *b) {
  b[0] = 1;
  for (int k = 1; k <= H; k++) {
    b[2 * k - 1] = cosl(k * t);
    b[2 * k]     = -sinl(k * t);
  }
}

static void add_force(walk *w, real t, real weight, const real f[2]) {
  real b[2 * REFERENCE_HARMONICS + 1];
  basis_at(w->H, t, b);
  for (int k = 0; k < 2; k++)
    for (int i = 0; i <= 2 * w->H; i++) w->sum[k][i] += weight * f[k] * b[i];
}

/* Slip over [t, t + h]; the work is the integral of lambda f.f. */
static void record_slip(walk *w, real t, real h, const series *s) {
  for (int i = 0; i < GAUSS_NODES; i++) {
    real at = h * w->node[i], weight = h * w->weight[i], Kf[2];
    real f[2] = {series_at(s->f[0], w->order, at), series_at(s->f[1], w->order, at)};
    times_K(w, f, Kf);
    w->work += weight * series_at(s->pull, w->order - 1, at) * (f[0] * f[0] + f[1] * f[1]) /
               (f[0] * Kf[0] + f[1] * Kf[1]);
    add_force(w, t + at, weight, f);
  }
  w->share[MHB_SLIDE] += h / TWO_PI;
}

static void record_stick(walk *w, real t, real h, const real z[2]) {
  for (int i = 0; i < GAUSS_NODES; i++) {
    real at   = t + h * w->node[i];
    real f[2] = {signal_at(w->m, w->x[0], at, 0) - z[0], signal_at(w->m, w->x[1], at, 0) - z[1]};
    add_force(w, at, h * w->weight[i], f);
  }
  w->share[MHB_STICK] += h / TWO_PI;
}

static void note(walk *w, real t, mhb_state state) {
  reference *out = w->out;
  if (out->n_transitions == REFERENCE_EVENTS) return;
  real phase                       = t / TWO_PI;
  out->phase[out->n_transitions]   = (double)(phase - floorl(phase));
  out->state[out->n_transitions++] = (int)state;
}

/* ---- from event to event ---- */

static void place_on_circle(const walk *w, place *p) {
  real size = hypotl(p->f[0], p->f[1]), limit = w->mu * signal_at(w->m, w->load, p->t, 0);
  for (int k = 0; k < 2 && size > 0; k++) p->f[k] *= limit / size;
}

/* One step of slip. Returns 1 if it ended in stick. */
static int step_slip(walk *w, place *p, real end, int opening) {
  series s;
  signals_about(w, p->t, p->fresh, &s);
  if (p->fresh) {
    closing_series(w, &s);
  } else {
    slip_series(w, p->f, &s);
  }
  pull_series(w, &s);
  real h = fminl(step_length(w, &s), end - p->t), falling[SERIES_ORDER + 2];
  if (opening) h = fminl(h, .6L * (end - p->t));
  for (int j = p->fresh; j < w->order; j++)
    falling[j - p->fresh] = -s.pull[j]; /* zero at a closing */
  real stop = series_upcrossing(falling, w->order - 1 - p->fresh, h);
  if (stop >= 0) h = stop;
  record_slip(w, p->t, h, &s);
  p->t     = stop < 0 && !opening && h >= end - p->t ? end : p->t + h;
  p->fresh = 0;
  for (int k = 0; k < 2; k++) p->f[k] = series_at(s.f[k], w->order, h);
  place_on_circle(w, p);
  return stop >= 0;
}

/* Slips until slip or the interval ends. In the last 1e-10 rad before an opening the force falls to
 * zero linearly. */
static void run_slip(walk *w, place *p, real end, int opening) {
  real begin = p->t;
  int  ended = 0;
  for (int i = 0; i < MAX_STEPS && !ended && p->t < end; i++) {
    if (opening && end - p->t < 1e-10L) {
      real spring[2];
      solve2(w->K[0][0], w->K[0][1], w->K[1][1], p->f, spring);
      w->work += .5L * (p->f[0] * spring[0] +
                        p->f[1] * spring[1]); /* the energy of the spring is dissipated */
      add_force(w, p->t, .5L * (end - p->t), p->f);
      w->share[MHB_SLIDE] += (end - p->t) / TWO_PI;
      p->t = end;
      break;
    }
    ended = step_slip(w, p, end, opening);
    if (i + 1 == MAX_STEPS) w->out->lost = 1;
  }
  if (p->t - begin > w->longest) {
    w->longest = p->t - begin;
    w->middle  = .5L * (begin + p->t);
  }
  if (!ended) return;
  p->state = MHB_STICK;
  p->fresh = 1;
  note(w, p->t, MHB_STICK);
}

/* Newton's method on |x - z|^2 = mu^2 n^2 itself, because the root of the series is only as
 * accurate as the series. */
static real polish_onset(const walk *w, const real z[2], real t) {
  for (int i = 0; i < 3; i++) {
    real n = signal_at(w->m, w->load, t, 0), dn = signal_at(w->m, w->load, t, 1), g = 0, dg = 0;
    for (int k = 0; k < 2; k++) {
      real f = signal_at(w->m, w->x[k], t, 0) - z[k];
      g += f * f;
      dg += 2 * f * signal_at(w->m, w->x[k], t, 1);
    }
    g -= w->mu * w->mu * n * n;
    dg -= 2 * w->mu * w->mu * n * dn;
    real step = dg > 0 ? -g / dg : 0;
    if (fabsl(step) < 1e-9L) t += step;
  }
  return t;
}

/* Sticks until the friction limit is reached or the interval ends. */
static void run_stick(walk *w, place *p, real end) {
  real z[2], h = 1.L / (w->m > 2 ? w->m : 2), onset = -1;
  for (int k = 0; k < 2; k++) z[k] = signal_at(w->m, w->x[k], p->t, 0) - p->f[k];
  while (p->t < end && onset < 0) {
    series s;
    real   g[SERIES_ORDER + 2], step = fminl(h, end - p->t);
    int    drop = p->fresh ? 2 : 0; /* the double zero at the start, divided out */
    signals_about(w, p->t, 0, &s);
    for (int k = 0; k < 2; k++) s.x[k][0] -= z[k];
    for (int j = drop; j <= w->order; j++)
      g[j - drop] = series_product(s.x[0], s.x[0], j) + series_product(s.x[1], s.x[1], j) -
                    w->mu * w->mu * s.square[j];
    onset = series_upcrossing(g, w->order - drop, step);
    if (onset >= 0) step = onset > 1e-6L ? polish_onset(w, z, p->t + onset) - p->t : onset;
    record_stick(w, p->t, step, z);
    p->t     = onset < 0 && step >= end - p->t ? end : p->t + step;
    p->fresh = 0;
  }
  for (int k = 0; k < 2; k++) p->f[k] = signal_at(w->m, w->x[k], p->t, 0) - z[k];
  if (onset < 0) return;
  p->state = MHB_SLIDE;
  place_on_circle(w, p);
  note(w, p->t, MHB_SLIDE);
}

static void run_closed(walk *w, place *p, real end, int opening) {
  for (int events = 0; p->t < end && !w->out->lost; events++) {
    if (events == REFERENCE_EVENTS) {
      w->out->lost = 1;
      return;
    }
    if (p->state == MHB_STICK) {
      run_stick(w, p, end);
    } else {
      run_slip(w, p, end, opening);
    }
  }
}

static void clear_lap(walk *w) {
  memset(w->sum, 0, sizeof w->sum);
  memset(w->share, 0, sizeof w->share);
  w->work               = 0;
  w->longest            = 0;
  w->out->n_transitions = 0;
}

/* ---- the contact opens ---- */

static void run_openings(walk *w, int n, const real *root, const int *rising) {
  for (int i = 0; i < n; i++) {
    if (!rising[i]) continue;
    real  end = i + 1 < n ? root[i + 1] : root[0] + TWO_PI;
    place p   = {.state = MHB_STICK, .fresh = 1, .t = root[i]};
    real  pull[2], rise = signal_at(w->m, w->load, p.t, 1);
    for (int k = 0; k < 2; k++) pull[k] = signal_at(w->m, w->x[k], p.t, 1);
    if (hypotl(pull[0], pull[1]) >= w->mu * rise) p.state = MHB_SLIDE;
    note(w, p.t, p.state);
    run_closed(w, &p, end, 1);
    note(w, end, MHB_SEPARATE);
  }
  w->share[MHB_SEPARATE] = 1 - w->share[MHB_STICK] - w->share[MHB_SLIDE];
}

/* ---- always closed ---- */

static void run_lap(walk *w, place *p) {
  real end = p->t + TWO_PI;
  clear_lap(w);
  run_closed(w, p, end, 0);
  p->t = end - TWO_PI;
}

/* From the middle of the longest slip phase of the last period: the angle a period later. Returns 0
 * if it does not slip there. */
static int reach_middle(walk *w, place *p) {
  real middle = w->middle > p->t ? w->middle : w->middle + TWO_PI;
  clear_lap(w);
  run_closed(w, p, middle, 0);
  real t = p->t;
  p->t   = t > TWO_PI ? t - TWO_PI : t;
  return p->state == MHB_SLIDE;
}

/* Secant method on the period map of the angle at p->t. Returns 1 if periodic. */
static int close_angle(walk *w, place *p) {
  real decay = 0, before = 0, angle_before = 0, limit = hypotl(p->f[0], p->f[1]);
  for (int i = 0; i < 60 && w->out->laps < MAX_LAPS; i++) {
    real angle = atan2l(p->f[1], p->f[0]);
    run_lap(w, p);
    w->out->laps++;
    if (p->state != MHB_SLIDE) return 0;
    real left = remainderl(atan2l(p->f[1], p->f[0]) - angle, TWO_PI);
    if (i > 0 && fabsl(angle - angle_before) > 1e-12L)
      decay = fminl(1 - 1e-9L, fmaxl(-.9L, 1 + (left - before) / (angle - angle_before)));
    w->out->left  = (double)fabsl(left / (1 - decay));
    w->out->decay = (double)decay;
    if (fabsl(left) < 1e-17L || (i > 3 && fabsl(left) < 3e-16L && fabsl(left) >= fabsl(before)))
      return 1;
    before       = left;
    angle_before = angle;
    angle += left / (1 - decay);
    p->f[0] = limit * cosl(angle);
    p->f[1] = limit * sinl(angle);
  }
  return 0;
}

static void run_always_closed(walk *w) {
  place p = {.state = MHB_STICK};
  for (int k = 0; k < 2; k++) p.f[k] = signal_at(w->m, w->x[k], 0, 0) - w->x[k][0];
  real size = hypotl(p.f[0], p.f[1]), limit = .99L * w->mu * signal_at(w->m, w->load, 0, 0);
  for (int k = 0; k < 2 && size > limit; k++) p.f[k] *= limit / size; /* any start is valid */
  for (int tries = 0; w->out->laps < MAX_LAPS; tries++) {
    for (int i = 0; i < 2 + tries; i++, w->out->laps++) run_lap(w, &p);
    if (w->longest < 1e-7L) { /* reaches the limit at most */
      w->out->stuck = 1;
      return;
    }
    if (reach_middle(w, &p) && close_angle(w, &p)) return;
  }
  w->out->lost = 1;
}

/* ---- assembly ---- */

static void set_up(walk *w, const mhb_law *law, const double *motion) {
  int           width = 2 * w->m + 1;
  const real    ku[3] = {law->ku[0], law->ku[1], law->ku[2]}, stiff = ku[0] + ku[2];
  const real    K[2][2] = {{ku[0] / stiff, ku[1] / stiff}, {ku[1] / stiff, ku[2] / stiff}};
  const double *u = motion + width, *v = motion + 2 * width;
  real          load = fabsl((real)law->n0), friction = 0;
  w->mu = law->mu;
  memcpy(w->K, K, sizeof K);
  for (int i = 0; i < width; i++) {
    w->load[i] = (i == 0 ? law->n0 : 0) + (real)law->kv * motion[i];
    w->x[0][i] = ku[0] * u[i] + ku[1] * v[i];
    w->x[1][i] = ku[1] * u[i] + ku[2] * v[i];
    load += fabsl(law->kv * (real)motion[i]);
    friction += hypotl(w->x[0][i], w->x[1][i]);
  }
  w->scale = fmaxl(load, friction);
  if (w->scale == 0) w->scale = 1;
  for (int i = 0; i < width; i++) {
    w->load[i] /= w->scale;
    for (int k = 0; k < 2; k++) w->x[k][i] /= w->scale;
  }
  gauss_rule(w->node, w->weight);
}

/* Adds the harmonics of n over [t0, t1], with panels of a tenth of the shortest wave. */
static void add_load(const walk *w, real t0, real t1, real *sum) {
  real b[2 * REFERENCE_HARMONICS + 1];
  int  panels = 1 + (int)((t1 - t0) * (w->m + w->H));
  for (int p = 0; p < panels; p++) {
    for (int g = 0; g < GAUSS_NODES; g++) {
      real t = t0 + (t1 - t0) * (p + w->node[g]) / panels;
      real n = w->weight[g] * (t1 - t0) / panels * signal_at(w->m, w->load, t, 0);
      basis_at(w->H, t, b);
      for (int i = 0; i <= 2 * w->H; i++) sum[i] += n * b[i];
    }
  }
}

static void finish(const walk *w, const mhb_law *law, const real *load_sum, reference *out) {
  const double *shift = &law->mean_offset;
  for (int i = 0; i <= 2 * w->H; i++) {
    real factor      = w->scale * (i == 0 ? 1 : 2) / TWO_PI;
    out->force[0][i] = (double)(factor * load_sum[i] - (i == 0 ? *shift : 0));
    for (int k = 0; k < 2; k++) out->force[1 + k][i] = (double)(factor * w->sum[k][i]);
  }
  /* in slip f.s' is lambda f.f over a stiffness: lambda belongs to K = Ku/(kuu + kww), f to units
   * of scale */
  out->work = (double)(w->work * w->scale * w->scale / ((real)law->ku[0] + law->ku[2]));
  for (int i = 0; i < 3; i++) out->share[i] = (double)w->share[i];
}

void reference_force(const mhb_law *law, int m, const double *motion, int H, int order,
                     double tolerance, reference *out) {
  walk w;
  real root[ROOTS], load_sum[2 * REFERENCE_HARMONICS + 1] = {0};
  int  rising[ROOTS];
  memset(out, 0, sizeof *out);
  memset(&w, 0, sizeof w);
  w.m         = m;
  w.H         = H;
  w.order     = order;
  w.tolerance = tolerance;
  w.out       = out;
  set_up(&w, law, motion);
  int n      = signal_roots(m, w.load, ROOTS, root, rising),
      closed = n == 0 && signal_at(m, w.load, 0, 0) > 0;
  if (closed) add_load(&w, 0, TWO_PI, load_sum);
  for (int i = 0; i < n; i++)
    if (rising[i]) add_load(&w, root[i], i + 1 < n ? root[i + 1] : root[0] + TWO_PI, load_sum);
  if (w.mu == 0) {
    /* no friction */
  } else if (closed) {
    run_always_closed(&w);
  } else {
    run_openings(&w, n, root, rising);
  }
  finish(&w, law, load_sum, out);
}
