/* Reference solution of the contact law: Taylor series of high order from event to event, in long
 * double.
 *
 * It shares no code and no method with mhb. There the slip angle is followed by collocation; here
 * the friction itself is followed in the plane. With x = Ku s and K the shape of Ku
 *   stick  f = x - z;   slip  f' = x' - lambda K f,  f.f = mu^2 n^2  (eq. 9)
 * The equation with its constraint is solved for the series of f and lambda coefficient by
 * coefficient. At a closing n = 0, f = t F and lambda = L/t. F and L are computed in the same way,
 * which gives the regular solution without an error of the start (eqs. 13-15). Events are roots of
 * the series: |x - z| = mu n (eq. 7) and lambda = 0 (eq. 10). Towards an opening the steps shrink
 * with the radius of convergence. Two solutions never diverge in the norm of 1/K, so the error of a
 * step is not amplified.
 *
 * A contact that stays closed and slips has one unknown, the angle in the middle of a slip phase.
 * The period map of that angle is solved by secants. A solution takes milliseconds and is accurate
 * to about 1e-13. */
#ifndef TESTS_SUPPORT_REFERENCE_LAW_H
#define TESTS_SUPPORT_REFERENCE_LAW_H

#include "mhb/contact/contact.h"
#include "tests/support/series.h"

enum { REFERENCE_HARMONICS = 24, REFERENCE_EVENTS = 512 };

typedef struct {
  double force[3][2 * REFERENCE_HARMONICS + 1]; /* (n - balance, fu, fw), real form, N */
  double work;                                  /* J a cycle, summed over slip */
  double share[3];
  int    n_transitions;
  double phase[REFERENCE_EVENTS]; /* in [0, 1) */
  int    state[REFERENCE_EVENTS]; /* mhb_state that begins */
  int    laps;
  double left;  /* distance from periodicity, relative to the largest friction */
  double decay; /* of the slip angle, per lap; 0 when the contact opens */
  /* never slips; the mean friction is undetermined, and that of a zero-mean slider is returned */
  int stuck;
  int lost; /* too many events, or not periodic */
} reference;

/* Force harmonics 0..H of a motion of m harmonics, motion[3][2m+1].
 *   order      of the series, 8..SERIES_ORDER
 *   tolerance  of a step, relative to the largest force so far: 1e-18 with order 24 */
void reference_force(const mhb_law *law, int m, const double *motion, int H, int order,
                     double tolerance, reference *out);

#endif
