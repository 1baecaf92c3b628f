#include "postproc/report/convergence_chart.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "postproc/draw/number_format.h"
#include "postproc/draw/plot.h"

enum { WIDTH = 1000, HEIGHT = 600 };

static const double LEAST = 1e-10; /* errors below are drawn there */

/* Class of a ladder's line. */
static const char *const classes[POST_N_LADDERS] = {"l-h",    "l-auto", "l-acc", "l-modes",
                                                    "l-bare", "l-mesh", "l-all", "l-points"};

const char post_convergence_css[] =
    ".l-h{color:#0b6e75}.l-auto{color:#6a4aa5}.l-acc{color:#a3540f}.l-modes{color:#2f6f2f}"
    ".l-bare{color:#8a8f2a}.l-mesh{color:#a83250}.l-all{color:#1b2530}.l-points{color:#1f5fa8}"
    ".line.l-bare{stroke-dasharray:6 4}.goal{stroke:#8c959f;stroke-width:1.2;fill:none;"
    "stroke-dasharray:3 4}.hollow{fill:none;stroke:currentColor;stroke-width:1.5}"
    ".plot .name{fill:currentColor}"
    "@media screen and (prefers-color-scheme:dark){.l-h{color:#4cc3cb}.l-auto{color:#b8a1ea}"
    ".l-acc{color:#e2a15c}.l-modes{color:#86c586}.l-bare{color:#c9cd6a}.l-mesh{color:#f08aa4}"
    ".l-all{color:#e6eaee}.l-points{color:#8ab8f0}}";

/* True if a rung was compared and timed. */
static bool is_drawn(const post_rung *r) {
  return !r->reference && !isnan(post_rung_error(r)) && r->seconds > 0;
}

static double height_of(const post_rung *r) {
  return fmax(LEAST, post_rung_error(r));
}

/* Ranges of seconds and errors, including the tolerance. */
static bool find_ranges(const post_convergence *s, double seconds[2], double error[2]) {
  bool any   = false;
  seconds[0] = error[0] = INFINITY;
  seconds[1] = error[1] = 0;
  for (int i = 0; i < s->n; i++) {
    const post_rung *r = &s->rung[i];
    if (r->reference && r->seconds > 0) {
      seconds[0] = fmin(seconds[0], r->seconds);
      seconds[1] = fmax(seconds[1], r->seconds);
    }
    if (!is_drawn(r)) continue;
    any        = true;
    seconds[0] = fmin(seconds[0], r->seconds);
    seconds[1] = fmax(seconds[1], r->seconds);
    error[0]   = fmin(error[0], height_of(r));
    error[1]   = fmax(error[1], height_of(r));
  }
  error[0] = fmin(error[0], s->tolerance);
  error[1] = fmax(error[1], s->tolerance);
  return any;
}

/* A label that is already placed, px. */
typedef struct {
  double x, y, width;
} label;

typedef struct {
  int   n;
  label at[256];
} labels;

/* True if the label covers no other one. */
static bool is_free(const labels *all, const label *wanted) {
  for (int i = 0; i < all->n; i++) {
    const label *l = &all->at[i];
    if (fabs(l->y - wanted->y) < 13 && wanted->x < l->x + l->width &&
        l->x < wanted->x + wanted->width)
      return false;
  }
  return true;
}

