#include "mhb/run_up/stuck_frequencies.h"

#include <stdlib.h>
#include <string.h>

#include "modal/model/nodal_diameters.h"

enum { MOST = 100000 }; /* entries of a list of a file */

static const char stored[] = "stuck_frequencies"; /* root attribute */

int mhb_driven_diameters(const modal_sector_speeds *sector, int engine_order, int *index) {
  const modal_model *model = &sector->at[0].model[0];
  int                n     = 0;
  for (int h = 1; h <= model->n_load; h++) {
    const int wanted = modal_nodal_diameter((long)h * engine_order, sector->blades);
    bool      have   = !modal_model_is_driven(model, h);
    for (int i = 0; i < n; i++) have = have || sector->diameter[index[i]] == wanted;
    for (int i = 0; i < sector->n && !have; i++)
      if (sector->diameter[i] == wanted) index[n++] = i;
  }
  return n;
}

/* ---- writing ---- */

static shb_status write_safe(hid_t file, const mhb_diagrams *d) {
  const h5_shape lines  = H5_SHAPE((hsize_t)d->n_diameters);
  const h5_shape values = H5_SHAPE((hsize_t)d->n_diameters, (hsize_t)d->n_families);
  if (d->n_families == 0 || d->n_diameters == 0) return SHB_OK;
  SHB_TRY(h5_write_int(file, "/safe/nodal_diameter", lines, d->diameter, "-",
                       "nodal diameter of the ring"));
  SHB_TRY(h5_write_double(file, "/safe/open", values, d->open, "Hz",
                          "natural frequency of a family with open contacts"));
  SHB_TRY(h5_write_double(file, "/safe/stuck", values, d->stuck, "Hz",
                          "natural frequency of a family with stuck contacts"));
  if (d->n_driven > 0)
    SHB_TRY(h5_write_int(file, "/safe/harmonic", H5_SHAPE((hsize_t)d->n_driven), d->driven, "-",
                         "harmonics of the load with a force"));
  return h5_write_attribute_int(file, "/safe", "disc", d->disc);
}

static shb_status write_campbell(hid_t file, const mhb_diagrams *d) {
  const hsize_t waves = (hsize_t)d->n_waves, speeds = (hsize_t)d->n_speeds;
  if (d->n_stuck == 0 || d->n_waves == 0) return SHB_OK;
  SHB_TRY(h5_write_int(file, "/campbell/nodal_diameter", H5_SHAPE(waves), d->wave, "-",
                       "nodal diameter of the excited waves"));
  SHB_TRY(h5_write_double(file, "/campbell/speed", H5_SHAPE(speeds), d->speed, "rad/s",
                          "speed of the rotor"));
  return h5_write_double(file, "/campbell/stuck", H5_SHAPE(waves, speeds, (hsize_t)d->n_stuck),
                         d->over, "Hz", "natural frequencies of a wave with stuck contacts");
}

shb_status mhb_diagrams_write(hid_t file, const mhb_diagrams *d) {
  SHB_TRY(h5_write_attribute_int(file, "/", stored, 1));
  SHB_TRY(write_safe(file, d));
  return write_campbell(file, d);
}

/* ---- reading ---- */

/* *n <- length of a list of the file, 0 without it. */
static shb_status length_of(hid_t file, const char *path, const char *name, int *n) {
  h5_shape shape;
  *n = 0;
  if (!h5_exists(file, name)) return SHB_OK;
  SHB_TRY(h5_shape_of(file, name, &shape));
  SHB_CHECK(shape.rank == 1 && shape.dim[0] <= MOST, SHB_ERR_INPUT,
            "%s: %s must be a list of at most %d", path, name, MOST);
  *n = (int)shape.dim[0];
  return SHB_OK;
}

