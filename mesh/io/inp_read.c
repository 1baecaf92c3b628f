#include "mesh/io/inp_read.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mesh/core/faces.h"
#include "mesh/core/regions.h"
#include "mesh/io/inp_cards.h"

/* Tables and indices while the mesh is built. */
typedef struct {
  const mesh_deck *deck;
  mesh_inp         inp;
  int             *index;  /* [inp.n_nodes] index in the mesh, -1: unused */
  int             *volume; /* [inp.n_elements] index in the mesh, -1: a face */
  mesh_fe         *mesh;
} builder;

static void allocate(builder *b, int n_volumes) {
  const size_t n        = (size_t)n_volumes;
  const size_t each     = (size_t)mesh_topology_of(b->mesh->kind)->nodes;
  b->mesh->n_elements   = n_volumes;
  b->mesh->connectivity = shb_alloc(each * n, sizeof *b->mesh->connectivity);
  b->mesh->element_tag  = shb_alloc(n, sizeof *b->mesh->element_tag);
  b->index              = shb_alloc((size_t)b->inp.n_nodes, sizeof *b->index);
  b->volume             = shb_alloc((size_t)b->inp.n_elements, sizeof *b->volume);
  for (int i = 0; i < b->inp.n_nodes; i++) b->index[i] = -1;
}

/* Check that all elements are of one kind; allocate. */
static shb_status find_kind(builder *b) {
  const mesh_inp *inp = &b->inp;
  int             n = 0, nodes = 0;
  for (int e = 0; e < inp->n_elements; e++) {
    const mesh_inp_element *element = &inp->element[e];
    if (element->face) continue;
    n++;
    if (!nodes) nodes = element->n;
    MESH_DECK_CHECK(element->n == nodes, b->deck, element->line,
                    "tetrahedra and hexahedra in one mesh; all elements must be of one kind");
  }
  SHB_CHECK(n > 0, SHB_ERR_INPUT, "%s: no volume elements (*ELEMENT, TYPE=C3D10 or C3D20R)",
            b->deck->path);
  SHB_CHECK(n < INT_MAX / MESH_NODES, SHB_ERR_INPUT, "%s: %d elements are too many", b->deck->path,
            n);
  b->mesh->kind = nodes == mesh_topology_of(MESH_HEX20)->nodes ? MESH_HEX20 : MESH_TET10;
  allocate(b, n);
  return SHB_OK;
}

/* Set connectivity to the index in the table, for take_nodes to replace; mark the nodes used. */
static shb_status take_volumes(builder *b) {
  const mesh_inp      *inp      = &b->inp;
  const mesh_topology *topology = mesh_topology_of(b->mesh->kind);
  int                  n        = 0;
  for (int e = 0; e < inp->n_elements; e++) {
    const mesh_inp_element *from = &inp->element[e];
    b->volume[e]                 = from->face ? -1 : n;
    if (from->face) continue;
    int *to = b->mesh->connectivity + (size_t)topology->nodes * (size_t)n;
    for (int i = 0; i < topology->nodes; i++) {
      int at = mesh_inp_node_at(inp, from->node[i]);
      MESH_DECK_CHECK(at >= 0, b->deck, from->line, "element %ld uses node %ld, which is absent",
                      from->id, from->node[i]);
      to[topology->vtk_order[i]] = at;
      b->index[at]               = 0;
    }
    b->mesh->element_tag[n++] = from->id;
  }
  return SHB_OK;
}

static void take_nodes(builder *b) {
  mesh_fe *mesh = b->mesh;
  for (int i = 0; i < b->inp.n_nodes; i++)
    if (b->index[i] >= 0) b->index[i] = mesh->n_nodes++;
  mesh->coordinates = shb_alloc(3 * (size_t)mesh->n_nodes, sizeof *mesh->coordinates);
  mesh->node_tag    = shb_alloc((size_t)mesh->n_nodes, sizeof *mesh->node_tag);
  for (int i = 0; i < b->inp.n_nodes; i++) {
    if (b->index[i] < 0) continue;
    memcpy(mesh->coordinates + 3 * (size_t)b->index[i], b->inp.node[i].at, 3 * sizeof(double));
    mesh->node_tag[b->index[i]] = b->inp.node[i].id;
  }
  const size_t each = (size_t)mesh_topology_of(mesh->kind)->nodes;
  for (size_t i = 0; i < each * (size_t)mesh->n_elements; i++)
    mesh->connectivity[i] = b->index[mesh->connectivity[i]];
}

