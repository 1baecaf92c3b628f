#include "postproc/field/field_grid.h"

#include <hdf5.h>
#include <stdlib.h>
#include <string.h>

#include "modal/hdf5/h5.h"
#include "postproc/field/peak_stress.h"
#include "postproc/field/vtk_file.h"

static const double MOST_BYTES = 2e9;

typedef struct {
  const post_period    *period;
  int                   steps, copies; /* copies: blades in the file */
  const shb_provenance *provenance;
  hid_t                 group; /* VTKHDF */
  double               *displacement, *stress, *mises;
} writer;

/* Rows from start on; HDF5 converts the type of memory to that of the file. */
static herr_t put_rows(hid_t set, hid_t memory, hsize_t start, hsize_t rows, hsize_t columns,
                       const void *data) {
  const hsize_t at[2] = {start, 0}, count[2] = {rows, columns};
  const int     rank = columns ? 2 : 1;
  hid_t         file = H5Dget_space(set), space = H5Screate_simple(rank, count, NULL);
  herr_t        error = H5Sselect_hyperslab(file, H5S_SELECT_SET, at, NULL, count, NULL);
  if (error >= 0) error = H5Dwrite(set, memory, space, file, H5P_DEFAULT, data);
  H5Sclose(space);
  H5Sclose(file);
  return error;
}

typedef struct {
  long long     *connectivity, *offset;
  unsigned char *type;
  int           *blade;
} cells;

static void set_cells(const writer *w, const cells *c) {
  const mesh_fe       *mesh     = &w->period->field->mesh;
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  const size_t         n = (size_t)mesh->n_elements, each = (size_t)topology->nodes;
  c->offset[0] = 0;
  for (size_t e = 0; e < n * (size_t)w->copies; e++) {
    const size_t     copy = e / n;
    const int *const node = mesh->connectivity + each * (e % n);
    c->offset[e + 1]      = (long long)each * (long long)(e + 1);
    c->type[e]            = (unsigned char)topology->vtk;
    c->blade[e]           = (int)copy;
    for (size_t i = 0; i < each; i++)
      c->connectivity[each * e + i] =
          node[topology->vtk_order[i]] + (long long)copy * mesh->n_nodes;
  }
}

static shb_status put_cell_arrays(const writer *w, const cells *c, hsize_t n, hsize_t each) {
  SHB_TRY(post_vtk_array(w->group, "Connectivity", H5T_NATIVE_LLONG, n * each, 0, c->connectivity));
  SHB_TRY(post_vtk_array(w->group, "Offsets", H5T_NATIVE_LLONG, n + 1, 0, c->offset));
  SHB_TRY(post_vtk_array(w->group, "Types", H5T_NATIVE_UCHAR, n, 0, c->type));
  if (w->copies == 1) return SHB_OK;
  return post_vtk_array(w->group, "CellData/blade", H5T_NATIVE_INT, n, 0, c->blade);
}

static shb_status put_cells(const writer *w) {
  const mesh_fe *mesh = &w->period->field->mesh;
  const size_t   each = (size_t)mesh_topology_of(mesh->kind)->nodes;
  const size_t   n    = (size_t)mesh->n_elements * (size_t)w->copies;
  const cells    c    = {malloc((each * n + 1) * sizeof *c.connectivity),
                         malloc((n + 1) * sizeof *c.offset), malloc(n + 1),
                         malloc((n + 1) * sizeof *c.blade)};
  shb_status     status;
  if (c.connectivity && c.offset && c.type && c.blade) {
    set_cells(w, &c);
    status = put_cell_arrays(w, &c, n, each);
  } else {
    status = post_vtk_failed("Connectivity");
  }
  free(c.connectivity);
  free(c.offset);
  free(c.type);
  free(c.blade);
  return status;
}

/* The same vectors or stresses of every blade, turned; once for all steps. */
static shb_status put_turned(const writer *w, const char *name, int columns, const double *blade0) {
  const size_t n   = (size_t)w->period->field->n_nodes;
  double      *own = columns == 3 ? w->displacement : w->stress;
  hid_t        set =
      post_vtk_dataset(w->group, name, H5T_NATIVE_DOUBLE, n * (size_t)w->copies, (hsize_t)columns);
  herr_t error = set < 0 ? -1 : 0;
  for (int b = 0; b < w->copies && error >= 0; b++) {
    memcpy(own, blade0, n * (size_t)columns * sizeof *own);
    if (columns == 3) {
      post_period_turn_vectors(w->period, b, (int)n, own);
    } else {
      post_period_turn_stresses(w->period, b, (int)n, own);
    }
    error = put_rows(set, H5T_NATIVE_DOUBLE, n * (hsize_t)b, n, (hsize_t)columns, own);
  }
  if (set >= 0) H5Dclose(set);
  return error < 0 ? post_vtk_failed(name) : SHB_OK;
}

