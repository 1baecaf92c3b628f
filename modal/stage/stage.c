#include "modal/stage/stage.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fem/body/clamp_check.h"
#include "fem/body/energy.h"
#include "fem/body/partition.h"
#include "fem/element/hourglass.h"
#include "fem/element/surface.h"
#include "fem/solver/petsc_error.h"
#include "mesh/core/group_checks.h"
#include "mesh/io/read.h"
#include "modal/common/phases.h"
#include "modal/condense/condense.h"
#include "modal/model/mode_selection.h"
#include "modal/model/reduce.h"
#include "modal/stage/model_export.h"
#include "modal/stage/speed_range.h"

enum { FIRST_MODES = 20, MOST_MODES = 1000 }; /* with modes: auto */

/* The worst status of all ranks; collective. */
static shb_status agree(MPI_Comm comm, shb_status status) {
  int mine = status, worst = status;
  MPI_Allreduce(&mine, &worst, 1, MPI_INT, MPI_MAX, comm);
  if (worst != SHB_OK && mine == SHB_OK) SHB_FAIL((shb_status)worst, "another rank failed");
  return (shb_status)worst;
}

/* Three dofs a probe: its nearest node in that node's cylindrical axes. */
static shb_status probe_dofs(const mesh_fe *mesh, const modal_settings *settings,
                             modal_dofs *dofs) {
  const double one = 1;
  for (int q = 0; q < settings->n_probes; q++) {
    double axes[3][3];
    char   what[96];
    int    node = 0;
    snprintf(what, sizeof what, "probe.%s", settings->probe[q].name);
    SHB_TRY(mesh_fe_near(mesh, settings->probe[q].at, what, &node));
    mesh_axes_at(settings->axis, mesh->coordinates + 3 * (size_t)node, axes);
    SHB_CHECK(axes[2][0] == axes[2][0], SHB_ERR_INPUT,
              "probe.%s: its nearest node lies on the engine axis; check rotor.axis",
              settings->probe[q].name);
    for (int a = 0; a < 3; a++) SHB_TRY(modal_dofs_add(dofs, 1, &node, &one, axes[a]));
  }
  return SHB_OK;
}

static shb_status name_probes(const modal_settings *settings, modal_model *model) {
  model->probe_name = calloc((size_t)settings->n_probes + 1, sizeof *model->probe_name);
  SHB_CHECK(model->probe_name, SHB_ERR_IO, "out of memory for the probes");
  for (int q = 0; q < settings->n_probes; q++) {
    model->probe_name[q] = strdup(settings->probe[q].name);
    SHB_CHECK(model->probe_name[q], SHB_ERR_IO, "out of memory for the probes");
  }
  return SHB_OK;
}

static shb_status copy_patches(const modal_interface *interface, modal_model *model) {
  const size_t n = (size_t)interface->n_pairs;
  model->normal  = malloc(3 * n * sizeof(double));
  model->area    = malloc(n * sizeof(double));
  SHB_CHECK(model->normal && model->area, SHB_ERR_IO, "out of memory for the contact patches");
  memcpy(model->normal, interface->normal, 3 * n * sizeof(double));
  memcpy(model->area, interface->area, n * sizeof(double));
  return SHB_OK;
}

/* An interface by its groups; its name heads error texts. */
static shb_status create_contact(const mesh_fe *mesh, const modal_settings *settings,
                                 const modal_contact *contact, modal_interface *out) {
  int        right = mesh_fe_set_named(mesh, contact->right);
  int        left  = settings->to_ground ? -1 : mesh_fe_set_named(mesh, contact->left);
  const bool there = right >= 0 && (left >= 0 || settings->to_ground);
  char       found[MESH_FOUND + 40];
  SHB_CHECK(there, SHB_ERR_INPUT, "contact interface %s: the mesh has no group \"%s\"; %s",
            contact->name, right < 0 ? contact->right : contact->left, mesh_fe_found(mesh, found));
  mesh_fe    view   = mesh_fe_facing(mesh, right, left);
  shb_status status = modal_interface_create(&view, settings->axis, settings->blades,
                                             settings->to_ground, contact->points, out);
  if (status == SHB_OK) status = modal_interface_check(out, contact->psi, contact->phi);
  if (status == SHB_OK) return SHB_OK;
  modal_interface_free(out);
  return shb_fail(status, __FILE__, __LINE__, "contact interface %s: %s", contact->name,
                  shb_message());
}

