/* VTKHDF group of the modal file, by HDF5 calls: the format prescribes types that h5.h does not
 * write. */
#include <hdf5.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "modal/stage/model_export.h"

static shb_status failed(const char *what) {
  SHB_FAIL(SHB_ERR_IO, "VTKHDF/%s cannot be written", what);
}

static shb_status write_array(hid_t group, const char *name, hid_t type, hsize_t n,
                              const void *data) {
  hid_t  space = H5Screate_simple(1, &n, NULL);
  hid_t  set   = H5Dcreate2(group, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  herr_t error = set < 0 ? -1 : H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
  if (set >= 0) H5Dclose(set);
  H5Sclose(space);
  return error < 0 ? failed(name) : SHB_OK;
}

static shb_status write_count(hid_t group, const char *name, long long count) {
  return write_array(group, name, H5T_NATIVE_LLONG, 1, &count);
}

/* Version 1.0; Type must be a string of fixed length, ASCII. */
static shb_status write_header(hid_t group) {
  static const char kind[]     = "UnstructuredGrid";
  const long long   version[2] = {1, 0};
  hsize_t           two        = 2;
  hid_t             space = H5Screate_simple(1, &two, NULL), scalar = H5Screate(H5S_SCALAR);
  hid_t             text = H5Tcopy(H5T_C_S1);
  H5Tset_size(text, sizeof kind - 1);
  H5Tset_strpad(text, H5T_STR_NULLPAD);
  hid_t  number = H5Acreate2(group, "Version", H5T_NATIVE_LLONG, space, H5P_DEFAULT, H5P_DEFAULT);
  hid_t  type   = H5Acreate2(group, "Type", text, scalar, H5P_DEFAULT, H5P_DEFAULT);
  herr_t error  = number < 0 || type < 0 || H5Awrite(number, H5T_NATIVE_LLONG, version) < 0 ||
                 H5Awrite(type, text, kind) < 0;
  if (number >= 0) H5Aclose(number);
  if (type >= 0) H5Aclose(type);
  H5Tclose(text);
  H5Sclose(space);
  H5Sclose(scalar);
  return error ? failed("Version") : SHB_OK;
}

static shb_status write_cells(hid_t group, const mesh_fe *mesh) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  const size_t         n = (size_t)mesh->n_elements, each = (size_t)topology->nodes;
  long long           *connectivity = shb_alloc(each * n, sizeof *connectivity);
  long long           *offset       = shb_alloc(n + 1, sizeof *offset);
  unsigned char       *type         = shb_alloc(n + 1, 1);
  for (size_t e = 0; e <= n; e++) {
    offset[e] = (long long)each * (long long)e;
    if (e == n) break;
    type[e] = (unsigned char)topology->vtk;
    for (size_t i = 0; i < each; i++)
      connectivity[each * e + i] = mesh->connectivity[each * e + (size_t)topology->vtk_order[i]];
  }
  shb_status status = write_array(group, "Connectivity", H5T_NATIVE_LLONG, each * n, connectivity);
  if (status == SHB_OK) status = write_array(group, "Offsets", H5T_NATIVE_LLONG, n + 1, offset);
  if (status == SHB_OK) status = write_array(group, "Types", H5T_NATIVE_UCHAR, n, type);
  free(connectivity);
  free(offset);
  free(type);
  return status;
}

/* View of /modes/shape[mode] in the same file as [n][3], without a copy of the data. */
static shb_status write_view(hid_t data, int mode, double frequency, hsize_t n_modes,
                             hsize_t n_nodes) {
  char    name[MODAL_VTK_NAME];
  hsize_t view[2] = {n_nodes, 3}, source[3] = {n_modes, n_nodes, 3};
  hsize_t start[3] = {(hsize_t)mode, 0, 0}, count[3] = {1, n_nodes, 3};
  hid_t   to = H5Screate_simple(2, view, NULL), from = H5Screate_simple(3, source, NULL);
  hid_t   layout = H5Pcreate(H5P_DATASET_CREATE), set = -1;
  modal_vtk_name(mode, frequency, name);
  if (H5Sselect_hyperslab(from, H5S_SELECT_SET, start, NULL, count, NULL) >= 0 &&
      H5Pset_virtual(layout, to, ".", "/modes/shape", from) >= 0)
    set = H5Dcreate2(data, name, H5T_NATIVE_DOUBLE, to, H5P_DEFAULT, layout, H5P_DEFAULT);
  shb_status status = set < 0 ? failed(name) : SHB_OK;
  if (set >= 0) H5Dclose(set);
  H5Pclose(layout);
  H5Sclose(from);
  H5Sclose(to);
  return status;
}

