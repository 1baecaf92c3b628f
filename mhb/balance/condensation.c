#include "mhb/balance/condensation.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/balance/stick_stiffness.h"
#include "mhb/numerics/lu.h"

/* Fewer stuck unknowns than this are not worth a team of threads. */
enum { WORTH_THREADS = 72 };

/* With many pairs, more moving unknowns or stuck axes than this are left to GMRES, measured on 8 to
 * 22 pairs of cases/z_notch_blade. */
enum { MOST_MOVING = 200, MOST_STUCK = 60 };

/* Accuracy of a Newton step by GMRES. */
static const double STEP_ACCURACY = 1e-4;

static const double complex ONE = 1, MINUS_ONE = -1;

/* ---- life cycle ---- */

static size_t n_axes(const mhb_condensation *s) {
  return 3 * (size_t)s->balance->n_pairs;
}

/* The large arrays are not cleared: their pages are touched only as far as they are used. */
static void allocate(mhb_condensation *s) {
  size_t pairs = (size_t)s->balance->n_pairs, n3 = n_axes(s), K = (size_t)s->balance->m + 1;
  size_t size           = (size_t)s->capacity + MHB_MOST_BORDERS;
  size_t borders        = 1 + 2 * (pairs < MHB_MOST_AT_LIMIT ? pairs : MHB_MOST_AT_LIMIT);
  size_t half           = n3 * n3 / 4 + 1; /* 3 stuck times 3 nonlinear is never more */
  s->kind               = shb_alloc_zeroed(pairs, sizeof *s->kind);
  s->form               = shb_alloc_zeroed(pairs, sizeof *s->form);
  s->nonlinear          = shb_alloc_zeroed(pairs, sizeof(int));
  s->stuck              = shb_alloc_zeroed(pairs, sizeof(int));
  s->factored           = shb_alloc_zeroed(pairs, sizeof(int));
  s->is_factored        = shb_alloc_zeroed(K, 1);
  s->A                  = shb_alloc(K * n3 * n3, sizeof(double complex));
  s->A_pivot            = shb_alloc_zeroed(K * n3, sizeof(int));
  s->schur              = shb_alloc(K * n3 * n3, sizeof(double complex));
  s->stuck_to_nonlinear = shb_alloc(K * half, sizeof(double complex));
  s->nonlinear_to_stuck = shb_alloc(K * half, sizeof(double complex));
  s->columns            = shb_alloc_zeroed(borders * K * n3, sizeof(double complex));
  s->rows               = shb_alloc_zeroed(borders * K * n3, sizeof(double complex));
  s->dense              = shb_alloc(size * size, sizeof(double));
  s->unknown            = shb_alloc_zeroed(size, sizeof(double));
  s->live               = shb_alloc_zeroed(n3, sizeof(int));
  s->full               = shb_alloc_zeroed((size_t)s->balance->n, sizeof(double));
  s->full_row           = shb_alloc(borders * (size_t)s->balance->n, sizeof(double));
  s->pivot              = shb_alloc_zeroed(size, sizeof(int));
  s->rhs                = shb_alloc_zeroed(K * n3, sizeof(double complex));
  s->nonlinear_force    = shb_alloc_zeroed(K * n3, sizeof(double complex));
  s->stuck_force        = shb_alloc_zeroed(K * n3, sizeof(double complex));
  s->open_reaction      = shb_alloc_zeroed(n3, sizeof(double complex));
}

mhb_condensation *mhb_condensation_create(const mhb_balance *balance) {
  return mhb_condensation_create_within(balance, balance->n);
}

mhb_condensation *mhb_condensation_create_within(const mhb_balance *balance, int capacity) {
  mhb_condensation *s = shb_alloc_zeroed(1, sizeof *s);
  s->balance          = balance;
  s->m                = balance->m;
  s->n_pairs          = balance->n_pairs;
  s->capacity         = capacity < balance->n ? capacity : balance->n;
  s->omega            = NAN;
  s->accuracy         = STEP_ACCURACY;
  if (balance->product && s->capacity > MHB_MOST_DENSE) s->capacity = MHB_MOST_DENSE;
  if (balance->receptance->ring)
    s->ring = mhb_ring_system_create(balance);
  else
    allocate(s);
  if (balance->product)
    s->low_rank = mhb_woodbury_create(balance->product, balance->law,
                                      SHB_TWO_PI * balance->settings->frequency[0],
                                      SHB_TWO_PI * balance->settings->frequency[1]);
  return s;
}

