#include "postproc/field/strain_gauge.h"

#include <math.h>
#include <stdlib.h>

#include "mesh/base/vec3.h"
#include "mesh/core/faces.h"
#include "mesh/core/triangle.h"
#include "postproc/analysis/outputs.h"
#include "postproc/field/kept_point.h"

enum { STEPS = 20 }; /* of Newton's method for the reference coordinates */

/* The strain of a field is the sum of row . u over the nodes of one element. */
typedef struct {
  int    n, node[MESH_NODES];
  double row[MESH_NODES][3];
} functional;

/* The nearest point of the surface; face <- the nodes of its face. */
static double find_foot(const mesh_fe *mesh, const mesh_face_set *faces, post_gauge *gauge,
                        const int **face, double normal[3]) {
  const int each  = mesh_topology_of(mesh->kind)->face_nodes;
  double    least = INFINITY;
  for (int f = 0; f < faces->n; f++) {
    const int    *nodes = faces->nodes + (size_t)each * (size_t)f;
    mesh_triangle part[MESH_TRIANGLES];
    const int     n = mesh_triangles(mesh, nodes, part);
    for (int t = 0; t < n; t++) {
      double       foot[3];
      const double far = mesh_triangle_closest(&part[t], gauge->at, foot, NULL);
      if (far >= least) continue;
      least = far;
      *face = nodes;
      mesh_triangle_area(&part[t], normal);
      for (int d = 0; d < 3; d++) gauge->foot[d] = foot[d];
    }
  }
  return least;
}

/* The element that has all corners of a face. */
static int element_of(const mesh_fe *mesh, const int *face) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  for (int e = 0; e < mesh->n_elements; e++) {
    const int *node  = mesh->connectivity + (size_t)topology->nodes * (size_t)e;
    int        found = 0;
    for (int i = 0; i < topology->corners; i++)
      for (int c = 0; c < topology->face_corners; c++) found += node[i] == face[c];
    if (found == topology->face_corners) return e;
  }
  return -1;
}

/* x, and the columns dx/dr, dx/ds, dx/dt at a reference point. */
static void map_point(const mesh_fe *mesh, const int *node, double gradient[MESH_NODES][3],
                      const double *shape, double x[3], double column[3][3]) {
  const int n = mesh_topology_of(mesh->kind)->nodes;
  for (int d = 0; d < 3; d++) x[d] = column[0][d] = column[1][d] = column[2][d] = 0;
  for (int i = 0; i < n; i++) {
    const double *at = mesh->coordinates + 3 * (size_t)node[i];
    for (int d = 0; d < 3; d++) {
      x[d] += shape[i] * at[d];
      for (int c = 0; c < 3; c++) column[c][d] += gradient[i][c] * at[d];
    }
  }
}

/* Rows of the inverse of the matrix with these columns. */
static void invert(double column[3][3], double row[3][3]) {
  for (int c = 0; c < 3; c++) vec3_cross(column[(c + 1) % 3], column[(c + 2) % 3], row[c]);
  const double det = vec3_dot(column[0], row[0]);
  for (int c = 0; c < 3; c++)
    for (int d = 0; d < 3; d++) row[c][d] /= det;
}

/* Gradients of the shape functions at the foot, in mesh axes, times the direction. */
static void set_functional(const mesh_fe *mesh, int element, const post_gauge *gauge,
                           functional *f) {
  const int  n     = mesh_topology_of(mesh->kind)->nodes;
  const int *node  = mesh->connectivity + (size_t)n * (size_t)element;
  double     at[3] = {0.3, 0.3, 0.3}, shape[MESH_NODES], gradient[MESH_NODES][3];
  double     x[3], column[3][3], row[3][3];
  for (int step = 0; step < STEPS; step++) {
    mesh_shape(mesh->kind, at, shape, gradient);
    map_point(mesh, node, gradient, shape, x, column);
    invert(column, row);
    vec3_minus(gauge->foot, x, x);
    for (int c = 0; c < 3; c++) at[c] += vec3_dot(row[c], x);
  }
  f->n = n;
  for (int i = 0; i < n; i++) {
    double slope = 0;
    for (int c = 0; c < 3; c++) slope += gradient[i][c] * vec3_dot(row[c], gauge->along);
    f->node[i] = node[i];
    for (int d = 0; d < 3; d++) f->row[i][d] = slope * gauge->along[d];
  }
}

