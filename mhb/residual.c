#include "mhb/residual.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/fourier.h"

shb_status mhb_residual_create(const modal_model *model, const mhb_settings *settings,
                               mhb_residual **out) {
  mhb_residual *b = calloc(1, sizeof *b);
  SHB_CHECK(b, SHB_ERR_IO, "out of memory");
  int m        = settings->harmonics;
  b->settings  = settings;
  b->m         = m;
  b->n_pairs   = model->n_pairs;
  b->nb        = mhb_real_size(m);
  b->n         = 3 * b->n_pairs * b->nb;
  size_t pairs = (size_t)b->n_pairs, block = 3 * (size_t)b->nb;
  b->law            = calloc(pairs, sizeof *b->law);
  b->info           = calloc(pairs, sizeof *b->info);
  b->p              = calloc((size_t)b->n, sizeof(double));
  b->dp             = calloc(pairs * block * block, sizeof(double));
  b->pk             = calloc(3 * pairs, sizeof(double complex));
  b->uk             = calloc(3 * pairs, sizeof(double complex));
  shb_status status = SHB_OK;
  if (!(b->law && b->info && b->p && b->dp && b->pk && b->uk))
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory for %d unknowns", b->n);
  if (status == SHB_OK) status = mhb_receptance_create(model, settings, m, &b->receptance);
  if (status == SHB_OK) status = mhb_contact_create(m, m, settings->tolerance, &b->contact);
  if (status != SHB_OK) {
    mhb_residual_destroy(b);
    return status;
  }
  *out = b;
  return SHB_OK;
}

void mhb_residual_destroy(mhb_residual *b) {
  if (!b) return;
  mhb_receptance_destroy(b->receptance);
  mhb_contact_destroy(b->contact);
  free(b->law);
  free(b->info);
  free(b->p);
  free(b->dp);
  free(b->pk);
  free(b->uk);
  free(b);
}

void mhb_residual_preload(mhb_residual *b, double n0) {
  const mhb_settings *s = b->settings;
  b->n0                 = n0;
  for (int a = 0; a < b->n_pairs; a++) {
    double share = b->receptance->share[a];
    b->law[a]    = (mhb_law){.mu = s->mu, .kv = share * s->kv, .n0 = share * n0};
    for (int i = 0; i < 3; i++) b->law[a].ku[i] = share * s->ku[i];
    if (s->preload == MHB_EQUILIBRIUM) b->law[a].balance = fmax(b->law[a].n0, 0);
  }
}

/* Complex harmonic k of a vector in real form. */
static void harmonic(const mhb_residual *b, const double *x, int k, double complex *out) {
  for (int row = 0; row < 3 * b->n_pairs; row++) {
    const double *a = x + (size_t)row * (size_t)b->nb;
    out[row]        = k == 0 ? a[0] : CMPLX(a[2 * k - 1], a[2 * k]);
  }
}

static void store(const mhb_residual *b, double *x, int k, const double complex *in) {
  for (int row = 0; row < 3 * b->n_pairs; row++) {
    double *a = x + (size_t)row * (size_t)b->nb;
    if (k == 0) {
      a[0] = creal(in[row]);
    } else {
      a[2 * k - 1] = creal(in[row]);
      a[2 * k]     = cimag(in[row]);
    }
  }
}

/* J += R_k dp_k for row (harmonic k, dof row) and the columns of pair b: two real rows at once. */
static void jacobian_rows(const mhb_residual *b, int k, int row, int pair, double *jacobian) {
  int                   block = 3 * b->nb, n3 = 3 * b->n_pairs;
  const double complex *R  = b->receptance->R + ((size_t)k * (size_t)n3 + (size_t)row) * (size_t)n3;
  const double         *dp = b->dp + (size_t)pair * (size_t)block * (size_t)block;
  int                   re = row * b->nb + (k ? 2 * k - 1 : 0);
  for (int c = 0; c < 3; c++) {
    double        x = creal(R[3 * pair + c]), y = cimag(R[3 * pair + c]);
    const double *dre = dp + (size_t)(c * b->nb + (k ? 2 * k - 1 : 0)) * (size_t)block;
    const double *dim = dre + block;
    double       *J   = jacobian + (size_t)pair * (size_t)block * (size_t)b->n + re;
    for (int j = 0; j < block; j++, J += b->n) {
      if (k == 0) {
        J[0] += x * dre[j];
      } else {
        J[0] += x * dre[j] - y * dim[j];
        J[1] += y * dre[j] + x * dim[j];
      }
    }
  }
}

static void assemble_jacobian(const mhb_residual *b, double *jacobian) {
  memset(jacobian, 0, sizeof(double) * (size_t)b->n * (size_t)b->n);
  for (int i = 0; i < b->n; i++) jacobian[(size_t)i * (size_t)b->n + (size_t)i] = 1;
  for (int pair = 0; pair < b->n_pairs; pair++)
    for (int row = 0; row < 3 * b->n_pairs; row++)
      for (int k = 0; k <= b->m; k++) jacobian_rows(b, k, row, pair, jacobian);
}

