/* Solves with a factor by panels: against dense products and LAPACK. */
#include "fem/supernodal/supernodal_solve.h"

#include <cblas.h>
#include <lapacke.h>

#include "tests/support/block_grid.h"
#include "tests/support/check.h"

enum { MOST_THREADS = 3 };

/* A matrix with its factor, and dense in the order of the factor. */
typedef struct {
  block_grid   grid;
  block_factor f;
  double      *A, *L; /* [n][n] by columns */
} scene;

static scene *make(block_grid grid, double diagonal) {
  scene *s = malloc(sizeof *s);
  assert_non_null(s);
  s->grid = grid;
  block_factor_make(&s->grid, &s->f);
  double *block = block_grid_values(&s->grid, diagonal, 71);
  assert_true(fem_supernodal_factorise(&s->f.panels, &s->f.lower, block, NULL, s->f.value));
  s->A = block_factor_dense(&s->f, block);
  s->L = block_factor_dense(&s->f, block);
  assert_int_equal(LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', s->f.n, s->L, s->f.n > 0 ? s->f.n : 1), 0);
  free(block);
  return s;
}

static void drop(scene *s) {
  free(s->A);
  free(s->L);
  block_factor_free(&s->f);
  block_grid_free(&s->grid);
  free(s);
}

static scene *make_grid(void) {
  return make(block_grid_make((const int[]){12, 4, 2}, 1, 1), 40);
}

static double *random_numbers(size_t n) {
  uint64_t seed = 53;
  double  *x    = malloc((n + 1) * sizeof *x);
  for (size_t i = 0; i < n; i++) x[i] = block_random(&seed);
  return x;
}

/* Greatest |A x - b| of columns [n][count] in rows of needed panels (NULL: all). x solves it. */
static double residual(const scene *s, int count, const double *x, const double *b) {
  const int n = s->f.n;
  double   *r = malloc(((size_t)n * (size_t)count + 1) * sizeof *r), worst = 0;
  memcpy(r, b, (size_t)n * (size_t)count * sizeof *r);
  if (n > 0)
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, count, n, 1, s->A, n, x, count, -1, r,
                count);
  for (int i = 0; i < n * count; i++) worst = fmax(worst, fabs(r[i]));
  free(r);
  return worst;
}

/* Lanes: columns of b. x has room for the copies, which hold rubbish before. */
static double lanes_residual(const scene *s, int threads) {
  const fem_supernodes *p = &s->f.panels;
  const size_t          n = (size_t)p->n, all = (size_t)p->n_extended, rows = (size_t)p->most_rows;
  double               *b = random_numbers(n * FEM_LANES);
  fem_lanes            *x = aligned_alloc(32, (all + 1) * sizeof *x);
  fem_lanes            *w = aligned_alloc(32, (MOST_THREADS * rows + 1) * sizeof *w);
  memcpy(x, b, n * sizeof *x);
  for (size_t i = n; i < all; i++) x[i] = (fem_lanes){1e9, -3, 7, 1e300};
  fem_supernodal_solve(p, s->f.value, threads, x, w);
  const double worst = residual(s, FEM_LANES, (const double *)x, b);
  free(b);
  free(x);
  free(w);
  return worst;
}

static void four_columns_on_threads(void **state) {
  (void)state;
  scene *s = make_grid();
  for (int threads = 1; threads <= MOST_THREADS; threads++) {
    const double worst = lanes_residual(s, threads);
    print_message("%d threads: %.1e\n", threads, worst);
    assert_below(worst, 1e-13);
  }
  drop(s);
}

static void odd_and_small_sizes(void **state) {
  (void)state;
  for (int n = 0; n <= 9; n++) {
    scene *s = make(block_grid_line(n, 2, false), 9);
    assert_below(lanes_residual(s, 2), 1e-14);
    drop(s);
  }
}

/* needed NULL: all. Returns x, to be freed. */
static double *solve_block(const scene *s, const bool *needed, int count, const double *b) {
  const size_t n = (size_t)s->f.n, c = (size_t)count, rows = (size_t)s->f.panels.most_rows;
  double      *x = malloc((n * c + 1) * sizeof *x), *work = malloc((rows * c + 1) * sizeof *work);
  int         *at = malloc((rows + 1) * sizeof *at);
  memcpy(x, b, n * c * sizeof *x);
  fem_supernodal_solve_block(&s->f.panels, s->f.value, needed, count, x, work, at);
  free(work);
  free(at);
  return x;
}

