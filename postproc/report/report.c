#include "postproc/report/report.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "postproc/analysis/campbell.h"
#include "postproc/analysis/findings.h"
#include "postproc/draw/colour.h"
#include "postproc/draw/number_format.h"
#include "postproc/draw/plot.h"
#include "postproc/report/charts.h"
#include "postproc/report/convergence_chart.h"
#include "postproc/report/page.h"
#include "postproc/report/page_data.h"
#include "postproc/report/ring_charts.h"
#include "postproc/report/safe_diagram.h"
#include "postproc/report/still_blade.h"
#include "postproc/report/tables.h"

/* ---------------------------------------------------------------- head */

static void put_head(const post_analysis *analysis, const char *case_name, post_buffer *out) {
  post_page_open(case_name, "forced response", out);
  post_put_ramp(analysis->n_ranks, false, out);
  post_put(out, "\n@media screen and (prefers-color-scheme: dark){");
  post_put_ramp(analysis->n_ranks, true, out);
  post_put(out, "}\n%s%s</style>\n</head>\n", analysis->campbell ? post_campbell_css : "",
           analysis->convergence ? post_convergence_css : "");
}

/* Angle in degrees, rounded to 0.001, so that rounding errors print as 0. */
static double degrees(double angle) {
  return round(angle * 180e3 / SHB_PI) / 1e3;
}

static void put_lede(const post_analysis *analysis, const post_origin *source, post_buffer *out) {
  const mhb_response  *r = analysis->response;
  const post_abscissa *x = &analysis->abscissa;
  char                 lo[POST_NUMBER], hi[POST_NUMBER], deg[POST_NUMBER], frequency[POST_PLACE];
  post_put(out, "<p class=\"lede\">");
  if (analysis->n_ranks > 0)
    post_put(out, "%d preload%s, ", analysis->n_ranks, analysis->n_ranks > 1 ? "s" : "");
  if (post_at_one_frequency(analysis))
    post_put(out, "%c%s ", analysis->n_ranks > 0 ? x->name[0] : toupper(x->name[0]), x->name + 1);
  post_put(out, "%s to %s%s%s%s", post_plain(lo, x->range[0] / x->unit.scale, 5),
           post_plain(hi, x->range[1] / x->unit.scale, 5), *x->unit.name ? "\u00a0" : "",
           x->unit.name, post_frequency_text(analysis, frequency));
  if (r->engine_order > 0) post_put(out, ", engine order %d", r->engine_order);
  if (r->blades > 0) post_put(out, " on %d blades", r->blades);
  post_put(out, ", ");
  post_put_harmonics(r, out);
  if (r->subharmonics > 1) post_put(out, " of ω/%d", r->subharmonics);
  post_put(out, ", %d contact%s", r->n_pairs, r->n_pairs == 1 ? "" : "s");
  for (int i = 0; i < r->n_interfaces; i++) {
    post_put(out, i ? ", " : " (");
    post_put_escaped(out, r->interface_name[i]);
    if (i == r->lead) post_put(out, ", whose preloads are named");
    if (i == r->n_interfaces - 1) post_put(out, ")");
  }
  post_put(out, ", ψ\u00a0=\u00a0%s°", post_plain(deg, degrees(r->psi), 3));
  post_put(out, ", φ\u00a0=\u00a0%s°", post_plain(deg, degrees(r->phi), 3));
  if (r->run_up) post_put(out, "; ");
  post_put_run_up(analysis, out);
  if (*source->created) {
    post_put(out, ". Computed ");
    post_put_escaped(out, source->created);
  }
  post_put(out, ".</p>\n");
}

static void put_header(const post_analysis *analysis, const post_origin *source,
                       const char *case_name, post_buffer *out) {
  post_put(out,
           "<body>\n<a class=\"skip\" href=\"#chart\">To the chart</a>\n<header class=\"top\">\n"
           "<p class=\"kicker\">Shrouded blade · forced response</p>\n<h1>");
  post_put_escaped(out, case_name);
  post_put(out, "</h1>\n");
  put_lede(analysis, source, out);
  post_key_figures(analysis, out);
  post_findings(analysis, out);
  post_put(out, "</header>\n<main>\n");
}

