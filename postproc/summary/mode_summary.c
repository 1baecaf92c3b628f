#include "postproc/summary/mode_summary.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "modal/hdf5/h5.h"

/* The modes at one nodal diameter after those that are there. */
static shb_status read_diameter(hid_t file, int diameter, post_modes *m) {
  char     name[64];
  h5_shape shape     = H5_SHAPE(0);
  double  *frequency = NULL, *damping = NULL;
  snprintf(name, sizeof name, "/nodal_diameter_%d/modes/frequency", diameter);
  SHB_TRY(h5_read_double(file, name, &shape, &frequency));
  snprintf(name, sizeof name, "/nodal_diameter_%d/modes/damping_ratio", diameter);
  shb_status   status = h5_read_double(file, name, &shape, &damping);
  const int    n      = m->n + (int)shape.dim[0];
  const size_t all    = (size_t)n + 1;
  if (status == SHB_OK) {
    double *f = realloc(m->frequency, all * sizeof *f);
    if (f) m->frequency = f;
    double *zeta = realloc(m->damping, all * sizeof *zeta);
    if (zeta) m->damping = zeta;
    int *d = realloc(m->diameter, all * sizeof *d);
    if (d) m->diameter = d;
    if (!f || !zeta || !d) status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  }
  for (int i = m->n; status == SHB_OK && i < n; i++) {
    m->frequency[i] = frequency[i - m->n];
    m->damping[i]   = damping[i - m->n];
    m->diameter[i]  = diameter;
  }
  if (status == SHB_OK) m->n = n;
  free(frequency);
  free(damping);
  return status;
}

static shb_status read_diameters(hid_t file, post_modes *m) {
  int n = 0, *diameter = NULL;
  m->mass = m->static_stress = m->static_displacement = NAN;
  shb_status status = h5_read_attribute_ints(file, "/", "nodal_diameters", &n, &diameter);
  for (int i = 0; i < n && status == SHB_OK; i++) status = read_diameter(file, diameter[i], m);
  free(diameter);
  return status;
}

static shb_status read_all(hid_t file, post_modes *m) {
  h5_shape shape = H5_SHAPE(0);
  if (h5_exists(file, "/nodal_diameter_0")) return read_diameters(file, m);
  SHB_TRY(h5_read_double(file, "/modes/frequency", &shape, &m->frequency));
  m->n = (int)shape.dim[0];
  SHB_TRY(h5_read_double(file, "/modes/damping_ratio", &shape, &m->damping));
  h5_shape along = H5_SHAPE(shape.dim[0], 3);
  if (h5_exists(file, "/modes/effective_mass"))
    SHB_TRY(h5_read_double(file, "/modes/effective_mass", &along, &m->mass_along));
  if (h5_exists(file, "/modes/effective_inertia"))
    SHB_TRY(h5_read_double(file, "/modes/effective_inertia", &shape, &m->inertia));
  SHB_TRY(h5_read_attribute_double(file, "/", "mass", NAN, &m->mass));
  SHB_TRY(h5_read_attribute_double(file, "/", "rotor_speed", 0, &m->speed));
  m->static_stress = m->static_displacement = NAN;
  if (!h5_exists(file, "/static")) return SHB_OK;
  SHB_TRY(h5_read_attribute_double(file, "/static", "greatest_stress", NAN, &m->static_stress));
  return h5_read_attribute_double(file, "/static", "greatest_displacement", NAN,
                                  &m->static_displacement);
}

shb_status post_modes_read(const char *path, post_modes *modes) {
  hid_t file;
  *modes = (post_modes){0};
  SHB_TRY(h5_open(path, &file));
  shb_status status = h5_check_format(file, "shroudhb modal model", 99);
  if (status == SHB_OK) status = read_all(file, modes);
  h5_close(file);
  if (status != SHB_OK) post_modes_free(modes);
  return status;
}

void post_modes_free(post_modes *modes) {
  free(modes->frequency);
  free(modes->damping);
  free(modes->diameter);
  free(modes->mass_along);
  free(modes->inertia);
  *modes = (post_modes){0};
}

void post_modes_put(const post_modes *modes, post_json *json) {
  post_json_number(json, "mass", modes->mass);
  post_json_number(json, "rotor_speed", modes->speed);
  if (isfinite(modes->static_stress)) {
    post_json_object(json, "static");
    post_json_number(json, "stress", modes->static_stress);
    post_json_number(json, "displacement", modes->static_displacement);
    post_json_end(json);
  } else {
    post_json_null(json, "static");
  }
  post_json_list(json, "modes");
  for (int i = 0; i < modes->n; i++) {
    post_json_object(json, NULL);
    post_json_number(json, "nodal_diameter", modes->diameter ? modes->diameter[i] : NAN);
    post_json_number(json, "frequency", modes->frequency[i]);
    post_json_number(json, "damping_ratio", modes->damping[i]);
    if (modes->mass_along)
      post_json_numbers(json, "effective_mass", 3, modes->mass_along + 3 * (size_t)i);
    else
      post_json_null(json, "effective_mass");
    post_json_number(json, "effective_inertia", modes->inertia ? modes->inertia[i] : NAN);
    post_json_end(json);
  }
  post_json_end(json);
}
