#include "cases/commands/load_model.h"

#include <complex.h>

#include "mesh/base/constants.h"
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
  if (status == SHB_OK) status = mhb_speed_model_create(m->run_up, &m->top);
  SHB_TRY(status);
  mhb_speed_model_set(m->top, SHB_TWO_PI * f[1]);
  m->model           = m->top->model;
  m->settings.run_up = m->run_up;
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

/* A file of nodal diameters has a model for each wave, which the balance does not use yet. */
static shb_status refuse_disc(const char *path) {
  modal_nodal_diameters disc;
  SHB_TRY(modal_nodal_diameters_read(path, &disc));
  const int n = disc.n;
  modal_nodal_diameters_free(&disc);
  SHB_CHECK(n == 0, SHB_ERR_INPUT,
            "%s: holds modes of a disc at %d nodal diameters, which the balance does not use yet; "
            "leave out the groups cyclic_right and cyclic_left and clamp the sides or the blade",
            path, n);
  return SHB_OK;
}

shb_status case_model_read(const case_file *file, const char *path, int modes, bool residuals,
                           case_model *m) {
  *m = (case_model){.settings = file->mhb};
  SHB_TRY(refuse_disc(path));
  if (file->run_up) return read_speeds(path, modes, residuals, m);
  SHB_TRY(modal_model_read(path, &m->model));
  SHB_TRY(check_use(path, &m->model));
  return modes > 0 ? modal_model_reduce(&m->model, modes, residuals) : SHB_OK;
}

void case_model_free(case_model *m) {
  if (!m->run_up) modal_model_free(&m->model);
  mhb_speed_model_destroy(m->top);
  mhb_speed_table_destroy(m->run_up);
  *m = (case_model){0};
}
