/* Settings of a balance for several tests. */
#ifndef TESTS_SUPPORT_SETTINGS_H
#define TESTS_SUPPORT_SETTINGS_H

#include "mhb/problem/settings.h"

/* Contact to ground with one preload: ku in both directions, engine order 0, tolerance 1e-8, at
 * most 5000 points, no lasting motion. The frequencies remain to be set.
 *   mu -, kv and ku N/m, n0 N */
mhb_settings ground_settings(double mu, double kv, double ku, double n0, int harmonics);

#endif
