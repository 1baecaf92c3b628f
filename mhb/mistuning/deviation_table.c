#include "mhb/mistuning/deviation_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "mesh/base/memory.h"
#include "mesh/table/number.h"
#include "mhb/mistuning/deviations.h"

typedef struct {
  const mhb_deviation_table *as;
  mesh_table                 text;
  int                        header, numbered; /* 1: a row of names, a column of blade numbers */
  int                        columns;
  bool                       pairs; /* all are whole numbers, two by two: 0,1 and 115,83 */
  int                       *blade; /* [blades] of each row */
  double                    *value; /* [blades][columns] */
} reading;

static int line_of(const reading *r, int row) {
  return mesh_table_line(&r->text, r->header + row);
}

static const char *expected_of(const reading *r) {
  return r->as->hz ? "a frequency such as 117.25 or 117.25 Hz" : "a deviation such as 0.01 or 1 %";
}

/* ---- shape ---- */

/* What else makes two numbers of one. */
static const char TWO[] =
    "; decimals have a point, and numbers of blades a line of names above them";

static shb_status check_rows(const reading *r) {
  const int   rows = r->text.n_rows - r->header, blades = r->as->blades;
  const char *header = r->header ? " below a line of names" : "";
  SHB_CHECK(rows <= blades, SHB_ERR_INPUT,
            "%s:%d: more than %d lines%s; expected one a blade (rotor.blades)", r->as->path,
            line_of(r, blades), blades, header);
  SHB_CHECK(rows == blades, SHB_ERR_INPUT,
            "%s: %d lines of numbers%s; expected %d, one a blade (rotor.blades)", r->as->path, rows,
            header, blades);
  return SHB_OK;
}

/* The first number of each row is read for a decimal comma, which makes two columns of one. */
static shb_status check_columns(reading *r) {
  const int n_modes = r->as->n_modes;
  for (int i = 0; i < r->as->blades; i++) {
    const int   n = mesh_table_cells(&r->text, r->header + i) - r->numbered;
    double      first;
    const char *suffix;
    SHB_CHECK(n >= 1, SHB_ERR_INPUT, "%s:%d: no number behind that of the blade", r->as->path,
              line_of(r, i));
    SHB_TRY(
        mesh_table_number(&r->text, r->header + i, r->numbered, expected_of(r), &first, &suffix));
    const char *hint = n == 2 ? TWO : "";
    SHB_CHECK(n == 1 || n_modes == 0 || n == n_modes, SHB_ERR_INPUT,
              "%s:%d: %d numbers; expected one for all modes, or one for each of the %d modes%s",
              r->as->path, line_of(r, i), n, n_modes, hint);
    SHB_CHECK(i == 0 || n == r->columns, SHB_ERR_INPUT,
              "%s:%d: %d numbers, but %d in the lines before%s", r->as->path, line_of(r, i), n,
              r->columns, hint);
    r->columns = n;
  }
  SHB_CHECK(r->as->mean == 0 || r->columns == 1, SHB_ERR_INPUT,
            "%s: %d columns; rotor.mistuning.mean goes with one, leave it out", r->as->path,
            r->columns);
  return SHB_OK;
}

/* ---- the blades ---- */

static shb_status read_number(const reading *r, int row, double *number) {
  const char *suffix;
  SHB_TRY(
      mesh_table_number(&r->text, r->header + row, 0, "the number of a blade", number, &suffix));
  SHB_CHECK(!*suffix && *number >= 0 && *number <= r->as->blades && *number == floor(*number),
            SHB_ERR_INPUT, "%s:%d: '%.20s' is not the number of a blade; expected 1 to %d",
            r->as->path, line_of(r, row), mesh_table_cell(&r->text, r->header + row, 0)->text,
            r->as->blades);
  return SHB_OK;
}

/* Rows are in the order of the blades unless a column numbers them. */
static shb_status read_blades(reading *r) {
  const int blades = r->as->blades;
  double    number = 0, least = INFINITY;
  for (int i = 0; i < blades; i++) {
    r->blade[i] = i;
    if (r->numbered) SHB_TRY(read_number(r, i, &number));
    if (r->numbered) r->blade[i] = (int)number;
    least = fmin(least, r->blade[i]);
  }
  for (int i = 0; i < blades; i++) {
    r->blade[i] -= (int)least;
    SHB_CHECK(r->blade[i] < blades, SHB_ERR_INPUT,
              "%s:%d: blade %d of %d; they count from 0 or from 1", r->as->path, line_of(r, i),
              r->blade[i] + (int)least, blades);
    for (int k = 0; k < i; k++)
      SHB_CHECK(r->blade[k] != r->blade[i], SHB_ERR_INPUT, "%s:%d: blade %d is in line %d already",
                r->as->path, line_of(r, i), r->blade[i] + (int)least, line_of(r, k));
  }
  return SHB_OK;
}

/* ---- numbers ---- */

static const mesh_cell *cell_of(const reading *r, int row, int column) {
  return mesh_table_cell(&r->text, r->header + row, r->numbered + column);
}

