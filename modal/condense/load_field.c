#include "modal/condense/load_field.h"

#include <stdlib.h>

#include "fem/element/load.h"
#include "mesh/base/memory.h"
#include "modal/hdf5/h5.h"

static shb_status read_all(hid_t file, modal_load_field *f) {
  h5_shape nodes = {1, {0}}, harmonics = {1, {0}};
  SHB_TRY(h5_read_int(file, "/node", &nodes, &f->node));
  SHB_TRY(h5_read_int(file, "/harmonic", &harmonics, &f->harmonic));
  f->nodes     = (int)nodes.dim[0];
  f->harmonics = (int)harmonics.dim[0];
  f->is_force  = h5_exists(file, "/force");
  SHB_CHECK(f->is_force != h5_exists(file, "/pressure"), SHB_ERR_INPUT,
            "%s: expected one of /force and /pressure", f->path);
  h5_shape force    = {3, {harmonics.dim[0], nodes.dim[0], 3}},
           pressure = {2, {harmonics.dim[0], nodes.dim[0]}};
  return f->is_force ? h5_read_complex(file, "/force", &force, &f->value)
                     : h5_read_complex(file, "/pressure", &pressure, &f->value);
}

static shb_status check_harmonics(const modal_load_field *f) {
  bool given[FEM_MAX_LOAD_HARMONICS + 1] = {false};
  for (int i = 0; i < f->harmonics; i++) {
    int k = f->harmonic[i];
    SHB_CHECK(k >= 0 && k <= FEM_MAX_LOAD_HARMONICS && !given[k], SHB_ERR_INPUT,
              "%s: /harmonic: value %d (from 0) is %d; expected whole numbers 0 to %d, each once",
              f->path, i, k, FEM_MAX_LOAD_HARMONICS);
    given[k] = true;
  }
  return SHB_OK;
}

static int by_tag(const void *a, const void *b) {
  long p = *(const long *)a, q = *(const long *)b;
  return (p > q) - (p < q);
}

/* Find each node of the mesh in the file; node tags ascend. */
static shb_status locate(const mesh_fe *mesh, modal_load_field *f) {
  f->at = shb_alloc((size_t)mesh->n_nodes, sizeof *f->at);
  for (int i = 0; i < mesh->n_nodes; i++) f->at[i] = -1;
  for (int i = 0; i < f->nodes; i++) {
    long        tag   = f->node[i];
    const long *found = bsearch(&tag, mesh->node_tag, (size_t)mesh->n_nodes, sizeof tag, by_tag);
    SHB_CHECK(found, SHB_ERR_INPUT, "%s: /node: value %d (from 0): the mesh has no node %ld",
              f->path, i, tag);
    int *at = &f->at[found - mesh->node_tag];
    SHB_CHECK(*at < 0, SHB_ERR_INPUT, "%s: /node: node %ld is given twice", f->path, tag);
    *at = i;
  }
  return SHB_OK;
}

shb_status modal_load_field_check(const mesh_fe *mesh, modal_load_field *field) {
  SHB_TRY(check_harmonics(field));
  return locate(mesh, field);
}

shb_status modal_load_field_read(const mesh_fe *mesh, modal_load_field *field) {
  hid_t file;
  SHB_TRY(h5_open(field->path, &file));
  shb_status status = read_all(file, field);
  h5_close(file);
  SHB_TRY(status);
  return modal_load_field_check(mesh, field);
}

void modal_load_field_free(modal_load_field *field) {
  free(field->node);
  free(field->harmonic);
  free(field->value);
  free(field->at);
}
