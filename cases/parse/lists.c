#include "cases/parse/lists.h"

#include <complex.h>
#include <ctype.h>
#include <string.h>

#include "cases/parse/units.h"

static bool preload_room(const case_value_context *c, const case_node *node, int n) {
  if (n >= 1 && n <= MHB_MAX_PRELOADS) return true;
  case_issue_add(c->issues, node->line, node->column, c->path, "%d %s; there may be 1 to %d", n,
                 strcmp(c->path, "rotor.speed") == 0 ? "speeds" : "preloads", MHB_MAX_PRELOADS);
  return false;
}

/* Reads {from, to, points}; both ends are included. */
static bool read_preload_range(const case_value_context *c, const case_node *node, int *n,
                               double *n0) {
  static const case_key names[] = {
      {.path = "from", .unit = ""}, {.path = "to", .unit = ""}, {.path = "points", .unit = ""}};
  double end[2] = {0, 0};
  int    points = 0;
  bool   good   = true;
  for (int i = 0; i < node->n; i++) {
    if (case_key_find((case_keys){3, names}, node->child[i].key)) continue;
    char hint[256], path[CASE_PATH];
    case_path(path, "%s.%s", c->path, node->child[i].key);
    case_key_suggest((case_keys){3, names}, "", node->child[i].key, hint, sizeof hint);
    case_issue_add(c->issues, node->child[i].key_line, node->child[i].key_column, path,
                   "unknown key%s", hint);
    good = false;
  }
  for (int i = 0; i < 3; i++) {
    const case_node *child = case_node_find(node, names[i].path);
    char             path[CASE_PATH], why[CASE_WHY];
    case_path(path, "%s.%s", c->path, names[i].path);
    if (!child) {
      case_issue_add(c->issues, node->line, node->column, path,
                     "missing; expected {from, to, points}");
      good = false;
    } else if (i < 2) {
      good = case_value_number(c, path, child, &end[i]) && good;
    } else if (child->kind != CASE_SCALAR) {
      good = case_value_refuse_kind(c, path, child, "a whole number");
    } else if (!case_integer(child->text, &points, why)) {
      case_issue_add(c->issues, child->line, child->column, path, "%s", why);
      good = false;
    } else if (points < 2 || points > MHB_MAX_PRELOADS) {
      case_issue_add(c->issues, child->line, child->column, path, "is %d, must be 2 to %d", points,
                     MHB_MAX_PRELOADS);
      good = false;
    }
  }
  if (!good) return false;
  *n = points;
  for (int i = 0; i < points; i++) {
    double share = (double)i / (points - 1);
    n0[i]        = (1 - share) * end[0] + share * end[1];
  }
  return true;
}

/* Refuses a preload that is listed twice. The lists of several interfaces may repeat a value, since
 * only their combination counts. */
static bool all_differ(const case_value_context *c, const case_node *node, const double *n0) {
  for (int i = 1; strcmp(c->path, "contact.n0") == 0 && i < node->n; i++)
    for (int j = 0; j < i; j++) {
      char path[CASE_PATH];
      if (n0[i] != n0[j]) continue;
      case_path(path, "%s[%d]", c->path, i);
      case_issue_add(c->issues, node->child[i].line, node->child[i].column, path,
                     "is %g N, which [%d] is already; every preload once", n0[i], j);
      return false;
    }
  return true;
}

bool case_list_preloads(const case_value_context *c, const case_node *node, void *slot) {
  double *n0 = slot;
  int    *n  = (int *)((char *)slot - c->key->at + c->key->count_at);
  *n         = 1;
  if (node->kind == CASE_SCALAR) return case_value_number(c, c->path, node, n0);
  if (node->kind == CASE_MAPPING) return read_preload_range(c, node, n, n0);
  if (node->kind != CASE_SEQUENCE) return case_value_refuse(c, node);
  if (!preload_room(c, node, node->n)) return false;
  *n = node->n;
  return case_value_numbers(c, c->path, node, node->n, n0) && all_differ(c, node, n0);
}

