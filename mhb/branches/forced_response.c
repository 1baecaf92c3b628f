#include "mhb/branches/forced_response.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/balance/truncation_error.h"
#include "mhb/branches/branch_stability.h"
#include "mhb/branches/harmonic_selection.h"
#include "mhb/branches/lasting_motion.h"
#include "mhb/branches/linear_limits.h"
#include "mhb/branches/main_branch.h"
#include "mhb/branches/peak_search.h"
#include "mhb/branches/secondary_branches.h"
#include "mhb/branches/sweep_memory.h"
#include "mhb/response/describe.h"
#include "mhb/response/face_wear.h"
#include "mhb/response/modal_motion.h"
#include "mhb/response/publisher.h"
#include "mhb/structure/stiffness_check.h"

static const double PUBLISH_EVERY = 10, BRANCH_END_EVERY = 1; /* s */

/* Share of a preload's work that is the main branch where other branches are searched for. */
static const double MAIN_SHARE = 0.3;

/* The curves of a preload: branch 0 is the main one. The thread at work on it owns them, and hands
 * over copies. */
typedef struct {
  mhb_response *own, *handed;
  double        done; /* share of its work */
  double        handed_at;
} preload_curves;

/* Shared by the threads. It is used under the publisher's lock only, but for the curves that a
 * thread owns. */
typedef struct {
  mhb_monitor         base;     /* first: the callbacks get it back */
  const mhb_settings *settings; /* harmonics: the first number tried */
  mhb_response       *response; /* the linear limits; at publication all of it */
  mhb_publisher       publisher;
  shb_progress       *progress;
  preload_curves     *preload;    /* [preload] */
  double              main_share; /* of a preload's work: the main branch */
  int                 threads;    /* that memory allows */
} sweep;

/* ---- publication ---- */

static void take(mhb_branch *to, mhb_branch *from) {
  mhb_branch old = *to;
  *to            = *from;
  *from          = old;
}

/* Append a branch beside a main one. Its arrays stay those of the preload. */
static void append_branch(mhb_response *response, const mhb_branch *branch, int main) {
  const int index              = mhb_response_branch(response, MHB_BRANCH_NONLINEAR);
  response->branch[index]      = *branch;
  response->branch[index].main = main;
}

/* The curves handed over so far become the response's branches 2.. for the time of a call: main
 * branches in the order of the preloads, then the others, grouped by their main one. */
static void gather(sweep *s) {
  mhb_response *r = s->response;
  for (int i = 0; i < s->settings->n_preloads; i++) {
    const int index = mhb_response_branch(r, MHB_BRANCH_NONLINEAR);
    if (!s->preload[i].handed) continue;
    r->branch[index]      = s->preload[i].handed->branch[0];
    r->branch[index].main = index;
  }
  for (int i = 0; i < s->settings->n_preloads; i++) {
    const mhb_response *handed = s->preload[i].handed;
    for (int k = 1; handed && k < handed->n_branches; k++)
      append_branch(r, &handed->branch[k], 2 + i);
  }
}

static shb_status publish(sweep *s) {
  gather(s);
  const shb_status status = mhb_publisher_write(&s->publisher, s->response);
  s->response->n_branches = 2; /* the others belong to the preloads */
  return status;
}

/* A copy of a preload's own curves. */
static mhb_response *copy_curves(const mhb_response *own) {
  mhb_response *copy = mhb_response_like(own);
  for (int k = 0; k < own->n_branches; k++) {
    const mhb_branch *from = &own->branch[k];
    if (k > 0 && from->n_points == 0) continue; /* under way, or not there */
    const int   index  = mhb_response_branch(copy, from->kind);
    mhb_branch *to     = &copy->branch[index];
    to->origin         = from->origin;
    to->order          = from->order;
    to->n_harmonics    = from->n_harmonics;
    to->main           = from->main;
    to->searched       = from->searched;
    to->flips_untraced = from->flips_untraced;
    to->complete       = from->complete;
    for (int i = 0; i < from->n_searches; i++) mhb_response_note_search(to, &from->search[i]);
    to->reason = from->reason ? shb_text(from->reason) : NULL;
    mhb_response_copy_lasting(to, from);
    const mhb_unfinished *under_way = from->unfinished;
    if (under_way)
      to->unfinished = mhb_unfinished_copy(under_way->segments, under_way->n, under_way->state);
    if (from->n_points > 0) mhb_response_copy_points(copy, index, own, k, 0, from->n_points - 1);
  }
  return copy;
}

