/* The balance of harmonics: derivatives against differences, linear limits, area shares, power, and
 * an explicit ring of blades without cyclic reduction. */
#include <lapacke.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/balance/balance.h"
#include "mhb/branches/main_branch.h"
#include "mhb/continuation/first_solution.h"
#include "mhb/numerics/fourier.h"
#include "tests/support/check.h"
#include "tests/support/complex_form.h"
#include "tests/support/random_model.h"

static mhb_balance *residual_of(const modal_model *model, const mhb_settings *s) {
  mhb_balance *b;
  if (mhb_balance_create(model, s, &b) != SHB_OK) fail_msg("%s", shb_message());
  mhb_balance_set_preload(b, s->n0[0]);
  return b;
}

static void random_motion(const mhb_balance *b, double size, unsigned long long seed, double *x) {
  for (int row = 0; row < 3 * b->n_pairs; row++)
    for (int i = 0; i < b->nb; i++) {
      int k              = (i + 1) / 2;
      x[row * b->nb + i] = size * random_unit(&seed) / (k ? k * k : 2);
    }
}

/* ---------------------------------------------------------------- derivatives */

/* d r/ds along (dx, d_omega), sixth order. */
static void difference(mhb_balance *b, const double *x, double omega, const double *dx,
                       double d_omega, double h, double *slope) {
  static const double weight[] = {3. / 4, -3. / 20, 1. / 60};
  double              moved[b->n], r[b->n];
  memset(slope, 0, sizeof(double) * (size_t)b->n);
  for (int step = -3; step <= 3; step++) {
    if (step == 0) continue;
    for (int i = 0; i < b->n; i++) moved[i] = x[i] + step * h * dx[i];
    mhb_balance_evaluate(b, moved, omega + step * h * d_omega, r, NULL, NULL);
    for (int i = 0; i < b->n; i++)
      slope[i] += (step > 0 ? 1 : -1) * weight[abs(step) - 1] * r[i] / h;
  }
}

/* Relative errors of Jacobian (worst column) and slope by omega at x. */
static void derivative_errors(mhb_balance *b, const double *x, double omega, double error[2]) {
  int     n    = b->n;
  double *J    = malloc(sizeof(double) * (size_t)n * (size_t)n), r[n], slope[n], wanted[n], unit[n];
  double  size = 0;
  mhb_balance_evaluate(b, x, omega, r, J, slope);
  memset(unit, 0, sizeof unit);
  for (int i = 0; i < n * n; i++) size = fmax(size, fabs(J[i]));
  error[0] = error[1] = 0;
  for (int j = 0; j < n; j++) {
    unit[j] = 1;
    difference(b, x, omega, unit, 0, 1e-5, wanted);
    unit[j] = 0;
    for (int i = 0; i < n; i++) error[0] = fmax(error[0], fabs(wanted[i] - J[j * n + i]) / size);
  }
  difference(b, x, omega, unit, 1, 1e-4, wanted);
  size = 0;
  for (int i = 0; i < n; i++) size = fmax(size, fabs(wanted[i]));
  for (int i = 0; i < n; i++) error[1] = fmax(error[1], fabs(wanted[i] - slope[i]) / size);
  free(J);
}

static void derivatives_are_exact(void **state) {
  (void)state;
  static const struct {
    int    pairs, ground, nu, preload;
    double n0, size;
  } rows[]       = {{1, 1, 1, MHB_EQUILIBRIUM, .5, .5},   {1, 0, 1, MHB_INTERFERENCE, .5, .5},
                    {1, 0, 2, MHB_EQUILIBRIUM, -.1, 1},   {3, 0, 1, MHB_EQUILIBRIUM, 1.2, .6},
                    {3, 1, 1, MHB_INTERFERENCE, 1.2, .6}, {3, 0, 1, MHB_INTERFERENCE, -.2, 1}};
  double most[3] = {0, 0, 0};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    modal_model  model;
    mhb_settings s = random_settings(4);
    random_model(rows[i].pairs, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS | WITH_AREAS, 31 + i,
                 &model);
    s.to_ground    = rows[i].ground;
    s.subharmonics = rows[i].nu;
    s.engine_order = 2;
    s.preload      = (mhb_preload)rows[i].preload;
    s.n0[0]        = rows[i].n0;
    mhb_balance *b = residual_of(&model, &s);
    double       x[b->n], error[2];
    random_motion(b, rows[i].size, 7 * i + 1, x);
    derivative_errors(b, x, 1.23, error);
    for (int a = 0; a < b->n_pairs; a++)
      for (int c = 0; c < 3; c++) most[c] = fmax(most[c], b->eval->info[a].share[c]);
    print_message(
        "%d pairs, n0 %4.1f: Jacobian %.1e, slope %.1e (pair 0: stuck %.2f slip %.2f open %.2f)\n",
        rows[i].pairs, rows[i].n0, error[0], error[1], b->eval->info[0].share[0],
        b->eval->info[0].share[1], b->eval->info[0].share[2]);
    assert_below(error[0], 1e-7);
    assert_below(error[1], 1e-8);
    mhb_balance_destroy(b);
    modal_model_free(&model);
  }
  for (int c = 0; c < 3; c++) assert_true(most[c] > .1); /* all three states were met */
}

