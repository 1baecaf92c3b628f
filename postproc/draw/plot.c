#include "postproc/draw/plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "postproc/draw/number_format.h"

static double round_step(double extent, int wanted) {
  double raw = extent / wanted, power = pow(10, floor(log10(raw))), mantissa = raw / power;
  return power * (mantissa <= 1.0001 ? 1 : mantissa <= 2.0001 ? 2 : mantissa <= 5.0001 ? 5 : 10);
}

static int even_ticks(double lo, double hi, double step, double ticks[PLOT_MAX_TICKS]) {
  int n = 0;
  for (double k = ceil(lo / step - 1e-9); k * step <= hi + 1e-9 * step && n < PLOT_MAX_TICKS; k++)
    ticks[n++] = k * step;
  return n;
}

/* A step rounded up past the range leaves a single tick, which shows no scale: then take finer
 * steps. */
static int linear_ticks(double lo, double hi, int wanted, double ticks[PLOT_MAX_TICKS]) {
  int n = 0, least = wanted < 3 ? wanted : 3;
  for (int w = wanted; n < least && w <= 3 * wanted; w++)
    n = even_ticks(lo, hi, round_step(hi - lo, w), ticks);
  return n;
}

static int log_ticks(double lo, double hi, int wanted, double ticks[PLOT_MAX_TICKS]) {
  static const double between[] = {1, 2, 5};
  double              decades   = log10(hi / lo);
  if (decades < 0.5) return linear_ticks(lo, hi, wanted, ticks);
  int parts = decades <= wanted / 2.5 ? 3 : 1, skip = (int)ceil(decades / wanted), n = 0;
  for (int d = (int)floor(log10(lo)); d <= (int)ceil(log10(hi)); d++)
    for (int i = 0; i < parts; i++) {
      double t = between[i] * pow(10, d);
      if (t >= lo * (1 - 1e-9) && t <= hi * (1 + 1e-9) && d % skip == 0 && n < PLOT_MAX_TICKS)
        ticks[n++] = t;
    }
  return n;
}

static double place(const plot_axis *axis, double value) {
  if (axis->knee > 0) {
    double lo = asinh(axis->lo / axis->knee), hi = asinh(axis->hi / axis->knee);
    return (asinh(value / axis->knee) - lo) / (hi - lo);
  }
  if (!axis->log) return (value - axis->lo) / (axis->hi - axis->lo);
  return value > 0 ? log(value / axis->lo) / log(axis->hi / axis->lo) : NAN;
}

/* 0, then outwards on both sides 1, 2, 5 of each decade from the knee on. Ticks too close to the
 * one before are left out. */
static int signed_ticks(const plot_axis *axis, int wanted, double ticks[PLOT_MAX_TICKS]) {
  static const double step[] = {1, 2, 5};
  int                 lowest = (int)floor(log10(axis->knee / axis->unit)), n = 0;
  int                 highest = (int)ceil(log10(fmax(fabs(axis->lo), fabs(axis->hi)) / axis->unit));
  if (axis->lo <= 0 && axis->hi >= 0) ticks[n++] = 0;
  for (int sign = 1; sign >= -1; sign -= 2) {
    double last = place(axis, 0);
    for (int i = 0; i < 3 * (highest - lowest + 1) && n < PLOT_MAX_TICKS; i++) {
      int    decade = lowest + i / 3;
      double t = sign * step[i % 3] * pow(10, decade), at = place(axis, t * axis->unit);
      if (at < 0 || at > 1 || fabs(at - last) < 0.7 / wanted) continue;
      ticks[n++] = t;
      last       = at;
    }
  }
  return n;
}

int plot_ticks(const plot_axis *axis, int wanted, double ticks[PLOT_MAX_TICKS]) {
  if (!(axis->unit > 0) || !(axis->hi > axis->lo)) return 0;
  double lo = axis->lo / axis->unit, hi = axis->hi / axis->unit;
  if (axis->knee > 0) return signed_ticks(axis, wanted, ticks);
  return axis->log ? log_ticks(lo, hi, wanted, ticks) : linear_ticks(lo, hi, wanted, ticks);
}

plot_axis plot_axis_around(double lo, double hi, bool log_scale, double unit, const char *label) {
  if (!(lo <= hi)) lo = 0, hi = unit;
  bool log_axis = log_scale && lo > 0;
  if (hi - lo <= 1e-12 * fmax(fabs(lo), fabs(hi))) {
    double extent = lo == 0 ? unit : 0.05 * fabs(lo);
    lo -= extent;
    hi += extent;
  }
  double air = log_axis ? 0.04 * log(hi / lo) : 0.04 * (hi - lo);
  return (plot_axis){log_axis ? lo * exp(-air) : lo - air,
                     log_axis ? hi * exp(air) : hi + air,
                     log_axis,
                     0,
                     unit,
                     label};
}

