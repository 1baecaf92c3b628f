#include "mhb/amplification/ring_samples.h"

#include "mhb/branches/harmonic_selection.h"
#include "mhb/branches/main_branch.h"
#include "mhb/branches/sweep_memory.h"
#include "mhb/mistuning/deviations.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "mhb/response/publisher.h"

static const double PUBLISH_EVERY = 10; /* s */

/* Shared by the threads. */
typedef struct {
  const modal_model   *blade;
  const mhb_settings  *settings;
  const mhb_sampling  *sampling;
  const mhb_ring_peak *tuned;
  mhb_response        *response;
  mhb_publisher        publisher;
  shb_progress        *progress;
  int                  handed;  /* samples that the crew was given or does not need */
  int                  threads; /* that memory allows */
} work;

/* ---- the monitor of one curve ---- */

static bool go_on(mhb_monitor *monitor, const mhb_response *response, int branch, int point) {
  (void)monitor;
  (void)response;
  (void)branch;
  (void)point;
  return !shb_interrupted();
}

static bool searching(mhb_monitor *monitor, mhb_sought what, double n0, double value,
                      double share) {
  (void)what;
  (void)n0;
  (void)value;
  (void)share;
  return go_on(monitor, NULL, 0, 0);
}

static bool never_due(mhb_monitor *monitor, const mhb_response *response) {
  (void)monitor;
  (void)response;
  return false;
}

static shb_status publish_nothing(mhb_monitor *monitor, const mhb_response *response) {
  (void)monitor;
  (void)response;
  return SHB_OK;
}

/* ---- one sample ---- */

/* The main curve of a ring at a preload. */
static shb_status trace(const mhb_settings *settings, double n0, mhb_ring_peak *peak) {
  mhb_monitor monitor = {
      .point = go_on, .searching = searching, .is_due = never_due, .publish = publish_nothing};
  const modal_model *whole = &settings->ring->whole;
  int                m[MHB_MAX_LEVELS], n = mhb_harmonic_levels_ladder(whole, settings, m);
  mhb_settings       first   = *settings;
  mhb_balance       *balance = NULL;
  mhb_response      *response =
      mhb_response_create(whole->n_pairs, whole->n_probes, mhb_harmonic_levels_usual(n, m));
  first.harmonics   = m[0];
  response->ring    = settings->ring->blades;
  shb_status status = mhb_balance_create(whole, &first, &balance);
  if (status == SHB_OK) {
    mhb_response_branch(response, MHB_BRANCH_NONLINEAR);
    mhb_balance_set_preload(balance, n0);
    mhb_balance_set_parameter(balance, settings->parameter);
    status = mhb_trace_main_branch(balance, response, &monitor);
  }
  if (status == SHB_OK) *peak = mhb_ring_peak_of(response, &response->branch[0]);
  mhb_balance_destroy(balance);
  mhb_response_destroy(response);
  return status;
}

shb_status mhb_ring_sample(const modal_model *blade, const mhb_settings *asked,
                           const mhb_sampling *sampling, int sample, int preload,
                           mhb_ring_peak *peak) {
  mhb_settings       settings = *asked;
  mhb_mistuned_ring *ring;
  double             deviation[asked->blades];
  *peak         = (mhb_ring_peak){0};
  settings.ring = NULL;
  SHB_TRY(
      mhb_deviations_random(sampling->deviation, sampling->seed, sample, asked->blades, deviation));
  SHB_TRY(mhb_mistuned_ring_create(blade, &settings, deviation, 1, &ring));
  settings.ring      = ring;
  settings.stability = MHB_STABILITY_NEVER; /* the peak alone is kept */
  shb_status status  = trace(&settings, asked->n0[preload], peak);
  mhb_mistuned_ring_destroy(ring);
  if (shb_interrupted()) peak->worst = 0;
  return status;
}

/* With the lock held. */
static void store(work *w, int at, const mhb_ring_peak *peak) {
  mhb_samples *s   = w->response->samples;
  int          all = s->n * s->preloads, done = 0;
  s->factor[at]    = peak->worst / w->tuned[at / s->n].worst;
  s->frequency[at] = peak->worst_at;
  s->blade[at]     = peak->blade;
  s->mark[at]      = peak->marked || w->tuned[at / s->n].marked;
  for (int i = 0; i < all; i++) done += s->factor[i] > 0;
  shb_progress_show(w->progress, 100. * done / all,
                    "sample %d of %d, n0 %.4g N: %.4g times the tuned peak%s", at % s->n + 1, s->n,
                    s->n0[at / s->n], s->factor[at],
                    s->mark[at] ? ", error above the tolerance" : "");
  if (mhb_publisher_is_due(&w->publisher, PUBLISH_EVERY))
    mhb_publisher_note(&w->publisher, mhb_publisher_write(&w->publisher, w->response));
}

