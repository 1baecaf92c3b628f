#include "postproc/field/whole_period.h"

#include <cblas.h>
#include <complex.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/vec3.h"
#include "mhb/problem/wave.h"
#include "postproc/field/peak_stress.h"

/* rad, phi/nu, as the balance has it. */
static void set_lag(post_period *p) {
  const mhb_driven_wave wave =
      mhb_driven_wave_of(p->engine_order, p->turns_right, p->blades, p->order);
  p->closes = p->blades > 0 && mhb_driven_wave_shift(wave) >= 0;
  if (p->closes) p->lag = mhb_driven_wave_lag(wave);
}

/* Sums of the harmonics, rows[rows][width] with `each` numbers a node, must be finite in single
 * precision, as pictures have them. Their squares then are in double precision. */
static shb_status check_rows(int n_rows, int width, int each, const double *rows,
                             const char *what) {
  for (int i = 0; i < width; i++) {
    double sum = 0;
    for (int k = 0; k < n_rows; k++) sum += fabs(rows[(size_t)k * (size_t)width + (size_t)i]);
    SHB_CHECK(sum <= FLT_MAX, SHB_ERR_INPUT,
              "the %s of node %d of the mesh is %.3g: no motion; the mode shapes of the modal file "
              "or the amplitudes of the response are too large",
              what, i / each + 1, sum);
  }
  return SHB_OK;
}

static shb_status check_finite(const post_period *p) {
  const int rows = 2 * (p->n_harmonics + 1), n = p->field->n_nodes;
  SHB_TRY(check_rows(rows, 3 * n, 3, p->displacement, "displacement, in m,"));
  return check_rows(rows, POST_STRESSES * n, POST_STRESSES, p->stress, "stress, in Pa,");
}

shb_status post_period_create(const post_blade_field *field, const mhb_response *response,
                              int branch, int kept, mesh_axis axis, post_period *p) {
  const mhb_branch *b    = &response->branch[branch];
  const size_t      rows = 2 * ((size_t)b->n_harmonics + 1), n = (size_t)field->n_nodes;
  *p = (post_period){.field        = field,
                     .branch       = branch,
                     .point        = b->modal.point[kept],
                     .n_harmonics  = post_blade_harmonics(b, field->n_modes, kept),
                     .order        = b->order,
                     .frequency    = b->frequency[b->modal.point[kept]],
                     .engine_order = response->engine_order,
                     .turns_right  = response->turns_right,
                     .blades       = response->blades,
                     .axis         = axis};
  set_lag(p);
  p->displacement = malloc(rows * 3 * n * sizeof *p->displacement + 1);
  p->stress       = malloc(rows * POST_STRESSES * n * sizeof *p->stress + 1);
  SHB_CHECK(p->displacement && p->stress, SHB_ERR_IO, "out of memory for the field of %zu nodes",
            n);
  SHB_TRY(post_blade_displacement(field, b, kept, p->displacement));
  SHB_TRY(post_blade_stress(field, b, kept, p->stress));
  return check_finite(p);
}

/* m kg^-1/2, greatest displacement of a node in a mode over the period. The node moves on an
 * ellipse whose half axis is sqrt((|u|^2 + |u.u|)/2). */
static double greatest_of_mode(int n, const double *re, const double *im) {
  double most = 0;
  for (int i = 0; i < n; i++) {
    double         length = 0;
    double complex square = 0;
    for (int d = 0; d < 3; d++) {
      const double complex u = CMPLX(re[3 * i + d], im[3 * i + d]);
      length += creal(u * conj(u));
      square += u * u;
    }
    most = fmax(most, sqrt(0.5 * (length + cabs(square))));
  }
  return most;
}

/* rows[2][n]: real and imaginary part of a mode, from shapes [modes][n]. */
static void take_mode(int mode, int n, const double *real, const double complex *wave,
                      double *rows) {
  const size_t at = (size_t)(mode - 1) * (size_t)n;
  for (int i = 0; i < n; i++) {
    rows[i]     = wave ? creal(wave[at + (size_t)i]) : real[at + (size_t)i];
    rows[n + i] = wave ? cimag(wave[at + (size_t)i]) : 0;
  }
}

