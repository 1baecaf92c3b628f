#include "cases/parse/groups.h"

#include <string.h>

#include "cases/parse/units.h"
#include "mesh/base/shortest.h"

static const char *const group_name[MESH_N_SETS] = {"root", "contact_right", "contact_left",
                                                    "load", "cyclic_right",  "cyclic_left"};
static const char        expected[] =
    "{plane: [x, y, z], normal: [x, y, z]}, {radius: r}, {nearest: [x, y, z]} or {name: WORD}";
static const double usual_tolerance = 1e-6; /* m */

/* State while one rule is read. */
typedef struct {
  case_issues *issues;
  char         path[CASE_PATH];
  mesh_rule   *rule;
  bool         plane, normal, tolerance;
} context;

static bool refuse(const context *c, const case_node *node, const char *wanted) {
  if (node->kind != CASE_BROKEN)
    case_issue_add(c->issues, node->line, node->column, c->path, "is %s; expected %s",
                   case_kind_name(node->kind), wanted);
  return false;
}

static bool read_number(const context *c, const case_node *node, const char *unit, double *value) {
  char why[CASE_WHY];
  if (node->kind != CASE_SCALAR) return refuse(c, node, "a number");
  if (case_quantity(node->text, unit, value, why)) return true;
  case_issue_add(c->issues, node->line, node->column, c->path, "%s", why);
  return false;
}

static bool read_vector(const context *c, const case_node *node, const char *unit,
                        double value[3]) {
  if (node->kind != CASE_SEQUENCE || node->n != 3) return refuse(c, node, "[x, y, z]");
  bool good = true;
  for (int d = 0; d < 3; d++) good = read_number(c, &node->child[d], unit, &value[d]) && good;
  return good;
}

static bool read_positive(const context *c, const case_node *node, double *value) {
  if (!read_number(c, node, "m", value)) return false;
  if (*value > 0) return true;
  case_issue_add(c->issues, node->line, node->column, c->path, "is %g m, must be above 0 m",
                 *value);
  return false;
}

/* Refuses a second rule for the same group. */
static bool take_kind(const context *c, const case_node *node, mesh_rule_kind kind) {
  bool first = c->rule->kind == MESH_RULE_NONE || c->rule->kind == kind;
  if (!first)
    case_issue_add(c->issues, node->key_line, node->key_column, c->path,
                   "is a second rule for its group; expected one of %s", expected);
  c->rule->kind = kind;
  return first;
}

static bool read_name(const context *c, const case_node *node) {
  if (node->kind != CASE_SCALAR) return refuse(c, node, "the name of a group in the mesh file");
  size_t n = strlen(node->text);
  if (n == 0 || n >= MESH_WORD) return refuse(c, node, "a name of 1 to 80 letters");
  memcpy(c->rule->name, node->text, n + 1);
  return true;
}

static bool read_part(context *c, const case_node *node) {
  mesh_rule *rule = c->rule;
  if (strcmp(node->key, "plane") == 0) {
    c->plane = true;
    return take_kind(c, node, MESH_RULE_PLANE) && read_vector(c, node, "m", rule->at);
  }
  if (strcmp(node->key, "normal") == 0) {
    c->normal = true;
    return take_kind(c, node, MESH_RULE_PLANE) && read_vector(c, node, "", rule->normal);
  }
  if (strcmp(node->key, "radius") == 0)
    return take_kind(c, node, MESH_RULE_RADIUS) && read_positive(c, node, &rule->radius);
  if (strcmp(node->key, "nearest") == 0)
    return take_kind(c, node, MESH_RULE_NEAREST) && read_vector(c, node, "m", rule->at);
  if (strcmp(node->key, "name") == 0)
    return take_kind(c, node, MESH_RULE_NAME) && read_name(c, node);
  if (strcmp(node->key, "tolerance") == 0) {
    c->tolerance = true;
    return read_positive(c, node, &rule->tolerance);
  }
  case_issue_add(c->issues, node->key_line, node->key_column, c->path,
                 "unknown key; known here: plane, normal, radius, nearest, name, tolerance");
  return false;
}