/* Under the lock: a thread that ends a preload gives its curves away. */
static preload_curves *preload_of(sweep *s, const mhb_response *own) {
  preload_curves *found = NULL;
  mhb_publisher_lock(&s->publisher, true);
  for (int i = 0; i < s->settings->n_preloads; i++)
    if (s->preload[i].own == own) found = &s->preload[i];
  mhb_publisher_lock(&s->publisher, false);
  return found;
}

/* ---- the monitor ---- */

static bool go_on(const sweep *s) {
  return !shb_interrupted() && s->publisher.status == SHB_OK;
}

static bool point(mhb_monitor *monitor, const mhb_response *own, int branch, int at) {
  sweep              *s         = (sweep *)monitor;
  const mhb_settings *c         = s->settings;
  const mhb_branch   *b         = &own->branch[branch];
  mhb_parameter       what      = c->parameter;
  double              amplitude = mhb_response_amplitude(own, b, at, own->n_probes);
  double              low       = mhb_parameter_shown(what, mhb_parameter_end(c, what, 0));
  double              high = mhb_parameter_shown(what, mhb_parameter_end(c, what, 1)), total = 0;
  mhb_publisher_lock(&s->publisher, true);
  for (int i = 0; i < c->n_preloads; i++) {
    if (c->n0[i] == b->n0[at] && s->preload[i].done < s->main_share)
      s->preload[i].done = s->main_share * (b->value[at] - low) / (high - low);
    total += s->preload[i].done;
  }
  shb_progress_show(s->progress, 100 * total / c->n_preloads,
                    "n0 %-8.4g N  point %-4d  %s %9.6g %s  %.3e m", b->n0[at], at + 1,
                    what == MHB_IN_FREQUENCY ? "at" : mhb_parameter_name(what), b->value[at],
                    mhb_parameter_unit(what), amplitude);
  bool on = go_on(s);
  mhb_publisher_lock(&s->publisher, false);
  return on;
}

static bool searching(mhb_monitor *monitor, mhb_sought what, double n0, double value,
                      double share) {
  sweep              *s     = (sweep *)monitor;
  const mhb_settings *c     = s->settings;
  double              total = 0;
  mhb_publisher_lock(&s->publisher, true);
  for (int i = 0; i < c->n_preloads; i++) {
    if (c->n0[i] == n0 && what == MHB_SEEKS_OTHERS)
      s->preload[i].done = s->main_share + (1 - s->main_share) * share;
    total += s->preload[i].done;
  }
  shb_progress_show(s->progress, 100 * total / c->n_preloads,
                    "n0 %-8.4g N  looking for %s at %.6g %s", n0,
                    what == MHB_SEEKS_FIRST ? "a first solution" : "other curves", value,
                    mhb_parameter_unit(c->parameter));
  bool on = go_on(s);
  mhb_publisher_lock(&s->publisher, false);
  return on;
}

static bool is_due(mhb_monitor *monitor, const mhb_response *own) {
  sweep          *s = (sweep *)monitor;
  preload_curves *p = preload_of(s, own);
  return s->publisher.path && p &&
         shb_seconds() - p->handed_at > mhb_publisher_pause(&s->publisher, PUBLISH_EVERY);
}

/* Hand over a copy of a preload's curves, and write the file if it is old. */
static shb_status hand_over(mhb_monitor *monitor, const mhb_response *own) {
  sweep          *s    = (sweep *)monitor;
  preload_curves *p    = preload_of(s, own);
  mhb_response   *copy = copy_curves(own);
  mhb_publisher_lock(&s->publisher, true);
  mhb_response_destroy(p->handed);
  p->handed         = copy;
  p->handed_at      = shb_seconds();
  bool       due    = mhb_publisher_is_due(&s->publisher, PUBLISH_EVERY);
  shb_status status = due ? publish(s) : SHB_OK;
  mhb_publisher_lock(&s->publisher, false);
  return status;
}

