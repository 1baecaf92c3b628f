#include "mhb/structure/receptance.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/numerics/simd.h"
#include "mhb/problem/interfaces.h"
#include "mhb/structure/speed_derivative.h"

static const double NUDGE = 1e-8;

/* From this many relative motions on, products of matrices are left to BLAS. */
enum { WORTH_BLAS = 12 };

/* Columns v, u, w of eq. 2. */
static void shroud_axes(double psi, double phi, double T0[3][3]) {
  double cs = cos(psi), ss = sin(psi), cf = cos(phi), sf = sin(phi);
  double T[3][3] = {{cs * cf, -ss, cs * sf}, {ss * cf, cs, ss * sf}, {-sf, 0, cf}};
  memcpy(T0, T, sizeof T);
}

/* Angles of an interface as the case has them; 0 if not given. */
typedef struct {
  bool        has_psi, has_phi;
  double      psi, phi;
  const char *name; /* NULL: the only one */
} angles;

static angles angles_of(const mhb_settings *s, int interface) {
  const mhb_interface *own = &s->interface[interface];
  angles               a   = {s->has_psi, s->has_phi, s->psi, s->phi, NULL};
  if (s->n_interfaces > 1) a = (angles){own->has_psi, own->has_phi, own->psi, own->phi, own->name};
  if (!a.has_psi) a.psi = 0;
  if (!a.has_phi) a.phi = 0;
  return a;
}

static shb_status check_angle(const char *name, const char *interface, bool given, double wanted,
                              double found, double degree) {
  SHB_CHECK(!given || fabs(remainder(found - wanted, SHB_TWO_PI)) * degree <= 1, SHB_ERR_INPUT,
            "contact.%s is %.2f deg, but the contact faces of the modal file stand at %.2f deg%s%s",
            name, wanted * degree, found * degree, interface ? ", interface " : "",
            interface ? interface : "");
  return SHB_OK;
}

/* Axes of each pair: from its own normal where the file has one, else psi and phi of the case. */
static shb_status set_axes(mhb_receptance *r, const mhb_settings *s, int interface) {
  const modal_model *model = r->model;
  const angles       given = angles_of(s, interface);
  double(*T0)[3][3]        = (double(*)[3][3])r->T0;
  double mean[3]           = {0, 0, 0};
  for (int a = 0; a < model->n_pairs; a++) {
    if (r->interface[a] != interface) continue;
    double psi = given.psi, phi = given.phi;
    if (model->normal) {
      const double *v = model->normal + 3 * a;
      psi             = atan2(v[1], v[0]);
      phi             = -atan2(v[2], hypot(v[0], v[1]));
    }
    shroud_axes(psi, phi, T0[a]);
    for (int i = 0; i < 3; i++) mean[i] += r->share[a] * T0[a][i][0];
  }
  double psi = atan2(mean[1], mean[0]), phi = -atan2(mean[2], hypot(mean[0], mean[1]));
  double degree = 180 / SHB_PI;
  if (s->n_interfaces < 2 || interface == s->lead) {
    r->psi = psi;
    r->phi = phi;
  }
  SHB_TRY(check_angle("psi", given.name, given.has_psi, given.psi, psi, degree));
  return check_angle("phi", given.name, given.has_phi, given.phi, phi, degree);
}

static void set_shares(mhb_receptance *r, int interface) {
  const modal_model *model = r->model;
  double             total = 0;
  for (int a = 0; a < model->n_pairs; a++)
    if (r->interface[a] == interface) total += model->area ? model->area[a] : 1;
  for (int a = 0; a < model->n_pairs; a++)
    if (r->interface[a] == interface) r->share[a] = (model->area ? model->area[a] : 1) / total;
}

static void set_modes(mhb_receptance *r, int k) {
  const modal_model  *model    = r->model;
  const mhb_relative *relative = &r->left_out->relative;
  int                 m        = r->n_modes;
  double complex     *B        = r->B + (size_t)k * (size_t)r->n * (size_t)m;
  for (int row = 0; row < r->n; row++) {
    for (int i = 0; i < m; i++) {
      double complex sum = 0;
      for (int axis = 0; axis < 3; axis++) {
        size_t at = ((size_t)(row / 3) * 3 + (size_t)axis) * (size_t)m + (size_t)i;
        sum += mhb_relative_weight(relative, row, 0, axis, r->phase[k]) * model->right[at];
        if (relative->sides == 2)
          sum += mhb_relative_weight(relative, row, 1, axis, r->phase[k]) * model->left[at];
      }
      B[(size_t)row * (size_t)m + (size_t)i] = sum;
    }
  }
}

