#include "postproc/field/blade_field.h"

#include <cblas.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/problem/wave.h"
#include "modal/hdf5/h5.h"
#include "modal/model/nodal_diameters.h"

enum { PATH = 96 };

/* Sizes and weights of /residual in a group of the modal file. */
static shb_status read_columns(hid_t at, post_blade_field *f) {
  h5_shape stress, weight = H5_SHAPE(0, 0);
  if (!h5_exists(at, "residual") || !h5_exists(at, "residual/stress")) return SHB_OK;
  SHB_TRY(h5_shape_of(at, "residual/stress", &stress));
  SHB_TRY(h5_read_complex(at, "residual/load_weight", &weight, &f->load_weight));
  f->n_column  = (int)stress.dim[0];
  f->n_contact = f->n_column - (int)weight.dim[1];
  f->n_load    = (int)weight.dim[0] - 1;
  SHB_CHECK(f->n_contact >= 0 && f->n_load >= 0, SHB_ERR_INPUT,
            "residual/load_weight has %d columns, residual/stress %d; make the file again",
            (int)weight.dim[1], f->n_column);
  return SHB_OK;
}

static shb_status read_stress(hid_t file, post_blade_field *f) {
  const hsize_t n      = (hsize_t)f->n_nodes;
  h5_shape      stress = H5_SHAPE((hsize_t)f->n_modes, n, POST_STRESSES);
  h5_shape      column = H5_SHAPE((hsize_t)f->n_column, n, POST_STRESSES);
  SHB_TRY(h5_read_double(file, "/modes/stress", &stress, &f->stress));
  if (f->n_column == 0) return SHB_OK;
  return h5_read_double(file, "/residual/stress", &column, &f->residual);
}

/* The group of a modal model: the root, or that of nodal diameter 0. */
static shb_status read_model(hid_t file, post_blade_field *f) {
  hid_t at = H5Gopen2(file, f->n_waves > 0 ? "/nodal_diameter_0" : "/", H5P_DEFAULT);
  SHB_CHECK(at >= 0, SHB_ERR_INPUT, "/nodal_diameter_0 is missing");
  h5_shape   nodes = H5_SHAPE(0, 3), stress = {0};
  shb_status status = SHB_OK;
  if (h5_exists(at, "modes") && h5_exists(at, "modes/stress")) {
    status = h5_read_double(file, "/mesh/nodes", &nodes, &f->nodes);
    if (status == SHB_OK) status = h5_shape_of(at, "modes/stress", &stress);
    f->n_nodes = status == SHB_OK ? (int)nodes.dim[0] : 0;
    f->n_modes = status == SHB_OK ? (int)stress.dim[0] : 0;
    if (status == SHB_OK) status = read_columns(at, f);
  }
  H5Gclose(at);
  return status;
}

static shb_status read_all(hid_t file, post_blade_field *f) {
  if (!h5_exists(file, "/mesh")) return SHB_OK;
  SHB_TRY(h5_read_attribute_ints(file, "/", "nodal_diameters", &f->n_waves, &f->diameter));
  SHB_TRY(h5_read_attribute_int(file, "/", "blades", 0, &f->blades));
  SHB_TRY(read_model(file, f));
  if (f->n_nodes == 0) return SHB_OK;
  if (f->n_waves > 0) {
    f->wave = calloc((size_t)f->n_waves, sizeof *f->wave);
    SHB_CHECK(f->wave, SHB_ERR_IO, "out of memory for the nodal diameters");
  } else
    SHB_TRY(read_stress(file, f));
  h5_shape at_speed = H5_SHAPE((hsize_t)f->n_nodes, POST_STRESSES);
  if (!h5_exists(file, "/static") || !h5_exists(file, "/static/nodal_stress")) return SHB_OK;
  return h5_read_double(file, "/static/nodal_stress", &at_speed, &f->static_stress);
}

