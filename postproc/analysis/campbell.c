#include "postproc/analysis/campbell.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "modal/model/spline.h"
#include "postproc/draw/number_format.h"
#include "postproc/draw/plot.h"

enum { WIDTH = 1000, HEIGHT = 600, SAMPLES = 241, COLOURS = 6, MOST_ORDERS = 16, AT_FIRST = 12 };

const char post_campbell_css[] =
    ".k0{color:#0b6e75}.k1{color:#a3540f}.k2{color:#6a4aa5}.k3{color:#2f6f2f}.k4{color:#a83250}"
    ".k5{color:#5c6470}.line.coupled{color:#1b2530;stroke-width:1.3;stroke-dasharray:2 "
    "3.5}.order{stroke:#c2c9d0;stroke-width:1;fill:none}"
    ".order.excited{stroke:#1b2530;stroke-width:1.4;stroke-dasharray:7 4}"
    ".crossing{fill:none;stroke:#1b2530;stroke-width:1.6}.plot .name{fill:currentColor}"
    "@media screen and (prefers-color-scheme:dark){.k0{color:#4cc3cb}.k1{color:#e2a15c}"
    ".k2{color:#b8a1ea}.k3{color:#86c586}.k4{color:#f08aa4}.k5{color:#aeb6c0}.line.coupled{color:#"
    "e6eaee}"
    ".order{stroke:#39434e}.order.excited,.crossing{stroke:#e6eaee}}";

/* ---------------------------------------------------------------- modes between the speeds */

typedef struct {
  const modal_speeds *speeds;
  modal_spline        spline; /* in Omega^2 */
  double             *weight; /* [n] */
} curves;

static shb_status curves_create(const modal_speeds *speeds, curves *c) {
  double *square = malloc((size_t)speeds->n * sizeof *square);
  *c             = (curves){.speeds = speeds, .weight = calloc((size_t)speeds->n, sizeof(double))};
  if (!square || !c->weight) {
    free(square);
    free(c->weight);
    SHB_FAIL(SHB_ERR_IO, "not enough memory for the Campbell diagram");
  }
  for (int i = 0; i < speeds->n; i++) square[i] = speeds->speed[i] * speeds->speed[i];
  modal_spline_create(speeds->n, square, &c->spline);
  free(square);
  return SHB_OK;
}

static void curves_free(curves *c) {
  modal_spline_free(&c->spline);
  free(c->weight);
}

/* Frequency of a track at a speed, Hz; NAN where the track is lost between the neighbouring
 * speeds. */
static double frequency_at(curves *c, int track, double speed) {
  const modal_speeds *s  = c->speeds;
  double              f2 = 0;
  int                 i  = 1;
  while (i < s->n - 1 && speed > s->speed[i]) i++;
  if (s->mac[i * s->n_modes + track] < modal_speeds_mac_limit) return NAN;
  modal_spline_weights(&c->spline, speed * speed, c->weight, NULL);
  for (int k = 0; k < s->n; k++) {
    double f = modal_speeds_frequency(s, k, track);
    f2 += c->weight[k] * f * f;
  }
  return f2 > 0 ? sqrt(f2) : NAN;
}

static double speed_at(const modal_speeds *s, int sample, int samples) {
  double share = (double)sample / (samples - 1);
  return (1 - share) * s->speed[0] + share * s->speed[s->n - 1];
}

/* Stuck frequency number j at a speed, Hz: its square is linear in Omega^2 between two speeds. */
static double stuck_at(const post_campbell *c, int j, double speed) {
  const modal_speeds *s = c->speeds;
  int                 i = 1;
  while (i < s->n - 1 && speed > s->speed[i]) i++;
  const double low = s->speed[i - 1] * s->speed[i - 1], high = s->speed[i] * s->speed[i],
               f = c->stuck[(i - 1) * c->n_stuck + j], g = c->stuck[i * c->n_stuck + j],
               part = (speed * speed - low) / (high - low);
  return sqrt((1 - part) * f * f + part * g * g);
}

