#include "tests/support/spinning.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "tests/support/random_model.h"

enum { N = SPINNING_DOFS, M = SPINNING_MODES, CONTACT = 6, PROBE = 6, PROBE_DOFS = 3, LOADS = 3 };

/* Orthogonal columns. */
static void random_basis(double W[N][N]) {
  unsigned long long seed = 5;
  for (int j = 0; j < N; j++) {
    for (int i = 0; i < N; i++) W[i][j] = random_unit(&seed);
    for (int pass = 0; pass < 2; pass++)
      for (int k = 0; k < j; k++) {
        double part = 0;
        for (int i = 0; i < N; i++) part += W[i][k] * W[i][j];
        for (int i = 0; i < N; i++) W[i][j] -= part * W[i][k];
      }
    double size = 0;
    for (int i = 0; i < N; i++) size += W[i][j] * W[i][j];
    for (int i = 0; i < N; i++) W[i][j] /= sqrt(size);
  }
}

/* In the basis W. */
static void core(spinning_kind kind, double s, double A[N][N]) {
  unsigned long long seed = 9;
  memset(A, 0, sizeof(double) * N * N);
  for (int i = 0; i < N; i++) {
    double a = pow(.8 + .33 * i, 2), b = .2 + .05 * i;
    /* meets the next one at 0.7 */
    if (i == 1) b += (pow(.8 + .66, 2) - pow(.8 + .33, 2)) / .49 + .05;
    A[i][i] = a + (kind == SPINNING_STEADY ? 0 : b * s);
    if (kind == SPINNING_STRAIGHT && i >= M) A[i][i] = a;
    if (kind == SPINNING_LEAVING && i == M - 1) A[i][i] = a + 7 * s;
    if (kind == SPINNING_TURNING) A[i][i] = a + (.2 + .05 * i) * s;
    for (int j = 0; j < i; j++) {
      double x = random_unit(&seed), y = random_unit(&seed);
      if (kind == SPINNING_TURNING) A[i][j] = A[j][i] = .25 * x * s + .1 * y * s * s;
    }
  }
  if (kind == SPINNING_VEERING) A[1][2] = A[2][1] = .05;
}

/* Rows of phi: eigenvectors, ascending. */
static void eigen(spinning_kind kind, double s, double lambda[N], double phi[N][N]) {
  double W[N][N], A[N][N], half[N][N] = {{0}};
  random_basis(W);
  core(kind, s, A);
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++)
      for (int k = 0; k < N; k++) half[i][j] += W[i][k] * A[k][j];
  memset(phi, 0, sizeof(double) * N * N);
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++)
      for (int k = 0; k < N; k++) phi[i][j] += half[i][k] * W[j][k];
  LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'L', N, &phi[0][0], N, lambda);
}

static double *zeros(size_t n) {
  return calloc(n, sizeof(double));
}

static void make_room(modal_model *m) {
  *m = (modal_model){
      .n_modes = M, .n_pairs = 1, .n_probes = 1, .n_load = LOADS - 1, .has_left = true};
  m->frequency              = zeros(M);
  m->damping_ratio          = zeros(M);
  m->right                  = zeros(3 * M);
  m->left                   = zeros(3 * M);
  m->probe                  = zeros(3 * M);
  m->modal_force            = calloc(LOADS * M, sizeof(double complex));
  m->residual_flexibility   = zeros(CONTACT * CONTACT);
  m->residual_inertia       = zeros(CONTACT * CONTACT);
  m->residual_fourth        = zeros(CONTACT * CONTACT);
  m->tail_order             = 3;
  m->contact_tail           = zeros(2 * CONTACT);
  m->load_residual          = calloc(LOADS * CONTACT, sizeof(double complex));
  m->load_inertia           = calloc(LOADS * CONTACT, sizeof(double complex));
  m->load_fourth            = calloc(LOADS * CONTACT, sizeof(double complex));
  m->probe_contact_residual = zeros(PROBE_DOFS * CONTACT);
  m->probe_contact_inertia  = zeros(PROBE_DOFS * CONTACT);
  m->probe_contact_fourth   = zeros(PROBE_DOFS * CONTACT);
  m->probe_load_residual    = calloc(LOADS * PROBE_DOFS, sizeof(double complex));
  m->probe_load_inertia     = calloc(LOADS * PROBE_DOFS, sizeof(double complex));
  m->probe_load_fourth      = calloc(LOADS * PROBE_DOFS, sizeof(double complex));
  m->probe_name             = malloc(sizeof(char *));
  m->probe_name[0]          = strdup("tip");
}

static void add_kept(modal_model *m, int mode, double lambda, const double phi[N],
                     const double complex f[LOADS]) {
  m->frequency[mode]     = sqrt(lambda) / SHB_TWO_PI;
  m->damping_ratio[mode] = .004 + .002 * sqrt(lambda); /* Rayleigh's beta, and a constant */
  for (int i = 0; i < 3; i++) {
    m->right[i * M + mode] = phi[i];
    m->left[i * M + mode]  = phi[3 + i];
    m->probe[i * M + mode] = phi[PROBE + i];
  }
  for (int k = 0; k < LOADS; k++) m->modal_force[k * M + mode] = f[k];
}

