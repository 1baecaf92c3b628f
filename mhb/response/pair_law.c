#include "mhb/response/pair_law.h"

#include <string.h>

#include "mhb/numerics/fourier.h"
#include "mhb/problem/interfaces.h"

void mhb_recorded_shares(const mhb_response *r, const double *area, double *share) {
  const int sides = r->interface && r->n_interfaces > 1 ? r->n_interfaces : 1;
  mhb_pair_shares(r->n_pairs, sides, sides > 1 ? r->interface : NULL, area,
                  r->ring > 0 ? r->ring : 1, share);
}

/* Place of the pair's interface in the settings. */
static int interface_of(const mhb_settings *s, const mhb_response *r, int pair) {
  if (r->n_interfaces < 2 || !r->interface) return s->lead;
  for (int i = 0; i < s->n_interfaces; i++)
    if (strcmp(s->interface[i].name, r->interface_name[r->interface[pair]]) == 0) return i;
  return s->lead;
}

mhb_law mhb_recorded_law(const mhb_settings *s, const mhb_response *r, const mhb_branch *b,
                         int point, int pair, double share) {
  mhb_operating_point at = mhb_operating_point_of(s);
  at.n0                  = b->n0[point];
  if (r->parameter != MHB_IN_FREQUENCY) mhb_parameter_set(&at, r->parameter, b->value[point]);
  mhb_operating_point own = mhb_interface_operating_point(&at, s, interface_of(s, r, pair));
  if (r->n_interfaces > 1 && r->interface)
    own.n0 = b->interface_n0[(size_t)point * (size_t)r->n_interfaces + (size_t)r->interface[pair]];
  return mhb_operating_point_law(&own, s->preload, share);
}

void mhb_recorded_pair_motion(const mhb_response *r, const mhb_branch *b, int point, int pair,
                              double *motion) {
  const size_t row = ((size_t)point * (size_t)r->n_pairs + (size_t)pair) * 3,
               K   = (size_t)b->n_harmonics + 1;
  for (size_t d = 0; d < 3; d++)
    mhb_to_real(b->n_harmonics, b->motion + (row + d) * K,
                motion + d * (size_t)mhb_real_size(b->n_harmonics));
}
