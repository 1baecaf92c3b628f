/* Random laws and motions over the whole admitted range, each determined by (seed, index). */
#ifndef TESTS_SUPPORT_RANDOM_MOTION_H
#define TESTS_SUPPORT_RANDOM_MOTION_H

#include "mhb/contact/contact.h"

enum { RANDOM_HARMONICS = 20, RANDOM_SIZES = 4 };

/* Sizes of the motions. The number of harmonics is drawn up to m, so one workspace serves a
 * size. */
extern const int random_size[RANDOM_SIZES];

typedef struct {
  unsigned long seed, index;
  int           size; /* into random_size */
  mhb_law       law;
  double        motion[3 * (2 * RANDOM_HARMONICS + 1)]; /* [3][2m+1], m = random_size[size] */
} random_motion;

/* Law and motion number `index` of a seed.
 *
 * mild: moderate ratios, for comparisons to many digits; else
 *   mu         0 (1 in 20), else 1e-3 .. 1e6, logarithmic
 *   stiffness  kv/kuu and kww/kuu 1e-6 .. 1e6, logarithmic; half of them skew, up to 1 - 1e-3 of
 *              singular
 *   preload    deep gap to deep stuck: n0 from -1e4 to 1e4 times the amplitude of kv v, half of
 *              them within 1.2
 *   motion     1 .. 20 harmonics decaying like k^0 .. k^-3, some absent; in half of the cases
 *              friction reaches 0.03 .. 30 times the limit, in the others any value; sometimes in
 *              phase, in one direction, or without v */
random_motion random_motion_of(unsigned long seed, unsigned long index, int mild);

/* Uniform in [0, 1); advances the state. */
double random_uniform(unsigned long *state);

#endif
