#include "postproc/field/contact_grid.h"

#include <stdlib.h>

#include "postproc/field/vtk_file.h"

enum { QUADRATIC_TRIANGLE = 22, QUADRATIC_QUADRANGLE = 23 }; /* VTK's; our order of nodes is its */

typedef struct {
  const post_contact_face *face;
  const post_contact_maps *maps;
  int                      row, branch;
  double                   frequency;
  const shb_provenance    *provenance;
} job;

static shb_status put_cells(hid_t group, const post_contact_face *f) {
  const int      each = mesh_topology_of(f->kind)->face_nodes, n = f->n_elements;
  const size_t   ids    = (size_t)n * (size_t)each;
  long long     *node   = malloc((ids + 1) * sizeof *node);
  long long     *offset = malloc(((size_t)n + 1) * sizeof *offset);
  unsigned char *type   = malloc((size_t)n + 1);
  shb_status     status = post_vtk_failed("Connectivity");
  if (node && offset && type) {
    for (size_t i = 0; i < ids; i++) node[i] = f->element[i];
    for (int e = 0; e <= n; e++) offset[e] = (long long)e * each;
    for (int e = 0; e < n; e++)
      type[e] = f->kind == MESH_TET10 ? QUADRATIC_TRIANGLE : QUADRATIC_QUADRANGLE;
    status = post_vtk_array(group, "Connectivity", H5T_NATIVE_LLONG, ids, 0, node);
    if (status == SHB_OK)
      status = post_vtk_array(group, "Offsets", H5T_NATIVE_LLONG, (hsize_t)n + 1, 0, offset);
    if (status == SHB_OK)
      status = post_vtk_array(group, "Types", H5T_NATIVE_UCHAR, (hsize_t)n, 0, type);
    if (status == SHB_OK) status = post_vtk_count(group, "NumberOfConnectivityIds", (long long)ids);
  }
  free(node);
  free(offset);
  free(type);
  return status;
}

static shb_status put_map(hid_t group, const char *name, const job *j, const double *map) {
  const size_t n = (size_t)j->face->n_nodes;
  return post_vtk_array(group, name, H5T_NATIVE_DOUBLE, n, 0, map + (size_t)j->row * n);
}

static shb_status put_states(hid_t group, const job *j) {
  static const char *const name[POST_STATES] = {"PointData/stuck", "PointData/slipping",
                                                "PointData/open"};
  const size_t             n                 = (size_t)j->face->n_nodes;
  const double            *state             = j->maps->state + POST_STATES * (size_t)j->row * n;
  double                  *one               = malloc(n * sizeof *one);
  shb_status               status            = one ? SHB_OK : post_vtk_failed(name[0]);
  for (int s = 0; s < POST_STATES && status == SHB_OK; s++) {
    for (size_t i = 0; i < n; i++) one[i] = state[POST_STATES * i + (size_t)s];
    status = post_vtk_array(group, name[s], H5T_NATIVE_DOUBLE, n, 0, one);
  }
  free(one);
  return status;
}

static shb_status put_all(hid_t group, const job *j) {
  static const char *const text[][3] = {
      {"Points", "m", "nodes of the right contact face, mesh axes"},
      {"NumberOfPoints", "-", "nodes"},
      {"NumberOfCells", "-", "elements"},
      {"NumberOfConnectivityIds", "-", "entries of Connectivity"},
      {"Connectivity", "-", "nodes of each quadratic face, from 0, VTK order"},
      {"Offsets", "-", "start of each face in Connectivity"},
      {"Types", "-", "VTK cell types"},
      {"PointData/pressure", "Pa", "mean pressure over the period"},
      {"PointData/slip", "m", "way slipped in a period, both senses"},
      {"PointData/dissipation", "J m^-2", "energy lost by friction in a period, by area"},
      {"PointData/stuck", "-", "share of the period"},
      {"PointData/slipping", "-", "share of the period"},
      {"PointData/open", "-", "share of the period"},
  };
  const post_contact_face *f = j->face;
  SHB_TRY(post_vtk_header(group, 1, 0));
  SHB_TRY(post_vtk_count(group, "NumberOfPoints", f->n_nodes));
  SHB_TRY(post_vtk_count(group, "NumberOfCells", f->n_elements));
  SHB_TRY(post_vtk_array(group, "Points", H5T_NATIVE_DOUBLE, (hsize_t)f->n_nodes, 3, f->node));
  SHB_TRY(put_cells(group, f));
  SHB_TRY(put_map(group, "PointData/pressure", j, j->maps->pressure));
  SHB_TRY(put_map(group, "PointData/slip", j, j->maps->slip));
  SHB_TRY(put_map(group, "PointData/dissipation", j, j->maps->dissipation));
  SHB_TRY(put_states(group, j));
  return post_vtk_describe(group, sizeof text / sizeof *text, text);
}

static shb_status fill(hid_t file, const void *context) {
  const job *j = context;
  SHB_TRY(h5_write_provenance(file, "shroudhb contact face", 1, j->provenance));
  SHB_TRY(h5_write_attribute_int(file, "/", "branch", j->branch));
  SHB_TRY(h5_write_attribute_int(file, "/", "point", j->maps->point[j->row]));
  SHB_TRY(h5_write_attribute_double(file, "/", "frequency", j->frequency));
  hid_t group = H5Gcreate2(file, "VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (group < 0) return post_vtk_failed("");
  shb_status status = put_all(group, j);
  H5Gclose(group);
  return status;
}

shb_status post_contact_grid(const post_contact_face *face, const post_contact_maps *maps, int row,
                             int branch, double frequency, const shb_provenance *provenance,
                             const char *path) {
  const job j = {face, maps, row, branch, frequency, provenance};
  return h5_publish(path, fill, &j);
}
