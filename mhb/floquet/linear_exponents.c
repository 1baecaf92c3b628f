#include "mhb/floquet/linear_exponents.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

void mhb_linear_exponents_create(const mhb_modal_structure *s, mhb_linear_exponents *x) {
  *x       = (mhb_linear_exponents){.structure = s,
                                    .n         = 2 * s->modes * s->blades,
                                    .orbits    = s->mistuned ? s->contacts : s->pairs};
  size_t m = (size_t)s->modes, orbits = (size_t)x->orbits, n3 = 3 * orbits, n = (size_t)x->n;
  x->state    = shb_arena_take(&x->arena, orbits, sizeof *x->state);
  x->law      = shb_arena_take(&x->arena, orbits, sizeof *x->law);
  x->exponent = shb_arena_take(&x->arena, n, sizeof *x->exponent);
  x->pivot    = shb_arena_take(&x->arena, n3, sizeof *x->pivot);
  if (s->mistuned) {
    x->ring = shb_arena_take(&x->arena, n * n + n3 * (n3 + n / 2) + 10 * n, sizeof *x->ring);
  } else {
    x->A     = shb_arena_take(&x->arena, 4 * m * m, sizeof *x->A);
    x->left  = shb_arena_take(&x->arena, n3 * m, sizeof *x->left);
    x->R     = shb_arena_take(&x->arena, 3 * n3, sizeof *x->R);
    x->S     = shb_arena_take(&x->arena, n3 * (n3 + m), sizeof *x->S);
    x->work  = shb_arena_take(&x->arena, 40 * m, sizeof *x->work);
    x->rwork = shb_arena_take(&x->arena, 4 * m, sizeof *x->rwork);
  }
}

void mhb_linear_exponents_destroy(mhb_linear_exponents *x) {
  shb_arena_free(&x->arena);
  *x = (mhb_linear_exponents){0};
}

/* Stiffness of a contact in a constant state. */
static void stiffness(int state, const mhb_law *law, double S[3][3]) {
  memset(S, 0, sizeof(double) * 9);
  if (state == MHB_SEPARATE) return;
  S[0][0] = law->kv;
  if (state != MHB_STICK || law->mu == 0) return;
  S[1][1] = law->ku[0];
  S[1][2] = S[2][1] = law->ku[1];
  S[2][2]           = law->ku[2];
}

/* B[3 pairs][mode] of nodal diameter d, into left. */
static void relative_shapes(mhb_linear_exponents *x, int d, double complex step) {
  const mhb_modal_structure *s = x->structure;
  int                        m = s->modes, n3 = 3 * s->pairs;
  for (int k = 0; s->disc && k < m * n3; k++)
    x->left[k % n3 * m + k / n3] = s->disc->shape[(size_t)d * (size_t)(m * n3) + (size_t)k];
  if (s->disc) return;
  for (int r = 0; r < n3; r++) {
    for (int i = 0; i < m; i++) {
      double complex sum = s->shape[i * n3 + r];
      if (s->sides == 2) sum += step * s->shape[(m + i) * n3 + r];
      x->left[r * m + i] = sum;
    }
  }
}

/* Rows of contact a in the residual flexibility R of nodal diameter d. */
static void relative_flexibility(mhb_linear_exponents *x, int a, int d, double complex step) {
  const mhb_modal_structure *s    = x->structure;
  const size_t               rows = 3 * (size_t)s->pairs, square = rows * rows, count = 3 * rows;
  const size_t               from = (size_t)a * count;
  memset(x->R, 0, sizeof *x->R * count);
  if (s->disc && s->disc->flexibility)
    memcpy(x->R, s->disc->flexibility + (size_t)d * square + from, sizeof *x->R * count);
  for (size_t i = from; i < from + count && s->block; i++)
    x->R[i - from] =
        s->block[i] + step * s->block[square + i] + conj(step) * s->block[2 * square + i];
}

