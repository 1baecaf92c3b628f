#include "cases/peaks/peak_walk.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Parts of the way: of the first step, and of the shortest. */
static const double FIRST_PART = 0.25, SHORTEST_PART = 1. / 512;
/* A step's peak lies this near the solution from which it is found: frequency, amplitude. */
static const double NEAR_OMEGA = 0.02, NEAR_AMPLITUDE = 0.3;
/* Relative distance of the two frequencies whose chord is that of a fixed motion. */
static const double CHORD = 1e-3;

bool peak_walk_values(const mhb_settings *s, double value[PEAK_WALK_VALUES]) {
  const double all[PEAK_WALK_VALUES] = {s->n0[0], s->mu,    s->kv,   s->ku[0],
                                        s->ku[1], s->ku[2], s->scale};
  memcpy(value, all, sizeof all);
  return s->n_preloads == 1 && s->n_interfaces <= 1 && !s->run_up;
}

/* The settings at a part of the way, 0 to 1. */
static mhb_settings between(const mhb_settings *to, const double *from, const double *end,
                            int order, double part) {
  mhb_settings s = *to;
  double       at[PEAK_WALK_VALUES];
  for (int i = 0; i < PEAK_WALK_VALUES; i++) {
    bool factor = from[i] > 0 && end[i] > 0;
    at[i] = factor ? from[i] * pow(end[i] / from[i], part) : from[i] + part * (end[i] - from[i]);
    if (part == 1) at[i] = end[i];
  }
  s.n0[0] = at[0];
  s.mu    = at[1];
  s.kv    = at[2];
  memcpy(s.ku, at + 3, sizeof s.ku);
  s.scale        = at[6];
  s.subharmonics = order;
  return s;
}

/* The same motion at another frequency; x is shared. */
static matched_solution beside(const matched_solution *s, double factor) {
  matched_solution other = *s;
  other.omega *= factor;
  return other;
}

/* Solve the peak near a solution with other settings. True: it is kept in peak. */
static shb_status step(const modal_model *model, const mhb_settings *settings, post_output output,
                       solved_peak *peak, bool *found) {
  matched_solution        start = peak->solution;
  const matched_solution  low = beside(&start, 1 - CHORD), high = beside(&start, 1 + CHORD);
  const matched_solution *chord[2] = {&low, &high};
  mhb_peak_derivatives    by       = {.kind = MHB_PEAK_UNJUDGED};
  point_matcher          *matcher;
  double                  at[2];
  start.n0 = settings->n0[0];
  *found   = false;
  SHB_TRY(point_matcher_create(model, settings, start.harmonics, output, &matcher));
  const mhb_peak_near near   = {{start.omega * (1 - NEAR_OMEGA), start.omega * (1 + NEAR_OMEGA)},
                                {1 - 1e-9, 1 + NEAR_AMPLITUDE},
                                .smooth_only    = true,
                                .no_derivatives = true};
  shb_status          status = SHB_OK;
  if (point_matcher_between(matcher, &start, &start, 0, chord, at))
    status = point_matcher_peak(matcher, near, &by, at);
  *found = status == SHB_OK && by.kind == MHB_PEAK_SMOOTH &&
           fabs(at[1] / peak->amplitude - 1) < NEAR_AMPLITUDE;
  if (*found) {
    peak->amplitude = at[1];
    status          = point_matcher_keep(matcher, &peak->solution);
  }
  point_matcher_destroy(matcher);
  return status;
}

static shb_status copy(const modal_model *model, const solved_peak *from, solved_peak *to) {
  size_t rows    = 3 * (size_t)model->n_pairs,
         size    = rows * (1 + 2 * (size_t)from->solution.harmonics) * sizeof *to->solution.x;
  *to            = *from;
  to->solution.x = malloc(size);
  SHB_CHECK(to->solution.x, SHB_ERR_IO, "out of memory");
  memcpy(to->solution.x, from->solution.x, size);
  return SHB_OK;
}

shb_status peak_walk(const modal_model *model, const mhb_settings *settings, post_output output,
                     const solved_peak *from, solved_peak *arrived) {
  double     end[PEAK_WALK_VALUES], done = 0, part = FIRST_PART;
  shb_status status = SHB_OK;
  bool       found  = true;
  *arrived          = (solved_peak){.order = from->order};
  if (!from->solution.x || !peak_walk_values(settings, end)) return SHB_OK;
  SHB_TRY(copy(model, from, arrived));
  while (status == SHB_OK && done < 1 && part >= SHORTEST_PART) {
    double       next = fmin(1, done + part);
    mhb_settings at   = between(settings, from->value, end, from->order, next);
    status            = step(model, &at, output, arrived, &found);
    done              = found ? next : done;
    part *= found ? 2 : 0.5;
  }
  memcpy(arrived->value, end, sizeof end);
  if (done < 1) matched_solution_free(&arrived->solution);
  return status;
}

void solved_peak_free(solved_peak *peak) {
  matched_solution_free(&peak->solution);
}
