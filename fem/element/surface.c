#include "fem/element/surface.h"

#include <math.h>
#include <string.h>

#include "fem/solver/petsc_error.h"
#include "mesh/base/vec3.h"

void fem_face_integrate(const fem_face_rule *rule, const double x[][3], double *area,
                        double normal[][3]) {
  memset(area, 0, (size_t)rule->nodes * sizeof *area);
  memset(normal, 0, (size_t)rule->nodes * sizeof *normal);
  for (int p = 0; p < rule->n; p++) {
    double r[3] = {0}, s[3] = {0};
    for (int i = 0; i < rule->nodes; i++)
      for (int d = 0; d < 3; d++) {
        r[d] += rule->gradient[p][i][0] * x[i][d];
        s[d] += rule->gradient[p][i][1] * x[i][d];
      }
    double n[3];
    vec3_cross(r, s, n);
    const double length = vec3_norm(n);
    for (int i = 0; i < rule->nodes; i++) {
      double weight = rule->weight[p] * rule->shape[p][i];
      area[i] += weight * length;
      for (int d = 0; d < 3; d++) normal[i][d] += weight * n[d];
    }
  }
}

void fem_face_coordinates(const mesh_fe *mesh, const mesh_face_set *set, int face, double x[][3]) {
  const int width = mesh_topology_of(mesh->kind)->face_nodes;
  for (int i = 0; i < width; i++)
    memcpy(x[i], mesh->coordinates + 3 * (size_t)set->nodes[width * face + i], sizeof x[i]);
}

static void surface_force(const mesh_fe *mesh, const fem_load *load, const fem_face_rule *rule,
                          double *force) {
  const mesh_face_set *set = &mesh->set[MESH_LOAD];
  for (int f = 0; f < set->n; f++) {
    double x[MESH_FACE_NODES][3], area[MESH_FACE_NODES], normal[MESH_FACE_NODES][3];
    fem_face_coordinates(mesh, set, f, x);
    fem_face_integrate(rule, (const double(*)[3])x, area, normal);
    for (int i = 0; i < rule->nodes; i++)
      for (int d = 0; d < 3; d++)
        force[3 * (size_t)set->nodes[rule->nodes * f + i] + d] +=
            load->kind == FEM_LOAD_PRESSURE ? -load->pressure * normal[i][d]
                                            : load->traction[d] * area[i];
  }
}

shb_status fem_load_pattern(const mesh_fe *mesh, const fem_load *load, const double *fallback,
                            double *force) {
  char found[MESH_FOUND + 40];
  memset(force, 0, 3 * (size_t)mesh->n_nodes * sizeof(double));
  if (load->kind == FEM_LOAD_FORCE) {
    const double *at = load->has_at ? load->at : fallback;
    SHB_CHECK(at, SHB_ERR_INPUT,
              "excitation.force: no place for the force; give force.at or a probe");
    int node = 0;
    SHB_TRY(
        mesh_fe_near(mesh, at, load->has_at ? "excitation.force.at" : "the first probe", &node));
    for (int d = 0; d < 3; d++) force[3 * (size_t)node + d] = load->force[d];
    return SHB_OK;
  }
  SHB_CHECK(mesh->set[MESH_LOAD].n > 0, SHB_ERR_INPUT,
            "the mesh has no group \"%s\" for excitation.%s; name the loaded faces so, or give "
            "excitation.force; %s",
            mesh_set_name(MESH_LOAD), load->kind == FEM_LOAD_PRESSURE ? "pressure" : "traction",
            mesh_fe_found(mesh, found));
  fem_face_rule rule;
  FEM_PETSC(fem_face_rule_create(mesh->kind, &rule));
  surface_force(mesh, load, &rule, force);
  return SHB_OK;
}
