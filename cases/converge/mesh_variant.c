#include "cases/converge/mesh_variant.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cases/commands/subprocess.h"
#include "cases/converge/resized_case.h"
#include "cases/schema/case.h"
#include "cases/schema/case_paths.h"
#include "mesh/base/publish.h"
#include "modal/hdf5/h5.h"
#include "postproc/draw/text_buffer.h"

shb_status mesh_variant_folder(const char *path) {
  SHB_CHECK(mkdir(path, 0777) == 0 || errno == EEXIST, SHB_ERR_IO, "%s: cannot be made: %s", path,
            strerror(errno));
  return SHB_OK;
}

static char *join(const char *folder, const char *leaf) {
  size_t size = strlen(folder) + strlen(leaf) + 2;
  char  *path = malloc(size);
  if (path) snprintf(path, size, "%s/%s", folder, leaf);
  return path;
}

/* Runs one stage of a case file, which prints its own messages on stderr. */
static shb_status run_stage(const char *stage, const char *path, bool force,
                            subprocess_result *result) {
  char  quiet[] = "--quiet", forced[] = "--force", end[] = "--", name[32];
  char *words[6] = {NULL};
  int   n        = 0;
  snprintf(name, sizeof name, "shroudhb-%s", stage);
  words[n++] = subprocess_program(name);
  words[n++] = quiet;
  if (force) words[n++] = forced;
  if (path[0] == '-') words[n++] = end;
  words[n++]        = strdup(path);
  shb_status status = words[0] && words[n - 1]
                          ? subprocess_run(words, result)
                          : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  free(words[n - 1]);
  free(words[0]);
  if (status == SHB_OK && result->code != 0)
    return shb_fail((shb_status)result->code, __FILE__, __LINE__, "%s", "");
  return status;
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
  if (!path || shb_fingerprint(v->modal, print) != SHB_OK) {
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

/* Makes mesh and modes of the case at path, and measures their cost if both had to be made. */
static shb_status run_stages(const char *path, bool force, mesh_variant *v) {
  subprocess_result mesh, modal;
  struct timespec   before = changed(v->modal), after;
  SHB_TRY(run_stage("mesh", path, force, &mesh));
  SHB_TRY(run_stage("modal", path, force, &modal));
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
  *out       = (mesh_variant){.factor = 1, .seconds = NAN, .memory = NAN, .unknowns = NAN};
  out->modal = case_modal_path(file);
  SHB_CHECK(out->modal, SHB_ERR_IO, "out of memory");
  return file->modal_file ? SHB_OK : run_stages(file->path, options->force, out);
}

static shb_status derive(const case_file *file, mesh_variant *v, char **path) {
  char leaf[CASE_NAME * 4];
  snprintf(leaf, sizeof leaf, "%s.yaml", file->name);
  *path = join(v->folder, leaf);
  SHB_CHECK(*path, SHB_ERR_IO, "out of memory");
  SHB_TRY(case_resize_mesh(file, v->factor, *path));
  case_file derived;
  SHB_TRY(case_read(*path, CASE_MESH | CASE_MODAL, stderr, &derived));
  v->modal = case_modal_path(&derived);
  case_free(&derived);
  SHB_CHECK(v->modal, SHB_ERR_IO, "out of memory");
  return SHB_OK;
}

shb_status mesh_variant_make(const case_file *file, const command_options *options,
                             const char *parent, double factor, mesh_variant *out) {
  char leaf[40], *path = NULL;
  *out = (mesh_variant){.factor = factor, .seconds = NAN, .memory = NAN, .unknowns = NAN};
  snprintf(leaf, sizeof leaf, "mesh_%.4g", factor);
  out->folder = join(parent, leaf);
  SHB_CHECK(out->folder, SHB_ERR_IO, "out of memory");
  SHB_TRY(mesh_variant_folder(out->folder));
  shb_status status = derive(file, out, &path);
  if (status == SHB_OK) status = run_stages(path, options->force, out);
  free(path);
  return status;
}

void mesh_variant_free(mesh_variant *v) {
  free(v->folder);
  free(v->modal);
  *v = (mesh_variant){0};
}
