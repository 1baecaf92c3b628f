/* The condensed receptance against dense sums over the contact dofs of one blade (eqs. 19-27,
 * 34-35). */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/structure/modal_structure.h"
#include "mhb/structure/receptance.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"

enum { MAX_N = 12, MAX_C = 24, MODES = 6, PROBE_DOFS = 6 };

/* What the condensation must come to, from the model alone. */
typedef struct {
  int            n, nc;
  double complex T[MAX_N][MAX_C]; /* relative motion = T x */
  double complex R[MAX_N][MAX_N], free[MAX_N];
  double complex probe_force[PROBE_DOFS][MAX_N], probe_free[PROBE_DOFS];
} dense;

/* v as given, u horizontal, w = v x u. */
static void axes_of(const modal_model *model, const mhb_settings *s, int pair, double axes[3][3]) {
  double psi = s->psi, phi = s->phi;
  if (model->normal) {
    memcpy(axes[0], model->normal + 3 * pair, sizeof axes[0]);
    psi = atan2(axes[0][1], axes[0][0]);
  } else {
    axes[0][0] = cos(psi) * cos(phi);
    axes[0][1] = sin(psi) * cos(phi);
    axes[0][2] = -sin(phi);
  }
  axes[1][0] = -sin(psi);
  axes[1][1] = cos(psi);
  axes[1][2] = 0;
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    axes[2][i] = axes[0][j] * axes[1][k] - axes[0][k] * axes[1][j];
  }
}

static void set_transform(const modal_model *model, const mhb_settings *s, int k, dense *d) {
  double complex phase =
      cexp(-I * (SHB_TWO_PI * s->engine_order / s->blades * k / s->subharmonics));
  memset(d, 0, sizeof *d);
  d->n  = 3 * model->n_pairs;
  d->nc = d->n * (model->has_left ? 2 : 1);
  for (int pair = 0; pair < model->n_pairs; pair++) {
    double axes[3][3];
    axes_of(model, s, pair, axes);
    for (int c = 0; c < 3; c++)
      for (int i = 0; i < 3; i++) {
        d->T[3 * pair + c][3 * pair + i] = axes[c][i];
        if (!s->to_ground) d->T[3 * pair + c][d->n + 3 * pair + i] = -phase * axes[c][i];
      }
  }
}

/* Shape of mode i at contact dof c. */
static double shape(const modal_model *model, int c, int i) {
  int n = 3 * model->n_pairs;
  return c < n ? model->right[c * MODES + i] : model->left[(c - n) * MODES + i];
}

static double complex modal_receptance(const modal_model *model, int i, double w) {
  double wi = SHB_TWO_PI * model->frequency[i];
  return 1 / CMPLX(wi * wi - w * w, 2 * model->damping_ratio[i] * wi * w);
}

