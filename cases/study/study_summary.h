/* What came out of a study, for a terminal. */
#ifndef CASES_STUDY_STUDY_SUMMARY_H
#define CASES_STUDY_STUDY_SUMMARY_H

#include <stdio.h>

#include "postproc/study/design_study.h"

/* Print the statistics of uncertain keys, if there are any: percentiles with bounds, and what
 * matters most for each output. */
void study_summary_statistics(const design_study *study, FILE *out);

#endif