/* The residual is a function of (x, omega) alone, to the last bit, whatever was evaluated
 * before. */
static void no_memory(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = random_settings(5);
  random_model(2, WITH_LEFT | WITH_RESIDUAL, 5, &model);
  mhb_balance *b = residual_of(&model, &s);
  size_t       n = (size_t)b->n, square = n * n;
  double       x[n], other[n], first[n], again[n], slope[2][n];
  double      *J = malloc(2 * square * sizeof(double));
  for (unsigned long long trial = 0; trial < 20; trial++) {
    random_motion(b, .3 + .1 * (double)trial, 2 * trial, x);
    random_motion(b, 1, 2 * trial + 1, other);
    mhb_balance_evaluate(b, x, 1.1, first, J, slope[0]);
    mhb_balance_evaluate(b, other, 1.4, again, J + square, NULL);
    mhb_balance_evaluate(b, x, 1.1, again, J + square, slope[1]);
    assert_memory_equal(first, again, sizeof first);
    assert_memory_equal(slope[0], slope[1], sizeof slope[0]);
    assert_memory_equal(J, J + square, square * sizeof(double));
  }
  free(J);
  mhb_balance_destroy(b);
  modal_model_free(&model);
}

/* ---------------------------------------------------------------- linear limits, shares */

static double relative_residual(mhb_balance *b, const double *x, double omega) {
  double r[b->n];
  mhb_balance_evaluate(b, x, omega, r, NULL, NULL);
  return mhb_norm(r, b->n) / mhb_norm(x, b->n);
}

static void linear_limits_solve_the_residual(void **state) {
  (void)state;
  for (int pairs = 1; pairs <= 3; pairs++)
    for (int preload = 0; preload < 2; preload++)
      for (int stuck = 0; stuck < 2; stuck++) {
        modal_model  model;
        mhb_settings s = random_settings(4);
        random_model(pairs, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS | WITH_AREAS, 41, &model);
        s.preload      = (mhb_preload)preload;
        s.n0[0]        = stuck ? 1e3 : -1e3;
        mhb_balance *b = residual_of(&model, &s);
        double       x[b->n];
        assert_int_equal(mhb_balance_linear_limit(b, .93, stuck, x), SHB_OK);
        double error = relative_residual(b, x, .93);
        for (int a = 0; a < pairs; a++) {
          int wanted = stuck ? MHB_STICK : MHB_SEPARATE;
          assert_true(b->eval->info[a].share[wanted] == 1);
        }
        assert_below(error, 1e-12);
        mhb_balance_destroy(b);
        modal_model_free(&model);
      }
}

