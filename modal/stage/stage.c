#include "modal/stage/stage.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>

#include "fem/body/partition.h"
#include "fem/body/stress.h"
#include "fem/solver/petsc_error.h"
#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mesh/core/cyclic_sides.h"
#include "mesh/core/group_checks.h"
#include "mesh/io/read.h"
#include "modal/common/phases.h"
#include "modal/common/session.h"
#include "modal/common/team.h"
#include "modal/model/receptance.h"
#include "modal/stage/model_export.h"
#include "modal/stage/sector_export.h"
#include "modal/stage/sector_modes.h"
#include "modal/stage/speed_range.h"

/* All mode shapes on rank 0, [m][n_nodes][3]; NULL elsewhere. Free with free. */
static shb_status gather_shapes(const modal_result *result, int rank, double **shape) {
  const size_t stride = 3 * (size_t)result->system.n_nodes;
  *shape = rank == 0 ? shb_alloc((size_t)result->eigen.n * stride, sizeof **shape) : NULL;
  for (int i = 0; i < result->eigen.n; i++) {
    Vec phi;
    FEM_PETSC(MatDenseGetColumnVecRead(result->eigen.phi, i, &phi));
    FEM_PETSC(
        fem_system_gather(&result->system, phi, rank == 0 ? *shape + (size_t)i * stride : NULL));
    FEM_PETSC(MatDenseRestoreColumnVecRead(result->eigen.phi, i, &phi));
  }
  return SHB_OK;
}

/* Compute the stresses about the static equilibrium, if there is one. */
static shb_status find_stresses(const mesh_fe *mesh, const modal_settings *settings,
                                const modal_result *result, modal_fields *of) {
  const int     modes = result->eigen.n, columns = result->residual.n;
  const size_t  each  = (size_t)mesh->n_nodes * FEM_STRESSES * sizeof(float);
  const double *state = result->deflection.at.displacement;
  modal_body   *body;
  of->stress               = shb_alloc((size_t)modes, each);
  of->residual_stress      = shb_alloc((size_t)columns, each);
  shb_status        status = modal_body_create(mesh, settings, &body);
  const fem_motions set[]  = {{modes, of->shape, of->stress},
                              {columns, result->residual.shape, of->residual_stress}};
  if (status == SHB_OK) fem_nodal_stress_changes(&body->body, state, 2, set);
  free(body);
  return status;
}

/* All that rank 0 writes. */
typedef struct {
  const mesh_fe        *mesh;
  const modal_result   *result;
  const modal_speeds   *speeds; /* n = 0: one speed */
  const modal_sector   *sector; /* models.n = 0: a clamped blade */
  const modal_fields   *of;
  const shb_provenance *provenance;
} contents;

static shb_status write_all(hid_t file, const contents *c) {
  const mesh_fe      *mesh   = c->mesh;
  const modal_result *result = c->result;
  const modal_speeds *speeds = c->speeds;
  const modal_fields *of     = c->of;
  if (c->sector->models.n > 0)
    return modal_sector_write(file, mesh, result, of, c->sector, c->provenance);
  SHB_TRY(modal_model_write(file, &result->model, c->provenance));
  if (speeds->n > 0) SHB_TRY(modal_speeds_write(file, speeds));
  SHB_TRY(modal_export_mesh(file, mesh));
  SHB_TRY(modal_export_shapes(file, result->model.n_modes, mesh->n_nodes, of->shape));
  SHB_TRY(modal_export_stress(file, result->model.n_modes, mesh->n_nodes, of->stress));
  SHB_TRY(modal_residual_shapes_write(file, &result->residual, of->residual_stress));
  SHB_TRY(modal_export_check(file, &result->eigen.check));
  SHB_TRY(modal_export_turning(file, result->coriolis));
  SHB_TRY(modal_participation_write(file, &result->participation));
  SHB_TRY(modal_export_contact(file, &result->patches));
  SHB_TRY(modal_receptance_write(file, &result->model));
  SHB_TRY(modal_deflection_write(file, &result->deflection, mesh->n_nodes, mesh->n_elements,
                                 &result->model));
  return modal_export_vtk(file, mesh, result->model.n_modes, result->model.frequency);
}

