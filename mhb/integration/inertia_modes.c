#include "mhb/integration/inertia_modes.h"

#include <lapacke.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "modal/model/residual_series.h"

/* Directions softer than this share of the softest one have inertia. A mode so many times above the
 * last frequency of the model is left out. */
static const double SOFT_ENOUGH = 1e-8, FAR_ABOVE = 1e4;

typedef struct {
  int     n, p, kept;     /* contact dofs; directions; modes found */
  int     power;          /* psi = nu^power L v: 1 from R and R2, 2 from R2 and R3 */
  double *vector, *value; /* [n][n] rows L^T / sqrt(r), [n]; then the modes */
  double *A, *tau;        /* [n][n], [n] */
  double *psi, *nu;       /* [kept][n] kg^-1/2, [kept] rad/s */
} search;

static int symmetric_eigen(int n, double *a, double *value) {
  return LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'U', n, a, n, value) == 0;
}

/* A <- L^-1 R2 L^-T (or R3) in the p softest directions of L L^T = R (or R2); eigenvectors of that
 * are the columns of vector, ascending. */
static void reduce(const search *s, const double *R2, int p) {
  int n = s->n;
  for (int a = 0; a < p; a++)
    for (int b = 0; b < p; b++) {
      const double *x   = s->vector + (size_t)(n - p + a) * (size_t)n;
      const double *y   = s->vector + (size_t)(n - p + b) * (size_t)n;
      double        sum = 0;
      for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) sum += x[i] * R2[(size_t)i * (size_t)n + (size_t)j] * y[j];
      s->A[b * p + a] = sum / sqrt(s->value[n - p + a] * s->value[n - p + b]);
    }
}

/* Directions by their flexibility (with R3: inertia), and how many of them may have inertia. */
static shb_status find_directions(const modal_model *model, search *s) {
  const size_t n     = (size_t)s->n;
  const bool   three = modal_series_has_fourth(model);
  s->power           = three ? 2 : 1;
  memcpy(s->vector, three ? model->residual_inertia : model->residual_flexibility,
         sizeof(double) * n * n);
  SHB_CHECK(symmetric_eigen(s->n, s->vector, s->value), SHB_ERR_INPUT,
            "/contact/residual_%s has no eigenvalues; it must be finite",
            three ? "inertia" : "flexibility");
  while (s->p < s->n && s->p < MHB_INERTIA_MODES &&
         s->value[s->n - 1 - s->p] > SOFT_ENOUGH * s->value[s->n - 1] && s->value[s->n - 1] > 0)
    s->p++;
  return SHB_OK;
}

/* The modes in the p softest directions. */
static shb_status find_modes(const modal_model *model, search *s) {
  const int    n = s->n, p = s->p;
  const double last = SHB_TWO_PI * model->frequency[model->n_modes - 1];
  reduce(s, s->power == 2 ? model->residual_fourth : model->residual_inertia, p);
  SHB_CHECK(p == 0 || symmetric_eigen(p, s->A, s->tau), SHB_ERR_INPUT,
            "/contact/residual_%s has no eigenvalues; it must be finite",
            s->power == 2 ? "fourth" : "inertia");
  s->kept = 0;
  for (int k = 0; k < p; k++) {
    if (!(s->tau[k] > 1 / pow(FAR_ABOVE * last, 2))) continue;
    double *psi    = s->psi + (size_t)s->kept * (size_t)n;
    s->nu[s->kept] = 1 / sqrt(s->tau[k]);
    for (int i = 0; i < n; i++) {
      psi[i] = 0;
      for (int a = 0; a < p; a++)
        psi[i] += pow(s->nu[s->kept], s->power) * s->A[k * p + a] * sqrt(s->value[n - p + a]) *
                  s->vector[(size_t)(n - p + a) * (size_t)n + (size_t)i];
    }
    s->kept++;
  }
  return SHB_OK;
}

/* [rows][m] -> [rows][m + kept], zeros at the end of each row. */
static double *widen(const double *x, size_t rows, int m, int kept) {
  size_t  wide = (size_t)m + (size_t)kept;
  double *out  = shb_alloc_zeroed(rows * wide, sizeof *out);
  for (size_t r = 0; x && r < rows; r++)
    memcpy(out + r * wide, x + r * (size_t)m, sizeof *out * (size_t)m);
  return out;
}

/* Coriolis terms do not couple the new modes. */
static void widen_coriolis(const modal_model *model, int kept, modal_model *out) {
  const size_t m = (size_t)model->n_modes, wide = m + (size_t)kept;
  if (!model->coriolis) return;
  out->coriolis = shb_alloc_zeroed(wide * wide, sizeof *out->coriolis);
  for (size_t r = 0; r < m; r++)
    memcpy(out->coriolis + r * wide, model->coriolis + r * m, m * sizeof *out->coriolis);
}

