/* The text of a .msh file as lists, before references are resolved. */
#ifndef MESH_IO_MSH_TEXT_H
#define MESH_IO_MSH_TEXT_H

#include <stdbool.h>
#include <stddef.h>

enum { MESH_MSH_NAME = 120 };

/* A geometric entity, or its membership of a physical group. */
typedef struct {
  int    dim;
  size_t entity, group; /* group 0: none */
} mesh_msh_member;

typedef struct {
  int    dim;
  size_t group;
  char   text[MESH_MSH_NAME];
} mesh_msh_name;

/* Elements of one type on one entity. */
typedef struct {
  int    dim, type;
  size_t entity, n;
  size_t tag, node; /* where they begin in the lists tag and node */
} mesh_msh_block;

typedef struct {
  double           version; /* 2.2 or 4.1 */
  size_t           n_names, n_members, n_blocks, n_nodes;
  mesh_msh_name   *name;
  mesh_msh_member *member;
  mesh_msh_block  *block;    /* of faces and volumes */
  size_t          *node_tag; /* [n_nodes] */
  double          *xyz;      /* [n_nodes][3] */
  size_t          *tag;      /* of the elements of all blocks */
  size_t          *node;     /* tags of their nodes */
  size_t           n_tags, n_element_nodes;
} mesh_msh_text;

/* Read a whole file. False where it holds anything that is not foreseen.
 *   out  free with mesh_msh_text_free, also then */
bool mesh_msh_text_read(const char *path, mesh_msh_text *out);

/* Nodes of an element of gmsh's type: of second-order faces and volumes; 0 for others. */
size_t mesh_msh_nodes_of(int type);

void mesh_msh_text_free(mesh_msh_text *text);

#endif
