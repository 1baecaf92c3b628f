/* Contact and excitation of cases/z_notch_blade, for its modal file. */
#ifndef TESTS_SUPPORT_Z_NOTCH_SETTINGS_H
#define TESTS_SUPPORT_Z_NOTCH_SETTINGS_H

#include "mhb/problem/settings.h"

/* Eight preloads, 90 to 270 Hz, automatic harmonics, no lasting motion. */
mhb_settings z_notch_settings(void);

#endif
