#include "mhb/variation/slider_propagation.h"

#include <cblas.h>
#include <lapacke.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/numerics/simd.h"
#include "mhb/variation/propagator.h"

/* Rows of a jump in the workspace: measure . y, and three of a contact. */
enum { JUMP_ROWS = 4 };

mhb_slider_propagation *mhb_slider_propagation_create(const mhb_stuck_springs *springs,
                                                      int                      capacity) {
  mhb_slider_propagation *x = shb_alloc_zeroed(1, sizeof *x);
  size_t                  n = (size_t)springs->n, m = (size_t)springs->modes, contacts = n / 3;
  size_t                  width = (size_t)mhb_whole_lanes(capacity);
  shb_arena              *a     = &x->arena;
  x->springs                    = springs;
  x->capacity                   = (int)width;
  x->h                          = -1;
  x->Y                          = shb_arena_take(a, (2 * m + 5 * contacts) * width, sizeof(double));
  x->z                          = shb_arena_take(a, n * width, sizeof(double));
  x->held                       = shb_arena_take(a, n * width, sizeof(double));
  x->g                          = shb_arena_take(a, m * width, sizeof(double));
  x->active                     = shb_arena_take(a, contacts, sizeof(int));
  x->is_active                  = shb_arena_take(a, contacts, sizeof(bool));
  x->stuck                      = shb_arena_take(a, n * m, sizeof(double));
  x->answer                     = shb_arena_take(a, 2 * n * m, sizeof(double));
  x->slider                     = shb_arena_take(a, n * n, sizeof(double));
  x->system                     = shb_arena_take(a, n * n, sizeof(double));
  x->pivot                      = shb_arena_take(a, n + m, sizeof(int));
  x->feedback                   = shb_arena_take(a, n * m, sizeof(double));
  x->laws                       = shb_arena_take(a, n * m + m * m, sizeof(double));
  x->propagator                 = shb_arena_take(a, PROPAGATOR * m, sizeof(double));
  x->inverse                    = shb_arena_take(a, m * m, sizeof(double));
  x->half                       = shb_arena_take(a, m * m, sizeof(double));
  x->work = shb_arena_take(a, (3 * m + 3 * n + JUMP_ROWS) * width, sizeof(double));
  return x;
}

void mhb_slider_propagation_destroy(mhb_slider_propagation *x) {
  if (!x) return;
  shb_arena_free(&x->arena);
  free(x);
}

/* ---- rows ---- */

static double *row(const mhb_slider_propagation *x, double *rows, int i) {
  return rows + (size_t)i * (size_t)x->width;
}

static double *motion_rows(const mhb_slider_propagation *x, int contact) {
  return row(x, x->Y, 2 * x->springs->modes + 3 * contact);
}

static double *sigma_rows(const mhb_slider_propagation *x, int contact) {
  return row(x, x->Y, 2 * x->springs->modes + x->springs->n + 2 * contact);
}

/* Y [rows] += factor M [rows][inner] X [inner]; set: Y = ... */
static void add_product(const mhb_slider_propagation *x, int rows, int inner, double factor,
                        const double *M, const double *X, bool set, double *Y) {
  if (rows > 0 && inner > 0)
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, rows, x->width, inner, factor, M, inner,
                X, x->width, set ? 0 : 1, Y, x->width);
}

/* Y [rows] += factor M^T X, M [inner][rows] */
static void add_transposed(const mhb_slider_propagation *x, int rows, int inner, double factor,
                           const double *M, const double *X, double *Y) {
  if (rows > 0 && inner > 0)
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, rows, x->width, inner, factor, M, rows, X,
                x->width, 1, Y, x->width);
}

void mhb_slider_propagation_clear(mhb_slider_propagation *x, int columns) {
  size_t n = (size_t)x->springs->n, m = (size_t)x->springs->modes;
  x->columns   = columns;
  x->width     = mhb_whole_lanes(columns);
  size_t width = (size_t)x->width;
  memset(x->Y, 0, sizeof(double) * (2 * m + 5 * (n / 3)) * width);
  memset(x->z, 0, sizeof(double) * n * width);
  memset(x->held, 0, sizeof(double) * n * width);
  memset(x->g, 0, sizeof(double) * m * width);
}

/* ---- which contacts ---- */

/* The list of active contacts, anew. */
static void list_active(mhb_slider_propagation *x) {
  x->gathered = false;
  x->n_active = 0;
  for (int j = 0; j < x->springs->n / 3; j++)
    if (x->is_active[j]) x->active[x->n_active++] = j;
}

