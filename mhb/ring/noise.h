/* Normal random numbers that are the same on every machine: splitmix64 (Steele, Lea, Flood 2014)
 * and the transform of Box and Muller (1958). */
#ifndef MHB_RING_NOISE_H
#define MHB_RING_NOISE_H

#include <stdint.h>

typedef struct {
  uint64_t state; /* any seed */
} mhb_noise;

/* Mean 0, variance 1. */
double mhb_noise_normal(mhb_noise *noise);

#endif
