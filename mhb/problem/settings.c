#include "mhb/problem/settings.h"

#include "modal/model/nodal_diameters.h"

bool mhb_judges_stability(const mhb_settings *s) {
  const modal_nodal_diameters *disc = s->nodal_diameters;
  return s->stability != MHB_STABILITY_NEVER && (!disc || disc->n == disc->blades / 2 + 1);
}
