#include "postproc/report/ring_charts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "mhb/response/ring_description.h"
#include "postproc/draw/number_format.h"
#include "postproc/draw/plot.h"

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

int post_factor_corners(const mhb_samples *s, int preload, double *x, double *share) {
  int n = 0;
  for (int i = 0; i < s->n; i++) {
    const double factor = s->factor[preload * s->n + i];
    if (factor > 0 && !s->mark[preload * s->n + i]) x[n++] = factor;
  }
  qsort(x, (size_t)n, sizeof *x, ascending);
  for (int i = n - 1; i >= 0;
       i--) { /* from the back: each goes to two places at or behind its own */
    x[2 * i] = x[2 * i + 1] = x[i];
    share[2 * i]            = (double)i / n;
    share[2 * i + 1]        = (i + 1.) / n;
  }
  return 2 * n;
}

/* Least and largest factor of all preloads, and the most factors of one. */
static int extent(const mhb_samples *s, double range[2]) {
  int most = 0;
  range[0] = INFINITY;
  range[1] = -INFINITY;
  for (int i = 0; i < s->n * s->preloads; i++) {
    if (!(s->factor[i] > 0) || s->mark[i]) continue;
    range[0] = fmin(range[0], s->factor[i]);
    range[1] = fmax(range[1], s->factor[i]);
  }
  for (int p = 0; p < s->preloads; p++)
    most = (int)fmax(most, mhb_samples_done(s, p) - mhb_samples_marked(s, p));
  return most;
}

static void draw(const mhb_samples *s, const post_plot *plot, double *x, double *share) {
  for (int p = 0; p < s->preloads; p++) {
    const int n = post_factor_corners(s, p, x, share);
    char      classes[32], name[64], n0[POST_NUMBER];
    if (n == 0) continue;
    snprintf(classes, sizeof classes, "line c%d", p);
    plot_line(plot, classes, n, x, share, NULL);
    snprintf(classes, sizeof classes, "mark c%d", p);
    snprintf(name, sizeof name, "n0 = %s N", post_plain(n0, s->n0[p], 4));
    const int    rings = n / 2, beside = (int)((0.1 + 0.8 * (p + 0.5) / s->preloads) * rings);
    const double move[2] = {8, 13};
    plot_text(plot, classes, x[2 * beside + 1], share[2 * beside + 1], move, "start", name);
  }
}

void post_put_factors(const mhb_samples *s, post_buffer *out) {
  double range[2];
  if (!s || extent(s, range) < 2) return;
  double *x = calloc(4 * (size_t)s->n, sizeof *x);
  if (!x) {
    out->failed = true;
    return;
  }
  post_put(out,
           "<section>\n<h2>Amplification of random rings</h2>\n<p class=\"note\">Share of the "
           "rings whose worst blade swings at most so many times as high as equal blades would. "
           "Quantiles with their bounds of confidence are in the file and in the findings.</p>\n"
           "<div class=\"card\"><figure><div class=\"chart\">\n");
  plot_svg_open(out, "factors", 1100, 360, "Distribution of the amplification factor",
                "Share of random rings over the amplification factor, a curve for each preload.");
  post_plot plot = {
      .out = out, .id = "factors", .left = 60, .top = 34, .width = 1020, .height = 270};
  plot.x = plot_axis_around(range[0], range[1], false, 1, "amplification factor");
  plot.y = (plot_axis){-0.02, 1.02, false, 0, 0.01, "share of the rings, %"};
  plot_frame(&plot);
  draw(s, &plot, x, x + 2 * s->n);
  plot_svg_close(out);
  post_put(out, "</div></figure></div>\n</section>\n");
  free(x);
}

/* ---- the amplitude of every blade ---- */

enum { PANELS = 12, ACROSS = 3, PANEL_WIDTH = 340, PANEL_HEIGHT = 190 };

