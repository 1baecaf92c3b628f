/* Relative frequency deviations of the blades of a ring. */
#ifndef MHB_MISTUNING_DEVIATIONS_H
#define MHB_MISTUNING_DEVIATIONS_H

#include "mesh/base/status.h"

/* A blade's frequency is (1 + deviation) times that of the tuned one: above half of it, and at most
 * twice. */
#define MHB_LEAST_DEVIATION (-0.5)
#define MHB_MOST_DEVIATION 1.0

/* value[n] <- sample number `sample` of n independent normal numbers of mean 0 and the standard
 * deviation. The same seed and sample give the same numbers on every machine and in any order.
 * SHB_ERR_INPUT: a number is -50 % or less. */
shb_status mhb_deviations_random(double deviation, long seed, int sample, int n, double *value);

#endif
