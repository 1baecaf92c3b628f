#include "mhb/contact/time_history.h"

#include "mesh/base/constants.h"
#include "mhb/contact/dense_output.h"

void mhb_contact_time_history(mhb_contact_evaluator *contact, const mhb_law *law,
                              const double *motion, int count, mhb_contact_sample *sample,
                              mhb_contact_info *info) {
  const mhb_dense_output *pieces = mhb_contact_dense_output(contact, law, motion, info);
  for (int i = 0; i < count; i++) {
    double force[3];
    sample[i].state = mhb_dense_output_at(pieces, SHB_TWO_PI * sample[i].phase, force);
    sample[i].n     = pieces->scale * force[0]; /* scale is NaN where the motion is not finite */
    for (int k = 0; k < 2; k++) sample[i].f[k] = pieces->scale * force[1 + k];
  }
}
