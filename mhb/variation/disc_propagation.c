#include "mhb/variation/disc_propagation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/variation/propagator.h"

mhb_disc_propagation *mhb_disc_propagation_create(const mhb_disc_modes *modes) {
  mhb_disc_propagation *d = shb_alloc_zeroed(1, sizeof *d);
  const size_t N = (size_t)modes->blades, n = (size_t)modes->n, K = (size_t)modes->diameters;
  d->modes      = modes;
  d->propagator = shb_arena_take(&d->arena, K * (size_t)modes->modes * PROPAGATOR, sizeof(double));
  if (modes->coupled) {
    d->growth = shb_arena_take(&d->arena, 2 * K * (size_t)modes->modes, sizeof *d->growth);
    d->gain   = shb_arena_take(&d->arena, 2 * K * (size_t)modes->modes, sizeof *d->gain);
    d->state  = shb_arena_take(&d->arena, 4 * (size_t)modes->modes, sizeof *d->state);
  }
  d->block  = shb_arena_take(&d->arena, K * n * n, sizeof *d->block);
  d->force  = shb_arena_take(&d->arena, N * n, sizeof *d->force);
  d->motion = shb_arena_take(&d->arena, N * n, sizeof *d->motion);
  d->row    = shb_arena_take(&d->arena, N, sizeof *d->row);
  return d;
}

void mhb_disc_propagation_destroy(mhb_disc_propagation *d) {
  if (!d) return;
  shb_arena_free(&d->arena);
  free(d);
}

static const double complex *shape_of(const mhb_disc_modes *s, int diameter, int mode) {
  return s->shape + (size_t)(diameter * s->modes + mode) * (size_t)s->n;
}

/* Number of halves of the coupled modes that count at a nodal diameter. */
static int halves(const mhb_disc_modes *s, int diameter) {
  int count;
  mhb_disc_modes_first(s, diameter, &count);
  return count;
}

/* e^z - 1 */
static double complex expm1_complex(double complex z) {
  const double x = expm1(creal(z)), half = sin(0.5 * cimag(z));
  return CMPLX(x * cos(cimag(z)) - 2 * half * half, (x + 1) * sin(cimag(z)));
}

/* Growth, gain and compliance of the coupled modes over h. */
static void set_coupled(mhb_disc_propagation *d, double h) {
  const mhb_disc_modes    *s = d->modes;
  const mhb_coupled_modes *c = s->coupled;
  const size_t             n = (size_t)s->n;
  for (int diameter = 0; diameter < s->diameters; diameter++)
    for (int i = 0; i < halves(s, diameter) * s->modes; i++) {
      const size_t          at  = 2 * (size_t)diameter * (size_t)s->modes + (size_t)i;
      const double complex *out = c->shape + at * n, *in = c->force + at * n;
      double complex       *C = d->block + (size_t)diameter * n * n;
      d->growth[at]           = expm1_complex(c->pole[at] * h);
      d->gain[at]             = d->growth[at] / c->pole[at];
      for (size_t row = 0; row < n; row++)
        for (size_t column = 0; column < n; column++)
          C[row * n + column] += out[row] * d->gain[at] * in[column];
    }
}

void mhb_disc_propagation_set_step(mhb_disc_propagation *d, double h, double *compliance) {
  const mhb_disc_modes *s = d->modes;
  const size_t          n = (size_t)s->n, all = n * (size_t)s->blades;
  memset(d->block, 0, sizeof *d->block * (size_t)s->diameters * n * n);
  if (s->coupled) set_coupled(d, h);
  for (int at = 0; at < s->diameters * s->modes && !s->coupled; at++) {
    const int             diameter = at / s->modes;
    const double complex *phi      = shape_of(s, diameter, at % s->modes);
    double               *e        = d->propagator + at * PROPAGATOR;
    double complex       *C        = d->block + (size_t)diameter * n * n;
    propagator_set(s->omega[at], s->zeta[at], h, e);
    for (size_t r = 0; r < n; r++)
      for (size_t c = 0; c < n; c++) C[r * n + c] += e[DQ_P] * phi[r] * conj(phi[c]);
  }
  memset(compliance, 0, sizeof *compliance * all * all);
  mhb_disc_modes_add_map(s, d->block, compliance);
}

/* out[coordinate][width] <- F in[sector][width] */
MHB_HOT static void transform(const mhb_disc_modes *s, int width, const mhb_columns *in,
                              mhb_columns *out) {
  const int N = s->blades;
  for (int at = 0; at < N; at++)
    for (int r = 0; r < width; r++) {
      mhb_columns sum = {0};
      for (int b = 0; b < N; b++) sum += s->fourier[at * N + b] * in[b * width + r];
      out[at * width + r] = sum;
    }
}

