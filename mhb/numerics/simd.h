/* Eight numbers at once: the nodes of a panel, or eight neighbouring points of a grid.
 *
 * GCC and Clang vector extensions: one AVX-512 register, two of AVX2, four of SSE2. Functions
 * marked MHB_HOT are compiled for each of them; one is chosen when the program starts. Functions
 * marked MHB_INLINE become part of their callers.
 *
 * A running sum has four numbers: GCC keeps one of eight in memory where registers hold four, and
 * every term then waits for the memory. */
#ifndef MHB_NUMERICS_SIMD_H
#define MHB_NUMERICS_SIMD_H

#include <limits.h>
#include <math.h>
#include <string.h>

enum { MHB_LANES = 8, MHB_HALF_LANES = 4 };

typedef double    mhb_lanes __attribute__((vector_size(64)));
typedef double    mhb_half_lanes __attribute__((vector_size(32))); /* for running sums */
typedef long long mhb_lanes_bits __attribute__((vector_size(64)));

#define MHB_INLINE static inline __attribute__((always_inline))

#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__clang__)
#define MHB_HOT __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define MHB_HOT
#endif

/* A function for registers of eight numbers, where mhb_has_wide(). It may have running sums of
 * eight. */
#if defined(__x86_64__) && defined(__GNUC__)
#define MHB_HAS_WIDE
#define MHB_WIDE __attribute__((target("avx512f,avx512dq,avx512vl,avx512bw,fma")))
#endif

static inline int mhb_has_wide(void) {
#ifdef MHB_HAS_WIDE
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
#else
  return 0;
#endif
}

/* The smaller and the larger of two numbers, without a call; b if a is not a number. */
MHB_INLINE double mhb_least(double a, double b) {
  return a < b ? a : b;
}

MHB_INLINE double mhb_most(double a, double b) {
  return a > b ? a : b;
}

/* n rounded up to whole vectors. */
static inline int mhb_whole_lanes(int n) {
  return (n + MHB_LANES - 1) / MHB_LANES * MHB_LANES;
}

MHB_INLINE mhb_lanes lanes_all(double x) {
  return (mhb_lanes){x, x, x, x, x, x, x, x};
}

/* From and to memory of any alignment. */
MHB_INLINE mhb_lanes lanes_load(const double *x) {
  mhb_lanes y;
  memcpy(&y, x, sizeof y);
  return y;
}

MHB_INLINE void lanes_store(double *x, mhb_lanes y) {
  memcpy(x, &y, sizeof y);
}

MHB_INLINE mhb_half_lanes half_lanes_load(const double *x) {
  mhb_half_lanes y;
  memcpy(&y, x, sizeof y);
  return y;
}

MHB_INLINE void half_lanes_store(double *x, mhb_half_lanes y) {
  memcpy(x, &y, sizeof y);
}

/* Lane i in all lanes; i a constant after unrolling. */
MHB_INLINE mhb_lanes lanes_pick(mhb_lanes x, int i) {
#ifdef __clang__
  return lanes_all(x[i]);
#else
  return __builtin_shuffle(x, (mhb_lanes_bits){i, i, i, i, i, i, i, i});
#endif
}

/* Lanes 2i and 2i + 1 change places. */
MHB_INLINE mhb_lanes lanes_swap(mhb_lanes x) {
#ifdef __clang__
  return __builtin_shufflevector(x, x, 1, 0, 3, 2, 5, 4, 7, 6);
#else
  return __builtin_shuffle(x, (mhb_lanes_bits){1, 0, 3, 2, 5, 4, 7, 6});
#endif
}

/* x moved up by n lanes, n = 1, 2, 4 a constant; `low` fills the lanes below. */
MHB_INLINE mhb_lanes lanes_rise(mhb_lanes low, mhb_lanes x, int n) {
#ifdef __clang__
  return n == 1   ? __builtin_shufflevector(x, low, 8, 0, 1, 2, 3, 4, 5, 6)
         : n == 2 ? __builtin_shufflevector(x, low, 8, 9, 0, 1, 2, 3, 4, 5)
                  : __builtin_shufflevector(x, low, 8, 9, 10, 11, 0, 1, 2, 3);
#else
  return n == 1   ? __builtin_shuffle(x, low, (mhb_lanes_bits){8, 0, 1, 2, 3, 4, 5, 6})
         : n == 2 ? __builtin_shuffle(x, low, (mhb_lanes_bits){8, 9, 0, 1, 2, 3, 4, 5})
                  : __builtin_shuffle(x, low, (mhb_lanes_bits){8, 9, 10, 11, 0, 1, 2, 3});
#endif
}

