#include "mhb/integration/integration_sweep.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/integration/spectrum.h"
#include "mhb/integration/steady_state.h"
#include "mhb/problem/interfaces.h"
#include "mhb/problem/parameter.h"
#include "mhb/response/describe.h"

static const double PUBLISH_EVERY = 10; /* s */

enum { MOST_STEPS = 8192, SPECTRUM_PERIODS = 64 };

/* One point: what is asked, and what was found. */
typedef struct {
  int             branch;
  double          hz, n0;
  double complex *start; /* [k][3 pairs] forces of the balance, or NULL */
  int             m;     /* its harmonics */
  int             done;  /* 1 found, -1 lost */
  int             multiple, periods;
  double          distance, seconds, error; /* error: of the steps, relative; -1: not known */
  double complex *motion, *force, *probe;   /* [..][k] */
  double         *state, *dissipation;      /* [pair][3], [pair] */
  double          line_frequency[MHB_SPECTRUM_LINES], line_amplitude[MHB_SPECTRUM_LINES];
} cell;

/* What the threads share: cells that are not their own under the lock only. */
typedef struct {
  const modal_model              *model;
  const mhb_settings             *settings;
  const mhb_integration_settings *asked;
  const mhb_response             *balance;
  int                             harmonics; /* kept */
  int                             n, room, n_branches, n_done;
  cell                           *cells;
  int        *chain, n_chains; /* [n_chains + 1] cells of a chain go one after the other */
  const char *path;
  const shb_provenance *provenance;
  shb_progress         *progress;
  omp_lock_t            mutex;
  double                published;
  shb_status            status;
  char                  fault[512];
} witness;

/* ---- what is asked ---- */

static double frequency_of(const witness *w, int i) {
  const double *range = w->settings->frequency;
  if (w->asked->listed) return w->asked->frequency[i];
  int n = w->asked->n_frequencies;
  return n > 1 ? range[0] + (range[1] - range[0]) * i / (n - 1) : .5 * (range[0] + range[1]);
}

static shb_status add_cell(witness *w, int branch, double n0, double hz, cell **out) {
  if (w->n == w->room) {
    int   room  = w->room ? 2 * w->room : 64;
    cell *cells = realloc(w->cells, (size_t)room * sizeof *cells);
    SHB_CHECK(cells, SHB_ERR_IO, "no memory for %d points", room);
    w->cells = cells;
    w->room  = room;
  }
  *out  = &w->cells[w->n++];
  **out = (cell){.branch = branch, .hz = hz, .n0 = n0, .error = -1};
  return SHB_OK;
}

/* A cell that starts between points p and p + 1 of a branch of the balance, if one of them is not unstable. */
static shb_status start_between(witness *w, const mhb_branch *b, int p, int branch, double hz) {
  double part = (hz - b->frequency[p]) / (b->frequency[p + 1] - b->frequency[p]);
  cell  *c    = NULL;
  if (b->stable[p] == 0 && b->stable[p + 1] == 0) return SHB_OK;
  if (b->stable[p] == 0) part = 1;
  if (b->stable[p + 1] == 0) part = 0;
  int K = b->n_harmonics + 1, n3 = 3 * w->balance->n_pairs;
  SHB_TRY(add_cell(w, branch, b->n0[p], hz, &c));
  c->start = malloc(sizeof *c->start * (size_t)(K * n3));
  SHB_CHECK(c->start, SHB_ERR_IO, "out of memory");
  c->m                     = K - 1;
  const double complex *at = b->force + (size_t)p * (size_t)(n3 * K), *next = at + n3 * K;
  for (int i = 0; i < n3 * K; i++)
    c->start[i % K * n3 + i / K] = (1 - part) * at[i] + part * next[i];
  return SHB_OK;
}

/* Curves of another order are left out: their harmonics are those of another fundamental. */
static bool is_at(const witness *w, const mhb_branch *b, double n0) {
  return b->kind == MHB_BRANCH_NONLINEAR && b->n_points > 1 &&
         b->order == w->settings->subharmonics &&
         fabs(b->n0[0] - n0) <= 1e-9 * fmax(fabs(n0), fabs(b->n0[0]));
}

/* hz, a hair inside the range of a branch if it is one of its ends to rounding. */
static double within(const mhb_branch *b, double hz) {
  double low = INFINITY, high = 0, hair = 1e-9 * hz;
  for (int p = 0; p < b->n_points; p++) {
    low  = fmin(low, b->frequency[p]);
    high = fmax(high, b->frequency[p]);
  }
  if (fabs(hz - low) < hair) return low + 1e-3 * hair;
  return fabs(hz - high) < hair ? high - 1e-3 * hair : hz;
}

