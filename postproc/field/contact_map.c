#include "postproc/field/contact_map.h"

#include <stdio.h>
#include <stdlib.h>

#include "modal/hdf5/h5.h"

void post_contact_face_free(post_contact_face *face) {
  free(face->node);
  free(face->area);
  free(face->element);
  *face = (post_contact_face){0};
}

void post_contact_maps_free(post_contact_maps *maps) {
  free(maps->point);
  free(maps->pressure);
  free(maps->slip);
  free(maps->dissipation);
  free(maps->state);
  *maps = (post_contact_maps){0};
}

static shb_status read_face(hid_t file, post_contact_face *f) {
  static const char *const name[] = {
      [MESH_TET10] = "/contact_face/triangles", [MESH_HEX20] = "/contact_face/quadrangles"};
  if (!h5_exists(file, "/contact_face/nodes")) return SHB_OK;
  f->kind           = h5_exists(file, name[MESH_TET10]) ? MESH_TET10 : MESH_HEX20;
  const int corners = mesh_topology_of(f->kind)->face_nodes;
  h5_shape  nodes = H5_SHAPE(0, 3), elements = H5_SHAPE(0, (hsize_t)corners);
  SHB_TRY(h5_read_double(file, "/contact_face/nodes", &nodes, &f->node));
  h5_shape each = H5_SHAPE(nodes.dim[0]);
  SHB_TRY(h5_read_double(file, "/contact_face/area", &each, &f->area));
  SHB_TRY(h5_read_int(file, name[f->kind], &elements, &f->element));
  f->n_nodes    = (int)nodes.dim[0];
  f->n_elements = (int)elements.dim[0];
  for (int i = 0; i < f->n_elements * corners; i++)
    SHB_CHECK(f->element[i] >= 0 && f->element[i] < f->n_nodes, SHB_ERR_INPUT,
              "%s: value %d (from 0) is %d; the face has %d nodes", name[f->kind], i, f->element[i],
              f->n_nodes);
  return SHB_OK;
}

shb_status post_contact_face_read(hid_t file, post_contact_face *face) {
  *face             = (post_contact_face){0};
  shb_status status = read_face(file, face);
  if (status != SHB_OK) post_contact_face_free(face);
  return status;
}

static shb_status read_maps(hid_t file, const post_contact_face *face, int branch,
                            post_contact_maps *m) {
  char          name[64];
  const int     start = snprintf(name, sizeof name, "/branch_%d/face", branch);
  char *const   end   = name + start;
  const size_t  left  = sizeof name - (size_t)start;
  const hsize_t nodes = (hsize_t)face->n_nodes;
  h5_shape      peaks = H5_SHAPE(0);
  struct {
    const char *name;
    double    **map;
  } const map[] = {
      {"/pressure", &m->pressure}, {"/slip", &m->slip}, {"/dissipation", &m->dissipation}};
  if (!h5_exists(file, name)) return SHB_OK;
  snprintf(end, left, "/point");
  SHB_TRY(h5_read_int(file, name, &peaks, &m->point));
  for (int i = 0; i < 3; i++) {
    h5_shape shape = H5_SHAPE(peaks.dim[0], nodes);
    snprintf(end, left, "%s", map[i].name);
    SHB_TRY(h5_read_double(file, name, &shape, map[i].map));
  }
  h5_shape shape = H5_SHAPE(peaks.dim[0], nodes, POST_STATES);
  snprintf(end, left, "/state");
  SHB_TRY(h5_read_double(file, name, &shape, &m->state));
  m->n = (int)peaks.dim[0];
  return SHB_OK;
}

shb_status post_contact_maps_read(hid_t file, const post_contact_face *face, int branch,
                                  post_contact_maps *maps) {
  *maps = (post_contact_maps){0};
  if (face->n_nodes == 0) return SHB_OK;
  shb_status status = read_maps(file, face, branch, maps);
  if (status != SHB_OK) post_contact_maps_free(maps);
  return status;
}

int post_contact_highest(const mhb_response *response, int branch, const post_contact_maps *maps) {
  const mhb_branch *b    = &response->branch[branch];
  int               best = -1;
  double            most = -1;
  for (int i = 0; i < maps->n; i++) {
    if (maps->point[i] < 0 || maps->point[i] >= b->n_points) continue;
    const double height = mhb_response_output(response, b, maps->point[i]);
    if (height > most) most = height, best = i;
  }
  return best;
}
