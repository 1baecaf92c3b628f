#include "modal/cyclic/wave_modes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/body/energy.h"
#include "fem/supernodal/large_pages.h"
#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mesh/base/progress.h"
#include "modal/common/random_vector.h"
#include "modal/cyclic/small_hermitian.h"
#include "modal/cyclic/wave_basis.h"
#include "modal/cyclic/wave_search.h"

enum { FIRST_SIZE = 4, MOST_SIZE = 32 }; /* columns of a block */
static const double tolerance = 1e-10;

/* ------------------------------------------------------------------ Lanczos */

/* Ritz values, and vectors in H. *converged: number of leading pairs with |T x - theta x| <=
 * tolerance theta. */
static shb_status find_pairs(wave_basis *b, int wanted, int *converged) {
  const int             m = b->p * b->n, p = b->p;
  const double complex *B = b->B + (size_t)(b->n - 1) * (size_t)(p * p);
  wave_basis_projection(p, b->n, b->D, b->B, b->H);
  SHB_CHECK(small_hermitian_eigen(m, b->H, b->theta, true), SHB_ERR_IO,
            "the eigenvalues of a Lanczos projection were not found");
  *converged = 0;
  for (int i = 0; i < wanted && i < m && *converged == i; i++) {
    const double complex *last   = b->H + (size_t)(m - 1 - i) * (size_t)m + (m - p);
    double                square = 0;
    for (int r = 0; r < p; r++) {
      double complex sum = 0;
      for (int c = r; c < p; c++) sum += B[c * p + r] * last[c];
      square += creal(sum) * creal(sum) + cimag(sum) * cimag(sum);
    }
    if (sqrt(square) <= tolerance * fabs(b->theta[m - 1 - i])) *converged = i + 1;
  }
  return SHB_OK;
}

/* Extend the basis until all wanted pairs have converged. */
static shb_status extend(wave_basis *b, int wanted) {
  int             converged = 0;
  bool            good      = true;
  double complex *unused    = b->H;
  wave_basis_randomise(b, 0);
  wave_basis_orthonormalise(b, NULL, unused, &good);
  while (good && converged < wanted && b->n < b->capacity) {
    const size_t at = (size_t)b->n * (size_t)(b->p * b->p);
    SHB_CHECK(!shb_interrupted(), SHB_INTERRUPTED, "interrupted");
    wave_basis_append(b);
    wave_operator_solve(b->op, b->p, b->MW, b->W);
    wave_basis_orthonormalise(b, b->D + at, b->B + at, &good);
    if (good && b->n * b->p >= wanted) SHB_TRY(find_pairs(b, wanted, &converged));
  }
  SHB_CHECK(converged >= wanted, SHB_NOT_CONVERGED,
            "modal: only %d of %d modes converged at a nodal diameter", converged, wanted);
  return SHB_OK;
}

/* ------------------------------------------------------------------ the check */

static shb_status check(wave_basis *b, const wave_settings *settings, modal_check *out,
                        modal_verdict *verdict) {
  const int          m      = b->p * b->n;
  const double       margin = 1e-6, last = 1 / b->theta[m - settings->modes];
  modal_missed_modes rest;
  *out     = (modal_check){.method = "no", .limit = last * (1 - margin), .probability = 1};
  *verdict = MODAL_VERDICT_COMPLETE;
  for (int i = 0; i < settings->modes; i++) out->count += 1 / b->theta[m - 1 - i] < out->limit;
  if (settings->check == MODAL_CHECK_NEVER) return SHB_OK;
  SHB_TRY(wave_search(b, 1 / out->limit, &rest));
  *verdict = rest.count == out->count ? rest.verdict : MODAL_VERDICT_UNDECIDED;
  if (*verdict != MODAL_VERDICT_COMPLETE) return SHB_OK;
  out->method      = "restart";
  out->probability = rest.probability;
  return SHB_OK;
}

/* ------------------------------------------------------------------ modes */

/* Factor that normalises a shape, and makes the sum of its dofs times random numbers positive. */
static double complex normaliser(size_t order, const double complex *x, const double complex *mx) {
  double complex sum  = 0;
  double         norm = 0;
  for (size_t i = 0; i < order; i++) {
    sum += modal_random(i) * x[i];
    norm += creal(x[i]) * creal(mx[i]) + cimag(x[i]) * cimag(mx[i]);
  }
  const double size = cabs(sum);
  return (size > 0 ? conj(sum) / size : 1) / sqrt(norm);
}

/* phi = Q times the leading eigenvectors of H, largest Ritz value first. */
static void collect(wave_basis *b, wave_modes *out) {
  const int       m     = b->p * b->n;
  const size_t    order = b->order, n = (size_t)out->n;
  double complex *S = shb_alloc((size_t)m * n, sizeof *S);
  for (int i = 0; i < out->n; i++) {
    memcpy(S + (size_t)i * (size_t)m, b->H + (size_t)(m - 1 - i) * (size_t)m,
           (size_t)m * sizeof *S);
    out->lambda[i] = 1 / b->theta[m - 1 - i];
  }
  memset(out->phi, 0, n * order * sizeof *out->phi);
  wave_add(order, 1, m, b->Q, S, out->n, out->phi);
  free(S);
  wave_operator_mass(b->op, out->n, out->phi, out->m_phi);
  for (size_t i = 0; i < n; i++) {
    const double complex by = normaliser(order, out->phi + i * order, out->m_phi + i * order);
    for (size_t k = i * order; k < (i + 1) * order; k++) {
      out->phi[k] *= by;
      out->m_phi[k] *= by;
    }
  }
}

