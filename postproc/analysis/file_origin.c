#include "postproc/analysis/file_origin.h"

#include <stdlib.h>
#include <string.h>

#include "modal/hdf5/h5.h"

static shb_status read_text(hid_t file, const char *name, char **text) {
  SHB_TRY(h5_read_attribute_text(file, "/", name, text));
  if (!*text) *text = strdup("");
  SHB_CHECK(*text, SHB_ERR_IO, "not enough memory");
  return SHB_OK;
}

static shb_status read_all(hid_t file, post_origin *source) {
  SHB_TRY(read_text(file, "format", &source->format));
  SHB_TRY(read_text(file, "revision", &source->revision));
  SHB_TRY(read_text(file, "command", &source->command));
  SHB_TRY(read_text(file, "created", &source->created));
  SHB_TRY(read_text(file, "case_path", &source->case_path));
  SHB_TRY(read_text(file, "case_text", &source->case_text));
  SHB_TRY(read_text(file, "settings", &source->settings));
  return h5_read_attribute_int(file, "/", "format_version", 0, &source->version);
}

shb_status post_origin_read(hid_t file, post_origin *source) {
  *source           = (post_origin){0};
  shb_status status = read_all(file, source);
  if (status != SHB_OK) post_origin_free(source);
  return status;
}

shb_status post_origin_open(const char *path, post_origin *source) {
  hid_t file;
  SHB_TRY(h5_open(path, &file));
  shb_status status = post_origin_read(file, source);
  if (H5Fclose(file) < 0 && status == SHB_OK) {
    post_origin_free(source);
    SHB_FAIL(SHB_ERR_IO, "%s: cannot be closed after reading", path);
  }
  return status;
}

void post_origin_free(post_origin *source) {
  free(source->format);
  free(source->revision);
  free(source->command);
  free(source->created);
  free(source->case_path);
  free(source->case_text);
  free(source->settings);
  *source = (post_origin){0};
}
