#include "tests/support/quiet_monitor.h"

static bool point(mhb_monitor *monitor, const mhb_response *response, int branch, int at) {
  quiet_monitor *m = (quiet_monitor *)monitor;
  (void)response;
  (void)branch;
  (void)at;
  return ++m->n_points != m->stop_at;
}

static bool searching(mhb_monitor *monitor, double n0, double value, double share) {
  (void)monitor;
  (void)n0;
  (void)value;
  (void)share;
  return true;
}

static bool is_due(mhb_monitor *monitor, const mhb_response *response) {
  (void)monitor;
  (void)response;
  return false;
}

quiet_monitor quiet_monitor_create(int stop_at) {
  return (quiet_monitor){.base    = {.point = point, .searching = searching, .is_due = is_due},
                         .stop_at = stop_at};
}