static void set_active(mhb_slider_propagation *x, int contact, bool is_active) {
  x->is_active[contact] = is_active;
  list_active(x);
}

/* Copies of the rows of A, one beside the other. */
static void gather(mhb_slider_propagation *x) {
  const mhb_stuck_springs *s = x->springs;
  const size_t             m = (size_t)s->modes, n = (size_t)s->n, a3 = 3 * (size_t)x->n_active;
  for (size_t r = 0; r < a3; r++) {
    const size_t from = 3 * (size_t)x->active[r / 3] + r % 3;
    memcpy(x->stuck + r * m, s->stuck + from * m, m * sizeof(double));
    memcpy(x->answer + r * m, s->shape + from * m, m * sizeof(double));
    for (size_t i = 0; i < m; i++) x->answer[(a3 + r) * m + i] = -0.5 * s->lost[from * m + i];
    for (size_t c = 0; c < a3 && s->flexible; c++)
      x->slider[r * a3 + c] = s->slider[from * n + 3 * (size_t)x->active[c / 3] + c % 3];
  }
  x->gathered = true;
}

/* z of a contact's columns: K u less the force by u and sigma. */
static void set_sliders(mhb_slider_propagation *x, int contact, const double of_u[3][3],
                        const double of_sigma[3][2]) {
  const double *K = x->springs->K + 9 * (size_t)contact;
  double       *u = motion_rows(x, contact), *sigma = sigma_rows(x, contact);
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < x->columns; c++) {
      double sum = 0;
      for (int k = 0; k < 3; k++) sum += (K[3 * r + k] - of_u[r][k]) * row(x, u, k)[c];
      for (int k = 0; k < 2; k++) sum -= of_sigma[r][k] * row(x, sigma, k)[c];
      row(x, x->z, 3 * contact + r)[c] = sum;
    }
}

void mhb_slider_propagation_begin(mhb_slider_propagation *x, const bool *is_stuck,
                                  const double (*of_u)[3][3], const double (*of_sigma)[3][2]) {
  for (int j = 0; j < x->springs->n / 3; j++) {
    x->is_active[j] = !is_stuck[j];
    set_sliders(x, j, of_u[j], of_sigma[j]);
  }
  list_active(x);
  add_transposed(x, x->springs->modes, x->springs->n, 1, x->springs->stuck, x->z, x->g);
}

/* ---- the system of A ---- */

int mhb_slider_propagation_set_step(mhb_slider_propagation *x, double h) {
  const mhb_stuck_springs   *s  = x->springs;
  const int                  m  = s->modes;
  const mhb_modal_structure *of = s->structure;
  if (h == x->h) return 1;
  for (int i = 0; i < m; i++) {
    double *e = x->propagator + i * PROPAGATOR;
    propagator_set(of->omega[i], of->zeta[i], h, e);
    for (int k = 0; k < m; k++)
      x->inverse[i * m + k] = (i == k) + 0.5 * e[DQ_P] * s->stiffness[i * m + k];
  }
  int *pivot = x->pivot + s->n;
  x->h       = -1;
  if (LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, m, m, x->inverse, m, pivot) != 0 ||
      LAPACKE_dgetri_work(LAPACK_COL_MAJOR, m, x->inverse, m, pivot, x->laws, m * m) != 0)
    return 0;
  for (int k = 0; k < m * m; k++)
    x->half[k] = 0.5 * x->inverse[k] * x->propagator[k % m * PROPAGATOR + DQ_P];
  x->h = h;
  return 1;
}

/* K - df_du of a contact. */
static void slider_law(const mhb_slider_propagation *x, int contact, const mhb_linearised_law *law,
                       double H[3][3]) {
  const double *K = x->springs->K + 9 * (size_t)contact;
  for (int k = 0; k < 9; k++) H[k / 3][k % 3] = K[k] - law->df_du[k / 3][k % 3];
}