/* ---------------------------------------------------------------- main chart */

static void put_tools(const mhb_response *response, post_buffer *out) {
  char harmonic[32];
  post_quantity_name(response, POST_QUANTITY_FIRST_HARMONIC, harmonic);
  post_put(out,
           "<div class=\"tools\">\n<label>Where<select id=\"place\"></select></label>\n"
           "<label>Motion<select id=\"axis\"></select></label>\n"
           "<fieldset><legend>Measure</legend><span class=\"switch\">"
           "<button type=\"button\" data-quantity=\"%s\">%c%s</button>"
           "<button type=\"button\" data-quantity=\"peak to peak\">Peak to "
           "peak</button></span></fieldset>\n"
           "<fieldset><legend>Amplitude</legend><span class=\"switch\">"
           "<button type=\"button\" data-scale=\"linear\">Linear</button>"
           "<button type=\"button\" data-scale=\"log\">Logarithmic</button></span></fieldset>\n"
           "<button type=\"button\" id=\"whole\">Whole range</button>\n</div>\n",
           harmonic, toupper(harmonic[0]), harmonic + 1);
}

static void put_key(const post_group *group, int index, post_buffer *out) {
  char classes[POST_CLASS], name[64];
  post_group_class(group, classes);
  post_group_name(group, name);
  if (group->rank >= 0) {
    char n0[POST_NUMBER];
    snprintf(name, sizeof name, "%s\u00a0N", post_plain(n0, group->n0, 5));
  }
  post_put(out,
           "<li><span class=\"key %s\" data-group=\"%d\"><svg viewBox=\"0 0 26 10\" "
           "aria-hidden=\"true\">"
           "<path class=\"line %s\" d=\"M1 5h24\"/></svg><span>%s</span></span></li>\n",
           classes, index, classes, name);
}

static void put_keys(const post_analysis *analysis, post_buffer *out) {
  post_put(out, "<ul class=\"keys\" aria-label=\"Curves shown\">\n<li class=\"lead\">%s</li>\n",
           analysis->n_ranks > 0 ? "Preload n₀" : "Curves");
  for (int g = 0; g < analysis->n_groups; g++)
    if (!analysis->group[g].empty) put_key(&analysis->group[g], g, out);
  post_put(out, "</ul>\n");
}

/* Of the main chart. */
static const char *tracked_title(const mhb_response *r) {
  if (!r->track) return "Forced response";
  if (strcmp(r->track, "fold") == 0) return "Tracked folds";
  if (strcmp(r->track, "flip") == 0) return "Tracked flips";
  return r->tracks_multiplier ? "Tracked Neimark-Sacker points" : "Tracked peaks";
}

/* What the marks of points say, below the main chart. */
static void put_marks(const post_analysis *analysis, post_buffer *out) {
  const mhb_response *r        = analysis->response;
  int                 doubtful = 0, undetermined = 0;
  for (int b = 0; b < r->n_branches; b++)
    for (int p = 0; p < r->branch[b].n_points; p++) {
      doubtful += mhb_branch_marked(&r->branch[b], p);
      undetermined += post_undetermined(r, &r->branch[b], p);
    }
  if (doubtful > 0)
    post_put(out,
             "<p class=\"note\">Small hollow points: the estimated error is above the tolerance; "
             "they are no results.</p>\n");
  if (undetermined > 0)
    post_put(
        out,
        "<p class=\"note\">At %d point%s some contacts stick throughout. Nothing determines "
        "their mean friction, and it moves the contacts that slip or open: what is drawn there "
        "is one of many answers, that of the smallest mean. A click tells which points.</p>\n",
        undetermined, undetermined > 1 ? "s" : "");
}