static void add_left_out(modal_model *m, double lambda, const double phi[N],
                         const double complex f[LOADS]) {
  for (int i = 0; i < CONTACT; i++) {
    for (int j = 0; j < CONTACT; j++) {
      m->residual_flexibility[i * CONTACT + j] += phi[i] * phi[j] / lambda;
      m->residual_inertia[i * CONTACT + j] += phi[i] * phi[j] / pow(lambda, 2);
      m->residual_fourth[i * CONTACT + j] += phi[i] * phi[j] / pow(lambda, 3);
    }
    for (int j = 0; j < 2; j++) m->contact_tail[2 * i + j] += phi[i] * phi[i] / pow(lambda, 4 + j);
    for (int q = 0; q < PROBE_DOFS; q++) {
      m->probe_contact_residual[q * CONTACT + i] += phi[PROBE + q] * phi[i] / lambda;
      m->probe_contact_inertia[q * CONTACT + i] += phi[PROBE + q] * phi[i] / pow(lambda, 2);
      m->probe_contact_fourth[q * CONTACT + i] += phi[PROBE + q] * phi[i] / pow(lambda, 3);
    }
  }
  for (int k = 0; k < LOADS; k++) {
    for (int i = 0; i < CONTACT; i++) {
      m->load_residual[k * CONTACT + i] += phi[i] * f[k] / lambda;
      m->load_inertia[k * CONTACT + i] += phi[i] * f[k] / pow(lambda, 2);
      m->load_fourth[k * CONTACT + i] += phi[i] * f[k] / pow(lambda, 3);
    }
    for (int q = 0; q < PROBE_DOFS; q++) {
      m->probe_load_residual[k * PROBE_DOFS + q] += phi[PROBE + q] * f[k] / lambda;
      m->probe_load_inertia[k * PROBE_DOFS + q] += phi[PROBE + q] * f[k] / pow(lambda, 2);
      m->probe_load_fourth[k * PROBE_DOFS + q] += phi[PROBE + q] * f[k] / pow(lambda, 3);
    }
  }
}

void spinning_model(spinning_kind kind, double speed, modal_model *model, double *shape) {
  double lambda[N], phi[N][N];
  eigen(kind, speed * speed, lambda, phi);
  make_room(model);
  for (int mode = 0; mode < N; mode++) {
    unsigned long long seed     = 3;
    double complex     f[LOADS] = {0};
    for (int i = 0; i < N; i++)
      for (int k = 0; k < LOADS; k++) {
        double re = random_unit(&seed), im = random_unit(&seed);
        f[k] += phi[mode][i] * (k ? .05 / (k * k) : .02) * CMPLX(re, k ? im : 0);
      }
    if (mode < M)
      add_kept(model, mode, lambda[mode], phi[mode], f);
    else
      add_left_out(model, lambda[mode], phi[mode], f);
  }
  for (int mode = 0; mode < M && kind == SPINNING_STRAIGHT; mode++)
    model->damping_ratio[mode] = .012;
  if (shape) memcpy(shape, phi, sizeof(double) * M * N);
}

static double product(const double *a, const double *b) {
  double sum = 0;
  for (int i = 0; i < N; i++) sum += a[i] * b[i];
  return sum;
}

static void turn_round(modal_model *m, double *phi, int mode) {
  for (int i = 0; i < N; i++) phi[mode * N + i] *= -1;
  for (int i = 0; i < 3; i++) {
    m->right[i * M + mode] *= -1;
    m->left[i * M + mode] *= -1;
    m->probe[i * M + mode] *= -1;
  }
  for (int k = 0; k < LOADS; k++) m->modal_force[k * M + mode] *= -1;
}

/* Each track continues with the mode most similar to it, with its sign. */
static void track(modal_speeds *s, int i, const double *before, double *phi) {
  for (int t = 0; t < M; t++) {
    int    last = i > 0 ? s->mode[(i - 1) * M + t] : t, best = t;
    double most = i > 0 ? 0 : 1;
    for (int j = 0; i > 0 && j < M; j++) {
      double c = product(before + last * N, phi + j * N);
      if (fabs(c) <= fabs(most)) continue;
      most = c;
      best = j;
    }
    if (most < 0) turn_round(&s->model[i], phi, best);
    s->mode[i * M + t] = best;
    s->mac[i * M + t]  = most * most;
  }
}

void spinning_speeds(spinning_kind kind, int n, double low, double high, bool overlap,
                     modal_speeds *s) {
  double first[M * N], before[M * N], phi[M * N];
  modal_speeds_create(n, M, s);
  if (overlap) s->overlap = zeros((size_t)(n * M * M));
  for (int i = 0; i < n; i++) {
    s->speed[i] = low + (high - low) * i / (n - 1);
    spinning_model(kind, s->speed[i], &s->model[i], phi);
    track(s, i, before, phi);
    memcpy(before, phi, sizeof phi);
    if (i == 0) memcpy(first, phi, sizeof phi);
    for (int a = 0; overlap && a < M; a++)
      for (int b = 0; b < M; b++)
        s->overlap[(i * M + a) * M + b] = product(first + a * N, phi + b * N);
  }
}

mhb_settings spinning_settings(void) {
  mhb_settings s = random_settings(3);
  s.blades       = 7;
  s.engine_order = 2;
  s.frequency[0] = .4 / SHB_TWO_PI;
  s.frequency[1] = 1.9 / SHB_TWO_PI;
  return s;
}
