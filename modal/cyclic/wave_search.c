#include "modal/cyclic/wave_search.h"
#include "fem/supernodal/large_pages.h"
#include "mesh/base/memory.h"
#include "modal/cyclic/small_hermitian.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_STEPS = 40 };                                 /* block solves */
static const double ACCEPTED_PROBABILITY = 1e-9;         /* probability */
static const double ROUNDING = 1e-9, COINCIDENT = 0.999; /* relative to t */

typedef struct {
  wave_basis     *b;
  double complex *residual, *current, *previous; /* R; blocks of the search [p][order] */
  double complex *F, *Y, *C;                     /* [p][p] by columns */
  double complex *D, *B;                         /* [MAX_STEPS] blocks [p][p] */
  double complex *H;                             /* [MAX_STEPS p][MAX_STEPS p] */
  double         *theta;                         /* [MAX_STEPS p] */
} search;

/* B s of the last part s of Ritz vector i. */
static void last_part(const wave_basis *b, int i, double complex *out) {
  const int             p = b->p, m = p * b->n;
  const double complex *B = b->B + (size_t)(b->n - 1) * (size_t)(p * p);
  const double complex *s = b->H + (size_t)i * (size_t)m + (m - p);
  for (int r = 0; r < p; r++) {
    out[r] = 0;
    for (int k = r; k < p; k++) out[r] += B[k * p + r] * s[k];
  }
}

/* F = sum of (B s)(B s)^H / (t - theta) over the Ritz values below t. Returns the number of Ritz
 * values above t.
 *   part  scratch  [p] */
static int couple_ritz_pairs(const wave_basis *b, double t, double complex *F,
                             double complex *part) {
  const int p = b->p, m = p * b->n;
  int       above = 0;
  memset(F, 0, (size_t)(p * p) * sizeof *F);
  for (int i = 0; i < m; i++) {
    if (b->theta[i] > t) {
      above++;
      continue;
    }
    const double gap = fmax(t - b->theta[i], 1e-14 * t);
    last_part(b, i, part);
    for (int c = 0; c < p; c++)
      for (int r = 0; r < p; r++) F[c * p + r] += part[r] * conj(part[c]) / gap;
  }
  return above;
}

/* Scale W by diag(M)^-1/2. */
static void scale_rows(const wave_basis *b) {
  const size_t rows = b->order / 3;
  double      *d    = shb_alloc(rows + 1, sizeof *d);
  fem_sector_mass_diagonal(b->op->sector, d);
  for (size_t c = 0; c < (size_t)b->p; c++)
    for (size_t i = 0; i < b->order; i++) b->W[c * b->order + i] /= sqrt(d[i / 3]);
  free(d);
}

static void apply_mass(const search *s) {
  wave_operator_mass(s->b->op, s->b->p, s->b->W, s->b->MW);
}

/* W = G times the block whose product with M is MW. */
static void apply(search *s) {
  wave_basis *b = s->b;
  const int   p = b->p;
  wave_inner(b->order, p, s->residual, p, b->MW, s->Y);
  wave_operator_solve(b->op, p, b->MW, b->W);
  wave_basis_project_out(b, NULL);
  for (int c = 0; c < p; c++)
    for (int r = 0; r < p; r++) {
      s->C[c * p + r] = 0;
      for (int k = 0; k < p; k++) s->C[c * p + r] += s->F[k * p + r] * s->Y[c * p + k];
    }
  wave_add(b->order, 1, p, s->residual, s->C, p, b->W);
}

/* W -= X X^H M W; MW is updated. */
static void orthogonalise(search *s, const double complex *X) {
  wave_basis *b = s->b;
  wave_inner(b->order, b->p, X, b->p, b->MW, s->C);
  wave_add(b->order, -1, b->p, X, s->C, b->p, b->W);
  apply_mass(s);
}

/* W = W' B. Near a converged Ritz pair B is small and rounding errors dominate W': orthogonalise
 * again. */
static void normalise(search *s, int k, double t, double complex *B, bool *good) {
  wave_basis *b = s->b;
  double      least;
  for (int i = 0; i < b->p * b->p; i++) B[i] = i % (b->p + 1) == 0;
  wave_basis_cholesky_qr(b, B, good);
  least = cabs(B[0]);
  for (int i = 1; i < b->p; i++) least = fmin(least, cabs(B[i * (b->p + 1)]));
  if (!*good || least > 1e-3 * t) return;
  wave_basis_project_out(b, NULL);
  apply_mass(s);
  orthogonalise(s, s->current);
  if (k > 0) orthogonalise(s, s->previous);
  wave_basis_cholesky_qr(b, B, good);
}