/* The phases of progress are written to the file. */
static shb_status publish(const char *path, const contents *all, const shb_progress *progress) {
  char      *temporary = shb_publish_temporary(path);
  hid_t      file      = -1;
  shb_status status    = h5_create(temporary, &file);
  if (status == SHB_OK) {
    int ranks;
    MPI_Comm_size(all->result->system.comm, &ranks);
    status = write_all(file, all);
    if (status == SHB_OK) status = modal_phases_write(file, ranks, progress, "write");
    shb_status closed = h5_close(file);
    if (status == SHB_OK) status = closed;
    if (status == SHB_OK)
      status = shb_publish(temporary, path);
    else
      remove(temporary);
  }
  free(temporary);
  return status;
}

/* Pair the sides of a sector with a disc, if the mesh has them. */
static shb_status pair_sides(const modal_settings *settings, mesh_fe *mesh,
                             shb_progress *progress) {
  mesh_cyclic_sides sides;
  SHB_TRY(mesh_cyclic_pair(mesh, settings->axis, settings->blades, &sides));
  if (sides.n > 0)
    shb_progress_note(progress, "cyclic sides: %d pairs of nodes, largest gap %.2g m, no orphans",
                      sides.n, sides.gap);
  return SHB_OK;
}

/* Makes the right face of an interface the right one. The usual groups name the sides of a blade,
 * which may meet the ground as well. */
static shb_status orient(const modal_settings *settings, const modal_contact *contact,
                         mesh_fe *mesh) {
  const int right = mesh_fe_set_named(mesh, contact->right),
            left  = mesh_fe_set_named(mesh, contact->left);
  const bool free = settings->may_be_free && settings->blades < 2;
  if (free || (contact->to_ground && contact->name[0]) || right < 0 || left < 0 ||
      mesh->set[right].n == 0 || mesh->set[left].n == 0)
    return SHB_OK;
  return mesh_fe_orient_groups(mesh, settings->axis, right, left);
}

static shb_status read_mesh(const char *path, const modal_settings *settings,
                            shb_progress *progress, mesh_fe *mesh) {
  mesh_names names = {.n_more = settings->n_groups};
  for (int i = 0; i < settings->n_groups; i++)
    names.more[i].label = names.more[i].name = settings->group[i];
  for (int i = 0; i < settings->n_regions && settings->region[i].name; i++, names.n_volumes++)
    names.volume[i].label = names.volume[i].name = settings->region[i].name;
  SHB_TRY(mesh_fe_read(path, &names, mesh));
  SHB_TRY(mesh_fe_check_groups(mesh, path));
  for (int i = 0; i < settings->n_contacts; i++)
    SHB_TRY(orient(settings, &settings->contact[i], mesh));
  return pair_sides(settings, mesh, progress);
}

/* What the modes left out would change with Coriolis terms: docs/theory/coriolis.md. */
static void note_coriolis(const modal_settings *settings, const modal_result *first,
                          const modal_sector *sector, shb_progress *progress) {
  const int m    = first->model.n_modes;
  double    last = first->model.frequency[m - 1];
  if (settings->coriolis == FEM_TURNS_UNSAID) return;
  for (int i = 0; i < sector->models.n; i++)
    last = fmin(last, sector->models.model[i].frequency[m - 1]);
  const double ratio = settings->speed / (SHB_TWO_PI * last);
  shb_progress_note(progress,
                    "Coriolis terms: modes left out change low frequencies by less than %.1e",
                    2 * ratio * ratio);
}

/* The rotor turns at every speed. */
static bool turns(const modal_settings *settings) {
  bool all = settings->speed > 0;
  for (int i = 0; i < settings->n_speeds; i++) all = all && settings->speeds[i] > 0;
  return all;
}

