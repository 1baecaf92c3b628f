#include "cases/designs/design_table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/parse/yaml.h"

enum { MOST_CELLS = 1 << 20 };

static char *trim(char *text) {
  while (*text == ' ' || *text == '\t') text++;
  size_t n = strlen(text);
  while (n > 0 && strchr(" \t\r", text[n - 1])) text[--n] = '\0';
  return text;
}

/* Cut a line at its commas; at most `most` cells are stored. Returns how many there are. */
static int split(char *line, char **cell, int most) {
  int n = 0;
  for (char *at = line, *next; at; at = next) {
    next = strchr(at, ',');
    if (next) *next++ = '\0';
    if (n < most) cell[n] = trim(at);
    n++;
  }
  return n;
}

static int count(const char *text, char c) {
  int n = 0;
  for (; *text; text++) n += *text == c;
  return n;
}

/* The next line that is not empty; NULL at the end. number counts the lines. */
static char *next_line(char **at, int *number) {
  while (*at) {
    char *line = *at, *end = strchr(line, '\n');
    if (end) *end = '\0';
    *at = end ? end + 1 : NULL;
    ++*number;
    if (trim(line)[0]) return line;
  }
  return NULL;
}

static bool fill(const char *path, design_table *t, char *why, size_t size) {
  int   number = 0;
  char *at = t->text, *line = next_line(&at, &number);
  if (!line) {
    snprintf(why, size, "%s: the table is empty; its first line names the varied keys", path);
    return false;
  }
  t->n_columns = count(line, ',') + 1;
  int lines    = at ? count(at, '\n') + 1 : 0;
  t->column    = calloc((size_t)t->n_columns, sizeof *t->column);
  bool fits    = (long)lines * t->n_columns <= MOST_CELLS;
  t->cell      = fits ? calloc((size_t)lines * (size_t)t->n_columns + 1, sizeof *t->cell) : NULL;
  t->line      = fits ? calloc((size_t)lines + 1, sizeof *t->line) : NULL;
  if (!t->column || !t->cell || !t->line) {
    snprintf(why, size, "%s: the table is too large", path);
    return false;
  }
  split(line, t->column, t->n_columns);
  while ((line = next_line(&at, &number)) != NULL) {
    int n = split(line, t->cell + (size_t)t->n_rows * (size_t)t->n_columns, t->n_columns);
    if (n != t->n_columns) {
      snprintf(why, size, "%s:%d: row %d has %d columns, the header has %d%s", path, number,
               t->n_rows + 1, n, t->n_columns,
               strchr(line, ';') ? "; columns are separated by commas" : "");
      return false;
    }
    t->line[t->n_rows++] = number;
  }
  return true;
}

bool design_table_read(const char *path, design_table *t, char *why, size_t size) {
  size_t length;
  *t = (design_table){0};
  if (!path || case_text_read(path, &t->text, &length) != SHB_OK) {
    snprintf(why, size, "%s", shb_message());
    return false;
  }
  bool good = fill(path, t, why, size);
  if (!good) design_table_free(t);
  return good;
}

void design_table_free(design_table *t) {
  free(t->column);
  free(t->cell);
  free(t->line);
  free(t->text);
  *t = (design_table){0};
}
