#include "postproc/report/blade_view.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/problem/wave.h"
#include "postproc/draw/number_format.h"
#include "postproc/field/blade_skin.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the page's arrays are little-endian");

/* Bytes before base64, which adds a third: 3 MB of text together. */
enum { BUDGET = 2000000, POINT_BUDGET = 200000 };
enum { MOST_MODES = 12, LEAST_MODES = 6, FIXED_BYTES = 18, MODE_BYTES = 9, MOST_SHOWN = 5 };
enum { MOST_WAVES = 6 };

static const double SHOWN = 0.02; /* of the largest modal amplitude */

/* Nodal diameters of a disc in the page; without a disc one, which is not named. */
typedef struct {
  int n, index[MOST_WAVES]; /* in field->wave */
  int parts;                /* arrays of all waves together: one real, or two of complex shapes */
} waves;

static bool has_shapes(const post_blade_field *f) {
  bool any = f->shape != NULL;
  for (int i = 0; i < f->n_waves; i++) any = any || f->wave[i].shape;
  return any;
}

bool post_blade_view_fits(const post_blade_view *view, const mhb_response *response) {
  const post_blade_field *f = view->field;
  return f && f->n_nodes > 0 && has_shapes(f) && f->mesh.n_elements > 0 && f->n_modes > 0 &&
         f->n_modes == response->n_modes;
}

static bool is_complex(const post_blade_field *f, int wave) {
  return f->n_waves > 0 && f->diameter[wave] > 0 && 2 * f->diameter[wave] < f->blades;
}

static int place_of(const waves *w, int wave) {
  for (int i = 0; i < w->n; i++)
    if (w->index[i] == wave) return i;
  return -1;
}

static void add_wave(const post_blade_field *f, int wave, waves *w) {
  if (wave < 0 || w->n == MOST_WAVES || place_of(w, wave) >= 0) return;
  if (f->n_waves > 0 && !f->wave[wave].shape) return;
  w->index[w->n++] = wave;
  w->parts += is_complex(f, wave) ? 2 : 1;
}

