#include "tests/support/settings.h"

mhb_settings ground_settings(double mu, double kv, double ku, double n0, int harmonics) {
  return (mhb_settings){.to_ground    = true,
                        .blades       = 1,
                        .mu           = mu,
                        .kv           = kv,
                        .ku           = {ku, 0, ku},
                        .n_preloads   = 1,
                        .n0           = {n0},
                        .harmonics    = harmonics,
                        .subharmonics = 1,
                        .scale        = 1,
                        .tolerance    = 1e-8,
                        .max_points   = 5000,
                        .lasting      = MHB_LASTING_NEVER};
}
