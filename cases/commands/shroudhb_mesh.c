/* shroudhb mesh: meshes the parametric blade of a case, or checks its mesh file. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/commands/stages.h"
#include "cases/commands/up_to_date.h"
#include "cases/schema/case.h"
#include "cases/schema/case_paths.h"
#include "mesh/base/progress.h"
#include "mesh/base/publish.h"
#include "mesh/blade/airfoil.h"
#include "mesh/blade/blade.h"
#include "mesh/core/face_pairing.h"
#include "mesh/core/fe_mesh.h"
#include "mesh/core/group_checks.h"
#include "mesh/gmsh/reading.h"
#include "mesh/io/inp_write.h"
#include "mesh/io/msh_write.h"
#include "mesh/io/read.h"
#include "mesh/io/source.h"

/* Checks both faces of an interface, or the right one if it meets the ground. pairing: zero
 * before. */
static shb_status check_faces(const case_file *file, const char *right, const char *left,
                              mesh_fe *mesh, mesh_pairing *pairing) {
  int r = mesh_fe_set_named(mesh, right), l = mesh_fe_set_named(mesh, left);
  *pairing = (mesh_pairing){0};
  if (file->mhb.to_ground) {
    char found[MESH_FOUND + 40];
    SHB_CHECK(mesh->set[r].n, SHB_ERR_INPUT,
              "group %s is absent or empty; contact to ground needs it; %s", right,
              mesh_fe_found(mesh, found));
    return SHB_OK;
  }
  SHB_TRY(mesh_fe_orient_groups(mesh, file->axis, r, l));
  mesh_fe view = mesh_fe_facing(mesh, r, l);
  return mesh_pairing_create(&view, file->axis, file->blades, pairing);
}

/* Checks all interfaces; pairing is that of the first. */
static shb_status check_contact(const case_file *file, mesh_fe *mesh, mesh_pairing *pairing) {
  *pairing  = (mesh_pairing){0};
  bool both = mesh->set[MESH_CONTACT_RIGHT].n > 0 && mesh->set[MESH_CONTACT_LEFT].n > 0;
  if (!file->has_contact && !(both && file->blades > 1)) return SHB_OK; /* touches nothing */
  for (int i = 0; i < file->n_interfaces; i++) {
    const case_interface *own = &file->interfaces[i];
    mesh_pairing          one;
    shb_status            status = check_faces(file, own->right, own->left, mesh, &one);
    if (status != SHB_OK && !own->mhb.name[0]) return status;
    if (status != SHB_OK)
      return shb_fail(status, __FILE__, __LINE__, "contact interface %s: %s", own->mhb.name,
                      shb_message());
    if (i == 0) *pairing = one;
    if (i > 0) mesh_pairing_free(&one);
  }
  return SHB_OK;
}

static void note_pairing(shb_progress *progress, const mesh_pairing *pairing) {
  if (pairing->projected)
    shb_progress_note(
        progress, "the contact faces do not match node for node: projected, at most %.3g m apart",
        pairing->gap);
}

/* Reads the mesh with the groups that the case names. */
static shb_status read_mesh(const case_file *file, const char *path, mesh_fe *mesh) {
  mesh_names names = mesh_rules_labels(&file->source.rules);
  SHB_TRY(mesh_fe_read(path, &names, mesh));
  shb_status status = mesh_fe_check_groups(mesh, path);
  if (status != SHB_OK) mesh_fe_free(mesh);
  return status;
}

/* Warns if coordinates seem to be in mm and not in m; the mesh itself is in order. */
static void warn_size(const case_file *file, const mesh_fe *mesh) {
  const double size  = mesh_fe_extent(mesh);
  const char  *doubt = mesh_unit_hint(size, file->source.unit_given);
  if (*doubt)
    fprintf(stderr, "shroudhb: warning: %s: the body measures %.3g m%s\n", file->mesh_file, size,
            doubt);
}

/* gmsh's own programs would run this file, and its user may expect that. */
static void warn_options(const char *path) {
  char beside[4096 + 8];
  if (mesh_reading_has_options(path, beside, sizeof beside))
    fprintf(stderr, "shroudhb: warning: %s: is not read; the case says what it would set\n",
            beside);
}

/* Checks that the mesh file of the case is readable, complete and usable for its contact. */
static shb_status check_file(const case_file *file, shb_progress *progress) {
  mesh_fe      mesh;
  mesh_pairing pairing;
  SHB_TRY(read_mesh(file, file->mesh_file, &mesh));
  shb_status status = check_contact(file, &mesh, &pairing);
  if (status != SHB_OK)
    status = shb_fail(status, __FILE__, __LINE__, "%s: %s", file->mesh_file, shb_message());
  if (status == SHB_OK)
    shb_progress_note(
        progress, "%s is sound: %d nodes, %d elements, %d contact node pairs, %d load faces",
        file->mesh_file, mesh.n_nodes, mesh.n_elements, pairing.n, mesh.set[MESH_LOAD].n);
  if (status == SHB_OK) {
    note_pairing(progress, &pairing);
    if (!progress->quiet) warn_size(file, &mesh);
  }
  mesh_pairing_free(&pairing);
  mesh_fe_free(&mesh);
  return status;
}