static shb_status create_interfaces(const mesh_fe *mesh, const modal_settings *settings,
                                    modal_interface *out) {
  const int       n                          = settings->n_contacts;
  modal_interface part[MODAL_MAX_INTERFACES] = {{0}};
  shb_status      status                     = SHB_OK;
  if (n == 0) {
    SHB_TRY(modal_interface_create(mesh, settings->axis, settings->blades, settings->to_ground,
                                   settings->points, out));
    return modal_interface_check(out, settings->psi, settings->phi);
  }
  for (int i = 0; i < n && status == SHB_OK; i++)
    status = create_contact(mesh, settings, &settings->contact[i], &part[i]);
  if (status == SHB_OK) status = modal_interface_join(n, part, out);
  for (int i = 0; i < n; i++) modal_interface_free(&part[i]);
  return status;
}

/* Which interface each pair belongs to; one alone needs no name. */
static shb_status name_interfaces(const modal_settings *settings, const modal_interface *interface,
                                  modal_model *model) {
  const int n = settings->n_contacts;
  if (n < 2) return SHB_OK;
  model->interface      = malloc((size_t)interface->n_pairs * sizeof *model->interface);
  model->interface_name = calloc((size_t)n, sizeof *model->interface_name);
  SHB_CHECK(model->interface && model->interface_name, SHB_ERR_IO,
            "out of memory for the contact patches");
  memcpy(model->interface, interface->which, (size_t)interface->n_pairs * sizeof *model->interface);
  for (model->n_interfaces = 0; model->n_interfaces < n; model->n_interfaces++) {
    char *name = strdup(settings->contact[model->n_interfaces].name);
    SHB_CHECK(name, SHB_ERR_IO, "out of memory for the contact patches");
    model->interface_name[model->n_interfaces] = name;
  }
  return SHB_OK;
}

/* What can be wrong with the input is found here, before any time is spent. */
static shb_status prepare(const mesh_fe *mesh, const modal_settings *settings,
                          modal_interface *interface, modal_condensation *to) {
  char found[MESH_FOUND + 40];
  SHB_TRY(fem_clamp_check(mesh));
  if (!settings->full_integration) SHB_TRY(fem_hourglass_check(mesh));
  SHB_CHECK(settings->pressure == 0 || mesh->set[MESH_LOAD].n > 0, SHB_ERR_INPUT,
            "the mesh has no group \"%s\" for rotor.pressure; name the loaded faces so; %s",
            mesh_set_name(MESH_LOAD), mesh_fe_found(mesh, found));
  SHB_TRY(create_interfaces(mesh, settings, interface));
  to->n_pairs  = interface->n_pairs;
  to->has_left = interface->has_left;
  to->damping  = settings->damping;
  SHB_TRY(modal_interface_dofs(interface, &to->contact));
  SHB_TRY(probe_dofs(mesh, settings, &to->probe));
  const double *fallback = settings->n_probes > 0 ? settings->probe[0].at : NULL;
  return modal_load_create(mesh, settings->n_loads ? settings->n_loads : 1,
                           settings->n_loads ? settings->loads : &settings->load, fallback,
                           &to->load);
}

/* Eigenvalues as Rayleigh quotients from the strains, on rank 0: the solver's own carry the rounding of K, which in a
 * slender body reaches 1e-9 and changes with the number of ranks; these are good to about 1e-12. */