/* Load harmonic h drives harmonic nu h. */
static void set_load(mhb_receptance *r, int k) {
  const modal_model *model = r->model;
  const int          h = k / r->nu, m = r->n_modes;
  r->driven[k] = mhb_residual_terms_driven(r->left_out, k);
  if (k % r->nu || h > model->n_load) return;
  for (int i = 0; i < m; i++) {
    r->F[k * m + i] = model->modal_force[h * m + i];
    r->driven[k] |= r->F[k * m + i] != 0;
  }
}

static double *part(const mhb_receptance *r, int k, int imaginary) {
  return r->parts + (size_t)(2 * k + imaginary) * ((size_t)r->n + 1) * (size_t)r->n_modes;
}

/* B and F by real and imaginary parts. */
static void set_parts(mhb_receptance *r, int k) {
  size_t                m = (size_t)r->n_modes, nm = (size_t)r->n * m;
  double               *re = part(r, k, 0), *im = part(r, k, 1);
  const double complex *B = r->B + (size_t)k * nm, *F = r->F + (size_t)k * m;
  for (size_t i = 0; i < nm + m; i++) {
    double complex z = i < nm ? B[i] : F[i - nm];
    re[i]            = creal(z);
    im[i]            = cimag(z);
  }
}

static int allocate(mhb_receptance *r) {
  size_t n = (size_t)r->n, m = (size_t)r->n_modes, K = (size_t)r->n_harmonics + 1, pairs = n / 3;
  r->T0        = calloc(9 * pairs, sizeof(double));
  r->share     = calloc(pairs, sizeof(double));
  r->interface = calloc(pairs, sizeof(int));
  r->B         = calloc(K * n * m, sizeof(double complex));
  r->F         = calloc(K * m, sizeof(double complex));
  r->parts     = calloc(K * 2 * (n + 1) * m, sizeof(double));
  r->scratch   = calloc(4 * m, sizeof(double));
  r->BL        = calloc(n * m, sizeof(double complex));
  r->lambda    = calloc(K * m, sizeof(double complex));
  r->driven    = calloc(K, sizeof(int));
  r->made_at   = calloc(K, sizeof(double));
  r->phase     = calloc(K, sizeof(double complex));
  r->R         = calloc(K * n * n, sizeof(double complex));
  r->free      = calloc(K * n, sizeof(double complex));
  r->unit      = calloc(K * n, sizeof(double complex));
  return r->T0 && r->share && r->interface && r->B && r->F && r->parts && r->scratch && r->BL &&
         r->lambda && r->driven && r->made_at && r->phase && r->R && r->free && r->unit;
}

/* Inter-blade phase of the fundamental omega/nu. A neighbour lags by phi and any whole number l of periods,
 * (2 pi/nu)(E/N + l); around the ring that closes if nu divides E + N l. NAN: for no l. */
static double wave_step(const mhb_settings *s) {
  for (int l = 0; l < s->subharmonics; l++)
    if ((s->engine_order + (long)s->blades * l) % s->subharmonics == 0)
      return SHB_TWO_PI / s->subharmonics * ((double)s->engine_order / s->blades + l);
  return NAN;
}

/* Modes and loads of every harmonic. */
static void set_harmonics(mhb_receptance *r) {
  for (int k = 0; k <= r->n_harmonics; k++) {
    set_modes(r, k);
    set_load(r, k);
    set_parts(r, k);
  }
}

void mhb_receptance_set(mhb_receptance *r) {
  mhb_residual_terms_set(r->left_out);
  set_harmonics(r);
}

/* Everything that does not depend on omega. */
static shb_status set_blade(mhb_receptance *r, const mhb_settings *settings) {
  const mhb_relative relative = {r->n, settings->to_ground ? 1 : 2, r->T0};
  const double       step     = settings->to_ground ? 0 : wave_step(settings);
  SHB_TRY(mhb_interfaces_match(r->model, settings, r->interface));
  for (int i = 0; i < mhb_interfaces(settings); i++) {
    set_shares(r, i);
    SHB_TRY(set_axes(r, settings, i));
  }
  for (int k = 0; k <= r->n_harmonics; k++) {
    r->made_at[k] = NAN;
    r->phase[k]   = cexp(-I * fmod(k * step, SHB_TWO_PI));
  }
  SHB_TRY(
      mhb_residual_terms_create(r->model, relative, r->nu, r->n_harmonics, r->phase, &r->left_out));
  set_harmonics(r);
  return SHB_OK;
}

