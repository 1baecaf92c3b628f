#include "modal/condense/static_deflection.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/body/tangent.h"
#include "fem/solver/petsc_error.h"
#include "mesh/base/memory.h"
#include "modal/common/phases.h"
#include "modal/common/session.h"

/* Strain limit: beyond it neither the St. Venant-Kirchhoff law nor any metal is elastic. */
static const double LARGEST_STRAIN = 0.1;

static void sample(const fem_body *body, const modal_condensation *to, const modal_patches *patches,
                   modal_deflection *out) {
  const double *u    = out->at.displacement;
  const size_t  side = 3 * (size_t)patches->n_pairs;
  modal_dofs_sample_nodal(&to->contact, u, out->contact);
  modal_dofs_sample_nodal(&to->probe, u, out->probe);
  for (size_t i = 0; i < side; i++) {
    double relative = out->contact[i] - (patches->has_left ? out->contact[side + i] : 0);
    out->closing[i / 3] += patches->normal[i] * relative;
  }
  for (int i = 0; i < body->mesh->n_nodes; i++) {
    const double *v = u + 3 * (size_t)i;
    out->greatest_displacement =
        fmax(out->greatest_displacement, sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
  }
}

static void allocate(const fem_body *body, const modal_condensation *to, int n_pairs, int rank,
                     modal_deflection *out) {
  out->contact = shb_alloc_zeroed((size_t)to->contact.n + 1, sizeof(double));
  out->probe   = shb_alloc_zeroed((size_t)to->probe.n + 1, sizeof(double));
  out->closing = shb_alloc_zeroed((size_t)n_pairs + 1, sizeof(double));
  if (rank == 0) out->stress = shb_alloc_zeroed((size_t)body->mesh->n_elements + 1, sizeof(double));
}

static void report(const modal_deflection *d, MPI_Comm comm, shb_progress *progress) {
  const fem_equilibrium *at = &d->at;
  modal_phase(comm, progress, "equilibrium",
              "%.6g rad/s, load steps %d, Newton iterations %d, factors %d, solves %d, last "
              "correction %.1e",
              d->speed, at->steps, at->iterations, at->factorisations, at->solves, at->correction);
  shb_progress_note(progress, "greatest displacement %.4g m, greatest von Mises stress %.4g MPa",
                    d->greatest_displacement, d->greatest_stress / 1e6);
  shb_progress_note(progress, "force of the clamp [%.6g, %.6g, %.6g] N", d->statics.force[0],
                    d->statics.force[1], d->statics.force[2]);
}

/* Stresses and reactions on rank 0; its status on every rank. */
static shb_status find_statics(const fem_body *body, MPI_Comm comm, int rank,
                               modal_deflection *out) {
  shb_status status = SHB_OK;
  if (rank == 0) {
    fem_body_stress(body, out->at.displacement, out->stress);
    status = modal_static_results_create(body, out->at.displacement, &out->statics);
  }
  return modal_agree(comm, status);
}

shb_status modal_deflection_solve(const fem_body *body, fem_system *system,
                                  const modal_condensation *to, const modal_patches *patches,
                                  shb_progress *progress, modal_deflection *out) {
  int rank;
  MPI_Comm_rank(system->comm, &rank);
  out->speed    = body->rotation.speed;
  out->pressure = body->pressure;
  allocate(body, to, patches->n_pairs, rank, out);
  FEM_PETSC(fem_equilibrium_solve(body, system, progress, &out->at));
  SHB_CHECK(out->at.displacement, SHB_INTERRUPTED, "interrupted");
  sample(body, to, patches, out);
  SHB_TRY(find_statics(body, system->comm, rank, out));
  double greatest[2] = {0, 0}; /* Pa, at the nodes as on the page; strain */
  for (int i = 0; rank == 0 && i < body->mesh->n_nodes; i++)
    greatest[0] = fmax(greatest[0], out->statics.von_mises[i]);
  for (int e = 0; rank == 0 && e < body->mesh->n_elements; e++)
    greatest[1] =
        fmax(greatest[1], out->stress[e] / fem_material_at(body->material, body->mesh, e)->E);
  MPI_Bcast(greatest, 2, MPI_DOUBLE, 0, system->comm);
  out->greatest_stress = greatest[0];
  SHB_CHECK(greatest[1] < LARGEST_STRAIN, SHB_ERR_INPUT,
            "rotor.%s: at %.6g rad/s the static stress reaches %.3g MPa, above a tenth of "
            "material.E: no elastic blade bears that; give a lower load, or check material and "
            "the mesh's unit (m)",
            out->speed == 0 ? "pressure" : "speed", out->speed, out->greatest_stress / 1e6);
  report(out, system->comm, progress);
  return SHB_OK;
}

static shb_status write_attributes(hid_t file, const modal_deflection *d) {
  SHB_TRY(h5_write_attribute_int(file, "/static", "load_steps", d->at.steps));
  SHB_TRY(h5_write_attribute_int(file, "/static", "newton_iterations", d->at.iterations));
  SHB_TRY(h5_write_attribute_int(file, "/static", "factorisations", d->at.factorisations));
  SHB_TRY(h5_write_attribute_int(file, "/static", "solves", d->at.solves));
  SHB_TRY(h5_write_attribute_double(file, "/static", "last_correction", d->at.correction));
  SHB_TRY(h5_write_attribute_double(file, "/static", "greatest_displacement",
                                    d->greatest_displacement));
  return h5_write_attribute_double(file, "/static", "greatest_stress", d->greatest_stress);
}

static shb_status write_samples(hid_t file, const modal_deflection *d, const modal_model *model) {
  const hsize_t pairs   = (hsize_t)model->n_pairs;
  const hsize_t contact = (hsize_t)modal_model_contact_dofs(model);
  const hsize_t probe   = 3 * (hsize_t)model->n_probes;
  const bool    root = h5_exists(file, "/modes"); /* a file of nodal diameters has no root model */
  if (pairs > 0) {
    SHB_TRY(h5_write_double(file, "/static/contact", H5_SHAPE(contact), d->contact, "m",
                            "static displacement of the contact patches, cylindrical axes"));
    if (root) SHB_TRY(h5_attach_scale(file, "/static/contact", 0, "/contact/dof"));
    SHB_TRY(
        h5_write_double(file, "/static/closing", H5_SHAPE(pairs), d->closing, "m",
                        "static motion of the right face against the left one along its normal, "
                        "faces free; kv times it is the interference load"));
    if (root) SHB_TRY(h5_attach_scale(file, "/static/closing", 0, "/contact/pair"));
  }
  if (probe == 0) return SHB_OK;
  SHB_TRY(h5_write_double(file, "/static/probe", H5_SHAPE(probe), d->probe, "m",
                          "static displacement of the probes, cylindrical axes"));
  return root ? h5_attach_scale(file, "/static/probe", 0, "/probe/dof") : SHB_OK;
}

shb_status modal_deflection_write(hid_t file, const modal_deflection *d, int n_nodes,
                                  int n_elements, const modal_model *model) {
  SHB_TRY(h5_write_attribute_double(file, "/", "rotor_speed", d->speed));
  SHB_TRY(h5_write_attribute_double(file, "/", "rotor_pressure", d->pressure));
  if (!d->at.displacement) return SHB_OK;
  SHB_TRY(h5_write_double(file, "/static/displacement", H5_SHAPE((hsize_t)n_nodes, 3),
                          d->at.displacement, "m",
                          "static displacement at every node, mesh axes (x, y, z)"));
  SHB_TRY(h5_write_double(file, "/static/stress", H5_SHAPE((hsize_t)n_elements), d->stress, "Pa",
                          "greatest von Mises stress of each element"));
  SHB_TRY(modal_static_results_write(file, &d->statics));
  SHB_TRY(write_samples(file, d, model));
  return write_attributes(file, d);
}

void modal_deflection_free(modal_deflection *d) {
  fem_equilibrium_free(&d->at);
  free(d->contact);
  free(d->probe);
  free(d->closing);
  free(d->stress);
  modal_static_results_free(&d->statics);
  memset(d, 0, sizeof *d);
}