static bool list_room(const case_value_context *c, const case_node *node, int most) {
  if (node->kind != CASE_SEQUENCE) return case_value_refuse(c, node);
  if (node->n >= 1 && node->n <= most) return true;
  case_issue_add(c->issues, node->line, node->column, c->path, "has %d numbers, expected 1 to %d",
                 node->n, most);
  return false;
}

/* Reads whole numbers that increase. */
static bool read_ascending(const case_value_context *c, const case_node *node, int *value) {
  bool good = true;
  for (int i = 0; i < node->n && good; i++) {
    const case_node *child = &node->child[i];
    char             path[CASE_PATH];
    case_path(path, "%s[%d]", c->path, i);
    case_value_context one = *c;
    one.path               = path;
    if (child->kind != CASE_SCALAR) return case_value_refuse_kind(c, path, child, "a whole number");
    good = case_value_integer(&one, child, &value[i]);
    if (!good || i == 0 || value[i] > value[i - 1]) continue;
    case_issue_add(c->issues, child->line, child->column, path,
                   "is %d after %d; they must increase", value[i], value[i - 1]);
    good = false;
  }
  return good;
}

bool case_list_numbers(const case_value_context *c, const case_node *node, void *slot) {
  const case_key *key  = c->key;
  char           *base = (char *)slot - key->at;
  if (!list_room(c, node, key->room)) return false;
  *(int *)(base + key->count_at) = node->n;
  if (key->type == CASE_INTEGERS || key->type == CASE_WORD_OR_INTEGERS)
    return read_ascending(c, node, slot);
  return case_value_numbers(c, c->path, node, node->n, slot);
}

/* Reads the number of points over the range of the sweep, or the list of frequencies. */
bool case_list_frequencies(const case_value_context *c, const case_node *node, void *slot) {
  (void)slot;
  mhb_integration_settings *asked = &c->file->integrate;
  char                      why[CASE_WHY];
  int                       n = node->kind == CASE_SEQUENCE ? node->n : 0;
  asked->listed               = node->kind == CASE_SEQUENCE;
  if (!asked->listed && node->kind != CASE_SCALAR) return case_value_refuse(c, node);
  if (!asked->listed && !case_integer(node->text, &n, why)) {
    case_issue_add(c->issues, node->line, node->column, c->path,
                   "%s; expected a number of points, or [from, ..] in Hz", why);
    return false;
  }
  if (n < 1 || n > MHB_MAX_FREQUENCIES) {
    case_issue_add(c->issues, node->line, node->column, c->path,
                   "%d frequencies; there may be 1 to %d", n, MHB_MAX_FREQUENCIES);
    return false;
  }
  asked->n_frequencies = n;
  if (!asked->listed) return true;
  if (!case_value_numbers(c, c->path, node, n, asked->frequency)) return false;
  for (int i = 1; i < n; i++) {
    if (asked->frequency[i] > asked->frequency[i - 1]) continue;
    case_issue_add(c->issues, node->child[i].line, node->child[i].column, c->path,
                   "%g Hz comes after %g Hz; frequencies must ascend", asked->frequency[i],
                   asked->frequency[i - 1]);
    return false;
  }
  return true;
}

/* Of a load, as mhb.scale. */
static const double LARGEST_FACTOR = 1e12;

