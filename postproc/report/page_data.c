#include "postproc/report/page_data.h"
#include "postproc/analysis/resonances.h"
#include "postproc/analysis/stability_findings.h"

#include <math.h>
#include <stdlib.h>

#include "mhb/problem/parameter.h"
#include "postproc/report/charts.h"
#include "postproc/report/contact_points.h"
#include "postproc/report/ring_data.h"
#include "postproc/report/safe_diagram.h"

enum { BUDGET = 400000, LEAST_ROWS = 12, MAX_COLUMNS = 256, MAX_PLACES = 8, MAX_HARMONICS = 16 };

static const char format[] = "shroudhb report page";
enum { VERSION = 1 };

/* Rows of every curve; the script finds them by these names. */
enum { ABSCISSA, STUCK, SLIPPING, OPEN, DISSIPATION, ERROR, STABILITY, SPECIAL, MARK, FIXED_ROWS };
static const char *const row_name[FIXED_ROWS] = {"abscissa",  "stuck",       "slipping",
                                                 "open",      "dissipation", "error",
                                                 "stability", "special",     "mark"};

/* One output; if n > 0, the amplitudes of harmonics 0 .. n - 1 of a place. */
typedef struct {
  post_output   output;
  post_quantity quantity;
  int           n, row;
} column;

typedef struct {
  int           n, rows, left_out;
  post_quantity first; /* that the page begins with */
  column        column[MAX_COLUMNS];
} plan;

/* Numbers of one branch: the points written and their rows. */
typedef struct {
  int    n;
  int   *kept; /* [n] */
  float *data; /* [rows][n] */
} sheet;

/* ---------------------------------------------------------------- choice of columns */

static void propose(plan *p, int rows, column wanted) {
  int needed = wanted.n > 0 ? wanted.n : 1;
  if (p->n == MAX_COLUMNS || p->rows + needed > rows) {
    p->left_out++;
    return;
  }
  wanted.row        = p->rows;
  p->column[p->n++] = wanted;
  p->rows += needed;
}

static post_quantity other_than(post_quantity quantity) {
  return quantity == POST_QUANTITY_PEAK_TO_PEAK ? POST_QUANTITY_FIRST_HARMONIC
                                                : POST_QUANTITY_PEAK_TO_PEAK;
}

static void propose_place(plan *p, int rows, post_place place, int index, int pass, int harmonics) {
  post_output whole = {place, index, POST_WHOLE};
  if (pass == 0) {
    propose(p, rows, (column){whole, p->first, 0, 0});
    propose(p, rows, (column){whole, other_than(p->first), 0, 0});
  } else if (pass == 1) {
    propose(p, rows, (column){whole, POST_QUANTITY_FIRST_HARMONIC, harmonics, 0});
  } else {
    for (int axis = 0; axis < 3; axis++)
      for (int q = POST_QUANTITY_FIRST_HARMONIC; q <= POST_QUANTITY_PEAK_TO_PEAK; q++)
        propose(p, rows, (column){{place, index, axis}, (post_quantity)q, 0, 0});
  }
}

static plan make_plan(const mhb_response *response, int n_points) {
  int rows      = BUDGET / (n_points > 0 ? n_points : 1);
  int harmonics = response->n_harmonics + 1;
  for (int b = 0; b < response->n_branches; b++)
    if (response->branch[b].n_harmonics >= harmonics)
      harmonics = response->branch[b].n_harmonics + 1;
  if (harmonics > MAX_HARMONICS) harmonics = MAX_HARMONICS;
  plan p = {.rows = FIXED_ROWS, .first = post_quantity_primary(response)};
  for (int pass = 0; pass < 3; pass++) {
    if (response->ring) {
      propose_place(&p, rows, POST_PLACE_WORST, 0, pass, harmonics);
      propose_place(&p, rows, POST_PLACE_MEAN, 0, pass, harmonics);
    }
    for (int q = 0; q < response->n_probes; q++) {
      if (q < MAX_PLACES)
        propose_place(&p, rows, POST_PLACE_PROBE, q, pass, harmonics);
      else
        p.left_out += pass == 2 ? 6 : 2 - pass;
    }
    for (int c = 0; c < response->n_pairs; c++) {
      if (c < MAX_PLACES)
        propose_place(&p, rows, POST_PLACE_CONTACT, c, pass, harmonics);
      else
        p.left_out += pass == 2 ? 6 : 2 - pass;
    }
  }
  return p;
}

