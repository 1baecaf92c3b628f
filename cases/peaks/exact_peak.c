#include "cases/peaks/exact_peak.h"

#include <math.h>
#include <stdlib.h>

#include "cases/converge/matched_point.h"
#include "mesh/base/constants.h"
#include "postproc/analysis/response_analysis.h"

/* Peaks of the coarse curve below this part of the highest are not solved again. Three harmonics
 * are 8 % off on z_notch_blade, and up to 20 % at gaps. */
static const double CANDIDATE = 0.7;
/* The bracket of a peak: points on either side that are lower by DROP, at most REACH away. */
static const double DROP = 2e-3;
enum { REACH = 6, MOST_CANDIDATES = 8, MOST_SHIFTS = 6, MOST_SOLUTIONS = 30 };
/* Width of the last bracket; the whole bracket is 2. A smooth peak is then exact to 1e-8. */
static const double WIDTH  = 1e-4;
static const double GOLDEN = 0.3819660112501051;

enum { N_LEVELS = 4 };
static const int levels[N_LEVELS] = {5, 9, 17, 31};

typedef struct {
  const mhb_branch *branch;
  int               point;
  double            amplitude;
} candidate;

/* What is solved again: one output on one branch between three of its points. */
typedef struct {
  point_matcher    *matcher;
  const mhb_branch *branch;
  int               low, middle, high;
  double            t, found[2]; /* of the best solution so far; found: Hz, m */
  double            drop;        /* m, from the maximum to the lower end of the last bracket */
} maximum;

/* ---------------------------------------------------------------- candidates */

static bool is_maximum(int n, const double *a, int i) {
  return (i == 0 || a[i] >= a[i - 1]) && (i == n - 1 || a[i] > a[i + 1]);
}

/* Insert by falling amplitude; the least one drops out of a full list. */
static void insert(candidate list[MOST_CANDIDATES], int *n, candidate one) {
  int at = *n;
  while (at > 0 && list[at - 1].amplitude < one.amplitude) at--;
  if (at == MOST_CANDIDATES) return;
  if (*n < MOST_CANDIDATES) (*n)++;
  for (int i = *n - 1; i > at; i--) list[i] = list[i - 1];
  list[at] = one;
}

static shb_status find_candidates(const mhb_response *response, post_output output,
                                  candidate list[MOST_CANDIDATES], int *n) {
  *n = 0;
  for (int b = 0; b < response->n_branches; b++) {
    const mhb_branch *branch = &response->branch[b];
    double           *a      = NULL;
    if (branch->kind != MHB_BRANCH_NONLINEAR || branch->n_points == 0) continue;
    SHB_TRY(post_series(response, branch, output, POST_QUANTITY_FIRST_HARMONIC, &a));
    for (int i = 0; i < branch->n_points; i++)
      if (is_maximum(branch->n_points, a, i)) insert(list, n, (candidate){branch, i, a[i]});
    free(a);
  }
  while (*n > 1 && list[*n - 1].amplitude < CANDIDATE * list[0].amplitude) (*n)--;
  return SHB_OK;
}

/* ---------------------------------------------------------------- the maximum of one peak */

/* Choose the bracket around the middle point. False: it is an end of the curve. */
static bool bracket(const mhb_response *response, post_output output, maximum *m) {
  const mhb_branch *b   = m->branch;
  double            top = post_amplitude(response, b, m->middle, output, post_first_harmonic(b));
  m->low = m->high = m->middle;
  for (int i = 1; i <= REACH && m->low > 0; i++) {
    m->low--;
    if (post_amplitude(response, b, m->low, output, post_first_harmonic(b)) < (1 - DROP) * top)
      break;
  }
  for (int i = 1; i <= REACH && m->high < b->n_points - 1; i++) {
    m->high++;
    if (post_amplitude(response, b, m->high, output, post_first_harmonic(b)) < (1 - DROP) * top)
      break;
  }
  return m->low < m->middle && m->middle < m->high;
}

