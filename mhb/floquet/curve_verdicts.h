/* Stability along a curve of which only some points have multipliers: which point to judge next,
 * and which of the others their neighbours decide.
 *
 * Let f be the largest modulus less 1, a function of the place s along the curve. s counts points,
 * since the steps of the continuation are short where the solution changes quickly. Between judged
 * points i < j let |f'| <= L. Then
 *   min |f| >= (|f_i| + |f_j| - L (j - i))/2,
 * and f has one sign if L (j - i) < |f_i| + |f_j|. L is STEEPER times the steepest difference
 * quotient of f between judged points from the one before i to the one after j. Points between are
 * decided by their neighbours if this holds, both have the same kind, and j - i is at most
 * eight. The estimate of L is no bound, so the verdict is likely, not certain.
 *
 * Nothing is concluded across a change of the equations: slip onset, a fold, a gap. */
#ifndef MHB_FLOQUET_CURVE_VERDICTS_H
#define MHB_FLOQUET_CURVE_VERDICTS_H

#include <stdbool.h>

/* Modulated: disturbances grow in a complex pair or with alternating sign, and none on the positive
 * axis. Beyond a fold: one grows without change of sign. */
typedef enum { MHB_KIND_STABLE, MHB_KIND_MODULATED, MHB_KIND_BEYOND_FOLD } mhb_stability_kind;

typedef struct {
  bool               judged;    /* kind and excess are known */
  bool               undecided; /* multipliers were tried in vain */
  bool               divides;   /* linear, or a fold: no conclusion from one side to the other */
  bool               begins;    /* none from the point before to this one */
  bool               wanted;    /* to be judged first: a peak */
  mhb_stability_kind kind;
  double             excess; /* f */
} mhb_curve_verdict;

/* The next point to judge; -1: none. In this order:
 *   a wanted point; the end of a stretch;
 *   the middle of the longest gap between points of different kind;
 *   the middle between points of one kind that nearly decide those between them.
 * For the last L (j - i)/(|f_i| + |f_j|) is least. */
int mhb_curve_verdicts_next(int n, const mhb_curve_verdict *verdict);

/* decided[n] <- the judged point before a point that its neighbours decide; -1 for all others. */
void mhb_curve_verdicts_decided(int n, const mhb_curve_verdict *verdict, int *decided);

#endif
