/* A monitor of tests: it counts points and publications, and stops the work where it is told to. */
#ifndef TESTS_SUPPORT_QUIET_MONITOR_H
#define TESTS_SUPPORT_QUIET_MONITOR_H

#include "mhb/response/monitor.h"

typedef struct {
  mhb_monitor base;              /* first: the functions get it back */
  int         n_points, stop_at; /* points so far; at which one to stop, 0: never */
  bool        due;               /* publication is always due, or never */
  int         n_published;
  int         fewest; /* points of branch 0 at any publication */
  bool        early;  /* branch 0 was complete at a publication */
} quiet_monitor;

/* Nothing is due, and searches go on. */
quiet_monitor quiet_monitor_create(int stop_at);

/* Publication is always due, and the work is never stopped. */
quiet_monitor due_monitor_create(void);

#endif
