#include "postproc/inspect/mac.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "modal/hdf5/h5.h"
#include "postproc/draw/number_format.h"

enum { MATRIX = 12 }; /* largest number of modes shown as a matrix */

static const double alike = 0.5; /* below this MAC two modes are different */

/* ---------------------------------------------------------------- shapes */

static double extent(const double *x, size_t n) {
  double most = 0;
  for (size_t i = 0; i < n; i++) most = fmax(most, fabs(x[i]));
  return most;
}

static bool near(const double *a, const double *b, size_t n, double tolerance) {
  for (size_t i = 0; i < n; i++)
    if (!(fabs(a[i] - b[i]) <= tolerance)) return false;
  return true;
}

/* True if a dataset has the same shape in both files and equal values. The tolerance is relative to
 * the largest value. */
static shb_status same_values(const hid_t file[2], const char *path, double tolerance, bool *same) {
  h5_shape   shape[2];
  double    *x[2]   = {NULL, NULL};
  shb_status status = SHB_OK;
  *same             = false;
  for (int s = 0; s < 2; s++) SHB_TRY(h5_shape_of(file[s], path, &shape[s]));
  if (shape[0].rank != shape[1].rank ||
      memcmp(shape[0].dim, shape[1].dim, (size_t)shape[0].rank * sizeof(hsize_t)) != 0)
    return SHB_OK;
  for (int s = 0; status == SHB_OK && s < 2; s++)
    status = h5_read_double(file[s], path, &shape[s], &x[s]);
  if (status == SHB_OK)
    *same = near(x[0], x[1], h5_count(shape[0]), tolerance * extent(x[0], h5_count(shape[0])));
  free(x[0]);
  free(x[1]);
  return status;
}

static bool both(const hid_t file[2], const char *path) {
  return h5_exists(file[0], path) && h5_exists(file[1], path);
}

static shb_status compare_meshes(const hid_t file[2], bool *same) {
  *same = false;
  if (!both(file, "/mesh/nodes") || !both(file, "/modes/shape")) return SHB_OK;
  return same_values(file, "/mesh/nodes", 1e-9, same);
}

static shb_status compare_contacts(const hid_t file[2], const modal_model m[2], bool *same) {
  *same = m[0].n_pairs == m[1].n_pairs && m[0].has_left == m[1].has_left;
  if (!*same || !both(file, "/contact/coordinates")) return SHB_OK;
  return same_values(file, "/contact/coordinates", 1e-2, same);
}

/* Index in the second file of each probe of the first, -1: absent. Returns the number of common
 * probes. */
static int common_probes(const modal_model m[2], int *at) {
  int n = 0;
  for (int p = 0; p < m[0].n_probes; p++) {
    at[p] = -1;
    for (int q = 0; q < m[1].n_probes && at[p] < 0; q++)
      if (strcmp(m[0].probe_name[p], m[1].probe_name[q]) == 0) at[p] = q;
    n += at[p] >= 0;
  }
  return n;
}

/* Transpose [value][modes] to [modes][value]. */
static void put_values(double *to, size_t stride, size_t first, const double *from, size_t n,
                       size_t modes) {
  for (size_t v = 0; v < n; v++)
    for (size_t i = 0; i < modes; i++) to[i * stride + first + v] = from[v * modes + i];
}

/* The condensed shapes of file s, [modes][values]. */
static void condensed(const modal_model *m, bool contact, int s, int n_probes, const int *at,
                      size_t values, double *to) {
  const size_t modes = (size_t)m->n_modes, side = 3 * (size_t)m->n_pairs;
  size_t       first = 0;
  if (contact) put_values(to, values, first, m->right, side, modes), first += side;
  if (contact && m->has_left) put_values(to, values, first, m->left, side, modes), first += side;
  for (int p = 0; p < n_probes; p++) {
    if (at[p] < 0) continue;
    put_values(to, values, first, m->probe + 3 * (size_t)(s ? at[p] : p) * modes, 3, modes);
    first += 3;
  }
}

