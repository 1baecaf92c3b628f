#include "cases/designs/uncertain_keys.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cases/designs/study_table.h"
#include "cases/parse/keys.h"
#include "cases/parse/units.h"

static const char *const PARAMETERS[PLAN_N_DISTRIBUTIONS] = {
    [PLAN_UNIFORM] = "low, high",          [PLAN_LOG_UNIFORM] = "low, high",
    [PLAN_NORMAL] = "mean, deviation",     [PLAN_LOGNORMAL] = "mean, deviation",
    [PLAN_TRIANGULAR] = "low, mode, high", [PLAN_TRUNCATED_NORMAL] = "mean, deviation, low, high",
};

static void fault(case_issues *issues, const case_node *node, const char *key, const char *text) {
  case_issue_add(issues, node->line, node->column, key, "%s", text);
}

/* The distribution of this name; PLAN_N_DISTRIBUTIONS: none. */
static plan_kind kind_of(const char *name) {
  plan_kind kind = 0;
  while (kind < PLAN_N_DISTRIBUTIONS && strcmp(name, plan_distribution_name(kind)) != 0) kind++;
  return kind;
}

static void refuse_name(case_issues *issues, const case_node *node, const study_key *key) {
  char hint[512];
  case_key_suggest(study_key_table(), "uncertain{}", node->key, hint, sizeof hint);
  case_issue_add(issues, node->key_line, node->key_column, key->path, "%s: unknown distribution%s",
                 node->key, hint);
}

static bool is_percent(const case_node *node) {
  const size_t n = node->kind == CASE_SCALAR ? strlen(node->text) : 0;
  return n > 0 && node->text[n - 1] == '%';
}

/* A deviation in percent beside a mean without is relative to the mean. */
static void read_relative_deviation(case_issues *issues, const case_node *node, const char *path,
                                    double mean, double *value) {
  char why[CASE_WHY];
  if (!case_quantity(node->text, "", value, why))
    fault(issues, node, path, why);
  else
    *value *= fabs(mean);
}

/* Other parameters are in percent all or none. Where mean and deviation are both, the deviation is
 * a value as well. One above the mean is asked back, as it may be meant relative to it. */
static void refuse_percent(case_issues *issues, const case_node *list, int i, bool has_mean,
                           const double *parameter, const char *path) {
  const case_node *one = &list->child[i], *first = &list->child[0];
  if (is_percent(one) != is_percent(first)) {
    case_issue_add(issues, one->line, one->column, path,
                   "'%.40s' beside '%.40s': percent of what? A deviation is relative to the mean; "
                   "give the values themselves",
                   one->text, first->text);
    return;
  }
  if (!has_mean || i != 1 || !is_percent(one) || parameter[1] <= parameter[0]) return;
  case_issue_add(issues, one->line, one->column, path,
                 "'%.40s' of a mean of '%.40s': is it relative to the mean? Write the mean without "
                 "percent then",
                 one->text, first->text);
}

static void read_parameters(case_issues *issues, const case_node *node, plan_kind kind,
                            study_key *key) {
  int n = plan_distribution_parameters(kind), before = issues->n;
  if (node->kind == CASE_BROKEN) return; /* told */
  if (node->kind != CASE_SEQUENCE || node->n != n) {
    case_issue_add(issues, node->line, node->column, key->path, "%s: expected %d numbers [%s]",
                   plan_distribution_name(kind), n, PARAMETERS[kind]);
    return;
  }
  key->distribution.kind = kind;
  double    *parameter   = key->distribution.parameter;
  const bool has_mean    = strncmp(PARAMETERS[kind], "mean", strlen("mean")) == 0;
  for (int i = 0; i < n; i++) {
    const case_node *one   = &node->child[i];
    const bool       share = has_mean && i == 1 && is_percent(one) && !is_percent(&node->child[0]);
    if (share)
      read_relative_deviation(issues, one, key->path, parameter[0], &parameter[i]);
    else if (study_key_number(issues, key, one, &parameter[i]))
      refuse_percent(issues, node, i, has_mean, parameter, key->path);
  }
  if (issues->n == before && plan_distribution_check(&key->distribution, key->path) != SHB_OK)
    fault(issues, node, NULL, shb_message());
}

/* Read `relative`; the unit of a ratio is that of a pure number. */
static void read_relative(case_issues *issues, const case_node *node, study_key *key) {
  const char *text = node->kind == CASE_SCALAR ? node->text : "";
  key->is_ratio    = strcmp(text, "true") == 0 || strcmp(text, "yes") == 0;
  if (!key->is_ratio && strcmp(text, "false") != 0 && strcmp(text, "no") != 0)
    fault(issues, node, key->path, "relative: expected true or false");
  if (key->is_ratio) {
    strcpy(key->unit, "-");
    key->whole = false;
  }
}

static void read_distribution(case_issues *issues, const case_node *node, study_key *key) {
  static const char expected[] =
      "expected a distribution, such as {normal: [mean, deviation]} or {uniform: [low, high]}";
  const case_node *relative = case_node_find(node, "relative");
  int              given    = 0;
  key->is_uncertain         = true;
  if (node->kind != CASE_MAPPING || node->n == 0) {
    fault(issues, node, key->path, expected);
    return;
  }
  if (relative) read_relative(issues, relative, key);
  for (int i = 0; i < node->n; i++) {
    const case_node *one  = &node->child[i];
    plan_kind        kind = kind_of(one->key);
    if (one == relative) continue;
    given++;
    if (kind == PLAN_N_DISTRIBUTIONS)
      refuse_name(issues, one, key);
    else if (given == 1)
      read_parameters(issues, one, kind, key);
  }
  if (given != 1) fault(issues, node, key->path, expected);
}

/* A ratio needs the varied key of its path; a key that is varied must be a ratio. */
static void match_varied(case_issues *issues, const case_node *node, const study_keys *keys,
                         study_key *key) {
  key->nominal = -1;
  for (int k = 0; k < keys->n - keys->n_uncertain; k++)
    if (strcmp(keys->key[k].path, key->path) == 0) key->nominal = k;
  if (key->nominal >= 0 && !key->is_ratio)
    fault(issues, node, key->path,
          "is varied and uncertain; add relative: true to give the distribution of the ratio to "
          "the varied value, such as {normal: [1, 0.1], relative: true}");
  if (key->nominal < 0 && key->is_ratio)
    fault(issues, node, key->path, "relative: true needs the key in vary");
}

void uncertain_keys_read(case_issues *issues, const case_node *node, study_keys *keys) {
  if (node->kind != CASE_MAPPING || node->n == 0) {
    fault(issues, node, "uncertain",
          "expected a mapping of keys of the case, such as contact.mu: {normal: [0.3, 0.05]}");
    return;
  }
  for (int i = 0; i < node->n; i++) {
    const case_node *one = &node->child[i];
    study_key       *key = &keys->key[keys->n];
    if (keys->n == STUDY_MAX_KEYS) {
      fault(issues, one, "uncertain", "more than 32 keys");
      return;
    }
    if (!study_key_start(issues, one, one->key, key)) continue;
    read_distribution(issues, one, key);
    match_varied(issues, one, keys, key);
    keys->n++;
    keys->n_uncertain++;
  }
}
