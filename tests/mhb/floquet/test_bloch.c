/* Multipliers of a ring of cells against those of the whole ring's matrix. */
#include <lapacke.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mhb/floquet/bloch.h"

enum { STATES = 4, MOST = 6 * STATES };

static double noise(unsigned *seed) {
  *seed = *seed * 1664525u + 1013904223u;
  return *seed / 4294967296. - .5;
}

/* C <- A B, [n][n] column-major */
static void multiply(int n, const double *A, const double *B, double *C) {
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      double sum = 0;
      for (int k = 0; k < n; k++) sum += A[k * n + i] * B[j * n + k];
      C[j * n + i] = sum;
    }
}

/* The block-circulant matrix of a stretch, to the power chunks, cells then renamed: what cell c
 * holds is cell c + names. */
static void whole_ring(int cells, const double *S, int chunks, int names, double *out) {
  int    n                 = cells * STATES;
  double once[MOST * MOST] = {0}, power[MOST * MOST];
  for (int to = 0; to < n; to++)
    for (int from = 0; from < n; from++) {
      int c               = (to / STATES - from / STATES + cells) % cells;
      once[from * n + to] = S[(c * STATES + from % STATES) * STATES + to % STATES];
    }
  memcpy(power, once, sizeof power);
  for (int i = 1; i < chunks; i++) {
    multiply(n, once, power, out);
    memcpy(power, out, sizeof power);
  }
  for (int row = 0; row < n; row++)
    for (int column = 0; column < n; column++)
      out[column * n + (row + names * STATES) % n] = power[column * n + row];
}

/* Greatest distance from one of a to the nearest of b. */
static double distance(int n, const double complex *a, const double complex *b) {
  double most = 0;
  for (int i = 0; i < n; i++) {
    double least = INFINITY;
    for (int k = 0; k < n; k++) least = fmin(least, cabs(a[i] - b[k]));
    most = fmax(most, least);
  }
  return most;
}

static void cells_give_the_ring(void **state) {
  (void)state;
  static const int rows[][3] = {{1, 1, 0}, {1, 5, 0}, {2, 3, 1}, {3, 1, 0}, {3, 2, 1},
                                {4, 3, 2}, {5, 2, 3}, {5, 1, 4}, {6, 4, 5}};
  unsigned         seed      = 7;
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    int            cells = rows[i][0], n = cells * STATES;
    double         S[6 * STATES * STATES], whole[MOST * MOST], re[MOST], im[MOST];
    double complex mine[MOST], other[MOST];
    mhb_bloch      bloch;
    for (int k = 0; k < cells * STATES * STATES; k++) S[k] = noise(&seed);
    mhb_bloch_create(cells, STATES, &bloch);
    assert_true(mhb_bloch_multipliers(&bloch, STATES, S, rows[i][1], rows[i][2], mine));
    mhb_bloch_destroy(&bloch);
    whole_ring(cells, S, rows[i][1], rows[i][2], whole);
    assert_int_equal(
        LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'N', n, whole, n, re, im, NULL, 1, NULL, 1), 0);
    for (int k = 0; k < n; k++) other[k] = CMPLX(re[k], im[k]);
    double off = fmax(distance(n, mine, other), distance(n, other, mine));
    print_message("%d cells, %d stretches, names %d: off by %.1e\n", cells, rows[i][1], rows[i][2],
                  off);
    assert_true(off < 1e-9);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(cells_give_the_ring)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
