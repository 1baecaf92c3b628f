#include "postproc/comparison/comparison_page.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "mesh/base/status.h"
#include "postproc/draw/colour.h"
#include "postproc/draw/number_format.h"
#include "postproc/draw/plot.h"
#include "postproc/report/page.h"

enum { WIDTH = 1100, HEIGHT = 540, NAMES = 48 };

static const char style[] =
    ".second { stroke-dasharray: 7 4; }\n"
    ".line.limit { stroke-dasharray: none; }\n"
    ".line.limit.second { stroke-dasharray: 7 4; }\n";

static void put_name(const post_pair *p, post_buffer *out) {
  char name[64];
  post_pair_name(p, name);
  post_put(out, "%s", name);
}

/* "+1.2 %", with a true minus sign. */
static void put_change(double change, post_buffer *out) {
  char number[POST_NUMBER];
  if (isfinite(change))
    post_put(out, "<td>%s%s</td>", change < 0 ? "−" : "+", post_percent(number, fabs(change)));
  else
    post_put(out, "<td>–</td>");
}

/* ---------------------------------------------------------------- head */

static void put_head(const post_comparison *c, post_buffer *out) {
  char title[512];
  snprintf(title, sizeof title, "%s and %s", c->run[0].name, c->run[1].name);
  post_page_open(title, "comparison", out);
  post_put_ramp(c->n_ranks, false, out);
  post_put(out, "\n@media screen and (prefers-color-scheme: dark){");
  post_put_ramp(c->n_ranks, true, out);
  post_put(out, "}\n%s</style>\n</head>\n<body>\n<header class=\"top\">\n", style);
  post_put(out, "<p class=\"kicker\">Shrouded blade · two runs</p>\n<h1>");
  post_put_escaped(out, title);
  post_put(out, "</h1>\n<p class=\"lede\">Solid: ");
  post_put_escaped(out, c->run[0].name);
  post_put(out, ", computed ");
  post_put_escaped(out, c->run[0].origin.created);
  post_put(out, ". Dashed: ");
  post_put_escaped(out, c->run[1].name);
  post_put(out, ", computed ");
  post_put_escaped(out, c->run[1].origin.created);
  post_put(out,
           ". Changes are those of the second run against the first.</p>\n</header>\n<main>\n");
}

/* ---------------------------------------------------------------- curves */

static double largest(const post_comparison *c) {
  return fmax(c->run[0].analysis->largest, c->run[1].analysis->largest);
}

/* Range of amplitudes above a ten thousandth of the largest, and of the abscissa. */
static void find_ranges(const post_comparison *c, double amplitude[2], double place[2]) {
  amplitude[0] = place[0] = INFINITY;
  place[1]                = -INFINITY;
  amplitude[1]            = largest(c);
  for (int run = 0; run < POST_RUNS; run++) {
    const post_analysis *a = c->run[run].analysis;
    for (int b = 0; b < a->response->n_branches; b++) {
      const mhb_branch *branch = &a->response->branch[b];
      const double     *x      = post_abscissa_values(a->response, branch);
      for (int i = 0; i < branch->n_points; i++) {
        place[0] = fmin(place[0], x[i]);
        place[1] = fmax(place[1], x[i]);
        double y = a->curve[b].amplitude[i];
        if (y > 1e-4 * amplitude[1]) amplitude[0] = fmin(amplitude[0], y);
      }
    }
  }
}

static int rank_of(const post_comparison *c, int run, int group) {
  for (int i = 0; i < c->n_pairs; i++)
    if (c->pair[i].group[run] == group) return c->pair[i].rank;
  return -1;
}

static void draw_run(const post_comparison *c, int run, const post_plot *plot) {
  const post_analysis *a      = c->run[run].analysis;
  const char          *second = run ? " second" : "";
  for (int b = 0; b < a->response->n_branches; b++) {
    const mhb_branch *branch = &a->response->branch[b];
    const int         rank   = rank_of(c, run, a->curve[b].group);
    const double     *x      = post_abscissa_values(a->response, branch);
    char              classes[NAMES];
    if (branch->kind == MHB_BRANCH_INTEGRATION) continue;
    if (branch->kind == MHB_BRANCH_OPEN || branch->kind == MHB_BRANCH_STUCK)
      snprintf(classes, sizeof classes, "line limit%s", second);
    else if (rank >= 0)
      snprintf(classes, sizeof classes, "line c%d%s", rank, second);
    else
      snprintf(classes, sizeof classes, "line varying%s", second);
    plot_line(plot, classes, branch->n_points, x, a->curve[b].amplitude, NULL);
  }
}

static void put_legend(const post_comparison *c, post_buffer *out) {
  post_put(out, "<ul class=\"legend\">");
  for (int i = 0; i < c->n_pairs; i++) {
    if (c->pair[i].rank < 0) continue;
    post_put(out, "<li class=\"c%d\"><i style=\"background:currentColor\"></i><span>",
             c->pair[i].rank);
    put_name(&c->pair[i], out);
    post_put(out, "</span></li>");
  }
  post_put(out, "<li>grey: linear limits</li></ul>\n");
}

