#include "cases/peaks/design_memory.h"

#include <string.h>

#include "cases/commands/load_model.h"
#include "cases/peaks/design_run.h"
#include "cases/schema/case.h"
#include "mhb/branches/sweep_memory.h"

/* Keys whose values change how much memory a sweep takes. */
static bool is_size(const study_key *key) {
  static const char *const path[] = {"mhb.harmonics", "contact.points", "rotor.blades",
                                     "mhb.subharmonics"};
  for (size_t i = 0; i < sizeof path / sizeof *path; i++)
    if (strcmp(key->path, path[i]) == 0) return true;
  return false;
}

static bool varies(const study_spec *spec) {
  for (int i = 0; i < spec->keys.n; i++)
    if (is_size(&spec->keys.key[i])) return true;
  return false;
}

/* Settings of the first sweep of a design. A ring has that of the case. */
static mhb_settings first_sweep(const case_file *file, bool ring, int sharing) {
  mhb_settings s = file->mhb;
  s.sharing      = sharing;
  if (ring) return s;
  s.stability = MHB_STABILITY_NEVER;
  s.harmonics = design_run_harmonics(&file->mhb);
  return s;
}

static mhb_sweep_size size_by_case(const case_file *file, int sharing) {
  const bool         ring  = file->mistuning.kind != CASE_TUNED;
  const mhb_settings s     = first_sweep(file, ring, sharing);
  int                pairs = 0;
  for (int i = 0; i < file->n_interfaces; i++)
    pairs += file->interfaces[i].points > 0 ? file->interfaces[i].points : 1;
  const modal_model model = {.n_pairs = pairs, .n_modes = file->modes > 0 ? file->modes : 1};
  mhb_sweep_size    size  = mhb_sweep_size_of(&model, &s);
  if (ring) size.blades = file->mhb.blades;
  return size;
}

/* A file that cannot be read is told by the designs. */
static void size_by_file(const case_file *file, int sharing, mhb_sweep_size *size) {
  case_model model;
  if (case_model_read(file, file->modal_file, 0, true, &model) == SHB_OK) {
    mhb_settings s    = first_sweep(file, model.ring != NULL, sharing);
    s.ring            = model.ring;
    s.run_up          = model.run_up;
    s.nodal_diameters = model.disc;
    s.disc_run_up     = model.disc_run_up;
    *size             = mhb_sweep_size_of(&model.model, &s);
  }
  case_model_free(&model);
}

/* The size of a design by its case, if it is larger than that before. */
static void grow(const study_spec *spec, int design, int sharing, FILE *errors,
                 mhb_sweep_size *largest) {
  const double *value = spec->design + (size_t)design * (size_t)spec->keys.n;
  case_file     file;
  if (study_spec_design(spec, value, NULL, NULL, errors, &file) != SHB_OK) return;
  mhb_sweep_size size = size_by_case(&file, sharing);
  if (file.modal_file && design == 0) size_by_file(&file, sharing, &size);
  if (file.modal_file && size.pairs < largest->pairs) size.pairs = largest->pairs;
  if (mhb_sweep_bytes(&size) > mhb_sweep_bytes(largest)) *largest = size;
  case_free(&file);
}

shb_status design_memory_check(const study_spec *spec, int sharing) {
  mhb_sweep_size largest = {.harmonics = 1, .sharing = sharing};
  const int      n       = varies(spec) ? spec->n_designs : 1;
  FILE          *errors  = fopen("/dev/null", "w"); /* the row of a design tells its faults */
  SHB_CHECK(errors, SHB_ERR_IO, "/dev/null cannot be opened");
  for (int i = 0; i < n && i < spec->n_designs; i++) grow(spec, i, sharing, errors, &largest);
  fclose(errors);
  return mhb_sweep_fits(&largest);
}
