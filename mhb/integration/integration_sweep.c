#include "mhb/integration/integration_sweep.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/integration/integration_memory.h"
#include "mhb/integration/spectrum.h"
#include "mhb/integration/steady_state.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "mhb/problem/interfaces.h"
#include "mhb/problem/parameter.h"
#include "mhb/problem/wave.h"
#include "mhb/response/describe.h"
#include "mhb/response/publisher.h"

/* Interval of writing the response file, s. */
static const double PUBLISH_EVERY = 10;

enum { MOST_STEPS = 8192, SPECTRUM_PERIODS = 64 };

typedef enum { POINT_NOT_RUN, POINT_FOUND, POINT_FAILED } point_outcome;

/* One point: its task, and its result. */
typedef struct {
  int             branch;
  double          hz, n0;
  double complex *start; /* [k][3 pairs] forces of the balance, or NULL */
  int             m;     /* its harmonics */
  point_outcome   outcome;
  int             multiple, periods;
  double          distance, seconds, error; /* error: of the steps, relative; -1: not known */
  double complex *motion, *force, *probe;   /* [..][k] */
  double         *state, *dissipation;      /* [pair][3], [pair] */
  double          line_frequency[MHB_SPECTRUM_LINES], line_amplitude[MHB_SPECTRUM_LINES];
} sweep_point;

/* Shared by the threads; points of other threads are touched under the publisher's lock only. */
typedef struct {
  const modal_model              *model;
  const mhb_settings             *settings;
  const mhb_integration_settings *request;
  const mhb_response             *balance;
  int                             harmonics; /* kept */
  int                             n, room, n_branches, n_done;
  sweep_point                    *points;
  int                            *sequence,
      n_sequences; /* [n_sequences + 1] first point; the points of one are run in order */
  shb_progress *progress;
  mhb_publisher publisher;
} sweep;

/* ---- the points ---- */

static double frequency_of(const sweep *s, int i) {
  const double *range = s->settings->frequency;
  if (s->request->listed) return s->request->frequency[i];
  int n = s->request->n_frequencies;
  return n > 1 ? range[0] + (range[1] - range[0]) * i / (n - 1) : 0.5 * (range[0] + range[1]);
}

static sweep_point *add_point(sweep *s, int branch, double n0, double hz) {
  if (s->n == s->room) {
    s->room   = s->room ? 2 * s->room : 64;
    s->points = shb_realloc(s->points, (size_t)s->room, sizeof *s->points);
  }
  s->points[s->n] = (sweep_point){.branch = branch, .hz = hz, .n0 = n0, .error = -1};
  return &s->points[s->n++];
}

/* Turn of a wave over n sectors, where the model has more of them than the balance. */
static double complex lag(const mhb_response *balance, long n) {
  const long wave = mhb_driven_wave_number(mhb_driven_wave_of(
      balance->engine_order, balance->turns_right, balance->blades, balance->subharmonics));
  return n ? cexp(-I * SHB_TWO_PI * (double)(n * wave % balance->blades) / balance->blades) : 1;
}

/* A point that starts between points p and p + 1 of a branch of the balance, unless both are
 * unstable. Where one is, it starts on the other. */
static void plan_between(sweep *s, const mhb_branch *b, int p, int branch, double hz) {
  double part = (hz - b->frequency[p]) / (b->frequency[p + 1] - b->frequency[p]);
  if (b->stable[p] == 0 && b->stable[p + 1] == 0) return;
  if (b->stable[p] == 0) part = 1;
  if (b->stable[p + 1] == 0) part = 0;
  int          K = b->n_harmonics + 1, own = 3 * s->balance->n_pairs, n3 = 3 * s->model->n_pairs;
  sweep_point *c           = add_point(s, branch, b->n0[p], hz);
  c->start                 = shb_alloc((size_t)K * (size_t)n3, sizeof *c->start);
  c->m                     = K - 1;
  const double complex *at = b->force + (size_t)p * (size_t)(own * K), *next = at + own * K;
  for (int i = 0; i < n3 * K; i++) {
    const int k = i % K, row = i / K, from = row % own * K + k;
    c->start[k * n3 + row] =
        ((1 - part) * at[from] + part * next[from]) * lag(s->balance, (long)k * (row / own));
  }
}

