#include "mhb/numerics/thin_product.h"

#include <stddef.h>

#include "mhb/numerics/simd.h"

typedef float float_lanes __attribute__((vector_size(32)));

/* Rows of A at once: with them the sums, a row of x and an element of A fit into 16 registers. */
enum { ROWS = 6 };

/* Both precisions. A group is two vectors wide. */
#define MHB_THIN_PRODUCT(name, number, vector)                                                     \
  MHB_INLINE void name##_rows(int rows, int n, const number A[], const number x[], number out[]) { \
    enum { WIDTH = sizeof(vector) / sizeof(number) };                                              \
    vector sum[ROWS][2] = {{{0}}};                                                                 \
    for (int j = 0; j < n; j++) {                                                                  \
      vector left, right;                                                                          \
      memcpy(&left, x + (size_t)j * 2 * WIDTH, sizeof left);                                       \
      memcpy(&right, x + (size_t)j * 2 * WIDTH + WIDTH, sizeof right);                             \
      _Pragma("GCC unroll 6") for (int i = 0; i < rows; i++) {                                     \
        const number a = A[(size_t)i * (size_t)n + (size_t)j];                                     \
        sum[i][0] += a * left;                                                                     \
        sum[i][1] += a * right;                                                                    \
      }                                                                                            \
    }                                                                                              \
    memcpy(out, sum, (size_t)rows * sizeof sum[0]);                                                \
  }                                                                                                \
                                                                                                   \
  MHB_HOT void name(int n, int groups, const number A[], const number x[], number out[]) {         \
    const size_t rows = (size_t)n, width = 2 * sizeof(vector) / sizeof(number);                    \
    for (size_t i = 0; i < rows; i += ROWS)                                                        \
      for (size_t g = 0; g < (size_t)groups; g++) {                                                \
        const size_t of = g * width * rows, to = of + i * width;                                   \
        if (rows - i >= ROWS)                                                                      \
          name##_rows(ROWS, n, A + i * rows, x + of, out + to);                                    \
        else                                                                                       \
          for (size_t j = 0; j < rows - i; j++)                                                    \
            name##_rows(1, n, A + (i + j) * rows, x + of, out + to + j * width);                   \
      }                                                                                            \
  }

MHB_THIN_PRODUCT(mhb_thin_product, double, mhb_half_lanes)
MHB_THIN_PRODUCT(mhb_thin_product_single, float, float_lanes)
