/* Reproducible pseudo-random numbers: the linear congruential generator of Knuth (MMIX). */
#ifndef MHB_NUMERICS_RANDOM_H
#define MHB_NUMERICS_RANDOM_H

/* The next number in [-1, 1); any seed. */
static inline double mhb_random(unsigned long long *seed) {
  *seed = *seed * 6364136223846793005ULL + 1442695040888963407ULL;
  return (double)(*seed >> 11) * 0x1p-52 - 1;
}

#endif
