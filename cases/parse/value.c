#include "cases/parse/value.h"

#include <complex.h>
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "cases/parse/damping.h"
#include "cases/parse/groups.h"
#include "cases/parse/lists.h"
#include "cases/parse/units.h"

void case_value_expected(const case_key *key, char *text, size_t size) {
  static const char *const shapes[CASE_N_TYPES] = {
      [CASE_NUMBER]    = "a number",
      [CASE_INTEGER]   = "a whole number",
      [CASE_COUNT]     = "a whole number or all",
      [CASE_AUTO]      = "a whole number or auto",
      [CASE_CHOICE]    = "one of",
      [CASE_SWITCH]    = "one of",
      [CASE_ACCURACY]  = "a number or one of",
      [CASE_WORD]      = "a name",
      [CASE_LABEL]     = "the name of a group",
      [CASE_FILE_NAME] = "a file name",
      [CASE_VECTOR]    = "[x, y, z]",
      [CASE_TRIPLE]    = "a number or three, for the axes",
      [CASE_INTERVAL]  = "[from, to]",
      [CASE_SWEEP]     = "[from, to] or a number",
      [CASE_STIFFNESS] = "a number or [kuu, kuw, kww]",
      [CASE_PRELOADS]  = "a number, a list or {from, to, points}",
      [CASE_PLACES]    = "a list of numbers",
      [CASE_ORDERS]    = "a list of whole numbers",
      [CASE_POINTS]    = "a whole number of points or a list",
      [CASE_FACTORS]   = "a mapping {harmonic: [factor, phase]}",
      [CASE_PROBES]    = "a mapping {name: [x, y, z]}",
      [CASE_DAMPING]   = "a number, a list, {loss_factor: ...} or {rayleigh: [alpha, beta]}",
      [CASE_GROUPS]    = "a mapping {group: rule}",
      [CASE_LIST]      = "a list of mappings",
      [CASE_SIGNAL]    = "a list of [amplitude, phase]"};
  text[0] = '\0';
  case_append(text, size, "%s", shapes[key->type]);
  for (const char *word = key->words; word && *word;) {
    size_t n = strcspn(word, " ");
    case_append(text, size, "%s%.*s", word == key->words ? " " : ", ", (int)n, word);
    word += n + (word[n] == ' ');
  }
  if (key->unit[0]) case_append(text, size, " in %s", key->unit);
}