static shb_status put_mesh(const writer *w) {
  const post_blade_field *f        = w->period->field;
  const long long         elements = (long long)f->mesh.n_elements * w->copies;
  SHB_TRY(post_vtk_header(w->group, 2, 0));
  SHB_TRY(post_vtk_count(w->group, "NumberOfPoints", (long long)f->n_nodes * w->copies));
  SHB_TRY(post_vtk_count(w->group, "NumberOfCells", elements));
  SHB_TRY(post_vtk_count(w->group, "NumberOfConnectivityIds",
                         elements * mesh_topology_of(f->mesh.kind)->nodes));
  SHB_TRY(put_turned(w, "Points", 3, f->nodes));
  SHB_TRY(put_cells(w));
  if (f->static_displacement)
    SHB_TRY(put_turned(w, "PointData/static_displacement", 3, f->static_displacement));
  if (!f->static_stress) return SHB_OK;
  return put_turned(w, "PointData/static_stress", POST_STRESSES, f->static_stress);
}

/* Where a step begins in each array: at 0 in those of the mesh. */
static shb_status put_offsets(const writer *w, hid_t steps, double *value, long long *at) {
  static const char *const fixed[]  = {"PartOffsets", "PointOffsets"};
  static const char *const cell[]   = {"CellOffsets", "ConnectivityIdOffsets"};
  static const char *const once[]   = {"static_displacement", "static_stress"};
  static const char *const moving[] = {"displacement", "stress", "von_mises"};
  const post_blade_field  *f        = w->period->field;
  const hsize_t            n        = (hsize_t)w->steps;
  char                     name[64];
  for (int i = 0; i < w->steps; i++) value[i] = post_period_seconds(w->period) * i / w->steps;
  SHB_TRY(post_vtk_array(steps, "Values", H5T_NATIVE_DOUBLE, n, 0, value));
  for (int i = 0; i < w->steps; i++) at[i] = 0;
  for (int i = 0; i < 2; i++) {
    SHB_TRY(post_vtk_array(steps, fixed[i], H5T_NATIVE_LLONG, n, 0, at));
    SHB_TRY(post_vtk_array(steps, cell[i], H5T_NATIVE_LLONG, n, 1, at));
    snprintf(name, sizeof name, "PointDataOffsets/%s", once[i]);
    if (i == 0 ? f->static_displacement : f->static_stress)
      SHB_TRY(post_vtk_array(steps, name, H5T_NATIVE_LLONG, n, 0, at));
  }
  if (w->copies > 1)
    SHB_TRY(post_vtk_array(steps, "CellDataOffsets/blade", H5T_NATIVE_LLONG, n, 0, at));
  for (int i = 0; i < w->steps; i++) at[i] = 1;
  SHB_TRY(post_vtk_array(steps, "NumberOfParts", H5T_NATIVE_LLONG, n, 0, at));
  for (int i = 0; i < w->steps; i++) at[i] = (long long)i * f->n_nodes * w->copies;
  for (int i = 0; i < 3; i++) {
    snprintf(name, sizeof name, "PointDataOffsets/%s", moving[i]);
    if (i != 1 || w->copies == 1) SHB_TRY(post_vtk_array(steps, name, H5T_NATIVE_LLONG, n, 0, at));
  }
  return SHB_OK;
}