/* A track of the free blade, or one stuck frequency. */
typedef struct {
  const post_campbell *campbell;
  curves              *c;
  bool                 stuck;
  int                  index;
} curve;

static double curve_at(const curve *k, double speed) {
  return k->stuck ? stuck_at(k->campbell, k->index, speed) : frequency_at(k->c, k->index, speed);
}

/* ---------------------------------------------------------------- crossings */

static bool is_excited(const post_campbell *c, int order) {
  int e = c->engine_order;
  if (c->blades > 0 && modal_nodal_diameter(order, c->blades) != c->diameter) return false;
  return e > 0 && order > 0 && order % e == 0 &&
         modal_model_is_driven(&c->speeds->model[0], order / e);
}

static int highest_order(const post_campbell *c) {
  int highest = 0;
  for (int k = 1; k <= c->speeds->model[0].n_load; k++)
    if (is_excited(c, k * c->engine_order)) highest = k * c->engine_order;
  return highest;
}

/* Crossing of the mode and the order's line between lo and hi, by bisection. */
static double bisect(const curve *k, int order, double lo, double hi) {
  bool above = curve_at(k, lo) > order * lo / SHB_TWO_PI;
  for (int i = 0; i < 60; i++) {
    double middle = (lo + hi) / 2;
    if ((curve_at(k, middle) > order * middle / SHB_TWO_PI) == above)
      lo = middle;
    else
      hi = middle;
  }
  return (lo + hi) / 2;
}

static bool add_crossing(int *n, post_crossing **all, post_crossing one) {
  post_crossing *more = realloc(*all, (size_t)(*n + 1) * sizeof *more);
  if (!more) return false;
  *all         = more;
  more[(*n)++] = one;
  return true;
}

static bool find_crossings(const curve *k, int order, int *n, post_crossing **all) {
  double before = NAN, from = 0;
  for (int i = 0; i < SAMPLES; i++) {
    double speed = speed_at(k->campbell->speeds, i, SAMPLES);
    double here  = curve_at(k, speed) - order * speed / SHB_TWO_PI;
    if (here * before <= 0 && before != 0) {
      double        at  = bisect(k, order, from, speed);
      post_crossing one = {k->stuck, order, k->index, at, order * at / SHB_TWO_PI};
      if (!add_crossing(n, all, one)) return false;
    }
    before = here;
    from   = speed;
  }
  return true;
}

static int by_speed(const void *a, const void *b) {
  double p = ((const post_crossing *)a)->speed, q = ((const post_crossing *)b)->speed;
  return (p > q) - (p < q);
}

shb_status post_campbell_crossings(const post_campbell *campbell, int *n, post_crossing **all) {
  curves c;
  bool   good = true;
  *n          = 0;
  *all        = NULL;
  SHB_TRY(curves_create(campbell->speeds, &c));
  for (int k = 1; k <= campbell->speeds->model[0].n_load; k++)
    for (int t = 0; good && t < campbell->speeds->n_modes; t++)
      if (is_excited(campbell, k * campbell->engine_order))
        good = find_crossings(&(curve){campbell, &c, false, t}, k * campbell->engine_order, n, all);
  for (int j = 0; good && j < campbell->n_stuck; j++) /* at the nodal diameter of E itself */
    if (is_excited(campbell, campbell->engine_order))
      good = find_crossings(&(curve){campbell, &c, true, j}, campbell->engine_order, n, all);
  curves_free(&c);
  if (*n > 1) qsort(*all, (size_t)*n, sizeof **all, by_speed);
  SHB_CHECK(good, SHB_ERR_IO, "not enough memory for the Campbell diagram");
  return SHB_OK;
}

/* ---------------------------------------------------------------- diagram */

/* Upper frequency of the diagram: the highest excited order at the highest speed, at least the
 * third mode. */
