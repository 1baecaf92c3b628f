#include "mhb/mistuning/mistuned_ring.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/mistuning/blade_model.h"
#include "mhb/mistuning/deviations.h"
#include "mhb/problem/wave.h"

/* ---- all blades as one model ---- */

/* n numbers of the tuned blade, once for each of them; NULL of NULL. */
static double *repeated(const mhb_mistuned_ring *ring, const double *from, size_t n) {
  const size_t N  = (size_t)ring->blades;
  double      *to = from ? shb_alloc_zeroed(N * n, sizeof *to) : NULL;
  for (size_t i = 0; to && i < N * n; i++) to[i] = from[i % n];
  return to;
}

static void set_modes(mhb_mistuned_ring *ring) {
  const modal_model *t = ring->tuned;
  modal_model       *w = &ring->whole;
  const size_t       m = (size_t)t->n_modes, all = (size_t)w->n_modes;
  w->frequency     = repeated(ring, t->frequency, m);
  w->damping_ratio = repeated(ring, t->damping_ratio, m);
  w->modal_force   = shb_alloc_zeroed(((size_t)t->n_load + 1) * all, sizeof *w->modal_force);
  for (size_t i = 0; i < all; i++) w->frequency[i] *= 1 + ring->deviation[i];
  for (size_t k = 0; k <= (size_t)t->n_load; k++)
    for (size_t i = 0; i < all; i++)
      w->modal_force[k * all + i] = ring->blade[i / m].modal_force[k * m + i % m];
}

/* "tip" of blade 3 is "tip.3". */
static void name_probes(mhb_mistuned_ring *ring) {
  const modal_model *t = ring->tuned;
  modal_model       *w = &ring->whole;
  w->probe_name        = shb_alloc_zeroed((size_t)w->n_probes + 1, sizeof(char *));
  for (int i = 0; i < w->n_probes; i++)
    w->probe_name[i] = shb_text_of("%s.%d", t->probe_name[i % t->n_probes], i / t->n_probes);
}

static void set_interfaces(mhb_mistuned_ring *ring) {
  const modal_model *t = ring->tuned;
  modal_model       *w = &ring->whole;
  if (t->n_interfaces < 1) return;
  w->interface_name = shb_alloc_zeroed((size_t)t->n_interfaces, sizeof(char *));
  w->interface      = t->interface ? shb_alloc_zeroed((size_t)w->n_pairs, sizeof(int)) : NULL;
  for (int i = 0; i < t->n_interfaces; i++) w->interface_name[i] = shb_text(t->interface_name[i]);
  for (int a = 0; w->interface && a < w->n_pairs; a++)
    w->interface[a] = t->interface[a % t->n_pairs];
}

static void set_whole(mhb_mistuned_ring *ring) {
  const modal_model *t = ring->tuned;
  modal_model       *w = &ring->whole;
  const int          N = ring->blades;
  w->n_modes           = N * t->n_modes;
  w->n_pairs           = N * t->n_pairs;
  w->n_probes          = N * t->n_probes;
  w->n_load            = t->n_load;
  w->n_interfaces      = t->n_interfaces;
  w->has_left          = true;
  set_modes(ring);
  name_probes(ring);
  set_interfaces(ring);
  w->normal = repeated(ring, t->normal, 3 * (size_t)t->n_pairs);
  w->area   = repeated(ring, t->area, (size_t)t->n_pairs);
}

/* ---- the ring ---- */

static shb_status fill(mhb_mistuned_ring *ring, const mhb_settings *settings,
                       const double *deviation, int columns) {
  const int m = ring->n_modes, N = ring->blades,
            order = mhb_driven_wave_order(mhb_settings_wave(settings));
  ring->deviation = shb_alloc_zeroed((size_t)N * (size_t)m, sizeof(double));
  ring->blade     = shb_alloc_zeroed((size_t)N, sizeof *ring->blade);
  for (int b = 0; b < N; b++) {
    for (int i = 0; i < m; i++) {
      const double d = deviation[columns == 1 ? b : b * m + i];
      SHB_CHECK(d > MHB_LEAST_DEVIATION && isfinite(d), SHB_ERR_INPUT,
                "rotor.mistuning: the deviation of blade %d is %g, must be above -50 %%", b, d);
      ring->deviation[b * m + i] = d;
    }
    mhb_blade_model(ring->tuned, ring->deviation + (size_t)b * (size_t)m,
                    SHB_TWO_PI * (b * order % N) / N, &ring->blade[b]);
  }
  set_whole(ring);
  return SHB_OK;
}

shb_status mhb_mistuned_ring_create(const modal_model *tuned, const mhb_settings *settings,
                                    const double *deviation, int columns, mhb_mistuned_ring **out) {
  SHB_CHECK(!settings->to_ground, SHB_ERR_INPUT,
            "rotor.mistuning: contact.to is ground, so that blades do not meet; leave it out");
  SHB_CHECK(tuned->has_left, SHB_ERR_INPUT,
            "rotor.mistuning: the modal file has no /contact/left, where a blade meets the next");
  SHB_CHECK(!tuned->coriolis, SHB_ERR_INPUT,
            "rotor.mistuning does not go with Coriolis terms (/modes/coriolis of the modal file); "
            "give rotor.coriolis: no");
  mhb_mistuned_ring *ring = shb_alloc_zeroed(1, sizeof *ring);
  ring->blades            = settings->blades;
  ring->n_pairs           = tuned->n_pairs;
  ring->n_probes          = tuned->n_probes;
  ring->n_modes           = tuned->n_modes;
  ring->tuned             = tuned;
  shb_status status       = fill(ring, settings, deviation, columns);
  if (status != SHB_OK) {
    mhb_mistuned_ring_destroy(ring);
    return status;
  }
  *out = ring;
  return SHB_OK;
}

void mhb_mistuned_ring_destroy(mhb_mistuned_ring *ring) {
  if (!ring) return;
  for (int b = 0; ring->blade && b < ring->blades; b++) modal_model_free(&ring->blade[b]);
  modal_model_free(&ring->whole);
  free(ring->blade);
  free(ring->deviation);
  free(ring);
}
