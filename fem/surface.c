#include "fem/surface.h"

#include <math.h>
#include <string.h>

#include "fem/fault.h"

void fem_tri6_integrate(const fem_tri_rule *rule, const double x[6][3], double area[6],
                        double normal[6][3]) {
  memset(area, 0, 6 * sizeof(double));
  memset(normal, 0, 18 * sizeof(double));
  for (int p = 0; p < rule->n; p++) {
    double r[3] = {0}, s[3] = {0};
    for (int i = 0; i < 6; i++)
      for (int d = 0; d < 3; d++) {
        r[d] += rule->gradient[p][i][0] * x[i][d];
        s[d] += rule->gradient[p][i][1] * x[i][d];
      }
    double n[3] = {r[1] * s[2] - r[2] * s[1], r[2] * s[0] - r[0] * s[2], r[0] * s[1] - r[1] * s[0]};
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 6; i++) {
      double weight = rule->weight[p] * rule->shape[p][i];
      area[i] += weight * length;
      for (int d = 0; d < 3; d++) normal[i][d] += weight * n[d];
    }
  }
}

void fem_face_coordinates(const mesh_fe *mesh, const mesh_face_set *set, int face, double x[6][3]) {
  for (int i = 0; i < 6; i++)
    memcpy(x[i], mesh->coordinates + 3 * (size_t)set->nodes[6 * face + i], sizeof x[i]);
}

static void surface_force(const mesh_fe *mesh, const fem_load *load, const fem_tri_rule *rule,
                          double *force) {
  const mesh_face_set *set = &mesh->set[MESH_LOAD];
  for (int f = 0; f < set->n; f++) {
    double x[6][3], area[6], normal[6][3];
    fem_face_coordinates(mesh, set, f, x);
    fem_tri6_integrate(rule, x, area, normal);
    for (int i = 0; i < 6; i++)
      for (int d = 0; d < 3; d++)
        force[3 * (size_t)set->nodes[6 * f + i] + d] += load->kind == FEM_LOAD_PRESSURE
                                                            ? -load->pressure * normal[i][d]
                                                            : load->traction[d] * area[i];
  }
}

shb_status fem_load_pattern(const mesh_fe *mesh, const fem_load *load, const double *fallback,
                            double *force) {
  memset(force, 0, 3 * (size_t)mesh->n_nodes * sizeof(double));
  if (load->kind == FEM_LOAD_FORCE) {
    const double *at = load->has_at ? load->at : fallback;
    SHB_CHECK(at, SHB_ERR_INPUT,
              "excitation.force: no place for the force; give force.at or a probe");
    int node = mesh_fe_nearest(mesh, at);
    for (int d = 0; d < 3; d++) force[3 * (size_t)node + d] = load->force[d];
    return SHB_OK;
  }
  SHB_CHECK(mesh->set[MESH_LOAD].n > 0, SHB_ERR_INPUT,
            "the mesh has no group \"%s\" for excitation.%s; name the loaded faces so, or give "
            "excitation.force",
            mesh_set_name(MESH_LOAD), load->kind == FEM_LOAD_PRESSURE ? "pressure" : "traction");
  fem_tri_rule rule;
  FEM_PETSC(fem_tri_rule_conical(4, &rule));
  surface_force(mesh, load, &rule, force);
  return SHB_OK;
}
