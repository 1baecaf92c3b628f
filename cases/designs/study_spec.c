#include "cases/designs/study_spec.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases/designs/digest.h"
#include "cases/designs/refusals.h"
#include "cases/designs/study_table.h"
#include "cases/designs/uncertain_keys.h"
#include "cases/parse/diagnostics.h"
#include "cases/parse/keys.h"
#include "cases/parse/value.h"
#include "cases/schema/case.h"
#include "mesh/base/publish.h"

enum { STAGES = CASE_MESH | CASE_MODAL | CASE_MHB };

typedef struct {
  case_issues        issues;
  study_spec        *spec;
  const study_texts *texts; /* NULL: the files are read */
  case_overrides     overrides;
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

/* ---------------------------------------------------------------- outputs */

static void add_output(reading *r, const case_node *node, const char *name) {
  study_spec *s = r->spec;
  char        why[512];
  for (int i = 0; i < s->n_outputs; i++) {
    if (strcmp(s->output[i].name, name) != 0) continue;
    case_issue_add(&r->issues, node->line, node->column, "outputs",
                   "'%s' is output %d already; every output once", name, i + 1);
    return;
  }
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
  if (node->kind == CASE_NULL || node->kind == CASE_MAPPING)
    fault(r, node, "outputs", "expected a list of outputs, such as [peak, frequency]");
  for (int i = 0; node->kind == CASE_SEQUENCE && i < node->n; i++) {
    const case_node *one = &node->child[i];
    if (one->kind == CASE_SCALAR) add_output(r, one, one->text);
    if (one->kind != CASE_SCALAR) fault(r, one, "outputs", "expected the name of an output");
  }
  if (node->kind == CASE_SEQUENCE && node->n == 0) fault(r, node, "outputs", "the list is empty");
}

/* ---------------------------------------------------------------- a design as a case */

/* The value of a key with its ratio, if it has one. */
static double value_of(const study_keys *keys, const double *value, int key) {
  double out = value[key];
  for (int k = 0; k < keys->n; k++)
    if (keys->key[k].is_ratio && keys->key[k].nominal == key) out *= value[k];
  return keys->key[key].whole ? rint(out) : out;
}

int study_spec_words(const study_spec *s, const double *value, char **words) {
  int  n    = 0;
  bool good = true;
  for (int k = 0; k < s->keys.n; k++) {
    const study_key *key  = &s->keys.key[k];
    size_t           size = strlen(key->path) + 40;
    if (key->is_ratio) continue;
    words[n]     = strdup("--set");
    words[n + 1] = malloc(size);
    good         = good && words[n] && words[n + 1];
    if (words[n + 1])
      snprintf(words[n + 1], size, "%s=%.17g", key->path, value_of(&s->keys, value, k));
    n += 2;
  }
  return good ? n : -1;
}

shb_status study_spec_design(const study_spec *s, const double *value, const char *name,
                             const char *into, FILE *errors, case_file *file) {
  char       *words[2 * STUDY_MAX_KEYS] = {NULL}, named[CASE_NAME * 2];
  const char *text[STUDY_MAX_KEYS + 1];
  int         n = study_spec_words(s, value, words), sets = 0;
  shb_status  status = n >= 0 ? SHB_OK : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  for (; 2 * sets < n; sets++) text[sets] = words[2 * sets + 1];
  snprintf(named, sizeof named, "name=%s", name ? name : "");
  if (name) text[sets++] = named;
  const case_overrides overrides = {
      .n = sets, .text = text, .into = into, .document = s->base.text};
  *file = (case_file){.no_memory = status != SHB_OK};
  if (status == SHB_OK) status = case_read_with(s->case_path, &overrides, STAGES, errors, file);
  for (int i = 0; i < 2 * STUDY_MAX_KEYS; i++) free(words[i]);
  return status;
}

/* The digests of a design and of its modes. False: it is refused, and *messages holds what was
 * said, malloc'ed; NULL without memory. */
static bool digest_values(const study_spec *s, const double *value, char digest[DIGEST_TEXT],
                          char modes[DIGEST_TEXT], char **messages) {
  size_t    length;
  case_file file;
  FILE     *into = open_memstream(messages, &length);
  digest[0] = modes[0] = '\0';
  if (!into) return false;
  bool good = study_spec_design(s, value, NULL, NULL, into, &file) == SHB_OK;
  if (good) digest_design(&file, s->inputs, s->n_outputs, s->output, digest);
  if (good) digest_modes(&file, s->inputs, modes);
  if (good) case_free(&file);
  if (!good) fputs(shb_message(), into); /* empty where the faults were printed */
  fclose(into);
  if (good || !file.no_memory) return good;
  free(*messages);
  *messages = NULL;
  return false;
}

bool study_spec_digest(const study_spec *s, const double *value, char digest[DIGEST_TEXT],
                       char *why, size_t size) {
  char *messages = NULL, modes[DIGEST_TEXT];
  bool  good     = digest_values(s, value, digest, modes, &messages);
  why[0]         = '\0';
  if (!good && messages) refusal_line(messages, s->case_path, why, size);
  free(messages);
  return good;
}

/* ---------------------------------------------------------------- designs */

/* What belongs together: plan and vary, uncertain and samples. */
static void check_parts(reading *r, const case_node *root) {
  const study_spec *s    = r->spec;
  const case_node  *vary = case_node_find(root, "vary"), *plan = case_node_find(root, "plan"),
                  *uncertain = case_node_find(root, "uncertain"),
                  *samples = case_node_find(root, "samples"), *seed = case_node_find(root, "seed");
  if (s->plan.kind == STUDY_TABLE && vary)
    fault(r, vary, "vary", "the columns of the table are the varied keys; leave vary out");
  if (r->issues.n == 0 && s->plan.kind != STUDY_TABLE && !vary &&
      !case_node_find(root, "optimise") && (plan || !uncertain))
    fault(r, root, "vary", "missing; expected a mapping of keys of the case");
  const case_node *optimise = case_node_find(root, "optimise");
  if (optimise && plan)
    fault(r, optimise, "optimise", "makes its own designs; leave plan out, or optimise");
  if (optimise && uncertain)
    fault(r, optimise, "optimise", "has no uncertain keys; leave uncertain out, or optimise");
  if (optimise && !vary && !plan)
    fault(r, optimise, "optimise", "needs vary, the ranges of the keys");
  if (uncertain && !samples)
    fault(r, uncertain, "uncertain", "needs samples, their number, such as samples: 512");
  if (samples && !uncertain)
    fault(r, samples, "samples", "needs uncertain, a mapping of keys to distributions");
  if (seed && !uncertain)
    fault(r, seed, "seed",
          "is that of uncertain keys; that of a plan is plan: {sobol: 256, seed: 1}");
}

/* Read the keys and make the designs. Returns the node for messages about them. */
static const case_node *make_designs(reading *r, const case_node *root) {
  study_spec      *s    = r->spec;
  const case_node *vary = case_node_find(root, "vary"), *plan = case_node_find(root, "plan"),
                  *uncertain = case_node_find(root, "uncertain"),
                  *optimise = case_node_find(root, "optimise"), *at = vary ? vary : root;
  const study_outputs outputs = {&s->base, &s->n_outputs, s->output};
  if (plan) study_plan_read(&r->issues, plan, s->folder, &s->plan);
  if (r->texts) s->plan.columns = r->texts->columns;
  study_plan_read_samples(&r->issues, case_node_find(root, "samples"), case_node_find(root, "seed"),
                          &s->plan);
  check_parts(r, root);
  if (vary) study_keys_read(&r->issues, vary, &s->keys);
  if (optimise) study_optimise_read(&r->issues, optimise, &outputs, &s->optimise);
  if (r->issues.n == 0 && optimise)
    study_optimise_starts(&r->issues, at, &outputs, &s->keys, &s->optimise, &s->n_designs,
                          &s->design);
  if (r->issues.n == 0 && !optimise)
    study_plan_make(&r->issues, plan && !vary ? plan : at, &s->plan, &s->keys, &s->n_designs,
                    &s->design);
  if (r->issues.n == 0 && s->n_designs == 0 && !s->plan.columns)
    fault(r, root, "plan", "holds no design");
  if (uncertain) uncertain_keys_read(&r->issues, uncertain, &s->keys);
  if (r->issues.n == 0 && uncertain)
    study_plan_add_samples(&r->issues, uncertain, &s->plan, &s->keys, &s->n_designs, &s->design);
  if (vary) return vary;
  return plan ? plan : uncertain ? uncertain : root;
}

static int by_text(const void *a, const void *b) {
  return strcmp(a, b);
}

/* How many texts differ; they are sorted. */
static int count_different(int n, char (*text)[DIGEST_TEXT]) {
  int different = 0;
  qsort(text, (size_t)n, sizeof *text, by_text);
  for (int i = 0; i < n; i++) different += i == 0 || strcmp(text[i], text[i - 1]) != 0;
  return different;
}

/* Read every design as a case, and report those that are refused. */
static void check_designs(reading *r, const case_node *root, const case_node *at) {
  study_spec *s             = r->spec;
  refusals    refused       = {0};
  s->digest                 = calloc((size_t)s->n_designs + 1, sizeof *s->digest);
  char(*modes)[DIGEST_TEXT] = calloc((size_t)s->n_designs + 1, sizeof *modes);
  for (int d = 0; s->digest && modes && d < s->n_designs; d++) {
    const double *value    = s->design + (size_t)d * (size_t)s->keys.n;
    char         *messages = NULL;
    const bool    good     = digest_values(s, value, s->digest[d], modes[d], &messages);
    if (!good && messages)
      refusals_take(&refused, &s->keys, d, messages, s->case_path);
    else if (!good)
      case_issues_no_memory(&r->issues);
    free(messages);
  }
  if (!s->digest || !modes) case_issues_no_memory(&r->issues);
  if (modes && !s->base.modal_file) s->n_models = count_different(s->n_designs, modes);
  free(modes);
  refusals_report(&refused, &s->keys, s->design, root, at, &r->issues);
}

/* ---------------------------------------------------------------- the file */

static void read_name(reading *r, const case_node *node) {
  const char *from = r->spec->path, *slash = strrchr(from, '/');
  const char *leaf = slash ? slash + 1 : from, *dot = strrchr(leaf, '.');
  bool        good = !node || node->kind == CASE_SCALAR;
  if (!good) fault(r, node, "name", "expected the name of the study and its files");
  if (node && good) good = case_value_is_name(&r->issues, "name", node);
  if (!node && !shb_name_is_plain(leaf))
    case_issue_add(&r->issues, 1, 1, "name",
                   "missing; the name of this file, which it would be, holds control characters");
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
  if (!r->spec->case_path) {
    case_issues_no_memory(&r->issues);
    return false;
  }
  const case_overrides again = {.document = r->texts ? r->texts->base : NULL};
  const shb_status     status =
      case_read_with(r->spec->case_path, &again, STAGES, errors, &r->spec->base);
  if (status == SHB_OK) {
    if (r->spec->base.mhb.parameter != MHB_IN_FREQUENCY)
      fault(r, node, "case", "the case follows mhb.vary; a study needs a case over the frequency");
    if (r->texts) r->spec->inputs = strdup(r->texts->inputs);
    if (r->texts && !r->spec->inputs) case_issues_no_memory(&r->issues);
    if (r->texts || digest_inputs(&r->spec->base, &r->spec->inputs) == SHB_OK) return true;
    fault(r, node, "case", shb_message());
    return false;
  }
  if (r->spec->base.no_memory) case_issues_no_memory(&r->issues);
  case_issue_add(&r->issues, node->line, node->column, "case", "%s",
                 shb_message()[0] ? shb_message() : "the case has errors; see above");
  return false;
}

static void refuse_unknown(reading *r, const case_node *root) {
  const case_keys keys = study_key_table();
  for (int i = 0; i < root->n; i++) {
    const case_node *one = &root->child[i];
    if (!case_key_find(keys, one->key) && !case_key_is_block(keys, one->key))
      study_table_refuse(&r->issues, "", one->key, one);
  }
}

static void read_document(reading *r, bool check, FILE *errors) {
  case_node *root = case_document_parse(&r->issues);
  if (root || r->issues.n == 0) case_overrides_apply(&r->issues, &r->overrides, &root);
  if (!root || root->kind != CASE_MAPPING) {
    if (r->issues.n == 0)
      case_issue_add(&r->issues, 1, 1, NULL, "the file holds no mapping of keys");
    case_document_free(root);
    return;
  }
  refuse_unknown(r, root);
  read_name(r, case_node_find(root, "name"));
  if (!r->spec->name) case_issues_no_memory(&r->issues);
  if (read_case(r, root, errors)) {
    read_outputs(r, case_node_find(root, "outputs"), root);
    const case_node *place = make_designs(r, root);
    if (r->issues.n == 0 && check) check_designs(r, root, place);
  }
  case_document_free(root);
}

/* The overrides as lines, and below the text; the folder of the results. */
static shb_status keep_overrides(study_spec *s, const case_overrides *o) {
  size_t size = 0;
  FILE  *out  = open_memstream(&s->sets, &size);
  char  *text = case_overrides_text(o, s->text);
  for (int i = 0; out && i < o->n; i++) fprintf(out, "%s\n", o->text[i]);
  if (out) fclose(out);
  s->into = o->into && o->into[0] ? strdup(o->into) : NULL;
  SHB_CHECK(out && s->sets && text, SHB_ERR_IO, "%s: out of memory", s->path);
  free(s->text);
  s->text = text;
  if (!s->into) return SHB_OK;
  free(s->folder);
  s->folder = strdup(s->into);
  SHB_CHECK(s->folder, SHB_ERR_IO, "%s: out of memory", s->path);
  return SHB_OK;
}

static shb_status read_study(reading *r, const char *path, bool check, FILE *errors) {
  study_spec *s     = r->spec;
  const char *slash = strrchr(path, '/');
  s->path           = strdup(path);
  s->folder = slash ? strndup(path, slash == path ? 1 : (size_t)(slash - path)) : strdup(".");
  SHB_CHECK(s->path && s->folder && s->text, SHB_ERR_IO, "%s: out of memory", path);
  r->issues         = case_issues_start(path, s->text, strlen(s->text));
  r->overrides.keys = study_key_table();
  read_document(r, check, errors);
  s->plan.columns = NULL; /* of the reader */
  SHB_TRY(case_issues_finish(&r->issues, errors));
  return keep_overrides(s, &r->overrides);
}

shb_status study_spec_read_with(const char *path, const case_overrides *overrides, bool check,
                                FILE *errors, study_spec *s) {
  size_t  length = 0;
  reading r      = {.spec = s, .overrides = *overrides};
  *s             = (study_spec){0};
  SHB_TRY(case_text_read(path, &s->text, &length));
  return read_study(&r, path, check, errors);
}

shb_status study_spec_read(const char *path, bool check, FILE *errors, study_spec *s) {
  return study_spec_read_with(path, &(case_overrides){0}, check, errors, s);
}

enum { MOST_SETS = 64 };

shb_status study_spec_read_texts(const char *path, const study_texts *texts, FILE *errors,
                                 study_spec *s) {
  const char *set[MOST_SETS];
  char       *lines = strdup(texts->sets), *rest = lines;
  reading     r = {.spec = s, .texts = texts, .overrides = {.text = set, .into = texts->into}};
  *s            = (study_spec){.text = lines ? strdup(texts->study) : NULL};
  for (char *line; (line = strsep(&rest, "\n")) != NULL && r.overrides.n < MOST_SETS;)
    if (line[0]) set[r.overrides.n++] = line;
  const shb_status status = read_study(&r, path, false, errors);
  free(lines);
  return status;
}

shb_status study_spec_check_inputs(const study_spec *s, const case_file *inputs_of) {
  char *now;
  SHB_TRY(digest_inputs(inputs_of, &now));
  const bool same = strcmp(now, s->inputs) == 0;
  free(now);
  SHB_CHECK(same, SHB_ERR_INPUT,
            "a file that the case reads (mesh, modes, loads or deviations) has changed since the "
            "study began; run the study again");
  return SHB_OK;
}

void study_spec_free(study_spec *s) {
  free(s->path);
  free(s->text);
  free(s->sets);
  free(s->into);
  free(s->folder);
  free(s->name);
  free(s->case_path);
  free(s->plan.table);
  study_keys_free(&s->keys);
  free(s->design);
  free(s->digest);
  free(s->inputs);
  case_free(&s->base);
  *s = (study_spec){0};
}
