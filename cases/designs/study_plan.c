#include "cases/designs/study_plan.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/designs/design_table.h"
#include "cases/designs/study_table.h"
#include "cases/parse/keys.h"
#include "cases/parse/units.h"
#include "cases/plan/sampling.h"
#include "cases/plan/sobol_indices.h"

static void fault(case_issues *issues, const case_node *node, const char *key, const char *text) {
  case_issue_add(issues, node->line, node->column, key, "%s", text);
}

/* ---------------------------------------------------------------- plan */

/* {sobol: 256, seed: 1} and the like. */
static void read_sampling(case_issues *issues, const case_node *node, study_plan *plan) {
  int kinds = 0;
  for (int i = 0; i < node->n; i++) {
    const case_node *one = &node->child[i];
    char             path[CASE_PATH];
    case_path(path, "plan.%s", one->key);
    if (strcmp(one->key, "seed") == 0) {
      study_table_read(issues, path, path, one, &plan->seed);
    } else if (strcmp(one->key, "sobol") == 0 || strcmp(one->key, "latin_hypercube") == 0) {
      plan->kind = one->key[0] == 's' ? STUDY_SOBOL : STUDY_LATIN_HYPERCUBE;
      kinds++;
      study_table_read(issues, path, path, one, &plan->n_points);
    } else if (strcmp(one->key, "table") == 0) {
      kinds = 2; /* a table alone was read before */
    } else {
      study_table_refuse(issues, "plan", "plan", one);
      kinds = 1;
    }
  }
  if (kinds != 1)
    fault(issues, node, "plan",
          "expected one of grid, {sobol: 256, seed: 1}, {latin_hypercube: 256, seed: 1}, "
          "{table: FILE.csv}");
}

void study_plan_read(case_issues *issues, const case_node *node, const char *folder,
                     study_plan *plan) {
  const case_node *table = case_node_find(node, "table");
  study_table_default("plan.seed", &plan->seed);
  if (node->kind == CASE_SCALAR && strcmp(node->text, "grid") == 0) {
    plan->kind = STUDY_GRID;
  } else if (table && node->n == 1 && table->kind == CASE_SCALAR) {
    bool   here = table->text[0] == '/' || strcmp(folder, ".") == 0;
    size_t size = strlen(folder) + strlen(table->text) + 2;
    plan->kind  = STUDY_TABLE;
    plan->table = malloc(size);
    if (plan->table)
      snprintf(plan->table, size, "%s%s%s", here ? "" : folder, here ? "" : "/", table->text);
  } else if (node->kind == CASE_MAPPING && node->n > 0) {
    read_sampling(issues, node, plan);
  } else {
    fault(issues, node, "plan",
          "expected grid, {sobol: 256}, {latin_hypercube: 256} or {table: FILE.csv}");
  }
}

void study_plan_read_samples(case_issues *issues, const case_node *samples, const case_node *seed,
                             study_plan *plan) {
  study_table_default("seed", &plan->sample_seed);
  if (samples) study_table_read(issues, "samples", "samples", samples, &plan->n_samples);
  if (seed) study_table_read(issues, "seed", "seed", seed, &plan->sample_seed);
}

bool study_plan_has_blocks(const study_plan *plan, const study_keys *keys) {
  return plan->n_samples > 0 && keys->n_uncertain == keys->n && keys->n > 1;
}

static int blocks(const study_plan *plan) {
  return (plan->n_samples + 1) / 2;
}

int study_plan_group(const study_plan *plan, const study_keys *keys) {
  if (study_plan_has_blocks(plan, keys)) return blocks(plan) * (keys->n + 2);
  return plan->n_samples > 0 ? plan->n_samples : 1;
}

void study_plan_text(const study_plan *plan, const study_keys *keys, char *out, size_t size) {
  static const char *const names[] = {"grid", "table", "sobol", "latin_hypercube"};
  int                      n       = 0;
  if (keys->n_uncertain == keys->n && keys->n > 0)
    n = snprintf(out, size, "uncertain");
  else
    n = snprintf(out, size, "%s", names[plan->kind]);
  if (keys->n_uncertain < keys->n && plan->n_samples > 0)
    snprintf(out + n, size - (size_t)n, ", %d samples each", plan->n_samples);
}

/* ---------------------------------------------------------------- designs of the varied keys */

/* Take memory for n designs; false after a fault. */
static bool take(case_issues *issues, const case_node *at, double n, int n_keys, double **design) {
  if (n > STUDY_MOST_DESIGNS)
    case_issue_add(issues, at->line, at->column, "vary", "%.0f designs; at most %d", n,
                   STUDY_MOST_DESIGNS);
  if (issues->n > 0) return false;
  *design = calloc((size_t)n * (size_t)n_keys + 1, sizeof **design);
  if (!*design) case_issues_no_memory(issues);
  return *design != NULL;
}

