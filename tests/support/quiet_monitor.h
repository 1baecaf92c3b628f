/* A monitor of tests: it counts the points, and stops the work where it is told to. */
#ifndef TESTS_SUPPORT_QUIET_MONITOR_H
#define TESTS_SUPPORT_QUIET_MONITOR_H

#include "mhb/branches/monitor.h"

typedef struct {
  mhb_monitor base;              /* first: the functions get it back */
  int         n_points, stop_at; /* points so far; at which one to stop, 0: never */
} quiet_monitor;

/* Nothing is due, and searches go on. */
quiet_monitor quiet_monitor_create(int stop_at);

#endif
