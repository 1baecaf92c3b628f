#include "modal/cyclic/wave_fields.h"

#include <stdlib.h>
#include <string.h>

#include "fem/body/stress.h"
#include "mesh/base/memory.h"
#include "modal/cyclic/wave_condense.h"

enum { BATCH = 16 };

static void add_modes(const wave_operator *op, const wave_modes *modes, const fem_body *body,
                      const double *state, wave_fields *f) {
  const size_t nodes = (size_t)body->mesh->n_nodes, m = (size_t)modes->n;
  f->n_modes = modes->n;
  f->shape   = shb_alloc(m * 3 * nodes, sizeof *f->shape);
  f->stress  = shb_alloc(m * FEM_STRESSES * nodes, sizeof *f->stress);
  for (size_t i = 0; i < m; i++)
    fem_sector_expand(op->sector, op->phase, modes->phi + i * modes->order,
                      f->shape + i * 3 * nodes);
  fem_nodal_stress_wave(body, state, op->phase, modes->n, f->shape, f->stress);
}

/* Vectors of one batch of residual columns. */
typedef struct {
  double complex *x;     /* [BATCH][order] */
  double complex *nodal; /* [BATCH][n_nodes][3] */
  double complex *C;     /* [BATCH][modes] */
} scratch;

static void add_batch(wave_operator *op, const wave_modes *modes, const modal_dofs *dofs,
                      const fem_body *body, const double *state, int first, const scratch *own,
                      wave_fields *f) {
  const size_t size = 3 * (size_t)body->mesh->n_nodes, at = (size_t)first * size;
  const int    count = dofs->n - first < BATCH ? dofs->n - first : BATCH;
  wave_spread(op, dofs, first, count, count, own->x);
  wave_operator_solve(op, count, own->x, own->x);
  wave_modes_project_out(modes, count, own->x, own->C);
  for (size_t c = 0; c < (size_t)count; c++)
    fem_sector_expand(op->sector, op->phase, own->x + c * op->order, own->nodal + c * size);
  for (size_t i = 0; i < (size_t)count * size; i++)
    f->residual[at + i] = (float complex)own->nodal[i];
  fem_nodal_stress_wave(body, state, op->phase, count, own->nodal, f->residual_stress + 2 * at);
}

static void add_columns(wave_operator *op, const wave_modes *modes, const modal_dofs *dofs,
                        const fem_body *body, const double *state, wave_fields *f) {
  const size_t nodes = (size_t)body->mesh->n_nodes, n = (size_t)dofs->n;
  scratch      own   = {.x     = shb_alloc(BATCH * op->order, sizeof *own.x),
                        .nodal = shb_alloc(BATCH * 3 * nodes, sizeof *own.nodal),
                        .C     = shb_alloc(BATCH * (size_t)modes->n, sizeof *own.C)};
  f->n_columns       = dofs->n;
  f->residual        = shb_alloc(n * 3 * nodes, sizeof *f->residual);
  f->residual_stress = shb_alloc(n * FEM_STRESSES * nodes, sizeof *f->residual_stress);
  for (int first = 0; first < dofs->n; first += BATCH)
    add_batch(op, modes, dofs, body, state, first, &own, f);
  free(own.x);
  free(own.nodal);
  free(own.C);
}

void wave_fields_create(wave_operator *op, const wave_modes *modes, const modal_condensation *to,
                        const fem_body *body, const double *state, bool columns, wave_fields *f) {
  modal_dofs dofs = {0};
  memset(f, 0, sizeof *f);
  add_modes(op, modes, body, state, f);
  if (!columns) return;
  modal_dofs_append(&dofs, &to->contact);
  modal_dofs_append(&dofs, &to->load.dofs);
  add_columns(op, modes, &dofs, body, state, f);
  modal_dofs_free(&dofs);
}

void wave_fields_free(wave_fields *f) {
  free(f->shape);
  free(f->stress);
  free(f->residual);
  free(f->residual_stress);
  memset(f, 0, sizeof *f);
}