/* Every stable solution of the balance at a preload and frequency. */
static shb_status start_on_balance(witness *w, int branch, double n0, double hz) {
  bool there = false;
  for (int i = 0; i < w->balance->n_branches; i++) {
    const mhb_branch *b = &w->balance->branch[i];
    if (!is_at(w, b, n0)) continue;
    there     = true;
    double at = within(b, hz);
    for (int p = 0; p + 1 < b->n_points; p++)
      if ((b->frequency[p] <= at) != (b->frequency[p + 1] <= at))
        SHB_TRY(start_between(w, b, p, branch, at));
  }
  SHB_CHECK(there, SHB_ERR_INPUT,
            "the response file has no curve at n0 = %g N to start on; run shroudhb mhb first, or "
            "set integrate.start to rest or state",
            n0);
  return SHB_OK;
}

static shb_status ask_state(witness *w, int branch, double n0, bool down) {
  int n = w->asked->n_frequencies;
  for (int i = 0; i < n; i++) {
    cell *c;
    SHB_TRY(add_cell(w, branch, n0, frequency_of(w, down ? n - 1 - i : i), &c));
  }
  return SHB_OK;
}

static shb_status ask(witness *w) {
  const mhb_integration_settings *a = w->asked;
  for (int i = 0; i < w->settings->n_preloads; i++) {
    double n0 = w->settings->n0[i];
    if (a->start == MHB_START_FROM_STATE) {
      if (a->direction != MHB_SWEEP_DOWN) SHB_TRY(ask_state(w, w->n_branches++, n0, false));
      if (a->direction != MHB_SWEEP_UP) SHB_TRY(ask_state(w, w->n_branches++, n0, true));
      continue;
    }
    for (int k = 0; k < a->n_frequencies; k++) {
      cell *c;
      if (a->start == MHB_START_FROM_BALANCE) {
        SHB_TRY(start_on_balance(w, w->n_branches, n0, frequency_of(w, k)));
      } else {
        SHB_TRY(add_cell(w, w->n_branches, n0, frequency_of(w, k), &c));
      }
    }
    w->n_branches++;
  }
  w->chain = calloc((size_t)w->n + 1, sizeof(int));
  SHB_CHECK(w->chain, SHB_ERR_IO, "out of memory");
  for (int i = 0; i < w->n; i++)
    if (a->start != MHB_START_FROM_STATE || i == 0 || w->cells[i].branch != w->cells[i - 1].branch)
      w->chain[w->n_chains++] = i;
  w->chain[w->n_chains] = w->n;
  return SHB_OK;
}

/* ---- one point ---- */

static int go_on(void *context) {
  (void)context;
  return !shb_interrupted();
}

/* Harmonics of the first size values of each row, of both, relative. */
static double difference(const double complex *a, const double complex *b, int n) {
  double apart = 0, size = 0;
  for (int i = 0; i < n; i++) {
    apart += creal((a[i] - b[i]) * conj(a[i] - b[i]));
    size += creal(a[i] * conj(a[i]));
  }
  return size > 0 ? sqrt(apart / size) : 0;
}

/* Twice the steps until two runs agree. */
static const mhb_steady_state_result *refine(const witness *w, mhb_integrator *g,
                                             mhb_steady_state                *orbit,
                                             const mhb_steady_state_settings *settings,
                                             const mhb_steady_state_result *r, cell *c) {
  int             n = 3 * r->n_pairs * (r->n_harmonics + 1), periods = r->periods;
  double complex *last = malloc(sizeof *last * (size_t)n);
  for (int steps = 2 * g->steps; last && r->multiple && !r->lost && steps <= MOST_STEPS;
       steps *= 2) {
    memcpy(last, r->motion, sizeof *last * (size_t)n);
    mhb_integrator_set(g, g->omega, g->n0, steps);
    r        = mhb_steady_state_run(orbit, settings, go_on, NULL);
    c->error = difference(r->motion, last, n);
    periods += r->periods;
    if (c->error <= w->asked->tolerance || shb_interrupted()) break;
  }
  c->periods = periods;
  free(last);
  return r;
}

