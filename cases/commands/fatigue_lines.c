#include "cases/commands/fatigue_lines.h"

#include <stdlib.h>

bool case_has_fatigue(const case_file *file) {
  for (int i = 0; i < file->n_materials; i++)
    if (file->materials[i].endurance > 0) return true;
  return false;
}

shb_status case_fatigue_read(const case_file *file, const char *modal, int n_nodes,
                             case_fatigue *s) {
  const char *name[MESH_MAX_VOLUMES];
  double      stiffness[MESH_MAX_VOLUMES];
  s->region  = NULL;
  s->fatigue = (post_fatigue){.endurance = file->materials[0].endurance,
                              .ultimate  = file->materials[0].ultimate};
  if (!file->has_materials || !case_has_fatigue(file)) return SHB_OK;
  for (int i = 0; i < file->n_materials; i++) {
    name[i]      = file->materials[i].group;
    stiffness[i] = file->materials[i].material.E;
    s->line[i]   = (post_goodman){file->materials[i].endurance, file->materials[i].ultimate};
  }
  SHB_TRY(post_blade_regions(modal, n_nodes, file->n_materials, name, stiffness, &s->region));
  s->fatigue = (post_fatigue){.region = s->region, .n_regions = file->n_materials, .of = s->line};
  return SHB_OK;
}

void case_fatigue_free(case_fatigue *s) {
  free(s->region);
  s->region = NULL;
}
