/* Random laws and motions over the whole range the program admits, each known by (seed, index)
 * alone. */
#ifndef TESTS_SUPPORT_RANDOM_MOTION_H
#define TESTS_SUPPORT_RANDOM_MOTION_H

#include "mhb/contact/contact.h"

enum { RANDOM_HARMONICS = 20, RANDOM_SIZES = 4 };

/* Motions come in these sizes: harmonics in use are drawn up to m, so that a workspace a size
 * serves all. */
extern const int random_size[RANDOM_SIZES];

typedef struct {
  unsigned long seed, index;
  int           size; /* into random_size */
  mhb_law       law;
  double        motion[3 * (2 * RANDOM_HARMONICS + 1)]; /* [3][2m+1], m = random_size[size] */
} random_motion;

/* mild: moderate ratios, for comparisons to many digits; else
 *   mu         0 (1 in 20), else 1e-3 .. 1e6, logarithmic
 *   stiffness  kv/kuu and kww/kuu 1e-6 .. 1e6, logarithmic; half of them skew, up to 1 - 1e-3 of singular
 *   preload    deep gap to deep stuck: n0 from -1e4 to 1e4 times the amplitude of kv v, half of them within 1.2
 *   motion     1 .. 20 harmonics decaying like k^0 .. k^-3, some absent; friction reaching for .03 .. 30 times the limit
 *              in half of the cases and for anything in the others; now and then in phase, in one direction, without v */
random_motion random_motion_of(unsigned long seed, unsigned long index, int mild);

/* uniform in [0, 1) out of a state that moves on */
double random_uniform(unsigned long *state);

#endif
