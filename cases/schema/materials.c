#include "cases/schema/materials.h"

#include <string.h>

/* Where a material is in the file: the block material, or an element of the list materials. */
typedef struct {
  case_reader     *reader;
  const case_node *element; /* NULL for the block */
  int              index;
} place;

static bool given(const place *p, const char *leaf) {
  char path[CASE_PATH];
  case_path(path, "material.%s", leaf);
  return p->element ? case_node_find(p->element, leaf) != NULL
                    : case_reader_given(p->reader, path) != NULL;
}

static void tell(const place *p, const char *text) {
  char path[CASE_PATH];
  if (!p->element) {
    case_reader_issue(p->reader, "material.G", "%s", text);
    return;
  }
  const case_node *G = case_node_find(p->element, "G"), *at = G ? G : p->element;
  case_path(path, "materials[%d].G", p->index);
  case_issue_add(p->reader->issues, at->line, at->column, path, "%s", text);
}

static void check_one(const place *p, const fem_orthotropic *constants, fem_material *material) {
  const double *E = constants->E, *nu = constants->nu;
  bool          axes  = E[0] != E[1] || E[0] != E[2] || nu[0] != nu[1] || nu[0] != nu[2];
  bool          shear = given(p, "G");
  if (!shear && axes) tell(p, "missing; E or nu differ along the axes, expected [G12, G13, G23]");
  if (!shear && (given(p, "axis_1") || given(p, "axis_2")))
    tell(p, "missing; without it the material is isotropic and has no axes");
  if (shear && fem_material_orthotropic(constants, material->rho, material) != SHB_OK)
    tell(p, shb_message());
}

static void check_material(case_reader *r) {
  static const char *const needed[] = {"material.E", "material.nu",     "material.rho",
                                       "material.G", "material.axis_1", "material.axis_2"};
  place                    p        = {.reader = r};
  for (int i = 0; i < 6; i++)
    if (!case_reader_good(r, needed[i]) && (given(&p, "G") || i != 3)) return;
  check_one(&p, &r->file->constants, &r->file->material);
}

/* Goodman's line needs both of its ends. */
static void check_fatigue(case_reader *r) {
  static const char *const end[2] = {"material.fatigue.endurance", "material.fatigue.ultimate"};
  for (int i = 0; i < 2; i++)
    if (case_reader_given(r, end[i]) && !case_reader_given(r, end[1 - i]))
      case_reader_issue(r, end[1 - i], "missing; material.fatigue is {endurance, ultimate}");
}

static void check_element_fatigue(case_reader *r, const case_node *element, int index) {
  static const char *const end[2]  = {"endurance", "ultimate"};
  const case_node         *fatigue = case_node_find(element, "fatigue");
  for (int i = 0; fatigue && i < 2; i++) {
    char path[CASE_PATH];
    if (!case_node_find(fatigue, end[i]) || case_node_find(fatigue, end[1 - i])) continue;
    case_path(path, "materials[%d].fatigue.%s", index, end[1 - i]);
    case_issue_add(r->issues, fatigue->line, fatigue->column, path,
                   "missing; fatigue is {endurance, ultimate}");
  }
}

static void check_groups(case_reader *r, const case_node *list) {
  const case_file *file = r->file;
  for (int i = 1; i < file->n_materials; i++)
    for (int j = 0; j < i; j++) {
      if (strcmp(file->materials[i].group, file->materials[j].group) != 0) continue;
      const case_node *at = case_node_find(&list->child[i], "group");
      char             path[CASE_PATH];
      case_path(path, "materials[%d].group", i);
      case_issue_add(r->issues, at->line, at->column, path, "'%s' has a material already",
                     file->materials[i].group);
    }
}

void case_check_materials(case_reader *r) {
  case_file       *file = r->file;
  const case_node *list = case_reader_given(r, "materials");
  if (file->modal_file) return;
  if (!list) {
    check_material(r);
    check_fatigue(r);
    return;
  }
  if (case_reader_given(r, "material.E"))
    case_reader_issue(r, "materials", "give either material or materials, not both");
  if (!file->mesh_file)
    case_reader_issue(
        r, "materials",
        "mesh.blade is one volume: give material, or a mesh.file with several volumes");
  if (!case_reader_good(r, "materials")) return;
  check_groups(r, list);
  for (int i = 0; i < file->n_materials; i++) {
    check_one(&(place){r, &list->child[i], i}, &file->materials[i].constants,
              &file->materials[i].material);
    check_element_fatigue(r, &list->child[i], i);
  }
}
