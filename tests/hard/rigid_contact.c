#include "tests/hard/rigid_contact.h"

#include <lapacke.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"

/* Relative to the largest force. */
static const double TOLERANCE = 1e-11;

enum { MOST_SWEEPS = 100000 };

/* The model with its contact turned into (normal, tangent, tangent). */
typedef struct {
  int             m, pairs, n; /* n = 3 pairs */
  double         *B, *R;       /* [n][m], [n][n] */
  double         *probe;       /* [3][n] residual response of the first probe, m/N */
  double complex *load;        /* [n] x of the first harmonic */
  double         *n0;          /* [pair] N */
} boundary;

static void axes_of(const double normal[3], double axes[3][3]) {
  int least = 0;
  for (int d = 1; d < 3; d++)
    if (fabs(normal[d]) < fabs(normal[least])) least = d;
  double other[3] = {0}, length = 0;
  other[least] = 1;
  for (int d = 0; d < 3; d++) axes[0][d] = normal[d];
  for (int d = 0; d < 3; d++) axes[1][d] = other[d] - normal[least] * normal[d];
  for (int d = 0; d < 3; d++) length += axes[1][d] * axes[1][d];
  for (int d = 0; d < 3; d++) axes[1][d] /= sqrt(length);
  for (int d = 0; d < 3; d++) {
    int e = (d + 1) % 3, f = (d + 2) % 3;
    axes[2][d] = normal[e] * axes[1][f] - normal[f] * axes[1][e];
  }
}

static boundary boundary_of(const modal_model *model) {
  boundary b = {.m = model->n_modes, .pairs = model->n_pairs, .n = 3 * model->n_pairs};
  size_t   m = (size_t)b.m, n = (size_t)b.n;
  double   T[b.pairs][3][3];
  b.B     = calloc(n * m, sizeof *b.B);
  b.R     = calloc(n * n, sizeof *b.R);
  b.probe = calloc(3 * n, sizeof *b.probe);
  b.load  = calloc(n, sizeof *b.load);
  b.n0    = calloc((size_t)b.pairs, sizeof *b.n0);
  for (int a = 0; a < b.pairs; a++) axes_of(model->normal + 3 * a, T[a]);
  for (int i = 0; i < b.n; i++)
    for (int c = 0; c < 3; c++) {
      const double turn = T[i / 3][i % 3][c];
      const int    from = 3 * (i / 3) + c;
      for (int j = 0; j < b.m; j++) b.B[i * b.m + j] += turn * model->right[from * b.m + j];
      b.load[i] += turn * model->load_residual[n + (size_t)from];
      for (int axis = 0; axis < 3; axis++)
        b.probe[axis * b.n + i] += turn * model->probe_contact_residual[axis * b.n + from];
      for (int j = 0; j < b.n; j++)
        for (int d = 0; d < 3; d++)
          b.R[i * b.n + j] +=
              turn * T[j / 3][j % 3][d] * model->residual_flexibility[from * b.n + 3 * (j / 3) + d];
    }
  return b;
}

static void boundary_free(boundary *b) {
  free(b->B);
  free(b->R);
  free(b->probe);
  free(b->load);
  free(b->n0);
}

/* Stiffness of the held blade, [m][m]: W^2 + B^T R^-1 B. solved: R^-1 B, [n][m], column-major. */
static void held_stiffness(const modal_model *model, const boundary *b, double *stiffness,
                           double *solved) {
  double *R = malloc(sizeof(double) * (size_t)b->n * (size_t)b->n);
  memcpy(R, b->R, sizeof(double) * (size_t)b->n * (size_t)b->n);
  for (int i = 0; i < b->n; i++)
    for (int j = 0; j < b->m; j++) solved[j * b->n + i] = b->B[i * b->m + j];
  assert_int_equal(LAPACKE_dposv(LAPACK_COL_MAJOR, 'U', b->n, b->m, R, b->n, solved, b->n), 0);
  for (int i = 0; i < b->m; i++)
    for (int j = 0; j < b->m; j++) {
      double sum = i == j ? pow(SHB_TWO_PI * model->frequency[i], 2) : 0;
      for (int c = 0; c < b->n; c++) sum += b->B[c * b->m + i] * solved[j * b->n + c];
      stiffness[i * b->m + j] = sum;
    }
  free(R);
}