/* Whether a branch can start points at a preload. Those of another order cannot: their harmonics
 * are of another fundamental. */
static bool is_start(const sweep *s, const mhb_branch *b, double n0) {
  return b->kind == MHB_BRANCH_NONLINEAR && b->n_points > 1 &&
         b->order == s->settings->subharmonics &&
         fabs(b->n0[0] - n0) <= 1e-9 * fmax(fabs(n0), fabs(b->n0[0]));
}

/* hz, moved inside the range of a branch if it equals one of its ends to rounding. */
static double move_inside(const mhb_branch *b, double hz) {
  double low = INFINITY, high = 0, margin = 1e-9 * hz;
  for (int p = 0; p < b->n_points; p++) {
    low  = fmin(low, b->frequency[p]);
    high = fmax(high, b->frequency[p]);
  }
  if (fabs(hz - low) < margin) return low + 1e-3 * margin;
  return fabs(hz - high) < margin ? high - 1e-3 * margin : hz;
}

/* A point for every solution of the balance at a preload and frequency that is not unstable. */
static shb_status plan_from_balance(sweep *s, int branch, double n0, double hz) {
  bool found_curve = false;
  for (int i = 0; i < s->balance->n_branches; i++) {
    const mhb_branch *b = &s->balance->branch[i];
    if (!is_start(s, b, n0)) continue;
    found_curve = true;
    double at   = move_inside(b, hz);
    for (int p = 0; p + 1 < b->n_points; p++)
      if ((b->frequency[p] <= at) != (b->frequency[p + 1] <= at)) plan_between(s, b, p, branch, at);
  }
  SHB_CHECK(found_curve, SHB_ERR_INPUT,
            "the response file has no curve at n0 = %g N to start on; run shroudhb mhb first, or "
            "set integrate.start to rest or state",
            n0);
  return SHB_OK;
}

static void plan_from_state(sweep *s, int branch, double n0, bool down) {
  int n = s->request->n_frequencies;
  for (int i = 0; i < n; i++) add_point(s, branch, n0, frequency_of(s, down ? n - 1 - i : i));
}

static shb_status plan_preload(sweep *s, double n0) {
  const mhb_integration_settings *a = s->request;
  if (a->start == MHB_START_FROM_STATE) {
    if (a->direction != MHB_SWEEP_DOWN) plan_from_state(s, s->n_branches++, n0, false);
    if (a->direction != MHB_SWEEP_UP) plan_from_state(s, s->n_branches++, n0, true);
    return SHB_OK;
  }
  for (int k = 0; k < a->n_frequencies; k++) {
    if (a->start == MHB_START_FROM_BALANCE)
      SHB_TRY(plan_from_balance(s, s->n_branches, n0, frequency_of(s, k)));
    else
      add_point(s, s->n_branches, n0, frequency_of(s, k));
  }
  s->n_branches++;
  return SHB_OK;
}

static shb_status plan(sweep *s) {
  const mhb_integration_settings *a = s->request;
  for (int i = 0; i < s->settings->n_preloads; i++) SHB_TRY(plan_preload(s, s->settings->n0[i]));
  s->sequence = shb_alloc_zeroed((size_t)s->n + 1, sizeof(int));
  for (int i = 0; i < s->n; i++)
    if (a->start != MHB_START_FROM_STATE || i == 0 ||
        s->points[i].branch != s->points[i - 1].branch)
      s->sequence[s->n_sequences++] = i;
  s->sequence[s->n_sequences] = s->n;
  return SHB_OK;
}

/* ---- one point ---- */

static int not_interrupted(void *context) {
  (void)context;
  return !shb_interrupted();
}

/* |a - b| / |b| or 0 of harmonics [n]. */
static double difference(const double complex *a, const double complex *b, int n) {
  double apart = 0, size = 0;
  for (int i = 0; i < n; i++) {
    apart += creal((a[i] - b[i]) * conj(a[i] - b[i]));
    size += creal(a[i] * conj(a[i]));
  }
  return size > 0 ? sqrt(apart / size) : 0;
}