static void put_main(const post_analysis *analysis, const char *case_name, post_buffer *out) {
  char frequency[POST_PLACE], harmonic[32];
  post_quantity_name(analysis->response, post_quantity_primary(analysis->response), harmonic);
  post_put(out, "<section id=\"chart\">\n<h2>%s%s</h2>\n<div class=\"card\"><figure>\n",
           tracked_title(analysis->response), post_frequency_text(analysis, frequency));
  put_tools(analysis->response, out);
  post_put(out, "<div class=\"chart\">\n");
  post_chart_response(analysis, case_name, out);
  post_put(out, "<div id=\"readout\" class=\"readout\" hidden></div>\n</div>\n");
  put_keys(analysis, out);
  post_put(
      out,
      "<figcaption class=\"note\">Solid: stable. Dashed: modulated. Dotted: beyond a fold, never "
      "seen. Thin: not judged. Bands and bars: the whole ring, from the mean to the worst blade. "
      "Small circles: folds; full ones: flips (period doubling) and Neimark-Sacker points. "
      "Dashed grey: the linear limits, contact open (long) and stuck (short). Amplitude, %s: "
      "the largest displacement it reaches in a cycle.</figcaption>\n",
      harmonic);
  put_marks(analysis, out);
  post_put(
      out,
      "<p class=\"hint\">Point at a curve to read it, click or tap it to see its contact, "
      "harmonics and "
      "motion below. Drag a rectangle, turn the wheel (after a click into the chart, or with Ctrl) "
      "or "
      "spread two fingers to zoom; double-click for the whole range. Keyboard: arrows move along "
      "and "
      "between curves, Enter chooses, Escape resets.</p>\n<p id=\"spoken\" class=\"hidden\" "
      "aria-live=\"polite\"></p>\n"
      "</figure></div>\n</section>\n");
}

/* ---------------------------------------------------------------- chosen point */

/* A chart that the script draws. */
static void put_scripted(const char *id, const char *heading, const char *text, post_buffer *out) {
  post_put(out, "<div class=\"card\"><figure><h3>%s</h3><div class=\"chart\">\n", heading);
  plot_svg_open(out, id, 540, 380, heading, text);
  plot_svg_close(out);
  post_put(out, "</div></figure></div>\n");
}

/* Loops, friction path, load and spectrum at the point that was clicked. */
static void put_point(const post_analysis *analysis, post_buffer *out) {
  bool contact = analysis->settings && analysis->response->n_pairs > 0;
  post_put(out,
           "<section id=\"point\" class=\"scripted\">\n<h2>At the chosen point</h2>\n"
           "<p id=\"point-where\" class=\"note\"></p>\n"
           "<div class=\"tools\"><label id=\"pair-label\">Contact<select id=\"pair\"></select>"
           "</label></div>\n");
  if (contact) {
    post_put(out, "<p id=\"contact-where\" class=\"note\"></p>\n<div class=\"pair\">\n");
    put_scripted("loop-u", "Hysteresis loop along u",
                 "Friction along the sliding axis u over the relative motion along it.", out);
    put_scripted("loop-w", "Hysteresis loop along w",
                 "Friction along the axis w over the relative motion along it.", out);
    put_scripted("path", "Friction within its limit",
                 "Path of the friction force in a period; circles: its limit at the least and the "
                 "greatest normal load.",
                 out);
    put_scripted("period", "Load and friction over the period",
                 "Normal load, friction and its limit over one period, and the contact state.",
                 out);
    post_put(
        out,
        "</div>\n<ul class=\"legend\"><li class=\"stick\"><i></i><span>stuck</span></li>"
        "<li class=\"slip\"><i></i><span>slipping</span></li>"
        "<li class=\"gap\"><i></i><span>open</span></li><li>The motion in the file, followed by "
        "the contact law of the balance.</li></ul>\n");
  } else if (analysis->response->n_pairs > 0) {
    post_put(out,
             "<p class=\"note\">Loops at the contact are left out: the settings that the response "
             "was made from are not those of the case. Run <code>shroudhb mhb</code> again.</p>\n");
  }
  put_scripted("spectrum", "Harmonics at the point",
               "Amplitude of each harmonic of the motion at the chosen point.", out);
  post_put(out, "</section>\n");
}