plot_axis plot_axis_signed(double lo, double hi, double knee, double unit, const char *label) {
  double a = asinh(lo / knee), b = asinh(hi / knee), air = 0.04 * (b - a);
  return (plot_axis){knee * sinh(a - air), knee * sinh(b + air), false, knee, unit, label};
}

/* Coordinates far outside the area are invisible: limit them to keep numbers short. */
static double within(double px) {
  return px > 9999 ? 9999 : px < -9999 ? -9999 : px;
}

double plot_x(const post_plot *plot, double x) {
  double at = place(&plot->x, x);
  return isfinite(at) ? within(plot->left + plot->width * at) : NAN;
}

double plot_y(const post_plot *plot, double y) {
  double at = place(&plot->y, y);
  return isfinite(at) ? within(plot->top + plot->height * (1 - at)) : NAN;
}

void plot_svg_open(post_buffer *out, const char *id, double width, double height, const char *title,
                   const char *description) {
  post_put(
      out,
      "<svg xmlns=\"http://www.w3.org/2000/svg\" id=\"%s\" class=\"plot\" viewBox=\"0 0 %g %g\" "
      "role=\"img\" aria-labelledby=\"%s-title %s-desc\">\n<title id=\"%s-title\">",
      id, width, height, id, id, id);
  post_put_escaped(out, title);
  post_put(out, "</title>\n<desc id=\"%s-desc\">", id);
  post_put_escaped(out, description);
  post_put(out, "</desc>\n");
}

void plot_svg_close(post_buffer *out) {
  post_put(out, "</svg>\n");
}

