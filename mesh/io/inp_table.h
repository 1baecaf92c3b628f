/* Nodes, elements, sets and surfaces of an .inp file before references are resolved. */
#ifndef MESH_IO_INP_TABLE_H
#define MESH_IO_INP_TABLE_H

#include "mesh/core/element_topology.h"
#include "mesh/io/inp_deck.h"

enum { MESH_INP_NAME = 2 * MESH_DECK_NAME };

typedef struct {
  long       id;
  mesh_place line;
  double     at[3]; /* in the file's unit */
} mesh_inp_node;

/* A volume element, or a triangle or quadrangle that marks a face; nodes in the order of the
 * file. */
typedef struct {
  long       id;
  mesh_place line;
  int        n;    /* number of nodes: 10, 20, 6 or 8 */
  bool       face; /* marks a face of a volume element */
  long       node[MESH_NODES];
} mesh_inp_element;

/* A member of a set: a node, an element or a face of an element. may_lack: it is of a range
 * (GENERATE), in which numbers that the file does not have are skipped. */
typedef struct {
  long       id;
  mesh_place line;
  int        face; /* 1, 2, ... for S1, S2, ...; 0: the element is itself a face */
  bool       may_lack;
} mesh_inp_member;

typedef enum { MESH_INP_NSET, MESH_INP_ELSET, MESH_INP_SURFACE } mesh_inp_kind;

typedef struct {
  mesh_inp_kind    kind;
  char             name[MESH_INP_NAME]; /* of an instance: "instance.set" */
  bool             of_nodes;            /* members are nodes */
  mesh_place       line;                /* where the set is first named */
  int              n, room;
  mesh_inp_member *member;
} mesh_inp_set;

typedef struct {
  mesh_inp_node    *node;
  mesh_inp_element *element;
  mesh_inp_set     *set;
  int               n_nodes, node_room, n_elements, element_room, n_sets, set_room;
  long              top_node, top_element; /* the greatest numbers */
  long long         referred; /* members that sets have by ranges and names of other sets */
} mesh_inp;

/* Append. */
void mesh_inp_add_node(mesh_inp *inp, const mesh_inp_node *node);
void mesh_inp_add_element(mesh_inp *inp, const mesh_inp_element *element);
void mesh_inp_add_member(mesh_inp_set *set, const mesh_inp_member *member);

/* Set of that kind and name, or NULL. Case is ignored. The name of an instance before a dot may be
 * missing. */
mesh_inp_set *mesh_inp_find(const mesh_inp *inp, mesh_inp_kind kind, const char *name);
mesh_inp_set *mesh_inp_find_whole(const mesh_inp *inp, mesh_inp_kind kind, const char *name);

/* Index in inp->set of the set of that kind and name, made if absent. */
int mesh_inp_open_set(mesh_inp *inp, mesh_inp_kind kind, const char *name, bool of_nodes,
                      mesh_place line);

/* A map of points, x' = axes x + origin. */
typedef struct {
  double axes[3][3], origin[3];
} mesh_inp_map;

/* Where a part is put: its numbers of nodes and elements are raised, its nodes mapped, its sets
 * named "name.set"; name "": as they are. */
typedef struct {
  char         name[MESH_DECK_NAME];
  long         node, element;
  mesh_inp_map map;
} mesh_inp_instance;

/* Put the table of a part behind this one. */
void mesh_inp_append(mesh_inp *inp, const mesh_inp *part, const mesh_inp_instance *as);

void mesh_inp_map_point(const mesh_inp_map *map, double at[3]);

/* Gives "set" the members of all sets "instance.set", where no set is named so. */
void mesh_inp_share_names(mesh_inp *inp);

/* Add to the set `into` the nodes of all elements of the set `of`. */
void mesh_inp_add_nodes_of(mesh_inp *inp, int into, const mesh_inp_set *of);

/* Sort nodes and elements by number. SHB_ERR_INPUT: a number is used twice. */
shb_status mesh_inp_sort(mesh_inp *inp, const mesh_deck *deck);

/* Index of a number after sorting, or -1. */
int mesh_inp_node_at(const mesh_inp *inp, long id);
int mesh_inp_element_at(const mesh_inp *inp, long id);

/* Local face (of mesh_topology) of label 1, 2, ... for S1, S2, ...; -1 if there is none. */
int mesh_inp_face(mesh_kind kind, int label);

void mesh_inp_free(mesh_inp *inp); /* also on a zeroed struct */

#endif
