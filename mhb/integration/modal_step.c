#include "mhb/integration/modal_step.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/numerics/simd.h"

enum { S = MHB_STAGES, MOMENTS = 5, GAMMAS = MOMENTS + 2 };

/* ---- the rule ---- */

/* Coefficients of the powers of tau in Lagrange's polynomial j through n points. */
static void lagrange(int n, const double *x, int j, double *power) {
  memset(power, 0, sizeof(double) * (size_t)n);
  power[0]   = 1;
  int degree = 0;
  for (int i = 0; i < n; i++) {
    if (i == j) continue;
    double scale = 1 / (x[j] - x[i]);
    for (int k = ++degree; k >= 0; k--)
      power[k] = scale * ((k > 0 ? power[k - 1] : 0) - (k < degree ? x[i] * power[k] : 0));
  }
}

/* A^-1: derivatives at the c_i of the polynomials through 0 and the c_j. */
static void set_inverse(mhb_radau *r) {
  for (int j = 0; j < S; j++)
    for (int i = 0; i < S; i++) {
      double t = r->c[i];
      r->inverse[i][j] =
          r->dense[1][j + 1] + t * (2 * r->dense[2][j + 1] + t * 3 * r->dense[3][j + 1]);
    }
}

void mhb_radau_create(mhb_radau *r) {
  const double root = sqrt(6.), factorial[] = {1, 1, 2};
  double       point[S + 1] = {0, (4 - root) / 10, (4 + root) / 10, 1}, power[S + 1];
  memcpy(r->c, point + 1, sizeof r->c);
  for (int j = 0; j <= S; j++) {
    lagrange(S + 1, point, j, power);
    for (int k = 0; k <= S; k++) r->dense[k][j] = power[k];
  }
  for (int j = 0; j < S; j++) {
    lagrange(S, r->c, j, power);
    for (int m = 0; m < S; m++) r->basis[j][m] = power[m] * factorial[m];
    for (int i = 0; i < S; i++) {
      double t   = r->c[i];
      r->A[i][j] = t * (power[0] + t * (power[1] / 2 + t * power[2] / 3));
    }
  }
  for (int i = 0; i < S; i++) { /* sum_m (2m+1) P_m(tau) int_0^c P_m, shifted Legendre */
    double c = r->c[i], I1 = c * c - c, I2 = c * (1 + c * (2 * c - 3));
    r->kernel[i][0] = c + 3 * I1 + 5 * I2;
    r->kernel[i][1] = -6 * I1 - 30 * I2;
    r->kernel[i][2] = 60 * I2;
  }
  set_inverse(r);
}

void mhb_radau_lagrange(const mhb_radau *r, double tau, double l[S]) {
  for (int j = 0; j < S; j++)
    l[j] = r->basis[j][0] + tau * (r->basis[j][1] + tau * r->basis[j][2] / 2);
}

/* ---- modes ----
 *
 * In tau the impulse response G_0 solves G'' + 2a G' + b G = delta, a = zeta w h, b = (w h)^2. G_k
 * is its k-th integral from 0, G_-1 its derivative; all are taken at tau = 1. The response to
 * tau^m/m! is G_m+1, its velocity G_m, and int (1 - tau)^l/l! G_m = G_m+l+1. So G_-1 .. G_5 give
 * all coefficients. Integrating the equation k times:
 *   G_k-2 + 2a G_k-1 + b G_k = 1/(k-1)!,   k >= 1.
 * For small b this is used downwards, where it is stable, from the Taylor series of G_5 and G_4;
 * else upwards from G_-1 and G_0. */

static const double inverse_factorial[] = {1, 1, 1. / 2, 1. / 6, 1. / 24, 1. / 120, 1. / 720};

static void series(double a, double b, double G[GAMMAS]) {
  double g = 1, before = 0, weight4 = 1. / 120, weight5 = 1. / 720, sum4 = 0, sum5 = 0;
  for (int n = 0; n < 60; n++) {
    sum4 += g * weight4;
    sum5 += g * weight5;
    double next = -2 * a * g - b * before;
    if (n > 2 && (fabs(g) + fabs(next)) * weight4 < 1e-20) break;
    before = g;
    g      = next;
    weight4 /= n + 6;
    weight5 /= n + 7;
  }
  G[6] = sum5;
  G[5] = sum4;
  for (int k = MOMENTS; k >= 1; k--)
    G[k - 1] = inverse_factorial[k - 1] - 2 * a * G[k] - b * G[k + 1];
}

