/* Which panels of a Hermitian factor are real up to phases. They are held against the dense factor
 * at two angles, and against phases that follow from numbers of the nodes. */
#include "fem/supernodal/panel_turns.h"

#include <lapacke.h>

#include "tests/support/block_wave.h"
#include "tests/support/check.h"

enum { ANGLES = 2 };

static const double theta[ANGLES] = {0.7, 1.9};

/* The dense factors at the angles. */
static void dense_factors(const block_grid *grid, const signed char *exponent,
                          double complex *L[ANGLES]) {
  const size_t count = (size_t)grid->start[grid->blocks.n];
  for (int a = 0; a < ANGLES; a++) {
    block_wave   w;
    signed char *copy = malloc(count + 1);
    memcpy(copy, exponent, count);
    assert_true(block_wave_make(grid, copy, theta[a], 40, &w));
    L[a] = block_factor_dense_complex(&w.f, (const double complex(*)[9])w.all);
    assert_int_equal(LAPACKE_zpotrf(LAPACK_COL_MAJOR, 'L', w.f.n, L[a], w.f.n), 0);
    block_wave_free(&w);
  }
}

/* e^(-j theta (g_r - g_c)) L_rc of a panel: its greatest imaginary part and change with theta. */
static double phase_error(const block_wave *w, int k, double complex *const L[ANGLES]) {
  const fem_panel   *p     = &w->f.panels.panel[k];
  const signed char *g     = w->turns.g + p->row / 3;
  double             worst = 0;
  for (int c = 0; c < p->columns; c++)
    for (int i = c; i < p->rows; i++) {
      const size_t at =
          (size_t)(p->first + c) * (size_t)w->f.n + (size_t)block_factor_row(&w->f, k, i);
      double complex R[ANGLES];
      for (int a = 0; a < ANGLES; a++)
        R[a] = L[a][at] * cexp(-I * theta[a] * (g[i / 3] - g[c / 3]));
      worst = fmax(worst, fmax(fabs(cimag(R[0])), cabs(R[0] - R[1])));
    }
  return worst;
}

/* Real panels are so at every angle; of the others an error of the size of the entries is left.
 * Returns the number of real panels. */
static int check(const block_grid *grid, signed char *exponent) {
  double complex *L[ANGLES];
  block_wave      w;
  int             real  = 0;
  double          worst = 0, least = INFINITY;
  dense_factors(grid, exponent, L);
  assert_true(block_wave_make(grid, exponent, 0.3, 40, &w));
  for (int k = 0; k < w.f.panels.n_panels; k++) {
    const double error = phase_error(&w, k, L);
    if (w.turns.is_real[k])
      worst = fmax(worst, error);
    else
      least = fmin(least, error);
    real += w.turns.is_real[k];
  }
  print_message("%d of %d panels real to %.1e, the others off by %.1e\n", real, w.f.panels.n_panels,
                worst, least);
  assert_below(worst, 1e-13);
  assert_true(least > 1e-4);
  for (int a = 0; a < ANGLES; a++) free(L[a]);
  block_wave_free(&w);
  return real;
}

static void a_real_matrix_has_real_panels(void **state) {
  (void)state;
  block_grid grid = block_grid_make((const int[]){9, 3, 2}, 1, 1);
  block_wave w;
  assert_true(block_wave_make(&grid, block_wave_exponents(&grid, NULL), 0.3, 40, &w));
  for (int k = 0; k < w.f.panels.n_panels; k++)
    assert_true(w.turns.is_real[k] && !w.turns.turns[k]);
  for (size_t i = 0; i < w.f.panels.n_rows / 3; i++) assert_int_equal(w.turns.g[i], 0);
  block_wave_free(&w);
  block_grid_free(&grid);
}

/* Phases h_r - h_c of node numbers h close no loop: g is h, counted from a panel's first row. */
static void phases_without_a_loop_are_turned_away(void **state) {
  (void)state;
  block_grid grid = block_grid_make((const int[]){9, 3, 2}, 1, 1);
  int       *h = calloc((size_t)grid.blocks.n, sizeof *h), turned = 0;
  block_wave w;
  for (int i = 0; i < grid.blocks.n; i++) h[i] = i % 10 < 4 || i % 3 == 0;
  assert_true(block_wave_make(&grid, block_wave_exponents(&grid, h), 0.3, 40, &w));
  int *at = malloc((size_t)grid.blocks.n * sizeof *at); /* h in the order of the factor */
  for (int i = 0; i < grid.blocks.n; i++) at[w.f.place[i]] = h[i];
  for (int k = 0; k < w.f.panels.n_panels; k++) {
    const fem_panel *p    = &w.f.panels.panel[k];
    bool             some = false;
    assert_true(w.turns.is_real[k]);
    for (int i = 0; i < p->rows; i += 3) {
      const int g = w.turns.g[(p->row + (size_t)i) / 3];
      assert_int_equal(g, at[block_factor_row(&w.f, k, i) / 3] - at[p->first / 3]);
      some = some || g != 0;
    }
    assert_true(w.turns.turns[k] == some);
    turned += some;
  }
  assert_true(turned > 0);
  free(at);
  block_wave_free(&w);
  assert_int_equal(check(&grid, block_wave_exponents(&grid, h)) > 0, 1);
  free(h);
  block_grid_free(&grid);
}