static shb_status create(const modal_model *model, const mhb_settings *settings, int n_harmonics,
                         mhb_receptance **out) {
  mhb_receptance *r = calloc(1, sizeof *r);
  SHB_CHECK(r, SHB_ERR_IO, "out of memory");
  r->model          = model;
  r->n              = 3 * model->n_pairs;
  r->n_modes        = model->n_modes;
  r->n_harmonics    = n_harmonics;
  r->nu             = settings->subharmonics;
  r->scale          = settings->scale;
  shb_status status = SHB_OK;
  if (!allocate(r))
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory for the receptance");
  if (status == SHB_OK) status = set_blade(r, settings);
  if (status != SHB_OK) {
    mhb_receptance_destroy(r);
    return status;
  }
  *out = r;
  return SHB_OK;
}

shb_status mhb_receptance_create(const modal_model *model, const mhb_settings *settings,
                                 int n_harmonics, mhb_receptance **out) {
  SHB_CHECK(settings->to_ground || model->has_left, SHB_ERR_INPUT,
            "contact.to is neighbour, but the modal file has no /contact/left; set it to ground");
  SHB_CHECK(settings->to_ground || isfinite(wave_step(settings)), SHB_ERR_INPUT,
            "mhb.subharmonics is %d, but a wave of that many periods does not close around %d "
            "blades at engine order %d; set it to 1",
            settings->subharmonics, settings->blades, settings->engine_order);
  mhb_receptance *r = NULL;
  if (!settings->run_up) return create(model, settings, n_harmonics, out);
  mhb_speed_model *at = NULL;
  SHB_TRY(mhb_speed_model_create(settings->run_up, &at));
  mhb_speed_model_set(at, 0);
  mhb_speed_model_differentiate(at);
  shb_status status = create(&at->model, settings, n_harmonics, &r);
  if (status == SHB_OK) status = create(&at->slope, settings, n_harmonics, &r->rate);
  if (status != SHB_OK) {
    mhb_receptance_destroy(r);
    mhb_speed_model_destroy(at);
    return status;
  }
  r->at          = at;
  r->rate->omega = NAN;
  *out           = r;
  return SHB_OK;
}

void mhb_receptance_destroy(mhb_receptance *r) {
  if (!r) return;
  mhb_receptance_destroy(r->rate);
  mhb_speed_model_destroy(r->at);
  free(r->T0);
  free(r->share);
  free(r->interface);
  free(r->B);
  free(r->F);
  mhb_residual_terms_destroy(r->left_out);
  free(r->phase);
  free(r->parts);
  free(r->scratch);
  free(r->BL);
  free(r->lambda);
  free(r->driven);
  free(r->made_at);
  free(r->R);
  free(r->free);
  free(r->unit);
  free(r);
}

/* 1/(w_i^2 - w^2 + 2 j zeta_i w_i w), w half of NUDGE off a resonance that nothing damps: so far that the other modes keep
 * half of their digits in the sums. */
MHB_HOT static void set_lambda(const mhb_receptance *r, double w, double *restrict re,
                               double *restrict im) {
  const double *restrict hz = r->model->frequency, *restrict zeta = r->model->damping_ratio;
  for (int i = 0; i < r->n_modes; i++) {
    double wi = SHB_TWO_PI * hz[i], a = wi * wi - w * w, b = 2 * zeta[i] * wi * w,
           size  = a * a + b * b;
    double least = NUDGE * wi * wi, at = size < least * least ? copysign(least, a) : a;
    size  = at * at + b * b;
    re[i] = at / size;
    im[i] = -b / size;
  }
}

/* sum_i (xr + j xi) (yr +- j yi), + or - as sign says */
MHB_INLINE double complex product(int m, const double *xr, const double *xi, const double *yr,
                                  const double *yi, double sign) {
  double re = 0, im = 0;
#pragma omp simd reduction(+ : re, im)
  for (int i = 0; i < m; i++) {
    re += xr[i] * yr[i] - sign * xi[i] * yi[i];
    im += xi[i] * yr[i] + sign * xr[i] * yi[i];
  }
  return CMPLX(re, im);
}

/* One row of R += B L B^H, and of the free motion: y = row of B L. */
MHB_HOT static void modal_row(const mhb_receptance *r, int k, const double *yr, const double *yi,
                              double complex *R, double complex *u) {
  int           m = r->n_modes, n = r->n;
  const double *re = part(r, k, 0), *im = part(r, k, 1);
  for (int b = 0; b < n && n < WORTH_BLAS; b++)
    R[b] += product(m, yr, yi, re + b * m, im + b * m, -1);
  *u += product(m, yr, yi, re + n * m, im + n * m, 1);
}

