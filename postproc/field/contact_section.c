#include "postproc/field/contact_section.h"

#include <math.h>
#include <stdlib.h>

#include "mesh/base/vec3.h"
#include "postproc/draw/colour.h"
#include "postproc/draw/number_format.h"
#include "postproc/draw/plot.h"

enum { MOST_CURVES = 6, CELLS = 600, FINEST = 4, MAPS = 3, DIGITS = 3 };
enum { WIDTH = 1000, MAP_WIDTH = 300, MAP_HEIGHT = 180, LEFT = 10, TOP = 46, FOOT = 12 };

/* Largest and least value of an even map differ by less than this share. */
static const double even = 1e-6;

/* The nodes of the face as seen from outside: x to the right, y up, m. */
typedef struct {
  double *at; /* [n_nodes][2] */
  double  low[2], high[2];
} view;

/* A curve at its highest peak. */
typedef struct {
  int               branch, row;
  double            work; /* J in a period */
  post_contact_maps maps;
} curve;

/* ---------------------------------------------------------------- view */

/* Sum of the normals of the elements, by their first three corners. */
static void mean_normal(const post_contact_face *f, double normal[3]) {
  const mesh_topology *t = mesh_topology_of(f->kind);
  normal[0] = normal[1] = normal[2] = 0;
  for (int e = 0; e < f->n_elements; e++) {
    const int *node = f->element + e * t->face_nodes;
    double     a[3], b[3], c[3];
    vec3_minus(f->node + 3 * node[1], f->node + 3 * node[0], a);
    vec3_minus(f->node + 3 * node[2], f->node + 3 * node[0], b);
    vec3_cross(a, b, c);
    for (int d = 0; d < 3; d++) normal[d] += c[d];
  }
  const double length = vec3_norm(normal);
  for (int d = 0; d < 3; d++) normal[d] /= length;
}

/* The part of a direction in the plane, as a unit vector; its length before. */
static double into_plane(const double direction[3], const double normal[3], double out[3]) {
  const double along = vec3_dot(direction, normal);
  for (int d = 0; d < 3; d++) out[d] = direction[d] - along * normal[d];
  const double length = vec3_norm(out);
  for (int d = 0; d < 3; d++) out[d] /= length;
  return length;
}

/* Up is the radial direction, or the axial one where the face looks outwards. */
static shb_status look(const post_contact_face *f, mesh_axis axis, view *v) {
  double centre[3] = {0, 0, 0}, axes[3][3], normal[3], up[3], right[3];
  v->at            = malloc(2 * (size_t)f->n_nodes * sizeof *v->at);
  SHB_CHECK(v->at, SHB_ERR_IO, "out of memory for the picture of the contact face");
  for (int i = 0; i < f->n_nodes; i++)
    for (int d = 0; d < 3; d++) centre[d] += f->node[3 * i + d] / f->n_nodes;
  mesh_axes_at(axis, centre, axes);
  mean_normal(f, normal);
  if (into_plane(axes[2], normal, up) < .2) into_plane(axes[1], normal, up);
  vec3_cross(up, normal, right);
  for (int d = 0; d < 2; d++) v->low[d] = INFINITY, v->high[d] = -INFINITY;
  for (int i = 0; i < f->n_nodes; i++)
    for (int d = 0; d < 2; d++) {
      const double x   = vec3_dot(f->node + 3 * i, d ? up : right);
      v->at[2 * i + d] = x;
      v->low[d]        = fmin(v->low[d], x);
      v->high[d]       = fmax(v->high[d], x);
    }
  return SHB_OK;
}

/* ---------------------------------------------------------------- maps */

/* Map i of a peak, [n_nodes]. */
static const double *map_of(const curve *c, const post_contact_face *f, int i) {
  const double *const map[MAPS] = {c->maps.dissipation, c->maps.slip, c->maps.pressure};
  return map[i] + (size_t)c->row * (size_t)f->n_nodes;
}

typedef struct {
  double least, most;
} range;

static range range_of(const post_contact_face *f, const double *map) {
  range r = {INFINITY, -INFINITY};
  for (int i = 0; i < f->n_nodes; i++) r = (range){fmin(r.least, map[i]), fmax(r.most, map[i])};
  return r;
}

static bool is_even(range r) {
  return r.most - r.least <= even * fmax(fabs(r.most), fabs(r.least));
}

static double sum(const double *shape, int n, const int *node, const double *value, int each,
                  int offset) {
  double total = 0;
  for (int i = 0; i < n; i++) total += shape[i] * value[each * node[i] + offset];
  return total;
}

