#include "postproc/report/tables.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/shortest.h"
#include "postproc/draw/number_format.h"

/* Bounds of the verdict on the largest error estimate of a curve. */
static const double FINE = 1e-3, USABLE = 1e-2;

/* First cell of a row: swatch and name of the branch's group. */
static void put_curve_cell(const post_analysis *analysis, int b, post_buffer *out) {
  const post_group *group = &analysis->group[analysis->curve[b].group];
  char              name[64], note[64];
  post_group_name(group, name);
  post_branch_note(analysis->response, &analysis->response->branch[b], note);
  if (group->rank >= 0)
    post_put(out, "<tr><th scope=\"row\"><i class=\"swatch c%d\"></i>%s%s</th>", group->rank, name,
             note);
  else
    post_put(out, "<tr><th scope=\"row\"><i class=\"swatch\"></i>%s%s</th>", name, note);
}

static void put_cell(post_buffer *out, const char *text) {
  post_put(out, "<td>%s</td>", text);
}

static void put_peak_row(const post_analysis *analysis, int b, const post_peak *peak,
                         post_unit unit, post_buffer *out) {
  char number[POST_NUMBER];
  put_curve_cell(analysis, b, out);
  post_put(out, "<td class=\"words\">%s</td>",
           !peak->edge                              ? "peak"
           : peak->level                            ? "everywhere"
           : analysis->response->branch[b].complete ? "edge of range"
                                                    : "end of curve");
  put_cell(out, post_abscissa_number(&analysis->abscissa, peak->level ? NAN : peak->at, 6, number));
  put_cell(out, post_number(number, peak->amplitude / unit.scale, 4));
  if (!post_at_one_frequency(analysis)) {
    put_cell(out, post_number(number, peak->bandwidth, 3));
    put_cell(out, post_percent(number, peak->damping));
  }
  post_put(out, "</tr>\n");
}

static void put_valley_row(const post_analysis *analysis, int b, const post_peak *valley,
                           post_unit unit, post_buffer *out) {
  char number[POST_NUMBER];
  if (valley->edge) return;
  put_curve_cell(analysis, b, out);
  post_put(out, "<td class=\"words\">valley</td>");
  put_cell(out, post_abscissa_number(&analysis->abscissa, valley->at, 6, number));
  put_cell(out, post_number(number, valley->amplitude / unit.scale, 4));
  post_put(out, "</tr>\n");
}

static void put_fold_row(const post_analysis *analysis, int b, const post_fold *fold,
                         post_unit unit, post_buffer *out) {
  char number[POST_NUMBER];
  put_curve_cell(analysis, b, out);
  post_put(out, "<td class=\"words\">fold, sweeping %s</td>", fold->upper ? "up" : "down");
  put_cell(out, post_abscissa_number(&analysis->abscissa, fold->at, 6, number));
  put_cell(out, post_number(number, fold->amplitude / unit.scale, 4));
  post_put(out, "%s</tr>\n", post_at_one_frequency(analysis) ? "" : "<td></td><td></td>");
}

void post_table_peaks(const post_analysis *analysis, post_buffer *out) {
  post_unit unit = post_unit_length(analysis->largest);
  char      place[128], label[POST_LABEL], frequency[POST_PLACE], harmonic[32];
  bool      widths = !post_at_one_frequency(analysis);
  post_place_name(analysis->response, analysis->primary, place);
  post_abscissa_label(&analysis->abscissa, "", label);
  label[0] = (char)toupper(label[0]);
  post_quantity_name(analysis->response, post_quantity_primary(analysis->response), harmonic);
  post_put(out, "<div class=\"scroll\"><table><caption>Peaks%s and folds of ",
           widths ? "" : ", valleys");
  post_put_escaped(out, place);
  post_put(out,
           " %s%s, %s.%s</caption>\n<thead><tr>"
           "<th scope=\"col\">Curve</th><th scope=\"col\" class=\"words\">What</th><th "
           "scope=\"col\">%s</th><th scope=\"col\">Amplitude, %s</th>%s</tr></thead>\n<tbody>\n",
           post_axis_name(analysis->primary), post_frequency_text(analysis, frequency), harmonic,
           widths ? " Damping is that of a linear resonance as wide at half power; &ldquo;–&rdquo; "
                    "where the curve does not fall that far on both sides."
                  : "",
           label, unit.name,
           widths ? "<th scope=\"col\">Half-power width, Hz</th><th scope=\"col\">Equivalent "
                    "damping</th>"
                  : "");
  for (int g = 0; g < analysis->n_groups; g++)
    for (int b = 0; b < analysis->response->n_branches; b++) {
      const post_curve *c = &analysis->curve[b];
      if (c->group != g) continue;
      for (int i = 0; i < c->n_peaks; i++) put_peak_row(analysis, b, &c->peak[i], unit, out);
      for (int i = 0; i < c->n_valleys; i++) put_valley_row(analysis, b, &c->valley[i], unit, out);
      for (int i = 0; i < c->n_folds; i++) put_fold_row(analysis, b, &c->fold[i], unit, out);
    }
  post_put(out, "</tbody></table></div>\n");
}

