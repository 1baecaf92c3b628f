/* The value of `optimise` in STUDY.yaml: what is minimised, under which limits, by which method. */
#ifndef CASES_DESIGNS_STUDY_OPTIMISE_H
#define CASES_DESIGNS_STUDY_OPTIMISE_H

#include "cases/designs/study_keys.h"

enum { STUDY_MAX_LIMITS = 16 };

/* In the order of optimise.algorithm. */

typedef enum {
  STUDY_SBPLX,  /* simplices in subspaces, local */
  STUDY_CRS,    /* controlled random search, global */
  STUDY_ISRES,  /* evolution, global */
  STUDY_DIRECT, /* division of rectangles, global */
  STUDY_SLOPE, /* root of the slope of the peak along one key; each start has a part of the range */
  STUDY_N_ALGORITHMS
} study_algorithm;

/* An output that may be at most (least: at least) this, SI. */
typedef struct {
  int    output;
  bool   least;
  double value;
} study_limit;

typedef struct {
  bool            wanted;
  int             objective; /* output that is minimised */
  int             n_limits;
  study_limit     limit[STUDY_MAX_LIMITS];
  int             evaluations, starts; /* of all starts together; these share them equally */
  int             seed;
  bool            free_algorithm; /* none was asked for */
  study_algorithm algorithm;
} study_optimise;

/* The outputs of a study, which a reader may append to. */
typedef struct {
  const case_file *base;
  int             *n;
  study_output    *output; /* [STUDY_MAX_OUTPUTS] */
} study_outputs;

/* Read the mapping. Outputs that it names are appended to those of the study. Faults are
 * recorded. */
void study_optimise_read(case_issues *issues, const case_node *node, const study_outputs *outputs,
                         study_optimise *optimise);

/* Check the keys, and choose an algorithm if none was asked for. Make the first designs of all
 * starts: the middle of the ranges, then a Latin hypercube. The two corners of the ranges stand
 * before them, to be checked.
 *   design  out  [n][keys->n] malloc'ed, NULL after a fault */
void study_optimise_starts(case_issues *issues, const case_node *at, const study_outputs *outputs,
                           const study_keys *keys, study_optimise *optimise, int *n,
                           double **design);

/* Index of the derivative of the peak by a key (peak_derivatives.h); -1: there is none. */
int study_key_derivative(const case_file *base, const study_key *key);

/* "sbplx", ... */
const char *study_algorithm_name(study_algorithm algorithm);

#endif
