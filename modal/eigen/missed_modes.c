#include "modal/eigen/missed_modes.h"

#include <math.h>
#include <string.h>

enum { MAX_STEPS = 40 };                                 /* block solves */
static const double ACCEPTED_PROBABILITY = 1e-9;         /* probability */
static const double LEAST_MASS_RATIO     = 0.05;         /* a of the header */
static const double ROUNDING = 1e-9, COINCIDENT = 0.999; /* relative to t */

static const PetscScalar one = 1, minus = -1, zero = 0;

typedef struct {
  const modal_block_basis *b;
  double                  *residual, *current, *previous; /* R; blocks of the search [p][rows] */
  double                  *F, *Y, *C;                     /* [p][p] */
  double                  *D, *B;                         /* [MAX_STEPS] blocks [p][p] */
  double                  *H, *theta; /* [MAX_STEPS p][MAX_STEPS p], [MAX_STEPS p] */
} search;

double modal_missed_modes_probability(double ratio, int steps, int columns, double order) {
  if (!(ratio < 1)) return 1;
  const double x         = fmax(ratio, 1e-6);
  const double chebyshev = log(cosh(fmin((steps - 1) * acosh(2 / x - 1), 300)));
  const double square    = log(x / (1 - x)) - 2 * chebyshev; /* log eta^2 */
  const double half      = 0.5 * columns;
  const double result    = half * (square + log(order / (2 * LEAST_MASS_RATIO))) - lgamma(half + 1);
  return fmin(exp(result), 1);
}

/* F = sum of (B s)(B s)^T / (t - theta) over the Ritz values below t, s the last part of the
 * vector. Returns the number of Ritz values above t. */
static int couple_ritz_pairs(const modal_block_basis *b, double t, double *F) {
  const int     p = b->p, m = p * b->n;
  const double *B     = b->B + (size_t)(b->n - 1) * (size_t)(p * p);
  int           above = 0;
  memset(F, 0, (size_t)(p * p) * sizeof *F);
  for (int i = 0; i < m; i++) {
    const double *s = b->H + (size_t)i * (size_t)m + (m - p);
    if (b->theta[i] > t) {
      above++;
      continue;
    }
    const double gap = fmax(t - b->theta[i], 1e-14 * t);
    for (int r = 0; r < p; r++)
      for (int c = 0; c < p; c++) {
        double left = 0, right = 0;
        for (int k = r; k < p; k++) left += B[k * p + r] * s[k];
        for (int k = c; k < p; k++) right += B[k * p + c] * s[k];
        F[c * p + r] += left * right / gap;
      }
  }
  return above;
}

/* Scale W by diag(M)^-1/2. A node has the same mass in its three directions. */
static PetscErrorCode scale_rows(const modal_block_basis *b) {
  Mat           nodes;
  Vec           diagonal;
  const double *d;
  double       *W;
  PetscBool     three;
  PetscFunctionBeginUser;
  PetscCall(
      PetscObjectTypeCompareAny((PetscObject)b->M, &three, MATMAIJ, MATSEQMAIJ, MATMPIMAIJ, ""));
  nodes = b->M;
  if (three) PetscCall(MatMAIJGetAIJ(b->M, &nodes));
  PetscCall(MatCreateVecs(nodes, NULL, &diagonal));
  PetscCall(MatGetDiagonal(nodes, diagonal));
  PetscCall(VecGetArrayRead(diagonal, &d));
  PetscCall(MatDenseGetArray(b->W, &W));
  for (size_t c = 0; c < (size_t)b->p; c++)
    for (size_t i = 0; i < (size_t)b->rows; i++)
      W[c * (size_t)b->rows + i] /= sqrt(d[three ? i / 3 : i]);
  PetscCall(MatDenseRestoreArray(b->W, &W));
  PetscCall(VecRestoreArrayRead(diagonal, &d));
  PetscCall(VecDestroy(&diagonal));
  PetscFunctionReturn(0);
}

