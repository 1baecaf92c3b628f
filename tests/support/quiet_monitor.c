#include "tests/support/quiet_monitor.h"

#include <limits.h>

static bool point(mhb_monitor *monitor, const mhb_response *response, int branch, int at) {
  quiet_monitor *m = (quiet_monitor *)monitor;
  (void)response;
  (void)branch;
  (void)at;
  return ++m->n_points != m->stop_at;
}

static bool searching(mhb_monitor *monitor, mhb_sought what, double n0, double value,
                      double share) {
  (void)monitor;
  (void)what;
  (void)n0;
  (void)value;
  (void)share;
  return true;
}

static bool is_due(mhb_monitor *monitor, const mhb_response *response) {
  (void)response;
  return ((quiet_monitor *)monitor)->due;
}

static shb_status publish(mhb_monitor *monitor, const mhb_response *response) {
  quiet_monitor    *m    = (quiet_monitor *)monitor;
  const mhb_branch *main = &response->branch[0];
  m->n_published++;
  m->fewest = main->n_points < m->fewest ? main->n_points : m->fewest;
  m->early  = m->early || main->complete;
  return SHB_OK;
}

quiet_monitor quiet_monitor_create(int stop_at) {
  return (quiet_monitor){
      .base    = {.point = point, .searching = searching, .is_due = is_due, .publish = publish},
      .stop_at = stop_at,
      .fewest  = INT_MAX};
}

quiet_monitor due_monitor_create(void) {
  quiet_monitor monitor = quiet_monitor_create(0);
  monitor.due           = true;
  return monitor;
}