static void make_grid(case_issues *issues, const case_node *at, const study_keys *keys, int n_keys,
                      int *n_designs, double **design) {
  double n = 1;
  for (int k = 0; k < n_keys; k++) {
    if (keys->key[k].n == 0)
      case_issue_add(issues, at->line, at->column, keys->key[k].path,
                     "a grid needs the number of points of the range");
    n *= keys->key[k].n;
  }
  if (!take(issues, at, n, n_keys, design)) return;
  *n_designs = (int)n;
  for (int d = 0; d < *n_designs; d++)
    for (int k = n_keys - 1, rest = d; k >= 0; k--) { /* the last key runs fastest */
      (*design)[d * n_keys + k] = keys->key[k].value[rest % keys->key[k].n];
      rest /= keys->key[k].n;
    }
}

/* Numbers u [n][n_keys] become values of the keys from key `first` on. */
static void map(const study_keys *keys, int first, int n_keys, int n, double *u) {
  for (int i = 0; i < n * n_keys; i++) u[i] = study_key_at(&keys->key[first + i % n_keys], u[i]);
}

static void make_sample(case_issues *issues, const case_node *at, const study_plan *plan,
                        const study_keys *keys, int n_keys, int *n_designs, double **design) {
  if (!take(issues, at, plan->n_points, n_keys, design)) return;
  shb_status status =
      plan->kind == STUDY_SOBOL
          ? plan_sobol(plan->n_points, n_keys, (unsigned long)plan->seed, *design)
          : plan_latin_hypercube(plan->n_points, n_keys, (unsigned long)plan->seed, *design);
  if (status != SHB_OK) fault(issues, at, "plan", shb_message());
  if (status != SHB_OK) return;
  map(keys, 0, n_keys, plan->n_points, *design);
  *n_designs = plan->n_points;
}

/* ---------------------------------------------------------------- samples */

/* The values of the uncertain keys [group][n_uncertain]; NULL after a fault. */
static double *make_group(case_issues *issues, const case_node *at, const study_plan *plan,
                          const study_keys *keys) {
  int        n = study_plan_group(plan, keys), d = keys->n_uncertain;
  double    *u = calloc((size_t)n * (size_t)d + 1, sizeof *u);
  shb_status status;
  if (!u) {
    case_issues_no_memory(issues);
    return NULL;
  }
  status = study_plan_has_blocks(plan, keys)
               ? plan_saltelli(blocks(plan), d, (unsigned long)plan->sample_seed, u)
               : plan_sobol(n, d, (unsigned long)plan->sample_seed, u);
  if (status != SHB_OK) {
    fault(issues, at, "uncertain", shb_message());
    free(u);
    return NULL;
  }
  map(keys, keys->n - d, d, n, u);
  return u;
}

void study_plan_add_samples(case_issues *issues, const case_node *at, const study_plan *plan,
                            const study_keys *keys, int *n, double **design) {
  int     group = study_plan_group(plan, keys), d = keys->n_uncertain, v = keys->n - d;
  double *varied = *design, *sample = make_group(issues, at, plan, keys);
  int     n_varied = *n;
  *design          = NULL;
  *n               = 0;
  if (sample && take(issues, at, (double)n_varied * group, keys->n, design)) *n = n_varied * group;
  for (int i = 0; i < *n; i++) {
    double *to = *design + (size_t)i * (size_t)keys->n;
    memcpy(to, varied + (size_t)(i / group) * (size_t)v, (size_t)v * sizeof *to);
    memcpy(to + v, sample + (size_t)(i % group) * (size_t)d, (size_t)d * sizeof *to);
  }
  free(varied);
  free(sample);
}

void study_plan_make(case_issues *issues, const case_node *at, const study_plan *plan,
                     study_keys *keys, int *n, double **design) {
  *n      = 0;
  *design = NULL;
  if (plan->kind == STUDY_TABLE && plan->columns)
    design_table_columns(issues, at, plan->columns, keys);
  else if (plan->kind == STUDY_TABLE && plan->table)
    design_table_read(issues, at, plan->table, keys, n, design);
  else if (plan->kind == STUDY_TABLE)
    case_issues_no_memory(issues);
  else if (plan->kind == STUDY_GRID)
    make_grid(issues, at, keys, keys->n, n, design);
  else
    make_sample(issues, at, plan, keys, keys->n, n, design);
}
