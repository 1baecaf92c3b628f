#include "cases/parse/damping.h"

#include <math.h>
#include <string.h>

#include "cases/parse/units.h"
#include "mesh/base/shortest.h"

static const char expected[] =
    "a ratio, a list of ratios, {loss_factor: eta} or {rayleigh: [alpha, beta]}";

/* A number of 0 or more, and below limit. */
static bool read_number(case_issues *issues, const char *path, const case_node *node,
                        const char *unit, double limit, double *value) {
  char why[CASE_WHY];
  if (node->kind == CASE_BROKEN) return false;
  if (node->kind != CASE_SCALAR) {
    case_issue_add(issues, node->line, node->column, path, "is %s; expected a number",
                   case_kind_name(node->kind));
    return false;
  }
  if (!case_quantity(node->text, unit, value, why)) {
    case_issue_add(issues, node->line, node->column, path, "%s", why);
    return false;
  }
  if (*value >= 0 && *value < limit) return true;
  char range[64] = "0 or more";
  if (isfinite(limit)) snprintf(range, sizeof range, "0 or more and below %g", limit);
  case_issue_add(issues, node->line, node->column, path, "is %g, must be %s", *value, range);
  return false;
}

static bool read_each(case_issues *issues, const char *path, const case_node *node,
                      modal_damping *damping) {
  bool good     = node->n > 0 && node->n <= MODAL_DAMPING_RATIOS;
  damping->kind = MODAL_DAMPING_EACH;
  damping->n    = good ? node->n : 0;
  if (!good)
    case_issue_add(issues, node->line, node->column, path, "has %d ratios, must have 1 to %d",
                   node->n, MODAL_DAMPING_RATIOS);
  for (int i = 0; i < damping->n; i++) {
    char inner[CASE_PATH];
    case_path(inner, "%s[%d]", path, i);
    good = read_number(issues, inner, &node->child[i], "", 1, &damping->each[i]) && good;
  }
  return good;
}

static bool read_rayleigh(case_issues *issues, const char *path, const case_node *node,
                          modal_damping *damping) {
  damping->kind = MODAL_DAMPING_RAYLEIGH;
  if (node->kind != CASE_SEQUENCE || node->n != 2) {
    if (node->kind != CASE_BROKEN)
      case_issue_add(issues, node->line, node->column, path, "expected [alpha, beta] in 1/s and s");
    return false;
  }
  bool good = read_number(issues, path, &node->child[0], "", INFINITY, &damping->alpha);
  return read_number(issues, path, &node->child[1], "s", INFINITY, &damping->beta) && good;
}

static bool read_law(case_issues *issues, const char *path, const case_node *node,
                     modal_damping *damping) {
  const case_node *child = node->n == 1 ? &node->child[0] : NULL;
  char             inner[CASE_PATH];
  if (child) case_path(inner, "%s.%s", path, child->key);
  if (child && strcmp(child->key, "loss_factor") == 0) {
    damping->kind = MODAL_DAMPING_LOSS;
    return read_number(issues, inner, child, "", 2, &damping->loss);
  }
  if (child && strcmp(child->key, "rayleigh") == 0)
    return read_rayleigh(issues, inner, child, damping);
  case_issue_add(issues, node->line, node->column, path, "expected %s", expected);
  return false;
}

bool case_damping_read(case_issues *issues, const char *path, const case_node *node,
                       modal_damping *damping) {
  *damping = (modal_damping){.kind = MODAL_DAMPING_ALL};
  switch (node->kind) {
    case CASE_SEQUENCE:
      return read_each(issues, path, node, damping);
    case CASE_MAPPING:
      return read_law(issues, path, node, damping);
    case CASE_SCALAR:
      return read_number(issues, path, node, "", 1, &damping->ratio);
    case CASE_BROKEN:
      return false;
    default:
      case_issue_add(issues, node->line, node->column, path, "is %s; expected %s",
                     case_kind_name(node->kind), expected);
      return false;
  }
}

void case_damping_print(FILE *out, const modal_damping *damping) {
  const double rayleigh[2] = {damping->alpha, damping->beta};
  switch (damping->kind) {
    case MODAL_DAMPING_LOSS:
      fputs("loss_factor ", out);
      shb_print_shortest(out, 1, &damping->loss);
      break;
    case MODAL_DAMPING_RAYLEIGH:
      fputs("rayleigh ", out);
      shb_print_shortest(out, 2, rayleigh);
      break;
    case MODAL_DAMPING_EACH:
      shb_print_shortest(out, damping->n, damping->each);
      break;
    default:
      shb_print_shortest(out, 1, &damping->ratio);
  }
}