static double apply(const functional *f, const double *displacement) {
  double sum = 0;
  for (int i = 0; i < f->n; i++) sum += vec3_dot(f->row[i], displacement + 3 * (size_t)f->node[i]);
  return sum;
}

static double complex apply_to_wave(const functional *f, const double complex *displacement) {
  double complex sum = 0;
  for (int i = 0; i < f->n; i++)
    for (int d = 0; d < 3; d++)
      sum += f->row[i][d] * displacement[3 * (size_t)f->node[i] + (size_t)d];
  return sum;
}

static void evaluate_wave(const post_blade_field *field, const functional *f, int i,
                          post_gauge *gauge) {
  const post_wave_field *w = &field->wave[i];
  const size_t           n = 3 * (size_t)field->n_nodes, m = (size_t)field->n_modes;
  const size_t           columns = (size_t)field->n_column;
  if (!w->shape) return; /* no harmonic has it */
  for (size_t k = 0; k < m; k++)
    gauge->mode[(size_t)i * m + k] = apply_to_wave(f, w->shape + n * k);
  for (size_t c = 0; c < columns; c++)
    gauge->residual[(size_t)i * columns + c] = apply_to_wave(f, w->residual_shape + n * c);
}

static shb_status evaluate(const post_blade_field *field, const functional *f, post_gauge *gauge) {
  const size_t n     = 3 * (size_t)field->n_nodes,
               waves = field->n_waves > 0 ? (size_t)field->n_waves : 1;
  gauge->mode        = calloc(waves * (size_t)field->n_modes + 1, sizeof *gauge->mode);
  gauge->residual    = calloc(waves * (size_t)field->n_column + 1, sizeof *gauge->residual);
  SHB_CHECK(gauge->mode && gauge->residual, SHB_ERR_IO, "out of memory for the gauge %s",
            gauge->name);
  for (int i = 0; i < field->n_waves; i++) evaluate_wave(field, f, i, gauge);
  for (int i = 0; i < field->n_modes && field->shape; i++)
    gauge->mode[i] = apply(f, field->shape + n * (size_t)i);
  for (int c = 0; c < field->n_column && field->residual_shape; c++)
    gauge->residual[c] = apply(f, field->residual_shape + n * (size_t)c);
  gauge->at_speed = field->static_displacement ? apply(f, field->static_displacement) : NAN;
  return SHB_OK;
}

/* along <- the direction without its part along the normal, of unit length; false if little of it
 * is left. */
static bool set_along(const double normal[3], post_gauge *gauge) {
  const double square = vec3_dot(normal, normal);
  const double part   = vec3_dot(gauge->direction, normal) / square;
  for (int d = 0; d < 3; d++) gauge->along[d] = gauge->direction[d] - part * normal[d];
  const double left = vec3_norm(gauge->along);
  for (int d = 0; d < 3; d++) gauge->along[d] /= left;
  return left > 0.1 * vec3_norm(gauge->direction);
}

static shb_status place(const post_blade_field *field, const mesh_face_set *faces,
                        post_gauge *gauge) {
  const mesh_fe *mesh = &field->mesh;
  const int     *face = NULL;
  double         normal[3];
  functional     f;
  const double   far = find_foot(mesh, faces, gauge, &face, normal);
  SHB_CHECK(far <= MESH_FE_NEAR * mesh_fe_extent(mesh), SHB_ERR_INPUT,
            "gauge.%s.at: is %.4g mm from the surface of the blade%s", gauge->name, 1e3 * far,
            mesh_unit_hint(mesh_fe_extent(mesh), mesh->unit_given));
  SHB_CHECK(
      set_along(normal, gauge), SHB_ERR_INPUT,
      "gauge.%s.direction: is normal to the surface there, whose normal is [%.3f, %.3f, %.3f]",
      gauge->name, normal[0] / vec3_norm(normal), normal[1] / vec3_norm(normal),
      normal[2] / vec3_norm(normal));
  set_functional(mesh, element_of(mesh, face), gauge, &f);
  return evaluate(field, &f, gauge);
}

