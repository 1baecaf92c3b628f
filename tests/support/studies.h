/* Design studies in closed form, one of each kind. */
#ifndef TESTS_SUPPORT_STUDIES_H
#define TESTS_SUPPORT_STUDIES_H

#include "postproc/study/design_study.h"

typedef enum {
  STUDIES_GRID,      /* 9 x 3 x 3 designs of n0, mu and a thickness; some failed */
  STUDIES_PAIR,      /* 8 x 5 designs of two keys, all done */
  STUDIES_OPTIMISE,  /* 60 evaluations of n0 and mu, the best on both upper bounds */
  STUDIES_UNCERTAIN, /* 256 samples, percentiles and Sobol' indices */
  STUDIES_ROBUST,    /* 5 preloads with 40 samples each */
  STUDIES_LARGE,     /* 2000 scattered designs of four keys with curves */
  STUDIES_ONE,       /* one design of one key */
  STUDIES_EMPTY,     /* no design */
  STUDIES_FAILED,    /* every design failed */
  STUDIES_N
} studies_kind;

/* "grid", "pair", ... */
const char *studies_name(studies_kind kind);

/* The peak of a design in m: 60 um (0.25 + 0.6 ln^2(n0 mu / 45 N)) (5 mm / thickness)^1.5. */
double studies_peak(double n0, double mu, double thickness);

/* Make a study; free it with design_study_free. Fails the test without memory. */
void studies_make(studies_kind kind, design_study *study);

#endif