/* The pair of model, four times over. */
static void repeat_pair(const modal_model *one, modal_model *four) {
  int m = one->n_modes, nc = 24, loads = one->n_load + 1, q = 3 * one->n_probes;
  random_model(4, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS, 1, four);
  memcpy(four->frequency, one->frequency, sizeof(double) * (size_t)m);
  memcpy(four->damping_ratio, one->damping_ratio, sizeof(double) * (size_t)m);
  memcpy(four->modal_force, one->modal_force, sizeof(double complex) * (size_t)(m * loads));
  memcpy(four->probe, one->probe, sizeof(double) * (size_t)(q * m));
  memcpy(four->probe_load_residual, one->probe_load_residual,
         sizeof(double complex) * (size_t)(loads * q));
  memcpy(four->probe_load_inertia, one->probe_load_inertia,
         sizeof(double complex) * (size_t)(loads * q));
  for (int a = 0; a < 4; a++) {
    memcpy(four->right + 3 * a * m, one->right, sizeof(double) * 3 * (size_t)m);
    memcpy(four->left + 3 * a * m, one->left, sizeof(double) * 3 * (size_t)m);
    memcpy(four->normal + 3 * a, one->normal, sizeof(double) * 3);
  }
  for (int i = 0; i < nc; i++) {
    int from = i / 12 * 3 + i % 3;
    for (int k = 0; k < loads; k++) {
      four->load_residual[k * nc + i] = one->load_residual[k * 6 + from];
      four->load_inertia[k * nc + i]  = one->load_inertia[k * 6 + from];
    }
    for (int s = 0; s < q; s++) {
      four->probe_contact_residual[s * nc + i] = one->probe_contact_residual[s * 6 + from];
      four->probe_contact_inertia[s * nc + i]  = one->probe_contact_inertia[s * 6 + from];
    }
    for (int j = 0; j < nc; j++) {
      int to                                 = j / 12 * 3 + j % 3;
      four->residual_flexibility[i * nc + j] = one->residual_flexibility[from * 6 + to];
      four->residual_inertia[i * nc + j]     = one->residual_inertia[from * 6 + to];
      four->residual_fourth[i * nc + j]      = one->residual_fourth[from * 6 + to];
    }
  }
}

static void equal_pairs_share_the_totals(void **state) {
  (void)state;
  modal_model  one, four;
  mhb_settings s = random_settings(3);
  random_model(1, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS, 77, &one);
  repeat_pair(&one, &four);
  mhb_balance   *a = residual_of(&one, &s), *b = residual_of(&four, &s);
  double         x[a->n], y[b->n], r[a->n], q[b->n], dissipation = 0;
  double complex p[12], motion[2][6];
  random_motion(a, .8, 3, x);
  for (int i = 0; i < b->n; i++) y[i] = x[i % a->n];
  mhb_balance_evaluate(a, x, 1.2, r, NULL, NULL);
  mhb_balance_evaluate(b, y, 1.2, q, NULL, NULL);
  for (int i = 0; i < b->n; i++) assert_below(fabs(q[i] - r[i % a->n]), 1e-12);
  for (int i = 0; i < 4; i++) dissipation += b->eval->info[i].dissipation;
  assert_true(dissipation > 1e-3);
  assert_below(fabs(dissipation / a->eval->info[0].dissipation - 1), 1e-12);
  mhb_balance_contact_force(a, 1, p);
  mhb_receptance_probe(a->receptance, 1, p, motion[0]);
  mhb_balance_contact_force(b, 1, p);
  mhb_receptance_probe(b->receptance, 1, p, motion[1]);
  for (int i = 0; i < 6; i++) assert_below(cabs(motion[0][i] - motion[1][i]), 1e-12);
  mhb_balance_destroy(a);
  mhb_balance_destroy(b);
  modal_model_free(&one);
  modal_model_free(&four);
}

/* ---------------------------------------------------------------- the whole ring */

enum { BLADES = 6, PAIRS = 2, SIDE = 3 * PAIRS, DOFS = 2 * SIDE, ALL = BLADES * DOFS };

/* One blade at harmonic k, by hand: receptance over its contact dofs, response to blade 0's load,
 * axes. */
typedef struct {
  double complex H[DOFS][DOFS], load[DOFS];
  double         axes[PAIRS][3][3]; /* rows v, u, w */
} blade;

