#include "mhb/mistuning/deviations.h"

#include <math.h>
#include <stdint.h>

#include "mesh/base/constants.h"

/* splitmix64 (Steele, Lea, Flood 2014). */
static uint64_t next(uint64_t *state) {
  uint64_t z = *state += 0x9e3779b97f4a7c15ULL;
  z          = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z          = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/* In (0, 1]. */
static double uniform(uint64_t *state) {
  return ((double)(next(state) >> 11) + 1) * 0x1p-53;
}

shb_status mhb_deviations_random(double deviation, long seed, int sample, int n, double *value) {
  uint64_t first = (uint64_t)seed, state = next(&first) + (uint64_t)sample * 0xda942042e4dd58b5ULL;
  for (int i = 0; i < n; i += 2) { /* Box and Muller (1958) */
    const double r = deviation * sqrt(-2 * log(uniform(&state)));
    const double a = SHB_TWO_PI * uniform(&state);
    value[i]       = r * cos(a);
    if (i + 1 < n) value[i + 1] = r * sin(a);
  }
  for (int i = 0; i < n; i++)
    SHB_CHECK(value[i] > MHB_LEAST_DEVIATION, SHB_ERR_INPUT,
              "rotor.mistuning: the deviation of blade %d of sample %d is %.3g %%, must be above "
              "-50 %%; give a smaller deviation than %.3g %%",
              i, sample, 100 * value[i], 100 * deviation);
  return SHB_OK;
}
