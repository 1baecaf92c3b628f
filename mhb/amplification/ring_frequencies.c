#include "mhb/amplification/ring_frequencies.h"

#include <stdlib.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/continuation/linear_resonances.h"
#include "mhb/problem/wave.h"
#include "mhb/structure/gyroscopic.h"
#include "modal/model/nodal_diameters.h"
#include "modal/model/sector_speeds.h"
#include "modal/model/speeds.h"

/* ---------------------------------------------------------------- over the nodal diameter */

/* The model at a nodal diameter; NULL: the file of a disc lacks it. */
static const modal_model *model_at(const modal_model *model, const mhb_settings *settings,
                                   int diameter) {
  const modal_nodal_diameters *disc = settings->nodal_diameters;
  if (!disc) return model;
  const int at = modal_nodal_diameters_find(disc, diameter);
  return at < 0 ? NULL : &disc->model[at];
}

/* The wave at a nodal diameter in which the load meets the rotor. It is that of the first harmonic
 * that does, or else of the engine order of that number. */
static int driven_at(const modal_model *model, const mhb_settings *settings, int diameter) {
  long order = diameter;
  for (int h = model->n_load; h >= 1; h--) {
    const long own = (long)h * settings->engine_order;
    if (modal_model_is_driven(model, h) && modal_nodal_diameter(own, settings->blades) == diameter)
      order = own;
  }
  order %= settings->blades;
  return mhb_driven_wave_order(
      mhb_driven_wave_of((int)order, settings->turns_right, settings->blades, 1));
}

/* Frequencies of the open families at a nodal diameter, Hz. With Coriolis terms they are those of
 * the wave that an excitation of that order drives. */
static shb_status find_open(const modal_model *own, const mhb_settings *settings, int diameter,
                            int n, double *open) {
  modal_wave     wave;
  mhb_gyroscopic g;
  int            missing;
  for (int i = 0; i < n; i++) open[i] = own->frequency[i];
  if (!own->coriolis) return SHB_OK;
  if (!settings->nodal_diameters ||
      !modal_nodal_diameters_wave(settings->nodal_diameters, driven_at(own, settings, diameter),
                                  &wave, &missing))
    wave = modal_wave_real(own);
  SHB_TRY(mhb_gyroscopic_of_wave(&wave, &g));
  for (int i = 0; i < n; i++) open[i] = g.omega[g.n + i] / SHB_TWO_PI;
  mhb_gyroscopic_free(&g);
  return SHB_OK;
}

static void find_driven(const modal_model *model, mhb_diagrams *d) {
  for (int k = 1; k <= model->n_load && d->n_driven < MHB_MOST_DRIVEN; k++)
    if (modal_model_is_driven(model, k)) d->driven[d->n_driven++] = k;
}

shb_status mhb_families_over_diameters(const modal_model *model, const mhb_settings *settings,
                                       mhb_diagrams *d) {
  const int n   = model->n_modes < MHB_MOST_FAMILIES ? model->n_modes : MHB_MOST_FAMILIES;
  const int all = settings->blades / 2 + 1;
  if (settings->to_ground || !model->has_left || model->n_pairs == 0 || settings->blades < 3)
    return SHB_OK;
  d->n_families = n;
  d->disc       = settings->nodal_diameters != NULL;
  d->diameter   = shb_alloc_zeroed((size_t)all, sizeof *d->diameter);
  d->open       = shb_alloc_zeroed((size_t)n * (size_t)all, sizeof *d->open);
  d->stuck      = shb_alloc_zeroed((size_t)n * (size_t)all, sizeof *d->stuck);
  find_driven(model, d);
  for (int i = 0; i < all; i++) {
    const modal_model *own = model_at(model, settings, i);
    const int          at  = n * d->n_diameters;
    if (!own) continue;
    d->diameter[d->n_diameters++] = i;
    SHB_TRY(find_open(own, settings, i, n, d->open + at));
    SHB_TRY(mhb_stuck_frequencies(own, settings, driven_at(model, settings, i), n, d->stuck + at));
  }
  return SHB_OK;
}

/* ---------------------------------------------------------------- over the speed */

/* The models of a disc at one speed; only the lists are its own. */
static void at_speed(const modal_sector_speeds *all, int speed, modal_nodal_diameters *out) {
  modal_nodal_diameters_create(all->blades, all->n, out);
  for (int i = 0; i < all->n; i++) {
    const modal_speeds *at = &all->at[i];
    out->diameter[i]       = all->diameter[i];
    out->model[i]          = at->model[speed];
    if (!at->imaginary) continue;
    out->imaginary[i] = at->imaginary[speed];
    out->backward[i]  = at->backward[speed];
  }
}

