#include "cases/study/dakota_files.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "postproc/draw/text_buffer.h"

/* One entry of the file: a number and its tag, and what should not stand behind them. */
typedef struct {
  char number[DAKOTA_TAG], tag[DAKOTA_TAG], more[DAKOTA_TAG];
} entry;

/* "{ tag = number }" or "number tag". False: neither. */
static bool read_entry(const char *line, entry *e) {
  const char *open = strchr(line, '{');
  e->more[0]       = '\0';
  if (!open) return sscanf(line, "%127s %127s %127s", e->number, e->tag, e->more) >= 2;
  const char *equal = strchr(open, '=');
  if (!equal || sscanf(open + 1, "%127s", e->tag) != 1) return false;
  e->tag[strcspn(e->tag, "=")] = '\0';
  return sscanf(equal + 1, "%127s", e->number) == 1;
}

static bool is_number(const char *text, double *value) {
  char *end;
  *value = strtod(text, &end);
  return end != text && *end == '\0' && isfinite(*value);
}

/* A count such as "2 variables", DAKOTA_VARS. */
static bool is_count(const entry *e, const char *standard, const char *aprepro) {
  return strcmp(e->tag, standard) == 0 || strcmp(e->tag, aprepro) == 0;
}

enum { NOT_YET = -1 };

typedef struct {
  dakota_parameters *p;
  int                variables, responses, derivatives; /* announced, or NOT_YET */
  char              *why;
  size_t             size;
} reading;

/* A whole number from least to most. */
static bool whole(reading *r, const entry *e, int least, int most, int *value) {
  char *end;
  errno     = 0;
  long wide = strtol(e->number, &end, 10);
  if (end != e->number && *end == '\0' && errno == 0 && wide >= least && wide <= most) {
    *value = (int)wide;
    return true;
  }
  snprintf(r->why, r->size, "%s %s: expected a whole number from %d to %d", e->number, e->tag,
           least, most);
  return false;
}

/* The name in "ASV_1:peak", "DVV_1:contact.n0", whose number must be that of its place. NULL: a
 * fault was told. */
static const char *name_in(reading *r, const entry *e, int place) {
  const size_t prefix = strlen("ASV_");
  const char  *name   = strchr(e->tag, ':');
  char        *end;
  const long   number = strtol(e->tag + prefix, &end, 10);
  if (!name || !name[1])
    snprintf(r->why, r->size, "%s names no response or variable; give descriptors", e->tag);
  else if (end != name || number != place)
    snprintf(r->why, r->size, "%s stands in place %d; expected %.4s%d:%s", e->tag, place, e->tag,
             place, name + 1);
  else
    return name + 1;
  return NULL;
}

static bool take_variable(reading *r, const entry *e) {
  dakota_parameters *p = r->p;
  if (is_count(e, "functions", "DAKOTA_FNS")) {
    snprintf(r->why, r->size, "%d variables are announced, %d stand there", r->variables,
             p->n_variables);
    return false;
  }
  if (!is_number(e->number, &p->value[p->n_variables])) {
    snprintf(r->why, r->size, "%s: '%s' is no number", e->tag, e->number);
    return false;
  }
  for (int i = 0; i < p->n_variables; i++) {
    if (strcmp(p->variable[i], e->tag) != 0) continue;
    snprintf(r->why, r->size, "the variable %s stands there twice", e->tag);
    return false;
  }
  strcpy(p->variable[p->n_variables++], e->tag);
  return true;
}

/* "ASV_1:peak"; 0 asks for nothing, the sum of 1 value, 2 gradient, 4 Hessian for these. */
static bool take_response(reading *r, const entry *e) {
  enum { ALL = 7 };
  dakota_parameters *p = r->p;
  if (p->n_responses == r->responses) {
    snprintf(r->why, r->size, "%s is response %d, of %d", e->tag, p->n_responses + 1, r->responses);
    return false;
  }
  const char *name = name_in(r, e, p->n_responses + 1);
  if (!name || !whole(r, e, 0, ALL, &p->active[p->n_responses])) return false;
  for (int i = 0; i < p->n_responses; i++) {
    if (strcmp(p->response[i], name) != 0) continue;
    snprintf(r->why, r->size, "the response %s stands there twice", name);
    return false;
  }
  strcpy(p->response[p->n_responses++], name);
  return true;
}

static bool take_derivative(reading *r, const entry *e) {
  dakota_parameters *p = r->p;
  int                i;
  if (p->n_derivatives == r->derivatives || p->n_derivatives == DAKOTA_MOST) {
    snprintf(r->why, r->size, "%s is derivative variable %d, of %d", e->tag, p->n_derivatives + 1,
             p->n_derivatives);
    return false;
  }
  const char *name = name_in(r, e, p->n_derivatives + 1);
  if (!name || !whole(r, e, 1, p->n_variables, &i)) return false;
  if (strcmp(name, p->variable[i - 1]) != 0) {
    snprintf(r->why, r->size, "%s %s: variable %d is %s", e->number, e->tag, i, p->variable[i - 1]);
    return false;
  }
  p->derivative[p->n_derivatives++] = i - 1;
  return true;
}

