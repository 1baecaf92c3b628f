#include "modal/stage/sector_modes.h"

#include <math.h>
#include <string.h>

#include "modal/model/mode_selection.h"

enum { MOST_MODES = 1000, LEAST_STEP = 2 };

/* Whether the modes are enough at every nodal diameter; the largest error, and where it is. */
static shb_status judge(const modal_settings *settings, const modal_sector *sector, bool *enough,
                        double *error, int *at) {
  const modal_nodal_diameters *d = &sector->models;
  *enough                        = true;
  *error                         = 0;
  *at                            = 0;
  for (int i = 0; i < d->n; i++) {
    const modal_model *im   = d->imaginary[i].right ? &d->imaginary[i] : NULL;
    bool               here = true;
    double             off  = 0;
    SHB_TRY(
        modal_modes_suffice(&d->model[i], im, settings->band, settings->tolerance, &here, &off));
    *enough = *enough && here;
    if (off > *error) {
      *error = off;
      *at    = d->diameter[i];
    }
  }
  return SHB_OK;
}

static shb_status solve(MPI_Comm comm, const mesh_fe *mesh, const modal_settings *settings,
                        shb_progress *progress, modal_result *result, modal_sector *sector) {
  modal_settings here = *settings;
  memset(sector, 0, sizeof *sector);
  SHB_TRY(modal_solve(comm, mesh, settings, progress, result));
  here.modes = result->model.n_modes;
  return modal_sector_solve(mesh, &here, progress, result, NULL, sector);
}

shb_status modal_sector_solve_enough(MPI_Comm comm, const mesh_fe *mesh,
                                     const modal_settings *settings, shb_progress *progress,
                                     modal_result *result, modal_sector *sector) {
  modal_settings here   = *settings;
  bool           enough = true;
  double         error  = 0;
  int            at     = 0;
  for (;;) {
    SHB_TRY(solve(comm, mesh, &here, progress, result, sector));
    if (settings->modes > 0) return SHB_OK;
    SHB_TRY(judge(settings, sector, &enough, &error, &at));
    const int n = result->model.n_modes;
    if (enough) {
      shb_progress_note(progress,
                        "%d modes kept: the receptance at the contact errs by %.1e up to %.6g Hz, "
                        "most at nodal diameter %d",
                        n, error, settings->band, at);
      return SHB_OK;
    }
    SHB_CHECK(n < MOST_MODES, SHB_ERR_INPUT,
              "modal.modes: auto: with %d modes at each nodal diameter the receptance at the "
              "contact errs by %.1e up to %.6g Hz; give a greater modal.tolerance than %.1e, or a "
              "lower modal.band",
              n, error, settings->band, settings->tolerance);
    shb_progress_note(progress, "%d modes are too few at nodal diameter %d: error %.1e", n, at,
                      error);
    here.modes = n + (n / 4 > LEAST_STEP ? n / 4 : LEAST_STEP);
    modal_sector_free(sector, result);
    modal_result_free(result);
  }
}