void mhb_receptance_residual_terms(const mhb_receptance *r, int k, double w, double complex *R) {
  memset(R, 0, sizeof *R * (size_t)r->n * (size_t)r->n);
  mhb_residual_terms_matrix(r->left_out, k, w, R);
}

static void harmonic_at(mhb_receptance *r, int k) {
  int             n = r->n, m = r->n_modes;
  double          w = k * r->omega / r->nu, *L = r->scratch, *y = L + 2 * m;
  double complex *R = r->R + (size_t)k * (size_t)n * (size_t)n, *u = r->unit + k * n;
  const double   *re = part(r, k, 0), *im = part(r, k, 1);
  double complex *all = r->BL, one = 1;
  set_lambda(r, w, L, L + m);
  for (int i = 0; i < m; i++) r->lambda[k * m + i] = CMPLX(L[i], L[m + i]);
  memset(u, 0, sizeof *u * (size_t)n);
  mhb_receptance_residual_terms(r, k, w, R);
  mhb_residual_terms_load(r->left_out, k, w, 1, u);
  for (int a = 0; a < n; a++, re += m, im += m) {
    for (int i = 0; i < m; i++) {
      y[i]     = re[i] * L[i] - im[i] * L[m + i];
      y[m + i] = re[i] * L[m + i] + im[i] * L[i];
      if (n >= WORTH_BLAS) all[a * m + i] = CMPLX(y[i], y[m + i]);
    }
    modal_row(r, k, y, y + m, R + (size_t)a * (size_t)n, &u[a]);
    r->free[k * n + a] = r->scale * u[a];
  }
  if (n >= WORTH_BLAS)
    cblas_zgemm(CblasRowMajor, CblasNoTrans, CblasConjTrans, n, n, m, &one, all, m,
                r->B + (size_t)k * (size_t)n * (size_t)m, m, &one, R, n);
}

void mhb_receptance_set_frequency(mhb_receptance *r, double omega) {
  r->omega = omega;
  if (!r->at || r->at->omega == omega) return;
  mhb_speed_model_set(r->at, omega);
  mhb_receptance_set(r);
}

void mhb_receptance_update(mhb_receptance *r, int k) {
  double w = k == 0 && !r->at ? 0 : r->omega; /* the mean knows no frequency, but a speed */
  if (r->made_at[k] == w) return;
  harmonic_at(r, k);
  r->made_at[k] = w;
}

void mhb_receptance_at(mhb_receptance *r, double omega, int top) {
  mhb_receptance_set_frequency(r, omega);
  for (int k = 0; k <= top; k++) mhb_receptance_update(r, k);
}

void mhb_receptance_scale(mhb_receptance *r, double scale) {
  r->scale = scale;
  for (int i = 0; i < (r->n_harmonics + 1) * r->n; i++) r->free[i] = scale * r->unit[i];
}

/* Modal amplitudes before L: load F - B^H p. */
double complex mhb_receptance_modal_load(const mhb_receptance *r, int k, const double complex *p,
                                         int i, double load) {
  const double complex *B = r->B + (size_t)k * (size_t)r->n * (size_t)r->n_modes;
  double complex        a = load * r->F[k * r->n_modes + i];
  for (int row = 0; row < r->n; row++) a -= conj(B[row * r->n_modes + i]) * p[row];
  return a;
}

/* dL/d omega = L^2 (2 k^2 w - 2 j zeta w_i k), k counted in the excitation frequency. */
static double complex lambda_slope(const mhb_receptance *r, int k, int i) {
  double         kk = (double)k / r->nu, wi = SHB_TWO_PI * r->model->frequency[i];
  double complex L = r->lambda[k * r->n_modes + i];
  return L * L * (2 * kk * kk * r->omega - 2 * I * r->model->damping_ratio[i] * wi * kk);
}

/* y = scale F - B^H p by modes. */
MHB_INLINE void drive(const mhb_receptance *r, int k, const double complex *p, double *restrict yr,
                      double *restrict yi) {
  int m = r->n_modes, n = r->n;
  const double *restrict re = part(r, k, 0), *restrict im = part(r, k, 1);
  for (int i = 0; i < m; i++) {
    yr[i] = r->scale * re[n * m + i];
    yi[i] = r->scale * im[n * m + i];
  }
  for (int b = 0; b < n; b++, re += m, im += m) {
    double pr = creal(p[b]), pi = cimag(p[b]);
    for (int i = 0; i < m; i++) {
      yr[i] -= re[i] * pr + im[i] * pi;
      yi[i] -= re[i] * pi - im[i] * pr;
    }
  }
}