static void blade_at(const modal_model *model, int k, double omega, int nu, blade *out) {
  int    h = k % nu == 0 && k / nu <= model->n_load ? k / nu : -1, m = model->n_modes;
  double w = k * omega / nu;
  memset(out, 0, sizeof *out);
  for (int pair = 0; pair < PAIRS; pair++) {
    double *v = out->axes[pair][0], *u = out->axes[pair][1], *t = out->axes[pair][2];
    memcpy(v, model->normal + 3 * pair, 3 * sizeof(double));
    double across = hypot(v[0], v[1]);
    u[0]          = -v[1] / across;
    u[1]          = v[0] / across;
    t[0]          = -v[2] * u[1];
    t[1]          = v[2] * u[0];
    t[2]          = v[0] * u[1] - v[1] * u[0];
  }
  for (int a = 0; a < DOFS; a++) {
    if (h >= 0)
      out->load[a] = model->load_residual[h * DOFS + a] + w * w * model->load_inertia[h * DOFS + a];
    for (int b = 0; b < DOFS; b++) out->H[a][b] = residual_by_hand(model, w, a, b);
  }
  for (int i = 0; i < m; i++) {
    double         wi = SHB_TWO_PI * model->frequency[i], shape[DOFS];
    double complex L  = 1 / CMPLX(wi * wi - w * w, 2 * model->damping_ratio[i] * wi * w);
    for (int a = 0; a < DOFS; a++)
      shape[a] = a < SIDE ? model->right[a * m + i] : model->left[(a - SIDE) * m + i];
    for (int a = 0; a < DOFS; a++) {
      if (h >= 0) out->load[a] += shape[a] * L * model->modal_force[h * m + i];
      for (int b = 0; b < DOFS; b++) out->H[a][b] += shape[a] * L * shape[b];
    }
  }
}

/* Forces p[SIDE] (v, u, w) that press interface b: on blade b's right -p, on blade b + 1's left +p,
 * as f[blade][dof]. */
static void add_interface(const blade *one, int b, const double complex *p,
                          double complex (*f)[DOFS]) {
  int next = (b + 1) % BLADES;
  for (int pair = 0; pair < PAIRS; pair++)
    for (int c = 0; c < 3; c++)
      for (int i = 0; i < 3; i++) {
        f[b][3 * pair + i] -= one->axes[pair][c][i] * p[3 * pair + c];
        f[next][SIDE + 3 * pair + i] += one->axes[pair][c][i] * p[3 * pair + c];
      }
}

/* Relative motion (v, u, w) across interface b. */
static void across(const blade *one, int b, double complex (*x)[DOFS], double complex *u) {
  int next = (b + 1) % BLADES;
  for (int pair = 0; pair < PAIRS; pair++)
    for (int c = 0; c < 3; c++) {
      u[3 * pair + c] = 0;
      for (int i = 0; i < 3; i++)
        u[3 * pair + c] +=
            one->axes[pair][c][i] * (x[b][3 * pair + i] - x[next][SIDE + 3 * pair + i]);
    }
}

/* Motion of all contact dofs under the travelling load and f. Blade b meets at phase theta what
 * blade 0 met at theta - b phi. */
static void ring_motion(const blade *one, double phase, double complex (*f)[DOFS],
                        double complex (*x)[DOFS]) {
  for (int b = 0; b < BLADES; b++)
    for (int a = 0; a < DOFS; a++) {
      x[b][a] = one->load[a] * cexp(-I * b * phase);
      for (int c = 0; c < DOFS; c++) x[b][a] += one->H[a][c] * f[b][c];
    }
}

/* Spring force of a stuck pair; by convention without mean friction. */
static void spring(const mhb_law *law, int mean, const double complex *u, double complex *p) {
  p[0] = law->kv * u[0];
  p[1] = p[2] = 0;
  if (mean) return;
  p[1] = law->ku[0] * u[1] + law->ku[1] * u[2];
  p[2] = law->ku[1] * u[1] + law->ku[2] * u[2];
}

/* The ring with all interfaces stuck: x = load + H f(x) + H f0 as one dense system; preload[pair]:
 * force at rest. */
