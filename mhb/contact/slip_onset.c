#include "mhb/contact/slip_onset.h"

#include <math.h>
#include <stdbool.h>

#include "mesh/base/constants.h"

/* A grid of phases resolves the highest harmonic of the motion by so many points. */
enum { PER_PERIOD = 24, MOST_GRID = 96, MOST_NEWTON = 20 };

/* Friction force f without its mean and normal force n at a phase, with two derivatives. */
typedef struct {
  double f[2], df[2], ddf[2], n, dn, ddn;
} forces;

/* Value and two derivatives of harmonics 1..m at a phase. */
static void component(const double *a, int m, double t, double mean, double out[3]) {
  out[0] = mean;
  out[1] = out[2] = 0;
  for (int k = 1; k <= m; k++) {
    double re = a[2 * k - 1], im = a[2 * k];
    if (re == 0 && im == 0) continue;
    double c = cos(k * t), s = sin(k * t), here = re * c - im * s;
    out[0] += here;
    out[1] -= k * (re * s + im * c);
    out[2] -= k * k * here;
  }
}

static forces forces_at(const mhb_law *law, int m, const double *x, double t) {
  double u[3][3];
  for (int axis = 0; axis < 3; axis++)
    component(x + axis * (2 * m + 1), m, t, axis == 0 ? x[0] : 0, u[axis]);
  return (forces){
      .f   = {law->ku[0] * u[1][0] + law->ku[1] * u[2][0],
              law->ku[1] * u[1][0] + law->ku[2] * u[2][0]},
      .df  = {law->ku[0] * u[1][1] + law->ku[1] * u[2][1],
              law->ku[1] * u[1][1] + law->ku[2] * u[2][1]},
      .ddf = {law->ku[0] * u[1][2] + law->ku[1] * u[2][2],
              law->ku[1] * u[1][2] + law->ku[2] * u[2][2]},
      .n   = law->n0 + law->kv * u[0][0],
      .dn  = law->kv * u[0][1],
      .ddn = law->kv * u[0][2],
  };
}

static double distance(const forces *a, const forces *b, double mu) {
  const double d[2] = {a->f[0] - b->f[0], a->f[1] - b->f[1]};
  return 0.5 * (sqrt(d[0] * d[0] + d[1] * d[1]) - mu * (a->n + b->n));
}

static int highest_harmonic(int m, const double *x) {
  int most = 1;
  for (int axis = 0; axis < 3; axis++, x += 2 * m + 1)
    for (int k = m; k > most; k--)
      if (x[2 * k - 1] != 0 || x[2 * k] != 0) most = k;
  return most;
}

/* The phases of the largest distance on a grid. */
static void search_times(const mhb_law *law, int m, const double *x, double time[2]) {
  forces    at[MOST_GRID];
  double    best = -INFINITY;
  const int fine = PER_PERIOD * highest_harmonic(m, x), n = fine < MOST_GRID ? fine : MOST_GRID;
  for (int i = 0; i < n; i++) at[i] = forces_at(law, m, x, SHB_TWO_PI * i / n);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++) {
      double d = distance(&at[i], &at[j], law->mu);
      if (d <= best) continue;
      best    = d;
      time[0] = SHB_TWO_PI * i / n;
      time[1] = SHB_TWO_PI * j / n;
    }
}

/* Twice h at two phases: direction and length of f_1 - f_2, gradient and Hessian by the phases. */
typedef struct {
  forces at[2];
  double e[2], size;
  double across[2]; /* of df_1, df_2, along (-e_2, e_1) */
  double g[2], h11, h12, h22, det;
} pair_of_phases;

static pair_of_phases phases_at(const mhb_law *law, int m, const double *x, const double time[2]) {
  pair_of_phases p = {.at = {forces_at(law, m, x, time[0]), forces_at(law, m, x, time[1])}};
  const forces  *a = &p.at[0], *c = &p.at[1];
  const double   d[2] = {a->f[0] - c->f[0], a->f[1] - c->f[1]}, mu = law->mu;
  p.size = hypot(d[0], d[1]);
  for (int i = 0; i < 2; i++) p.e[i] = p.size > 0 ? d[i] / p.size : 0;
  const double *e = p.e, part = p.size > 0 ? 1 / p.size : 0;
  for (int i = 0; i < 2; i++) p.across[i] = e[0] * p.at[i].df[1] - e[1] * p.at[i].df[0];
  p.g[0] = e[0] * a->df[0] + e[1] * a->df[1] - mu * a->dn;
  p.g[1] = -(e[0] * c->df[0] + e[1] * c->df[1]) - mu * c->dn;
  p.h11  = e[0] * a->ddf[0] + e[1] * a->ddf[1] - mu * a->ddn + part * p.across[0] * p.across[0];
  p.h22  = -(e[0] * c->ddf[0] + e[1] * c->ddf[1]) - mu * c->ddn + part * p.across[1] * p.across[1];
  p.h12  = -part * p.across[0] * p.across[1];
  p.det  = p.h11 * p.h22 - p.h12 * p.h12;
  return p;
}

/* Newton's method for the phases of the largest distance, from near ones. */
static void refine_times(const mhb_law *law, int m, const double *x, double time[2]) {
  for (int i = 0; i < MOST_NEWTON; i++) {
    const pair_of_phases p = phases_at(law, m, x, time);
    if (p.size == 0 || !(p.h11 < 0 && p.det > 0)) return;
    double first  = -(p.h22 * p.g[0] - p.h12 * p.g[1]) / p.det;
    double second = -(p.h11 * p.g[1] - p.h12 * p.g[0]) / p.det;
    double most = fmax(fabs(first), fabs(second)), limit = fmin(1, 0.05 / fmax(most, 1e-300));
    time[0] += limit * first;
    time[1] += limit * second;
    if (most < 1e-15) return;
  }
}

