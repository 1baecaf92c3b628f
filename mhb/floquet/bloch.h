/* Multipliers of a ring of g equal cells, N/g blades each, from the map of one cell's disturbances
 * over a segment of the period.
 *
 * With g = gcd(E, N) the wave repeats every N/g blades: the map of all disturbances is
 * block-circulant. By Bloch's theorem an eigenvector is psi e^{i kappa c} in cell c, kappa = 2 pi
 * l/g:
 *   S(kappa) psi = lambda psi,   S(kappa) = sum over cells c of e^{-i kappa c} S_c,
 * S_c the end states of cell c after a disturbance of cell 0. At the end of each segment the blades
 * are renamed; over a period that is a shift by k cells. The multiplier is e^{-i kappa k}
 * lambda^n_segments. So g problems of n states, half of them conjugates of the others, replace one
 * of g n. */
#ifndef MHB_FLOQUET_BLOCH_H
#define MHB_FLOQUET_BLOCH_H

#include <complex.h>
#include <stdbool.h>

#include "mesh/base/arena.h"
#include "mesh/base/status.h"
#include "mhb/floquet/hessenberg_qr.h"

typedef struct {
  int               cells, capacity; /* g; states a cell */
  double           *real;            /* [capacity][capacity] */
  double           *re, *im;         /* [capacity] */
  double complex   *matrix;          /* [capacity][capacity] */
  double complex   *value;           /* [capacity] */
  double           *work;            /* [size] */
  int              *pivot;           /* [capacity] */
  int               size;
  mhb_hessenberg_qr qr;      /* with three cells or more */
  double           *aligned; /* [n_aligned] multipliers with the symmetry of the wave, above 0 */
  int               n_aligned;
  int               wave;    /* l of the largest multiplier of the last call */
  double complex    largest; /* its lambda */
  shb_arena         arena;
} mhb_bloch;

/* For up to capacity states a cell. */
void mhb_bloch_create(int cells, int capacity, mhb_bloch *bloch);
void mhb_bloch_destroy(mhb_bloch *bloch);

/* Number of Bloch problems that are solved: kappa of l = 0 to cells/2. The others are their
 * conjugates. */
int mhb_bloch_waves(const mhb_bloch *bloch);

/* Whether S(kappa) of wave l is real: with an eigenvalue it has the conjugate. */
bool mhb_bloch_is_real(const mhb_bloch *bloch, int l);

/* lambda[n] <- the eigenvalues of S(kappa) of wave l, S as below. Conjugates of a real S(kappa) are
 * side by side. Returns 0 if the eigensolver failed. */
int mhb_bloch_eigenvalues(mhb_bloch *bloch, int n, const double *S, int l, double complex *lambda);

/* The multiplier of an eigenvalue of wave l; cell_shift: k. */
double complex mhb_bloch_multiplier(const mhb_bloch *bloch, int l, int n_segments, int cell_shift,
                                    double complex lambda);

/* Multipliers of S [cells][n][n], column-major. Those of kappa = 0 with a positive lambda are
 * aligned. Their disturbance repeats from segment to segment as the wave does, without change of
 * sign. Only such a multiplier passes 1 at a fold of the wave.
 *   cell_shift  in   k
 *   multiplier  out  [cells n], conjugates side by side
 * Returns 0 if the eigensolver failed. */
int mhb_bloch_multipliers(mhb_bloch *bloch, int n, const double *S, int n_segments, int cell_shift,
                          double complex *multiplier);

/* Modulus of a multiplier of another S, near the S of the last call. It continues the largest
 * multiplier of that call: lambda is the nearest of the same kappa. By inverse iteration. NAN: it
 * failed. */
double mhb_bloch_continued(mhb_bloch *bloch, int n, const double *S, int n_segments);

#endif
