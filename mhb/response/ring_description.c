#include "mhb/response/ring_description.h"

#include <stdio.h>

const char *mhb_ring_kind_name(int kind) {
  static const char *const name[MHB_RING_KINDS] = {"at rest", "wave", "other waves",
                                                   "standing wave", "localised"};
  return kind >= 0 && kind < MHB_RING_KINDS ? name[kind] : name[0];
}

int mhb_ring_most_localised(const mhb_response *r, const mhb_branch *b) {
  int best = -1;
  for (int i = 0; r->ring && b->ring_participation && i < b->n_points; i++) {
    const double share = b->ring_participation[i];
    if (share > 0 && (best < 0 || share < b->ring_participation[best])) best = i;
  }
  return best;
}

void mhb_ring_describe(const mhb_response *r, const mhb_branch *b, char text[MHB_RING_TEXT]) {
  const int at = mhb_ring_most_localised(r, b);
  text[0]      = '\0';
  if (at < 0) return;
  snprintf(text, MHB_RING_TEXT,
           "%s: %.3g of %d blades take part, %.3g of the energy in the wave of the load",
           mhb_ring_kind_name(b->ring_kind[at]), b->ring_participation[at] * r->ring, r->ring,
           b->ring_wave[(size_t)at * (size_t)r->ring]);
}
