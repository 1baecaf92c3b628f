/* Reports on the work on a preload, and requests to stop it. */
#ifndef MHB_RESPONSE_MONITOR_H
#define MHB_RESPONSE_MONITOR_H

#include <stdbool.h>

#include "mhb/response/response.h"

/* What is searched for: the first solution of a curve, or other curves of a preload. */
typedef enum { MHB_SEEKS_FIRST, MHB_SEEKS_OTHERS } mhb_sought;

/* Its functions may be called from any thread. */
typedef struct mhb_monitor mhb_monitor;
struct mhb_monitor {
  /* A point of a branch was recorded, or judged. false: stop. */
  bool (*point)(mhb_monitor *monitor, const mhb_response *response, int branch, int point);
  /* A search at a preload (N) begins or goes on. value: of the parameter, as the file shows it.
   * share: of the search for other curves that is done. false: stop. */
  bool (*searching)(mhb_monitor *monitor, mhb_sought what, double n0, double value, double share);
  /* Whether the curves so far of a preload are to be published, and their publication. */
  bool (*is_due)(mhb_monitor *monitor, const mhb_response *response);
  shb_status (*publish)(mhb_monitor *monitor, const mhb_response *response);
};

/* Publish the curves so far of a preload's response, if that is due. Errors: as of publish. */
static inline shb_status mhb_monitor_publish_if_due(mhb_monitor        *monitor,
                                                    const mhb_response *response) {
  return monitor->is_due(monitor, response) ? monitor->publish(monitor, response) : SHB_OK;
}

#endif
