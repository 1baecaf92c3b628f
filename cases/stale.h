/* Telling a user of single stages that an earlier stage's file no longer fits the case. */
#ifndef CASES_STALE_H
#define CASES_STALE_H

#include "cases/case.h"

/* One warning line on stderr if the HDF5 file at path was made from other settings of stage than the case has now.
 * Files that cannot be read are left to whoever needs them. */
void stale_warn(const case_file *file, case_stage stage, const char *path);

#endif
