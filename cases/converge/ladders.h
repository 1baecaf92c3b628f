/* The ladders of a convergence study: which rungs there are, and running them. */
#ifndef CASES_CONVERGE_LADDERS_H
#define CASES_CONVERGE_LADDERS_H

#include "cases/commands/command.h"
#include "cases/converge/mesh_variant.h"
#include "cases/converge/rung.h"
#include "cases/parse/case_file.h"
#include "mesh/base/progress.h"
#include "modal/model/model.h"
#include "postproc/analysis/convergence.h"

enum { STUDY_VARIANTS = 4 };

/* What a row of the result needs to be run. */
typedef struct {
  rung_setting setting;
  int          variant;
  char        *stem;
  rung_cost    cost;
} study_row;

typedef struct {
  case_file             *file;
  const command_options *options;
  shb_progress           progress;
  char                  *folder; /* NAME.converge */
  mesh_variant           variant[STUDY_VARIANTS];
  int                    n_variants;
  modal_model            model;  /* of the first */
  char                  *points; /* NAME.integration.h5, if it belongs to the case; or NULL */
  rung_setting           base;   /* in which the ladders stand: all at its finest */
  post_convergence       result;
  int                    capacity;
  study_row             *row;  /* [result.n] */
  post_buffer            note; /* what must be known besides; lines */
  bool short_of_rungs;         /* a ladder has no rung but the finest that meets the tolerance */
} convergence_study;

/* Every ladder in turn. A rung that fails costs its row only.
 * Errors: SHB_INTERRUPTED, the rows so far are good; SHB_ERR_INPUT a rung's program has told it (no text); SHB_ERR_IO. */
shb_status ladders_run(convergence_study *study);

#endif