static shb_status run(MPI_Comm comm, int rank, const char *out_path, const mesh_fe *mesh,
                      const modal_settings *settings, const shb_provenance *provenance,
                      shb_progress *progress) {
  modal_result result;
  modal_speeds speeds = {0};
  modal_sector sector = {0};
  modal_fields of     = {NULL, NULL, NULL};
  shb_status   status;
  if (mesh->image) SHB_TRY(modal_sector_check(comm, settings));
  SHB_CHECK(settings->coriolis == FEM_TURNS_UNSAID || turns(settings), SHB_ERR_INPUT,
            "rotor.coriolis needs rotor.speed above 0; at rest there are no Coriolis forces");
  if (settings->n_speeds > 1)
    status = modal_speed_range_solve(comm, mesh, settings, progress, &speeds,
                                     mesh->image ? &sector : NULL, &result);
  else if (mesh->image)
    status = modal_sector_solve_enough(comm, mesh, settings, progress, &result, &sector);
  else
    status = modal_solve(comm, mesh, settings, progress, &result);
  if (status == SHB_OK) status = fem_petsc_status(modal_eigen_drop_factor(&result.eigen));
  if (status == SHB_OK) status = gather_shapes(&result, rank, &of.shape);
  if (status == SHB_OK)
    status = modal_agree(comm, rank == 0 ? find_stresses(mesh, settings, &result, &of) : SHB_OK);
  if (status == SHB_OK)
    modal_phase(comm, progress, "stress", "%d modes at %d nodes", result.eigen.n, mesh->n_nodes);
  if (status == SHB_OK) note_coriolis(settings, &result, &sector, progress);
  if (status == SHB_OK) {
    shb_progress_show(progress, 96, "writing %s", out_path);
    const contents all  = {mesh, &result, &speeds, &sector, &of, provenance};
    shb_status     mine = rank != 0 ? SHB_OK : publish(out_path, &all, progress);
    status              = modal_agree(comm, mine);
    if (status == SHB_OK) modal_phase(comm, progress, "write", "%s", out_path);
  }
  free(of.shape);
  free(of.stress);
  free(of.residual_stress);
  modal_sector_free(&sector, &result);
  modal_speed_range_free(&speeds, &result);
  modal_result_free(&result);
  return status;
}

/* On the ranks of comm. */
static shb_status work(MPI_Comm comm, const char *out_path, mesh_fe *mesh,
                       const modal_settings *settings, const shb_provenance *provenance,
                       shb_progress *progress) {
  int rank;
  MPI_Comm_rank(comm, &rank);
  FEM_PETSC(fem_mesh_broadcast(comm, mesh));
  modal_phase(comm, progress, "mesh", "%d nodes, %d elements", mesh->n_nodes, mesh->n_elements);
  return run(comm, rank, out_path, mesh, settings, provenance, progress);
}

shb_status modal_stage(MPI_Comm all, const char *mesh_path, const char *out_path,
                       const modal_settings *settings, const shb_provenance *provenance,
                       shb_progress *progress) {
  int        rank;
  mesh_fe    mesh = {0};
  modal_team team = {.all = all};
  MPI_Comm_rank(all, &rank);
  shb_progress_show(progress, 0, "reading %s", mesh_path);
  const int  threads = omp_get_max_threads(); /* gmsh sets it to 1 */
  shb_status status =
      modal_agree(all, rank == 0 ? read_mesh(mesh_path, settings, progress, &mesh) : SHB_OK);
  omp_set_num_threads(threads);
  if (status == SHB_OK) status = modal_team_gather(all, mesh.n_nodes, &team);
  if (team.gathered)
    shb_progress_note(progress,
                      "the ranks share a machine: they work as one process with %d "
                      "threads",
                      team.threads);
  if (status == SHB_OK && team.works)
    status = work(team.comm, out_path, &mesh, settings, provenance, progress);
  status = modal_team_end(&team, status);
  mesh_fe_free(&mesh);
  shb_progress_clear(progress);
  return status;
}