/* Element c of the row K of contact a times [R B], c < n3 + modes. */
static double complex stiffness_row(const mhb_linear_exponents *x, const double K[3], int a,
                                    int c) {
  int            n3 = 3 * x->structure->pairs, m = x->structure->modes;
  double complex sum = 0;
  for (int k = 0; k < 3; k++)
    sum += K[k] * (c < n3 ? x->R[k * n3 + c] : x->left[(3 * a + k) * m + c - n3]);
  return sum;
}

/* S B of nodal diameter d into the columns n3.. of x->S, from I + diag(kv, Ku) R in those before.
 * Returns 0 if singular. */
static int contact_stiffness(mhb_linear_exponents *x, int d, double complex step) {
  int    n3 = 3 * x->structure->pairs, m = x->structure->modes;
  size_t rows = (size_t)n3;
  double K[3][3];
  for (int row = 0; row < n3; row++) {
    if (row % 3 == 0) relative_flexibility(x, row / 3, d, step);
    stiffness(x->state[row / 3], &x->law[row / 3], K);
    for (int c = 0; c < n3 + m; c++)
      x->S[(size_t)c * rows + (size_t)row] = (c == row) + stiffness_row(x, K[row % 3], row / 3, c);
  }
  return LAPACKE_zgesv_work(LAPACK_COL_MAJOR, n3, m, x->S, n3, x->pivot, x->S + rows * rows, n3) ==
         0;
}

/* Exponents of one nodal diameter. Returns 0 if the eigensolver failed. */
static int nodal_diameter(mhb_linear_exponents *x, int d) {
  const mhb_modal_structure *s  = x->structure;
  int                        n3 = 3 * s->pairs, m = s->modes, n = 2 * m;
  double complex             step    = cexp(-I * SHB_TWO_PI * d / s->blades);
  const double              *omega   = s->disc ? s->disc->omega + d * m : s->omega;
  const double              *zeta    = s->disc ? s->disc->zeta + d * m : s->zeta;
  const mhb_coupled_modes   *coupled = s->disc ? s->disc->coupled : NULL;
  relative_shapes(x, d, step);
  if (!contact_stiffness(x, d, step)) return 0;
  const double complex *SB = x->S + (size_t)n3 * (size_t)n3;
  memset(x->A, 0, sizeof *x->A * (size_t)(n * n));
  for (int i = 0; i < m; i++) {
    x->A[(m + i) * n + i]     = 1;
    x->A[(m + i) * n + m + i] = -2 * zeta[i] * omega[i];
    for (int k = 0; k < m; k++) {
      double complex sum = i == k ? omega[i] * omega[i] : 0;
      for (int r = 0; r < n3; r++) sum += conj(x->left[r * m + i]) * SB[k * n3 + r];
      x->A[k * n + m + i] = -sum;
      if (coupled) x->A[(m + k) * n + m + i] -= coupled->G[(d * m + i) * m + k];
    }
  }
  return LAPACKE_zgeev_work(LAPACK_COL_MAJOR, 'N', 'N', n, x->A, n,
                            x->exponent + (size_t)d * (size_t)n, NULL, 1, NULL, 1, x->work, 40 * m,
                            x->rwork) == 0;
}

/* The structure is real: N - d has the conjugates of d. */
static void copy_conjugate(mhb_linear_exponents *x, int d) {
  size_t                n    = 2 * (size_t)x->structure->modes;
  const double complex *from = x->exponent + (size_t)(x->structure->blades - d) * n;
  double complex       *to   = x->exponent + (size_t)d * n;
  for (size_t i = 0; i < n; i++) to[i] = conj(from[i]);
}

/* ---- mistuned ---- */

/* Motion of row r by mode c of the ring [blade][mode]. */
static double ring_shape(const mhb_modal_structure *s, int r, int c) {
  const int n3 = 3 * s->pairs, blade = c / s->modes, mode = c % s->modes;
  double    sum = 0;
  for (int side = 0; side < s->sides; side++)
    if (r / n3 * s->pairs == mhb_modal_structure_contact(s, blade, side))
      sum += s->shape[(side * s->modes + mode) * n3 + r % n3];
  return sum;
}

