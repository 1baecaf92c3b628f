/* A table of designs: a CSV file whose header names the varied keys. */
#ifndef CASES_DESIGNS_DESIGN_TABLE_H
#define CASES_DESIGNS_DESIGN_TABLE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct {
  int    n_columns, n_rows;
  char **column; /* [n_columns] header; they point into text */
  char **cell;   /* [n_rows][n_columns] as written, without surrounding blanks */
  int   *line;   /* [n_rows] where a row stands in the file, from 1 */
  char  *text;
} design_table;

/* Read a CSV file with commas. Empty lines are left out; cells are not quoted. False with a reason,
 * one line. Free it after success. */
bool design_table_read(const char *path, design_table *table, char *why, size_t size);
void design_table_free(design_table *table);

#endif
