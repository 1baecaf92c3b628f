#include "cases/converge/mesh_variant.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cases/commands/stage.h"
#include "cases/converge/resized_case.h"
#include "cases/schema/case.h"
#include "cases/schema/case_paths.h"
#include "mesh/base/memory.h"
#include "mesh/base/publish.h"
#include "modal/hdf5/h5.h"
#include "postproc/draw/text_buffer.h"

shb_status mesh_variant_folder(const char *path) {
  SHB_CHECK(mkdir(path, 0777) == 0 || errno == EEXIST, SHB_ERR_IO, "%s: cannot be made: %s", path,
            strerror(errno));
  return SHB_OK;
}

static char *join(const char *folder, const char *leaf) {
  return shb_text_of("%s/%s", folder, leaf);
}

/* Runs a stage. Its exit code is the status; its own message is the only one. */
static shb_status run_stage(command_id stage, const command_options *options,
                            shb_child_end *result) {
  SHB_TRY(stage_run(stage, options, result));
  return result->code == 0 ? SHB_OK
                           : shb_fail((shb_status)result->code, __FILE__, __LINE__, "%s", "");
}

/* Unknowns of the finite-element model in a modal file written by the modal stage. */
static double unknowns_of(const char *path) {
  hid_t    file;
  h5_shape shape;
  double   n = NAN;
  if (h5_open(path, &file) != SHB_OK) return NAN;
  if (h5_exists(file, "/mesh/nodes") && h5_shape_of(file, "/mesh/nodes", &shape) == SHB_OK)
    n = 3 * (double)shape.dim[0];
  h5_close(file);
  return n;
}

/* Writes MODAL.cost beside the modal file: seconds, memory, and the fingerprint of the measured
 * file. */
static void remember(mesh_variant *v, bool made) {
  char  print[17] = "", found[17] = "", *path = join(v->folder, "modes.cost");
  FILE *in;
  if (shb_fingerprint(v->modal, print) != SHB_OK) {
    free(path);
    return;
  }
  if (made) {
    post_buffer out = {0};
    post_put(&out, "%s %.9g %.9g\n", print, v->seconds, v->memory);
    /* a failure is harmless: the next run does not know the seconds */
    post_buffer_publish(&out, path);
    post_buffer_free(&out);
  } else if ((in = fopen(path, "r")) != NULL) {
    double seconds, memory;
    if (fscanf(in, "%16s %lf %lf", found, &seconds, &memory) == 3 && strcmp(found, print) == 0) {
      v->seconds = seconds;
      v->memory  = memory;
    }
    fclose(in);
  }
  free(path);
}

static struct timespec changed(const char *path) {
  struct stat info;
  return stat(path, &info) == 0 ? info.st_mtim : (struct timespec){0};
}

/* Makes mesh and modes of a case, and measures their cost if both had to be made.
 *   options  in  of the stages, with the path of the case */
static shb_status run_stages(const command_options *options, mesh_variant *v) {
  shb_child_end   mesh, modal;
  struct timespec before = changed(v->modal), after;
  SHB_TRY(run_stage(COMMAND_MESH, options, &mesh));
  SHB_TRY(run_stage(COMMAND_MODAL, options, &modal));
  after       = changed(v->modal);
  bool made   = after.tv_sec != before.tv_sec || after.tv_nsec != before.tv_nsec;
  v->unknowns = unknowns_of(v->modal);
  if (made) {
    v->seconds = mesh.cpu + modal.cpu;
    v->memory  = fmax(mesh.peak, modal.peak);
  }
  if (v->folder) remember(v, made);
  return SHB_OK;
}

shb_status mesh_variant_own(const case_file *file, const command_options *options,
                            mesh_variant *out) {
  *out                = (mesh_variant){.factor = 1, .seconds = NAN, .memory = NAN, .unknowns = NAN};
  out->modal          = case_modal_path(file);
  command_options own = *options;
  own.quiet           = true;
  own.verbose         = false;
  return file->modal_file ? SHB_OK : run_stages(&own, out);
}

/* Options of the stages of a derived case: its outputs lie beside it, its element sizes are its
 * own. */
typedef struct {
  command_options options;
  char            size[2][64]; /* overrides of the sizes, if the case has overrides */
  char           *path;
} derived_case;

static void set_sizes(const case_file *file, double factor, derived_case *d) {
  const double      value[] = {file->blade.size, file->blade.shroud_size};
  const char *const key[]   = {"size", "shroud_size"};
  command_options  *o       = &d->options;
  for (int i = 0; i < 2; i++) {
    if (o->n_set == 0 || o->n_set == COMMAND_SETS || value[i] == 0) continue;
    snprintf(d->size[i], sizeof d->size[i], "mesh.blade.%s=%.9g m", key[i], factor * value[i]);
    o->set[o->n_set++] = d->size[i];
  }
}

static shb_status derive(const case_file *file, const command_options *options, mesh_variant *v,
                         derived_case *d) {
  char leaf[CASE_NAME * 4];
  snprintf(leaf, sizeof leaf, "%s.yaml", file->name);
  d->path = join(v->folder, leaf);
  SHB_TRY(case_resize_mesh(file, v->factor, d->path));
  d->options         = *options;
  d->options.into    = NULL;
  d->options.quiet   = true;
  d->options.verbose = false;
  d->options.path    = d->path;
  set_sizes(file, v->factor, d);
  case_file derived;
  SHB_TRY(command_read(&d->options, CASE_MESH | CASE_MODAL, &derived));
  v->modal = case_modal_path(&derived);
  case_free(&derived);
  return SHB_OK;
}

shb_status mesh_variant_make(const case_file *file, const command_options *options,
                             const char *parent, double factor, mesh_variant *out) {
  char         leaf[40];
  derived_case d = {.path = NULL};
  *out           = (mesh_variant){.factor = factor, .seconds = NAN, .memory = NAN, .unknowns = NAN};
  snprintf(leaf, sizeof leaf, "mesh_%.4g", factor);
  out->folder = join(parent, leaf);
  SHB_TRY(mesh_variant_folder(out->folder));
  shb_status status = derive(file, options, out, &d);
  if (status == SHB_OK) status = run_stages(&d.options, out);
  free(d.path);
  return status;
}

void mesh_variant_free(mesh_variant *v) {
  free(v->folder);
  free(v->modal);
  *v = (mesh_variant){0};
}
