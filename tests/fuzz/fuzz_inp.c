/* Meshes of Abaqus and CalculiX: elements that pass refer to nodes that exist. */
#include "mesh/io/inp_read.h"
#include "tests/fuzz/fuzz_file.h"

/* The length chooses whether its volume is asked for by name. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  mesh_fe    mesh       = {0};
  mesh_names names      = {.n_volumes = size % 2};
  names.volume[0].label = names.volume[0].name = "body";
  if (size > FUZZ_MOST) return 0;
  if (mesh_inp_read(fuzz_file("mesh.inp", data, size), &names, &mesh) == SHB_OK)
    for (int i = 0; i < mesh.n_elements * mesh_topology_of(mesh.kind)->nodes; i++)
      fuzz_assert(mesh.connectivity[i] >= 0 && mesh.connectivity[i] < mesh.n_nodes,
                  "an element that is accepted refers to no node");
  mesh_fe_free(&mesh);
  return 0;
}
