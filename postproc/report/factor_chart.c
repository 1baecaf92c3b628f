#include "postproc/report/factor_chart.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

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
    if (factor > 0) x[n++] = factor;
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
    if (!(s->factor[i] > 0)) continue;
    range[0] = fmin(range[0], s->factor[i]);
    range[1] = fmax(range[1], s->factor[i]);
  }
  for (int p = 0; p < s->preloads; p++) most = (int)fmax(most, mhb_samples_done(s, p));
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
