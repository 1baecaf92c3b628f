#include "postproc/study/study_publish.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "postproc/study/study_csv.h"
#include "postproc/study/study_file.h"
#include "postproc/study/study_findings.h"
#include "postproc/study/study_page.h"
#include "postproc/study/study_picture.h"

static const char suffix[] = ".study.h5";

bool study_publish_takes(const char *path) {
  size_t n = strlen(path), m = strlen(suffix);
  return n >= m && strcmp(path + n - m, suffix) == 0;
}

/* The path with another ending than h5, malloc'ed; NULL: no memory. */
static char *beside(const char *path, const char *ending) {
  size_t stem = strlen(path) - strlen("h5"), size = stem + strlen(ending) + 1;
  char  *name = malloc(size);
  if (name) snprintf(name, size, "%.*s%s", (int)stem, path, ending);
  return name;
}

static shb_status publish(const post_buffer *text, const char *path, const char *ending) {
  char *name = beside(path, ending);
  SHB_CHECK(name, SHB_ERR_IO, "no memory for the report of %s", path);
  shb_status status = post_buffer_publish(text, name);
  free(name);
  return status;
}

static shb_status publish_all(const design_study *s, const char *path, post_buffer text[3]) {
  study_csv(s, &text[0]);
  SHB_TRY(publish(&text[0], path, "csv"));
  shb_status status = study_picture(s, &text[1]);
  if (status == SHB_OK) status = publish(&text[1], path, "svg");
  if (status != SHB_OK && status != SHB_ERR_INPUT) return status;
  SHB_TRY(study_page(s, &text[2]));
  return publish(&text[2], path, "html");
}

shb_status study_publish(const design_study *s, const char *path) {
  SHB_CHECK(study_publish_takes(path), SHB_ERR_INPUT, "%s: a study file ends in %s", path, suffix);
  post_buffer text[3] = {0};
  shb_status  status  = publish_all(s, path, text);
  for (int i = 0; i < 3; i++) post_buffer_free(&text[i]);
  return status;
}

shb_status study_publish_file(const char *path, char **summary) {
  design_study study;
  post_buffer  line = {0};
  *summary          = NULL;
  SHB_TRY(study_file_read(path, &study));
  shb_status status = study_publish(&study, path);
  if (status == SHB_OK) {
    char *page = beside(path, "html");
    post_put(&line, "%s: ", page ? page : path);
    study_summary(&study, &line);
    *summary = line.text;
    free(page);
  }
  design_study_free(&study);
  return status;
}