static void columns_by_blas(void **state) {
  (void)state;
  scene *s = make_grid();
  for (int count = 1; count <= 22; count += 7) {
    double      *b = random_numbers((size_t)(s->f.n * count)), *x = solve_block(s, NULL, count, b);
    const double worst = residual(s, count, x, b);
    print_message("%d columns: %.1e\n", count, worst);
    assert_below(worst, 1e-13);
    free(b);
    free(x);
  }
  drop(s);
}

/* Few wanted rows need few panels; what is solved there is the whole solution's. */
static void a_part_of_the_rows(void **state) {
  (void)state;
  scene                *s = make_grid();
  const fem_supernodes *p = &s->f.panels;
  const int             n = s->f.n, count = 3;
  bool                 *row = calloc((size_t)n, 1), *needed = malloc((size_t)p->n_panels);
  int                   few = 0;
  row[4]                    = true;
  fem_supernodes_needed(p, row, needed);
  double *b   = random_numbers((size_t)(n * count));
  double *all = solve_block(s, NULL, count, b), *part = solve_block(s, needed, count, b);
  for (int i = 0; i < n * count; i++)
    if (needed[s->f.owner[i / count]]) assert_true(part[i] == all[i]);
  for (int k = 0; k < p->n_panels; k++) few += needed[k];
  print_message("%d of %d panels\n", few, p->n_panels);
  assert_true(needed[0] && few < p->n_panels);
  free(row);
  free(needed);
  free(b);
  free(all);
  free(part);
  drop(s);
}

/* A unit load in one row, as loads at single dofs have them: zero panels are passed over. */
static void unit_loads(void **state) {
  (void)state;
  scene *s = make_grid();
  for (int r = 0; r < s->f.n; r += 61) {
    double *b = calloc((size_t)s->f.n, sizeof *b);
    b[r]      = 2.385;
    double *x = solve_block(s, NULL, 1, b);
    assert_below(residual(s, 1, x, b), 1e-13);
    free(b);
    free(x);
  }
  drop(s);
}

/* One panel: forward is L_11^-1 b and what the rows below lose; backward is its transpose. */
static void one_panel_forward_and_transposed(void **state) {
  (void)state;
  scene                *s = make_grid();
  const fem_supernodes *p = &s->f.panels;
  const int             n = s->f.n;
  for (int k = 0; k < p->n_panels; k += 3) {
    const fem_panel *own = &p->panel[k];
    const int below = own->rows - own->columns, first = own->first, end = first + own->columns;
    int      *at = malloc(((size_t)below + 1) * sizeof *at);
    double   *x = random_numbers((size_t)n), *b = random_numbers((size_t)n);
    double   *work = malloc(((size_t)below + 1) * sizeof *work);
    for (int i = 0; i < below; i++) at[i] = block_factor_row(&s->f, k, own->columns + i);
    fem_panel_forward(own, s->f.value + own->value, at, 1, x + first, x, work);
    for (int r = 0; r < n; r++) { /* b_r is the sum of L_rc x_c, and what is left */
      double sum = r >= first && r < end ? 0 : x[r];
      for (int c = first; c < end && c <= r; c++)
        sum += s->L[(size_t)c * (size_t)n + (size_t)r] * x[c];
      assert_near(sum, b[r], 1e-13);
    }
    memcpy(x, b, (size_t)n * sizeof *x);
    fem_panel_backward(own, s->f.value + own->value, at, 1, x + first, x, work);
    for (int c = 0; c < n; c++) {
      double sum = c >= first && c < end ? 0 : x[c];
      for (int r = c; c >= first && c < end && r < n; r++)
        sum += s->L[(size_t)c * (size_t)n + (size_t)r] * x[r];
      assert_near(sum, b[c], 1e-13);
    }
    free(at);
    free(x);
    free(b);
    free(work);
  }
  drop(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(four_columns_on_threads),
      cmocka_unit_test(odd_and_small_sizes),
      cmocka_unit_test(columns_by_blas),
      cmocka_unit_test(a_part_of_the_rows),
      cmocka_unit_test(unit_loads),
      cmocka_unit_test(one_panel_forward_and_transposed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
