#include "postproc/field/blade_skin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/vec3.h"
#include "mesh/core/faces.h"
#include "mesh/core/triangle.h"

/* Index of a node on the skin; a new one is appended. place[node]: its index + 1, 0: none yet. */
static int index_of(post_skin *skin, int node, int *place) {
  if (place[node] == 0) {
    skin->node[skin->n_nodes] = node;
    place[node]               = ++skin->n_nodes;
  }
  return place[node] - 1;
}

static void add_normal(const mesh_triangle *part, const int corner[3], post_skin *skin) {
  double area[3];
  mesh_triangle_area(part, area);
  for (int c = 0; c < 3; c++)
    for (int d = 0; d < 3; d++) skin->normal[3 * corner[c] + d] += (float)(1e6 * area[d]);
}

static void set_triangles(const mesh_fe *mesh, const mesh_face_set *faces, int *place,
                          post_skin *skin) {
  const int each = mesh_topology_of(mesh->kind)->face_nodes;
  for (int f = 0; f < faces->n; f++) {
    const int    *face = faces->nodes + (size_t)each * (size_t)f;
    mesh_triangle part[MESH_TRIANGLES];
    const int     n = mesh_triangles(mesh, face, part);
    for (int t = 0; t < n; t++) {
      int *corner = skin->triangle + 3 * (size_t)skin->n_triangles++;
      for (int c = 0; c < 3; c++) corner[c] = index_of(skin, face[part[t].local[c]], place);
      add_normal(&part[t], corner, skin);
    }
  }
}

static void set_unit(post_skin *skin) {
  for (int i = 0; i < skin->n_nodes; i++) {
    float       *normal    = skin->normal + 3 * (size_t)i;
    const double vector[3] = {normal[0], normal[1], normal[2]}, length = vec3_norm(vector);
    for (int d = 0; d < 3; d++)
      normal[d] = length > 0 ? (float)(vector[d] / length) : (float)(d == 2);
  }
}

shb_status post_skin_create(const mesh_fe *mesh, post_skin *skin) {
  mesh_face_set faces = {0};
  *skin               = (post_skin){0};
  mesh_faces_outer(mesh, NULL, &faces);
  const size_t n     = (size_t)mesh->n_nodes;
  int         *place = calloc(n + 1, sizeof *place);
  skin->node         = malloc((n + 1) * sizeof *skin->node);
  skin->normal       = calloc(3 * n + 1, sizeof *skin->normal);
  skin->triangle     = malloc((3 * MESH_TRIANGLES * (size_t)faces.n + 1) * sizeof(int));
  const bool whole   = place && skin->node && skin->normal && skin->triangle;
  if (whole) {
    set_triangles(mesh, &faces, place, skin);
    set_unit(skin);
  }
  free(place);
  free(faces.nodes);
  SHB_CHECK(whole, SHB_ERR_IO, "out of memory for the surface of the blade");
  return SHB_OK;
}

void post_skin_free(post_skin *skin) {
  free(skin->node);
  free(skin->triangle);
  free(skin->normal);
  memset(skin, 0, sizeof *skin);
}