/* y = dL/d omega (scale F - B^H p) by modes. */
MHB_HOT static void slope_drive(const mhb_receptance *r, int k, const double complex *p,
                                double *restrict yr, double *restrict yi) {
  int    m  = r->n_modes;
  double kk = (double)k / r->nu, spring = 2 * kk * kk * r->omega;
  drive(r, k, p, yr, yi);
  const double complex *lambda = r->lambda + k * m;
  for (int i = 0; i < m; i++) {
    double a = creal(lambda[i]), b = cimag(lambda[i]);
    double sr = a * a - b * b, si = 2 * a * b;
    double loss = -4 * SHB_PI * r->model->damping_ratio[i] * r->model->frequency[i] * kk;
    double dr = sr * spring - si * loss, di = si * spring + sr * loss, x = yr[i];
    yr[i] = dr * x - di * yi[i];
    yi[i] = dr * yi[i] + di * x;
  }
}

/* y = L (scale F - B^H p) by modes, at w rad/s. */
MHB_HOT static void motion_drive(const mhb_receptance *r, int k, double w, const double complex *p,
                                 double *restrict yr, double *restrict yi) {
  int    m = r->n_modes;
  double L[2 * m];
  set_lambda(r, w, L, L + m);
  drive(r, k, p, yr, yi);
  for (int i = 0; i < m; i++) {
    double x = yr[i];
    yr[i]    = L[i] * x - L[m + i] * yi[i];
    yi[i]    = L[i] * yi[i] + L[m + i] * x;
  }
}

MHB_HOT static void modal_sums(const mhb_receptance *r, int k, const double *yr, const double *yi,
                               double complex *out) {
  int           m  = r->n_modes;
  const double *re = part(r, k, 0), *im = part(r, k, 1);
  for (int a = 0; a < r->n; a++, re += m, im += m) out[a] = product(m, yr, yi, re, im, 1);
}

void mhb_receptance_motion(const mhb_receptance *r, int k, const double complex *p,
                           double complex *motion) {
  double w = k * r->omega / r->nu, yr[r->n_modes], yi[r->n_modes];
  motion_drive(r, k, w, p, yr, yi);
  modal_sums(r, k, yr, yi, motion);
  mhb_residual_terms_motion(r->left_out, k, w, r->scale, p, motion);
}

void mhb_receptance_slope(const mhb_receptance *r, int k, const double complex *p,
                          double complex *slope) {
  double kk = (double)k / r->nu, dw2 = 2 * kk * kk * r->omega, yr[r->n_modes], yi[r->n_modes];
  slope_drive(r, k, p, yr, yi);
  modal_sums(r, k, yr, yi, slope);
  mhb_residual_terms_slope(r->left_out, k, kk * r->omega, dw2, r->scale, p, slope);
  if (r->at) mhb_speed_derivative_slope(r, k, p, slope);
}

void mhb_receptance_probe_change(const mhb_receptance *r, int k, const double complex *p,
                                 const double complex *dp, double d_omega, double d_scale,
                                 double complex *change) {
  int    q = 3 * r->model->n_probes, m = r->n_modes;
  double kk = (double)k / r->nu, dw2 = 2 * kk * kk * r->omega * d_omega;
  memset(change, 0, sizeof *change * (size_t)q);
  mhb_residual_terms_probe_change(r->left_out, k, kk * r->omega, r->scale, p, dp, dw2, d_scale,
                                  change);
  for (int i = 0; i < m; i++) {
    double complex a = r->lambda[k * m + i] * mhb_receptance_modal_load(r, k, dp, i, d_scale);
    if (d_omega != 0)
      a += d_omega * lambda_slope(r, k, i) * mhb_receptance_modal_load(r, k, p, i, r->scale);
    for (int s = 0; s < q; s++) change[s] += r->model->probe[s * m + i] * a;
  }
  if (r->at && d_omega != 0) mhb_speed_derivative_probe(r, k, p, d_omega, change);
}

/* Neither driven nor pushed at by the contact. */
static int at_rest(const mhb_receptance *r, int k, const double complex *p) {
  for (int i = 0; i < r->n; i++)
    if (creal(p[i]) != 0 || cimag(p[i]) != 0) return 0;
  return !r->driven[k];
}

void mhb_receptance_probe(const mhb_receptance *r, int k, const double complex *p,
                          double complex *motion) {
  int q = 3 * r->model->n_probes;
  memset(motion, 0, sizeof(double complex) * (size_t)q);
  if (!at_rest(r, k, p)) mhb_receptance_probe_change(r, k, p, p, 0, r->scale, motion);
}