/* Nodes of face f of element e. */
static void element_face(const mesh_fe *mesh, int e, int f, int *nodes) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  for (int i = 0; i < topology->face_nodes; i++)
    nodes[i] =
        mesh->connectivity[(size_t)topology->nodes * (size_t)e + (size_t)topology->face[f][i]];
}

/* Nodes of an element that is itself a face. */
static shb_status own_face(const builder *b, const mesh_inp_element *from, const char *name,
                           int *nodes) {
  const mesh_topology *topology = mesh_topology_of(b->mesh->kind);
  MESH_DECK_CHECK(from->n == topology->face_nodes, b->deck, from->line,
                  "group %s: element %ld has %d nodes; a face of the body has %d", name, from->id,
                  from->n, topology->face_nodes);
  for (int i = 0; i < from->n; i++) {
    int at   = mesh_inp_node_at(&b->inp, from->node[i]);
    nodes[i] = at < 0 ? -1 : b->index[at];
    MESH_DECK_CHECK(nodes[i] >= 0, b->deck, from->line,
                    "group %s: node %ld of element %ld belongs to no volume element", name,
                    from->node[i], from->id);
  }
  return SHB_OK;
}

/* Nodes of a member of a surface or element set that is a face. found: false in the gap of a
 * range. */
static shb_status member_face(const builder *b, const mesh_inp_member *member, const char *name,
                              int *nodes, bool *found) {
  int at = mesh_inp_element_at(&b->inp, member->id);
  *found = at >= 0;
  MESH_DECK_CHECK(*found || member->may_lack, b->deck, member->line,
                  "group %s: element %ld is not in the file", name, member->id);
  if (!*found) return SHB_OK;
  const mesh_inp_element *from = &b->inp.element[at];
  if (from->face) return own_face(b, from, name, nodes);
  MESH_DECK_CHECK(member->face > 0, b->deck, member->line,
                  "group %s: element %ld is a volume, not a face; give *SURFACE, NAME=%s with "
                  "faces S1, S2, ..., or *NSET, NSET=%s",
                  name, member->id, name, name);
  int face = mesh_inp_face(b->mesh->kind, member->face);
  MESH_DECK_CHECK(face >= 0, b->deck, member->line, "group %s: a %s has no face S%d", name,
                  mesh_topology_of(b->mesh->kind)->name, member->face);
  element_face(b->mesh, b->volume[at], face, nodes);
  return SHB_OK;
}

static shb_status faces_of_elements(builder *b, const mesh_inp_set *from, int id) {
  const size_t   each = (size_t)mesh_topology_of(b->mesh->kind)->face_nodes;
  mesh_face_set *set  = &b->mesh->set[id];
  set->nodes          = shb_alloc(each * (size_t)from->n, sizeof *set->nodes);
  for (int i = 0; i < from->n; i++) {
    bool found;
    SHB_TRY(member_face(b, &from->member[i], mesh_fe_set_name(b->mesh, id),
                        set->nodes + each * (size_t)set->n, &found));
    set->n += found;
  }
  return SHB_OK;
}

/* Faces of the body all nodes of which are in the set. */
static shb_status faces_of_nodes(builder *b, const mesh_inp_set *from, int id) {
  char      *marked = shb_alloc_zeroed((size_t)b->mesh->n_nodes + 1, 1);
  shb_status status = SHB_OK;
  for (int i = 0; i < from->n && status == SHB_OK; i++) {
    int at = mesh_inp_node_at(&b->inp, from->member[i].id);
    if (at < 0 && !from->member[i].may_lack)
      status = mesh_deck_fail(b->deck, from->member[i].line, __FILE__, __LINE__,
                              "group %s: node %ld is not in the file",
                              mesh_fe_set_name(b->mesh, id), from->member[i].id);
    if (at >= 0 && b->index[at] >= 0) marked[b->index[at]] = 1;
  }
  if (status == SHB_OK) mesh_faces_outer(b->mesh, marked, &b->mesh->set[id]);
  if (status == SHB_OK && b->mesh->set[id].n == 0)
    status = mesh_deck_fail(b->deck, from->line, __FILE__, __LINE__,
                            "group %s: its %d nodes hold no whole face of the body (%d nodes)",
                            mesh_fe_set_name(b->mesh, id), from->n,
                            mesh_topology_of(b->mesh->kind)->face_nodes);
  free(marked);
  return status;
}

