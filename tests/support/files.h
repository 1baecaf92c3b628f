/* For tests of files: a scratch folder, a check of every dataset's attributes, small file tools. */
#ifndef TESTS_SUPPORT_FILES_H
#define TESTS_SUPPORT_FILES_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "modal/hdf5/h5.h"
#include "tests/support/check.h"
#include "tests/support/scratch_folder.h"

static inline char *slurp(const char *path, size_t *size) {
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  fseek(file, 0, SEEK_END);
  *size      = (size_t)ftell(file);
  char *data = malloc(*size + 1);
  assert_non_null(data);
  rewind(file);
  assert_int_equal(fread(data, 1, *size, file), *size);
  fclose(file);
  return data;
}

static inline void spill(const char *path, const void *data, size_t size) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(data, 1, size, file), size);
  assert_int_equal(fclose(file), 0);
}

static inline int files_in_scratch(void) {
  char command[300];
  snprintf(command, sizeof command, "ls -A '%s' | wc -l", scratch_folder);
  FILE *pipe  = popen(command, "r");
  int   count = -1;
  assert_non_null(pipe);
  assert_int_equal(fscanf(pipe, "%d", &count), 1);
  pclose(pipe);
  return count;
}

static inline herr_t check_described(hid_t at, const char *name, const H5O_info_t *info,
                                     void *count) {
  if (info->type != H5O_TYPE_DATASET) return 0;
  for (int i = 0; i < 2; i++) {
    const char *attribute = i ? "long_name" : "units";
    char       *text      = NULL;
    assert_ok(h5_read_attribute_text(at, name, attribute, &text));
    if (!text || !*text) fail_msg("dataset %s has no attribute %s", name, attribute);
    free(text);
  }
  ++*(int *)count;
  return 0;
}

/* Every dataset has units and long_name; returns their number. */
static inline int assert_described(const char *path) {
  hid_t file;
  int   count = 0;
  assert_ok(h5_open(path, &file));
  assert_true(H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, check_described, &count) >= 0);
  assert_ok(h5_close(file));
  return count;
}

/* The reader must refuse every proper prefix of the file at path, with a message. */
static inline void assert_prefixes_refused(const char *path, size_t step,
                                           shb_status (*reader)(const char *)) {
  size_t      size;
  char       *data   = slurp(path, &size);
  const char *short_ = scratch("prefix.h5");
  for (size_t n = size - 1;; n = n > step ? n - step : 0) {
    spill(short_, data, n);
    shb_status status = reader(short_);
    if (status != SHB_ERR_IO) fail_msg("%zu of %zu bytes: status %d", n, size, (int)status);
    const char *text = shb_message();
    if (!strstr(text, "truncated") && !strstr(text, "not an HDF5 file"))
      fail_msg("%zu of %zu bytes: \"%s\"", n, size, text);
    if (n == 0) break;
  }
  free(data);
  unlink(short_);
}

#endif