static PetscErrorCode copy_block(const modal_block_basis *b, double *to) {
  const double *W;
  PetscFunctionBeginUser;
  PetscCall(MatDenseGetArrayRead(b->W, &W));
  PetscCall(PetscArraycpy(to, W, (size_t)b->rows * (size_t)b->p));
  PetscCall(MatDenseRestoreArrayRead(b->W, &W));
  PetscFunctionReturn(0);
}

/* W += factor X C, or factor X C^T if transposed. */
static PetscErrorCode add(const modal_block_basis *b, PetscScalar factor, const double *X,
                          const double *C, bool turned) {
  double *W;
  PetscFunctionBeginUser;
  PetscCall(MatDenseGetArray(b->W, &W));
  PetscCallBLAS("BLASgemm", BLASgemm_("N", turned ? "T" : "N", &b->rows, &b->p, &b->p, &factor, X,
                                      &b->rows, C, &b->p, &one, W, &b->rows));
  PetscCall(MatDenseRestoreArray(b->W, &W));
  PetscFunctionReturn(0);
}

/* out = X^T MW */
static PetscErrorCode project(const modal_block_basis *b, const double *X, double *out) {
  const double *MW;
  PetscFunctionBeginUser;
  PetscCall(MatDenseGetArrayRead(b->MW, &MW));
  PetscCall(modal_block_basis_inner(b, X, MW, out));
  PetscCall(MatDenseRestoreArrayRead(b->MW, &MW));
  PetscFunctionReturn(0);
}

/* W = G times the block whose product with M is MW. */
static PetscErrorCode apply(const search *s) {
  const modal_block_basis *b = s->b;
  PetscFunctionBeginUser;
  PetscCall(project(b, s->residual, s->Y));
  PetscCall(KSPMatSolve(b->ksp, b->MW, b->W));
  PetscCall(modal_block_basis_project_out(b));
  PetscCallBLAS("BLASgemm", BLASgemm_("N", "N", &b->p, &b->p, &b->p, &one, s->F, &b->p, s->Y, &b->p,
                                      &zero, s->C, &b->p));
  PetscCall(add(b, one, s->residual, s->C, false));
  PetscFunctionReturn(0);
}

/* W -= X X^T M W; MW is updated. */
static PetscErrorCode orthogonalise(const search *s, const double *X) {
  PetscFunctionBeginUser;
  PetscCall(project(s->b, X, s->C));
  PetscCall(add(s->b, minus, X, s->C, false));
  PetscCall(modal_block_basis_apply_mass(s->b));
  PetscFunctionReturn(0);
}

/* W = W' B. Near a converged Ritz pair B is small and ROUNDING errors dominate W': orthogonalise
 * again. */
static PetscErrorCode normalise(const search *s, int k, double t, double *B, bool *good) {
  const modal_block_basis *b = s->b;
  double                   least;
  PetscFunctionBeginUser;
  for (int i = 0; i < b->p * b->p; i++) B[i] = i % (b->p + 1) == 0;
  PetscCall(modal_block_basis_cholesky_qr(b, B, good));
  least = fabs(B[0]);
  for (int i = 1; i < b->p; i++) least = fmin(least, fabs(B[i * (b->p + 1)]));
  if (!*good || least > 1e-3 * t) PetscFunctionReturn(0);
  PetscCall(modal_block_basis_project_out(b));
  PetscCall(modal_block_basis_apply_mass(b));
  PetscCall(orthogonalise(s, s->current));
  if (k > 0) PetscCall(orthogonalise(s, s->previous));
  PetscCall(modal_block_basis_cholesky_qr(b, B, good));
  PetscFunctionReturn(0);
}

