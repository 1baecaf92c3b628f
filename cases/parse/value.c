#include "cases/parse/value.h"

#include <complex.h>
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases/parse/damping.h"
#include "cases/parse/groups.h"
#include "cases/parse/lists.h"
#include "cases/parse/units.h"
#include "cases/parse/value_context.h"
#include "mesh/base/publish.h"

/* Of the tangential stiffness. The contact law needs the more steps the larger it is: at 2e7 twice
 * as many as at 1. */
static const double MOST_CONDITION = 1e7;

static bool read_number(const case_value_context *c, const case_node *node, void *slot) {
  return case_value_number(c, c->path, node, slot);
}

/* Reads a whole number, or the word: "all" stands for 0, "auto" for one less than the least. */
static bool read_count(const case_value_context *c, const case_node *node, void *slot) {
  bool automatic = c->key->type == CASE_AUTO;
  bool is_word   = node->kind == CASE_SCALAR && strcmp(node->text, automatic ? "auto" : "all") == 0;
  if (is_word) *(int *)slot = automatic ? (int)c->key->least - 1 : 0;
  if (!is_word && !automatic && c->key->words && node->kind == CASE_SCALAR &&
      strcmp(node->text, c->key->words) == 0) {
    *(int *)slot = (int)c->key->least - 2;
    return true;
  }
  return is_word || case_value_integer(c, node, slot);
}

/* Index of text in words separated by spaces, or -1. */
static int word_index(const char *words, const char *text) {
  int index = 0;
  for (const char *word = words; *word; index++) {
    size_t n = strcspn(word, " ");
    if (strlen(text) == n && strncmp(word, text, n) == 0) return index;
    word += n + (word[n] == ' ');
  }
  return -1;
}

