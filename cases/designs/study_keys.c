#include "cases/designs/study_keys.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/designs/study_table.h"
#include "cases/parse/key_table.h"
#include "cases/parse/units.h"

static void fault(case_issues *issues, const case_node *node, const char *key, const char *text) {
  case_issue_add(issues, node->line, node->column, key, "%s", text);
}

/* Members of a key with a mapping that are numbers. */
static const case_key mapping_members[] = {
    {.path = "rotor.mistuning.deviation", .type = CASE_NUMBER, .unit = ""},
    {.path = "rotor.mistuning.seed", .type = CASE_INTEGER, .unit = ""}};

static const case_key *member_of(const char *path) {
  for (size_t i = 0; i < sizeof mapping_members / sizeof *mapping_members; i++)
    if (strcmp(mapping_members[i].path, path) == 0) return &mapping_members[i];
  return NULL;
}

/* The row of a path: indices become "[]", and an index at the end may choose a number of a list. */
static const case_key *row_of(const char *path) {
  char   pattern[CASE_PATH];
  size_t n = 0;
  for (const char *at = path; *at && n + 3 < sizeof pattern; at++) {
    pattern[n++] = *at;
    if (*at != '[') continue;
    at += strcspn(at, "]");
    pattern[n++] = ']';
    if (!*at) break;
  }
  pattern[n]          = '\0';
  const case_key *key = case_key_find(case_key_table(), pattern);
  if (!key && n > 2 && strcmp(pattern + n - 2, "[]") == 0) {
    pattern[n - 2] = '\0';
    key            = case_key_find(case_key_table(), pattern);
  }
  return key;
}

/* A part of a path as the key table has it: an index becomes "[]". Returns the length of the part
 * with its index. */
static size_t part_of(const char *at, char word[CASE_PATH], char pattern[CASE_PATH]) {
  size_t name = strcspn(at, ".["), whole = strcspn(at, ".");
  case_path(word, "%.*s", (int)name, at);
  case_path(pattern, "%s%s", word, at[name] == '[' ? "[]" : "");
  return whole;
}

/* The nearest path that is a key, with the indices of path. False: there is none; block is then the
 * block of the part that is no key, and word this part. */
static bool nearest_path(const char *path, char near[CASE_PATH], char block[CASE_PATH],
                         char word[CASE_PATH]) {
  const case_keys keys = case_key_table();
  char            pattern[CASE_PATH], longer[CASE_PATH], best[CASE_LONGEST_WORD];
  near[0] = block[0] = '\0';
  for (const char *at = path;; at++) {
    size_t      n   = part_of(at, word, pattern);
    const char *dot = block[0] ? "." : "", *index = at + strlen(word);
    case_path(longer, "%s%s%s", block, dot, pattern);
    bool known = case_key_is_block(keys, longer) || row_of(longer);
    if (!known && !case_key_nearest(keys, block, word, best)) return false;
    if (!known) case_path(longer, "%s%s%s%s", block, dot, best, pattern + strlen(word));
    case_append(near, CASE_PATH, "%s%s%.*s", dot, known ? word : best, (int)(n - strlen(word)),
                index);
    at += n;
    if (!*at) return row_of(longer) != NULL;
    case_path(block, "%s", longer);
    if (case_key_is_block(keys, block)) continue;
    case_append(block, CASE_PATH, "[]"); /* a list without an index, perhaps */
    if (!case_key_is_block(keys, block)) return row_of(longer) != NULL;
    case_append(near, CASE_PATH, "[0]");
  }
}

/* The message about a path that is no key: the nearest one. */
static void refuse_path(case_issues *issues, const case_node *node, const char *path) {
  char near[CASE_PATH], block[CASE_PATH], word[CASE_PATH], hint[512];
  if (case_key_is_block(case_key_table(), path)) { /* a mapping of the case */
    case_key_suggest(case_key_table(), path, "", hint, sizeof hint);
  } else if (nearest_path(path, near, block, word)) {
    snprintf(hint, sizeof hint, "; did you mean '%s'?", near);
  } else {
    case_key_suggest(case_key_table(), block, word, hint, sizeof hint);
  }
  case_issue_add(issues, node->key_line, node->key_column, path, "is no key of a case%s", hint);
}

bool study_key_number(case_issues *issues, const study_key *key, const case_node *node,
                      double *value) {
  char why[CASE_WHY];
  if (node->kind == CASE_BROKEN) return false; /* told */
  if (node->kind != CASE_SCALAR) {
    case_issue_add(issues, node->line, node->column, key->path, "is %s; expected a number",
                   case_kind_name(node->kind));
    return false;
  }
  if (!case_quantity(node->text, strcmp(key->unit, "-") == 0 ? "" : key->unit, value, why)) {
    case_issue_add(issues, node->line, node->column, key->path, "%s", why);
    return false;
  }
  if (key->whole && *value != rint(*value)) {
    case_issue_add(issues, node->line, node->column, key->path, "takes whole numbers");
    return false;
  }
  return true;
}

static bool take_values(case_issues *issues, study_key *key, int n) {
  key->n     = n;
  key->value = calloc((size_t)n + 1, sizeof *key->value);
  if (!key->value) case_issues_no_memory(issues);
  return key->value != NULL;
}

