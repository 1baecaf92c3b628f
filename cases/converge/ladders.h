/* The ladders of a convergence study: choice of the rungs, and their runs. */
#ifndef CASES_CONVERGE_LADDERS_H
#define CASES_CONVERGE_LADDERS_H

#include "cases/commands/command.h"
#include "cases/commands/contact_points.h"
#include "cases/converge/mesh_variant.h"
#include "cases/converge/rung.h"
#include "cases/parse/case_file.h"
#include "mesh/base/progress.h"
#include "modal/model/model.h"
#include "postproc/analysis/convergence.h"

enum { STUDY_VARIANTS = 4 };

/* What is needed to run a row of the result. */
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
  modal_model            model;   /* of the first mesh, joined as base says */
  int                    n_pairs; /* of its modal file */
  contact_points        *joined;  /* contact.points: auto; else NULL */
  bool                   disc;    /* the modal file holds nodal diameters; model is that of 0 */
  /* NAME.integration.h5 if it belongs to the present case, else NULL */
  char            *points;
  rung_setting     base; /* base setting of the ladders: everything at its finest */
  post_convergence result;
  int              capacity;
  study_row       *row;  /* [result.n] */
  post_buffer      note; /* remarks, one a line */
  /* a ladder has no rung besides the finest that meets the tolerance */
  bool short_of_rungs;
} convergence_study;

/* Run every ladder. A rung that fails affects only its row. Errors: SHB_INTERRUPTED, the rows so
 * far are valid; SHB_ERR_INPUT, the program of a rung has printed the message; SHB_ERR_IO. */
shb_status ladders_run(convergence_study *study);

#endif