/* Receptance over the contact dofs [nc][nc] and from contact to probes. */
static void dense_at(const modal_model *model, const mhb_settings *s, int k, double omega,
                     dense *d) {
  set_transform(model, s, k, d);
  double         w = k * omega / s->subharmonics;
  int            h = k % s->subharmonics == 0 ? k / s->subharmonics : 99, nc = d->nc;
  int            r_n             = model->n_residual;
  double complex r[MAX_C][MAX_C] = {{0}}, x[MAX_C] = {0}, rp[PROBE_DOFS][MAX_C] = {{0}};
  for (int a = 0; a < nc; a++) {
    if (model->load_residual && h <= model->n_load)
      x[a] = s->scale * loaded_by_hand(model, w, model->load_residual[h * nc + a],
                                       model->load_inertia[h * nc + a],
                                       r_n ? model->load_fourth[h * nc + a] : 0,
                                       r_n ? model->residual_shape + a * r_n : NULL,
                                       r_n ? model->residual_force + h * r_n : NULL);
    for (int b = 0; model->residual_flexibility && b < nc; b++)
      r[a][b] = residual_by_hand(model, w, a, b);
  }
  for (int q = 0; q < PROBE_DOFS; q++) {
    if (model->probe_load_residual && h <= model->n_load)
      d->probe_free[q] =
          s->scale * loaded_by_hand(model, w, model->probe_load_residual[h * PROBE_DOFS + q],
                                    model->probe_load_inertia[h * PROBE_DOFS + q],
                                    r_n ? model->probe_load_fourth[h * PROBE_DOFS + q] : 0,
                                    r_n ? model->residual_probe + q * r_n : NULL,
                                    r_n ? model->residual_force + h * r_n : NULL);
    for (int b = 0; model->probe_contact_residual && b < nc; b++) {
      double complex column[3] = {0};
      for (int i = 0; i < r_n; i++) column[i] = model->residual_shape[b * r_n + i];
      rp[q][b] = loaded_by_hand(model, w, model->probe_contact_residual[q * nc + b],
                                model->probe_contact_inertia[q * nc + b],
                                r_n ? model->probe_contact_fourth[q * nc + b] : 0,
                                r_n ? model->residual_probe + q * r_n : NULL, column);
    }
  }
  for (int i = 0; i < MODES; i++) {
    double complex L = modal_receptance(model, i, w),
                   F = h <= model->n_load ? s->scale * model->modal_force[h * MODES + i] : 0;
    for (int b = 0; b < nc; b++) {
      x[b] += shape(model, b, i) * L * F;
      for (int a = 0; a < nc; a++) r[a][b] += shape(model, a, i) * L * shape(model, b, i);
      for (int q = 0; q < PROBE_DOFS; q++)
        rp[q][b] += model->probe[q * MODES + i] * L * shape(model, b, i);
    }
    for (int q = 0; q < PROBE_DOFS; q++) d->probe_free[q] += model->probe[q * MODES + i] * L * F;
  }
  for (int i = 0; i < d->n; i++)
    for (int a = 0; a < nc; a++) {
      d->free[i] += d->T[i][a] * x[a];
      for (int q = 0; q < PROBE_DOFS; q++) d->probe_force[q][i] += rp[q][a] * conj(d->T[i][a]);
      for (int j = 0; j < d->n; j++)
        for (int b = 0; b < nc; b++) d->R[i][j] += d->T[i][a] * r[a][b] * conj(d->T[j][b]);
    }
}

static void random_force(int n, unsigned long long seed, double complex *p) {
  for (int i = 0; i < n; i++) {
    double re = random_unit(&seed), im = random_unit(&seed);
    p[i] = CMPLX(re, im);
  }
}

/* Largest errors of R, free and probe motion over the harmonics. */
static void compare(const modal_model *model, const mhb_settings *s, int top, double omega,
                    const char *where) {
  mhb_receptance *r;
  assert_int_equal(mhb_receptance_create(model, s, top, &r), SHB_OK);
  mhb_receptance_at(r, omega, top);
  double worst[3] = {0, 0, 0};
  for (int k = 0; k <= top; k++) {
    dense          d;
    double complex p[MAX_N], motion[PROBE_DOFS], u[MAX_N];
    dense_at(model, s, k, omega, &d);
    random_force(d.n, 5, p);
    mhb_receptance_probe(r, k, p, motion);
    mhb_receptance_motion(r, k, p, u);
    for (int i = 0; i < d.n; i++) {
      worst[1] = fmax(worst[1], cabs(r->free[k * d.n + i] - d.free[i]));
      u[i] -= d.free[i];
      for (int j = 0; j < d.n; j++) {
        worst[0] = fmax(worst[0], cabs(r->R[(k * d.n + i) * d.n + j] - d.R[i][j]));
        u[i] += d.R[i][j] * p[j];
      }
      worst[1] = fmax(worst[1], cabs(u[i]));
    }
    for (int q = 0; q < PROBE_DOFS; q++) {
      double complex wanted = d.probe_free[q];
      for (int i = 0; i < d.n; i++) wanted -= d.probe_force[q][i] * p[i];
      worst[2] = fmax(worst[2], cabs(motion[q] - wanted));
    }
  }
  print_message("%s: R %.1e, free %.1e, probes %.1e\n", where, worst[0], worst[1], worst[2]);
  for (int i = 0; i < 3; i++) assert_below_at(worst[i], 1e-13, where);
  mhb_receptance_destroy(r);
}