static void solve_stuck_ring(const blade *one, const mhb_law *law, double phase, int mean,
                             double complex (*x)[DOFS]) {
  static double complex A[ALL][ALL]; /* column-major */
  double complex        none[BLADES][DOFS], f[BLADES][DOFS], base[BLADES][DOFS], u[SIDE], p[SIDE];
  lapack_int            pivot[ALL];
  blade                 unloaded = *one;
  memset(unloaded.load, 0, sizeof unloaded.load);
  memset(f, 0, sizeof f);
  for (int b = 0; mean && b < BLADES; b++) {
    for (int i = 0; i < SIDE; i++) p[i] = i % 3 ? 0 : law[i / 3].n0 - law[i / 3].mean_offset;
    add_interface(one, b, p, f);
  }
  ring_motion(one, phase, f, x);
  for (int j = 0; j < ALL; j++) { /* column j: e_j - H f(e_j) */
    memset(none, 0, sizeof none);
    memset(f, 0, sizeof f);
    none[j / DOFS][j % DOFS] = 1;
    for (int b = 0; b < BLADES; b++) {
      across(one, b, none, u);
      for (int pair = 0; pair < PAIRS; pair++) spring(&law[pair], mean, u + 3 * pair, p + 3 * pair);
      add_interface(one, b, p, f);
    }
    ring_motion(&unloaded, phase, f, base);
    for (int i = 0; i < ALL; i++) A[j][i] = none[i / DOFS][i % DOFS] - base[i / DOFS][i % DOFS];
  }
  assert_int_equal(LAPACKE_zgesv(LAPACK_COL_MAJOR, ALL, 1, &A[0][0], ALL, pivot, &x[0][0], ALL), 0);
}

static void ring_model(modal_model *model) {
  random_model(PAIRS, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS | WITH_AREAS, 55, model);
}

/* Engine orders 0 to 3 in turn on six blades; 7 is an alias of 1, -1 travels the other way. */
static void stuck_ring_is_the_sector(void **state) {
  (void)state;
  static const int order[] = {0, 1, 2, 3, 4, 7, -1};
  modal_model      model;
  ring_model(&model);
  for (size_t e = 0; e < sizeof order / sizeof *order; e++)
    for (int preload = 0; preload < 2; preload++) {
      mhb_settings s = random_settings(2);
      s.engine_order = order[e];
      s.preload      = (mhb_preload)preload;
      s.n0[0]        = 50;
      mhb_balance *b = residual_of(&model, &s);
      double       x[b->n], worst = 0, size = 0;
      assert_int_equal(mhb_balance_linear_limit(b, 1.17, 1, x), SHB_OK);
      for (int k = 0; k <= 2; k++) {
        blade          one;
        double complex motion[BLADES][DOFS], u[SIDE];
        double         phase = SHB_TWO_PI * order[e] / BLADES * k;
        blade_at(&model, k, 1.17, 1, &one);
        solve_stuck_ring(&one, b->law, phase, k == 0, motion);
        for (int blade_no = 0; blade_no < BLADES; blade_no++) {
          across(&one, blade_no, motion, u);
          for (int i = 0; i < SIDE; i++) {
            double        *a      = x + i * b->nb;
            double complex sector = k ? CMPLX(a[2 * k - 1], a[2 * k]) : a[0];
            worst                 = fmax(worst, cabs(u[i] - sector * cexp(-I * phase * blade_no)));
            size                  = fmax(size, cabs(sector));
          }
        }
      }
      print_message("E %2d: ring against sector %.1e\n", order[e], worst / size);
      assert_below(worst / size, 1e-10);
      mhb_balance_destroy(b);
    }
  modal_model_free(&model);
}

/* Sector motion x shifted in time to interface b, and the law's force there. */
static void force_at_interface(const mhb_balance *b, const double *x, double phase, int blade_no,
                               double *moved, double *p) {
  int block = 3 * b->nb;
  for (int row = 0; row < 3 * b->n_pairs; row++) {
    double complex A[b->m + 1];
    to_complex(b->m, x + row * b->nb, A);
    for (int k = 0; k <= b->m; k++) A[k] *= cexp(-I * k * phase * blade_no);
    mhb_to_real(b->m, A, moved + row * b->nb);
  }
  mhb_contact_info info;
  for (int a = 0; a < b->n_pairs; a++)
    mhb_contact_force(b->contact, &b->law[a], moved + a * block, p + a * block, NULL, &info);
}

/* error[0]: largest difference at any interface between the ring's residual and the shifted one of
 * the sector. error[1]: the ring's residual u - u(x(load, p(u))) itself. Every interface's force is
 * evaluated by itself. */