bool case_reading_refuse_kind(const case_reading *c, const char *path, const case_node *node,
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

bool case_reading_refuse(const case_reading *c, const case_node *node) {
  char expected[256];
  case_value_expected(c->key, expected, sizeof expected);
  return case_reading_refuse_kind(c, c->path, node, expected);
}

static bool in_range(const case_key *key, double value) {
  if (key->least == 0 && key->most == 0) return true;
  bool low  = key->above ? value <= key->least : value < key->least;
  bool high = key->below ? value >= key->most : value > key->most;
  return !low && !high;
}

static bool check_range(const case_reading *c, const char *path, const case_node *node,
                        double value) {
  if (in_range(c->key, value)) return true;
  char range[128];
  case_key_range(c->key, range, sizeof range);
  case_issue_add(c->issues, node->line, node->column, path, "is %g%s%s, must be %s%s%s", value,
                 c->key->unit[0] ? " " : "", c->key->unit, range, c->key->unit[0] ? " " : "",
                 c->key->unit);
  return false;
}

bool case_reading_number(const case_reading *c, const char *path, const case_node *node,
                         double *value) {
  char why[CASE_WHY], expected[128] = "a number";
  if (c->key->unit[0]) case_append(expected, sizeof expected, " in %s", c->key->unit);
  if (node->kind != CASE_SCALAR) return case_reading_refuse_kind(c, path, node, expected);
  if (!case_quantity(node->text, c->key->unit, value, why)) {
    case_issue_add(c->issues, node->line, node->column, path, "%s", why);
    return false;
  }
  return check_range(c, path, node, *value);
}

static bool read_number(const case_reading *c, const case_node *node, void *slot) {
  return case_reading_number(c, c->path, node, slot);
}

bool case_reading_integer(const case_reading *c, const case_node *node, void *slot) {
  char why[CASE_WHY];
  if (node->kind != CASE_SCALAR) return case_reading_refuse(c, node);
  if (!case_integer(node->text, slot, why)) {
    case_issue_add(c->issues, node->line, node->column, c->path, "%s", why);
    return false;
  }
  return check_range(c, c->path, node, *(int *)slot);
}

/* A whole number, or the word that stands for 0. */
static bool read_count(const case_reading *c, const case_node *node, void *slot) {
  const char *word = c->key->type == CASE_AUTO ? "auto" : "all";
  bool        zero = node->kind == CASE_SCALAR && strcmp(node->text, word) == 0;
  if (zero) *(int *)slot = 0;
  return zero || case_reading_integer(c, node, slot);
}

/* Place of text in words separated by spaces, or -1. */
static int word_index(const char *words, const char *text) {
  int index = 0;
  for (const char *word = words; *word; index++) {
    size_t n = strcspn(word, " ");
    if (strlen(text) == n && strncmp(word, text, n) == 0) return index;
    word += n + (word[n] == ' ');
  }
  return -1;
}

static int choose(const case_reading *c, const case_node *node) {
  if (node->kind != CASE_SCALAR) {
    case_reading_refuse(c, node);
    return -1;
  }
  int index = word_index(c->key->words, node->text);
  if (index >= 0) return index;
  char expected[256];
  case_value_expected(c->key, expected, sizeof expected);
  case_issue_add(c->issues, node->line, node->column, c->path, "'%.60s' is not known; expected %s",
                 node->text, expected);
  return -1;
}

static bool read_choice(const case_reading *c, const case_node *node, void *slot) {
  int index = choose(c, node);
  if (index >= 0) *(int *)slot = index;
  return index >= 0;
}

static bool read_switch(const case_reading *c, const case_node *node, void *slot) {
  int index = choose(c, node);
  if (index >= 0) *(bool *)slot = index == 1;
  return index >= 0;
}

/* The words' tolerances, in the order of the row's words; what begins like a number is one. */
static bool read_accuracy(const case_reading *c, const case_node *node, void *slot) {
  static const double tolerance[] = {1e-3, 1e-5, 1e-8};

  const char *text = node->kind == CASE_SCALAR ? node->text : "";
  if (text[0] && strchr("+-.0123456789", text[0]))
    return case_reading_number(c, c->path, node, slot);
  int index = choose(c, node);
  if (index >= 0) *(double *)slot = tolerance[index];
  return index >= 0;
}

static bool keep_text(const case_reading *c, const case_node *node, void *slot, char *copy) {
  if (!copy) case_issue_add(c->issues, node->line, node->column, c->path, "out of memory");
  free(*(char **)slot);
  *(char **)slot = copy;
  return copy != NULL;
}

static bool is_control(unsigned char c) {
  return c < 0x20 || c == 0x7F;
}

static bool read_word(const case_reading *c, const case_node *node, void *slot) {
  if (node->kind != CASE_SCALAR) return case_reading_refuse(c, node);
  const char *text = node->text;
  bool        good = text[0] && text[0] != '.' && text[0] != '-' && strlen(text) <= 100;
  for (const char *at = text; *at; at++)
    good = good && *at != '/' && !is_control((unsigned char)*at);
  if (!good) {
    case_issue_add(
        c->issues, node->line, node->column, c->path,
        "'%.60s' cannot be a file name: at most 100 characters, no '/', no '.' or '-' first", text);
    return false;
  }
  return keep_text(c, node, slot, strdup(text));
}

static bool read_label(const case_reading *c, const case_node *node, void *slot) {
  if (node->kind != CASE_SCALAR) return case_reading_refuse(c, node);
  const char *text = node->text;
  bool        good = text[0] && strlen(text) < MESH_WORD;
  for (const char *at = text; *at; at++)
    good = good && !strchr("/\",", *at) && !is_control((unsigned char)*at);
  if (good) {
    strcpy(slot, text);
  } else {
    case_issue_add(c->issues, node->line, node->column, c->path,
                   "'%.90s' cannot be the name of a group: 1 to %d letters, no '/', ',' or '\"'",
                   text, MESH_WORD - 1);
  }
  return good;
}

static bool read_file_name(const case_reading *c, const case_node *node, void *slot) {
  if (node->kind != CASE_SCALAR) return case_reading_refuse(c, node);
  if (node->text[0] == '\0') {
    case_issue_add(c->issues, node->line, node->column, c->path, "is empty; expected a file name");
    return false;
  }
  size_t size = strlen(c->file->folder) + strlen(node->text) + 2;
  char  *path = malloc(size);
  bool   here = node->text[0] == '/' || strcmp(c->file->folder, ".") == 0;
  if (path)
    snprintf(path, size, "%s%s%s", here ? "" : c->file->folder, here ? "" : "/", node->text);
  return keep_text(c, node, slot, path);
}

/* A list of n numbers; names the shape if it is none. */
bool case_reading_numbers(const case_reading *c, const char *path, const case_node *node, int n,
                          double *value) {
  if (node->kind != CASE_SEQUENCE || node->n != n) {
    char expected[256] = "";
    case_append(expected, sizeof expected, "%d numbers", n);
    if (c->key->unit[0]) case_append(expected, sizeof expected, " in %s", c->key->unit);
    if (node->kind != CASE_SEQUENCE) return case_reading_refuse_kind(c, path, node, expected);
    case_issue_add(c->issues, node->line, node->column, path, "has %d numbers, expected %d",
                   node->n, n);
    return false;
  }
  bool good = true;
  for (int i = 0; i < n; i++) {
    char inner[CASE_PATH];
    case_path(inner, "%s[%d]", path, i);
    good = case_reading_number(c, inner, &node->child[i], &value[i]) && good;
  }
  return good;
}

static bool read_vector(const case_reading *c, const case_node *node, void *slot) {
  return case_reading_numbers(c, c->path, node, 3, slot);
}

static bool read_interval(const case_reading *c, const case_node *node, void *slot) {
  double *value = slot;
  if (!case_reading_numbers(c, c->path, node, 2, value)) return false;
  if (value[0] < value[1]) return true;
  case_issue_add(c->issues, node->line, node->column, c->path,
                 "goes from %g to %g %s; the second must be above the first", value[0], value[1],
                 c->key->unit);
  return false;
}

static bool read_sweep(const case_reading *c, const case_node *node, void *slot) {
  double *value = slot;
  if (node->kind != CASE_SCALAR) return read_interval(c, node, slot);
  if (!case_reading_number(c, c->path, node, &value[0])) return false;
  value[1] = value[0];
  return true;
}

/* A list may leave the range: it is that of an isotropic material. */
static bool read_triple(const case_reading *c, const case_node *node, void *slot) {
  double *v = slot;
  if (node->kind == CASE_SCALAR) {
    if (!case_reading_number(c, c->path, node, v)) return false;
    v[1] = v[2] = v[0];
    return true;
  }
  case_key free_key = *c->key;
  free_key.least = free_key.most = 0;
  case_reading free_context      = *c;
  free_context.key               = &free_key;
  return case_reading_numbers(&free_context, c->path, node, 3, v);
}

static bool read_stiffness(const case_reading *c, const case_node *node, void *slot) {
  double *k = slot;
  if (node->kind == CASE_SCALAR) {
    if (!case_reading_number(c, c->path, node, &k[0])) return false;
    k[1] = 0;
    k[2] = k[0];
    return true;
  }
  if (node->kind != CASE_SEQUENCE) return case_reading_refuse(c, node);
  case_key free_key = *c->key; /* kuw may have any sign: the range holds for a single number */
  free_key.least = free_key.most = 0;
  case_reading free_context      = *c;
  free_context.key               = &free_key;
  if (!case_reading_numbers(&free_context, c->path, node, 3, k)) return false;
  if (k[0] > 0 && k[2] > 0 && k[0] * k[2] > k[1] * k[1]) return true;
  case_issue_add(
      c->issues, node->line, node->column, c->path,
      "[%g, %g, %g] N/m is not positive definite: kuu and kww must be above 0 and kuu kww "
      "above kuw^2",
      k[0], k[1], k[2]);
  return false;
}

bool case_value_polar(case_issues *issues, const char *path, const case_node *node,
                      const char *unit, double polar[2]) {
  case_key           keys[2] = {{.unit = unit}, {.unit = "rad"}};
  const case_reading c       = {.issues = issues, .key = &keys[0], .path = path};
  const case_reading phase   = {.issues = issues, .key = &keys[1], .path = path};
  char               inner[CASE_PATH];
  polar[0] = polar[1] = 0;
  if (node->kind == CASE_SCALAR) return case_reading_number(&c, path, node, &polar[0]);
  if (node->kind != CASE_SEQUENCE)
    return case_reading_refuse_kind(&c, path, node, "[amplitude, phase]");
  if (node->n != 2) {
    case_issue_add(issues, node->line, node->column, path,
                   "has %d value%s; expected [amplitude, phase]", node->n, node->n == 1 ? "" : "s");
    return false;
  }
  case_path(inner, "%s[0]", path);
  bool good = case_reading_number(&c, inner, &node->child[0], &polar[0]);
  case_path(inner, "%s[1]", path);
  return case_reading_number(&phase, inner, &node->child[1], &polar[1]) && good;
}

static bool read_damping(const case_reading *c, const case_node *node, void *slot) {
  return case_damping_read(c->issues, c->path, node, slot);
}

static bool read_groups(const case_reading *c, const case_node *node, void *slot) {
  return case_groups_read(c->issues, c->path, node, slot);
}

static bool read_signal(const case_reading *c, const case_node *node, void *slot) {
  (void)slot;
  return node->kind == CASE_SEQUENCE || case_reading_refuse(c, node);
}

bool case_value_read(case_issues *issues, const case_key *key, const char *path,
                     const case_node *node, case_file *file, void *slot) {
  static bool (*const readers[CASE_N_TYPES])(const case_reading *, const case_node *, void *) = {
      [CASE_NUMBER]    = read_number,
      [CASE_INTEGER]   = case_reading_integer,
      [CASE_COUNT]     = read_count,
      [CASE_CHOICE]    = read_choice,
      [CASE_SWITCH]    = read_switch,
      [CASE_ACCURACY]  = read_accuracy,
      [CASE_WORD]      = read_word,
      [CASE_LABEL]     = read_label,
      [CASE_FILE_NAME] = read_file_name,
      [CASE_VECTOR]    = read_vector,
      [CASE_TRIPLE]    = read_triple,
      [CASE_INTERVAL]  = read_interval,
      [CASE_SWEEP]     = read_sweep,
      [CASE_STIFFNESS] = read_stiffness,
      [CASE_PRELOADS]  = case_list_preloads,
      [CASE_FACTORS]   = case_list_factors,
      [CASE_PROBES]    = case_list_probes,
      [CASE_DAMPING]   = read_damping,
      [CASE_GROUPS]    = read_groups,
      [CASE_SIGNAL]    = read_signal,
      [CASE_AUTO]      = read_count,
      [CASE_PLACES]    = case_list_places,
      [CASE_ORDERS]    = case_list_orders,
      [CASE_POINTS]    = case_list_frequencies};
  const case_reading c = {.issues = issues, .key = key, .path = path, .file = file};
  return readers[key->type](&c, node, slot);
}
