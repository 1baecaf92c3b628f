#include "cases/designs/study_spec.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases/designs/design_table.h"
#include "cases/designs/digest.h"
#include "cases/parse/diagnostics.h"
#include "cases/parse/key_table.h"
#include "cases/parse/units.h"
#include "cases/schema/case.h"

enum { STAGES = CASE_MESH | CASE_MODAL | CASE_MHB, TOLD = 5 };

/* The keys of a study file. Only their names are used, for suggestions. */
static const case_key  rows[] = {{"name", CASE_WORD, .help = ""},
                                 {"case", CASE_FILE_NAME, .help = ""},
                                 {"vary", CASE_NUMBER, .help = ""},
                                 {"plan", CASE_WORD, .help = ""},
                                 {"outputs", CASE_WORD, .help = ""}};
static const case_keys known  = {sizeof rows / sizeof *rows, rows};

typedef struct {
  case_issues issues;
  study_spec *spec;
} reading;

static void fault(reading *r, const case_node *node, const char *key, const char *text) {
  case_issue_add(&r->issues, node->line, node->column, key, "%s", text);
}

static char *beside(const char *folder, const char *path) {
  size_t size = strlen(folder) + strlen(path) + 2;
  char  *out  = malloc(size);
  bool   here = path[0] == '/' || strcmp(folder, ".") == 0;
  if (out) snprintf(out, size, "%s%s%s", here ? "" : folder, here ? "" : "/", path);
  return out;
}

/* ---------------------------------------------------------------- varied keys */

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

static bool is_number(const case_key *key) {
  switch (key->type) {
    case CASE_NUMBER:
    case CASE_INTEGER:
    case CASE_COUNT:
    case CASE_AUTO:
    case CASE_ACCURACY:
    case CASE_VECTOR:
    case CASE_TRIPLE:
    case CASE_INTERVAL:
    case CASE_SWEEP:
    case CASE_STIFFNESS:
    case CASE_PRELOADS:
    case CASE_DAMPING:
      return true;
    default:
      return false;
  }
}

/* The message about a path that is no key: the nearest one of its block. */
static void refuse_path(reading *r, const case_node *node, const char *path) {
  char block[CASE_PATH], hint[512];
  case_path(block, "%s", path);
  char *dot  = strrchr(block, '.');
  char *leaf = dot ? dot + 1 : block;
  char  word[CASE_PATH];
  case_path(word, "%.*s", (int)strcspn(leaf, "["), leaf);
  if (dot) *dot = '\0';
  if (!dot) block[0] = '\0';
  for (char *at = block; *at; at++) /* "sections[4]" is the block "sections[]" */
    if (*at == '[')
      memmove(at + 1, at + 1 + strcspn(at + 1, "]"), strlen(at + 1 + strcspn(at + 1, "]")) + 1);
  if (!dot || case_key_is_block(case_key_table(), block)) {
    case_key_suggest(case_key_table(), block, word, hint, sizeof hint);
  } else { /* the first part is wrong */
    case_path(word, "%.*s", (int)strcspn(path, ".["), path);
    case_key_suggest(case_key_table(), "", word, hint, sizeof hint);
  }
  case_issue_add(&r->issues, node->key_line, node->key_column, path, "is no key of a case%s", hint);
}

static bool read_number(reading *r, const study_key *key, const case_node *node, double *value) {
  char why[CASE_WHY];
  if (node->kind != CASE_SCALAR) {
    case_issue_add(&r->issues, node->line, node->column, key->path, "is %s; expected a number",
                   case_kind_name(node->kind));
    return false;
  }
  if (!case_quantity(node->text, strcmp(key->unit, "-") == 0 ? "" : key->unit, value, why)) {
    case_issue_add(&r->issues, node->line, node->column, key->path, "%s", why);
    return false;
  }
  if (key->whole && *value != rint(*value)) {
    case_issue_add(&r->issues, node->line, node->column, key->path, "takes whole numbers");
    return false;
  }
  return true;
}

static bool take_values(reading *r, const case_node *node, study_key *key, int n) {
  key->n     = n;
  key->value = calloc((size_t)n + 1, sizeof *key->value);
  if (!key->value) fault(r, node, key->path, "out of memory");
  return key->value != NULL;
}