void mhb_condensation_destroy(mhb_condensation *s) {
  if (!s) return;
  mhb_ring_system_destroy(s->ring);
  mhb_woodbury_destroy(s->low_rank);
  free(s->form);
  free(s->kind);
  free(s->nonlinear);
  free(s->stuck);
  free(s->factored);
  free(s->is_factored);
  free(s->A);
  free(s->A_pivot);
  free(s->schur);
  free(s->stuck_to_nonlinear);
  free(s->nonlinear_to_stuck);
  free(s->columns);
  free(s->rows);
  free(s->dense);
  free(s->unknown);
  free(s->live);
  free(s->full);
  free(s->full_row);
  free(s->pivot);
  free(s->rhs);
  free(s->nonlinear_force);
  free(s->stuck_force);
  free(s->open_reaction);
  free(s);
}

/* ---- arrays by harmonic ---- */

/* Place of harmonic k > 0 or of the mean in a row of real form. */
static int place(int k) {
  return k ? 2 * k - 1 : 0;
}

/* Real form [row][nb] to harmonics [k][row], and back. */
static void to_harmonics(const mhb_condensation *s, const double *x, double complex *X) {
  size_t n3 = n_axes(s);
  int    nb = s->balance->nb;
  for (size_t row = 0; row < n3; row++, x += nb) {
    X[row] = x[0];
    for (int k = 1; k <= s->balance->m; k++)
      X[(size_t)k * n3 + row] = CMPLX(x[2 * k - 1], x[2 * k]);
  }
}

static void to_real(const mhb_condensation *s, const double complex *X, double *x) {
  size_t n3 = n_axes(s);
  int    nb = s->balance->nb;
  for (size_t row = 0; row < n3; row++, x += nb) {
    x[0] = creal(X[row]);
    for (int k = 1; k <= s->balance->m; k++) {
      x[2 * k - 1] = creal(X[(size_t)k * n3 + row]);
      x[2 * k]     = cimag(X[(size_t)k * n3 + row]);
    }
  }
}

static double complex *A_of(const mhb_condensation *s, int k) {
  return s->A + (size_t)k * n_axes(s) * n_axes(s);
}

static double complex *schur_of(const mhb_condensation *s, int k) {
  return s->schur + (size_t)k * n_axes(s) * n_axes(s);
}

/* Harmonic k of an array [k][3 nonlinear][3 stuck]. */
static double complex *coupling_of(const mhb_condensation *s, double complex *array, int k) {
  return array + (size_t)k * (n_axes(s) * n_axes(s) / 4 + 1);
}

/* Harmonic k of an array [k][3 pairs]. */
static double complex *harmonic_of(const mhb_condensation *s, double complex *array, int k) {
  return array + (size_t)k * n_axes(s);
}

/* Harmonic k of border j of an array [border][k][3 pairs]. */
static double complex *border_of(const mhb_condensation *s, double complex *array, int j, int k) {
  return array + ((size_t)j * ((size_t)s->balance->m + 1) + (size_t)k) * n_axes(s);
}

static double *dense_row(const mhb_condensation *s, int row) {
  return s->dense + (size_t)row * (size_t)s->size;
}

/* Row of the receptance R_k. */
static const double complex *receptance_row(const mhb_condensation *s, int k, int row) {
  size_t n3 = n_axes(s);
  return s->balance->receptance->R + ((size_t)k * n3 + (size_t)row) * n3;
}

/* Number of axis i of the listed pairs among those of all pairs. */
static int axis_of(const int *pair, int i) {
  return 3 * pair[i / 3] + i % 3;
}

/* sum over the listed pairs of R p, R one row of the receptance */
static double complex response(const double complex *R, int n, const int *pair,
                               const double complex *p) {
  double re = 0, im = 0;
  for (int j = 0; j < n; j++)
    for (int c = 3 * pair[j]; c < 3 * pair[j] + 3; c++) {
      re += creal(R[c]) * creal(p[c]) - cimag(R[c]) * cimag(p[c]);
      im += creal(R[c]) * cimag(p[c]) + cimag(R[c]) * creal(p[c]);
    }
  return CMPLX(re, im);
}