void plot_picture_open(post_buffer *out, const char *id, int width, int height, const char *title,
                       const char *description, const char *css) {
  post_put(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
  plot_svg_open(out, id, width, height, title, description);
  post_put(
      out,
      "<style>text{font:12.5px 'Helvetica Neue',Helvetica,Arial,sans-serif;fill:#56606c}"
      ".page{fill:#fff}.axis{fill:#1b2530}.heading{font-size:18px;font-weight:600;fill:#1b2530}"
      ".line{fill:none;stroke:currentColor;stroke-width:1.8;stroke-linejoin:round}"
      ".dot{fill:currentColor}.grid{stroke:#e4e7ea}.base{stroke:#8c959f;fill:none}"
      "@media screen and (prefers-color-scheme:dark){text{fill:#9aa5b1}.page{fill:#12171d}"
      ".axis,.heading{fill:#e6eaee}.grid{stroke:#262e37}.base{stroke:#6b7682}}"
      "%s</style>\n<rect class=\"page\" width=\"%d\" height=\"%d\"/>\n",
      css, width, height);
  post_put(out, "<text class=\"heading\" x=\"14\" y=\"32\">");
  post_put_escaped(out, title);
  post_put(out, "</text>\n");
}

static void frame_x(const post_plot *p) {
  double ticks[PLOT_MAX_TICKS], bottom = p->top + p->height;
  int    n = plot_ticks(&p->x, (int)fmax(3, p->width / 90), ticks);
  for (int i = 0; i < n; i++) {
    char   number[POST_NUMBER];
    double x = plot_x(p, ticks[i] * p->x.unit);
    post_put(p->out, "<path class=\"grid\" d=\"M%.1f %.1fV%.1f\"/>", x, p->top, bottom);
    if (p->x.label)
      post_put(p->out,
               "<text class=\"tick\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%s</text>\n", x,
               bottom + 17, post_plain(number, ticks[i], 7));
  }
  if (!p->x.label) return;
  post_put(p->out, "<text class=\"axis\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">",
           p->left + p->width, bottom + 36);
  post_put_escaped(p->out, p->x.label);
  post_put(p->out, "</text>\n");
}

static void frame_y(const post_plot *p) {
  double ticks[PLOT_MAX_TICKS];
  int    n = plot_ticks(&p->y, (int)fmax(2, p->height / 55), ticks);
  for (int i = 0; i < n; i++) {
    char   number[POST_NUMBER];
    double y = plot_y(p, ticks[i] * p->y.unit);
    post_put(p->out, "<path class=\"grid\" d=\"M%.1f %.1fH%.1f\"/>", p->left, y,
             p->left + p->width);
    if (p->y.label)
      post_put(p->out, "<text class=\"tick\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%s</text>\n",
               p->left - 8, y + 4, post_plain(number, ticks[i], 7));
  }
  if (!p->y.label) return;
  post_put(p->out, "<text class=\"axis\" x=\"%.1f\" y=\"%.1f\">", p->left - 48, p->top - 12);
  post_put_escaped(p->out, p->y.label);
  post_put(p->out, "</text>\n");
}

void plot_frame(const post_plot *plot) {
  post_put(plot->out,
           "<clipPath id=\"%s-clip\"><rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" "
           "height=\"%.1f\"/></clipPath>\n",
           plot->id, plot->left, plot->top, plot->width, plot->height);
  frame_x(plot);
  frame_y(plot);
  post_put(plot->out, "<path class=\"base\" d=\"M%.1f %.1fH%.1f\"/>\n", plot->left,
           plot->top + plot->height, plot->left + plot->width);
}

void plot_powers(const post_plot *plot) {
  double ticks[PLOT_MAX_TICKS];
  int    n = plot_ticks(&plot->y, (int)fmax(2, plot->height / 55), ticks); /* as the frame's grid */
  for (int i = 0; i < n; i++) {
    char text[POST_NUMBER];
    plot_text(plot, "tick", plot->x.lo, ticks[i] * plot->y.unit, (double[2]){-8, 4}, "end",
              post_power(text, ticks[i]));
  }
}

/* State of the path under construction. */
typedef struct {
  double x, y;
  /* Point up to which the path is drawn, merged ones included; -1: none. */
  int  at;
  bool any;
} pen;

static void draw_piece(const post_plot *plot, const char *classes, const double from[2],
                       const double to[2], pen *p) {
  if (!p->any)
    post_put(plot->out, "<path class=\"%s\" clip-path=\"url(#%s-clip)\" d=\"", classes, plot->id);
  if (p->at < 0) post_put(plot->out, "M%.1f %.1f", from[0], from[1]);
  post_put(plot->out, "L%.1f %.1f", to[0], to[1]);
  p->any = true;
  p->x   = to[0];
  p->y   = to[1];
}

void plot_line(const post_plot *plot, const char *classes, int n, const double *x, const double *y,
               const bool *piece) {
  if (n == 1 && !piece) plot_dot(plot, classes, x[0], y[0], 2);
  double from[2] = {NAN, NAN};
  pen    p       = {NAN, NAN, -1, false};
  for (int i = 0; i < n; i++) {
    double to[2] = {plot_x(plot, x[i]), plot_y(plot, y[i])};
    bool   drawn = isfinite(to[0] + to[1]) && isfinite(from[0] + from[1]) && (!piece || piece[i]);
    if (!drawn) {
      p.at = -1;
    } else {
      bool more = i + 1 < n && (!piece || piece[i + 1]);
      bool near = p.at >= 0 && hypot(to[0] - p.x, to[1] - p.y) < 0.4;
      if (!near || !more) draw_piece(plot, classes, from, to, &p);
      p.at = i;
    }
    memcpy(from, to, sizeof from);
  }
  if (p.any) post_put(plot->out, "\"/>\n");
}

void plot_bar(const post_plot *plot, const char *classes, const double x[2], const double y[2]) {
  double left = plot_x(plot, x[0]), right = plot_x(plot, x[1]);
  double low = plot_y(plot, y[0]), high = plot_y(plot, y[1]);
  if (!isfinite(left + right + low + high) || low - high < 0.01) return;
  post_put(plot->out, "<rect class=\"%s\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/>\n",
           classes, left, high, right - left, low - high);
}

void plot_dot(const post_plot *plot, const char *classes, double x, double y, double radius) {
  double px = plot_x(plot, x), py = plot_y(plot, y);
  if (!isfinite(px) || !isfinite(py)) return;
  post_put(plot->out, "<circle class=\"%s\" cx=\"%.2f\" cy=\"%.2f\" r=\"%g\"/>\n", classes, px, py,
           radius);
}

void plot_text(const post_plot *plot, const char *classes, double x, double y, const double move[2],
               const char *anchor, const char *text) {
  double px = plot_x(plot, x), py = plot_y(plot, y);
  if (!isfinite(px) || !isfinite(py)) return;
  post_put(plot->out, "<text class=\"%s\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">", classes,
           px + move[0], py + move[1], anchor);
  post_put_escaped(plot->out, text);
  post_put(plot->out, "</text>\n");
}

void plot_level(const post_plot *plot, const char *classes, double y) {
  double py = plot_y(plot, y);
  if (!isfinite(py)) return;
  post_put(plot->out, "<path class=\"%s\" clip-path=\"url(#%s-clip)\" d=\"M%.1f %.2fH%.1f\"/>\n",
           classes, plot->id, plot->left, py, plot->left + plot->width);
}
