#include "cases/parse/value_context.h"

#include <stdio.h>
#include <string.h>

#include "cases/parse/units.h"

void case_value_expected(const case_key *key, char *text, size_t size) {
  text[0] = '\0';
  case_append(text, size, "%s", case_types[key->type].expected);
  for (const char *word = key->words; word && *word;) {
    size_t n = strcspn(word, " ");
    case_append(text, size, "%s%.*s",
                key->type == CASE_COUNT ? " or "
                : word == key->words    ? " "
                                        : ", ",
                (int)n, word);
    word += n + (word[n] == ' ');
  }
  if (key->unit[0]) case_append(text, size, " in %s", key->unit);
}

bool case_value_refuse_kind(const case_value_context *c, const char *path, const case_node *node,
                            const char *expected) {
  if (node->kind != CASE_BROKEN)
    case_issue_add(c->issues, node->line, node->column, path, "%s; expected %s",
                   node->kind == CASE_NULL       ? "has no value"
                   : node->kind == CASE_SCALAR   ? "is a single value"
                   : node->kind == CASE_SEQUENCE ? "is a list"
                                                 : "is a mapping",
                   expected);
  return false;
}

bool case_value_refuse(const case_value_context *c, const case_node *node) {
  char expected[256];
  case_value_expected(c->key, expected, sizeof expected);
  return case_value_refuse_kind(c, c->path, node, expected);
}

static bool in_range(const case_key *key, double value) {
  if (key->least == 0 && key->most == 0) return true;
  bool low  = key->above ? value <= key->least : value < key->least;
  bool high = key->below ? value >= key->most : value > key->most;
  return !low && !high;
}

/* Customary units for bare numbers that do not fit their range in SI. */
static const struct {
  const char *si, *unit[3];
} customary[] = {{"Pa", {"GPa", "MPa", "kPa"}},
                 {"m", {"mm"}},
                 {"rad", {"deg"}},
                 {"rad/s", {"rpm"}},
                 {"kg/m3", {"g/cm3"}}};

/* "; did you mean 210 GPa?" for a bare number that fits the range with a customary unit; else "".
 */
static void guess_unit(const case_key *key, const char *number, char *text, size_t size) {
  text[0] = '\0';
  if (number[strspn(number, "+-.0123456789eE")] != '\0') return;
  for (size_t i = 0; i < sizeof customary / sizeof *customary; i++) {
    for (int u = 0; u < 3 && strcmp(key->unit, customary[i].si) == 0 && customary[i].unit[u]; u++) {
      char   with_unit[64], why[CASE_WHY];
      double value;
      snprintf(with_unit, sizeof with_unit, "%.40s %s", number, customary[i].unit[u]);
      if (!case_quantity(with_unit, key->unit, &value, why) || !in_range(key, value)) continue;
      snprintf(text, size, "; did you mean %s?", with_unit);
      return;
    }
  }
}

static bool check_range(const case_value_context *c, const char *path, const case_node *node,
                        double value) {
  if (in_range(c->key, value)) return true;
  char range[128], guess[96];
  case_key_range(c->key, range, sizeof range);
  guess_unit(c->key, node->text, guess, sizeof guess);
  case_issue_add(c->issues, node->line, node->column, path, "is %g%s%s, must be %s%s%s%s", value,
                 c->key->unit[0] ? " " : "", c->key->unit, range, c->key->unit[0] ? " " : "",
                 c->key->unit, guess);
  return false;
}

bool case_value_number(const case_value_context *c, const char *path, const case_node *node,
                       double *value) {
  char why[CASE_WHY], expected[128] = "a number";
  if (c->key->unit[0]) case_append(expected, sizeof expected, " in %s", c->key->unit);
  if (node->kind != CASE_SCALAR) return case_value_refuse_kind(c, path, node, expected);
  if (!case_quantity(node->text, c->key->unit, value, why)) {
    case_issue_add(c->issues, node->line, node->column, path, "%s", why);
    return false;
  }
  return check_range(c, path, node, *value);
}

bool case_value_integer(const case_value_context *c, const case_node *node, void *slot) {
  char why[CASE_WHY];
  if (node->kind != CASE_SCALAR) return case_value_refuse(c, node);
  if (!case_integer(node->text, slot, why)) {
    case_issue_add(c->issues, node->line, node->column, c->path, "%s", why);
    return false;
  }
  return check_range(c, c->path, node, *(int *)slot);
}

bool case_value_numbers(const case_value_context *c, const char *path, const case_node *node, int n,
                        double *value) {
  if (node->kind != CASE_SEQUENCE || node->n != n) {
    char expected[256] = "";
    case_append(expected, sizeof expected, "%d numbers", n);
    if (c->key->unit[0]) case_append(expected, sizeof expected, " in %s", c->key->unit);
    if (node->kind != CASE_SEQUENCE) return case_value_refuse_kind(c, path, node, expected);
    case_issue_add(c->issues, node->line, node->column, path, "has %d numbers, expected %d",
                   node->n, n);
    return false;
  }
  bool good = true;
  for (int i = 0; i < n; i++) {
    char inner[CASE_PATH];
    case_path(inner, "%s[%d]", path, i);
    good = case_value_number(c, inner, &node->child[i], &value[i]) && good;
  }
  return good;
}

bool case_value_polar(case_issues *issues, const char *path, const case_node *node,
                      const char *unit, double most, double polar[2]) {
  case_key keys[2]               = {{.unit = unit, .least = -most, .most = most}, {.unit = "rad"}};
  const case_value_context c     = {.issues = issues, .key = &keys[0], .path = path};
  const case_value_context phase = {.issues = issues, .key = &keys[1], .path = path};
  char                     inner[CASE_PATH];
  polar[0] = polar[1] = 0;
  if (node->kind == CASE_SCALAR) return case_value_number(&c, path, node, &polar[0]);
  if (node->kind != CASE_SEQUENCE)
    return case_value_refuse_kind(&c, path, node, "[amplitude, phase]");
  if (node->n != 2) {
    case_issue_add(issues, node->line, node->column, path,
                   "has %d value%s; expected [amplitude, phase]", node->n, node->n == 1 ? "" : "s");
    return false;
  }
  case_path(inner, "%s[0]", path);
  bool good = case_value_number(&c, inner, &node->child[0], &polar[0]);
  case_path(inner, "%s[1]", path);
  return case_value_number(&phase, inner, &node->child[1], &polar[1]) && good;
}