/* Run again with twice the steps until two runs agree. result: of the first run, then of the
 * last. */
static void refine(const sweep *s, mhb_integrator *g, mhb_steady_state *steady,
                   const mhb_steady_state_settings *settings,
                   const mhb_steady_state_result **result, sweep_point *c) {
  const mhb_steady_state_result *r = *result;
  int                            n = 3 * r->n_pairs * (r->n_harmonics + 1), periods = r->periods;
  double complex                *last = shb_alloc((size_t)n, sizeof *last);
  for (int steps = 2 * g->steps; r->multiple && !r->failed && steps <= MOST_STEPS; steps *= 2) {
    memcpy(last, r->motion, sizeof *last * (size_t)n);
    mhb_integrator_set(g, g->omega, g->n0, steps);
    r        = mhb_steady_state_run(steady, settings, not_interrupted, NULL);
    c->error = difference(r->motion, last, n);
    periods += r->periods;
    if (c->error <= s->request->tolerance || shb_interrupted()) break;
  }
  c->periods = periods;
  *result    = r;
  free(last);
}

static void store_rows(int rows, int from, int to, const double complex *in, double complex *out) {
  for (int i = 0; i < rows; i++)
    memcpy(out + i * (to + 1), in + i * (from + 1), sizeof *in * (size_t)(to + 1));
}

static void store_result(const sweep *s, const mhb_steady_state_result *r, sweep_point *c) {
  int    K = s->harmonics + 1, n3 = 3 * r->n_pairs, q = 3 * r->n_probes;
  size_t rows    = 2 * (size_t)n3 + (size_t)q;
  c->motion      = shb_alloc(rows * (size_t)K, sizeof *c->motion);
  c->state       = shb_alloc(4 * (size_t)r->n_pairs, sizeof(double));
  c->force       = c->motion + n3 * K;
  c->probe       = c->force + n3 * K;
  c->dissipation = c->state + 3 * r->n_pairs;
  store_rows(n3, r->n_harmonics, s->harmonics, r->motion, c->motion);
  store_rows(n3, r->n_harmonics, s->harmonics, r->force, c->force);
  store_rows(q, r->n_harmonics, s->harmonics, r->probe, c->probe);
  memcpy(c->state, r->state, sizeof(double) * 3 * (size_t)r->n_pairs);
  memcpy(c->dissipation, r->dissipation, sizeof(double) * (size_t)r->n_pairs);
  c->multiple = r->multiple;
  c->distance = r->distance;
}

/* The steady state from where the point starts. Steps in which no forces are found are halved,
 * unless the state of the point before would be lost. */
static const mhb_steady_state_result *settle(const sweep *s, mhb_integrator *g,
                                             mhb_steady_state                *steady,
                                             const mhb_steady_state_settings *settings, bool first,
                                             const sweep_point *c) {
  const bool from_rest = s->request->start == MHB_START_FROM_REST || first;
  for (int steps = s->request->steps;; steps *= 2) {
    mhb_integrator_set(g, SHB_TWO_PI * c->hz, c->n0, steps);
    if (c->start)
      mhb_integrator_balance(g, c->m, c->start);
    else if (from_rest)
      mhb_integrator_rest(g);
    const mhb_steady_state_result *r =
        mhb_steady_state_run(steady, settings, not_interrupted, NULL);
    if (!r->failed || !(c->start || from_rest) || 2 * steps > MOST_STEPS || shb_interrupted())
      return r;
  }
}

/* first: of its sequence. Nothing is stored if interrupted. */
static void run_point(const sweep *s, mhb_integrator *g, mhb_steady_state *steady, bool first,
                      sweep_point *c) {
  const mhb_integration_settings *a        = s->request;
  mhb_steady_state_settings       settings = {0.1 * a->tolerance, a->max_periods};
  double                          began    = shb_seconds();
  const mhb_steady_state_result  *r        = settle(s, g, steady, &settings, first, c);
  c->periods                               = r->periods;
  if (r->multiple && !r->failed) refine(s, g, steady, &settings, &r, c);
  if (shb_interrupted()) return;
  if (!r->failed) store_result(s, r, c);
  c->outcome = r->failed ? POINT_FAILED : POINT_FOUND;
  if (c->outcome == POINT_FOUND && !c->multiple)
    mhb_spectrum(g, SPECTRUM_PERIODS, c->line_frequency, c->line_amplitude);
  c->seconds = shb_seconds() - began;
}