static void read_list(reading *r, const case_node *node, study_key *key) {
  if (node->n == 0) fault(r, node, key->path, "the list is empty; expected at least one number");
  if (node->n == 0 || !take_values(r, node, key, node->n)) return;
  for (int i = 0; i < node->n; i++) read_number(r, key, &node->child[i], &key->value[i]);
}

/* Read the members of {from, to, points, scale}; false after a fault. */
static bool read_members(reading *r, const case_node *node, study_key *key) {
  static const case_key members[] = {
      {.path = "from"}, {.path = "to"}, {.path = "points"}, {.path = "scale"}};
  const case_keys all  = {4, members};
  bool            good = true;
  for (int i = 0; i < node->n; i++) {
    const case_node *one = &node->child[i];
    char             hint[256], why[CASE_WHY];
    if (strcmp(one->key, "from") == 0) {
      good = read_number(r, key, one, &key->from) && good;
    } else if (strcmp(one->key, "to") == 0) {
      good = read_number(r, key, one, &key->to) && good;
    } else if (strcmp(one->key, "points") == 0) {
      if (one->kind != CASE_SCALAR || !case_integer(one->text, &key->n, why) || key->n < 1 ||
          key->n > STUDY_MOST_DESIGNS) {
        fault(r, one, key->path, "points: expected a whole number from 1");
        good = false;
      }
    } else if (strcmp(one->key, "scale") == 0) {
      key->log = one->kind == CASE_SCALAR && strcmp(one->text, "log") == 0;
      if (!key->log && (one->kind != CASE_SCALAR || strcmp(one->text, "linear") != 0)) {
        fault(r, one, key->path, "scale: expected linear or log");
        good = false;
      }
    } else {
      case_key_suggest(all, "", one->key, hint, sizeof hint);
      case_issue_add(&r->issues, one->key_line, one->key_column, key->path, "%s: unknown key%s",
                     one->key, hint);
      good = false;
    }
  }
  return good;
}

static void read_range(reading *r, const case_node *node, study_key *key) {
  key->is_range = true;
  key->n        = 0;
  if (!read_members(r, node, key)) return;
  bool ends = case_node_find(node, "from") && case_node_find(node, "to");
  if (!ends || !(key->from < key->to)) {
    fault(r, node, key->path, "expected from and to, from below to");
    return;
  }
  if (key->log && !(key->from > 0)) {
    fault(r, node, key->path, "scale: log needs a range above 0");
    return;
  }
  int n = key->n;
  if (n == 1) fault(r, node, key->path, "points: a range has 2 points or more");
  if (!take_values(r, node, key, n)) return;
  for (int i = 0; i < n; i++) {
    double t = n > 1 ? (double)i / (n - 1) : 0;
    key->value[i] =
        key->log ? key->from * pow(key->to / key->from, t) : key->from + (key->to - key->from) * t;
    if (i == n - 1) key->value[i] = key->to;
    if (key->whole) key->value[i] = rint(key->value[i]);
  }
}

/* Set path, unit and kind of a varied key. False if the path is no number of a case. */
static bool start_key(reading *r, const case_node *node, const char *path, study_key *key) {
  const case_key *row = row_of(path);
  *key                = (study_key){0};
  case_path(key->path, "%s", path);
  if (!row) {
    refuse_path(r, node, path);
    return false;
  }
  if (!is_number(row)) {
    case_issue_add(&r->issues, node->key_line, node->key_column, path,
                   "is not a number; a study varies numbers");
    return false;
  }
  key->whole = row->type == CASE_INTEGER || row->type == CASE_COUNT || row->type == CASE_AUTO;
  snprintf(key->unit, sizeof key->unit, "%s", row->unit[0] ? row->unit : "-");
  return true;
}

static void read_vary(reading *r, const case_node *node) {
  study_spec *s = r->spec;
  if (node->kind != CASE_MAPPING || node->n == 0) {
    fault(r, node, "vary",
          "expected a mapping of keys of the case, such as contact.n0: [5 N, 9 N]");
    return;
  }
  for (int i = 0; i < node->n; i++) {
    const case_node *one = &node->child[i];
    if (s->n_keys == STUDY_MAX_KEYS) {
      fault(r, one, "vary", "more than 32 keys");
      return;
    }
    study_key *key = &s->key[s->n_keys];
    if (!start_key(r, one, one->key, key)) continue;
    s->n_keys++;
    if (one->kind == CASE_SEQUENCE) {
      read_list(r, one, key);
    } else if (one->kind == CASE_MAPPING) {
      read_range(r, one, key);
    } else if (one->kind == CASE_SCALAR && take_values(r, one, key, 1)) {
      read_number(r, key, one, &key->value[0]);
    } else if (one->kind == CASE_NULL) {
      fault(r, one, one->key, "expected a list of values or {from, to, points}");
    }
  }
}