/* Label a rung at the first free position beside its dot; none without space. */
static void put_label(const post_plot *plot, const post_rung *r, double y, labels *all) {
  static const double move[][2] = {{8, -7},  {8, 15}, {8, 4},  {-8, -7},
                                   {-8, 15}, {-8, 4}, {8, 27}, {8, -19}};
  char                classed[24], name[POST_RUNG_NAME];
  snprintf(name, sizeof name, "%s", r->name);
  char *comma = strchr(name, ',');
  if (comma && r->ladder == POST_LADDER_MESH) *comma = '\0';
  if (r->ladder == POST_LADDER_AUTO && strncmp(name, "tolerance ", 10) == 0)
    snprintf(name, sizeof name, "auto %s", r->name + 10);
  if (r->ladder == POST_LADDER_TOGETHER) strcpy(name, "together");
  snprintf(classed, sizeof classed, "name %s", classes[r->ladder]);
  for (int i = 0; i < 8 && all->n < 256; i++) {
    double width = 7 * (double)strlen(name), x = plot_x(plot, r->seconds) + move[i][0];
    label  wanted = {move[i][0] > 0 ? x : x - width, plot_y(plot, y) + move[i][1], width};
    bool   inside = wanted.x > plot->left && wanted.x + width < plot->left + plot->width &&
                  wanted.y > plot->top && wanted.y < plot->top + plot->height;
    if (!inside || !is_free(all, &wanted)) continue;
    all->at[all->n++] = wanted;
    plot_text(plot, classed, r->seconds, y, move[i], move[i][0] > 0 ? "start" : "end", name);
    return;
  }
}

static void draw_ladder(const post_convergence *s, const post_plot *plot, post_ladder ladder,
                        labels *all) {
  double *x = calloc(2 * (size_t)s->n + 1, sizeof *x), *y = x ? x + s->n : NULL;
  char    line[32], dot[32];
  int     n = 0;
  if (!x) {
    plot->out->failed = true;
    return;
  }
  snprintf(line, sizeof line, "line %s", classes[ladder]);
  for (int i = 0; i < s->n; i++) {
    const post_rung *r = &s->rung[i];
    if (r->ladder != ladder || !is_drawn(r)) continue;
    x[n]   = r->seconds;
    y[n++] = height_of(r);
    all->at[all->n < 255 ? all->n++ : 254] =
        (label){plot_x(plot, r->seconds) - 4, plot_y(plot, y[n - 1]) + 4, 8};
  }
  if (n > 1 && ladder != POST_LADDER_TOGETHER) plot_line(plot, line, n, x, y, NULL);
  for (int i = 0; i < s->n; i++) {
    const post_rung *r = &s->rung[i];
    if (r->ladder != ladder || !is_drawn(r)) continue;
    snprintf(dot, sizeof dot, "%s %s", r->state == POST_RUNG_DONE ? "dot" : "hollow",
             classes[ladder]);
    plot_dot(plot, dot, r->seconds, height_of(r),
             ladder == POST_LADDER_TOGETHER ? 6
             : r->of_case                   ? 5
                                            : 3.5);
  }
  free(x);
}

/* Labels come last, when the positions of all dots are known. */
static void draw_labels(const post_convergence *s, const post_plot *plot, labels *all) {
  for (int ladder = POST_N_LADDERS - 1; ladder >= 0; ladder--)
    for (int i = 0; i < s->n; i++) {
      const post_rung *r = &s->rung[i];
      if ((int)r->ladder == ladder && is_drawn(r)) put_label(plot, r, height_of(r), all);
    }
}

/* References have no error: mark their seconds on the base line. */
static void draw_references(const post_convergence *s, const post_plot *plot) {
  for (int i = 0; i < s->n; i++) {
    const post_rung *r = &s->rung[i];
    char             classed[32];
    if (!r->reference || !(r->seconds > 0)) continue;
    snprintf(classed, sizeof classed, "hollow %s", classes[r->ladder]);
    plot_dot(plot, classed, r->seconds, plot->y.lo, 5);
  }
}

static void draw(const post_convergence *s, post_plot *plot) {
  double seconds[2], error[2];
  if (!find_ranges(s, seconds, error)) {
    post_put(plot->out, "<text class=\"axis\" x=\"%g\" y=\"%g\">no rung was compared</text>\n",
             plot->left, plot->top + 20);
    return;
  }
  labels all = {0};
  char   goal[48];
  plot->x = plot_axis_around(seconds[0] / 1.15, seconds[1] * 1.6, true, 1, "seconds of one core");
  plot->y = plot_axis_around(error[0] / 2, error[1] * 2, true, 1, NULL);
  plot_frame(plot);
  plot_powers(plot);
  plot_level(plot, "goal", s->tolerance);
  snprintf(goal, sizeof goal, "tolerance %g %%", 100 * s->tolerance);
  plot_text(plot, "tick", plot->x.hi, s->tolerance, (double[2]){-6, -6}, "end", goal);
  all.at[all.n++] = (label){plot->left + plot->width - 100, plot_y(plot, s->tolerance) - 6, 100};
  draw_references(s, plot);
  for (int l = 0; l < POST_N_LADDERS; l++) draw_ladder(s, plot, (post_ladder)l, &all);
  draw_labels(s, plot, &all);
}