static void keep_rows(int rows, int from, int to, const double complex *in, double complex *out) {
  for (int i = 0; i < rows; i++)
    memcpy(out + i * (to + 1), in + i * (from + 1), sizeof *in * (size_t)(to + 1));
}

static int keep(const witness *w, const mhb_steady_state_result *r, cell *c) {
  int    K = w->harmonics + 1, n3 = 3 * r->n_pairs, q = 3 * r->n_probes;
  size_t rows = 2 * (size_t)n3 + (size_t)q;
  c->motion   = malloc(sizeof *c->motion * rows * (size_t)K + 1);
  c->state    = malloc(sizeof(double) * 4 * (size_t)r->n_pairs);
  if (!c->motion || !c->state) return 0;
  c->force       = c->motion + n3 * K;
  c->probe       = c->force + n3 * K;
  c->dissipation = c->state + 3 * r->n_pairs;
  keep_rows(n3, r->n_harmonics, w->harmonics, r->motion, c->motion);
  keep_rows(n3, r->n_harmonics, w->harmonics, r->force, c->force);
  keep_rows(q, r->n_harmonics, w->harmonics, r->probe, c->probe);
  memcpy(c->state, r->state, sizeof(double) * 3 * (size_t)r->n_pairs);
  memcpy(c->dissipation, r->dissipation, sizeof(double) * (size_t)r->n_pairs);
  c->multiple = r->multiple;
  c->distance = r->distance;
  return 1;
}

/* first: of its chain. */
static shb_status run_cell(const witness *w, mhb_integrator *g, mhb_steady_state *orbit, bool first,
                           cell *c) {
  const mhb_integration_settings *a        = w->asked;
  mhb_steady_state_settings       settings = {.1 * a->tolerance, a->max_periods};
  double                          began    = shb_seconds();
  mhb_integrator_set(g, SHB_TWO_PI * c->hz, c->n0, a->steps);
  if (c->start) {
    mhb_integrator_balance(g, c->m, c->start);
  } else if (a->start == MHB_START_FROM_REST || first) {
    mhb_integrator_rest(g);
  }
  const mhb_steady_state_result *r = mhb_steady_state_run(orbit, &settings, go_on, NULL);
  c->periods                       = r->periods;
  if (r->multiple && !r->lost) r = refine(w, g, orbit, &settings, r, c);
  if (shb_interrupted()) return SHB_OK;
  if (!r->lost) SHB_CHECK(keep(w, r, c), SHB_ERR_IO, "out of memory");
  c->done = r->lost ? -1 : 1;
  if (c->done > 0 && !c->multiple &&
      !mhb_spectrum(g, SPECTRUM_PERIODS, c->line_frequency, c->line_amplitude))
    c->line_amplitude[0] = 0;
  c->seconds = shb_seconds() - began;
  return SHB_OK;
}

/* ---- the response ---- */

static void record_preloads(const witness *w, int n, mhb_branch *b, int at, double n0) {
  mhb_operating_point c = mhb_operating_point_of(w->settings);
  c.n0                  = n0;
  for (int i = 0; i < n; i++)
    b->interface_n0[at * n + i] = mhb_interface_operating_point(&c, w->settings, i).n0;
}

static shb_status put_cell(const witness *w, mhb_response *response, const cell *c) {
  int    at, K = response->n_harmonics + 1;
  size_t n3 = 3 * (size_t)response->n_pairs * (size_t)K,
         q  = 3 * (size_t)response->n_probes * (size_t)K;
  SHB_TRY(mhb_response_point(response, c->branch, &at));
  mhb_branch *b     = &response->branch[c->branch];
  size_t      pairs = (size_t)response->n_pairs;
  b->frequency[at]  = c->hz;
  b->n0[at]         = c->n0;
  record_preloads(w, response->n_interfaces, b, at, c->n0);
  b->value[at]            = c->hz;
  b->stable[at]           = c->multiple ? 1 : -1;
  b->seconds[at]          = c->seconds;
  b->error_newton[at]     = c->multiple ? c->distance : -1;
  b->error_truncation[at] = 0;
  b->error_sampling[at]   = c->error;
  b->error_modal[at]      = -1;
  b->multiple[at]         = c->multiple;
  b->periods[at]          = c->periods;
  b->distance[at]         = c->distance;
  memcpy(b->motion + (size_t)at * n3, c->motion, sizeof *c->motion * n3);
  memcpy(b->force + (size_t)at * n3, c->force, sizeof *c->force * n3);
  if (q) memcpy(b->probe + (size_t)at * q, c->probe, sizeof *c->probe * q);
  memcpy(b->state + 3 * pairs * (size_t)at, c->state, sizeof(double) * 3 * pairs);
  memcpy(b->dissipation + pairs * (size_t)at, c->dissipation, sizeof(double) * pairs);
  size_t line = (size_t)at * MHB_SPECTRUM_LINES;
  memcpy(b->line_frequency + line, c->line_frequency, sizeof c->line_frequency);
  memcpy(b->line_amplitude + line, c->line_amplitude, sizeof c->line_amplitude);
  return SHB_OK;
}