static void put_peak_cells(const post_analysis *analysis, const post_track_point *p, post_unit unit,
                           post_buffer *out) {
  char number[POST_NUMBER];
  put_cell(out, post_abscissa_number(&analysis->abscissa, p->at, 5, number));
  put_cell(out, post_number(number, p->amplitude / unit.scale, 3));
}

static void put_resonance_row(const post_analysis *analysis, int index, post_unit unit,
                              post_buffer *out) {
  static const post_track_point none = {NAN, NAN, NAN, -1, -1, false, false, false, false};
  const post_tracking          *t    = &analysis->resonances.list[index];
  const post_track_point       *best = t->best >= 0 ? &t->point[t->best] : &none;
  char                          number[POST_NUMBER];
  double change = best->amplitude / fmin(t->open.amplitude, t->stuck.amplitude) - 1;
  post_put(out, "<tr><th scope=\"row\">%d</th>", index + 1);
  put_peak_cells(analysis, &t->open, unit, out);
  put_peak_cells(analysis, &t->stuck, unit, out);
  put_peak_cells(analysis, best, unit, out);
  put_cell(out, isfinite(best->n0) ? post_plain(number, best->n0, 6) : "–");
  post_put(out, "<td>%s%s</td>", change < 0 ? "−" : "", post_percent(number, fabs(change)));
  post_put(out, "</tr>\n");
}

void post_table_resonances(const post_analysis *analysis, post_buffer *out) {
  const post_resonances *r    = &analysis->resonances;
  post_unit              unit = post_unit_length(analysis->largest);
  if (r->n < 2) return;
  post_put(out,
           "<div class=\"scroll\"><table><caption>Peaks of each resonance: open, stuck, and the "
           "lowest over the preloads. Peaks of neighbouring preloads belong together by their "
           "order of frequency.</caption>\n<thead><tr><th scope=\"col\">Resonance</th>"
           "<th scope=\"col\">Open, Hz</th><th scope=\"col\">%s</th>"
           "<th scope=\"col\">Stuck, Hz</th><th scope=\"col\">%s</th>"
           "<th scope=\"col\">Lowest, Hz</th><th scope=\"col\">%s</th>"
           "<th scope=\"col\">at n₀, N</th><th scope=\"col\">against the lower limit</th>"
           "</tr></thead>\n<tbody>\n",
           unit.name, unit.name, unit.name);
  for (int i = 0; i < r->n; i++) put_resonance_row(analysis, i, unit, out);
  post_put(out, "</tbody></table></div>\n");
}

/* Largest finite value, NAN if none; 0 counts as not estimated. */
static double largest(int n, const double *x) {
  double most = NAN;
  for (int i = 0; i < n; i++)
    if (isfinite(x[i]) && x[i] > 0) most = fmax(most, x[i]);
  return most;
}

static const char *verdict(const mhb_branch *branch, double worst) {
  if (!branch->complete) return "<td class=\"bad\">incomplete</td>";
  if (branch->kind == MHB_BRANCH_OPEN || branch->kind == MHB_BRANCH_STUCK)
    return "<td class=\"good\">linear</td>";
  if (isnan(worst)) return "<td>not estimated</td>";
  return worst <= FINE     ? "<td class=\"good\">fine</td>"
         : worst <= USABLE ? "<td class=\"fair\">usable</td>"
                           : "<td class=\"bad\">coarse</td>";
}

static int sum_of(int n, const int *x) {
  int sum = 0;
  for (int i = 0; i < n; i++) sum += x[i];
  return sum;
}

static void put_quality_row(const post_analysis *analysis, int b, post_buffer *out) {
  const mhb_branch *branch = &analysis->response->branch[b];
  const double *part[] = {branch->error_newton, branch->error_truncation, branch->error_sampling,
                          branch->error_modal,
                          branch->kind == MHB_BRANCH_NONLINEAR ? branch->error_spatial : NULL};
  char          number[POST_NUMBER];
  int           n = branch->n_points, iterations = 0;
  double        seconds = 0, worst = NAN;
  for (int p = 0; p < n; p++) {
    iterations += branch->iterations[p];
    seconds += branch->seconds[p];
  }
  put_curve_cell(analysis, b, out);
  if (branch->kind == MHB_BRANCH_INTEGRATION) iterations = sum_of(n, branch->periods);
  post_put(out, "<td>%d</td><td>%d</td><td>%s</td>", n, iterations,
           post_number(number, seconds, 2));
  for (int e = 0; e < 5; e++) {
    double most = part[e] ? largest(n, part[e]) : NAN;
    worst       = fmax(worst, most);
    put_cell(out, most > 1 ? "no bound" : post_number(number, most, 2));
  }
  post_put(out, "%s<td class=\"words\">", verdict(branch, worst));
  post_put_escaped(out, branch->reason ? branch->reason : "");
  post_put(out, "</td></tr>\n");
}

