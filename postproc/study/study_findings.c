#include "postproc/study/study_findings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "postproc/study/study_effects.h"

enum { MOST_NAMED = 12, MOST_REASONS = 8 };

typedef void (*put_text)(post_buffer *out, const char *text);

/* ---------------------------------------------------------------- pieces of sentences */

static void put_measure(double value, post_unit unit, int digits, post_buffer *out) {
  char number[POST_NUMBER];
  post_put(out, "%s%s%s", post_plain(number, value / unit.scale, digits),
           *unit.name && strcmp(unit.name, "°") != 0 ? "\u00a0" : "", unit.name);
}

static void put_output(const design_study *s, int output, double value, post_buffer *out) {
  put_measure(value, study_unit(&s->output[output], fabs(value)), 4, out);
}

/* "contact.n0 = 47.4 N, contact.mu = 0.3" */
static void put_place(const design_study *s, int design, put_text put, post_buffer *out) {
  for (int k = 0; k < s->n_keys; k++) {
    post_put(out, k ? ", " : "");
    put(out, s->key[k].name);
    post_put(out, "\u00a0=\u00a0");
    put_measure(s->design[design].key[k], study_key_unit(s, k), 4, out);
  }
}

/* Percentile with the highest level; -1: none. */
static int last_percentile(const study_uncertainty *u) {
  int last = -1;
  for (int i = 0; i < u->n_percentiles; i++)
    if (last < 0 || u->level[i] > u->level[last]) last = i;
  return last;
}

static bool is_uncertain(const design_study *s, int objective) {
  return s->uncertainty.n_samples > 0 && objective >= 0 && isfinite(s->uncertainty.mean[objective]);
}

/* "contact.n0 = 47.4 N" of a group */
static void put_group_place(const design_study *s, int group, put_text put, post_buffer *out) {
  const study_robust *r = &s->robust;
  for (int k = 0; k < r->n_varied; k++) {
    post_put(out, k ? ", " : "");
    put(out, s->key[k].name);
    post_put(out, "\u00a0=\u00a0");
    put_measure(r->key[group * r->n_varied + k], study_key_unit(s, k), 4, out);
  }
}

static int objective_at(const design_study *s, int group, int level) {
  return (group * s->n_outputs + study_objective(s)) * s->robust.n_percentiles + level;
}

/* "A to B at 95 % confidence". A bound that so few samples cannot give is said to lack. */
static void put_bounds(const design_study *s, double low, double high, double confidence,
                       int samples, post_buffer *out) {
  const int  objective = study_objective(s);
  const bool has_low = isfinite(low), has_high = isfinite(high);
  if (!has_low && !has_high) {
    post_put(out, "%d samples are too few for a bound", samples);
    return;
  }
  if (!has_low || !has_high) post_put(out, has_low ? "above " : "below ");
  if (has_low) put_output(s, objective, low, out);
  if (has_low && has_high) post_put(out, " to ");
  if (has_high) put_output(s, objective, high, out);
  post_put(out, " at %g\u00a0%% confidence", 100 * confidence);
  if (!has_low || !has_high)
    post_put(out, "; %d samples give no %s bound", samples, has_low ? "upper" : "lower");
}

/* The varied keys at which the highest percentile is least. */
static void put_robust_answer(const design_study *s, int group, int level, put_text put,
                              post_buffer *out) {
  const study_robust *r = &s->robust;
  post_put(out, "%g\u00a0%% of the samples of ", r->level[level]);
  put(out, s->output[study_objective(s)].name);
  post_put(out, " stay below ");
  const int i = objective_at(s, group, level);
  put_output(s, study_objective(s), r->percentile[i], out);
  post_put(out, " (");
  put_bounds(s, r->percentile_low[i], r->percentile_high[i], r->confidence, r->n_samples[group],
             out);
  post_put(out, ") at ");
  put_group_place(s, group, put, out);
  post_put(out, r->n_groups > 1 ? ", the least of %d" : "", r->n_groups);
}