static const char *name_of(const witness *w, int branch) {
  static const char *const name[]   = {"from the balance", "from rest", "up, from the state before",
                                       "down, from the state before"};
  const mhb_integration_settings *a = w->asked;
  if (a->start != MHB_START_FROM_STATE) return name[a->start];
  return name[a->direction == MHB_SWEEP_DOWN || (a->direction == MHB_SWEEP_BOTH && branch % 2) ? 3
                                                                                               : 2];
}

static shb_status fill(const witness *w, mhb_response *response) {
  SHB_TRY(mhb_response_describe(response, w->model, w->settings));
  response->n_multipliers = 0;
  response->n_lines       = MHB_SPECTRUM_LINES;
  for (int i = 0; i < w->n_branches; i++) {
    int branch;
    SHB_TRY(mhb_response_branch(response, MHB_BRANCH_INTEGRATION, &branch));
    response->branch[branch].complete = true;
    response->branch[branch].reason   = strdup(name_of(w, i));
    SHB_CHECK(response->branch[branch].reason, SHB_ERR_IO, "out of memory");
  }
  for (int i = 0; i < w->n; i++) {
    if (w->cells[i].done > 0) {
      SHB_TRY(put_cell(w, response, &w->cells[i]));
    } else {
      response->branch[w->cells[i].branch].complete = false;
    }
  }
  return SHB_OK;
}