static void condensation_is_the_dense_sum(void **state) {
  (void)state;
  static const struct {
    const char *what;
    int         pairs, parts, ground, E, nu;
  } rows[] = {
      {"one pair, neighbour", 1, WITH_LEFT, 0, 1, 1},
      {"two pairs, residuals", 2, WITH_LEFT | WITH_RESIDUAL, 0, 4, 1},
      {"three pairs, normals", 3, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS | WITH_AREAS, 0, 2, 1},
      {"subharmonics", 2, WITH_LEFT | WITH_RESIDUAL, 0, 2, 2},
      {"residual modes", 2, WITH_LEFT | WITH_RESIDUAL | WITH_RESIDUAL_MODES, 0, 4, 1},
      {"residual modes, four pairs", 4, WITH_LEFT | WITH_RESIDUAL | WITH_RESIDUAL_MODES, 0, 2, 2},
      {"ground, left shapes there", 2, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS, 1, 3, 1},
      {"ground, no left shapes", 3, WITH_RESIDUAL, 1, 3, 2}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    modal_model  model;
    mhb_settings s = random_settings(3);
    random_model(rows[i].pairs, rows[i].parts, 11 + i, &model);
    s.to_ground    = rows[i].ground;
    s.engine_order = rows[i].E;
    s.subharmonics = rows[i].nu;
    s.scale        = 1.7;
    if (!(rows[i].parts & WITH_NORMALS)) {
      s.has_psi = s.has_phi = true;
      s.psi                 = .61;
      s.phi                 = -.23;
    }
    compare(&model, &s, 6, 1.07, rows[i].what);
    modal_model_free(&model);
  }
}

/* Twice the harmonics on the same residual matrices: the same numbers, and one copy of them. */
static void one_beside_another_has_the_same_numbers(void **state) {
  (void)state;
  modal_model     model;
  mhb_receptance *one, *beside, *alone;
  mhb_settings    s = random_settings(2);
  random_model(3, WITH_LEFT | WITH_RESIDUAL | WITH_RESIDUAL_MODES, 31, &model);
  assert_int_equal(mhb_receptance_create(&model, &s, 2, &one), SHB_OK);
  s.harmonics = 4;
  assert_int_equal(mhb_receptance_create_beside(one, &s, 4, &beside), SHB_OK);
  assert_int_equal(mhb_receptance_create(&model, &s, 4, &alone), SHB_OK);
  assert_ptr_equal(beside->residual_terms->contact[0], one->residual_terms->contact[0]);
  assert_ptr_not_equal(alone->residual_terms->contact[0], one->residual_terms->contact[0]);
  mhb_receptance_at(beside, 1.07, 4);
  mhb_receptance_at(alone, 1.07, 4);
  size_t n = (size_t)one->n;
  assert_memory_equal(beside->R, alone->R, 5 * n * n * sizeof(double complex));
  assert_memory_equal(beside->free, alone->free, 5 * n * sizeof(double complex));
  mhb_receptance_destroy(beside);
  mhb_receptance_at(one, 1.07, 2); /* its matrices are still there */
  assert_memory_equal(one->R, alone->R, 3 * n * n * sizeof(double complex));
  mhb_receptance_destroy(one);
  mhb_receptance_destroy(alone);
  modal_model_free(&model);
}

/* Receptances of the same model and axes use the residual matrices of one of them, with the same
 * numbers. Other axes, another model and contact to the ground have their own. */
