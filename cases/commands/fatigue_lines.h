/* Goodman's lines of a case, for the stress of its blade. */
#ifndef CASES_COMMANDS_FATIGUE_LINES_H
#define CASES_COMMANDS_FATIGUE_LINES_H

#include "cases/parse/case_file.h"
#include "postproc/field/peak_stress.h"

typedef struct {
  post_fatigue fatigue; /* points into the other members */
  int         *region;  /* [node] with several materials, else NULL */
  post_goodman line[MESH_MAX_VOLUMES];
} case_fatigue;

/* Whether a material of the case has Goodman's line. */
bool case_has_fatigue(const case_file *file);

/* The lines of a case: one, or one a material.
 *   modal    in  path of the modal file, whose volumes name the materials
 *   n_nodes  in  nodes of its mesh
 * Errors: those of post_blade_regions. To be freed in any case, and not to be moved. */
shb_status case_fatigue_read(const case_file *file, const char *modal, int n_nodes,
                             case_fatigue *lines);
void       case_fatigue_free(case_fatigue *lines);

#endif