void rigid_contact_frequencies(const modal_model *model, double *omega) {
  boundary b         = boundary_of(model);
  double  *stiffness = malloc(sizeof(double) * (size_t)b.m * (size_t)b.m);
  double  *solved    = malloc(sizeof(double) * (size_t)b.n * (size_t)b.m);
  held_stiffness(model, &b, stiffness, solved);
  assert_int_equal(LAPACKE_dsyev(LAPACK_COL_MAJOR, 'N', 'U', b.m, stiffness, b.m, omega), 0);
  for (int i = 0; i < b.m; i++) omega[i] = sqrt(omega[i]);
  free(stiffness);
  free(solved);
  boundary_free(&b);
}

/* First harmonics of the held blade, modes q[m] and forces p[n]: Z q = F - B^T p, B q + x = R p. */
static void held_motion(const modal_model *model, const boundary *b, double omega,
                        double complex *q, double complex *p) {
  double         *stiffness = malloc(sizeof(double) * (size_t)b->m * (size_t)b->m);
  double         *solved    = malloc(sizeof(double) * (size_t)b->n * (size_t)b->m);
  double complex *Z         = malloc(sizeof *Z * (size_t)b->m * (size_t)b->m);
  double         *R         = malloc(sizeof(double) * (size_t)b->n * (size_t)b->n);
  double         *x         = malloc(sizeof(double) * 2 * (size_t)b->n);
  int             pivots[b->m];
  held_stiffness(model, b, stiffness, solved);
  for (int i = 0; i < b->m * b->m; i++) Z[i] = stiffness[i];
  for (int i = 0; i < b->m; i++) {
    double w = SHB_TWO_PI * model->frequency[i];
    Z[i * (b->m + 1)] += 2 * I * model->damping_ratio[i] * w * omega - omega * omega;
    q[i] = model->modal_force[b->m + i];
    for (int c = 0; c < b->n; c++) q[i] -= solved[i * b->n + c] * b->load[c];
  }
  assert_int_equal(LAPACKE_zgesv(LAPACK_COL_MAJOR, b->m, 1, (lapack_complex_double *)Z, b->m,
                                 pivots, (lapack_complex_double *)q, b->m),
                   0);
  for (int c = 0; c < b->n; c++) {
    double complex sum = b->load[c];
    for (int i = 0; i < b->m; i++) sum += b->B[c * b->m + i] * q[i];
    x[c]        = creal(sum);
    x[b->n + c] = cimag(sum);
  }
  memcpy(R, b->R, sizeof(double) * (size_t)b->n * (size_t)b->n);
  assert_int_equal(LAPACKE_dposv(LAPACK_COL_MAJOR, 'U', b->n, 2, R, b->n, x, b->n), 0);
  for (int c = 0; c < b->n; c++) p[c] = x[c] + I * x[b->n + c];
  free(stiffness);
  free(solved);
  free(Z);
  free(R);
  free(x);
}

/* State of the contacts. */
typedef struct {
  const boundary *b;
  double          mu;
  double         *p, *slider; /* [n] forces; [pair][2] where the contact stuck last */
  double         *u;          /* [n] motion without contact forces */
  long            sweeps;
} contacts;

static double motion_of(const contacts *c, int i) {
  const double *row = c->b->R + (size_t)i * (size_t)c->b->n;
  double        sum = c->u[i];
  for (int j = 0; j < c->b->n; j++) sum -= row[j] * c->p[j];
  return sum;
}

/* One projection of each contact's force, in order. Returns the largest change. */
static double sweep(contacts *c) {
  double largest = 0;
  for (int a = 0; a < c->b->pairs; a++) {
    const int     i    = 3 * a;
    double       *p    = c->p + i;
    const double *R    = c->b->R + (size_t)i * (size_t)c->b->n + i;
    const double  n0   = c->b->n0[a];
    const double  soft = fmax(R[c->b->n + 1], R[2 * c->b->n + 2]);
    double        old[3];
    memcpy(old, p, sizeof old);
    p[0] = fmax(-n0, p[0] + motion_of(c, i) / R[0]);
    double trial[2], limit = c->mu * (p[0] + n0), size;
    for (int d = 0; d < 2; d++)
      trial[d] = p[1 + d] + (motion_of(c, i + 1 + d) - c->slider[2 * a + d]) / soft;
    size = hypot(trial[0], trial[1]);
    for (int d = 0; d < 2; d++) p[1 + d] = size > limit ? trial[d] * limit / size : trial[d];
    for (int d = 0; d < 3; d++) largest = fmax(largest, fabs(p[d] - old[d]));
  }
  c->sweeps++;
  return largest;
}

