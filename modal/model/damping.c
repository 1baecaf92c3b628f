#include "modal/model/damping.h"

#include <math.h>

#include "mesh/base/constants.h"

static double ratio_of(const modal_damping *damping, int i, double omega) {
  switch (damping->kind) {
    case MODAL_DAMPING_EACH:
      return damping->each[i < damping->n ? i : damping->n - 1];
    case MODAL_DAMPING_LOSS:
      return damping->loss / 2;
    case MODAL_DAMPING_RAYLEIGH:
      return damping->alpha / (2 * omega) + damping->beta * omega / 2;
    case MODAL_DAMPING_ALL:
      break;
  }
  return damping->ratio;
}

shb_status modal_damping_ratio(const modal_damping *damping, int i, double omega, double *ratio) {
  *ratio = ratio_of(damping, i, omega);
  SHB_CHECK(*ratio < 1, SHB_ERR_INPUT,
            "modal.damping: mode %d at %.6g Hz would have the damping ratio %.3g; it must be below "
            "1 (lower alpha or beta, or fewer modal.modes)",
            i + 1, omega / SHB_TWO_PI, *ratio);
  return SHB_OK;
}
