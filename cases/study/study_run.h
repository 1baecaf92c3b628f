/* A study from its designs to its files: what is left to do, resumption, publication. */
#ifndef CASES_STUDY_STUDY_RUN_H
#define CASES_STUDY_STUDY_RUN_H

#include "cases/designs/study_spec.h"
#include "cases/study/crew.h"
#include "mesh/base/progress.h"
#include "postproc/study/design_study.h"

/* Run all designs of a checked study on the manager, and publish NAME.study.h5 and NAME.study.csv.
 *
 * Designs whose digest is in NAME.study.h5, or in another study file beside it, are taken from
 * there. Equal designs of the study are computed once. The file is published at most every 10 s,
 * and at the end.
 *
 *   force  in   take nothing from files
 *   study  out  the result; free it in any case
 * Errors: SHB_NOT_CONVERGED some design failed, all is published; SHB_INTERRUPTED, likewise so far;
 * SHB_ERR_IO. */
shb_status study_run(const study_spec *spec, bool force, const crew_staff *workers,
                     shb_progress *progress, design_study *study);

/* Path of a file of the study: folder/NAME and a suffix; malloc'ed. */
char *study_path(const study_spec *spec, const char *suffix);

/* Print what came out: the number of designs, the range of each output, the files. */
void study_run_summary(const study_spec *spec, const design_study *study, FILE *out);

#endif
