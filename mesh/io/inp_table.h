/* Nodes, elements, sets and surfaces of an .inp file before references are resolved. */
#ifndef MESH_IO_INP_TABLE_H
#define MESH_IO_INP_TABLE_H

#include "mesh/core/element_topology.h"
#include "mesh/io/inp_deck.h"

typedef struct {
  long   id, line;
  double at[3]; /* in the file's unit */
} mesh_inp_node;

/* A volume element, or a triangle or quadrangle that marks a face; nodes in the order of the
 * file. */
typedef struct {
  long id, line;
  int  n;    /* number of nodes: 10, 20, 6 or 8 */
  bool face; /* marks a face of a volume element */
  long node[MESH_NODES];
} mesh_inp_element;

/* A member of a set: a node, an element or a face of an element. */
typedef struct {
  long id, line;
  int  face; /* 1, 2, ... for S1, S2, ...; 0: the element is itself a face */
} mesh_inp_member;

typedef enum { MESH_INP_NSET, MESH_INP_ELSET, MESH_INP_SURFACE } mesh_inp_kind;

typedef struct {
  mesh_inp_kind    kind;
  char             name[MESH_DECK_NAME];
  bool             of_nodes; /* members are nodes */
  long             line;     /* where the set is first named */
  int              n, room;
  mesh_inp_member *member;
} mesh_inp_set;

typedef struct {
  mesh_inp_node    *node;
  mesh_inp_element *element;
  mesh_inp_set     *set;
  int               n_nodes, node_room, n_elements, element_room, n_sets, set_room;
  long long         referred; /* members that sets have by ranges and names of other sets */
} mesh_inp;

/* Append. */
void mesh_inp_add_node(mesh_inp *inp, const mesh_inp_node *node);
void mesh_inp_add_element(mesh_inp *inp, const mesh_inp_element *element);
void mesh_inp_add_member(mesh_inp_set *set, const mesh_inp_member *member);

/* Set of that kind and name, or NULL. Case is ignored. The name of an instance before a dot may be
 * missing. */
mesh_inp_set *mesh_inp_find(const mesh_inp *inp, mesh_inp_kind kind, const char *name);

/* Index in inp->set of the set of that kind and name, made if absent. */
int mesh_inp_open_set(mesh_inp *inp, mesh_inp_kind kind, const char *name, bool of_nodes,
                      long line);

/* Sort nodes and elements by number. SHB_ERR_INPUT: a number is used twice. */
shb_status mesh_inp_sort(mesh_inp *inp, const mesh_deck *deck);

/* Index of a number after sorting, or -1. */
int mesh_inp_node_at(const mesh_inp *inp, long id);
int mesh_inp_element_at(const mesh_inp *inp, long id);

/* Local face (of mesh_topology) of label 1, 2, ... for S1, S2, ...; -1 if there is none. */
int mesh_inp_face(mesh_kind kind, int label);

void mesh_inp_free(mesh_inp *inp); /* also on a zeroed struct */

#endif