static shb_status put_steps(const writer *w) {
  const long long n     = w->steps;
  hid_t           steps = H5Gcreate2(w->group, "Steps", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  double         *value = malloc((size_t)n * sizeof *value);
  long long      *at    = malloc((size_t)n * sizeof *at);
  shb_status      status;
  if (steps >= 0 && value && at) {
    status = post_vtk_attribute(steps, "NSteps", H5T_NATIVE_LLONG, 0, &n);
    if (status == SHB_OK) status = put_offsets(w, steps, value, at);
  } else {
    status = post_vtk_failed("Steps");
  }
  free(value);
  free(at);
  if (steps >= 0) H5Gclose(steps);
  return status;
}

/* Displacement, stress and von Mises stress of a blade at a step; set[1] < 0: without stress. */
static herr_t put_step(const writer *w, int step, int blade, const hid_t set[3]) {
  const size_t  n  = (size_t)w->period->field->n_nodes;
  const hsize_t at = n * ((hsize_t)step * (hsize_t)w->copies + (hsize_t)blade);
  post_period_at(w->period, blade, (double)step / w->steps, w->displacement, w->stress);
  for (size_t i = 0; i < n; i++) w->mises[i] = post_signed_mises(w->stress + POST_STRESSES * i);
  herr_t error = put_rows(set[0], H5T_NATIVE_DOUBLE, at, n, 3, w->displacement);
  if (error >= 0 && set[1] >= 0)
    error = put_rows(set[1], H5T_NATIVE_DOUBLE, at, n, POST_STRESSES, w->stress);
  return error < 0 ? error : put_rows(set[2], H5T_NATIVE_DOUBLE, at, n, 0, w->mises);
}

static shb_status put_motion(const writer *w) {
  const bool    ring = w->copies > 1;
  const hsize_t rows = (hsize_t)w->period->field->n_nodes * (hsize_t)w->copies * (hsize_t)w->steps;
  const hid_t   wide = ring ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE;
  hid_t         set[3] = {-1, -1, -1};
  set[0]               = post_vtk_dataset(w->group, "PointData/displacement", wide, rows, 3);
  set[2] = post_vtk_dataset(w->group, "PointData/von_mises", H5T_NATIVE_FLOAT, rows, 0);
  if (!ring)
    set[1] = post_vtk_dataset(w->group, "PointData/stress", H5T_NATIVE_FLOAT, rows, POST_STRESSES);
  herr_t error = set[0] < 0 || set[2] < 0 || (!ring && set[1] < 0) ? -1 : 0;
  for (int s = 0; s < w->steps; s++)
    for (int b = 0; b < w->copies && error >= 0; b++) error = put_step(w, s, b, set);
  for (int i = 0; i < 3; i++)
    if (set[i] >= 0) H5Dclose(set[i]);
  return error < 0 ? post_vtk_failed("PointData") : SHB_OK;
}

static shb_status describe(const writer *w) {
  static const char *const text[][3] = {
      {"Points", "m", "nodes at rest, mesh axes"},
      {"NumberOfPoints", "-", "nodes"},
      {"NumberOfCells", "-", "elements"},
      {"NumberOfConnectivityIds", "-", "entries of Connectivity"},
      {"Connectivity", "-", "nodes of each quadratic cell, from 0, VTK order"},
      {"Offsets", "-", "start of each element in Connectivity"},
      {"Types", "-", "VTK cell types"},
      {"CellData/blade", "-", "blade of the ring, from 0, each turned to the right of the last"},
      {"Steps/Values", "s", "time within the period"},
      {"PointData/displacement", "m", "displacement of the vibration with its mean, mesh axes"},
      {"PointData/stress", "Pa", "stress of the vibration with its mean: xx, yy, zz, xy, yz, xz"},
      {"PointData/von_mises", "Pa", "its von Mises stress, signed as its leading principal stress"},
      {"PointData/static_displacement", "m", "static displacement at speed, to be added"},
      {"PointData/static_stress", "Pa", "static stress at speed, to be added"},
  };
  return post_vtk_describe(w->group, sizeof text / sizeof *text, text);
}

static shb_status put_all(hid_t file, const writer *w) {
  const post_period *p = w->period;
  SHB_TRY(h5_write_provenance(file, "shroudhb field", 1, w->provenance));
  if (p->mode > 0) {
    SHB_TRY(h5_write_attribute_int(file, "/", "mode", p->mode));
    if (p->diameter >= 0) SHB_TRY(h5_write_attribute_int(file, "/", "nodal_diameter", p->diameter));
  } else {
    SHB_TRY(h5_write_attribute_int(file, "/", "branch", p->branch));
    SHB_TRY(h5_write_attribute_int(file, "/", "point", p->point));
    SHB_TRY(h5_write_attribute_int(file, "/", "order", p->order));
    SHB_TRY(h5_write_attribute_int(file, "/", "engine_order", p->engine_order));
  }
  SHB_TRY(h5_write_attribute_int(file, "/", "blades", p->blades));
  SHB_TRY(h5_write_attribute_double(file, "/", "frequency", p->frequency));
  SHB_TRY(put_mesh(w));
  SHB_TRY(put_steps(w));
  SHB_TRY(put_motion(w));
  return describe(w);
}

static shb_status fill(hid_t file, const void *context) {
  writer       w    = *(const writer *)context;
  const size_t n    = (size_t)w.period->field->n_nodes;
  w.group           = H5Gcreate2(file, "VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  w.displacement    = malloc(3 * n * sizeof(double) + 1);
  w.stress          = malloc(POST_STRESSES * n * sizeof(double) + 1);
  w.mises           = malloc(n * sizeof(double) + 1);
  shb_status status = w.group < 0 || !w.displacement || !w.stress || !w.mises ? post_vtk_failed("")
                                                                              : put_all(file, &w);
  if (w.group >= 0) H5Gclose(w.group);
  free(w.displacement);
  free(w.stress);
  free(w.mises);
  return status;
}

/* Of the moving arrays: double displacement, single stress; of a ring single throughout. */
static double bytes_of(const writer *w) {
  const double each = w->copies > 1 ? 16 : 24 + 4 * POST_STRESSES + 4;
  return each * w->period->field->n_nodes * w->copies * w->steps;
}

shb_status post_field_grid(const post_period *period, int steps, bool ring,
                           const shb_provenance *provenance, const char *path) {
  const writer w = {.period     = period,
                    .steps      = steps,
                    .copies     = ring ? period->blades : 1,
                    .provenance = provenance};
  SHB_CHECK(bytes_of(&w) <= MOST_BYTES, SHB_ERR_INPUT,
            "%s would take %.1f GB for %d steps of %d blades with %d nodes; give fewer --steps",
            path, bytes_of(&w) / 1e9, steps, w.copies, period->field->n_nodes);
  return h5_publish(path, fill, &w);
}
