#include "modal/stage/solve.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fem/body/clamp_check.h"
#include "fem/body/energy.h"
#include "fem/element/hourglass.h"
#include "fem/solver/petsc_error.h"
#include "mesh/base/memory.h"
#include "modal/common/phases.h"
#include "modal/common/session.h"
#include "modal/condense/condense.h"
#include "modal/eigen/coriolis.h"
#include "modal/model/mode_selection.h"
#include "modal/model/reduce.h"

enum { FIRST_MODES = 20, MOST_MODES = 1000 }; /* with modal.modes: auto */

/* Three dofs for each probe: its nearest node in that node's cylindrical axes. */
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
    for (int a = 0; a < 3; a++) modal_dofs_add(dofs, 1, &node, &one, axes[a]);
  }
  return SHB_OK;
}

static void name_probes(const modal_settings *settings, modal_model *model) {
  model->probe_name = shb_alloc_zeroed((size_t)settings->n_probes + 1, sizeof *model->probe_name);
  for (int q = 0; q < settings->n_probes; q++)
    model->probe_name[q] = shb_text(settings->probe[q].name);
}

static void copy_patches(const modal_patches *patches, modal_model *model) {
  const size_t n = (size_t)patches->n_pairs;
  if (n == 0) return;
  model->normal = shb_alloc(3 * n, sizeof(double));
  model->area   = shb_alloc(n, sizeof(double));
  memcpy(model->normal, patches->normal, 3 * n * sizeof(double));
  memcpy(model->area, patches->area, n * sizeof(double));
}

/* Create an interface from its groups; error texts start with its name. */
static shb_status create_contact(const mesh_fe *mesh, const modal_settings *settings,
                                 const modal_contact *contact, modal_patches *out) {
  int        right = mesh_fe_set_named(mesh, contact->right);
  int        left  = contact->to_ground ? -1 : mesh_fe_set_named(mesh, contact->left);
  const bool exist = right >= 0 && (left >= 0 || contact->to_ground);
  char       found[MESH_FOUND + 40];
  SHB_CHECK(exist, SHB_ERR_INPUT, "contact interface %s: the mesh has no group \"%s\"; %s",
            contact->name, right < 0 ? contact->right : contact->left, mesh_fe_found(mesh, found));
  mesh_fe    view   = mesh_fe_facing(mesh, right, left);
  shb_status status = modal_patches_create(&view, settings->axis, settings->blades,
                                           contact->to_ground, contact->points, out);
  if (status == SHB_OK) status = modal_patches_check_angles(out, contact->psi, contact->phi);
  if (status == SHB_OK) return SHB_OK;
  modal_patches_free(out);
  if (!contact->name[0]) return status;
  return shb_fail(status, __FILE__, __LINE__, "contact interface %s: %s", contact->name,
                  shb_message());
}

/* Is a body meant that touches nothing? Contact to the neighbour needs the number of blades. */
static bool is_free(const mesh_fe *mesh, const modal_settings *settings) {
  return settings->may_be_free && (mesh->set[MESH_CONTACT_RIGHT].n == 0 ||
                                   mesh->set[MESH_CONTACT_LEFT].n == 0 || settings->blades < 2);
}

static shb_status create_interfaces(const mesh_fe *mesh, const modal_settings *settings,
                                    modal_patches *out) {
  const int     n                          = settings->n_contacts;
  modal_patches part[MODAL_MAX_INTERFACES] = {{0}};
  shb_status    status                     = SHB_OK;
  if (is_free(mesh, settings)) return SHB_OK;
  for (int i = 0; i < n && status == SHB_OK; i++)
    status = create_contact(mesh, settings, &settings->contact[i], &part[i]);
  if (status == SHB_OK) modal_patches_join(n, part, out);
  for (int i = 0; i < n; i++) modal_patches_free(&part[i]);
  return status;
}

/* Copy the interface of each pair; a single interface has no name. */
static void name_interfaces(const modal_settings *settings, const modal_patches *patches,
                            modal_model *model) {
  const int n = settings->n_contacts;
  if (n < 2 || patches->n_pairs == 0) return;
  model->interface      = shb_alloc((size_t)patches->n_pairs, sizeof *model->interface);
  model->interface_name = shb_alloc_zeroed((size_t)n, sizeof *model->interface_name);
  memcpy(model->interface, patches->interface, (size_t)patches->n_pairs * sizeof *model->interface);
  model->n_interfaces = n;
  for (int i = 0; i < n; i++) model->interface_name[i] = shb_text(settings->contact[i].name);
}

