#include "modal/stage/sector_export.h"

#include <stdio.h>
#include <stdlib.h>

#include "mesh/base/memory.h"
#include "modal/stage/model_export.h"

static const char shape_text[] =
    "mass-normalised mode shapes at every node of the sector, mesh axes (x, y, z); sector b moves "
    "as exp(-2 pi j n b/N) times them, turned by b sectors";

static shb_status write_check(hid_t at, const modal_check *check) {
  SHB_TRY(h5_write_attribute_text(at, "modes", "checked", check->method));
  SHB_TRY(h5_write_attribute_int(at, "modes", "checked_count", check->count));
  SHB_TRY(h5_write_attribute_double(at, "modes", "checked_below", modal_check_frequency(check)));
  return h5_write_attribute_double(at, "modes", "missed_chance", check->probability);
}

/* Shapes whose imaginary parts vanish are written as real ones. */
static shb_status write_shape(hid_t at, int n_nodes, bool is_real, const wave_fields *f) {
  const h5_shape size  = H5_SHAPE((hsize_t)f->n_modes, (hsize_t)n_nodes, 3);
  const size_t   count = 3 * (size_t)f->n_modes * (size_t)n_nodes;
  if (!is_real) return h5_write_complex(at, "modes/shape", size, f->shape, "kg^-1/2", shape_text);
  double *real = shb_alloc(count, sizeof *real);
  for (size_t i = 0; i < count; i++) real[i] = creal(f->shape[i]);
  shb_status status = h5_write_double(at, "modes/shape", size, real, "kg^-1/2", shape_text);
  free(real);
  return status;
}

/* A dataset in single precision, [rows][n_nodes][width]. */
typedef struct {
  const char          *path, *units, *text;
  int                  rows, width;
  const float complex *value;
} single_field;

static shb_status write_single(hid_t at, int n_nodes, bool is_real, const single_field *f) {
  const h5_shape size  = H5_SHAPE((hsize_t)f->rows, (hsize_t)n_nodes, (hsize_t)f->width);
  const size_t   count = (size_t)h5_count(size);
  if (!is_real) return h5_write_complex_single(at, f->path, size, f->value, f->units, f->text);
  float *real = shb_alloc(count, sizeof *real);
  for (size_t i = 0; i < count; i++) real[i] = crealf(f->value[i]);
  shb_status status = h5_write_single(at, f->path, size, real, f->units, f->text);
  free(real);
  return status;
}

static shb_status write_fields(hid_t at, int n_nodes, bool is_real,
                               const modal_residual_shapes *first, const wave_fields *f) {
  const int          m = f->n_modes, c = f->n_columns;
  const single_field stress   = {"modes/stress",
                                 "Pa kg^-1/2",
                                 "Cauchy stress of the modes at the nodes: xx, yy, zz, xy, yz, "
                                   "xz in mesh axes; to be multiplied by modal amplitudes",
                                 m,
                                 6,
                                 f->stress};
  const single_field column[] = {
      {"residual/shape", "m/N",
       "static displacement by a unit force on each contact dof, then by each load pattern, modes "
       "removed, mesh axes (x, y, z)",
       c, 3, f->residual},
      {"residual/stress", "Pa/N", "Cauchy stress of the same: xx, yy, zz, xy, yz, xz in mesh axes",
       c, 6, f->residual_stress}};
  SHB_TRY(write_shape(at, n_nodes, is_real, f));
  SHB_TRY(write_single(at, n_nodes, is_real, &stress));
  if (c == 0) return SHB_OK;
  for (int i = 0; i < 2; i++) SHB_TRY(write_single(at, n_nodes, is_real, &column[i]));
  return modal_residual_weight_write(at, first);
}

static shb_status write_first(hid_t at, const mesh_fe *mesh, const modal_result *first,
                              const modal_fields *of) {
  const int m = first->model.n_modes;
  SHB_TRY(h5_write_double(at, "modes/shape", H5_SHAPE((hsize_t)m, (hsize_t)mesh->n_nodes, 3),
                          of->shape, "kg^-1/2", shape_text));
  SHB_TRY(modal_export_stress(at, m, mesh->n_nodes, of->stress));
  SHB_TRY(modal_residual_shapes_write(at, &first->residual, of->residual_stress));
  return modal_export_contact(at, &first->patches);
}

static shb_status write_group(hid_t at, int i, const mesh_fe *mesh, const modal_result *first,
                              const modal_fields *of, const modal_sector *sector) {
  const modal_nodal_diameters *all     = &sector->models;
  const bool                   is_real = 2 * all->diameter[i] == all->blades;
  SHB_TRY(write_check(at, &sector->check[i]));
  SHB_TRY(modal_export_turning(at, first->coriolis));
  if (i == 0) {
    SHB_TRY(write_first(at, mesh, first, of));
  } else {
    SHB_TRY(write_fields(at, mesh->n_nodes, is_real, &first->residual, &sector->fields[i]));
    SHB_TRY(h5_attach_scale(at, "modes/stress", 0, "modes/frequency"));
  }
  return h5_attach_scale(at, "modes/shape", 0, "modes/frequency");
}

shb_status modal_sector_write(hid_t file, const mesh_fe *mesh, const modal_result *first,
                              const modal_fields *of, const modal_sector *sector,
                              const shb_provenance *provenance) {
  const modal_nodal_diameters *all = &sector->models;
  SHB_TRY(h5_write_provenance(file, "shroudhb modal model", MODAL_DIAMETERS_VERSION, provenance));
  SHB_TRY(modal_nodal_diameters_write(file, all));
  SHB_TRY(modal_export_mesh(file, mesh));
  for (int i = 0; i < all->n; i++) {
    char name[32];
    snprintf(name, sizeof name, "/nodal_diameter_%d", all->diameter[i]);
    hid_t group = H5Gopen2(file, name, H5P_DEFAULT);
    SHB_CHECK(group >= 0, SHB_ERR_IO, "%s cannot be written", name);
    shb_status status = write_group(group, i, mesh, first, of, sector);
    H5Gclose(group);
    SHB_TRY(status);
  }
  SHB_TRY(modal_sector_speeds_write(file, &sector->speeds));
  return modal_deflection_write(file, &first->deflection, mesh->n_nodes, mesh->n_elements,
                                &first->model);
}
