#include "cases/commands/load_model.h"

#include <complex.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/mistuning/deviation_table.h"
#include "mhb/mistuning/deviations.h"
#include "modal/model/nodal_diameters.h"
#include "modal/model/reduce.h"

static shb_status read_speeds(const char *path, int modes, bool residuals, case_model *m) {
  const double *f = m->settings.frequency;
  modal_speeds  speeds;
  SHB_TRY(modal_speeds_read(path, &speeds));
  shb_status status = SHB_OK;
  for (int i = 0; i < speeds.n && modes > 0 && status == SHB_OK; i++)
    status = modal_model_reduce(&speeds.model[i], modes, residuals);
  if (status == SHB_OK)
    status = mhb_speed_table_create(&speeds, path, m->settings.engine_order, f, &m->run_up);
  modal_speeds_free(&speeds);
  if (status == SHB_OK) status = mhb_speed_model_check(m->run_up, path);
  if (status == SHB_OK) m->top = mhb_speed_model_create(m->run_up);
  SHB_TRY(status);
  mhb_speed_model_set(m->top, SHB_TWO_PI * f[1]);
  m->model           = m->top->model;
  m->settings.run_up = m->run_up;
  return SHB_OK;
}

/* The same of a disc, if the file at path holds one; else nothing is read. */
static shb_status read_disc_speeds(const char *path, int modes, bool residuals, case_model *m) {
  const double       *f = m->settings.frequency;
  modal_sector_speeds all;
  SHB_TRY(modal_sector_speeds_read(path, &all));
  shb_status status = SHB_OK;
  for (int i = 0; i < all.n && modes > 0; i++)
    for (int s = 0; s < all.at[i].n && status == SHB_OK; s++) {
      modal_speeds *at = &all.at[i];
      status           = modal_wave_reduce(&at->model[s], at->imaginary ? &at->imaginary[s] : NULL,
                                 at->backward ? &at->backward[s] : NULL, modes, residuals);
    }
  if (status == SHB_OK && all.n > 0)
    status = mhb_disc_table_create(&all, path, m->settings.engine_order, f, &m->disc_run_up);
  modal_sector_speeds_free(&all);
  SHB_TRY(status);
  if (!m->disc_run_up) return SHB_OK;
  m->run_up = m->disc_run_up->table[0];
  SHB_TRY(mhb_disc_table_check(m->disc_run_up, path));
  m->disc_top = mhb_disc_speeds_create(m->disc_run_up);
  m->top      = m->disc_top->at[0];
  mhb_disc_speeds_set(m->disc_top, SHB_TWO_PI * f[1]);
  mhb_disc_speeds_set_all(m->disc_top);
  m->disc                     = &m->disc_top->now;
  m->model                    = m->disc->model[0];
  m->settings.nodal_diameters = m->disc;
  m->settings.run_up          = m->run_up;
  m->settings.disc_run_up     = m->disc_run_up;
  return SHB_OK;
}

/* The balance needs contact and a load, which modes alone do without. */
static shb_status check_use(const char *path, const modal_model *model) {
  double force = 0;
  SHB_CHECK(model->n_pairs > 0, SHB_ERR_INPUT,
            "%s: has no /contact, as the case had no block contact or its mesh no contact faces; "
            "the balance needs one",
            path);
  for (int i = 0; i < (model->n_load + 1) * model->n_modes; i++)
    force += cabs(model->modal_force[i]);
  SHB_CHECK(
      force > 0, SHB_ERR_INPUT,
      "%s: its load is 0, as of a case without a load; give excitation.pressure, or traction, "
      "force, field or loads, and run `shroudhb modal` again",
      path);
  return SHB_OK;
}

/* value[n][*columns] <- the deviations of the case, to be freed. */
static shb_status deviations(const case_file *file, int n_modes, int *columns, double **value) {
  const case_mistuning *m = &file->mistuning;
  const size_t          N = (size_t)file->mhb.blades;
  if (m->kind == CASE_MISTUNED_FILE) {
    const mhb_deviation_table table = {m->file, m->hz, m->mean, file->mhb.blades, n_modes};
    return mhb_deviation_table_read(&table, columns, value);
  }
  *columns   = 1;
  double *to = *value = malloc(N * sizeof *to);
  SHB_CHECK(to, SHB_ERR_IO, "out of memory");
  if (m->kind == CASE_MISTUNED_LIST) {
    memcpy(to, m->each, N * sizeof *to);
    return SHB_OK;
  }
  return mhb_deviations_random(m->deviation, m->seed, 0, (int)N, to);
}

/* The model becomes that of the ring. It is searched for other motions only where the case says
 * how. */