/* ---------------------------------------------------------------- choice of points */

/* True for ends, special points, extrema of amplitude and abscissa, changes of stability, and every
 * stride-th point. */
static bool is_kept(const mhb_branch *branch, const double *x, const double *a, int i, int stride) {
  if (i % stride == 0 || i == branch->n_points - 1 || branch->special[i]) return true;
  bool top  = (a[i] - a[i - 1]) * (a[i + 1] - a[i]) <= 0;
  bool turn = (x[i] - x[i - 1]) * (x[i + 1] - x[i]) <= 0;
  return top || turn || branch->stable[i] != branch->stable[i - 1];
}

/* ---------------------------------------------------------------- writing */

static void put_value(post_buffer *out, double value) {
  post_put(out, isfinite(value) ? "%.7g" : "null", value);
}

static void put_triple(post_buffer *out, bool *first, int group, double at, double amplitude) {
  post_put(out, "%s[%d,", *first ? "" : ",", group);
  put_value(out, at);
  post_put(out, ",");
  put_value(out, amplitude);
  post_put(out, "]");
  *first = false;
}

static void put_row(post_buffer *out, int n, const double *value) {
  for (int i = 0; i < n; i++) {
    post_put(out, i ? "," : "[");
    put_value(out, value[i]);
  }
  post_put(out, "]");
}

static void put_track_point(const post_analysis *analysis, const post_track_point *p, int group,
                            post_buffer *out) {
  const mhb_response *r      = analysis->response;
  const mhb_branch   *branch = &r->branch[p->branch];
  const double        all[]  = {group,
                                p->n0,
                                p->amplitude,
                                p->at,
                                p->edge,
                                p->doubtful,
                                post_state(r, branch, p->point, 0),
                                post_state(r, branch, p->point, 1),
                                post_state(r, branch, p->point, 2),
                                post_dissipation(r, branch, p->point)};
  put_row(out, sizeof all / sizeof *all, all);
}

static shb_status put_track(const post_analysis *analysis, double *const *values,
                            post_buffer *out) {
  post_tracking t;
  SHB_TRY(post_track(analysis, values, &t));
  post_put(out, ",\"track\":[");
  for (int i = 0; i < t.n; i++) {
    post_put(out, i ? "," : "");
    put_track_point(analysis, &t.point[i], analysis->curve[t.point[i].branch].group, out);
  }
  post_put(out, "],\"best\":%d,\"limits\":[", t.best);
  bool first = true;
  if (t.open.branch >= 0)
    put_triple(out, &first, analysis->curve[t.open.branch].group, t.open.at, t.open.amplitude);
  if (t.stuck.branch >= 0)
    put_triple(out, &first, analysis->curve[t.stuck.branch].group, t.stuck.at, t.stuck.amplitude);
  post_put(out, "]");
  post_tracking_free(&t);
  return SHB_OK;
}

/* "resonances": a list of points for each; empty below two. */
static shb_status put_resonances(const post_analysis *analysis, double *const *values,
                                 post_buffer *out) {
  post_resonances r;
  SHB_TRY(post_resonances_find(analysis, values, &r));
  post_put(out, ",\"resonances\":[");
  for (int i = 0; i < r.n && r.n > 1; i++) {
    post_put(out, "%s[", i ? "," : "");
    for (int k = 0; k < r.list[i].n; k++) {
      const post_track_point *p      = &r.list[i].point[k];
      const double            all[3] = {p->n0, p->at, p->amplitude};
      post_put(out, k ? "," : "");
      put_row(out, 3, all);
    }
    post_put(out, "]");
  }
  post_put(out, "]");
  post_resonances_free(&r);
  return SHB_OK;
}

