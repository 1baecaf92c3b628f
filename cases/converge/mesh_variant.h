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
} variant;

/* The case's own modal file: brought, or made by the stages beside the case where it is not up to date. */
shb_status variant_own(const case_file *file, const command_options *options, variant *out);

/* Mesh and modes of a parametric blade with factor times the element sizes, in PARENT/mesh_FACTOR; kept there between runs.
 * Errors: of the stages, which have told them (no text); SHB_ERR_IO; SHB_INTERRUPTED. */
shb_status variant_make(const case_file *file, const command_options *options, const char *parent,
                        double factor, variant *out);

void variant_free(variant *v);

/* Make a folder unless it is there. SHB_ERR_IO. */
shb_status variant_folder(const char *path);

#endif
