#include "mesh/table/csv.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "mesh/base/memory.h"
#include "mesh/table/text_file.h"

enum { MOST_MIB = 256 };

typedef struct {
  mesh_table *table;
  char       *at;           /* what comes next */
  int         line, column; /* of it, from 1 */
  int         n_cells, cell_room, row_room;
} scanner;

static bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

static bool is_end(char c) {
  return c == '\0' || c == '\n' || c == '\r';
}

/* Go on by a character; bytes within one of UTF-8 are no columns. */
static void next(scanner *s) {
  bool ends = *s->at == '\n' || (*s->at == '\r' && s->at[1] != '\n');
  s->at++;
  s->column = ends ? 1 : s->column + (((unsigned char)*s->at & 0xC0) != 0x80);
  s->line += ends;
}

static void end_line(scanner *s) {
  if (*s->at == '\r' && s->at[1] == '\n') next(s);
  if (*s->at) next(s);
}

/* Blanks before a cell; a tab that separates is none. */
static void skip_blanks(scanner *s) {
  while (*s->at == ' ' || (*s->at == '\t' && s->table->separator != '\t')) next(s);
}

static bool begins_number(const char *text) {
  if (*text == '+' || *text == '-') text++;
  if (*text == '.') text++;
  return *text >= '0' && *text <= '9';
}

/* A comment begins with #. Capital letters with / ! or ? are an error of a spreadsheet: #DIV/0!,
 * #NAME?, also in other languages. */
static bool is_comment(const char *text) {
  const size_t n = strspn(text + 1, "ABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789/!?");
  return text[0] == '#' && (n == 0 || strcspn(text + 1, "/!?") >= n);
}

/* A blank before a unit is part of the cell: 1 %. */
static bool separates(const scanner *s) {
  if (s->table->separator != ' ') return *s->at && *s->at == s->table->separator;
  const char *then = s->at + strspn(s->at, " \t");
  return is_blank(*s->at) && (*then == '"' || begins_number(then));
}

/* ---- the separator ---- */

/* Take "sep=X", as spreadsheets write and read it. */
static bool take_sep(scanner *s) {
  if (strncmp(s->at, "sep=", 4) != 0 || is_end(s->at[4]) || !is_end(s->at[5])) return false;
  s->table->separator = s->at[4];
  while (!is_end(*s->at)) next(s);
  end_line(s);
  return true;
}

/* The first of order in the first row that has one; NUL if no row has. */
static char separator_of(const char *text) {
  static const char order[] = "\t;,";
  int               found   = 3;
  bool              quoted = false, fresh = true; /* fresh: no text in this line so far */
  for (; *text && (found == 3 || quoted || !is_end(*text)); text++) {
    if (fresh && is_comment(text)) text += strcspn(text, "\r\n") - 1;
    if (*text == '"') quoted = !quoted;
    for (int i = 0; i < found && !quoted; i++)
      if (*text == order[i]) found = i;
    fresh = is_end(*text) || (fresh && is_blank(*text));
  }
  return order[found];
}

/* ---- cells ---- */

static void grow(void **array, int n, int *room, size_t size) {
  if (n < *room) return;
  *room  = *room ? 2 * *room : 64;
  *array = shb_realloc(*array, (size_t)*room, size);
}

/* A quoted cell, moved to its first quote. At the end, at is behind the closed quote. */
static shb_status take_quoted(scanner *s, char **end) {
  char *to   = s->at;
  int   line = s->line, column = s->column;
  next(s);
  while (*s->at && (*s->at != '"' || s->at[1] == '"')) {
    if (*s->at == '"') next(s);
    *to++ = *s->at;
    next(s);
  }
  SHB_CHECK(*s->at, SHB_ERR_INPUT, "%s:%d:%d: the quote that opens here is not closed",
            s->table->path, line, column);
  next(s);
  *end = to;
  while (is_blank(*s->at) && !separates(s)) next(s);
  SHB_CHECK(is_end(*s->at) || separates(s), SHB_ERR_INPUT,
            "%s:%d:%d: text behind a closed quote; a quote within a cell is written twice",
            s->table->path, s->line, s->column);
  return SHB_OK;
}

