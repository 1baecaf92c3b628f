#include "mhb/truncation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/elimination.h"
#include "mhb/fourier.h"
#include "mhb/newton.h"

static const double PI = 3.14159265358979323846, NEGLIGIBLE = .1;

static int least(int a, int b) {
  return a < b ? a : b;
}

static int most(int a, int b) {
  return a > b ? a : b;
}

/* What the Newton step and the harmonics beyond 2m need. */
static shb_status create_newton(mhb_truncation *t) {
  const modal_model *model = t->narrow->receptance->model;
  size_t             n3    = 3 * (size_t)t->narrow->n_pairs;
  int                m     = t->narrow->m;
  t->beyond_settings       = t->settings;
  t->beyond_settings.harmonics =
      most(2 * m, least(most(4 * m, MHB_LEAST_LOOKED_AT), MHB_MOST_LOOKED_AT));
  SHB_TRY(mhb_residual_create(model, &t->beyond_settings, &t->beyond));
  size_t far = (size_t)t->beyond->n;
  t->far_x   = calloc(far, sizeof(double));
  t->far_r   = calloc(far, sizeof(double));
  t->A       = calloc(n3 * n3, sizeof(double complex));
  t->u       = calloc(n3, sizeof(double complex));
  SHB_CHECK(t->far_x && t->far_r && t->A && t->u, SHB_ERR_IO, "out of memory for %zu unknowns",
            far);
  return mhb_condensed_create(t->doubled, &t->system);
}

shb_status mhb_truncation_create(const mhb_residual *residual, mhb_truncation **out) {
  mhb_truncation *t = calloc(1, sizeof *t);
  SHB_CHECK(t, SHB_ERR_IO, "out of memory");
  t->narrow             = residual;
  t->settings           = *residual->settings;
  t->settings.harmonics = 2 * residual->m;
  shb_status status = mhb_residual_create(residual->receptance->model, &t->settings, &t->doubled);
  if (status == SHB_OK) {
    t->x    = calloc((size_t)t->doubled->n, sizeof(double));
    t->step = calloc((size_t)t->doubled->n, sizeof(double));
    if (!(t->x && t->step)) status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  }
  if (status == SHB_OK && t->doubled->n <= MHB_MAX_DOUBLED) status = create_newton(t);
  if (status != SHB_OK) {
    mhb_truncation_destroy(t);
    return status;
  }
  *out = t;
  return SHB_OK;
}

void mhb_truncation_destroy(mhb_truncation *t) {
  if (!t) return;
  mhb_residual_destroy(t->doubled);
  mhb_residual_destroy(t->beyond);
  free(t->x);
  free(t->step);
  mhb_condensed_destroy(t->system);
  free(t->far_x);
  free(t->far_r);
  free(t->A);
  free(t->u);
  free(t);
}

/* Open or stuck throughout at all pairs: the force has the harmonics of the motion and no others. */
static int is_linear(const mhb_residual *b) {
  for (int a = 0; a < b->n_pairs; a++)
    if (b->info[a].share[MHB_STICK] < 1 && b->info[a].share[MHB_SEPARATE] < 1) return 0;
  return 1;
}

/* Rows of nb coefficients into rows of wide ones, or back; the rest is left as it is. */
static void copy_rows(int rows, const double *from, int nb, double *to, int wide) {
  size_t length = sizeof(double) * (size_t)(nb < wide ? nb : wide);
  for (int i = 0; i < rows; i++)
    memcpy(to + (size_t)i * (size_t)wide, from + (size_t)i * (size_t)nb, length);
}

/* Stiffness of a pair at harmonic 2m that turns with the motion: what couples k with -k is left out. */
static void stiffness(const mhb_residual *b, int pair, double complex D[3][3]) {
  size_t        block = 3 * (size_t)b->nb;
  const double *dp    = b->dp + (size_t)pair * block * block;
  for (int c = 0; c < 3; c++) {
    const double *re = dp + ((size_t)((c + 1) * b->nb) - 2) * block, *im = re + block;
    for (int d = 0; d < 3; d++) {
      int j   = (d + 1) * b->nb - 2;
      D[c][d] = .5 * CMPLX(re[j] + im[j + 1], im[j] - re[j + 1]);
    }
  }
}

/* A <- I + R_k D, column-major. */
static void fill(mhb_truncation *t, int k) {
  int n = 3 * t->narrow->n_pairs;
  mhb_receptance_need(t->beyond->receptance, k);
  const double complex *R = t->beyond->receptance->R + (size_t)k * (size_t)n * (size_t)n;
  for (int pair = 0; pair < t->narrow->n_pairs; pair++) {
    double complex D[3][3];
    stiffness(t->doubled, pair, D);
    for (int i = 0; i < n; i++) {
      const double complex *r = R + (size_t)i * (size_t)n + 3 * pair;
      for (int d = 0; d < 3; d++)
        t->A[(3 * pair + d) * n + i] =
            r[0] * D[0][d] + r[1] * D[1][d] + r[2] * D[2][d] + (i == 3 * pair + d);
    }
  }
}

