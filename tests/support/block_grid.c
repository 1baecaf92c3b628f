#include "tests/support/block_grid.h"

#include "tests/support/check.h"

/* ------------------------------------------------------------------ patterns */

/* Nodes i, j of a grid with cells of step^3: is there a cell with both? */
static bool share_cell(int i, int j, int step) {
  const int low = i < j ? i : j, high = i < j ? j : i;
  return high <= low / step * step + step;
}

static block_grid allocate(int n, int neighbours) {
  block_grid grid;
  grid.start  = calloc((size_t)n + 1, sizeof(int));
  grid.column = malloc(((size_t)neighbours * (size_t)n + 1) * sizeof(int));
  assert_true(grid.start && grid.column);
  grid.blocks = (fem_blocks){n, grid.start, grid.column};
  return grid;
}

block_grid block_grid_make(const int cells[3], int step, int bodies) {
  const int  nx = step * cells[0] + 1, ny = step * cells[1] + 1, nz = step * cells[2] + 1;
  const int  each = nx * ny * nz, n = bodies * each;
  block_grid grid = allocate(n, 125);
  int        at   = 0;
  for (int r = 0; r < n; r++) {
    const int x = r % nx, y = r / nx % ny, z = r % each / (nx * ny), base = r / each * each;
    for (int w = z; w < nz && w <= z + step; w++)
      for (int v = y - step < 0 ? 0 : y - step; v < ny && v <= y + step; v++)
        for (int u = x - step < 0 ? 0 : x - step; u < nx && u <= x + step; u++) {
          const int c = base + (w * ny + v) * nx + u;
          if (c >= r && share_cell(x, u, step) && share_cell(y, v, step) && share_cell(z, w, step))
            grid.column[at++] = c;
        }
    grid.start[r + 1] = at;
  }
  return grid;
}

block_grid block_grid_line(int nodes, int band, bool closed) {
  block_grid grid = allocate(nodes, 2 * band + 1);
  int        at   = 0;
  for (int r = 0; r < nodes; r++) {
    for (int c = r; c < nodes; c++)
      if (c - r <= band || (closed && r + nodes - c <= band)) grid.column[at++] = c;
    grid.start[r + 1] = at;
  }
  return grid;
}

void block_grid_free(block_grid *grid) {
  free(grid->start);
  free(grid->column);
  *grid = (block_grid){0};
}

bool *block_grid_fill(const block_grid *grid, const int *place) {
  const fem_blocks *b    = &grid->blocks;
  const size_t      n    = (size_t)b->n;
  bool             *fill = calloc(n * n + 1, sizeof *fill);
  assert_non_null(fill);
  for (int r = 0; r < b->n; r++)
    for (int k = b->start[r]; k < b->start[r + 1]; k++) {
      const size_t i                      = (size_t)(place ? place[r] : r);
      const size_t j                      = (size_t)(place ? place[b->column[k]] : b->column[k]);
      fill[i < j ? i * n + j : j * n + i] = true;
    }
  for (size_t k = 0; k < n; k++)
    for (size_t j = k + 1; j < n; j++)
      for (size_t i = j; fill[k * n + j] && i < n; i++)
        fill[j * n + i] = fill[j * n + i] || fill[k * n + i];
  return fill;
}

/* ------------------------------------------------------------------ numbers */

double block_random(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (double)(*state >> 11) * 0x1p-52 - 1;
}

double *block_grid_values(const block_grid *grid, double diagonal, uint64_t seed) {
  const fem_blocks *b     = &grid->blocks;
  double           *value = malloc((9 * (size_t)b->start[b->n] + 1) * sizeof *value);
  assert_non_null(value);
  for (int r = 0; r < b->n; r++)
    for (int k = b->start[r]; k < b->start[r + 1]; k++) {
      double *B = value + 9 * (size_t)k;
      for (int i = 0; i < 9; i++) B[i] = block_random(&seed);
      if (b->column[k] != r) continue;
      for (int d = 0; d < 3; d++) {
        B[4 * d] += diagonal;
        for (int e = 0; e < d; e++) B[d + 3 * e] = B[e + 3 * d];
      }
    }
  return value;
}

/* ------------------------------------------------------------------ factor */

void block_factor_make(const block_grid *grid, block_factor *f) {
  cholmod_common common;
  const size_t   nodes = (size_t)grid->blocks.n;
  *f                   = (block_factor){.grid = grid, .n = 3 * grid->blocks.n};
  f->place             = malloc((nodes + 1) * sizeof *f->place);
  f->row               = malloc((3 * nodes + 1) * sizeof *f->row);
  f->owner             = malloc((3 * nodes + 1) * sizeof *f->owner);
  assert_true(f->place && f->row && f->owner);
  fem_cholmod_start(&common);
  cholmod_factor *L = fem_block_analyse(&grid->blocks, &common, f->place);
  assert_non_null(L);
  fem_lower_pattern_create(&grid->blocks, f->place, &f->lower);
  fem_supernodes_create(L, &f->panels);
  cholmod_free_factor(&L, &common);
  cholmod_finish(&common);
  f->value = malloc((f->panels.n_values + 1) * sizeof *f->value);
  assert_non_null(f->value);
  for (int i = 0; i < f->n; i++) f->row[i] = 3 * f->place[i / 3] + i % 3;
  for (int k = 0; k < f->panels.n_panels; k++)
    for (int c = 0; c < f->panels.panel[k].columns; c++) f->owner[f->panels.panel[k].first + c] = k;
}

void block_factor_free(block_factor *f) {
  fem_supernodes_free(&f->panels);
  fem_lower_pattern_free(&f->lower);
  free(f->place);
  free(f->row);
  free(f->owner);
  free(f->value);
  *f = (block_factor){0};
}

double complex *block_factor_dense_complex(const block_factor *f,
                                           const double        complex (*block)[9]) {
  const fem_blocks *b = &f->grid->blocks;
  const size_t      n = (size_t)f->n;
  double complex   *A = calloc(n * n + 1, sizeof *A);
  assert_non_null(A);
  for (int r = 0; r < b->n; r++)
    for (int k = b->start[r]; k < b->start[r + 1]; k++)
      for (int i = 0; i < 9; i++) {
        const size_t row    = (size_t)f->row[3 * r + i % 3];
        const size_t column = (size_t)f->row[3 * b->column[k] + i / 3];
        A[column * n + row] = block[k][i];
        A[row * n + column] = conj(block[k][i]);
      }
  return A;
}

double *block_factor_dense(const block_factor *f, const double *block) {
  const size_t n = (size_t)f->n, count = (size_t)f->grid->start[f->grid->blocks.n];
  double      *A              = malloc((n * n + 1) * sizeof *A);
  double       complex(*z)[9] = malloc((count + 1) * sizeof *z);
  assert_true(A && z);
  for (size_t i = 0; i < 9 * count; i++) z[i / 9][i % 9] = block[i];
  double complex *same = block_factor_dense_complex(f, (const double complex(*)[9])z);
  for (size_t i = 0; i < n * n; i++) A[i] = creal(same[i]);
  free(z);
  free(same);
  return A;
}

int block_factor_row(const block_factor *f, int panel, int i) {
  return fem_supernodes_row(&f->panels, f->panels.panel[panel].row + (size_t)i);
}
