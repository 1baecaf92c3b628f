#include "cases/study/optimiser.h"

#include <math.h>
#include <nlopt.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

#include "cases/study/line_minimum.h"

/* A start ends where the simplex is this small in the unit cube, or values differ by less. */
static const double SETTLED = 1e-6, EQUAL = 1e-8;
/* Size of the first step in the unit cube. */
static const double FIRST_STEP = 0.15;
/* SBPLX begins again with steps down to this, and on while it gains this share. */
static const double LAST_STEP = 0.02, GAIN = 1e-6;

typedef enum { THINKING, ASKING, WAITING, DONE } start_state;

typedef struct {
  optimiser  *owner;
  pthread_t   thread;
  bool        running; /* the thread is to be joined */
  start_state state;
  int         index;
  double     *point; /* [n] */
  double      answer, slope;
  int         count; /* evaluations */
  bool        used_up;
  nlopt_opt   opt; /* NULL for STUDY_SLOPE */
} one_start;

struct optimiser {
  study_optimise  settings;
  int             n, n_starts;
  bool            stopped;
  one_start      *start;
  double         *points; /* [starts][n] */
  pthread_mutex_t lock;
  pthread_cond_t  changed;
};

/* Ask for the value at x [n] and sleep until it is told. False: the search is to end. */
static bool ask(one_start *s, const double *x) {
  optimiser *o = s->owner;
  if (s->count++ >= o->settings.evaluations / o->n_starts) { /* DIRECT heeds no limit of its own */
    s->used_up = true;
    return false;
  }
  pthread_mutex_lock(&o->lock);
  for (int i = 0; i < o->n; i++) s->point[i] = fmin(1, fmax(0, x[i]));
  s->state = ASKING;
  pthread_cond_broadcast(&o->changed);
  while (s->state != THINKING && !o->stopped) pthread_cond_wait(&o->changed, &o->lock);
  bool goes_on = !o->stopped;
  pthread_mutex_unlock(&o->lock);
  return goes_on;
}

/* Called by NLopt in the thread of a start. */
static double value_at(unsigned n, const double *x, double *gradient, void *context) {
  one_start *s = context;
  (void)n;
  (void)gradient;
  if (ask(s, x)) return s->answer;
  nlopt_force_stop(s->opt);
  return HUGE_VAL;
}

/* Called by line_minimum in the thread of a start. */
static bool value_and_slope_at(void *context, double u, double *value, double *slope) {
  one_start *s = context;
  if (!ask(s, &u)) return false;
  *value = s->answer;
  *slope = s->slope;
  return true;
}

static const nlopt_algorithm algorithm_of[STUDY_SLOPE] = {NLOPT_LN_SBPLX, NLOPT_GN_CRS2_LM,
                                                          NLOPT_GN_ISRES, NLOPT_GN_DIRECT_L};

/* Simplices settle on a kink beside the optimum, so SBPLX begins again where it ended, until that
 * brings no more than GAIN. */
static void search_by_values(one_start *s, double *x) {
  double least = HUGE_VAL, step = FIRST_STEP;
  bool   again = true;
  nlopt_optimize(s->opt, x, &least);
  for (; again && !s->used_up && !s->owner->stopped; step *= 0.5) {
    double before = least;
    again         = s->owner->settings.algorithm == STUDY_SBPLX;
    nlopt_set_initial_step1(s->opt, 0.5 * step);
    if (again) nlopt_optimize(s->opt, x, &least);
    again = again && (before - least > GAIN * fabs(before) || step > LAST_STEP);
  }
}

static void *run(void *context) {
  one_start *s = context;
  optimiser *o = s->owner;
  double     x[o->n];
  if (o->settings.algorithm == STUDY_SLOPE) {
    double low = s->index / (double)o->n_starts, high = (s->index + 1) / (double)o->n_starts;
    line_minimum(low, high, SETTLED, value_and_slope_at, s);
  } else {
    for (int i = 0; i < o->n; i++) x[i] = s->point[i];
    nlopt_srand((unsigned long)o->settings.seed * 1000 +
                (unsigned long)s->index); /* a generator a thread */
    search_by_values(s, x);
  }
  pthread_mutex_lock(&o->lock);
  s->state = DONE;
  pthread_cond_broadcast(&o->changed);
  pthread_mutex_unlock(&o->lock);
  return NULL;
}

