#include "tests/support/hill.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/numerics/fourier.h"

/* Index of (harmonic k, row or mode i of n): (k + m) n + i. */
typedef struct {
  const mhb_modal_structure *s;
  int                        m, K, n3; /* K = 2m+1 */
  double                     omega;
  double complex            *B;      /* [k][n3][mode] */
  double complex            *J, *JR; /* [K n3][K n3] column-major */
  double complex            *A;      /* [2 K modes][.] column-major */
  double complex            *exponent, *work;
  double                    *rwork;
  int                       *pivot;
} hill;

static double complex neighbour_phase(const hill *h, int d, int k, int blades_on) {
  const mhb_modal_structure *s     = h->s;
  long                       turns = (d + (long)k * s->wave) % s->blades * blades_on;
  return cexp(-I * SHB_TWO_PI * (double)turns / s->blades);
}

static void set_shapes(hill *h, int d) {
  const mhb_modal_structure *s     = h->s;
  int                        modes = s->modes;
  for (int k = -h->m; k <= h->m; k++) {
    double complex phase = neighbour_phase(h, d, k, 1), *B = h->B + (k + h->m) * h->n3 * modes;
    for (int r = 0; r < h->n3; r++)
      for (int i = 0; i < modes; i++) {
        B[r * modes + i] = s->shape[i * h->n3 + r];
        if (s->sides == 2) B[r * modes + i] += phase * s->shape[(modes + i) * h->n3 + r];
      }
  }
}

/* Weight of real coefficient i (fourier.h) in exponential k: c_k = sum_i w a_i. */
static double complex to_exponential(int k, int i) {
  if (k == 0) return i == 0;
  int j = k > 0 ? k : -k;
  if (i == 2 * j - 1) return 0.5;
  return i == 2 * j ? (k > 0 ? 0.5 * I : -0.5 * I) : 0;
}

/* Weight of exponential k in real coefficient i. */
static double complex to_real(int i, int k) {
  if (i == 0) return k == 0;
  int j = (i + 1) / 2;
  if (k != j && k != -j) return 0;
  return i == 2 * j - 1 ? 1 : k > 0 ? -I : I;
}

/* One element of J: row (k, r), column (l, c), both of pair a. At most two real coefficients meet each exponential. */
static double complex element(const hill *h, const double *dp, int k, int l, int r, int c) {
  int            nb = h->K, first = abs(k) ? 2 * abs(k) - 1 : 0, from = abs(l) ? 2 * abs(l) - 1 : 0;
  double complex sum = 0;
  for (int i = first; i <= 2 * abs(k); i++)
    for (int j = from; j <= 2 * abs(l); j++)
      sum += to_exponential(k, i) *
             dp[(size_t)(r * nb + i) * (size_t)(3 * nb) + (size_t)(c * nb + j)] * to_real(j, l);
  return sum;
}

static void set_derivative(hill *h, const double *dp) {
  int    K = h->K, n3 = h->n3, n = K * n3;
  size_t block = 9 * (size_t)(K * K);
  memset(h->J, 0, sizeof *h->J * (size_t)n * (size_t)n);
  for (int e = 0; e < K * K * 9 * (n3 / 3); e++) { /* (k, l), pair, (r, c) */
    int k = e / (9 * n3 / 3) / K, l = e / (9 * n3 / 3) % K, a = e / 9 % (n3 / 3), r = e % 9 / 3,
        c = e % 3;
    h->J[(size_t)(l * n3 + 3 * a + c) * (size_t)n + (size_t)(k * n3 + 3 * a + r)] =
        element(h, dp + (size_t)a * block, k - h->m, l - h->m, r, c);
  }
}

/* R of harmonic k between rows of blade 0. */
static double complex flexibility(const hill *h, int d, int k, int r, int c) {
  const mhb_modal_structure *s   = h->s;
  size_t                     n   = 3 * (size_t)s->contacts;
  double complex             sum = 0;
  for (int b = 0; b < s->blades; b++)
    sum += neighbour_phase(h, d, k, b) * s->flexibility[(size_t)r * n + (size_t)(b * h->n3 + c)];
  return sum;
}

/* J <- (I + J R)^-1 J. 0: singular. */
static int soften(hill *h, int d) {
  int n = h->K * h->n3, n3 = h->n3;
  for (int column = 0; column < n; column++) {
    int l = column / n3;
    for (int row = 0; row < n; row++) {
      double complex sum = row == column;
      for (int k = 0; k < n3; k++)
        sum += h->J[(size_t)(l * n3 + k) * (size_t)n + (size_t)row] *
               flexibility(h, d, l - h->m, k, column % n3);
      h->JR[(size_t)column * (size_t)n + (size_t)row] = sum;
    }
  }
  return LAPACKE_zgesv_work(LAPACK_COL_MAJOR, n, n, h->JR, n, h->pivot, h->J, n) == 0;
}