/* Check the input before any lengthy computation, and create patches, probes and load patterns. */
static shb_status prepare(const mesh_fe *mesh, const modal_settings *settings,
                          shb_progress *progress, modal_patches *patches, modal_condensation *to) {
  char found[MESH_FOUND + 40];
  int  bodies;
  SHB_TRY(fem_clamp_check(mesh, &bodies));
  if (bodies > 1)
    shb_progress_warn(progress,
                      "the mesh has %d bodies that share no nodes; the modes are those of all of "
                      "them, and one blade is expected",
                      bodies);
  if (!settings->full_integration) SHB_TRY(fem_hourglass_check(mesh));
  SHB_CHECK(settings->pressure == 0 || mesh->set[MESH_LOAD].n > 0, SHB_ERR_INPUT,
            "the mesh has no group \"%s\" for rotor.pressure; name the loaded faces so; %s",
            mesh_set_name(MESH_LOAD), mesh_fe_found(mesh, found));
  SHB_TRY(create_interfaces(mesh, settings, patches));
  to->n_pairs  = patches->n_pairs;
  to->has_left = patches->has_left;
  to->damping  = settings->damping;
  modal_patches_dofs(patches, &to->contact);
  SHB_TRY(probe_dofs(mesh, settings, &to->probe));
  const double *fallback = settings->n_probes > 0 ? settings->probe[0].at : NULL;
  return modal_load_create(mesh, settings->n_loads, settings->loads, fallback, &to->load);
}

/* Recompute the eigenvalues as Rayleigh quotients from the strains, on rank 0. The solver's
 * eigenvalues contain rounding errors of K: up to 1e-9 in a slender body, varying with the number
 * of ranks. The quotients are accurate to about 1e-12. */
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
  for (int i = 1; i < eigen->n; i++) /* repeated eigenvalues stay in order */
    eigen->lambda[i] = PetscMax(eigen->lambda[i], eigen->lambda[i - 1]);
  PetscCallMPI(MPI_Bcast(eigen->lambda, eigen->n, MPI_DOUBLE, 0, system->comm));
  PetscCall(PetscFree(u));
  PetscFunctionReturn(0);
}

/* The analysis of K, made beside its numbers. */
typedef struct {
  int         modes;
  fem_factor *factor;
} analysis;

static PetscErrorCode analyse(const fem_system *system, void *context) {
  analysis *own = context;
  PetscFunctionBeginUser;
  PetscCall(modal_eigen_analyse(system, own->modes, &own->factor));
  PetscFunctionReturn(0);
}

static bool is_at_rest(const fem_body *body) {
  return body->rotation.speed == 0 && body->pressure == 0;
}

/* Assemble the matrices of the body, at its equilibrium if it rotates. Only a body at rest has the
 * factor analysed beside. */
static shb_status assemble(MPI_Comm comm, const fem_body *body, const modal_condensation *to,
                           shb_progress *progress, analysis *own, modal_result *result) {
  const bool       at_rest = is_at_rest(body);
  const fem_beside beside  = {analyse, own};
  shb_progress_show(progress, 5, "assembling %d elements", body->mesh->n_elements);
  FEM_PETSC(fem_system_create_beside(comm, body->mesh, body->material, body->element->rules,
                                     at_rest ? &beside : NULL, &result->system));
  modal_phase(comm, progress, "assembly", "%d elements, %d dofs", body->mesh->n_elements,
              (int)(3 * result->system.n_free));
  if (at_rest) return SHB_OK;
  return modal_deflection_solve(body, &result->system, to, &result->patches, progress,
                                &result->deflection);
}