/* Rows of the contact in laws, and its columns of I - S (K - df_du) in the system. */
static void add_law(mhb_slider_propagation *x, int i, const mhb_linearised_law *law) {
  const int     m = x->springs->modes, a3 = 3 * x->n_active;
  const double *K = x->springs->K + 9 * (size_t)x->active[i];
  double        H[3][3];
  slider_law(x, x->active[i], law, H);
  for (int c = 0; c < 3; c++) {
    double *to = x->laws + (3 * i + c) * m;
    memset(to, 0, sizeof *to * (size_t)m);
    for (int k = 0; k < 3; k++) {
      const double *lost = x->answer + (a3 + 3 * i + k) * m, *shape = x->answer + (3 * i + k) * m;
      const double  by_lost = -2 * H[k][c], by_shape = law->mean_du[k][c] - K[3 * k + c];
      for (int q = 0; q < m; q++) to[q] += by_lost * lost[q] + by_shape * shape[q];
    }
  }
  for (int r = 0; r < a3; r++) {
    double       *to = x->system + r * a3 + 3 * i;
    const double *S  = x->slider + r * a3 + 3 * i;
    for (int c = 0; c < 3; c++) {
      to[c] = r == 3 * i + c;
      if (x->springs->flexible) to[c] -= S[0] * H[0][c] + S[1] * H[1][c] + S[2] * H[2][c];
    }
  }
}

int mhb_slider_propagation_factor(mhb_slider_propagation *x, const mhb_linearised_law *linearised) {
  const int m = x->springs->modes, a3 = 3 * x->n_active;
  if (!x->gathered) gather(x);
  if (a3 == 0) return 1;
  for (int i = 0; i < x->n_active; i++) add_law(x, i, &linearised[x->active[i]]);
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, a3, m, m, 1, x->laws, m, x->half, m, 0,
              x->feedback, m);
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, a3, a3, m, 1, x->stuck, m, x->feedback, m, 1,
              x->system, a3);
  return LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, a3, a3, x->system, a3, x->pivot) == 0;
}

/* D [3 active] <- system^-1 D. The transposed matrix is the one that was factored. */
static void solve(const mhb_slider_propagation *x, double *D) {
  const int a3 = 3 * x->n_active, width = x->width;
  cblas_dtrsm(CblasRowMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, a3, width, 1,
              x->system, a3, D, width);
  cblas_dtrsm(CblasRowMajor, CblasLeft, CblasUpper, CblasNoTrans, CblasUnit, a3, width, 1,
              x->system, a3, D, width);
  for (int i = a3 - 1; i >= 0; i--)
    if (x->pivot[i] - 1 != i) cblas_dswap(width, row(x, D, i), 1, row(x, D, x->pivot[i] - 1), 1);
}

/* ---- one sub-step ---- */

/* Rows of a contact in A: motion, sigma, slider force; its three rows in the work arrays. */
typedef struct {
  double *u, *sigma, *z, *b, *c, *D;
} contact_rows;

/* b = mean_y y - K u + z, c = df_y y, for y = (v, sigma). */
MHB_HOT static void set_sources(int width, const mhb_linearised_law *law, const double *K,
                                const contact_rows *at) {
  const double *u = at->u, *sigma = at->sigma;
  for (int r = 0; r < 3; r++) {
    const double *M = law->mean_y[r], *F = law->df_y[r], *k = K + 3 * r;
    const double *z = at->z + r * width;
    double       *b = at->b + r * width, *c = at->c + r * width;
#pragma omp simd
    for (int i = 0; i < width; i++) {
      double v = u[i], s = sigma[i], t = sigma[width + i];
      b[i] = M[0] * v + M[1] * s + M[2] * t + z[i] - k[0] * v - k[1] * u[width + i] -
             k[2] * u[2 * width + i];
      c[i] = F[0] * v + F[1] * s + F[2] * t;
    }
  }
}

/* The contact at the end of the sub-step by D; c becomes the change of z. */
MHB_HOT static void advance_contact(int width, const mhb_linearised_law *law, double H[3][3],
                                    const contact_rows *at) {
  const double *D = at->D;
  double       *u = at->u, *sigma = at->sigma;
#pragma omp simd
  for (int i = 0; i < width; i++) {
    const double d0 = D[i], d1 = D[width + i], d2 = D[2 * width + i];
    const double v = u[i], s = sigma[i], t = sigma[width + i];
    sigma[i] = law->state_y[0][0] * v + law->state_y[0][1] * s + law->state_y[0][2] * t +
               law->state_du[0][0] * d0 + law->state_du[0][1] * d1 + law->state_du[0][2] * d2;
    sigma[width + i] = law->state_y[1][0] * v + law->state_y[1][1] * s + law->state_y[1][2] * t +
                       law->state_du[1][0] * d0 + law->state_du[1][1] * d1 +
                       law->state_du[1][2] * d2;
    u[i] += d0;
    u[width + i] += d1;
    u[2 * width + i] += d2;
  }
  for (int r = 0; r < 3; r++) {
    double *c = at->c + r * width, *z = at->z + r * width;
#pragma omp simd
    for (int i = 0; i < width; i++) {
      c[i] = H[r][0] * D[i] + H[r][1] * D[width + i] + H[r][2] * D[2 * width + i] - c[i];
      z[i] += c[i];
    }
  }
}