/* One step of the three-term recurrence. The steps are too few for a loss of orthogonality. */
static PetscErrorCode step(search *s, int k, double t, bool *good) {
  const modal_block_basis *b    = s->b;
  const size_t             each = (size_t)b->p * (size_t)b->p, at = (size_t)k * each;
  PetscFunctionBeginUser;
  PetscCall(apply(s));
  PetscCall(modal_block_basis_apply_mass(b));
  PetscCall(project(b, s->current, s->D + at));
  PetscCall(add(b, minus, s->current, s->D + at, false));
  if (k > 0) PetscCall(add(b, minus, s->previous, s->B + at - each, true));
  PetscCall(modal_block_basis_apply_mass(b));
  PetscCall(normalise(s, k, t, s->B + at, good));
  double *oldest = s->previous;
  s->previous    = s->current;
  s->current     = oldest;
  PetscCall(copy_block(b, s->current));
  PetscFunctionReturn(0);
}

/* Largest Ritz value of the first blocks. */
static PetscErrorCode largest_ritz_value(const search *s, int blocks, double *value) {
  const PetscBLASInt m    = s->b->p * blocks;
  PetscBLASInt       size = 8 * m, info;
  double            *work;
  PetscFunctionBeginUser;
  modal_block_basis_projection((int)s->b->p, blocks, s->D, s->B, s->H);
  PetscCall(PetscMalloc1((size_t)size, &work));
  PetscCallBLAS("LAPACKsyev", LAPACKsyev_("N", "L", &m, s->H, &m, s->theta, work, &size, &info));
  PetscCall(PetscFree(work));
  PetscCheck(info == 0, s->b->comm, PETSC_ERR_LIB, "syev: %d", (int)info);
  *value = s->theta[m - 1];
  PetscFunctionReturn(0);
}

static PetscErrorCode iterate(search *s, double t, modal_missed_modes *out) {
  const modal_block_basis *b    = s->b;
  bool                     good = true;
  PetscFunctionBeginUser;
  PetscCall(copy_block(b, s->residual));
  PetscCall(modal_block_basis_randomise(b, 1));
  PetscCall(scale_rows(b));
  PetscCall(modal_block_basis_orthonormalise(b, NULL, s->C, &good));
  PetscCall(copy_block(b, s->current));
  while (good && out->verdict == MODAL_VERDICT_UNDECIDED && out->steps < MAX_STEPS) {
    const double previous = out->ratio;
    PetscCall(step(s, out->steps++, t, &good));
    PetscCall(largest_ritz_value(s, out->steps, &out->ratio));
    out->ratio /= t;
    out->probability = modal_missed_modes_probability(out->ratio, out->steps, (int)b->p, b->order);
    if (out->ratio > 1 + ROUNDING) out->verdict = MODAL_VERDICT_MISSING;
    if (out->probability <= ACCEPTED_PROBABILITY) out->verdict = MODAL_VERDICT_COMPLETE;
    if (out->ratio > COINCIDENT && out->ratio - previous < ROUNDING)
      break; /* an eigenvalue equals t */
  }
  PetscFunctionReturn(0);
}

PetscErrorCode modal_missed_modes_search(const modal_block_basis *b, double t,
                                         modal_missed_modes *out) {
  const size_t size = (size_t)b->rows * (size_t)b->p, each = (size_t)b->p * (size_t)b->p;
  const size_t columns = (size_t)b->p * MAX_STEPS;
  search       s       = {.b = b};
  PetscFunctionBeginUser;
  *out = (modal_missed_modes){.verdict = MODAL_VERDICT_UNDECIDED, .probability = 1};
  PetscCall(PetscMalloc3(size, &s.residual, size, &s.current, size, &s.previous));
  PetscCall(PetscCalloc7(each, &s.F, each, &s.Y, each, &s.C, MAX_STEPS * each, &s.D,
                         MAX_STEPS * each, &s.B, columns * columns, &s.H, columns, &s.theta));
  out->count = couple_ritz_pairs(b, t, s.F);
  PetscCall(iterate(&s, t, out));
  PetscCall(PetscFree3(s.residual, s.current, s.previous));
  PetscCall(PetscFree7(s.F, s.Y, s.C, s.D, s.B, s.H, s.theta));
  PetscFunctionReturn(0);
}
