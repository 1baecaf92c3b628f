/* K(theta)^-1 and M(theta) of a sector: against dense matrices and the strain energy. */
#include "modal/cyclic/wave_operator.h"

#include "modal/common/session.h"
#include "tests/support/fem.h"
#include "tests/support/small_wave.h"

enum { MOST = 9 };

/* The dense K(theta), which the tests of this room rely on. Its x^H K x is the energy of the
 * strains of the real and of the imaginary part of the motion. */
static void the_dense_stiffness_has_the_strain_energy(void **state) {
  const small_sector *s = *state;
  for (int d = 0; d <= SMALL_BLADES / 2; d++) {
    dense_wave w;
    dense_wave_create(s, d, &w);
    const size_t    n = (size_t)w.n, nodal = (size_t)w.nodal;
    double complex *x = random_complex(n, 3), *y = malloc(n * sizeof *y), sum = 0;
    double         *u[2] = {calloc(nodal, 8), calloc(nodal, 8)};
    dense_multiply(w.n, w.K, 1, x, y);
    for (size_t i = 0; i < n; i++) {
      sum += conj(x[i]) * y[i];
      for (size_t k = 0; k < nodal; k++) {
        u[0][k] += creal(w.C[i * nodal + k] * x[i]);
        u[1][k] += cimag(w.C[i * nodal + k] * x[i]);
      }
    }
    const double energy =
        tangent_energy(&s->body, NULL, u[0]) + tangent_energy(&s->body, NULL, u[1]);
    print_message("nodal diameter %d: energy off by %.1e\n", d, creal(sum) / energy - 1);
    assert_within(creal(sum), energy, 1e-12);
    assert_small(cimag(sum), 1e-12 * energy);
    free(x);
    free(y);
    free(u[0]);
    free(u[1]);
    dense_wave_free(&w);
  }
}

static void solutions_and_products_are_the_dense_ones(void **state) {
  const small_sector *s = *state;
  for (int d = 0; d <= SMALL_BLADES / 2; d++) {
    dense_wave    w;
    wave_operator op;
    dense_wave_create(s, d, &w);
    assert_ok(wave_operator_create(&s->sector, s->order, d, SMALL_BLADES, &op));
    assert_int_equal(op.order, w.n);
    assert_true(op.is_real == (d == 0 || 2 * d == SMALL_BLADES));
    assert_small(cabs(op.phase - w.phase), 1e-15);
    for (int count = 1; count <= MOST; count += 4) {
      const size_t    size = (size_t)(w.n * count);
      double complex *X = random_complex(size, 8), *Y = malloc(size * sizeof *Y);
      double complex *Z = malloc(size * sizeof *Z);
      wave_operator_solve(&op, count, X, Y);
      dense_multiply(w.n, w.K, count, Y, Z);
      const double solution = complex_difference(size, Z, X);
      wave_operator_mass(&op, count, X, Y);
      dense_multiply(w.n, w.M, count, X, Z);
      const double product = complex_difference(size, Y, Z);
      print_message("nodal diameter %d, %d columns: K^-1 %.1e, M %.1e\n", d, count, solution,
                    product);
      assert_below(solution, 1e-12);
      assert_below(product, 1e-14);
      memcpy(Z, X, size * sizeof *Z);
      wave_operator_solve(&op, count, X, Y);
      wave_operator_solve(&op, count, Z, Z); /* in place */
      assert_memory_equal(Z, Y, size * sizeof *Z);
      free(X);
      free(Y);
      free(Z);
    }
    wave_operator_free(&op);
    dense_wave_free(&w);
  }
}