/* Free changes of q, and rho <- free - E force. */
MHB_HOT static void free_modes(int m, int width, const double *propagator, const double *q,
                               const double *v, const double *force, double *free, double *rho) {
  for (int k = 0; k < m; k++) {
    const double *e = propagator + k * PROPAGATOR;
#pragma omp simd
    for (int i = k * width; i < (k + 1) * width; i++) {
      free[i] = e[DQ_Q] * q[i] + e[DQ_V] * v[i];
      rho[i]  = free[i] - e[DQ_P] * force[i];
    }
  }
}

/* q and v at the end, by the change of q. */
MHB_HOT static void end_modes(int m, int width, const double *propagator, const double *free,
                              const double *change, double *q, double *v) {
  for (int k = 0; k < m; k++) {
    const double *e = propagator + k * PROPAGATOR, answer = e[V_P] / e[DQ_P];
#pragma omp simd
    for (int i = k * width; i < (k + 1) * width; i++) {
      v[i] = e[V_Q] * q[i] + e[V_V] * v[i] - answer * (free[i] - change[i]);
      q[i] += change[i];
    }
  }
}

void mhb_slider_propagation_step(mhb_slider_propagation *x, const mhb_linearised_law *linearised) {
  const mhb_stuck_springs *s = x->springs;
  const int                m = s->modes, a3 = 3 * x->n_active, width = x->width;
  double                  *force = x->work, *free = row(x, force, m), *change = row(x, free, m);
  double                  *b = row(x, change, m), *c = row(x, b, a3), *D = row(x, c, a3);
  double                  *q = x->Y, *v = row(x, q, m), *rho = force;
  add_product(x, m, m, 1, s->stiffness, q, true, force);
  for (int k = 0; k < m * width; k++) force[k] -= x->g[k];
  for (int i = 0; i < x->n_active; i++) {
    const int    j  = x->active[i];
    contact_rows at = {motion_rows(x, j), sigma_rows(x, j), row(x, x->z, 3 * j),
                       row(x, b, 3 * i),  row(x, c, 3 * i), row(x, D, 3 * i)};
    set_sources(width, &linearised[j], s->K + 9 * (size_t)j, &at);
  }
  add_transposed(x, m, 2 * a3, 1, x->answer, b, force);
  free_modes(m, width, x->propagator, q, v, force, free, rho);
  add_product(x, m, m, 1, x->inverse, rho, true, change);
  if (a3 > 0) {
    add_product(x, a3, m, 1, x->stuck, change, true, D);
    if (s->flexible) add_product(x, a3, a3, -1, x->slider, c, false, D);
    solve(x, D);
    add_transposed(x, m, a3, -1, x->feedback, D, change);
  }
  for (int i = 0; i < x->n_active; i++) {
    const int    j  = x->active[i];
    contact_rows at = {motion_rows(x, j), sigma_rows(x, j), row(x, x->z, 3 * j),
                       row(x, b, 3 * i),  row(x, c, 3 * i), row(x, D, 3 * i)};
    double       H[3][3];
    slider_law(x, j, &linearised[j], H);
    advance_contact(width, &linearised[j], H, &at);
  }
  add_transposed(x, m, a3, 1, x->stuck, c, x->g);
  end_modes(m, width, x->propagator, free, change, q, v);
}

/* ---- transitions ---- */

/* Force of a stuck contact's spring, K u - z, of a column. */
static void spring_force(const mhb_slider_propagation *x, int contact, int column, double p[3]) {
  double *u = motion_rows(x, contact), *z = row(x, x->z, 3 * contact), motion[3];
  for (int k = 0; k < 3; k++) motion[k] = row(x, u, k)[column];
  mhb_stuck_springs_force(x->springs, contact, motion, p);
  for (int k = 0; k < 3; k++) p[k] -= row(x, z, k)[column];
}