static int is_zero(size_t n, const double complex *x) {
  for (size_t i = 0; i < n; i++)
    if (creal(x[i]) != 0 || cimag(x[i]) != 0) return 0;
  return 1;
}

/* ---- the pairs ---- */

static void classify_pairs(mhb_condensation *s) {
  s->n_nonlinear = s->n_stuck = s->n_at_limit = 0;
  for (int a = 0; a < s->balance->n_pairs; a++) {
    mhb_pair_kind kind = s->balance->eval->kind[a];
    if (kind == MHB_PAIR_AT_LIMIT) {
      kind = s->n_at_limit < MHB_MOST_AT_LIMIT ? MHB_PAIR_STUCK : MHB_PAIR_NONLINEAR;
      if (kind == MHB_PAIR_STUCK) s->at_limit[s->n_at_limit++] = a;
    }
    if (kind == MHB_PAIR_NONLINEAR) s->nonlinear[s->n_nonlinear++] = a;
    if (kind == MHB_PAIR_STUCK) s->stuck[s->n_stuck++] = a;
    s->kind[a] = kind;
  }
}

/* S x of the stuck pairs, for x[3 pairs] of harmonic k. */
static void set_stuck_force(mhb_condensation *s, int k, const double complex *x) {
  double complex *force = harmonic_of(s, s->stuck_force, k);
  for (int i = 0; i < s->n_stuck; i++) {
    int a = s->stuck[i];
    mhb_stick_force(&s->balance->law[a], k, x + 3 * a, force + 3 * a);
  }
}

/* Factor A = I + R_LL S of harmonic k, unless that is done. Returns 0 if singular. */
static int factor_stuck(mhb_condensation *s, int k) {
  int             nl = 3 * s->n_stuck;
  double complex *A  = A_of(s, k);
  if (s->is_factored[k] || nl == 0) return 1;
  for (int i = 0; i < nl; i++) {
    const double complex *R = receptance_row(s, k, axis_of(s->stuck, i));
    for (int j = 0; j < s->n_stuck; j++) {
      double complex RS[3]; /* S is symmetric: R S = (S R^T)^T */
      mhb_stick_force(&s->balance->law[s->stuck[j]], k, R + 3 * s->stuck[j], RS);
      for (int c = 0; c < 3; c++)
        A[(size_t)(3 * j + c) * (size_t)nl + (size_t)i] = RS[c] + (i == 3 * j + c);
    }
  }
  return s->is_factored[k] = (char)mhb_factor_complex(nl, A, s->A_pivot + (size_t)k * n_axes(s));
}

/* x_L <- A^-1 x_L of harmonic k, x[3 pairs], and its forces S x_L. Returns 0 if singular. */
static int solve_stuck(mhb_condensation *s, int k, double complex *x) {
  int            nl = 3 * s->n_stuck;
  double complex packed[nl + 1];
  if (nl == 0) return 1;
  for (int i = 0; i < nl; i++) packed[i] = x[axis_of(s->stuck, i)];
  if (is_zero((size_t)nl, packed)) {
    memset(harmonic_of(s, s->stuck_force, k), 0, n_axes(s) * sizeof *x);
    return 1;
  }
  mhb_receptance_update(s->balance->receptance, k);
  if (!factor_stuck(s, k)) return 0;
  if (!mhb_solve_complex(nl, A_of(s, k), s->A_pivot + (size_t)k * n_axes(s), 1, packed)) return 0;
  for (int i = 0; i < nl; i++) x[axis_of(s->stuck, i)] = packed[i];
  set_stuck_force(s, k, x);
  return 1;
}

