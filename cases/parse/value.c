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
#include "mesh/base/shortest.h"

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

static int n_words(const char *words) {
  int n = 1;
  for (const char *c = words; *c; c++) n += *c == ' ';
  return n;
}

/* Reads a list, or one of the words. */
static bool read_word_or_list(const case_value_context *c, const case_node *node, void *slot) {
  int *what = (int *)((char *)slot - c->key->at + c->key->what_at);
  if (node->kind == CASE_SEQUENCE) {
    *what = n_words(c->key->words);
    return case_list_numbers(c, node, slot);
  }
  const int index = choose(c, node);
  if (index >= 0) *what = index;
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

/* ---------------------------------------------------------------- values as text */

/* The path as in the case file, so that settings do not depend on the working folder. */
static const char *inside(const case_file *file, const char *path) {
  const size_t n = strlen(file->folder);
  return strncmp(path, file->folder, n) == 0 && path[n] == '/' ? path + n + 1 : path;
}

static void print_number(const case_printed *p) {
  shb_print_shortest(p->out, 1, p->slot);
}

static void print_two(const case_printed *p) {
  shb_print_shortest(p->out, 2, p->slot);
}

static void print_three(const case_printed *p) {
  shb_print_shortest(p->out, 3, p->slot);
}

/* One number if the three are equal. */
static void print_triple(const case_printed *p) {
  const double *v = p->slot;
  shb_print_shortest(p->out, v[0] == v[1] && v[1] == v[2] ? 1 : 3, v);
}

static void print_integer(const case_printed *p) {
  fprintf(p->out, "%d", *(const int *)p->slot);
}

static void print_auto(const case_printed *p) {
  if (*(const int *)p->slot < p->key->least)
    fputs("auto", p->out);
  else
    print_integer(p);
}

static void print_word(const case_printed *p, int index) {
  const char *words = p->key->words;
  for (; index > 0; index--) words = strchr(words, ' ') + 1;
  fprintf(p->out, "%.*s", (int)strcspn(words, " "), words);
}

static void print_choice(const case_printed *p) {
  print_word(p, *(const int *)p->slot);
}

static void print_switch(const case_printed *p) {
  print_word(p, *(const bool *)p->slot);
}

static void print_label(const case_printed *p) {
  fputs(p->slot, p->out);
}

static void print_text(const case_printed *p) {
  fputs(*(char *const *)p->slot, p->out);
}

static void print_file_name(const case_printed *p) {
  const char *path = *(char *const *)p->slot;
  fputs(path ? inside(p->file, path) : "-", p->out);
}

static void print_numbers(const case_printed *p) {
  const char *base = (const char *)p->slot - p->key->at;
  shb_print_shortest(p->out, *(const int *)(base + p->key->count_at), p->slot);
}

static void print_integers(const case_printed *p) {
  const char *base = (const char *)p->slot - p->key->at;
  const int  *v    = p->slot;
  for (int i = 0; i < *(const int *)(base + p->key->count_at); i++)
    fprintf(p->out, "%s%d", i ? " " : "", v[i]);
}

static void print_word_or_list(const case_printed *p) {
  const char *base = (const char *)p->slot - p->key->at;
  const int   what = *(const int *)(base + p->key->what_at);
  if (what < n_words(p->key->words))
    print_word(p, what);
  else if (p->key->type == CASE_WORD_OR_INTEGERS)
    print_integers(p);
  else
    print_numbers(p);
}

static void print_points(const case_printed *p) {
  const mhb_integration_settings *asked = &p->file->integrate;
  if (asked->listed)
    shb_print_shortest(p->out, asked->n_frequencies, p->slot);
  else
    fprintf(p->out, "%d points", asked->n_frequencies);
}

/* Of a file its content counts, not its name. */
static void print_mistuning(const case_printed *p) {
  const case_mistuning *m = p->slot;
  char                  fingerprint[17], deviation[SHB_SHORTEST];
  if (m->kind == CASE_MISTUNED_LIST) shb_print_shortest(p->out, m->n, m->each);
  if (m->kind == CASE_MISTUNED_RANDOM)
    fprintf(p->out, "deviation %s seed %d samples %d", shb_shortest(m->deviation, deviation),
            m->seed, m->samples);
  if (m->kind != CASE_MISTUNED_FILE) return;
  if (shb_fingerprint(m->file, fingerprint) != SHB_OK) strcpy(fingerprint, "-");
  fprintf(p->out, "file %s %s", inside(p->file, m->file), fingerprint);
  if (m->hz) fprintf(p->out, " Hz mean %s", shb_shortest(m->mean, deviation));
}

static void print_damping(const case_printed *p) {
  case_damping_print(p->out, p->slot);
}

static void print_factors(const case_printed *p) {
  const fem_load *load = p->slot;
  for (int k = 0; k <= load->n_harmonics; k++) {
    const double parts[2] = {creal(load->factor[k]), cimag(load->factor[k])};
    if (load->factor[k] == 0) continue;
    fprintf(p->out, "%s.%d = ", p->path, k);
    shb_print_shortest(p->out, 2, parts);
    fputc('\n', p->out);
  }
}

static void print_probes(const case_printed *p) {
  for (int i = 0; i < p->file->n_probes; i++) {
    fprintf(p->out, "%s.%s = ", p->path, p->file->probe[i].name);
    shb_print_shortest(p->out, 3, p->file->probe[i].at);
    fputc('\n', p->out);
  }
}

static void print_gauges(const case_printed *p) {
  for (int i = 0; i < p->file->n_gauges; i++) {
    fprintf(p->out, "%s.%s = ", p->path, p->file->gauge[i].name);
    shb_print_shortest(p->out, 3, p->file->gauge[i].at);
    fputs("; ", p->out);
    shb_print_shortest(p->out, 3, p->file->gauge[i].direction);
    fputc('\n', p->out);
  }
}

static void print_groups(const case_printed *p) {
  case_groups_print(p->out, p->path, p->slot);
}

/* ---------------------------------------------------------------- the table of types */

/* clang-format off */
const case_type_row case_types[CASE_N_TYPES] = {
  [CASE_NUMBER]    = {"number", "a number", "N", read_number, print_number, .number = true},
  [CASE_INTEGER]   = {"integer", "a whole number", "I", case_value_integer, print_integer,
                      .number = true, .whole = true},
  [CASE_COUNT]     = {"integer or all", "a whole number or all", "I =all w", read_count,
                      print_integer, .number = true, .whole = true},
  [CASE_AUTO]      = {"integer or auto", "a whole number or auto", "I =auto", read_count,
                      print_auto, .number = true, .whole = true},
  [CASE_CHOICE]    = {"word", "one of", "W", read_choice, print_choice},
  [CASE_SWITCH]    = {"word", "one of", "W", read_switch, print_switch},
  [CASE_ACCURACY]  = {"word or number", "a number or one of", "W N", read_accuracy, print_number,
                      .number = true},
  [CASE_WORD]      = {"word", "a name", "S", read_word, print_text},
  [CASE_LABEL]     = {"word", "the name of a group", "S", read_label, print_label},
  [CASE_FILE_NAME] = {"file", "a file name", "S", read_file_name, print_file_name},
  [CASE_VECTOR]    = {"[x, y, z]", "[x, y, z]", "3", read_vector, print_three, .number = true},
  [CASE_TRIPLE]    = {"number or list", "a number or three, for the axes", "N 3", read_triple,
                      print_triple, .number = true},
  [CASE_INTERVAL]  = {"[from, to]", "[from, to]", "2", read_interval, print_two, .number = true},
  [CASE_SWEEP]     = {"[from, to] or number", "[from, to] or a number", "N 2", read_sweep,
                      print_two, .number = true},
  [CASE_STIFFNESS] = {"number or list", "a number or [kuu, kuw, kww]", "N 3", read_stiffness,
                      print_three, .number = true},
  [CASE_PRELOADS]  = {"number(s)", "a number, a list or {from, to, points}",
                      "N * {^(from|to|points)$}", case_list_preloads, print_numbers,
                      .number = true},
  [CASE_NUMBERS]   = {"list", "a list of numbers", "*", case_list_numbers, print_numbers},
  [CASE_INTEGERS]  = {"list", "a list of whole numbers", "J", case_list_numbers, print_integers},
  [CASE_WORD_OR_NUMBERS]  = {"word or list", "a list of numbers or one of", "W *",
                             read_word_or_list, print_word_or_list},
  [CASE_WORD_OR_INTEGERS] = {"word or list", "a list of whole numbers or one of", "W J",
                             read_word_or_list, print_word_or_list},
  [CASE_POINTS]    = {"integer or list", "a whole number of points or a list", "I *",
                      case_list_frequencies, print_points},
  [CASE_FACTORS]   = {"mapping", "a mapping {harmonic: [factor, phase]}", "{^[0-9]+$}",
                      case_list_factors, print_factors, .own_lines = true},
  [CASE_PROBES]    = {"mapping", "a mapping {name: [x, y, z]}", "{}", case_list_probes,
                      print_probes, .own_lines = true},
  [CASE_GAUGES]    = {"mapping", "a mapping {name: {at: [x, y, z], direction: [x, y, z]}}", "{}",
                      case_list_gauges, print_gauges, .own_lines = true},
  [CASE_MISTUNING] = {"number(s), mapping", "a list, {file: NAME} or {deviation: 1 %, seed: 7}",
                      "* {^(file|unit|mean|deviation|seed|samples)$}", read_mistuning,
                      print_mistuning},
  [CASE_DAMPING]   = {"number(s), mapping",
                      "a number, a list, {loss_factor: ...} or {rayleigh: [alpha, beta]}",
                      "N * {^(loss_factor|rayleigh)$}", read_damping, print_damping,
                      .number = true},
  [CASE_GROUPS]    = {"mapping", "a mapping {group: rule}", "{}", read_groups, print_groups,
                      .own_lines = true},
  [CASE_LIST]      = {"list", "a list of mappings", "", NULL, NULL}, /* by the reader */
  [CASE_KEYS]      = {"mapping", "a mapping", "{}", NULL, NULL},
  [CASE_NAMES]     = {"list", "a list of names", "A", NULL, NULL},
  [CASE_SIGNAL]    = {"list", "a list of [amplitude, phase]", "A", read_signal, NULL}};
/* clang-format on */

bool case_value_read(case_issues *issues, const case_key *key, const char *path,
                     const case_node *node, case_file *file, void *slot) {
  const case_value_context c = {.issues = issues, .key = key, .path = path, .file = file};
  return case_types[key->type].read(&c, node, slot);
}

void case_value_print(const case_printed *p) {
  const case_type_row *type = &case_types[p->key->type];
  if (!type->own_lines) fprintf(p->out, "%s = ", p->path);
  type->print(p);
  if (!type->own_lines) fputc('\n', p->out);
}
