/* Modal files of designs, each made once and kept in the folder NAME.study.d, and those in memory.
 *
 * Meshing and modes run as child processes: a crash there costs one design. A lock file keeps two
 * processes from making the same file. */
#ifndef CASES_STUDY_MODAL_STORE_H
#define CASES_STUDY_MODAL_STORE_H

#include "cases/commands/load_model.h"
#include "cases/designs/study_spec.h"
#include "cases/peaks/peak_field.h"
#include "mesh/process/child.h"

enum { STORE_MODELS = 4 };

typedef struct {
  const study_spec *spec;
  char             *folder; /* NAME.study.d beside the study file */
  int               copy;   /* text of the case for the stages, as it was when it was read */
  char              copy_path[SHB_CHILD_TEXT];
  struct {
    char        digest[17]; /* "": free */
    case_model  model;
    peak_field *field; /* NULL: not wanted */
    long        used;  /* time of the last use */
  } entry[STORE_MODELS];
  long clock;
} modal_store;

/* Make the folder. Close it in any case; a zeroed one too. Errors: SHB_ERR_IO. */
shb_status modal_store_open(const study_spec *spec, modal_store *store);
void       modal_store_close(modal_store *store);

/* The model of a design with the settings of its case. It is valid until the next call.
 *
 *   value  in   [n_keys] of the design
 *   file   in   its case
 *   model  out  owned by the store
 *   field  out  likewise; NULL if no output of the study needs it
 * Errors: SHB_ERR_INPUT no mesh or no modes, with the message of the stage; a file of the case has
 * changed since the study began; SHB_ERR_IO. */
shb_status modal_store_get(modal_store *store, const double *value, const case_file *file,
                           case_model *model, peak_field **field);

#endif