static shb_status read_mesh(hid_t file, post_blade_field *f) {
  h5_shape  elements = H5_SHAPE(0, 0);
  mesh_kind kind     = MESH_TET10;
  SHB_TRY(h5_read_int(file, "/mesh/connectivity", &elements, &f->mesh.connectivity));
  if ((int)elements.dim[1] == mesh_topology_of(MESH_HEX20)->nodes) kind = MESH_HEX20;
  f->mesh.kind        = kind;
  f->mesh.n_nodes     = f->n_nodes;
  f->mesh.coordinates = f->nodes;
  f->mesh.n_elements  = (int)elements.dim[0];
  const int each      = mesh_topology_of(kind)->nodes;
  SHB_CHECK((int)elements.dim[1] == each, SHB_ERR_INPUT,
            "/mesh/connectivity has elements of %d nodes; it must be 10 or 20",
            (int)elements.dim[1]);
  for (int i = 0; i < each * f->mesh.n_elements; i++) {
    const int node = f->mesh.connectivity[i];
    SHB_CHECK(node >= 0 && node < f->n_nodes, SHB_ERR_INPUT,
              "/mesh/connectivity names the node %d, but there are %d nodes", node, f->n_nodes);
  }
  return SHB_OK;
}

static shb_status read_motion(hid_t file, post_blade_field *f) {
  const hsize_t n       = (hsize_t)f->n_nodes;
  h5_shape      shape   = H5_SHAPE((hsize_t)f->n_modes, n, 3);
  h5_shape      columns = H5_SHAPE((hsize_t)f->n_column, n, 3), at_speed = H5_SHAPE(n, 3);
  SHB_TRY(read_mesh(file, f));
  if (f->n_waves == 0) SHB_TRY(h5_read_double(file, "/modes/shape", &shape, &f->shape));
  if (f->n_waves == 0 && f->n_column > 0)
    SHB_TRY(h5_read_double(file, "/residual/shape", &columns, &f->residual_shape));
  if (!h5_exists(file, "/static") || !h5_exists(file, "/static/displacement")) return SHB_OK;
  return h5_read_double(file, "/static/displacement", &at_speed, &f->static_displacement);
}

static shb_status read_file(const char *path, bool motion, post_blade_field *field) {
  hid_t file;
  *field = (post_blade_field){.motion = motion};
  SHB_TRY(h5_open(path, &file));
  shb_status status = read_all(file, field);
  if (status == SHB_OK && motion && field->n_nodes > 0) status = read_motion(file, field);
  h5_close(file);
  return status;
}

shb_status post_blade_field_read(const char *path, post_blade_field *field) {
  return read_file(path, false, field);
}

shb_status post_blade_field_read_motion(const char *path, post_blade_field *field) {
  return read_file(path, true, field);
}

void post_blade_field_free(post_blade_field *f) {
  for (int i = 0; f->wave && i < f->n_waves; i++) {
    free(f->wave[i].frequency);
    free(f->wave[i].stress);
    free(f->wave[i].residual);
    free(f->wave[i].shape);
    free(f->wave[i].residual_shape);
  }
  free(f->wave);
  free(f->diameter);
  free(f->nodes);
  free(f->stress);
  free(f->residual);
  free(f->load_weight);
  free(f->static_stress);
  free(f->mesh.connectivity);
  free(f->shape);
  free(f->residual_shape);
  free(f->static_displacement);
  memset(f, 0, sizeof *f);
}

/* place[volume of the file] <- index of its name, or false. */
static shb_status match_names(hid_t file, int n, const char *const *name, int *place, bool *all) {
  int    found;
  char **text;
  SHB_TRY(h5_read_strings(file, "/mesh/volume", &found, &text));
  *all = found <= n;
  for (int i = 0; i < found; i++) {
    int at = -1;
    for (int j = 0; j < n; j++)
      if (strcmp(text[i], name[j]) == 0) at = j;
    *all = *all && at >= 0;
    if (*all) place[i] = at;
    free(text[i]);
  }
  free(text);
  return SHB_OK;
}

/* The rule of fem/body/stress: the greatest E, of equal ones the first. */
static shb_status find_regions(hid_t file, int n_nodes, const int *place, const double *stiffness,
                               int *region) {
  h5_shape   elements = H5_SHAPE(0, 0), one = H5_SHAPE(0);
  int       *node = NULL, *volume = NULL;
  shb_status status = h5_read_int(file, "/mesh/connectivity", &elements, &node);
  one.dim[0]        = elements.dim[0];
  if (status == SHB_OK) status = h5_read_int(file, "/mesh/material", &one, &volume);
  for (int i = 0; i < n_nodes; i++) region[i] = -1;
  for (size_t i = 0; status == SHB_OK && i < (size_t)(elements.dim[0] * elements.dim[1]); i++) {
    int      *own  = &region[node[i]];
    const int here = place[volume[i / elements.dim[1]]];
    if (*own < 0 || stiffness[here] > stiffness[*own] ||
        (stiffness[here] == stiffness[*own] && here < *own))
      *own = here;
  }
  for (int i = 0; i < n_nodes; i++)
    if (region[i] < 0) region[i] = 0; /* a node of no element */
  free(node);
  free(volume);
  return status;
}

