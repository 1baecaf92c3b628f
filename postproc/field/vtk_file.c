#include "postproc/field/vtk_file.h"

shb_status post_vtk_failed(const char *what) {
  SHB_FAIL(SHB_ERR_IO, "VTKHDF/%s cannot be written", what);
}

hid_t post_vtk_dataset(hid_t at, const char *name, hid_t type, hsize_t rows, hsize_t columns) {
  const hsize_t dim[2] = {rows, columns};
  hid_t         space = H5Screate_simple(columns ? 2 : 1, dim, NULL), set = -1;
  hid_t         links = H5Pcreate(H5P_LINK_CREATE), layout = H5Pcreate(H5P_DATASET_CREATE);
  if (H5Pset_create_intermediate_group(links, 1) >= 0 && H5Pset_obj_track_times(layout, 0) >= 0)
    set = H5Dcreate2(at, name, type, space, links, layout, H5P_DEFAULT);
  H5Pclose(links);
  H5Pclose(layout);
  H5Sclose(space);
  return set;
}

shb_status post_vtk_array(hid_t at, const char *name, hid_t type, hsize_t rows, hsize_t columns,
                          const void *data) {
  hid_t  set   = post_vtk_dataset(at, name, type, rows, columns);
  herr_t error = set < 0 ? -1 : H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
  if (set >= 0) H5Dclose(set);
  return error < 0 ? post_vtk_failed(name) : SHB_OK;
}

shb_status post_vtk_count(hid_t at, const char *name, long long count) {
  return post_vtk_array(at, name, H5T_NATIVE_LLONG, 1, 0, &count);
}

shb_status post_vtk_attribute(hid_t at, const char *name, hid_t type, hsize_t n, const void *data) {
  hid_t  space     = n ? H5Screate_simple(1, &n, NULL) : H5Screate(H5S_SCALAR);
  hid_t  attribute = H5Acreate2(at, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  herr_t error     = attribute < 0 ? -1 : H5Awrite(attribute, type, data);
  if (attribute >= 0) H5Aclose(attribute);
  H5Sclose(space);
  return error < 0 ? post_vtk_failed(name) : SHB_OK;
}

/* Type must be a string of fixed length, ASCII. */
shb_status post_vtk_header(hid_t group, int major, int minor) {
  static const char kind[]     = "UnstructuredGrid";
  const long long   version[2] = {major, minor};
  hid_t             text       = H5Tcopy(H5T_C_S1);
  H5Tset_size(text, sizeof kind - 1);
  H5Tset_strpad(text, H5T_STR_NULLPAD);
  shb_status status = post_vtk_attribute(group, "Version", H5T_NATIVE_LLONG, 2, version);
  if (status == SHB_OK) status = post_vtk_attribute(group, "Type", text, 0, kind);
  H5Tclose(text);
  return status;
}

shb_status post_vtk_describe(hid_t group, int n, const char *const text[][3]) {
  for (int i = 0; i < n; i++) {
    if (!h5_exists(group, text[i][0])) continue;
    SHB_TRY(h5_write_attribute_text(group, text[i][0], "units", text[i][1]));
    SHB_TRY(h5_write_attribute_text(group, text[i][0], "long_name", text[i][2]));
  }
  return SHB_OK;
}
