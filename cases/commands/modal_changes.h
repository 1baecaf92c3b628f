/* Which settings of an earlier modal file differ from those of the case. */
#ifndef CASES_COMMANDS_MODAL_CHANGES_H
#define CASES_COMMANDS_MODAL_CHANGES_H

#include <stdbool.h>

#include "modal/model/revision.h"

/* Do the settings differ at most in modal.damping and in the amplitude of one load, which are
 * excitation.pressure, traction, force.vector and harmonics? out->ratio holds the ratio of the
 * loads then; damping is not touched. A harmonic that is new or gone is another load.
 *
 *   earlier, settings  in  texts of cases/schema/stage_settings.h */
bool modal_changes_find(const char *earlier, const char *settings, modal_revision *out);

#endif
