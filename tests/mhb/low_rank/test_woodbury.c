/* The low-rank solver has the solution and the sign of the dense one; its products are those with
 * the receptance. */
#include <lapacke.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/balance/balance.h"
#include "mhb/low_rank/lone_harmonics.h"
#include "mhb/low_rank/woodbury.h"
#include "mhb/numerics/vector.h"
#include "tests/support/check.h"
#include "tests/support/random_disc.h"
#include "tests/support/random_model.h"
#include "tests/support/shroud_face.h"

enum { M = 3, NB = 2 * M + 1 };

static void random_vector(int n, double size, unsigned long long seed, double *x) {
  for (int i = 0; i < n; i++) x[i] = size * random_unit(&seed);
}

static double difference(const double *a, const double *b, int n) {
  double worst = 0;
  for (int i = 0; i < n; i++) worst = fmax(worst, fabs(a[i] - b[i]));
  return worst / mhb_norm(b, n);
}

static void create(const modal_model *model, const mhb_settings *s, mhb_balance **b) {
  if (mhb_balance_create(model, s, b) != SHB_OK) fail_msg("%s", shb_message());
  mhb_balance_set_preload(*b, s->n0[0]);
}

static void stiffness_of(const mhb_balance *b, double *stiffness) {
  for (int a = 0; a < b->n_pairs; a++) {
    stiffness[3 * a]     = b->law[a].kv;
    stiffness[3 * a + 1] = b->law[a].ku[0];
    stiffness[3 * a + 2] = b->law[a].ku[2];
  }
}

/* ---------------------------------------------------------------- products */

/* What a coarse product leaves out, |S^1/2 (out - wanted)|/|S^-1/2 p|. */
static double leaves_out(mhb_receptance_product *product, mhb_product_kind kind, double coarse,
                         const double *p, const double *wanted, const double *stiffness,
                         double *out) {
  double of = 0, force = 0;
  mhb_receptance_product_apply(product, kind, coarse, p, out);
  for (int i = 0; i < product->n; i++)
    for (int j = i * product->nb; j < (i + 1) * product->nb; j++) {
      of += stiffness[i] * (out[j] - wanted[j]) * (out[j] - wanted[j]);
      force += p[j] * p[j] / stiffness[i];
    }
  return sqrt(of / force);
}

/* Each harmonic alone has its columns of the product of all. */
static void check_harmonics(const mhb_receptance_product *product, const double *p,
                            const double *whole) {
  const int      nb = product->nb, n = product->n;
  double complex force[n], motion[n];
  for (int k = 0; k <= product->m; k++) {
    const int at   = mhb_product_column(product, k);
    double    away = 0, size = 0;
    for (int i = 0; i < n; i++) force[i] = CMPLX(p[i * nb + at], k ? p[i * nb + at + 1] : 0);
    mhb_receptance_product_of_harmonic(product, k, force, motion);
    for (int i = 0; i < n; i++) {
      const double complex of = CMPLX(whole[i * nb + at], k ? whole[i * nb + at + 1] : 0);
      away                    = fmax(away, cabs(motion[i] - of));
      size                    = fmax(size, cabs(of));
    }
    assert_below(away, 1e-13 * size);
  }
}