static shb_status write_point_data(hid_t file, int n_modes, const double *frequency, int n_nodes) {
  /* views need the format of HDF5 1.10; files otherwise have that of 1.8 */
  if (H5Fset_libver_bounds(file, H5F_LIBVER_V18, H5F_LIBVER_LATEST) < 0) return failed("PointData");
  hid_t data = H5Gcreate2(file, "VTKHDF/PointData", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (data < 0) return failed("PointData");
  shb_status status = SHB_OK;
  for (int i = 0; status == SHB_OK && i < n_modes; i++)
    status = write_view(data, i, frequency[i], (hsize_t)n_modes, (hsize_t)n_nodes);
  H5Gclose(data);
  return status;
}

/* Link the static deflection and stresses, if the file holds them. */
static shb_status write_static(hid_t file, hid_t group) {
  static const char *const link[][2] = {
      {"/static/displacement", "PointData/static_displacement"},
      {"/static/nodal_stress", "PointData/static_stress"},
      {"/static/nodal_von_mises", "PointData/static_von_mises"},
      {"/static/stress", "CellData/static_von_mises"},
  };
  if (!h5_exists(file, "/static/displacement")) return SHB_OK;
  hid_t data = H5Gcreate2(group, "CellData", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (data < 0) return failed("CellData");
  H5Gclose(data);
  for (size_t i = 0; i < sizeof link / sizeof *link; i++)
    if (h5_exists(file, link[i][0]) &&
        H5Lcreate_soft(link[i][0], group, link[i][1], H5P_DEFAULT, H5P_DEFAULT) < 0)
      return failed(link[i][1]);
  return SHB_OK;
}

static shb_status describe_one(hid_t group, const char *path, const char *units,
                               const char *long_name) {
  SHB_TRY(h5_write_attribute_text(group, path, "units", units));
  return h5_write_attribute_text(group, path, "long_name", long_name);
}

/* Describe the datasets. Points is a link: /mesh/nodes has its own attributes. */
static shb_status describe(hid_t group, int n_modes, const double *frequency) {
  static const char *const text[][2] = {
      {"NumberOfPoints", "nodes"},
      {"NumberOfCells", "elements"},
      {"NumberOfConnectivityIds", "entries of Connectivity"},
      {"Connectivity", "nodes of each quadratic cell, from 0, VTK order"},
      {"Offsets", "start of each element in Connectivity"},
      {"Types", "VTK cell types"},
  };
  for (size_t i = 0; i < sizeof text / sizeof *text; i++)
    SHB_TRY(describe_one(group, text[i][0], "-", text[i][1]));
  for (int i = 0; i < n_modes; i++) {
    char path[MODAL_VTK_NAME + 16] = "PointData/";
    modal_vtk_name(i, frequency[i], path + strlen(path));
    SHB_TRY(describe_one(group, path, "kg^-1/2", "mode shape, a view of /modes/shape"));
  }
  return SHB_OK;
}

static shb_status write_group(hid_t group, const mesh_fe *mesh) {
  SHB_TRY(write_header(group));
  SHB_TRY(write_count(group, "NumberOfPoints", mesh->n_nodes));
  SHB_TRY(write_count(group, "NumberOfCells", mesh->n_elements));
  SHB_TRY(write_count(group, "NumberOfConnectivityIds",
                      (long long)mesh_topology_of(mesh->kind)->nodes * mesh->n_elements));
  if (H5Lcreate_soft("/mesh/nodes", group, "Points", H5P_DEFAULT, H5P_DEFAULT) < 0)
    return failed("Points");
  return write_cells(group, mesh);
}

void modal_vtk_name(int mode, double frequency, char name[MODAL_VTK_NAME]) {
  snprintf(name, MODAL_VTK_NAME, "mode_%03d %.6g Hz", mode + 1, frequency);
}

shb_status modal_export_vtk(hid_t file, const mesh_fe *mesh, int n_modes, const double *frequency) {
  hid_t group = H5Gcreate2(file, "VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (group < 0) return failed("");
  shb_status status = write_group(group, mesh);
  if (status == SHB_OK) status = write_point_data(file, n_modes, frequency, mesh->n_nodes);
  if (status == SHB_OK) status = write_static(file, group);
  if (status == SHB_OK) status = describe(group, n_modes, frequency);
  H5Gclose(group);
  return status;
}