/* ---- the work ---- */

static shb_status linear_limits(const modal_model *model, const mhb_settings *settings,
                                mhb_response *response) {
  mhb_balance *balance = NULL;
  SHB_TRY(mhb_balance_create(model, settings, &balance));
  response->psi = balance->receptance->psi;
  response->phi = balance->receptance->phi;
  double most   = settings->n0[0];
  for (int i = 1; i < settings->n_preloads; i++) most = fmax(most, settings->n0[i]);
  mhb_balance_set_preload(balance, most);
  mhb_balance_set_parameter(balance, settings->parameter);
  shb_status status = mhb_stiffness_check(balance->receptance, settings);
  for (int stuck = 0; stuck < 2 && status == SHB_OK; stuck++) {
    const int branch = mhb_response_branch(response, stuck ? MHB_BRANCH_STUCK : MHB_BRANCH_OPEN);
    if (status == SHB_OK && !settings->outline) /* an outline is of the curves between them */
      status = mhb_linear_limits(balance, response, branch);
  }
  mhb_balance_destroy(balance);
  return status;
}

/* The main branch of a preload. */
static shb_status main_branch(sweep *s, const modal_model *model, int i) {
  mhb_balance *balance;
  SHB_TRY(mhb_balance_create(model, s->settings, &balance));
  mhb_balance_set_preload(balance, s->settings->n0[i]);
  mhb_balance_set_parameter(balance, s->settings->parameter);
  shb_status status = mhb_trace_main_branch(balance, s->preload[i].own, &s->base);
  mhb_balance_destroy(balance);
  return status;
}

/* Drop branches without points. */
static void drop_empty(mhb_response *own) {
  bool drop[own->n_branches];
  for (int k = 0; k < own->n_branches; k++) drop[k] = k > 0 && own->branch[k].n_points == 0;
  mhb_response_drop(own, drop);
}

/* One preload on this thread. Branches that an earlier run finished are there already. */
static shb_status one_preload(sweep *s, const modal_model *model, int i) {
  preload_curves *p      = &s->preload[i];
  shb_status      status = SHB_OK;
  p->handed_at           = shb_seconds();
  if (!p->own->branch[0].complete) status = main_branch(s, model, i);
  if (status == SHB_OK && !p->own->branch[0].searched && !shb_interrupted())
    status = mhb_secondary_branches(model, s->settings, p->own, &s->base);
  if (status != SHB_OK) return status;
  drop_empty(p->own);
  mhb_publisher_lock(&s->publisher, true);
  mhb_response_destroy(p->handed);
  p->handed = p->own;
  p->own    = NULL;
  p->done   = 1;
  if (mhb_publisher_is_due(&s->publisher, BRANCH_END_EVERY)) status = publish(s);
  mhb_publisher_lock(&s->publisher, false);
  return status;
}

/* The small search at the lowest and highest peaks, unless an earlier run made it. */
static shb_status search_peaks(sweep *s, const modal_model *model) {
  int                 n = s->settings->n_preloads;
  const mhb_response *own[n];
  mhb_peak_places     places[n];
  for (int i = 0; i < n; i++) own[i] = s->preload[i].handed;
  mhb_peak_places_choose(s->response, own, n, places);
#pragma omp parallel for schedule(dynamic, 1) num_threads(s->threads) if (n > 1)
  for (int i = 0; i < n; i++) {
    if (places[i].n == 0 || own[i]->branch[0].n_searches > 0 || shb_interrupted()) continue;
    shb_status status =
        mhb_secondary_branches_at(model, s->settings, s->preload[i].handed, places[i].n,
                                  places[i].value, places[i].starts, &s->base);
    drop_empty(s->preload[i].handed);
    mhb_publisher_lock(&s->publisher, true);
    mhb_publisher_note(&s->publisher, status);
    mhb_publisher_lock(&s->publisher, false);
  }
  return mhb_publisher_status(&s->publisher);
}

/* Length of the settings from a line on, up to the line of the preloads or the end. */
static size_t up_to_preloads(const char *settings) {
  const char *key = "contact.n0 = ", *at = strstr(settings, key);
  while (at && at > settings && at[-1] != '\n') at = strstr(at + 1, key);
  return at ? (size_t)(at - settings) : strlen(settings);
}

