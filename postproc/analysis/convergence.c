#include "postproc/analysis/convergence.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *post_ladder_name(post_ladder ladder) {
  static const char *const name[POST_N_LADDERS] = {
      "harmonics", "auto", "accuracy", "modes", "modes, no residual", "mesh", "together", "points"};
  return name[ladder];
}

post_rung *post_convergence_add(post_convergence *s) {
  if (s->n == s->capacity) {
    int        room  = s->capacity ? 2 * s->capacity : 32;
    post_rung *grown = realloc(s->rung, (size_t)room * sizeof *grown);
    if (!grown) return NULL;
    s->rung     = grown;
    s->capacity = room;
  }
  post_rung *r = &s->rung[s->n++];
  *r           = (post_rung){.seconds = NAN, .total = NAN, .memory = NAN, .unknowns = NAN};
  r->peak = r->frequency = r->curve = r->integration = NAN;
  return r;
}

void post_convergence_free(post_convergence *s) {
  free(s->rung);
  free(s->note);
  *s = (post_convergence){0};
}

double post_rung_error(const post_rung *r) {
  if (isnan(r->peak) || isnan(r->frequency) || isnan(r->curve)) return NAN;
  return fmax(r->peak, fmax(r->frequency, r->curve));
}

bool post_rung_meets(const post_convergence *s, const post_rung *r) {
  return r->state == POST_RUNG_DONE && !r->reference && post_rung_error(r) <= s->tolerance;
}

int post_cheapest(const post_convergence *s, post_ladder ladder) {
  int best = -1;
  for (int i = 0; i < s->n; i++) {
    const post_rung *r = &s->rung[i];
    if (r->ladder != ladder || !post_rung_meets(s, r)) continue;
    if (best < 0 || r->seconds < s->rung[best].seconds) best = i;
  }
  return best;
}

int post_reference(const post_convergence *s, post_ladder ladder) {
  for (int i = 0; i < s->n; i++)
    if (s->rung[i].ladder == ladder && s->rung[i].reference) return i;
  return -1;
}

/* ---------------------------------------------------------------- table */

static void put_seconds(post_buffer *out, double seconds) {
  if (isnan(seconds)) {
    post_put(out, " %9s", "-");
  } else {
    post_put(out, " %9.*f", seconds < 10 ? 3 : seconds < 100 ? 2 : 1, seconds);
  }
}

static void put_error(post_buffer *out, double error) {
  if (isnan(error)) {
    post_put(out, " %9s", "-");
  } else {
    post_put(out, " %9.1e", error);
  }
}

static const char *verdict(const post_convergence *s, const post_rung *r) {
  if (r->state == POST_RUNG_WAITING) return "not run";
  if (r->state == POST_RUNG_FAILED) return "failed";
  if (r->state == POST_RUNG_INCOMPLETE) return r->reference ? "reference, gap" : "no, gap";
  if (r->reference) return "reference";
  if (isnan(post_rung_error(r))) return "-";
  return post_rung_meets(s, r) ? "yes" : "no";
}

static void put_row(const post_convergence *s, const post_rung *r, bool first, post_buffer *out) {
  post_put(out, "%-18s  %s", first ? post_ladder_name(r->ladder) : "", r->name);
  int width = (int)strlen(r->name) + 2 * r->of_case;
  post_put(out, "%s%*s", r->of_case ? " *" : "", width < 26 ? 26 - width : 0, "");
  if (isnan(r->unknowns)) {
    post_put(out, " %9s", "-");
  } else {
    post_put(out, " %9.0f", r->unknowns);
  }
  put_seconds(out, r->seconds);
  put_seconds(out, r->total);
  if (isnan(r->memory)) {
    post_put(out, " %7s", "-");
  } else {
    post_put(out, " %7.0f", 1e-6 * r->memory);
  }
  if (r->reference) {
    post_put(out, " %9s %9s %9s", "0", "0", "0");
  } else {
    put_error(out, r->peak);
    put_error(out, r->frequency);
    put_error(out, r->curve);
  }
  if (s->n_points > 0) put_error(out, r->integration);
  post_put(out, "  %s\n", verdict(s, r));
}

void post_convergence_table(const post_convergence *s, const char *case_name, post_buffer *out) {
  post_put_printable(out, case_name);
  post_put(out, ": ");
  post_put_printable(out, s->output);
  post_put(out, ", first harmonic, the worst of %d preload%s; tolerance %g %%\n\n", s->n_preloads,
           s->n_preloads == 1 ? "" : "s", 100 * s->tolerance);
  post_put(out, "%-18s  %-26s %9s %9s %9s %7s %9s %9s %9s%s  %s\n", "ladder", "rung", "unknowns",
           "seconds", "total s", "MB", "peak", "frequency", "curve",
           s->n_points > 0 ? "      time" : "", "verdict");
  for (int i = 0; i < s->n; i++) {
    bool first = i == 0 || s->rung[i].ladder != s->rung[i - 1].ladder;
    if (first && i > 0) post_put(out, "\n");
    put_row(s, &s->rung[i], first, out);
  }
  post_put(out,
           "\nseconds: one core, the balance (mesh: with meshing and modes). Errors are relative; "
           "peak, its frequency,\nand distance of the curves: the greater of |ln f/f'| and "
           "|a - a'|/max a. * as in the case.\n");
  if (s->n_points > 0)
    post_put(out,
             "time: |a - a'|/max a at the frequencies of %d points of time integration, against "
             "those.\n",
             s->n_points);
}

