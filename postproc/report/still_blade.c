#include "postproc/report/still_blade.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "mesh/base/constants.h"
#include "mesh/base/vec3.h"
#include "postproc/draw/number_format.h"
#include "postproc/draw/plot.h"

enum { WIDTH = 460, HEIGHT = 520, MARGIN = 16 };

static const double SHARP = 0.85; /* cosine of the angle between faces at a sharp edge */

typedef struct {
  int a, b, triangle;
} edge;

static int by_nodes(const void *left, const void *right) {
  const edge *p = left, *q = right;
  if (p->a != q->a) return p->a - q->a;
  if (p->b != q->b) return p->b - q->b;
  return p->triangle - q->triangle;
}

/* Rows: right, up and towards the viewer. */
static void view_axes(mesh_axis axis, double rows[3][3]) {
  double radial[3], axial[3], across[3];
  mesh_axis_stacking(axis, radial);
  mesh_axis_vector(axis, axial);
  vec3_cross(axial, radial, across);
  const double turn = 0.7, tilt = 0.3;
  for (int d = 0; d < 3; d++) {
    double right = cos(turn) * across[d] + sin(turn) * axial[d];
    double depth = cos(turn) * axial[d] - sin(turn) * across[d];
    rows[0][d]   = right;
    rows[1][d]   = cos(tilt) * radial[d] + sin(tilt) * depth;
    rows[2][d]   = sin(tilt) * radial[d] - cos(tilt) * depth;
  }
}

typedef struct {
  const post_skin *skin;
  double          *at;     /* [node][2] projected, m */
  double          *normal; /* [triangle][3] unit */
  double          *facing; /* [triangle] towards the viewer */
  edge            *edges;  /* [3 triangles] */
} sheet;

static void project(const post_blade_field *f, double rows[3][3], sheet *s) {
  const post_skin *skin = s->skin;
  for (int i = 0; i < skin->n_nodes; i++)
    for (int d = 0; d < 2; d++) s->at[2 * i + d] = vec3_dot(rows[d], f->nodes + 3 * skin->node[i]);
  for (int t = 0; t < skin->n_triangles; t++) {
    const int    *c = skin->triangle + 3 * t;
    const double *p[3];
    double        one[3], two[3], *normal = s->normal + 3 * t;
    for (int i = 0; i < 3; i++) p[i] = f->nodes + 3 * skin->node[c[i]];
    for (int d = 0; d < 3; d++) {
      one[d] = p[1][d] - p[0][d];
      two[d] = p[2][d] - p[0][d];
    }
    vec3_cross(one, two, normal);
    double length = vec3_norm(normal);
    for (int d = 0; d < 3; d++) normal[d] /= length > 0 ? length : 1;
    s->facing[t] = vec3_dot(rows[2], normal);
    for (int i = 0; i < 3; i++) {
      int a = c[i], b = c[(i + 1) % 3];
      s->edges[3 * t + i] = (edge){a < b ? a : b, a < b ? b : a, t};
    }
  }
}

/* Sharp edges of surfaces that face the viewer, and the outline. */
static bool is_drawn(const sheet *s, int t, int u) {
  bool front[2] = {s->facing[t] > 0, s->facing[u] > 0};
  if (front[0] != front[1]) return true;
  return front[0] && vec3_dot(s->normal + 3 * t, s->normal + 3 * u) < SHARP;
}

static void put_edges(sheet *s, post_buffer *out) {
  const post_skin *skin  = s->skin;
  double           lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
  for (int i = 0; i < 2 * skin->n_nodes; i++) {
    lo[i % 2] = fmin(lo[i % 2], s->at[i]);
    hi[i % 2] = fmax(hi[i % 2], s->at[i]);
  }
  double       scale  = fmin((WIDTH - 2 * MARGIN) / fmax(hi[0] - lo[0], 1e-12),
                             (HEIGHT - 2 * MARGIN) / fmax(hi[1] - lo[1], 1e-12));
  const double middle = (WIDTH - scale * (hi[0] - lo[0])) / 2;
  qsort(s->edges, 3 * (size_t)skin->n_triangles, sizeof *s->edges, by_nodes);
  post_put(out, "<path class=\"outline\" d=\"");
  for (int i = 0; i + 1 < 3 * skin->n_triangles; i++) {
    const edge *e = &s->edges[i];
    if (e[0].a != e[1].a || e[0].b != e[1].b || !is_drawn(s, e[0].triangle, e[1].triangle))
      continue;
    post_put(out, "M%.1f %.1fL%.1f %.1f", middle + scale * (s->at[2 * e->a] - lo[0]),
             HEIGHT - MARGIN - scale * (s->at[2 * e->a + 1] - lo[1]),
             middle + scale * (s->at[2 * e->b] - lo[0]),
             HEIGHT - MARGIN - scale * (s->at[2 * e->b + 1] - lo[1]));
  }
  post_put(out, "\"/>\n");
}

