#include "mhb/contact/time_history.h"

#include "mesh/base/constants.h"
#include "mhb/contact/internal.h"

/* Evaluates the law and keeps its pieces, valid until the evaluator is used again. */
static const mhb_dense_output *evaluate(mhb_contact_evaluator *c, const mhb_law *law,
                                        const double *motion, mhb_contact_info *info) {
  c->pieces.n = c->pieces.full = 0;
  c->pieces.on                 = 1;
  mhb_contact_force(c, law, motion, c->traced, NULL, info);
  c->pieces.on    = 0;
  c->pieces.mu    = law->mu;
  c->pieces.scale = c->scale;
  info->lost |= c->pieces.full;
  return &c->pieces;
}

void mhb_contact_time_history(mhb_contact_evaluator *contact, const mhb_law *law,
                              const double *motion, int count, mhb_contact_sample *sample,
                              mhb_contact_info *info) {
  const mhb_dense_output *pieces = evaluate(contact, law, motion, info);
  for (int i = 0; i < count; i++) {
    double force[3];
    sample[i].state = mhb_dense_output_at(pieces, SHB_TWO_PI * sample[i].phase, force);
    sample[i].n     = pieces->scale * force[0]; /* scale is NaN where the motion is not finite */
    for (int k = 0; k < 2; k++) sample[i].f[k] = pieces->scale * force[1 + k];
  }
}
