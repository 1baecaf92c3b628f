/* A model in other units, for tests that units do not matter. */
#ifndef TESTS_SUPPORT_MICROMETRES_H
#define TESTS_SUPPORT_MICROMETRES_H

#include "mhb/problem/settings.h"
#include "modal/model/model.h"

/* The same model in um and MN: lengths x 1e6, forces / 1e6. */
void model_in_micrometres(modal_model *model, mhb_settings *settings);

#endif