/* Both products against R and against the slope of the motion. */
static void check_product(const modal_model *model, const mhb_settings *s, double omega,
                          int is_smooth) {
  mhb_balance            *b;
  mhb_receptance_product *product;
  create(model, s, &b);
  int             n3 = 3 * b->n_pairs, n = b->n;
  double         *p = calloc((size_t)n, sizeof(double)), *out = calloc((size_t)n, sizeof(double));
  double         *wanted = calloc((size_t)n, sizeof(double)), stiffness[n3];
  double complex *force  = calloc((size_t)n3, sizeof *force),
                 *motion = calloc((size_t)n3, sizeof *motion);
  stiffness_of(b, stiffness);
  product = mhb_receptance_product_create(b->receptance, 0, b->m, stiffness, omega);
  assert_int_equal(product->U != NULL, is_smooth);
  random_vector(n, 1, 3, p);
  mhb_receptance_at(b->receptance, omega, b->m);
  mhb_receptance_product_update(product);
  for (mhb_product_kind kind = 0; kind < MHB_PRODUCTS; kind++) {
    for (int k = 0; k <= b->m; k++) {
      const double complex *R = b->receptance->R + (size_t)k * (size_t)(n3 * n3);
      for (int i = 0; i < n3; i++)
        force[i] = k ? CMPLX(p[i * b->nb + 2 * k - 1], p[i * b->nb + 2 * k]) : p[i * b->nb];
      if (kind == MHB_PRODUCT_SLOPE) {
        double complex load[n3];
        mhb_receptance_slope(b->receptance, k, force, motion);
        mhb_receptance_slope(b->receptance, k, NULL, load);
        for (int i = 0; i < n3; i++) motion[i] = load[i] - motion[i];
      }
      for (int i = 0; i < n3; i++) {
        double complex sum = 0;
        for (int j = 0; j < n3; j++) sum += R[i * n3 + j] * force[j];
        if (kind == MHB_PRODUCT_SLOPE) sum = motion[i];
        wanted[i * b->nb + (k ? 2 * k - 1 : 0)] = creal(sum);
        if (k) wanted[i * b->nb + 2 * k] = cimag(sum);
      }
    }
    mhb_receptance_product_apply(product, kind, 0, p, out);
    print_message("%d pairs, smooth %d, kind %d: %.1e\n", b->n_pairs, product->n_smooth, (int)kind,
                  difference(out, wanted, n));
    assert_below(difference(out, wanted, n), 1e-11);
    if (kind == MHB_PRODUCT_VALUE) check_harmonics(product, p, out);
    for (double coarse = 1e-8; coarse < 1e-3; coarse *= 100) {
      const double left = leaves_out(product, kind, coarse, p, wanted, stiffness, out);
      print_message("  allowed %.0e: %.1e\n", coarse, left);
      assert_below(left, 3 * coarse);
    }
  }
  mhb_receptance_product_destroy(product);
  mhb_balance_destroy(b);
  free(p);
  free(out);
  free(wanted);
  free(force);
  free(motion);
}

static void products_are_those_of_R(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = random_settings(M);
  random_model(9, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS | WITH_AREAS, 5, &model);
  check_product(&model, &s, 1.2, 0);
  modal_model_free(&model);
  random_model(9, WITH_LEFT | WITH_RESIDUAL | WITH_RESIDUAL_MODES, 6, &model);
  check_product(&model, &s, 1.1, 0);
  modal_model_free(&model);
  s = shroud_face_settings(M);
  shroud_face_model(12, 150, &model);
  check_product(&model, &s, SHB_TWO_PI * 255, 0);
  modal_model_free(&model);
}

/* The same of a disc: without and with Coriolis terms, forwards and backwards, random and
 * smooth. */
static void products_of_a_disc(void **state) {
  (void)state;
  enum { BLADES = 6 };
  modal_nodal_diameters disc;
  modal_model           face;
  mhb_settings          s = random_settings(M);
  for (int i = 0; i < 4; i++) {
    const int parts = WITH_LEFT | WITH_RESIDUAL | (i % 2 ? WITH_RESIDUAL_MODES : WITH_NORMALS);
    random_disc(9, BLADES, parts, i >= 2, 5, &disc);
    s.nodal_diameters = &disc;
    s.engine_order    = i % 2 ? 5 : 1;
    check_product(&disc.model[0], &s, 1.2, 0);
    modal_nodal_diameters_free(&disc);
  }
  s = shroud_face_settings(M);
  shroud_face_model(12, 150, &face);
  face_disc(&face, BLADES, 0, &disc);
  modal_model_free(&face);
  s.nodal_diameters = &disc;
  s.blades          = BLADES;
  s.engine_order    = 1;
  check_product(&disc.model[0], &s, SHB_TWO_PI * 255, 1);
  modal_nodal_diameters_free(&disc);
}