static double highest_frequency(const post_campbell *c) {
  const modal_speeds *s = c->speeds;
  double top = s->speed[s->n - 1], line = highest_order(c) * top / SHB_TWO_PI, third = 0, last = 0;
  for (int i = 0; i < s->n; i++) {
    third = fmax(third, modal_speeds_frequency(s, i, s->n_modes < 3 ? s->n_modes - 1 : 2));
    last  = fmax(last, modal_speeds_frequency(s, i, s->n_modes - 1));
  }
  return fmin(1.12 * fmax(line, third), fmax(1.12 * last, third));
}

static void draw_track(curves *c, const post_plot *plot, int track) {
  const modal_speeds *s = c->speeds;
  double              x[SAMPLES], y[SAMPLES], least = INFINITY;
  char                classes[24];
  for (int i = 0; i < SAMPLES; i++) {
    double speed = speed_at(s, i, SAMPLES);
    x[i]         = speed;
    y[i]         = frequency_at(c, track, speed);
    if (y[i] < least) least = y[i];
  }
  if (least > plot->y.hi) return;
  snprintf(classes, sizeof classes, "line k%d", track % COLOURS);
  plot_line(plot, classes, SAMPLES, x, y, NULL);
  snprintf(classes, sizeof classes, "dot k%d", track % COLOURS);
  for (int i = 0; i < s->n; i++)
    if (modal_speeds_frequency(s, i, track) <= plot->y.hi)
      plot_dot(plot, classes, s->speed[i], modal_speeds_frequency(s, i, track), 2.6);
}

static void draw_stuck(const post_campbell *c, const post_plot *plot, int j) {
  const modal_speeds *s = c->speeds;
  double              x[SAMPLES], y[SAMPLES];
  for (int i = 0; i < SAMPLES; i++) {
    x[i] = speed_at(s, i, SAMPLES);
    y[i] = stuck_at(c, j, x[i]);
  }
  if (y[0] <= plot->y.hi) plot_line(plot, "line coupled", SAMPLES, x, y, NULL);
}

/* Heights of the labels on the right, px. */
typedef struct {
  int    n;
  double y[64];
} names;

/* Put a label beyond the right edge, at its height or slightly moved; none without space. */
static void put_name(const post_plot *plot, names *all, const char *classes, double value,
                     const char *text) {
  static const double shift[] = {0, 7, -7, 14, -14};
  for (int k = 0; k < 5 && all->n < 64; k++) {
    double y    = plot_y(plot, value) + shift[k];
    bool   free = true;
    for (int i = 0; i < all->n; i++) free = free && fabs(all->y[i] - y) >= 13;
    if (!free) continue;
    all->y[all->n++] = y;
    plot_text(plot, classes, plot->x.hi, value, (double[2]){10, 4 + shift[k]}, "start", text);
    return;
  }
}

static void name_tracks(const modal_speeds *s, const post_plot *plot, names *all) {
  for (int t = 0; t < s->n_modes; t++) {
    char   text[16], classes[24];
    double f = modal_speeds_frequency(s, s->n - 1, t);
    if (!(f <= plot->y.hi)) continue;
    snprintf(text, sizeof text, "mode %d", t + 1);
    snprintf(classes, sizeof classes, "name k%d", t % COLOURS);
    put_name(plot, all, classes, f, text);
  }
}

/* Label an order where its line leaves the area, above or on the right. last: the label before
 * above, px. */
static void name_order(const post_plot *plot, int order, double slope, double *last, names *all) {
  char   text[24];
  double right = slope * plot->x.hi, x = plot_x(plot, plot->y.hi / slope);
  snprintf(text, sizeof text, "%dE", order);
  if (right <= plot->y.hi) {
    put_name(plot, all, "tick", right, text);
  } else if (fabs(x - *last) >= 26) {
    *last = x;
    plot_text(plot, "tick", plot->y.hi / slope, plot->y.hi, (double[2]){0, -6}, "middle", text);
  }
}

