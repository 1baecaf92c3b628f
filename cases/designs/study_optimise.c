#include "cases/designs/study_optimise.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases/designs/study_table.h"
#include "cases/parse/units.h"
#include "cases/plan/sampling.h"
#include "mhb/tracking/peak_system.h"

enum { MOST_OUTPUTS = 64 };

typedef struct {
  case_issues         *issues;
  const study_outputs *outputs;
  study_optimise      *o;
} reading;

const char *study_algorithm_name(study_algorithm algorithm) {
  static const char *const name[STUDY_N_ALGORITHMS] = {"sbplx", "crs", "isres", "direct", "slope"};
  return name[algorithm];
}

static void fault(reading *r, const case_node *node, const char *text) {
  case_issue_add(r->issues, node->line, node->column, "optimise", "%s", text);
}

/* Index of an output by its name, appended if it is new; -1 after a fault. */
static int output_of(reading *r, const case_node *node, const char *name) {
  const study_outputs *s = r->outputs;
  char                 why[512];
  for (int i = 0; i < *s->n; i++)
    if (strcmp(s->output[i].name, name) == 0) return i;
  if (*s->n == MOST_OUTPUTS) {
    fault(r, node, "more than 64 outputs");
  } else if (!study_output_parse(name, s->base, &s->output[*s->n], why, sizeof why)) {
    fault(r, node, why);
  } else {
    return (*s->n)++;
  }
  return -1;
}

/* Bare limits that are none in SI: no metal fails at 1 MPa, and no meshed blade swings by 5 cm. */
static const double LEAST_BARE_STRESS = 1e6, MOST_BARE_LENGTH = 0.05;

/* A bare number that cannot be meant in SI is asked back. */
static bool refuse_bare(reading *r, const case_node *one, const char *unit, double value) {
  const bool bare   = one->text[strspn(one->text, "+-.0123456789eE")] == '\0';
  const bool stress = strcmp(unit, "Pa") == 0 && fabs(value) < LEAST_BARE_STRESS;
  const bool length =
      strcmp(unit, "m") == 0 && !r->outputs->base->modal_file && fabs(value) > MOST_BARE_LENGTH;
  if (!bare || !(stress || length)) return false;
  case_issue_add(r->issues, one->line, one->column, "optimise", "%s: %s %s: did you mean %s %s?",
                 one->key, one->text, unit, one->text, stress ? "MPa" : "mm");
  return true;
}

/* A size is never below 0: every design keeps such a limit, or none does. */
static bool refuse_idle(reading *r, const case_node *one, const char *unit, double value) {
  if (strcmp(unit, "-") == 0 || value >= 0) return false;
  case_issue_add(r->issues, one->line, one->column, "optimise", "%s: %s: no design is below 0",
                 one->key, one->text);
  return true;
}

static void read_limits(reading *r, const case_node *node, bool least) {
  if (node->kind != CASE_MAPPING || node->n == 0)
    fault(r, node, "at_most, at_least: expected a mapping such as {frequency: 150 Hz}");
  for (int i = 0; node->kind == CASE_MAPPING && i < node->n; i++) {
    const case_node *one = &node->child[i];
    char             why[CASE_WHY];
    study_limit      limit = {output_of(r, one, one->key), least, 0};
    if (limit.output < 0 || one->kind == CASE_BROKEN) continue; /* told */
    const char *unit = r->outputs->output[limit.output].unit;
    if (one->kind != CASE_SCALAR) {
      fault(r, one, "a limit is a number with its unit");
    } else if (!case_quantity(one->text, strcmp(unit, "-") == 0 ? "" : unit, &limit.value, why)) {
      case_issue_add(r->issues, one->line, one->column, "optimise", "%s: %s", one->key, why);
    } else if (refuse_bare(r, one, unit, limit.value) || refuse_idle(r, one, unit, limit.value)) {
      continue;
    } else if (r->o->n_limits == STUDY_MAX_LIMITS) {
      fault(r, one, "more than 16 limits");
    } else {
      r->o->limit[r->o->n_limits++] = limit;
    }
  }
}

static void read_member(reading *r, const case_node *one) {
  static const char *const number[] = {"evaluations", "starts", "seed", "algorithm"};
  void *const slot[] = {&r->o->evaluations, &r->o->starts, &r->o->seed, &r->o->algorithm};
  char        path[CASE_PATH];
  case_path(path, "optimise.%s", one->key);
  for (int i = 0; i < 4; i++) {
    if (strcmp(one->key, number[i]) != 0) continue;
    study_table_read(r->issues, path, path, one, slot[i]);
    return;
  }
  if (strcmp(one->key, "minimise") == 0) {
    if (one->kind == CASE_SCALAR) r->o->objective = output_of(r, one, one->text);
    if (one->kind != CASE_SCALAR) fault(r, one, "minimise: expected the name of an output");
  } else if (strcmp(one->key, "at_most") == 0 || strcmp(one->key, "at_least") == 0) {
    read_limits(r, one, strcmp(one->key, "at_least") == 0);
  } else {
    study_table_refuse(r->issues, "optimise", "optimise", one);
  }
}

