/* The basis of complex block Lanczos: orthonormal, with the recurrence of K^-1 M. */
#include "modal/cyclic/wave_basis.h"

#include "modal/common/session.h"
#include "tests/support/fem.h"
#include "tests/support/small_wave.h"

enum { P = 3, BLOCKS = 5 };

typedef struct {
  dense_wave    dense;
  wave_operator op;
  wave_basis    b;
} lanczos;

/* n blocks, and the next one in W. */
static void run(const small_sector *s, int diameter, int n, lanczos *l) {
  double complex R[P * P];
  bool           good;
  dense_wave_create(s, diameter, &l->dense);
  assert_ok(wave_operator_create(&s->sector, s->order, diameter, SMALL_BLADES, &l->op));
  wave_basis_create(&l->op, P, n, &l->b);
  wave_basis_randomise(&l->b, 0);
  wave_basis_orthonormalise(&l->b, NULL, R, &good);
  for (int k = 0; k < n; k++) {
    wave_basis_append(&l->b);
    assert_int_equal(l->b.n, k + 1);
    wave_operator_solve(&l->op, P, l->b.MW, l->b.W);
    wave_basis_orthonormalise(&l->b, l->b.D + P * P * k, l->b.B + P * P * k, &good);
    assert_true(good);
  }
}

static void drop(lanczos *l) {
  wave_basis_free(&l->b);
  wave_operator_free(&l->op);
  dense_wave_free(&l->dense);
}

/* C = X^H M Y by columns, [ny][nx]. */
static double complex *mass_products(const dense_wave *w, int nx, const double complex *X, int ny,
                                     const double complex *Y) {
  double complex *MY = malloc((size_t)(w->n * ny) * sizeof *MY);
  double complex *C  = malloc((size_t)(nx * ny) * sizeof *C);
  dense_multiply(w->n, w->M, ny, Y, MY);
  wave_inner((size_t)w->n, nx, X, ny, MY, C);
  free(MY);
  return C;
}

static void the_basis_is_orthonormal(void **state) {
  for (int d = 0; d <= 1; d++) {
    lanczos l;
    double  worst = 0;
    run(*state, d, BLOCKS, &l);
    const int       m = P * BLOCKS;
    double complex *G = mass_products(&l.dense, m, l.b.Q, m, l.b.Q);
    double complex *N = mass_products(&l.dense, m, l.b.Q, P, l.b.W);
    for (int i = 0; i < m * m; i++) worst = fmax(worst, cabs(G[i] - (i % (m + 1) == 0)));
    for (int i = 0; i < m * P; i++) worst = fmax(worst, cabs(N[i]));
    print_message("nodal diameter %d: orthonormal to %.1e\n", d, worst);
    assert_below(worst, 1e-13);
    for (size_t i = 0; d == 0 && i < (size_t)m * l.b.order; i++)
      assert_true(cimag(l.b.Q[i]) == 0); /* real matrices, real shapes */
    free(G);
    free(N);
    drop(&l);
  }
}

/* Column c of block k of T Q - Q_(k-1) B_(k-1)^H - Q_k D_k - Q_(k+1) B_k. */
static void subtract(const lanczos *l, int block, const double complex *C, bool adjoint, int c,
                     double complex *x) {
  const size_t          order = l->b.order;
  const double complex *Q     = block < BLOCKS ? l->b.Q + (size_t)(block * P) * order : l->b.W;
  for (size_t r = 0; r < P; r++)
    for (size_t i = 0; i < order; i++)
      x[i] -= Q[r * order + i] * (adjoint ? conj(C[r * P + (size_t)c]) : C[(size_t)c * P + r]);
}

static void the_recurrence_holds(void **state) {
  lanczos l;
  run(*state, 1, BLOCKS, &l);
  const size_t    order = l.b.order, all = (size_t)(P * BLOCKS);
  double complex *T = malloc(all * order * sizeof *T), *R = calloc(order, sizeof *R);
  double          worst = 0;
  dense_multiply(l.dense.n, l.dense.M, P * BLOCKS, l.b.Q, T);
  dense_wave_solve(&l.dense, P * BLOCKS, T);
  for (int k = 0; k < BLOCKS; k++)
    for (int c = 0; c < P; c++) {
      double complex *x    = T + (size_t)(k * P + c) * order;
      const double    size = cabs(x[0]) + cabs(x[order / 2]);
      if (k > 0) subtract(&l, k - 1, l.b.B + P * P * (k - 1), true, c, x);
      subtract(&l, k, l.b.D + P * P * k, false, c, x);
      subtract(&l, k + 1, l.b.B + P * P * k, false, c, x);
      for (size_t i = 0; i < order; i++) worst = fmax(worst, cabs(x[i]) / size);
    }
  print_message("recurrence off by %.1e\n", worst);
  assert_below(worst, 1e-11);
  free(T);
  free(R);
  drop(&l);
}

