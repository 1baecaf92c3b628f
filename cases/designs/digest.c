#include "cases/designs/digest.h"

#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "cases/schema/stage_settings.h"
#include "mesh/base/publish.h"
#include "mesh/io/source_files.h"

/* Changes whenever the way to compute outputs changes. */
static const char method[] = "exact peaks 2";

/* FNV-1a, 64 bits. */
static uint64_t add(uint64_t hash, const char *text) {
  for (; *text; text++) hash = (hash ^ (unsigned char)*text) * UINT64_C(1099511628211);
  return (hash ^ 0xFF) * UINT64_C(1099511628211);
}

static uint64_t add_stage(uint64_t hash, const case_file *file, case_stage stage) {
  char *settings = case_settings(file, stage);
  hash           = add(hash, settings ? settings : "");
  free(settings);
  return hash;
}

static uint64_t modes(const case_file *file, const char *inputs) {
  uint64_t hash = add(UINT64_C(14695981039346656037), inputs);
  hash          = add_stage(hash, file, CASE_MESH);
  return add_stage(hash, file, CASE_MODAL);
}

static void print(uint64_t hash, char out[DIGEST_TEXT]) {
  snprintf(out, DIGEST_TEXT, "%016" PRIx64, hash);
}

/* With all that a mesh file includes. */
static shb_status add_mesh(const char *path, FILE *out) {
  char print[17];
  if (!path) return SHB_OK;
  SHB_TRY(mesh_source_fingerprint(path, print));
  fprintf(out, "%s\n", print);
  return SHB_OK;
}

static shb_status add_file(const char *path, FILE *out) {
  char print[17];
  if (!path) return SHB_OK;
  SHB_TRY(shb_fingerprint(path, print));
  fprintf(out, "%s\n", print);
  return SHB_OK;
}

shb_status digest_inputs(const case_file *file, char **inputs) {
  size_t size = 0;
  *inputs     = NULL;
  FILE *out   = open_memstream(inputs, &size);
  SHB_CHECK(out, SHB_ERR_IO, "out of memory");
  shb_status status = add_mesh(file->mesh_file, out);
  if (status == SHB_OK) status = add_file(file->modal_file, out);
  for (int i = 0; i < file->n_loads && status == SHB_OK; i++)
    status = add_file(file->loads[i].field, out);
  if (status == SHB_OK) status = add_file(file->mistuning.file, out);
  fclose(out);
  return status;
}

void digest_modes(const case_file *file, const char *inputs, char out[DIGEST_TEXT]) {
  print(modes(file, inputs), out);
}

void digest_design(const case_file *file, const char *inputs, int n_outputs,
                   const study_output *output, char out[DIGEST_TEXT]) {
  uint64_t hash  = add_stage(add(modes(file, inputs), method), file, CASE_MHB);
  bool     field = false; /* fatigue and gauges count */
  for (int i = 0; i < n_outputs; i++) {
    study_quantity q = output[i].quantity;
    hash             = add(hash, output[i].name);
    field            = field || q == STUDY_STRESS || q == STUDY_SAFETY || q == STUDY_GAUGE;
  }
  if (field) hash = add_stage(hash, file, CASE_POST);
  print(hash, out);
}
