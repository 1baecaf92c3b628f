/* A peak or a fold, followed along a parameter from a first one, both ways. */
#ifndef MHB_TRACKING_TRACKED_CURVE_H
#define MHB_TRACKING_TRACKED_CURVE_H

#include "mhb/continuation/events.h"
#include "mhb/response/response.h"
#include "mhb/tracking/peak_system.h"

/* What is followed, and where. */
typedef struct {
  mhb_tracked_point kind;
  int               output;       /* output_amplitude.h */
  mhb_parameter     parameter;    /* not the frequency */
  double            low, high;    /* of the parameter */
  double            frequency[2]; /* rad/s, the range of the peaks */
  int               max_points;
  double            tolerance; /* > 0: stop where the truncation error exceeds it */
  mhb_size          size;      /* which amplitude */
} mhb_tracking;

/* A point to start from: an approximate peak or fold. */
typedef struct {
  const double *x;     /* [n] motion of the balance */
  double        omega; /* rad/s */
  double        value; /* of the parameter */
  double        reach; /* of a peak: its frequency is within this of omega, relative; 0: not known,
                        * and any peak will do */
  double        amplitude; /* of a peak, with reach: that of the output, about */
} mhb_tracking_seed;

/* Whether a peak is that of a seed. */
bool mhb_is_seeded(const mhb_tracking_seed *seed, double omega, double amplitude);

/* Where a curve ends. */
typedef struct {
  mhb_end low, high; /* towards small and large values of the parameter */
} mhb_tracking_end;

/* Follow from a seed to both ends of the range, into an empty branch of a response.
 *
 * A branch of peaks ascends in the parameter and is single-valued in it. Its ends are those of
 * mhb_end: the ends of the range, MHB_END_TURNED, MHB_END_CORNER, MHB_END_FREQUENCY. A curve of
 * folds may turn. It ends at the ends of the range, or where it closes. MHB_OPTIMUM marks where the
 * amplitude is stationary along the curve; of a fold, where the frequency is.
 * *found false: no peak near the seed. */
shb_status mhb_trace_tracked(mhb_balance *balance, const mhb_tracking *tracking,
                             const mhb_tracking_seed *seed, mhb_response *response, int branch,
                             bool *found, mhb_tracking_end *end);

/* Append both halves of a curve, each from the seed on, to a branch: the low one from its end, then
 * the high one. The seed's point is in both and is appended once. */
void mhb_join_halves(mhb_response *response, int branch, const mhb_response *store, int low,
                     int high);

#endif