/* Excited orders are drawn first, so that their labels find space. */
static void draw_orders(const post_campbell *c, const post_plot *plot, names *all) {
  int    highest = highest_order(c), most = highest < 10 ? 10 : highest + 2;
  int    step = 1 + (most - 1) / MOST_ORDERS;
  double last = -1e9;
  for (int pass = 0; pass < 2; pass++)
    for (int order = 1; order <= most; order++) {
      bool excited = is_excited(c, order);
      if (excited == (pass == 1) || (!excited && order % step != 0)) continue;
      double x[2] = {fmin(plot->x.lo, plot->x.hi), plot->x.hi}, slope = order / SHB_TWO_PI;
      x[1] = fmin(x[1], plot->y.hi / slope);
      if (x[0] >= x[1]) continue;
      plot_line(plot, excited ? "order excited" : "order", 2, x,
                (double[2]){slope * x[0], slope * x[1]}, NULL);
      name_order(plot, order, slope, &last, all);
    }
}

static void draw(const post_campbell *campbell, post_plot *plot) {
  const modal_speeds *s = campbell->speeds;
  curves              c;
  int                 n        = 0;
  post_crossing      *crossing = NULL;
  double              unit     = SHB_TWO_PI / 60;
  names               all      = {0};
  if (curves_create(s, &c) != SHB_OK) {
    plot->out->failed = true;
    return;
  }
  plot->x = (plot_axis){s->speed[0], s->speed[s->n - 1], false, 0, unit, "speed, rpm"};
  plot->y = (plot_axis){0, highest_frequency(campbell), false, 0, 1, "frequency, Hz"};
  plot_frame(plot);
  name_tracks(s, plot, &all);
  draw_orders(campbell, plot, &all);
  for (int t = 0; t < s->n_modes; t++) draw_track(&c, plot, t);
  for (int j = 0; j < campbell->n_stuck; j++) draw_stuck(campbell, plot, j);
  if (post_campbell_crossings(campbell, &n, &crossing) != SHB_OK) plot->out->failed = true;
  for (int i = 0; i < n; i++)
    if (crossing[i].frequency <= plot->y.hi)
      plot_dot(plot, "crossing", crossing[i].speed, crossing[i].frequency, 6);
  free(crossing);
  curves_free(&c);
}

enum { ID = 32 };

/* Name of a diagram in a page. */
static const char *id_of(const post_campbell *campbell, char id[ID]) {
  if (campbell->blades > 0)
    snprintf(id, ID, "campbell-%d", campbell->diameter);
  else
    snprintf(id, ID, "campbell");
  return id;
}

static void put_plot(const post_campbell *campbell, double top, post_buffer *out) {
  char      id[ID];
  post_plot plot = {.out    = out,
                    .id     = id_of(campbell, id),
                    .left   = 66,
                    .top    = top,
                    .width  = WIDTH - 66 - 80,
                    .height = HEIGHT - 76 - 58};
  draw(campbell, &plot);
}

static const char description[] =
    "Frequencies of the modes over the rotor's speed, dotted those of the ring with stuck "
    "contacts, "
    "straight lines the engine orders, rings where an excited order meets one. The crossings are "
    "in "
    "the table.";

void post_campbell_picture(const post_campbell *campbell, const char *case_name, post_buffer *out) {
  char title[256], of[48] = "";
  if (campbell->blades > 0) snprintf(of, sizeof of, ", nodal diameter %d", campbell->diameter);
  snprintf(title, sizeof title, "Campbell diagram%s: %s", of, case_name);
  plot_picture_open(out, "campbell", WIDTH, HEIGHT, title, description, post_campbell_css);
  put_plot(campbell, 76, out);
  plot_svg_close(out);
}

/* ---------------------------------------------------------------- the report's section */

