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
#include "postproc/draw/template.h"
#include "postproc/report/charts.h"
#include "postproc/report/convergence_chart.h"
#include "postproc/report/page.h"
#include "postproc/report/page_data.h"
#include "postproc/report/picture.h"
#include "postproc/report/ring_data.h"
#include "postproc/report/safe_diagram.h"
#include "postproc/report/tables.h"

/* ---------------------------------------------------------------- head */

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
  if (r->turns_right) post_put(out, " of a rotor that turns right");
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

/* ---------------------------------------------------------------- main chart */

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
  for (int g = 0; g < analysis->n_groups; g++)
    if (!analysis->group[g].empty) put_key(&analysis->group[g], g, out);
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

/* ---------------------------------------------------------------- provenance */

static void put_source_row(const char *label, const char *text, post_buffer *out) {
  if (!*text) return;
  post_put(out, "<dt>%s</dt><dd>", label);
  post_put_escaped(out, text);
  post_put(out, "</dd>\n");
}

static void put_source(const post_origin *source, post_buffer *out) {
  put_source_row("Case file", source->case_path, out);
  put_source_row("Computed by", source->command, out);
  put_source_row("Revision", source->revision, out);
  put_source_row("Computed", source->created, out);
  put_source_row("Page made by", shb_revision(), out);
}

/* A file name as a relative address. */
static void put_address(const char *name, post_buffer *out) {
  for (const char *c = name; *c; c++) {
    bool plain = isalnum((unsigned char)*c) || strchr("-_.~", *c);
    post_put(out, plain ? "%c" : "%%%02X", (unsigned char)*c);
  }
}

/* ---------------------------------------------------------------- page */

/* A part of the template that is there or not. */
static void flag(post_values_list *values, const char *name, bool there) {
  post_buffer *value = post_value(values, name);
  if (there) post_put(value, "1");
}

static void put_text(post_values_list *values, const char *name, const char *text) {
  post_put(post_value(values, name), "%s", text);
}

static void escaped(post_values_list *values, const char *name, const char *text) {
  post_put_escaped(post_value(values, name), text);
}

static void fill_head(const post_analysis *analysis, const post_origin *source,
                      const char *case_name, post_values_list *v) {
  char         frequency[POST_PLACE], harmonic[32];
  post_buffer *css, *findings;
  escaped(v, "name", case_name);
  put_text(v, "css", post_page_css);
  post_put_ramp(analysis->n_ranks, false, post_value(v, "ramp"));
  post_put_ramp(analysis->n_ranks, true, post_value(v, "ramp_dark"));
  css = post_value(v, "more_css");
  if (analysis->campbell) post_put(css, "%s", post_campbell_css);
  if (analysis->convergence) post_put(css, "%s", post_convergence_css);
  put_lede(analysis, source, post_value(v, "lede"));
  findings = post_value(v, "findings");
  post_key_figures(analysis, findings);
  post_findings(analysis, findings);
  post_put(post_value(v, "title"), "%s%s", tracked_title(analysis->response),
           post_frequency_text(analysis, frequency));
  post_quantity_name(analysis->response, POST_QUANTITY_FIRST_HARMONIC, harmonic);
  put_text(v, "harmonic", harmonic);
  post_put(post_value(v, "Harmonic"), "%c%s", toupper(harmonic[0]), harmonic + 1);
}

/* NAME.svg without its XML declaration, the first line. */
static void put_picture(const post_analysis *analysis, const char *case_name, post_buffer *out) {
  post_buffer svg = {0};
  post_picture(analysis, case_name, &svg);
  const char *line = svg.failed ? NULL : strchr(svg.text, '\n');
  if (line) post_put(out, "%s", line + 1);
  out->failed = out->failed || !line;
  post_buffer_free(&svg);
}

static void fill_chart(const post_analysis *analysis, const char *case_name, post_values_list *v) {
  const mhb_response *r = analysis->response;
  put_picture(analysis, case_name, post_value(v, "picture"));
  post_describe_response(analysis, post_value(v, "description"));
  put_text(v, "abscissa", analysis->abscissa.name);
  put_text(v, "key_lead", analysis->n_ranks > 0 ? "Preload n₀" : "Curves");
  put_keys(analysis, post_value(v, "keys"));
  put_marks(analysis, post_value(v, "marks"));
  flag(v, "contact", r->n_pairs > 0);
  flag(v, "contacts", r->n_pairs > 1);
  flag(v, "loops", analysis->settings && r->n_pairs > 0);
  flag(v, "no_loops", !analysis->settings && r->n_pairs > 0);
}

