#include "modal/model/joined_pairs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"

void modal_shroud_axes(double psi, double phi, double T0[3][3]) {
  double cs = cos(psi), ss = sin(psi), cf = cos(phi), sf = sin(phi);
  double T[3][3] = {{cs * cf, -ss, cs * sf}, {ss * cf, cs, ss * sf}, {-sf, 0, cf}};
  memcpy(T0, T, sizeof T);
}

void modal_normal_angles(const double normal[3], double *psi, double *phi) {
  *psi = atan2(normal[1], normal[0]);
  *phi = -atan2(normal[2], hypot(normal[0], normal[1]));
}

int modal_joinable(const modal_model *model) {
  return model->position ? model->n_pairs : 0;
}

/* ---------------------------------------------------------------- patches */

typedef struct {
  double key; /* position along the cut, m */
  int    pair;
} site;

static int compare(const void *a, const void *b) {
  const site *x = a, *y = b;
  if (x->key != y->key) return x->key < y->key ? -1 : 1;
  return x->pair - y->pair;
}

static double area_of(const modal_model *model, int pair) {
  return model->area ? model->area[pair] : 1;
}

/* Unit vector along which the sites spread most, by power iteration on their covariance. */
static void longest_extent(const modal_model *model, const site *sites, int n, double axis[3]) {
  double centre[3] = {0}, C[3][3] = {{0}}, total = 0;
  for (int i = 0; i < n; i++) {
    double area = area_of(model, sites[i].pair);
    total += area;
    for (int d = 0; d < 3; d++) centre[d] += area * model->position[3 * sites[i].pair + d];
  }
  for (int i = 0; i < n; i++)
    for (int d = 0; d < 3; d++)
      for (int e = 0; e < 3; e++)
        C[d][e] += area_of(model, sites[i].pair) *
                   (model->position[3 * sites[i].pair + d] - centre[d] / total) *
                   (model->position[3 * sites[i].pair + e] - centre[e] / total);
  double v[3] = {0.62, 0.51, 0.59}; /* not along an axis of a mesh */
  for (int sweep = 0; sweep < 60; sweep++) {
    double w[3], length = 0;
    for (int d = 0; d < 3; d++) {
      w[d] = C[d][0] * v[0] + C[d][1] * v[1] + C[d][2] * v[2];
      length += w[d] * w[d];
    }
    if (!(length > 0)) break;
    for (int d = 0; d < 3; d++) v[d] = w[d] / sqrt(length);
  }
  memcpy(axis, v, sizeof v);
}

/* Cut sites into two parts by area, each with a site for every patch at least. */
static void bisect(const modal_model *model, site *sites, int n, int first, int patches,
                   modal_joining *j) {
  if (patches == 1) {
    for (int i = 0; i < n; i++) j->patch[sites[i].pair] = first;
    return;
  }
  double axis[3], total = 0, sum = 0;
  int    lower = patches / 2, cut = 0;
  longest_extent(model, sites, n, axis);
  for (int i = 0; i < n; i++) {
    const double *x = model->position + 3 * sites[i].pair;
    sites[i].key    = axis[0] * x[0] + axis[1] * x[1] + axis[2] * x[2];
    total += area_of(model, sites[i].pair);
  }
  qsort(sites, (size_t)n, sizeof *sites, compare);
  while (cut < n && sum + area_of(model, sites[cut].pair) / 2 <= total * lower / patches)
    sum += area_of(model, sites[cut++].pair);
  if (cut < lower) cut = lower;
  if (n - cut < patches - lower) cut = n - (patches - lower);
  bisect(model, sites, cut, first, lower, j);
  bisect(model, sites + cut, n - cut, first + lower, patches - lower, j);
}

static int interface_of(const modal_model *model, int pair) {
  return model->interface ? model->interface[pair] : 0;
}

/* Patches of an interface: in proportion to its pairs, one at least, as many as are left at most.
 */
static int part_of(const modal_model *model, int patches, int left, int n, int interfaces_left) {
  int part = (int)lround((double)patches * n / model->n_pairs);
  if (interfaces_left == 1) part = left;
  if (part < 1) part = 1;
  if (part > n) part = n;
  return part > left - (interfaces_left - 1) ? left - (interfaces_left - 1) : part;
}