static void put_legend(const post_convergence *s, double left, double top, post_buffer *out) {
  double y = top;
  for (int l = 0; l < POST_N_LADDERS; l++) {
    bool any = false;
    for (int i = 0; i < s->n; i++)
      any = any || ((int)s->rung[i].ladder == l && is_drawn(&s->rung[i]));
    if (!any) continue;
    post_put(out, "<path class=\"line %s\" d=\"M%g %gh24\"/>", classes[l], left, y - 4);
    post_put(out, "<circle class=\"dot %s\" cx=\"%g\" cy=\"%g\" r=\"%g\"/>", classes[l], left + 12,
             y - 4, l == POST_LADDER_TOGETHER ? 5. : 3.5);
    post_put(out, "<text x=\"%g\" y=\"%g\">%s</text>\n", left + 32, y,
             post_ladder_name((post_ladder)l));
    y += 20;
  }
  post_put(out,
           "<circle class=\"hollow l-all\" cx=\"%g\" cy=\"%g\" r=\"5\"/><text x=\"%g\" "
           "y=\"%g\">finest, error 0</text>\n",
           left + 12, y - 4, left + 32, y);
}

/* Data area, 76 px below the top, moved up by lift. */
static void put_plot(const post_convergence *s, const char *title, double lift, post_buffer *out) {
  post_plot plot = {.out    = out,
                    .id     = "convergence",
                    .left   = 62,
                    .top    = 76 - lift,
                    .width  = WIDTH - 62 - 178,
                    .height = HEIGHT - 76 - 54};
  post_put(out, "<text class=\"axis\" x=\"14\" y=\"%g\">", 58 - lift);
  post_put_escaped(out, title);
  post_put(out, "</text>\n");
  draw(s, &plot);
  put_legend(s, WIDTH - 162, 92 - lift, out);
}

static const char axis_title[] = "relative error: the greatest of peak, its frequency and curve";
static const char description[] =
    "Error against seconds, both axes logarithmic, a line a ladder of settings. The numbers are in "
    "the table.";

void post_convergence_picture(const post_convergence *s, const char *case_name, post_buffer *out) {
  char title[256];
  snprintf(title, sizeof title, "Speed against error: %s", case_name);
  plot_picture_open(out, "convergence", WIDTH, HEIGHT, title, description, post_convergence_css);
  put_plot(s, axis_title, 0, out);
  plot_svg_close(out);
}

/* ---------------------------------------------------------------- the report's section */

static void put_cell(post_buffer *out, double value, const char *format, double scale) {
  char text[48] = "–";
  if (!isnan(value)) snprintf(text, sizeof text, format, value * scale);
  post_put(out, "<td>%s</td>", text);
}

static void put_verdict(const post_convergence *s, const post_rung *r, post_buffer *out) {
  if (r->state == POST_RUNG_FAILED || r->state == POST_RUNG_WAITING)
    post_put(out, "<td class=\"bad\">%s</td>", r->state == POST_RUNG_FAILED ? "failed" : "not run");
  else if (r->state == POST_RUNG_INCOMPLETE)
    post_put(out, "<td class=\"bad\">a curve has a gap</td>");
  else if (r->reference)
    post_put(out, "<td>finest</td>");
  else if (isnan(post_rung_error(r)))
    post_put(out, "<td>–</td>");
  else
    post_put(out, post_rung_meets(s, r) ? "<td class=\"good\">meets</td>"
                                        : "<td class=\"fair\">no</td>");
}

