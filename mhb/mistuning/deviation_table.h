/* Deviations or frequencies of the blades of a ring from a table (mesh/table/csv). */
#ifndef MHB_MISTUNING_DEVIATION_TABLE_H
#define MHB_MISTUNING_DEVIATION_TABLE_H

#include <stdbool.h>

#include "mesh/base/status.h"

typedef struct {
  const char *path;
  bool        hz;      /* the numbers are frequencies in Hz: deviation = f/mean - 1 */
  double      mean;    /* Hz, of a single column; 0: the mean of each column */
  int         blades;  /* rows */
  int         n_modes; /* 0: not known, any number of columns */
} mhb_deviation_table;

/* Read a line a blade with one number (all modes of the blade) or n_modes numbers. "%" behind a
 * deviation divides it by 100, "Hz" may stand behind a frequency. A first row of names is passed
 * over. If the first of them begins with "blade", that column has the numbers of the blades, from 0
 * or from 1, in any order.
 *
 *   columns  out  1 or n_modes
 *   value    out  [blades][columns] deviations, to be freed by the caller
 *
 * Errors: SHB_ERR_IO the file cannot be read; SHB_ERR_INPUT another number of lines or columns, no
 * number, another unit, a deviation out of bounds (mhb/mistuning/deviations). The message names
 * line and column. */
shb_status mhb_deviation_table_read(const mhb_deviation_table *table, int *columns, double **value);

#endif
