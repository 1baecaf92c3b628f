#include "tests/support/sector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "tests/support/box.h"
#include "tests/support/fem.h"

static const double bore = 0.08, rim = 0.03, blade = 0.06, shroud = 0.012, depth = 0.025;

/* Keep the faces of a set whose nodes all have a height (before the map) in [low, high]. */
static void keep(mesh_fe *mesh, mesh_set_id id, double low, double high) {
  const int      width = mesh_topology_of(mesh->kind)->face_nodes;
  mesh_face_set *set   = &mesh->set[id];
  int            n     = 0;
  for (int f = 0; f < set->n; f++) {
    const int *node = set->nodes + width * f;
    bool       in   = true;
    for (int i = 0; i < width; i++) {
      const double z = mesh->coordinates[3 * node[i] + 2];
      in             = in && z >= low - 1e-12 && z <= high + 1e-12;
    }
    if (in) memmove(set->nodes + width * n++, node, (size_t)width * sizeof *node);
  }
  set->n = n;
}

/* Height of layer k of the box: the disc, the blade and the shroud have whole numbers of cells. */
static double height(double k, int fine) {
  const double disc = 2 * fine, airfoil = 4 * fine, top = fine;
  if (k <= disc) return rim * k / disc;
  if (k <= disc + airfoil) return rim + blade * (k - disc) / airfoil;
  return rim + blade + shroud * (k - disc - airfoil) / top;
}

/* Width of the blade at a height, in widths of the sector. */
static double width_at(double z) {
  if (z <= rim || z >= rim + blade) return 1;
  const double t = (z - rim) / blade;
  return 1 - 0.7 * sin(SHB_PI * t) * (1 + 0.2 * t);
}

mesh_fe make_bladed_sector(int blades, int fine) {
  const double size[3]  = {depth, 1, 7. * fine};
  const int    cells[3] = {2 * fine, 2 * fine, 7 * fine};
  mesh_fe      mesh     = make_box(size, cells);
  const double sector   = SHB_TWO_PI / blades;
  for (int i = 0; i < mesh.n_nodes; i++)
    mesh.coordinates[3 * i + 2] = height(mesh.coordinates[3 * i + 2], fine);
  assert_ok(box_set(&mesh, MESH_ROOT, 2, 0));
  assert_ok(box_set(&mesh, MESH_LOAD, 2, rim + blade + shroud));
  for (int s = 0; s < 2; s++) {
    const mesh_set_id contact = s ? MESH_CONTACT_LEFT : MESH_CONTACT_RIGHT;
    const mesh_set_id cyclic  = s ? MESH_CYCLIC_LEFT : MESH_CYCLIC_RIGHT;
    assert_ok(box_set(&mesh, contact, 1, s));
    keep(&mesh, contact, rim + blade, 1);
    assert_ok(box_set(&mesh, cyclic, 1, s));
    keep(&mesh, cyclic, 0, rim);
  }
  for (int i = 0; i < mesh.n_nodes; i++) {
    double      *x = mesh.coordinates + 3 * i;
    const double z = x[2], lean = 3 * (x[0] - 0.3 * depth) * z / (bore + z) + 0.7 * z;
    const double angle = (0.5 - x[1]) * sector * width_at(z) + lean, radius = bore + z;
    x[0] *= 1 - 2 * z + 0.3 * (x[1] - 0.5) * (width_at(z) - 1);
    x[1] = -radius * sin(angle);
    x[2] = radius * cos(angle);
  }
  return mesh;
}

static bool in_disc(const mesh_fe *mesh, int node) {
  const double *x = mesh->coordinates + 3 * node;
  return hypot(x[1], x[2]) < bore + rim + 1e-9;
}

void sector_mark_disc(mesh_fe *mesh) {
  const int each  = mesh_topology_of(mesh->kind)->nodes;
  mesh->n_regions = 2;
  mesh->region    = calloc((size_t)mesh->n_elements, sizeof *mesh->region);
  assert_non_null(mesh->region);
  for (int e = 0; e < mesh->n_elements; e++) {
    mesh->region[e] = 1;
    for (int i = 0; i < each; i++)
      if (!in_disc(mesh, mesh->connectivity[each * e + i])) mesh->region[e] = 0;
  }
}

