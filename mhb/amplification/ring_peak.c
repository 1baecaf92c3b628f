#include "mhb/amplification/ring_peak.h"

double mhb_blade_amplitude(const mhb_response *r, const mhb_branch *b, int point, int blade) {
  const int blades = r->ring > 0 ? r->ring : 1;
  const int place =
      r->n_probes > 0 ? blade * (r->n_probes / blades) : blade * (r->n_pairs / blades);
  return mhb_response_amplitude(r, b, point, place);
}

mhb_ring_peak mhb_ring_peak_of(const mhb_response *r, const mhb_branch *b) {
  const int     blades = r->ring > 0 ? r->ring : 1;
  mhb_ring_peak peak   = {0};
  int           worst = 0, highest = 0; /* points */
  for (int p = 0; p < b->n_points; p++) {
    double mean = 0;
    for (int blade = 0; blade < blades; blade++) {
      const double a = mhb_blade_amplitude(r, b, p, blade);
      mean += a / blades;
      if (!(a > peak.worst)) continue;
      peak.worst    = a;
      peak.worst_at = b->frequency[p];
      peak.blade    = blade;
      worst         = p;
    }
    if (!(mean > peak.mean)) continue;
    peak.mean    = mean;
    peak.mean_at = b->frequency[p];
    highest      = p;
  }
  if (b->n_points > 0)
    peak.marked = ((b->mark[worst] | b->mark[highest]) & MHB_ABOVE_TOLERANCE) != 0;
  return peak;
}
