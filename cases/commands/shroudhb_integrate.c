/* shroudhb integrate: points of a case by direct time integration. */
#include <cblas.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cases/commands/load_model.h"
#include "cases/commands/stage.h"
#include "cases/commands/stages.h"
#include "cases/commands/up_to_date.h"
#include "cases/schema/case.h"
#include "cases/schema/case_paths.h"
#include "mesh/base/memory.h"
#include "mesh/base/progress.h"
#include "mesh/base/publish.h"
#include "mhb/integration/integration_memory.h"
#include "mhb/integration/integration_sweep.h"
#include "mhb/mistuning/dense_ring.h"
#include "mhb/structure/dense_disc.h"

/* The keys of the stage and the file of its initial states, as text; malloc'ed. */
static shb_status settings_of(const case_file *file, const char *modal, const char *balance,
                              char **text) {
  char *keys, fingerprint[17];
  SHB_TRY(up_to_date_settings(file, (case_stage)(CASE_MHB | CASE_INTEGRATE), modal, &keys));
  *text = keys;
  if (!balance) return SHB_OK;
  SHB_TRY(shb_fingerprint(balance, fingerprint));
  *text = shb_text_of("%sresponse.fingerprint = %s\n", keys, fingerprint);
  free(keys);
  return SHB_OK;
}

/* Does the file at path hold the complete result of these settings? */
static bool up_to_date(const char *path, const char *settings) {
  bool          same     = up_to_date_with(path, settings);
  mhb_response *response = NULL;
  same                   = same && mhb_response_read(path, &response) == SHB_OK;
  for (int i = 0; same && i < response->n_branches; i++) same = response->branch[i].complete;
  mhb_response_destroy(response);
  return same;
}

static void summarise(const case_file *file, const mhb_response *response, const char *path) {
  int  points = 0, higher = 0, never = 0;
  long periods = 0;
  for (int i = 0; i < response->n_branches; i++) {
    const mhb_branch *b = &response->branch[i];
    for (int p = 0; p < b->n_points; p++) {
      points++;
      periods += b->periods[p];
      higher += b->multiple[p] > 1;
      never += b->multiple[p] == 0;
    }
  }
  printf("%s: %d points, %ld periods on the average", path, points, points ? periods / points : 0);
  if (higher) printf("; %d repeat after several periods of the fundamental only", higher);
  if (never) printf("; %d are not periodic after %d periods", never, file->integrate.max_periods);
  puts("");
}

/* Warns that rings take long, most of all where the waves differ from those of the balance. */
static void warn_of_ring(const case_file *file, const modal_model *model) {
  if (file->mhb.to_ground || file->mhb.blades * model->n_modes < 200) return;
  fprintf(
      stderr,
      "shroudhb: warning: all %d blades of the ring are integrated, with %d modes each; a point "
      "whose wave does not last takes all %d periods (integrate.periods)\n",
      file->mhb.blades, model->n_modes, file->integrate.max_periods);
}

/* A structure of all blades is refused before it is made. */
static shb_status check_memory(const case_file *file, const case_model *model,
                               const mhb_response *balance) {
  const mhb_settings  *s    = &model->settings;
  mhb_integration_size size = mhb_integration_size_of(
      &model->model, s, mhb_integration_harmonics(&model->model, s, &file->integrate, balance),
      file->integrate.n_frequencies * s->n_preloads);
  int threads;
  size.dense = true;
  if (model->ring) {
    size.pairs    = model->ring->n_pairs;
    size.modes    = model->ring->n_modes;
    size.probes   = model->ring->n_probes;
    size.residual = model->tuned.residual_flexibility != NULL;
    size.inertia  = model->tuned.residual_inertia != NULL;
  }
  return mhb_integration_threads(&size, &threads);
}

