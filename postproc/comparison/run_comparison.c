#include "postproc/comparison/run_comparison.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/problem/parameter.h"

static const post_track_point NONE = {NAN, NAN, NAN, -1, -1, false, false, false, false};

/* ---------------------------------------------------------------- curves */

static bool same(const post_pair *p, const post_group *g) {
  if (p->kind != g->kind || isnan(p->n0) != isnan(g->n0)) return false;
  return isnan(p->n0) || fabs(p->n0 - g->n0) <= 1e-9 * fmax(fabs(p->n0), fabs(g->n0));
}

/* Highest peak of a group, as the tracking of its run has it. */
static post_track_point peak_of(const post_analysis *a, int group) {
  const post_tracking *t = &a->tracking;
  if (a->group[group].kind == MHB_BRANCH_OPEN) return t->open;
  if (a->group[group].kind == MHB_BRANCH_STUCK) return t->stuck;
  for (int i = 0; i < t->n; i++)
    if (a->curve[t->point[i].branch].group == group) return t->point[i];
  return NONE;
}

/* Limits first, then by rising n0, those with a varying one last. */
static int by_preload(const void *left, const void *right) {
  const post_pair *a = left, *b = right;
  const bool       la = a->kind != MHB_BRANCH_NONLINEAR, lb = b->kind != MHB_BRANCH_NONLINEAR;
  if (la != lb) return la ? -1 : 1;
  if (la) return (int)a->kind - (int)b->kind;
  if (isnan(a->n0) || isnan(b->n0)) return (int)isnan(a->n0) - (int)isnan(b->n0);
  return (a->n0 > b->n0) - (a->n0 < b->n0);
}

static shb_status pair_curves(post_comparison *c) {
  const int most = c->run[0].analysis->n_groups + c->run[1].analysis->n_groups;
  c->pair        = calloc((size_t)most + 1, sizeof *c->pair);
  SHB_CHECK(c->pair, SHB_ERR_IO, "not enough memory for the comparison");
  for (int run = 0; run < POST_RUNS; run++) {
    const post_analysis *a = c->run[run].analysis;
    for (int g = 0; g < a->n_groups; g++) {
      int i = 0;
      if (a->group[g].empty) continue;
      while (i < c->n_pairs && !same(&c->pair[i], &a->group[g])) i++;
      if (i == c->n_pairs)
        c->pair[c->n_pairs++] =
            (post_pair){a->group[g].kind, a->group[g].n0, -1, {-1, -1}, {NONE, NONE}};
      c->pair[i].group[run] = g;
      c->pair[i].peak[run]  = peak_of(a, g);
    }
  }
  qsort(c->pair, (size_t)c->n_pairs, sizeof *c->pair, by_preload);
  for (int i = 0; i < c->n_pairs; i++)
    if (c->pair[i].kind == MHB_BRANCH_NONLINEAR && !isnan(c->pair[i].n0))
      c->pair[i].rank = c->n_ranks++;
  return SHB_OK;
}

void post_pair_name(const post_pair *p, char out[64]) {
  const post_group group = {p->kind, false, p->n0, p->rank};
  post_group_name(&group, out);
}

double post_change(const post_pair *p, bool place) {
  const double a = place ? p->peak[0].at : p->peak[0].amplitude,
               b = place ? p->peak[1].at : p->peak[1].amplitude;
  return a > 0 && b > 0 ? b / a - 1 : NAN;
}

/* ---------------------------------------------------------------- settings */

/* The value of a key in lines "key = value"; malloc'ed, NULL: it is not there. */
static char *value_of(const char *settings, const char *key, size_t length) {
  for (const char *line = settings; line && *line; line = strchr(line, '\n')) {
    if (*line == '\n') line++;
    if (strncmp(line, key, length) != 0 || strncmp(line + length, " = ", 3) != 0) continue;
    const char *value = line + length + 3;
    return strndup(value, strcspn(value, "\n"));
  }
  return NULL;
}

static shb_status add_difference(post_comparison *c, char *key, char *first, char *second) {
  size_t           n    = (size_t)c->n_differences + 1;
  post_difference *more = key ? realloc(c->difference, n * sizeof *more) : NULL;
  if (!more) {
    free(key);
    free(first);
    free(second);
    SHB_FAIL(SHB_ERR_IO, "not enough memory for the comparison");
  }
  c->difference                     = more;
  c->difference[c->n_differences++] = (post_difference){key, {first, second}};
  return SHB_OK;
}

/* Compare one line of the settings of a run, whose key has `name` bytes.
 *   run  in  0; 1: what run 0 has is known */
static shb_status compare_line(post_comparison *c, int run, const char *line, size_t name) {
  char *own   = value_of(c->run[run].origin.settings, line, name);
  char *other = value_of(c->run[1 - run].origin.settings, line, name);
  bool  known = own && other && (run == 1 || strcmp(own, other) == 0);
  if (!known) return add_difference(c, strndup(line, name), run ? other : own, run ? own : other);
  free(own);
  free(other);
  return SHB_OK;
}

/* The settings of one run that the other has not got, or has with another value. */
static shb_status compare_settings(post_comparison *c, int run) {
  for (const char *line = c->run[run].origin.settings; *line;) {
    size_t      length = strcspn(line, "\n");
    const char *equals = strstr(line, " = ");
    if (equals && equals < line + length)
      SHB_TRY(compare_line(c, run, line, (size_t)(equals - line)));
    line += length + (line[length] == '\n');
  }
  return SHB_OK;
}

/* ---------------------------------------------------------------- both runs */

static shb_status read_run(const char *path, const char *name, post_run *run) {
  char why[512];
  SHB_TRY(mhb_response_read(path, &run->response));
  SHB_TRY(post_origin_open(path, &run->origin));
  run->name = strdup(name);
  SHB_CHECK(run->name, SHB_ERR_IO, "out of memory");
  shb_status status = post_analysis_create(run->response, &run->analysis);
  if (status != SHB_ERR_INPUT) return status;
  snprintf(why, sizeof why, "%s", shb_message());
  SHB_FAIL(status, "%s: %s", path, why);
}

static shb_status compare(const char *const path[POST_RUNS], const char *const name[POST_RUNS],
                          post_comparison *c) {
  for (int run = 0; run < POST_RUNS; run++) SHB_TRY(read_run(path[run], name[run], &c->run[run]));
  const mhb_parameter a = c->run[0].response->parameter, b = c->run[1].response->parameter;
  SHB_CHECK(a == b, SHB_ERR_INPUT, "%s follows %s, %s follows %s; there is nothing to compare",
            path[0], mhb_parameter_name(a), path[1], mhb_parameter_name(b));
  SHB_TRY(pair_curves(c));
  for (int run = 0; run < POST_RUNS; run++) SHB_TRY(compare_settings(c, run));
  return SHB_OK;
}

shb_status post_comparison_read(const char *const path[POST_RUNS],
                                const char *const name[POST_RUNS], post_comparison *c) {
  *c                = (post_comparison){0};
  shb_status status = compare(path, name, c);
  if (status != SHB_OK) post_comparison_free(c);
  return status;
}

void post_comparison_free(post_comparison *c) {
  for (int i = 0; i < POST_RUNS; i++) {
    post_analysis_destroy(c->run[i].analysis);
    mhb_response_destroy(c->run[i].response);
    post_origin_free(&c->run[i].origin);
    free(c->run[i].name);
  }
  for (int i = 0; i < c->n_differences; i++) {
    free(c->difference[i].key);
    free(c->difference[i].value[0]);
    free(c->difference[i].value[1]);
  }
  free(c->difference);
  free(c->pair);
  *c = (post_comparison){0};
}
