/* Settings of a balance that several tests share. */
#ifndef TESTS_SUPPORT_SETTINGS_H
#define TESTS_SUPPORT_SETTINGS_H

#include "mhb/problem/settings.h"

/* Contact to ground with one preload: ku in both directions, engine order 0, tolerance 1e-8, 5000 points at most.
 *   mu -, kv and ku N/m, n0 N; the frequencies are left to the test */
mhb_settings ground_settings(double mu, double kv, double ku, double n0, int harmonics);

#endif
