/* What the benchmarks of studies share: a model, random numbers, the peak that a study has of a
 * design, the highest point of a sweep. */
#ifndef TESTS_BENCH_STUDIED_DESIGNS_H
#define TESTS_BENCH_STUDIED_DESIGNS_H

#include "cases/commands/load_model.h"
#include "mhb/response/response.h"

/* The highest peak of a design. */
typedef struct {
  bool   done;
  char   reason[256];
  double peak, at, error; /* m, Hz, m: told */
  double cpu;             /* s */
} studied_peak;

/* The highest point of a sweep. */
typedef struct {
  bool   complete; /* every main curve covers the range */
  double peak, at; /* m, Hz */
  double cpu;      /* s, of all sweeps so far */
} swept_peak;

/* Read a modal file, or make the small random ring where file is NULL, with settings for it and no
 * lasting motion. One thread. Errors: those of modal_model_read. */
shb_status studied_model(const char *file, case_model *model);

/* The peak as a study has it. */
shb_status studied_peak_find(const case_model *model, studied_peak *out);

/* The highest point of a sweep of the whole range.
 *   accuracy  in      factor of the law's tolerance
 *   out       in/out  cpu grows
 *   response  out     the sweep, to be destroyed; NULL: not wanted */
shb_status swept_peak_find(const case_model *model, int harmonics, double accuracy, bool outline,
                           swept_peak *out, mhb_response **response);

/* Numbers between 0 and 1 (Lehmer, modulus 2^31 - 1). */
double next_random(unsigned long *state);
/* Even in the logarithm. */
double random_between(double low, double high, unsigned long *state);

#endif
