#include "cases/options/finish.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "mesh/base/crash_guard.h"
#include "mesh/process/report.h"

/* A reader of standard output that has closed it is no fault; a full disk is one. */
static shb_status finish_output(void) {
  errno     = 0;
  bool good = fflush(stdout) == 0;
  if ((good && !ferror(stdout)) || errno == EPIPE) return SHB_OK;
  SHB_FAIL(SHB_ERR_IO, "standard output cannot be written%s%s", errno ? ": " : "",
           errno ? strerror(errno) : "");
}

int command_finish(shb_status status) {
  if (status == SHB_OK || status == SHB_NOT_CONVERGED) {
    shb_status output = finish_output();
    if (output != SHB_OK) status = output;
  }
  if (status == SHB_NOT_CONVERGED && shb_message()[0] != '\0')
    fprintf(stderr, "shroudhb: warning: %s\n", shb_message());
  else if (status != SHB_OK && shb_message()[0] != '\0')
    shb_error("%s", shb_message());
  shb_guard_told((int)status);
  return (int)status;
}