/* A ring of different blades and a disc are integrated as one model. */
static shb_status integrate(const case_file *file, case_model *model, const mhb_response *balance,
                            const char *output, const shb_provenance *provenance,
                            shb_progress *progress, mhb_response **response) {
  if (!model->ring && !model->disc)
    return mhb_integration_sweep(&model->model, &model->settings, &file->integrate, balance, output,
                                 provenance, progress, response);
  modal_model  dense;
  mhb_settings settings;
  shb_status   status = SHB_OK;
  SHB_CHECK(!model->disc_run_up, SHB_ERR_INPUT,
            "mhb.run_up: the sectors of a disc are integrated at one speed; leave it out, and give "
            "a case for each rotor.speed");
  SHB_TRY(check_memory(file, model, balance));
  if (model->disc) {
    status = mhb_dense_disc(&model->settings, &dense);
    mhb_dense_disc_settings(&model->settings, &settings);
  } else {
    mhb_dense_ring(model->ring, &dense);
    mhb_dense_ring_settings(&model->settings, &settings);
  }
  if (status == SHB_OK)
    status = mhb_integration_sweep(&dense, &settings, &file->integrate, balance, output, provenance,
                                   progress, response);
  modal_model_free(&dense);
  return status;
}

static shb_status solve(const case_file *file, const char *modal, const mhb_response *balance,
                        char *settings, const char *output, shb_progress *progress) {
  case_model     model;
  mhb_response  *response   = NULL;
  shb_provenance provenance = command_provenance(file, settings, "shroudhb-integrate");
  shb_status     status     = case_model_read(file, modal, 0, true, &model);
  if (status == SHB_OK && !progress->quiet) warn_of_ring(file, &model.model);
  if (status == SHB_OK)
    status = integrate(file, &model, balance, output, &provenance, progress, &response);
  shb_progress_clear(progress);
  if (response && !progress->quiet) summarise(file, response, output);
  shb_progress_note(progress, "%.2f s in all", shb_seconds() - progress->started);
  int points = 0;
  for (int i = 0; response && i < response->n_branches; i++) points += response->branch[i].n_points;
  mhb_response_destroy(response);
  case_model_free(&model);
  SHB_CHECK(status != SHB_OK || points > 0, SHB_NOT_CONVERGED,
            "%s: no points: the balance has no stable solution at any of integrate.frequencies to "
            "start on; set integrate.start to rest or state",
            output);
  return status;
}

/* Reads the response file that holds the initial states. */
static shb_status read_balance(const case_file *file, const char *path, const char *modal,
                               mhb_response **balance) {
  SHB_CHECK(
      access(path, R_OK) == 0, SHB_ERR_INPUT,
      "%s: not there to start on; run `shroudhb mhb %s` first, or set integrate.start to rest "
      "or state",
      path, file->path);
  SHB_TRY(up_to_date_check_modal(path, modal));
  up_to_date_warn(file, path);
  return mhb_response_read(path, balance);
}

static shb_status run(const case_file *file, const command_options *options) {
  shb_progress  progress = shb_progress_start("time", options->quiet, options->verbose);
  char         *modal = case_modal_path(file), *output = case_output(file, ".integration.h5");
  char         *start = case_output(file, ".response.h5"), *settings = NULL;
  mhb_response *balance = NULL;
  bool          needed  = file->integrate.start == MHB_START_FROM_BALANCE;
  shb_status    status  = stage_renew_modes(file, options);
  if (status == SHB_OK && needed) status = read_balance(file, start, modal, &balance);
  if (status == SHB_OK) status = settings_of(file, modal, needed ? start : NULL, &settings);
  if (status == SHB_OK) {
    if (!options->force && up_to_date(output, settings)) {
      shb_progress_note(&progress, "%s is up to date", output);
    } else {
      status = shb_publish_check(output);
      if (status == SHB_OK) status = solve(file, modal, balance, settings, output, &progress);
    }
  }
  mhb_response_destroy(balance);
  free(modal);
  free(output);
  free(start);
  free(settings);
  return status;
}

int integrate_command(const command_options *options) {
  case_file  file;
  shb_status status = command_read(options, CASE_MHB | CASE_INTEGRATE, &file);
  if (status != SHB_OK) return command_finish(status);
  shb_interrupt_catch();
  openblas_set_num_threads(1); /* the points run in parallel, so BLAS uses one thread */
  status = run(&file, options);
  case_free(&file);
  return command_finish(status);
}
