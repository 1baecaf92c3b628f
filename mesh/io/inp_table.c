#include "mesh/io/inp_table.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "mesh/base/memory.h"

/* Make room for one more item. */
static void reserve(void **array, int n, int *room, size_t size) {
  if (n < *room) return;
  if (n == INT_MAX) shb_out_of_memory((double)n * (double)size);
  *room  = *room > INT_MAX / 2 ? INT_MAX : *room ? 2 * *room : 64;
  *array = shb_realloc(*array, (size_t)*room, size);
}

void mesh_inp_add_node(mesh_inp *inp, const mesh_inp_node *node) {
  reserve((void **)&inp->node, inp->n_nodes, &inp->node_room, sizeof *node);
  inp->node[inp->n_nodes++] = *node;
}

void mesh_inp_add_element(mesh_inp *inp, const mesh_inp_element *element) {
  reserve((void **)&inp->element, inp->n_elements, &inp->element_room, sizeof *element);
  inp->element[inp->n_elements++] = *element;
}

void mesh_inp_add_member(mesh_inp_set *set, const mesh_inp_member *member) {
  reserve((void **)&set->member, set->n, &set->room, sizeof *member);
  set->member[set->n++] = *member;
}

mesh_inp_set *mesh_inp_find(const mesh_inp *inp, mesh_inp_kind kind, const char *name) {
  const char *dot = strrchr(name, '.');
  for (int i = 0; i < inp->n_sets; i++)
    if (inp->set[i].kind == kind && strcasecmp(inp->set[i].name, name) == 0) return &inp->set[i];
  return dot ? mesh_inp_find(inp, kind, dot + 1) : NULL;
}

int mesh_inp_open_set(mesh_inp *inp, mesh_inp_kind kind, const char *name, bool of_nodes,
                      long line) {
  const mesh_inp_set *found = mesh_inp_find(inp, kind, name);
  if (found) return (int)(found - inp->set);
  reserve((void **)&inp->set, inp->n_sets, &inp->set_room, sizeof *inp->set);
  mesh_inp_set *set = &inp->set[inp->n_sets];
  *set              = (mesh_inp_set){.kind = kind, .of_nodes = of_nodes, .line = line};
  snprintf(set->name, sizeof set->name, "%s", name);
  return inp->n_sets++;
}

static int compare(long a, long b) {
  return (a > b) - (a < b);
}

static int by_node(const void *a, const void *b) {
  return compare(((const mesh_inp_node *)a)->id, ((const mesh_inp_node *)b)->id);
}

static int by_element(const void *a, const void *b) {
  return compare(((const mesh_inp_element *)a)->id, ((const mesh_inp_element *)b)->id);
}

/* Name the later of the two lines. */
static shb_status refuse_duplicate(const mesh_deck *deck, const char *what, long id, long a,
                                   long b) {
  MESH_DECK_FAIL(deck, a > b ? a : b, "%s %ld is given twice, first in line %ld", what, id,
                 a > b ? b : a);
}

shb_status mesh_inp_sort(mesh_inp *inp, const mesh_deck *deck) {
  mesh_inp_node    *node    = inp->node;
  mesh_inp_element *element = inp->element;
  if (inp->n_nodes) qsort(node, (size_t)inp->n_nodes, sizeof *node, by_node);
  if (inp->n_elements) qsort(element, (size_t)inp->n_elements, sizeof *element, by_element);
  for (int i = 1; i < inp->n_nodes; i++)
    if (node[i].id == node[i - 1].id)
      return refuse_duplicate(deck, "node", node[i].id, node[i].line, node[i - 1].line);
  for (int i = 1; i < inp->n_elements; i++)
    if (element[i].id == element[i - 1].id)
      return refuse_duplicate(deck, "element", element[i].id, element[i].line, element[i - 1].line);
  return SHB_OK;
}

int mesh_inp_node_at(const mesh_inp *inp, long id) {
  mesh_inp_node  wanted = {.id = id};
  mesh_inp_node *found =
      inp->n_nodes ? bsearch(&wanted, inp->node, (size_t)inp->n_nodes, sizeof wanted, by_node)
                   : NULL;
  return found ? (int)(found - inp->node) : -1;
}

int mesh_inp_element_at(const mesh_inp *inp, long id) {
  mesh_inp_element  wanted = {.id = id};
  mesh_inp_element *found =
      inp->n_elements
          ? bsearch(&wanted, inp->element, (size_t)inp->n_elements, sizeof wanted, by_element)
          : NULL;
  return found ? (int)(found - inp->element) : -1;
}

/* Corners of S1, S2, ..., counted from 0; the fourth of a triangle repeats the first. */
static const int tet_label[4][4] = {{0, 1, 2, 0}, {0, 3, 1, 0}, {1, 3, 2, 1}, {2, 3, 0, 2}};
static const int hex_label[6][4] = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                    {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};

static bool contains(const int label[4], int corner) {
  for (int i = 0; i < 4; i++)
    if (label[i] == corner) return true;
  return false;
}

int mesh_inp_face(mesh_kind kind, int label) {
  const mesh_topology *topology = mesh_topology_of(kind);
  if (label < 1 || label > topology->faces) return -1;
  const int *corner = kind == MESH_HEX20 ? hex_label[label - 1] : tet_label[label - 1];
  for (int f = 0; f < topology->faces; f++) {
    int same = 0;
    for (int i = 0; i < topology->face_corners; i++) same += contains(corner, topology->face[f][i]);
    if (same == topology->face_corners) return f;
  }
  return -1;
}

void mesh_inp_free(mesh_inp *inp) {
  for (int i = 0; i < inp->n_sets; i++) free(inp->set[i].member);
  free(inp->node);
  free(inp->element);
  free(inp->set);
  memset(inp, 0, sizeof *inp);
}
