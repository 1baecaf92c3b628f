#include "mhb/response/publisher.h"

#include <math.h>
#include <stdio.h>

#include "mesh/base/progress.h"

void mhb_publisher_start(mhb_publisher *p, const char *path, const shb_provenance *provenance) {
  *p = (mhb_publisher){
      .path = path, .provenance = provenance, .written = shb_seconds(), .cost = -INFINITY};
  omp_init_lock(&p->mutex);
}

void mhb_publisher_stop(mhb_publisher *p) {
  omp_destroy_lock(&p->mutex);
}

void mhb_publisher_lock(mhb_publisher *p, bool locked) {
  if (locked) {
    omp_set_lock(&p->mutex);
  } else {
    omp_unset_lock(&p->mutex);
  }
}

void mhb_publisher_note(mhb_publisher *p, shb_status status) {
  if (status == SHB_OK || p->status != SHB_OK) return;
  p->status = status;
  snprintf(p->text, sizeof p->text, "%s", shb_message());
}

double mhb_publisher_pause(const mhb_publisher *p, double seconds) {
  enum { WRITES = 20 };
  return fmax(seconds, WRITES * p->cost);
}

bool mhb_publisher_is_due(const mhb_publisher *p, double seconds) {
  return p->path && p->status == SHB_OK &&
         shb_seconds() - p->written > mhb_publisher_pause(p, seconds);
}

shb_status mhb_publisher_write(mhb_publisher *p, const mhb_response *response) {
  const double began  = shb_seconds();
  shb_status   status = p->path ? mhb_response_write(response, p->path, p->provenance) : SHB_OK;
  p->written          = shb_seconds();
  p->cost             = p->written - began;
  return status;
}

shb_status mhb_publisher_status(const mhb_publisher *p) {
  if (p->status == SHB_OK) return SHB_OK;
  return shb_fail(p->status, __FILE__, __LINE__, "%s", p->text);
}