/* ---------------------------------------------------------------- plan and outputs */

static void read_plan(reading *r, const case_node *node) {
  const case_node *table = case_node_find(node, "table");
  if (node->kind == CASE_SCALAR && strcmp(node->text, "grid") == 0) {
    r->spec->plan = STUDY_GRID;
  } else if (table && node->n == 1 && table->kind == CASE_SCALAR) {
    r->spec->plan  = STUDY_TABLE;
    r->spec->table = beside(r->spec->folder, table->text);
  } else {
    fault(r, node, "plan", "expected grid or {table: FILE.csv}");
  }
}

static void add_output(reading *r, const case_node *node, const char *name) {
  study_spec *s = r->spec;
  char        why[512];
  if (s->n_outputs == STUDY_MAX_OUTPUTS) {
    fault(r, node, "outputs", "more than 64 outputs");
  } else if (!study_output_parse(name, &s->base, &s->output[s->n_outputs], why, sizeof why)) {
    fault(r, node, "outputs", why);
  } else {
    s->n_outputs++;
  }
}

static void read_outputs(reading *r, const case_node *node, const case_node *root) {
  if (!node) {
    add_output(r, root, "peak");
    add_output(r, root, "frequency");
    return;
  }
  if (node->kind == CASE_SCALAR) add_output(r, node, node->text);
  if (node->kind != CASE_SEQUENCE && node->kind != CASE_SCALAR)
    fault(r, node, "outputs", "expected a list of outputs, such as [peak, frequency]");
  for (int i = 0; node->kind == CASE_SEQUENCE && i < node->n; i++) {
    const case_node *one = &node->child[i];
    if (one->kind == CASE_SCALAR) add_output(r, one, one->text);
    if (one->kind != CASE_SCALAR) fault(r, one, "outputs", "expected the name of an output");
  }
  if (node->kind == CASE_SEQUENCE && node->n == 0) fault(r, node, "outputs", "the list is empty");
}

/* ---------------------------------------------------------------- designs */

static void make_grid(reading *r, const case_node *at) {
  study_spec *s = r->spec;
  double      n = 1;
  for (int k = 0; k < s->n_keys; k++) {
    if (s->key[k].n == 0)
      case_issue_add(&r->issues, at->line, at->column, s->key[k].path,
                     "a grid needs the number of points of the range");
    n *= s->key[k].n;
  }
  if (n > STUDY_MOST_DESIGNS)
    case_issue_add(&r->issues, at->line, at->column, "vary", "%.0f designs; at most %d", n,
                   STUDY_MOST_DESIGNS);
  if (r->issues.n > 0) return;
  s->n_designs = (int)n;
  s->design    = calloc((size_t)n * (size_t)s->n_keys + 1, sizeof *s->design);
  for (int d = 0; s->design && d < s->n_designs; d++)
    for (int k = s->n_keys - 1, rest = d; k >= 0; k--) { /* the last key runs fastest */
      s->design[d * s->n_keys + k] = s->key[k].value[rest % s->key[k].n];
      rest /= s->key[k].n;
    }
  if (!s->design) fault(r, at, "vary", "out of memory");
}

/* Take the columns of a table as varied keys, and its rows as designs. */
static void use_table(reading *r, const case_node *at) {
  study_spec  *s = r->spec;
  design_table table;
  char         why[512];
  if (!design_table_read(s->table, &table, why, sizeof why)) {
    fault(r, at, "plan", why);
    return;
  }
  for (int k = 0; k < table.n_columns && r->issues.n == 0; k++) {
    case_node column  = *at;
    column.key_line   = at->line;
    column.key_column = at->column;
    if (s->n_keys == STUDY_MAX_KEYS) fault(r, at, "plan", "the table has more than 32 columns");
    if (r->issues.n == 0 && start_key(r, &column, table.column[k], &s->key[s->n_keys])) s->n_keys++;
  }
  s->n_designs = table.n_rows;
  s->design    = calloc((size_t)table.n_rows * (size_t)table.n_columns + 1, sizeof *s->design);
  for (int i = 0; s->design && r->issues.n == 0 && i < table.n_rows * s->n_keys; i++) {
    int             k    = i % s->n_keys;
    const case_node cell = {
        .kind = CASE_SCALAR, .line = at->line, .column = at->column, .text = table.cell[i]};
    if (!read_number(r, &s->key[k], &cell, &s->design[i]))
      case_issue_add(&r->issues, at->line, at->column, "plan", "%s: row %d", s->table,
                     i / s->n_keys + 1);
  }
  design_table_free(&table);
}