static int modes_shown(const post_skin *skin, int n_modes, int parts) {
  int fit = (BUDGET / skin->n_nodes - FIXED_BYTES) / (MODE_BYTES * parts);
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

static shb_status make_skin(const post_blade_field *f, int parts, post_skin *skin) {
  double lo[3], size[3], width;
  SHB_TRY(post_skin_create(&f->mesh, skin));
  box_of(f, skin, lo, size);
  width = 1e-3 * (size[0] + size[1] + size[2]);
  while (skin->n_nodes > BUDGET / (FIXED_BYTES + LEAST_MODES * MODE_BYTES * parts)) {
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

/* A field of one mode: real, or real and imaginary parts side by side. */
typedef struct {
  const double *of;
  int           width, parts; /* numbers a node; 1 or 2 doubles a number */
} mode_field;

static mode_field field_of(const double *real, const double complex *wave, size_t mode, int nodes,
                           int width) {
  const size_t at = mode * (size_t)nodes * (size_t)width;
  if (!wave) return (mode_field){real + at, width, 1};
  return (mode_field){(const double *)(wave + at), width, 2};
}

static double number_of(const mode_field *m, int node, int component, int part) {
  return m->of[(m->width * node + component) * m->parts + part];
}

static double largest(const post_skin *skin, const mode_field *m) {
  double most = 0;
  for (int i = 0; i < skin->n_nodes; i++)
    for (int c = 0; c < m->width * m->parts; c++)
      most = fmax(most, fabs(number_of(m, skin->node[i], c / m->parts, c % m->parts)));
  return most > 0 ? most : 1;
}

static void put_part(const post_skin *skin, const mode_field *u, const mode_field *s,
                     const double scale[2], int part, int8_t *data, post_buffer *out) {
  for (int i = 0; i < skin->n_nodes; i++)
    for (int c = 0; c < 3 + POST_STRESSES; c++) {
      const double x =
          c < 3 ? number_of(u, skin->node[i], c, part) : number_of(s, skin->node[i], c - 3, part);
      data[MODE_BYTES * i + c] = (int8_t)lround(127 * x / scale[c >= 3]);
    }
  put_array(part ? "im" : "data", MODE_BYTES * (size_t)skin->n_nodes, data, out);
}

/* Mode of the wave at a place of the page. */
static void put_mode(const post_blade_field *f, const post_skin *skin, const waves *w, int at,
                     int mode, double frequency, int8_t *data, post_buffer *out) {
  const post_wave_field *own = f->n_waves > 0 ? &f->wave[w->index[at]] : NULL;
  const mode_field u = field_of(f->shape, own ? own->shape : NULL, (size_t)mode, f->n_nodes, 3);
  const mode_field s =
      field_of(f->stress, own ? own->stress : NULL, (size_t)mode, f->n_nodes, POST_STRESSES);
  const double scale[] = {largest(skin, &u), largest(skin, &s)};
  post_put(out, "%s{\"f\":%.7g,\"d\":%.7g,\"s\":%.7g", at || mode ? "," : "",
           own ? own->frequency[mode] : frequency, scale[0], scale[1]);
  if (own) post_put(out, ",\"w\":%d", at);
  for (int part = 0; part < (is_complex(f, w->index[at]) ? 2 : 1); part++)
    put_part(skin, &u, &s, scale, part, data, out);
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

/* The wave of each harmonic: its place on the page, and whether it runs backwards. */
static void put_waves(const post_blade_field *f, const mhb_branch *b, const waves *w, int n,
                      const int *k, post_buffer *out) {
  int  slot[MOST_SHOWN];
  bool backward[MOST_SHOWN];
  for (int i = 0; i < n; i++) slot[i] = place_of(w, post_blade_wave(f, b, k[i], &backward[i]));
  post_put(out, ",\"w\":[");
  for (int i = 0; i < n; i++) post_put(out, i ? ",%d" : "%d", slot[i]);
  post_put(out, "],\"back\":[");
  for (int i = 0; i < n; i++) post_put(out, i ? ",%d" : "%d", backward[i]);
  post_put(out, "]");
}

/* rad, by which the right neighbour lags at the fundamental of so many periods. */
static double lag_of(const mhb_response *r, int periods) {
  const mhb_driven_wave wave =
      mhb_driven_wave_of(r->engine_order, r->turns_right, r->blades, periods);
  return r->blades > 0 && mhb_driven_wave_shift(wave) >= 0 ? mhb_driven_wave_lag(wave) : 0;
}

static void put_point(const post_analysis *analysis, const post_blade_field *f, const waves *w,
                      int b, int kept, int modes, post_buffer *out) {
  const mhb_response   *r      = analysis->response;
  const mhb_branch     *branch = &r->branch[b];
  const int             point = branch->modal.point[kept], all = r->n_modes;
  const double complex *q =
      branch->modal.amplitude + (size_t)kept * (size_t)(branch->n_harmonics + 1) * (size_t)all;
  int    k[MOST_SHOWN], n = choose_harmonics(branch, kept, all, k);
  float  data[2 * MOST_SHOWN * MOST_MODES];
  float *to = data;
  post_put(out, "{\"b\":%d,\"x\":%.9g,\"a\":%.7g,\"order\":%d,\"lag\":%.9g,\"k\":[", b,
           post_abscissa_values(r, branch)[point], analysis->curve[b].amplitude[point],
           branch->order, lag_of(r, branch->order));
  for (int i = 0; i < n; i++) {
    post_put(out, i ? ",%d" : "%d", k[i]);
    for (int m = 0; m < modes; m++) {
      *to++ = (float)creal(q[k[i] * all + m]);
      *to++ = (float)cimag(q[k[i] * all + m]);
    }
  }
  post_put(out, "]");
  if (f->n_waves > 0) put_waves(f, branch, w, n, k, out);
  put_array("q", sizeof(float) * (size_t)(to - data), data, out);
  post_put(out, "}");
}

static bool is_highest(const post_analysis *analysis, int b, int point) {
  for (int p = 0; p < analysis->curve[b].n_peaks; p++)
    if (analysis->curve[b].peak[p].point == point) return true;
  return false;
}

/* The waves of the harmonics that the kept points show, those of the lowest harmonics first. */
static void find_waves(const post_analysis *analysis, const post_blade_field *f, waves *w) {
  const mhb_response *r = analysis->response;
  *w                    = (waves){0};
  if (f->n_waves == 0) {
    add_wave(f, 0, w);
    return;
  }
  for (int rank = 0; rank < MOST_SHOWN; rank++)
    for (int b = 0; b < r->n_branches; b++) {
      const mhb_branch *branch = &r->branch[b];
      for (int i = 0; branch->kind == MHB_BRANCH_NONLINEAR && i < branch->modal.n; i++) {
        bool backward;
        int  k[MOST_SHOWN];
        if (rank < choose_harmonics(branch, i, r->n_modes, k))
          add_wave(f, post_blade_wave(f, branch, k[rank], &backward), w);
      }
    }
  for (int i = 0; i < f->n_waves && w->n == 0; i++) add_wave(f, i, w);
}

/* Kept points of all nonlinear curves: all if they fit, else peaks and every stride-th. */
static void put_points(const post_analysis *analysis, const post_blade_field *f, const waves *w,
                       int modes, post_buffer *out) {
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
      put_point(analysis, f, w, b, i, modes, out);
    }
  }
}

static void put_modes(const post_analysis *analysis, const post_blade_field *f,
                      const post_skin *skin, const waves *w, int modes, int8_t *data,
                      post_buffer *out) {
  post_put(out, ",\"modes\":[");
  for (int at = 0; at < w->n; at++)
    for (int i = 0; i < modes; i++)
      put_mode(f, skin, w, at, i, analysis->response->mode_frequency[i], data, out);
  post_put(out, "],\"row\":%d", modes);
  for (int i = 0; i < w->n && f->n_waves > 0; i++)
    post_put(out, i ? ",%d" : ",\"waves\":[%d", f->diameter[w->index[i]]);
  if (f->n_waves > 0) post_put(out, "]");
  post_put(out, ",\"modesLeftOut\":%d", f->n_modes - modes);
}

shb_status post_blade_data(const post_analysis *analysis, const post_blade_view *view,
                           post_buffer *out) {
  const mhb_response     *r    = analysis->response;
  const post_blade_field *f    = view->field;
  post_skin               skin = {0};
  waves                   w;
  double                  axis[3];
  find_waves(analysis, f, &w);
  shb_status status = make_skin(f, w.parts, &skin);
  int8_t    *data   = status == SHB_OK ? calloc(MODE_BYTES * (size_t)skin.n_nodes + 4, 1) : NULL;
  if (status == SHB_OK && !data)
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "not enough memory for the page");
  if (status == SHB_OK) {
    const int modes = modes_shown(&skin, f->n_modes, w.parts);
    mesh_axis_vector(view->axis, axis);
    post_put(out, "{");
    put_surface(f, &skin, out);
    put_modes(analysis, f, &skin, &w, modes, data, out);
    post_put(out, ",\"points\":[");
    put_points(analysis, f, &w, modes, out);
    post_put(out, "],\"axis\":[%g,%g,%g],\"blades\":%d,\"lag\":%.9g}", axis[0], axis[1], axis[2],
             r->blades, lag_of(r, 1));
  }
  free(data);
  post_skin_free(&skin);
  return status;
}
