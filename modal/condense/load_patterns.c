#include "modal/condense/load_patterns.h"

#include <stdlib.h>
#include <string.h>

#include "fem/element/surface.h"
#include "fem/solver/petsc_error.h"
#include "mesh/base/memory.h"
#include "modal/condense/load_field.h"

static double part(double complex value, int imaginary) {
  return imaginary ? cimag(value) : creal(value);
}

static void nodal_force(const mesh_fe *mesh, const modal_load_field *f, int harmonic, int imaginary,
                        double *force) {
  const double complex *value = f->value + 3 * (size_t)f->nodes * (size_t)harmonic;
  for (int i = 0; i < mesh->n_nodes; i++)
    for (int d = 0; d < 3 && f->at[i] >= 0; d++)
      force[3 * (size_t)i + d] = part(value[3 * f->at[i] + d], imaginary);
}

/* f_i = - integral of N_i (sum_j N_j p_j) n dA over a face. */
static void face_pressure(const fem_face_rule *rule, const double x[][3], const double *p,
                          double force[][3]) {
  memset(force, 0, (size_t)rule->nodes * sizeof *force);
  for (int q = 0; q < rule->n; q++) {
    double r[3] = {0}, s[3] = {0}, here = 0;
    for (int i = 0; i < rule->nodes; i++) {
      here += rule->shape[q][i] * p[i];
      for (int d = 0; d < 3; d++) {
        r[d] += rule->gradient[q][i][0] * x[i][d];
        s[d] += rule->gradient[q][i][1] * x[i][d];
      }
    }
    double n[3] = {r[1] * s[2] - r[2] * s[1], r[2] * s[0] - r[0] * s[2], r[0] * s[1] - r[1] * s[0]};
    for (int i = 0; i < rule->nodes; i++)
      for (int d = 0; d < 3; d++) force[i][d] -= rule->weight[q] * rule->shape[q][i] * here * n[d];
  }
}

static shb_status pressure_force(const mesh_fe *mesh, const modal_load_field *f, int harmonic,
                                 int imaginary, double *force) {
  const mesh_face_set  *set   = &mesh->set[MESH_LOAD];
  const double complex *value = f->value + (size_t)f->nodes * (size_t)harmonic;
  fem_face_rule         rule;
  char                  found[MESH_FOUND + 40];
  SHB_CHECK(set->n > 0, SHB_ERR_INPUT, "the mesh has no group \"load\" for the pressure of %s; %s",
            f->path, mesh_fe_found(mesh, found));
  FEM_PETSC(fem_face_rule_create(mesh->kind, &rule));
  for (int face = 0; face < set->n; face++) {
    const int *node = set->nodes + rule.nodes * (size_t)face;
    double     x[MESH_FACE_NODES][3], p[MESH_FACE_NODES], nodal[MESH_FACE_NODES][3];
    fem_face_coordinates(mesh, set, face, x);
    for (int i = 0; i < rule.nodes; i++) {
      SHB_CHECK(f->at[node[i]] >= 0, SHB_ERR_INPUT,
                "%s: node %ld of group load has no pressure (it is not in /node)", f->path,
                mesh->node_tag[node[i]]);
      p[i] = part(value[f->at[node[i]]], imaginary);
    }
    face_pressure(&rule, (const double(*)[3])x, p, nodal);
    for (int i = 0; i < rule.nodes; i++)
      for (int d = 0; d < 3; d++) force[3 * (size_t)node[i] + d] += nodal[i][d];
  }
  return SHB_OK;
}

static bool is_zero(int n, const double *force) {
  for (int i = 0; i < n; i++)
    if (force[i] != 0) return false;
  return true;
}

/* Add a pattern for every part that is not zero; kind[c]: its harmonic, and 1 if imaginary. */
static shb_status add_patterns(const mesh_fe *mesh, const modal_load_field *f, double *force,
                               int (*kind)[2], modal_load *out) {
  const size_t size = 3 * (size_t)mesh->n_nodes;
  for (int i = 0; i < f->harmonics; i++)
    for (int imaginary = 0; imaginary < 2; imaginary++) {
      memset(force, 0, size * sizeof *force);
      if (f->is_force)
        nodal_force(mesh, f, i, imaginary, force);
      else
        SHB_TRY(pressure_force(mesh, f, i, imaginary, force));
      if (is_zero(3 * mesh->n_nodes, force)) continue;
      kind[out->dofs.n][0] = f->harmonic[i];
      kind[out->dofs.n][1] = imaginary;
      if (f->harmonic[i] > out->n_harmonics) out->n_harmonics = f->harmonic[i];
      modal_dofs_add_forces(&out->dofs, mesh->n_nodes, force);
    }
  SHB_CHECK(out->dofs.n > 0, SHB_ERR_INPUT, "%s: all loads are 0; nothing would move", f->path);
  return SHB_OK;
}