/* A free response made without R is that made with it. */
static void load_without_R(void **state) {
  (void)state;
  modal_model     model;
  mhb_settings    s = random_settings(M);
  mhb_receptance *one, *other;
  random_model(9, WITH_LEFT | WITH_RESIDUAL | WITH_RESIDUAL_MODES, 6, &model);
  assert_int_equal(mhb_receptance_create(&model, &s, M, &one), SHB_OK);
  assert_int_equal(mhb_receptance_create(&model, &s, M, &other), SHB_OK);
  mhb_receptance_at(one, 1.3, M);
  mhb_receptance_set_frequency(other, 1.3);
  for (int k = 0; k <= M; k++) mhb_receptance_update_load(other, k);
  for (int i = 0; i < (M + 1) * one->n; i++)
    assert_below(cabs(one->free[i] - other->free[i]), 1e-13 * (cabs(one->free[i]) + 1));
  mhb_receptance_at(other, 1.3, M); /* R of 1.3, then the load alone elsewhere, then back */
  mhb_receptance_set_frequency(other, 1.1);
  for (int k = 0; k <= M; k++) mhb_receptance_update_load(other, k);
  mhb_receptance_at(other, 1.3, M);
  for (int i = 0; i < (M + 1) * one->n_modes; i++)
    assert_below(cabs(one->lambda[i] - other->lambda[i]), 1e-13 * (cabs(one->lambda[i]) + 1));
  mhb_receptance_destroy(one);
  mhb_receptance_destroy(other);
  modal_model_free(&model);
}

/* ---------------------------------------------------------------- solutions */

/* rhs <- solution by LU of [J column; row]; returns the sign of the determinant. */
static int solve_whole(int n, const double *J, const double *column, const double *row, double *x) {
  int     one = n + (column != NULL), sign = 1;
  int    *pivot = calloc((size_t)one, sizeof(int));
  double *A     = calloc((size_t)one * (size_t)one, sizeof(double));
  for (int j = 0; j < n; j++) {
    memcpy(A + (size_t)j * (size_t)one, J + (size_t)j * (size_t)n, sizeof(double) * (size_t)n);
    if (row) A[(size_t)j * (size_t)one + (size_t)n] = row[j];
  }
  if (column) memcpy(A + (size_t)n * (size_t)one, column, sizeof(double) * (size_t)one);
  assert_int_equal(LAPACKE_dgesv(LAPACK_COL_MAJOR, one, 1, A, one, pivot, x, one), 0);
  for (int i = 0; i < one; i++) {
    if (A[(size_t)i * (size_t)(one + 1)] < 0) sign = -sign;
    if (pivot[i] != i + 1) sign = -sign;
  }
  free(A);
  free(pivot);
  return sign;
}

typedef struct {
  mhb_balance            *b;
  mhb_receptance_product *product;
  mhb_woodbury           *woodbury;
  mhb_block              *form;
} solver;

static void open_solver(const modal_model *model, const mhb_settings *s, double low, double high,
                        solver *v) {
  create(model, s, &v->b);
  double stiffness[3 * v->b->n_pairs];
  stiffness_of(v->b, stiffness);
  v->product  = mhb_receptance_product_create(v->b->receptance, 0, v->b->m, stiffness, high);
  v->woodbury = mhb_woodbury_create(v->product, v->b->law, low, high);
  v->form     = calloc((size_t)v->b->n_pairs, sizeof *v->form);
}

static void close_solver(solver *v) {
  mhb_woodbury_destroy(v->woodbury);
  mhb_receptance_product_destroy(v->product);
  mhb_balance_destroy(v->b);
  free(v->form);
}