/* The rows x of an 8 by 8 matrix become its columns. */
MHB_INLINE void lanes_transpose(mhb_lanes x[MHB_LANES]) {
#ifdef __clang__
#define MHB_SHUFFLE(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#else
#define MHB_SHUFFLE(a, b, ...) __builtin_shuffle(a, b, (mhb_lanes_bits){__VA_ARGS__})
#endif
#pragma GCC unroll 8
  for (int i = 0; i < 4; i++) {
    mhb_lanes a = x[i], b = x[i + 4];
    x[i]     = MHB_SHUFFLE(a, b, 0, 1, 2, 3, 8, 9, 10, 11);
    x[i + 4] = MHB_SHUFFLE(a, b, 4, 5, 6, 7, 12, 13, 14, 15);
  }
#pragma GCC unroll 8
  for (int k = 0; k < 4; k++) {
    int       i = k / 2 * 4 + k % 2;
    mhb_lanes a = x[i], b = x[i + 2];
    x[i]     = MHB_SHUFFLE(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
    x[i + 2] = MHB_SHUFFLE(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
  }
#pragma GCC unroll 8
  for (int i = 0; i < MHB_LANES; i += 2) {
    mhb_lanes a = x[i], b = x[i + 1];
    x[i]     = MHB_SHUFFLE(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
    x[i + 1] = MHB_SHUFFLE(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
  }
#undef MHB_SHUFFLE
}

MHB_INLINE double lanes_sum(mhb_lanes x) {
  return ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]));
}

MHB_INLINE mhb_lanes lanes_where(mhb_lanes_bits mask, mhb_lanes a, mhb_lanes b) {
  return (mhb_lanes)((mask & (mhb_lanes_bits)a) | (~mask & (mhb_lanes_bits)b));
}

MHB_INLINE mhb_lanes lanes_min(mhb_lanes a, mhb_lanes b) {
  return lanes_where(a < b, a, b);
}

MHB_INLINE mhb_lanes lanes_max(mhb_lanes a, mhb_lanes b) {
  return lanes_where(a > b, a, b);
}

MHB_INLINE mhb_lanes lanes_abs(mhb_lanes x) {
  return (mhb_lanes)((mhb_lanes_bits)x & LLONG_MAX); /* all but the sign */
}

MHB_INLINE mhb_lanes lanes_sqrt(mhb_lanes x) {
  for (int i = 0; i < MHB_LANES; i++) x[i] = sqrt(x[i]);
  return x;
}

/* Largest and smallest lane; NaN lanes may be ignored. */
MHB_INLINE double lanes_top(mhb_lanes x) {
  double a = x[0] > x[4] ? x[0] : x[4], b = x[1] > x[5] ? x[1] : x[5];
  double c = x[2] > x[6] ? x[2] : x[6], d = x[3] > x[7] ? x[3] : x[7];
  a = a > c ? a : c;
  b = b > d ? b : d;
  return a > b ? a : b;
}

MHB_INLINE double lanes_bottom(mhb_lanes x) {
  return -lanes_top(-x);
}

/* cos r and sin r to rounding for |r| <= pi/4: minimax polynomials with coefficients of fdlibm. */
MHB_INLINE void lanes_cos_sin_small(mhb_lanes r, mhb_lanes *cosine, mhb_lanes *sine) {
  mhb_lanes z = r * r;
  mhb_lanes s = 2.75573137070700676789e-06 +
                z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10);
  s = -1.66666666666666324348e-01 +
      z * (8.33333333332248946124e-03 + z * (-1.98412698298579493134e-04 + z * s));
  mhb_lanes c = -2.75573143513906633035e-07 +
                z * (2.08757232129817482790e-09 - z * 1.13596475577881948265e-11);
  c = 4.16666666666666019037e-02 +
      z * (-1.38888888888741095749e-03 + z * (2.48015872894767294178e-05 + z * c));
  *sine   = r + r * z * s;
  *cosine = 1 - .5 * z + z * z * c;
}