/* Point of a curve that is shown: the highest of a main one. -1: none. */
static int shown_point(const mhb_response *r, const mhb_branch *b) {
  const int least = mhb_ring_most_localised(r, b),
            each  = r->n_probes > 0 ? r->n_probes : r->n_pairs;
  int    best     = -1;
  double most     = 0;
  if (b->kind != MHB_BRANCH_NONLINEAR || least < 0) return -1;
  if (b->origin != MHB_FROM_END) return least;
  for (int i = 0; i < b->n_points; i++)
    for (int place = 0; place < each; place += each / r->ring) {
      const double amplitude = mhb_response_amplitude(r, b, i, place);
      if (amplitude > most) best = i;
      most = fmax(most, amplitude);
    }
  return best;
}

static void put_panel(const mhb_response *r, int branch, int point, int panel, post_buffer *out) {
  const mhb_branch *b    = &r->branch[branch];
  const int         each = (r->n_probes > 0 ? r->n_probes : r->n_pairs) / r->ring;
  double            size[r->ring], most = 0;
  char              text[96], id[32], n0[POST_NUMBER], value[POST_NUMBER];
  for (int i = 0; i < r->ring; i++) {
    size[i] = mhb_response_amplitude(r, b, point, i * each);
    most    = fmax(most, size[i]);
  }
  if (!(most > 0)) return;
  snprintf(id, sizeof id, "blades%d", panel);
  const int column = panel % ACROSS, row = panel / ACROSS;
  post_plot plot = {.out    = out,
                    .id     = id,
                    .left   = 50 + column * PANEL_WIDTH,
                    .top    = 30 + row * PANEL_HEIGHT,
                    .width  = PANEL_WIDTH - 60,
                    .height = PANEL_HEIGHT - 75};
  plot.x         = (plot_axis){-0.5, r->ring - 0.5, false, 0, 1, "blade"};
  plot.y         = (plot_axis){0, 1.25, false, 0, 1, NULL};
  plot_frame(&plot);
  for (int i = 0; i < r->ring; i++)
    plot_bar(&plot, b->stable[point] == 0 ? "bar c1" : "bar c0",
             (const double[2]){i - 0.4, i + 0.4}, (const double[2]){0, size[i] / most});
  snprintf(text, sizeof text, "n0 = %s N, %s, curve %d: %s", post_plain(n0, b->n0[point], 4),
           post_plain(value, b->value[point], 5), branch, mhb_ring_kind_name(b->ring_kind[point]));
  plot_text(&plot, "small", -0.5, 1.25, (const double[2]){0, -5}, "start", text);
}

/* The curves of the panels: main ones first. Returns their number. */
static int choose_panels(const mhb_response *r, int branch[PANELS], int point[PANELS]) {
  int n = 0;
  for (int others = 0; others < 2; others++)
    for (int b = 0; b < r->n_branches && n < PANELS; b++) {
      if ((r->branch[b].origin != MHB_FROM_END) != (others == 1)) continue;
      const int at = shown_point(r, &r->branch[b]);
      if (at < 0) continue;
      branch[n]  = b;
      point[n++] = at;
    }
  return n;
}

void post_put_blades(const mhb_response *r, post_buffer *out) {
  int       branch[PANELS], point[PANELS];
  const int n = r->ring ? choose_panels(r, branch, point) : 0;
  if (n == 0) return;
  post_put(out,
           "<section>\n<h2>Amplitude of every blade</h2>\n<p class=\"note\">Of the first "
           "harmonic, relative to the blade that swings highest: main curves at their highest "
           "point, other curves where the fewest blades take part. Unstable motions have another "
           "colour.</p>\n<div class=\"card\"><figure><div class=\"chart\">\n");
  const int rows = (n + ACROSS - 1) / ACROSS;
  plot_svg_open(out, "blades", 1100, 20 + rows * PANEL_HEIGHT, "Amplitude of every blade",
                "A bar for each blade, a panel for each curve.");
  for (int i = 0; i < n; i++) put_panel(r, branch[i], point[i], i, out);
  plot_svg_close(out);
  post_put(out, "</div></figure></div>\n</section>\n");
}