/* Amplitude at t, 0 at low, 1 at middle, 2 at high; -1: no solution. */
static double solve(maximum *m, double t) {
  bool        left  = t < 1;
  curve_place place = {m->branch, left ? m->low : m->middle, left ? m->middle : m->high, m->low,
                       m->high,   left ? t : t - 1};
  double      found[2];
  if (!point_matcher_solve(m->matcher, &place, false, found)) return -1;
  if (found[1] > m->found[1]) {
    m->t        = t;
    m->found[0] = found[0];
    m->found[1] = found[1];
  }
  return found[1];
}

/* The vertex of the parabola through three points (t, a); NAN if it is no maximum. */
static double vertex(const double t[3], const double a[3]) {
  double p = (t[1] - t[0]) * (a[1] - a[2]), q = (t[1] - t[2]) * (a[1] - a[0]);
  double at = t[1] - 0.5 * ((t[1] - t[0]) * p - (t[1] - t[2]) * q) / (p - q);
  return isfinite(at) && at > t[0] && at < t[2] ? at : NAN;
}

/* The next t in a bracket: the parabola's vertex, or a golden section after slow progress. */
static double next_place(const double t[3], const double a[3], bool slow) {
  double at   = slow ? NAN : vertex(t, a);
  bool   left = t[1] - t[0] > t[2] - t[1];
  if (isnan(at)) return left ? t[1] - GOLDEN * (t[1] - t[0]) : t[1] + GOLDEN * (t[2] - t[1]);
  double least = 0.3 * WIDTH; /* a vertex at a known point says that the bracket may be closed */
  if (fabs(at - t[1]) < least) at = left ? t[1] - least : t[1] + least;
  return at;
}

/* Keep the part of the bracket that holds the maximum. */
static void shrink(double t[3], double a[3], double at, double value) {
  int side = at > t[1] ? 2 : 0; /* where the new point is */
  if (value > a[1]) {
    int other = 2 - side;
    t[other]  = t[1];
    a[other]  = a[1];
    t[1]      = at;
    a[1]      = value;
  } else {
    t[side] = at;
    a[side] = value;
  }
}

/* Solve at an end of the bracket, 0 or 2; if there is no solution, nearer to the middle. */
static void solve_end(maximum *m, double end, double *t, double *a) {
  enum { MOST_PULLS = 6 };
  *t = end;
  *a = solve(m, *t);
  for (int i = 0; i < MOST_PULLS && *a < 0; i++) {
    *t = 1 + 0.5 * (*t - 1);
    *a = solve(m, *t);
  }
}

/* Solve at a place, or at one nearer to the best so far: Newton's method may fail at a kink. */
static double solve_near(maximum *m, double best, double *at) {
  enum { MOST_TRIALS = 5 };
  double value = solve(m, *at);
  for (int i = 0; i < MOST_TRIALS && value < 0; i++) {
    *at   = best + 0.6 * (*at - best);
    value = solve(m, *at);
  }
  return value;
}

/* Maximise over the bracket. Returns -1 or 1 if the maximum is beyond low or high, 0 if it was
 * found, 2 if a solution is missing. */
static int maximise(maximum *m) {
  double t[3] = {0, 1, 2}, a[3];
  m->found[1] = -1;
  if ((a[1] = solve(m, t[1])) < 0) return 2;
  solve_end(m, 0, &t[0], &a[0]);
  solve_end(m, 2, &t[2], &a[2]);
  if (a[0] < 0 || a[2] < 0) return 2;
  if (a[1] < a[0] || a[1] < a[2]) return a[0] > a[2] ? -1 : 1;
  double before = 2;
  for (int n = 3; n < MOST_SOLUTIONS && t[2] - t[0] > WIDTH; n++) {
    double width = t[2] - t[0];
    double at    = next_place(t, a, width > 0.7 * before);
    before       = width;
    double value = solve_near(m, t[1], &at);
    if (value < 0) break;
    shrink(t, a, at, value);
    /* A smooth maximum is known before its bracket is closed. */
    if (a[1] - fmin(a[0], a[2]) < 1e-9 * a[1]) break;
  }
  m->drop = a[1] - fmin(a[0], a[2]);
  return 0;
}