static shb_status put_peaks(const post_analysis *analysis, double *const *values,
                            post_buffer *out) {
  bool first = true;
  post_put(out, ",\"peaks\":[");
  for (int b = 0; b < analysis->response->n_branches; b++) {
    const mhb_branch *branch = &analysis->response->branch[b];
    post_peak        *peak;
    int               n;
    const double     *x = post_abscissa_values(analysis->response, branch);
    SHB_TRY(post_find_peaks(branch->n_points, x, values[b], &peak, &n));
    for (int i = 0; i < n; i++)
      put_triple(out, &first, analysis->curve[b].group, peak[i].at, peak[i].amplitude);
    free(peak);
  }
  post_put(out, "]");
  return SHB_OK;
}

static shb_status put_folds(const post_analysis *analysis, double *const *values,
                            post_buffer *out) {
  bool first = true;
  post_put(out, ",\"folds\":[");
  for (int b = 0; b < analysis->response->n_branches; b++) {
    const mhb_branch *branch = &analysis->response->branch[b];
    post_fold        *fold;
    int               n;
    if (analysis->curve[b].n_folds == 0) continue;
    const double *x = post_abscissa_values(analysis->response, branch);
    SHB_TRY(post_find_folds(branch->n_points, x, values[b], branch->special, &fold, &n));
    for (int i = 0; i < n; i++)
      put_triple(out, &first, analysis->curve[b].group, fold[i].at, fold[i].amplitude);
    free(fold);
  }
  post_put(out, "]");
  return SHB_OK;
}

/* Write the analysis of an output, and fill its row in every sheet. */
static shb_status put_output(const post_analysis *analysis, const column *c, sheet *sheets,
                             post_buffer *out) {
  double **values;
  char     quantity[32];
  post_quantity_name(analysis->response, c->quantity, quantity);
  SHB_TRY(post_values(analysis->response, c->output, c->quantity, &values));
  post_put(out, ",\"axis\":\"%s\",\"quantity\":\"%s\"", post_axis_name(c->output), quantity);
  shb_status status = put_track(analysis, values, out);
  if (status == SHB_OK) status = put_resonances(analysis, values, out);
  if (status == SHB_OK) status = put_peaks(analysis, values, out);
  if (status == SHB_OK) status = put_folds(analysis, values, out);
  for (int b = 0; b < analysis->response->n_branches; b++) {
    sheet *s = &sheets[b];
    for (int i = 0; i < s->n; i++)
      s->data[(size_t)c->row * (size_t)s->n + (size_t)i] = (float)values[b][s->kept[i]];
  }
  post_values_free(analysis->response, values);
  return status;
}

static void fill_spectrum(const mhb_response *response, const column *c, sheet *sheets) {
  for (int b = 0; b < response->n_branches; b++)
    for (int k = 0; k < c->n; k++)
      for (int i = 0; i < sheets[b].n; i++)
        sheets[b].data[(size_t)(c->row + k) * (size_t)sheets[b].n + (size_t)i] =
            (float)post_amplitude(response, &response->branch[b], sheets[b].kept[i], c->output, k);
}

static shb_status put_columns(const post_analysis *analysis, const plan *p, bool spectra,
                              sheet *sheets, post_buffer *out) {
  const char *comma = "";
  for (int i = 0; i < p->n; i++) {
    const column *c = &p->column[i];
    char          place[128];
    if ((c->n > 0) != spectra) continue;
    post_put(out, "%s\n{\"place\":", comma);
    comma = ",";
    post_place_name(analysis->response, c->output, place);
    post_put_json(out, place);
    post_put(out, ",\"row\":%d", c->row);
    if (spectra) {
      post_put(out, ",\"n\":%d", c->n);
      fill_spectrum(analysis->response, c, sheets);
    } else {
      SHB_TRY(put_output(analysis, c, sheets, out));
    }
    post_put(out, "}");
  }
  return SHB_OK;
}