static void ring_errors(mhb_balance *b, const modal_model *model, const double *x, double omega,
                        double error[2]) {
  const mhb_settings *s     = b->settings;
  double              phase = SHB_TWO_PI * s->engine_order / s->blades / s->subharmonics;
  double              r[b->n], moved[BLADES][b->n], p[BLADES][b->n];
  mhb_balance_evaluate(b, x, omega, r, NULL, NULL);
  for (int i = 0; i < BLADES; i++) force_at_interface(b, x, phase, i, moved[i], p[i]);
  error[0] = error[1] = 0;
  for (int k = 0; k <= b->m; k++) {
    blade          one;
    double complex f[BLADES][DOFS], motion[BLADES][DOFS], pk[SIDE], u[SIDE];
    memset(f, 0, sizeof f);
    blade_at(model, k, omega, s->subharmonics, &one);
    int re = k ? 2 * k - 1 : 0, im = 2 * k;
    for (int i = 0; i < BLADES; i++) {
      for (int c = 0; c < SIDE; c++)
        pk[c] = CMPLX(p[i][c * b->nb + re], k ? p[i][c * b->nb + im] : 0);
      add_interface(&one, i, pk, f);
    }
    ring_motion(&one, k * phase, f, motion);
    for (int i = 0; i < BLADES; i++) {
      across(&one, i, motion, u);
      for (int c = 0; c < SIDE; c++) {
        int            at   = c * b->nb;
        double complex ring = CMPLX(moved[i][at + re], k ? moved[i][at + im] : 0) - u[c];
        double complex here = CMPLX(r[at + re], k ? r[at + im] : 0) * cexp(-I * k * phase * i);
        error[0]            = fmax(error[0], cabs(ring - here));
        error[1]            = fmax(error[1], cabs(ring));
      }
    }
  }
}

/* Any motion, solution or not, subharmonics too. */
static void slipping_ring_is_the_sector(void **state) {
  (void)state;
  static const struct {
    int E, nu;
  } rows[] = {{0, 1}, {1, 1}, {2, 1}, {3, 1}, {-2, 1}, {0, 2}, {2, 2}, {3, 3}};
  modal_model model;
  ring_model(&model);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    mhb_settings s = random_settings(5);
    s.engine_order = rows[i].E;
    s.subharmonics = rows[i].nu;
    s.n0[0]        = .6;
    mhb_balance *b = residual_of(&model, &s);
    double       x[b->n], error[2];
    random_motion(b, .6, i, x);
    ring_errors(b, &model, x, 1.17, error);
    print_message("E %2d, nu %d: ring against sector %.1e\n", rows[i].E, rows[i].nu, error[0]);
    assert_below(error[0], 5e-8); /* the law itself is asked for 1e-8 */
    mhb_balance_destroy(b);
  }
  modal_model_free(&model);
}

/* ---------------------------------------------------------------- solutions */

/* Mean power into the blade from the load, less what its modes and the friction take; relative to
 * the first. */
static double power_imbalance(const mhb_balance *b, double omega) {
  const mhb_receptance *r     = b->receptance;
  const modal_model    *model = r->model;
  double                in = 0, damping = 0, friction = 0;
  int                   m = r->n_modes;
  for (int k = 1; k <= b->m; k++) {
    double         w = k * omega / r->nu;
    double complex p[r->n], residual = 0;
    mhb_balance_contact_force(b, k, p);
    for (int i = 0; i < m; i++) {
      double         wi = SHB_TWO_PI * model->frequency[i];
      double complex F = r->F[k * m + i], drive = F;
      for (int row = 0; row < r->n; row++) drive -= conj(r->B[(k * r->n + row) * m + i]) * p[row];
      double complex q = drive / CMPLX(wi * wi - w * w, 2 * model->damping_ratio[i] * wi * w);
      in += .5 * creal(conj(F) * I * w * q);
      damping += model->damping_ratio[i] * wi * w * w * creal(q * conj(q));
    }
    const mhb_residual_terms *left = r->residual_terms;
    for (int row = 0; left->load[0] && row < r->n; row++)
      residual +=
          conj(left->load[0][k * r->n + row] + w * w * left->load[1][k * r->n + row]) * p[row];
    in -= .5 * creal(I * w * residual);
  }
  for (int a = 0; a < b->n_pairs; a++)
    friction += b->eval->info[a].dissipation * omega / (SHB_TWO_PI * r->nu);
  assert_true(friction > 1e-3 * in);
  return fabs(in - damping - friction) / in;
}