static void receptances_alike_share_their_matrices(void **state) {
  (void)state;
  modal_model     model, other;
  mhb_receptance *lender, *alike, *alone, *apart;
  mhb_settings    s = random_settings(2), free = s;
  random_model(3, WITH_LEFT | WITH_RESIDUAL | WITH_RESIDUAL_MODES, 31, &model);
  random_model(3, WITH_LEFT | WITH_RESIDUAL | WITH_RESIDUAL_MODES, 31, &other);
  assert_ok(mhb_receptance_create(&model, &s, 0, &lender));
  s.alike = lender;
  assert_ok(mhb_receptance_create(&model, &s, 4, &alike));
  assert_ok(mhb_receptance_create(&model, &free, 4, &alone));
  const void *lent = lender->residual_terms->contact[0];
  assert_ptr_equal(alike->residual_terms->contact[0], lent);
  assert_ptr_not_equal(alone->residual_terms->contact[0], lent);
  mhb_receptance_at(alike, 1.07, 4);
  mhb_receptance_at(alone, 1.07, 4);
  const size_t n = (size_t)lender->n;
  assert_memory_equal(alike->R, alone->R, 5 * n * n * sizeof(double complex));
  mhb_receptance_destroy(alike);
  assert_ok(mhb_receptance_create(&model, &s, 4, &alike)); /* they are still there */
  mhb_receptance_at(alike, 1.07, 4);
  assert_memory_equal(alike->R, alone->R, 5 * n * n * sizeof(double complex));
  for (int i = 0; i < 3; i++) {
    mhb_settings differs = s;
    if (i == 0) differs.has_psi = true, differs.psi = 0.1;
    if (i == 1) differs.to_ground = true;
    assert_ok(mhb_receptance_create(i == 2 ? &other : &model, &differs, 1, &apart));
    assert_ptr_not_equal(apart->residual_terms->contact[0], lent);
    mhb_receptance_destroy(apart);
  }
  mhb_receptance_destroy(alike);
  mhb_receptance_destroy(alone);
  mhb_receptance_destroy(lender);
  modal_model_free(&model);
  modal_model_free(&other);
}

/* A model that has released its residual matrices works by those lent: the same bits, and the same
 * blocks of the structure in modal coordinates. Nobody else can use it. */
static void released_matrices_are_lent(void **state) {
  (void)state;
  for (int sides = 1; sides <= 2; sides++) {
    modal_model         model;
    mhb_receptance     *lender, *before, *after;
    mhb_modal_structure one, other;
    mhb_settings        s = random_settings(2);
    s.to_ground           = sides == 1;
    random_model(3, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS, 31, &model);
    assert_ok(mhb_receptance_create(&model, &s, 0, &lender));
    assert_ok(mhb_receptance_create(&model, &s, 4, &before));
    assert_ok(mhb_modal_structure_create(before, &s, 4, MHB_STRUCTURE_LEAN, &one));
    mhb_receptance_at(before, 1.07, 4);
    modal_model_release_terms(&model, 0);
    assert_null(model.residual_flexibility);
    assert_refused(mhb_receptance_create(&model, &s, 4, &after), SHB_ERR_INPUT, "released");
    s.alike = lender;
    assert_ok(mhb_receptance_create(&model, &s, 4, &after));
    assert_ok(mhb_modal_structure_create(after, &s, 4, MHB_STRUCTURE_LEAN, &other));
    mhb_receptance_at(after, 1.07, 4);
    const size_t n = (size_t)lender->n;
    assert_memory_equal(after->R, before->R, 5 * n * n * sizeof(double complex));
    assert_memory_equal(after->free, before->free, 5 * n * sizeof(double complex));
    for (size_t i = 0; i < 3 * n * n; i++) assert_near(other.block[i], one.block[i], 1e-14);
    mhb_modal_structure_destroy(&one);
    mhb_modal_structure_destroy(&other);
    mhb_receptance_destroy(before);
    mhb_receptance_destroy(after);
    mhb_receptance_destroy(lender);
    modal_model_free(&model);
  }
}

/* r_cc is complex symmetric, so that reversing the wave transposes R. It takes energy out:
 * Im p^H R p <= 0. */