void mhb_slip_onset_find(const mhb_law *law, int m, const double *x, mhb_slip_onset *onset) {
  search_times(law, m, x, onset->time);
  refine_times(law, m, x, onset->time);
  const pair_of_phases p = phases_at(law, m, x, onset->time);
  const forces        *a = &p.at[0], *c = &p.at[1];
  onset->h     = distance(a, c, law->mu);
  onset->limit = 0.5 * law->mu * (a->n + c->n);
  for (int i = 0; i < 2; i++)
    onset->c[i] = -0.5 * (a->f[i] + c->f[i]) + 0.5 * law->mu * (a->n - c->n) * p.e[i];
}

/* Signs of a force's changes in h and c. */
typedef struct {
  double half_mu, between; /* mu/2, mu (n_1 - n_2)/2 */
  double part;             /* 1/|f_1 - f_2| */
  double c_by_time[2][2];  /* [phase][component] */
} touching;

static touching touching_of(const mhb_law *law, const pair_of_phases *p) {
  touching t = {.half_mu = 0.5 * law->mu,
                .between = 0.5 * law->mu * (p->at[0].n - p->at[1].n),
                .part    = p->size > 0 ? 1 / p->size : 0};
  for (int phase = 0; phase < 2; phase++) {
    const forces *f    = &p->at[phase];
    const double  sign = phase ? -1 : 1, turn = sign * t.between * t.part * p->across[phase];
    t.c_by_time[phase][0] = -0.5 * f->df[0] + sign * t.half_mu * f->dn * p->e[0] - turn * p->e[1];
    t.c_by_time[phase][1] = -0.5 * f->df[1] + sign * t.half_mu * f->dn * p->e[1] + turn * p->e[0];
  }
  return t;
}

/* A coefficient that changes the forces at both phases: f by df[phase][component], n by dn. Both
 * derivatives by time change too: ddf, ddn. */
typedef struct {
  double f[2][2], df[2][2], n[2], dn[2];
} change;

static double by_h(const pair_of_phases *p, const touching *t, const change *d) {
  double sum = -t->half_mu * (d->n[0] + d->n[1]);
  for (int i = 0; i < 2; i++) sum += 0.5 * p->e[i] * (d->f[0][i] - d->f[1][i]);
  return sum;
}

static void by_c(const mhb_law *law, const pair_of_phases *p, const touching *t, const change *d,
                 double c[2]) {
  const double moved[2] = {d->f[0][0] - d->f[1][0], d->f[0][1] - d->f[1][1]};
  const double turned   = t->part * (p->e[0] * moved[1] - p->e[1] * moved[0]);
  double       g[2], later[2];
  for (int phase = 0; phase < 2; phase++) {
    const double sign = phase ? -1 : 1;
    g[phase] =
        sign * (p->e[0] * d->df[phase][0] + p->e[1] * d->df[phase][1] + turned * p->across[phase]) -
        law->mu * d->dn[phase];
  }
  later[0]           = p->det > 0 ? -(p->h22 * g[0] - p->h12 * g[1]) / p->det : 0;
  later[1]           = p->det > 0 ? -(p->h11 * g[1] - p->h12 * g[0]) / p->det : 0;
  const double along = t->half_mu * (d->n[0] - d->n[1]), across = t->between * turned;
  c[0] = -0.5 * (d->f[0][0] + d->f[1][0]) + along * p->e[0] - across * p->e[1];
  c[1] = -0.5 * (d->f[0][1] + d->f[1][1]) + along * p->e[1] + across * p->e[0];
  for (int i = 0; i < 2; i++) c[i] += t->c_by_time[0][i] * later[0] + t->c_by_time[1][i] * later[1];
}

void mhb_slip_onset_gradient(const mhb_law *law, int m, const double *x,
                             const mhb_slip_onset *onset, double *to_h, double *const to_c[2]) {
  const int            nb      = 2 * m + 1;
  const pair_of_phases p       = phases_at(law, m, x, onset->time);
  const touching       t       = touching_of(law, &p);
  const double         k[3][2] = {{0, 0}, {law->ku[0], law->ku[1]}, {law->ku[1], law->ku[2]}};
  for (int axis = 0; axis < 3; axis++)
    for (int i = 0; i < nb; i++) {
      change     d = {.f = {{0}}};
      const int  h = (i + 1) / 2, at = axis * nb + i; /* harmonic */
      double     c[2];
      const bool mean = i == 0;
      for (int phase = 0; phase < 2; phase++) {
        const double angle = h * onset->time[phase], co = cos(angle), si = sin(angle);
        const double value = mean ? 1 : i % 2 ? co : -si, rate = h * (i % 2 ? -si : -co);
        if (axis == 0) d.n[phase] = law->kv * value;
        if (axis == 0) d.dn[phase] = law->kv * rate;
        for (int j = 0; j < 2 && !mean; j++) d.f[phase][j] = k[axis][j] * value;
        for (int j = 0; j < 2 && !mean; j++) d.df[phase][j] = k[axis][j] * rate;
      }
      to_h[at] = by_h(&p, &t, &d);
      by_c(law, &p, &t, &d, c);
      to_c[0][at] = c[0];
      to_c[1][at] = c[1];
    }
}
