#include "cases/designs/design_table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/table/csv.h"

/* Record the first fault of a table at the plan that names it; line 0 is that of no row. */
static void table_fault(case_issues *issues, const case_node *at, const char *path, int line,
                        const char *text) {
  char number[32] = "";
  if (line > 0) snprintf(number, sizeof number, ":%d", line);
  case_issue_add(issues, at->line, at->column, "plan", "%s%s: %s", path, number, text);
}

/* A column becomes a key. False after a fault, which is recorded in own. */
static bool name_column(case_issues *own, const char *name, int number, study_keys *keys) {
  const case_node place = {.kind = CASE_SCALAR};
  if (!name[0]) {
    case_issue_add(own, 0, 0, NULL, "column %d has no name; expected a key of the case", number);
  } else if (keys->n == STUDY_MAX_KEYS) {
    case_issue_add(own, 0, 0, NULL, "the table has more than %d columns", STUDY_MAX_KEYS);
  } else if (study_key_start(own, &place, name, &keys->key[keys->n])) {
    for (int k = 0; k < keys->n; k++)
      if (strcmp(keys->key[k].path, name) == 0)
        case_issue_add(own, 0, 0, name, "is the column %d and %d", k + 1, number);
    keys->n++;
  }
  return own->n == 0;
}

/* The first row. */
static void read_header(case_issues *own, const mesh_table *t, study_keys *keys) {
  if (t->n_rows == 0)
    case_issue_add(own, 0, 0, NULL, "the table is empty; its first line names the varied keys");
  else if (!mesh_table_is_header(t, 0))
    case_issue_add(own, 0, 0, NULL,
                   "the first line holds numbers; it must name the varied keys, such as "
                   "contact.n0,contact.mu");
  if (own->n > 0) return;
  const int named = mesh_table_cells(t, 0), all = t->first[1] - t->first[0];
  for (int k = 0; k < all; k++) {
    const bool empty = k >= named; /* of columns without cells a comma may be left */
    if (empty && (t->n_rows < 2 || mesh_table_cells(t, 1) <= k)) return;
    if (!name_column(own, mesh_table_cell(t, 0, k)->text, k + 1, keys)) return;
  }
}

/* Whether a row has as many cells as the header. */
static bool check_cells(case_issues *own, const mesh_table *t, int row, const study_keys *keys) {
  const int   n    = mesh_table_cells(t, row);
  const char *hint = "";
  if (n == keys->n) return true;
  if (n > keys->n && t->separator == ',')
    hint = "; numbers have a decimal point, as commas separate columns";
  case_issue_add(own, 0, 0, NULL, "row %d has %d columns, the header has %d%s", row, n, keys->n,
                 hint);
  return false;
}

/* The cells of a row as values [keys->n]. */
static bool read_row(case_issues *own, const mesh_table *t, int row, const study_keys *keys,
                     double *value) {
  if (!check_cells(own, t, row, keys)) return false;
  for (int k = 0; k < keys->n; k++) {
    const mesh_cell *cell = mesh_table_cell(t, row, k);
    const case_node  node = {.kind = CASE_SCALAR, .text = cell->text};
    if (!study_key_number(own, &keys->key[k], &node, &value[k])) return false;
  }
  return true;
}

/* Returns the line of the first fault, which is recorded in own; 0: the header, or none. */
static int read_rows(case_issues *own, const mesh_table *t, const study_keys *keys, int *n,
                     double **design) {
  const int rows = t->n_rows - 1;
  if (rows > STUDY_MOST_DESIGNS) {
    case_issue_add(own, 0, 0, NULL, "%d designs; at most %d", rows, STUDY_MOST_DESIGNS);
    return 0;
  }
  *design = calloc((size_t)rows * (size_t)keys->n + 1, sizeof **design);
  if (!*design) case_issues_no_memory(own);
  for (int i = 1; *design && i <= rows; i++)
    if (!read_row(own, t, i, keys, *design + (size_t)(i - 1) * (size_t)keys->n))
      return mesh_table_line(t, i);
  *n = rows;
  return 0;
}

void design_table_read(case_issues *issues, const case_node *at, const char *path, study_keys *keys,
                       int *n, double **design) {
  mesh_table  table;
  case_issues own  = {0};
  int         line = 0;
  if (mesh_table_read(path, false, &table) != SHB_OK) {
    case_issue_add(issues, at->line, at->column, "plan", "%s", shb_message());
    return;
  }
  read_header(&own, &table, keys);
  if (own.n == 0) line = read_rows(&own, &table, keys, n, design);
  if (own.no_memory) case_issues_no_memory(issues);
  if (own.n > 0) table_fault(issues, at, path, line, own.issue[0].text);
  if (own.n > 0 || own.no_memory) {
    free(*design);
    *design = NULL;
    *n      = 0;
  }
  case_issues_free(&own);
  mesh_table_free(&table);
}

void design_table_columns(case_issues *issues, const case_node *at, const char *columns,
                          study_keys *keys) {
  for (const char *name = columns; *name;) {
    const size_t length = strcspn(name, "\n");
    char         path[CASE_PATH];
    case_path(path, "%.*s", (int)length, name);
    if (keys->n == STUDY_MAX_KEYS || !study_key_start(issues, at, path, &keys->key[keys->n]))
      return;
    keys->n++;
    name += length + (name[length] == '\n');
  }
}
