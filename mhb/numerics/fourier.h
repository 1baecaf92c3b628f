/* Trigonometric polynomials in real form, on a grid (FFTW) and at a point.
 *
 * A signal of m harmonics, x(t) = Re sum_{k=0..m} A_k exp(jkt), has 2m+1 real coefficients
 *   a[0] = Re A_0,  a[2k-1] = Re A_k,  a[2k] = Im A_k     on the basis   1,  cos kt,  -sin kt,
 * so that x = sum_i a[i] b_i(t) for motion and force alike. t is the phase; one period is 2 pi. */
#ifndef MHB_NUMERICS_FOURIER_H
#define MHB_NUMERICS_FOURIER_H

#include <complex.h>
#include <fftw3.h>

#include "mesh/base/arena.h"
#include "mesh/base/status.h"
#include "mhb/numerics/simd.h"

/* Number of real coefficients of m harmonics. */
static inline int mhb_real_size(int m) {
  return 2 * m + 1;
}

/* a[2m+1] <- A[m+1]; the imaginary part of A_0 is ignored. */
void mhb_to_real(int m, const double complex *A, double *a);

/* basis[2m+1] at t; slope[2m+1] its derivative by t (may be NULL). */
void mhb_basis(int m, double t, double *basis, double *slope);

/* integral[0..2n] += integrals over [t0, t1] of the basis up to harmonic n. */
void mhb_basis_integral(int n, double t0, double t1, double *integral);

/* product[i * ld + j] <- integral over a set of intervals of b_i b_j, i < 2p+1, j < 2q+1 (Toeplitz
 * + Hankel). integral: of the basis up to harmonic p + q. */
void mhb_basis_product(int p, int q, const double *integral, double *product, int ld);

/* Grids of 64, 128, ... points; the least one serves MHB_TABLE harmonics. */
enum { MHB_LEAST_GRID = 64, MHB_GRIDS = 12, MHB_TABLE = 7 };

/* Three signals of up to m harmonics: values and slopes on a grid, evaluation anywhere. The grid
 * has as many points as the highest harmonic that is not zero needs. */
typedef struct {
  int           m;
  int           top;          /* highest harmonic that is not zero */
  int           n_grid;       /* points of the grid in use, a multiple of MHB_LANES */
  int           largest_grid; /* n_grid for m harmonics */
  double       *coefficient;  /* [2m+1][3] */
  double       *derivative;   /* [2m+1][3], k times that of the same harmonic */
  double       *by_harmonic;  /* [m, to whole lanes][2][MHB_LANES] of each: see mhb_signals_at */
  double       *value[3];    /* [n_grid + MHB_LANES] at t = 2 pi i/n_grid, continued periodically */
  double       *slope[3];    /* the same */
  double        bound[3][5]; /* [signal][j] = sum_k k^j |A_k| >= |d^j x/dt^j| */
  fftw_complex *spectrum;    /* [6][largest_grid/2 + 1] */
  double       *samples;     /* [6][largest_grid + MHB_LANES]: value, slope */
  double   *wave; /* [MHB_TABLE][2][MHB_LEAST_GRID] cos kt, sin kt, k from 1, on the least grid */
  fftw_plan plan[MHB_GRIDS]; /* for 128 points, ... as far as m needs them; 64 have the table */
  shb_arena arena;
} mhb_signals;

/* FFTW plans are made here and only here. SHB_ERR_IO: no memory, or more harmonics than the largest
 * grid serves. */
shb_status mhb_signals_create(int m, mhb_signals *signals);
void       mhb_signals_destroy(mhb_signals *signals);

/* Takes the coefficients a[signal][2m+1]; fills grid and bounds. O(n_grid log n_grid). */
void mhb_signals_set(mhb_signals *signals, const double *const a[3]);

/* Values, first and (unless NULL) second derivatives at t. O(m). */
void mhb_signals_at(const mhb_signals *signals, double t, double y[3], double dy[3], double ddy[3]);

/* Values and slopes at eight phases, given by their cosine and sine. */
MHB_INLINE void mhb_signals_at_lanes(const mhb_signals *signals, mhb_lanes cosine, mhb_lanes sine,
                                     mhb_lanes y[3], mhb_lanes dy[3]) {
  const double *a = signals->coefficient, *b = signals->derivative;
  mhb_lanes     c = lanes_all(1), s = lanes_all(0);
  for (int i = 0; i < 3; i++) {
    y[i]  = lanes_all(a[i]);
    dy[i] = lanes_all(0);
  }
  a += 3;
  b += 3;
  for (int k = 1; k <= signals->top; k++, a += 6, b += 6) {
    mhb_lanes next = c * cosine - s * sine;
    s              = s * cosine + c * sine;
    c              = next;
    for (int i = 0; i < 3; i++) {
      y[i] += a[i] * c - a[i + 3] * s;
      dy[i] -= b[i] * s + b[i + 3] * c;
    }
  }
}

#endif