static void put_answer(const design_study *s, put_text put, post_buffer *out) {
  int objective = study_objective(s), best = study_best(s), level;
  int group = study_best_group(s, &level);
  if (group >= 0) {
    put_robust_answer(s, group, level, put, out);
  } else if (is_uncertain(s, objective)) {
    const study_uncertainty *u = &s->uncertainty;
    int                      q = last_percentile(u), i = objective * u->n_percentiles + q;
    post_put(out, "On average ");
    put(out, s->output[objective].name);
    post_put(out, " is ");
    put_output(s, objective, u->mean[objective], out);
    if (q >= 0 && isfinite(u->percentile[i])) {
      post_put(out, "; %g\u00a0%% of the samples stay below ", u->level[q]);
      put_output(s, objective, u->percentile[i], out);
      post_put(out, " (");
      put_bounds(s, u->percentile_low[i], u->percentile_high[i], u->confidence, u->n_samples, out);
      post_put(out, ")");
    }
  } else if (best >= 0 && objective >= 0) {
    post_put(out, s->n > 1 ? "Design %d has the lowest " : "Design %d has the ", best + 1);
    put(out, s->output[objective].name);
    post_put(out, ", ");
    put_output(s, objective, s->design[best].value[objective], out);
    post_put(out, ", at ");
    put_place(s, best, put, out);
  } else if (s->optimum.n_history > 0) {
    post_put(out, "No design meets the constraints");
  } else {
    post_put(out, s->n ? "No design gave a result" : "The study has no design yet");
  }
}

void study_headline(const design_study *s, post_buffer *out) {
  put_answer(s, post_put_escaped, out);
  post_put(out, ".");
}

void study_summary(const design_study *s, post_buffer *out) {
  put_answer(s, post_put_printable, out);
  post_put(out, "; %d of %d designs done", design_study_count(s, STUDY_DONE), s->n);
  int failed = design_study_count(s, STUDY_FAILED);
  if (failed > 0) post_put(out, ", %d failed", failed);
}

/* ---------------------------------------------------------------- key figures */

static void open_figure(const char *label, const char *name, post_buffer *out) {
  post_put(out, "<div class=\"figure\"><dt>%s", label);
  post_put_escaped(out, name);
  post_put(out, "</dt><dd><b>");
}

static void between(post_buffer *out) {
  post_put(out, "</b><span>");
}

static void close_figure(post_buffer *out) {
  post_put(out, "</span></dd></div>\n");
}

static void put_uncertain_figures(const design_study *s, int objective, post_buffer *out) {
  const study_uncertainty *u = &s->uncertainty;
  int                      q = last_percentile(u), i = objective * u->n_percentiles + q;
  open_figure("Mean ", s->output[objective].name, out);
  put_output(s, objective, u->mean[objective], out);
  between(out);
  post_put(out, "deviation ");
  put_output(s, objective, u->deviation[objective], out);
  close_figure(out);
  if (q < 0 || !isfinite(u->percentile[i])) return;
  post_put(out, "<div class=\"figure\"><dt>%g %% stay below</dt><dd><b>", u->level[q]);
  put_output(s, objective, u->percentile[i], out);
  between(out);
  put_bounds(s, u->percentile_low[i], u->percentile_high[i], u->confidence, u->n_samples, out);
  close_figure(out);
}

/* Largest value of the objective over the designs that are done. */
static double largest(const design_study *s, int objective) {
  double most = -INFINITY;
  for (int i = 0; i < s->n; i++) most = fmax(most, study_done_value(&s->design[i], objective));
  return most;
}

static void put_best_figures(const design_study *s, int objective, int best, post_buffer *out) {
  double least = s->design[best].value[objective], most = largest(s, objective);
  char   ratio[POST_NUMBER];
  open_figure("Lowest ", s->output[objective].name, out);
  put_output(s, objective, least, out);
  between(out);
  post_put(out, "design %d", best + 1);
  if (isfinite(s->design[best].error[objective]) && s->design[best].error[objective] > 0 &&
      least != 0)
    post_put(out, ", error %s",
             post_percent(ratio, s->design[best].error[objective] / fabs(least)));
  close_figure(out);
  for (int k = 0; k < s->n_keys && k < 2; k++) {
    open_figure("at ", s->key[k].name, out);
    put_measure(s->design[best].key[k], study_key_unit(s, k), 4, out);
    between(out);
    if (s->optimum.n_history > 0 && s->optimum.on_bound[k])
      post_put(out, "on its %s bound", s->optimum.on_bound[k] < 0 ? "lower" : "upper");
    close_figure(out);
  }
  if (!(most > least)) return;
  open_figure("Highest ", s->output[objective].name, out);
  put_output(s, objective, most, out);
  between(out);
  if (least > 0) post_put(out, "%s times the lowest", post_plain(ratio, most / least, 3));
  close_figure(out);
}