static shb_status condensed_shapes(const modal_model m[2], post_mac *out, double *shape[2]) {
  int *at = calloc((size_t)m[0].n_probes + 1, sizeof *at);
  SHB_CHECK(at, SHB_ERR_IO, "not enough memory to compare the mode shapes");
  out->probes = common_probes(m, at);
  out->values = (out->contact ? modal_model_contact_dofs(&m[0]) : 0) + 3 * out->probes;
  for (int s = 0; s < 2 && out->values > 0; s++) {
    shape[s] = malloc((size_t)m[s].n_modes * (size_t)out->values * sizeof(double));
    if (!shape[s]) break;
    condensed(&m[s], out->contact, s, m[0].n_probes, at, (size_t)out->values, shape[s]);
  }
  free(at);
  SHB_CHECK(out->values > 0, SHB_ERR_INPUT,
            "the mode shapes cannot be compared: other meshes, contact patches that differ in "
            "number or place, and no probe of the same name; files of one mesh, of equal "
            "contact.points, or with a common probe can be");
  SHB_CHECK(shape[0] && shape[1], SHB_ERR_IO, "not enough memory to compare the mode shapes");
  return SHB_OK;
}

static shb_status nodal_shapes(const hid_t file[2], const modal_model m[2], post_mac *out,
                               double *shape[2]) {
  for (int s = 0; s < 2; s++) {
    h5_shape all = H5_SHAPE((hsize_t)m[s].n_modes, 0, 3);
    SHB_TRY(h5_read_double(file[s], "/modes/shape", &all, &shape[s]));
    out->values = 3 * (int)all.dim[1];
  }
  return SHB_OK;
}

/* ---------------------------------------------------------------- MAC */

static double inner(const double *a, const double *b, size_t n) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

static shb_status fill(const modal_model m[2], double *const shape[2], post_mac *out) {
  const size_t n = (size_t)out->values, rows = (size_t)m[0].n_modes, columns = (size_t)m[1].n_modes;
  double      *square = malloc(columns * sizeof *square);
  out->mac            = malloc(rows * columns * sizeof *out->mac);
  if (!square || !out->mac) {
    free(square);
    SHB_FAIL(SHB_ERR_IO, "not enough memory to compare the mode shapes");
  }
  for (size_t j = 0; j < columns; j++) square[j] = inner(shape[1] + j * n, shape[1] + j * n, n);
  for (size_t i = 0; i < rows; i++) {
    const double *a = shape[0] + i * n, own = inner(a, a, n);
    for (size_t j = 0; j < columns; j++) {
      double product = inner(a, shape[1] + j * n, n), size = own * square[j];
      out->mac[i * columns + j] = size > 0 ? product * product / size : 0;
    }
  }
  free(square);
  return SHB_OK;
}

shb_status post_mac_create(const hid_t file[2], const modal_model model[2], post_mac *out) {
  double    *shape[2] = {NULL, NULL};
  shb_status status;
  *out   = (post_mac){.n = {model[0].n_modes, model[1].n_modes}};
  status = compare_meshes(file, &out->nodes);
  if (status == SHB_OK && out->nodes) {
    status = nodal_shapes(file, model, out, shape);
  } else if (status == SHB_OK) {
    status = compare_contacts(file, model, &out->contact);
    if (status == SHB_OK) status = condensed_shapes(model, out, shape);
  }
  if (status == SHB_OK) status = fill(model, shape, out);
  free(shape[0]);
  free(shape[1]);
  return status;
}

void post_mac_free(post_mac *mac) {
  free(mac->mac);
  *mac = (post_mac){0};
}

/* ---------------------------------------------------------------- as text */

static void put_basis(const post_mac *mac, const modal_model *m, post_buffer *out) {
  if (mac->nodes) {
    post_put(out, "  MAC of the shapes at all %d nodes of the same mesh\n", mac->values / 3);
    return;
  }
  post_put(out, "  the meshes differ: MAC of %d condensed values:", mac->values);
  if (mac->contact)
    post_put(out, " %d contact pair%s, %s side%s", m->n_pairs, m->n_pairs == 1 ? "" : "s",
             m->has_left ? "both" : "one", m->has_left ? "s" : "");
  if (mac->probes)
    post_put(out, "%s %d common probe%s", mac->contact ? "," : "", mac->probes,
             mac->probes == 1 ? "" : "s");
  post_put(out, "\n");
  if (mac->values < mac->n[0] || mac->values < mac->n[1])
    post_put(out,
             "  (fewer values than modes: different modes may look alike; more contact.points "
             "or probes tell them apart)\n");
}