void study_optimise_read(case_issues *issues, const case_node *node, const study_outputs *outputs,
                         study_optimise *o) {
  reading r = {issues, outputs, o};
  *o        = (study_optimise){.wanted = true, .objective = -1};
  study_table_default("optimise.evaluations", &o->evaluations);
  study_table_default("optimise.starts", &o->starts);
  study_table_default("optimise.seed", &o->seed);
  o->free_algorithm = node->kind == CASE_MAPPING && !case_node_find(node, "algorithm");
  if (node->kind != CASE_MAPPING) {
    fault(&r, node, "expected a mapping such as {minimise: peak, evaluations: 200}");
    return;
  }
  for (int i = 0; i < node->n; i++) read_member(&r, &node->child[i]);
  if (o->algorithm == STUDY_DIRECT && case_node_find(node, "starts") && o->starts > 1)
    fault(&r, case_node_find(node, "starts"), "starts: direct divides the whole ranges, once");
  if (o->algorithm == STUDY_DIRECT) o->starts = 1;
  if (!case_node_find(node, "minimise"))
    fault(&r, node, "minimise is missing: the output to be minimised");
  if (o->evaluations < STUDY_LEAST_A_START * o->starts)
    case_issue_add(issues, node->line, node->column, "optimise",
                   "%d evaluations are too few for %d starts; each takes %d or more",
                   o->evaluations, o->starts, STUDY_LEAST_A_START);
}

static bool check_keys(case_issues *issues, const case_node *at, const study_keys *keys) {
  int before = issues->n;
  for (int k = 0; k < keys->n; k++) {
    const study_key *key = &keys->key[k];
    if (!key->is_range)
      case_issue_add(issues, at->line, at->column, key->path,
                     "optimise needs a range {from, to}, not a list");
    else if (key->whole)
      case_issue_add(issues, at->line, at->column, key->path,
                     "takes whole numbers; optimise varies any number of a range");
  }
  return issues->n == before;
}

int study_key_derivative(const case_file *base, const study_key *key) {
  static const char *const paths[] = {"contact.n0", "contact.mu", "contact.ku",
                                      "contact.kv", "mhb.scale",  "modal.damping"};
  for (size_t p = 0; p < sizeof paths / sizeof *paths; p++) {
    if (strcmp(key->path, paths[p]) != 0) continue;
    for (int i = 0; i < MHB_PEAK_PARAMETERS; i++) {
      char   name[STUDY_UNIT_TEXT], unit[STUDY_UNIT_TEXT];
      double value;
      study_derivative(base, i, name, unit, &value);
      if (strcmp(name, strchr(paths[p], '.') + 1) == 0) return i;
    }
  }
  return -1;
}

/* Why the slope of the objective is not known; NULL: it is. */
static const char *why_no_slope(const study_outputs *outputs, const study_keys *keys,
                                const study_optimise *o) {
  if (keys->n != 1) return "slope varies one key";
  if (outputs->output[o->objective].quantity != STUDY_PEAK) return "slope minimises peak";
  if (o->n_limits > 0) return "slope has no limits; sbplx has";
  if (study_key_derivative(outputs->base, &keys->key[0]) < 0)
    return "slope varies contact.n0, mu, ku, kv, mhb.scale or a damping that is one number";
  return NULL;
}

void study_optimise_starts(case_issues *issues, const case_node *at, const study_outputs *outputs,
                           const study_keys *keys, study_optimise *o, int *n, double **design) {
  int d = keys->n, rows = o->starts + 2;
  *design = NULL;
  *n      = 0;
  if (!check_keys(issues, at, keys)) return;
  const char *none = why_no_slope(outputs, keys, o);
  if (!none && o->free_algorithm) o->algorithm = STUDY_SLOPE;
  if (none && o->algorithm == STUDY_SLOPE) {
    case_issue_add(issues, at->line, at->column, "optimise", "algorithm: %s", none);
    return;
  }
  double *u = calloc((size_t)rows * (size_t)d + 1, sizeof *u);
  if (!u || plan_latin_hypercube(o->starts, d, (unsigned long)o->seed, u + 2 * d) != SHB_OK) {
    case_issues_no_memory(issues);
    free(u);
    return;
  }
  for (int k = 0; k < d; k++) {
    u[2 * d + k] = 0.5;
    for (int i = 0; i < rows; i++)
      u[i * d + k] = i == 0   ? keys->key[k].from
                     : i == 1 ? keys->key[k].to
                              : study_key_at(&keys->key[k], u[i * d + k]);
  }
  *design = u;
  *n      = rows;
}
