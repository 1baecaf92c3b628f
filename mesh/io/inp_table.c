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
  if (node->id > inp->top_node) inp->top_node = node->id;
}

void mesh_inp_add_element(mesh_inp *inp, const mesh_inp_element *element) {
  reserve((void **)&inp->element, inp->n_elements, &inp->element_room, sizeof *element);
  inp->element[inp->n_elements++] = *element;
  if (element->id > inp->top_element) inp->top_element = element->id;
}

void mesh_inp_add_member(mesh_inp_set *set, const mesh_inp_member *member) {
  reserve((void **)&set->member, set->n, &set->room, sizeof *member);
  set->member[set->n++] = *member;
}

mesh_inp_set *mesh_inp_find_whole(const mesh_inp *inp, mesh_inp_kind kind, const char *name) {
  for (int i = 0; i < inp->n_sets; i++)
    if (inp->set[i].kind == kind && strcasecmp(inp->set[i].name, name) == 0) return &inp->set[i];
  return NULL;
}

mesh_inp_set *mesh_inp_find(const mesh_inp *inp, mesh_inp_kind kind, const char *name) {
  mesh_inp_set *found = mesh_inp_find_whole(inp, kind, name);
  const char   *dot   = strrchr(name, '.');
  return found || !dot ? found : mesh_inp_find(inp, kind, dot + 1);
}

int mesh_inp_open_set(mesh_inp *inp, mesh_inp_kind kind, const char *name, bool of_nodes,
                      mesh_place line) {
  const mesh_inp_set *found = mesh_inp_find_whole(inp, kind, name);
  if (found) return (int)(found - inp->set);
  reserve((void **)&inp->set, inp->n_sets, &inp->set_room, sizeof *inp->set);
  mesh_inp_set *set = &inp->set[inp->n_sets];
  *set              = (mesh_inp_set){.kind = kind, .of_nodes = of_nodes, .line = line};
  snprintf(set->name, sizeof set->name, "%.*s", MESH_INP_NAME - 1, name);
  return inp->n_sets++;
}

void mesh_inp_map_point(const mesh_inp_map *map, double at[3]) {
  const double x[3] = {at[0], at[1], at[2]};
  for (int i = 0; i < 3; i++)
    at[i] =
        map->axes[i][0] * x[0] + map->axes[i][1] * x[1] + map->axes[i][2] * x[2] + map->origin[i];
}

/* Members of a set behind those of another; their numbers are raised. */
static void append_set(mesh_inp_set *to, const mesh_inp_set *from, long raise) {
  for (int i = 0, n = from->n; i < n; i++) {
    mesh_inp_member member = from->member[i];
    member.id += raise;
    mesh_inp_add_member(to, &member);
  }
}

void mesh_inp_append(mesh_inp *inp, const mesh_inp *part, const mesh_inp_instance *as) {
  for (int i = 0; i < part->n_nodes; i++) {
    mesh_inp_node node = part->node[i];
    node.id += as->node;
    mesh_inp_map_point(&as->map, node.at);
    mesh_inp_add_node(inp, &node);
  }
  for (int i = 0; i < part->n_elements; i++) {
    mesh_inp_element element = part->element[i];
    element.id += as->element;
    for (int j = 0; j < element.n; j++) element.node[j] += as->node;
    mesh_inp_add_element(inp, &element);
  }
  for (int i = 0; i < part->n_sets; i++) {
    const mesh_inp_set *from = &part->set[i];
    char                name[MESH_DECK_NAME + MESH_INP_NAME];
    snprintf(name, sizeof name, "%s%s%s", as->name, *as->name ? "." : "", from->name);
    const int to = mesh_inp_open_set(inp, from->kind, name, from->of_nodes, from->line);
    append_set(&inp->set[to], from, from->of_nodes ? as->node : as->element);
  }
}

void mesh_inp_share_names(mesh_inp *inp) {
  for (int i = 0, n = inp->n_sets; i < n; i++) {
    const mesh_inp_set  from = inp->set[i];
    const char         *dot  = strrchr(from.name, '.');
    const mesh_inp_set *own  = dot ? mesh_inp_find_whole(inp, from.kind, dot + 1) : NULL;
    if (!dot || (own && own - inp->set < n)) continue;
    const int to = mesh_inp_open_set(inp, from.kind, dot + 1, from.of_nodes, from.line);
    append_set(&inp->set[to], &from, 0);
  }
}

static int compare(long a, long b) {
  return (a > b) - (a < b);
}

static int by_number(const void *a, const void *b) {
  return compare(*(const long *)a, *(const long *)b);
}

void mesh_inp_add_nodes_of(mesh_inp *inp, int into, const mesh_inp_set *of) {
  long *wanted = shb_alloc((size_t)of->n, sizeof *wanted);
  for (int i = 0; i < of->n; i++) wanted[i] = of->member[i].id;
  qsort(wanted, (size_t)of->n, sizeof *wanted, by_number);
  for (int e = 0; e < inp->n_elements; e++) {
    const mesh_inp_element *element = &inp->element[e];
    if (!bsearch(&element->id, wanted, (size_t)of->n, sizeof *wanted, by_number)) continue;
    for (int i = 0; i < element->n; i++)
      mesh_inp_add_member(&inp->set[into],
                          &(mesh_inp_member){element->node[i], element->line, 0, 0});
  }
  free(wanted);
}

static int by_node(const void *a, const void *b) {
  return compare(((const mesh_inp_node *)a)->id, ((const mesh_inp_node *)b)->id);
}

static int by_element(const void *a, const void *b) {
  return compare(((const mesh_inp_element *)a)->id, ((const mesh_inp_element *)b)->id);
}

/* Name the later of the two lines. */
static shb_status refuse_duplicate(const mesh_deck *deck, const char *what, long id, mesh_place a,
                                   mesh_place b) {
  MESH_DECK_FAIL(deck, a > b ? a : b, "%s %ld is given twice, first in line %ld%s%s", what, id,
                 mesh_place_line(a > b ? b : a), a >> 32 == b >> 32 ? "" : " of ",
                 a >> 32 == b >> 32 ? "" : mesh_place_file(deck, a > b ? b : a));
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
