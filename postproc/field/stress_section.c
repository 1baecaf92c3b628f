#include "postproc/field/stress_section.h"

#include <math.h>

#include "postproc/analysis/stability_findings.h"
#include "postproc/draw/number_format.h"
#include "postproc/field/kept_point.h"

enum { DIGITS = 4, MOST_CURVES = 40 };

/* The highest kept point of a curve with its worst places. */
typedef struct {
  const mhb_branch *branch;
  int               index, kept, n;
  post_worst_place  place[POST_PLACES];
} worst;

static void put_cell(post_buffer *out, double value) {
  char text[POST_NUMBER];
  post_put(out, "<td class=\"num\">%s</td>", post_plain(text, value, DIGITS));
}

/* Coordinates in mm. */
static void put_where(const post_blade_field *field, int node, post_buffer *out) {
  char text[POST_NUMBER];
  for (int d = 0; d < 3; d++) {
    const double x = round(1e4 * field->nodes[3 * (size_t)node + (size_t)d]) / 10;
    post_put(out, "%s%s", d ? ", " : "", post_plain(text, x, DIGITS));
  }
}

static void put_place(const post_blade_field *field, const post_worst_place *place, bool judged,
                      post_buffer *out) {
  put_cell(out, place->amplitude / 1e6);
  put_cell(out, place->principal / 1e6);
  put_cell(out, place->mean / 1e6);
  post_put(out, "<td class=\"num\">");
  put_where(field, place->node, out);
  post_put(out, "</td>");
  if (judged) put_cell(out, place->safety);
}

static void put_name(const worst *w, post_buffer *out) {
  static const char *const name[MHB_N_BRANCH_KINDS] = {"", "open", "stuck", "time integration",
                                                       "tracked"};
  char                     n0[POST_NUMBER];
  const int                point = w->branch->modal.point[w->kept];
  if (w->branch->kind != MHB_BRANCH_NONLINEAR) {
    post_put(out, "%s", name[w->branch->kind]);
  } else {
    post_put(out, "%s\u00a0N", post_plain(n0, w->branch->n0[point], DIGITS));
  }
  if (w->branch->main != w->index) post_put(out, ", secondary");
}

static void put_columns(bool judged, post_buffer *out) {
  post_put(out,
           "<th scope=\"col\">Amplitude, MPa</th><th scope=\"col\">Greatest principal, MPa</th>"
           "<th scope=\"col\">Mean, MPa</th><th scope=\"col\">At x, y, z, mm</th>%s</tr></thead>\n"
           "<tbody>\n",
           judged ? "<th scope=\"col\">Safety</th>" : "");
}

static void put_row(const post_blade_field *field, const worst *w, bool judged, post_buffer *out) {
  static const char *const verdict[] = {[POST_VERDICT_STABLE]     = "stable",
                                        [POST_VERDICT_NOT_JUDGED] = "not judged",
                                        [POST_VERDICT_MODULATED]  = "modulated",
                                        [POST_VERDICT_NEVER_SEEN] = "never seen: beyond a fold"};
  const int                point     = w->branch->modal.point[w->kept];
  char                     frequency[POST_NUMBER];
  post_put(out, "<tr><td>");
  put_name(w, out);
  post_put(out, "</td><td class=\"num\">%s</td><td>%s</td>",
           post_number(frequency, w->branch->frequency[point], 5),
           verdict[post_verdict_of(w->branch, point)]);
  put_place(field, &w->place[0], judged, out);
  post_put(out, "</tr>\n");
}

static void put_list(const post_blade_field *field, const worst *w, bool judged, post_buffer *out) {
  post_put(out, "<details><summary>The %d worst places of ", w->n);
  put_name(w, out);
  post_put(out,
           "</summary><div class=\"scroll\"><table><thead><tr><th scope=\"col\">Place</th>"
           "<th scope=\"col\">Node</th>");
  put_columns(judged, out);
  for (int i = 0; i < w->n; i++) {
    post_put(out, "<tr><td class=\"num\">%d</td><td class=\"num\">%d</td>", i + 1,
             w->place[i].node);
    put_place(field, &w->place[i], judged, out);
    post_put(out, "</tr>\n");
  }
  post_put(out, "</tbody></table></div></details>\n");
}

static void put_static(const post_blade_field *field, post_buffer *out) {
  double most = -1;
  int    node = 0;
  if (!field->static_stress) return;
  for (int i = 0; i < field->n_nodes; i++) {
    const double mises = fabs(post_signed_mises(field->static_stress + POST_STRESSES * (size_t)i));
    if (mises > most) most = mises, node = i;
  }
  char text[POST_NUMBER];
  post_put(out, "<p>Static stress at speed: at most %s\u00a0MPa (von Mises) at ",
           post_plain(text, most / 1e6, DIGITS));
  put_where(field, node, out);
  post_put(out, "\u00a0mm.</p>\n");
}

static void put_all(const post_blade_field *field, const worst *list, int n, bool judged,
                    post_buffer *out) {
  post_put(out,
           "<section id=\"stress\">\n<h2>Stress at the peaks</h2>\n"
           "<p class=\"note\">The highest point of each curve, the worst place of the blade. "
           "Amplitude: half the range of the signed von Mises stress over a period, of the "
           "vibration alone. Mean: signed von Mises stress of static stress and the vibration's "
           "mean.%s</p>\n",
           judged ? " Safety: against Goodman's line; above 1 is safe." : "");
  put_static(field, out);
  post_put(out,
           "<div class=\"scroll\"><table><caption>Worst place of each curve</caption><thead><tr>"
           "<th scope=\"col\">Curve</th><th scope=\"col\">Hz</th><th scope=\"col\">Motion</th>");
  put_columns(judged, out);
  for (int i = 0; i < n; i++) put_row(field, &list[i], judged, out);
  post_put(out, "</tbody></table></div>\n");
  for (int i = 0; i < n; i++) put_list(field, &list[i], judged, out);
  post_put(out, "</section>\n");
}

/* Curves with kept points: nonlinear ones, or the others. */
static int choose(const mhb_response *response, bool nonlinear, worst *list) {
  int n = 0;
  for (int i = 0; i < response->n_branches && n < MOST_CURVES; i++) {
    const mhb_branch *b = &response->branch[i];
    if (b->modal.n == 0 || (b->kind == MHB_BRANCH_NONLINEAR) != nonlinear) continue;
    list[n++] = (worst){.branch = b, .index = i, .kept = post_highest_kept(response, b)};
  }
  return n;
}

shb_status post_stress_section(const post_blade_field *field, const mhb_response *response,
                               const post_fatigue *fatigue, post_buffer *out) {
  worst list[MOST_CURVES];
  int   n = choose(response, true, list);
  if (n == 0) n = choose(response, false, list);
  for (int i = 0; i < n; i++)
    SHB_TRY(
        post_worst_places(field, list[i].branch, list[i].kept, fatigue, list[i].place, &list[i].n));
  if (n > 0) put_all(field, list, n, post_fatigue_given(fatigue), out);
  SHB_CHECK(!out->failed, SHB_ERR_IO, "out of memory for the stress at the peaks");
  return SHB_OK;
}