/* |phi - lambda K^-1 M phi| in the M norm. */
static void find_residuals(wave_operator *op, wave_modes *out) {
  const size_t    size = (size_t)out->n * out->order;
  double complex *X = shb_alloc(size, sizeof *X), *MX = shb_alloc(size, sizeof *MX);
  wave_operator_solve(op, out->n, out->m_phi, X);
  for (size_t i = 0; i < size; i++) X[i] = out->phi[i] - out->lambda[i / out->order] * X[i];
  wave_operator_mass(op, out->n, X, MX);
  for (int i = 0; i < out->n; i++) {
    double complex square;
    wave_inner(out->order, 1, X + (size_t)i * out->order, 1, MX + (size_t)i * out->order, &square);
    out->eigen_residual[i] = sqrt(fmax(creal(square), 0));
  }
  free(X);
  free(MX);
}

/* The eigenvalues from the strains of the real and of the imaginary part of the sector's motion. */
static shb_status refine(const wave_operator *op, const fem_body *body, const double *state,
                         wave_modes *out) {
  const size_t    stride = 3 * (size_t)body->mesh->n_nodes;
  double complex *nodal  = shb_alloc(stride, sizeof *nodal);
  double         *u      = shb_alloc(FEM_FIELDS * stride, sizeof *u), energy[FEM_FIELDS];
  for (int first = 0; first < out->n; first += FEM_FIELDS / 2) {
    const int left = out->n - first, count = left < FEM_FIELDS / 2 ? left : FEM_FIELDS / 2;
    for (int i = 0; i < count; i++) {
      double *re = u + 2 * (size_t)i * stride, *im = re + stride;
      fem_sector_expand(op->sector, op->phase, out->phi + (size_t)(first + i) * out->order, nodal);
      for (size_t k = 0; k < stride; k++) re[k] = creal(nodal[k]), im[k] = cimag(nodal[k]);
    }
    fem_tangent_energies(body, state, 2 * count, u, energy);
    for (int i = 0; i < count; i++) out->lambda[first + i] = energy[2 * i] + energy[2 * i + 1];
  }
  for (int i = 1; i < out->n; i++) /* repeated eigenvalues stay in order */
    out->lambda[i] = fmax(out->lambda[i], out->lambda[i - 1]);
  free(nodal);
  free(u);
  SHB_CHECK(out->lambda[0] > 0, SHB_ERR_INPUT,
            "rotor.speed: the static equilibrium at %.6g rad/s is not stable (lowest eigenvalue "
            "%.3g rad2/s2); give a lower speed",
            body->rotation.speed, out->lambda[0]);
  return SHB_OK;
}

static void allocate(size_t order, int modes, wave_modes *out) {
  const size_t n      = (size_t)modes;
  out->n              = modes;
  out->order          = order;
  out->lambda         = shb_alloc(n, sizeof *out->lambda);
  out->eigen_residual = shb_alloc_zeroed(n, sizeof *out->eigen_residual);
  out->phi            = fem_large_alloc(n * order, sizeof *out->phi);
  out->m_phi          = fem_large_alloc(n * order, sizeof *out->m_phi);
}

/* One run with blocks of p columns. */
static shb_status run(wave_operator *op, const wave_settings *settings, int p, wave_modes *out,
                      modal_verdict *verdict) {
  const int  most = (int)fmin((double)op->order, 8. * settings->modes + 30. * p);
  wave_basis b;
  wave_basis_create(op, p, most / p, &b);
  shb_status status = extend(&b, settings->modes);
  if (status == SHB_OK) collect(&b, out);
  if (status == SHB_OK) status = check(&b, settings, &out->check, verdict);
  wave_basis_free(&b);
  return status;
}

shb_status wave_modes_solve(wave_operator *op, const wave_settings *settings, const fem_body *body,
                            const double *state, wave_modes *out) {
  modal_verdict verdict = MODAL_VERDICT_MISSING;
  memset(out, 0, sizeof *out);
  SHB_CHECK((size_t)settings->modes <= op->order, SHB_ERR_INPUT,
            "modal.modes: %d modes asked of a mesh with %zu free dofs", settings->modes, op->order);
  allocate(op->order, settings->modes, out);
  for (int p = FIRST_SIZE; verdict == MODAL_VERDICT_MISSING; p *= 2) {
    SHB_CHECK(
        p <= MOST_SIZE && (size_t)p <= op->order, SHB_NOT_CONVERGED,
        "modal: the eigensolver missed a mode below %.6g Hz at a nodal diameter; ask for more "
        "or fewer modes",
        modal_check_frequency(&out->check));
    SHB_TRY(run(op, settings, p, out, &verdict));
  }
  find_residuals(op, out);
  return refine(op, body, state, out);
}

void wave_modes_project_out(const wave_modes *modes, int columns, double complex *X,
                            double complex *C) {
  wave_inner(modes->order, modes->n, modes->m_phi, columns, X, C);
  wave_add(modes->order, -1, modes->n, modes->phi, C, columns, X);
}

void wave_modes_free(wave_modes *modes) {
  free(modes->lambda);
  free(modes->eigen_residual);
  free(modes->phi);
  free(modes->m_phi);
  memset(modes, 0, sizeof *modes);
}
