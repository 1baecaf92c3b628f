#include "cases/commands/balance_run.h"

#include <stdio.h>
#include <stdlib.h>

#include "cases/commands/load_model.h"
#include "cases/commands/stage.h"
#include "cases/commands/up_to_date.h"
#include "cases/schema/case.h"
#include "cases/schema/case_paths.h"
#include "mesh/base/progress.h"
#include "mesh/base/publish.h"
#include "mhb/amplification/ring_response.h"
#include "mhb/balance/balance.h"
#include "mhb/branches/forced_response.h"
#include "mhb/branches/lasting_motion.h"
#include "mhb/tracking/tracked_response.h"

mhb_sampling balance_sampling(const case_file *file) {
  return (mhb_sampling){.n         = file->mistuning.samples,
                        .deviation = file->mistuning.deviation,
                        .seed      = file->mistuning.seed};
}

/* Points above the tolerance are an outcome that must not be overlooked, beside any other. So are
 * samples. */
static shb_status tell_marks(const case_file *file, const mhb_response *response,
                             shb_status status) {
  const mhb_marks marks = mhb_response_marks(response);
  char            before[512], points[256] = "", samples[128] = "";
  const bool      both = marks.marked > 0 && marks.marked_samples > 0;
  if (marks.marked == 0 && marks.marked_samples == 0) return status;
  if (status != SHB_OK && status != SHB_NOT_CONVERGED) return status;
  snprintf(before, sizeof before, "%s%s", status == SHB_OK ? "" : shb_message(),
           status == SHB_OK ? "" : "; ");
  if (marks.marked > 0)
    snprintf(points, sizeof points,
             "%d of %d points have an estimated error above mhb.tolerance %g, up to %.2g with %d "
             "harmonics: they are marked, and no peak is told from them",
             marks.marked, marks.points, file->mhb.motion_tolerance, marks.largest,
             marks.harmonics);
  if (marks.marked_samples > 0)
    snprintf(samples, sizeof samples,
             "%d of %d random rings have their peak above mhb.tolerance %g: they are marked",
             marks.marked_samples, marks.samples, file->mhb.motion_tolerance);
  return shb_fail(SHB_NOT_CONVERGED, __FILE__, __LINE__, "%s%s%s%s", before, points,
                  both ? "; " : "", samples);
}

/* Does the file at path hold the complete result of these settings? *outcome: what that is. */
static bool up_to_date(const case_file *file, const char *path, const char *settings,
                       shb_status *outcome) {
  const int     samples  = file->mistuning.samples;
  bool          same     = up_to_date_with(path, settings);
  mhb_response *response = NULL;
  same                   = same && mhb_response_read(path, &response) == SHB_OK;
  same                   = same && !response->unfinished;
  for (int i = 0; same && i < response->n_branches; i++) {
    const mhb_branch *branch = &response->branch[i];
    same                     = branch->main != i || (branch->complete && branch->searched);
  }
  const mhb_samples *drawn = same ? response->samples : NULL;
  if (samples > 0) same = same && drawn != NULL;
  for (int i = 0; same && drawn && i < drawn->preloads; i++)
    same = mhb_samples_done(drawn, i) == drawn->n;
  if (same) *outcome = tell_marks(file, response, SHB_OK);
  mhb_response_destroy(response);
  return same;
}

static void summarise(shb_progress *progress, const mhb_response *response) {
  long   points = 0, iterations = 0;
  int    further = 0;
  double seconds = 0;
  for (int i = 0; i < response->n_branches; i++) {
    const mhb_branch *b = &response->branch[i];
    if (b->kind != MHB_BRANCH_NONLINEAR && b->kind != MHB_BRANCH_TRACKED) continue;
    points += b->n_points;
    further += b->origin != MHB_FROM_END;
    for (int p = 0; p < b->n_points; p++) {
      iterations += b->iterations[p];
      seconds += b->seconds[p];
    }
  }
  shb_progress_note(progress, "%ld points, %.1f Newton steps and %.3f ms a point", points,
                    points ? (double)iterations / (double)points : 0.,
                    points ? 1e3 * seconds / (double)points : 0.);
  if (further > 0)
    shb_progress_note(progress, "%d further curve%s beside the main ones", further,
                      further > 1 ? "s" : "");
}

static void note_run_up(shb_progress *progress, const case_model *model) {
  const mhb_speed_table *r = model->run_up;
  shb_progress_note(progress, "run-up: engine order %d, %.6g to %.6g rpm, %d speeds, %d modes",
                    r->engine_order, 60 * model->settings.frequency[0] / r->engine_order,
                    60 * model->settings.frequency[1] / r->engine_order, r->n, r->n_modes);
  if (!r->speeds.overlap)
    shb_progress_note(progress,
                      "run-up: the modal file has no /speeds/overlap: modes are joined by their "
                      "tracks, which take a veering between two speeds for a crossing");
  if (r->n_dropped > 0)
    shb_progress_note(progress,
                      "run-up: %d modes change places with ones left out and answer statically",
                      r->n_dropped);
}