/* In a ring one turned link is a phase around it: the panels that close the ring are complex. */
static void a_loop_with_a_phase_is_complex(void **state) {
  (void)state;
  block_grid   grid = block_grid_line(61, 1, true);
  signed char *e    = block_wave_exponents(&grid, NULL);
  e[1]              = 1;
  const int    real = check(&grid, e);
  block_factor f;
  block_factor_make(&grid, &f);
  assert_true(real > 0 && real < f.panels.n_panels);
  block_factor_free(&f);
  block_grid_free(&grid);
}

/* A block of any numbers makes its panel complex, and those above. */
static void any_block_makes_the_panels_above_complex(void **state) {
  (void)state;
  block_grid   grid = block_grid_make((const int[]){9, 3, 2}, 1, 1);
  const int    r = grid.blocks.n / 2, q = grid.start[r] + 1;
  signed char *e = block_wave_exponents(&grid, NULL);
  block_wave   w;
  e[q] = FEM_ANY_BLOCK;
  assert_true(block_wave_make(&grid, e, 0.3, 40, &w));
  const int a = w.f.row[3 * r], b = w.f.row[3 * grid.column[q]];
  int       at = w.f.owner[a < b ? a : b], above = 0;
  bool     *wanted = calloc((size_t)w.f.panels.n_panels, sizeof *wanted);
  for (bool on = true; on;) {
    const fem_panel *p = &w.f.panels.panel[at];
    wanted[at]         = true;
    on                 = p->rows > p->columns;
    if (on) at = w.f.owner[block_factor_row(&w.f, at, p->columns)];
    above++;
  }
  for (int k = 0; k < w.f.panels.n_panels; k++) assert_true(w.turns.is_real[k] == !wanted[k]);
  print_message("%d of %d panels complex\n", above, w.f.panels.n_panels);
  assert_true(above < w.f.panels.n_panels);
  free(wanted);
  block_wave_free(&w);
  block_grid_free(&grid);
}

/* Each link of a line turns by one: g of far rows is above FEM_MOST_TURN. */
static void too_many_turns_count_as_complex(void **state) {
  (void)state;
  enum { NODES = 300 };
  block_grid grid = block_grid_line(NODES, 1, false);
  int        h[NODES], at[NODES], real = 0;
  bool       all[NODES]; /* no panel below has too many */
  block_wave w;
  for (int i = 0; i < NODES; i++) h[i] = i;
  assert_true(block_wave_make(&grid, block_wave_exponents(&grid, h), 0.3, 40, &w));
  for (int i = 0; i < NODES; i++) at[w.f.place[i]] = i;
  for (int k = 0; k < w.f.panels.n_panels; k++) all[k] = true;
  for (int k = 0; k < w.f.panels.n_panels; k++) {
    const fem_panel *p = &w.f.panels.panel[k];
    for (int i = 0; i < p->rows; i += 3)
      if (abs(at[block_factor_row(&w.f, k, i) / 3] - at[p->first / 3]) > FEM_MOST_TURN)
        all[k] = false;
    assert_true(w.turns.is_real[k] == all[k]);
    real += all[k];
    if (p->rows > p->columns && !all[k])
      all[w.f.owner[block_factor_row(&w.f, k, p->columns)]] = false;
  }
  print_message("%d of %d panels real\n", real, w.f.panels.n_panels);
  assert_true(real > 0 && real < w.f.panels.n_panels);
  block_wave_free(&w);
  block_grid_free(&grid);
}

static void no_node(void **state) {
  (void)state;
  block_grid grid = block_grid_line(0, 1, false);
  block_wave w;
  assert_true(block_wave_make(&grid, block_wave_exponents(&grid, NULL), 0.3, 40, &w));
  assert_true(block_wave_factorise(&w));
  block_wave_free(&w);
  block_grid_free(&grid);
  fem_panel_turns none = {0};
  fem_panel_turns_free(&none);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_real_matrix_has_real_panels),
      cmocka_unit_test(phases_without_a_loop_are_turned_away),
      cmocka_unit_test(a_loop_with_a_phase_is_complex),
      cmocka_unit_test(any_block_makes_the_panels_above_complex),
      cmocka_unit_test(too_many_turns_count_as_complex),
      cmocka_unit_test(no_node),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