static bool set_up(one_start *s) {
  optimiser *o = s->owner;
  if (o->settings.algorithm == STUDY_SLOPE) return true;
  s->opt = nlopt_create(algorithm_of[o->settings.algorithm], (unsigned)o->n);
  if (!s->opt) return false;
  nlopt_set_lower_bounds1(s->opt, 0);
  nlopt_set_upper_bounds1(s->opt, 1);
  nlopt_set_min_objective(s->opt, value_at, s);
  nlopt_set_xtol_abs1(s->opt, SETTLED);
  nlopt_set_ftol_rel(s->opt, EQUAL);
  return nlopt_set_initial_step1(s->opt, FIRST_STEP) > 0;
}

shb_status optimiser_create(const study_optimise *settings, int n, const double *first,
                            optimiser **out) {
  optimiser *o = calloc(1, sizeof *o);
  SHB_CHECK(o, SHB_ERR_IO, "out of memory");
  size_t n_starts = (size_t)settings->starts;
  o->settings     = *settings;
  o->n            = n;
  o->n_starts     = settings->starts;
  o->start        = calloc(n_starts, sizeof *o->start);
  o->points       = calloc(n_starts * (size_t)n, sizeof *o->points);
  pthread_mutex_init(&o->lock, NULL);
  pthread_cond_init(&o->changed, NULL);
  bool good = o->start && o->points;
  for (int i = 0; good && i < o->n_starts; i++) {
    one_start *s = &o->start[i];
    *s           = (one_start){.owner = o, .index = i, .point = o->points + (size_t)i * (size_t)n};
    for (int k = 0; k < n; k++) s->point[k] = first[i * n + k];
    good       = set_up(s) && pthread_create(&s->thread, NULL, run, s) == 0;
    s->running = good;
  }
  *out = o;
  if (good) return SHB_OK;
  optimiser_destroy(o);
  *out = NULL;
  SHB_FAIL(SHB_ERR_IO, "no memory or no thread for %d starts", settings->starts);
}

int optimiser_ask(optimiser *o, const double **point) {
  pthread_mutex_lock(&o->lock);
  int found = -1;
  for (bool thinking = true; thinking;) { /* only then is the order of starts always the same */
    thinking = false;
    for (int i = 0; i < o->n_starts; i++) thinking = thinking || o->start[i].state == THINKING;
    if (thinking) pthread_cond_wait(&o->changed, &o->lock);
  }
  for (int i = o->n_starts - 1; i >= 0; i--)
    if (o->start[i].state == ASKING) found = i;
  if (found >= 0) {
    o->start[found].state = WAITING;
    *point                = o->start[found].point;
  }
  pthread_mutex_unlock(&o->lock);
  return found;
}

void optimiser_tell(optimiser *o, int start, double value, double slope) {
  pthread_mutex_lock(&o->lock);
  o->start[start].answer = value;
  o->start[start].slope  = slope;
  o->start[start].state  = THINKING;
  pthread_cond_broadcast(&o->changed);
  pthread_mutex_unlock(&o->lock);
}

bool optimiser_used_up(const optimiser *o, int start) {
  return o->start[start].used_up;
}

void optimiser_destroy(optimiser *o) {
  if (!o) return;
  pthread_mutex_lock(&o->lock);
  o->stopped = true;
  pthread_cond_broadcast(&o->changed);
  pthread_mutex_unlock(&o->lock);
  for (int i = 0; o->start && i < o->n_starts; i++) {
    if (o->start[i].running) pthread_join(o->start[i].thread, NULL);
    if (o->start[i].opt) nlopt_destroy(o->start[i].opt);
  }
  pthread_mutex_destroy(&o->lock);
  pthread_cond_destroy(&o->changed);
  free(o->points);
  free(o->start);
  free(o);
}

void optimiser_name(study_algorithm algorithm, char *out, size_t size) {
  static const char *const names[STUDY_SLOPE] = {"SBPLX", "CRS2", "ISRES", "DIRECT-L"};
  int                      major, minor, bugfix;
  if (algorithm == STUDY_SLOPE) {
    snprintf(out, size, "root of the slope");
    return;
  }
  nlopt_version(&major, &minor, &bugfix);
  snprintf(out, size, "%s of NLopt %d.%d.%d", names[algorithm], major, minor, bugfix);
}