/* ---------------------------------------------------------------- conclusion */

static void put_name(const post_rung *r, post_buffer *out) {
  post_put_printable(out, r->name);
}

/* "12 %", "0.034 %" */
static void put_percent(double ratio, post_buffer *out) {
  post_put(out, "%.2g %%", 100 * ratio);
}

static void conclude_ladder(const post_convergence *s, post_ladder ladder, post_buffer *out) {
  int members = 0, compared = 0, best = post_cheapest(s, ladder);
  for (int i = 0; i < s->n; i++) {
    members += s->rung[i].ladder == ladder;
    compared += s->rung[i].ladder == ladder && !isnan(post_rung_error(&s->rung[i]));
  }
  if (members == 0) return;
  int finest = post_reference(s, ladder);
  post_put(out, "%s: ", post_ladder_name(ladder));
  if (best >= 0) {
    const post_rung *r = &s->rung[best];
    put_name(r, out);
    post_put(out, " meets ");
    put_percent(s->tolerance, out);
    post_put(out, " in %.3g s (error ", r->seconds);
    put_percent(post_rung_error(r), out);
    post_put(out, ")");
  } else if (compared == 0) {
    post_put(out, "not compared");
  } else {
    post_put(out, finest >= 0 ? "none below the finest meets " : "none meets ");
    put_percent(s->tolerance, out);
  }
  if (finest >= 0) {
    post_put(out, "; the finest, ");
    put_name(&s->rung[finest], out);
    post_put(out, ", takes %.3g s", s->rung[finest].seconds);
    if (best < 0 && compared > 0) post_put(out, " and is not known to be fine enough");
  }
  post_put(out, "\n");
}

/* Fastest rung of the ladders whose error includes every coarser setting. */
static int cheapest_of_all(const post_convergence *s) {
  static const post_ladder whole[] = {POST_LADDER_HARMONICS, POST_LADDER_AUTO,
                                      POST_LADDER_TOGETHER};
  int                      best    = -1;
  for (int i = 0; i < 3; i++) {
    int candidate = post_cheapest(s, whole[i]);
    if (candidate < 0) continue;
    if (best < 0 || s->rung[candidate].seconds < s->rung[best].seconds) best = candidate;
  }
  return best;
}

/* Compare the finest harmonics with time integration: no harmonic result can tell their error. */
static void conclude_integration(const post_convergence *s, post_buffer *out) {
  int finest = post_reference(s, POST_LADDER_HARMONICS);
  if (s->n_points == 0 || finest < 0 || isnan(s->rung[finest].integration)) return;
  post_put(out, "Time integration: at %d points %s harmonics are within ", s->n_points,
           s->rung[finest].name);
  put_percent(s->rung[finest].integration, out);
  post_put(out, " of the largest amplitude.\n");
}

void post_convergence_conclusion(const post_convergence *s, post_buffer *out) {
  for (int l = 0; l < POST_N_LADDERS; l++)
    if (l != POST_LADDER_TOGETHER) conclude_ladder(s, (post_ladder)l, out);
  conclude_integration(s, out);
  int best = cheapest_of_all(s), finest = post_reference(s, POST_LADDER_HARMONICS);
  if (finest < 0) return;
  if (best < 0) {
    post_put(out, "Nothing meets ");
    put_percent(s->tolerance, out);
    post_put(out, " but the reference itself.\n");
    return;
  }
  const post_rung *r = &s->rung[best], *f = &s->rung[finest];
  post_put(out, "Cheapest that meets ");
  put_percent(s->tolerance, out);
  post_put(out, ": %s%s", r->ladder == POST_LADDER_HARMONICS ? "mhb.harmonics " : "",
           r->ladder == POST_LADDER_AUTO ? "mhb.harmonics auto, " : "");
  put_name(r, out);
  post_put(out, ", %.3g s, error ", r->seconds);
  put_percent(post_rung_error(r), out);
  post_put(out, "; %.2g times less than %s harmonics with all else at its finest, %.3g s.\n",
           f->seconds / r->seconds, f->name, f->seconds);
}

/* ---------------------------------------------------------------- CSV */

static void put_number(post_buffer *out, double value) {
  if (isnan(value)) {
    post_put(out, ",");
  } else {
    post_put(out, ",%.6g", value);
  }
}

void post_convergence_csv(const post_convergence *s, post_buffer *out) {
  static const char *const state[] = {"not run", "complete", "gap", "failed"};
  post_put(out,
           "ladder,rung,of_case,state,unknowns,seconds,total_seconds,memory_bytes,peak_error,"
           "frequency_error,curve_error,integration_error,verdict\r\n");
  for (int i = 0; i < s->n; i++) {
    const post_rung *r = &s->rung[i];
    post_put(out, "\"%s\",\"%s\",%d,%s", post_ladder_name(r->ladder), r->name, r->of_case,
             state[r->state]);
    const double value[] = {r->unknowns, r->seconds,   r->total, r->memory,
                            r->peak,     r->frequency, r->curve, r->integration};
    for (int k = 0; k < 8; k++) put_number(out, value[k]);
    post_put(out, ",%s\r\n",
             r->reference                ? "reference"
             : isnan(post_rung_error(r)) ? ""
             : post_rung_meets(s, r)     ? "yes"
                                         : "no");
  }
}
