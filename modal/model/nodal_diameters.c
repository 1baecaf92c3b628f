#include "modal/model/nodal_diameters.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

enum { MOST_BLADES = 10000, NAME = 32, LABEL = 1024 };

void modal_nodal_diameters_create(int blades, int n, modal_nodal_diameters *d) {
  const size_t count = (size_t)n;
  *d                 = (modal_nodal_diameters){.blades = blades, .n = n};
  d->diameter        = shb_alloc_zeroed(count, sizeof *d->diameter);
  d->model           = shb_alloc_zeroed(count, sizeof *d->model);
  d->imaginary       = shb_alloc_zeroed(count, sizeof *d->imaginary);
  d->backward        = shb_alloc_zeroed(count, sizeof *d->backward);
}

void modal_nodal_diameters_free(modal_nodal_diameters *d) {
  for (int i = 0; d->model && i < d->n; i++) modal_model_free(&d->model[i]);
  for (int i = 0; d->imaginary && i < d->n; i++) modal_model_free(&d->imaginary[i]);
  for (int i = 0; d->backward && i < d->n; i++) modal_model_free(&d->backward[i]);
  free(d->diameter);
  free(d->model);
  free(d->imaginary);
  free(d->backward);
  *d = (modal_nodal_diameters){0};
}

/* Shapes at nodal diameter 0 and N/2 are real. */
static bool is_real(int blades, int n) {
  return n == 0 || 2 * n == blades;
}

static bool has_imaginary(const modal_model *imaginary) {
  return imaginary->right || imaginary->probe;
}

/* ---------------------------------------------------------------- waves */

int modal_nodal_diameters_find(const modal_nodal_diameters *d, int n) {
  for (int i = 0; i < d->n; i++)
    if (d->diameter[i] == n) return i;
  return -1;
}

modal_wave modal_wave_real(const modal_model *model) {
  return (modal_wave){model, NULL, model, 1};
}

int modal_nodal_diameter(long wave, int blades) {
  const int n = (int)((wave % blades + blades) % blades);
  return 2 * n > blades ? blades - n : n;
}

bool modal_nodal_diameters_wave(const modal_nodal_diameters *d, long wave, modal_wave *found,
                                int *missing) {
  const int  n        = modal_nodal_diameter(wave, d->blades);
  const bool backward = (wave - n) % d->blades != 0;
  const int  i        = modal_nodal_diameters_find(d, n);
  *missing            = n;
  if (i < 0) return false;
  *found = modal_wave_real(&d->model[i]);
  if (has_imaginary(&d->imaginary[i])) found->imaginary = &d->imaginary[i];
  if (backward) {
    found->sign = -1;
    if (d->backward[i].modal_force) found->loads = &d->backward[i];
  }
  return true;
}

/* ---------------------------------------------------------------- file */

static shb_status write_one(hid_t file, const modal_nodal_diameters *d, int i) {
  char name[NAME];
  snprintf(name, sizeof name, "/nodal_diameter_%d", d->diameter[i]);
  hid_t group = H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  SHB_CHECK(group >= 0, SHB_ERR_IO, "%s cannot be created", name);
  const bool complex_too = has_imaginary(&d->imaginary[i]);
  shb_status status =
      modal_model_write_complex_at(group, &d->model[i], complex_too ? &d->imaginary[i] : NULL);
  if (status == SHB_OK && d->backward[i].modal_force)
    status = modal_model_write_backward_at(group, &d->model[i], &d->backward[i]);
  H5Gclose(group);
  return status;
}

shb_status modal_nodal_diameters_write(hid_t file, const modal_nodal_diameters *d) {
  SHB_TRY(h5_write_attribute_int(file, "/", "format_version", MODAL_DIAMETERS_VERSION));
  SHB_TRY(h5_write_attribute_int(file, "/", "blades", d->blades));
  SHB_TRY(h5_write_attribute_ints(file, "/", "nodal_diameters", d->n, d->diameter));
  for (int i = 0; i < d->n; i++) SHB_TRY(write_one(file, d, i));
  return SHB_OK;
}

/* The sizes that all models share; the first difference is told. Residual modes may differ. */
static shb_status check_sizes(const char *label, const modal_model *a, const modal_model *b) {
  for (const modal_size *size = modal_sizes; size->path; size++) {
    const int first = (int)modal_size_of(a, size->letter),
              here  = (int)modal_size_of(b, size->letter);
    SHB_CHECK(size->letter == 'r' || first == here, SHB_ERR_INPUT,
              "%s holds %d %s, /nodal_diameter_0 %d; write as many at every nodal diameter", label,
              here, size->noun, first);
  }
  SHB_CHECK(a->has_left == b->has_left, SHB_ERR_INPUT,
            "%s holds %d sides of the contact, /nodal_diameter_0 %d; write as many at every nodal "
            "diameter",
            label, b->has_left + 1, a->has_left + 1);
  return SHB_OK;
}

