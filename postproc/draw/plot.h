/* Plots as SVG: axes with round ticks, curves, marks. Independent of the application.
 *
 * Elements carry classes, no colours; the page or the picture brings the style. Lines are stroked
 * and marks are filled with currentColor. */
#ifndef POSTPROC_DRAW_PLOT_H
#define POSTPROC_DRAW_PLOT_H

#include <stdbool.h>

#include "postproc/draw/text_buffer.h"

typedef struct {
  double lo, hi; /* data range */
  bool   log;
  double knee; /* above 0: position by asinh(value / knee), both signs over decades */
  double unit; /* ticks read value / unit; 0: no ticks */
  /* "frequency, Hz" (escaped when printed); NULL: neither label nor tick labels. */
  const char *label;
} plot_axis;

/* One data area inside an SVG. */
typedef struct {
  post_buffer *out;
  const char  *id;                       /* unique in the page: names the clip path */
  double       left, top, width, height; /* px */
  plot_axis    x, y;
} post_plot;

enum { PLOT_MAX_TICKS = 24 };

/* Round tick values inside [lo, hi] in units of the axis, about wanted of them: steps of 1, 2, 5.
 * On a log axis: decades, with 2 and 5 between if there are few. Returns their number. */
int plot_ticks(const plot_axis *axis, int wanted, double ticks[PLOT_MAX_TICKS]);

/* Axis over [lo, hi] with a margin; a range without extent is widened. log is ignored if lo <=
 * 0. */
plot_axis plot_axis_around(double lo, double hi, bool log, double unit, const char *label);

/* The same with positions by asinh. */
plot_axis plot_axis_signed(double lo, double hi, double knee, double unit, const char *label);

/* px; NAN where a log axis has no position for it */
double plot_x(const post_plot *plot, double x);
double plot_y(const post_plot *plot, double y);

/* Start <svg> with <title> and <desc> (escaped); plot_svg_close ends it. */
void plot_svg_open(post_buffer *out, const char *id, double width, double height, const char *title,
                   const char *description);
void plot_svg_close(post_buffer *out);

/* Start a stand-alone picture: XML declaration, <svg>, style for a light or dark viewer followed by
 * the rules css, background, heading. plot_svg_close ends it. */
void plot_picture_open(post_buffer *out, const char *id, int width, int height, const char *title,
                       const char *description, const char *css);

void plot_frame(const post_plot *plot); /* grid, ticks, labels, clip path */
/* Label the vertical ticks as powers of ten, for an axis whose label is NULL. Call it after the
 * frame. */
void plot_powers(const post_plot *plot);
/* Curve through [n] points. Piece i joins points i - 1 and i; it is drawn where piece[i] (NULL:
 * always). Values that are not finite, or not positive on a log axis, interrupt it. Points within
 * 0.4 px are merged. A curve of one point is a small circle. */
void plot_line(const post_plot *plot, const char *classes, int n, const double *x, const double *y,
               const bool *piece);
/* Area between two curves over [n] points. Points that have no position are left out. */
void plot_band(const post_plot *plot, const char *classes, int n, const double *x,
               const double *low, const double *high);
/* Rectangle between two corners in data units. */
void plot_bar(const post_plot *plot, const char *classes, const double x[2], const double y[2]);
void plot_dot(const post_plot *plot, const char *classes, double x, double y, double radius);
/* Text at a data point, moved by (dx, dy) px. anchor: start, middle or end. Text is escaped. */
void plot_text(const post_plot *plot, const char *classes, double x, double y, const double move[2],
               const char *anchor, const char *text);
/* Horizontal line across the data area. */
void plot_level(const post_plot *plot, const char *classes, double y);

#endif