/* A wave that runs backwards has the conjugate matrices. */
static void the_backward_wave_is_the_conjugate(void **state) {
  const small_sector *s = *state;
  wave_operator       op[2];
  assert_ok(wave_operator_create(&s->sector, s->order, 1, SMALL_BLADES, &op[0]));
  assert_ok(wave_operator_create(&s->sector, s->order, -1, SMALL_BLADES, &op[1]));
  const size_t    n = op[0].order;
  double complex *b = random_complex(n, 8), *x = malloc(n * sizeof *x), *y = malloc(n * sizeof *y);
  wave_operator_solve(&op[0], 1, b, x);
  for (size_t i = 0; i < n; i++) b[i] = conj(b[i]);
  wave_operator_solve(&op[1], 1, b, y);
  for (size_t i = 0; i < n; i++) y[i] = conj(y[i]);
  assert_below(complex_difference(n, y, x), 1e-13);
  free(b);
  free(x);
  free(y);
  wave_operator_free(&op[0]);
  wave_operator_free(&op[1]);
}

/* C = X^H Y, and Y += factor X C. */
static void products_of_blocks(void **state) {
  (void)state;
  enum { ORDER = 7, NX = 3, NY = 2 };
  double complex *X = random_complex(ORDER * NX, 1), *Y = random_complex(ORDER * NY, 2);
  double complex *Z = random_complex(ORDER * NY, 2), C[NX * NY];
  wave_inner(ORDER, NX, X, NY, Y, C);
  for (int x = 0; x < NX; x++)
    for (int y = 0; y < NY; y++) {
      double complex sum = 0;
      for (int i = 0; i < ORDER; i++) sum += conj(X[x * ORDER + i]) * Y[y * ORDER + i];
      assert_small(cabs(C[y * NX + x] - sum), 1e-14);
    }
  wave_add(ORDER, -1.7, NX, X, C, NY, Y);
  for (int y = 0; y < NY; y++)
    for (int i = 0; i < ORDER; i++) {
      double complex sum = Z[y * ORDER + i];
      for (int x = 0; x < NX; x++) sum -= 1.7 * X[x * ORDER + i] * C[y * NX + x];
      assert_small(cabs(Y[y * ORDER + i] - sum), 1e-13);
    }
  memcpy(Z, Y, sizeof *Z * ORDER * NY); /* no column: nothing */
  wave_inner(ORDER, 0, NULL, NY, Y, NULL);
  wave_add(ORDER, 1, 0, NULL, NULL, NY, Y);
  assert_memory_equal(Z, Y, sizeof *Z * ORDER * NY);
  free(X);
  free(Y);
  free(Z);
}

/* A sector of which nothing holds the disc, in effect: one number on the diagonal is negative. */
static void a_stiffness_that_is_not_definite_is_told(void **state) {
  const small_sector  *s   = *state;
  fem_sector           bad = s->sector;
  const size_t         all = 9 * (size_t)bad.blocks.start[bad.n_rows];
  fem_hermitian_order *order;
  wave_operator        op;
  bad.stiffness = malloc(all * sizeof *bad.stiffness);
  memcpy(bad.stiffness, s->sector.stiffness, all * sizeof *bad.stiffness);
  bad.stiffness[9 * (size_t)bad.blocks.start[bad.n_rows / 2]] = -1;
  assert_ok(fem_sector_analyse(&bad, &order));
  assert_refused(wave_operator_create(&bad, order, 1, SMALL_BLADES, &op), SHB_ERR_INPUT,
                 "is not positive definite: the clamp on group root");
  wave_operator_free(&op);
  fem_hermitian_order_free(order);
  free(bad.stiffness);
}

static int set_up(void **state) {
  static small_sector s;
  small_sector_create(&s);
  *state = &s;
  return 0;
}

static int tear_down(void **state) {
  small_sector_free(*state);
  return 0;
}

int main(int argc, char **argv) {
  modal_session           session;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_dense_stiffness_has_the_strain_energy),
      cmocka_unit_test(solutions_and_products_are_the_dense_ones),
      cmocka_unit_test(the_backward_wave_is_the_conjugate),
      cmocka_unit_test(products_of_blocks),
      cmocka_unit_test(a_stiffness_that_is_not_definite_is_told),
  };
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failed = cmocka_run_group_tests(tests, set_up, tear_down);
  modal_session_end(&session, SHB_OK);
  return failed;
}
