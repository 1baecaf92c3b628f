#include "mhb/branches/forced_response.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/branches/branch_stability.h"
#include "mhb/branches/harmonic_selection.h"
#include "mhb/branches/linear_limits.h"
#include "mhb/branches/main_branch.h"
#include "mhb/branches/secondary_branches.h"
#include "mhb/response/describe.h"
#include "mhb/structure/stiffness_check.h"

static const double PUBLISH_EVERY = 10, BRANCH_END_EVERY = 1; /* s */

/* What the threads share: all of it touched under the lock only. */
typedef struct {
  mhb_monitor           base;     /* first: the callbacks get it back */
  const mhb_settings   *settings; /* harmonics: the first number tried */
  mhb_response         *response;
  const char           *path;
  const shb_provenance *provenance;
  shb_progress         *progress;
  omp_lock_t            mutex;
  double               *done;       /* [preload] share of its work that is done */
  double                main_share; /* of that: the main branch */
  double                published;
  shb_status            status; /* first failure, and its text: messages are per thread */
  char                  fault[512];
} sweep;

static void lock(mhb_monitor *monitor, bool locked) {
  sweep *s = (sweep *)monitor;
  if (locked) {
    omp_set_lock(&s->mutex);
  } else {
    omp_unset_lock(&s->mutex);
  }
}

static shb_status publish(sweep *s) {
  shb_status status = s->path ? mhb_response_write(s->response, s->path, s->provenance) : SHB_OK;
  s->published      = shb_seconds();
  return status;
}

/* Keep the first failure of any thread, under the lock. */
static void note_failure(sweep *s, shb_status status) {
  if (status == SHB_OK || s->status != SHB_OK) return;
  s->status = status;
  snprintf(s->fault, sizeof s->fault, "%s", shb_message());
}

static bool point(mhb_monitor *monitor, int branch, const mhb_curve_point *at) {
  sweep              *s    = (sweep *)monitor;
  const mhb_settings *c    = s->settings;
  const mhb_branch   *b    = &s->response->branch[branch];
  mhb_parameter       what = c->parameter;
  double low = mhb_parameter_end(c, what, 0), high = mhb_parameter_end(c, what, 1), total = 0;
  if (b->main == branch) s->done[branch - 2] = s->main_share * (at->value - low) / (high - low);
  for (int i = 0; i < c->n_preloads; i++) total += s->done[i];
  int                   K = b->n_harmonics + 1, first = b->order < K ? b->order : K - 1;
  const double complex *u =
      b->motion + (size_t)(b->n_points - 1) * 3 * (size_t)s->response->n_pairs * (size_t)K;
  double amplitude =
      sqrt(pow(cabs(u[first]), 2) + pow(cabs(u[K + first]), 2) + pow(cabs(u[2 * K + first]), 2));
  shb_progress_show(s->progress, 100 * total / c->n_preloads,
                    "n0 %-8.4g N  point %-4d  %s %9.6g %s  %.3e m", b->n0[b->n_points - 1],
                    b->n_points, what == MHB_IN_FREQUENCY ? "at" : mhb_parameter_name(what),
                    mhb_parameter_shown(what, at->value), mhb_parameter_unit(what), amplitude);
  if (s->path && shb_seconds() - s->published > PUBLISH_EVERY && s->status == SHB_OK)
    note_failure(s, publish(s));
  return !shb_interrupted() && s->status == SHB_OK;
}

static bool looking(mhb_monitor *monitor, int branch, double value, double share) {
  sweep        *s     = (sweep *)monitor;
  mhb_parameter what  = s->settings->parameter;
  double        total = 0;
  s->done[branch - 2] = s->main_share + (1 - s->main_share) * share;
  for (int i = 0; i < s->settings->n_preloads; i++) total += s->done[i];
  shb_progress_show(s->progress, 100 * total / s->settings->n_preloads,
                    "n0 %-8.4g N  looking for other curves at %.6g %s",
                    s->response->branch[branch].n0[0], mhb_parameter_shown(what, value),
                    mhb_parameter_unit(what));
  return !shb_interrupted() && s->status == SHB_OK;
}