/* ---- the response ---- */

static void record_preloads(const sweep *s, int n, mhb_branch *b, int at, double n0) {
  mhb_operating_point c = mhb_operating_point_of(s->settings);
  c.n0                  = n0;
  for (int i = 0; i < n; i++)
    b->interface_n0[at * n + i] = mhb_interface_operating_point(&c, s->settings, i).n0;
}

/* The mean friction of a pair that sticks all the time is that of the start. */
static bool has_undetermined_friction(const sweep *s, const mhb_response *response,
                                      const sweep_point *c) {
  const mhb_operating_point lead       = mhb_operating_point_of(s->settings);
  const int                 n          = response->n_pairs;
  const int                 on_contact = s->settings->ring ? s->settings->ring->n_pairs : n;
  bool                      free_mean[n + 1];
  for (int a = 0; a < n; a++) {
    const int                 i   = response->interface ? response->interface[a] : 0;
    const mhb_operating_point own = mhb_interface_operating_point(&lead, s->settings, i);
    free_mean[a] =
        own.mu > 0 && (own.ku[0] > 0 || own.ku[2] > 0) && c->state[3 * a + MHB_STICK] == 1;
  }
  return mhb_friction_loads_others(n, on_contact, free_mean, c->state);
}

static void record_point(const sweep *s, mhb_response *response, const sweep_point *c) {
  int    at, K = response->n_harmonics + 1;
  size_t n3         = 3 * (size_t)response->n_pairs * (size_t)K,
         q          = 3 * (size_t)response->n_probes * (size_t)K;
  at                = mhb_response_point(response, c->branch);
  mhb_branch *b     = &response->branch[c->branch];
  size_t      pairs = (size_t)response->n_pairs;
  b->frequency[at]  = c->hz;
  b->n0[at]         = c->n0;
  record_preloads(s, response->n_interfaces, b, at, c->n0);
  b->value[at]            = c->hz;
  b->stable[at]           = c->multiple ? 1 : -1;
  b->seconds[at]          = c->seconds;
  b->error_newton[at]     = c->multiple ? c->distance : -1;
  b->error_truncation[at] = 0;
  b->error_sampling[at]   = c->error;
  b->error_modal[at]      = -1;
  b->mark[at]     = has_undetermined_friction(s, response, c) ? MHB_TRACTION_UNDETERMINED : 0;
  b->multiple[at] = c->multiple;
  b->periods[at]  = c->periods;
  b->distance[at] = c->distance;
  memcpy(b->motion + (size_t)at * n3, c->motion, sizeof *c->motion * n3);
  memcpy(b->force + (size_t)at * n3, c->force, sizeof *c->force * n3);
  if (q) memcpy(b->probe + (size_t)at * q, c->probe, sizeof *c->probe * q);
  memcpy(b->state + 3 * pairs * (size_t)at, c->state, sizeof(double) * 3 * pairs);
  memcpy(b->dissipation + pairs * (size_t)at, c->dissipation, sizeof(double) * pairs);
  size_t line = (size_t)at * MHB_SPECTRUM_LINES;
  memcpy(b->line_frequency + line, c->line_frequency, sizeof c->line_frequency);
  memcpy(b->line_amplitude + line, c->line_amplitude, sizeof c->line_amplitude);
}

static const char *name_of(const sweep *s, int branch) {
  static const char *const name[]   = {"from the balance", "from rest", "up, from the state before",
                                       "down, from the state before"};
  const mhb_integration_settings *a = s->request;
  if (a->start != MHB_START_FROM_STATE) return name[a->start];
  return name[a->direction == MHB_SWEEP_DOWN || (a->direction == MHB_SWEEP_BOTH && branch % 2) ? 3
                                                                                               : 2];
}