/* H = Q^H M T Q, of which the lower triangle is stored. */
static void the_projection_is_that_of_the_operator(void **state) {
  lanczos l;
  run(*state, 2, BLOCKS, &l);
  const int       m     = P * BLOCKS;
  double complex *T     = malloc((size_t)m * l.b.order * sizeof *T), *G;
  double          worst = 0;
  dense_multiply(l.dense.n, l.dense.M, m, l.b.Q, T);
  dense_wave_solve(&l.dense, m, T);
  G = mass_products(&l.dense, m, l.b.Q, m, T);
  wave_basis_projection(P, BLOCKS, l.b.D, l.b.B, l.b.H);
  for (int c = 0; c < m; c++)
    for (int r = c; r < m; r++)
      worst = fmax(worst, cabs(G[c * m + r] - l.b.H[c * m + r]) / cabs(G[0]));
  print_message("projection off by %.1e\n", worst);
  assert_below(worst, 1e-12);
  free(T);
  free(G);
  drop(&l);
}

/* W before is Q C + W' R. */
static void a_block_is_split_into_its_parts(void **state) {
  lanczos        l;
  bool           good;
  double complex R[P * P], last[P * P] = {0};
  run(*state, 1, 2, &l);
  const size_t    size = (size_t)P * l.b.order;
  double complex *W    = random_complex(size, 4), *C;
  memcpy(l.b.W, W, size * sizeof *W);
  C = mass_products(&l.dense, 2 * P, l.b.Q, P, W);
  wave_basis_orthonormalise(&l.b, last, R, &good);
  assert_true(good);
  for (int c = 0; c < P; c++)
    for (int r = 0; r < P; r++)
      assert_small(cabs(last[c * P + r] - C[c * 2 * P + P + r]), 1e-13 * cabs(C[0]));
  double most = 0;
  for (size_t i = 0; i < size; i++) most = fmax(most, cabs(W[i]));
  wave_add(l.b.order, -1, 2 * P, l.b.Q, C, P, W);
  wave_add(l.b.order, -1, P, l.b.W, R, P, W);
  for (size_t i = 0; i < size; i++) assert_small(cabs(W[i]), 1e-13 * most);
  for (int c = 0; c < P; c++)
    for (int r = c + 1; r < P; r++) assert_true(R[c * P + r] == 0);
  free(W);
  free(C);
  drop(&l);
}

static void equal_columns_are_told(void **state) {
  lanczos        l;
  bool           good = true;
  double complex R[P * P];
  run(*state, 1, 1, &l);
  memcpy(l.b.W + l.b.order, l.b.W, l.b.order * sizeof *l.b.W);
  memset(l.b.W + 2 * l.b.order, 0, l.b.order * sizeof *l.b.W);
  wave_basis_orthonormalise(&l.b, NULL, R, &good);
  assert_false(good);
  drop(&l);
}

/* Normal numbers of mean 0 and variance 1 of each component; real where the matrices are. */
static void random_blocks_are_normal(void **state) {
  const small_sector *s = *state;
  for (int d = 0; d <= 1; d++) {
    enum { MANY = 40 };
    wave_operator op;
    wave_basis    b;
    assert_ok(wave_operator_create(&s->sector, s->order, d, SMALL_BLADES, &op));
    wave_basis_create(&op, MANY, 1, &b);
    const size_t   n    = MANY * b.order;
    double complex mean = 0, square = 0, first;
    double         size = 0, fourth = 0;
    wave_basis_randomise(&b, 3);
    first = b.W[0];
    wave_basis_randomise(&b, 2);
    assert_true(first != b.W[0]);
    for (size_t i = 0; i < n; i++) {
      mean += b.W[i] / (double)n;
      square += b.W[i] * b.W[i] / (double)n;
      size += creal(b.W[i] * conj(b.W[i])) / (double)n;
      fourth += pow(cabs(b.W[i]), 4) / (double)n;
      assert_true(d > 0 || cimag(b.W[i]) == 0);
    }
    const double error = 4 / sqrt((double)n); /* about four standard deviations */
    print_message("%zu numbers: mean %.3f, size %.3f, fourth moment %.3f\n", n, cabs(mean), size,
                  fourth);
    assert_small(cabs(mean), error);
    assert_near(size, 1, 2 * error);
    assert_near(cabs(square), d > 0 ? 0 : 1, 2 * error);
    assert_near(fourth, d > 0 ? 2 : 3, 12 * error);
    wave_basis_free(&b);
    wave_operator_free(&op);
  }
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
      cmocka_unit_test(the_basis_is_orthonormal),
      cmocka_unit_test(the_recurrence_holds),
      cmocka_unit_test(the_projection_is_that_of_the_operator),
      cmocka_unit_test(a_block_is_split_into_its_parts),
      cmocka_unit_test(equal_columns_are_told),
      cmocka_unit_test(random_blocks_are_normal),
  };
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failed = cmocka_run_group_tests(tests, set_up, tear_down);
  modal_session_end(&session, SHB_OK);
  return failed;
}
