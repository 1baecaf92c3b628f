#include "mhb/problem/settings.h"

#include <string.h>

#include "modal/model/nodal_diameters.h"

bool mhb_judges_stability(const mhb_settings *s) {
  const modal_nodal_diameters *disc = s->nodal_diameters;
  return s->stability != MHB_STABILITY_NEVER && (!disc || disc->n == disc->blades / 2 + 1);
}

const char *mhb_track_word(mhb_track track) {
  static const char *const word[MHB_N_TRACKS] = {[MHB_TRACK_NOTHING]         = "nothing",
                                                 [MHB_TRACK_PEAKS]           = "peak",
                                                 [MHB_TRACK_FOLDS]           = "fold",
                                                 [MHB_TRACK_FLIPS]           = "flip",
                                                 [MHB_TRACK_NEIMARK_SACKERS] = "neimark-sacker"};
  return word[track];
}

const char *mhb_output_quantity_word(mhb_output_quantity quantity) {
  static const char *const word[] = {[MHB_OUTPUT_HARMONIC]     = "harmonic",
                                     [MHB_OUTPUT_PEAK_TO_PEAK] = "peak_to_peak",
                                     [MHB_OUTPUT_RSS]          = "rss"};
  return word[quantity];
}

bool mhb_track_by_multiplier(const char *word) {
  return word && (strcmp(word, mhb_track_word(MHB_TRACK_FLIPS)) == 0 ||
                  strcmp(word, mhb_track_word(MHB_TRACK_NEIMARK_SACKERS)) == 0);
}
