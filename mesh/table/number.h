/* Numbers in the cells of a table. */
#ifndef MESH_TABLE_NUMBER_H
#define MESH_TABLE_NUMBER_H

#include "mesh/table/csv.h"

/* Digits with a sign, and no more. */
bool mesh_text_is_whole(const char *text);

/* The number in a cell, whatever the locale, and what stands behind it.
 *
 *   expected  in   what would be right, for messages: "a deviation such as 0.01 or 1 %"
 *   value     out  finite
 *   suffix    out  the rest of the cell without leading blanks: "", "%", "Hz"; borrowed
 *
 * SHB_ERR_INPUT: no number, nan, inf, hexadecimal, a decimal comma. A comma that separates cells is
 * taken for a decimal one where the next cell has a leading zero, as in 0,05. The message names
 * line and column. */
shb_status mesh_table_number(const mesh_table *table, int row, int column, const char *expected,
                             double *value, const char **suffix);

#endif