static shb_status linear_limits(const modal_model *model, const mhb_settings *settings,
                                mhb_response *response) {
  mhb_balance *residual = NULL;
  SHB_TRY(mhb_balance_create(model, settings, &residual));
  response->psi = residual->receptance->psi;
  response->phi = residual->receptance->phi;
  double most   = settings->n0[0];
  for (int i = 1; i < settings->n_preloads; i++) most = fmax(most, settings->n0[i]);
  mhb_balance_set_preload(residual, most);
  mhb_balance_set_parameter(residual, settings->parameter);
  shb_status status = mhb_stiffness_check(residual->receptance, settings);
  for (int stuck = 0; stuck < 2 && status == SHB_OK; stuck++) {
    int branch;
    status = mhb_response_branch(response, stuck ? MHB_BRANCH_STUCK : MHB_BRANCH_OPEN, &branch);
    if (status == SHB_OK) status = mhb_linear_limits(residual, response, branch);
  }
  mhb_balance_destroy(residual);
  return status;
}

/* The main branch of a preload. */
static shb_status main_branch(sweep *s, const modal_model *model, int i) {
  mhb_balance *residual = NULL;
  lock(&s->base, true); /* FFTW's planner */
  shb_status status = mhb_balance_create(model, s->settings, &residual);
  lock(&s->base, false);
  if (status != SHB_OK) return status;
  mhb_balance_set_preload(residual, s->settings->n0[i]);
  mhb_balance_set_parameter(residual, s->settings->parameter);
  status = mhb_trace_main_branch(residual, s->response, 2 + i, &s->base);
  lock(&s->base, true);
  mhb_balance_destroy(residual);
  lock(&s->base, false);
  return status;
}

/* One preload on this thread; what an earlier run finished is there already. */
static shb_status one_preload(sweep *s, const modal_model *model, int i) {
  mhb_branch *main   = &s->response->branch[2 + i];
  shb_status  status = main->complete ? SHB_OK : main_branch(s, model, i);
  if (status == SHB_OK && !main->searched && !shb_interrupted())
    status = mhb_secondary_branches(model, s->settings, s->response, 2 + i, &s->base);
  lock(&s->base, true);
  s->done[i] = 1;
  if (status == SHB_OK && s->path && shb_seconds() - s->published > BRANCH_END_EVERY)
    status = publish(s);
  lock(&s->base, false);
  return status;
}

static void take_over(mhb_response *response, int index, mhb_branch *old) {
  mhb_branch fresh        = response->branch[index];
  response->branch[index] = *old;
  *old                    = fresh;
}

/* Take over the branches that an interrupted run of the same settings finished. */
static void resume(sweep *s) {
  hid_t         file;
  char         *settings = NULL;
  mhb_response *old      = NULL;
  if (!s->path || h5_open(s->path, &file) != SHB_OK) return;
  bool same = h5_read_attribute_text(file, "/", "settings", &settings) == SHB_OK && settings &&
              strcmp(settings, s->provenance->settings) == 0;
  h5_close(file);
  free(settings);
  if (!same || mhb_response_read(s->path, &old) != SHB_OK) return;
  bool fits = old->n_multipliers == s->response->n_multipliers;
  for (int i = 2; fits && i < s->response->n_branches && i < old->n_branches; i++) {
    if (!old->branch[i].complete) continue;
    take_over(s->response, i, &old->branch[i]);
    s->done[i - 2] = s->response->branch[i].searched ? 1 : s->main_share;
  }
  for (int i = 2 + s->settings->n_preloads; fits && i < old->n_branches; i++) {
    int main = old->branch[i].main, index;
    if (main == i || main >= 2 + s->settings->n_preloads) continue;
    const mhb_branch *trunk = &s->response->branch[main];
    bool              whole = trunk->searched || old->branch[i].origin == MHB_FROM_DETACHED;
    if (!trunk->complete || !whole ||
        mhb_response_branch(s->response, MHB_BRANCH_NONLINEAR, &index) != SHB_OK)
      continue;
    take_over(s->response, index, &old->branch[i]);
  }
  mhb_response_destroy(old);
}

/* Branches that turned out not to be there. */
static void drop_empty(mhb_response *response) {
  bool drop[response->n_branches];
  for (int i = 0; i < response->n_branches; i++)
    drop[i] = response->branch[i].main != i && response->branch[i].n_points == 0;
  mhb_response_drop(response, drop);
}