static void put_crossings(const post_campbell *campbell, post_buffer *out) {
  int            n;
  post_crossing *all;
  char           rpm[POST_NUMBER], hz[POST_NUMBER];
  if (post_campbell_crossings(campbell, &n, &all) != SHB_OK) {
    out->failed = true;
    return;
  }
  if (n == 0) {
    post_put(out, "<p class=\"note\">No excited order meets a mode in this range of speeds.</p>\n");
    return;
  }
  post_put(out,
           "<div class=\"scroll\"><table><caption>Resonances of the free %s%s in the range of "
           "speeds.</caption>\n<thead><tr><th scope=\"col\">Speed, rpm</th><th "
           "scope=\"col\">Order</th><th scope=\"col\">Mode</th><th scope=\"col\">Frequency, "
           "Hz</th></tr></thead>\n<tbody>\n",
           campbell->blades > 0 ? "sectors" : "blade",
           campbell->n_stuck > 0 ? ", and of the ring with stuck contacts," : "");
  for (int i = 0; i < n; i++)
    post_put(out, "<tr><th scope=\"row\">%s</th><td>%dE</td><td>%s%d</td><td>%s</td></tr>\n",
             post_plain(rpm, all[i].speed * 60 / SHB_TWO_PI, 5), all[i].order,
             all[i].stuck ? "stuck " : "", all[i].track + 1, post_plain(hz, all[i].frequency, 5));
  post_put(out, "</tbody></table></div>\n");
  free(all);
}

/* One diagram with its crossings. */
static void put_diagram(const post_campbell *campbell, post_buffer *out) {
  char id[ID];
  if (campbell->blades > 0) post_put(out, "<h3>Nodal diameter %d</h3>\n", campbell->diameter);
  post_put(out, "<div class=\"card\"><figure><div class=\"chart\">\n");
  plot_svg_open(out, id_of(campbell, id), WIDTH, HEIGHT - 42, "Campbell diagram", description);
  put_plot(campbell, 34, out);
  plot_svg_close(out);
  post_put(out, "</div></figure></div>\n");
  put_crossings(campbell, out);
}

void post_campbell_section(int n, const post_campbell *campbell, post_buffer *out) {
  const bool disc = campbell->blades > 0;
  post_put(out,
           "<section>\n<h2>Campbell diagram</h2>\n<p class=\"note\">Modes of the %s with free "
           "contact faces at %d speeds (dots), followed by their shapes (MAC) and joined in "
           "Ω².%s Straight lines: engine orders, the excited ones dashed; rings: where they meet a "
           "mode.%s</p>\n",
           disc ? "sector" : "blade", campbell->speeds->n,
           campbell->n_stuck == 0 ? ""
           : disc                 ? " Dotted: the same with stuck contacts."
                  : " Dotted: the ring with stuck contacts, at the nodal diameter of "
                    "the excitation.",
           disc ? " An excited order meets the modes of its own nodal diameter only." : "");
  for (int i = 0; i < n; i++) put_diagram(&campbell[i], out);
  post_put(out, "</section>\n");
}

/* ---------------------------------------------------------------- for a terminal */

void post_campbell_table(const modal_speeds *s, bool all, post_buffer *out) {
  int  shown = all || s->n_modes <= AT_FIRST ? s->n_modes : AT_FIRST;
  int  step  = all || s->n <= 10 ? 1 : (s->n + 8) / 9;
  char text[POST_NUMBER];
  post_put(out, "  %d speeds; frequencies of the tracked modes, Hz (*: MAC below %g)\n  %6s", s->n,
           modal_speeds_mac_limit, "rpm");
  for (int i = 0; i < s->n; i += step) {
    post_put_column(out, 10, post_plain(text, s->speed[i] * 60 / SHB_TWO_PI, 5));
    post_put(out, " ");
  }
  post_put(out, "\n");
  for (int t = 0; t < shown; t++) {
    post_put(out, "  %6d", t + 1);
    for (int i = 0; i < s->n; i += step) {
      post_put_column(out, 10, post_plain(text, modal_speeds_frequency(s, i, t), 6));
      post_put(out, s->mac[i * s->n_modes + t] < modal_speeds_mac_limit ? "*" : " ");
    }
    post_put(out, "\n");
  }
  if (shown < s->n_modes) post_put(out, "  … %d more (--verbose shows them)\n", s->n_modes - shown);
}
