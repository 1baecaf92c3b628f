#include "cases/schema/materials.h"

#include <string.h>

static void check_constants(const case_place *p, case_material *m) {
  const double *E = m->constants.E, *nu = m->constants.nu;
  const bool    axes  = E[0] != E[1] || E[0] != E[2] || nu[0] != nu[1] || nu[0] != nu[2];
  const bool    shear = case_place_given(p, "G") != NULL;
  if (!shear && axes)
    case_place_issue(p, "G", "missing; E or nu differ along the axes, expected [G12, G13, G23]");
  if (!shear && (case_place_given(p, "axis_1") || case_place_given(p, "axis_2")))
    case_place_issue(p, "G", "missing; without it the material is isotropic and has no axes");
  if (shear && fem_material_orthotropic(&m->constants, m->material.rho, &m->material) != SHB_OK)
    case_place_issue(p, "G", "%s", shb_message());
}

static bool is_good(const case_place *p) {
  static const char *const needed[] = {"E", "nu", "rho", "axis_1", "axis_2", "G"};
  const int                n        = case_place_given(p, "G") ? 6 : 5;
  for (int i = 0; i < n; i++)
    if (!case_place_good(p, needed[i])) return false;
  return true;
}

/* Goodman's line needs both of its ends. */
static void check_fatigue(const case_place *p) {
  static const char *const end[2] = {"fatigue.endurance", "fatigue.ultimate"};
  for (int i = 0; i < 2; i++)
    if (case_place_given(p, end[i]) && !case_place_given(p, end[1 - i]))
      case_place_issue(p, end[1 - i], "missing; fatigue is {endurance, ultimate}");
}

static void check_group(const case_place *p, int index) {
  const case_material *all = p->reader->file->materials;
  for (int i = 0; i < index; i++)
    if (strcmp(all[i].group, all[index].group) == 0)
      case_place_issue(p, "group", "'%s' has a material already", all[index].group);
}

void case_check_materials(case_reader *r) {
  case_file *file = r->file;
  if (file->modal_file) return;
  if (file->has_materials && case_reader_given(r, "material.E"))
    case_reader_issue(r, "materials", "give either material or materials, not both");
  if (file->has_materials && !file->mesh_file)
    case_reader_issue(
        r, "materials",
        "mesh.blade is one volume: give material, or a mesh.file with several volumes");
  if (file->has_materials && !case_reader_good(r, "materials")) return;
  for (int i = 0; i < file->n_materials; i++) {
    const case_place p = case_reader_place(r, "materials", "material", i);
    check_group(&p, i);
    if (is_good(&p)) check_constants(&p, &file->materials[i]);
    check_fatigue(&p);
  }
}