/* *n <- the last of rank dimensions of a dataset. */
static shb_status width_of(hid_t file, const char *path, const char *name, int rank, int *n) {
  h5_shape shape;
  SHB_TRY(h5_shape_of(file, name, &shape));
  SHB_CHECK(shape.rank == rank && shape.dim[rank - 1] <= MOST, SHB_ERR_INPUT,
            "%s: %s must have %d dimensions of at most %d", path, name, rank, MOST);
  *n = (int)shape.dim[rank - 1];
  return SHB_OK;
}

static shb_status read_safe(hid_t file, const char *path, mhb_diagrams *d) {
  int *driven = NULL, disc;
  if (!h5_exists(file, "/safe")) return SHB_OK;
  SHB_TRY(length_of(file, path, "/safe/nodal_diameter", &d->n_diameters));
  SHB_TRY(width_of(file, path, "/safe/stuck", 2, &d->n_families));
  h5_shape lines  = H5_SHAPE((hsize_t)d->n_diameters);
  h5_shape values = H5_SHAPE((hsize_t)d->n_diameters, (hsize_t)d->n_families);
  SHB_TRY(h5_read_int(file, "/safe/nodal_diameter", &lines, &d->diameter));
  SHB_TRY(h5_read_double(file, "/safe/open", &values, &d->open));
  SHB_TRY(h5_read_double(file, "/safe/stuck", &values, &d->stuck));
  SHB_TRY(h5_read_attribute_int(file, "/safe", "disc", 0, &disc));
  d->disc = disc != 0;
  SHB_TRY(length_of(file, path, "/safe/harmonic", &d->n_driven));
  SHB_CHECK(d->n_driven <= MHB_MOST_DRIVEN, SHB_ERR_INPUT,
            "%s: /safe/harmonic must be a list of at most %d", path, MHB_MOST_DRIVEN);
  if (d->n_driven == 0) return SHB_OK;
  h5_shape harmonics = H5_SHAPE((hsize_t)d->n_driven);
  SHB_TRY(h5_read_int(file, "/safe/harmonic", &harmonics, &driven));
  memcpy(d->driven, driven, (size_t)d->n_driven * sizeof *driven);
  free(driven);
  return SHB_OK;
}

static shb_status read_campbell(hid_t file, const char *path, mhb_diagrams *d) {
  if (!h5_exists(file, "/campbell")) return SHB_OK;
  SHB_TRY(length_of(file, path, "/campbell/nodal_diameter", &d->n_waves));
  SHB_TRY(length_of(file, path, "/campbell/speed", &d->n_speeds));
  SHB_TRY(width_of(file, path, "/campbell/stuck", 3, &d->n_stuck));
  h5_shape waves = H5_SHAPE((hsize_t)d->n_waves), speeds = H5_SHAPE((hsize_t)d->n_speeds);
  h5_shape all = H5_SHAPE((hsize_t)d->n_waves, (hsize_t)d->n_speeds, (hsize_t)d->n_stuck);
  SHB_TRY(h5_read_int(file, "/campbell/nodal_diameter", &waves, &d->wave));
  SHB_TRY(h5_read_double(file, "/campbell/speed", &speeds, &d->speed));
  return h5_read_double(file, "/campbell/stuck", &all, &d->over);
}

shb_status mhb_diagrams_read(const char *path, mhb_diagrams *d) {
  hid_t file;
  int   known = 0;
  *d          = (mhb_diagrams){0};
  SHB_TRY(h5_open(path, &file));
  shb_status status = h5_read_attribute_int(file, "/", stored, 0, &known);
  d->known          = known != 0;
  if (status == SHB_OK) status = read_safe(file, path, d);
  if (status == SHB_OK) status = read_campbell(file, path, d);
  h5_close(file);
  if (status != SHB_OK) mhb_diagrams_free(d);
  return status;
}

void mhb_diagrams_free(mhb_diagrams *d) {
  free(d->diameter);
  free(d->open);
  free(d->stuck);
  free(d->wave);
  free(d->speed);
  free(d->over);
  *d = (mhb_diagrams){0};
}