/* far_x <- the solution with the motion at the harmonics beyond 2m; their size. */
static double look_beyond(mhb_truncation *t) {
  mhb_residual *b   = t->beyond;
  int           n   = 3 * b->n_pairs, pivot[n];
  double        sum = 0;
  memset(t->far_x, 0, sizeof(double) * (size_t)b->n);
  copy_rows(n, t->x, t->doubled->nb, t->far_x, b->nb);
  mhb_residual_evaluate(b, t->far_x, t->narrow->at.omega, t->far_r, NULL, NULL);
  for (int k = 2 * t->narrow->m + 1; k <= b->m; k++) {
    for (int i = 0; i < n; i++)
      t->u[i] = -CMPLX(t->far_r[i * b->nb + 2 * k - 1], t->far_r[i * b->nb + 2 * k]);
    fill(t, k);
    if (!mhb_factor_complex(n, t->A, pivot) || !mhb_solve_complex(n, t->A, pivot, 1, t->u))
      continue;
    for (int i = 0; i < n; i++) {
      t->far_x[i * b->nb + 2 * k - 1] = creal(t->u[i]);
      t->far_x[i * b->nb + 2 * k]     = cimag(t->u[i]);
      sum += creal(t->u[i]) * creal(t->u[i]) + cimag(t->u[i]) * cimag(t->u[i]);
    }
  }
  return sqrt(sum);
}

/* step <- -r, then the Newton step where there is room for it and it exists. */
static mhb_truncation_kind set_step(mhb_truncation *t) {
  mhb_residual *b     = t->doubled;
  double        omega = t->narrow->at.omega;
  int           n     = b->n;
  if (t->system) {
    mhb_residual_derive(b, t->x, omega, t->step, NULL);
  } else {
    mhb_residual_evaluate(b, t->x, omega, t->step, NULL, NULL);
  }
  for (int i = 0; i < n; i++) t->step[i] = -t->step[i];
  if (!t->system || !mhb_condensed_factor(t->system, NULL, NULL)) return MHB_TRUNCATION_FIRST_ORDER;
  mhb_condensed_solve(t->system, t->step);
  t->far = look_beyond(t);
  if (t->far <= NEGLIGIBLE * mhb_norm(t->step, n)) return MHB_TRUNCATION_NEWTON;
  mhb_residual_evaluate(t->beyond, t->far_x, omega, t->far_r, NULL, NULL);
  copy_rows(3 * b->n_pairs, t->far_r, t->beyond->nb, t->step, b->nb);
  for (int i = 0; i < n; i++) t->step[i] = -t->step[i];
  mhb_condensed_solve(t->system, t->step);
  return MHB_TRUNCATION_NEWTON;
}

double mhb_truncation_error(mhb_truncation *t, const double *x) {
  mhb_residual *b    = t->doubled;
  double        size = mhb_norm(x, t->narrow->n);
  copy_rows(3 * b->n_pairs, x, t->narrow->nb, t->x, b->nb);
  memset(t->step, 0, sizeof(double) * (size_t)b->n);
  t->far  = 0;
  t->kind = MHB_TRUNCATION_NONE;
  if (is_linear(t->narrow)) return 0;
  mhb_residual_condition(b, &t->narrow->at);
  if (t->beyond) mhb_residual_condition(t->beyond, &t->narrow->at);
  t->kind = set_step(t);
  return size > 0 ? hypot(mhb_norm(t->step, b->n), t->far) / size : 0;
}

/* Motion, squared, by the terms of the residual series that the model does not hold: the last one held times
 * (k w/w_m)^2. */
static double modal_term(const mhb_residual *b, int k, const double complex *p) {
  const mhb_receptance *r    = b->receptance;
  int                   n    = r->n;
  double                w    = k * r->omega / r->nu;
  double                top  = 2 * PI * r->model->frequency[r->n_modes - 1];
  double                held = r->inertia ? w * w : 1, ratio = w * w / (top * top), sum = 0;
  const mhb_flexibility *last = r->inertia ? r->inertia : r->flexibility;
  for (int i = 0; i < n; i++) {
    double complex u = held * mhb_flexibility_row(last, r->phase[k], i, p);
    sum += creal(u) * creal(u) + cimag(u) * cimag(u);
  }
  return sum * ratio * ratio;
}

double mhb_modal_error(const mhb_residual *b, const double *x) {
  double complex p[3 * b->n_pairs];
  double         unheld = 0, size = mhb_norm(x, b->n);
  if (!b->receptance->flexibility) return -1;
  for (int k = 0; k <= b->m; k++) {
    mhb_residual_force(b, k, p);
    unheld += modal_term(b, k, p);
  }
  return size > 0 ? sqrt(unheld) / size : 0;
}
