#include "modal/condense/static_results.h"

#include <stdlib.h>
#include <string.h>

#include "fem/element/finite_strain.h"
#include "fem/solver/petsc_error.h"
#include "mesh/base/memory.h"

/* Nodes of group root, each once. */
static void find_clamped(const mesh_fe *mesh, bool *is_clamped) {
  const mesh_face_set *root = &mesh->set[MESH_ROOT];
  for (int i = 0; i < mesh_topology_of(mesh->kind)->face_nodes * root->n; i++)
    is_clamped[root->nodes[i]] = true;
}

static void add_reaction(const double x[3], const double f[3], modal_static_results *out) {
  memcpy(out->reaction[out->n_clamped++], f, 3 * sizeof *f);
  for (int d = 0; d < 3; d++) {
    int b = (d + 1) % 3, c = (d + 2) % 3;
    out->force[d] += f[d];
    out->moment[d] += x[b] * f[c] - x[c] * f[b];
  }
}

static shb_status fill(const fem_body *body, const double *u, bool *is_clamped,
                       double (*balance)[3], modal_static_results *out) {
  const mesh_fe *mesh = body->mesh;
  fem_nodal_stress(body, u, out->stress);
  for (int i = 0; i < mesh->n_nodes; i++) out->von_mises[i] = fem_von_mises(out->stress[i]);
  FEM_PETSC(fem_unbalanced_forces(body, u, balance, out->load));
  find_clamped(mesh, is_clamped);
  for (int i = 0; i < mesh->n_nodes; i++) { /* clamped nodes do not move */
    if (!is_clamped[i]) continue;
    out->clamped[out->n_clamped] = i;
    add_reaction(mesh->coordinates + 3 * (size_t)i, balance[i], out);
  }
  return SHB_OK;
}

shb_status modal_static_results_create(const fem_body *body, const double *displacement,
                                       modal_static_results *out) {
  const size_t n          = (size_t)body->mesh->n_nodes;
  bool        *clamped    = shb_alloc_zeroed(n, sizeof *clamped);
  double(*balance)[3]     = shb_alloc(n, sizeof *balance);
  out->n_nodes            = body->mesh->n_nodes;
  out->stress             = shb_alloc(n, sizeof *out->stress);
  out->von_mises          = shb_alloc(n, sizeof *out->von_mises);
  out->clamped            = shb_alloc(n, sizeof *out->clamped);
  out->reaction           = shb_alloc(n, sizeof *out->reaction);
  const shb_status status = fill(body, displacement, clamped, balance, out);
  free(clamped);
  free(balance);
  return status;
}

static shb_status write_reactions(hid_t file, const modal_static_results *s) {
  const hsize_t n = (hsize_t)s->n_clamped;
  SHB_TRY(h5_write_int(file, "/static/reaction_node", H5_SHAPE(n), s->clamped, "-",
                       "clamped nodes, from 0"));
  SHB_TRY(h5_write_double(file, "/static/reaction", H5_SHAPE(n, 3), s->reaction[0], "N",
                          "force of the clamp on each of its nodes, mesh axes (x, y, z)"));
  SHB_TRY(h5_write_double(file, "/static/reaction_force", H5_SHAPE(3), s->force, "N",
                          "force of the clamp on the blade, mesh axes (x, y, z)"));
  SHB_TRY(h5_write_double(file, "/static/reaction_moment", H5_SHAPE(3), s->moment, "N m",
                          "moment of the clamp on the blade about the origin"));
  return h5_write_double(file, "/static/load_force", H5_SHAPE(3), s->load, "N",
                         "resultant of the static loads, mesh axes (x, y, z)");
}

shb_status modal_static_results_write(hid_t file, const modal_static_results *s) {
  if (!s->stress) return SHB_OK;
  SHB_TRY(h5_write_double(
      file, "/static/nodal_stress", H5_SHAPE((hsize_t)s->n_nodes, FEM_STRESSES), s->stress[0], "Pa",
      "static Cauchy stress at the nodes: xx, yy, zz, xy, yz, xz in mesh axes"));
  SHB_TRY(h5_write_double(file, "/static/nodal_von_mises", H5_SHAPE((hsize_t)s->n_nodes),
                          s->von_mises, "Pa", "von Mises stress of nodal_stress"));
  return write_reactions(file, s);
}

void modal_static_results_free(modal_static_results *s) {
  free(s->stress);
  free(s->von_mises);
  free(s->clamped);
  free(s->reaction);
  memset(s, 0, sizeof *s);
}
