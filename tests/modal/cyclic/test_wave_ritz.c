/* Residual modes from Hermitian moments: those of known modes give the modes back. */
#include "modal/cyclic/wave_ritz.h"

#include "tests/support/check.h"
#include "tests/support/small_wave.h"

enum { COLUMNS = 2, BLOCKS = MODAL_RESIDUAL_BLOCKS, MOMENTS = 2 * BLOCKS, MOST = 12 };

/* mu_j = sum psi psi^H/lambda^j, by rows, of n modes with shapes psi [COLUMNS][n]. */
typedef struct {
  int             n;
  double          lambda[MOST];
  double complex *psi;
  double complex  moment[MOMENTS][COLUMNS * COLUMNS];
} modes;

static modes make(int n) {
  modes m = {.n = n, .psi = random_complex((size_t)(COLUMNS * n), 13)};
  for (int i = 0; i < n; i++) m.lambda[i] = 1.3 + 0.9 * i + 0.2 * i * i;
  for (int j = 0; j < MOMENTS; j++)
    for (int a = 0; a < COLUMNS; a++)
      for (int b = 0; b < COLUMNS; b++)
        for (int i = 0; i < n; i++)
          m.moment[j][a * COLUMNS + b] +=
              m.psi[a * n + i] * conj(m.psi[b * n + i]) / pow(m.lambda[i], j + 1);
  return m;
}

static wave_ritz solve(modes *m) {
  double complex *moment[MOMENTS];
  wave_ritz       ritz;
  for (int j = 0; j < MOMENTS; j++) moment[j] = m->moment[j];
  assert_ok(wave_ritz_create(COLUMNS, moment, &ritz));
  return ritz;
}

/* Shape of Ritz mode k at column a: sum of B^H V_i y_i, B^H V_i = mu_(i+1). */
static double complex shape(const modes *m, const wave_ritz *r, int a, int k) {
  double complex sum = 0;
  for (int i = 0; i < BLOCKS; i++)
    for (int b = 0; b < COLUMNS; b++)
      sum += m->moment[i][a * COLUMNS + b] * r->weight[(i * COLUMNS + b) * r->n + k];
  return sum;
}

/* As many modes as Ritz modes: they are the same, up to phases. */
static void few_modes_are_found_again(void **state) {
  (void)state;
  for (int n = 1; n <= BLOCKS * COLUMNS; n++) {
    modes     m     = make(n);
    wave_ritz r     = solve(&m);
    double    worst = 0;
    assert_int_equal(r.n, n);
    for (int i = 0; i < n; i++) {
      assert_within(r.lambda[i], m.lambda[i], 1e-9);
      for (int a = 0; a < COLUMNS; a++)
        for (int b = 0; b < COLUMNS; b++)
          worst = fmax(worst, cabs(shape(&m, &r, a, i) * conj(shape(&m, &r, b, i)) -
                                   m.psi[a * n + i] * conj(m.psi[b * n + i])));
    }
    print_message("%d modes: shapes off by %.1e\n", n, worst);
    assert_below(worst, 1e-9);
    wave_ritz_free(&r);
    free(m.psi);
  }
}

/* More modes than Ritz modes: sum psi psi^H/theta^j has the same moments, and no theta is below
 * the lowest eigenvalue. */
static void moments_are_kept(void **state) {
  (void)state;
  modes     m = make(MOST);
  wave_ritz r = solve(&m);
  assert_int_equal(r.n, BLOCKS * COLUMNS);
  assert_true(r.lambda[0] >= m.lambda[0] * (1 - 1e-9));
  for (int j = 0; j < MOMENTS; j++) {
    double worst = 0;
    for (int a = 0; a < COLUMNS; a++)
      for (int b = 0; b < COLUMNS; b++) {
        double complex sum = -m.moment[j][a * COLUMNS + b];
        for (int k = 0; k < r.n; k++)
          sum += shape(&m, &r, a, k) * conj(shape(&m, &r, b, k)) / pow(r.lambda[k], j + 1);
        worst = fmax(worst, cabs(sum) / cabs(m.moment[j][0]));
      }
    print_message("moment %d: off by %.1e\n", j + 1, worst);
    assert_below(worst, 1e-12);
  }
  for (int k = 1; k < r.n; k++) assert_true(r.lambda[k] >= r.lambda[k - 1]);
  wave_ritz_free(&r);
  free(m.psi);
}

static void a_column_without_mass_has_no_mode(void **state) {
  (void)state;
  modes m = make(2);
  for (int j = 0; j < MOMENTS; j++)
    for (int a = 0; a < COLUMNS; a++) m.moment[j][a * COLUMNS + 1] = m.moment[j][COLUMNS + a] = 0;
  wave_ritz one = solve(&m);
  assert_int_equal(one.n, 2); /* both by the other column */
  wave_ritz_free(&one);
  memset(m.moment, 0, sizeof m.moment);
  wave_ritz none = solve(&m);
  assert_int_equal(none.n, 0);
  wave_ritz_free(&none);
  free(m.psi);
}

static void a_matrix_is_made_hermitian(void **state) {
  (void)state;
  double complex *a = random_complex(25, 7), *b = random_complex(25, 7);
  wave_make_hermitian(a, 5);
  for (int i = 0; i < 5; i++)
    for (int j = 0; j < 5; j++) {
      assert_small(cabs(a[i * 5 + j] - (b[i * 5 + j] + conj(b[j * 5 + i])) / 2), 1e-16);
      assert_true(a[i * 5 + j] == conj(a[j * 5 + i]));
    }
  free(a);
  free(b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(few_modes_are_found_again),
      cmocka_unit_test(moments_are_kept),
      cmocka_unit_test(a_column_without_mass_has_no_mode),
      cmocka_unit_test(a_matrix_is_made_hermitian),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