/* Optional parts that one model has and another lacks would be an error of the wave. */
static shb_status check_parts(const char *label, const modal_model *a, const modal_model *b) {
  for (const modal_dataset *row = modal_datasets; row->path; row++) {
    const bool shared = modal_dataset_is_residual(row) || strcmp(row->path, "modes/coriolis") == 0;
    const bool first = modal_dataset_get(row, a), here = modal_dataset_get(row, b);
    SHB_CHECK(!shared || first == here, SHB_ERR_INPUT,
              "%s %s /%s, /nodal_diameter_0 %s; write it at every nodal diameter or at none", label,
              here ? "has" : "lacks", row->path, here ? "lacks it" : "has it");
  }
  return SHB_OK;
}

static shb_status read_group(hid_t file, const char *path, modal_nodal_diameters *d, int i) {
  const int n = d->diameter[i];
  char      name[NAME], label[LABEL];
  snprintf(name, sizeof name, "/nodal_diameter_%d", n);
  snprintf(label, sizeof label, "%s: %s", path, name);
  SHB_CHECK(h5_exists(file, name), SHB_ERR_INPUT,
            "%s is missing, which the root attribute nodal_diameters lists", label);
  hid_t group = H5Gopen2(file, name, H5P_DEFAULT);
  SHB_CHECK(group >= 0, SHB_ERR_INPUT, "%s is not a group", label);
  shb_status status;
  if (is_real(d->blades, n)) {
    status = modal_model_read_real_at(group, label, &d->model[i]);
  } else {
    status = modal_model_read_complex_at(group, label, &d->model[i], &d->imaginary[i]);
    if (status == SHB_OK)
      status = modal_model_read_backward_at(group, &d->model[i], &d->backward[i]);
  }
  H5Gclose(group);
  SHB_TRY(status);
  SHB_TRY(check_sizes(label, &d->model[0], &d->model[i]));
  return check_parts(label, &d->model[0], &d->model[i]);
}

static shb_status check_list(const char *path, int blades, int n, const int *diameter) {
  SHB_CHECK(n > 0, SHB_ERR_INPUT,
            "%s: the root attribute nodal_diameters is missing; a file of version %d lists its "
            "nodal diameters there",
            path, MODAL_DIAMETERS_VERSION);
  SHB_CHECK(blades >= 2 && blades <= MOST_BLADES, SHB_ERR_INPUT,
            "%s: the root attribute blades is %d; the number of sectors is wanted, 2 to %d", path,
            blades, MOST_BLADES);
  for (int i = 0; i < n; i++) {
    SHB_CHECK(diameter[i] >= 0 && diameter[i] <= blades / 2, SHB_ERR_INPUT,
              "%s: the root attribute nodal_diameters holds %d; 0 to %d are wanted with %d blades",
              path, diameter[i], blades / 2, blades);
    SHB_CHECK(i == 0 || diameter[i] > diameter[i - 1], SHB_ERR_INPUT,
              "%s: the root attribute nodal_diameters: value %d (from 0), %d, does not ascend",
              path, i, diameter[i]);
  }
  SHB_CHECK(diameter[0] == 0, SHB_ERR_INPUT,
            "%s: has no nodal diameter 0, at which the static part of every motion stands", path);
  return SHB_OK;
}

static shb_status read_all(hid_t file, const char *path, modal_nodal_diameters *d) {
  int        blades, n, *diameter = NULL;
  shb_status status = h5_read_attribute_int(file, "/", "blades", -1, &blades);
  if (status == SHB_OK)
    status = h5_read_attribute_ints(file, "/", "nodal_diameters", &n, &diameter);
  if (status == SHB_OK) status = check_list(path, blades, n, diameter);
  if (status == SHB_OK) {
    modal_nodal_diameters_create(blades, n, d);
    memcpy(d->diameter, diameter, (size_t)n * sizeof *diameter);
  }
  free(diameter);
  for (int i = 0; status == SHB_OK && i < d->n; i++) status = read_group(file, path, d, i);
  return status;
}

shb_status modal_nodal_diameters_read(const char *path, modal_nodal_diameters *d) {
  hid_t file;
  int   version = 1;
  *d            = (modal_nodal_diameters){0};
  SHB_TRY(h5_open(path, &file));
  shb_status status = h5_check_format(file, "shroudhb modal model", MODAL_NEWEST);
  if (status == SHB_OK) status = h5_read_attribute_int(file, "/", "format_version", 1, &version);
  if (status == SHB_OK && version == MODAL_DIAMETERS_VERSION) status = read_all(file, path, d);
  h5_close(file);
  if (status != SHB_OK) modal_nodal_diameters_free(d);
  return status;
}