/* One map of the face in the picture. */
typedef struct {
  const post_contact_face *face;
  const view              *v;
  const double            *map;
  range                    over;
  double                   left, top, scale; /* px, px, px a metre */
  post_buffer             *out;
} picture;

/* A small cell of an element: its corners in the picture, the colour of its middle. */
static void put_cell(const picture *p, const int *node, int n, const double corner[][2]) {
  const mesh_kind kind      = p->face->kind;
  const int       each      = mesh_topology_of(kind)->face_nodes;
  double          middle[2] = {0, 0}, shape[MESH_FACE_NODES], gradient[MESH_FACE_NODES][2];
  char            colour[8];
  for (int i = 0; i < n; i++)
    for (int d = 0; d < 2; d++) middle[d] += corner[i][d] / n;
  mesh_face_shape(kind, middle, shape, gradient);
  const double value = sum(shape, each, node, p->map, 1, 0), least = p->over.least;
  const double share = is_even(p->over) ? 0 : (value - least) / (p->over.most - least);
  post_colour(fmin(fmax(share, 0), 1), false, colour);
  post_put(p->out, "<path fill=\"%s\" d=\"", colour);
  for (int i = 0; i < n; i++) {
    mesh_face_shape(kind, corner[i], shape, gradient);
    const double x = sum(shape, each, node, p->v->at, 2, 0) - p->v->low[0];
    const double y = p->v->high[1] - sum(shape, each, node, p->v->at, 2, 1);
    post_put(p->out, "%c%.1f %.1f", i ? 'L' : 'M', p->left + p->scale * x, p->top + p->scale * y);
  }
  post_put(p->out, "Z\"/>\n");
}

/* An element as fine by fine cells. */
static void put_element(const picture *p, const int *node, int fine) {
  const double h        = 1.0 / fine;
  const bool   triangle = p->face->kind == MESH_TET10;
  for (int i = 0; i < fine; i++)
    for (int j = 0; j < (triangle ? fine - i : fine); j++) {
      const double r = i * h, s = j * h;
      const double square[4][2] = {{r, s}, {r + h, s}, {r + h, s + h}, {r, s + h}};
      const double lower[3][2]  = {{r, s}, {r + h, s}, {r, s + h}};
      const double upper[3][2]  = {{r + h, s}, {r + h, s + h}, {r, s + h}};
      put_cell(p, node, triangle ? 3 : 4, triangle ? lower : square);
      if (triangle && i + j + 2 <= fine) put_cell(p, node, 3, upper);
    }
}

static void put_label(int i, range r, double x, post_buffer *out) {
  static const char *const name[MAPS] = {"work of friction", "way slipped", "mean pressure"};
  static const struct {
    const char *unit;
    double      scale;
  } unit[MAPS] = {{"J/m²", 1}, {"µm", 1e-6}, {"MPa", 1e6}};
  char least[POST_NUMBER], most[POST_NUMBER];
  post_plain(least, r.least / unit[i].scale, DIGITS);
  post_plain(most, r.most / unit[i].scale, DIGITS);
  post_put(out, "<text class=\"axis\" x=\"%g\" y=\"20\">%s</text>\n", x, name[i]);
  post_put(out, "<text x=\"%g\" y=\"37\">%s%s%s\u00a0%s</text>\n", x, least,
           is_even(r) ? "" : " to ", is_even(r) ? "" : most, unit[i].unit);
}

/* Px a metre, such that a map fits. */
static double scale_of(const view *v) {
  return fmin(MAP_WIDTH / (v->high[0] - v->low[0]), MAP_HEIGHT / (v->high[1] - v->low[1]));
}