void mhb_residual_evaluate(mhb_residual *b, const double *x, double omega, double *r,
                           double *jacobian, double *slope) {
  int    n3    = 3 * b->n_pairs;
  size_t block = 3 * (size_t)b->nb;
  mhb_receptance_at(b->receptance, omega, b->m);
  for (int a = 0; a < b->n_pairs; a++) {
    mhb_contact_force(b->contact, &b->law[a], x + (size_t)a * block, b->p + (size_t)a * block,
                      jacobian ? b->dp + (size_t)a * block * block : NULL, &b->info[a]);
  }
  for (int k = 0; k <= b->m; k++) {
    const double complex *R = b->receptance->R + (size_t)k * (size_t)n3 * (size_t)n3;
    harmonic(b, b->p, k, b->pk);
    harmonic(b, x, k, b->uk);
    for (int i = 0; i < n3; i++) {
      b->uk[i] -= b->receptance->free[k * n3 + i];
      for (int j = 0; j < n3; j++) b->uk[i] += R[(size_t)i * (size_t)n3 + (size_t)j] * b->pk[j];
    }
    store(b, r, k, b->uk);
    if (!slope) continue;
    mhb_receptance_slope(b->receptance, k, b->pk, b->uk);
    for (int i = 0; i < n3; i++) b->uk[i] = -b->uk[i];
    store(b, slope, k, b->uk);
  }
  if (jacobian) assemble_jacobian(b, jacobian);
}

/* Stuck: (I + R_k S) u_k = free_k - R_k s0, S = diag(kv, Ku), s0 the unbalanced preload at k = 0. The mean friction is
 * zero there (stuck.h: the smallest admissible one), so that S_0 = diag(kv, 0). */
static shb_status linear_harmonic(const mhb_residual *b, int k, int stuck, double complex *u) {
  int                   n = 3 * b->n_pairs;
  const double complex *R = b->receptance->R + (size_t)k * (size_t)n * (size_t)n;
  memcpy(u, b->receptance->free + k * n, sizeof(double complex) * (size_t)n);
  if (!stuck) return SHB_OK;
  lapack_complex_double *A    = calloc((size_t)n * (size_t)n, sizeof *A);
  lapack_int            *ipiv = calloc((size_t)n, sizeof *ipiv);
  for (int i = 0; A && ipiv && i < n; i++) {
    for (int pair = 0; pair < b->n_pairs; pair++) {
      const mhb_law        *law  = &b->law[pair];
      const double complex *r    = R + (size_t)i * (size_t)n + 3 * pair;
      double complex        s[3] = {r[0] * law->kv, k ? r[1] * law->ku[0] + r[2] * law->ku[1] : 0,
                             k ? r[1] * law->ku[1] + r[2] * law->ku[2] : 0};
      for (int c = 0; c < 3; c++)
        A[(size_t)(3 * pair + c) * (size_t)n + (size_t)i] = s[c] + (i == 3 * pair + c);
      if (k == 0) u[i] -= r[0] * (fmax(law->n0, 0) - law->balance);
    }
  }
  lapack_int bad = 1;
  if (A && ipiv) bad = LAPACKE_zgesv(LAPACK_COL_MAJOR, n, 1, A, n, ipiv, u, n);
  free(A);
  free(ipiv);
  SHB_CHECK(bad == 0, SHB_ERR_INPUT, "the stuck system is singular at harmonic %d", k);
  return SHB_OK;
}

shb_status mhb_residual_linear(mhb_residual *b, double omega, int stuck, double *x) {
  mhb_receptance_at(b->receptance, omega, b->m);
  for (int k = 0; k <= b->m; k++) {
    SHB_TRY(linear_harmonic(b, k, stuck, b->uk));
    store(b, x, k, b->uk);
    for (int i = 0; i < 3 * b->n_pairs; i++) b->pk[i] = 0;
    for (int a = 0; stuck && a < b->n_pairs; a++) {
      const mhb_law        *law = &b->law[a];
      const double complex *u   = b->uk + 3 * a;
      b->pk[3 * a]              = law->kv * u[0] + (k == 0 ? fmax(law->n0, 0) - law->balance : 0);
      if (k == 0) continue;
      b->pk[3 * a + 1] = law->ku[0] * u[1] + law->ku[1] * u[2];
      b->pk[3 * a + 2] = law->ku[1] * u[1] + law->ku[2] * u[2];
    }
    store(b, b->p, k, b->pk);
  }
  return SHB_OK;
}

void mhb_residual_force(const mhb_residual *b, int k, double complex *p) {
  harmonic(b, b->p, k, p);
}