static PetscErrorCode refine(const fem_body *body, const double *state, const fem_system *system,
                             modal_eigen *eigen) {
  const size_t stride = 3 * (size_t)body->mesh->n_nodes;
  double      *u;
  int          rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(system->comm, &rank));
  PetscCall(PetscMalloc1(rank == 0 ? FEM_FIELDS * stride : 1, &u));
  for (int first = 0; first < eigen->n; first += FEM_FIELDS) {
    const int count = PetscMin(FEM_FIELDS, eigen->n - first);
    for (int i = 0; i < count; i++) {
      Vec phi;
      PetscCall(MatDenseGetColumnVecRead(eigen->phi, first + i, &phi));
      PetscCall(fem_system_gather(system, phi, rank == 0 ? u + (size_t)i * stride : u));
      PetscCall(MatDenseRestoreColumnVecRead(eigen->phi, first + i, &phi));
    }
    if (rank == 0) fem_tangent_energies(body, state, count, u, eigen->lambda + first);
  }
  for (int i = 1; i < eigen->n; i++) /* equal pairs */
    eigen->lambda[i] = PetscMax(eigen->lambda[i], eigen->lambda[i - 1]);
  PetscCallMPI(MPI_Bcast(eigen->lambda, eigen->n, MPI_DOUBLE, 0, system->comm));
  PetscCall(PetscFree(u));
  PetscFunctionReturn(0);
}

/* Matrices of the body, at its equilibrium if it rotates. */
static shb_status assemble(MPI_Comm comm, const fem_body *body, const modal_condensation *to,
                           shb_progress *progress, modal_result *result) {
  shb_progress_show(progress, 5, "assembling %d elements", body->mesh->n_elements);
  FEM_PETSC(
      fem_system_create(comm, body->mesh, body->material, body->element->rules, &result->system));
  modal_phase(comm, progress, "assembly", "%d elements, %d dofs", body->mesh->n_elements,
              (int)(3 * result->system.n_free));
  if (body->rotation.speed == 0 && body->pressure == 0) return SHB_OK;
  return modal_deflect(body, &result->system, to, &result->interface, progress,
                       &result->deflection);
}

/* That many modes, condensed. */
static shb_status find_modes(const fem_body *body, const modal_settings *settings,
                             const modal_condensation *to, int modes, shb_progress *progress,
                             modal_result *result) {
  modal_eigen_settings eigen = {.modes = modes, .progress = progress, .check = settings->check};
  FEM_PETSC(modal_eigen_solve(&result->system, &eigen, &result->eigen));
  SHB_CHECK(result->eigen.n > 0, SHB_INTERRUPTED, "interrupted");
  FEM_PETSC(refine(body, result->deflection.at.displacement, &result->system, &result->eigen));
  modal_phase(result->system.comm, progress, "refinement", "eigenvalues from the strains");
  SHB_CHECK(result->eigen.lambda[0] > 0, SHB_ERR_INPUT,
            "rotor.speed: the static equilibrium at %.6g rad/s is not stable (lowest eigenvalue "
            "%.3g rad2/s2); give a lower speed",
            body->rotation.speed, result->eigen.lambda[0]);
  return modal_condense(&result->system, &result->eigen, to, progress, &result->model);
}

/* As many modes as the tolerance needs: twice as many until there are enough, then the fewest of them. */
static shb_status find_enough(const fem_body *body, const modal_settings *settings,
                              const modal_condensation *to, shb_progress *progress,
                              modal_result *result) {
  const int most  = (int)PetscMin(MOST_MODES, 3 * result->system.n_free);
  int       modes = PetscMin(FIRST_MODES, most), enough = 0;
  double    error = 0;
  for (;; modes = PetscMin(2 * modes, most)) {
    SHB_TRY(find_modes(body, settings, to, modes, progress, result));
    SHB_TRY(modal_enough(&result->model, settings->band, settings->tolerance, &enough, &error));
    if (enough > 0) break;
    SHB_CHECK(modes < most, SHB_ERR_INPUT,
              "modal.modes: auto: with %d modes, to %.6g Hz, the receptance at the contact errs by "
              "%.1e up to %.6g Hz; give a greater modal.tolerance than %.1e, or a lower modal.band",
              modes, result->model.frequency[modes - 1], error, settings->band,
              settings->tolerance);
    modal_model_free(&result->model);
    memset(&result->model, 0, sizeof result->model);
    FEM_PETSC(modal_eigen_destroy(&result->eigen));
  }
  shb_progress_note(progress,
                    "%d of %d modes kept: the receptance at the contact errs by %.1e up to %.6g Hz",
                    enough, modes, error, settings->band);
  result->eigen.n = enough;
  return modal_model_keep(&result->model, enough, true);
}