static shb_status fill(const sweep *s, mhb_response *response) {
  SHB_TRY(mhb_response_describe(response, s->model, s->settings));
  response->n_multipliers = 0;
  response->n_lines       = MHB_SPECTRUM_LINES;
  for (int i = 0; i < s->n_branches; i++) {
    const int branch                  = mhb_response_branch(response, MHB_BRANCH_INTEGRATION);
    response->branch[branch].complete = true;
    response->branch[branch].reason   = shb_text(name_of(s, i));
  }
  for (int i = 0; i < s->n; i++) {
    if (s->points[i].outcome == POINT_FOUND) {
      record_point(s, response, &s->points[i]);
    } else {
      response->branch[s->points[i].branch].complete = false;
    }
  }
  return SHB_OK;
}

static shb_status make_response(const sweep *s, mhb_response **out) {
  mhb_response *response = mhb_response_create(s->model->n_pairs, s->model->n_probes, s->harmonics);
  mhb_receptance *axes   = NULL;
  shb_status      status = fill(s, response);
  if (status == SHB_OK) status = mhb_receptance_create(s->model, s->settings, 1, &axes);
  if (status != SHB_OK) {
    mhb_response_destroy(response);
    return status;
  }
  response->psi = axes->psi;
  response->phi = axes->phi;
  mhb_receptance_destroy(axes);
  *out = response;
  return SHB_OK;
}

/* Under the lock. */
static shb_status publish(sweep *s) {
  mhb_response *response;
  if (!s->publisher.path) return SHB_OK;
  SHB_TRY(make_response(s, &response));
  shb_status status = mhb_publisher_write(&s->publisher, response);
  mhb_response_destroy(response);
  return status;
}

/* ---- all points ---- */

/* Objects of one thread. In a run-up they are created anew at each frequency: the structure is that
 * at its speed. */
typedef struct {
  mhb_speed_model  *at; /* NULL: one speed */
  mhb_settings      settings;
  mhb_integrator   *g;
  mhb_steady_state *steady;
  int               harmonics;
} worker;

static void worker_release(worker *k) {
  mhb_steady_state_destroy(k->steady);
  mhb_integrator_destroy(k->g);
  k->steady = NULL;
  k->g      = NULL;
}

static shb_status worker_attach(worker *k, const modal_model *model) {
  SHB_TRY(mhb_integrator_create(model, &k->settings, k->harmonics, &k->g));
  k->steady = mhb_steady_state_create(k->g);
  return SHB_OK;
}

static shb_status worker_create(const sweep *s, int harmonics, worker *k) {
  *k                 = (worker){.settings = *s->settings, .harmonics = harmonics};
  k->settings.run_up = NULL;
  if (!s->settings->run_up) return worker_attach(k, s->model);
  k->at = mhb_speed_model_create(s->settings->run_up);
  return SHB_OK;
}

static shb_status worker_set_frequency(worker *k, double hz) {
  if (!k->at) return SHB_OK;
  worker_release(k);
  mhb_speed_model_set(k->at, SHB_TWO_PI * hz);
  return worker_attach(k, &k->at->model);
}

static void run_sequence(sweep *s, worker *k, int sequence) {
  for (int i = s->sequence[sequence]; i < s->sequence[sequence + 1]; i++) {
    sweep_point found = s->points[i];
    if (shb_interrupted() || s->publisher.status != SHB_OK) return;
    bool       first  = i == s->sequence[sequence] || s->points[i - 1].outcome == POINT_FAILED;
    shb_status status = worker_set_frequency(k, found.hz);
    if (status == SHB_OK) run_point(s, k->g, k->steady, first, &found);
    mhb_publisher_lock(&s->publisher, true);
    mhb_publisher_note(&s->publisher, status);
    s->points[i] = found;
    s->n_done++;
    shb_progress_show(s->progress, 100. * s->n_done / s->n, "n0 %-8.4g N  %8.3f Hz  %d periods",
                      found.n0, found.hz, found.periods);
    if (mhb_publisher_is_due(&s->publisher, PUBLISH_EVERY))
      mhb_publisher_note(&s->publisher, publish(s));
    mhb_publisher_lock(&s->publisher, false);
  }
}

