/* A table of comma-separated values, as spreadsheets and people write it.
 *
 * Cells are separated by tabs, semicolons or commas: by the first of these in the first row that
 * has one. A first line "sep=X" says so instead. In a file without any, blanks before a number or a
 * quote separate, if the reader allows it. Lines end with LF, CRLF or CR. A UTF-8 byte-order mark
 * is passed over, and so are rows without any text and rows that begin with #. Errors of a
 * spreadsheet, as #N/A, are cells. A cell in double quotes holds anything; two quotes within stand
 * for one (RFC 4180). */
#ifndef MESH_TABLE_CSV_H
#define MESH_TABLE_CSV_H

#include <stdbool.h>
#include <stddef.h>

#include "mesh/base/status.h"

typedef struct {
  char  *text; /* without quotes and surrounding blanks */
  size_t length;
  int    line, column; /* of its first character, from 1; columns count characters */
} mesh_cell;

typedef struct {
  const char *path;      /* borrowed */
  char        separator; /* ' ': blanks; NUL: a single column */
  int         n_rows;
  int        *first; /* [n_rows + 1] place in cell of the first cell of a row; at the end all */
  mesh_cell  *cell;
  char       *text; /* the cells point into it */
} mesh_table;

/* Read a table; free it after success. blanks: blanks may separate.
 * Errors: SHB_ERR_IO unreadable; SHB_ERR_INPUT above 256 MiB, binary data, a quote that is not
 * closed, text behind a closed one. The message names line and column. */
shb_status mesh_table_read(const char *path, bool blanks, mesh_table *table);
void       mesh_table_free(mesh_table *table); /* also a zeroed one */

/* Number of cells of a row, without empty ones at its end. */
int mesh_table_cells(const mesh_table *table, int row);

const mesh_cell *mesh_table_cell(const mesh_table *table, int row, int column);

/* Line of the file where a row stands. */
int mesh_table_line(const mesh_table *table, int row);

/* Whether a row holds names: no cell of it begins as a number or formula does. An error of a
 * spreadsheet, nan and inf are no names. */
bool mesh_table_is_header(const mesh_table *table, int row);

#endif
