#include "modal/model/speeds.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

const double modal_speeds_mac_limit = 0.5;

enum { MAX_SPEEDS = 256 };

void modal_speeds_create(int n, int n_modes, modal_speeds *s) {
  const size_t all = (size_t)n * (size_t)n_modes;
  *s               = (modal_speeds){.n       = n,
                                    .n_modes = n_modes,
                                    .speed   = shb_alloc_zeroed((size_t)n, sizeof *s->speed),
                                    .model   = shb_alloc_zeroed((size_t)n, sizeof *s->model),
                                    .mode    = shb_alloc_zeroed(all, sizeof *s->mode),
                                    .mac     = shb_alloc_zeroed(all, sizeof *s->mac)};
}

void modal_speeds_make_complex(modal_speeds *s) {
  const size_t n = (size_t)s->n, m = (size_t)s->n_modes;
  s->imaginary         = shb_alloc_zeroed(n, sizeof *s->imaginary);
  s->backward          = shb_alloc_zeroed(n, sizeof *s->backward);
  s->overlap_imaginary = shb_alloc_zeroed(n * m * m, sizeof *s->overlap_imaginary);
}

double modal_speeds_frequency(const modal_speeds *s, int i, int track) {
  return s->model[i].frequency[s->mode[(size_t)i * (size_t)s->n_modes + (size_t)track]];
}

/* ---------------------------------------------------------------- writing */