static shb_status take_cell(scanner *s) {
  mesh_table *t = s->table;
  grow((void **)&t->cell, s->n_cells, &s->cell_room, sizeof *t->cell);
  skip_blanks(s);
  mesh_cell *c = &t->cell[s->n_cells++];
  *c           = (mesh_cell){.text = s->at, .line = s->line, .column = s->column};
  char *end    = s->at;
  if (*s->at == '"') {
    SHB_TRY(take_quoted(s, &end));
  } else {
    while (!is_end(*s->at) && !separates(s)) next(s);
    for (end = s->at; end > c->text && is_blank(end[-1]);) end--;
  }
  c->length = (size_t)(end - c->text);
  return SHB_OK;
}

/* A row; one without text, and a comment, leaves nothing. */
static shb_status take_row(scanner *s) {
  mesh_table *t     = s->table;
  const int   first = s->n_cells;
  bool        text  = false;
  grow((void **)&t->first, t->n_rows + 1, &s->row_room, sizeof *t->first);
  skip_blanks(s);
  const bool comment = is_comment(s->at);
  for (bool more = !comment; more;) {
    SHB_TRY(take_cell(s));
    text = text || t->cell[s->n_cells - 1].length > 0;
    more = separates(s);
    if (more) next(s);
  }
  while (!is_end(*s->at)) next(s);
  end_line(s);
  if (!text) s->n_cells = first;
  t->first[t->n_rows] = first;
  t->n_rows += text;
  return SHB_OK;
}

static shb_status scan(scanner *s, bool blanks) {
  mesh_table *t = s->table;
  if (!take_sep(s)) t->separator = separator_of(s->at);
  if (!t->separator && blanks) t->separator = ' ';
  while (*s->at) SHB_TRY(take_row(s));
  grow((void **)&t->first, t->n_rows, &s->row_room, sizeof *t->first);
  t->first[t->n_rows] = s->n_cells;
  for (int i = 0; i < s->n_cells; i++) t->cell[i].text[t->cell[i].length] = '\0';
  return SHB_OK;
}

shb_status mesh_table_read(const char *path, bool blanks, mesh_table *table) {
  size_t length;
  *table = (mesh_table){.path = path};
  SHB_TRY(mesh_text_read(path, MOST_MIB, "a table is text", &table->text, &length));
  scanner s = {.table = table, .at = table->text, .line = 1, .column = 1};
  if (strncmp(s.at, "\xef\xbb\xbf", 3) == 0) s.at += 3;
  shb_status status = scan(&s, blanks);
  if (status != SHB_OK) mesh_table_free(table);
  return status;
}

void mesh_table_free(mesh_table *table) {
  free(table->first);
  free(table->cell);
  free(table->text);
  *table = (mesh_table){0};
}

int mesh_table_cells(const mesh_table *table, int row) {
  int n = table->first[row + 1] - table->first[row];
  while (n > 0 && mesh_table_cell(table, row, n - 1)->length == 0) n--;
  return n;
}

const mesh_cell *mesh_table_cell(const mesh_table *table, int row, int column) {
  return &table->cell[table->first[row] + column];
}

int mesh_table_line(const mesh_table *table, int row) {
  return mesh_table_cell(table, row, 0)->line;
}

static bool is_name(const char *text) {
  return !begins_number(text) && !strchr("=+-@#", text[0]) && strcasecmp(text, "nan") != 0 &&
         strcasecmp(text, "inf") != 0;
}

bool mesh_table_is_header(const mesh_table *table, int row) {
  for (int i = 0; i < mesh_table_cells(table, row); i++) {
    const char *text = mesh_table_cell(table, row, i)->text;
    if (*text && !is_name(text)) return false;
  }
  return true;
}
