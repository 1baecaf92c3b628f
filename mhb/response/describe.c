#include "mhb/response/describe.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "mhb/problem/interfaces.h"
#include "mhb/problem/wave.h"
#include "modal/model/nodal_diameters.h"

/* Interfaces in the order of the case. */
static shb_status describe_interfaces(mhb_response *response, const modal_model *model,
                                      const mhb_settings *settings) {
  const int n = settings->n_interfaces;
  char     *name[MHB_MAX_INTERFACES];
  int      *interface = shb_alloc((size_t)model->n_pairs, sizeof *interface);
  for (int i = 0; i < n; i++) name[i] = (char *)settings->interface[i].name;
  shb_status status = mhb_interfaces_match(model, settings, interface);
  if (status == SHB_OK) mhb_response_interfaces(response, n, name, interface, settings->lead);
  free(interface);
  return status;
}

/* The model whose frequencies are shown: with a disc that of the first harmonic. */
static const modal_model *shown(const modal_model *model, const mhb_settings *settings) {
  modal_wave wave;
  int        missing;
  if (settings->nodal_diameters &&
      modal_nodal_diameters_wave(settings->nodal_diameters,
                                 mhb_driven_wave_order(mhb_settings_wave(settings)), &wave,
                                 &missing))
    return wave.model;
  return model;
}

shb_status mhb_response_describe(mhb_response *response, const modal_model *model,
                                 const mhb_settings *settings) {
  const modal_model *modes  = settings->ring ? settings->ring->tuned : shown(model, settings);
  size_t             m      = (size_t)modes->n_modes;
  response->n_modes         = modes->n_modes;
  response->ring            = settings->ring ? settings->ring->blades : 0;
  response->subharmonics    = settings->subharmonics;
  response->output_harmonic = settings->output_harmonic;
  response->quantity        = settings->output_quantity;
  response->engine_order    = settings->engine_order;
  response->turns_right     = settings->turns_right;
  response->blades          = settings->blades;
  response->run_up          = settings->run_up != NULL;
  response->diagrams        = settings->diagrams;
  response->lacks_diameters =
      settings->stability != MHB_STABILITY_NEVER && !mhb_judges_stability(settings);
  response->parameter      = settings->parameter;
  response->n_multipliers  = mhb_judges_stability(settings) ? MHB_KEPT_MULTIPLIERS : 0;
  response->mode_frequency = shb_alloc(m, sizeof(double));
  response->mode_damping   = shb_alloc(m, sizeof(double));
  memcpy(response->mode_frequency, modes->frequency, sizeof(double) * m);
  memcpy(response->mode_damping, modes->damping_ratio, sizeof(double) * m);
  if (modes->eigen_residual) {
    response->eigen_residual = shb_alloc(m, sizeof(double));
    memcpy(response->eigen_residual, modes->eigen_residual, sizeof(double) * m);
  }
  if (settings->n_interfaces > 1) SHB_TRY(describe_interfaces(response, model, settings));
  for (int q = 0; q < model->n_probes; q++) {
    free(response->probe_name[q]);
    response->probe_name[q] = shb_text(model->probe_name[q]);
  }
  return SHB_OK;
}
