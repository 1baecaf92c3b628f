/* The modal file of a case, from its own mesh or from a coarser or finer one. */
#ifndef CASES_CONVERGE_MESH_VARIANT_H
#define CASES_CONVERGE_MESH_VARIANT_H

#include "cases/commands/command.h"
#include "cases/parse/case_file.h"

typedef struct {
  double factor;          /* of the case's element sizes */
  char  *folder;          /* folder of its files, once it is made */
  char  *modal;           /* path of the modal file */
  double seconds, memory; /* s of one core, largest bytes of meshing and modes; NAN: unknown */
  double unknowns;        /* three per node; NAN: unknown */
} mesh_variant;

/* The modal file of the case itself: a given one, or the stages' own, made again if out of date. */
shb_status mesh_variant_own(const case_file *file, const command_options *options,
                            mesh_variant *out);

/* Make mesh and modes of a parametric blade whose element sizes are multiplied by factor. The files
 * stay in PARENT/mesh_FACTOR. Errors: those of the stages, already printed; SHB_ERR_IO;
 * SHB_INTERRUPTED. */
shb_status mesh_variant_make(const case_file *file, const command_options *options,
                             const char *parent, double factor, mesh_variant *out);

void mesh_variant_free(mesh_variant *v);

/* Make a folder if it does not exist. Errors: SHB_ERR_IO. */
shb_status mesh_variant_folder(const char *path);

#endif