static void receptance_is_reciprocal_and_passive(void **state) {
  (void)state;
  const char     *where = "reciprocity";
  modal_model     model;
  mhb_receptance *forward, *backward;
  mhb_settings    s = random_settings(3);
  random_model(3, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS, 3, &model);
  assert_int_equal(mhb_receptance_create(&model, &s, 3, &forward), SHB_OK);
  s.engine_order = 5; /* the same as -1 on 6 blades */
  assert_int_equal(mhb_receptance_create(&model, &s, 3, &backward), SHB_OK);
  mhb_receptance_at(forward, 1.3, 3);
  mhb_receptance_at(backward, 1.3, 3);
  int n = forward->n;
  for (int k = 0; k <= 3; k++) {
    const double complex *R = forward->R + k * n * n, *Q = backward->R + k * n * n;
    double                skew = 0;
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++) {
        assert_below_at(cabs(R[i * n + j] - Q[j * n + i]), 1e-13, where);
        skew = fmax(skew, cabs(R[i * n + j] - R[j * n + i]));
      }
    if (k % 3) assert_true(skew > 1e-3); /* the phase is there */
    for (unsigned long long trial = 0; trial < 50; trial++) {
      double complex p[MAX_N], work = 0;
      random_force(n, trial, p);
      for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) work += conj(p[i]) * R[i * n + j] * p[j];
      assert_below_at(cimag(work), k ? 0 : 1e-13, where);
    }
  }
  mhb_receptance_destroy(forward);
  mhb_receptance_destroy(backward);
  modal_model_free(&model);
}

/* free - R p of harmonic k at omega */
static void motion_under(mhb_receptance *r, int k, double omega, const double complex *p,
                         double complex *u) {
  mhb_receptance_at(r, omega, r->n_harmonics);
  for (int i = 0; i < r->n; i++) {
    u[i] = r->free[k * r->n + i];
    for (int j = 0; j < r->n; j++) u[i] -= r->R[(k * r->n + i) * r->n + j] * p[j];
  }
}

enum { MOTION, PROBE };

/* Either kind of output at (p + s dp, omega + s d_omega). */
static void output_at(mhb_receptance *r, int k, int kind, double s, const double complex *p,
                      const double complex *dp, double d_omega, double complex *out) {
  double complex moved[MAX_N];
  double         omega = 1.11 + s * d_omega;
  for (int i = 0; i < r->n; i++) moved[i] = p[i] + s * dp[i];
  if (kind == MOTION) {
    motion_under(r, k, omega, moved, out);
  } else {
    mhb_receptance_at(r, omega, r->n_harmonics);
    mhb_receptance_probe(r, k, moved, out);
  }
}

/* d output/ds, sixth order. */
static void difference(mhb_receptance *r, int k, int kind, const double complex *p,
                       const double complex *dp, double d_omega, double complex *slope) {
  static const double weight[] = {3. / 4, -3. / 20, 1. / 60}, h = 2e-4;
  double complex      out[MAX_N];
  int                 n = kind == MOTION ? r->n : PROBE_DOFS;
  for (int i = 0; i < n; i++) slope[i] = 0;
  for (int step = -3; step <= 3; step++) {
    if (step == 0) continue;
    output_at(r, k, kind, step * h, p, dp, d_omega, out);
    for (int i = 0; i < n; i++)
      slope[i] += (step > 0 ? 1 : -1) * weight[abs(step) - 1] * out[i] / h;
  }
}

static void slopes_are_derivatives(void **state) {
  (void)state;
  const char *where = "slopes";
  for (int trial = 0; trial < 4; trial++) {
    const int       nu = 1 + trial / 2, modes = trial % 2 ? WITH_RESIDUAL_MODES : 0;
    modal_model     model;
    mhb_receptance *r;
    mhb_settings    s = random_settings(3);
    s.subharmonics    = nu;
    s.engine_order    = 2;
    random_model(2, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS | modes, 21, &model);
    assert_int_equal(mhb_receptance_create(&model, &s, 5, &r), SHB_OK);
    for (int k = 0; k <= 5; k++) {
      double complex p[MAX_N], dp[MAX_N], zero[MAX_N] = {0}, exact[MAX_N], wanted[MAX_N];
      random_force(r->n, 1, p);
      random_force(r->n, 2, dp);
      difference(r, k, MOTION, p, zero, 1, wanted);
      mhb_receptance_at(r, 1.11, 5);
      mhb_receptance_slope(r, k, p, exact);
      double worst = 0, size = 1e-3;
      for (int i = 0; i < r->n; i++) {
        worst = fmax(worst, cabs(exact[i] - wanted[i]));
        size  = fmax(size, cabs(wanted[i]));
      }
      assert_below_at(worst / size, 1e-8, where);
      difference(r, k, PROBE, p, dp, .7, wanted);
      mhb_receptance_at(r, 1.11, 5);
      mhb_receptance_probe_change(r, k, p, dp, .7, 0, exact);
      worst = 0;
      for (int i = 0; i < PROBE_DOFS; i++) {
        worst = fmax(worst, cabs(exact[i] - wanted[i]));
        size  = fmax(size, cabs(wanted[i]));
      }
      assert_below_at(worst / size, 1e-8, where);
    }
    mhb_receptance_destroy(r);
    modal_model_free(&model);
  }
}