/* ---- all of them ---- */

static shb_status make(const mhb_settings *settings, const mhb_sampling *sampling, int preloads,
                       mhb_samples **out) {
  const int N    = settings->ring->blades;
  *out           = mhb_samples_create(sampling->n, preloads, N);
  mhb_samples *s = *out;
  for (int i = 0; i < preloads; i++) s->n0[i] = settings->n0[i];
  for (int i = 0; i < s->n; i++)
    SHB_TRY(mhb_deviations_random(sampling->deviation, sampling->seed, i, N,
                                  s->deviation + (size_t)i * (size_t)N));
  return SHB_OK;
}

/* With the lock held. */
static bool is_wanted(const work *w, int at) {
  const mhb_samples *s = w->response->samples;
  return !(s->factor[at] > 0) && w->publisher.status == SHB_OK && w->tuned[at / s->n].worst > 0;
}

static void run_threads(work *w) {
  const mhb_samples *s = w->response->samples;
#pragma omp parallel for schedule(dynamic, 1) num_threads(w->threads)
  for (int at = 0; at < s->n * s->preloads; at++) {
    mhb_ring_peak peak;
    mhb_publisher_lock(&w->publisher, true);
    const bool wanted = is_wanted(w, at);
    mhb_publisher_lock(&w->publisher, false);
    if (!wanted || shb_interrupted()) continue;
    const shb_status status =
        mhb_ring_sample(w->blade, w->settings, w->sampling, at % s->n, at / s->n, &peak);
    mhb_publisher_lock(&w->publisher, true);
    mhb_publisher_note(&w->publisher, status);
    if (status == SHB_OK && peak.worst > 0) store(w, at, &peak);
    mhb_publisher_lock(&w->publisher, false);
  }
}

/* ---- by a crew: one thread here ---- */

static bool next(void *context, int *sample, int *preload) {
  work              *w = context;
  const mhb_samples *s = w->response->samples;
  while (w->handed < s->n * s->preloads && !is_wanted(w, w->handed)) w->handed++;
  if (w->handed == s->n * s->preloads) return false;
  *sample  = w->handed % s->n;
  *preload = w->handed / s->n;
  w->handed++;
  return true;
}

static shb_status done(void *context, int sample, int preload, const mhb_ring_peak *peak) {
  work *w = context;
  if (peak->worst > 0) store(w, preload * w->response->samples->n + sample, peak);
  return mhb_publisher_status(&w->publisher);
}

static shb_status tick(void *context) {
  (void)context;
  return shb_interrupted() ? SHB_INTERRUPTED : SHB_OK;
}

static void run(work *w) {
  const mhb_sample_work  shared = {w, next, done, tick};
  const mhb_sample_crew *crew   = w->sampling->crew;
  if (!crew) {
    run_threads(w);
    return;
  }
  const shb_status status = crew->share(crew->context, &shared);
  if (status != SHB_INTERRUPTED) mhb_publisher_note(&w->publisher, status);
}

shb_status mhb_ring_samples(const modal_model *blade, const mhb_settings *settings,
                            const mhb_sampling *sampling, const mhb_ring_peak *tuned,
                            const char *path, const shb_provenance *provenance,
                            shb_progress *progress, mhb_response *response) {
  const int    preloads = settings->parameter == MHB_IN_N0 ? 1 : settings->n_preloads;
  work         w        = {.blade    = blade,
                           .settings = settings,
                           .sampling = sampling,
                           .tuned    = tuned,
                           .response = response,
                           .progress = progress};
  mhb_settings one      = *settings;
  one.stability         = MHB_STABILITY_NEVER; /* as in mhb_ring_sample */
  if (sampling->crew) one.sharing = sampling->crew->sharing;
  SHB_TRY(mhb_sweep_threads(&settings->ring->whole, &one, &w.threads));
  if (!response->samples) SHB_TRY(make(settings, sampling, preloads, &response->samples));
  mhb_publisher_start(&w.publisher, path, provenance);
  run(&w);
  shb_status status = mhb_publisher_status(&w.publisher);
  mhb_publisher_stop(&w.publisher);
  SHB_TRY(status);
  return shb_interrupted() ? shb_fail(SHB_INTERRUPTED, __FILE__, __LINE__,
                                      "interrupted; the samples so far are saved")
                           : SHB_OK;
}