static void put_robust_figures(const design_study *s, int group, int level, post_buffer *out) {
  const study_robust *r = &s->robust;
  int                 i = objective_at(s, group, level);
  post_put(out, "<div class=\"figure\"><dt>%g %% stay below</dt><dd><b>", r->level[level]);
  put_output(s, study_objective(s), r->percentile[i], out);
  between(out);
  put_bounds(s, r->percentile_low[i], r->percentile_high[i], r->confidence, r->n_samples[group],
             out);
  close_figure(out);
  for (int k = 0; k < r->n_varied && k < 2; k++) {
    open_figure("at ", s->key[k].name, out);
    put_measure(r->key[group * r->n_varied + k], study_key_unit(s, k), 4, out);
    between(out);
    close_figure(out);
  }
}

void study_key_figures(const design_study *s, post_buffer *out) {
  int    objective = study_objective(s), best = study_best(s), level;
  int    group     = study_best_group(s, &level);
  bool   uncertain = is_uncertain(s, objective);
  double share;
  int    chief = study_chief_key(s, &share);
  char   ratio[POST_NUMBER];
  if (objective < 0 || (best < 0 && !uncertain && group < 0)) return;
  post_put(out, "<dl class=\"figures\">\n");
  if (group >= 0)
    put_robust_figures(s, group, level, out);
  else if (uncertain)
    put_uncertain_figures(s, objective, out);
  else
    put_best_figures(s, objective, best, out);
  if (chief >= 0 && group < 0) {
    post_put(out, "<div class=\"figure\"><dt>Matters most</dt><dd><b class=\"words\">");
    post_put_escaped(out, s->key[chief].name);
    between(out);
    post_put(out, "%s of the variance%s", post_percent(ratio, share),
             s->uncertainty.has_sobol ? "" : " by itself");
    close_figure(out);
  }
  open_figure("Designs done", "", out);
  post_put(out, "%d", design_study_count(s, STUDY_DONE));
  between(out);
  post_put(out, "of %d", s->n);
  close_figure(out);
  post_put(out, "</dl>\n");
}

/* ---------------------------------------------------------------- findings */

static void open_item(bool caution, post_buffer *out) {
  post_put(out, caution ? "<li class=\"caution\">" : "<li>");
}

static void close_item(post_buffer *out) {
  post_put(out, "</li>\n");
}

static void put_bold(const char *text, post_buffer *out) {
  post_put(out, "<b>");
  post_put_escaped(out, text);
  post_put(out, "</b>");
}

/* The keys by their share of the objective's variance. */
static void put_shares(const design_study *s, int objective, post_buffer *out) {
  const study_uncertainty *u = &s->uncertainty;
  double                   share;
  char                     ratio[POST_NUMBER], low[POST_NUMBER], high[POST_NUMBER];
  int                      chief = study_chief_key(s, &share);
  if (chief < 0) return;
  open_item(false, out);
  put_bold(s->key[chief].name, out);
  post_put(out, " matters most for ");
  post_put_escaped(out, s->output[objective].name);
  if (u->has_sobol) {
    int i = objective * s->n_keys + chief;
    post_put(out, ": its total Sobol’ index is %s", post_plain(ratio, share, 3));
    if (isfinite(u->total_low[i]))
      post_put(out, " (%s to %s)", post_plain(low, u->total_low[i], 2),
               post_plain(high, u->total_high[i], 2));
    post_put(out, ".");
  } else {
    post_put(out, ": by itself it explains %s of the variance over the designs",
             post_percent(ratio, share));
    for (int k = 0; k < s->n_keys; k++) {
      double own = study_main_effect(s, objective, k).share;
      if (k == chief || !isfinite(own)) continue;
      post_put(out, ", ");
      post_put_escaped(out, s->key[k].name);
      post_put(out, " %s", post_percent(ratio, own));
    }
    post_put(out, ".");
  }
  close_item(out);
}

