/* Products and substitutions of small dense blocks, by tiles that registers hold. A part of
 * block_cyclic.c, which includes it once for each width of the registers, with these set:
 *   TILES(name)                        the functions' names
 *   TILE_HOT                           for which processors they are compiled
 *   tile_lanes, TILE_LANES             a register and its numbers
 *   TILE_ROWS                          rows of a tile, 4 or 8; its columns are two registers
 *   tile_load, tile_store              a register from and to memory
 * Every number is a sum in the order of the columns of A, whatever the tiles. */

enum { TILES(TILE) = 2 * TILE_LANES };

/* sum[rows][vectors] -= A[rows][from..to) X, both with rows of width */
MHB_INLINE void TILES(subtract_tile)(int rows, int vectors, int from, int to, int width,
                                     const double *A, const double *X, tile_lanes sum[][2]) {
  for (int l = from; l < to; l++)
    for (int i = 0; i < rows; i++)
      for (int j = 0; j < vectors; j++)
        sum[i][j] -= A[i * width + l] * tile_load(X + l * width + j * TILE_LANES);
}

MHB_INLINE void TILES(load_tile)(int rows, int vectors, int width, const double *X,
                                 tile_lanes sum[][2]) {
  for (int i = 0; i < rows; i++)
    for (int j = 0; j < vectors; j++) sum[i][j] = tile_load(X + i * width + j * TILE_LANES);
}

MHB_INLINE void TILES(store_tile)(int rows, int vectors, int width, double *X,
                                  tile_lanes sum[][2]) {
  for (int i = 0; i < rows; i++)
    for (int j = 0; j < vectors; j++) tile_store(X + i * width + j * TILE_LANES, sum[i][j]);
}

/* Rows `at` on of a tile of X <- those of lower factor^-1 X; the rows before are solved. */
MHB_INLINE void TILES(lower_tile)(int rows, int vectors, int at, int width, const double *A,
                                  double *X) {
  tile_lanes sum[TILE_ROWS][2] = {{{0}}};
  A += at * width;
  TILES(load_tile)(rows, vectors, width, X + at * width, sum);
  TILES(subtract_tile)(rows, vectors, 0, at, width, A, X, sum);
  for (int i = 1; i < rows; i++)
    for (int l = 0; l < i; l++)
      for (int j = 0; j < vectors; j++) sum[i][j] -= A[i * width + at + l] * sum[l][j];
  TILES(store_tile)(rows, vectors, width, X + at * width, sum);
}

/* The same of the upper factor of n rows; the rows behind are solved. */
MHB_INLINE void TILES(upper_tile)(int rows, int vectors, int at, int n, int width, const double *A,
                                  const double *inverse, double *X) {
  tile_lanes sum[TILE_ROWS][2] = {{{0}}};
  A += at * width;
  TILES(load_tile)(rows, vectors, width, X + at * width, sum);
  TILES(subtract_tile)(rows, vectors, at + rows, n, width, A, X, sum);
  for (int i = rows - 1; i >= 0; i--) {
    for (int l = i + 1; l < rows; l++)
      for (int j = 0; j < vectors; j++) sum[i][j] -= A[i * width + at + l] * sum[l][j];
    for (int j = 0; j < vectors; j++) sum[i][j] *= inverse[at + i];
  }
  TILES(store_tile)(rows, vectors, width, X + at * width, sum);
}

/* All rows of a tile of X: whole tiles, then rows one by one; back in the opposite order. */
MHB_INLINE void TILES(substitute_tile)(int vectors, int n, int width, const double *A,
                                       const double *inverse, double *X) {
  const int whole = n / TILE_ROWS * TILE_ROWS, four = whole + (n - whole) / 4 * 4;
  for (int i = 0; i < whole; i += TILE_ROWS) TILES(lower_tile)(TILE_ROWS, vectors, i, width, A, X);
  for (int i = whole; i < four; i += 4) TILES(lower_tile)(4, vectors, i, width, A, X);
  for (int i = four; i < n; i++) TILES(lower_tile)(1, vectors, i, width, A, X);
  for (int i = n - 1; i >= four; i--) TILES(upper_tile)(1, vectors, i, n, width, A, inverse, X);
  for (int i = four - 4; i >= whole; i -= 4)
    TILES(upper_tile)(4, vectors, i, n, width, A, inverse, X);
  for (int i = whole - TILE_ROWS; i >= 0; i -= TILE_ROWS)
    TILES(upper_tile)(TILE_ROWS, vectors, i, n, width, A, inverse, X);
}

/* `columns` columns of A[n][width] from `first` on, in whole vectors of eight, <- the solution with
 * the factors in its first n columns. */
TILE_HOT static void TILES(substitute_rows)(int n, int width, int first, int columns, double *A) {
  double  inverse[n];
  double *X = A + first, *end = X + columns;
  for (int i = 0; i < n; i++) inverse[i] = 1 / A[i * (width + 1)];
  for (; X + TILES(TILE) <= end; X += TILES(TILE))
    TILES(substitute_tile)(2, n, width, A, inverse, X);
  for (; X < end; X += TILE_LANES) TILES(substitute_tile)(1, n, width, A, inverse, X);
}

/* A tile of the product of A[..][s], with rows of `stride`, and B[s][width]. */
MHB_INLINE void TILES(multiply_tile)(int rows, int vectors, int s, int stride, int width,
                                     const double *A, const double *B, double *C) {
  tile_lanes sum[TILE_ROWS][2] = {{{0}}};
  for (int l = 0; l < s; l++)
    for (int i = 0; i < rows; i++)
      for (int j = 0; j < vectors; j++)
        sum[i][j] += A[i * stride + l] * tile_load(B + l * width + j * TILE_LANES);
  TILES(store_tile)(rows, vectors, width, C, sum);
}

MHB_INLINE void TILES(multiply_rows)(int rows, int columns, int s, int stride, int width,
                                     const double *A, const double *B, double *C) {
  int j = 0;
  for (; j + TILES(TILE) <= columns; j += TILES(TILE))
    TILES(multiply_tile)(rows, 2, s, stride, width, A, B + j, C + j);
  for (; j < columns; j += TILE_LANES)
    TILES(multiply_tile)(rows, 1, s, stride, width, A, B + j, C + j);
}

/* C[rows][columns] <- A[rows][s] B[s][columns], columns in whole vectors of eight. A has rows of
 * `stride`, B and C have rows of width. */
TILE_HOT static void TILES(multiply)(int rows, int columns, int s, int stride, int width,
                                     const double *A, const double *B, double *C) {
  int i = 0;
  for (; i + TILE_ROWS <= rows; i += TILE_ROWS) TILES(multiply_rows)
  (TILE_ROWS, columns, s, stride, width, A + i * stride, B, C + i * width);
  for (; i + 2 <= rows; i += 2)
    TILES(multiply_rows)(2, columns, s, stride, width, A + i * stride, B, C + i * width);
  for (; i < rows; i++)
    TILES(multiply_rows)(1, columns, s, stride, width, A + i * stride, B, C + i * width);
}

#undef TILES
#undef TILE_HOT
#undef TILE_LANES
#undef TILE_ROWS
#undef tile_lanes
#undef tile_load
#undef tile_store