/* Do two texts of settings differ in the line of the preloads alone? */
static bool differ_in_preloads(const char *a, const char *b) {
  size_t n = up_to_preloads(a);
  if (n != up_to_preloads(b) || strncmp(a, b, n) != 0 || !a[n]) return false;
  const char *rest_a = strchr(a + n, '\n'), *rest_b = strchr(b + n, '\n');
  return rest_a && rest_b && strcmp(rest_a, rest_b) == 0;
}

/* What a run may take from an earlier file. */
typedef enum { TAKE_NOTHING, TAKE_ALL, TAKE_EQUAL_PRELOADS } taken_part;

static taken_part what_to_take(const sweep *s, hid_t file) {
  const char *own  = s->publisher.provenance->settings;
  char       *text = NULL;
  taken_part  part = TAKE_NOTHING;
  if (h5_read_attribute_text(file, "/", "settings", &text) == SHB_OK && text) {
    if (strcmp(text, own) == 0) {
      part = TAKE_ALL;
    } else if (s->settings->parameter != MHB_IN_N0 && differ_in_preloads(text, own)) {
      part = TAKE_EQUAL_PRELOADS;
    }
  }
  free(text);
  return part;
}

/* The preload of a main branch of an earlier file; NULL: it is not wanted. */
static preload_curves *wanted_for(sweep *s, const mhb_response *old, int branch, taken_part part) {
  const mhb_branch *b = &old->branch[branch];
  int               n = s->settings->n_preloads;
  if (b->main != branch || !(b->complete || b->unfinished)) return NULL;
  if (part == TAKE_ALL) return branch >= 2 && branch < 2 + n ? &s->preload[branch - 2] : NULL;
  for (int i = 0; i < n && b->kind == MHB_BRANCH_NONLINEAR && b->n_points > 0; i++)
    if (s->settings->n0[i] == b->n0[0] && !s->preload[i].own->branch[0].complete)
      return &s->preload[i];
  return NULL;
}

/* Take the branches beside a main one. Those of the small search depend on all preloads: with
 * other preloads the search is made anew. */
static void take_beside(preload_curves *p, mhb_response *old, int main, bool no_searches) {
  mhb_branch *first = &p->own->branch[0];
  if (no_searches) first->n_searches = 0;
  for (int i = main + 1; i < old->n_branches; i++) {
    mhb_branch *b = &old->branch[i];
    int         index;
    if (b->main != main) continue;
    if (no_searches && b->origin == MHB_FROM_SEARCH) break;
    if (!(first->searched || b->origin == MHB_FROM_DETACHED)) continue;
    index = mhb_response_branch(p->own, MHB_BRANCH_NONLINEAR);
    first = &p->own->branch[0];
    take(&p->own->branch[index], b);
    p->own->branch[index].main = 0;
  }
}

/* Take a main branch that an earlier run did not finish. It stays in the file until more of it is
 * there. */
static void take_unfinished(preload_curves *p, mhb_branch *old) {
  const mhb_unfinished *u = old->unfinished;
  if (p->handed) return;
  p->own->branch[0].unfinished = mhb_unfinished_copy(u->segments, u->n, u->state);
  p->handed                    = mhb_response_like(p->own);
  mhb_response_branch(p->handed, MHB_BRANCH_NONLINEAR);
  take(&p->handed->branch[0], old);
  p->handed->branch[0].main = 0;
}

/* Take over the curves of an earlier run: an interrupted one of the same settings, or one with
 * other preloads. Each preload's curves depend on no other preload. */
