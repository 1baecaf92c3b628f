#include "postproc/report/blade_view.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "postproc/draw/number_format.h"
#include "postproc/report/still_blade.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the page's arrays are little-endian");

/* Bytes before base64, which adds a third: 3 MB of text together. */
enum { BUDGET = 2000000, POINT_BUDGET = 200000 };
enum { MOST_MODES = 12, LEAST_MODES = 6, FIXED_BYTES = 18, MODE_BYTES = 9, MOST_SHOWN = 5 };

static const double SHOWN = 0.02; /* of the largest modal amplitude */

bool post_blade_view_fits(const post_blade_view *view, const mhb_response *response) {
  const post_blade_field *f = view->field;
  return f && f->n_nodes > 0 && f->shape && f->mesh.n_elements > 0 && f->n_modes > 0 &&
         f->n_modes == response->n_modes;
}

static int modes_shown(const post_skin *skin, int n_modes) {
  int fit = (BUDGET / skin->n_nodes - FIXED_BYTES) / MODE_BYTES;
  if (fit > MOST_MODES) fit = MOST_MODES;
  return fit < n_modes ? fit : n_modes;
}

/* ---------------------------------------------------------------- coarser surface */

static void box_of(const post_blade_field *f, const post_skin *skin, double lo[3], double size[3]) {
  for (int d = 0; d < 3; d++) {
    double high = -INFINITY;
    lo[d]       = INFINITY;
    for (int i = 0; i < skin->n_nodes; i++) {
      lo[d] = fmin(lo[d], f->nodes[3 * skin->node[i] + d]);
      high  = fmax(high, f->nodes[3 * skin->node[i] + d]);
    }
    size[d] = fmax(high - lo[d], 1e-12);
  }
}

typedef struct {
  uint64_t cell;
  int      node;
} place;

static int by_cell(const void *a, const void *b) {
  const place *p = a, *q = b;
  if (p->cell != q->cell) return p->cell < q->cell ? -1 : 1;
  return p->node - q->node;
}

/* Merge the nodes of a cell of a cubic grid of this width into the first of them; triangles that
 * vanish go. */
static shb_status merge(const post_blade_field *f, double width, post_skin *skin) {
  const size_t n  = (size_t)skin->n_nodes;
  place       *p  = malloc(n * sizeof *p);
  int         *to = malloc(n * sizeof *to), kept = 0;
  double       lo[3], size[3];
  if (!p || !to) {
    free(p);
    free(to);
    SHB_FAIL(SHB_ERR_IO, "not enough memory for the surface of the blade");
  }
  box_of(f, skin, lo, size);
  for (size_t i = 0; i < n; i++) {
    p[i] = (place){0, (int)i};
    for (int d = 0; d < 3; d++)
      p[i].cell =
          p[i].cell << 20 | (uint64_t)fmin((f->nodes[3 * skin->node[i] + d] - lo[d]) / width, 1e6);
  }
  qsort(p, n, sizeof *p, by_cell);
  for (size_t i = 0; i < n; i++) {
    bool first    = i == 0 || p[i].cell != p[i - 1].cell;
    to[p[i].node] = first ? p[i].node : to[p[i - 1].node];
  }
  int *node = skin->node;
  for (size_t i = 0; i < n; i++) { /* the first of a cell has the lowest index */
    if (to[i] != (int)i) {
      to[i] = to[to[i]];
      continue;
    }
    node[kept] = node[i];
    to[i]      = kept++;
  }
  skin->n_nodes = kept;
  int left      = 0;
  for (int t = 0; t < skin->n_triangles; t++) {
    const int *old = skin->triangle + 3 * t;
    const int  c[] = {to[old[0]], to[old[1]], to[old[2]]};
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
    memcpy(skin->triangle + 3 * left++, c, sizeof c);
  }
  skin->n_triangles = left;
  free(p);
  free(to);
  return SHB_OK;
}

static shb_status make_skin(const post_blade_field *f, post_skin *skin) {
  double lo[3], size[3], width;
  SHB_TRY(post_skin_create(&f->mesh, skin));
  box_of(f, skin, lo, size);
  width = 1e-3 * (size[0] + size[1] + size[2]);
  while (skin->n_nodes > BUDGET / (FIXED_BYTES + LEAST_MODES * MODE_BYTES)) {
    SHB_TRY(merge(f, width, skin));
    width *= 1.25;
  }
  return SHB_OK;
}

/* ---------------------------------------------------------------- arrays */

static void put_array(const char *name, size_t bytes, const void *data, post_buffer *out) {
  post_put(out, ",\"%s\":\"", name);
  post_put_base64(out, (bytes + 3) / 4, data); /* data has room for whole floats */
  post_put(out, "\"");
}

