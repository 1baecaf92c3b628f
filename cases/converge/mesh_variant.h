/* The case's modal file, from its own mesh or a coarser or finer one. */
#ifndef CASES_CONVERGE_MESH_VARIANT_H
#define CASES_CONVERGE_MESH_VARIANT_H

#include "cases/commands/command.h"
#include "cases/parse/case_file.h"

typedef struct {
  double factor;          /* of the case's element sizes */
  char  *folder;          /* for its files; there once it was made */
  char  *modal;           /* path of the modal file */
  double seconds, memory; /* s of one core, greatest bytes of meshing and modes; NAN: not known */
  double unknowns;        /* 3 nodes; NAN: the file does not say */
} mesh_variant;

/* The case's own modal file: brought, or made by the stages beside the case where it is not up to date. */
shb_status mesh_variant_own(const case_file *file, const command_options *options,
                            mesh_variant *out);

/* Mesh and modes of a parametric blade with factor times the element sizes, in PARENT/mesh_FACTOR; kept there between runs.
 * Errors: of the stages, which have told them (no text); SHB_ERR_IO; SHB_INTERRUPTED. */
shb_status mesh_variant_make(const case_file *file, const command_options *options,
                             const char *parent, double factor, mesh_variant *out);

void mesh_variant_free(mesh_variant *v);

/* Make a folder unless it is there. SHB_ERR_IO. */
shb_status mesh_variant_folder(const char *path);

#endif
