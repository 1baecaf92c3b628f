/* One design of a study in full: `shroudhb run` for it, beside the peak that the study has. */
#ifndef CASES_PEAKS_OWN_RUN_H
#define CASES_PEAKS_OWN_RUN_H

#include "cases/designs/study_spec.h"

/* Run all stages of a design, with a report of its own, and print the study's peak beside it. A
 * study that was not run, or has no peak of this design, has none to tell. If the curves do not
 * reach that peak, the run is done again with a search for detached curves at its frequency.
 *
 *   design  in  from 1
 *   quiet   in  print nothing but errors
 * Errors: those of the run, of which it has told; SHB_NOT_CONVERGED the peak is on no curve;
 * SHB_ERR_INPUT there is no such design; SHB_ERR_IO. */
shb_status own_run(const study_spec *spec, int design, bool quiet);

#endif