static shb_status make_response(const witness *w, mhb_response **out) {
  mhb_response *response = mhb_response_create(w->model->n_pairs, w->model->n_probes, w->harmonics);
  mhb_receptance *axes   = NULL;
  SHB_CHECK(response, SHB_ERR_IO, "out of memory");
  shb_status status = fill(w, response);
  if (status == SHB_OK) status = mhb_receptance_create(w->model, w->settings, 1, &axes);
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

static shb_status publish(witness *w) {
  mhb_response *response;
  w->published = shb_seconds();
  if (!w->path) return SHB_OK;
  SHB_TRY(make_response(w, &response));
  shb_status status = mhb_response_write(response, w->path, w->provenance);
  mhb_response_destroy(response);
  return status;
}

/* ---- all points ---- */

static void note(witness *w, shb_status status) {
  if (status == SHB_OK || w->status != SHB_OK) return;
  w->status = status;
  snprintf(w->fault, sizeof w->fault, "%s", shb_message());
}

/* What a thread has. In a run-up each frequency has a structure of its own, which stays as it is while it is integrated. */
typedef struct {
  mhb_speed_model  *at; /* NULL: one speed */
  mhb_settings      settings;
  mhb_integrator   *g;
  mhb_steady_state *orbit;
  int               harmonics;
} worker;

static void worker_drop(worker *k) {
  mhb_steady_state_destroy(k->orbit);
  mhb_integrator_destroy(k->g);
  k->orbit = NULL;
  k->g     = NULL;
}

static shb_status worker_take(worker *k, const modal_model *model) {
  SHB_TRY(mhb_integrator_create(model, &k->settings, k->harmonics, &k->g));
  return mhb_steady_state_create(k->g, &k->orbit);
}

static shb_status worker_create(const witness *w, int harmonics, worker *k) {
  *k                 = (worker){.settings = *w->settings, .harmonics = harmonics};
  k->settings.run_up = NULL;
  return w->settings->run_up ? mhb_speed_model_create(w->settings->run_up, &k->at)
                             : worker_take(k, w->model);
}

static shb_status worker_go(worker *k, double hz) {
  if (!k->at) return SHB_OK;
  worker_drop(k);
  mhb_speed_model_set(k->at, SHB_TWO_PI * hz);
  return worker_take(k, &k->at->model);
}

static void run_chain(witness *w, worker *k, int chain) {
  for (int i = w->chain[chain]; i < w->chain[chain + 1]; i++) {
    cell found = w->cells[i];
    if (shb_interrupted() || w->status != SHB_OK) return;
    bool       first  = i == w->chain[chain] || w->cells[i - 1].done < 0;
    shb_status status = worker_go(k, found.hz);
    if (status == SHB_OK) status = run_cell(w, k->g, k->orbit, first, &found);
    omp_set_lock(&w->mutex);
    note(w, status);
    w->cells[i] = found;
    w->n_done++;
    shb_progress_show(w->progress, 100. * w->n_done / w->n, "n0 %-8.4g N  %8.3f Hz  %d periods",
                      found.n0, found.hz, found.periods);
    if (w->path && shb_seconds() - w->published > PUBLISH_EVERY && w->status == SHB_OK)
      note(w, publish(w));
    omp_unset_lock(&w->mutex);
  }
}

static shb_status run_all(witness *w) {
  int most = w->harmonics;
  for (int i = 0; i < w->n; i++)
    if (w->cells[i].m > most) most = w->cells[i].m;
#pragma omp parallel if (w->n_chains > 1)
  {
    worker     k;
    shb_status status = worker_create(w, most, &k);
    omp_set_lock(&w->mutex);
    note(w, status);
    omp_unset_lock(&w->mutex);
#pragma omp for schedule(dynamic, 1)
    for (int i = 0; i < w->n_chains; i++)
      if (status == SHB_OK) run_chain(w, &k, i);
    worker_drop(&k);
    mhb_speed_model_destroy(k.at);
  }
  if (w->status != SHB_OK) return shb_fail(w->status, __FILE__, __LINE__, "%s", w->fault);
  return SHB_OK;
}

static shb_status outcome(const witness *w) {
  int lost = 0, at = -1;
  if (shb_interrupted()) SHB_FAIL(SHB_INTERRUPTED, "interrupted; the points so far are saved");
  for (int i = 0; i < w->n; i++)
    if (w->cells[i].done < 0) {
      lost++;
      if (at < 0) at = i;
    }
  SHB_CHECK(
      !lost, SHB_NOT_CONVERGED,
      "the contact forces of a step were not found at %d of %d points, first at n0 = %g N, %g "
      "Hz; they are left out; try more integrate.steps",
      lost, w->n, w->cells[at].n0, w->cells[at].hz);
  return SHB_OK;
}

static int harmonics_of(const modal_model *model, const mhb_settings *settings,
                        const mhb_integration_settings *asked, const mhb_response *balance) {
  int m = asked->harmonics, load = settings->subharmonics * model->n_load;
  if (m == 0) m = balance ? balance->n_harmonics : settings->harmonics ? settings->harmonics : 31;
  return m > load ? m : load;
}

shb_status mhb_integration_sweep(const modal_model *model, const mhb_settings *settings,
                                 const mhb_integration_settings *asked, const mhb_response *balance,
                                 const char *path, const shb_provenance *provenance,
                                 shb_progress *progress, mhb_response **out) {
  witness w = {.model      = model,
               .settings   = settings,
               .asked      = asked,
               .balance    = asked->start == MHB_START_FROM_BALANCE ? balance : NULL,
               .harmonics  = harmonics_of(model, settings, asked, balance),
               .path       = path,
               .provenance = provenance,
               .progress   = progress,
               .published  = shb_seconds()};
  *out      = NULL;
  SHB_CHECK(!settings->run_up || asked->start != MHB_START_FROM_STATE, SHB_ERR_INPUT,
            "integrate.start: state takes the state of one structure to the next, but in a run-up "
            "(mhb.run_up) each frequency has its own; set it to balance or rest");
  SHB_CHECK(
      settings->parameter == MHB_IN_FREQUENCY, SHB_ERR_INPUT,
      "the case follows %s at a fixed frequency; points by time integration go over a range of "
      "frequencies",
      mhb_parameter_name(settings->parameter));
  shb_status status = ask(&w);
  omp_init_lock(&w.mutex);
  if (status == SHB_OK) status = run_all(&w);
  if (status == SHB_OK) status = publish(&w);
  if (status == SHB_OK) status = make_response(&w, out);
  if (status == SHB_OK) status = outcome(&w);
  omp_destroy_lock(&w.mutex);
  for (int i = 0; i < w.n; i++) {
    free(w.cells[i].start);
    free(w.cells[i].motion);
    free(w.cells[i].state);
  }
  free(w.cells);
  free(w.chain);
  return status;
}