shb_status post_period_of_mode(const post_blade_field *field, int mode, int diameter,
                               double frequency, double size, mesh_axis axis, post_period *p) {
  const int              n = field->n_nodes;
  const post_wave_field *w = NULL;
  for (int i = 0; i < field->n_waves; i++)
    if (field->diameter[i] == diameter) w = &field->wave[i];
  *p = (post_period){.field        = field,
                     .branch       = -1,
                     .point        = -1,
                     .mode         = mode,
                     .diameter     = diameter,
                     .n_harmonics  = 1,
                     .order        = 1,
                     .frequency    = frequency,
                     .closes       = w != NULL,
                     .engine_order = w ? diameter : 0,
                     .blades       = field->blades,
                     .axis         = axis};
  if (w) p->lag = SHB_TWO_PI * diameter / field->blades;
  p->displacement = calloc(4 * 3 * (size_t)n + 1, sizeof *p->displacement);
  p->stress       = calloc(4 * (size_t)POST_STRESSES * (size_t)n + 1, sizeof *p->stress);
  SHB_CHECK(p->displacement && p->stress, SHB_ERR_IO, "out of memory for the field of %d nodes", n);
  double *shape = p->displacement + 6 * (size_t)n;
  double *sigma = p->stress + 2 * (size_t)POST_STRESSES * (size_t)n;
  take_mode(mode, 3 * n, field->shape, w ? w->shape : NULL, shape);
  take_mode(mode, POST_STRESSES * n, field->stress, w ? w->stress : NULL, sigma);
  const double most = greatest_of_mode(n, shape, shape + 3 * (size_t)n);
  SHB_CHECK(most > 0, SHB_ERR_INPUT, "mode %d does not move", mode);
  SHB_CHECK(isfinite(most), SHB_ERR_INPUT, "the shape of mode %d is not finite", mode);
  cblas_dscal(6 * n, size / most, shape, 1);
  cblas_dscal(2 * POST_STRESSES * n, size / most, sigma, 1);
  return check_finite(p);
}

void post_period_free(post_period *p) {
  free(p->displacement);
  free(p->stress);
  memset(p, 0, sizeof *p);
}

double post_period_seconds(const post_period *p) {
  return p->order / p->frequency;
}

double post_period_lag(const post_period *p, int blade, int k) {
  return fmod(k * fmod(blade * p->lag, SHB_TWO_PI), SHB_TWO_PI);
}

/* out[width] = sum over the harmonics of rows [2 k + part][width]. */
static void sum_harmonics(const post_period *p, int blade, double instant, const double *rows,
                          int width, double *out) {
  memset(out, 0, (size_t)width * sizeof *out);
  for (int k = 0; k <= p->n_harmonics; k++) {
    const double  angle = SHB_TWO_PI * k * instant - post_period_lag(p, blade, k);
    const double *real  = rows + 2 * (size_t)k * (size_t)width;
    cblas_daxpy(width, cos(angle), real, 1, out, 1);
    cblas_daxpy(width, -sin(angle), real + width, 1, out, 1);
  }
}

/* Rows of the rotation that takes blade 0 to a blade. */
static void rotation(const post_period *p, int blade, double row[3][3]) {
  const double angle = SHB_TWO_PI * blade / p->blades;
  for (int d = 0; d < 3; d++) {
    double column[3] = {d == 0, d == 1, d == 2};
    mesh_axis_rotate(p->axis, angle, column, column);
    for (int i = 0; i < 3; i++) row[i][d] = column[i];
  }
}

void post_period_turn_vectors(const post_period *p, int blade, int n, double *vectors) {
  double row[3][3];
  if (blade == 0) return;
  rotation(p, blade, row);
  for (int i = 0; i < n; i++) {
    double *v = vectors + 3 * (size_t)i, old[3] = {v[0], v[1], v[2]};
    for (int d = 0; d < 3; d++) v[d] = vec3_dot(row[d], old);
  }
}

void post_period_turn_stresses(const post_period *p, int blade, int n, double *stresses) {
  double row[3][3];
  if (blade == 0) return;
  rotation(p, blade, row);
  for (int i = 0; i < n; i++) vec3_turn_tensor(row, stresses + POST_STRESSES * (size_t)i);
}

void post_period_at(const post_period *p, int blade, double instant, double *displacement,
                    double *stress) {
  const int n = p->field->n_nodes;
  sum_harmonics(p, blade, instant, p->displacement, 3 * n, displacement);
  post_period_turn_vectors(p, blade, n, displacement);
  if (!stress) return;
  sum_harmonics(p, blade, instant, p->stress, POST_STRESSES * n, stress);
  post_period_turn_stresses(p, blade, n, stress);
}

shb_status post_period_extremes(const post_period *p, int instants, double *largest,
                                double *greatest) {
  const int n            = p->field->n_nodes;
  double   *displacement = malloc(3 * (size_t)n * sizeof *displacement + 1);
  double   *stress       = malloc(POST_STRESSES * (size_t)n * sizeof *stress + 1);
  *greatest              = 0;
  for (int i = 0; i < n; i++) largest[i] = 0;
  for (int t = 0; displacement && stress && t < instants; t++) {
    post_period_at(p, 0, (double)t / instants, displacement, stress);
    cblas_daxpy(3 * n, -1, p->displacement, 1, displacement, 1);
    for (int i = 0; i < n; i++) {
      *greatest  = fmax(*greatest, vec3_norm(displacement + 3 * (size_t)i));
      largest[i] = fmax(largest[i], fabs(post_signed_mises(stress + POST_STRESSES * (size_t)i)));
    }
  }
  const bool whole = displacement && stress;
  free(displacement);
  free(stress);
  SHB_CHECK(whole, SHB_ERR_IO, "out of memory for the field of %d nodes", n);
  return SHB_OK;
}