static void closed_form(double a, double b, double G[GAMMAS]) {
  double wd = sqrt(b - a * a), decay = exp(-a), sine = sin(wd) / wd;
  G[0] = decay * (cos(wd) - a * sine);
  G[1] = decay * sine;
  for (int k = 1; k <= MOMENTS; k++)
    G[k + 1] = (inverse_factorial[k - 1] - G[k - 1] - 2 * a * G[k]) / b;
}

/* G[k + 1] = G_k, k = -1..5. */
static void responses(double a, double b, double G[GAMMAS]) {
  if (b < 4) {
    series(a, b, G);
  } else {
    closed_form(a, b, G);
  }
}

static void set_mode(const mhb_ring_step *ring, double h, int i, mhb_modal_step *step) {
  const mhb_radau *r = &ring->rule;
  int              m = ring->s.modes;
  double           w = ring->s.omega[i] * h, a = ring->s.zeta[i] * w, b = w * w, G[GAMMAS];
  double          *row = step->mode + i;
  responses(a, b, G);
  for (int k = 0; k < S; k++) {
    double z = 1, v = 0, end = 0, rate = 0;
    for (int l = 0; l < S; l++) {
      z -= b * r->kernel[k][l] * G[l + 2];
      v += r->kernel[k][l] * G[l + 1];
      end += r->basis[k][l] * G[l + 2];
      rate += r->basis[k][l] * G[l + 1];
    }
    row[(MHB_STAGE_Z + k) * m] = z;
    row[(MHB_STAGE_V + k) * m] = h * v;
    row[(MHB_END_F + k) * m]   = h * h * end;
    row[(MHB_RATE_F + k) * m]  = h * rate;
  }
  row[MHB_END_Z * m]  = G[0] + 2 * a * G[1];
  row[MHB_END_V * m]  = h * G[1];
  row[MHB_RATE_Z * m] = -b / h * G[1];
  row[MHB_RATE_V * m] = G[0];
  for (int k = 0; k < MOMENTS; k++) row[(MHB_MOMENT + k) * m] = h * h * G[k + 2];
}

/* ---- amplitudes ----
 *
 * In tau an amplitude obeys a' = x a + h in . f, x = pole h. With phi_k the responses of
 * amplitudes.h, that to tau^m/m! is phi_m+1, and int (1 - tau)^l/l! of its rate phi_l+m+1. The free
 * motion is e^(x tau), of its rate x phi_l+1. The motion of the contact is of second order in h.
 * What is of first order adds up to nothing over the amplitudes, and h (phi_k - 1/k!) = h x phi_k+1
 * is summed in the place of h phi_k. */

static void set_amplitude(const mhb_ring_step *ring, double h, int i, mhb_modal_step *step) {
  const mhb_radau *r   = &ring->rule;
  const int        m   = ring->s.modes;
  double          *row = step->mode + i;
  double complex   phi[MHB_POWERS], x = ring->amplitudes->pole[i] * h;
  mhb_amplitudes_responses(x, phi);
  for (int k = 0; k < S; k++) {
    double complex stage = 1, end = 0;
    for (int l = 0; l < S; l++) {
      stage += x * r->kernel[k][l] * phi[l + 1];
      end += h * r->basis[k][l] * phi[l + 1];
    }
    row[(MHB_STAGE_Z + k) * m] = creal(stage);
    row[(MHB_STAGE_V + k) * m] = cimag(stage);
    row[(MHB_END_F + k) * m]   = creal(end);
    row[(MHB_RATE_F + k) * m]  = cimag(end);
  }
  row[MHB_END_Z * m] = creal(phi[0]);
  row[MHB_END_V * m] = cimag(phi[0]);
  for (int k = 0; k < MOMENTS; k++) {
    const double complex moment         = h * x * phi[k + 2];
    row[(MHB_MOMENT + k) * m]           = creal(moment);
    row[(MHB_MOMENT_IMAGINARY + k) * m] = cimag(moment);
  }
}