static void widen_all(const modal_model *model, int kept, modal_model *out) {
  int    m    = model->n_modes;
  size_t rows = 3 * (size_t)model->n_pairs, loads = (size_t)model->n_load + 1;
  out->n_modes          = m + kept;
  out->frequency        = widen(model->frequency, 1, m, kept);
  out->damping_ratio    = widen(model->damping_ratio, 1, m, kept);
  out->right            = widen(model->right, rows, m, kept);
  out->left             = model->has_left ? widen(model->left, rows, m, kept) : NULL;
  out->probe            = widen(model->probe, 3 * (size_t)model->n_probes, m, kept);
  out->modal_force      = shb_alloc_zeroed(loads * (size_t)(m + kept), sizeof *out->modal_force);
  out->eigen_residual   = NULL;
  out->residual_inertia = NULL;
  out->residual_fourth  = NULL;
  out->coriolis         = NULL;
  out->n_residual       = 0;
  size_t square         = rows * rows * (model->has_left ? 4 : 1);
  out->residual_flexibility = shb_alloc(square, sizeof(double));
  for (size_t k = 0; k < loads; k++)
    memcpy(out->modal_force + k * (size_t)(m + kept), model->modal_force + k * (size_t)m,
           sizeof *out->modal_force * (size_t)m);
  memcpy(out->residual_flexibility, model->residual_flexibility, sizeof(double) * square);
  widen_coriolis(model, kept, out);
}

/* The new modes; their part is subtracted from the flexibility. */
static void add_modes(const search *s, int m, modal_model *out) {
  int n = s->n, n3 = 3 * out->n_pairs;
  for (int k = 0; k < s->kept; k++) {
    const double *psi         = s->psi + (size_t)k * (size_t)n;
    out->frequency[m + k]     = s->nu[k] / (SHB_TWO_PI);
    out->damping_ratio[m + k] = out->damping_ratio[m - 1];
    for (int i = 0; i < n; i++)
      (i < n3 ? out->right : out->left)[(size_t)(i % n3) * (size_t)out->n_modes + (size_t)(m + k)] =
          psi[i];
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++)
        out->residual_flexibility[(size_t)i * (size_t)n + (size_t)j] -=
            psi[i] * psi[j] / (s->nu[k] * s->nu[k]);
  }
}

/* Whether the remaining flexibility is not negative. Overwrites A and tau. */
static bool is_passive(const modal_model *model, const modal_model *out, const search *s) {
  const size_t n       = (size_t)s->n;
  double       largest = 0;
  memcpy(s->A, out->residual_flexibility, sizeof(double) * n * n);
  for (size_t i = 0; i < n; i++) largest = fmax(largest, model->residual_flexibility[i * (n + 1)]);
  return symmetric_eigen(s->n, s->A, s->tau) && s->tau[0] >= -1e-6 * largest;
}

/* The model with modes in fewer and fewer directions until what remains is passive. Directions of
 * little inertia may hold nothing but the rounding of R3. */
static shb_status add_fewest(const modal_model *model, search *s, modal_model *out) {
  for (;; s->p = 2 * s->p / 3) {
    SHB_TRY(find_modes(model, s));
    *out = *model;
    widen_all(model, s->kept, out);
    add_modes(s, model->n_modes, out);
    if (s->power == 1 || is_passive(model, out, s)) return SHB_OK;
    mhb_inertia_free(out);
    SHB_CHECK(s->p > 1, SHB_ERR_INPUT,
              "/contact/residual_fourth does not fit residual_flexibility and residual_inertia: no "
              "modes have all three; leave it out, or write sums of phi phi^T/w^2, /w^4 and /w^6 "
              "over the modes left out");
  }
}

shb_status mhb_inertia_modes(const modal_model *model, modal_model *out) {
  SHB_CHECK(
      model->residual_flexibility, SHB_ERR_INPUT,
      "the modal file has residual inertia but no residual flexibility; write both or neither");
  search  s         = {.n = 3 * model->n_pairs * (model->has_left ? 2 : 1)};
  size_t  n         = (size_t)s.n;
  double *space     = shb_alloc_zeroed(3 * n * n + 3 * n, sizeof *space);
  *out              = (modal_model){0};
  s.vector          = space;
  s.A               = space + n * n;
  s.psi             = space + 2 * n * n;
  s.value           = space + 3 * n * n;
  s.tau             = s.value + n;
  s.nu              = s.tau + n;
  shb_status status = find_directions(model, &s);
  if (status == SHB_OK) status = add_fewest(model, &s, out);
  free(space);
  return status;
}

void mhb_inertia_free(modal_model *out) {
  free(out->frequency);
  free(out->damping_ratio);
  free(out->right);
  free(out->left);
  free(out->probe);
  free(out->modal_force);
  free(out->residual_flexibility);
  free(out->coriolis);
  *out = (modal_model){0};
}