/* At one motion, with and without a border. */
static void compare_at(solver *v, double omega, double size, unsigned long long seed) {
  mhb_balance *b = v->b;
  size_t       n = (size_t)b->n;
  double      *J = calloc(n * n, sizeof(double)), *room = calloc(6 * (n + 1), sizeof(double));
  double      *x = room, *r = x + n + 1, *column = r + n + 1, *row = column + n + 1;
  double      *rhs = row + n + 1, *wanted = rhs + n + 1;
  int          n_full = 0, count[4] = {0};
  random_vector(b->n, size, seed, x);
  for (int i = 0; i < b->n; i += b->nb) x[i] = 0;
  random_vector(b->n + 1, 1, seed + 1, column);
  random_vector(b->n + 1, 1, seed + 2, row);
  row[n] = column[n];
  mhb_balance_evaluate(b, x, omega, r, J, NULL);
  for (int a = 0; a < b->n_pairs; a++) {
    mhb_pair_kind kind = b->eval->kind[a];
    v->form[a]         = kind == MHB_PAIR_OPEN    ? MHB_BLOCK_NONE
                         : kind == MHB_PAIR_STUCK ? MHB_BLOCK_SPRING
                                                  : MHB_BLOCK_FULL;
    count[kind]++;
    n_full += v->form[a] == MHB_BLOCK_FULL;
  }
  for (int border = 0; border < 2; border++) {
    random_vector(b->n + 1, 1, seed + 3, rhs);
    memcpy(wanted, rhs, sizeof(double) * (n + 1));
    int sign = solve_whole(b->n, J, border ? column : NULL, border ? row : NULL, wanted);
    assert_true(mhb_woodbury_factor(v->woodbury, v->form, b->eval->dp, b->law,
                                    border ? column : NULL, border ? row : NULL));
    assert_true(mhb_woodbury_solve(v->woodbury, 1e-15, rhs) ||
                v->woodbury->gmres->residual < 1e-14);
    print_message("%d full, %d spring of %d: size %d, %d iterations, %.1e, sign %d\n", n_full,
                  count[MHB_PAIR_STUCK], b->n_pairs, v->woodbury->basis->size,
                  v->woodbury->iterations, difference(rhs, wanted, b->n + border), sign);
    assert_below(difference(rhs, wanted, b->n + border), 1e-12);
    assert_int_equal(mhb_woodbury_sign(v->woodbury), sign);
  }
  free(J);
  free(room);
}

static void solution_is_that_of_the_whole(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = random_settings(M);
  solver       v = {0};
  random_model(12, WITH_LEFT | WITH_NORMALS | WITH_AREAS, 5, &model);
  open_solver(&model, &s, 1, 1.4, &v);
  for (unsigned long long seed = 0; seed < 4; seed++)
    compare_at(&v, 1.05 + .1 * (double)seed, .02 * pow(4, (double)seed), seed);
  close_solver(&v);
  modal_model_free(&model);
  s = shroud_face_settings(M);
  shroud_face_model(14, 150, &model);
  open_solver(&model, &s, SHB_TWO_PI * 215, SHB_TWO_PI * 320, &v);
  for (unsigned long long seed = 0; seed < 4; seed++)
    compare_at(&v, SHB_TWO_PI * (230 + 20 * (double)seed), 1e-4 * pow(4, (double)seed), seed);
  close_solver(&v);
  modal_model_free(&model);
}

static void solution_on_a_disc(void **state) {
  (void)state;
  enum { BLADES = 6 };
  modal_nodal_diameters disc;
  modal_model           face;
  solver                v = {0};
  mhb_settings          s = random_settings(M);
  for (int coriolis = 0; coriolis < 2; coriolis++) {
    random_disc(12, BLADES, WITH_LEFT | WITH_NORMALS | WITH_AREAS, coriolis, 5, &disc);
    s.nodal_diameters = &disc;
    open_solver(&disc.model[0], &s, 1, 1.4, &v);
    for (unsigned long long seed = 0; seed < 3; seed++)
      compare_at(&v, 1.05 + .1 * (double)seed, .02 * pow(4, (double)seed), seed);
    close_solver(&v);
    modal_nodal_diameters_free(&disc);
  }
  s = shroud_face_settings(M);
  shroud_face_model(14, 150, &face);
  face_disc(&face, BLADES, 0, &disc);
  modal_model_free(&face);
  s.nodal_diameters = &disc;
  s.blades          = BLADES;
  s.engine_order    = 5;
  open_solver(&disc.model[0], &s, SHB_TWO_PI * 215, SHB_TWO_PI * 320, &v);
  for (unsigned long long seed = 0; seed < 3; seed++)
    compare_at(&v, SHB_TWO_PI * (230 + 20 * (double)seed), 1e-4 * pow(4, (double)seed), seed);
  close_solver(&v);
  modal_nodal_diameters_free(&disc);
}