/* Subharmonics of order 2 at engine order 1. On 5 blades the neighbour lags by phi + 2 pi, so that
 * the lags of 5 blades add up to 12 pi. On 6 blades no lag closes. */
static void subharmonics_close_around_the_ring(void **state) {
  (void)state;
  modal_model     model;
  mhb_receptance *r;
  mhb_settings    s = random_settings(3);
  random_model(1, WITH_LEFT, 4, &model);
  s.subharmonics = 2;
  assert_int_equal(mhb_receptance_create(&model, &s, 3, &r), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "mhb.subharmonics"));
  s.to_ground = true;
  assert_int_equal(mhb_receptance_create(&model, &s, 3, &r), SHB_OK);
  mhb_receptance_destroy(r);
  s.to_ground = false;
  s.blades    = 5;
  assert_int_equal(mhb_receptance_create(&model, &s, 3, &r), SHB_OK);
  for (int k = 0; k <= 3; k++) { /* v of mode 0: right - e_k left, psi = phi = 0 */
    double complex e = (model.right[0] - r->B[k * r->n * r->n_modes]) / model.left[0];
    assert_true(cabs(cpow(e, 5) - 1) < 1e-12);
    if (k == 2) assert_true(cabs(e - cexp(-I * SHB_TWO_PI / 5)) < 1e-12); /* eq. 25 */
  }
  mhb_receptance_destroy(r);
  modal_model_free(&model);
}

static void expect_refusal(const modal_model *model, const mhb_settings *s, const char *wanted) {
  mhb_receptance *r = NULL;
  assert_int_equal(mhb_receptance_create(model, s, 3, &r), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), wanted));
  assert_null(r);
}

static void faults_are_named(void **state) {
  (void)state;
  modal_model     model;
  mhb_receptance *r;
  mhb_settings    s = random_settings(3);
  random_model(2, WITH_LEFT | WITH_NORMALS, 8, &model);
  assert_int_equal(mhb_receptance_create(&model, &s, 3, &r), SHB_OK);
  double psi = r->psi, phi = r->phi, degree = SHB_PI / 180;
  mhb_receptance_destroy(r);
  assert_true(fabs(psi - 35 * degree) < 4 * degree && fabs(phi - 10 * degree) < 4 * degree);
  s.has_psi = s.has_phi = true;
  s.psi                 = psi + .9 * degree + SHB_TWO_PI;
  s.phi                 = phi - .9 * degree;
  assert_int_equal(mhb_receptance_create(&model, &s, 3, &r), SHB_OK);
  mhb_receptance_destroy(r);
  s.psi = psi + 1.1 * degree;
  expect_refusal(&model, &s, "contact.psi is");
  s.psi = psi;
  s.phi = phi - 1.1 * degree;
  expect_refusal(&model, &s, "contact.phi is");
  modal_model_free(&model);
  random_model(2, 0, 8, &model);
  s.has_psi = s.has_phi = false;
  expect_refusal(&model, &s, "/contact/left");
  s.to_ground = true;
  assert_int_equal(mhb_receptance_create(&model, &s, 3, &r), SHB_OK);
  mhb_receptance_destroy(r);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(condensation_is_the_dense_sum),
      cmocka_unit_test(one_beside_another_has_the_same_numbers),
      cmocka_unit_test(receptances_alike_share_their_matrices),
      cmocka_unit_test(released_matrices_are_lent),
      cmocka_unit_test(receptance_is_reciprocal_and_passive),
      cmocka_unit_test(slopes_are_derivatives),
      cmocka_unit_test(subharmonics_close_around_the_ring),
      cmocka_unit_test(faults_are_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