/* At solutions that slip: every interface of the ring is in balance, and no power is lost. */
static void solutions_balance_forces_and_power(void **state) {
  (void)state;
  static const struct {
    int    E, preload;
    double n0, omega, scale;
  } rows[] = {{0, MHB_EQUILIBRIUM, .1, 1.12, 1},  {1, MHB_EQUILIBRIUM, .1, 1.2, 1},
              {2, MHB_EQUILIBRIUM, .05, 1.3, 1},  {3, MHB_EQUILIBRIUM, .1, 1.4, 1.5},
              {1, MHB_INTERFERENCE, .2, 1.35, 2}, {2, MHB_EQUILIBRIUM, -.01, 1.1, 2}};
  modal_model model;
  ring_model(&model);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    mhb_newton  *newton;
    mhb_settings s = random_settings(7);
    s.engine_order = rows[i].E;
    s.preload      = (mhb_preload)rows[i].preload;
    s.n0[0]        = rows[i].n0;
    mhb_balance *b = residual_of(&model, &s);
    newton         = mhb_newton_create(b->n);
    double x[b->n], error[2];
    int    iterations;
    assert_int_equal(mhb_first_solution(newton, b, rows[i].omega, 1e-12, x, &iterations),
                     MHB_CONVERGED);
    ring_errors(b, &model, x, rows[i].omega, error);
    double size = mhb_norm(x, b->n);
    mhb_balance_evaluate(b, x, rows[i].omega, newton->r, NULL, NULL);
    double lost = power_imbalance(b, rows[i].omega);
    print_message(
        "E %d n0 %5.2f: ring's balance %.1e, power %.1e (pair 0: stuck %.2f slip %.2f open %.2f)\n",
        rows[i].E, rows[i].n0, error[1] / size, lost, b->eval->info[0].share[0],
        b->eval->info[0].share[1], b->eval->info[0].share[2]);
    assert_below(error[1] / size, 1e-8);
    assert_below(lost, 1e-8);
    mhb_newton_destroy(newton);
    mhb_balance_destroy(b);
  }
  modal_model_free(&model);
}

/* ---------------------------------------------------------------- evaluations */

/* Two points with evaluations of their own: each keeps force, derivative and laws of its own. */
static void points_own_their_evaluations(void **state) {
  (void)state;
  modal_model model;
  random_model(2, WITH_LEFT | WITH_RESIDUAL, 11, &model);
  mhb_settings    s = random_settings(3);
  mhb_balance    *b = residual_of(&model, &s);
  mhb_evaluation *second;
  mhb_balance_set_parameter(b, MHB_IN_N0);
  int     n = b->n, block = 3 * b->nb;
  size_t  size = (size_t)b->n_pairs * (size_t)block * (size_t)block * sizeof(double);
  double  x[n], y[n], r[n], again[n], n0 = s.n0[0];
  double *dp = malloc(size), *J = malloc(sizeof(double[n]) * (size_t)n),
         *K = malloc(sizeof(double[n]) * (size_t)n);
  random_motion(b, 0.8, 3, x);
  random_motion(b, 1.1, 4, y);
  mhb_balance_evaluate(b, x, n0, r, J, NULL);
  memcpy(dp, b->eval->dp, size);

  second = mhb_evaluation_create(b);
  mhb_balance_use(b, second);
  mhb_balance_evaluate(b, y, 1.7 * n0, again, K, NULL);
  assert_memory_not_equal(dp, b->eval->dp, size);
  assert_true(b->law[0].n0 == b->receptance->share[0] * (1.7 * n0));

  mhb_balance_use(b, NULL);
  assert_true(b->law[0].n0 == b->receptance->share[0] * n0 && b->eval->at.n0 == n0);
  assert_memory_equal(dp, b->eval->dp, size);
  mhb_balance_evaluate(b, x, n0, again, K, NULL);
  assert_memory_equal(r, again, sizeof r);
  assert_memory_equal(J, K, sizeof(double[n]) * (size_t)n);
  free(dp);
  free(J);
  free(K);
  mhb_evaluation_destroy(second);
  mhb_balance_destroy(b);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(derivatives_are_exact),
      cmocka_unit_test(no_memory),
      cmocka_unit_test(points_own_their_evaluations),
      cmocka_unit_test(linear_limits_solve_the_residual),
      cmocka_unit_test(equal_pairs_share_the_totals),
      cmocka_unit_test(stuck_ring_is_the_sector),
      cmocka_unit_test(slipping_ring_is_the_sector),
      cmocka_unit_test(solutions_balance_forces_and_power),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