/* B_k^H J_kl B_l between modes i and j. */
static double complex coupling(const hill *h, int k, int l, int i, int j) {
  int                   n = h->K * h->n3, n3 = h->n3, modes = h->s->modes;
  const double complex *Bk = h->B + k * n3 * modes, *Bl = h->B + l * n3 * modes;
  double complex        sum = 0;
  for (int c = 0; c < n3; c++) {
    const double complex *J     = h->J + (size_t)(l * n3 + c) * (size_t)n + (size_t)(k * n3);
    double complex        inner = 0;
    for (int r = 0; r < n3; r++) inner += conj(Bk[r * modes + i]) * J[r];
    sum += inner * Bl[c * modes + j];
  }
  return sum;
}

/* s (a, b) = A (a, b) with b_k = (s + jkw) a_k. */
static void set_matrix(hill *h) {
  const mhb_modal_structure *s    = h->s;
  int                        half = h->K * s->modes;
  size_t                     n    = 2 * (size_t)half;
  memset(h->A, 0, sizeof *h->A * n * n);
  for (int row = 0; row < half; row++) {
    int            k = row / s->modes, i = row % s->modes;
    double complex turn = I * (k - h->m) * h->omega;
    size_t         a = (size_t)row, b = (size_t)(half + row);
    h->A[a * n + a] = -turn;
    h->A[b * n + a] = 1;
    h->A[b * n + b] = -turn - 2 * s->zeta[i] * s->omega[i];
    for (int column = 0; column < half; column++)
      h->A[(size_t)column * n + b] = -coupling(h, k, column / s->modes, i, column % s->modes);
    h->A[a * n + b] -= s->omega[i] * s->omega[i];
  }
}

static int by_turn(const void *a, const void *b) {
  double x = fabs(cimag(*(const double complex *)a)), y = fabs(cimag(*(const double complex *)b));
  return (x > y) - (x < y);
}

static int by_growth(const void *a, const void *b) {
  double x = creal(*(const double complex *)a), y = creal(*(const double complex *)b);
  return (x < y) - (x > y);
}

/* Every exponent comes with its shifts by j omega; those that turn least are kept. Of a negative multiplier two turn by half of
 * omega, one each way: leaning to one side takes one of them. */
static int solve(hill *h, double complex *multiplier) {
  int            n = 2 * h->K * h->s->modes, kept = 2 * h->s->modes;
  double complex lean = 1e-3 * I * h->omega;
  if (LAPACKE_zgeev_work(LAPACK_COL_MAJOR, 'N', 'N', n, h->A, n, h->exponent, NULL, 1, NULL, 1,
                         h->work, 8 * n, h->rwork) != 0)
    return 0;
  for (int i = 0; i < n; i++) h->exponent[i] -= lean;
  qsort(h->exponent, (size_t)n, sizeof *h->exponent, by_turn);
  qsort(h->exponent, (size_t)kept, sizeof *h->exponent, by_growth);
  for (int i = 0; i < kept; i++)
    multiplier[i] = cexp((h->exponent[i] + lean) * SHB_TWO_PI / h->omega);
  return 1;
}

shb_status hill_multipliers(const mhb_modal_structure *s, int d, double omega, int m,
                            const double *dp, double complex *multiplier) {
  hill   h = {.s = s, .m = m, .K = mhb_real_size(m), .n3 = 3 * s->pairs, .omega = omega};
  size_t n = (size_t)(h.K * h.n3), states = 2 * (size_t)(h.K * s->modes);
  h.B               = calloc(n * (size_t)s->modes, sizeof *h.B);
  h.J               = calloc(n * n, sizeof *h.J);
  h.JR              = calloc(n * n, sizeof *h.JR);
  h.A               = calloc(states * states, sizeof *h.A);
  h.exponent        = calloc(states, sizeof *h.exponent);
  h.work            = calloc(8 * states, sizeof *h.work);
  h.rwork           = calloc(2 * states, sizeof *h.rwork);
  h.pivot           = calloc(n, sizeof *h.pivot);
  shb_status status = SHB_ERR_IO;
  if (h.B && h.J && h.JR && h.A && h.exponent && h.work && h.rwork && h.pivot) {
    set_shapes(&h, d);
    set_derivative(&h, dp);
    int ok = !s->flexibility || soften(&h, d);
    if (ok) set_matrix(&h);
    status = ok && solve(&h, multiplier) ? SHB_OK : SHB_NOT_CONVERGED;
  }
  void *arrays[] = {h.B, h.J, h.JR, h.A, h.exponent, h.work, h.rwork, h.pivot};
  for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; i++) free(arrays[i]);
  if (status == SHB_ERR_IO) SHB_FAIL(status, "out of memory for Hill's method, %zu states", states);
  if (status != SHB_OK) SHB_FAIL(status, "the eigensolver failed on Hill's matrix");
  return status;
}
