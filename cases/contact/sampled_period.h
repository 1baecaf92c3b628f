/* One period of a prescribed motion and of the contact forces, sampled for a picture. */
#ifndef CASES_CONTACT_SAMPLED_PERIOD_H
#define CASES_CONTACT_SAMPLED_PERIOD_H

#include <stdbool.h>

#include "mhb/contact/time_history.h"

enum { PERIOD_STATES = 3 }; /* mhb_state */

typedef struct {
  int     n;                     /* samples, phase 0 and phase 1 included */
  double *phase;                 /* [n] t/2 pi, ascending; every transition is among them */
  double *motion[3];             /* [n] v, u, w, m */
  double *friction[2];           /* [n] fu, fw, N; 0 if only round-off of the other */
  double *load, *size, *limit;   /* [n] n, |f|, mu n, N */
  bool   *during[PERIOD_STATES]; /* [n] the state holds from sample i - 1 to i */
  /* areas enclosed by the loops (u, fu) and (w, fw), J; 0 if only round-off */
  double work[2];
} sampled_period;

/* Sample one period of a motion and the contact forces.
 *
 *   motion  in  [3][2m+1] as in mhb_contact_force, m
 *   info    in  transitions of the same law and motion
 *
 * Errors: SHB_ERR_IO no memory. */
shb_status sampled_period_create(mhb_contact_evaluator *contact, const mhb_law *law, int m,
                                 const double *motion, const mhb_contact_info *info,
                                 sampled_period *period);
void       sampled_period_free(sampled_period *period);

#endif
