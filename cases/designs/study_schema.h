/* The keys of STUDY.yaml as a JSON Schema (draft 7): editors complete and check a study by it. */
#ifndef CASES_DESIGNS_STUDY_SCHEMA_H
#define CASES_DESIGNS_STUDY_SCHEMA_H

#include <stdio.h>

/* The schema. Its paths of varied keys are the numbers of the key table of cases. What depends on
 * the case, such as names of probes, is left to `shroudhb check`. */
void study_print_schema(FILE *out);

#endif