static double fixed_value(const post_analysis *analysis, const mhb_branch *branch, int point,
                          int row) {
  const mhb_response *r = analysis->response;
  switch (row) {
    case ABSCISSA:
      return post_abscissa_values(r, branch)[point];
    case STUCK:
    case SLIPPING:
    case OPEN:
      return post_state(r, branch, point, row - STUCK);
    case DISSIPATION:
      return post_dissipation(r, branch, point);
    case ERROR:
      return post_error(branch, point);
    case STABILITY:
      return post_verdict_of(branch, point);
    case SPECIAL:
      return branch->special[point];
    default:
      return branch->mark[point];
  }
}

/* Choose the points of a branch and fill its fixed rows. */
static shb_status make_sheet(const post_analysis *analysis, int b, int rows, int stride, sheet *s) {
  const mhb_branch *branch = &analysis->response->branch[b];
  const double     *x      = post_abscissa_values(analysis->response, branch);
  size_t            points = (size_t)branch->n_points;
  s->kept                  = malloc((points + 1) * sizeof *s->kept);
  s->data                  = malloc((points * (size_t)rows + 1) * sizeof *s->data);
  SHB_CHECK(s->kept && s->data, SHB_ERR_IO, "not enough memory for the report");
  for (int i = 0; i < branch->n_points; i++)
    if (is_kept(branch, x, analysis->curve[b].amplitude, i, stride)) s->kept[s->n++] = i;
  for (int row = 0; row < FIXED_ROWS; row++)
    for (int i = 0; i < s->n; i++)
      s->data[(size_t)row * (size_t)s->n + (size_t)i] =
          (float)fixed_value(analysis, branch, s->kept[i], row);
  return SHB_OK;
}

static void put_list(post_buffer *out, const char *name, int n, const double *value) {
  post_put(out, "\"%s\":", name);
  put_row(out, n, value);
}

/* The motion that lasts, of the primary output: the sweep of the ring, and settled points that
 * differ from the wave. */
static void put_lasting(const post_analysis *analysis, int b, post_buffer *out) {
  const mhb_branch        *branch = &analysis->response->branch[b];
  const mhb_lasting_curve *sweep  = &branch->lasting_curve;
  const char              *comma  = "";
  if (branch->kind != MHB_BRANCH_NONLINEAR || !branch->lasting_kind) return;
  if (sweep->n > 0) {
    post_put(out, ",\"ring\":{");
    put_list(out, "at", sweep->n, sweep->frequency);
    post_put(out, ",");
    put_list(out, "mean", sweep->n, sweep->mean);
    post_put(out, ",");
    put_list(out, "worst", sweep->n, sweep->worst);
    post_put(out, ",\"lasts\":[");
    for (int i = 0; i < sweep->n; i++)
      post_put(out, "%s%s", i ? "," : "", post_swing_lasts(branch, i) ? "true" : "false");
    post_put(out, "]}");
  }
  post_put(out, ",\"lasting\":[");
  for (int i = 0; i < branch->n_points; i++) {
    const double wave   = analysis->curve[b].amplitude[i];
    const double all[3] = {branch->frequency[i], wave * branch->lasting_mean[i],
                           wave * branch->lasting_worst[i]};
    if (branch->lasting_kind[i] <= MHB_LASTING_WAVE) continue;
    post_put(out, "%s", comma);
    comma = ",";
    put_row(out, 3, all);
  }
  post_put(out, "]");
}

