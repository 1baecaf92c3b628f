/* Where slip begins, by a motion whose contact is taken as stuck (docs/theory/tracking.md).
 *
 * f(t) = Ku s is the friction force without its mean, n(t) = n0 + kv v the normal force. A mean c
 * is admissible if |f + c| <= mu n at all phases: c lies in a disc for each. Slip is possible where
 * the discs of two phases t_1, t_2 lie apart,
 *   h = max over t_1, t_2 of (|f_1 - f_2| - mu (n_1 + n_2))/2 > 0.
 * At h = 0 they touch and c is determined,
 *   c = -(f_1 + f_2)/2 + mu (n_1 - n_2) e/2,   e = (f_1 - f_2)/|f_1 - f_2|.
 * Three discs that have no point in common are not recognised. */
#ifndef MHB_CONTACT_SLIP_ONSET_H
#define MHB_CONTACT_SLIP_ONSET_H

#include "mhb/contact/law.h"

typedef struct {
  double h;       /* N: below 0 no two discs lie apart */
  double limit;   /* N: mu (n_1 + n_2)/2, the size of what h is the difference of */
  double c[2];    /* N */
  double time[2]; /* t_1, t_2, as angles in a period of 2 pi */
} mhb_slip_onset;

/* motion[3][2m+1] in real form (fourier.h), m. */
void mhb_slip_onset_find(const mhb_law *law, int m, const double *motion, mhb_slip_onset *onset);

/* The derivatives by the motion, N/m, at an onset that was found. h does not change with the times,
 * c moves with them.
 *   by_h, by_c[2]  out  [3 (2m+1)] */
void mhb_slip_onset_gradient(const mhb_law *law, int m, const double *motion,
                             const mhb_slip_onset *onset, double *by_h, double *const by_c[2]);

#endif