static void fill_tracking(const post_analysis *analysis, post_values_list *v) {
  const post_tracking *t        = &analysis->tracking;
  bool                 doubtful = false;
  for (int i = 0; i < t->n; i++) doubtful |= t->point[i].doubtful;
  flag(v, "tracked", t->n > 1);
  flag(v, "state", t->n > 0);
  flag(v, "doubtful", doubtful);
  put_text(v, "range_name", post_at_one_frequency(analysis) ? "parameter’s" : "frequency");
  post_table_resonances(analysis, post_value(v, "resonances"));
}

/* The curve that the page begins with. */
static void fill_chosen(const post_analysis *analysis, int chosen, post_values_list *v) {
  post_buffer *out      = post_value(v, "chosen");
  const bool   followed = analysis->abscissa.parameter == MHB_IN_N0;
  char         name[64];
  if (chosen < 0) return;
  post_group_name(&analysis->group[analysis->curve[chosen].group], name);
  post_put(out, "%scurve%s%s%s", followed ? "first " : "", followed ? "" : " of ",
           followed ? "" : name,
           analysis->tracking.best >= 0 ? ", the one with the lowest peak" : "");
}

static void fill_sections(const post_analysis *analysis, const post_origin *source,
                          post_values_list *v) {
  const post_safe *safe = analysis->safe;
  put_text(v, "stress", analysis->stress ? analysis->stress : "");
  post_buffer *campbell = post_value(v, "campbell"), *convergence = post_value(v, "convergence");
  if (analysis->campbell)
    post_campbell_section(analysis->n_campbells, analysis->campbell, campbell);
  if (analysis->convergence) post_convergence_section(analysis->convergence, convergence);
  post_buffer *rows = post_value(v, "safe");
  if (safe) post_safe_table(safe, rows);
  flag(v, "safe_unknown", safe && !safe->known);
  flag(v, "disc", safe && safe->disc);
  flag(v, "turning", safe && safe->speed > 0);
  post_table_peaks(analysis, post_value(v, "peaks"));
  post_table_quality(analysis, post_value(v, "quality"));
  post_table_modes(analysis->response, post_value(v, "modes"));
  put_source(source, post_value(v, "source"));
  post_table_settings(source->settings, post_value(v, "settings"));
  escaped(v, "case", source->case_text);
}

static shb_status fill_data(const post_analysis *analysis, int chosen, const post_blade_view *blade,
                            const char *case_name, post_values_list *v) {
  int         left_out = 0;
  post_buffer unused   = {0};
  flag(v, "moving", blade != NULL);
  flag(v, "blades", post_put_blades(analysis->response, &unused) > 0);
  flag(v, "factors", post_put_factors(analysis->response->samples, &unused));
  post_buffer_free(&unused);
  SHB_TRY(post_page_data(analysis, chosen, blade, post_value(v, "data"), &left_out));
  post_buffer *number = post_value(v, "left_out");
  if (left_out > 0) post_put(number, "%d", left_out);
  put_address(case_name, post_value(v, "address"));
  put_text(v, "script", post_report_js);
  return SHB_OK;
}

shb_status post_report(const post_analysis *analysis, const post_origin *source,
                       const char *case_name, const post_blade_view *blade, post_buffer *out) {
  const bool       moving = blade && post_blade_view_fits(blade, analysis->response);
  const int        chosen = post_chosen_branch(analysis);
  post_values_list values = {0};
  fill_head(analysis, source, case_name, &values);
  fill_chart(analysis, case_name, &values);
  fill_tracking(analysis, &values);
  fill_chosen(analysis, chosen, &values);
  fill_sections(analysis, source, &values);
  shb_status status = fill_data(analysis, chosen, moving ? blade : NULL, case_name, &values);
  if (status == SHB_OK) status = post_template(post_report_html, &values, out);
  post_values_list_free(&values);
  return status;
}