static void make_designs(reading *r, const case_node *root) {
  study_spec      *s    = r->spec;
  const case_node *vary = case_node_find(root, "vary"), *plan = case_node_find(root, "plan");
  if (s->plan == STUDY_TABLE && vary) {
    fault(r, vary, "vary", "the columns of the table are the varied keys; leave vary out");
  } else if (s->plan == STUDY_TABLE) {
    use_table(r, plan);
  } else if (!vary) {
    fault(r, root, "vary", "missing; expected a mapping of keys of the case");
  } else if (r->issues.n == 0) {
    make_grid(r, vary);
  }
  if (r->issues.n == 0 && s->n_designs == 0) fault(r, root, "plan", "holds no design");
}

/* The first line of the messages of a case, without the name of its file. */
static void first_line(const char *text, const char *path, char *out, size_t size) {
  size_t n = strlen(path);
  if (strncmp(text, path, n) == 0 && text[n] == ':') text += n + 1;
  const char *error = strstr(text, "error: ");
  if (error) text = error + strlen("error: ");
  snprintf(out, size, "%.*s", (int)strcspn(text, "\n"), text);
}

/* Read every design as a case, and report the first that are refused. */
static void check_designs(reading *r, const case_node *at) {
  study_spec *s   = r->spec;
  int         bad = 0;
  s->digest       = calloc((size_t)s->n_designs + 1, sizeof *s->digest);
  for (int d = 0; s->digest && d < s->n_designs; d++) {
    char     *text = NULL, line[512];
    size_t    size = 0;
    FILE     *out  = open_memstream(&text, &size);
    case_file file;
    if (!out) return;
    shb_status status =
        study_spec_design(s, s->design + (size_t)d * (size_t)s->n_keys, NULL, NULL, out, &file);
    if (status == SHB_OK) {
      digest_design(&file, s->inputs, s->n_outputs, s->output, s->digest[d]);
      case_free(&file);
    }
    fclose(out);
    first_line(text, s->case_path, line, sizeof line);
    free(text);
    if (status != SHB_OK && bad++ < TOLD)
      case_issue_add(&r->issues, at->line, at->column, NULL, "design %d: %s", d + 1, line);
  }
  if (bad > TOLD)
    case_issue_add(&r->issues, at->line, at->column, NULL, "%d designs are refused in all", bad);
}

/* ---------------------------------------------------------------- the file */

static void read_name(reading *r, const case_node *node) {
  const char *from = r->spec->path, *slash = strrchr(from, '/');
  const char *leaf = slash ? slash + 1 : from, *dot = strrchr(leaf, '.');
  bool        good = !node || (node->kind == CASE_SCALAR && node->text[0] &&
                        !strpbrk(node->text, "/\\ \t") && strlen(node->text) < CASE_NAME);
  if (!good) fault(r, node, "name", "expected a word that may be the name of a file");
  r->spec->name = node && good
                      ? strdup(node->text)
                      : strndup(leaf, dot && dot != leaf ? (size_t)(dot - leaf) : strlen(leaf));
}

static bool read_case(reading *r, const case_node *root, FILE *errors) {
  const case_node *node = case_node_find(root, "case");
  if (!node || node->kind != CASE_SCALAR) {
    fault(r, node ? node : root, "case", "expected the path of a case file");
    return false;
  }
  r->spec->case_path = beside(r->spec->folder, node->text);
  if (!r->spec->case_path) return false;
  if (case_read(r->spec->case_path, STAGES, errors, &r->spec->base) == SHB_OK) {
    if (r->spec->base.mhb.parameter != MHB_IN_FREQUENCY)
      fault(r, node, "case", "the case follows mhb.vary; a study needs a case over the frequency");
    if (digest_inputs(&r->spec->base, &r->spec->inputs) == SHB_OK) return true;
    fault(r, node, "case", shb_message());
    return false;
  }
  case_issue_add(&r->issues, node->line, node->column, "case", "%s",
                 shb_message()[0] ? shb_message() : "the case has errors; see above");
  return false;
}