bool case_list_factors(const case_value_context *c, const case_node *node, void *slot) {
  fem_load *load = slot;
  if (node->kind != CASE_MAPPING) return case_value_refuse(c, node);
  bool good = true, given[FEM_MAX_LOAD_HARMONICS + 1] = {false};
  load->n_harmonics = 0;
  memset(load->factor, 0, sizeof load->factor); /* the default */
  for (int i = 0; i < node->n; i++) {
    const case_node *child = &node->child[i];
    char             path[CASE_PATH], why[CASE_WHY];
    int              k = -1;
    double           polar[2];
    case_path(path, "%s.%s", c->path, child->key);
    bool known = case_integer(child->key, &k, why) && k >= 0 && k <= FEM_MAX_LOAD_HARMONICS;
    if (!known || given[k]) {
      case_issue_add(c->issues, child->key_line, child->key_column, c->path,
                     known ? "harmonic '%.40s' is given twice"
                           : "'%.40s' is not a harmonic; expected a whole number, 0 to 64",
                     child->key);
      good = false;
      continue;
    }
    given[k] = true;
    if (k > load->n_harmonics) load->n_harmonics = k;
    good            = case_value_polar(c->issues, path, child, "", LARGEST_FACTOR, polar) && good;
    load->factor[k] = polar[0] * cexp(I * polar[1]);
  }
  bool any = false;
  for (int k = 0; k <= load->n_harmonics; k++) any = any || load->factor[k] != 0;
  if (any || !good) return good;
  case_issue_add(c->issues, node->line, node->column, c->path,
                 "every factor is 0; nothing would move");
  return false;
}

static bool probe_name(const char *name) {
  for (const char *at = name; *at; at++)
    if (!isalnum((unsigned char)*at) && !strchr("_-.+", *at)) return false;
  return name[0] && strlen(name) < CASE_NAME;
}

/* The name of entry i of probes or gauges. */
static bool take_name(const case_value_context *c, const case_node *child, const char *kind,
                      char *name) {
  if (probe_name(child->key)) {
    strcpy(name, child->key);
    return true;
  }
  case_issue_add(c->issues, child->key_line, child->key_column, c->path,
                 "'%.60s' cannot be a %s's name: 1 to %d letters, digits, _ - . +", child->key,
                 kind, CASE_NAME - 1);
  return false;
}

static bool mapping_room(const case_value_context *c, const case_node *node, const char *kind) {
  if (node->kind != CASE_MAPPING) return case_value_refuse(c, node);
  if (node->n <= CASE_MAX_PROBES) return true;
  case_issue_add(c->issues, node->line, node->column, c->path, "%d %ss; at most %d", node->n, kind,
                 CASE_MAX_PROBES);
  return false;
}

bool case_list_probes(const case_value_context *c, const case_node *node, void *slot) {
  (void)slot;
  if (!mapping_room(c, node, "probe")) return false;
  bool good = true;
  for (int i = 0; i < node->n; i++) {
    const case_node *child = &node->child[i];
    char             path[CASE_PATH];
    case_path(path, "%s.%s", c->path, child->key);
    case_probe *probe = &c->file->probe[i];
    good              = take_name(c, child, "probe", probe->name) &&
           case_value_numbers(c, path, child, 3, probe->at) && good;
  }
  c->file->n_probes = node->n;
  return good;
}

static bool gauge_vector(const case_value_context *c, const case_node *gauge, const char *leaf,
                         double vector[3]) {
  const case_node *node = case_node_find(gauge, leaf);
  char             path[CASE_PATH];
  case_path(path, "%s.%s", c->path, leaf);
  if (node) return case_value_numbers(c, path, node, 3, vector);
  case_issue_add(c->issues, gauge->line, gauge->column, path,
                 "missing; expected {at: [x, y, z], direction: [x, y, z]}");
  return false;
}

static bool read_gauge(const case_value_context *c, const case_node *node, case_gauge *gauge) {
  if (node->kind != CASE_MAPPING)
    return case_value_refuse_kind(c, c->path, node, "{at, direction}");
  for (int i = 0; i < node->n; i++) {
    const case_node *child = &node->child[i];
    char             path[CASE_PATH];
    if (strcmp(child->key, "at") == 0 || strcmp(child->key, "direction") == 0) continue;
    case_path(path, "%s.%s", c->path, child->key);
    case_issue_add(c->issues, child->key_line, child->key_column, path,
                   "unknown key; a gauge has at and direction");
    return false;
  }
  case_key           plain = *c->key; /* a direction has no unit */
  case_value_context along = *c;
  plain.unit               = "";
  along.key                = &plain;
  if (!gauge_vector(c, node, "at", gauge->at)) return false;
  if (!gauge_vector(&along, node, "direction", gauge->direction)) return false;
  const double *d = gauge->direction;
  if (d[0] != 0 || d[1] != 0 || d[2] != 0) return true;
  case_issue_add(c->issues, node->line, node->column, c->path, "direction is [0, 0, 0]");
  return false;
}