static void put_equals(const design_study *s, int best, post_buffer *out) {
  int equals = study_count_equals(s, best);
  if (equals < 1) return;
  open_item(true, out);
  post_put(out, "%d other design%s within the errors of the lowest: it is not told apart from %s.",
           equals, equals > 1 ? "s are" : " is", equals > 1 ? "them" : "it");
  close_item(out);
}

static void put_stability(const design_study *s, int best, post_buffer *out) {
  int output = design_study_output(s, "stable");
  if (best < 0 || output < 0 || s->uncertainty.n_samples > 0) return;
  double stable = s->design[best].value[output];
  if (stable > 0) return;
  open_item(true, out);
  post_put(out, "Design %d %s at its peak.", best + 1,
           isnan(stable) ? "was not judged for stability" : "is not stable");
  close_item(out);
}

/* Each line of the notes is an item of its own. */
static void put_notes(const char *notes, post_buffer *out) {
  while (notes && *notes) {
    size_t length = strcspn(notes, "\n");
    char  *line   = strndup(notes, length);
    if (line && *line) {
      open_item(true, out);
      post_put_escaped(out, line);
      close_item(out);
    }
    free(line);
    notes += length + (notes[length] == '\n');
  }
}

static void put_search(const design_study *s, post_buffer *out) {
  const study_optimum *o = &s->optimum;
  if (o->n_history < 1) return;
  open_item(false, out);
  post_put(out, "The search by ");
  post_put_escaped(out, o->method);
  int reached = -1;
  for (int i = 0; i < o->n_history && reached < 0; i++)
    if (o->history[i] == o->best) reached = i + 1;
  post_put(out, " took %d evaluations", o->n_history);
  if (reached > 0) post_put(out, "; number %d found the optimum", reached);
  post_put(out, ".");
  close_item(out);
  for (int k = 0; k < s->n_keys && o->best >= 0; k++) {
    if (!o->on_bound[k]) continue;
    open_item(true, out);
    post_put(out, "The optimum lies on the %s bound of ", o->on_bound[k] < 0 ? "lower" : "upper");
    put_bold(s->key[k].name, out);
    post_put(out, ": a wider range may hold a better one.");
    close_item(out);
  }
  put_notes(o->note, out);
}

/* End of a key's range at which the choice lies: -1 lower, 1 upper, 0 inside. */
static int end_of_range(double chosen, double low, double high) {
  if (!(high > low)) return 0;
  return (chosen >= high) - (chosen <= low);
}

/* The choice of a grid or table at the end of what was tried: of designs, or of the groups of a
 * robust study. Optimisations tell of their bounds, samples have no choice. */
static void put_edges(const design_study *s, int best, int group, post_buffer *out) {
  const study_robust *r = &s->robust;
  const int n = group >= 0 ? r->n_groups : s->n, keys = group >= 0 ? r->n_varied : s->n_keys;
  if (s->optimum.n_history > 0 || (group < 0 && best < 0)) return;
  for (int k = 0; k < keys; k++) {
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < n; i++) {
      const double at = group >= 0 ? r->key[i * keys + k] : s->design[i].key[k];
      low             = fmin(low, at);
      high            = fmax(high, at);
    }
    const double chosen = group >= 0 ? r->key[group * keys + k] : s->design[best].key[k];
    const int    end    = end_of_range(chosen, low, high);
    if (!end) continue;
    open_item(true, out);
    post_put(out, "The choice lies at the %s end of the values of ", end < 0 ? "lower" : "upper");
    put_bold(s->key[k].name, out);
    post_put(out, ": further values may hold a better one.");
    close_item(out);
  }
}

static void put_spread(const design_study *s, int objective, post_buffer *out) {
  const study_uncertainty *u = &s->uncertainty;
  char                     ratio[POST_NUMBER];
  if (!is_uncertain(s, objective) || u->mean[objective] == 0) return;
  open_item(false, out);
  post_put(out, "The standard deviation of ");
  post_put_escaped(out, s->output[objective].name);
  post_put(out, " is %s of its mean, from %d samples",
           post_percent(ratio, u->deviation[objective] / fabs(u->mean[objective])), u->n_samples);
  if (u->n_failed > 0) post_put(out, "; %d failed ones are left out", u->n_failed);
  post_put(out, ".");
  close_item(out);
}