shb_status post_blade_regions(const char *path, int n_nodes, int n, const char *const *name,
                              const double *stiffness, int **region) {
  hid_t file;
  bool  all       = false;
  int   place[64] = {0};
  *region         = NULL;
  SHB_TRY(h5_open(path, &file));
  shb_status status = SHB_OK;
  if (h5_exists(file, "/mesh/volume") && n <= 64) status = match_names(file, n, name, place, &all);
  if (status == SHB_OK && all) {
    *region = malloc((size_t)n_nodes * sizeof **region + 1);
    status  = *region ? find_regions(file, n_nodes, place, stiffness, *region)
                      : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory for the materials");
  }
  h5_close(file);
  return status;
}

/* One dataset of a nodal diameter, of the field's sizes. */
static shb_status read_wave_data(hid_t file, int diameter, const char *name, int rows, int nodes,
                                 int width, double complex **data) {
  h5_shape shape = H5_SHAPE((hsize_t)rows, (hsize_t)nodes, (hsize_t)width);
  char     path[PATH];
  snprintf(path, sizeof path, "/nodal_diameter_%d/%s", diameter, name);
  return h5_read_complex(file, path, &shape, data);
}

static shb_status read_modes(hid_t file, const post_blade_field *f, int i) {
  post_wave_field *w = &f->wave[i];
  const int        n = f->n_nodes, d = f->diameter[i], m = f->n_modes;
  h5_shape         modes = H5_SHAPE((hsize_t)m);
  char             path[PATH];
  snprintf(path, sizeof path, "/nodal_diameter_%d/modes/frequency", d);
  SHB_TRY(h5_read_double(file, path, &modes, &w->frequency));
  SHB_TRY(read_wave_data(file, d, "modes/stress", m, n, POST_STRESSES, &w->stress));
  return f->motion ? read_wave_data(file, d, "modes/shape", m, n, 3, &w->shape) : SHB_OK;
}

static shb_status read_wave(hid_t file, const post_blade_field *f, int i) {
  post_wave_field *w = &f->wave[i];
  const int        n = f->n_nodes, d = f->diameter[i], c = f->n_column;
  SHB_TRY(read_modes(file, f, i));
  if (c == 0) return SHB_OK;
  SHB_TRY(read_wave_data(file, d, "residual/stress", c, n, POST_STRESSES, &w->residual));
  if (f->motion) SHB_TRY(read_wave_data(file, d, "residual/shape", c, n, 3, &w->residual_shape));
  return SHB_OK;
}

shb_status post_blade_field_read_wave(post_blade_field *f, const char *path, int n) {
  hid_t      file;
  shb_status status = SHB_OK;
  SHB_TRY(h5_open(path, &file));
  for (int i = 0; i < f->n_waves && status == SHB_OK; i++)
    if (f->diameter[i] == n && !f->wave[i].stress) status = read_modes(file, f, i);
  h5_close(file);
  return status;
}

int post_blade_wave(const post_blade_field *f, const mhb_branch *b, int k, bool *backward) {
  *backward = false;
  if (f->n_waves == 0) return 0;
  const long wave = k * mhb_driven_wave_number(mhb_driven_wave_of(f->engine_order, f->turns_right,
                                                                  f->blades, b->order));
  const int  n    = modal_nodal_diameter(wave, f->blades);
  *backward       = (wave - n) % f->blades != 0;
  for (int i = 0; i < f->n_waves; i++)
    if (f->diameter[i] == n) return i;
  return -1;
}

