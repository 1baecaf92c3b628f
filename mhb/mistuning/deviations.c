#include "mhb/mistuning/deviations.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

enum { LONGEST_LINE = 1 << 16 };

/* splitmix64 (Steele, Lea, Flood 2014). */
static uint64_t next(uint64_t *state) {
  uint64_t z = *state += 0x9e3779b97f4a7c15ULL;
  z          = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z          = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/* In (0, 1]. */
static double uniform(uint64_t *state) {
  return ((double)(next(state) >> 11) + 1) * 0x1p-53;
}

shb_status mhb_deviations_random(double deviation, long seed, int sample, int n, double *value) {
  uint64_t first = (uint64_t)seed, state = next(&first) + (uint64_t)sample * 0xda942042e4dd58b5ULL;
  for (int i = 0; i < n; i += 2) { /* Box and Muller (1958) */
    const double r = deviation * sqrt(-2 * log(uniform(&state)));
    const double a = SHB_TWO_PI * uniform(&state);
    value[i]       = r * cos(a);
    if (i + 1 < n) value[i + 1] = r * sin(a);
  }
  for (int i = 0; i < n; i++)
    SHB_CHECK(value[i] > MHB_LEAST_DEVIATION, SHB_ERR_INPUT,
              "rotor.mistuning: the deviation of blade %d of sample %d is %.3g %%, must be above "
              "-50 %%; give a smaller deviation than %.3g %%",
              i, sample, 100 * value[i], 100 * deviation);
  return SHB_OK;
}

/* ---- a table ---- */

typedef struct {
  const char *path;
  int         line, blades, n_modes; /* line: of the file, from 1 */
  int         rows, columns;         /* so far; columns 0: none yet */
  double     *value;                 /* [blades][columns] */
} table;

static char *skip_separators(char *at) {
  while (isspace((unsigned char)*at) || *at == ',' || *at == ';') at++;
  return at;
}

/* row[n_modes] <- the numbers of a line; *n their number. */
static shb_status read_line(const table *t, char *text, double *row, int *n) {
  *n = 0;
  for (char *at = skip_separators(text); *at; at = skip_separators(at)) {
    char  *end;
    double x = strtod(at, &end);
    SHB_CHECK(end > at && isfinite(x), SHB_ERR_INPUT,
              "%s:%d: '%.20s' is not a number; expected deviations such as 0.01 or 1 %%", t->path,
              t->line, at);
    at = end;
    while (*at == ' ') at++;
    if (*at == '%') {
      x *= 0.01;
      at++;
    }
    SHB_CHECK(x > MHB_LEAST_DEVIATION, SHB_ERR_INPUT,
              "%s:%d: a deviation of %g (%g %%) must be above -50 %%", t->path, t->line, x,
              100 * x);
    SHB_CHECK(*n < t->n_modes, SHB_ERR_INPUT,
              "%s:%d: more than %d numbers; expected one for all modes, or one for each of the %d "
              "modes",
              t->path, t->line, t->n_modes, t->n_modes);
    row[(*n)++] = x;
  }
  return SHB_OK;
}

static shb_status take_row(table *t, const double *row, int n) {
  SHB_CHECK(t->rows < t->blades, SHB_ERR_INPUT, "%s:%d: more than %d lines; expected one a blade",
            t->path, t->line, t->blades);
  SHB_CHECK(n == 1 || n == t->n_modes, SHB_ERR_INPUT,
            "%s:%d: %d numbers; expected one for all modes, or one for each of the %d modes",
            t->path, t->line, n, t->n_modes);
  SHB_CHECK(t->columns == 0 || n == t->columns, SHB_ERR_INPUT,
            "%s:%d: %d numbers, but %d in the lines before", t->path, t->line, n, t->columns);
  t->columns = n;
  memcpy(t->value + (size_t)t->rows * (size_t)n, row, sizeof(double) * (size_t)n);
  t->rows++;
  return SHB_OK;
}

static shb_status read_lines(FILE *file, table *t, char *text, double *row) {
  while (fgets(text, LONGEST_LINE, file)) {
    int n;
    t->line++;
    if (*skip_separators(text) == '#' || !*skip_separators(text)) continue;
    SHB_TRY(read_line(t, text, row, &n));
    SHB_TRY(take_row(t, row, n));
  }
  SHB_CHECK(t->rows == t->blades, SHB_ERR_INPUT,
            "%s: %d lines of deviations; expected %d, one a blade (rotor.blades)", t->path, t->rows,
            t->blades);
  return SHB_OK;
}

shb_status mhb_deviations_read(const char *path, int blades, int n_modes, int *columns,
                               double **value) {
  FILE *file = fopen(path, "r");
  SHB_CHECK(file, SHB_ERR_IO, "%s: cannot be read: %s (rotor.mistuning.file)", path,
            strerror(errno));
  table      t      = {.path = path, .blades = blades, .n_modes = n_modes};
  char      *text   = malloc(LONGEST_LINE);
  double    *row    = malloc(sizeof(double) * (size_t)n_modes);
  shb_status status = SHB_OK;
  t.value           = malloc(sizeof(double) * (size_t)blades * (size_t)n_modes);
  if (!text || !row || !t.value) status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  if (status == SHB_OK) status = read_lines(file, &t, text, row);
  fclose(file);
  free(text);
  free(row);
  if (status != SHB_OK) {
    free(t.value);
    return status;
  }
  *columns = t.columns;
  *value   = t.value;
  return SHB_OK;
}
