/* One period of a prescribed motion and of the contact's answer, sampled for a picture. */
#ifndef CASES_COMMANDS_SAMPLED_PERIOD_H
#define CASES_COMMANDS_SAMPLED_PERIOD_H

#include <stdbool.h>

#include "mhb/contact/time_history.h"

enum { PERIOD_STATES = 3 }; /* mhb_state */

typedef struct {
  int     n;                     /* samples, phase 0 and phase 1 included */
  double *phase;                 /* [n] t/2 pi, ascending; every transition is among them */
  double *motion[3];             /* [n] v, u, w, m */
  double *friction[2];           /* [n] fu, fw, N; one that is mere rounding of the other is 0 */
  double *load, *size, *limit;   /* [n] n, |f|, mu n, N */
  bool   *during[PERIOD_STATES]; /* [n] the state holds from sample i - 1 to i */
  double  work[2];               /* what the loops (u, fu) and (w, fw) enclose, J; 0 for rounding */
} sampled_period;

/* motion: [3][2m+1] as in mhb_contact_force; info: of the same law and motion, says where the transitions are.
 * SHB_ERR_IO: no memory. */
shb_status sampled_period_create(mhb_contact_evaluator *contact, const mhb_law *law, int m,
                                 const double *motion, const mhb_contact_info *info,
                                 sampled_period *period);
void       sampled_period_free(sampled_period *period);

#endif