static void put_curve(const post_contact_face *f, const view *v, const mhb_response *response,
                      const curve *c, post_buffer *out) {
  const mhb_branch *b     = &response->branch[c->branch];
  const int         point = c->maps.point[c->row], each = mesh_topology_of(f->kind)->face_nodes;
  const double      scale = scale_of(v);
  const int fine = (int)fmin(FINEST, fmax(1, floor(sqrt((double)CELLS / fmax(1, f->n_elements)))));
  char      n0[POST_NUMBER], frequency[POST_NUMBER], work[POST_NUMBER], id[32], title[160];
  snprintf(title, sizeof title, "Contact face at the peak of %s\u00a0N%s, %s\u00a0Hz",
           post_plain(n0, b->n0[point], 4), b->main == c->branch ? "" : ", secondary",
           post_number(frequency, b->frequency[point], 5));
  snprintf(id, sizeof id, "face-%d", c->branch);
  post_put(out, "<figure><figcaption>%s: %s in a period on the whole face</figcaption>\n", title,
           post_measure(work, c->work, post_unit_energy(c->work), DIGITS));
  plot_svg_open(out, id, WIDTH, TOP + FOOT + scale * (v->high[1] - v->low[1]), title,
                "Three maps of the right contact face, seen from outside the blade.");
  for (int i = 0; i < MAPS; i++) {
    const double *map = map_of(c, f, i), left = LEFT + i * ((WIDTH - LEFT) / (double)MAPS);
    const picture part = {f, v, map, range_of(f, map), left, TOP, scale, out};
    put_label(i, part.over, left, out);
    post_put(out, "<g shape-rendering=\"crispEdges\">\n"); /* no seams between the cells */
    for (int e = 0; e < f->n_elements; e++) put_element(&part, f->element + e * each, fine);
    post_put(out, "</g>\n");
  }
  plot_svg_close(out);
  post_put(out, "</figure>\n");
}

/* ---------------------------------------------------------------- section */

static int by_work(const void *a, const void *b) {
  const curve *p = a, *q = b;
  return p->work != q->work ? (p->work < q->work ? 1 : -1) : p->branch - q->branch;
}

/* Keep a curve if one of its maps is uneven. */
static shb_status take(hid_t file, const mhb_response *response, const post_contact_face *f,
                       int branch, curve *list, int *n) {
  curve c = {.branch = branch};
  SHB_TRY(post_contact_maps_read(file, f, branch, &c.maps));
  c.row       = post_contact_highest(response, branch, &c.maps);
  bool uneven = false;
  for (int i = 0; c.row >= 0 && i < MAPS; i++)
    uneven = uneven || !is_even(range_of(f, map_of(&c, f, i)));
  if (!uneven) {
    post_contact_maps_free(&c.maps);
    return SHB_OK;
  }
  const double *dissipation = map_of(&c, f, 0);
  for (int i = 0; i < f->n_nodes; i++) c.work += f->area[i] * dissipation[i];
  list[(*n)++] = c;
  return SHB_OK;
}

static void put_section(const post_contact_face *f, const view *v, const mhb_response *response,
                        const curve *list, int n, post_buffer *out) {
  post_put(
      out,
      "<section id=\"face\">\n<h2>Where friction works</h2>\n"
      "<p class=\"note\">The right contact face at the highest peak of a curve, seen from "
      "outside the blade; away from the axis is up. Colours run from amber, the least value, to "
      "indigo, the largest.");
  if (n > MOST_CURVES) post_put(out, " The %d curves of %d that dissipate most.", MOST_CURVES, n);
  post_put(out, "</p>\n");
  for (int i = 0; i < n && i < MOST_CURVES; i++) put_curve(f, v, response, &list[i], out);
  post_put(out, "</section>\n");
}

static shb_status compose(hid_t file, const mhb_response *response, mesh_axis axis,
                          const post_contact_face *f, post_buffer *out) {
  int        n    = 0;
  view       v    = {0};
  curve     *list = calloc((size_t)response->n_branches + 1, sizeof *list);
  shb_status status =
      list ? look(f, axis, &v)
           : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory for the contact face");
  for (int i = 0; i < response->n_branches && status == SHB_OK; i++)
    if (response->branch[i].kind == MHB_BRANCH_NONLINEAR)
      status = take(file, response, f, i, list, &n);
  if (status == SHB_OK && n > 0) {
    qsort(list, (size_t)n, sizeof *list, by_work);
    put_section(f, &v, response, list, n, out);
  }
  for (int i = 0; i < n; i++) post_contact_maps_free(&list[i].maps);
  free(list);
  free(v.at);
  SHB_CHECK(status != SHB_OK || !out->failed, SHB_ERR_IO, "out of memory for the contact face");
  return status;
}

shb_status post_contact_section(const char *path, const mhb_response *response, mesh_axis axis,
                                post_buffer *out) {
  hid_t             file;
  post_contact_face face = {0};
  SHB_TRY(h5_open(path, &file));
  shb_status status = post_contact_face_read(file, &face);
  if (status == SHB_OK && face.n_elements > 0) status = compose(file, response, axis, &face, out);
  post_contact_face_free(&face);
  h5_close(file);
  return status;
}