static shb_status take_group(builder *b, const mesh_names *names, int id) {
  const char         *name = mesh_names_set(names, id);
  const mesh_inp_set *set  = mesh_inp_find(&b->inp, MESH_INP_SURFACE, name);
  if (!set) set = mesh_inp_find(&b->inp, MESH_INP_ELSET, name);
  if (!set) set = mesh_inp_find(&b->inp, MESH_INP_NSET, name);
  if (!set) return SHB_OK;
  MESH_DECK_CHECK(set->n > 0, b->deck, set->line, "group %s is empty", name);
  return set->of_nodes ? faces_of_nodes(b, set, id) : faces_of_elements(b, set, id);
}

/* Assign the elements of an element set to volume i. */
static shb_status take_volume(builder *b, mesh_regions *regions, int i) {
  const char *name = regions->names->volume[i].name;
  SHB_CHECK(!regions->names->volume[i].near, SHB_ERR_INPUT,
            "mesh.groups.%s: %s is not made of volumes in which a point could lie; give {name: an "
            "element set}",
            regions->names->volume[i].label, b->deck->path);
  const mesh_inp_set *set = mesh_inp_find(&b->inp, MESH_INP_ELSET, name);
  SHB_CHECK(set, SHB_ERR_INPUT, "%s: no element set '%s' (*ELSET, or ELSET= of *ELEMENT)",
            b->deck->path, name);
  for (int m = 0; m < set->n; m++) {
    const mesh_inp_member *member = &set->member[m];
    int                    at     = mesh_inp_element_at(&b->inp, member->id);
    MESH_DECK_CHECK(at >= 0 || member->may_lack, b->deck, member->line,
                    "element set %s: element %ld is not in the file", name, member->id);
    if (at < 0) continue;
    MESH_DECK_CHECK(b->volume[at] >= 0, b->deck, member->line,
                    "element set %s: element %ld is a face, not a volume", name, member->id);
    mesh_regions_assign(regions, b->volume[at], i);
  }
  return SHB_OK;
}

static shb_status take_regions(builder *b, const mesh_names *names) {
  mesh_regions regions;
  mesh_regions_begin(b->deck->path, names, b->mesh, &regions);
  for (int i = 0; i < names->n_volumes; i++) SHB_TRY(take_volume(b, &regions, i));
  return mesh_regions_end(&regions);
}

static shb_status build(builder *b, const mesh_names *names) {
  SHB_TRY(mesh_inp_sort(&b->inp, b->deck));
  SHB_TRY(find_kind(b));
  SHB_TRY(take_volumes(b));
  take_nodes(b);
  for (int i = 0; i < b->inp.n_sets; i++)
    if (*b->inp.set[i].name) mesh_fe_note_group(b->mesh, b->inp.set[i].name);
  for (int id = 0; id < mesh_fe_sets(b->mesh); id++) SHB_TRY(take_group(b, names, id));
  if (names && names->n_volumes) SHB_TRY(take_regions(b, names));
  return mesh_faces_orient(b->mesh, b->deck->path);
}

shb_status mesh_inp_read(const char *path, const mesh_names *names, mesh_fe *mesh) {
  mesh_deck deck;
  memset(mesh, 0, sizeof *mesh);
  mesh_regions_name(names, mesh);
  shb_status status = mesh_deck_open(path, &deck);
  builder    b      = {.deck = &deck, .mesh = mesh};
  if (status == SHB_OK) status = mesh_inp_cards(&deck, &b.inp);
  if (status == SHB_OK) status = build(&b, names);
  mesh_inp_free(&b.inp);
  mesh_deck_close(&deck);
  free(b.index);
  free(b.volume);
  if (status != SHB_OK) mesh_fe_free(mesh);
  return status;
}