/* The nodal diameters that the kept points of a branch need. */
static shb_status read_waves(hid_t file, const post_blade_field *f, const mhb_branch *b,
                             const char *path) {
  int top = -1;
  for (int a = 0; a < b->modal.n; a++) {
    const int here = post_blade_harmonics(b, f->n_modes, a);
    if (here > top) top = here;
  }
  for (int k = 0; k <= top; k++) {
    bool      backward;
    const int i = post_blade_wave(f, b, k, &backward);
    SHB_CHECK(i >= 0, SHB_ERR_INPUT,
              "%s: lacks the nodal diameter of harmonic %d of the response; run shroudhb mhb again",
              path, k);
    if (!f->wave[i].stress) SHB_TRY(read_wave(file, f, i));
  }
  return SHB_OK;
}

shb_status post_blade_field_match(post_blade_field *f, const mhb_response *response,
                                  const char *path) {
  SHB_CHECK(f->n_modes == response->n_modes, SHB_ERR_INPUT,
            "%s: has the stress of %d modes, but the response %d modes; run shroudhb mhb again",
            path, f->n_modes, response->n_modes);
  for (int i = 0; i < response->n_branches; i++) {
    const mhb_modal_motion *m = &response->branch[i].modal;
    SHB_CHECK(m->n == 0 || f->n_column == 0 || m->n_contact == f->n_contact, SHB_ERR_INPUT,
              "%s: /residual has %d contact dofs, but the response %d; run shroudhb mhb again",
              path, f->n_contact, m->n_contact);
  }
  if (f->n_waves == 0) return SHB_OK;
  hid_t file;
  f->engine_order = response->engine_order;
  f->turns_right  = response->turns_right;
  SHB_TRY(h5_open(path, &file));
  shb_status status = SHB_OK;
  for (int i = 0; status == SHB_OK && i < response->n_branches; i++)
    status = read_waves(file, f, &response->branch[i], path);
  h5_close(file);
  return status;
}

int post_blade_harmonics(const mhb_branch *b, int n_modes, int kept) {
  const size_t          m = (size_t)n_modes, K = (size_t)b->n_harmonics + 1;
  const double complex *q = b->modal.amplitude + (size_t)kept * K * m;
  for (size_t i = K * m; i-- > 0;)
    if (q[i] != 0) return (int)(i / m);
  return 0;
}

void post_blade_forces(const post_blade_field *f, const mhb_branch *b, int kept, int k,
                       double complex *force) {
  const size_t            at       = (size_t)kept * ((size_t)b->n_harmonics + 1) + (size_t)k;
  const int               patterns = f->n_column - f->n_contact;
  const mhb_modal_motion *m        = &b->modal;
  const bool              driven   = k % b->order == 0 && k / b->order <= f->n_load;
  for (int c = 0; c < f->n_contact; c++) force[c] = m->force[at * (size_t)f->n_contact + (size_t)c];
  for (int c = 0; c < patterns; c++)
    force[f->n_contact + c] =
        driven ? m->scale[kept] * f->load_weight[k / b->order * patterns + c] : 0;
}

/* weight[2 k + part][column] of the residual columns, harmonics below rows/2. */
static shb_status set_forces(const post_blade_field *f, const mhb_branch *b, int kept, int rows,
                             double *weight) {
  double complex *force = malloc((size_t)f->n_column * sizeof *force + 1);
  SHB_CHECK(force, SHB_ERR_IO, "out of memory for the field of a point");
  for (int k = 0; k < rows / 2; k++) {
    post_blade_forces(f, b, kept, k, force);
    for (int c = 0; c < f->n_column; c++) {
      weight[(2 * k) * f->n_column + c]     = creal(force[c]);
      weight[(2 * k + 1) * f->n_column + c] = cimag(force[c]);
    }
  }
  free(force);
  return SHB_OK;
}

static void set_amplitudes(const post_blade_field *f, const mhb_branch *b, int kept,
                           double *weight) {
  const size_t          K = (size_t)b->n_harmonics + 1, m = (size_t)f->n_modes;
  const double complex *q = b->modal.amplitude + (size_t)kept * K * m;
  for (size_t k = 0; k < K; k++)
    for (size_t i = 0; i < m; i++) {
      weight[2 * k * m + i]       = creal(q[k * m + i]);
      weight[(2 * k + 1) * m + i] = cimag(q[k * m + i]);
    }
}