static shb_status check_deviation(const reading *r, const mesh_cell *c, double x) {
  const char *hint = r->pairs    ? "; decimals have a point"
                     : r->as->hz ? ""
                                 : "; frequencies in Hz: rotor.mistuning: {file: NAME, unit: Hz}";
  SHB_CHECK(x > MHB_LEAST_DEVIATION && x <= MHB_MOST_DEVIATION, SHB_ERR_INPUT,
            "%s:%d:%d: a deviation of %g (%g %%) must be above -50 %% and at most 100 %%%s",
            r->as->path, c->line, c->column, x, 100 * x, hint);
  return SHB_OK;
}

static shb_status read_one(const reading *r, int row, int column, double *x) {
  const mesh_cell *c = cell_of(r, row, column);
  const char      *suffix;
  SHB_TRY(mesh_table_number(&r->text, r->header + row, r->numbered + column, expected_of(r), x,
                            &suffix));
  if (r->as->hz) {
    SHB_CHECK(!*suffix || !strcmp(suffix, "Hz"), SHB_ERR_INPUT,
              "%s:%d:%d: '%.20s' is not in Hz (rotor.mistuning.unit)", r->as->path, c->line,
              c->column, c->text);
    SHB_CHECK(*x > 0, SHB_ERR_INPUT, "%s:%d:%d: a frequency of %g Hz must be above 0", r->as->path,
              c->line, c->column, *x);
    return SHB_OK;
  }
  SHB_CHECK(!*suffix || !strcmp(suffix, "%"), SHB_ERR_INPUT,
            "%s:%d:%d: '%.20s' is not a deviation such as 0.01 or 1 %%; frequencies in Hz: "
            "rotor.mistuning: {file: NAME, unit: Hz}",
            r->as->path, c->line, c->column, c->text);
  if (*suffix) *x *= 0.01;
  return check_deviation(r, c, *x);
}

/* Frequencies of a column become deviations from their mean. */
static shb_status take_mean(const reading *r, int column) {
  const int blades = r->as->blades;
  double    mean   = r->as->mean;
  for (int i = 0; i < blades && r->as->mean == 0; i++)
    mean += r->value[i * r->columns + column] / blades;
  for (int i = 0; i < blades; i++) {
    double *x = &r->value[r->blade[i] * r->columns + column];
    *x        = *x / mean - 1;
    SHB_TRY(check_deviation(r, cell_of(r, i, column), *x));
  }
  return SHB_OK;
}

/* Is the first column one of blade numbers: by its name, or as it counts from 0 or 1? Three
 * deviations or frequencies cannot count so. */
static bool is_numbered(const reading *r) {
  const int rows = r->text.n_rows - r->header;
  if (rows < 1 || mesh_table_cells(&r->text, r->header) < 2) return false;
  if (r->header && !strncasecmp(mesh_table_cell(&r->text, 0, 0)->text, "blade", strlen("blade")))
    return true;
  const int first = atoi(mesh_table_cell(&r->text, r->header, 0)->text);
  for (int i = 0; i < rows; i++) {
    const char *text = mesh_table_cell(&r->text, r->header + i, 0)->text;
    if (!mesh_text_is_whole(text) || atoi(text) != first + i) return false;
  }
  return rows >= 3 && (first == 0 || first == 1);
}

static bool are_pairs(const reading *r) {
  bool whole = r->text.separator == ',' && r->columns % 2 == 0;
  for (int i = 0; whole && i < r->as->blades; i++)
    for (int k = 0; whole && k < r->columns; k++)
      whole = mesh_text_is_whole(cell_of(r, i, k)->text);
  return whole;
}

static shb_status read_all(reading *r, double **value) {
  const int blades = r->as->blades;
  r->header        = r->text.n_rows > 0 && mesh_table_is_header(&r->text, 0);
  r->numbered      = is_numbered(r);
  SHB_TRY(check_rows(r));
  SHB_TRY(check_columns(r));
  r->pairs = are_pairs(r);
  r->blade = shb_alloc((size_t)blades, sizeof(int));
  r->value = shb_alloc((size_t)blades * (size_t)r->columns, sizeof(double));
  SHB_TRY(read_blades(r));
  for (int i = 0; i < blades; i++)
    for (int k = 0; k < r->columns; k++)
      SHB_TRY(read_one(r, i, k, &r->value[r->blade[i] * r->columns + k]));
  for (int k = 0; k < r->columns && r->as->hz; k++) SHB_TRY(take_mean(r, k));
  *value   = r->value;
  r->value = NULL;
  return SHB_OK;
}

shb_status mhb_deviation_table_read(const mhb_deviation_table *table, int *columns,
                                    double **value) {
  reading r = {.as = table};
  SHB_TRY(mesh_table_read(table->path, true, &r.text));
  shb_status status = read_all(&r, value);
  *columns          = r.columns;
  free(r.blade);
  free(r.value);
  mesh_table_free(&r.text);
  return status;
}
