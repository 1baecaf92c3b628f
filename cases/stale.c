#include "cases/stale.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "modal/h5.h"

/* The stage wrote its keys first, then what else it depends on. */
static bool made_from(const char *written, const char *keys) {
  return strncmp(written, keys, strlen(keys)) == 0;
}

void stale_warn(const case_file *file, case_stage stage, const char *path) {
  hid_t h5;
  if (h5_open(path, &h5) != SHB_OK) return;
  char *written = NULL, *keys = case_settings(file, stage);
  bool  read = h5_read_attribute_text(h5, "/", "settings", &written) == SHB_OK;
  h5_close(h5);
  if (read && written && keys && !made_from(written, keys))
    fprintf(stderr, "shroudhb: warning: %s was made from other settings; run `shroudhb %s` first\n",
            path, stage == CASE_MODAL ? "modal" : "mhb");
  free(written);
  free(keys);
}