/* |(I + X K X^H D) x_k - rhs_k|/|rhs_k| of a harmonic, D of each pair, X and K of the basis. */
static double residual_of(const solver *v, int k, const double complex (*D)[9], const double *x,
                          const double *rhs) {
  const mhb_contact_basis *basis = v->woodbury->basis;
  const int                n3 = 3 * v->b->n_pairs, nb = v->b->nb, wide = 2 * basis->rank[k];
  double                   p[2 * n3], y[wide], left = 0, all = 0;
  memset(y, 0, sizeof y);
  for (int i = 0; i < n3; i++) {
    double complex sum = 0;
    for (int c = 0; c < 3; c++) {
      const double *u = x + (i - i % 3 + c) * nb + 2 * k - 1;
      sum += D[i / 3][3 * (i % 3) + c] * CMPLX(u[0], u[1]);
    }
    p[2 * i]     = creal(sum);
    p[2 * i + 1] = cimag(sum);
  }
  for (int row = 0; row < 2 * n3; row++)
    for (int j = 0; j < wide; j++) y[j] += basis->X[k][row * wide + j] * p[row];
  for (int row = 0; row < 2 * n3; row++) {
    const int at  = row / 2 * nb + 2 * k - 1 + row % 2;
    double    sum = x[at] - rhs[at];
    for (int j = 0; j < wide; j++)
      for (int l = 0; l < wide; l++)
        sum += basis->X[k][row * wide + j] * basis->K[k][j * wide + l] * y[l];
    left += sum * sum;
    all += rhs[at] * rhs[at];
  }
  return sqrt(left / all);
}

/* Harmonics that do not couple, with the receptance of the basis. */
static void lone_harmonics_are_those_of_the_basis(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s     = random_settings(M);
  solver       v     = {0};
  const double omega = 1.2;
  random_model(12, WITH_LEFT | WITH_NORMALS | WITH_AREAS, 5, &model);
  open_solver(&model, &s, 1, 1.4, &v);
  const mhb_balance *b = v.b;
  double             rhs[b->n], x[b->n];
  double complex     D[b->n_pairs][9];
  memset(D, 0, sizeof D);
  for (int a = 0; a < b->n_pairs; a++) {
    D[a][0] = CMPLX(b->law[a].kv, .02 * b->law[a].kv);
    D[a][4] = CMPLX(.6 * b->law[a].ku[0], .1 * b->law[a].ku[0]);
    D[a][8] = .7 * b->law[a].ku[2];
    D[a][5] = .05 * b->law[a].ku[2];
  }
  random_vector(b->n, 1, 7, rhs);
  memcpy(x, rhs, sizeof rhs);
  mhb_receptance_at(b->receptance, omega, b->m);
  assert_true(mhb_lone_harmonics_factor(v.woodbury, b->law, 1, (const double complex(*)[9])D));
  mhb_lone_harmonics_solve(v.woodbury, 1, (const double complex(*)[9])D, x);
  for (int i = 0; i < b->n; i += b->nb) assert_near(x[i], rhs[i], 0); /* k = 0 stays */
  for (int k = 1; k <= b->m; k++) {
    const double before = residual_of(&v, k, (const double complex(*)[9])D, rhs, rhs),
                 after  = residual_of(&v, k, (const double complex(*)[9])D, x, rhs);
    print_message("harmonic %d, %d columns: residual %.1e, %.1e without\n", k,
                  v.woodbury->basis->rank[k], after, before);
    assert_true(before > 1e-6 || v.woodbury->basis->rank[k] == 0);
    assert_below(after, 1e-13 * (1 + before));
  }
  close_solver(&v);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lone_harmonics_are_those_of_the_basis),
      cmocka_unit_test(products_are_those_of_R),
      cmocka_unit_test(products_of_a_disc),
      cmocka_unit_test(load_without_R),
      cmocka_unit_test(solution_on_a_disc),
      cmocka_unit_test(solution_is_that_of_the_whole),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
