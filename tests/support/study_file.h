/* A study file beside a complete case in the scratch folder. */
#ifndef TESTS_SUPPORT_STUDY_FILE_H
#define TESTS_SUPPORT_STUDY_FILE_H

#include "cases/designs/study_spec.h"
#include "tests/support/check.h"
#include "tests/support/scratch.h"

/* Of the test program; made and removed by set-up and tear-down of the group. */
static char study_folder[SCRATCH_PATH];

static inline int study_folder_make(void **state) {
  (void)state;
  scratch_create(study_folder);
  char *text = scratch_case(NULL, NULL);
  scratch_write(study_folder, "case.yaml", text, strlen(text));
  free(text);
  return 0;
}

static inline int study_folder_remove(void **state) {
  (void)state;
  scratch_remove(study_folder);
  return 0;
}

/* Read the text as study.yaml, whose first line names the case. fault: part of the only messages;
 * NULL: the study is right. Free the spec in any case. */
static inline void study_file_read(const char *text, const char *fault, study_spec *spec) {
  char   all[4096], path[SCRATCH_PATH + 16], *messages = NULL;
  size_t size = 0;
  snprintf(all, sizeof all, "case: case.yaml\n%s", text);
  scratch_write(study_folder, "study.yaml", all, strlen(all));
  snprintf(path, sizeof path, "%s/study.yaml", study_folder);
  FILE            *errors = open_memstream(&messages, &size);
  const shb_status status = study_spec_read(path, true, errors, spec);
  fclose(errors);
  if (!fault && status != SHB_OK) fail_msg("refused: %s%s", messages, shb_message());
  if (fault) {
    assert_int_equal(status, SHB_ERR_INPUT);
    assert_has(messages, fault);
  }
  free(messages);
}

#endif
