/* The uncertain keys of a study: a distribution for each. */
#ifndef CASES_DESIGNS_UNCERTAIN_KEYS_H
#define CASES_DESIGNS_UNCERTAIN_KEYS_H

#include "cases/designs/study_keys.h"

/* Read the mapping of uncertain keys and append them to the varied ones. Faults are recorded.
 *
 * A key that is varied too has `relative: true`: its distribution is that of the ratio to the
 * varied value. */
void uncertain_keys_read(case_issues *issues, const case_node *node, study_keys *keys);

#endif