/* ---------------------------------------------------------------- the other charts */

static void put_tracking(const post_analysis *analysis, post_buffer *out) {
  if (analysis->tracking.n < 2) return;
  bool doubtful = false;
  for (int i = 0; i < analysis->tracking.n; i++) doubtful |= analysis->tracking.point[i].doubtful;
  post_put(
      out,
      "<section>\n<h2>Peak against preload</h2>\n<p class=\"note\">Each preload’s highest peak, "
      "joined; lesser peaks are the "
      "faint dots.%s An open ring marks a largest value at the edge of the %s range%s.</p>\n"
      "<div class=\"card\"><figure><div class=\"chart\">\n",
      analysis->resonances.n > 1 ? " The thin lines join the peaks of one resonance each." : "",
      post_at_one_frequency(analysis) ? "parameter’s" : "frequency",
      doubtful ? ", a thin one an estimated error above the tolerance" : "");
  post_chart_tracking(analysis, out);
  post_put(out, "</div></figure></div>\n");
  post_table_resonances(analysis, out);
  post_put(out, "</section>\n");
}

static void put_contact(const post_analysis *analysis, int chosen, post_buffer *out) {
  if (analysis->response->n_pairs < 1) return;
  post_put(out, "<div class=\"pair\">\n");
  if (analysis->tracking.n > 0) {
    post_put(out,
             "<div class=\"card\"><figure><h3>At the highest peak, by preload</h3><div "
             "class=\"chart\">\n");
    post_chart_state(analysis, out);
    post_put(out, "</div></figure></div>\n");
  }
  post_put(out, "<div class=\"card\"><figure><h3>Along the curve</h3><div class=\"chart\">\n");
  post_chart_along(analysis, chosen, out);
  post_put(out,
           "</div></figure></div>\n</div>\n"
           "<ul class=\"legend\"><li class=\"stick\"><i></i><span>stuck</span></li>"
           "<li class=\"slip\"><i></i><span>slipping</span></li>"
           "<li class=\"gap\"><i></i><span>open</span></li>"
           "<li>Mean over the contacts; energy of all contacts.</li></ul>\n");
}

static void put_details(const post_analysis *analysis, int chosen, post_buffer *out) {
  if (chosen < 0) return;
  char name[64];
  bool followed = analysis->abscissa.parameter == MHB_IN_N0;
  post_group_name(&analysis->group[analysis->curve[chosen].group], name);
  post_put(out,
           "<section>\n<h2>Contact and harmonics</h2>\n<p class=\"note\">To begin with along the "
           "%scurve%s%s%s.</p>\n"
           "<div class=\"tools\"><label>Curve<select id=\"curve\"></select></label></div>\n",
           followed ? "first " : "", followed ? "" : " of ", followed ? "" : name,
           analysis->tracking.best >= 0 ? ", the one with the lowest peak" : "");
  put_contact(analysis, chosen, out);
  post_put(out,
           "<div class=\"card\"><figure><h3>Harmonics along the curve</h3><div class=\"chart\">\n");
  post_chart_harmonics(analysis, chosen, out);
  post_put(out, "</div></figure></div>\n</section>\n");
}

static void put_axes(const post_analysis *analysis, post_buffer *out) {
  if (analysis->response->n_pairs < 1) return;
  post_put(out,
           "<section>\n<h2>Axes of the contact</h2>\n<div class=\"card\"><figure><div "
           "class=\"chart\">\n");
  post_contact_axes(analysis->response->psi, analysis->response->phi, out);
  post_put(out,
           "</div><figcaption class=\"note\">v is normal to the right face and positive where the "
           "motion presses the faces together, u and w lie in it. Red: the contact face.%s"
           "</figcaption></figure></div>\n</section>\n",
           analysis->response->n_pairs > 1 ? " Angles: mean of the contacts." : "");
}

/* ---------------------------------------------------------------- tables and provenance */

static void put_source_row(const char *label, const char *text, post_buffer *out) {
  if (!*text) return;
  post_put(out, "<dt>%s</dt><dd>", label);
  post_put_escaped(out, text);
  post_put(out, "</dd>\n");
}

