/* The last word of a command. */
#ifndef CASES_OPTIONS_FINISH_H
#define CASES_OPTIONS_FINISH_H

#include "mesh/base/status.h"

/* Exit code for a status. Unless the status is SHB_OK, prints "shroudhb: error: TEXT" with the last
 * message, and reports it; for SHB_NOT_CONVERGED it prints "warning". Without a message nothing is
 * printed: case_read prints its errors itself. If standard output is incomplete, SHB_OK and
 * SHB_NOT_CONVERGED become SHB_ERR_IO. */
int command_finish(shb_status status);

#endif
