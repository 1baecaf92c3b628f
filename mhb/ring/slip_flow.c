#include "mhb/ring/slip_flow.h"

mhb_slip_law mhb_slip_law_of(const mhb_law *law) {
  mhb_slip_law c = {.mu = law->mu, .kv = law->kv, .n0 = law->n0, .offset = law->mean_offset};
  for (int i = 0; i < 3 && law->mu > 0; i++) c.ku[i] = law->ku[i];
  c.mean      = 0.5 * (c.ku[0] + c.ku[2]);
  c.skew[0]   = 0.5 * (c.ku[0] - c.ku[2]);
  c.skew[1]   = c.ku[1];
  c.isotropic = c.skew[0] == 0 && c.skew[1] == 0;
  return c;
}

void mhb_slip_step(const mhb_slip_law *law, const double u[3], mhb_slip_state *state) {
  mhb_slip_flow(law, law->isotropic, false, u[0], u[1], u[2], &state->load, &state->s[0],
                &state->s[1], &state->f[0], &state->f[1]);
}
