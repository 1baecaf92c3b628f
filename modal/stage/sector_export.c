#include "modal/stage/sector_export.h"

#include <stdio.h>
#include <stdlib.h>

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
static shb_status write_shape(hid_t at, int modes, int n_nodes, bool is_real,
                              const double complex *shape) {
  const h5_shape size  = H5_SHAPE((hsize_t)modes, (hsize_t)n_nodes, 3);
  const size_t   count = 3 * (size_t)modes * (size_t)n_nodes;
  if (!is_real) return h5_write_complex(at, "modes/shape", size, shape, "kg^-1/2", shape_text);
  double *real = malloc(count * sizeof *real + 1);
  SHB_CHECK(real, SHB_ERR_IO, "out of memory for the mode shapes");
  for (size_t i = 0; i < count; i++) real[i] = creal(shape[i]);
  shb_status status = h5_write_double(at, "modes/shape", size, real, "kg^-1/2", shape_text);
  free(real);
  return status;
}

static shb_status write_group(hid_t at, int i, const mesh_fe *mesh, const modal_result *first,
                              const double *shape, const modal_sector *sector) {
  const modal_nodal_diameters *all = &sector->models;
  const int                    m   = all->model[i].n_modes;
  SHB_TRY(write_check(at, &sector->check[i]));
  if (i > 0) {
    const bool is_real = 2 * all->diameter[i] == all->blades;
    SHB_TRY(write_shape(at, m, mesh->n_nodes, is_real, sector->shape[i]));
  } else {
    SHB_TRY(h5_write_double(at, "modes/shape", H5_SHAPE((hsize_t)m, (hsize_t)mesh->n_nodes, 3),
                            shape, "kg^-1/2", shape_text));
    SHB_TRY(modal_export_contact(at, &first->patches));
  }
  return h5_attach_scale(at, "modes/shape", 0, "modes/frequency");
}

shb_status modal_sector_write(hid_t file, const mesh_fe *mesh, const modal_result *first,
                              const double *shape, const modal_sector *sector,
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
    shb_status status = write_group(group, i, mesh, first, shape, sector);
    H5Gclose(group);
    SHB_TRY(status);
  }
  return modal_deflection_write(file, &first->deflection, mesh->n_nodes, mesh->n_elements,
                                &first->model);
}