static shb_status from_field(const mesh_fe *mesh, const modal_load_field *f, double *force,
                             modal_load *out) {
  int kind[2 * (FEM_MAX_LOAD_HARMONICS + 1)][2];
  SHB_TRY(add_patterns(mesh, f, force, kind, out));
  out->weight =
      shb_alloc_zeroed((size_t)(out->n_harmonics + 1) * (size_t)out->dofs.n, sizeof *out->weight);
  for (int c = 0; c < out->dofs.n; c++)
    out->weight[kind[c][0] * out->dofs.n + c] = kind[c][1] ? I : 1;
  return SHB_OK;
}

static shb_status from_case(const mesh_fe *mesh, const fem_load *load, const double *fallback,
                            double *force, modal_load *out) {
  SHB_TRY(fem_load_pattern(mesh, load, fallback, force));
  modal_dofs_add_forces(&out->dofs, mesh->n_nodes, force);
  out->n_harmonics = load->n_harmonics;
  out->weight      = shb_alloc_zeroed((size_t)load->n_harmonics + 1, sizeof *out->weight);
  memcpy(out->weight, load->factor, ((size_t)load->n_harmonics + 1) * sizeof *out->weight);
  return SHB_OK;
}

/* View of the mesh in which the load's own group is the group load. */
static shb_status view_of(const mesh_fe *mesh, const fem_load *load, mesh_fe *view) {
  char found[MESH_FOUND + 40];
  *view = *mesh;
  if (!load->group) return SHB_OK;
  int set = mesh_fe_set_named(mesh, load->group);
  SHB_CHECK(set >= 0 && mesh->set[set].n > 0, SHB_ERR_INPUT,
            "the mesh has no group \"%s\", which excitation.loads names; %s", load->group,
            mesh_fe_found(mesh, found));
  view->set[MESH_LOAD] = mesh->set[set];
  return SHB_OK;
}

static shb_status create_one(const mesh_fe *mesh, const fem_load *load, const double *fallback,
                             double *force, modal_load *out) {
  modal_load_field f = {.path = load->field};
  mesh_fe          view;
  SHB_TRY(view_of(mesh, load, &view));
  if (load->kind != FEM_LOAD_FIELD) return from_case(&view, load, fallback, force, out);
  shb_status status = modal_load_field_read(&view, &f);
  if (status == SHB_OK) status = from_field(&view, &f, force, out);
  modal_load_field_free(&f);
  return status;
}

/* Append the patterns of one load to out. */
static void append(modal_load *out, const modal_load *one) {
  const int       top = one->n_harmonics > out->n_harmonics ? one->n_harmonics : out->n_harmonics;
  const int       n = out->dofs.n, both = n + one->dofs.n;
  double complex *weight = shb_alloc_zeroed((size_t)(top + 1) * (size_t)both, sizeof *weight);
  for (int k = 0; k <= out->n_harmonics && n > 0; k++)
    memcpy(weight + k * both, out->weight + k * n, (size_t)n * sizeof *weight);
  for (int k = 0; k <= one->n_harmonics; k++)
    memcpy(weight + k * both + n, one->weight + k * one->dofs.n,
           (size_t)one->dofs.n * sizeof *weight);
  free(out->weight);
  out->weight      = weight;
  out->n_harmonics = top;
  modal_dofs_append(&out->dofs, &one->dofs);
}

shb_status modal_load_create(const mesh_fe *mesh, int n, const fem_load *loads,
                             const double *fallback, modal_load *out) {
  memset(out, 0, sizeof *out);
  if (n == 0) {
    out->n_harmonics = 1;
    return SHB_OK;
  }
  double    *force  = shb_alloc(3 * (size_t)mesh->n_nodes, sizeof *force);
  shb_status status = SHB_OK;
  for (int i = 0; i < n && status == SHB_OK; i++) {
    modal_load one = {0};
    status         = create_one(mesh, &loads[i], fallback, force, &one);
    if (status == SHB_OK) append(out, &one);
    modal_load_free(&one);
  }
  free(force);
  if (status != SHB_OK) modal_load_free(out);
  return status;
}

void modal_load_free(modal_load *load) {
  free(load->weight);
  modal_dofs_free(&load->dofs);
  memset(load, 0, sizeof *load);
}
