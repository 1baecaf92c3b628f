#include "postproc/report/safe_diagram.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "mesh/base/constants.h"
#include "mhb/continuation/linear_resonances.h"
#include "mhb/structure/gyroscopic.h"
#include "modal/model/nodal_diameters.h"
#include "postproc/draw/number_format.h"
#include "postproc/draw/plot.h"

enum { WIDTH = 1000, HEIGHT = 500, MOST_FAMILIES = 8, SHOWN = 3 };

/* ---------------------------------------------------------------- frequencies */

/* Families up to half above the range, at least three. */
static int count_families(const modal_model *model, double high) {
  int n = 0;
  while (n < model->n_modes && n < MOST_FAMILIES && (n < SHOWN || model->frequency[n] < 1.5 * high))
    n++;
  return n;
}

static void find_driven(const modal_model *model, post_safe *s) {
  for (int k = 1; k <= model->n_load && s->n_driven < 16; k++)
    if (modal_model_is_driven(model, k)) s->driven[s->n_driven++] = k;
}

/* The model at a nodal diameter; NULL: the file of a disc lacks it. */
static const modal_model *model_at(const modal_model *model, const mhb_settings *settings,
                                   int diameter) {
  const modal_nodal_diameters *disc = settings->nodal_diameters;
  if (!disc) return model;
  const int at = modal_nodal_diameters_find(disc, diameter);
  return at < 0 ? NULL : &disc->model[at];
}

/* Frequencies of the open families at a nodal diameter, Hz. With Coriolis terms they are those of
 * the wave that runs to the right, as an excitation of that order does. */
static shb_status find_open(const modal_model *own, const mhb_settings *settings, int diameter,
                            int n, double *open) {
  modal_wave     wave;
  mhb_gyroscopic g;
  int            missing;
  for (int i = 0; i < n; i++) open[i] = own ? own->frequency[i] : NAN;
  if (!own || !own->coriolis) return SHB_OK;
  if (!settings->nodal_diameters ||
      !modal_nodal_diameters_wave(settings->nodal_diameters, diameter, &wave, &missing))
    wave = modal_wave_real(own);
  shb_status status = mhb_gyroscopic_of_wave(&wave, &g);
  for (int i = 0; i < n && status == SHB_OK; i++) open[i] = g.omega[g.n + i] / SHB_TWO_PI;
  mhb_gyroscopic_free(&g);
  return status;
}

shb_status post_safe_compute(const modal_model *model, const mhb_settings *settings,
                             const double range[2], double speed, post_safe *s) {
  *s = (post_safe){.blades       = settings->blades,
                   .engine_order = settings->engine_order,
                   .range        = {range[0], range[1]},
                   .speed        = speed,
                   .disc         = settings->nodal_diameters != NULL};
  if (settings->to_ground || !model->has_left || model->n_pairs == 0 || settings->blades < 3)
    return SHB_OK;
  const int n = count_families(model, range[1]), diameters = settings->blades / 2 + 1;
  s->open           = calloc((size_t)n * (size_t)diameters, sizeof *s->open);
  s->stuck          = calloc((size_t)n * (size_t)diameters, sizeof *s->stuck);
  shb_status status = s->open && s->stuck ? SHB_OK : SHB_ERR_IO;
  SHB_CHECK(status == SHB_OK, SHB_ERR_IO, "not enough memory for the SAFE diagram");
  for (int d = 0; d < diameters && status == SHB_OK; d++) {
    const modal_model *own = model_at(model, settings, d);
    status                 = find_open(own, settings, d, n, s->open + d * n);
    for (int i = 0; i < n; i++) s->stuck[d * n + i] = NAN;
    if (own && status == SHB_OK)
      status = mhb_stuck_frequencies(own, settings, d, n, s->stuck + d * n);
  }
  find_driven(model, s);
  s->n_families = n;
  return status;
}

void post_safe_free(post_safe *s) {
  free(s->open);
  free(s->stuck);
  *s = (post_safe){0};
}

/* ---------------------------------------------------------------- diagram */

static void draw_family(const post_safe *s, const post_plot *plot, int family, bool stuck) {
  const int most = s->blades / 2 + 1;
  double    x[most], y[most];
  int       n = 0;
  for (int d = 0; d < most; d++) {
    const double f = (stuck ? s->stuck : s->open)[d * s->n_families + family];
    if (!(f == f)) continue; /* a diameter that the file of a disc lacks */
    x[n]   = d;
    y[n++] = f;
  }
  plot_line(plot, stuck ? "line limit stuck" : "line limit open", n, x, y, NULL);
  for (int i = 0; i < n; i++)
    if (y[i] <= plot->y.hi) plot_dot(plot, "dot family", x[i], y[i], 2.2);
}

/* The range of the curves at the diameter of each driven harmonic; rings where it holds a
 * frequency. Harmonic k of the excitation is at k times the frequency of the curve. */