static shb_status run_all(sweep *s) {
  int most = s->harmonics, threads;
  for (int i = 0; i < s->n; i++)
    if (s->points[i].m > most) most = s->points[i].m;
  mhb_integration_size size = mhb_integration_size_of(s->model, s->settings, most, s->n);
  SHB_TRY(mhb_integration_threads(&size, &threads));
  if (s->n_sequences < threads) threads = s->n_sequences;
#pragma omp parallel if (threads > 1) num_threads(threads > 1 ? threads : 1)
  {
    worker     k;
    shb_status status = worker_create(s, most, &k);
    mhb_publisher_lock(&s->publisher, true);
    mhb_publisher_note(&s->publisher, status);
    mhb_publisher_lock(&s->publisher, false);
#pragma omp for schedule(dynamic, 1)
    for (int i = 0; i < s->n_sequences; i++)
      if (status == SHB_OK) run_sequence(s, &k, i);
    worker_release(&k);
    mhb_speed_model_destroy(k.at);
  }
  return mhb_publisher_status(&s->publisher);
}

static shb_status check_outcome(const sweep *s) {
  int lost = 0, at = -1;
  if (shb_interrupted()) SHB_FAIL(SHB_INTERRUPTED, "interrupted; the points so far are saved");
  for (int i = 0; i < s->n; i++)
    if (s->points[i].outcome == POINT_FAILED) {
      lost++;
      if (at < 0) at = i;
    }
  SHB_CHECK(
      !lost, SHB_NOT_CONVERGED,
      "the contact forces of a step were not found at %d of %d points, first at n0 = %g N, %g "
      "Hz; they are left out; try more integrate.steps",
      lost, s->n, s->points[at].n0, s->points[at].hz);
  return SHB_OK;
}

int mhb_integration_harmonics(const modal_model *model, const mhb_settings *settings,
                              const mhb_integration_settings *request,
                              const mhb_response             *balance) {
  int m = request->harmonics, load = settings->subharmonics * model->n_load;
  if (m == 0) m = balance ? balance->n_harmonics : settings->harmonics ? settings->harmonics : 31;
  return m > load ? m : load;
}

shb_status mhb_integration_sweep(const modal_model *model, const mhb_settings *settings,
                                 const mhb_integration_settings *request,
                                 const mhb_response *balance, const char *path,
                                 const shb_provenance *provenance, shb_progress *progress,
                                 mhb_response **out) {
  sweep s = {.model     = model,
             .settings  = settings,
             .request   = request,
             .balance   = request->start == MHB_START_FROM_BALANCE ? balance : NULL,
             .harmonics = mhb_integration_harmonics(model, settings, request, balance),
             .progress  = progress};
  *out    = NULL;
  SHB_CHECK(!settings->nodal_diameters, SHB_ERR_INPUT,
            "time integration takes a disc as one structure (mhb/structure/dense_disc.h)");
  SHB_CHECK(!settings->run_up || request->start != MHB_START_FROM_STATE, SHB_ERR_INPUT,
            "integrate.start: state takes the state of one structure to the next, but in a run-up "
            "(mhb.run_up) each frequency has its own; set it to balance or rest");
  SHB_CHECK(
      settings->parameter == MHB_IN_FREQUENCY, SHB_ERR_INPUT,
      "the case follows %s at a fixed frequency; points by time integration go over a range of "
      "frequencies",
      mhb_parameter_name(settings->parameter));
  shb_status status = plan(&s);
  mhb_publisher_start(&s.publisher, path, provenance);
  if (status == SHB_OK) status = run_all(&s);
  if (status == SHB_OK) status = publish(&s);
  if (status == SHB_OK) status = make_response(&s, out);
  if (status == SHB_OK) status = check_outcome(&s);
  mhb_publisher_stop(&s.publisher);
  for (int i = 0; i < s.n; i++) {
    free(s.points[i].start);
    free(s.points[i].motion);
    free(s.points[i].state);
  }
  free(s.points);
  free(s.sequence);
  return status;
}