/* C = R_NN - R_NL S A^-1 R_LN of harmonic k. Returns 0 if singular. */
static int set_schur(mhb_condensation *s, int k) {
  int             nl = 3 * s->n_stuck, nn = 3 * s->n_nonlinear;
  double complex *C   = schur_of(s, k);
  double complex *AiR = coupling_of(s, s->stuck_to_nonlinear, k);
  double complex *RS  = coupling_of(s, s->nonlinear_to_stuck, k);
  for (int i = 0; i < nn; i++) {
    const double complex *R = receptance_row(s, k, axis_of(s->nonlinear, i));
    for (int j = 0; j < nn; j++) C[i * nn + j] = R[axis_of(s->nonlinear, j)];
    for (int j = 0; j < s->n_stuck; j++)
      mhb_stick_force(&s->balance->law[s->stuck[j]], k, R + 3 * s->stuck[j], RS + i * nl + 3 * j);
  }
  if (nl == 0) return 1;
  for (int i = 0; i < nl; i++) {
    const double complex *R = receptance_row(s, k, axis_of(s->stuck, i));
    for (int j = 0; j < nn; j++) AiR[j * nl + i] = R[axis_of(s->nonlinear, j)];
  }
  if (!mhb_solve_complex(nl, A_of(s, k), s->A_pivot + (size_t)k * n_axes(s), nn, AiR)) return 0;
  cblas_zgemm(CblasRowMajor, CblasNoTrans, CblasTrans, nn, nn, nl, &MINUS_ONE, RS, nl, AiR, nl,
              &ONE, C, nn);
  return 1;
}

static int factors_are_valid(const mhb_condensation *s) {
  return s->omega == s->balance->receptance->omega && s->n_laws == s->balance->n_laws &&
         s->n_factored == s->n_stuck &&
         memcmp(s->factored, s->stuck, sizeof(int) * (size_t)s->n_stuck) == 0;
}

/* A and C of all harmonics. Nonlinear pairs couple the harmonics; without any, A of a harmonic is
 * factored when its right-hand side is not zero. Returns 0 if singular. */
static int condense_stuck(mhb_condensation *s) {
  int ok = 1, last = s->n_nonlinear > 0 ? s->balance->m : -1;
  if (!factors_are_valid(s)) memset(s->is_factored, 0, (size_t)s->balance->m + 1);
  for (int k = 0; k <= last; k++) mhb_receptance_update(s->balance->receptance, k);
  int team = 3 * s->n_stuck >= WORTH_THREADS;
#pragma omp parallel for schedule(dynamic, 1) reduction(&& : ok) if (team)
  for (int k = 0; k <= last; k++) ok = ok && factor_stuck(s, k) && set_schur(s, k);
  s->omega      = ok ? s->balance->receptance->omega : NAN;
  s->n_factored = s->n_stuck;
  s->n_laws     = s->balance->n_laws;
  memcpy(s->factored, s->stuck, sizeof(int) * (size_t)s->n_stuck);
  return ok;
}

/* to[3 nonlinear][nb] <- x_N - R_NL S A^-1 x_L of harmonic k in real form; x_L <- A^-1 x_L. Serves
 * right-hand sides and border columns. Returns 0 if singular. */
static int eliminate_stuck(mhb_condensation *s, int k, double complex *x, double *to) {
  const double complex *force = harmonic_of(s, s->stuck_force, k);
  if (!solve_stuck(s, k, x)) return 0;
  for (int i = 0; i < 3 * s->n_nonlinear; i++) {
    int            row = axis_of(s->nonlinear, i);
    size_t         at  = (size_t)i * (size_t)s->balance->nb + (size_t)place(k);
    double complex y   = x[row] - response(receptance_row(s, k, row), s->n_stuck, s->stuck, force);
    to[at]             = creal(y);
    if (k) to[at + 1] = cimag(y);
  }
  return 1;
}

/* ---- axes at rest ---- */

static bool rests(const mhb_condensation *s, int axis, const double *column) {
  const int nb = s->balance->nb;
  for (int k = 0; k <= s->balance->m; k++)
    if (!is_zero(n_axes(s), receptance_row(s, k, axis))) return false;
  for (int i = 0; column && i < nb; i++)
    if (column[axis * nb + i] != 0) return false;
  return true;
}

/* The axes of nonlinear pairs that forces move. An axis without receptance, as of a motion along a
 * line, has the solution x = rhs. column: the caller's border, or NULL. */
static void find_live_axes(mhb_condensation *s, const double *column) {
  s->n_live = 0;
  for (int i = 0; i < 3 * s->n_nonlinear; i++)
    if (!rests(s, axis_of(s->nonlinear, i), column)) s->live[s->n_live++] = i;
}