static shb_status put_branches(const post_analysis *analysis, int rows, const sheet *sheets,
                               const post_contact_plan *contacts, post_buffer *out) {
  for (int b = 0; b < analysis->response->n_branches; b++) {
    const mhb_branch *branch = &analysis->response->branch[b];
    char              note[64];
    post_branch_note(analysis->response, branch, note);
    post_put(out,
             "%s\n{\"group\":%d,\"n\":%d,\"complete\":%s,\"dots\":%s,\"reason\":", b ? "," : "",
             analysis->curve[b].group, sheets[b].n, branch->complete ? "true" : "false",
             branch->kind == MHB_BRANCH_INTEGRATION ? "true" : "false");
    post_put_json(out, branch->reason ? branch->reason : "");
    post_put(out, ",\"order\":%d,\"note\":", branch->order);
    post_put_json(out, note);
    put_lasting(analysis, b, out);
    SHB_TRY(post_put_contact_points(analysis, contacts, b, sheets[b].n, sheets[b].kept, out));
    post_put(out, ",\"data\":\"");
    post_put_base64(out, (size_t)rows * (size_t)sheets[b].n, sheets[b].data);
    post_put(out, "\"}");
  }
  return SHB_OK;
}

/* The curves with their contacts. */
static shb_status put_curves(const post_analysis *analysis, int rows, const sheet *sheets,
                             post_buffer *out) {
  post_contact_plan contacts;
  shb_status        status = post_contact_points(analysis, &contacts);
  post_put(out, ",\"contacts\":");
  post_put_contacts(analysis, &contacts, out);
  post_put(out, ",\"branches\":[");
  if (status == SHB_OK) status = put_branches(analysis, rows, sheets, &contacts, out);
  post_put(out, "]");
  post_contact_plan_free(&contacts);
  return status;
}

static void put_groups(const post_analysis *analysis, post_buffer *out) {
  static const char *const kind[] = {"nonlinear", "open", "stuck"};
  for (int g = 0; g < analysis->n_groups; g++) {
    const post_group *group = &analysis->group[g];
    char              name[64];
    post_group_name(group, name);
    post_put(out, "%s{\"kind\":\"%s\",\"rank\":%d,\"n0\":", g ? "," : "", kind[group->kind],
             group->rank);
    put_value(out, group->n0);
    post_put(out, ",\"name\":");
    post_put_json(out, name);
    post_put(out, "}");
  }
}

static void put_abscissa(const post_abscissa *x, post_buffer *out) {
  post_put(out,
           "{\"parameter\":\"%s\",\"name\":\"%s\",\"unit\":\"%s\",\"scale\":%g,\"log\":%s,"
           "\"range\":[%.9g,%.9g]}",
           mhb_parameter_name(x->parameter), x->name, x->unit.name, x->unit.scale,
           x->log ? "true" : "false", x->range[0], x->range[1]);
}

/* ---------------------------------------------------------------- document */

typedef struct {
  const char *word;
  int         code;
} code;

static void put_code(post_buffer *out, const char *name, int n, const code *list) {
  post_put(out, "\"%s\":{", name);
  for (int i = 0; i < n; i++)
    post_put(out, "%s\"%s\":%d", i ? "," : "", list[i].word, list[i].code);
  post_put(out, "}");
}