shb_status post_gauge_place(const post_blade_field *field, post_gauge *gauge) {
  mesh_face_set faces = {0};
  mesh_faces_outer(&field->mesh, NULL, &faces);
  shb_status status = place(field, &faces, gauge);
  free(faces.nodes);
  return status;
}

void post_gauge_free(post_gauge *gauge) {
  free(gauge->mode);
  free(gauge->residual);
  gauge->mode = gauge->residual = NULL;
}

shb_status post_gauge_strain(const post_blade_field *field, const post_gauge *gauge,
                             const mhb_branch *b, int kept, double complex *strain) {
  const size_t          K = (size_t)b->n_harmonics + 1, m = (size_t)field->n_modes;
  const size_t          columns = (size_t)field->n_column;
  const double complex *q       = b->modal.amplitude + (size_t)kept * K * m;
  double complex       *force   = malloc(columns * sizeof *force + 1);
  SHB_CHECK(force, SHB_ERR_IO, "out of memory for the gauge %s", gauge->name);
  for (size_t k = 0; k < K; k++) {
    bool      backward;
    const int wave = post_blade_wave(field, b, (int)k, &backward);
    strain[k]      = 0;
    if (wave < 0) continue; /* above those that move */
    const double complex *mode     = gauge->mode + (size_t)wave * m;
    const double complex *residual = gauge->residual + (size_t)wave * columns;
    for (size_t i = 0; i < m; i++) strain[k] += q[k * m + i] * (backward ? conj(mode[i]) : mode[i]);
    post_blade_forces(field, b, kept, (int)k, force);
    for (size_t c = 0; c < columns; c++)
      strain[k] += force[c] * (backward ? conj(residual[c]) : residual[c]);
  }
  free(force);
  return SHB_OK;
}

static void put_row(const post_gauge *gauge, const mhb_branch *b, int branch, int point,
                    const double complex *strain, post_buffer *out) {
  post_put_kept_point(b, branch, point, out);
  post_put(out, ",");
  post_put_csv(out, gauge->name);
  post_put_cell(out, cabs(strain[b->order]));
  post_put_cell(out, post_peak_to_peak(1, b->n_harmonics, strain));
  post_put_cell(out, creal(strain[0]));
  post_put_cell(out, gauge->at_speed);
  post_put(out, "\r\n");
}

shb_status post_gauge_table(const post_blade_field *field, const mhb_response *response,
                            int n_gauges, const post_gauge *gauge, post_buffer *out) {
  post_put(out,
           "branch,kind,n0_N,frequency_Hz,point,special,stable,gauge,amplitude,peak_to_peak,mean,"
           "static\r\n");
  for (int i = 0; i < response->n_branches; i++) {
    const mhb_branch *b      = &response->branch[i];
    double complex   *strain = malloc(((size_t)b->n_harmonics + 1) * sizeof *strain);
    shb_status        status = SHB_OK;
    SHB_CHECK(strain, SHB_ERR_IO, "out of memory for the gauges");
    for (int a = 0; a < b->modal.n * n_gauges && status == SHB_OK; a++) {
      const int         kept = a / n_gauges;
      const post_gauge *one  = &gauge[a % n_gauges];
      status                 = post_gauge_strain(field, one, b, kept, strain);
      put_row(one, b, i, b->modal.point[kept], strain, out);
    }
    free(strain);
    SHB_TRY(status);
  }
  SHB_CHECK(!out->failed, SHB_ERR_IO, "out of memory for the gauges");
  return SHB_OK;
}