/* u and sigma of a stuck contact. */
static void refresh(mhb_slider_propagation *x, int contact) {
  const mhb_stuck_springs *s     = x->springs;
  const size_t             first = 3 * (size_t)contact;
  double                  *u = motion_rows(x, contact), *sigma = sigma_rows(x, contact), p[3];
  add_product(x, 3, s->modes, 1, s->stuck + first * (size_t)s->modes, x->Y, true, u);
  if (s->flexible) add_product(x, 3, s->n, 1, s->slider + first * (size_t)s->n, x->z, false, u);
  for (int c = 0; c < x->columns; c++) {
    spring_force(x, contact, c, p);
    for (int i = 0; i < 2; i++)
      row(x, sigma, i)[c] = p[1 + i] + row(x, x->held, 3 * contact + 1 + i)[c];
  }
}

/* The contact's springs let go: g without held. */
static void release(mhb_slider_propagation *x, int contact) {
  const int m    = x->springs->modes;
  double   *held = row(x, x->held, 3 * contact);
  add_transposed(x, m, 3, 1, x->springs->shape + (size_t)(3 * contact * m), held, x->g);
  memset(held, 0, sizeof(double) * 3 * (size_t)x->width);
}

/* held <- the force by (v, sigma) less that of the springs. */
static void hold(mhb_slider_propagation *x, int contact) {
  const int m    = x->springs->modes;
  double   *held = row(x, x->held, 3 * contact), *u = motion_rows(x, contact);
  double   *sigma = sigma_rows(x, contact), p[3];
  for (int c = 0; c < x->columns; c++) {
    spring_force(x, contact, c, p);
    held[c] = x->springs->law[contact].kv * u[c] - p[0];
    for (int i = 0; i < 2; i++) row(x, held, 1 + i)[c] = row(x, sigma, i)[c] - p[1 + i];
  }
  add_transposed(x, m, 3, -1, x->springs->shape + (size_t)(3 * contact * m), held, x->g);
}

/* u, sigma, z of a contact by alpha times the jump of all. */
static void add_jump(mhb_slider_propagation *x, int contact, const double *alpha, const double *du,
                     const double *dsigma, const double *dp) {
  const int m = x->springs->modes, width = x->width;
  double   *u = motion_rows(x, contact), *sigma = sigma_rows(x, contact);
  double   *z = row(x, x->z, 3 * contact), *change = row(x, (double *)alpha, 1), dz[3];
  mhb_stuck_springs_force(x->springs, contact, du + 3 * contact, dz);
  for (int r = 0; r < 3; r++) {
    dz[r] -= dp[3 * contact + r];
    cblas_daxpy(width, du[3 * contact + r], alpha, 1, row(x, u, r), 1);
    cblas_daxpy(width, dz[r], alpha, 1, row(x, z, r), 1);
    for (int c = 0; c < width; c++) row(x, change, r)[c] = dz[r] * alpha[c];
    if (r < 2) cblas_daxpy(width, dsigma[2 * contact + r], alpha, 1, row(x, sigma, r), 1);
  }
  add_transposed(x, m, 3, 1, x->springs->stuck + (size_t)(3 * contact * m), change, x->g);
}

/* sigma = set y of the contact; alpha = measure . y */
static void set_sigma(mhb_slider_propagation *x, const mhb_saltation *jump, double *alpha) {
  double *u = motion_rows(x, jump->contact), *sigma = sigma_rows(x, jump->contact);
  for (int c = 0; c < x->width; c++) {
    const double y[3] = {u[c], sigma[c], sigma[x->width + c]};
    alpha[c]          = 0;
    for (int k = 0; k < 3; k++) alpha[c] += jump->measure[k] * y[k];
    for (int i = 0; i < 2; i++)
      sigma[i * x->width + c] =
          jump->set[i][0] * y[0] + jump->set[i][1] * y[1] + jump->set[i][2] * y[2];
  }
}

void mhb_slider_propagation_jump(mhb_slider_propagation *x, const mhb_saltation *jump,
                                 const double *du, const double *dsigma, const double *dp) {
  const int j     = jump->contact;
  double   *alpha = x->work;
  if (!x->is_active[j]) {
    refresh(x, j);
    release(x, j);
    set_active(x, j, true);
  }
  set_sigma(x, jump, alpha);
  const bool others = jump->measure[0] != 0 || jump->measure[1] != 0 || jump->measure[2] != 0;
  for (int i = 0; i < x->n_active && others; i++) add_jump(x, x->active[i], alpha, du, dsigma, dp);
  if (!jump->stuck) return;
  hold(x, j);
  set_active(x, j, false);
}

void mhb_slider_propagation_finish(mhb_slider_propagation *x) {
  for (int j = 0; j < x->springs->n / 3; j++)
    if (!x->is_active[j]) refresh(x, j);
}