static void put_surface(const post_blade_field *f, const post_skin *skin, post_buffer *out) {
  double    lo[3], size[3];
  const int wide = skin->n_nodes >= 65536;
  size_t most = 3 * (size_t)(skin->n_nodes > skin->n_triangles ? skin->n_nodes : skin->n_triangles);
  uint32_t *large  = calloc(most + 1, sizeof *large);
  uint16_t *values = (uint16_t *)large;
  if (!large) {
    out->failed = true;
    return;
  }
  box_of(f, skin, lo, size);
  post_put(out, "\"nodes\":%d,\"triangles\":%d,\"lo\":[%.7g,%.7g,%.7g],\"size\":[%.7g,%.7g,%.7g]",
           skin->n_nodes, skin->n_triangles, lo[0], lo[1], lo[2], size[0], size[1], size[2]);
  for (int i = 0; i < skin->n_nodes; i++)
    for (int d = 0; d < 3; d++)
      values[3 * i + d] =
          (uint16_t)lround(65535 * (f->nodes[3 * skin->node[i] + d] - lo[d]) / size[d]);
  put_array("position", 6 * (size_t)skin->n_nodes, values, out);
  for (int i = 0; i < 3 * skin->n_triangles; i++) {
    if (wide) large[i] = (uint32_t)skin->triangle[i];
    if (!wide) values[i] = (uint16_t)skin->triangle[i];
  }
  put_array("index", (wide ? 12 : 6) * (size_t)skin->n_triangles, values, out);
  free(large);
}

static double largest(const post_skin *skin, int width, const double *x) {
  double most = 0;
  for (int i = 0; i < skin->n_nodes; i++)
    for (int c = 0; c < width; c++) most = fmax(most, fabs(x[width * skin->node[i] + c]));
  return most > 0 ? most : 1;
}

static void put_mode(const post_blade_field *f, const post_skin *skin, double frequency, int mode,
                     int8_t *data, post_buffer *out) {
  const double *shape  = f->shape + (size_t)mode * 3 * (size_t)f->n_nodes;
  const double *stress = f->stress + (size_t)mode * POST_STRESSES * (size_t)f->n_nodes;
  const double  d = largest(skin, 3, shape), s = largest(skin, POST_STRESSES, stress);
  for (int i = 0; i < skin->n_nodes; i++) {
    for (int c = 0; c < 3; c++)
      data[9 * i + c] = (int8_t)lround(127 * shape[3 * skin->node[i] + c] / d);
    for (int c = 0; c < POST_STRESSES; c++)
      data[9 * i + 3 + c] = (int8_t)lround(127 * stress[POST_STRESSES * skin->node[i] + c] / s);
  }
  post_put(out, "%s{\"f\":%.7g,\"d\":%.7g,\"s\":%.7g", mode ? "," : "", frequency, d, s);
  put_array("data", 9 * (size_t)skin->n_nodes, data, out);
  post_put(out, "}");
}

/* ---------------------------------------------------------------- points */

/* The largest harmonics of a kept point, ascending; returns their number. */
static int choose_harmonics(const mhb_branch *b, int kept, int n_modes, int chosen[MOST_SHOWN]) {
  const int             K = b->n_harmonics + 1;
  const double complex *q = b->modal.amplitude + (size_t)kept * (size_t)K * (size_t)n_modes;
  double                size[K], most = 0;
  int                   n = 0;
  for (int k = 0; k < K; k++) {
    size[k] = 0;
    for (int i = 0; i < n_modes; i++) size[k] = hypot(size[k], cabs(q[k * n_modes + i]));
    if (k > 0) most = fmax(most, size[k]);
  }
  for (int k = 1; k < K; k++) {
    int larger = 0;
    for (int j = 1; j < K; j++) larger += size[j] > size[k];
    if (larger < MOST_SHOWN && size[k] > SHOWN * most && n < MOST_SHOWN) chosen[n++] = k;
  }
  return n;
}

static void put_point(const post_analysis *analysis, int b, int kept, int modes, post_buffer *out) {
  const mhb_response   *r      = analysis->response;
  const mhb_branch     *branch = &r->branch[b];
  const int             point = branch->modal.point[kept], all = r->n_modes;
  const double complex *q =
      branch->modal.amplitude + (size_t)kept * (size_t)(branch->n_harmonics + 1) * (size_t)all;
  int    k[MOST_SHOWN], n = choose_harmonics(branch, kept, all, k);
  float  data[2 * MOST_SHOWN * MOST_MODES];
  float *to = data;
  post_put(out, "{\"b\":%d,\"x\":%.9g,\"a\":%.7g,\"order\":%d,\"k\":[", b,
           post_abscissa_values(r, branch)[point], analysis->curve[b].amplitude[point],
           branch->order);
  for (int i = 0; i < n; i++) {
    post_put(out, i ? ",%d" : "%d", k[i]);
    for (int m = 0; m < modes; m++) {
      *to++ = (float)creal(q[k[i] * all + m]);
      *to++ = (float)cimag(q[k[i] * all + m]);
    }
  }
  post_put(out, "]");
  put_array("q", sizeof(float) * (size_t)(to - data), data, out);
  post_put(out, "}");
}

