#include "mesh/io/msh_read.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mesh/core/faces.h"
#include "mesh/core/regions.h"
#include "mesh/core/tagged_nodes.h"
#include "mesh/io/msh_text.h"

/* What is put together from the lists. */
typedef struct {
  const char          *path;
  const mesh_names    *names;
  const mesh_msh_text *text;
  mesh_tagged_nodes    nodes;
  mesh_fe             *mesh;
} assembly;

static int by_entity(const void *a, const void *b) {
  const mesh_msh_block *p = a, *q = b;
  if (p->entity != q->entity) return p->entity > q->entity ? 1 : -1;
  return (p->tag > q->tag) - (p->tag < q->tag);
}

/* The elements of all volumes are of one type. */
static bool find_kind(const mesh_msh_text *t, mesh_kind *kind) {
  int type = 0;
  for (size_t b = 0; b < t->n_blocks; b++) {
    if (t->block[b].dim != 3) continue;
    if (type != 0 && t->block[b].type != type) return false;
    type = t->block[b].type;
  }
  *kind = type == mesh_topology_of(MESH_HEX20)->gmsh ? MESH_HEX20 : MESH_TET10;
  return type == mesh_topology_of(*kind)->gmsh;
}

/* The elements of the volumes, entity by entity.
 *   tag, node  out  malloc'ed */
static void join_volumes(const mesh_msh_text *t, size_t *n, size_t **tag, size_t **node) {
  size_t at = 0;
  *n        = 0;
  for (size_t b = 0; b < t->n_blocks; b++) *n += t->block[b].dim == 3 ? t->block[b].n : 0;
  *tag  = shb_alloc(*n + 1, sizeof **tag);
  *node = shb_alloc(*n * MESH_NODES + 1, sizeof **node);
  for (size_t b = 0; b < t->n_blocks; b++) {
    const mesh_msh_block *block = &t->block[b];
    const size_t          each  = mesh_msh_nodes_of(block->type);
    if (block->dim != 3) continue;
    memcpy(*tag + at, t->tag + block->tag, block->n * sizeof **tag);
    memcpy(*node + at * each, t->node + block->node, block->n * each * sizeof **node);
    at += block->n;
  }
}

static bool take_volumes(assembly *a) {
  size_t              *tag = NULL, *node = NULL;
  mesh_tagged_elements all = {0};
  join_volumes(a->text, &all.n, &tag, &node);
  all.tag         = tag;
  all.nodes       = node;
  const bool good = mesh_tagged_take_volume(a->path, &all, &a->nodes, a->mesh) == SHB_OK;
  free(tag);
  free(node);
  return good;
}

/* ------------------------------------------------------------------ groups */

/* The least group of surfaces above the last one; 0: none. */
static size_t next_group(const mesh_msh_text *t, size_t last) {
  size_t least = 0;
  for (size_t i = 0; i < t->n_members; i++) {
    const mesh_msh_member *m = &t->member[i];
    if (m->dim == 2 && m->group > last && (least == 0 || m->group < least)) least = m->group;
  }
  return least;
}

/* Is the entity a surface of the group? */
static bool is_in(const mesh_msh_text *t, size_t entity, size_t group) {
  for (size_t i = 0; i < t->n_members; i++) {
    const mesh_msh_member *m = &t->member[i];
    if (m->dim == 2 && m->entity == entity && m->group == group) return true;
  }
  return false;
}

/* "": none. False if there are two. */
static bool find_name(const mesh_msh_text *t, size_t group, const char **name) {
  *name = "";
  for (size_t i = 0; i < t->n_names; i++) {
    if (t->name[i].dim != 2 || t->name[i].group != group) continue;
    if (**name) return false;
    *name = t->name[i].text;
  }
  return true;
}

static bool take_group(assembly *a, size_t group) {
  const mesh_msh_text *t    = a->text;
  const int            face = mesh_topology_of(a->mesh->kind)->gmsh_face;
  const char          *name;
  if (!find_name(t, group, &name)) return false;
  const int set = mesh_fe_take_group(a->mesh, a->names, name);
  for (size_t b = 0; set >= 0 && b < t->n_blocks; b++) {
    const mesh_msh_block *block = &t->block[b];
    if (block->dim != 2 || !is_in(t, block->entity, group)) continue;
    const mesh_tagged_elements faces = {block->n, t->tag + block->tag, t->node + block->node};
    if (block->type != face ||
        mesh_tagged_append_faces(a->path, &a->nodes, &faces, set, a->mesh) != SHB_OK)
      return false;
  }
  return true;
}

static bool assemble(assembly *a) {
  const mesh_msh_text *t = a->text;
  mesh_regions_name(a->names, a->mesh);
  if (!find_kind(t, &a->mesh->kind)) return false;
  if (mesh_tagged_nodes_create(a->path, t->n_nodes, t->node_tag, t->xyz, &a->nodes) != SHB_OK)
    return false;
  if (mesh_tagged_nodes_repeat(&a->nodes) || !take_volumes(a)) return false;
  for (size_t group = 0; (group = next_group(t, group)) > 0;)
    if (!take_group(a, group)) return false;
  return mesh_faces_orient(a->mesh, a->path) == SHB_OK;
}

bool mesh_msh_read(const char *path, const mesh_names *names, mesh_fe *mesh) {
  mesh_msh_text text;
  memset(mesh, 0, sizeof *mesh);
  if (names && names->n_volumes > 0) return false;
  bool     read = mesh_msh_text_read(path, &text);
  assembly a    = {.path = path, .names = names, .text = &text, .mesh = mesh};
  if (read) {
    qsort(text.block, text.n_blocks, sizeof *text.block, by_entity);
    read = assemble(&a);
  }
  mesh_tagged_nodes_free(&a.nodes);
  mesh_msh_text_free(&text);
  if (!read) mesh_fe_free(mesh);
  return read;
}