/* out[rows][width] = weight[rows][columns] field[columns][width], or added to it. */
static void combine(int rows, int columns, int width, const double *weight, const double *field,
                    bool add, double *out) {
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, rows, width, columns, 1, weight, columns,
              field, width, add, out, width);
}

/* Harmonics of a field with so many components a node, of every mode and residual column. */
static shb_status sum_up(const post_blade_field *f, const mhb_branch *b, int kept, int components,
                         const double *mode, const double *residual, double *out) {
  const int rows   = 2 * (post_blade_harmonics(b, f->n_modes, kept) + 1);
  const int most   = f->n_modes + f->n_column;
  double   *weight = malloc(2 * ((size_t)b->n_harmonics + 1) * (size_t)most * sizeof *weight + 1);
  SHB_CHECK(weight, SHB_ERR_IO, "out of memory for the field of a point");
  set_amplitudes(f, b, kept, weight);
  combine(rows, f->n_modes, components * f->n_nodes, weight, mode, false, out);
  shb_status status = SHB_OK;
  if (f->n_column > 0) status = set_forces(f, b, kept, rows, weight);
  if (f->n_column > 0 && status == SHB_OK)
    combine(rows, f->n_column, components * f->n_nodes, weight, residual, true, out);
  free(weight);
  return status;
}

/* sum[width] = or += sum of weight[rows] field[rows][width] */
static void add_wave(int rows, int width, const double complex *weight, const double complex *field,
                     bool add, double complex *sum) {
  const double complex one = 1, beta = add;
  if (rows > 0)
    cblas_zgemv(CblasRowMajor, CblasTrans, rows, width, &one, field, width, weight, 1, &beta, sum,
                1);
}

/* One harmonic of a disc: out[2][width], real and imaginary.
 *   scratch  [n_modes + n_column + width] */
static void sum_wave(const post_blade_field *f, const mhb_branch *b, int kept, int k,
                     int components, double complex *scratch, double *out) {
  bool                   backward;
  const post_wave_field *w = &f->wave[post_blade_wave(f, b, k, &backward)];
  const size_t           m = (size_t)f->n_modes, n = m + (size_t)f->n_column;
  const int              width = components * f->n_nodes;
  const bool             moves = components == 3;
  double complex        *sum   = scratch + n;
  memcpy(scratch,
         b->modal.amplitude + ((size_t)kept * ((size_t)b->n_harmonics + 1) + (size_t)k) * m,
         m * sizeof *scratch);
  post_blade_forces(f, b, kept, k, scratch + m);
  /* conj(field) q is the conjugate of field conj(q) */
  for (size_t i = 0; i < n && backward; i++) scratch[i] = conj(scratch[i]);
  add_wave(f->n_modes, width, scratch, moves ? w->shape : w->stress, false, sum);
  add_wave(f->n_column, width, scratch + m, moves ? w->residual_shape : w->residual, true, sum);
  for (int i = 0; i < width; i++) {
    out[i]         = creal(sum[i]);
    out[width + i] = backward ? -cimag(sum[i]) : cimag(sum[i]);
  }
}

static shb_status sum_waves(const post_blade_field *f, const mhb_branch *b, int kept,
                            int components, double *out) {
  const size_t    width = (size_t)components * (size_t)f->n_nodes;
  double complex *scratch =
      malloc(((size_t)f->n_modes + (size_t)f->n_column + width) * sizeof *scratch);
  SHB_CHECK(scratch, SHB_ERR_IO, "out of memory for the field of a point");
  for (int k = 0; k <= post_blade_harmonics(b, f->n_modes, kept); k++)
    sum_wave(f, b, kept, k, components, scratch, out + 2 * (size_t)k * width);
  free(scratch);
  return SHB_OK;
}

shb_status post_blade_stress(const post_blade_field *f, const mhb_branch *b, int kept,
                             double *out) {
  if (f->n_waves > 0) return sum_waves(f, b, kept, POST_STRESSES, out);
  return sum_up(f, b, kept, POST_STRESSES, f->stress, f->residual, out);
}

shb_status post_blade_displacement(const post_blade_field *f, const mhb_branch *b, int kept,
                                   double *out) {
  if (f->n_waves > 0) return sum_waves(f, b, kept, 3, out);
  return sum_up(f, b, kept, 3, f->shape, f->residual_shape, out);
}