mesh_fe sector_clamp_disc(const mesh_fe *sector) {
  const int width = mesh_topology_of(sector->kind)->face_nodes;
  mesh_fe   mesh  = *sector;
  int      *node = malloc((size_t)(mesh.n_nodes + width) * sizeof *node), count = 0;
  assert_non_null(node);
  for (int i = 0; i < mesh.n_nodes; i++)
    if (in_disc(&mesh, i)) node[count++] = i;
  while (count % width) node[count++] = node[0];
  mesh.image          = NULL;
  mesh.set[MESH_ROOT] = (mesh_face_set){count / width, node};
  return mesh;
}

static void copy_sets(const mesh_fe *sector, const int *node, mesh_fe *ring) {
  const int width = mesh_topology_of(sector->kind)->face_nodes;
  for (int s = 0; s <= MESH_LOAD; s++) {
    const mesh_face_set *from = &sector->set[s];
    mesh_face_set       *to   = &ring->set[s];
    for (int i = 0; i < width * from->n; i++) to->nodes[width * to->n + i] = node[from->nodes[i]];
    to->n += from->n;
  }
}

/* Numbers of the ring's nodes: a right node of sector b is its partner in sector b + 1. */
static int number(const mesh_fe *sector, int blades, int *node) {
  const int n    = sector->n_nodes;
  int       next = 0;
  for (int b = 0; b < blades; b++)
    for (int i = 0; i < n; i++)
      if (sector->image[i] < 0) node[b * n + i] = next++;
  for (int b = 0; b < blades; b++)
    for (int i = 0; i < n; i++)
      if (sector->image[i] >= 0) node[b * n + i] = node[(b + 1) % blades * n + sector->image[i]];
  return next;
}

sector_ring make_sector_ring(const mesh_fe *sector, mesh_axis axis, int blades) {
  const size_t N = (size_t)blades, n = (size_t)sector->n_nodes, e = (size_t)sector->n_elements;
  const size_t each  = (size_t)mesh_topology_of(sector->kind)->nodes;
  const size_t width = (size_t)mesh_topology_of(sector->kind)->face_nodes;
  sector_ring  ring  = {.blades = blades, .node = malloc(N * n * sizeof *ring.node)};
  mesh_fe     *mesh  = &ring.mesh;
  assert_non_null(ring.node);
  *mesh              = (mesh_fe){.kind = sector->kind, .n_elements = (int)(N * e)};
  mesh->n_nodes      = number(sector, blades, ring.node);
  mesh->coordinates  = malloc(3 * (size_t)mesh->n_nodes * sizeof *mesh->coordinates);
  mesh->node_tag     = malloc((size_t)mesh->n_nodes * sizeof *mesh->node_tag);
  mesh->connectivity = malloc(N * e * each * sizeof *mesh->connectivity);
  mesh->element_tag  = malloc(N * e * sizeof *mesh->element_tag);
  assert_true(mesh->coordinates && mesh->node_tag && mesh->connectivity && mesh->element_tag);
  for (int s = 0; s <= MESH_LOAD; s++)
    mesh->set[s].nodes = malloc((N * width * (size_t)sector->set[s].n + 1) * sizeof(int));
  for (int i = 0; i < mesh->n_nodes; i++) mesh->node_tag[i] = i + 1;
  for (int b = 0; b < blades; b++) {
    const int *node = ring.node + (size_t)b * n;
    for (size_t i = 0; i < n; i++)
      mesh_axis_rotate(axis, SHB_TWO_PI * b / blades, sector->coordinates + 3 * i,
                       mesh->coordinates + 3 * (size_t)node[i]);
    for (size_t i = 0; i < e * each; i++)
      mesh->connectivity[(size_t)b * e * each + i] = node[sector->connectivity[i]];
    for (size_t i = 0; i < e; i++)
      mesh->element_tag[(size_t)b * e + i] = (long)((size_t)b * e + i) + 1;
    copy_sets(sector, node, mesh);
  }
  return ring;
}

void free_sector_ring(sector_ring *ring) {
  mesh_fe_free(&ring->mesh);
  free(ring->node);
  ring->node = NULL;
}