static bool is_highest(const post_analysis *analysis, int b, int point) {
  for (int p = 0; p < analysis->curve[b].n_peaks; p++)
    if (analysis->curve[b].peak[p].point == point) return true;
  return false;
}

/* Kept points of all nonlinear curves: all if they fit, else peaks and every stride-th. */
static void put_points(const post_analysis *analysis, int modes, post_buffer *out) {
  const mhb_response *r     = analysis->response;
  int                 total = 0, any = 0;
  for (int b = 0; b < r->n_branches; b++)
    if (r->branch[b].kind == MHB_BRANCH_NONLINEAR) total += r->branch[b].modal.n;
  const int stride = 1 + total * modes * 2 * MOST_SHOWN * 4 / POINT_BUDGET;
  for (int b = 0; b < r->n_branches; b++) {
    const mhb_branch *branch = &r->branch[b];
    if (branch->kind != MHB_BRANCH_NONLINEAR) continue;
    for (int i = 0; i < branch->modal.n; i++) {
      if (i % stride && !is_highest(analysis, b, branch->modal.point[i])) continue;
      post_put(out, any++ ? "," : "");
      put_point(analysis, b, i, modes, out);
    }
  }
}

shb_status post_blade_data(const post_analysis *analysis, const post_blade_view *view,
                           post_buffer *out) {
  const mhb_response     *r    = analysis->response;
  const post_blade_field *f    = view->field;
  post_skin               skin = {0};
  double                  axis[3];
  shb_status              status = make_skin(f, &skin);
  int8_t                 *data = status == SHB_OK ? calloc(9 * (size_t)skin.n_nodes + 4, 1) : NULL;
  if (status == SHB_OK && !data)
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "not enough memory for the page");
  if (status == SHB_OK) {
    const int modes = modes_shown(&skin, f->n_modes);
    mesh_axis_vector(view->axis, axis);
    post_put(out, "{");
    put_surface(f, &skin, out);
    post_put(out, ",\"modes\":[");
    for (int i = 0; i < modes; i++) put_mode(f, &skin, r->mode_frequency[i], i, data, out);
    post_put(out, "],\"modesLeftOut\":%d,\"points\":[", f->n_modes - modes);
    put_points(analysis, modes, out);
    post_put(out, "],\"axis\":[%g,%g,%g],\"blades\":%d,\"lag\":%.9g}", axis[0], axis[1], axis[2],
             r->blades, r->blades > 0 ? SHB_TWO_PI * r->engine_order / r->blades : 0);
  }
  free(data);
  post_skin_free(&skin);
  return status;
}

/* ---------------------------------------------------------------- section */

void post_blade_section(const post_analysis *analysis, const post_blade_view *view,
                        post_buffer *out) {
  (void)analysis;
  post_put(
      out,
      "<section id=\"blade\">\n<h2>The blade in motion</h2>\n<p class=\"note\" id=\"blade-note\">"
      "The surface of the mesh.</p>\n<div class=\"card\"><figure>\n<div class=\"tools\">\n"
      "<label>Shown<select id=\"blade-shown\"></select></label>\n"
      "<label>Colour<select id=\"blade-colour\"><option value=\"stress\">stress</option>"
      "<option value=\"motion\">displacement</option></select></label>\n"
      "<label>Size of the motion<input type=\"range\" id=\"blade-scale\" min=\"0\" max=\"100\" "
      "value=\"40\"></label>\n"
      "<label>Neighbours<select id=\"blade-ring\"><option value=\"0\">none</option>"
      "<option value=\"1\">one on each side</option><option value=\"3\">three on each side"
      "</option><option value=\"all\">the whole ring</option></select></label>\n"
      "<button type=\"button\" id=\"blade-play\">Pause</button>\n"
      "<button type=\"button\" id=\"blade-home\">Whole blade</button>\n"
      "<button type=\"button\" id=\"blade-save\">PNG</button>\n</div>\n"
      "<div id=\"blade-still\">\n");
  post_still_blade(view->field, view->axis, out);
  post_put(out,
           "</div>\n<canvas id=\"blade-canvas\" tabindex=\"0\" hidden aria-label=\"The blade in "
           "motion\"></canvas>\n<div class=\"scale\" id=\"blade-bar\" hidden><span></span><i></i>"
           "<span></span></div>\n<p class=\"hint\">Drag to turn, wheel or two fingers to zoom, "
           "with Shift drag to move. Click a curve above to see its motion here.</p>\n"
           "</figure></div>\n</section>\n");
}