static bool slides(const contacts *c, int pair) {
  const double *p = c->p + 3 * pair;
  return hypot(p[1], p[2]) >= c->mu * (p[0] + c->b->n0[pair]) * (1 - 1e-12);
}

/* Forces at the motion u; sliders follow where the contact slides or is open. */
static void solve_contacts(contacts *c) {
  double scale = 0;
  for (int a = 0; a < c->b->pairs; a++) scale = fmax(scale, c->b->n0[a]);
  for (int i = 0; i < c->b->n; i++) scale = fmax(scale, fabs(c->p[i]));
  int count = 0;
  while (sweep(c) > TOLERANCE * scale) assert_true(++count < MOST_SWEEPS);
  for (int a = 0; a < c->b->pairs; a++)
    if (slides(c, a))
      for (int d = 0; d < 2; d++) c->slider[2 * a + d] = motion_of(c, 3 * a + 1 + d);
}

static void count_states(const contacts *c, double share, rigid_motion *out) {
  for (int a = 0; a < c->b->pairs; a++) {
    bool open = c->p[3 * a] <= -c->b->n0[a];
    out->open += open ? share : 0;
    out->slip += !open && slides(c, a) ? share : 0;
  }
  out->stuck = 1 - out->open - out->slip;
}

static double probe_of(const modal_model *model, const boundary *b, int axis, const double *q,
                       double complex e, const double *p) {
  double sum = creal(model->probe_load_residual[3 * model->n_probes + axis] * e);
  for (int i = 0; i < b->m; i++) sum += model->probe[axis * b->m + i] * q[i];
  for (int j = 0; j < b->n; j++) sum -= b->probe[axis * b->n + j] * p[j];
  return sum;
}

void rigid_contact_march(const modal_model *model, const rigid_contact *contact,
                         rigid_motion *out) {
  boundary       b = boundary_of(model);
  const int      m = b.m, n = b.n;
  const double   h = SHB_TWO_PI / contact->omega / contact->steps;
  double         q[m], before[m], first[m], u[n], p[n], slider[2 * b.pairs];
  double complex held[m], forces[n];
  contacts       c = {&b, contact->mu, p, slider, u, 0};
  for (int a = 0; a < b.pairs; a++) b.n0[a] = contact->pressure * model->area[a];
  held_motion(model, &b, contact->omega, held, forces);
  for (int i = 0; i < m; i++) {
    q[i]      = creal(held[i]);
    before[i] = creal(held[i] * cexp(-I * contact->omega * h));
  }
  for (int i = 0; i < n; i++) p[i] = creal(forces[i]);
  memset(slider, 0, sizeof slider);
  for (int period = 0; period < contact->periods; period++) {
    double change = 0, size = 0;
    *out = (rigid_motion){0};
    memcpy(first, q, sizeof q);
    c.sweeps = 0;
    for (int step = 0; step < contact->steps; step++) {
      double complex e = cexp(I * SHB_TWO_PI * step / contact->steps);
      for (int i = 0; i < n; i++) {
        u[i] = creal(b.load[i] * e);
        for (int j = 0; j < m; j++) u[i] += b.B[i * m + j] * q[j];
      }
      solve_contacts(&c);
      for (int d = 0; d < 3; d++)
        out->probe[d] += 2. / contact->steps * conj(e) * probe_of(model, &b, d, q, e, p);
      count_states(&c, 1. / contact->steps / b.pairs, out);
      for (int j = 0; j < m; j++) {
        double w = SHB_TWO_PI * model->frequency[j], damping = model->damping_ratio[j] * w * h;
        double force = creal(model->modal_force[m + j] * e);
        for (int i = 0; i < n; i++) force -= b.B[i * m + j] * p[i];
        double next =
            (2 * q[j] - (1 - damping) * before[j] + h * h * (force - w * w * q[j])) / (1 + damping);
        before[j] = q[j];
        q[j]      = next;
      }
    }
    for (int j = 0; j < m; j++) {
      change += pow(q[j] - first[j], 2);
      size += q[j] * q[j];
    }
    out->change = sqrt(change / size);
    out->sweeps = (double)c.sweeps / contact->steps;
    if (out->change < 1e-9) break;
  }
  boundary_free(&b);
}
