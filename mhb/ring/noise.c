#include "mhb/ring/noise.h"

#include <math.h>

#include "mesh/base/constants.h"

static uint64_t next(mhb_noise *noise) {
  uint64_t z = noise->state += 0x9e3779b97f4a7c15u;
  z          = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z          = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/* Uniform in (0, 1). */
static double uniform(mhb_noise *noise) {
  return ((double)(next(noise) >> 11) + 0.5) / 9007199254740992.;
}

double mhb_noise_normal(mhb_noise *noise) {
  double size = sqrt(-2 * log(uniform(noise)));
  return size * cos(SHB_TWO_PI * uniform(noise));
}