/* What numbers mean: rows of the curves, columns of lists, codes. */
static void put_meaning(post_buffer *out) {
  static const code stability[] = {{"stable", POST_VERDICT_STABLE},
                                   {"not judged", POST_VERDICT_NOT_JUDGED},
                                   {"modulated", POST_VERDICT_MODULATED},
                                   {"never seen", POST_VERDICT_NEVER_SEEN}};
  static const code special[]   = {{"fold", MHB_FOLD},
                                   {"peak", MHB_PEAK},
                                   {"flip", MHB_FLIP},
                                   {"Neimark-Sacker point", MHB_NEIMARK_SACKER},
                                   {"optimum", MHB_OPTIMUM}};
  static const code mark[]      = {{"aboveTolerance", MHB_ABOVE_TOLERANCE},
                                   {"undetermined", MHB_TRACTION_UNDETERMINED},
                                   {"notJudged", MHB_ERROR_NOT_JUDGED}};
  code              rows[FIXED_ROWS];
  for (int i = 0; i < FIXED_ROWS; i++) rows[i] = (code){row_name[i], i};
  put_code(out, "fields", FIXED_ROWS, rows);
  post_put(out, ",\n\"codes\":{");
  put_code(out, "stability", 4, stability);
  post_put(out, ",");
  put_code(out, "special", 5, special);
  post_put(out, ",");
  put_code(out, "mark", 3, mark);
  post_put(out,
           "},\n\"columns\":{"
           "\"track\":[\"group\",\"n0\",\"amplitude\",\"at\",\"edge\",\"doubtful\","
           "\"stuck\",\"slipping\",\"open\",\"dissipation\"],"
           "\"peak\":[\"group\",\"at\",\"amplitude\"],"
           "\"resonance\":[\"n0\",\"at\",\"amplitude\"],"
           "\"lasting\":[\"at\",\"mean\",\"worst\"]}");
}

/* Numbers of the other charts. */
static shb_status put_parts(const post_analysis *analysis, const post_blade_view *blade,
                            post_buffer *out) {
  const mhb_response *r = analysis->response;
  post_put(out, ",\n\"axes\":{\"psi\":%.9g,\"phi\":%.9g}", r->psi, r->phi);
  post_put_blades(r, out);
  post_put_factors(r->samples, out);
  if (analysis->safe) post_safe_data(analysis->safe, out);
  if (!blade) return SHB_OK;
  post_put(out, ",\n\"blade\":");
  return post_blade_data(analysis, blade, out);
}

static shb_status put_all(const post_analysis *analysis, int chosen, const post_blade_view *blade,
                          sheet *sheets, post_buffer *out, int *left_out) {
  int  stride = 1 + LEAST_ROWS * analysis->n_points / (BUDGET + 1);
  plan p      = make_plan(analysis->response, analysis->n_points / stride);
  *left_out   = p.left_out;
  for (int b = 0; b < analysis->response->n_branches; b++)
    SHB_TRY(make_sheet(analysis, b, p.rows, stride, &sheets[b]));
  post_put(out, "{\"format\":\"%s\",\"version\":%d,\n", format, VERSION);
  put_meaning(out);
  post_put(out, ",\n\"rows\":%d,\"chosen\":%d,\"log\":%s,\"abscissa\":", p.rows, chosen,
           post_amplitude_is_log(analysis) ? "true" : "false");
  put_abscissa(&analysis->abscissa, out);
  if (analysis->response->run_up && analysis->response->engine_order > 0)
    post_put(out, ",\"rpm\":%.9g", 60.0 / analysis->response->engine_order);
  post_put(out, ",\"groups\":[");
  put_groups(analysis, out);
  post_put(out, "],\"outputs\":[");
  SHB_TRY(put_columns(analysis, &p, false, sheets, out));
  post_put(out, "],\"spectra\":[");
  SHB_TRY(put_columns(analysis, &p, true, sheets, out));
  post_put(out, "]");
  SHB_TRY(put_curves(analysis, p.rows, sheets, out));
  SHB_TRY(put_parts(analysis, blade, out));
  post_put(out, "}");
  return SHB_OK;
}

shb_status post_page_data(const post_analysis *analysis, int chosen, const post_blade_view *blade,
                          post_buffer *out, int *left_out) {
  int    n      = analysis->response->n_branches;
  sheet *sheets = calloc((size_t)n + 1, sizeof *sheets);
  SHB_CHECK(sheets, SHB_ERR_IO, "not enough memory for the report");
  shb_status status = put_all(analysis, chosen, blade, sheets, out, left_out);
  for (int b = 0; b < n; b++) {
    free(sheets[b].kept);
    free(sheets[b].data);
  }
  free(sheets);
  return status;
}
