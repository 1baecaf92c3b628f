/* Plots as SVG: axes with round ticks, curves, marks. Knows nothing of blades.
 *
 * Elements carry classes, no colours; the page or the picture brings the style. Lines are stroked and marks filled
 * with currentColor. */
#ifndef POSTPROC_DRAW_PLOT_H
#define POSTPROC_DRAW_PLOT_H

#include <stdbool.h>

#include "postproc/draw/text_buffer.h"

typedef struct {
  double lo, hi; /* data range */
  bool   log;
  double knee; /* > 0: place by asinh(value / knee), for both signs over decades */
  double unit; /* ticks read value / unit; 0: no ticks */
  const char
      *label; /* "frequency, Hz" (escaped when printed); NULL: neither label nor tick labels */
} plot_axis;

/* One data area inside an SVG. */
typedef struct {
  post_buffer *out;
  const char  *id;                       /* unique in the page: names the clip path */
  double       left, top, width, height; /* px */
  plot_axis    x, y;
} post_plot;

enum { PLOT_MAX_TICKS = 24 };

/* Round values inside [lo, hi] in units of the axis: 1, 2, 5 steps, about wanted of them; on a log axis decades (and
 * 2, 5 between when there are few). Returns how many. */
int plot_ticks(const plot_axis *axis, int wanted, double ticks[PLOT_MAX_TICKS]);

/* Range that holds [lo, hi] with a little air; one without extent is widened. log_scale is not heeded where lo <= 0. */
plot_axis plot_axis_around(double lo, double hi, bool log, double unit, const char *label);

/* The same by asinh. */
plot_axis plot_axis_signed(double lo, double hi, double knee, double unit, const char *label);

double plot_x(const post_plot *plot, double x); /* px; NAN where a log axis has no place for it */
double plot_y(const post_plot *plot, double y);

/* <svg> with <title> and <desc> (escaped), to be closed by plot_svg_close.. */
void plot_svg_open(post_buffer *out, const char *id, double width, double height, const char *title,
                   const char *description);
void plot_svg_close(post_buffer *out);

void plot_frame(const post_plot *plot); /* grid, ticks, labels, clip path */
/* Labels of the vertical ticks as powers of ten, for an axis whose own label is NULL. After the frame. */
void plot_powers(const post_plot *plot);
/* Curve through [n] points; piece i joins points i - 1 and i and is drawn where piece[i] (NULL: everywhere). Values
 * that are not finite, or not positive on a log axis, part it. Points within 0.4 px are merged.
 * A curve of one point is a small circle. */
void plot_line(const post_plot *plot, const char *classes, int n, const double *x, const double *y,
               const bool *piece);
/* Rectangle between two corners in data units. */
void plot_bar(const post_plot *plot, const char *classes, const double x[2], const double y[2]);
void plot_dot(const post_plot *plot, const char *classes, double x, double y, double radius);
/* Text at a data point, moved by (dx, dy) px; anchor start, middle or end; text is escaped. */
void plot_text(const post_plot *plot, const char *classes, double x, double y, const double move[2],
               const char *anchor, const char *text);
/* Horizontal line across the data area. */
void plot_level(const post_plot *plot, const char *classes, double y);

#endif
