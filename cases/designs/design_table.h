/* A table of designs: a CSV file whose first row names the varied keys (mesh/table/csv.h). */
#ifndef CASES_DESIGNS_DESIGN_TABLE_H
#define CASES_DESIGNS_DESIGN_TABLE_H

#include "cases/designs/study_keys.h"

/* Take the columns of a table as varied keys, and its rows as designs.
 *
 *   at      in   for messages: where the study file names the table
 *   n       out  rows
 *   design  out  [n][keys->n] malloc'ed, SI; NULL after a fault, which is recorded */
void design_table_read(case_issues *issues, const case_node *at, const char *path, study_keys *keys,
                       int *n, double **design);

/* Take keys by their names, one a line, which came from a table. */
void design_table_columns(case_issues *issues, const case_node *at, const char *columns,
                          study_keys *keys);

#endif