static void put_robust(const design_study *s, post_buffer *out) {
  const study_robust *r = &s->robust;
  int                 level, best = study_best_group(s, &level), failed = 0;
  int                 equals = study_count_equal_groups(s, best, level);
  for (int g = 0; g < r->n_groups; g++) failed += r->n_failed[g];
  if (best < 0) return;
  open_item(false, out);
  post_put(out, "Percentiles of %d samples at each of %d designs of the varied keys",
           r->n_samples[best] + r->n_failed[best], r->n_groups);
  if (failed > 0) post_put(out, "; %d failed ones are left out", failed);
  post_put(out, ".");
  close_item(out);
  if (equals < 1) return;
  open_item(true, out);
  post_put(out,
           "The interval of the percentile at %d other design%s overlaps with that of the least: "
           "more samples would tell them apart.",
           equals, equals > 1 ? "s" : "");
  close_item(out);
}

static const char *reason_of(const study_design *design) {
  return design->reason ? design->reason : "no reason was recorded";
}

static bool same_fate(const study_design *a, const study_design *b) {
  return a->state == b->state && strcmp(reason_of(a), reason_of(b)) == 0;
}

/* Is design i the first of those with its state and reason? */
static bool is_first(const design_study *s, int i) {
  for (int j = 0; j < i; j++)
    if (same_fate(&s->design[j], &s->design[i])) return false;
  return true;
}

/* One item for all designs with the state and reason of design i. */
static void put_fate(const design_study *s, int i, post_buffer *out) {
  int count = 0, named = 0;
  for (int j = i; j < s->n; j++) count += same_fate(&s->design[i], &s->design[j]);
  open_item(true, out);
  post_put(out, "%s %s: ", count > 1 ? "Designs" : "Design",
           s->design[i].state == STUDY_FAILED ? "failed" : "not converged");
  for (int j = i; j < s->n && named < MOST_NAMED; j++) {
    if (!same_fate(&s->design[i], &s->design[j])) continue;
    post_put(out, "%s%d", named++ ? ", " : "", j + 1);
  }
  if (count > named) post_put(out, " and %d more", count - named);
  post_put(out, ". ");
  post_put_escaped(out, reason_of(&s->design[i]));
  close_item(out);
}

static void put_fates(const design_study *s, post_buffer *out) {
  int shown = 0, more = 0;
  for (int i = 0; i < s->n; i++) {
    study_state state = s->design[i].state;
    if ((state != STUDY_FAILED && state != STUDY_NOT_CONVERGED) || !is_first(s, i)) continue;
    if (shown < MOST_REASONS)
      put_fate(s, i, out);
    else
      more++;
    shown++;
  }
  if (more > 0) {
    open_item(true, out);
    post_put(out, "%d more reasons of failure are in the table.", more);
    close_item(out);
  }
  int waiting = design_study_count(s, STUDY_WAITING);
  if (waiting > 0 || !s->finished) {
    open_item(true, out);
    post_put(out, "The study is not finished");
    if (waiting > 0) post_put(out, ": %d designs wait", waiting);
    post_put(out, ".");
    close_item(out);
  }
}

void study_findings(const design_study *s, post_buffer *out) {
  int objective = study_objective(s), best = study_best(s), level;
  post_put(out, "<ul class=\"findings\">\n");
  if (objective >= 0) {
    put_robust(s, out);
    put_spread(s, objective, out);
    if (s->robust.n_groups == 0) put_shares(s, objective, out); /* else choice and chance mix */
  }
  bool chosen = is_uncertain(s, objective) || s->optimum.n_history > 0;
  if (!chosen) put_equals(s, best, out);
  if (!is_uncertain(s, objective)) put_edges(s, best, study_best_group(s, &level), out);
  put_stability(s, best, out);
  put_search(s, out);
  put_fates(s, out);
  post_put(out, "</ul>\n");
}