static shb_status all_preloads(sweep *s, const modal_model *model) {
  int  n      = s->settings->n_preloads;
  bool wanted = mhb_secondary_branches_wanted(s->settings);
  for (int i = 0; i < n; i++) {
    int branch;
    SHB_TRY(mhb_response_branch(s->response, MHB_BRANCH_NONLINEAR, &branch));
    s->response->branch[branch].searched = !wanted;
  }
  SHB_TRY(
      mhb_response_reserve(s->response, n * (MHB_MAX_DETACHED + (wanted ? MHB_MAX_SECONDARY : 0))));
  if (s->settings->resume) resume(s);
#pragma omp parallel for schedule(dynamic, 1) if (n > 1) /* else the threads go to the pairs */
  for (int i = 0; i < n; i++) {
    const mhb_branch *main = &s->response->branch[2 + i];
    if (shb_interrupted() || (main->complete && main->searched)) continue;
    shb_status status = one_preload(s, model, i);
    lock(&s->base, true);
    note_failure(s, status);
    lock(&s->base, false);
  }
  if (s->status != SHB_OK) return shb_fail(s->status, __FILE__, __LINE__, "%s", s->fault);
  drop_empty(s->response);
  mhb_response_sort(s->response);
  return SHB_OK;
}

/* A further branch that does not cover its range is told in the file; the sweep has what it set out for. */
static shb_status outcome(const mhb_response *response, const mhb_settings *settings) {
  for (int i = 0; i < response->n_branches; i++) {
    const mhb_branch *branch = &response->branch[i];
    if (branch->complete || branch->main != i) continue;
    return shb_fail(SHB_NOT_CONVERGED, __FILE__, __LINE__,
                    "branch %d (n0 = %g N) did not cover the range: %s", i, settings->n0[i - 2],
                    branch->reason ? branch->reason : "not started");
  }
  return SHB_OK;
}

/* A load harmonic that the balance has no room for would vanish without a word. */
static shb_status check_load(const modal_model *model, const mhb_settings *settings) {
  for (int h = settings->harmonics / settings->subharmonics + 1; h <= model->n_load; h++) {
    double size = 0;
    for (int i = 0; i < model->n_modes; i++)
      size += cabs(model->modal_force[h * model->n_modes + i]);
    SHB_CHECK(size == 0, SHB_ERR_INPUT,
              "the modal file's load has harmonic %d, which needs mhb.harmonics of %d or more", h,
              h * settings->subharmonics);
  }
  return SHB_OK;
}

shb_status mhb_forced_response(const modal_model *model, const mhb_settings *asked,
                               const char *path, const shb_provenance *provenance,
                               shb_progress *progress, mhb_response **out) {
  int          m[MHB_MAX_LEVELS], rungs = mhb_harmonic_levels_ladder(model, asked, m);
  mhb_settings first = *asked, *settings = &first;
  *out            = NULL;
  first.harmonics = m[rungs - 1];
  SHB_TRY(check_load(model, settings));
  first.harmonics = m[0];
  if (first.parameter == MHB_IN_N0) first.n_preloads = 1;
  sweep s    = {.base       = {.point = point, .lock = lock, .looking = looking},
                .settings   = settings,
                .path       = path,
                .provenance = provenance,
                .progress   = progress,
                .main_share = settings->search.starts > 0 ? .3 : 1,
                .published  = shb_seconds()};
  s.response = mhb_response_create(model->n_pairs, model->n_probes, m[rungs - 1]);
  s.done     = calloc((size_t)settings->n_preloads, sizeof(double));
  shb_status status =
      s.response && s.done ? SHB_OK : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  if (status == SHB_OK) status = mhb_response_describe(s.response, model, settings);
  if (status == SHB_OK) status = linear_limits(model, settings, s.response);
  omp_init_lock(&s.mutex);
  if (status == SHB_OK) status = all_preloads(&s, model);
  if (status == SHB_OK) status = publish(&s);
  omp_destroy_lock(&s.mutex);
  free(s.done);
  if (status != SHB_OK) {
    mhb_response_destroy(s.response);
    return status;
  }
  *out = s.response;
  if (shb_interrupted())
    return shb_fail(SHB_INTERRUPTED, __FILE__, __LINE__,
                    "interrupted; the points so far are saved");
  return outcome(s.response, settings);
}
