#include "modal/model/sector_speeds.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

enum { NAME = 32, LABEL = 1024 };

void modal_sector_speeds_create(int blades, int n, modal_sector_speeds *s) {
  *s = (modal_sector_speeds){.blades   = blades,
                             .n        = n,
                             .diameter = shb_alloc_zeroed((size_t)n, sizeof *s->diameter),
                             .at       = shb_alloc_zeroed((size_t)n, sizeof *s->at)};
}

void modal_sector_speeds_free(modal_sector_speeds *s) {
  for (int i = 0; s->at && i < s->n; i++) modal_speeds_free(&s->at[i]);
  free(s->diameter);
  free(s->at);
  *s = (modal_sector_speeds){0};
}

static hid_t open_group(hid_t file, int diameter, char name[NAME]) {
  snprintf(name, NAME, "/nodal_diameter_%d", diameter);
  return H5Gopen2(file, name, H5P_DEFAULT);
}

shb_status modal_sector_speeds_write(hid_t file, const modal_sector_speeds *s) {
  for (int i = 0; i < s->n; i++) {
    char  name[NAME];
    hid_t group = open_group(file, s->diameter[i], name);
    SHB_CHECK(group >= 0, SHB_ERR_IO, "%s cannot be written", name);
    shb_status status = modal_speeds_write_at(group, &s->at[i]);
    H5Gclose(group);
    SHB_TRY(status);
  }
  return SHB_OK;
}

/* The speeds of a nodal diameter are those of 0, and its modes can be followed. */
static shb_status check_alike(const char *label, const modal_speeds *a, const modal_speeds *b) {
  SHB_CHECK(a->n == b->n && a->n_modes == b->n_modes, SHB_ERR_INPUT,
            "%s holds %d modes at %d speeds, /nodal_diameter_0 %d at %d; write as many at every "
            "nodal diameter",
            label, b->n_modes, b->n, a->n_modes, a->n);
  for (int i = 0; i < a->n; i++)
    SHB_CHECK(a->speed[i] == b->speed[i], SHB_ERR_INPUT,
              "%s/speeds/speed: value %d (from 0) is %.9g rad/s, in /nodal_diameter_0 %.9g; the "
              "speeds of all nodal diameters must be the same",
              label, i, b->speed[i], a->speed[i]);
  SHB_CHECK(b->overlap, SHB_ERR_INPUT,
            "%s/speeds/overlap is missing; the modes of a disc are followed by it", label);
  return SHB_OK;
}

static shb_status read_one(hid_t file, const char *path, modal_sector_speeds *s, int i) {
  const int n = s->diameter[i];
  char      name[NAME], label[LABEL];
  hid_t     group = open_group(file, n, name);
  snprintf(label, sizeof label, "%s: %s", path, name);
  SHB_CHECK(group >= 0, SHB_ERR_INPUT, "%s is missing", label);
  shb_status status = modal_speeds_read_at(group, label, n != 0 && 2 * n != s->blades, &s->at[i]);
  H5Gclose(group);
  SHB_TRY(status);
  return check_alike(label, &s->at[0], &s->at[i]);
}

static shb_status read_all(hid_t file, const char *path, const modal_nodal_diameters *d,
                           modal_sector_speeds *s) {
  if (d->n == 0 || !h5_exists(file, "/nodal_diameter_0/speeds/mode")) return SHB_OK;
  modal_sector_speeds_create(d->blades, d->n, s);
  memcpy(s->diameter, d->diameter, (size_t)d->n * sizeof *s->diameter);
  for (int i = 0; i < s->n; i++) SHB_TRY(read_one(file, path, s, i));
  return SHB_OK;
}

shb_status modal_sector_speeds_read(const char *path, modal_sector_speeds *s) {
  hid_t                 file;
  modal_nodal_diameters d;
  *s = (modal_sector_speeds){0};
  SHB_TRY(modal_nodal_diameters_read(path, &d));
  shb_status status = h5_open(path, &file);
  if (status == SHB_OK) {
    status = read_all(file, path, &d, s);
    h5_close(file);
  }
  modal_nodal_diameters_free(&d);
  if (status != SHB_OK) modal_sector_speeds_free(s);
  return status;
}