/* atan x to rounding for |x| < 7/16, with the coefficients of fdlibm. */
#define MHB_ATAN_REACH .4375
MHB_INLINE mhb_lanes lanes_atan(mhb_lanes x) {
  mhb_lanes z = x * x, w = z * z, v = w * w;
  mhb_lanes a = (3.33333333333329318027e-01 + w * 1.42857142725034663711e-01) +
                v * ((9.09088713343650656196e-02 + w * 6.66107313738753120669e-02) +
                     v * (4.97687799461593236017e-02 + w * 1.62858201153657823623e-02));
  mhb_lanes b = (-1.99999999998764832476e-01 - w * 1.11111104054623557880e-01) +
                v * ((-7.69187620504482999495e-02 - w * 5.83357013379057348645e-02) -
                     v * 3.65315727442169155270e-02);
  return x - x * (z * a + w * b);
}

/* atan x to 4e-7 for |x| <= 1: interpolated in x^2 at Chebyshev's points. */
MHB_INLINE mhb_lanes lanes_atan_rough(mhb_lanes x) {
  mhb_lanes z = x * x, z2 = z * z;
  mhb_lanes low = .99999923 - .33325678 * z, high = .083126453 - .036360431 * z;
  mhb_lanes middle = .1987204 - .13447864 * z;
  return x * (low + z2 * (middle + z2 * (high + z2 * .0076483539)));
}

/* cos x and sin x to rounding for |x| < 1e5. The argument is reduced by multiples of pi/2, which is
 * held in two parts. */
MHB_INLINE void lanes_cos_sin(mhb_lanes x, mhb_lanes *cosine, mhb_lanes *sine) {
  const double   magic = 6755399441055744.0; /* 1.5 2^52: adding it rounds to an integer */
  mhb_lanes      turns = x * 0.63661977236758134308 + magic;
  mhb_lanes_bits n     = (mhb_lanes_bits)turns;
  turns -= magic;
  mhb_lanes r = x - turns * 1.57079632673412561417, c, s;
  r -= turns * 6.07710050650619224932e-11;
  lanes_cos_sin_small(r, &c, &s);
  mhb_lanes_bits swap     = -(n & 1);
  mhb_lanes_bits sin_sign = (n & 2) << 62, cos_sign = ((n + 1) & 2) << 62;
  *sine   = (mhb_lanes)((mhb_lanes_bits)lanes_where(swap, c, s) ^ sin_sign);
  *cosine = (mhb_lanes)((mhb_lanes_bits)lanes_where(swap, s, c) ^ cos_sign);
}

/* exp x and exp -x for |x| < 700, to 7e-15 of the value. The argument is reduced by multiples of
 * ln 2. Taylor's series to degree 11 follows; its rest is 6.3e-15. */
MHB_INLINE mhb_lanes lanes_exp(mhb_lanes x, mhb_lanes *inverse) {
  const double   magic = 6755399441055744.0;
  mhb_lanes      turns = x * 1.44269504088896338700 + magic;
  mhb_lanes_bits n     = (mhb_lanes_bits)turns << 52; /* the low bits of magic are zero */
  turns -= magic;
  mhb_lanes r = (x - turns * 6.93147180369123816490e-01) - turns * 1.90821492927058770002e-10;
  mhb_lanes s = r * r, s2 = s * s;
  mhb_lanes even =
      (1 + s * .5) + s2 * ((1. / 24 + s * (1. / 720)) + s2 * (1. / 40320 + s * (1. / 3628800)));
  mhb_lanes odd = (1 + s * (1. / 6)) +
                  s2 * ((1. / 120 + s * (1. / 5040)) + s2 * (1. / 362880 + s * (1. / 39916800)));
  *inverse = (mhb_lanes)((mhb_lanes_bits)(even - r * odd) - n);
  return (mhb_lanes)((mhb_lanes_bits)(even + r * odd) + n);
}

#endif