/* ---- compliance of the contacts ---- */

/* sum[5] += sum over modes of to by G_1..5 */
MHB_HOT static void add_moments(int m, const double *to, const double *by, const double *moments,
                                double *sum) {
  for (int k = 0; k < MOMENTS; k++) {
    double x = 0;
#pragma omp simd reduction(+ : x)
    for (int i = 0; i < m; i++) x += to[i] * by[i] * moments[k * m + i];
    sum[k] += x;
  }
}

/* The same of amplitudes: rows of motion and of force. */
MHB_HOT static void add_amplitude_moments(int m, const double *to, const double *by,
                                          const double *moments, double *sum) {
  for (int k = 0; k < MOMENTS; k++) {
    const double *re = moments + k * m, *im = moments + (MOMENTS + k) * m;
    double        x = 0;
#pragma omp simd reduction(+ : x)
    for (int i = 0; i < m; i++)
      x += to[i] * (re[i] * by[i] - im[i] * by[m + i]) +
           to[m + i] * (re[i] * by[m + i] + im[i] * by[i]);
    sum[k] += x;
  }
}

/* Neighbour whose contacts are on side `by` of a blade, seen from the contacts on side `to`. */
static int neighbour_of(const mhb_ring_step *c, int to, int by) {
  if (to == by) return 0;
  return c->s.blades == 1 ? 0 : c->s.blades == 2 || to == 0 ? 1 : 2;
}

static void set_moments(const mhb_ring_step *c, const mhb_modal_step *step) {
  int n3 = 3 * c->s.pairs, m = c->s.modes, lines = c->lines, sides = c->s.sides;
  memset(c->moment, 0, sizeof(double) * (size_t)(c->n_neighbours * n3 * n3 * MOMENTS));
  for (int k = 0; k < sides * sides; k++) {
    int to = k / sides, by = k % sides, neighbour = neighbour_of(c, to, by);
    for (int row = 0; row < n3; row++)
      for (int column = 0; column < n3; column++)
        (c->amplitudes ? add_amplitude_moments : add_moments)(
            m, c->motion + (to * n3 + row) * lines, c->force + (by * n3 + column) * lines,
            step->mode + MHB_MOMENT * m,
            c->moment + ((neighbour * n3 + row) * n3 + column) * MOMENTS);
  }
}

double mhb_ring_step_flexibility(const mhb_ring_step *c, int neighbour, int row, int column) {
  int n3 = 3 * c->s.pairs, n = 3 * c->s.contacts;
  if (!c->s.flexibility) return 0;
  return c->s.flexibility[(size_t)row * (size_t)n +
                          (size_t)(mhb_ring_step_sector(c, 0, neighbour) * n3 + column)];
}

/* w_i by the force at stage j: sum_q weight[i][j][q] h^2 G_q+1. */
static void set_weights(const mhb_radau *r, double weight[S][S][MOMENTS]) {
  memset(weight, 0, sizeof(double) * S * S * MOMENTS);
  for (int k = 0; k < S * S * S * S; k++) { /* stages i, j; powers l, m */
    int i = k / (S * S * S), j = k / (S * S) % S, l = k / S % S, m = k % S;
    weight[i][j][l + m] += r->kernel[i][l] * r->basis[j][m];
  }
}

void mhb_modal_step_response(const mhb_ring_step *c, const mhb_modal_step *step, double *response) {
  int    m = c->s.modes;
  double weight[S][S][MOMENTS];
  set_weights(&c->rule, weight);
  for (int k = 0; k < S * S * m; k++) {
    response[k] = 0;
    for (int q = 0; q < MOMENTS; q++)
      response[k] += weight[k / (S * m)][k / m % S][q] * step->mode[(MHB_MOMENT + q) * m + k % m];
  }
}

