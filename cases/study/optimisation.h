/* An optimisation as a study: which design comes next, what its result means, what was best. */
#ifndef CASES_STUDY_OPTIMISATION_H
#define CASES_STUDY_OPTIMISATION_H

#include "cases/designs/study_spec.h"
#include "postproc/study/design_study.h"

typedef struct optimisation optimisation;

/* Begin. Designs are appended to the study, which has none. Errors: SHB_ERR_IO. */
shb_status optimisation_create(const study_spec *spec, design_study *study, optimisation **out);
void       optimisation_destroy(optimisation *o);

/* Results of another study, which is taken over: its designs are not computed again. Errors:
 * SHB_ERR_IO no memory; the study is freed then, too. */
shb_status optimisation_know(optimisation *o, design_study *known);

/* The next design to compute and its values [n_keys]; -1: none at present. Errors are kept for
 * optimisation_finish. */
int optimisation_next(optimisation *o, const double **value);

/* A design has its result. */
void optimisation_done(optimisation *o, int design);

/* Order the designs by evaluation and start, whatever the order in which they came, and set the
 * study's optimum. Errors: SHB_ERR_IO. */
shb_status optimisation_finish(optimisation *o);

#endif
