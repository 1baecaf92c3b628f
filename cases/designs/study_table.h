/* The keys of a study file: a row each, as those of a case. */
#ifndef CASES_DESIGNS_STUDY_TABLE_H
#define CASES_DESIGNS_STUDY_TABLE_H

#include <stdio.h>

#include "cases/parse/keys.h"
#include "cases/parse/yaml.h"

enum { STUDY_MOST_DESIGNS = 100000, STUDY_MOST_STARTS = 64, STUDY_LEAST_A_START = 5 };
/* 95 % of confidence in an upper bound of the 95 % percentile takes 72 samples. */
enum { STUDY_LEAST_SAMPLES = 8 };

/* Every key of a study file, in the order of the manual. "{}" stands for a name of the user's
 * choice: "vary{}.from" for from of each varied key. */
case_keys study_key_table(void);

/* Read the value of a key into slot by its row. False after a fault, which is recorded.
 *   path  in  that of messages */
bool study_table_read(case_issues *issues, const char *row, const char *path, const case_node *node,
                      void *slot);

/* slot <- the default of a row. */
void study_table_default(const char *row, void *slot);

/* Refuse an unknown key of a block ("" for the top), with the key that was probably meant. */
void study_table_refuse(case_issues *issues, const char *block, const char *path,
                        const case_node *node);

/* The table as text, for `shroudhb keys study`. */
void study_print_keys(FILE *out);

#endif