/* out[sector][width] += F^T in[coordinate][width] */
MHB_HOT static void add_transformed_back(const mhb_disc_modes *s, int width, const mhb_columns *in,
                                         mhb_columns *out) {
  const int N = s->blades;
  for (int b = 0; b < N; b++)
    for (int r = 0; r < width; r++) {
      mhb_columns sum = {0};
      for (int at = 0; at < N; at++) sum += s->fourier[at * N + b] * in[at * width + r];
      out[b * width + r] += sum;
    }
}

/* rows [N][modes] <- F rows, or F^T rows */
static void turn_rows(mhb_disc_propagation *d, mhb_columns *rows, int back) {
  const mhb_disc_modes *s = d->modes;
  const int             N = s->blades;
  for (int i = 0; i < s->modes; i++) {
    for (int a = 0; a < N; a++) {
      mhb_columns sum = {0};
      for (int b = 0; b < N; b++)
        sum += s->fourier[back ? b * N + a : a * N + b] * rows[b * s->modes + i];
      d->row[a] = sum;
    }
    for (int a = 0; a < N; a++) rows[a * s->modes + i] = d->row[a];
  }
}

/* Row of the first or second half: real part, or imaginary part of a complex amplitude. */
static mhb_columns *row_of(const mhb_disc_modes *s, int diameter, int a, int imaginary,
                           mhb_columns *q, mhb_columns *v) {
  const int m = s->modes, second = a >= m;
  int       count;
  const int first = mhb_disc_modes_first(s, diameter, &count);
  if (count == 1) return (imaginary ? v : q) + first * m + a;
  return (second ? v : q) + (first + imaginary) * m + a % m;
}

/* Rows of one nodal diameter: from (z, z') to the amplitudes of the coupled modes. */
static void to_amplitudes(mhb_disc_propagation *d, int diameter, mhb_columns *q, mhb_columns *v) {
  const mhb_disc_modes *s = d->modes;
  const int             m = s->modes, all = 2 * m, count = halves(s, diameter);
  int                   unused;
  const int             first = mhb_disc_modes_first(s, diameter, &unused);
  const double complex *T     = s->coupled->to_amplitude + (size_t)diameter * (size_t)(all * all);
  for (int a = 0; a < count * m; a++) {
    mhb_columns re = {0}, im = {0};
    for (int j = 0; j < all; j++) {
      const double complex t = T[a * all + j];
      const mhb_columns   *z = (j < m ? q : v) + first * m + j % m;
      re += creal(t) * z[0];
      im += cimag(t) * z[0];
      if (count == 1) continue;
      re -= cimag(t) * z[m];
      im += creal(t) * z[m];
    }
    d->state[2 * a]     = re;
    d->state[2 * a + 1] = im;
  }
  for (int a = 0; a < count * m; a++)
    for (int part = 0; part < 2; part++)
      *row_of(s, diameter, a, part, q, v) = d->state[2 * a + part];
}

/* Back to (z, z'). */
static void to_states(mhb_disc_propagation *d, int diameter, mhb_columns *q, mhb_columns *v) {
  const mhb_disc_modes *s = d->modes;
  const int             m = s->modes, all = 2 * m, count = halves(s, diameter);
  int                   unused;
  const int             first = mhb_disc_modes_first(s, diameter, &unused);
  const double complex *T     = s->coupled->to_state + (size_t)diameter * (size_t)(all * all);
  for (int j = 0; j < all; j++) {
    mhb_columns re = {0}, im = {0};
    for (int a = 0; a < count * m; a++) {
      const double complex t = T[j * all + a];
      const mhb_columns x = *row_of(s, diameter, a, 0, q, v), y = *row_of(s, diameter, a, 1, q, v);
      re += creal(t) * x - cimag(t) * y;
      im += cimag(t) * x + creal(t) * y;
    }
    d->state[2 * j]     = re;
    d->state[2 * j + 1] = im;
  }
  for (int j = 0; j < all; j++) {
    mhb_columns *z = (j < m ? q : v) + first * m + j % m;
    z[0]           = d->state[2 * j];
    if (count == 2) z[m] = d->state[2 * j + 1];
  }
}

void mhb_disc_propagation_begin(mhb_disc_propagation *d, mhb_columns *q, mhb_columns *v) {
  turn_rows(d, q, 0);
  turn_rows(d, v, 0);
  for (int k = 0; d->growth && k < d->modes->diameters; k++) to_amplitudes(d, k, q, v);
}

void mhb_disc_propagation_end(mhb_disc_propagation *d, mhb_columns *q, mhb_columns *v) {
  for (int k = 0; d->growth && k < d->modes->diameters; k++) to_states(d, k, q, v);
  turn_rows(d, q, 1);
  turn_rows(d, v, 1);
}

/* Force Phi^H p on a mode, real and imaginary part of a wave of count coordinates. */
MHB_INLINE void modal_force(int n, int count, const double complex *phi, const mhb_columns *p,
                            mhb_columns out[2]) {
  out[0] = out[1] = (mhb_columns){0};
  for (int r = 0; r < n; r++) {
    out[0] += creal(phi[r]) * p[r];
    if (count == 1) continue;
    out[0] += cimag(phi[r]) * p[n + r];
    out[1] += creal(phi[r]) * p[n + r] - cimag(phi[r]) * p[r];
  }
}

