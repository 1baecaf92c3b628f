/* A field file as read: loads of several harmonics at nodes. load_patterns.h states its format. */
#ifndef MODAL_CONDENSE_LOAD_FIELD_H
#define MODAL_CONDENSE_LOAD_FIELD_H

#include <complex.h>
#include <stdbool.h>

#include "mesh/core/fe_mesh.h"

typedef struct {
  const char     *path;
  int             nodes, harmonics;
  int            *node;     /* [nodes] numbers in the mesh file */
  int            *harmonic; /* [harmonics] */
  bool            is_force;
  double complex *value; /* [harmonics][nodes][3] N, or [harmonics][nodes] Pa */
  int            *at;    /* [nodes of the mesh] index in node, -1: none */
} modal_load_field;

/* Read the file at field->path, check its harmonics and find its nodes in the mesh. The rest of
 * field is zero at first.
 * Errors: SHB_ERR_INPUT wrong numbers, no such nodes; SHB_ERR_IO unreadable. */
shb_status modal_load_field_read(const mesh_fe *mesh, modal_load_field *field);

/* The part of it behind the file: check harmonic and node, and set at.
 * Errors: as above. */
shb_status modal_load_field_check(const mesh_fe *mesh, modal_load_field *field);

void modal_load_field_free(modal_load_field *field);

#endif