static void draw_excitation(const post_safe *s, const post_plot *plot) {
  for (int h = 0; h < s->n_driven; h++) {
    const int    k = s->driven[h], d = modal_nodal_diameter(k * s->engine_order, s->blades);
    const double lo = k * s->range[0], hi = fmin(k * s->range[1], plot->y.hi), x[2] = {d, d};
    char         text[32];
    if (lo >= plot->y.hi) continue;
    plot_line(plot, "line excited", 2, x, (double[2]){lo, hi}, NULL);
    snprintf(text, sizeof text, "%d E = %d", k, k * s->engine_order);
    plot_text(plot, "mark", d, hi, (double[2]){6, 4}, "start", k == 1 ? text + 2 : text);
    for (int i = 0; i < 2 * s->n_families; i++) {
      double f = (i % 2 ? s->stuck : s->open)[d * s->n_families + i / 2];
      if (f >= lo && f <= hi) plot_dot(plot, "crossing", d, f, 6);
    }
  }
}

/* The zigzag of all engine orders at the speed of the rotor: order k is at k Omega. */
static void draw_zigzag(const post_safe *s, const post_plot *plot) {
  const double rate = s->speed / SHB_TWO_PI;
  if (!(rate > 0)) return;
  const int n = (int)fmin(4. * s->blades, plot->y.hi / rate) + 2;
  double   *x = calloc((size_t)n, 2 * sizeof *x), *y = x ? x + n : NULL;
  if (!x) {
    plot->out->failed = true;
    return;
  }
  for (int k = 0; k < n; k++) {
    x[k] = modal_nodal_diameter(k, s->blades);
    y[k] = k * rate;
  }
  plot_line(plot, "order", n, x, y, NULL);
  free(x);
}

static double top_of(const post_safe *s) {
  const int last = s->n_families < SHOWN ? s->n_families - 1 : SHOWN - 1;
  double    top  = 1.15 * s->range[1];
  for (int d = 0; d <= s->blades / 2; d++)
    top = fmax(top, fmin(2 * s->range[1], 1.05 * s->stuck[d * s->n_families + last]));
  return top;
}

static void put_rows(const post_safe *s, post_buffer *out) {
  char number[POST_NUMBER];
  post_put(out,
           "<div class=\"scroll\"><table><caption>Frequencies at the nodal diameter of each "
           "excited order, Hz.</caption>\n<thead><tr><th scope=\"col\">Order</th>"
           "<th scope=\"col\">Nodal diameter</th><th scope=\"col\">Contacts</th>");
  for (int i = 0; i < s->n_families; i++) post_put(out, "<th scope=\"col\">%d</th>", i + 1);
  post_put(out, "</tr></thead>\n<tbody>\n");
  for (int h = 0; h < s->n_driven; h++) {
    const int order = s->driven[h] * s->engine_order, d = modal_nodal_diameter(order, s->blades);
    for (int stuck = 0; stuck < 2; stuck++) {
      post_put(out, "<tr><th scope=\"row\">%d</th><td>%d</td><td>%s</td>", order, d,
               stuck ? "stuck" : "open");
      for (int i = 0; i < s->n_families; i++)
        post_put(out, "<td>%s</td>",
                 post_number(number, (stuck ? s->stuck : s->open)[d * s->n_families + i], 5));
      post_put(out, "</tr>\n");
    }
  }
  post_put(out, "</tbody></table></div>\n");
}

void post_safe_section(const post_safe *s, post_buffer *out) {
  if (s->n_families == 0) return;
  post_put(out,
           "<section>\n<h2>Nodal diameters</h2>\n<p class=\"note\">SAFE diagram: natural "
           "frequencies of the ring over the nodal diameter, with open contacts (dashed) and with "
           "stuck ones (dotted). %s Thick: frequencies of the curves, at the nodal diameter that "
           "the excitation drives; "
           "rings: its resonances there.%s</p>\n"
           "<div class=\"card\"><figure><div class=\"chart\">\n",
           s->disc ? "The blades share a flexible disc; dots: the nodal diameters of the file."
                   : "The root is clamped, so that open blades do not know each other.",
           s->speed > 0 ? " Thin zigzag: every engine order at the speed of the rotor." : "");
  plot_svg_open(out, "safe", WIDTH, HEIGHT, "SAFE diagram",
                "Natural frequencies of the ring over the nodal diameter; the table has those of "
                "the excited orders.");
  post_plot plot = {.out    = out,
                    .id     = "safe-a",
                    .left   = 66,
                    .top    = 34,
                    .width  = WIDTH - 66 - 40,
                    .height = HEIGHT - 34 - 58};
  const int last = s->blades / 2;
  plot.x         = (plot_axis){-0.3, last + 0.3, false, 0, 1, "nodal diameter"};
  plot.y         = (plot_axis){0, top_of(s), false, 0, 1, "frequency, Hz"};
  plot_frame(&plot);
  draw_zigzag(s, &plot);
  for (int i = 0; i < s->n_families; i++)
    for (int stuck = 0; stuck < 2; stuck++) draw_family(s, &plot, i, stuck);
  draw_excitation(s, &plot);
  plot_svg_close(out);
  post_put(out, "</div></figure></div>\n");
  put_rows(s, out);
  post_put(out, "</section>\n");
}
