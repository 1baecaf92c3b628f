/* One design: the outputs of a case that may differ from its file in some keys. */
#ifndef CASES_PEAKS_DESIGN_RUN_H
#define CASES_PEAKS_DESIGN_RUN_H

#include "cases/commands/load_model.h"
#include "cases/designs/output_names.h"
#include "cases/peaks/peak_field.h"
#include "cases/peaks/peak_walk.h"
#include "postproc/study/design_study.h"

/* Harmonics of the first sweep of a design. */
int design_run_harmonics(const mhb_settings *settings);

/* Compute the outputs on a modal model. Sets state, value, error, reason and curve of the design.
 * A design without an output is STUDY_FAILED with its reason, which is no error here.
 *
 *   file      in  the case of the design
 *   model     in  of its modal file
 *   field     in  of the same, for these outputs; NULL where peak_field_wanted says no
 *   n_modes, mode_frequency   through the model
 *
 * The sweep has few harmonics and no multipliers; the highest peak is then solved with enough
 * (exact_peak.h). Errors: SHB_ERR_IO no memory; SHB_INTERRUPTED. */
shb_status design_run(const case_file *file, const case_model *model, peak_field *field,
                      int n_outputs, const study_output *output, study_design *design);

/* The same from and to peaks of other designs.
 *   from   in   the highest peak of a neighbour, walked to this design; NULL: none
 *   found  out  the highest peak; NULL: not asked for. Its solution has no x where the peak has no
 *               solution of its own. To be freed in any case */
shb_status design_run_from(const case_file *file, const case_model *model, peak_field *field,
                           int n_outputs, const study_output *output, const solved_peak *from,
                           solved_peak *found, study_design *design);

#endif