/* Compute that many modes and condense. */
static shb_status find_modes(const fem_body *body, const modal_settings *settings,
                             const modal_condensation *to, fem_factor **factor, int modes,
                             shb_progress *progress, modal_result *result) {
  const modal_spare_stiffness spare = {&result->system,
                                       {body->mesh, body->material, body->element->rules}};
  modal_eigen_settings        eigen = {
             .modes = modes, .progress = progress, .check = settings->check, .factor = factor};
  if (settings->spares_stiffness && settings->modes > 0 && is_at_rest(body) && !body->mesh->image)
    eigen.spare = &spare;
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

/* Double the number of modes until the tolerance is met; then keep the fewest that meet it. */
static shb_status find_enough(const fem_body *body, const modal_settings *settings,
                              const modal_condensation *to, fem_factor **factor,
                              shb_progress *progress, modal_result *result) {
  const int most  = (int)PetscMin(MOST_MODES, 3 * result->system.n_free);
  int       modes = PetscMin(FIRST_MODES, most), enough = 0;
  double    error = 0;
  for (;; modes = PetscMin(2 * modes, most)) {
    SHB_TRY(find_modes(body, settings, to, factor, modes, progress, result));
    SHB_TRY(
        modal_select_modes(&result->model, settings->band, settings->tolerance, &enough, &error));
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
  return modal_model_reduce(&result->model, enough, true);
}

/* The Coriolis matrix of the modes, where it is asked for. */
static shb_status add_coriolis(const fem_body *body, const modal_settings *settings,
                               modal_result *result) {
  const size_t m = (size_t)result->eigen.n;
  if (settings->coriolis == FEM_TURNS_UNSAID) return SHB_OK;
  result->coriolis       = settings->coriolis;
  result->model.coriolis = shb_alloc_zeroed(m * m, sizeof *result->model.coriolis);
  FEM_PETSC(
      modal_coriolis(&result->eigen, &body->rotation, settings->coriolis, result->model.coriolis));
  return SHB_OK;
}

/* The matrices, and the modes that they have. */
static shb_status assemble_and_find(MPI_Comm comm, const fem_body *body,
                                    const modal_settings *settings, const modal_condensation *to,
                                    shb_progress *progress, modal_result *result) {
  const int  modes  = settings->modes > 0 ? settings->modes : FIRST_MODES;
  analysis   own    = {.modes = modes};
  shb_status status = assemble(comm, body, to, progress, &own, result);
  if (status == SHB_OK && settings->modes > 0)
    status = find_modes(body, settings, to, &own.factor, modes, progress, result);
  else if (status == SHB_OK)
    status = find_enough(body, settings, to, &own.factor, progress, result);
  (void)fem_factor_destroy(&own.factor);
  return status;
}

static shb_status solve(MPI_Comm comm, const fem_body *body, const modal_settings *settings,
                        const modal_condensation *to, shb_progress *progress,
                        modal_result *result) {
  SHB_CHECK(settings->modes > 0 || to->n_pairs > 0, SHB_ERR_INPUT,
            "modal.modes: auto goes by the receptance at the contact, and there is no contact; "
            "give a number");
  SHB_TRY(assemble_and_find(comm, body, settings, to, progress, result));
  SHB_TRY(add_coriolis(body, settings, result));
  SHB_TRY(modal_participation_create(body, result->deflection.at.displacement, &result->system,
                                     &result->eigen, &result->participation));
  modal_phase(comm, progress, "participation", "effective masses");
  SHB_TRY(modal_residual_shapes_create(&result->system, &result->eigen, to, &result->residual));
  modal_phase(comm, progress, "residual shapes", "%d columns", result->residual.n);
  modal_label(settings, &result->patches, &result->model);
  return SHB_OK;
}

void modal_label(const modal_settings *settings, const modal_patches *patches, modal_model *model) {
  name_probes(settings, model);
  name_interfaces(settings, patches, model);
  copy_patches(patches, model);
}

shb_status modal_body_create(const mesh_fe *mesh, const modal_settings *settings,
                             modal_body **out) {
  modal_body *b = shb_alloc_zeroed(1, sizeof *b);
  *out          = b;
  for (int i = 0; i < settings->n_regions; i++) b->material[i] = settings->region[i].material;
  b->body = (fem_body){
      mesh, b->material, &b->element, {settings->axis, settings->speed}, settings->pressure};
  FEM_PETSC(fem_element_create(mesh->kind, settings->full_integration ? FEM_FULL : FEM_STANDARD,
                               &b->element));
  return SHB_OK;
}

static shb_status solve_body(MPI_Comm comm, const mesh_fe *mesh, const modal_settings *settings,
                             const modal_condensation *to, shb_progress *progress,
                             modal_result *result) {
  modal_body *body;
  shb_status  status = modal_agree(comm, modal_body_create(mesh, settings, &body));
  if (status == SHB_OK) status = solve(comm, &body->body, settings, to, progress, result);
  free(body);
  return status;
}

shb_status modal_solve(MPI_Comm comm, const mesh_fe *mesh, const modal_settings *settings,
                       shb_progress *progress, modal_result *result) {
  memset(result, 0, sizeof *result);
  SHB_TRY(modal_agree(comm, prepare(mesh, settings, progress, &result->patches, &result->to)));
  return solve_body(comm, mesh, settings, &result->to, progress, result);
}

void modal_result_free(modal_result *result) {
  modal_model_free(&result->model);
  modal_patches_free(&result->patches);
  modal_deflection_free(&result->deflection);
  modal_participation_free(&result->participation);
  modal_residual_shapes_free(&result->residual);
  modal_dofs_free(&result->to.contact);
  modal_dofs_free(&result->to.probe);
  modal_load_free(&result->to.load);
  (void)modal_eigen_destroy(&result->eigen);
  (void)fem_system_destroy(&result->system);
  memset(result, 0, sizeof *result);
}