static shb_status make_ring(const case_file *file, case_model *m) {
  double *value     = NULL;
  int     columns   = 1;
  m->tuned          = m->model;
  m->model          = (modal_model){0};
  shb_status status = deviations(file, m->tuned.n_modes, &columns, &value);
  if (status == SHB_OK)
    status = mhb_mistuned_ring_create(&m->tuned, &m->settings, value, columns, &m->ring);
  free(value);
  SHB_TRY(status);
  m->model          = m->ring->whole;
  m->settings.ring  = m->ring;
  m->settings.flips = false;
  if (m->settings.search.starts == MHB_SEARCH_PEAKS) m->settings.search.starts = 0;
  return SHB_OK;
}

/* With nodal diameters the model is that of 0. */
static shb_status read_disc(const char *path, int modes, bool residuals, case_model *m) {
  modal_nodal_diameters *disc = calloc(1, sizeof *disc);
  SHB_CHECK(disc, SHB_ERR_IO, "out of memory");
  shb_status status = modal_nodal_diameters_read(path, disc);
  if (status != SHB_OK || disc->n == 0) {
    free(disc);
    return status;
  }
  m->disc = disc;
  if (modes > 0) SHB_TRY(modal_nodal_diameters_reduce(disc, modes, residuals));
  m->model                    = disc->model[0];
  m->settings.nodal_diameters = disc;
  return SHB_OK;
}

/* What the balance of a disc does not do. */
static shb_status check_disc(const case_file *file, const char *path, const case_model *m) {
  SHB_CHECK(!file->run_up || m->run_up, SHB_ERR_INPUT,
            "mhb.run_up: %s holds the modes of a disc at one speed; give rotor.speed as a list",
            path);
  SHB_CHECK(file->mistuning.kind == CASE_TUNED, SHB_ERR_INPUT,
            "rotor.mistuning: %s holds the modes of a disc, whose sectors are alike; leave it out, "
            "or clamp the blade at its root",
            path);
  SHB_TRY(mhb_receptance_check(&m->settings, 0));
  return check_use(path, &m->model);
}

/* contact.points: auto. */
static shb_status choose_points(const case_file *file, case_model *m) {
  if (!case_points_are_auto(file) || file->modal_file) return SHB_OK;
  SHB_TRY(
      contact_points_choose(&m->model, m->disc, &m->settings, file->points_tolerance, &m->points));
  if (m->points) m->settings.other_pairs = &m->points->pairs;
  return SHB_OK;
}

shb_status case_model_read(const case_file *file, const char *path, int modes, bool residuals,
                           case_model *m) {
  *m = (case_model){.settings = file->mhb};
  if (file->run_up) SHB_TRY(read_disc_speeds(path, modes, residuals, m));
  if (!m->disc) SHB_TRY(read_disc(path, modes, residuals, m));
  if (m->disc) {
    SHB_TRY(check_disc(file, path, m));
    return m->disc_run_up ? SHB_OK : choose_points(file, m);
  }
  if (file->run_up) return read_speeds(path, modes, residuals, m);
  SHB_TRY(modal_model_read(path, &m->model));
  SHB_TRY(check_use(path, &m->model));
  if (modes > 0) SHB_TRY(modal_model_reduce(&m->model, modes, residuals));
  if (file->mistuning.kind != CASE_TUNED) return make_ring(file, m);
  return choose_points(file, m);
}

shb_status case_model_join(case_model *m, int patches) {
  SHB_TRY(contact_points_join(&m->model, m->disc, patches, &m->points));
  if (m->points) m->settings.other_pairs = &m->points->pairs;
  return SHB_OK;
}

shb_status case_model_judge_points(case_model *m) {
  if (m->points || m->run_up || m->ring) return SHB_OK;
  SHB_TRY(contact_points_halve(&m->model, m->disc, &m->points));
  if (m->points) m->settings.other_pairs = &m->points->pairs;
  return SHB_OK;
}

shb_status case_model_face(case_model *m, const char *path) {
  if (m->run_up || m->ring || m->disc) return SHB_OK;
  SHB_TRY(modal_contact_face_read(path, &m->face));
  if (m->points && m->points->pairs.finer) modal_contact_face_join(&m->face, &m->points->joining);
  if (m->face.n_nodes > 0) m->settings.face = &m->face;
  return SHB_OK;
}

void case_model_free(case_model *m) {
  modal_contact_face_free(&m->face);
  if (!m->run_up && !m->ring && !m->disc) modal_model_free(&m->model);
  mhb_mistuned_ring_destroy(m->ring);
  modal_model_free(&m->tuned);
  contact_points_free(m->points);
  if (m->disc_run_up) { /* it owns all */
    mhb_disc_speeds_destroy(m->disc_top);
    mhb_disc_table_destroy(m->disc_run_up);
    *m = (case_model){0};
    return;
  }
  if (m->disc) modal_nodal_diameters_free(m->disc);
  free(m->disc);
  mhb_speed_model_destroy(m->top);
  mhb_speed_table_destroy(m->run_up);
  *m = (case_model){0};
}
