/* A peak of a frequency sweep, as a first guess of one that is followed.
 *
 * A sweep in outline does not locate its peaks. A parabola through the highest of three points and
 * its neighbours gives the guess. Where one of them sticks the peak may be a corner, and the guess
 * is the highest point itself. */
#ifndef MHB_TRACKING_SWEEP_PEAK_H
#define MHB_TRACKING_SWEEP_PEAK_H

#include "mhb/balance/balance.h"
#include "mhb/response/response.h"

typedef struct {
  const mhb_branch *branch;    /* of the sweep */
  int               point;     /* of the branch: the highest of three */
  double            frequency; /* Hz */
  double            amplitude; /* m, of the output */
  double            reach;     /* the peak's frequency is within this of the guess, relative */
  double            weight[3]; /* of the motions of the three points */
  bool              sticks;    /* between the three points some contact begins to slip, or at one
                                * of them all stick: the peak may be a corner */
} mhb_sweep_peak;

/* The peak at a point of a sweep's branch; the point is none of the branch's ends. False: a
 * neighbour is higher.
 *   output   in  output_amplitude.h
 *   outline  in  the sweep is in outline; else its peaks are points of it */
bool mhb_sweep_peak_at(const mhb_response *sweep, const mhb_branch *branch, int point, int output,
                       bool outline, mhb_sweep_peak *peak);

/* x[n] of a balance <- motion of the guess. work[n] is overwritten. */
void mhb_sweep_peak_motion(const mhb_sweep_peak *peak, const mhb_balance *balance, double *x,
                           double *work);

#endif
