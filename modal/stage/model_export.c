#include "modal/stage/model_export.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "modal/model/receptance.h"

static shb_status export_regions(hid_t file, const mesh_fe *mesh) {
  const char *name[MESH_MAX_VOLUMES];
  for (int i = 0; i < mesh->n_regions; i++) name[i] = mesh->region_name[i];
  SHB_TRY(h5_write_strings(file, "mesh/volume", mesh->n_regions, name, "volumes by material"));
  return h5_write_int(file, "mesh/material", H5_SHAPE((hsize_t)mesh->n_elements), mesh->region, "-",
                      "volume that each element lies in, from 0");
}

shb_status modal_export_mesh(hid_t file, const mesh_fe *mesh) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  char                 text[80];
  SHB_TRY(h5_write_double(file, "mesh/nodes", H5_SHAPE((hsize_t)mesh->n_nodes, 3),
                          mesh->coordinates, "m", "node coordinates"));
  snprintf(text, sizeof text, "nodes of each %s, from 0, gmsh order", topology->name);
  SHB_TRY(h5_write_int(file, "mesh/connectivity",
                       H5_SHAPE((hsize_t)mesh->n_elements, (hsize_t)topology->nodes),
                       mesh->connectivity, "-", text));
  snprintf(text, sizeof text, "nodes of each %s, outward", topology->face_name);
  for (int s = 0; s < mesh_fe_sets(mesh); s++) {
    char path[128];
    if (mesh->set[s].n == 0) continue;
    snprintf(path, sizeof path, "mesh/sets/%s", mesh_fe_set_name(mesh, s));
    SHB_TRY(h5_write_int(file, path,
                         H5_SHAPE((hsize_t)mesh->set[s].n, (hsize_t)topology->face_nodes),
                         mesh->set[s].nodes, "-", text));
  }
  return mesh->region ? export_regions(file, mesh) : SHB_OK;
}

shb_status modal_export_shapes(hid_t file, int n_modes, int n_nodes, const double *shape) {
  SHB_TRY(h5_write_double(file, "modes/shape", H5_SHAPE((hsize_t)n_modes, (hsize_t)n_nodes, 3),
                          shape, "kg^-1/2",
                          "mass-normalised mode shapes at every node, mesh axes (x, y, z)"));
  return h5_attach_scale(file, "modes/shape", 0, "modes/frequency");
}

shb_status modal_export_stress(hid_t file, int n_modes, int n_nodes, const float *stress) {
  SHB_TRY(h5_write_single(file, "modes/stress", H5_SHAPE((hsize_t)n_modes, (hsize_t)n_nodes, 6),
                          stress, "Pa kg^-1/2",
                          "Cauchy stress of the modes at the nodes: xx, yy, zz, xy, yz, xz in mesh "
                          "axes; to be multiplied by modal amplitudes"));
  return h5_attach_scale(file, "modes/stress", 0, "modes/frequency");
}

shb_status modal_export_check(hid_t file, const modal_check *check) {
  SHB_TRY(h5_write_attribute_text(file, "/modes", "checked", check->method));
  SHB_TRY(h5_write_attribute_int(file, "/modes", "checked_count", check->count));
  SHB_TRY(h5_write_attribute_double(file, "/modes", "checked_below", modal_check_frequency(check)));
  return h5_write_attribute_double(file, "/modes", "missed_chance", check->probability);
}

shb_status modal_export_turning(hid_t at, fem_turning turning) {
  if (turning == FEM_TURNS_UNSAID) return SHB_OK;
  return h5_write_attribute_text(at, "modes/coriolis", "rotor_turns",
                                 turning == FEM_TURNS_LEFT ? "left" : "right");
}

shb_status modal_export_contact(hid_t file, const modal_patches *patches) {
  if (patches->n_pairs == 0) return SHB_OK;
  const size_t pairs = (size_t)patches->n_pairs;
  const int    n = patches->start[patches->n_pairs], sides = patches->has_left ? 2 : 1;
  int         *nodes       = shb_alloc(3 * (size_t)n, sizeof *nodes);
  double      *coordinates = shb_alloc(6 * pairs, sizeof *coordinates);
  for (int p = 0; p < patches->n_pairs; p++)
    for (int e = patches->start[p]; e < patches->start[p + 1]; e++) {
      nodes[3 * e]     = p;
      nodes[3 * e + 1] = patches->node[0][e];
      nodes[3 * e + 2] = patches->has_left ? patches->node[1][e] : -1;
    }
  for (int side = 0; side < sides; side++)
    memcpy(coordinates + 3 * pairs * (size_t)side, patches->centroid[side],
           3 * pairs * sizeof *coordinates);
  shb_status status = h5_write_int(file, "contact/nodes", H5_SHAPE((hsize_t)n, 3), nodes, "-",
                                   "patch, right node, left node (-1: ground) of each entry");
  if (status == SHB_OK)
    status = h5_write_double(file, "contact/weight", H5_SHAPE((hsize_t)n), patches->weight, "-",
                             "share of each entry in its patch's mean displacement");
  if (status == SHB_OK && patches->projected)
    status = h5_write_double(
        file, "contact/left_weight", H5_SHAPE((hsize_t)n), patches->left_weight, "-",
        "the same of the left nodes: the faces do not match and are projected");
  if (status == SHB_OK)
    status =
        h5_write_double(file, "contact/coordinates", H5_SHAPE((hsize_t)sides, (hsize_t)pairs, 3),
                        coordinates, "m", "centroids of the patches, right then left, mesh axes");
  free(nodes);
  free(coordinates);
  return status;
}