/* Checks that the parts of a rule fit together. */
static bool check_rule(const context *c, const case_node *node) {
  const mesh_rule *rule = c->rule;
  const char      *lack = NULL;
  if (rule->kind == MESH_RULE_NONE) lack = "says no faces";
  if (rule->kind == MESH_RULE_PLANE && !c->plane) lack = "lacks plane, a point in it";
  if (rule->kind == MESH_RULE_PLANE && !c->normal) lack = "lacks normal";
  if (rule->kind == MESH_RULE_PLANE && c->normal && rule->normal[0] == 0 && rule->normal[1] == 0 &&
      rule->normal[2] == 0)
    lack = "has a normal without direction";
  if (c->tolerance && (rule->kind == MESH_RULE_NEAREST || rule->kind == MESH_RULE_NAME))
    lack = "has a tolerance, which only a plane or a radius has";
  if (lack)
    case_issue_add(c->issues, node->line, node->column, c->path, "%s; expected %s", lack, expected);
  return !lack;
}

static bool read_rule(case_issues *issues, const char *path, const case_node *node,
                      mesh_rule *rule) {
  context c       = {.issues = issues, .rule = rule};
  bool    good    = true;
  *rule           = (mesh_rule){.kind = MESH_RULE_NONE};
  rule->tolerance = usual_tolerance;
  case_path(c.path, "%s", path);
  if (node->kind != CASE_MAPPING) return refuse(&c, node, expected);
  for (int i = 0; i < node->n; i++) {
    case_path(c.path, "%s.%s", path, node->child[i].key);
    good = read_part(&c, &node->child[i]) && good;
  }
  case_path(c.path, "%s", path);
  return good && check_rule(&c, node);
}

bool case_group_is_usual(const char *name) {
  for (int id = 0; id < MESH_N_SETS; id++)
    if (strcmp(name, group_name[id]) == 0) return true;
  return false;
}

/* Slot for the rule of a group; NULL if there are too many groups. */
static mesh_rule *slot_of(const char *name, mesh_rules *rules) {
  for (int id = 0; id < MESH_N_SETS; id++)
    if (strcmp(name, group_name[id]) == 0) return &rules->usual[id];
  if (rules->n_more == MESH_MAX_MORE || strlen(name) >= MESH_WORD) return NULL;
  strcpy(rules->more[rules->n_more].name, name);
  return &rules->more[rules->n_more++].rule;
}

bool case_groups_read(case_issues *issues, const char *path, const case_node *node,
                      mesh_rules *rules) {
  bool good = node->kind == CASE_MAPPING;
  if (!good && node->kind != CASE_BROKEN)
    case_issue_add(issues, node->line, node->column, path,
                   "is %s; expected {root: ..., contact_right: ..., contact_left: ..., load: ...}",
                   case_kind_name(node->kind));
  for (int i = 0; node->kind == CASE_MAPPING && i < node->n; i++) {
    const case_node *child = &node->child[i];
    char             full[CASE_PATH];
    mesh_rule       *slot = slot_of(child->key, rules);
    case_path(full, "%s.%s", path, child->key);
    if (!slot)
      case_issue_add(issues, child->key_line, child->key_column, full,
                     "one group too many (%d besides the usual six), or a name of more than %d "
                     "letters",
                     MESH_MAX_MORE, MESH_WORD - 1);
    good = slot && read_rule(issues, full, child, slot) && good;
  }
  return good;
}

static void print_numbers(FILE *out, const char *word, int n, const double *value) {
  fprintf(out, "%s ", word);
  shb_print_shortest(out, n, value);
}

static void print_rule(FILE *out, const char *path, const char *name, const mesh_rule *r) {
  if (r->kind == MESH_RULE_NONE) return;
  fprintf(out, "%s.%s = ", path, name);
  if (r->kind == MESH_RULE_NAME) fprintf(out, "name %s", r->name);
  if (r->kind == MESH_RULE_PLANE) {
    print_numbers(out, "plane", 3, r->at);
    print_numbers(out, " normal", 3, r->normal);
  }
  if (r->kind == MESH_RULE_RADIUS) print_numbers(out, "radius", 1, &r->radius);
  if (r->kind == MESH_RULE_NEAREST) print_numbers(out, "nearest", 3, r->at);
  if (r->kind == MESH_RULE_PLANE || r->kind == MESH_RULE_RADIUS)
    print_numbers(out, " tolerance", 1, &r->tolerance);
  fputc('\n', out);
}

void case_groups_print(FILE *out, const char *path, const mesh_rules *rules) {
  for (int id = 0; id < MESH_N_SETS; id++) print_rule(out, path, group_name[id], &rules->usual[id]);
  for (int i = 0; i < rules->n_more; i++)
    print_rule(out, path, rules->more[i].name, &rules->more[i].rule);
  for (int i = 0; i < rules->n_volumes; i++)
    print_rule(out, path, rules->volume[i].name, &rules->volume[i].rule);
}
