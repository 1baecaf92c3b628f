/* Nodes and elements of a mesh file by their tags, put into a mesh. */
#ifndef MESH_CORE_TAGGED_NODES_H
#define MESH_CORE_TAGGED_NODES_H

#include "mesh/core/fe_mesh.h"

/* The nodes of a file. */
typedef struct {
  size_t        n;
  const size_t *tag;    /* [n] of the caller */
  const double *xyz;    /* [n][3] m, of the caller */
  size_t       *by_tag; /* [n][2] tag, index in tag[]; ascending */
  int          *index;  /* [n] index in the mesh, -1: unused */
} mesh_tagged_nodes;

/* Elements or faces of a file. */
typedef struct {
  size_t        n;
  const size_t *tag;   /* [n] of elements; of faces it is not read */
  const size_t *nodes; /* [n][nodes of one] their tags */
} mesh_tagged_elements;

/* All functions below: name heads the messages. SHB_ERR_INPUT. */
shb_status mesh_tagged_nodes_create(const char *name, size_t n, const size_t *tag,
                                    const double *xyz, mesh_tagged_nodes *out);

/* Are there two nodes of one tag? */
bool mesh_tagged_nodes_repeat(const mesh_tagged_nodes *nodes);

/* Give the mesh its elements, of mesh->kind, and the nodes that these use, by ascending tag. */
shb_status mesh_tagged_take_volume(const char *name, const mesh_tagged_elements *elements,
                                   mesh_tagged_nodes *nodes, mesh_fe *mesh);

/* Append faces to a set of the mesh, which has its elements. */
shb_status mesh_tagged_append_faces(const char *name, const mesh_tagged_nodes *nodes,
                                    const mesh_tagged_elements *faces, int set, mesh_fe *mesh);

void mesh_tagged_nodes_free(mesh_tagged_nodes *nodes); /* also on a zeroed struct */

#endif
