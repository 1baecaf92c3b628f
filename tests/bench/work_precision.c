#include "work_precision.h"

#include <math.h>
#include <stdio.h>

#include "postproc/draw/number_format.h"
#include "postproc/draw/plot.h"

enum { WIDTH = 860, HEIGHT = 520 };

static const char *const classes[] = {"line return", "line closed", "line law"};

static void put_style(post_buffer *out) {
  post_put(
      out,
      "<style>text{font:13px 'Helvetica Neue',Helvetica,Arial,sans-serif;fill:#56606c}"
      ".page{fill:#fff}.axis{fill:#1b2530}.heading{font-size:17px;font-weight:600;fill:#1b2530}"
      ".line{fill:none;stroke:currentColor;stroke-width:2;stroke-linejoin:round}"
      ".thin{stroke-width:1.4;stroke-dasharray:5 4}.dot{fill:currentColor}"
      ".grid{stroke:#e4e7ea}.base{stroke:#8c959f;fill:none}.name{fill:currentColor}"
      ".strong{font-weight:600}"
      ".return{color:#a3540f}.closed{color:#6a4aa5}.law{color:#0b6e75}"
      "@media (prefers-color-scheme:dark){text{fill:#9aa5b1}.page{fill:#12171d}"
      ".axis,.heading{fill:#e6eaee}.grid{stroke:#262e37}.base{stroke:#6b7682}"
      ".name{fill:currentColor}"
      ".return{color:#e2a15c}.closed{color:#b8a1ea}.law{color:#4cc3cb}}"
      "</style>\n<rect class=\"page\" width=\"%d\" height=\"%d\"/>\n",
      WIDTH, HEIGHT);
}

/* Error upwards, time to the right. */
static void put_axes(const post_plot *plot) {
  plot_frame(plot);
  plot_powers(plot);
  post_put(plot->out,
           "<text class=\"axis\" x=\"20\" y=\"58\">error of the force harmonics, relative to the "
           "largest</text>\n");
}

static void put_baselines(const post_plot *plot, const work_precision *curve, const method *all) {
  static const char *const name[] = {"radial return", "closed-form slip between samples"};
  for (int f = METHOD_RETURN; f <= METHOD_CLOSED; f++) {
    const work_precision *c = &curve[f];
    plot_line(plot, classes[f], c->n, c->us, c->error, NULL);
    for (int j = 0; j < c->n; j++) {
      plot_dot(plot, f == METHOD_RETURN ? "dot return" : "dot closed", c->us[j], c->error[j], 2.4);
      if (j && j + 1 < c->n) continue;
      char text[16];
      snprintf(text, sizeof text, j ? "%d" : "%d samples", all[c->method[j]].N);
      plot_text(plot, f == METHOD_RETURN ? "name return" : "name closed", c->us[j], c->error[j],
                (double[2]){0, j ? 18 : -9}, "middle", text);
    }
    int middle = c->n / 2;
    plot_text(plot, f == METHOD_RETURN ? "name return strong" : "name closed strong", c->us[middle],
              c->error[middle], (double[2]){10, -10}, "start", name[f]);
  }
}

static void put_law(const post_plot *plot, const work_precision *c, const method *all) {
  int last = c->n - 1;
  plot_line(plot, classes[METHOD_LAW], c->n, c->us, c->error, NULL);
  plot_line(plot, "line law thin", c->n, c->us_derivative, c->error, NULL);
  for (int j = 0; j < c->n; j++) {
    const method *m = &all[c->method[j]];
    char          text[96], power[POST_NUMBER];
    plot_dot(plot, "dot law", c->us[j], c->error[j], m->accuracy ? 5 : 2.4);
    if (!m->accuracy) continue;
    plot_dot(plot, "dot law", c->us_derivative[j], c->error[j], 3);
    post_power(power, m->tolerance);
    snprintf(text, sizeof text, "%s (asked: %s)", m->accuracy, power);
    plot_text(plot, "name law strong", c->us[j], c->error[j], (double[2]){-13, 4}, "end", text);
    if (m->tolerance < 1e-7)
      plot_text(plot, "name law", c->us_derivative[j], c->error[j], (double[2]){10, 4}, "start",
                "with derivative");
  }
  plot_text(plot, "name law strong", c->us[last], c->error[last], (double[2]){-11, 4}, "end",
            "this program");
}

shb_status work_precision_svg(const method *all, const summary *sum, int n, int motions,
                              const char *path) {
  work_precision curve[METHOD_FAMILIES];
  double         us[2] = {INFINITY, 0}, error[2] = {INFINITY, 0};
  for (method_family f = METHOD_RETURN; f < METHOD_FAMILIES; f++) {
    curve[f] = work_precision_of(f, all, sum, n);
    for (int j = 0; j < curve[f].n; j++) {
      us[0]    = fmin(us[0], curve[f].us[j]);
      us[1]    = fmax(us[1], fmax(curve[f].us[j], curve[f].us_derivative[j]));
      error[0] = fmin(error[0], curve[f].error[j]);
      error[1] = fmax(error[1], curve[f].error[j]);
    }
  }
  post_buffer out = {0};
  char        heading[160];
  snprintf(heading, sizeof heading,
           "Force harmonics of a rubbing contact: medians over %d motions, one core", motions);
  plot_svg_open(&out, "work-precision", WIDTH, HEIGHT, heading,
                "Error against time for radial return, closed-form slip between samples and this "
                "program, both axes logarithmic.");
  put_style(&out);
  post_put(&out, "<text class=\"heading\" x=\"20\" y=\"30\">");
  post_put_escaped(&out, heading);
  post_put(&out, "</text>\n");
  post_plot plot = {.out    = &out,
                    .id     = "work-precision",
                    .left   = 62,
                    .top    = 76,
                    .width  = WIDTH - 62 - 24,
                    .height = HEIGHT - 76 - 54};
  plot.x = plot_axis_around(us[0] / 1.6, us[1] * 1.2, true, 1, "time a force evaluation, µs");
  plot.y = plot_axis_around(error[0] / 3, error[1] * 3, true, 1, NULL);
  put_axes(&plot);
  put_baselines(&plot, curve, all);
  put_law(&plot, &curve[METHOD_LAW], all);
  plot_svg_close(&out);
  shb_status status = post_buffer_publish(&out, path);
  post_buffer_free(&out);
  return status;
}