static void read_list(case_issues *issues, const case_node *node, study_key *key) {
  if (node->n == 0)
    fault(issues, node, key->path, "the list is empty; expected at least one number");
  if (node->n == 0 || !take_values(issues, key, node->n)) return;
  for (int i = 0; i < node->n; i++) {
    const case_node *one = &node->child[i];
    if (!study_key_number(issues, key, one, &key->value[i])) continue;
    for (int k = 0; k < i; k++) {
      if (key->value[k] != key->value[i]) continue;
      case_issue_add(issues, one->line, one->column, key->path,
                     "is %s, which value %d is already; every value once, with a decimal point",
                     one->text, k + 1);
      return;
    }
  }
}

/* Read the members of {from, to, points, scale}; false after a fault. */
static bool read_members(case_issues *issues, const case_node *node, study_key *key) {
  const int before = issues->n;
  int       scale  = 0;
  for (int i = 0; i < node->n; i++) {
    const case_node *one = &node->child[i];
    char             path[CASE_PATH];
    case_path(path, "%s.%s", key->path, one->key);
    if (one->kind == CASE_BROKEN) return false; /* told */
    if (strcmp(one->key, "from") == 0)
      study_key_number(issues, key, one, &key->from);
    else if (strcmp(one->key, "to") == 0)
      study_key_number(issues, key, one, &key->to);
    else if (strcmp(one->key, "points") == 0)
      study_table_read(issues, "vary{}.points", path, one, &key->n);
    else if (strcmp(one->key, "scale") == 0)
      study_table_read(issues, "vary{}.scale", path, one, &scale);
    else
      study_table_refuse(issues, "vary{}", key->path, one);
  }
  key->log = scale == 1;
  return issues->n == before;
}

static void read_range(case_issues *issues, const case_node *node, study_key *key) {
  key->is_range = true;
  key->n        = 0;
  if (!read_members(issues, node, key)) return;
  bool ends = case_node_find(node, "from") && case_node_find(node, "to");
  if (!ends || !(key->from < key->to)) {
    fault(issues, node, key->path, "expected from and to, from below to");
    return;
  }
  if (key->log && !(key->from > 0)) {
    fault(issues, node, key->path, "scale: log needs a range above 0");
    return;
  }
  int n = key->n;
  if (n == 1) fault(issues, node, key->path, "points: a range has 2 points or more");
  if (!take_values(issues, key, n)) return;
  for (int i = 0; i < n; i++) {
    double t = n > 1 ? (double)i / (n - 1) : 0;
    key->value[i] =
        key->log ? key->from * pow(key->to / key->from, t) : key->from + (key->to - key->from) * t;
    if (i == n - 1) key->value[i] = key->to;
    if (key->whole) key->value[i] = rint(key->value[i]);
  }
}

/* Set path, unit and kind of a varied key. False if the path is no number of a case. */
bool study_key_start(case_issues *issues, const case_node *node, const char *path, study_key *key) {
  const case_key *row = member_of(path) ? member_of(path) : row_of(path);
  *key                = (study_key){0};
  case_path(key->path, "%s", path);
  if (!row) {
    refuse_path(issues, node, path);
    return false;
  }
  if (!case_types[row->type].number) {
    case_issue_add(issues, node->key_line, node->key_column, path,
                   "is not a number; a study varies numbers");
    return false;
  }
  key->whole = case_types[row->type].whole;
  snprintf(key->unit, sizeof key->unit, "%s", row->unit[0] ? row->unit : "-");
  return true;
}

static void read_values(case_issues *issues, const case_node *node, study_key *key) {
  if (node->kind == CASE_SEQUENCE) {
    read_list(issues, node, key);
  } else if (node->kind == CASE_MAPPING) {
    read_range(issues, node, key);
  } else if (node->kind == CASE_SCALAR && take_values(issues, key, 1)) {
    study_key_number(issues, key, node, &key->value[0]);
  } else if (node->kind == CASE_NULL) {
    fault(issues, node, node->key, "expected a list of values or {from, to, points}");
  }
}

void study_keys_read(case_issues *issues, const case_node *node, study_keys *keys) {
  if (node->kind != CASE_MAPPING || node->n == 0) {
    fault(issues, node, "vary",
          "expected a mapping of keys of the case, such as contact.n0: [5 N, 9 N]");
    return;
  }
  for (int i = 0; i < node->n; i++) {
    const case_node *one = &node->child[i];
    if (keys->n == STUDY_MAX_KEYS) {
      fault(issues, one, "vary", "more than 32 keys");
      return;
    }
    study_key *key = &keys->key[keys->n];
    if (!study_key_start(issues, one, one->key, key)) continue;
    keys->n++;
    read_values(issues, one, key);
  }
}

void study_keys_free(study_keys *keys) {
  for (int i = 0; i < keys->n; i++) free(keys->key[i].value);
  *keys = (study_keys){0};
}

void study_key_name(const study_key *key, char out[STUDY_KEY_TEXT]) {
  snprintf(out, STUDY_KEY_TEXT, "%s%s", key->path, key->is_ratio ? " (ratio)" : "");
}

double study_key_at(const study_key *key, double u) {
  double low = key->from, high = key->to;
  if (key->is_uncertain) {
    double value = plan_quantile(&key->distribution, u);
    return key->whole ? rint(value) : value;
  }
  if (!key->is_range) return key->value[(int)fmin(floor(u * key->n), key->n - 1)];
  if (key->log) return key->whole ? rint(low * pow(high / low, u)) : low * pow(high / low, u);
  if (key->whole) return fmin(floor(low + u * (high - low + 1)), high);
  return low + u * (high - low);
}