static shb_status resume(sweep *s) {
  const char   *path  = s->publisher.path;
  bool          peaks = s->settings->search.starts == MHB_SEARCH_PEAKS;
  hid_t         file;
  mhb_response *old    = NULL;
  shb_status    status = SHB_OK;
  if (!path || h5_check_earlier(path) != SHB_OK || h5_open(path, &file) != SHB_OK) return SHB_OK;
  taken_part part = what_to_take(s, file);
  h5_close(file);
  if (part == TAKE_NOTHING || mhb_response_read(path, &old) != SHB_OK) return SHB_OK;
  /* other preloads may have led to other contact points (contact.points: auto) */
  bool fits =
      old->n_multipliers == s->response->n_multipliers && old->n_pairs == s->response->n_pairs;
  for (int i = 2; fits && i < old->n_branches && status == SHB_OK; i++) {
    preload_curves *p = wanted_for(s, old, i, part);
    if (!p) continue;
    if (!old->branch[i].complete) {
      take_unfinished(p, &old->branch[i]);
      continue;
    }
    take(&p->own->branch[0], &old->branch[i]);
    p->own->branch[0].main = 0;
    old->branch[i].main    = i; /* the empty branch is in its place */
    p->done                = p->own->branch[0].searched ? 1 : s->main_share;
    take_beside(p, old, i, peaks && part == TAKE_EQUAL_PRELOADS);
    p->handed = copy_curves(p->own); /* they stay in the file */
  }
  mhb_response_destroy(old);
  return status;
}

static shb_status all_preloads(sweep *s, const modal_model *model) {
  int n = s->settings->n_preloads;
  for (int i = 0; i < n; i++) {
    preload_curves *p = &s->preload[i];
    p->own            = mhb_response_like(s->response);
    mhb_response_branch(p->own, MHB_BRANCH_NONLINEAR);
    p->own->branch[0].searched    = !mhb_secondary_branches_wanted(s->settings);
    p->own->branch[0].n_harmonics = s->response->n_harmonics;
  }
  if (s->settings->resume) SHB_TRY(resume(s));
#pragma omp parallel for schedule(dynamic, 1) \
    num_threads(s->threads) if (n > 1) /* else the threads go to the pairs */
  for (int i = 0; i < n; i++) {
    if (shb_interrupted()) continue;
    shb_status status = one_preload(s, model, i);
    mhb_publisher_lock(&s->publisher, true);
    mhb_publisher_note(&s->publisher, status);
    mhb_publisher_lock(&s->publisher, false);
  }
  SHB_TRY(mhb_publisher_status(&s->publisher));
  for (int i = 0; i < n; i++) {
    preload_curves *p = &s->preload[i];
    if (!p->own) continue;
    if (p->handed) /* not begun: the curves of an earlier run stay */
      mhb_response_destroy(p->own);
    else
      p->handed = p->own;
    p->own = NULL;
  }
  bool searches = s->settings->search.starts == MHB_SEARCH_PEAKS && !shb_interrupted();
  return searches ? search_peaks(s, model) : SHB_OK;
}

/* ---- the motion that lasts ---- */

static bool lasting_goes_on(void *context) {
  return go_on(context);
}

static void lasting_lock(void *context, bool locked) {
  mhb_publisher_lock(&((sweep *)context)->publisher, locked);
}

static shb_status lasting_stored(void *context, double share, double n0, double frequency) {
  sweep *s = context;
  shb_progress_show(s->progress, 100 * share, "n0 %-8.4g N  motion that lasts at %.6g Hz", n0,
                    frequency);
  return mhb_publisher_is_due(&s->publisher, PUBLISH_EVERY) ? publish(s) : SHB_OK;
}

/* Integrate the ring where main branches are modulated. */
static shb_status lasting_motion(sweep *s, const modal_model *model) {
  const mhb_lasting_host host = {.context = s,
                                 .go_on   = lasting_goes_on,
                                 .lock    = lasting_lock,
                                 .stored  = lasting_stored,
                                 .threads = s->threads};
  int                    n    = s->settings->n_preloads;
  mhb_response          *curves[n];
  if (shb_interrupted()) return SHB_OK;
  for (int i = 0; i < n; i++) {
    mhb_response *handed = s->preload[i].handed;
    curves[i]            = handed && handed->branch[0].complete ? handed : NULL;
  }
  return mhb_lasting_motion(model, s->settings, n, curves, &host);
}

/* The response takes over the curves of all preloads. */
static void take_curves(sweep *s) {
  gather(s);
  for (int i = 0; i < s->settings->n_preloads; i++) {
    s->preload[i].handed->n_branches = 0;
    mhb_response_destroy(s->preload[i].handed);
    s->preload[i].handed = NULL;
  }
}

