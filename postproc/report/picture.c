#include "postproc/report/picture.h"
#include "postproc/analysis/stability_findings.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "postproc/draw/colour.h"
#include "postproc/draw/number_format.h"
#include "postproc/report/charts.h"

enum { WIDTH = 1000, HEIGHT = 560, LEGEND = 820 };

static void put_style(const post_analysis *analysis, post_buffer *out) {
  post_put(
      out,
      "<style>text{font:13px 'Helvetica Neue',Helvetica,Arial,sans-serif;fill:#56606c}"
      ".axis{fill:#1b2530}.heading{font-size:19px;font-weight:600;fill:#1b2530}"
      ".line{fill:none;stroke:currentColor;stroke-width:1.8;stroke-linejoin:round;stroke-linecap:"
      "round}"
      ".grid{stroke:#e4e7ea}.base{stroke:#8c959f;fill:none}"
      ".unstable{stroke-dasharray:.1 4.5}.modulated{stroke-dasharray:5 3.2;stroke-linecap:butt}"
      ".unjudged{stroke-width:.9;opacity:.75}.lasting{stroke-width:1.4}"
      ".swing{fill:currentColor;opacity:.18;stroke:none}.limit{color:#6b7480;stroke-width:1.5;"
      "stroke-linecap:butt}"
      ".line.open{stroke-dasharray:9 5}.line.stuck{stroke-dasharray:4 4}"
      ".dot{fill:currentColor}.fold{fill:#fff;stroke:currentColor;stroke-width:1.4}"
      ".bifurcation{fill:currentColor;stroke:#fff;stroke-width:.8}"
      ".integration{fill:currentColor;stroke:#1b2530;stroke-width:.9}"
      ".aperiodic{fill:none;stroke:currentColor;stroke-width:1.4}"
      ".varying{color:#0b6e75}.plain{color:#56606c}.mark{font-style:italic;paint-order:stroke;"
      "stroke:#fff;stroke-width:"
      "4px}");
  post_put_ramp(analysis->n_ranks, false, out);
  post_put(out, "</style>\n");
}

static void put_entry(post_buffer *out, double y, const char *classes, const char *text) {
  post_put(out, "<path class=\"line %s\" d=\"M%d %.1fh28\"/><text x=\"%d\" y=\"%.1f\">%s</text>\n",
           classes, LEGEND, y - 4, LEGEND + 38, y, text);
}

static void put_legend(const post_analysis *analysis, post_buffer *out) {
  double step = fmin(21, 430.0 / (analysis->n_groups + 5)), y = 84;
  bool   seen[POST_N_VERDICTS] = {false}, integration = false, lasting = false;
  for (int b = 0; b < analysis->response->n_branches; b++) {
    const mhb_branch *branch = &analysis->response->branch[b];
    integration = integration || (branch->kind == MHB_BRANCH_INTEGRATION && branch->n_points > 0);
    if (branch->kind != MHB_BRANCH_NONLINEAR) continue;
    for (int p = 0; p < branch->n_points; p++) {
      seen[post_verdict_of(branch, p)] = true;
      lasting                          = lasting || branch->lasting_kind[p] > MHB_LASTING_WAVE;
    }
  }
  if (analysis->n_ranks > 0) {
    post_put(out, "<text class=\"axis\" x=\"%d\" y=\"%.1f\">preload n₀</text>\n", LEGEND, y);
    y += 1.2 * step;
  }
  for (int g = 0; g < analysis->n_groups; g++) {
    const post_group *group = &analysis->group[g];
    char              number[POST_NUMBER], text[POST_NUMBER + 8], classes[POST_CLASS];
    if (group->empty) continue;
    post_group_class(group, classes);
    if (group->rank >= 0)
      snprintf(text, sizeof text, "%s\u00a0N", post_plain(number, group->n0, 5));
    else if (group->kind == MHB_BRANCH_NONLINEAR)
      strcpy(text, analysis->abscissa.parameter == MHB_IN_N0 ? "n₀ varying" : "varying");
    else
      strcpy(text, group->kind == MHB_BRANCH_OPEN ? "fully open" : "fully stuck");
    put_entry(out, y, classes, text);
    y += step;
  }
  static const char *const entry[POST_N_VERDICTS][2] = {
      [POST_VERDICT_NOT_JUDGED] = {"unjudged plain", "not judged"},
      [POST_VERDICT_MODULATED]  = {"modulated plain", "modulated"},
      [POST_VERDICT_NEVER_SEEN] = {"unstable plain", "never seen"}};
  for (int v = 0; v < POST_N_VERDICTS; v++) {
    if (!seen[v] || !entry[v][0]) continue;
    put_entry(out, y, entry[v][0], entry[v][1]);
    y += step;
  }
  if (lasting) {
    post_put(out,
             "<rect class=\"swing plain\" x=\"%d\" y=\"%.1f\" width=\"28\" height=\"9\"/>"
             "<text x=\"%d\" y=\"%.1f\">ring: mean to worst</text>\n",
             LEGEND, y - 9, LEGEND + 38, y);
    y += step;
  }
  if (integration)
    post_put(out,
             "<circle class=\"integration plain\" cx=\"%d\" cy=\"%.1f\" r=\"2.4\"/>"
             "<text x=\"%d\" y=\"%.1f\">time integration</text>\n",
             LEGEND + 14, y - 4, LEGEND + 38, y);
}

void post_picture(const post_analysis *analysis, const char *case_name, post_buffer *out) {
  char title[256], text[160], frequency[POST_PLACE];
  snprintf(title, sizeof title, "Forced response of %s%s", case_name,
           post_frequency_text(analysis, frequency));
  snprintf(text, sizeof text, "Amplitude against %s%s.", analysis->abscissa.name,
           analysis->n_ranks > 0 || !post_at_one_frequency(analysis) ? " for each preload" : "");
  post_put(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
  plot_svg_open(out, "picture", WIDTH, HEIGHT, title, text);
  put_style(analysis, out);
  post_put(out, "<rect width=\"%d\" height=\"%d\" fill=\"#fff\"/>\n", WIDTH, HEIGHT);
  post_put(out, "<text class=\"heading\" x=\"20\" y=\"34\">");
  post_put_escaped(out, title);
  post_put(out, "</text>\n");
  post_plot plot = {
      .out = out, .id = "picture", .left = 68, .top = 84, .width = 724, .height = 420};
  post_draw_response(analysis, &plot);
  put_legend(analysis, out);
  plot_svg_close(out);
}