static void axes_of(const modal_model *model, int pair, double T0[3][3]) {
  double psi, phi;
  modal_normal_angles(model->normal + 3 * pair, &psi, &phi);
  modal_shroud_axes(psi, phi, T0);
}

/* Unit mean of the normals of each patch by area: normal[patch][3]. */
static void mean_normals(const modal_model *model, const modal_joining *j, double *normal) {
  memset(normal, 0, 3 * (size_t)j->n_patches * sizeof *normal);
  for (int i = 0; i < j->n_pairs; i++)
    for (int d = 0; d < 3; d++)
      normal[3 * j->patch[i] + d] += j->weight[i] * model->normal[3 * i + d];
  for (int a = 0; a < j->n_patches; a++) {
    double *v = normal + 3 * a, length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int d = 0; d < 3 && length > 0; d++) v[d] /= length;
  }
}

/* Of the normals of pairs, in their own cylindrical axes as the motion of a patch. */
static double spread_of(const modal_model *model, const modal_joining *j, const double *normal) {
  double least = 1;
  for (int i = 0; i < j->n_pairs; i++) {
    const double *a = model->normal + 3 * (size_t)i, *b = normal + 3 * (size_t)j->patch[i];
    const double  length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    least                = fmin(least, (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / length);
  }
  return acos(fmax(-1, least)) * 180 / SHB_PI;
}

/* turn = T0_patch T0_pair^T; the identity without normals, where all pairs have the same axes. */
static void set_turns(const modal_model *model, modal_joining *j) {
  for (int i = 0; i < j->n_pairs; i++)
    for (int d = 0; d < 3; d++) j->turn[9 * i + 4 * d] = 1;
  if (!model->normal) return;
  double *normal = shb_alloc(3 * (size_t)j->n_patches, sizeof *normal);
  mean_normals(model, j, normal);
  j->spread = spread_of(model, j, normal);
  for (int i = 0; i < j->n_pairs; i++) {
    double to[3][3], from[3][3], psi, phi;
    modal_normal_angles(normal + 3 * j->patch[i], &psi, &phi);
    modal_shroud_axes(psi, phi, to);
    axes_of(model, i, from);
    for (int d = 0; d < 3; d++)
      for (int e = 0; e < 3; e++)
        j->turn[9 * i + 3 * d + e] =
            to[d][0] * from[e][0] + to[d][1] * from[e][1] + to[d][2] * from[e][2];
  }
  free(normal);
}

static void set_weights(const modal_model *model, modal_joining *j) {
  double *total = shb_alloc_zeroed((size_t)j->n_patches, sizeof *total);
  for (int i = 0; i < j->n_pairs; i++) total[j->patch[i]] += area_of(model, i);
  for (int i = 0; i < j->n_pairs; i++) j->weight[i] = area_of(model, i) / total[j->patch[i]];
  free(total);
}

shb_status modal_joining_create(const modal_model *model, int patches, modal_joining *j) {
  const size_t n          = (size_t)model->n_pairs;
  const int    interfaces = model->n_interfaces > 1 ? model->n_interfaces : 1;
  *j                      = (modal_joining){.n_pairs = model->n_pairs, .n_patches = patches};
  SHB_CHECK(model->position, SHB_ERR_INPUT,
            "the modal file has no /contact/coordinates, by which contact pairs are joined to "
            "patches; give contact.points as a number");
  SHB_CHECK(patches >= interfaces && patches <= model->n_pairs, SHB_ERR_INPUT,
            "%d patches asked of %d contact pairs on %d faces", patches, model->n_pairs,
            interfaces);
  site *sites = shb_alloc(n, sizeof *sites);
  j->patch    = shb_alloc(n, sizeof *j->patch);
  j->weight   = shb_alloc(n, sizeof *j->weight);
  j->turn     = shb_alloc_zeroed(9 * n, sizeof *j->turn);
  for (int f = 0, first = 0; f < interfaces; f++) {
    int found = 0;
    for (int i = 0; i < j->n_pairs; i++)
      if (interface_of(model, i) == f) sites[found++] = (site){0, i};
    int part = part_of(model, patches, patches - first, found, interfaces - f);
    bisect(model, sites, found, first, part, j);
    first += part;
  }
  set_weights(model, j);
  set_turns(model, j);
  free(sites);
  return SHB_OK;
}

void modal_joining_free(modal_joining *j) {
  free(j->patch);
  free(j->weight);
  free(j->turn);
  *j = (modal_joining){0};
}

/* ---------------------------------------------------------------- model */

/* to[rows of patches][n] += the mean of from[rows of pairs][n], three rows each, on every side. A
 * complex number counts as two. */
static double *mean_rows(const modal_joining *j, int sides, const double *from, size_t n) {
  const size_t pairs = 3 * (size_t)j->n_pairs, patches = 3 * (size_t)j->n_patches;
  if (!from) return NULL;
  double *to = shb_alloc_zeroed((size_t)sides * patches * n, sizeof *to);
  for (size_t row = 0; row < (size_t)sides * pairs; row++) {
    size_t side = row / pairs, pair = row % pairs / 3, axis = row % 3;
    for (size_t d = 0; d < 3; d++) {
      double  part = j->weight[pair] * j->turn[9 * pair + 3 * d + axis];
      double *out  = to + (side * patches + 3 * (size_t)j->patch[pair] + d) * n;
      for (size_t i = 0; i < n && part != 0; i++) out[i] += part * from[row * n + i];
    }
  }
  return to;
}

/* [rows][columns] -> [columns][rows], numbers of so many doubles. */
static double *transposed(const double *from, size_t rows, size_t columns, size_t size) {
  double *to = from ? shb_alloc(rows * columns * size, sizeof *to) : NULL;
  for (size_t i = 0; to && i < rows; i++)
    for (size_t k = 0; k < columns; k++)
      memcpy(to + (k * rows + i) * size, from + (i * columns + k) * size, size * sizeof *to);
  return to;
}

/* The mean over the columns of from[rows][contact]. */
static double *mean_columns(const modal_joining *j, int sides, const double *from, size_t rows,
                            size_t size) {
  const size_t pairs = 3 * (size_t)(sides * j->n_pairs), n = 3 * (size_t)(sides * j->n_patches);
  double      *turned = transposed(from, rows, pairs, size);
  double      *mean   = mean_rows(j, sides, turned, rows * size);
  double      *out    = transposed(mean, n, rows, size);
  free(turned);
  free(mean);
  return out;
}

/* The mean over rows and columns, made symmetric (sign 1) or skew (-1): round-off of the two sums
 * differs. */
static double *mean_both(const modal_joining *j, int sides, const double *from, double sign) {
  const size_t n    = 3 * (size_t)(sides * j->n_patches);
  double      *rows = mean_rows(j, sides, from, 3 * (size_t)(sides * j->n_pairs));
  double      *out  = mean_columns(j, sides, rows, n, 1);
  for (size_t i = 0; out && i < n; i++)
    for (size_t k = 0; k < i; k++) {
      out[i * n + k] = (out[i * n + k] + sign * out[k * n + i]) / 2;
      out[k * n + i] = sign * out[i * n + k];
    }
  free(rows);
  return out;
}

/* A mean of motions has a tail of at most the squared mean of the roots of their tails. */
static double *bound_tails(const modal_joining *j, int sides, const double *from) {
  const size_t pairs = 3 * (size_t)j->n_pairs, patches = 3 * (size_t)j->n_patches;
  if (!from) return NULL;
  double *to = shb_alloc_zeroed(2 * (size_t)sides * patches, sizeof *to);
  for (size_t row = 0; row < (size_t)sides * pairs; row++) {
    size_t side = row / pairs, pair = row % pairs / 3, axis = row % 3;
    for (size_t d = 0; d < 3; d++)
      for (size_t t = 0; t < 2; t++)
        to[2 * (side * patches + 3 * (size_t)j->patch[pair] + d) + t] +=
            j->weight[pair] * fabs(j->turn[9 * pair + 3 * d + axis]) * sqrt(from[2 * row + t]);
  }
  for (size_t i = 0; i < 2 * (size_t)sides * patches; i++) to[i] *= to[i];
  return to;
}

/* Areas add up, positions are means, and normals unit means. What is numbered has the number of a
 * pair of the patch. */
static void *describe_patches(const modal_dataset *row, const modal_model *a,
                              const modal_joining *j) {
  const size_t patches = (size_t)j->n_patches;
  const size_t each    = row->dims[1] ? (size_t)modal_size_of(a, row->dims[1]) : 1;
  const void  *from    = modal_dataset_get(row, a);
  if (row->kind == MODAL_INDEX) {
    int *to = shb_alloc_zeroed(patches, sizeof *to);
    for (int i = 0; i < j->n_pairs; i++) to[j->patch[i]] = ((const int *)from)[i];
    return to;
  }
  double *to = shb_alloc_zeroed(each * patches, sizeof *to);
  if (from == a->normal) {
    mean_normals(a, j, to);
    return to;
  }
  for (int i = 0; i < j->n_pairs; i++)
    for (size_t d = 0; d < each; d++)
      to[each * (size_t)j->patch[i] + d] +=
          (each > 1 ? j->weight[i] : 1) * ((const double *)from)[each * (size_t)i + d];
  return to;
}

/* An array of the contact by its dimensions; of: whose sizes a has. sign: of the transpose of a
 * residual matrix. */
static void *joined_array(const modal_dataset *row, const modal_model *of, const modal_model *a,
                          const modal_joining *j, double sign) {
  const double *from  = modal_dataset_get(row, a);
  const int     sides = of->has_left ? 2 : 1;
  const char   *dims  = row->dims;
  if (!from) return NULL;
  if (strcmp(dims, "p3m") == 0 || strcmp(dims, "l3m") == 0)
    return mean_rows(j, 1, from, (size_t)of->n_modes);
  if (dims[0] == 'p') return describe_patches(row, a, j);
  if (strcmp(dims, "cc") == 0) return mean_both(j, sides, from, sign);
  if (row->part == MODAL_TAIL) return bound_tails(j, sides, from);
  if (dims[0] == 'c') return mean_rows(j, sides, from, (size_t)modal_size_of(of, dims[1]));
  return mean_columns(j, sides, from, (size_t)modal_size_of(of, dims[0]),
                      modal_dataset_width(row) / sizeof(double));
}

/* The arrays of a, whose sizes are those of `of`, joined. */
static void join_arrays(const modal_model *of, const modal_model *a, const modal_joining *j,
                        double sign, modal_model *b) {
  *b         = modal_model_sizes(of);
  b->n_pairs = j->n_patches;
  for (const modal_dataset *row = modal_datasets; row->path; row++) {
    void *data = strpbrk(row->dims, "plc") ? joined_array(row, of, a, j, sign)
                                           : modal_dataset_copy(row, of, a);
    modal_dataset_set(row, b, data);
  }
}

void modal_join(const modal_model *a, const modal_joining *j, modal_model *b) {
  join_arrays(a, a, j, 1, b);
}

void modal_join_diameters(const modal_nodal_diameters *a, const modal_joining *j,
                          modal_nodal_diameters *b) {
  modal_nodal_diameters_create(a->blades, a->n, b);
  for (int i = 0; i < a->n; i++) {
    const modal_model *of = &a->model[i];
    b->diameter[i]        = a->diameter[i];
    join_arrays(of, of, j, 1, &b->model[i]);
    join_arrays(of, &a->imaginary[i], j, -1, &b->imaginary[i]);
    join_arrays(of, &a->backward[i], j, 1, &b->backward[i]);
  }
}

void modal_joining_spread(const modal_joining *j, int sides, const double complex *force,
                          double complex *out) {
  for (int side = 0; side < sides; side++)
    for (int i = 0; i < j->n_pairs; i++) {
      const double complex *from = force + 3 * (side * j->n_patches + j->patch[i]);
      double complex       *to   = out + 3 * (side * j->n_pairs + i);
      const double         *turn = j->turn + 9 * i;
      for (int d = 0; d < 3; d++)
        to[d] = j->weight[i] * (turn[d] * from[0] + turn[3 + d] * from[1] + turn[6 + d] * from[2]);
    }
}
