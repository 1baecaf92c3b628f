#include <stdio.h>

#include "modal/hdf5/h5_internal.h"

/* The first object whose content lies outside the file. */
typedef struct {
  char        path[H5_LABEL];
  const char *kind; /* NULL: none was found */
} outside;

static int found(outside *out, const char *path, const char *kind) {
  snprintf(out->path, sizeof out->path, "/%s", path);
  out->kind = kind;
  return 1; /* ends the visit */
}

/* A link that is not of the file itself is not followed here. */
static herr_t check_link(hid_t root, const char *name, const H5L_info_t *info, void *out) {
  (void)root;
  if (info->type == H5L_TYPE_HARD || info->type == H5L_TYPE_SOFT) return 0;
  return found(out, name, "is an external link");
}

/* Whether a layout takes values from another file; "." is the file itself, where the modal stage
 * keeps a view of the mode shapes for ParaView. */
static bool is_elsewhere(hid_t creation) {
  size_t maps = 0;
  if (H5Pget_layout(creation) != H5D_VIRTUAL) return false;
  if (H5Pget_virtual_count(creation, &maps) < 0) return true;
  for (size_t i = 0; i < maps; i++) {
    char name[3] = "";
    if (H5Pget_virtual_filename(creation, i, name, sizeof name) != 1 || name[0] != '.') return true;
  }
  return false;
}

/* Opening a dataset opens none of the files that its values lie in. */
static herr_t check_object(hid_t root, const char *name, const H5O_info_t *info, void *out) {
  if (info->type != H5O_TYPE_DATASET) return 0;
  const hid_t set       = H5Dopen2(root, name, H5P_DEFAULT);
  const hid_t creation  = set >= 0 ? H5Dget_create_plist(set) : -1;
  const int   files     = creation >= 0 ? H5Pget_external_count(creation) : -1;
  const bool  elsewhere = creation >= 0 && is_elsewhere(creation);
  if (creation >= 0) H5Pclose(creation);
  if (set >= 0) H5Dclose(set);
  if (elsewhere) return found(out, name, "is a virtual dataset");
  if (files > 0) return found(out, name, "has external storage");
  return files < 0 ? -1 : 0;
}

shb_status h5_check_content(const char *path, hid_t file) {
  char    reason[H5_LABEL];
  outside out  = {.kind = NULL};
  herr_t  ends = H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, check_link, &out);
  if (ends == 0)
    ends = H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_NATIVE, check_object, &out, H5O_INFO_BASIC);
  if (ends < 0) h5_reason(reason, sizeof reason);
  SHB_CHECK(ends >= 0, SHB_ERR_INPUT, "%s: is damaged (%s); write or copy it again", path, reason);
  SHB_CHECK(!out.kind, SHB_ERR_INPUT,
            "%s: %s %s: its content lies in another file, which no checksum covers; copy the "
            "values into this file",
            path, out.path, out.kind);
  return SHB_OK;
}
