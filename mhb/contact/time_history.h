/* The contact over one period at given phases: for hysteresis loops and contact states. */
#ifndef MHB_CONTACT_TIME_HISTORY_H
#define MHB_CONTACT_TIME_HISTORY_H

#include "mhb/contact/contact.h"

typedef struct {
  double    phase; /* in: t/2 pi, in [0, 1] */
  mhb_state state; /* out; at a transition the one that begins */
  double    n;     /* normal load max(n0 + kv v, 0), N; mean_offset is not subtracted */
  double    f[2];  /* friction (fu, fw), N */
} mhb_contact_sample;

/* Evaluates the law and samples its pieces at any phases: nothing is interpolated between samples.
 *   motion  in      [3][2m+1] as in mhb_contact_force, m
 *   sample  in out  [count]
 *   info    out     as in mhb_contact_force; lost is set too where the pieces found no room
 * Not finite: NaN. Laps are repeated until one closes to 1e-12 of the friction, or as near as their
 * tolerance permits. */
void mhb_contact_time_history(mhb_contact_evaluator *contact, const mhb_law *law,
                              const double *motion, int count, mhb_contact_sample *sample,
                              mhb_contact_info *info);

#endif