static void put_curves(const post_comparison *c, post_buffer *out) {
  const post_analysis *a    = c->run[0].analysis;
  const post_unit      unit = post_unit_length(largest(c));
  char                 place[128], label[256], below[POST_LABEL], harmonic[32];
  double               y[2], x[2];
  find_ranges(c, y, x);
  post_place_name(a->response, a->primary, place);
  post_quantity_name(a->response, post_quantity_primary(a->response), harmonic);
  snprintf(label, sizeof label, "%s %s, %s, %s", place, post_axis_name(a->primary), harmonic,
           unit.name);
  post_abscissa_label(&a->abscissa, "", below);
  post_put(out, "<section>\n<h2>Curves</h2>\n<div class=\"card\"><figure><div class=\"chart\">\n");
  plot_svg_open(out, "curves", WIDTH, HEIGHT, "Curves of both runs",
                "Amplitude of both runs; the second one is dashed. The peaks are in the table.");
  post_plot plot = {
      .out = out, .id = "curves-a", .left = 60, .top = 34, .width = 1020, .height = HEIGHT - 84};
  const bool log = y[1] > 12 * y[0];
  plot.x         = (plot_axis){x[0], x[1], a->abscissa.log, 0, a->abscissa.unit.scale, below};
  plot.y = (plot_axis){log ? y[0] / 1.2 : 0, (log ? 1.4 : 1.06) * y[1], log, 0, unit.scale, label};
  plot_frame(&plot);
  for (int run = 0; run < POST_RUNS; run++) draw_run(c, run, &plot);
  plot_svg_close(out);
  post_put(out, "</div></figure></div>\n");
  put_legend(c, out);
  post_put(out, "</section>\n");
}

/* ---------------------------------------------------------------- tables */

static void put_peak(const post_analysis *a, const post_track_point *p, post_unit unit,
                     post_buffer *out) {
  char number[POST_NUMBER];
  post_put(out, "<td>%s%s</td>", post_abscissa_number(&a->abscissa, p->at, 6, number),
           p->edge && !p->level ? ", end of range" : "");
  post_put(out, "<td>%s</td>", post_number(number, p->amplitude / unit.scale, 4));
}

static void put_peaks(const post_comparison *c, post_buffer *out) {
  const post_analysis *a = c->run[0].analysis;
  const post_unit      u = post_unit_length(largest(c));
  char                 label[POST_LABEL];
  post_abscissa_label(&a->abscissa, "", label);
  post_put(out,
           "<section>\n<h2>Highest peaks</h2>\n<div class=\"scroll\"><table><thead><tr>"
           "<th scope=\"col\">Curve</th><th scope=\"col\">First: %s</th><th scope=\"col\">%s</th>"
           "<th scope=\"col\">Second: %s</th><th scope=\"col\">%s</th>"
           "<th scope=\"col\">Change of place</th><th scope=\"col\">Change of amplitude</th>"
           "</tr></thead>\n<tbody>\n",
           label, u.name, label, u.name);
  for (int i = 0; i < c->n_pairs; i++) {
    const post_pair *p = &c->pair[i];
    if (!(p->peak[0].amplitude > 0) && !(p->peak[1].amplitude > 0)) continue;
    post_put(out, "<tr><th scope=\"row\">");
    put_name(p, out);
    post_put(out, "</th>");
    for (int run = 0; run < POST_RUNS; run++) put_peak(a, &p->peak[run], u, out);
    put_change(post_change(p, true), out);
    put_change(post_change(p, false), out);
    post_put(out, "</tr>\n");
  }
  post_put(out, "</tbody></table></div>\n</section>\n");
}

static void put_modes(const post_comparison *c, post_buffer *out) {
  const mhb_response *a = c->run[0].response, *b = c->run[1].response;
  const int           n = a->n_modes > b->n_modes ? a->n_modes : b->n_modes;
  char                number[POST_NUMBER];
  post_put(
      out,
      "<section>\n<h2>Modes</h2>\n<div class=\"scroll\"><table><caption>By their number; "
      "<code>shroudhb inspect FIRST.modal.h5 SECOND.modal.h5</code> compares their shapes."
      "</caption><thead><tr><th scope=\"col\">Mode</th><th scope=\"col\">First, Hz</th>"
      "<th scope=\"col\">Second, Hz</th><th scope=\"col\">Change</th></tr></thead>\n<tbody>\n");
  for (int i = 0; i < n && i < 12; i++) {
    const double f = i < a->n_modes ? a->mode_frequency[i] : NAN,
                 g = i < b->n_modes ? b->mode_frequency[i] : NAN;
    post_put(out, "<tr><th scope=\"row\">%d</th><td>%s</td>", i + 1, post_number(number, f, 6));
    post_put(out, "<td>%s</td>", post_number(number, g, 6));
    put_change(g / f - 1, out);
    post_put(out, "</tr>\n");
  }
  post_put(out, "</tbody></table></div>\n</section>\n");
}

static void put_settings(const post_comparison *c, post_buffer *out) {
  post_put(out, "<section>\n<h2>Settings that differ</h2>\n");
  if (c->n_differences == 0) {
    post_put(out, "<p class=\"note\">None.</p>\n</section>\n");
    return;
  }
  post_put(out,
           "<div class=\"scroll\"><table><thead><tr><th scope=\"col\">Key</th>"
           "<th scope=\"col\" class=\"words\">First</th><th scope=\"col\" class=\"words\">"
           "Second</th></tr></thead>\n<tbody>\n");
  for (int i = 0; i < c->n_differences; i++) {
    post_put(out, "<tr><th scope=\"row\">");
    post_put_escaped(out, c->difference[i].key);
    for (int run = 0; run < POST_RUNS; run++) {
      post_put(out, run ? "</td><td class=\"words\">" : "</th><td class=\"words\">");
      post_put_escaped(out, c->difference[i].value[run] ? c->difference[i].value[run] : "–");
    }
    post_put(out, "</td></tr>\n");
  }
  post_put(out, "</tbody></table></div>\n</section>\n");
}

void post_comparison_page(const post_comparison *c, post_buffer *out) {
  put_head(c, out);
  put_curves(c, out);
  put_peaks(c, out);
  put_modes(c, out);
  put_settings(c, out);
  post_put(out, "</main>\n<footer>shroudhb %s</footer>\n</body>\n</html>\n", shb_revision());
}