/* Makes NAME.msh from a solid, or from a mesh in other units or without groups. */
static shb_status make_from_file(const case_file *file, const char *output,
                                 const shb_provenance *provenance, shb_progress *progress) {
  mesh_fe      mesh;
  mesh_pairing pairing;
  SHB_TRY(mesh_source_read(&file->source, progress, &mesh));
  shb_progress_phase(progress, "mesh", "%d nodes, %d elements", mesh.n_nodes, mesh.n_elements);
  shb_status status = check_contact(file, &mesh, &pairing);
  if (status != SHB_OK)
    status = shb_fail(status, __FILE__, __LINE__, "%s: %s", file->mesh_file, shb_message());
  if (status == SHB_OK) status = mesh_msh_write(&mesh, output, provenance);
  if (status == SHB_OK) {
    shb_progress_phase(progress, "write", "%s", output);
    note_pairing(progress, &pairing);
    if (!progress->quiet) warn_size(file, &mesh);
    if (!progress->quiet) warn_options(file->mesh_file);
  }
  mesh_pairing_free(&pairing);
  mesh_fe_free(&mesh);
  return status;
}

static shb_status make_blade(const case_file *file, const char *output,
                             const shb_provenance *provenance, shb_progress *progress) {
  const double chord = mesh_airfoil_chord(&file->blade);
  SHB_TRY(mesh_blade_write(&file->blade, output, provenance, progress));
  if (file->blade.size > chord && !progress->quiet)
    fprintf(stderr,
            "shroudhb: warning: mesh.blade.size: %.3g mm is more than the chord, %.3g mm: "
            "frequencies can be 3 %% off and more\n",
            1e3 * file->blade.size, 1e3 * chord);
  return SHB_OK;
}

static shb_status make_at(const case_file *file, const command_options *options, const char *output,
                          char *settings, shb_progress *progress) {
  if (!options->force && up_to_date_mesh(output, settings)) {
    shb_progress_note(progress, "%s is up to date", output);
    return SHB_OK;
  }
  SHB_TRY(shb_publish_check(output));
  shb_provenance provenance = command_provenance(file, settings, "shroudhb-mesh");
  return file->mesh_file ? make_from_file(file, output, &provenance, progress)
                         : make_blade(file, output, &provenance, progress);
}

static shb_status make(const case_file *file, const command_options *options,
                       shb_progress *progress) {
  char      *settings = NULL, *output = case_output(file, ".msh");
  shb_status status = up_to_date_mesh_settings(file, &settings);
  if (status == SHB_OK) status = make_at(file, options, output, settings, progress);
  free(output);
  free(settings);
  return status;
}

/* Writes NAME.inp of the mesh that the case uses, unless that is its mesh file. */
static shb_status write_inp(const case_file *file, shb_progress *progress) {
  char      *source = case_mesh_path(file), *output = case_output(file, ".inp");
  mesh_fe    mesh   = {0};
  shb_status status = SHB_OK;
  if (strcmp(source, output) == 0)
    status =
        shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__, "%s is the mesh of the case itself", source);
  if (status == SHB_OK) status = read_mesh(file, source, &mesh);
  if (status == SHB_OK) status = mesh_inp_write(&mesh, output);
  if (status == SHB_OK) shb_progress_note(progress, "wrote %s", output);
  mesh_fe_free(&mesh);
  free(source);
  free(output);
  return status;
}

static shb_status run(const case_file *file, const command_options *options) {
  shb_progress progress = shb_progress_start("mesh", options->quiet, options->verbose);
  if (file->modal_file) {
    shb_progress_note(&progress, "modal.file is given: nothing to mesh");
    return SHB_OK;
  }
  shb_status status = file->mesh_file && !case_mesh_is_made(file) ? check_file(file, &progress)
                                                                  : make(file, options, &progress);
  if (status == SHB_OK && options->inp) status = write_inp(file, &progress);
  shb_progress_note(&progress, "%.2f s in all", shb_seconds() - progress.started);
  return status;
}

int mesh_command(const command_options *options) {
  case_file  file;
  shb_status status = command_read(options, CASE_MESH, &file);
  if (status != SHB_OK) return command_finish(status);
  shb_interrupt_catch();
  shb_interrupt_grace(2);
  status = run(&file, options);
  case_free(&file);
  return command_finish(status);
}
