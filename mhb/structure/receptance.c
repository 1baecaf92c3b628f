#include "mhb/structure/receptance.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/numerics/lu.h"
#include "mhb/numerics/simd.h"
#include "mhb/problem/interfaces.h"
#include "modal/model/joined_pairs.h"

static const double NUDGE = 1e-8;

/* At k = 0 a mode is at least this part of the lowest frequency asked for. It holds the mean of a
 * mode at 0 Hz, whose receptance there has no bound. */
static const double HOLD = 1e-3;

/* From this damping ratio on no gyroscopic mode has a resonance as sharp as NUDGE. */
static const double LEAST_DAMPING = 1e-6;

/* Angles of an interface in the case; 0 if not given. */
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

/* Axes of each pair: from its normal if the file has one, else from psi and phi of the case. */
static shb_status set_axes(mhb_receptance *r, const mhb_settings *s, int interface) {
  const modal_model *model = r->model;
  const angles       given = angles_of(s, interface);
  double(*T0)[3][3]        = (double(*)[3][3])r->T0;
  double mean[3]           = {0, 0, 0};
  for (int a = 0; a < model->n_pairs; a++) {
    if (r->interface[a] != interface) continue;
    double psi = given.psi, phi = given.phi;
    if (model->normal) modal_normal_angles(model->normal + 3 * a, &psi, &phi);
    modal_shroud_axes(psi, phi, T0[a]);
    for (int i = 0; i < 3; i++) mean[i] += r->share[a] * T0[a][i][0]; /* its length is no matter */
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

static void allocate(mhb_receptance *r) {
  size_t     n = (size_t)r->n, m = (size_t)r->n_modes, K = (size_t)r->n_harmonics + 1;
  shb_arena *a          = &r->arena;
  r->T0                 = shb_arena_take(a, 3 * n, sizeof *r->T0);
  r->share              = shb_arena_take(a, n / 3, sizeof *r->share);
  r->interface          = shb_arena_take(a, n / 3, sizeof *r->interface);
  r->phase              = shb_arena_take(a, K, sizeof *r->phase);
  r->updated_at         = shb_arena_take(a, K, sizeof *r->updated_at);
  r->load_at            = shb_arena_take(a, K, sizeof *r->load_at);
  r->free               = shb_arena_take(a, K * n, sizeof *r->free);
  r->free_response_unit = shb_arena_take(a, K * n, sizeof *r->free_response_unit);
  if (r->ring) return;
  r->lambda  = shb_arena_take(a, K * m, sizeof *r->lambda);
  r->R       = shb_alloc_zeroed(K * n * n, sizeof *r->R);
  r->scratch = shb_arena_take(a, 4 * m, sizeof *r->scratch);
  r->BL      = shb_arena_take(a, n * m, sizeof *r->BL);
  if (r->model->coriolis) {
    r->factor = shb_arena_take(a, K * m * m, sizeof *r->factor);
    r->pivot  = shb_arena_take(a, K * m, sizeof *r->pivot);
  }
}

/* The model of one harmonic: that of nodal diameter k (E + N l)/nu of d. */
static shb_status find_wave(const mhb_settings *s, const modal_nodal_diameters *d, int k,
                            modal_wave *wave) {
  const long fundamental = mhb_settings_wave_number(s, d->blades);
  int        missing;
  SHB_CHECK(fundamental >= 0, SHB_ERR_INPUT,
            "mhb.subharmonics is %d, but a wave of that many periods does not close around the %d "
            "sectors of the modal file at engine order %d; set it to 1",
            s->subharmonics, d->blades, s->engine_order);
  SHB_CHECK(modal_nodal_diameters_wave(d, k * fundamental, wave, &missing), SHB_ERR_INPUT,
            "harmonic %d%s at engine order %d meets the disc at nodal diameter %d, which the modal "
            "file does not have; add it by `shroudhb modal --set modal.nodal_diameters=all "
            "CASE.yaml`",
            k, s->subharmonics > 1 ? " of the fundamental" : "", s->engine_order, missing);
  return SHB_OK;
}

shb_status mhb_receptance_check(const mhb_settings *s, int top) {
  const modal_nodal_diameters *d = s->nodal_diameters;
  modal_wave                   wave;
  if (!d) return SHB_OK;
  SHB_CHECK(s->blades == d->blades || (s->to_ground && s->blades == 0), SHB_ERR_INPUT,
            "rotor.blades is %d, but the modal file holds one of %d sectors; set it to %d",
            s->blades, d->blades, d->blades);
  SHB_CHECK(s->engine_order >= 0, SHB_ERR_INPUT,
            "excitation.engine_order is %d; the nodal diameters of the modal file need one of 0 or "
            "more",
            s->engine_order);
  for (int k = 0; k <= top; k++) SHB_TRY(find_wave(s, d, k, &wave));
  return SHB_OK;
}

/* The models of all harmonics of a disc, from d; to be freed in any case. */
static shb_status find_waves(const mhb_receptance *r, const mhb_settings *settings,
                             const modal_nodal_diameters *d, modal_wave **out) {
  modal_wave *wave = *out = shb_alloc_zeroed((size_t)r->n_harmonics + 1, sizeof *wave);
  shb_status  status      = SHB_OK;
  for (int k = 0; k <= r->n_harmonics && status == SHB_OK; k++)
    status = find_wave(settings, d, k, &wave[k]);
  return status;
}

/* The residual matrices that settings->alike lends; NULL: it has none that fit. */
static const mhb_residual_terms *terms_alike(const mhb_receptance *r, const mhb_settings *s) {
  const mhb_receptance *of = s->alike;
  if (!of || of->ring || of->at || of->model != r->model) return NULL;
  const bool same = of->part->relative.sides == (s->to_ground ? 1 : 2) &&
                    memcmp(of->T0, r->T0, 3 * (size_t)r->n * sizeof *r->T0) == 0;
  return same ? of->residual_terms : NULL;
}

static shb_status make_part(mhb_receptance *r, const mhb_settings *settings,
                            const mhb_residual_terms *like) {
  const mhb_relative relative  = {r->n, settings->to_ground ? 1 : 2, r->T0};
  mhb_harmonics      harmonics = {.nu          = r->nu,
                                  .n_harmonics = r->n_harmonics,
                                  .phase       = r->phase,
                                  .like        = like ? like : terms_alike(r, settings)};
  if (!settings->nodal_diameters)
    return mhb_modal_part_create(r->model, relative, &harmonics, &r->part);
  modal_wave *wave = NULL;
  SHB_TRY(mhb_receptance_check(settings, r->n_harmonics));
  shb_status status =
      find_waves(r, settings, r->disc ? &r->disc->now : settings->nodal_diameters, &wave);
  harmonics.wave            = wave;
  harmonics.nodal_diameters = true;
  if (status == SHB_OK) status = mhb_modal_part_create(r->model, relative, &harmonics, &r->part);
  free(wave);
  return status;
}

/* The speed model of each harmonic, at the lowest speed. */
static shb_status make_speeds(mhb_receptance *r, const mhb_settings *s) {
  r->speeds = shb_arena_take(&r->arena, (size_t)r->n_harmonics + 1, sizeof(mhb_speed_model *));
  const long fundamental = r->disc ? mhb_settings_wave_number(s, r->disc->table->blades) : 0;
  for (int k = 0; k <= r->n_harmonics; k++) {
    r->speeds[k] = r->disc ? mhb_disc_speeds_use(r->disc, k * fundamental) : r->at;
    SHB_CHECK(r->speeds[k], SHB_ERR_INPUT, "the modal file lacks the nodal diameter of harmonic %d",
              k);
  }
  return SHB_OK;
}

static shb_status make_speed_derivative(mhb_receptance *r, const mhb_settings *settings) {
  modal_wave *wave   = NULL;
  shb_status  status = r->disc ? find_waves(r, settings, &r->disc->slope, &wave) : SHB_OK;
  if (status == SHB_OK)
    status = mhb_speed_derivative_create(r->speeds, r->disc, wave, r->part, &r->speed_derivative);
  free(wave);
  return status;
}

/* Roots at 0 of modes that Coriolis terms couple share one shape. */
static shb_status check_coriolis(const modal_model *model) {
  for (int i = 0; i < model->n_modes && model->coriolis; i++)
    SHB_CHECK(
        model->frequency[i] > 0, SHB_ERR_INPUT,
        "/modes/frequency: value %d (from 0) is at 0 Hz; with Coriolis terms (/modes/coriolis) "
        "every mode must be above 0: hold the body, or leave the terms out",
        i);
  return SHB_OK;
}

/* Everything that does not depend on omega. */
static shb_status set_blade(mhb_receptance *r, const mhb_settings *settings,
                            const mhb_residual_terms *like) {
  const double step  = settings->to_ground ? 0 : mhb_driven_wave_lag(mhb_settings_wave(settings));
  const int contacts = r->ring ? r->ring->blades : settings->contacts > 1 ? settings->contacts : 1;
  r->hold            = HOLD * SHB_TWO_PI * fmin(settings->frequency[0], settings->frequency[1]);
  SHB_TRY(check_coriolis(r->model));
  SHB_TRY(mhb_interfaces_match(r->model, settings, r->interface));
  mhb_pair_shares(r->model->n_pairs, mhb_interfaces(settings), r->interface, r->model->area,
                  contacts, r->share);
  for (int i = 0; i < mhb_interfaces(settings); i++) SHB_TRY(set_axes(r, settings, i));
  for (int k = 0; k <= r->n_harmonics; k++) {
    r->updated_at[k] = r->load_at[k] = NAN;
    r->phase[k]                      = cexp(-I * fmod(k * step, SHB_TWO_PI));
  }
  if (r->ring) {
    for (int k = 0; k <= r->n_harmonics; k++) r->phase[k] = 1; /* all blades are there */
    r->driven = r->ring->blade[0]->driven;
    return SHB_OK;
  }
  SHB_TRY(make_part(r, settings, like));
  r->B              = r->part->B;
  r->F              = r->part->F;
  r->driven         = r->part->driven;
  r->residual_terms = r->part->residual_terms;
  return SHB_OK;
}

static shb_status make(mhb_receptance *r, const modal_model *model, const mhb_settings *settings,
                       const mhb_residual_terms *like) {
  r->model = model;
  if (settings->ring) {
    SHB_TRY(mhb_ring_receptance_create(settings, r->n_harmonics, &r->ring));
    r->model = &settings->ring->whole;
  } else if (settings->disc_run_up) {
    r->disc = mhb_disc_speeds_create(settings->disc_run_up);
    r->at   = r->disc->at[0];
  } else if (settings->run_up) {
    r->at = mhb_speed_model_create(settings->run_up);
  }
  if (r->at) {
    mhb_speed_model_set(r->at, 0);
    r->model = &r->at->model;
  }
  r->n       = 3 * r->model->n_pairs;
  r->n_modes = r->model->n_modes;
  allocate(r);
  if (r->disc) SHB_TRY(mhb_receptance_check(settings, r->n_harmonics));
  if (r->at) SHB_TRY(make_speeds(r, settings));
  SHB_TRY(set_blade(r, settings, like));
  if (r->at) SHB_TRY(make_speed_derivative(r, settings));
  return SHB_OK;
}

static shb_status create(const modal_model *model, const mhb_settings *settings, int n_harmonics,
                         const mhb_residual_terms *like, mhb_receptance **out) {
  SHB_CHECK(settings->to_ground || model->has_left, SHB_ERR_INPUT,
            "contact.to is neighbour, but the modal file has no /contact/left; set it to ground");
  SHB_CHECK(settings->to_ground || settings->ring ||
                mhb_driven_wave_shift(mhb_settings_wave(settings)) >= 0,
            SHB_ERR_INPUT,
            "mhb.subharmonics is %d, but a wave of that many periods does not close around %d "
            "blades at engine order %d; set it to 1",
            settings->subharmonics, settings->blades, settings->engine_order);
  mhb_receptance *r = shb_alloc_zeroed(1, sizeof *r);
  r->n_harmonics    = n_harmonics;
  r->nu             = settings->subharmonics;
  r->scale          = settings->scale;
  shb_status status = make(r, model, settings, like);
  if (status != SHB_OK) {
    mhb_receptance_destroy(r);
    return status;
  }
  *out = r;
  return SHB_OK;
}

shb_status mhb_receptance_create(const modal_model *model, const mhb_settings *settings,
                                 int n_harmonics, mhb_receptance **out) {
  return create(model, settings, n_harmonics, NULL, out);
}

shb_status mhb_receptance_create_beside(const mhb_receptance *other, const mhb_settings *settings,
                                        int n_harmonics, mhb_receptance **out) {
  const int own = other->ring || other->at;
  return create(other->model, settings, n_harmonics, own ? NULL : other->residual_terms, out);
}

void mhb_receptance_destroy(mhb_receptance *r) {
  if (!r) return;
  mhb_ring_receptance_destroy(r->ring);
  mhb_speed_derivative_destroy(r->speed_derivative);
  mhb_modal_part_destroy(r->part);
  if (r->disc)
    mhb_disc_speeds_destroy(r->disc);
  else
    mhb_speed_model_destroy(r->at);
  shb_arena_free(&r->arena);
  free(r->R);
  free(r);
}

/* L_i = 1/(w_i^2 - w^2 + 2 j zeta_i w_i w). At a resonance without damping w is moved by half of
 * NUDGE. That is far enough for the other modes to keep half of their digits in the sums. */
MHB_HOT static void set_lambda(const mhb_receptance *r, int k, double w, double *restrict re,
                               double *restrict im) {
  const modal_model *model  = mhb_receptance_model(r, k);
  const double *restrict hz = model->frequency, *restrict zeta = model->damping_ratio;
  const double held = k == 0 ? r->hold : 0;
  for (int i = 0; i < r->n_modes; i++) {
    double wi = mhb_most(SHB_TWO_PI * hz[i], held), a = wi * wi - w * w, b = 2 * zeta[i] * wi * w,
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

/* One row of R += B L B^H, and of the response to the load. y: that row of B L. */
MHB_HOT static void modal_row(const mhb_receptance *r, int k, const double *yr, const double *yi,
                              double complex *R, double complex *u) {
  int           m = r->n_modes, n = r->n;
  const double *re = mhb_modal_part_split(r->part, k, 0), *im = mhb_modal_part_split(r->part, k, 1);
  for (int b = 0; b < n && n < MHB_WORTH_BLAS; b++)
    R[b] += product(m, yr, yi, re + b * m, im + b * m, -1);
  *u += product(m, yr, yi, re + n * m, im + n * m, 1);
}

void mhb_receptance_residual_terms(const mhb_receptance *r, int k, double w, double complex *R) {
  memset(R, 0, sizeof *R * (size_t)r->n * (size_t)r->n);
  mhb_residual_terms_matrix(r->residual_terms, k, w, R);
}

/* Without a run-up the mean does not depend on the frequency. */
static double frequency_of(const mhb_receptance *r, int k) {
  return k == 0 && !r->at ? 0 : r->omega;
}

/* ---- modes coupled by Coriolis terms ---- */

void mhb_receptance_dynamic_stiffness(const mhb_receptance *r, int k, double w, double complex *A) {
  const modal_model    *model = mhb_receptance_model(r, k);
  const size_t          m     = (size_t)r->n_modes;
  const double complex *G     = r->part->G ? r->part->G + (size_t)k * m * m : NULL;
  for (size_t j = 0; j < m; j++)
    for (size_t i = 0; i < m; i++) A[j * m + i] = G ? I * w * G[i * m + j] : 0;
  for (size_t i = 0; i < m; i++) {
    const double wi = fmax(SHB_TWO_PI * model->frequency[i], k == 0 ? r->hold : 0);
    A[i * m + i] += CMPLX(wi * wi - w * w, 2 * model->damping_ratio[i] * wi * w);
  }
}

/* w, or where a gyroscopic mode without damping has its resonance a frequency beside it, as in
 * set_lambda. */
static double beside_resonances(const mhb_receptance *r, int k, double w) {
  const modal_model *model = mhb_receptance_model(r, k);
  bool               least = false;
  for (int i = 0; i < r->n_modes; i++) least = least || model->damping_ratio[i] < LEAST_DAMPING;
  if (!least) return w;
  const mhb_gyroscopic *modes = mhb_modal_part_gyroscopic(r->part, k);
  for (int i = modes ? modes->n : 0; modes && i < 2 * modes->n; i++) {
    const double wi = modes->omega[i], a = wi * wi - w * w, b = 2 * modes->decay[i] * w;
    if (hypot(a, b) < NUDGE * wi * wi) return wi * (1 - copysign(0.5 * NUDGE, a));
  }
  return w;
}

static void factor_at(const mhb_receptance *r, int k, double complex *A, int *pivot) {
  const double w = k * r->omega / r->nu;
  mhb_receptance_dynamic_stiffness(r, k, beside_resonances(r, k, w), A);
  mhb_factor_complex(r->n_modes, A, pivot);
}

/* The factor may be that of another frequency. */
void mhb_receptance_coupled(const mhb_receptance *r, int k, double complex *x) {
  const size_t    m    = (size_t)r->n_modes;
  const int       kept = r->load_at[k] == frequency_of(r, k);
  double complex *own  = kept ? NULL : shb_alloc(m * m, sizeof *own);
  int             pivot[m];
  if (own) factor_at(r, k, own, pivot);
  mhb_solve_complex(r->n_modes, own ? own : r->factor + (size_t)k * m * m,
                    own ? pivot : r->pivot + (size_t)k * m, 1, x);
  free(own);
}

static mhb_modal_solver solver_of(const mhb_receptance *r, int k) {
  const size_t m = (size_t)r->n_modes, at = (size_t)k * m;
  if (!r->factor) return (mhb_modal_solver){.lambda = r->lambda + at};
  return (mhb_modal_solver){.factor = r->factor + at * m, .pivot = r->pivot + at};
}

void mhb_receptance_respond(const mhb_receptance *r, int k, double complex *x) {
  if (r->factor)
    mhb_receptance_coupled(r, k, x);
  else
    for (int i = 0; i < r->n_modes; i++) x[i] *= r->lambda[k * r->n_modes + i];
}

static void join(int m, const double *re, const double *im, double complex *x) {
  for (int i = 0; i < m; i++) x[i] = CMPLX(re[i], im[i]);
}

static void part(int m, const double complex *x, double *re, double *im) {
  for (int i = 0; i < m; i++) {
    re[i] = creal(x[i]);
    im[i] = cimag(x[i]);
  }
}

/* 2 zeta_i w_i, 1/s */
static double loss_of(const mhb_receptance *r, int k, int i) {
  const modal_model *model = mhb_receptance_model(r, k);
  return 2 * model->damping_ratio[i] * SHB_TWO_PI * model->frequency[i];
}

/* y <- -dA/d omega x, A = L^-1. */
static void coupled_slope(const mhb_receptance *r, int k, const double complex *x,
                          double complex *y) {
  const int             m  = r->n_modes;
  const double          kk = (double)k / r->nu;
  const double complex *G  = r->part->G + (size_t)k * (size_t)m * (size_t)m;
  for (int i = 0; i < m; i++) {
    double complex sum = (2 * I * kk * r->omega + loss_of(r, k, i)) * x[i]; /* times j: -2 w x */
    for (int j = 0; j < m; j++) sum += G[(size_t)i * (size_t)m + (size_t)j] * x[j];
    y[i] = -I * kk * sum;
  }
}

void mhb_receptance_coupled_slope(const mhb_receptance *r, int k, double complex *x) {
  double complex y[r->n_modes];
  mhb_receptance_coupled(r, k, x);
  coupled_slope(r, k, x, y);
  memcpy(x, y, sizeof y);
  mhb_receptance_coupled(r, k, x);
}

/* R += B L B^H; the factor is up to date. */
static void coupled_matrix(mhb_receptance *r, int k, double complex *R) {
  const int             n = r->n, m = r->n_modes;
  const size_t          nm  = (size_t)n * (size_t)m;
  const double complex *B   = r->B + (size_t)k * nm;
  const double complex  one = 1;
  for (size_t i = 0; i < nm; i++) r->BL[i] = conj(B[i]);
  mhb_solve_complex(m, r->factor + (size_t)k * (size_t)m * (size_t)m,
                    r->pivot + (size_t)k * (size_t)m, n, r->BL);
  cblas_zgemm(CblasRowMajor, CblasNoTrans, CblasTrans, n, n, m, &one, B, m, r->BL, m, &one, R, n);
}

/* lambda and free, as harmonic_at makes them, without R. */
static void load_at(mhb_receptance *r, int k) {
  if (r->ring) {
    mhb_ring_receptance_update_load(r->ring, k, r->free + k * r->n,
                                    r->free_response_unit + k * r->n);
    return;
  }
  int             n = r->n, m = r->n_modes;
  double          w = k * r->omega / r->nu, *L = r->scratch, *y = L + 2 * m;
  double complex *u = r->free_response_unit + k * n;
  const double *re = mhb_modal_part_split(r->part, k, 0), *im = mhb_modal_part_split(r->part, k, 1);
  const double *load_re = re + n * m, *load_im = im + n * m;
  if (r->factor) {
    double complex  x[m];
    int            *pivot = r->pivot + (size_t)k * (size_t)m;
    double complex *A     = r->factor + (size_t)k * (size_t)m * (size_t)m;
    factor_at(r, k, A, pivot);
    join(m, load_re, load_im, x);
    mhb_solve_complex(m, A, pivot, 1, x);
    part(m, x, y, y + m);
  } else {
    set_lambda(r, k, w, L, L + m);
    for (int i = 0; i < m; i++) r->lambda[k * m + i] = CMPLX(L[i], L[m + i]);
  }
  memset(u, 0, sizeof *u * (size_t)n);
  if (!r->driven[k]) { /* nor is the free response, which stays 0 */
    memset(r->free + k * n, 0, sizeof *u * (size_t)n);
    return;
  }
  for (int i = 0; i < m && !r->factor; i++) {
    y[i]     = L[i] * load_re[i] - L[m + i] * load_im[i];
    y[m + i] = L[i] * load_im[i] + L[m + i] * load_re[i];
  }
  mhb_residual_terms_load(r->residual_terms, k, w, 1, u);
  for (int a = 0; a < n; a++, re += m, im += m) {
    u[a] += product(m, y, y + m, re, im, 1);
    r->free[k * n + a] = r->scale * u[a];
  }
}

static void harmonic_at(mhb_receptance *r, int k) {
  if (r->ring) {
    mhb_ring_receptance_update(r->ring, k, r->free + k * r->n, r->free_response_unit + k * r->n);
    return;
  }
  int             n = r->n, m = r->n_modes;
  double          w = k * r->omega / r->nu, *L = r->scratch, *y = L + 2 * m;
  double complex *R = r->R + (size_t)k * (size_t)n * (size_t)n, *u = r->free_response_unit + k * n;
  const double *re = mhb_modal_part_split(r->part, k, 0), *im = mhb_modal_part_split(r->part, k, 1);
  double complex *all = r->BL, one = 1;
  if (r->factor) {
    load_at(r, k);
    mhb_receptance_residual_terms(r, k, w, R);
    coupled_matrix(r, k, R);
    return;
  }
  set_lambda(r, k, w, L, L + m);
  for (int i = 0; i < m; i++) r->lambda[k * m + i] = CMPLX(L[i], L[m + i]);
  memset(u, 0, sizeof *u * (size_t)n);
  mhb_receptance_residual_terms(r, k, w, R);
  mhb_residual_terms_load(r->residual_terms, k, w, 1, u);
  for (int a = 0; a < n; a++, re += m, im += m) {
    for (int i = 0; i < m; i++) {
      y[i]     = re[i] * L[i] - im[i] * L[m + i];
      y[m + i] = re[i] * L[m + i] + im[i] * L[i];
      if (n >= MHB_WORTH_BLAS) all[a * m + i] = CMPLX(y[i], y[m + i]);
    }
    modal_row(r, k, y, y + m, R + (size_t)a * (size_t)n, &u[a]);
    r->free[k * n + a] = r->scale * u[a];
  }
  if (n >= MHB_WORTH_BLAS)
    cblas_zgemm(CblasRowMajor, CblasNoTrans, CblasConjTrans, n, n, m, &one, all, m,
                r->B + (size_t)k * (size_t)n * (size_t)m, m, &one, R, n);
}

void mhb_receptance_set_frequency(mhb_receptance *r, double omega) {
  r->omega = omega;
  if (r->ring) mhb_ring_receptance_set_frequency(r->ring, omega);
  if (!r->at || r->at->omega == omega) return;
  if (r->disc)
    mhb_disc_speeds_set(r->disc, omega);
  else
    mhb_speed_model_set(r->at, omega);
  mhb_modal_part_update(r->part);
}

void mhb_receptance_update(mhb_receptance *r, int k) {
  double w = frequency_of(r, k);
  if (r->updated_at[k] != w) {
    harmonic_at(r, k);
    if (!r->ring && !r->factor && r->n >= MHB_WORTH_BLAS)
      load_at(r, k); /* its last digits, not R's, everywhere */
    r->updated_at[k] = r->load_at[k] = w;
  }
  if (r->load_at[k] != w) { /* R_k is that of w, but the load went elsewhere since */
    load_at(r, k);
    r->load_at[k] = w;
  }
}

void mhb_receptance_update_load(mhb_receptance *r, int k) {
  double w = frequency_of(r, k);
  if (r->load_at[k] == w) return;
  load_at(r, k);
  r->load_at[k] = w;
}

void mhb_receptance_at(mhb_receptance *r, double omega, int top) {
  mhb_receptance_set_frequency(r, omega);
  for (int k = 0; k <= top; k++) mhb_receptance_update(r, k);
}

void mhb_receptance_scale(mhb_receptance *r, double scale) {
  r->scale = scale;
  if (r->ring) mhb_ring_receptance_scale(r->ring, scale);
  for (int i = 0; i < (r->n_harmonics + 1) * r->n; i++)
    r->free[i] = scale * r->free_response_unit[i];
}

/* dL/d omega = L^2 (2 k^2 omega - 2 j zeta w_i k), k counted in the excitation frequency. */
static double complex lambda_slope(const mhb_receptance *r, int k, int i) {
  double         kk = (double)k / r->nu, wi = SHB_TWO_PI * mhb_receptance_model(r, k)->frequency[i];
  double complex L = r->lambda[k * r->n_modes + i];
  return L * L *
         (2 * kk * kk * r->omega - 2 * I * mhb_receptance_model(r, k)->damping_ratio[i] * wi * kk);
}

/* y = scale F - B^H p, by modes. */
MHB_INLINE void drive(const mhb_receptance *r, int k, const double complex *p, double *restrict yr,
                      double *restrict yi) {
  int m = r->n_modes, n = r->n;
  const double *restrict re = mhb_modal_part_split(r->part, k, 0), *restrict im =
                                                                       mhb_modal_part_split(r->part,
                                                                                            k, 1);
  for (int i = 0; i < m; i++) {
    yr[i] = r->scale * re[n * m + i];
    yi[i] = r->scale * im[n * m + i];
  }
  for (int b = 0; p && b < n; b++, re += m, im += m) {
    double pr = creal(p[b]), pi = cimag(p[b]);
    for (int i = 0; i < m; i++) {
      yr[i] -= re[i] * pr + im[i] * pi;
      yi[i] -= re[i] * pi - im[i] * pr;
    }
  }
}

/* y = dL/d omega (scale F - B^H p), by modes. */
MHB_HOT static void slope_drive(const mhb_receptance *r, int k, const double complex *p,
                                double *restrict yr, double *restrict yi) {
  int    m  = r->n_modes;
  double kk = (double)k / r->nu, spring = 2 * kk * kk * r->omega;
  drive(r, k, p, yr, yi);
  if (r->factor) {
    double complex x[m];
    join(m, yr, yi, x);
    mhb_receptance_coupled_slope(r, k, x);
    part(m, x, yr, yi);
    return;
  }
  const double complex *lambda = r->lambda + k * m;
  for (int i = 0; i < m; i++) {
    double a = creal(lambda[i]), b = cimag(lambda[i]);
    double sr = a * a - b * b, si = 2 * a * b;
    double loss = -4 * SHB_PI * mhb_receptance_model(r, k)->damping_ratio[i] *
                  mhb_receptance_model(r, k)->frequency[i] * kk;
    double dr = sr * spring - si * loss, di = si * spring + sr * loss, x = yr[i];
    yr[i] = dr * x - di * yi[i];
    yi[i] = dr * yi[i] + di * x;
  }
}

/* y = L (scale F - B^H p), by modes, at w rad/s. */
MHB_HOT static void motion_drive(const mhb_receptance *r, int k, double w, const double complex *p,
                                 double *restrict yr, double *restrict yi) {
  int    m = r->n_modes;
  double L[2 * m];
  drive(r, k, p, yr, yi);
  if (r->factor) {
    double complex x[m];
    join(m, yr, yi, x);
    mhb_receptance_coupled(r, k, x);
    part(m, x, yr, yi);
    return;
  }
  set_lambda(r, k, w, L, L + m);
  for (int i = 0; i < m; i++) {
    double x = yr[i];
    yr[i]    = L[i] * x - L[m + i] * yi[i];
    yi[i]    = L[i] * yi[i] + L[m + i] * x;
  }
}

MHB_HOT static void modal_sums(const mhb_receptance *r, int k, const double *yr, const double *yi,
                               double complex *out) {
  int           m  = r->n_modes;
  const double *re = mhb_modal_part_split(r->part, k, 0), *im = mhb_modal_part_split(r->part, k, 1);
  for (int a = 0; a < r->n; a++, re += m, im += m) out[a] = product(m, yr, yi, re, im, 1);
}

double complex mhb_receptance_diagonal(const mhb_receptance *r, int k, int i) {
  if (r->ring) {
    const int n = r->ring->n;
    return mhb_ring_receptance_block(r->ring, k, i / n, MHB_RING_OWN)[(i % n) * (n + 1)];
  }
  return r->R[((size_t)k * (size_t)r->n + (size_t)i) * (size_t)r->n + (size_t)i];
}

void mhb_receptance_product_of(const mhb_receptance *r, int k, const double complex *p,
                               double complex *motion) {
  if (r->ring) {
    mhb_ring_receptance_product(r->ring, k, p, motion);
    return;
  }
  const double complex *R = r->R + (size_t)k * (size_t)r->n * (size_t)r->n;
  for (int i = 0; i < r->n; i++, R += r->n)
    for (int j = 0; j < r->n; j++) motion[i] += R[j] * p[j];
}

void mhb_receptance_motion(const mhb_receptance *r, int k, const double complex *p,
                           double complex *motion) {
  if (r->ring) {
    mhb_ring_receptance_motion(r->ring, k, p, motion);
    return;
  }
  double w = k * r->omega / r->nu, yr[r->n_modes], yi[r->n_modes];
  motion_drive(r, k, w, p, yr, yi);
  modal_sums(r, k, yr, yi, motion);
  mhb_residual_terms_motion(r->residual_terms, k, w, r->scale, p, motion);
}

void mhb_receptance_amplitudes(const mhb_receptance *r, int k, const double complex *p,
                               double complex *amplitude) {
  if (r->ring) {
    mhb_ring_receptance_amplitudes(r->ring, k, p, amplitude);
    return;
  }
  double yr[r->n_modes], yi[r->n_modes];
  motion_drive(r, k, k * r->omega / r->nu, p, yr, yi);
  for (int i = 0; i < r->n_modes; i++) amplitude[i] = CMPLX(yr[i], yi[i]);
}

void mhb_receptance_slope(const mhb_receptance *r, int k, const double complex *p,
                          double complex *slope) {
  if (r->ring) {
    mhb_ring_receptance_slope(r->ring, k, p, slope);
    return;
  }
  double kk = (double)k / r->nu, dw2 = 2 * kk * kk * r->omega, yr[r->n_modes], yi[r->n_modes];
  slope_drive(r, k, p, yr, yi);
  modal_sums(r, k, yr, yi, slope);
  mhb_residual_terms_slope(r->residual_terms, k, kk * r->omega, dw2, r->scale, p, slope);
  if (r->at)
    mhb_speed_derivative_slope(r->speed_derivative, k, k * r->omega / r->nu, solver_of(r, k),
                               r->scale, p, slope);
}

/* Change of the amplitudes of coupled modes, as mhb_receptance_probe_change. */
static void coupled_change(const mhb_receptance *r, int k, const double complex *p,
                           const double complex *dp, double d_omega, double d_scale,
                           double complex *a) {
  const int m = r->n_modes;
  for (int i = 0; i < m; i++) a[i] = mhb_modal_part_force(r->part, k, dp, i, d_scale);
  if (d_omega != 0) {
    double complex x[m], y[m];
    for (int i = 0; i < m; i++) x[i] = mhb_modal_part_force(r->part, k, p, i, r->scale);
    mhb_receptance_coupled(r, k, x);
    coupled_slope(r, k, x, y);
    for (int i = 0; i < m; i++) a[i] += d_omega * y[i];
  }
  mhb_receptance_coupled(r, k, a);
}

void mhb_receptance_probe_change(const mhb_receptance *r, int k, const double complex *p,
                                 const double complex *dp, double d_omega, double d_scale,
                                 double complex *change) {
  if (r->ring) {
    mhb_ring_receptance_probe_change(r->ring, k, p, dp, d_omega, d_scale, change);
    return;
  }
  int    q = 3 * r->model->n_probes, m = r->n_modes;
  double kk = (double)k / r->nu, dw2 = 2 * kk * kk * r->omega * d_omega;
  memset(change, 0, sizeof *change * (size_t)q);
  mhb_residual_terms_probe_change(r->residual_terms, k, kk * r->omega,
                                  (mhb_structure_forces){r->scale, p},
                                  (mhb_structure_forces){d_scale, dp}, dw2, change);
  double complex coupled[r->factor ? m : 1];
  if (r->factor) coupled_change(r, k, p, dp, d_omega, d_scale, coupled);
  for (int i = 0; i < m; i++) {
    double complex a = r->factor ? coupled[i] : 0;
    if (!r->factor) a = r->lambda[k * m + i] * mhb_modal_part_force(r->part, k, dp, i, d_scale);
    if (!r->factor && d_omega != 0)
      a += d_omega * lambda_slope(r, k, i) * mhb_modal_part_force(r->part, k, p, i, r->scale);
    for (int s = 0; s < q; s++) change[s] += mhb_modal_part_probe(r->part, k, s, i, a);
  }
  if (r->at && d_omega != 0)
    mhb_speed_derivative_probe(r->speed_derivative, k, k * r->omega / r->nu, solver_of(r, k),
                               r->scale, p, d_omega, change);
}

/* The harmonic has neither load nor contact force. */
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

/* zeta dL/d zeta = -2 j zeta w_i w L^2 */
void mhb_receptance_by_damping(const mhb_receptance *r, int k, const double complex *p,
                               double complex *motion, double complex *probe) {
  if (r->ring) {
    mhb_ring_receptance_by_damping(r->ring, k, p, motion, probe);
    return;
  }
  int            m = r->n_modes, q = 3 * r->model->n_probes;
  double         w = k * r->omega / r->nu, yr[m], yi[m];
  double complex coupled[r->factor ? m : 1];
  drive(r, k, p, yr, yi);
  memset(probe, 0, sizeof *probe * (size_t)q);
  if (r->factor) {
    join(m, yr, yi, coupled);
    mhb_receptance_coupled(r, k, coupled);
    for (int i = 0; i < m; i++) coupled[i] *= -I * loss_of(r, k, i) * w;
    mhb_receptance_coupled(r, k, coupled);
  }
  for (int i = 0; i < m; i++) {
    double b = 2 * mhb_receptance_model(r, k)->damping_ratio[i] * SHB_TWO_PI *
               mhb_receptance_model(r, k)->frequency[i] * w;
    double complex L = r->factor ? 0 : r->lambda[k * m + i];
    double complex y = r->factor ? coupled[i] : -I * b * L * L * CMPLX(yr[i], yi[i]);
    yr[i]            = creal(y);
    yi[i]            = cimag(y);
    for (int s = 0; s < q; s++) probe[s] += mhb_modal_part_probe(r->part, k, s, i, y);
  }
  modal_sums(r, k, yr, yi, motion);
}
