#include "tests/support/block_wave.h"

#include "tests/support/check.h"

static int count_of(const block_grid *grid) {
  return grid->start[grid->blocks.n];
}

signed char *block_wave_exponents(const block_grid *grid, const int *h) {
  signed char *e = calloc((size_t)count_of(grid) + 1, 1);
  assert_non_null(e);
  for (int r = 0; h && r < grid->blocks.n; r++)
    for (int k = grid->start[r]; k < grid->start[r + 1]; k++)
      e[k] = (signed char)(h[r] - h[grid->column[k]]);
  return e;
}

/* The block of the matrix; any block on the diagonal is Hermitian, by its upper half. */
static void set_block(const block_wave *w, int k, bool diagonal, double theta, uint64_t *seed) {
  const double        *from = w->real + 9 * (size_t)k;
  double complex      *to   = w->all[k];
  const double complex by   = cexp(I * theta * w->exponent[k]);
  for (int i = 0; i < 9; i++) to[i] = by * from[i];
  if (w->exponent[k] != FEM_ANY_BLOCK) return;
  for (int i = 0; i < 9; i++) to[i] = CMPLX(from[i], block_random(seed));
  for (int d = 0; d < 3 && diagonal; d++) {
    to[4 * d] = from[4 * d];
    for (int e = 0; e < d; e++) to[d + 3 * e] = conj(to[e + 3 * d]);
  }
}

static void set_matrix(block_wave *w, double theta) {
  const block_grid *grid = w->f.grid;
  uint64_t          seed = 29;
  int               n    = 0;
  for (int r = 0; r < grid->blocks.n; r++)
    for (int k = grid->start[r]; k < grid->start[r + 1]; k++) {
      set_block(w, k, grid->column[k] == r, theta, &seed);
      w->coupled_at[k] = w->exponent[k] != 0 ? n++ : -1;
      if (w->exponent[k] != 0) memcpy(w->coupled[n - 1], w->all[k], sizeof *w->all);
    }
}

/* Places of the panels' numbers: real ones, and the others with twice as many.
 *   size  out  of both */
static void place_panels(block_wave *w, size_t size[2]) {
  size[0] = size[1] = 0;
  for (int k = 0; k < w->f.panels.n_panels; k++) {
    fem_panel   *p    = &w->f.panels.panel[k];
    const size_t one  = (size_t)p->columns * (size_t)p->rows;
    const bool   real = w->turns.is_real[k];
    p->value          = size[!real];
    size[!real] += real ? one : 2 * one;
  }
}

bool block_wave_make(const block_grid *grid, signed char *exponent, double theta, double diagonal,
                     block_wave *w) {
  const size_t count = (size_t)count_of(grid);
  size_t       size[2];
  *w            = (block_wave){.exponent = exponent};
  w->coupled_at = malloc((count + 1) * sizeof *w->coupled_at);
  w->coupled    = malloc((count + 1) * sizeof *w->coupled);
  w->all        = malloc((count + 1) * sizeof *w->all);
  assert_true(w->coupled_at && w->coupled && w->all);
  w->real = block_grid_values(grid, diagonal, 41);
  block_factor_make(grid, &w->f);
  set_matrix(w, theta);
  fem_panel_turns_create(&w->f.panels, &w->f.lower, exponent, &w->turns);
  place_panels(w, size);
  w->real_value = malloc((size[0] + 1) * sizeof *w->real_value);
  w->panels     = (fem_hermitian_panels){.s     = &w->f.panels,
                                         .turns = &w->turns,
                                         .real  = w->real_value,
                                         .other = malloc((size[1] + 1) * sizeof(double))};
  assert_true(w->real_value && w->panels.other);
  fem_hermitian_set_phase(cexp(I * theta), &w->panels);
  return fem_supernodal_factorise(&w->f.panels, &w->f.lower, w->real, w->turns.is_real,
                                  w->real_value);
}

bool block_wave_factorise(block_wave *w) {
  const fem_hermitian_blocks A = {&w->f.lower, w->real, w->coupled_at,
                                  (const double complex(*)[9])w->coupled};
  return fem_hermitian_factorise(&A, &w->panels);
}

void block_wave_free(block_wave *w) {
  fem_panel_turns_free(&w->turns);
  block_factor_free(&w->f);
  free(w->exponent);
  free(w->coupled_at);
  free(w->coupled);
  free(w->all);
  free(w->real);
  free(w->real_value);
  free(w->panels.other);
  *w = (block_wave){0};
}
