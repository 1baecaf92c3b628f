#include "tests/support/z_notch_settings.h"

#include <string.h>

#include "mesh/base/constants.h"

mhb_settings z_notch_settings(void) {
  static const double n0[] = {-250, 10, 15, 25, 50, 100, 250, 1000};
  mhb_settings        s    = {.blades           = 40,
                              .engine_order     = 5,
                              .lasting          = MHB_LASTING_NEVER,
                              .has_psi          = true,
                              .has_phi          = true,
                              .psi              = 35 * SHB_TWO_PI / 360,
                              .mu               = 0.3,
                              .kv               = 8e5,
                              .ku               = {5e5, 0, 5e5},
                              .n_preloads       = 8,
                              .frequency        = {90, 270},
                              .harmonics        = 31,
                              .motion_tolerance = 0.01,
                              .subharmonics     = 1,
                              .scale            = 1,
                              .tolerance        = 1e-4,
                              .max_points       = 2000};
  memcpy(s.n0, n0, sizeof n0);
  return s;
}
