/* Relative frequency deviations of the blades of a ring. */
#ifndef MHB_MISTUNING_DEVIATIONS_H
#define MHB_MISTUNING_DEVIATIONS_H

#include "mesh/base/status.h"

/* A blade's frequency is (1 + deviation) times that of the tuned one, and above half of it. */
#define MHB_LEAST_DEVIATION (-0.5)

/* value[n] <- sample number `sample` of n independent normal numbers of mean 0 and the standard
 * deviation. The same seed and sample give the same numbers on every machine and in any order.
 * SHB_ERR_INPUT: a number is -50 % or less. */
shb_status mhb_deviations_random(double deviation, long seed, int sample, int n, double *value);

/* Read a table of numbers: a line a blade, one number (all modes of the blade) or n_modes numbers.
 * Columns are separated by commas, blanks or tabs; "%" after a number divides it by 100. Lines that
 * are empty or begin with # are passed over.
 *
 *   columns  out  1 or n_modes
 *   value    out  [blades][columns], to be freed by the caller
 *
 * Errors: SHB_ERR_IO the file cannot be read; SHB_ERR_INPUT another number of lines or columns, no
 * number, or a deviation of -50 % or less. The message names the line. */
shb_status mhb_deviations_read(const char *path, int blades, int n_modes, int *columns,
                               double **value);

#endif