static void refuse_unknown(reading *r, const case_node *root) {
  for (int i = 0; i < root->n; i++) {
    char hint[512];
    if (case_key_find(known, root->child[i].key)) continue;
    case_key_suggest(known, "", root->child[i].key, hint, sizeof hint);
    case_issue_add(&r->issues, root->child[i].key_line, root->child[i].key_column,
                   root->child[i].key, "unknown key%s", hint);
  }
}

static void read_document(reading *r, bool check, FILE *errors) {
  case_node *root = case_document_parse(&r->issues);
  if (!root || root->kind != CASE_MAPPING) {
    if (r->issues.n == 0)
      case_issue_add(&r->issues, 1, 1, NULL, "the file holds no mapping of keys");
    case_document_free(root);
    return;
  }
  refuse_unknown(r, root);
  read_name(r, case_node_find(root, "name"));
  if (read_case(r, root, errors)) {
    if (case_node_find(root, "plan")) read_plan(r, case_node_find(root, "plan"));
    if (case_node_find(root, "vary")) read_vary(r, case_node_find(root, "vary"));
    read_outputs(r, case_node_find(root, "outputs"), root);
    make_designs(r, root);
    const case_node *place = case_node_find(root, "vary");
    if (r->issues.n == 0 && check) check_designs(r, place ? place : root);
  }
  case_document_free(root);
}

shb_status study_spec_read(const char *path, bool check, FILE *errors, study_spec *s) {
  size_t length = 0;
  *s            = (study_spec){0};
  SHB_TRY(case_text_read(path, &s->text, &length));
  const char *slash = strrchr(path, '/');
  s->path           = strdup(path);
  s->folder = slash ? strndup(path, slash == path ? 1 : (size_t)(slash - path)) : strdup(".");
  SHB_CHECK(s->path && s->folder, SHB_ERR_IO, "%s: out of memory", path);
  reading r = {case_issues_start(path, s->text, length), s};
  read_document(&r, check, errors);
  int n = r.issues.n;
  case_issues_print(&r.issues, errors);
  case_issues_free(&r.issues);
  return n == 0 ? SHB_OK : shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__, "%s", "");
}

void study_spec_free(study_spec *s) {
  free(s->path);
  free(s->text);
  free(s->folder);
  free(s->name);
  free(s->case_path);
  free(s->table);
  for (int i = 0; i < s->n_keys; i++) free(s->key[i].value);
  free(s->design);
  free(s->digest);
  free(s->inputs);
  case_free(&s->base);
  *s = (study_spec){0};
}

bool study_spec_words(const study_spec *s, const double *value, char **words) {
  bool good = true;
  for (int k = 0; k < s->n_keys; k++) {
    size_t size      = strlen(s->key[k].path) + 40;
    words[2 * k]     = strdup("--set");
    words[2 * k + 1] = malloc(size);
    good             = good && words[2 * k] && words[2 * k + 1];
    if (words[2 * k + 1]) snprintf(words[2 * k + 1], size, "%s=%.17g", s->key[k].path, value[k]);
  }
  return good;
}

shb_status study_spec_design(const study_spec *s, const double *value, const char *name,
                             const char *into, FILE *errors, case_file *file) {
  char       *words[2 * STUDY_MAX_KEYS] = {NULL}, named[CASE_NAME * 2];
  const char *text[STUDY_MAX_KEYS + 1];
  int         n      = 0;
  bool        good   = study_spec_words(s, value, words);
  shb_status  status = good ? SHB_OK : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  for (; n < s->n_keys; n++) text[n] = words[2 * n + 1];
  snprintf(named, sizeof named, "name=%s", name ? name : "");
  if (name) text[n++] = named;
  const case_overrides overrides = {n, text, into};
  if (status == SHB_OK) status = case_read_with(s->case_path, &overrides, STAGES, errors, file);
  for (int i = 0; i < 2 * s->n_keys; i++) free(words[i]);
  return status;
}
