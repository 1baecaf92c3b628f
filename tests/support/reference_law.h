/* Independent witness of the contact law: Taylor series of high order from event to event, in long
 * double.
 *
 * Shares no code and no method with mhb/: the law there follows the slip angle by collocation; here
 * the friction itself is followed in the plane, with x = Ku s and K the shape of Ku,
 *   stick  f = x - z;   slip  f' = x' - lambda K f,  f.f = mu^2 n^2  (eq. 9),
 * an equation with a constraint, solved for the series of f and lambda coefficient by coefficient.
 * At a closing n = 0, f = t F and lambda = L/t, and the same is done for F and L: the regular
 * solution, no start-up error (eqs. 13-15). Events are roots of the series: |x - z| = mu n (eq. 7),
 * lambda = 0 (eq. 10). Towards an opening the steps shrink with the radius of convergence. Two
 * solutions never part in the norm of 1/K, so that errors of a step are not amplified.
 *
 * A contact that stays closed and slips: the state in the middle of a slip is one angle; the lap
 * map of that angle is solved by secants. Slow (milliseconds), good to 1e-13 or so. */
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
  int stuck; /* never slips: the mean friction is not determined; its mean is left at zero-mean slider */
  int lost; /* too many events, or not periodic */
} reference;

/* Force harmonics 0..H of a motion of m harmonics, motion[3][2m+1].
 *   order      of the series, 8..SERIES_ORDER
 *   tolerance  of a step, relative to the largest force in sight: 1e-18 with order 24 */
void reference_force(const mhb_law *law, int m, const double *motion, int H, int order,
                     double tolerance, reference *out);

#endif
