/* The scratch folder of a test program. Give scratch_make and scratch_remove to cmocka as set-up
 * and tear-down of the group. */
#ifndef TESTS_SUPPORT_SCRATCH_FOLDER_H
#define TESTS_SUPPORT_SCRATCH_FOLDER_H

#include <stdio.h>
#include <stdlib.h>

static char scratch_folder[256];

static inline int scratch_make(void **state) {
  (void)state;
  const char *root = getenv("TMPDIR");
  snprintf(scratch_folder, sizeof scratch_folder, "%s/shroudhb.XXXXXX", root ? root : "/tmp");
  return mkdtemp(scratch_folder) == NULL;
}

static inline int scratch_remove(void **state) {
  (void)state;
  char command[300];
  snprintf(command, sizeof command, "rm -r '%s'", scratch_folder);
  return system(command);
}

/* Path of a file in the scratch folder. Up to four paths are valid at a time. */
static inline const char *scratch(const char *name) {
  static char path[4][512];
  static int  turn;
  turn = (turn + 1) % 4;
  snprintf(path[turn], sizeof path[turn], "%s/%s", scratch_folder, name);
  return path[turn];
}

#endif