/* to[live][nb] <- full[3 nonlinear][nb] */
static void compress(const mhb_condensation *s, const double *full, double *to, size_t stride) {
  const int nb = s->balance->nb;
  for (int i = 0; i < s->n_live; i++, to += (size_t)nb * stride)
    for (int j = 0; j < nb; j++) to[(size_t)j * stride] = full[s->live[i] * nb + j];
}

static void uncompress(const mhb_condensation *s, const double *from, double *full) {
  const int nb = s->balance->nb;
  for (int i = 0; i < s->n_live; i++)
    memcpy(full + s->live[i] * nb, from + i * nb, sizeof(double) * (size_t)nb);
}

/* ---- the dense system ---- */

/* Rows of the nonlinear pairs at harmonic k: I + C D. */
static void set_nonlinear_rows(mhb_condensation *s, int k) {
  const mhb_balance    *b  = s->balance;
  const int             nn = 3 * s->n_nonlinear, block = 3 * b->nb;
  const double complex *C  = schur_of(s, k);
  double               *re = s->full, im[s->n_nonlinear * block]; /* the mean has none */
  for (int i = 0; i < s->n_live; i++) {
    const int row = i * b->nb + place(k);
    memset(re, 0, sizeof im);
    memset(im, 0, sizeof im);
    for (int j = 0; j < s->n_nonlinear; j++)
      mhb_balance_row_times_dp(b, C + s->live[i] * nn + 3 * j, s->nonlinear[j], k, re + j * block,
                               im + j * block);
    double *to = dense_row(s, row);
    compress(s, re, to, 1);
    memset(to + s->size - s->n_borders, 0, sizeof(double) * (size_t)s->n_borders);
    to[row] += 1;
    if (k == 0) continue;
    to += s->size;
    compress(s, im, to, 1);
    memset(to + s->size - s->n_borders, 0, sizeof(double) * (size_t)s->n_borders);
    to[row + 1] += 1;
  }
}

/* Border of a pair at the friction limit, for the mean of axis u (1) or w (2): column R_0 of the
 * axis, row -G. */
static void set_limit_border(mhb_condensation *s, int j, int pair, int axis) {
  size_t        n3 = n_axes(s);
  int           nb = s->balance->nb, m = s->balance->m;
  const double *G = mhb_balance_mean_friction_row(s->balance, pair, axis);
  memset(border_of(s, s->columns, j, 0), 0, sizeof(double complex) * n3 * ((size_t)m + 1));
  memset(border_of(s, s->rows, j, 0), 0, sizeof(double complex) * n3 * ((size_t)m + 1));
  mhb_receptance_update(s->balance->receptance, 0);
  for (int row = 0; row < (int)n3; row++)
    border_of(s, s->columns, j, 0)[row] = receptance_row(s, 0, row)[3 * pair + axis];
  for (int c = 0; c < 3; c++, G += nb) {
    border_of(s, s->rows, j, 0)[3 * pair + c] = -G[0];
    for (int k = 1; k <= m; k++)
      border_of(s, s->rows, j, k)[3 * pair + c] = CMPLX(-G[2 * k - 1], -G[2 * k]);
  }
}

/* s->open_reaction <- R_O^H row_O of harmonic k: by it the row acts on the forces of other pairs
 * through the motion of the open ones. */
static void set_open_reaction(mhb_condensation *s, int k, const double complex *row) {
  size_t          n3  = n_axes(s);
  double complex *out = s->open_reaction;
  memset(out, 0, n3 * sizeof *out);
  for (size_t i = 0; i < n3; i++) {
    double x = creal(row[i]), y = cimag(row[i]);
    if (s->kind[i / 3] != MHB_PAIR_OPEN || (x == 0 && y == 0)) continue;
    if (s->n_nonlinear + s->n_stuck == 0) continue;
    mhb_receptance_update(s->balance->receptance, k);
    const double complex *R = receptance_row(s, k, (int)i);
    for (size_t j = 0; j < n3; j++)
      out[j] += CMPLX(creal(R[j]) * x + cimag(R[j]) * y, creal(R[j]) * y - cimag(R[j]) * x);
  }
}

/* Real inner product of row and x over the stuck and open pairs. */
static double product_of_linear(const mhb_condensation *s, const double complex *row,
                                const double complex *x) {
  double sum = 0;
  for (size_t i = 0; i < n_axes(s); i++)
    if (s->kind[i / 3] != MHB_PAIR_NONLINEAR)
      sum += creal(row[i]) * creal(x[i]) + cimag(row[i]) * cimag(x[i]);
  return sum;
}