static void set_compliance(const mhb_ring_step *c, mhb_modal_step *step) {
  int    n3 = 3 * c->s.pairs, pairs = c->s.pairs;
  double weight[S][S][MOMENTS];
  set_weights(&c->rule, weight);
  for (int k = 0; k < c->n_neighbours * n3 * n3; k++) {
    int     neighbour = k / (n3 * n3), row = k / n3 % n3, column = k % n3;
    double  R = mhb_ring_step_flexibility(c, neighbour, row, column);
    double *block =
        step->compliance + (size_t)((neighbour * pairs + row / 3) * pairs + column / 3) *
                               MHB_STAGE_FORCES * MHB_STAGE_FORCES;
    const double *G = c->moment + k * MOMENTS;
    for (int ij = 0; ij < S * S; ij++) {
      int    i = ij / S, j = ij % S;
      double sum = i == j ? R : 0;
      for (int q = 0; q < MOMENTS; q++) sum += weight[i][j][q] * G[q];
      block[(3 * i + row % 3) * MHB_STAGE_FORCES + 3 * j + column % 3] = sum;
    }
  }
}

void mhb_modal_step_modes(const mhb_ring_step *ring, double h, mhb_modal_step *step) {
  step->h = h;
  for (int i = 0; i < ring->s.modes; i++)
    (ring->amplitudes ? set_amplitude : set_mode)(ring, h, i, step);
}

void mhb_modal_step_length(const mhb_ring_step *ring, double h, mhb_modal_step *step) {
  mhb_modal_step_modes(ring, h, step);
  set_moments(ring, step);
  set_compliance(ring, step);
  for (int a = 0; a < ring->s.pairs; a++) step->stuck[a].pivot[0] = -1;
}

/* ---- life cycle ---- */

shb_status mhb_ring_step_create(const mhb_receptance *receptance, const mhb_settings *settings,
                                mhb_ring_step *ring) {
  *ring = (mhb_ring_step){.n_neighbours = 1};
  mhb_radau_create(&ring->rule);
  SHB_TRY(mhb_modal_structure_create(receptance, settings, receptance->n_modes,
                                     MHB_STRUCTURE_BLADES, &ring->s));
  const mhb_modal_structure *s  = &ring->s;
  int                        n3 = 3 * s->pairs, m = s->modes;
  if (s->sides == 2) ring->n_neighbours = s->blades < 3 ? s->blades : 3;
  size_t block = (size_t)n3 * (size_t)n3 * MOMENTS;
  ring->shape =
      shb_arena_take(&ring->arena, (size_t)s->sides * (size_t)n3 * (size_t)m, sizeof(double));
  ring->moment = shb_arena_take(&ring->arena, (size_t)ring->n_neighbours * block, sizeof(double));
  for (int k = 0; k < s->sides * n3 * m; k++)
    ring->shape[k] = s->shape[(k / (n3 * m) * m + k % m) * n3 + k / m % n3];
  ring->lines  = m;
  ring->motion = ring->force = ring->shape;
  if (!receptance->model->coriolis) return SHB_OK;
  shb_status status = mhb_amplitudes_create(receptance->model, s, ring->shape, &ring->amplitudes);
  if (status != SHB_OK) {
    mhb_ring_step_destroy(ring);
    return status;
  }
  ring->lines  = 2 * m;
  ring->motion = ring->amplitudes->motion;
  ring->force  = ring->amplitudes->force;
  return SHB_OK;
}

void mhb_ring_step_destroy(mhb_ring_step *ring) {
  mhb_amplitudes_destroy(ring->amplitudes);
  mhb_modal_structure_destroy(&ring->s);
  shb_arena_free(&ring->arena);
  *ring = (mhb_ring_step){0};
}

void mhb_modal_step_create(const mhb_ring_step *c, bool contacts, mhb_modal_step *step) {
  size_t pairs = contacts ? (size_t)c->s.pairs : 0, square = MHB_STAGE_FORCES * MHB_STAGE_FORCES;
  *step = (mhb_modal_step){.h = NAN};
  step->mode =
      shb_arena_take(&step->arena, MHB_MODAL_STEP_ROWS * (size_t)c->s.modes, sizeof(double));
  step->compliance = shb_arena_take(&step->arena, (size_t)c->n_neighbours * pairs * pairs * square,
                                    sizeof(double));
  step->stuck      = shb_arena_take(&step->arena, pairs, sizeof *step->stuck);
}

void mhb_modal_step_destroy(mhb_modal_step *step) {
  shb_arena_free(&step->arena);
  *step = (mhb_modal_step){0};
}
