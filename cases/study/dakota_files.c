#include "cases/study/dakota_files.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "postproc/draw/text_buffer.h"

/* One entry of the file: a number and its tag. */
typedef struct {
  char number[DAKOTA_TAG], tag[DAKOTA_TAG];
} entry;

/* "{ tag = number }" or "number tag". False: neither. */
static bool read_entry(const char *line, entry *e) {
  const char *open = strchr(line, '{');
  if (!open) return sscanf(line, "%127s %127s", e->number, e->tag) == 2;
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

typedef struct {
  dakota_parameters *p;
  int                variables, responses; /* announced */
  char              *why;
  size_t             size;
} reading;

static bool take_variable(reading *r, const entry *e) {
  dakota_parameters *p = r->p;
  if (!is_number(e->number, &p->value[p->n_variables])) {
    snprintf(r->why, r->size, "%s: '%s' is no number", e->tag, e->number);
    return false;
  }
  strcpy(p->variable[p->n_variables++], e->tag);
  return true;
}

/* "ASV_1:peak" */
static bool take_response(reading *r, const entry *e) {
  dakota_parameters *p    = r->p;
  const char        *name = strchr(e->tag, ':');
  if (!name || !name[1]) {
    snprintf(r->why, r->size, "%s names no response; give the responses descriptors", e->tag);
    return false;
  }
  p->active[p->n_responses] = atoi(e->number);
  strcpy(p->response[p->n_responses++], name + 1);
  return true;
}

static bool take_derivative(reading *r, const entry *e) {
  dakota_parameters *p = r->p;
  int                i = atoi(e->number);
  if (i < 1 || i > p->n_variables || p->n_derivatives == DAKOTA_MOST) {
    snprintf(r->why, r->size, "%s: there is no variable %s", e->tag, e->number);
    return false;
  }
  p->derivative[p->n_derivatives++] = i - 1;
  return true;
}

static bool take_count(reading *r, const entry *e, int *count) {
  *count = atoi(e->number);
  if (*count >= 1 && *count <= DAKOTA_MOST) return true;
  snprintf(r->why, r->size, "%s %s: expected 1 to %d", e->number, e->tag, DAKOTA_MOST);
  return false;
}

static bool take(reading *r, const entry *e) {
  if (r->variables < 0)
    return is_count(e, "variables", "DAKOTA_VARS") ? take_count(r, e, &r->variables) : true;
  if (r->p->n_variables < r->variables) return take_variable(r, e);
  if (is_count(e, "functions", "DAKOTA_FNS")) return take_count(r, e, &r->responses);
  if (strncmp(e->tag, "ASV_", 4) == 0 && r->p->n_responses < DAKOTA_MOST)
    return take_response(r, e);
  if (strncmp(e->tag, "DVV_", 4) == 0) return take_derivative(r, e);
  return true;
}

bool dakota_read(const char *path, dakota_parameters *p, char *why, size_t size) {
  char    line[1024];
  reading r    = {p, -1, -1, why, size};
  FILE   *file = fopen(path, "r");
  bool    good = file != NULL;
  *p           = (dakota_parameters){0};
  if (!file) snprintf(why, size, "cannot be opened");
  while (good && fgets(line, sizeof line, file)) {
    entry e;
    if (read_entry(line, &e)) good = take(&r, &e);
  }
  if (file) fclose(file);
  if (good && (r.variables < 1 || p->n_variables < r.variables || p->n_responses < 1 ||
               p->n_responses != r.responses)) {
    snprintf(why, size, "is no parameters file of Dakota: %d variables and %d responses found",
             p->n_variables, p->n_responses);
    good = false;
  }
  return good;
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