/* Row i of the borders without x_L and x_O. With row_L <- row_L - S R_OL^H row_O it reads
 *   row_N - [(A^-1 R_LN)^H row_L + R_ON^H row_O]^H D   on the nonlinear pairs,
 *   corner - row_L . A^-1 column_L - row_O . column_O  on the borders' unknowns. */
static void set_border_row(mhb_condensation *s, int i, const double *corner) {
  int     nb = s->balance->nb, block = 3 * nb, nl = 3 * s->n_stuck;
  int     first = s->size - s->n_borders;
  double *to    = dense_row(s, first + i), unused[block];
  double *full  = s->full_row + (size_t)i * (size_t)s->balance->n;
  memset(full, 0, sizeof(double) * (size_t)(s->n_nonlinear * block));
  memcpy(to + first, corner, sizeof(double) * (size_t)s->n_borders);
  for (int k = 0; k <= s->balance->m; k++) {
    double complex       *row = border_of(s, s->rows, i, k), force[3], weight[3];
    const double complex *AiR = coupling_of(s, s->stuck_to_nonlinear, k);
    if (is_zero(n_axes(s), row)) continue;
    set_open_reaction(s, k, row);
    for (int j = 0; j < s->n_stuck; j++) {
      int a = s->stuck[j];
      mhb_stick_force(&s->balance->law[a], k, s->open_reaction + 3 * a, force);
      for (int c = 0; c < 3; c++) row[3 * a + c] -= force[c];
    }
    for (int j = 0; j < s->n_nonlinear; j++) {
      double *at = full + j * block + place(k);
      for (int c = 0; c < 3; c++) {
        int            axis = 3 * s->nonlinear[j] + c;
        double complex w    = s->open_reaction[axis];
        at[c * nb] += creal(row[axis]);
        if (k) at[c * nb + 1] += cimag(row[axis]);
        for (int l = 0; l < nl; l++)
          w += conj(AiR[(3 * j + c) * nl + l]) * row[axis_of(s->stuck, l)];
        weight[c] = -conj(w);
      }
      mhb_balance_row_times_dp(s->balance, weight, s->nonlinear[j], k, full + j * block, unused);
    }
    for (int j = 0; j < s->n_borders; j++)
      to[first + j] -= product_of_linear(s, row, border_of(s, s->columns, j, k));
  }
  compress(s, full, to, 1);
}

/* All borders; the columns first, because the rows need A^-1 column_L. Returns 0 if singular. */
static int set_borders(mhb_condensation *s, const double *column, const double *row) {
  int    first = s->size - s->n_borders;
  double corner[MHB_MOST_BORDERS];
  if (s->bordered) {
    to_harmonics(s, column, s->columns);
    to_harmonics(s, row, s->rows);
  }
  for (int i = 0; i < 2 * s->n_at_limit; i++)
    set_limit_border(s, s->bordered + i, s->at_limit[i / 2], 1 + i % 2);
  for (int j = 0; j < s->n_borders; j++) {
    for (int k = 0; k <= s->balance->m; k++)
      if (!eliminate_stuck(s, k, border_of(s, s->columns, j, k), s->full)) return 0;
    compress(s, s->full, s->dense + first + j, (size_t)s->size);
  }
  for (int i = 0; i < s->n_borders; i++) {
    memset(corner, 0, sizeof corner);
    corner[i] = i < s->bordered ? row[s->balance->n] : 1;
    set_border_row(s, i, corner);
  }
  return 1;
}

/* A system of one number, the border where no pair is nonlinear, needs no LAPACK. */
static int factor_dense(mhb_condensation *s) {
  if (s->size == 1) s->pivot[0] = 1;
  if (s->size <= 1) return s->size == 0 || s->dense[0] != 0;
  return LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, s->size, s->size, s->dense, s->size, s->pivot) == 0;
}

static int solve_dense(mhb_condensation *s) {
  if (s->size == 1) s->unknown[0] /= s->dense[0];
  return s->size <= 1 || LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'T', s->size, 1, s->dense, s->size,
                                             s->pivot, s->unknown, s->size) == 0;
}

