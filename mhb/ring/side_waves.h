/* Side waves of a modulated wave: lines in frequency and nodal diameter.
 *
 *   X(f, n) = 2/sum(w) 1/N sum_{s,b} w_s x(s, b) exp(-j 2 pi f s/S) exp(+j 2 pi n b/N)
 * for S samples a period, w Hann's window in time. Blades are exact: no window. Lines are looked
 * for between 0.5 and 1.5 times the excitation's frequency, beside the wave itself. A line that
 * falls between two bins is placed by its larger neighbour (Rife, Vincent 1970). Quadratic coupling
 * with the wave gives pairs: n_1 + n_2 = 2 E modulo N, offsets d and -d. */
#ifndef MHB_RING_SIDE_WAVES_H
#define MHB_RING_SIDE_WAVES_H

#include "mesh/base/status.h"

/* Samples a period of the excitation. Lines counted. */
enum { MHB_SIDE_SAMPLES = 16, MHB_SIDE_WAVES = 5 };

typedef struct {
  int    diameter; /* 0 to N - 1: the next blade lags by 2 pi n/N; -1: none */
  double offset;   /* frequency over that of the excitation, less 1 */
  double size;     /* amplitude over the wave's */
} mhb_side_wave;

typedef struct {
  mhb_side_wave wave[MHB_SIDE_WAVES]; /* largest first */
  double        share; /* of the power beside the wave that these lines have; 1 if there is none */
} mhb_side_waves;

/* Lines of x[periods * MHB_SIDE_SAMPLES][3 axes][blades], unchanged. engine_order: of the wave. */
void mhb_side_waves_find(const double *x, int periods, int blades, int engine_order,
                         mhb_side_waves *found);

#endif