/* Solve for the maximum near a point; the bracket moves with it. False: not found. */
static bool climb(const mhb_response *response, post_output output, maximum *m) {
  for (int shift = 0; shift < MOST_SHIFTS; shift++) {
    if (!bracket(response, output, m)) return false;
    int side = maximise(m);
    if (side == 0) return true;
    if (side == 2) return false;
    m->middle = side < 0 ? m->low : m->high;
  }
  return false;
}

/* ---------------------------------------------------------------- its numbers */

/* Numbers at a point of a branch. */
static shb_status describe(const mhb_response *response, const mhb_branch *branch, int point,
                           post_output output, exact_peak *peak) {
  double *value = NULL;
  SHB_TRY(post_series(response, branch, output, POST_QUANTITY_PEAK_TO_PEAK, &value));
  peak->frequency    = branch->frequency[point];
  peak->amplitude    = post_amplitude(response, branch, point, output, post_first_harmonic(branch));
  peak->peak_to_peak = value[point];
  peak->dissipation  = post_dissipation(response, branch, point);
  free(value);
  return SHB_OK;
}

typedef struct {
  const modal_model  *model;
  const mhb_settings *settings;
  mhb_response       *response;
  post_output         output;
  double              best; /* m, highest peak so far */
} work;

/* Stress and strain there, where they are asked for. */
static shb_status describe_field(const work *w, mhb_response *response, int branch, int point,
                                 exact_peak_asked asked, exact_peak *peak) {
  for (int i = 0; i < STUDY_MAX_OUTPUTS; i++) peak->field[i] = peak->field_error[i] = NAN;
  if (!asked.field || !(peak->amplitude > w->best)) return SHB_OK;
  return peak_field_evaluate(asked.field, w->model, w->settings, response, branch, point,
                             peak->field);
}

/* Numbers at the solution that the matcher found last. */
static shb_status describe_solution(const work *w, maximum *m, int harmonics,
                                    exact_peak_asked asked, exact_peak *peak) {
  mhb_response *one = mhb_response_like(w->response);
  int           index;
  SHB_CHECK(one, SHB_ERR_IO, "out of memory");
  shb_status status = mhb_response_branch(one, MHB_BRANCH_NONLINEAR, &index);
  if (status == SHB_OK) {
    one->branch[index].order       = m->branch->order;
    one->branch[index].n_harmonics = harmonics;
    status                         = point_matcher_record(m->matcher, one, index);
  }
  if (status == SHB_OK) status = describe(one, &one->branch[index], 0, w->output, peak);
  if (status == SHB_OK) status = describe_field(w, one, index, 0, asked, peak);
  mhb_response_destroy(one);
  return status;
}

/* Solve the peak with a number of harmonics; at: only at this t, NAN: find it. */
static shb_status solve_peak(const work *w, int harmonics, double at, exact_peak_asked asked,
                             maximum *m, exact_peak *peak) {
  mhb_settings settings = *w->settings;
  peak->found           = false;
  settings.subharmonics = m->branch->order;
  SHB_TRY(point_matcher_create(w->model, &settings, harmonics * m->branch->order, w->output,
                               &m->matcher));
  bool       found  = isnan(at) ? climb(w->response, w->output, m) : solve(m, at) >= 0;
  shb_status status = SHB_OK;
  if (found && isnan(at)) found = solve(m, m->t) >= 0; /* the balance is then evaluated there */
  if (found) status = describe_solution(w, m, harmonics * m->branch->order, asked, peak);
  if (status == SHB_OK && found && asked.multipliers)
    status = point_matcher_judge(m->matcher, &peak->stable);
  if (status == SHB_OK && found && asked.derivatives && m->found[1] > w->best)
    status = point_matcher_derivatives(m->matcher, &peak->by);
  point_matcher_destroy(m->matcher);
  m->matcher  = NULL;
  peak->found = found;
  return status;
}