static int choose(const case_value_context *c, const case_node *node) {
  if (node->kind != CASE_SCALAR) {
    case_value_refuse(c, node);
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

static bool read_choice(const case_value_context *c, const case_node *node, void *slot) {
  int index = choose(c, node);
  if (index >= 0) *(int *)slot = index;
  return index >= 0;
}

static bool read_switch(const case_value_context *c, const case_node *node, void *slot) {
  int index = choose(c, node);
  if (index >= 0) *(bool *)slot = index == 1;
  return index >= 0;
}

/* Reads a number, or one of the words; tolerance is in the order of the words of the row. */
static bool read_accuracy(const case_value_context *c, const case_node *node, void *slot) {
  static const double tolerance[] = {1e-3, 1e-5, 1e-8};

  const char *text = node->kind == CASE_SCALAR ? node->text : "";
  if (text[0] && strchr("+-.0123456789", text[0])) return case_value_number(c, c->path, node, slot);
  int index = choose(c, node);
  if (index >= 0) *(double *)slot = tolerance[index];
  return index >= 0;
}

/* Reads a list of frequencies, or one of the words; they are in the order of mhb_save_when. */
static bool read_saved(const case_value_context *c, const case_node *node, void *slot) {
  mhb_save_settings *save = slot;
  if (node->kind == CASE_SEQUENCE) return case_list_saved(c, node, slot);
  int index = choose(c, node);
  if (index >= 0) save->what = (mhb_save_when)index;
  return index >= 0;
}

/* Takes over the copy; NULL: no memory. */
static bool keep_text(const case_value_context *c, void *slot, char *copy) {
  if (!copy) case_issues_no_memory(c->issues);
  free(*(char **)slot);
  *(char **)slot = copy;
  return copy != NULL;
}

bool case_value_is_name(case_issues *issues, const char *path, const case_node *node) {
  const char *text = node->text;
  const bool  good = shb_name_is_plain(text) && text[0] != '.' && text[0] != '-' &&
                    strlen(text) <= 100 && !strchr(text, '/');
  if (!good)
    case_issue_add(issues, node->line, node->column, path,
                   "'%.60s' cannot be a file name: at most 100 characters, no '/', no '.' or '-' "
                   "first",
                   text);
  return good;
}

static bool read_word(const case_value_context *c, const case_node *node, void *slot) {
  if (node->kind != CASE_SCALAR) return case_value_refuse(c, node);
  return case_value_is_name(c->issues, c->path, node) && keep_text(c, slot, strdup(node->text));
}

static bool read_label(const case_value_context *c, const case_node *node, void *slot) {
  if (node->kind != CASE_SCALAR) return case_value_refuse(c, node);
  const char *text = node->text;
  bool        good = shb_name_is_plain(text) && strlen(text) < MESH_WORD && !strpbrk(text, "/\",");
  if (good) {
    strcpy(slot, text);
  } else {
    case_issue_add(c->issues, node->line, node->column, c->path,
                   "'%.90s' cannot be the name of a group: 1 to %d letters, no '/', ',' or '\"'",
                   text, MESH_WORD - 1);
  }
  return good;
}

static bool read_file_name(const case_value_context *c, const case_node *node, void *slot) {
  if (node->kind != CASE_SCALAR) return case_value_refuse(c, node);
  if (node->text[0] == '\0') {
    case_issue_add(c->issues, node->line, node->column, c->path, "is empty; expected a file name");
    return false;
  }
  size_t size = strlen(c->file->folder) + strlen(node->text) + 2;
  char  *path = malloc(size);
  bool   here = node->text[0] == '/' || strcmp(c->file->folder, ".") == 0;
  if (path)
    snprintf(path, size, "%s%s%s", here ? "" : c->file->folder, here ? "" : "/", node->text);
  return keep_text(c, slot, path);
}

/* {unit: Hz, mean: } beside {file: }. */
static bool read_mistuning_unit(const case_value_context *c, const case_node *node,
                                case_mistuning *m) {
  static const case_key hz = {.path = "mean", .unit = "Hz", .least = 0, .most = 1e6, .above = true};
  const case_node      *unit = case_node_find(node, "unit"), *mean = case_node_find(node, "mean");
  char                  path[CASE_PATH];
  for (int i = 0; i < node->n; i++) {
    const case_node *child = &node->child[i];
    if (child == unit || child == mean || !strcmp(child->key, "file")) continue;
    case_path(path, "%s.%s", c->path, child->key);
    case_issue_add(c->issues, child->key_line, child->key_column, path,
                   "does not go with a file; expected {file: NAME} or {file: NAME, unit: Hz, mean: "
                   "117 Hz}");
    return false;
  }
  m->hz = unit != NULL;
  if (unit && (unit->kind != CASE_SCALAR || strcmp(unit->text, "Hz") != 0)) {
    case_path(path, "%s.unit", c->path);
    case_issue_add(c->issues, unit->line, unit->column, path,
                   "is not Hz; of deviations such as 0.01 or 1 %% leave it out");
    return false;
  }
  if (!mean) return true;
  case_value_context own = *c;
  own.key                = &hz;
  case_path(path, "%s.mean", c->path);
  if (unit) return case_value_number(&own, path, mean, &m->mean);
  case_issue_add(c->issues, mean->line, mean->column, path, "goes with unit: Hz alone");
  return false;
}

/* List, {file: } or {deviation: , seed: }. */
static bool read_mistuning(const case_value_context *c, const case_node *node, void *slot) {
  case_mistuning  *m    = slot;
  const case_node *file = node->kind == CASE_MAPPING ? case_node_find(node, "file") : NULL;
  char             path[CASE_PATH];
  if (!file) return case_list_mistuning(c, node, slot);
  if (!read_mistuning_unit(c, node, m)) return false;
  case_value_context own = *c;
  case_path(path, "%s.file", c->path);
  own.path = path;
  m->kind  = CASE_MISTUNED_FILE;
  return read_file_name(&own, file, &m->file);
}

static bool read_vector(const case_value_context *c, const case_node *node, void *slot) {
  return case_value_numbers(c, c->path, node, 3, slot);
}

static bool read_interval(const case_value_context *c, const case_node *node, void *slot) {
  double *value = slot;
  if (!case_value_numbers(c, c->path, node, 2, value)) return false;
  if (value[0] < value[1]) return true;
  case_issue_add(c->issues, node->line, node->column, c->path,
                 "goes from %g to %g %s; the second must be above the first", value[0], value[1],
                 c->key->unit);
  return false;
}

static bool read_sweep(const case_value_context *c, const case_node *node, void *slot) {
  double *value = slot;
  if (node->kind != CASE_SCALAR) return read_interval(c, node, slot);
  if (!case_value_number(c, c->path, node, &value[0])) return false;
  value[1] = value[0];
  return true;
}

/* Reads one number or three. The range holds for an isotropic material, so not for three
 * numbers. */
static bool read_triple(const case_value_context *c, const case_node *node, void *slot) {
  double *v = slot;
  if (node->kind == CASE_SCALAR) {
    if (!case_value_number(c, c->path, node, v)) return false;
    v[1] = v[2] = v[0];
    return true;
  }
  case_key free_key = *c->key;
  free_key.least = free_key.most  = 0;
  case_value_context free_context = *c;
  free_context.key                = &free_key;
  return case_value_numbers(&free_context, c->path, node, 3, v);
}

/* Ratio of the eigenvalues of [k0 k1; k1 k2], which is positive definite. */
static double condition_number(const double k[3]) {
  double half = 0.5 * (k[0] + k[2]), greatest = half + hypot(0.5 * (k[0] - k[2]), k[1]);
  double determinant = k[0] * k[2] - k[1] * k[1];
  return greatest * (greatest / determinant);
}

static bool read_stiffness(const case_value_context *c, const case_node *node, void *slot) {
  double *k = slot;
  if (node->kind == CASE_SCALAR) {
    if (!case_value_number(c, c->path, node, &k[0])) return false;
    k[1] = 0;
    k[2] = k[0];
    return true;
  }
  if (node->kind != CASE_SEQUENCE) return case_value_refuse(c, node);
  /* kuw may have any sign, so the range holds for a single number only */
  case_key free_key = *c->key;
  free_key.least = free_key.most  = 0;
  case_value_context free_context = *c;
  free_context.key                = &free_key;
  if (!case_value_numbers(&free_context, c->path, node, 3, k)) return false;
  if (!(k[0] > 0 && k[2] > 0 && k[0] * k[2] > k[1] * k[1])) {
    case_issue_add(
        c->issues, node->line, node->column, c->path,
        "[%g, %g, %g] N/m is not positive definite: kuu and kww must be above 0 and kuu kww "
        "above kuw^2",
        k[0], k[1], k[2]);
    return false;
  }
  double condition = condition_number(k);
  if (condition <= MOST_CONDITION) return true;
  case_issue_add(c->issues, node->line, node->column, c->path,
                 "[%.12g, %.12g, %.12g] N/m is %.2g times stiffer in one direction than in the "
                 "other; at most %g times are allowed",
                 k[0], k[1], k[2], condition, MOST_CONDITION);
  return false;
}

static bool read_diameters(const case_value_context *c, const case_node *node, void *slot) {
  case_diameters *diameters = slot;
  if (node->kind == CASE_SEQUENCE) return case_list_diameters(c, node, slot);
  int index = choose(c, node);
  if (index >= 0) diameters->what = (case_diameters_kind)index;
  return index >= 0;
}

static bool read_damping(const case_value_context *c, const case_node *node, void *slot) {
  return case_damping_read(c->issues, c->path, node, slot);
}

static bool read_groups(const case_value_context *c, const case_node *node, void *slot) {
  return case_groups_read(c->issues, c->path, node, slot);
}

static bool read_signal(const case_value_context *c, const case_node *node, void *slot) {
  (void)slot;
  return node->kind == CASE_SEQUENCE || case_value_refuse(c, node);
}

bool case_value_read(case_issues *issues, const case_key *key, const char *path,
                     const case_node *node, case_file *file, void *slot) {
  static bool (*const readers[CASE_N_TYPES])(const case_value_context *, const case_node *,
                                             void *) = {[CASE_NUMBER]    = read_number,
                                                        [CASE_INTEGER]   = case_value_integer,
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
                                                        [CASE_GAUGES]    = case_list_gauges,
                                                        [CASE_MISTUNING] = read_mistuning,
                                                        [CASE_DAMPING]   = read_damping,
                                                        [CASE_GROUPS]    = read_groups,
                                                        [CASE_SIGNAL]    = read_signal,
                                                        [CASE_AUTO]      = read_count,
                                                        [CASE_PLACES]    = case_list_places,
                                                        [CASE_ORDERS]    = case_list_orders,
                                                        [CASE_POINTS]    = case_list_frequencies,
                                                        [CASE_SAVED]     = read_saved,
                                                        [CASE_DIAMETERS] = read_diameters};
  const case_value_context c = {.issues = issues, .key = key, .path = path, .file = file};
  return readers[key->type](&c, node, slot);
}
