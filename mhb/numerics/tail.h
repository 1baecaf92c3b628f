/* The tail of a spectrum from its last two octaves.
 *
 * Where a motion has a kink its harmonics fall like k^-p: p = 2 for a jump of the velocity, 3 for
 * one of the acceleration. The sums of the squares over two neighbouring octaves have
 * the ratio 2^(1-2p). It gives p, and the geometric series of all octaves that follow. */
#ifndef MHB_NUMERICS_TAIL_H
#define MHB_NUMERICS_TAIL_H

/* Fewer harmonics than this have no two octaves to speak of. */
enum { MHB_LEAST_OF_TAIL = 8 };

typedef struct {
  double order; /* p seen; infinite where a look at it is not possible */
  double rms;   /* root of the sum of the squares of all harmonics above */
  double sum;   /* sum of their sizes, which bounds their signal */
} mhb_tail;

/* The tail above harmonic top.
 *   power   in  [top + 1] squares of the sizes of harmonics 1..top
 *   margin  in  the order counted with is the one seen less this, at least 1.25 */
mhb_tail mhb_tail_of(int top, const double *power, double margin);

#endif
