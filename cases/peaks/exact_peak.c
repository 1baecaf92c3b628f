#include "cases/peaks/exact_peak.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases/peaks/fine_curve.h"
#include "mesh/base/constants.h"
#include "postproc/analysis/response_analysis.h"

/* A smooth peak is at most this much higher than the sample beside it. */
static const double RISE = 1.06;
/* A peak changes by no more than this from 9 to 17 harmonics, or else it is another one. */
static const double CHANGE = 0.1;
/* Peaks this close to the highest are solved with more harmonics too. */
static const double RIVAL = 0.03;
/* Points of the coarse curve without a fine solution may be this part of the peak. */
static const double MISSED = 0.9;
/* Width of the last bracket; the whole bracket is 2. A smooth peak is then exact to 1e-8. */
static const double WIDTH  = 1e-4;
static const double GOLDEN = 0.3819660112501051;
/* A point this near to an end of the range is on it, relative. */
static const double AT_END = 1e-9;
/* The frequency of a smooth peak is within this of the maximum found by comparison, relative. */
static const double BESIDE = 1e-3;
enum { MOST_SOLUTIONS = 30 };
/* Harmonics beyond these are not looked at for the error. */
enum { MOST_BEYOND = 64 };

enum { N_LEVELS = 3 };
static const int levels[N_LEVELS] = {9, 17, 31};

typedef struct {
  const modal_model  *model;
  const mhb_settings *settings;
  mhb_response       *response;
  post_output         output;
  exact_peak_asked    asked;
  int                 first; /* of the levels: the samples' */
} work;

/* A maximum and how it is solved with one number of harmonics. */
typedef struct {
  const fine_maximum *fine;
  int                 harmonics; /* of the balance */
  point_matcher      *matcher;
  double              t;        /* place in the bracket: 0 before, 1 at, 2 after */
  double              found[2]; /* Hz, m: of the best solution so far */
  double              drop;     /* m, from the maximum to the lower end of the last bracket */
} maximum;

/* ---------------------------------------------------------------- by comparison */