mhb_block mhb_pair_block(const mhb_balance *b, int a) {
  return b->eval->kind[a] == MHB_PAIR_OPEN    ? MHB_BLOCK_NONE
         : b->eval->kind[a] == MHB_PAIR_STUCK ? MHB_BLOCK_SPRING
                                              : MHB_BLOCK_FULL;
}

/* GMRES pays, and the point was factored for it. */
static int factor_low_rank(mhb_condensation *s, const double *column, const double *row) {
  const mhb_balance *b = s->balance;
  if (!s->low_rank) return 0;
  if (3 * b->nb * s->n_nonlinear <= MOST_MOVING && 3 * s->n_stuck <= MOST_STUCK) return 0;
  for (int a = 0; a < b->n_pairs; a++) s->form[a] = mhb_pair_block(b, a);
  return mhb_woodbury_factor(s->low_rank, s->form, b->eval->dp, b->law, column, row);
}

static int factor_condensed(mhb_condensation *s, const double *column, const double *row) {
  s->n_borders = s->bordered + 2 * s->n_at_limit;
  if (!condense_stuck(s)) return 0;
  find_live_axes(s, column);
  s->size = s->balance->nb * s->n_live + s->n_borders;
  if (s->size - s->n_borders > s->capacity) return 0;
  for (int k = 0; k <= s->balance->m && s->n_nonlinear > 0; k++) set_nonlinear_rows(s, k);
  return set_borders(s, column, row) && factor_dense(s);
}

int mhb_condensation_factor(mhb_condensation *s, const double *column, const double *row) {
  if (s->ring) return mhb_ring_system_factor(s->ring, column, row);
  classify_pairs(s);
  s->bordered    = column != NULL;
  s->by_low_rank = factor_low_rank(s, column, row);
  return s->by_low_rank || factor_condensed(s, column, row);
}

/* ---- solution ---- */

/* q = D x_N */
static void set_nonlinear_force(mhb_condensation *s, const double *x) {
  const mhb_balance *b  = s->balance;
  int                nb = b->nb, block = 3 * nb;
  for (int i = 0; i < s->n_nonlinear; i++) {
    const double *D = b->eval->dp + (size_t)s->nonlinear[i] * (size_t)block * (size_t)block;
    double        p[block];
    cblas_dgemv(CblasRowMajor, CblasNoTrans, block, block, 1, D, block, x + i * block, 1, 0, p, 1);
    for (int c = 0; c < 3; c++)
      for (int k = 0; k <= b->m; k++)
        harmonic_of(s, s->nonlinear_force, k)[3 * s->nonlinear[i] + c] =
            k ? CMPLX(p[c * nb + 2 * k - 1], p[c * nb + 2 * k]) : p[c * nb];
  }
}

/* What the axes at rest add to the other rows goes to their right-hand side. */
static void move_rest(mhb_condensation *s) {
  const int nn = 3 * s->n_nonlinear, nb = s->balance->nb;
  double    rest[nn * nb], *borders = s->unknown + s->size - s->n_borders, sum = 0;
  memcpy(rest, s->full, sizeof rest);
  for (int i = 0; i < s->n_live; i++)
    memset(rest + s->live[i] * nb, 0, sizeof(double) * (size_t)nb);
  for (int i = 0; i < nn * nb; i++) sum += fabs(rest[i]);
  if (!(sum > 0)) return;
  set_nonlinear_force(s, rest);
  for (int k = 0; k <= s->balance->m; k++) {
    const double complex *q = harmonic_of(s, s->nonlinear_force, k);
    for (int i = 0; i < s->n_live; i++) {
      const double complex *C  = schur_of(s, k) + s->live[i] * nn;
      double               *to = s->full + s->live[i] * nb + place(k);
      double complex        y  = 0;
      for (int j = 0; j < nn; j++) y += C[j] * q[axis_of(s->nonlinear, j)];
      to[0] -= creal(y);
      if (k) to[1] -= cimag(y);
    }
  }
  for (int i = 0; i < s->n_borders; i++)
    borders[i] -= cblas_ddot(nn * nb, s->full_row + (size_t)i * (size_t)s->balance->n, 1, rest, 1);
}