void post_still_blade(const post_blade_field *field, mesh_axis axis, post_buffer *out) {
  post_skin skin = {0};
  sheet     s    = {.skin = &skin};
  double    rows[3][3];
  if (post_skin_create(&field->mesh, &skin) == SHB_OK) {
    const size_t n = (size_t)skin.n_nodes + 1, t = (size_t)skin.n_triangles + 1;
    s.at     = malloc(2 * n * sizeof *s.at);
    s.normal = malloc(3 * t * sizeof *s.normal);
    s.facing = malloc(t * sizeof *s.facing);
    s.edges  = malloc(3 * t * sizeof *s.edges);
  }
  if (s.at && s.normal && s.facing && s.edges) {
    view_axes(axis, rows);
    project(field, rows, &s);
    plot_svg_open(out, "still", WIDTH, HEIGHT, "The blade", "Its sharp edges and its outline.");
    put_edges(&s, out);
    plot_svg_close(out);
  } else {
    out->failed = true;
  }
  free(s.at);
  free(s.normal);
  free(s.facing);
  free(s.edges);
  post_skin_free(&skin);
}

/* ---------------------------------------------------------------- axes of the contact */

static void put_arrow(double x, double y, double dx, double dy, const char *classes,
                      const char *name, post_buffer *out) {
  double length = hypot(dx, dy), c = dx / length, s = dy / length;
  bool   level = *classes == 'o' && dy == 0; /* a long name beside the tip of a level arrow */
  post_put(out,
           "<path class=\"axis-line %s\" d=\"M%.1f %.1fL%.1f %.1fM%.1f %.1fL%.1f %.1fL%.1f "
           "%.1f\"/><text class=\"axis\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%s</text>\n",
           classes, x, y, x + dx, y + dy, x + dx - 8 * c - 4 * s, y + dy - 8 * s + 4 * c, x + dx,
           y + dy, x + dx - 8 * c + 4 * s, y + dy - 8 * s - 4 * c, x + dx + (level ? 6 : 14 * c),
           y + dy + 14 * s + 4, level ? "start" : "middle", name);
}

/* Arc of 52 px about (x, y) from the horizontal to an angle, rad, up in the picture; it is named
 * with a value, rad. */
static void put_arc(double x, double y, double angle, double value, const char *name,
                    post_buffer *out) {
  const double radius = 52;
  char         text[48], degrees[POST_NUMBER];
  snprintf(text, sizeof text, "%s = %s°", name,
           post_plain(degrees, round(value * 180e3 / SHB_PI) / 1e3, 4));
  if (fabs(angle) > 1e-3)
    post_put(out, "<path class=\"arc\" d=\"M%.1f %.1fA%g %g 0 0 %d %.1f %.1f\"/>", x + radius, y,
             radius, radius, angle < 0, x + radius * cos(angle), y - radius * sin(angle));
  bool flat = fabs(angle) < 0.25; /* no space beside the axis */
  post_put(out, "<text class=\"axis\" x=\"%.1f\" y=\"%.1f\">%s</text>\n",
           x + (radius + 10) * cos(angle / 2),
           flat ? y - 12 : y - (radius + 10) * sin(angle / 2) + 4, text);
}

/* Both shrouds beside the line of contact through (x, y), whose direction is (along, up). */
static void put_shrouds(double x, double y, double along, double up, double half,
                        post_buffer *out) {
  double dx = half * along, dy = half * up;
  for (int side = -1; side <= 1; side += 2) {
    double wide = 130 * side;
    post_put(out, "<path class=\"shroud\" d=\"M%.1f %.1fL%.1f %.1fL%.1f %.1fL%.1f %.1fZ\"/>\n",
             x + dx, y - dy, x - dx, y + dy, x + wide, y + dy, x + wide, y - dy);
  }
  post_put(out, "<path class=\"face\" d=\"M%.1f %.1fL%.1f %.1f\"/>\n", x + dx, y - dy, x - dx,
           y + dy);
}

void post_contact_axes(double psi, double phi, post_buffer *out) {
  const double c = cos(psi), s = sin(psi), cp = cos(phi), sp = sin(phi);
  plot_svg_open(out, "contact-axes", 720, 300, "Axes of the contact",
                "Left: seen from outside, tangential to the right, axial up; psi turns v from "
                "tangential towards axial. Right: seen along the engine axis, radial up; phi turns "
                "v towards the engine axis.");
  put_shrouds(180, 160, -s, c, 80 / fmax(c, 0.3), out);
  put_arrow(180, 160, 92 * c, -92 * s, "v", "v", out);
  put_arrow(180, 160, -92 * s, -92 * c, "u", "u", out);
  put_arc(180, 160, psi, psi, "ψ", out);
  put_arrow(20, 284, 60, 0, "other", "tangential", out);
  put_arrow(20, 284, 0, -44, "other", "axial", out);
  put_shrouds(540, 160, sp, cp, 34, out);
  put_arrow(540, 160, 92 * cp, 92 * sp, "v", "v", out);
  put_arrow(540, 160, 92 * sp, -92 * cp, "w", "w", out);
  put_arc(540, 160, -phi, phi, "φ", out);
  put_arrow(380, 284, 60, 0, "other", "tangential", out);
  put_arrow(380, 284, 0, -44, "other", "radial", out);
  post_put(out,
           "<text class=\"tick\" x=\"60\" y=\"16\">from outside: this blade left, its right "
           "neighbour right</text><text class=\"tick\" x=\"430\" y=\"16\">along the engine "
           "axis</text>\n");
  plot_svg_close(out);
}
