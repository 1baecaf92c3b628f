#include "mhb/contact/time_history.h"

#include "mesh/base/constants.h"
#include "mhb/contact/internal.h"

/* Evaluates the law; the pieces are valid until the evaluator is used again. */
static const mhb_dense_output *evaluate(mhb_contact_evaluator *c, const mhb_law *law,
                                        const double *motion, mhb_contact_info *info) {
  c->dense_output.n = c->dense_output.full = 0;
  c->dense_output.enabled                  = 1;
  mhb_contact_force(c, law, motion, c->history_force, NULL, info);
  c->dense_output.enabled = 0;
  c->dense_output.mu      = law->mu;
  c->dense_output.scale   = c->scale;
  info->lost |= c->dense_output.full;
  return &c->dense_output;
}

void mhb_contact_time_history(mhb_contact_evaluator *contact, const mhb_law *law,
                              const double *motion, int count, mhb_contact_sample *sample,
                              mhb_contact_info *info) {
  const mhb_dense_output *output = evaluate(contact, law, motion, info);
  for (int i = 0; i < count; i++) {
    double force[3];
    sample[i].state = mhb_dense_output_at(output, SHB_TWO_PI * sample[i].phase, force);
    sample[i].n     = output->scale * force[0]; /* scale is NaN where the motion is not finite */
    for (int k = 0; k < 2; k++) sample[i].f[k] = output->scale * force[1 + k];
  }
}