/* W -= previous B^H */
static void subtract_previous(search *s, const double complex *B) {
  const int p = s->b->p;
  for (int c = 0; c < p; c++)
    for (int r = 0; r < p; r++) s->C[c * p + r] = conj(B[r * p + c]);
  wave_add(s->b->order, -1, p, s->previous, s->C, p, s->b->W);
}

static void copy_block(const wave_basis *b, double complex *to) {
  memcpy(to, b->W, (size_t)b->p * b->order * sizeof *to);
}

/* One step of the three-term recurrence. The steps are too few for a loss of orthogonality. */
static void step(search *s, int k, double t, bool *good) {
  wave_basis  *b    = s->b;
  const size_t each = (size_t)b->p * (size_t)b->p, at = (size_t)k * each;
  apply(s);
  apply_mass(s);
  wave_inner(b->order, b->p, s->current, b->p, b->MW, s->D + at);
  wave_add(b->order, -1, b->p, s->current, s->D + at, b->p, b->W);
  if (k > 0) subtract_previous(s, s->B + at - each);
  apply_mass(s);
  normalise(s, k, t, s->B + at, good);
  double complex *oldest = s->previous;
  s->previous            = s->current;
  s->current             = oldest;
  copy_block(b, s->current);
}

/* Largest Ritz value of the first blocks. */
static shb_status largest_ritz_value(const search *s, int blocks, double *value) {
  const int m = s->b->p * blocks;
  wave_basis_projection(s->b->p, blocks, s->D, s->B, s->H);
  SHB_CHECK(small_hermitian_eigen(m, s->H, s->theta, false), SHB_ERR_IO,
            "the eigenvalues of a Lanczos projection were not found");
  *value = s->theta[m - 1];
  return SHB_OK;
}

static shb_status iterate(search *s, double t, modal_missed_modes *out) {
  wave_basis *b     = s->b;
  const int   parts = b->op->is_real ? 1 : 2;
  bool        good  = true;
  copy_block(b, s->residual);
  wave_basis_randomise(b, 1);
  scale_rows(b);
  wave_basis_orthonormalise(b, NULL, s->C, &good);
  copy_block(b, s->current);
  while (good && out->verdict == MODAL_VERDICT_UNDECIDED && out->steps < MAX_STEPS) {
    const double previous = out->ratio;
    step(s, out->steps++, t, &good);
    SHB_TRY(largest_ritz_value(s, out->steps, &out->ratio));
    out->ratio /= t;
    out->probability = modal_missed_modes_probability(out->ratio, out->steps, parts * b->p,
                                                      parts * (double)b->order);
    if (out->ratio > 1 + ROUNDING) out->verdict = MODAL_VERDICT_MISSING;
    if (out->probability <= ACCEPTED_PROBABILITY) out->verdict = MODAL_VERDICT_COMPLETE;
    if (out->ratio > COINCIDENT && out->ratio - previous < ROUNDING)
      break; /* an eigenvalue equals t */
  }
  return SHB_OK;
}

shb_status wave_search(wave_basis *b, double t, modal_missed_modes *out) {
  const size_t    size = (size_t)b->p * b->order, each = (size_t)b->p * (size_t)b->p;
  const size_t    columns = (size_t)b->p * MAX_STEPS;
  search          s       = {.b = b};
  double complex *vectors = fem_large_alloc(3 * size, sizeof *vectors);
  double complex *small =
      shb_alloc_zeroed((3 + 2 * MAX_STEPS) * each + columns * columns, sizeof *small);
  double *theta = shb_alloc(columns, sizeof *theta);
  *out          = (modal_missed_modes){.verdict = MODAL_VERDICT_UNDECIDED, .probability = 1};
  s.residual = vectors, s.current = vectors + size, s.previous = vectors + 2 * size;
  s.F = small, s.Y = s.F + each, s.C = s.Y + each, s.D = s.C + each;
  s.B = s.D + MAX_STEPS * each, s.H = s.B + MAX_STEPS * each, s.theta = theta;
  out->count              = couple_ritz_pairs(b, t, s.F, s.Y);
  const shb_status status = iterate(&s, t, out);
  free(vectors);
  free(small);
  free(theta);
  return status;
}