void post_table_quality(const post_analysis *analysis, post_buffer *out) {
  post_put(
      out,
      "<div class=\"scroll\"><table><caption>Largest error estimates along each curve, relative to "
      "the "
      "motion. Time integration: periods for iterations, the return map for Newton, steps for "
      "sampling. Fine: all at most 0.1&nbsp;%%; usable: at most 1&nbsp;%%; coarse: above (more "
      "harmonics, modes or contact points "
      "are needed); no bound: above 100&nbsp;%%, as beside a fold; &ldquo;–&rdquo;: not "
      "estimated.</caption>\n<thead><tr><th "
      "scope=\"col\">Curve</th>"
      "<th scope=\"col\">Points</th><th scope=\"col\">Iterations</th><th scope=\"col\">Time, s</th>"
      "<th scope=\"col\">Newton</th><th scope=\"col\">Truncation</th><th "
      "scope=\"col\">Sampling</th>"
      "<th scope=\"col\">Modal</th><th scope=\"col\">Contact points</th><th "
      "scope=\"col\">Verdict</th><th "
      "scope=\"col\" class=\"words\">Ended</th></tr></thead>"
      "\n<tbody>\n");
  for (int g = 0; g < analysis->n_groups; g++)
    for (int b = 0; b < analysis->response->n_branches; b++)
      if (analysis->curve[b].group == g) put_quality_row(analysis, b, out);
  post_put(out, "</tbody></table></div>\n");
}

void post_table_modes(const mhb_response *response, post_buffer *out) {
  if (response->n_modes == 0) {
    post_put(out, "<p>The response file does not list the modes it was computed from.</p>\n");
    return;
  }
  post_put(out,
           "<div class=\"scroll\"><table><caption>Modes of the blade with its shrouds "
           "free%s.</caption>\n"
           "<thead><tr><th scope=\"col\">Mode</th><th scope=\"col\">Frequency, Hz</th>"
           "<th scope=\"col\">Damping ratio, %%</th><th scope=\"col\">Relative "
           "residual</th></tr></thead>\n<tbody>\n",
           response->run_up ? ", at the highest speed of the run-up" : "");
  for (int i = 0; i < response->n_modes; i++) {
    char number[POST_NUMBER];
    post_put(out, "<tr><th scope=\"row\">%d</th>", i + 1);
    put_cell(out, post_number(number, response->mode_frequency[i], 7));
    put_cell(out, post_plain(number, 100 * response->mode_damping[i], 4));
    put_cell(out,
             post_number(number, response->eigen_residual ? response->eigen_residual[i] : NAN, 2));
    post_put(out, "</tr>\n");
  }
  post_put(out, "</tbody></table></div>\n");
}

/* A number with the fewest digits that give it back: 0.3, not 0.29999999999999999. Other words are
 * unchanged. */
static void put_word(const char *word, size_t n, post_buffer *out) {
  char text[512], shortest[SHB_SHORTEST], *end;
  snprintf(text, sizeof text, "%.*s", (int)n, word);
  double     value     = strtod(text, &end);
  const bool is_number = n > 15 && *end == '\0' && isfinite(value);
  post_put_escaped(out, is_number ? shb_shortest(value, shortest) : text);
}

static void put_words(const char *text, post_buffer *out) {
  while (*text) {
    size_t n = strcspn(text, " ");
    if (n > 0) put_word(text, n, out);
    text += n;
    if (*text) post_put(out, "%c", *text++);
  }
}

static void put_setting(const char *line, size_t n, post_buffer *out) {
  char text[512];
  snprintf(text, sizeof text, "%.*s", (int)(n < 500 ? n : 500), line);
  char *equal = strstr(text, " = ");
  post_put(out, "<tr><th scope=\"row\"><code>");
  if (equal) *equal = '\0';
  post_put_escaped(out, text);
  post_put(out, "</code></th><td class=\"words\">");
  if (equal) put_words(equal + 3, out);
  post_put(out, "</td></tr>\n");
}

void post_table_settings(const char *settings, post_buffer *out) {
  if (!*settings) {
    post_put(out, "<p>The response file holds no settings.</p>\n");
    return;
  }
  post_put(out,
           "<div class=\"scroll\"><table class=\"settings\"><caption>Every key the harmonic "
           "balance depends on, "
           "in SI units.</caption><tbody>\n");
  while (*settings) {
    size_t n = strcspn(settings, "\n");
    if (n > 0) put_setting(settings, n, out);
    settings += n + (settings[n] == '\n');
  }
  post_put(out, "</tbody></table></div>\n");
}