/* The errors by harmonics. */
static void set_errors(exact_peak *peak, const exact_peak *other) {
  for (int i = 0; i < STUDY_MAX_OUTPUTS; i++)
    peak->field_error[i] = fabs(other->field[i] - peak->field[i]);
  peak->frequency_error    = fabs(other->frequency - peak->frequency);
  peak->amplitude_error    = fabs(other->amplitude - peak->amplitude);
  peak->peak_to_peak_error = fabs(other->peak_to_peak - peak->peak_to_peak);
  peak->dissipation_error  = fabs(other->dissipation - peak->dissipation);
}

/* The place of the peak is not exact: the amplitude is too low by at most this. */
static void add_error(exact_peak *peak, double drop) {
  peak->amplitude_error += drop;
  for (int i = 0; i < STUDY_MAX_OUTPUTS; i++)
    peak->field_error[i] += fabs(peak->field[i]) * drop / peak->amplitude;
}

/* Where the derivatives were found, the peak itself was solved by its own equations. */
static bool take_solved(exact_peak *peak) {
  if (peak->by.kind == MHB_PEAK_UNJUDGED) return false;
  add_error(peak, fabs(peak->amplitude - peak->by.amplitude));
  peak->amplitude = peak->by.amplitude;
  peak->frequency = peak->by.omega / SHB_TWO_PI;
  return true;
}

/* With the harmonics of the case, or as many as its tolerance asks for. */
static shb_status refine(const work *w, const candidate *c, exact_peak_asked asked,
                         exact_peak *peak) {
  maximum    m       = {.branch = c->branch, .middle = c->point};
  exact_peak other   = *peak;
  int        fixed   = w->settings->motion_tolerance > 0 ? 0 : w->settings->harmonics;
  bool       settled = false;
  if (fixed) {
    SHB_TRY(solve_peak(w, fixed / c->branch->order > 0 ? fixed / c->branch->order : 1, NAN, asked,
                       &m, &other));
    other.exact           = other.found;
    other.amplitude_error = 0; /* that of the harmonics is not known */
    if (other.found && !take_solved(&other)) add_error(&other, m.drop);
    if (other.found) *peak = other;
    return SHB_OK;
  }
  for (int level = 1; level + 1 < N_LEVELS && !settled; level++) {
    exact_peak more = *peak;
    m.middle        = c->point;
    SHB_TRY(solve_peak(w, levels[level], NAN, asked, &m, &other));
    if (!other.found) return SHB_OK;
    double t = m.t, drop = m.drop;
    SHB_TRY(
        solve_peak(w, levels[level + 1], t, (exact_peak_asked){.field = asked.field}, &m, &more));
    if (more.found) set_errors(&other, &more);
    if (!take_solved(&other)) add_error(&other, drop);
    other.exact = true;
    *peak       = other;
    settled = more.found && other.amplitude_error < w->settings->motion_tolerance * peak->amplitude;
  }
  return SHB_OK;
}

shb_status exact_peak_find(const modal_model *model, const mhb_settings *settings,
                           mhb_response *response, post_output output, exact_peak_asked asked,
                           exact_peak *peak) {
  work      w = {model, settings, response, output, 0};
  candidate list[MOST_CANDIDATES];
  int       n;
  *peak = (exact_peak){.amplitude = -1};
  SHB_TRY(find_candidates(response, output, list, &n));
  for (int i = 0; i < n; i++) {
    exact_peak        one = {.found              = true,
                             .frequency_error    = NAN,
                             .amplitude_error    = NAN,
                             .peak_to_peak_error = NAN,
                             .dissipation_error  = NAN,
                             .stable             = -1};
    const mhb_branch *b   = list[i].branch;
    SHB_TRY(describe(response, b, list[i].point, output, &one));
    one.edge = list[i].point == 0 || list[i].point == b->n_points - 1;
    SHB_TRY(describe_field(&w, response, (int)(b - response->branch), list[i].point,
                           one.edge ? asked : (exact_peak_asked){0}, &one));
    if (!one.edge) SHB_TRY(refine(&w, &list[i], asked, &one));
    if (one.amplitude > peak->amplitude) *peak = one;
    w.best = peak->amplitude;
  }
  return SHB_OK;
}