/* Right-hand side of the dense system; rhs_L <- A^-1 rhs_L. Returns 0 if singular. */
static int condense_rhs(mhb_condensation *s, double rhs_border) {
  double *borders = s->unknown + s->size - s->n_borders;
  for (int i = 0; i < s->n_borders; i++) borders[i] = i < s->bordered ? rhs_border : 0;
  for (int k = 0; k <= s->balance->m; k++) {
    double complex *rhs = harmonic_of(s, s->rhs, k);
    if (!eliminate_stuck(s, k, rhs, s->full)) return 0;
    for (int i = 0; i < s->n_borders; i++)
      borders[i] -= product_of_linear(s, border_of(s, s->rows, i, k), rhs);
  }
  if (s->n_live < 3 * s->n_nonlinear) move_rest(s);
  compress(s, s->full, s->unknown, 1);
  return 1;
}

/* Harmonic k of x, in place of the right-hand side. */
static void expand(mhb_condensation *s, int k) {
  int                   n3 = (int)n_axes(s), nl = 3 * s->n_stuck, nn = 3 * s->n_nonlinear;
  const double complex *AiR = coupling_of(s, s->stuck_to_nonlinear, k);
  const double complex *q   = harmonic_of(s, s->nonlinear_force, k);
  double complex       *x   = harmonic_of(s, s->rhs, k);
  for (int j = 0; j < s->n_borders; j++) { /* stuck and open: - column sigma */
    const double complex *column = border_of(s, s->columns, j, k);
    double                sigma  = s->unknown[s->size - s->n_borders + j];
    for (int row = 0; row < n3; row++)
      if (s->kind[row / 3] != MHB_PAIR_NONLINEAR) x[row] -= sigma * column[row];
  }
  for (int j = 0; j < nn; j++) /* stuck: - A^-1 R_LN q */
    for (int i = 0; i < nl; i++)
      x[axis_of(s->stuck, i)] -= AiR[j * nl + i] * q[axis_of(s->nonlinear, j)];
  set_stuck_force(s, k, x);
  for (int row = 0; row < n3 && nl + nn > 0; row++) { /* open: - R_ON q - R_OL S x_L */
    if (s->kind[row / 3] != MHB_PAIR_OPEN) continue;
    const double complex *R = receptance_row(s, k, row);
    x[row] -= response(R, s->n_nonlinear, s->nonlinear, q) +
              response(R, s->n_stuck, s->stuck, harmonic_of(s, s->stuck_force, k));
  }
  for (int i = 0; i < nn; i++) { /* nonlinear: from the dense system */
    const double *y             = s->full + i * s->balance->nb + place(k);
    x[axis_of(s->nonlinear, i)] = k ? CMPLX(y[0], y[1]) : y[0];
  }
}

/* 0: rhs is as it was, and the point is condensed. */
static int solve_low_rank(mhb_condensation *s, double *rhs) {
  if (mhb_woodbury_solve(s->low_rank, s->accuracy, rhs)) return 1;
  s->by_low_rank = 0;
  return 0;
}

int mhb_condensation_solve(mhb_condensation *s, double *rhs) {
  int n = s->balance->n;
  if (s->ring) return mhb_ring_system_solve(s->ring, rhs);
  if (s->by_low_rank) {
    if (solve_low_rank(s, rhs)) return 1;
    if (!factor_condensed(s, s->low_rank->column, s->low_rank->row)) return 0;
  }
  to_harmonics(s, rhs, s->rhs);
  if (!condense_rhs(s, s->bordered ? rhs[n] : 0) || !solve_dense(s)) return 0;
  uncompress(s, s->unknown, s->full);
  set_nonlinear_force(s, s->full);
  for (int k = 0; k <= s->balance->m; k++) expand(s, k);
  to_real(s, s->rhs, rhs);
  if (s->bordered) rhs[n] = s->unknown[s->size - s->n_borders];
  for (int i = 0; i < n + s->bordered; i++)
    if (!isfinite(rhs[i])) return 0;
  return 1;
}

int mhb_condensation_sign(const mhb_condensation *s) {
  int sign = 1;
  if (s->ring) return mhb_ring_system_sign(s->ring);
  if (s->by_low_rank) return mhb_woodbury_sign(s->low_rank);
  for (int i = 0; i < s->size; i++) {
    if (dense_row(s, i)[i] < 0) sign = -sign;
    if (s->pivot[i] != i + 1) sign = -sign;
  }
  return sign;
}