/* All branches have as many harmonics as the one with the most. */
static void widen_all(mhb_response *r) {
  for (int i = 0; i < r->n_branches; i++)
    if (r->branch[i].n_harmonics > r->n_harmonics) r->n_harmonics = r->branch[i].n_harmonics;
  for (int i = 0; i < r->n_branches; i++) mhb_response_widen(r, &r->branch[i], r->n_harmonics);
}

/* A secondary branch that does not cover its range is noted in the file only. The sweep has its
 * main branches all the same. Branches 0 and 1 are the linear limits, which an outline has not. */
static shb_status outcome(const mhb_response *response, const mhb_settings *settings) {
  for (int i = 2; i < response->n_branches; i++) {
    const mhb_branch *branch = &response->branch[i];
    if (branch->complete || branch->main != i) continue;
    return shb_fail(SHB_NOT_CONVERGED, __FILE__, __LINE__,
                    "branch %d (n0 = %g N) did not cover the range: %s", i, settings->n0[i - 2],
                    branch->reason ? branch->reason : "not started");
  }
  return SHB_OK;
}

/* A load harmonic above those of the balance would be ignored silently. */
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

/* The linear limits and all preloads. They share one copy of the residual matrices in the axes of
 * the pairs, which grow with the square of the pairs. */
static shb_status all_curves(sweep *s, const modal_model *model, mhb_settings *settings) {
  mhb_receptance *alike = NULL;
  if (!settings->alike && !settings->ring && !settings->run_up && !settings->nodal_diameters) {
    SHB_TRY(mhb_receptance_create(model, settings, 0, &alike));
    settings->alike = alike;
  }
  shb_status status = linear_limits(model, settings, s->response);
  if (status == SHB_OK) status = all_preloads(s, model);
  if (status == SHB_OK) status = lasting_motion(s, model);
  if (status == SHB_OK) s->response->unfinished = shb_interrupted() || settings->ring;
  if (status == SHB_OK) take_curves(s);
  if (status == SHB_OK && !shb_interrupted()) widen_all(s->response);
  if (status == SHB_OK) status = mhb_modal_motion_keep(model, settings, s->response);
  if (alike) settings->alike = NULL;
  mhb_receptance_destroy(alike);
  return status;
}

shb_status mhb_forced_response(const modal_model *model, const mhb_settings *asked,
                               const char *path, const shb_provenance *provenance,
                               shb_progress *progress, mhb_response **out) {
  int          m[MHB_MAX_LEVELS], n_levels = mhb_harmonic_levels_ladder(model, asked, m);
  mhb_settings first = *asked, *settings = &first;
  *out            = NULL;
  first.harmonics = m[n_levels - 1];
  SHB_TRY(check_load(model, settings));
  SHB_TRY(mhb_receptance_check(settings, mhb_truncation_highest(first.harmonics)));
  first.harmonics = m[0];
  int threads;
  SHB_TRY(mhb_sweep_threads(model, settings, &threads));
  if (first.parameter == MHB_IN_N0) first.n_preloads = 1;
  sweep s = {
      .base     = {.point = point, .searching = searching, .is_due = is_due, .publish = hand_over},
      .settings = settings,
      .threads  = threads,
      .progress = progress,
      .main_share = settings->search.starts > 0 ? MAIN_SHARE : 1};
  mhb_publisher_start(&s.publisher, path, provenance);
  s.response =
      mhb_response_create(model->n_pairs, model->n_probes, mhb_harmonic_levels_usual(n_levels, m));
  s.preload              = shb_alloc_zeroed((size_t)settings->n_preloads, sizeof *s.preload);
  s.response->unfinished = true;
  shb_status status      = mhb_response_describe(s.response, model, settings);
  if (status == SHB_OK) status = all_curves(&s, model, &first);
  if (status == SHB_OK && settings->face) {
    s.response->face = settings->face;
    status           = mhb_face_wear_keep(model, settings, s.response);
  }
  if (status == SHB_OK) status = mhb_publisher_write(&s.publisher, s.response);
  mhb_publisher_stop(&s.publisher);
  for (int i = 0; i < settings->n_preloads; i++) {
    mhb_response_destroy(s.preload[i].own);
    mhb_response_destroy(s.preload[i].handed);
  }
  free(s.preload);
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