/* [I + K R | K B], column-major with n3 rows. */
static void ring_contacts(const mhb_linear_exponents *x, double *S) {
  const mhb_modal_structure *s  = x->structure;
  const int                  n3 = 3 * s->contacts, half = x->n / 2;
  double                     K[3][3];
  for (int row = 0; row < n3; row++) {
    stiffness(x->state[row / 3], &x->law[row / 3], K);
    for (int c = 0; c < n3 + half; c++) {
      double sum = c == row;
      for (int k = 0; k < 3; k++) {
        const int of = row - row % 3 + k;
        if (c >= n3) sum += K[row % 3][k] * ring_shape(s, of, c - n3);
        if (c < n3 && s->flexibility)
          sum += K[row % 3][k] * s->flexibility[(size_t)of * (size_t)n3 + (size_t)c];
      }
      S[(size_t)c * (size_t)n3 + (size_t)row] = sum;
    }
  }
}

/* Exponents of all blades at once. Returns 0 if singular, or if the eigensolver failed. */
static int mistuned_ring(mhb_linear_exponents *x) {
  const mhb_modal_structure *s  = x->structure;
  const int                  n3 = 3 * s->contacts, n = x->n, half = n / 2;
  const size_t               rows = (size_t)n;
  double                    *A = x->ring, *S = A + rows * rows, *SB = S + (size_t)n3 * (size_t)n3;
  double                    *re = SB + (size_t)n3 * (size_t)half, *im = re + n, *work = im + n;
  ring_contacts(x, S);
  if (LAPACKE_dgesv_work(LAPACK_COL_MAJOR, n3, half, S, n3, x->pivot, SB, n3) != 0) return 0;
  memset(A, 0, sizeof *A * rows * rows);
  for (int i = 0; i < half; i++) {
    const double w = s->omega[i], damping = 2 * s->zeta[i % s->modes] * w;
    A[(size_t)(half + i) * rows + (size_t)i]          = 1;
    A[(size_t)(half + i) * rows + (size_t)(half + i)] = -damping;
    A[(size_t)i * rows + (size_t)(half + i)]          = -w * w;
    for (int r = 0; r < n3; r++) {
      const double b = ring_shape(s, r, i);
      for (int k = 0; b != 0 && k < half; k++)
        A[(size_t)k * rows + (size_t)(half + i)] -= b * SB[(size_t)k * (size_t)n3 + (size_t)r];
    }
  }
  if (LAPACKE_dgeev_work(LAPACK_COL_MAJOR, 'N', 'N', n, A, n, re, im, NULL, 1, NULL, 1, work,
                         8 * n) != 0)
    return 0;
  for (int i = 0; i < n; i++) x->exponent[i] = CMPLX(re[i], im[i]);
  return 1;
}

static int same(const mhb_linear_exponents *x, const int *state, const mhb_law *law) {
  for (int a = 0; a < x->orbits; a++) {
    const mhb_law *old = &x->law[a];
    if (state[a] != x->state[a] || law[a].kv != old->kv || (law[a].mu == 0) != (old->mu == 0) ||
        law[a].ku[0] != old->ku[0] || law[a].ku[1] != old->ku[1] || law[a].ku[2] != old->ku[2])
      return 0;
  }
  return 1;
}

/* By falling real part: the multipliers of any period then have falling modulus. */
static int by_real_part(const void *a, const void *b) {
  double x = creal(*(const double complex *)a), y = creal(*(const double complex *)b);
  return (x < y) - (x > y);
}

int mhb_linear_exponents_set(mhb_linear_exponents *x, const int *state, const mhb_law *law) {
  const mhb_modal_structure *s = x->structure;
  if (x->known && same(x, state, law)) return 1;
  memcpy(x->state, state, sizeof *state * (size_t)x->orbits);
  memcpy(x->law, law, sizeof *law * (size_t)x->orbits);
  x->known = s->mistuned ? mistuned_ring(x) : 1;
  for (int d = 0; d < s->blades && !s->mistuned; d++) {
    if (2 * d > s->blades) {
      copy_conjugate(x, d);
    } else {
      x->known &= nodal_diameter(x, d);
    }
  }
  qsort(x->exponent, (size_t)x->n, sizeof *x->exponent, by_real_part);
  return x->known;
}