static void put_row(const post_convergence *s, const post_rung *r, bool first, post_buffer *out) {
  static const char error[] = "%.1e";
  post_put(out, "<tr><th scope=\"row\">");
  if (first)
    post_put(out, "<i class=\"swatch %s\"></i>%s", classes[r->ladder], post_ladder_name(r->ladder));
  post_put(out, "</th><td class=\"words\">");
  post_put_escaped(out, r->name);
  post_put(out, "%s</td>", r->of_case ? " (the case)" : "");
  put_cell(out, r->unknowns, "%.0f", 1);
  put_cell(out, r->seconds, "%.3g", 1);
  put_cell(out, r->total, "%.3g", 1);
  put_cell(out, r->memory, "%.0f", 1e-6);
  put_cell(out, r->reference ? 0 : r->peak, r->reference ? "0" : error, 1);
  put_cell(out, r->reference ? 0 : r->frequency, r->reference ? "0" : error, 1);
  put_cell(out, r->reference ? 0 : r->curve, r->reference ? "0" : error, 1);
  if (s->n_points > 0) put_cell(out, r->integration, error, 1);
  put_verdict(s, r, out);
  post_put(out, "</tr>\n");
}

static void put_table(const post_convergence *s, post_buffer *out) {
  post_put(out, "<div class=\"scroll\"><table><caption>");
  post_put_escaped(out, s->output);
  post_put(out,
           ", first harmonic, the worst of %d preload%s. Seconds of one core: the balance without "
           "stability; for a mesh with meshing and modes. Errors are relative; curve: "
           "the greater of |ln f/f′| and |a − a′|/max a, nowhere exceeded.</caption>\n<thead><tr>",
           s->n_preloads, s->n_preloads == 1 ? "" : "s");
  static const char *const heads[] = {
      "Ladder", NULL,        "Unknowns", "Seconds",          "In all, s", "MB",
      "Peak",   "Frequency", "Curve",    "Time integration", "Tolerance"};
  for (int i = 0; i < 11; i++) {
    if (i == 9 && s->n_points == 0) continue;
    if (i == 1)
      post_put(out, "<th scope=\"col\" class=\"words\">Rung</th>");
    else
      post_put(out, "<th scope=\"col\">%s</th>", heads[i]);
  }
  post_put(out, "</tr></thead>\n<tbody>\n");
  for (int i = 0; i < s->n; i++)
    put_row(s, &s->rung[i], i == 0 || s->rung[i].ladder != s->rung[i - 1].ladder, out);
  post_put(out, "</tbody></table></div>\n");
}

static void put_lines(const char *text, post_buffer *out) {
  while (text && *text) {
    size_t n    = strcspn(text, "\n");
    char  *line = strndup(text, n);
    post_put(out, "<li>");
    post_put_escaped(out, line ? line : "");
    post_put(out, "</li>\n");
    free(line);
    text += n + (text[n] == '\n');
  }
}

void post_convergence_section(const post_convergence *s, post_buffer *out) {
  post_buffer conclusion = {0};
  post_convergence_conclusion(s, &conclusion);
  post_put(out,
           "<section>\n<h2>Speed against error</h2>\n<p class=\"note\">Each ladder varies one "
           "setting; its errors are against its own finest rung, those of auto and together "
           "against the most harmonics.</p>\n<ul class=\"findings\">\n");
  put_lines(conclusion.text, out);
  put_lines(s->note, out);
  post_put(out, "</ul>\n<div class=\"card\"><figure><div class=\"chart\">\n");
  plot_svg_open(out, "convergence", WIDTH, HEIGHT - 42, "Speed against error", description);
  put_plot(s, axis_title, 42, out);
  plot_svg_close(out);
  post_put(out, "</div></figure></div>\n");
  put_table(s, out);
  post_put(out, "</section>\n");
  out->failed = out->failed || conclusion.failed;
  post_buffer_free(&conclusion);
}