static void put_source(const post_origin *source, post_buffer *out) {
  post_put(out, "<section>\n<h2>Case and provenance</h2>\n<dl class=\"source\">\n");
  put_source_row("Case file", source->case_path, out);
  put_source_row("Computed by", source->command, out);
  put_source_row("Revision", source->revision, out);
  put_source_row("Computed", source->created, out);
  put_source_row("Page made by", shb_revision(), out);
  post_put(out, "</dl>\n<h3>Settings</h3>\n");
  post_table_settings(source->settings, out);
  if (*source->case_text) {
    post_put(out,
             "<h3>The case, verbatim</h3>\n<pre tabindex=\"0\" aria-label=\"Case file\"><code>");
    post_put_escaped(out, source->case_text);
    post_put(out, "</code></pre>\n");
  }
  post_put(out, "</section>\n");
}

static void put_tables(const post_analysis *analysis, post_buffer *out) {
  post_put(out, "<section>\n<h2>Peaks and folds</h2>\n");
  post_table_peaks(analysis, out);
  post_put(out, "</section>\n<section>\n<h2>Numerical quality</h2>\n");
  post_table_quality(analysis, out);
  post_put(out, "</section>\n<section>\n<h2>Modes</h2>\n");
  post_table_modes(analysis->response, out);
  post_put(out, "</section>\n");
}

/* A file name as a relative address. */
static void put_address(const char *name, post_buffer *out) {
  for (const char *c = name; *c; c++) {
    bool plain = isalnum((unsigned char)*c) || strchr("-_.~", *c);
    post_put(out, plain ? "%c" : "%%%02X", (unsigned char)*c);
  }
}

shb_status post_report(const post_analysis *analysis, const post_origin *source,
                       const char *case_name, const post_blade_view *blade, post_buffer *out) {
  bool moving = blade && post_blade_view_fits(blade, analysis->response);
  int  chosen = post_chosen_branch(analysis), left_out = 0;
  put_head(analysis, case_name, out);
  put_header(analysis, source, case_name, out);
  put_main(analysis, case_name, out);
  if (chosen >= 0) put_point(analysis, out);
  if (moving) post_blade_section(analysis, blade, out);
  put_tracking(analysis, out);
  post_put_blades(analysis->response, out);
  post_put_factors(analysis->response->samples, out);
  put_details(analysis, chosen, out);
  if (analysis->stress) post_put_bytes(out, analysis->stress, strlen(analysis->stress));
  put_axes(analysis, out);
  if (analysis->campbell) post_campbell_section(analysis->n_campbells, analysis->campbell, out);
  if (analysis->safe) post_safe_section(analysis->safe, out);
  if (analysis->convergence) post_convergence_section(analysis->convergence, out);
  put_tables(analysis, out);
  put_source(source, out);
  post_put(out, "</main>\n<script type=\"application/json\" id=\"data\">\n");
  SHB_TRY(post_page_data(analysis, chosen, out, &left_out));
  if (moving) {
    post_put(out, "\n</script>\n<script type=\"application/json\" id=\"blade-data\">\n");
    SHB_TRY(post_blade_data(analysis, blade, out));
  }
  post_put(out, "\n</script>\n<footer>");
  if (left_out > 0)
    post_put(out,
             "To keep this page small its charts leave out %d outputs; the response file and the "
             "CSV have all. ",
             left_out);
  post_put(out, "Displacements in SI: <a href=\"");
  put_address(case_name, out);
  post_put(out,
           ".csv\">the table of every point</a>, beside this page. Works without "
           "network.</footer>\n<script>\n");
  post_put_bytes(out, post_plot_js, strlen(post_plot_js));
  if (moving) post_put_bytes(out, post_blade_js, strlen(post_blade_js));
  post_put_bytes(out, post_page_js, strlen(post_page_js));
  post_put(out, "</script>\n</body>\n</html>\n");
  SHB_CHECK(!out->failed, SHB_ERR_IO, "not enough memory for the report");
  return SHB_OK;
}