/* What stands between the variables and the count of functions is a variable too many. */
static bool refuse_further(reading *r, const entry *e) {
  snprintf(r->why, r->size,
           "'%s %s' stands where the functions are announced: %d variables were announced",
           e->number, e->tag, r->variables);
  return false;
}

static bool refuse_more(reading *r, const entry *e) {
  snprintf(r->why, r->size, "'%s' stands behind '%s %s'", e->more, e->number, e->tag);
  return false;
}

static bool take(reading *r, const entry *e) {
  if (r->variables == NOT_YET)
    return !is_count(e, "variables", "DAKOTA_VARS") || whole(r, e, 1, DAKOTA_MOST, &r->variables);
  if (e->more[0] && r->responses == NOT_YET) return refuse_more(r, e);
  if (r->p->n_variables < r->variables) return take_variable(r, e);
  if (r->responses == NOT_YET)
    return is_count(e, "functions", "DAKOTA_FNS") ? whole(r, e, 1, DAKOTA_MOST, &r->responses)
                                                  : refuse_further(r, e);
  if (strncmp(e->tag, "ASV_", 4) == 0) return take_response(r, e);
  if (is_count(e, "derivative_variables", "DAKOTA_DER_VARS"))
    return whole(r, e, 0, DAKOTA_MOST, &r->derivatives);
  if (strncmp(e->tag, "DVV_", 4) == 0) return take_derivative(r, e);
  return true;
}

/* Whether as many stand there as were announced. */
static bool check_counts(reading *r) {
  const dakota_parameters *p = r->p;
  if (r->variables == NOT_YET || r->responses == NOT_YET) {
    snprintf(r->why, r->size, "is no parameters file of Dakota: it announces no %s",
             r->variables == NOT_YET ? "variables" : "functions");
    return false;
  }
  if (p->n_responses == r->responses &&
      (r->derivatives == NOT_YET || p->n_derivatives == r->derivatives))
    return true;
  const bool short_of = p->n_responses != r->responses;
  snprintf(r->why, r->size, "%d %s are announced, %d stand there",
           short_of ? r->responses : r->derivatives,
           short_of ? "functions" : "derivative variables",
           short_of ? p->n_responses : p->n_derivatives);
  return false;
}

bool dakota_read(const char *path, dakota_parameters *p, char *why, size_t size) {
  char    line[1024];
  reading r    = {p, NOT_YET, NOT_YET, NOT_YET, why, size};
  FILE   *file = fopen(path, "r");
  bool    good = file != NULL;
  *p           = (dakota_parameters){0};
  if (!file) snprintf(why, size, "cannot be opened");
  while (good && fgets(line, sizeof line, file)) {
    entry e;
    if (read_entry(line, &e)) good = take(&r, &e);
  }
  if (file) fclose(file);
  return good && check_counts(&r);
}

void dakota_path(const char *descriptor, char path[2 * DAKOTA_TAG]) {
  char *to = path;
  for (const char *at = descriptor; *at;) {
    if (strncmp(at, "__", 2) != 0) {
      *to++ = *at++;
      continue;
    }
    at += 2;
    size_t digits = strspn(at, "0123456789");
    bool   index  = digits > 0 && (at[digits] == '\0' || strncmp(at + digits, "__", 2) == 0);
    *to++         = index ? '[' : '.';
    for (size_t i = 0; index && i < digits; i++) *to++ = *at++;
    if (index) *to++ = ']';
  }
  *to = '\0';
}

bool dakota_write(const char *path, const dakota_parameters *p, const double *value,
                  const double *gradient) {
  post_buffer text = {0};
  for (int i = 0; i < p->n_responses; i++)
    if (p->active[i] & 1) post_put(&text, "%24.16e %s\n", value[i], p->response[i]);
  for (int i = 0; i < p->n_responses; i++) {
    if (!(p->active[i] & 2)) continue;
    post_put(&text, "[");
    for (int k = 0; k < p->n_derivatives; k++)
      post_put(&text, " %.16e", gradient[i * p->n_derivatives + k]);
    post_put(&text, " ]\n");
  }
  bool good = post_buffer_publish(&text, path) == SHB_OK;
  post_buffer_free(&text);
  return good;
}

bool dakota_fail(const char *path, const char *reason) {
  post_buffer text = {0};
  post_put(&text, "FAIL\n%s\n", reason);
  bool good = post_buffer_publish(&text, path) == SHB_OK;
  post_buffer_free(&text);
  return good;
}