static shb_status solve(MPI_Comm comm, const fem_body *body, const modal_settings *settings,
                        const modal_condensation *to, shb_progress *progress,
                        modal_result *result) {
  SHB_TRY(assemble(comm, body, to, progress, result));
  if (settings->modes > 0)
    SHB_TRY(find_modes(body, settings, to, settings->modes, progress, result));
  else
    SHB_TRY(find_enough(body, settings, to, progress, result));
  SHB_TRY(modal_participate(body, result->deflection.at.displacement, &result->system,
                            &result->eigen, &result->participation));
  modal_phase(comm, progress, "participation", "effective masses");
  SHB_TRY(name_probes(settings, &result->model));
  SHB_TRY(name_interfaces(settings, &result->interface, &result->model));
  return copy_patches(&result->interface, &result->model);
}

static shb_status solve_body(MPI_Comm comm, const mesh_fe *mesh, const modal_settings *settings,
                             const modal_condensation *to, shb_progress *progress,
                             modal_result *result) {
  fem_element *element = malloc(sizeof *element);
  SHB_TRY(
      agree(comm, element ? SHB_OK : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory")));
  fem_material materials[MESH_MAX_VOLUMES] = {settings->material};
  for (int i = 0; i < settings->n_regions; i++) materials[i] = settings->region[i].material;
  fem_body body = {mesh, materials, element, {settings->axis, settings->speed}, settings->pressure};
  fem_rules  rules  = settings->full_integration ? FEM_FULL : FEM_STANDARD;
  shb_status status = fem_petsc_status(fem_element_create(mesh->kind, rules, element));
  if (status == SHB_OK) status = solve(comm, &body, settings, to, progress, result);
  free(element);
  return status;
}

shb_status modal_solve(MPI_Comm comm, const mesh_fe *mesh, const modal_settings *settings,
                       shb_progress *progress, modal_result *result) {
  modal_condensation to = {0};
  memset(result, 0, sizeof *result);
  shb_status status = agree(comm, prepare(mesh, settings, &result->interface, &to));
  if (status == SHB_OK) status = solve_body(comm, mesh, settings, &to, progress, result);
  modal_dofs_free(&to.contact);
  modal_dofs_free(&to.probe);
  modal_load_free(&to.load);
  return status;
}

void modal_result_free(modal_result *result) {
  modal_model_free(&result->model);
  modal_interface_free(&result->interface);
  modal_deflection_free(&result->deflection);
  modal_participation_free(&result->participation);
  (void)modal_eigen_destroy(&result->eigen);
  (void)fem_system_destroy(&result->system);
  memset(result, 0, sizeof *result);
}

/* All mode shapes on rank 0, [m][n_nodes][3]; NULL elsewhere. Free with free. */
static shb_status gather_shapes(const modal_result *result, int rank, double **shape) {
  const size_t stride = 3 * (size_t)result->system.n_nodes;
  *shape = rank == 0 ? malloc((size_t)result->eigen.n * stride * sizeof **shape) : NULL;
  SHB_TRY(agree(result->system.comm,
                rank == 0 && !*shape
                    ? shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory for the mode shapes")
                    : SHB_OK));
  for (int i = 0; i < result->eigen.n; i++) {
    Vec phi;
    FEM_PETSC(MatDenseGetColumnVecRead(result->eigen.phi, i, &phi));
    FEM_PETSC(
        fem_system_gather(&result->system, phi, rank == 0 ? *shape + (size_t)i * stride : NULL));
    FEM_PETSC(MatDenseRestoreColumnVecRead(result->eigen.phi, i, &phi));
  }
  return SHB_OK;
}

/* speeds: n = 0 with one speed. */
static shb_status write_all(hid_t file, const mesh_fe *mesh, const modal_result *result,
                            const modal_speeds *speeds, const double *shape,
                            const shb_provenance *provenance) {
  SHB_TRY(modal_model_write(file, &result->model, provenance));
  if (speeds->n > 0) SHB_TRY(modal_speeds_write(file, speeds));
  SHB_TRY(modal_export_mesh(file, mesh));
  SHB_TRY(modal_export_shapes(file, result->model.n_modes, mesh->n_nodes, shape));
  SHB_TRY(modal_export_check(file, &result->eigen.check));
  SHB_TRY(modal_participation_write(file, &result->participation));
  SHB_TRY(modal_export_contact(file, &result->interface));
  SHB_TRY(modal_export_receptance(file, &result->model));
  SHB_TRY(modal_deflection_write(file, &result->deflection, mesh->n_nodes, mesh->n_elements,
                                 &result->model));
  return modal_export_vtk(file, mesh, result->model.n_modes);
}

/* progress: its phases go into the file. */
static shb_status publish(const char *path, const mesh_fe *mesh, const modal_result *result,
                          const modal_speeds *speeds, const double *shape,
                          const shb_provenance *provenance, const shb_progress *progress) {
  char *temporary = shb_publish_temporary(path);
  SHB_CHECK(temporary, SHB_ERR_IO, "out of memory");
  hid_t      file   = -1;
  shb_status status = h5_create(temporary, &file);
  if (status == SHB_OK) {
    int ranks;
    MPI_Comm_size(result->system.comm, &ranks);
    status = write_all(file, mesh, result, speeds, shape, provenance);
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

static shb_status read_mesh(const char *path, const modal_settings *settings, mesh_fe *mesh) {
  mesh_names names = {.n_more = settings->n_groups, .n_volumes = settings->n_regions};
  for (int i = 0; i < settings->n_groups; i++)
    names.more[i].label = names.more[i].name = settings->group[i];
  for (int i = 0; i < settings->n_regions; i++)
    names.volume[i].label = names.volume[i].name = settings->region[i].name;
  SHB_TRY(mesh_fe_read(path, &names, mesh));
  SHB_TRY(mesh_fe_check_groups(mesh, path));
  for (int i = 0; i < settings->n_contacts && !settings->to_ground; i++) {
    int right = mesh_fe_set_named(mesh, settings->contact[i].right);
    int left  = mesh_fe_set_named(mesh, settings->contact[i].left);
    if (right < 0 || left < 0 || !mesh->set[right].n || !mesh->set[left].n) continue;
    SHB_TRY(mesh_fe_orient_groups(mesh, settings->axis, right, left));
  }
  if (settings->n_contacts || mesh->set[MESH_CONTACT_RIGHT].n == 0 ||
      mesh->set[MESH_CONTACT_LEFT].n == 0)
    return SHB_OK;
  return mesh_fe_orient(mesh, settings->axis);
}

static shb_status run(MPI_Comm comm, int rank, const char *out_path, const mesh_fe *mesh,
                      const modal_settings *settings, const shb_provenance *provenance,
                      shb_progress *progress) {
  modal_result result;
  modal_speeds speeds = {0};
  double      *shape  = NULL;
  shb_status   status = settings->n_speeds > 1
                            ? modal_campbell_solve(comm, mesh, settings, progress, &speeds, &result)
                            : modal_solve(comm, mesh, settings, progress, &result);
  if (status == SHB_OK) status = gather_shapes(&result, rank, &shape);
  if (status == SHB_OK) {
    shb_progress_show(progress, 96, "writing %s", out_path);
    shb_status mine =
        rank != 0 ? SHB_OK : publish(out_path, mesh, &result, &speeds, shape, provenance, progress);
    status = agree(comm, mine);
    if (status == SHB_OK) modal_phase(comm, progress, "write", "%s", out_path);
  }
  free(shape);
  modal_campbell_free(&speeds, &result);
  modal_result_free(&result);
  return status;
}

shb_status modal_stage(MPI_Comm comm, const char *mesh_path, const char *out_path,
                       const modal_settings *settings, const shb_provenance *provenance,
                       shb_progress *progress) {
  int     rank;
  mesh_fe mesh = {0};
  MPI_Comm_rank(comm, &rank);
  shb_progress_show(progress, 0, "reading %s", mesh_path);
  shb_status status = agree(comm, rank == 0 ? read_mesh(mesh_path, settings, &mesh) : SHB_OK);
  if (status == SHB_OK) status = fem_petsc_status(fem_mesh_broadcast(comm, &mesh));
  if (status == SHB_OK)
    modal_phase(comm, progress, "mesh", "%d nodes, %d elements", mesh.n_nodes, mesh.n_elements);
  if (status == SHB_OK) status = run(comm, rank, out_path, &mesh, settings, provenance, progress);
  mesh_fe_free(&mesh);
  shb_progress_clear(progress);
  return status;
}