/* u += Phi dz */
MHB_INLINE void add_motion(int n, int count, const double complex *phi, const mhb_columns dz[2],
                           mhb_columns *u) {
  for (int r = 0; r < n; r++) {
    u[r] += creal(phi[r]) * dz[0];
    if (count == 1) continue;
    u[r] -= cimag(phi[r]) * dz[1];
    u[n + r] += cimag(phi[r]) * dz[0] + creal(phi[r]) * dz[1];
  }
}

/* d->force is p^. The modes of one nodal diameter; with motion also propagated freely. */
MHB_HOT static void advance_diameter(mhb_disc_propagation *d, int diameter, mhb_columns *q,
                                     mhb_columns *v, mhb_columns *motion) {
  const mhb_disc_modes *s = d->modes;
  const int             n = s->n, m = s->modes;
  int                   count;
  const int             first = mhb_disc_modes_first(s, diameter, &count);
  for (int i = 0; i < m; i++) {
    const double         *e   = d->propagator + (diameter * m + i) * PROPAGATOR;
    const double complex *phi = shape_of(s, diameter, i);
    mhb_columns           force[2], dz[2] = {{0}};
    modal_force(n, count, phi, d->force + first * n, force);
    for (int c = 0; c < count; c++) {
      const int         at = (first + c) * m + i;
      const mhb_columns q0 = q[at] - e[DQ_P] * force[c], v0 = v[at] - e[V_P] * force[c];
      q[at] = q0;
      v[at] = v0;
      if (!motion) continue;
      dz[c] = e[DQ_Q] * q0 + e[DQ_V] * v0;
      q[at] = q0 + dz[c];
      v[at] = e[V_Q] * q0 + e[V_V] * v0;
    }
    if (motion) add_motion(n, count, phi, dz, motion + first * n);
  }
}

/* The same of coupled modes. */
MHB_HOT static void advance_coupled(mhb_disc_propagation *d, int diameter, mhb_columns *q,
                                    mhb_columns *v, mhb_columns *motion) {
  const mhb_disc_modes *s = d->modes;
  const int             n = s->n, m = s->modes;
  int                   count;
  const int             first = mhb_disc_modes_first(s, diameter, &count);
  const mhb_columns    *p     = d->force + first * n;
  for (int a = 0; a < count * m; a++) {
    const size_t          at  = 2 * (size_t)diameter * (size_t)m + (size_t)a;
    const double complex *in  = s->coupled->force + at * (size_t)n;
    const double complex *out = s->coupled->shape + at * (size_t)n;
    const double          gr = creal(d->gain[at]), gi = cimag(d->gain[at]);
    const double          er = creal(d->growth[at]), ei = cimag(d->growth[at]);
    mhb_columns          *x = row_of(s, diameter, a, 0, q, v), *y = row_of(s, diameter, a, 1, q, v);
    mhb_columns           fr = {0}, fi = {0}, dz[2];
    for (int r = 0; r < n; r++) {
      fr += creal(in[r]) * p[r];
      fi += cimag(in[r]) * p[r];
      if (count == 1) continue;
      fr -= cimag(in[r]) * p[n + r];
      fi += creal(in[r]) * p[n + r];
    }
    const mhb_columns x0 = *x - (gr * fr - gi * fi), y0 = *y - (gr * fi + gi * fr);
    *x = x0;
    *y = y0;
    if (!motion) continue;
    dz[0] = er * x0 - ei * y0;
    dz[1] = er * y0 + ei * x0;
    *x += dz[0];
    *y += dz[1];
    for (int r = 0; r < n; r++) {
      motion[first * n + r] += creal(out[r]) * dz[0] - cimag(out[r]) * dz[1];
      if (count == 2) motion[(first + 1) * n + r] += cimag(out[r]) * dz[0] + creal(out[r]) * dz[1];
    }
  }
}

static void advance(mhb_disc_propagation *d, mhb_columns *q, mhb_columns *v, mhb_columns *motion) {
  for (int k = 0; k < d->modes->diameters; k++)
    (d->growth ? advance_coupled : advance_diameter)(d, k, q, v, motion);
}

void mhb_disc_propagation_apply(mhb_disc_propagation *d, mhb_columns *q, mhb_columns *v,
                                const mhb_columns *P) {
  transform(d->modes, d->modes->n, P, d->force);
  advance(d, q, v, NULL);
}

void mhb_disc_propagation_advance(mhb_disc_propagation *d, mhb_columns *q, mhb_columns *v,
                                  const mhb_columns *P, mhb_columns *W) {
  const mhb_disc_modes *s = d->modes;
  transform(s, s->n, P, d->force);
  memset(d->motion, 0, sizeof *d->motion * (size_t)(s->blades * s->n));
  advance(d, q, v, d->motion);
  add_transformed_back(s, s->n, d->motion, W);
}