static void put_pair(const post_mac *mac, const modal_model m[2], int i, post_buffer *out) {
  const double *row  = mac->mac + (size_t)i * (size_t)mac->n[1];
  int           best = 0;
  char          a[POST_NUMBER], b[POST_NUMBER];
  for (int j = 1; j < mac->n[1]; j++)
    if (row[j] > row[best]) best = j;
  post_put(out, "  %5d", i + 1);
  post_put_column(out, 13, post_plain(a, m[0].frequency[i], 6));
  if (row[best] < alike) {
    post_put(out, "%7s %12s %11s %7.3f\n", "-", "none alike", "", row[best]);
    return;
  }
  double change = 100 * (m[1].frequency[best] / m[0].frequency[i] - 1);
  post_put(out, "%7d", best + 1);
  post_put_column(out, 13, post_plain(b, m[1].frequency[best], 6));
  post_put(out, " %+11.3g %7.3f\n", fabs(change) < 1e-10 ? 0. : change, row[best]);
}

static void put_matrix(const post_mac *mac, post_buffer *out) {
  post_put(out, "\n  MAC: modes of A down, of B across\n        ");
  for (int j = 0; j < mac->n[1]; j++) post_put(out, "%6d", j + 1);
  post_put(out, "\n");
  for (int i = 0; i < mac->n[0]; i++) {
    post_put(out, "  %5d ", i + 1);
    for (int j = 0; j < mac->n[1]; j++)
      post_put(out, "%6.3f", mac->mac[(size_t)i * (size_t)mac->n[1] + (size_t)j]);
    post_put(out, "\n");
  }
}

static shb_status put_file(hid_t file, const char *path, char letter, const modal_model *m,
                           post_buffer *out) {
  double speed;
  char   text[POST_NUMBER];
  SHB_TRY(h5_read_attribute_double(file, "/", "rotor_speed", NAN, &speed));
  post_put(out, "%c  %s  %d modes, %d contact pair%s", letter, path, m->n_modes, m->n_pairs,
           m->n_pairs == 1 ? "" : "s");
  if (speed > 0) post_put(out, ", at %s rad/s", post_plain(text, speed, 6));
  if (speed == 0) post_put(out, ", at rest");
  post_put(out, "\n");
  return SHB_OK;
}

static shb_status put_all(const hid_t file[2], const char *const path[2], const modal_model m[2],
                          bool all, post_buffer *out) {
  post_mac   mac;
  shb_status status = SHB_OK;
  for (int s = 0; status == SHB_OK && s < 2; s++)
    status = put_file(file[s], path[s], s ? 'B' : 'A', &m[s], out);
  SHB_TRY(status);
  status = post_mac_create(file, m, &mac);
  if (status == SHB_OK) {
    put_basis(&mac, m, out);
    post_put(out, "\n  %5s %12s%7s %12s %11s %7s\n", "A", "Hz", "B", "Hz", "change, %", "MAC");
    for (int i = 0; i < mac.n[0]; i++) put_pair(&mac, m, i, out);
    if (all || (mac.n[0] <= MATRIX && mac.n[1] <= MATRIX))
      put_matrix(&mac, out);
    else
      post_put(out, "  (--verbose shows the whole matrix)\n");
  }
  post_mac_free(&mac);
  return status;
}

shb_status post_compare(const char *const path[2], bool all, post_buffer *out) {
  modal_model m[2]    = {{0}};
  hid_t       file[2] = {-1, -1};
  shb_status  status  = SHB_OK;
  for (int s = 0; status == SHB_OK && s < 2; s++) status = modal_model_read(path[s], &m[s]);
  for (int s = 0; status == SHB_OK && s < 2; s++) status = h5_open(path[s], &file[s]);
  if (status == SHB_OK) status = put_all(file, path, m, all, out);
  for (int s = 0; s < 2; s++) {
    if (file[s] >= 0) H5Fclose(file[s]);
    modal_model_free(&m[s]);
  }
  if (out->failed) SHB_FAIL(SHB_ERR_IO, "not enough memory to compare %s and %s", path[0], path[1]);
  return status;
}