/* How many contact points contact.points: auto has chosen. */
static void note_points(shb_progress *progress, const case_file *file, const case_model *model) {
  if (model->points)
    shb_progress_note(progress,
                      "contact.points auto: %d of %d, estimated spatial error %.2g (tolerance %g)",
                      model->model.n_pairs, model->points->other.n_pairs, model->points->estimate,
                      file->points_tolerance);
  else
    shb_progress_note(progress, "contact.points auto: all %d, fewer do not keep the tolerance %g",
                      model->model.n_pairs, file->points_tolerance);
}

/* With many pairs the sweep reads residual matrices in the axes of the pairs, which alike lends. R3
 * is released, and so are R and R2 where no motion that lasts is computed from them. The stability
 * of gyroscopic modes reads the model's own. */
static shb_status release_terms(case_model *m, mhb_receptance **alike) {
  const bool reads_own = m->disc || m->run_up || m->model.coriolis;
  if (m->model.n_pairs < MHB_MANY_PAIRS || reads_own) return SHB_OK;
  SHB_TRY(mhb_receptance_create(&m->model, &m->settings, 0, alike));
  m->settings.alike = *alike;
  modal_model_release_terms(&m->model, mhb_lasting_refusal(&m->model, &m->settings) ? 0 : 2);
  return SHB_OK;
}

static shb_status sweep(case_model *m, const char *output, const shb_provenance *provenance,
                        shb_progress *progress, mhb_response **response) {
  mhb_receptance *alike  = NULL;
  shb_status      status = release_terms(m, &alike);
  if (status == SHB_OK)
    status = mhb_forced_response(&m->model, &m->settings, output, provenance, progress, response);
  m->settings.alike = NULL;
  mhb_receptance_destroy(alike);
  return status;
}

static shb_status solve(const case_file *file, const char *modal, char *settings,
                        const char *output, const mhb_sample_crew *crew, shb_progress *progress) {
  case_model     model;
  mhb_response  *response   = NULL;
  shb_provenance provenance = command_provenance(file, settings, "shroudhb-mhb");
  shb_status     status     = case_model_read(file, modal, 0, true, &model);
  mhb_sampling   sampling   = balance_sampling(file);
  sampling.crew             = crew;
  if (status == SHB_OK && model.run_up) note_run_up(progress, &model);
  if (status == SHB_OK && case_points_are_auto(file)) note_points(progress, file, &model);
  if (status == SHB_OK && !file->modal_file) status = case_model_judge_points(&model);
  if (status == SHB_OK) status = case_model_face(&model, modal);
  if (status == SHB_OK && model.settings.track != MHB_TRACK_NOTHING)
    status = mhb_tracked_response(&model.model, &model.settings, output, &provenance, progress,
                                  &response);
  else if (status == SHB_OK && model.ring)
    status =
        mhb_ring_response(&model.settings, &sampling, output, &provenance, progress, &response);
  else if (status == SHB_OK)
    status = sweep(&model, output, &provenance, progress, &response);
  shb_progress_clear(progress);
  if (response) summarise(progress, response);
  if (response) status = tell_marks(file, response, status);
  shb_progress_note(progress, "%.2f s in all", shb_seconds() - progress->started);
  mhb_response_destroy(response);
  case_model_free(&model);
  return status;
}

/* Other ranks read the modal file meanwhile, so it is not made again. */
static shb_status check_modes(const case_file *file) {
  SHB_CHECK(file->modal_file || up_to_date_modes(file), SHB_ERR_INPUT,
            "%s: the modes are out of date; run `shroudhb modal %s` first", file->path, file->path);
  return SHB_OK;
}

shb_status balance_run(const case_file *file, const command_options *options,
                       const mhb_sample_crew *crew) {
  shb_progress progress = shb_progress_start("mhb", options->quiet, options->verbose);
  char        *modal = case_modal_path(file), *output = case_output(file, ".response.h5");
  char        *settings = NULL;
  shb_status   status =
      modal && output ? SHB_OK : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  if (status == SHB_OK) status = crew ? check_modes(file) : stage_renew_modes(file, options);
  if (status == SHB_OK) status = up_to_date_settings(file, CASE_MHB, modal, &settings);
  if (status == SHB_OK) {
    if (!options->force && up_to_date(file, output, settings, &status)) {
      shb_progress_note(&progress, "%s is up to date", output);
    } else {
      status = shb_publish_check(output);
      if (status == SHB_OK) status = solve(file, modal, settings, output, crew, &progress);
    }
  }
  free(modal);
  free(output);
  free(settings);
  return status;
}