static shb_status write_one(hid_t at, const modal_speeds *s, int i) {
  char name[32];
  snprintf(name, sizeof name, "speed_%d", i);
  hid_t group = H5Gcreate2(at, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  SHB_CHECK(group >= 0, SHB_ERR_IO, "%s cannot be written", name);
  shb_status status =
      modal_model_write_complex_at(group, &s->model[i], s->imaginary ? &s->imaginary[i] : NULL);
  if (status == SHB_OK && s->backward)
    status = modal_model_write_backward_at(group, &s->model[i], &s->backward[i]);
  H5Gclose(group);
  if (status == SHB_OK) status = h5_write_attribute_double(at, name, "rotor_speed", s->speed[i]);
  return status;
}

static shb_status write_overlap(hid_t at, const modal_speeds *s) {
  static const char text[] =
      "phi^H M psi of each mode at the first speed with each mode at this "
      "one, as numbered there";
  const h5_shape all = H5_SHAPE((hsize_t)s->n, (hsize_t)s->n_modes, (hsize_t)s->n_modes);
  const size_t   n   = h5_count(all);
  if (!s->overlap_imaginary)
    return h5_write_double(at, "speeds/overlap", all, s->overlap, "-", text);
  double complex *z = shb_alloc(n, sizeof *z);
  for (size_t i = 0; i < n; i++) z[i] = CMPLX(s->overlap[i], s->overlap_imaginary[i]);
  shb_status status = h5_write_complex(at, "speeds/overlap", all, z, "-", text);
  free(z);
  return status;
}

static shb_status write_tracks(hid_t at, const modal_speeds *s, double *frequency) {
  const h5_shape all = H5_SHAPE((hsize_t)s->n, (hsize_t)s->n_modes);
  for (int i = 0; i < s->n; i++)
    for (int t = 0; t < s->n_modes; t++)
      frequency[i * s->n_modes + t] = modal_speeds_frequency(s, i, t);
  SHB_TRY(h5_write_double(at, "speeds/speed", H5_SHAPE((hsize_t)s->n), s->speed, "rad/s",
                          "speeds of the rotor, ascending"));
  SHB_TRY(h5_write_double(at, "speeds/frequency", all, frequency, "Hz",
                          "frequencies of the tracked modes"));
  SHB_TRY(h5_write_int(at, "speeds/mode", all, s->mode, "-",
                       "which mode of each speed, from 0, belongs to the track"));
  SHB_TRY(h5_write_double(at, "speeds/mac", all, s->mac, "-",
                          "MAC of the track's mode with its mode at the speed before"));
  SHB_TRY(h5_attach_scale(at, "speeds/frequency", 0, "speeds/speed"));
  if (s->overlap) {
    SHB_TRY(write_overlap(at, s));
    SHB_TRY(h5_attach_scale(at, "speeds/overlap", 0, "speeds/speed"));
  }
  SHB_TRY(h5_attach_scale(at, "speeds/mode", 0, "speeds/speed"));
  return h5_attach_scale(at, "speeds/mac", 0, "speeds/speed");
}

shb_status modal_speeds_write_at(hid_t at, const modal_speeds *s) {
  double    *frequency = shb_alloc((size_t)s->n * (size_t)s->n_modes, sizeof *frequency);
  shb_status status    = write_tracks(at, s, frequency);
  free(frequency);
  for (int i = 0; status == SHB_OK && i < s->n; i++) status = write_one(at, s, i);
  return status;
}

shb_status modal_speeds_write(hid_t file, const modal_speeds *s) {
  SHB_TRY(modal_speeds_write_at(file, s));
  return h5_write_attribute_int(file, "/", "format_version", MODAL_SPEEDS_VERSION);
}

/* ---------------------------------------------------------------- reading */

static shb_status check_tracks(const char *path, const modal_speeds *s, const int *mode) {
  for (int i = 0; i < s->n; i++) {
    SHB_CHECK(s->speed[i] >= 0, SHB_ERR_INPUT,
              "%s: /speeds/speed: value %d (from 0) is %g rad/s; none may be negative", path, i,
              s->speed[i]);
    SHB_CHECK(i == 0 || s->speed[i] > s->speed[i - 1], SHB_ERR_INPUT,
              "%s: /speeds/speed: value %d (from 0), %g rad/s, does not ascend", path, i,
              s->speed[i]);
    for (int t = 0; t < s->n_modes; t++) {
      int here = mode[i * s->n_modes + t], times = 0;
      for (int u = 0; u < s->n_modes; u++) times += mode[i * s->n_modes + u] == here;
      SHB_CHECK(here >= 0 && here < s->n_modes && times == 1, SHB_ERR_INPUT,
                "%s: /speeds/mode: row %d does not hold every mode from 0 to %d once", path, i,
                s->n_modes - 1);
    }
  }
  return SHB_OK;
}

/* Check that model i has the sizes and the optional parts of the first one. Coriolis terms may lack
 * at rest. */
static shb_status check_alike(const char *path, const modal_model *a, const modal_model *b, int i) {
  bool same = a->n_modes == b->n_modes && a->n_pairs == b->n_pairs && a->has_left == b->has_left &&
              a->n_probes == b->n_probes && a->n_load == b->n_load;
  for (const modal_dataset *row = modal_datasets; row->path; row++)
    same = same && (!modal_dataset_is_residual(row) ||
                    !modal_dataset_get(row, a) == !modal_dataset_get(row, b));
  SHB_CHECK(same, SHB_ERR_INPUT,
            "%s: /speed_%d does not hold what /speed_0 holds: modes, pairs, probes, load harmonics "
            "and residual terms must be the same at every speed",
            path, i);
  return SHB_OK;
}

static shb_status read_one(hid_t at, const char *path, modal_speeds *s, int i) {
  char name[32], label[1024];
  snprintf(name, sizeof name, "/speed_%d", i);
  snprintf(label, sizeof label, "%s: /speed_%d", path, i);
  SHB_CHECK(h5_exists(at, name + 1), SHB_ERR_INPUT, "%s: %s is missing", path, name);
  hid_t group = H5Gopen2(at, name + 1, H5P_DEFAULT);
  SHB_CHECK(group >= 0, SHB_ERR_INPUT, "%s: %s is not a group", path, name);
  shb_status status;
  if (s->imaginary) {
    status = modal_model_read_complex_at(group, label, &s->model[i], &s->imaginary[i]);
    if (status == SHB_OK)
      status = modal_model_read_backward_at(group, &s->model[i], &s->backward[i]);
  } else {
    status = modal_model_read_at(group, label, &s->model[i]);
  }
  H5Gclose(group);
  SHB_TRY(status);
  SHB_CHECK(s->model[i].n_modes == s->n_modes, SHB_ERR_INPUT,
            "%s: %s holds %d modes, /speeds/mode %d", path, name, s->model[i].n_modes, s->n_modes);
  return check_alike(path, &s->model[0], &s->model[i], i);
}

/* The overlap of the first speed with itself is the identity. No overlap exceeds 1. */
static shb_status check_overlap(const char *path, const modal_speeds *s) {
  const int     m  = s->n_modes;
  const double *im = s->overlap_imaginary;
  for (int i = 0; i < m * m; i++)
    SHB_CHECK(hypot(s->overlap[i] - (i % (m + 1) == 0), im ? im[i] : 0) < 1e-6, SHB_ERR_INPUT,
              "%s: /speeds/overlap: value [0, %d, %d] is %g; of the first speed with itself the "
              "identity is wanted",
              path, i / m, i % m, s->overlap[i]);
  for (int i = 0; i < s->n * m * m; i++)
    SHB_CHECK(hypot(s->overlap[i], im ? im[i] : 0) < 1 + 1e-6, SHB_ERR_INPUT,
              "%s: /speeds/overlap: value [%d, %d, %d] is %g; 1 is the most that two modes of unit "
              "mass have in common",
              path, i / (m * m), i / m % m, i % m, s->overlap[i]);
  return SHB_OK;
}

static shb_status read_overlap(hid_t at, const char *path, modal_speeds *s) {
  h5_shape all = H5_SHAPE((hsize_t)s->n, (hsize_t)s->n_modes, (hsize_t)s->n_modes);
  if (!h5_exists(at, "speeds/overlap")) return SHB_OK;
  if (!s->imaginary) {
    SHB_TRY(h5_read_double(at, "speeds/overlap", &all, &s->overlap));
    return check_overlap(path, s);
  }
  double complex *z = NULL;
  SHB_TRY(h5_read_complex(at, "speeds/overlap", &all, &z));
  const size_t n = h5_count(all);
  s->overlap     = shb_alloc(n, sizeof *s->overlap);
  for (size_t i = 0; i < n; i++) {
    s->overlap[i]           = creal(z[i]);
    s->overlap_imaginary[i] = cimag(z[i]);
  }
  free(z);
  return check_overlap(path, s);
}

shb_status modal_speeds_read_at(hid_t at, const char *path, bool is_complex, modal_speeds *s) {
  h5_shape all = H5_SHAPE(0, 0), shape;
  SHB_TRY(h5_shape_of(at, "speeds/mode", &shape));
  SHB_CHECK(shape.rank == 2 && shape.dim[0] >= 1 && shape.dim[0] <= MAX_SPEEDS && shape.dim[1] >= 1,
            SHB_ERR_INPUT, "%s: /speeds/mode must be [speeds, modes], 1 to %d speeds", path,
            MAX_SPEEDS);
  all = shape;
  modal_speeds_create((int)shape.dim[0], (int)shape.dim[1], s);
  if (is_complex) modal_speeds_make_complex(s);
  int       *mode  = NULL;
  double    *speed = NULL, *mac = NULL;
  h5_shape   one    = H5_SHAPE(shape.dim[0]);
  shb_status status = h5_read_int(at, "speeds/mode", &all, &mode);
  if (status == SHB_OK) status = h5_read_double(at, "speeds/speed", &one, &speed);
  if (status == SHB_OK) status = h5_read_double(at, "speeds/mac", &all, &mac);
  if (status == SHB_OK) {
    const size_t count = (size_t)s->n * (size_t)s->n_modes;
    memcpy(s->speed, speed, (size_t)s->n * sizeof *speed);
    memcpy(s->mode, mode, count * sizeof *mode);
    memcpy(s->mac, mac, count * sizeof *mac);
    status = check_tracks(path, s, mode);
  }
  free(mode);
  free(speed);
  free(mac);
  if (status == SHB_OK) status = read_overlap(at, path, s);
  for (int i = 0; status == SHB_OK && i < s->n; i++) status = read_one(at, path, s, i);
  return status;
}

shb_status modal_speeds_read(const char *path, modal_speeds *s) {
  hid_t file;
  *s = (modal_speeds){0};
  SHB_TRY(h5_open(path, &file));
  shb_status status = h5_check_format(file, "shroudhb modal model", MODAL_NEWEST);
  if (status == SHB_OK && h5_exists(file, "/speeds/mode"))
    status = modal_speeds_read_at(file, path, false, s);
  h5_close(file);
  if (status != SHB_OK) modal_speeds_free(s);
  return status;
}

void modal_speeds_free(modal_speeds *s) {
  for (int i = 0; s->model && i < s->n; i++) modal_model_free(&s->model[i]);
  for (int i = 0; s->imaginary && i < s->n; i++) modal_model_free(&s->imaginary[i]);
  for (int i = 0; s->backward && i < s->n; i++) modal_model_free(&s->backward[i]);
  free(s->speed);
  free(s->model);
  free(s->mode);
  free(s->mac);
  free(s->overlap);
  free(s->imaginary);
  free(s->backward);
  free(s->overlap_imaginary);
  *s = (modal_speeds){0};
}