bool case_list_gauges(const case_value_context *c, const case_node *node, void *slot) {
  (void)slot;
  if (!mapping_room(c, node, "gauge")) return false;
  bool good = true;
  for (int i = 0; i < node->n; i++) {
    const case_node   *child = &node->child[i];
    case_value_context one   = *c;
    char               path[CASE_PATH];
    case_path(path, "%s.%s", c->path, child->key);
    one.path = path;
    good     = take_name(c, child, "gauge", c->file->gauge[i].name) &&
           read_gauge(&one, child, &c->file->gauge[i]) && good;
  }
  c->file->n_gauges = node->n;
  return good;
}

static bool mistuning_list(const case_value_context *c, const case_node *node, case_mistuning *m) {
  if (node->n < 1 || node->n > CASE_MAX_BLADES) {
    case_issue_add(c->issues, node->line, node->column, c->path,
                   "has %d deviations; expected one a blade, at most %d", node->n, CASE_MAX_BLADES);
    return false;
  }
  m->kind = CASE_MISTUNED_LIST;
  m->n    = node->n;
  return case_value_numbers(c, c->path, node, node->n, m->each);
}

enum { MOST_SAMPLES = 100000 };

/* {deviation: , seed: , samples: } */
bool case_list_mistuning(const case_value_context *c, const case_node *node, void *slot) {
  static const char expected[] = "missing; expected {deviation: 1 %, seed: 7}";
  case_mistuning   *m          = slot;
  if (node->kind == CASE_SEQUENCE) return mistuning_list(c, node, m);
  if (node->kind != CASE_MAPPING) return case_value_refuse(c, node);
  const case_node *deviation = case_node_find(node, "deviation"),
                  *seed = case_node_find(node, "seed"), *samples = case_node_find(node, "samples");
  char path[CASE_PATH], why[CASE_WHY];
  for (int i = 0; i < node->n; i++) {
    const case_node *child = &node->child[i];
    if (child == deviation || child == seed || child == samples) continue;
    case_path(path, "%s.%s", c->path, child->key);
    case_issue_add(c->issues, child->key_line, child->key_column, path,
                   "unknown key; give a list, {file: NAME} or {deviation: 1 %%, seed: 7}");
    return false;
  }
  if (!deviation || !seed) {
    case_path(path, "%s.%s", c->path, deviation ? "seed" : "deviation");
    case_issue_add(c->issues, node->line, node->column, path, "%s", expected);
    return false;
  }
  case_key           range = *c->key;
  case_value_context own   = *c;
  range.least              = 0;
  range.most               = 0.1;
  range.above              = false;
  own.key                  = &range;
  case_path(path, "%s.deviation", c->path);
  if (!case_value_number(&own, path, deviation, &m->deviation)) return false;
  case_path(path, "%s.seed", c->path);
  if (seed->kind != CASE_SCALAR) return case_value_refuse_kind(c, path, seed, "a whole number");
  if (!case_integer(seed->text, &m->seed, why)) {
    case_issue_add(c->issues, seed->line, seed->column, path, "%s", why);
    return false;
  }
  m->kind = CASE_MISTUNED_RANDOM;
  if (!samples) return true;
  case_path(path, "%s.samples", c->path);
  if (samples->kind != CASE_SCALAR)
    return case_value_refuse_kind(c, path, samples, "a whole number");
  if (case_integer(samples->text, &m->samples, why) && m->samples >= 2 &&
      m->samples <= MOST_SAMPLES)
    return true;
  case_issue_add(c->issues, samples->line, samples->column, path,
                 "'%.20s' is not a number of samples; expected a whole number, 2 to %d",
                 samples->text, MOST_SAMPLES);
  return false;
  return true;
}