static void release(modal_nodal_diameters *d) {
  for (int i = 0; d->model && i < d->n; i++)
    d->model[i] = d->imaginary[i] = d->backward[i] = (modal_model){0};
  modal_nodal_diameters_free(d);
}

static bool has_stuck(const modal_model *model, const mhb_settings *settings) {
  return model->n_pairs > 0 && (settings->to_ground || model->has_left);
}

/* Room for so many waves over the speeds of one of them. */
static void make_room(const modal_speeds *s, int waves, mhb_diagrams *d) {
  d->n_waves  = waves;
  d->n_speeds = s->n;
  d->n_stuck  = s->n_modes < MHB_MOST_STUCK ? s->n_modes : MHB_MOST_STUCK;
  d->wave     = shb_alloc_zeroed((size_t)waves, sizeof *d->wave);
  d->speed    = shb_alloc_zeroed((size_t)s->n, sizeof *d->speed);
  d->over = shb_alloc_zeroed((size_t)waves * (size_t)s->n * (size_t)d->n_stuck, sizeof *d->over);
  for (int i = 0; i < s->n; i++) d->speed[i] = s->speed[i];
}

/* A blade that is clamped at its root, at the nodal diameter of the engine order. */
static shb_status over_speeds(const modal_speeds *s, const mhb_settings *settings,
                              mhb_diagrams *d) {
  mhb_settings here = *settings;
  if (s->n < 2 || !has_stuck(&s->model[0], settings)) return SHB_OK;
  make_room(s, 1, d);
  const int order = settings->blades > 0 ? mhb_driven_wave_order(mhb_settings_wave(settings)) : 0;
  if (settings->blades > 0)
    d->wave[0] = modal_nodal_diameter(settings->engine_order, settings->blades);
  here.nodal_diameters = NULL;
  for (int i = 0; i < s->n; i++)
    SHB_TRY(
        mhb_stuck_frequencies(&s->model[i], &here, order, d->n_stuck, d->over + i * d->n_stuck));
  return SHB_OK;
}

/* A disc at one speed: every wave that the load meets. */
static shb_status disc_at_speed(const modal_sector_speeds *all, int speed,
                                const mhb_settings *settings, mhb_diagrams *d) {
  modal_nodal_diameters models = {0};
  mhb_settings          here   = *settings;
  shb_status            status = SHB_OK;
  at_speed(all, speed, &models);
  here.nodal_diameters = &models;
  for (int w = 0; w < d->n_waves && status == SHB_OK; w++)
    status = mhb_stuck_frequencies(&all->at[0].model[speed], &here,
                                   driven_at(&all->at[0].model[0], &here, d->wave[w]), d->n_stuck,
                                   d->over + (w * d->n_speeds + speed) * d->n_stuck);
  release(&models);
  return status;
}

static shb_status over_disc_speeds(const modal_sector_speeds *all, const mhb_settings *settings,
                                   mhb_diagrams *d) {
  if (all->n == 0 || !has_stuck(&all->at[0].model[0], settings)) return SHB_OK;
  int      *index = shb_alloc_zeroed((size_t)all->n, sizeof *index);
  const int waves = mhb_driven_diameters(all, settings->engine_order, index);
  make_room(&all->at[0], waves, d);
  for (int w = 0; w < waves; w++) d->wave[w] = all->diameter[index[w]];
  free(index);
  for (int i = 0; i < d->n_speeds; i++) SHB_TRY(disc_at_speed(all, i, settings, d));
  return SHB_OK;
}

/* ---------------------------------------------------------------- a modal file */

typedef struct {
  modal_model           model;
  modal_nodal_diameters disc;
  modal_speeds          speeds;
  modal_sector_speeds   sector;
} content;

static shb_status read_all(const char *modal, content *c) {
  SHB_TRY(modal_model_read(modal, &c->model));
  SHB_TRY(modal_nodal_diameters_read(modal, &c->disc));
  SHB_TRY(modal_speeds_read(modal, &c->speeds));
  return c->speeds.n > 0 ? SHB_OK : modal_sector_speeds_read(modal, &c->sector);
}

shb_status mhb_diagrams_compute(const char *modal, const mhb_settings *settings, mhb_diagrams *d) {
  content      c       = {0};
  mhb_settings here    = *settings;
  *d                   = (mhb_diagrams){.known = true};
  shb_status status    = read_all(modal, &c);
  here.nodal_diameters = c.disc.n > 0 ? &c.disc : NULL;
  if (status == SHB_OK) status = mhb_families_over_diameters(&c.model, &here, d);
  if (status == SHB_OK) status = over_speeds(&c.speeds, settings, d);
  if (status == SHB_OK) status = over_disc_speeds(&c.sector, settings, d);
  modal_model_free(&c.model);
  modal_nodal_diameters_free(&c.disc);
  modal_speeds_free(&c.speeds);
  modal_sector_speeds_free(&c.sector);
  return status;
}
