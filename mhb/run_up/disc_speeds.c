#include "mhb/run_up/disc_speeds.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"

shb_status mhb_disc_table_create(modal_sector_speeds *speeds, const char *path, int engine_order,
                                 const double frequency[2], mhb_disc_table **out) {
  mhb_disc_table *d = shb_alloc_zeroed(1, sizeof *d);
  d->blades         = speeds->blades;
  d->n              = speeds->n;
  d->diameter       = speeds->diameter;
  speeds->diameter  = NULL;
  d->table          = shb_alloc_zeroed((size_t)d->n, sizeof(void *));
  const shb_status status =
      mhb_speed_tables_create(d->n, speeds->at, path, engine_order, frequency, d->table);
  if (status != SHB_OK) {
    mhb_disc_table_destroy(d);
    return status;
  }
  *out = d;
  return SHB_OK;
}

void mhb_disc_table_destroy(mhb_disc_table *d) {
  if (!d) return;
  for (int i = 0; d->table && i < d->n; i++) mhb_speed_table_destroy(d->table[i]);
  free(d->table);
  free(d->diameter);
  free(d);
}

shb_status mhb_disc_table_check(const mhb_disc_table *d, const char *path) {
  for (int i = 0; i < d->n; i++) SHB_TRY(mhb_speed_model_check(d->table[i], path));
  return SHB_OK;
}

static void make(mhb_disc_speeds *s) {
  const mhb_disc_table *d = s->table;
  const size_t          n = (size_t)d->n;
  s->at                   = shb_alloc_zeroed(n, sizeof(mhb_speed_model *));
  s->used                 = shb_alloc_zeroed(n, sizeof *s->used);
  modal_nodal_diameters_create(d->blades, d->n, &s->now);
  modal_nodal_diameters_create(d->blades, d->n, &s->slope);
  s->used[0] = true;
  for (int i = 0; i < d->n; i++) {
    s->now.diameter[i] = s->slope.diameter[i] = d->diameter[i];
    s->at[i]                                  = mhb_speed_model_create(d->table[i]);
    const mhb_speed_model *at                 = s->at[i];
    s->now.model[i]                           = at->model;
    s->now.imaginary[i]                       = at->imaginary;
    s->now.backward[i]                        = at->backward;
    s->slope.model[i]                         = at->slope;
    s->slope.imaginary[i]                     = at->slope_imaginary;
    s->slope.backward[i]                      = at->slope_backward;
  }
}

mhb_disc_speeds *mhb_disc_speeds_create(const mhb_disc_table *table) {
  mhb_disc_speeds *s = shb_alloc_zeroed(1, sizeof *s);
  s->table           = table;
  make(s);
  return s;
}

/* The arrays of the models belong to the speed models. */
static void release(modal_nodal_diameters *d) {
  for (int i = 0; d->model && i < d->n; i++)
    d->model[i] = d->imaginary[i] = d->backward[i] = (modal_model){0};
  modal_nodal_diameters_free(d);
}

void mhb_disc_speeds_destroy(mhb_disc_speeds *s) {
  if (!s) return;
  release(&s->now);
  release(&s->slope);
  for (int i = 0; s->at && i < s->table->n; i++) mhb_speed_model_destroy(s->at[i]);
  free(s->at);
  free(s->used);
  free(s);
}

void mhb_disc_speeds_set(mhb_disc_speeds *s, double omega) {
  for (int i = 0; i < s->table->n; i++)
    if (s->used[i]) mhb_speed_model_set(s->at[i], omega);
}

void mhb_disc_speeds_set_all(mhb_disc_speeds *s) {
  for (int i = 1; i < s->table->n; i++) mhb_speed_model_set(s->at[i], s->at[0]->omega);
}

void mhb_disc_speeds_differentiate(mhb_disc_speeds *s) {
  for (int i = 0; i < s->table->n; i++)
    if (s->used[i]) mhb_speed_model_differentiate(s->at[i]);
}

mhb_speed_model *mhb_disc_speeds_use(mhb_disc_speeds *s, long wave) {
  const int i = modal_nodal_diameters_find(&s->now, modal_nodal_diameter(wave, s->table->blades));
  if (i < 0) return NULL;
  if (!s->used[i] && s->at[0]->omega == s->at[0]->omega)
    mhb_speed_model_set(s->at[i], s->at[0]->omega);
  s->used[i] = true;
  return s->at[i];
}
