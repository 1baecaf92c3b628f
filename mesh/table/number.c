#include "mesh/table/number.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST = 40 }; /* characters of a cell that a message repeats */

/* The number of decimal characters that begin a text: 12, -0.5, 1e-3. */
static size_t length_of(const char *text) {
  const char *at     = text;
  int         digits = 0;
  if (*at == '+' || *at == '-') at++;
  for (; isdigit((unsigned char)*at); at++) digits++;
  if (*at == '.')
    for (at++; isdigit((unsigned char)*at); at++) digits++;
  if (digits == 0) return 0;
  const char *exponent = at + 1 + (at[0] && (at[1] == '+' || at[1] == '-'));
  if (strchr("eE", *at) && *at && isdigit((unsigned char)*exponent))
    for (at = exponent; isdigit((unsigned char)*at);) at++;
  return (size_t)(at - text);
}

bool mesh_text_is_whole(const char *text) {
  if (*text == '+' || *text == '-') text++;
  return *text && strspn(text, "0123456789") == strlen(text);
}

/* Is the cell the whole part of 0,05, cut at the comma? */
static bool is_cut(const mesh_table *t, int row, int column) {
  if (t->separator != ',' || column + 1 >= mesh_table_cells(t, row)) return false;
  const char *rest = mesh_table_cell(t, row, column + 1)->text;
  return mesh_text_is_whole(mesh_table_cell(t, row, column)->text) && rest[0] == '0' &&
         isdigit((unsigned char)rest[1]);
}

shb_status mesh_table_number(const mesh_table *table, int row, int column, const char *expected,
                             double *value, const char **suffix) {
  const mesh_cell *c = mesh_table_cell(table, row, column);
  const size_t     n = length_of(c->text);
  SHB_CHECK(!is_cut(table, row, column), SHB_ERR_INPUT,
            "%s:%d:%d: %s,%s has a decimal comma; write %s.%s, commas separate columns",
            table->path, c->line, c->column, c->text, c[1].text, c->text, c[1].text);
  SHB_CHECK(c->text[n] != ',' || !isdigit((unsigned char)c->text[n + 1]), SHB_ERR_INPUT,
            "%s:%d:%d: '%.*s' has a decimal comma; write it with a point", table->path, c->line,
            c->column, LONGEST, c->text);
  char *end;
  *value = strtod(c->text, &end);
  SHB_CHECK(n > 0 && end == c->text + n && *end != '.', SHB_ERR_INPUT,
            "%s:%d:%d: '%.*s' is not a number; expected %s", table->path, c->line, c->column,
            LONGEST, c->text, expected);
  SHB_CHECK(isfinite(*value), SHB_ERR_INPUT, "%s:%d:%d: '%.*s' is too large", table->path, c->line,
            c->column, LONGEST, c->text);
  *suffix = c->text + n;
  while (**suffix == ' ' || **suffix == '\t') (*suffix)++;
  return SHB_OK;
}
