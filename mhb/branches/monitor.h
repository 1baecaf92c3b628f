/* How a branch under way reports its points, and is stopped. */
#ifndef MHB_BRANCHES_MONITOR_H
#define MHB_BRANCHES_MONITOR_H

#include <stdbool.h>

#include "mhb/continuation/arclength.h"

/* Called after every recorded point; the one place where threads meet. Returns false to stop (interrupted). */
typedef struct mhb_monitor mhb_monitor;
struct mhb_monitor {
  bool (*point)(mhb_monitor *monitor, int branch, const mhb_curve_point *point);
  void (*lock)(mhb_monitor *monitor, bool locked);
  /* Called, locked, while further branches are looked for at a value of the parameter, a share of it done; false: stop. */
  bool (*looking)(mhb_monitor *monitor, int branch, double value, double share);
};

#endif