/* Amplitude at t; -1: no solution. */
static double solve(maximum *m, double t) {
  const fine_maximum           *f        = m->fine;
  const matched_solution *const chord[2] = {&f->before, &f->after};
  const matched_solution *from = t < 1 ? &f->before : &f->at, *to = t < 1 ? &f->at : &f->after;
  double                  found[2];
  if (!point_matcher_between(m->matcher, from, to, t < 1 ? t : t - 1, chord, found)) return -1;
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

/* Maximise over a bracket: places t[3] and amplitudes a[3] there. */
static void maximise(maximum *m, double t[3], double a[3]) {
  double before = t[2] - t[0];
  for (int n = 0; n < MOST_SOLUTIONS && t[2] - t[0] > WIDTH; n++) {
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
}

/* ---------------------------------------------------------------- by its own equations */

/* A smooth peak between the samples, no lower than a solution of this amplitude. */
static mhb_peak_near between_samples(const fine_maximum *f) {
  const double a = f->before.omega, b = f->at.omega, c = f->after.omega;
  const double low = fmin(a, fmin(b, c)), high = fmax(a, fmax(b, c)), room = 0.5 * (high - low);
  return (mhb_peak_near){{low - room, high + room}, {1 - 1e-9, RISE}, false, true};
}

/* Between this solution and that at any place near it. */
static int solve_beside(const maximum *m, const matched_solution *from) {
  const matched_solution *const chord[2] = {&m->fine->before, &m->fine->after};
  double                        found[2];
  return point_matcher_between(m->matcher, from, from, 0, chord, found);
}

/* The maximum between the samples, solved with their harmonics. The matcher is left there.
 *   solution  out  kept there; its x is NULL if there is none
 *   by        out  its kind and, where it is known, frequency and amplitude */
static shb_status solve_first(maximum *m, matched_solution *solution, mhb_peak_derivatives *by) {
  mhb_peak_near near = between_samples(m->fine);
  double        solved[2];
  near.smooth_only = true; /* a sample is hardly ever at a corner */
  m->t             = 1;
  m->drop          = 0;
  m->found[1]      = -1;
  if (solve(m, 1) < 0) return SHB_OK;
  SHB_TRY(point_matcher_peak(m->matcher, near, by, m->found));
  if (by->kind == MHB_PEAK_SMOOTH) return point_matcher_keep(m->matcher, solution);
  m->found[1] = -1;
  double t[3] = {0, 1, 2}, a[3] = {m->fine->beside[0], m->fine->found[1], m->fine->beside[1]};
  maximise(m, t, a);
  if (solve(m, m->t) < 0) return SHB_OK;
  SHB_TRY(point_matcher_keep(m->matcher, solution));
  SHB_TRY(point_matcher_peak(m->matcher, between_samples(m->fine), by, solved));
  if (by->kind != MHB_PEAK_SMOOTH && !solve_beside(m, solution)) matched_solution_free(solution);
  return SHB_OK;
}

/* ---------------------------------------------------------------- its numbers */

static void no_errors(exact_peak *peak) {
  peak->frequency_error = peak->amplitude_error = NAN;
  peak->peak_to_peak_error = peak->rss_error = peak->dissipation_error = NAN;
  for (int i = 0; i < STUDY_MAX_OUTPUTS; i++) peak->field[i] = peak->field_error[i] = NAN;
}

/* Numbers at a point of a branch. */
static shb_status describe(const work *w, mhb_response *response, int branch, int point,
                           exact_peak *peak) {
  const mhb_branch *b     = &response->branch[branch];
  double           *value = NULL, *rss = NULL;
  SHB_TRY(post_series(response, b, w->output, POST_QUANTITY_PEAK_TO_PEAK, &value));
  shb_status status  = post_series(response, b, w->output, POST_QUANTITY_RSS, &rss);
  peak->found        = true;
  peak->frequency    = b->frequency[point];
  peak->amplitude    = post_amplitude(response, b, point, w->output, post_first_harmonic(b));
  peak->peak_to_peak = value[point];
  peak->rss          = status == SHB_OK ? rss[point] : NAN;
  peak->dissipation  = post_dissipation(response, b, point);
  free(value);
  free(rss);
  if (!w->asked.field) return status;
  return peak_field_evaluate(w->asked.field, w->model, w->settings, response, branch, point,
                             peak->field);
}

/* Numbers at the solution that the matcher found last. */
static shb_status describe_solution(const work *w, const maximum *m, exact_peak *peak) {
  mhb_response *one              = mhb_response_like(w->response);
  const int     index            = mhb_response_branch(one, MHB_BRANCH_NONLINEAR);
  one->branch[index].order       = m->fine->branch->order;
  one->branch[index].n_harmonics = m->harmonics;
  shb_status status              = point_matcher_record(m->matcher, one, index);
  if (status == SHB_OK) status = describe(w, one, index, 0, peak);
  mhb_response_destroy(one);
  return status;
}

static shb_status matcher_for(const work *w, maximum *m, int harmonics) {
  mhb_settings settings = *w->settings;
  settings.subharmonics = m->fine->branch->order;
  m->harmonics          = fine_harmonics(w->settings, m->fine->branch, harmonics);
  return point_matcher_create(w->model, &settings, m->harmonics, w->output, &m->matcher);
}

/* The numbers of a peak whose solution the matcher found last. */
static shb_status describe_peak(const work *w, const maximum *m, const mhb_peak_derivatives *by,
                                exact_peak *peak) {
  SHB_TRY(describe_solution(w, m, peak));
  peak->by = *by;
  if (by->kind == MHB_PEAK_UNJUDGED) return SHB_OK;
  peak->amplitude = by->amplitude;
  peak->frequency = by->omega / SHB_TWO_PI;
  return SHB_OK;
}

/* Move a bracket by twice its longer step towards its higher end. False: no solution there. */
static bool move_bracket(maximum *m, double t[3], double a[3]) {
  const int    end = a[0] > a[2] ? 0 : 2, other = 2 - end;
  const double to = t[end] + 2 * (t[end] - t[1]);
  t[other]        = t[1];
  a[other]        = a[1];
  t[1]            = t[end];
  a[1]            = a[end];
  t[end]          = to;
  a[end]          = solve(m, to);
  return a[end] >= 0;
}

/* Maximise near samples of fewer harmonics. False: no maximum is found there. */
static bool maximise_anew(maximum *m) {
  enum { MOST_MOVES = 4 };
  double t[3] = {0, 1, 2}, a[3];
  m->found[1] = -1;
  for (int i = 0; i < 3; i++) a[i] = solve(m, t[i]);
  if (fmin(a[0], fmin(a[1], a[2])) < 0) return false;
  for (int i = 0; i < MOST_MOVES && a[1] < fmax(a[0], a[2]); i++)
    if (!move_bracket(m, t, a)) return false;
  if (a[1] < fmax(a[0], a[2])) return false;
  maximise(m, t, a);
  return solve(m, m->t) > 0;
}

/* The peak near a solution, with the harmonics of the matcher, and its numbers. */
static shb_status solve_near_solution(const work *w, maximum *m, const matched_solution *from,
                                      exact_peak *peak, matched_solution *solution) {
  mhb_peak_derivatives by;
  double               solved[2];
  *peak = (exact_peak){.stable = -1};
  no_errors(peak);
  if (!solve_beside(m, from)) return SHB_OK;
  SHB_TRY(point_matcher_peak(m->matcher, between_samples(m->fine), &by, solved));
  bool there = by.kind == MHB_PEAK_SMOOTH;
  if (by.kind == MHB_PEAK_UNJUDGED && maximise_anew(m)) {
    SHB_TRY(point_matcher_keep(m->matcher, solution));
    mhb_peak_near near = between_samples(m->fine);
    near.omega[0]      = fmin(near.omega[0], SHB_TWO_PI * m->found[0] * (1 - BESIDE));
    near.omega[1]      = fmax(near.omega[1], SHB_TWO_PI * m->found[0] * (1 + BESIDE));
    SHB_TRY(point_matcher_peak(m->matcher, near, &by, solved));
    there = by.kind == MHB_PEAK_SMOOTH || solve_beside(m, solution);
  }
  if (!there && !solve_beside(m, from)) return SHB_OK;
  SHB_TRY(point_matcher_keep(m->matcher, solution));
  return describe_peak(w, m, &by, peak);
}

/* ---------------------------------------------------------------- errors */

/* The change from fewer harmonics. */
static void set_errors(exact_peak *peak, const exact_peak *fewer) {
  peak->frequency_error    = fabs(fewer->frequency - peak->frequency);
  peak->amplitude_error    = fabs(fewer->amplitude - peak->amplitude);
  peak->peak_to_peak_error = fabs(fewer->peak_to_peak - peak->peak_to_peak);
  peak->rss_error          = fabs(fewer->rss - peak->rss);
  peak->dissipation_error  = fabs(fewer->dissipation - peak->dissipation);
  for (int i = 0; i < STUDY_MAX_OUTPUTS; i++)
    peak->field_error[i] = fabs(fewer->field[i] - peak->field[i]);
}

/* A peak found by comparison is too low by at most this, and so is a corner. */
static void add_drop(exact_peak *peak, double drop) {
  if (peak->by.kind != MHB_PEAK_UNJUDGED && peak->by.kind != MHB_PEAK_CORNER) drop = 0;
  peak->amplitude_error = drop + (isnan(peak->amplitude_error) ? 0 : peak->amplitude_error);
  for (int i = 0; i < STUDY_MAX_OUTPUTS; i++)
    peak->field_error[i] += fabs(peak->field[i]) * drop / peak->amplitude;
}

/* ---------------------------------------------------------------- one maximum */

/* One maximum on its way: its peak with the harmonics of the samples, then with more. */
typedef struct {
  exact_peak       peak;
  double           amplitude; /* m, with those of the samples; -1: not solved */
  double           drop;
  int              harmonics; /* of the peak; 0: those of the case */
  matched_solution solution;
} candidate;

/* The amplitude's change by the harmonics of the next level, or twice as many after the last one,
 * by one linearisation, m. NAN: not known. */
static shb_status change_beyond(const work *w, const fine_maximum *f, int level,
                                const matched_solution *at, double *change) {
  maximum   m    = {.fine = f};
  const int more = level + 1 < N_LEVELS ? levels[level + 1] : 2 * levels[level];
  *change        = NAN;
  if (!at->x || more * f->branch->order > MOST_BEYOND) return SHB_OK;
  SHB_TRY(matcher_for(w, &m, more));
  const shb_status status = point_matcher_change(m.matcher, at, change);
  point_matcher_destroy(m.matcher);
  return status;
}

/* The error with the harmonics of a level, m. The change from fewer is that of these, and may be
 * small by chance. It falls with the fourth power of the harmonics: a kink of the force has
 * harmonics as k^-2, the motion as k^-4. */
static double error_of(int level, double fewer, double beyond) {
  const double part = pow((double)levels[level - 1] / levels[level], 4);
  return isfinite(beyond) ? fmax(beyond, part * fewer) : fewer;
}

/* The amplitude's error. What the harmonics beyond change is that of a smooth peak: the frequency
 * of another one moves.
 *   fewer  in   m, the change from fewer
 *   known  out  false: it is that change, which may be small by chance */
static shb_status estimate(const work *w, const fine_maximum *f, int level, double fewer,
                           const matched_solution *at, exact_peak *peak, bool *known) {
  const bool smooth = peak->by.kind == MHB_PEAK_SMOOTH;
  double     beyond;
  SHB_TRY(change_beyond(w, f, level, at, &beyond));
  *known                = !smooth || isfinite(beyond);
  peak->amplitude_error = smooth ? error_of(level, fewer, beyond) : fmax(fewer, beyond);
  return SHB_OK;
}

/* With as many harmonics as the tolerance of the case asks for. */
static shb_status settle(const work *w, const fine_maximum *f, candidate *c) {
  bool settled = false, known = true;
  for (int level = w->first + 1; level < N_LEVELS && !settled; level++) {
    maximum          m      = {.fine = f};
    exact_peak       more   = {0};
    matched_solution at     = {0};
    shb_status       status = matcher_for(w, &m, levels[level]);
    if (status == SHB_OK) status = solve_near_solution(w, &m, &c->solution, &more, &at);
    point_matcher_destroy(m.matcher);
    if (more.found && fabs(more.amplitude / c->peak.amplitude - 1) < CHANGE) {
      set_errors(&more, &c->peak);
      status = estimate(w, f, level, more.amplitude_error, &at, &more, &known);
      add_drop(&more, c->drop);
      more.exact   = true;
      c->peak      = more;
      c->harmonics = levels[level];
      settled      = known && more.amplitude_error < w->settings->motion_tolerance * more.amplitude;
      matched_solution_free(&c->solution);
      c->solution = at;
    } else {
      matched_solution_free(&at);
      settled = true; /* the error stays unknown, or is that of fewer */
      if (!known) c->peak.amplitude_error = NAN;
    }
    SHB_TRY(status);
  }
  return SHB_OK;
}

/* What is wanted besides at the highest peak alone: multipliers, derivatives. */
static shb_status add_asked(const work *w, const fine_maximum *f, const candidate *c,
                            exact_peak *peak) {
  mhb_peak_near near   = between_samples(f);
  maximum       m      = {.fine = f};
  const bool    judged = peak->by.kind != MHB_PEAK_UNJUDGED;
  double        solved[2];
  near.no_derivatives = false;
  if (!c->solution.x || !(w->asked.multipliers || (w->asked.derivatives && judged))) return SHB_OK;
  SHB_TRY(matcher_for(w, &m, c->harmonics));
  shb_status status = SHB_OK;
  if (w->asked.multipliers && solve_beside(&m, &c->solution))
    status = point_matcher_judge(m.matcher, &peak->stable);
  if (status == SHB_OK && w->asked.derivatives && judged && solve_beside(&m, &c->solution))
    status = point_matcher_peak(m.matcher, near, &peak->by, solved);
  point_matcher_destroy(m.matcher);
  return status;
}

/* One level of an end of a branch. False: it has no solution. */
static shb_status settle_edge_at(const work *w, const fine_maximum *f, int level, bool fixed,
                                 const curve_place *place, candidate *c, bool *good) {
  maximum          m     = {.fine = f};
  exact_peak       fewer = c->peak;
  matched_solution at    = {0};
  double           found[2], beyond = NAN;
  SHB_TRY(matcher_for(w, &m, fixed ? 0 : levels[level]));
  *good             = point_matcher_solve(m.matcher, place, true, found);
  shb_status status = *good ? describe_solution(w, &m, &c->peak) : SHB_OK;
  if (*good && status == SHB_OK) status = point_matcher_keep(m.matcher, &at);
  if (*good && w->asked.multipliers && status == SHB_OK)
    status = point_matcher_judge(m.matcher, &c->peak.stable);
  point_matcher_destroy(m.matcher);
  if (*good && !fixed && status == SHB_OK) status = change_beyond(w, f, level, &at, &beyond);
  matched_solution_free(&at);
  if (!*good || level == w->first) return status;
  set_errors(&c->peak, &fewer);
  c->peak.amplitude_error = error_of(level, c->peak.amplitude_error, beyond);
  return status;
}

/* The end of a branch, solved again at its frequency; without a solution the coarse point is
 * taken. */
static shb_status settle_edge(const work *w, const fine_maximum *f, int point, int fixed,
                              candidate *c) {
  const curve_place place = {f->branch, point, point, point, point, 0};
  bool              good  = true;
  c->peak.edge            = true;
  c->peak.stable          = -1;
  SHB_TRY(describe(w, w->response, (int)(f->branch - w->response->branch), point, &c->peak));
  for (int level = w->first; level < (fixed ? w->first + 1 : N_LEVELS) && good; level++) {
    SHB_TRY(settle_edge_at(w, f, level, fixed, &place, c, &good));
    c->peak.exact = c->peak.exact || good;
    if (c->peak.amplitude_error < w->settings->motion_tolerance * c->peak.amplitude) break;
  }
  c->amplitude = c->peak.amplitude;
  return SHB_OK;
}

/* -1: a frequency, Hz, lies within the range. Else the point of the branch at that end of the
 * range, nearest to the maximum. */
static int end_beyond(const work *w, const fine_maximum *f, double frequency) {
  const double *range = w->settings->frequency;
  const int     n     = f->branch->n_points;
  if (frequency >= range[0] && frequency <= range[1]) return -1;
  const double to = frequency < range[0] ? range[0] : range[1];
  for (int away = 0; away < n; away++)
    for (int sense = -1; sense <= 1; sense += 2) {
      const int i = f->point + sense * away;
      if (i >= 0 && i < n && fabs(f->branch->frequency[i] - to) <= AT_END * to) return i;
    }
  return f->point;
}

/* With the harmonics of the samples.
 *   most  in  the highest peak so far: one that is no rival gets no numbers but its amplitude */
static shb_status begin(const work *w, const fine_maximum *f, int fixed, double most,
                        candidate *c) {
  maximum              m  = {.fine = f};
  mhb_peak_derivatives by = {.kind = MHB_PEAK_UNJUDGED};
  c->amplitude            = -1;
  c->peak.stable          = -1;
  no_errors(&c->peak);
  if (f->edge) return settle_edge(w, f, f->point, fixed, c);
  c->harmonics = fixed ? 0 : levels[w->first];
  SHB_TRY(matcher_for(w, &m, c->harmonics));
  shb_status status = solve_first(&m, &c->solution, &by);
  const bool smooth = by.kind != MHB_PEAK_UNJUDGED;
  const int  end =
      c->solution.x ? end_beyond(w, f, smooth ? by.omega / SHB_TWO_PI : m.found[0]) : -1;
  if (status == SHB_OK && end >= 0) {
    point_matcher_destroy(m.matcher);
    matched_solution_free(&c->solution);
    return settle_edge(w, f, end, fixed, c);
  }
  if (status == SHB_OK && c->solution.x) {
    c->amplitude = by.kind == MHB_PEAK_UNJUDGED ? m.found[1] : by.amplitude;
    /* beside a corner the law may go on a little higher, and Newton's method not reach the top */
    c->drop = by.kind == MHB_PEAK_CORNER ? fmax(0, m.found[1] - by.amplitude) : m.drop;
    if (c->amplitude >= (1 - RIVAL) * most) {
      status        = describe_peak(w, &m, &by, &c->peak);
      c->peak.exact = true;
      if (fixed) add_drop(&c->peak, c->drop); /* that of the harmonics is not known */
    }
  }
  point_matcher_destroy(m.matcher);
  return status;
}

/* ---------------------------------------------------------------- the highest */

/* The highest point of the coarse curve, where no fine one was found. */
static shb_status describe_coarse(const work *w, exact_peak *peak) {
  int    branch = -1, point = 0;
  double most = -1;
  for (int k = 0; k < w->response->n_branches; k++) {
    const mhb_branch *b = &w->response->branch[k];
    for (int i = 0; i < b->n_points && b->kind == MHB_BRANCH_NONLINEAR; i++) {
      double a = post_amplitude(w->response, b, i, w->output, post_first_harmonic(b));
      if (a <= most) continue;
      most   = a;
      branch = k;
      point  = i;
    }
  }
  if (branch < 0) return SHB_OK;
  peak->edge = point == 0 || point == w->response->branch[branch].n_points - 1;
  return describe(w, w->response, branch, point, peak);
}

/* Whether the highest peak is one that was walked to from another design, found anew or not. */
static bool is_walked(const fine_maxima *maxima, const candidate *c, int best) {
  static const double same = 1e-6;
  for (int i = 0; i < maxima->n; i++)
    if (maxima->list[i].walked && c[i].peak.amplitude >= (1 - same) * c[best].peak.amplitude)
      return true;
  return false;
}

/* Copy the solution of a peak to where it is asked for; without one nothing is done. */
static void give_solution(const work *w, const fine_maximum *f, const candidate *c) {
  solved_peak *out  = w->asked.solution;
  size_t       size = 3 * (size_t)w->model->n_pairs * (1 + 2 * (size_t)c->solution.harmonics);
  matched_solution_free(&out->solution);
  if (!c->solution.x) return;
  double *x = malloc(size * sizeof *x);
  if (!x) return;
  memcpy(x, c->solution.x, size * sizeof *x);
  *out            = (solved_peak){.order = f->branch->order, .amplitude = c->peak.amplitude};
  out->solution   = c->solution;
  out->solution.x = x;
  peak_walk_values(w->settings, out->value);
}

static shb_status choose(const work *w, const fine_maxima *maxima, candidate *c, exact_peak *peak) {
  int    fixed = w->settings->motion_tolerance > 0 ? 0 : w->settings->harmonics, best = -1;
  double most = -1;
  for (int i = 0; i < maxima->n; i++) {
    SHB_TRY(begin(w, &maxima->list[i], fixed, most, &c[i]));
    most = fmax(most, c[i].amplitude);
  }
  for (int i = 0; i < maxima->n; i++) {
    if (c[i].amplitude < 0 || c[i].amplitude < (1 - RIVAL) * most) continue;
    if (!c[i].peak.edge && !fixed) SHB_TRY(settle(w, &maxima->list[i], &c[i]));
    if (!c[i].peak.found || c[i].peak.amplitude <= peak->amplitude) continue;
    *peak = c[i].peak;
    best  = i;
  }
  if (best >= 0) peak->walked = is_walked(maxima, c, best);
  if (best >= 0 && w->asked.solution) give_solution(w, &maxima->list[best], &c[best]);
  if (best >= 0) SHB_TRY(add_asked(w, &maxima->list[best], &c[best], peak));
  if (!peak->found) SHB_TRY(describe_coarse(w, peak));
  peak->missed  = maxima->missed;
  peak->high[0] = maxima->high[0];
  peak->high[1] = maxima->high[1];
  if (maxima->missed > (peak->walked ? 1 : MISSED) * peak->amplitude) peak->doubt = true;
  return SHB_OK;
}

/* The samples have as many harmonics as the coarse curve, but one level is left for the error. */
static int first_level(int harmonics) {
  int level = 0;
  while (level < N_LEVELS - 2 && harmonics > levels[level]) level++;
  return level;
}

shb_status exact_peak_find(const modal_model *model, const mhb_settings *settings,
                           mhb_response *response, post_output output, exact_peak_asked asked,
                           exact_peak *peak) {
  const work  w     = {model, settings, response, output, asked, first_level(asked.harmonics)};
  int         first = settings->motion_tolerance > 0 ? levels[w.first] : 0;
  fine_maxima maxima;
  *peak = (exact_peak){.amplitude = -1, .stable = -1};
  no_errors(peak);
  shb_status status =
      fine_maxima_find(model, settings, response, output, first, asked.hasty, &maxima);
  if (status == SHB_OK && asked.walked)
    status = fine_maxima_append(response, asked.walked, &maxima);
  candidate *c = calloc((size_t)maxima.n + 1, sizeof *c);
  if (status == SHB_OK && !c) status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  if (status == SHB_OK) status = choose(&w, &maxima, c, peak);
  for (int i = 0; c && i < maxima.n; i++) matched_solution_free(&c[i].solution);
  free(c);
  fine_maxima_free(&maxima);
  return status;
}
