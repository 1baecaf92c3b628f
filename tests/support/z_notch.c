#include "tests/support/z_notch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "mesh/base/constants.h"
#include "mesh/blade/blade.h"
#include "tests/support/read_mesh.h"

static mesh_blade make_blade(mesh_kind kind, const z_notch_sizes *s) {
  const double       degree     = SHB_PI / 180;
  const mesh_section section[5] = {{.25, .058, .009, .011, -10 * degree},
                                   {.3, .054, .0076, .009, -19 * degree},
                                   {.35, .05, .0062, .007, -28 * degree},
                                   {.4, .047, .0051, .0054, -36 * degree},
                                   {.445, .045, .0044, .0042, -42 * degree}};
  mesh_blade         blade      = {.blades           = 40,
                                   .axis             = MESH_AXIS_X,
                                   .psi              = 35 * degree,
                                   .root_length      = .068,
                                   .root_width       = .035,
                                   .root_height      = .018,
                                   .n_sections       = 5,
                                   .shroud_length    = .046,
                                   .shroud_thickness = .007,
                                   .shroud_contact   = .024,
                                   .size             = 1e-3 * s->size,
                                   .shroud_size      = 1e-3 * s->shroud,
                                   .edge_size        = 1e-3 * s->edge,
                                   .elements         = kind};
  memcpy(blade.section, section, sizeof section);
  return blade;
}

shb_status z_notch_write(mesh_kind kind, const z_notch_sizes *sizes, const char *path) {
  const mesh_blade     blade      = make_blade(kind, sizes);
  const shb_provenance provenance = {"", "", "", "bench"};
  return mesh_blade_write(&blade, path, &provenance, NULL);
}

shb_status z_notch_disc_write(int blades, const z_notch_sizes *sizes, const char *path) {
  mesh_blade           blade      = make_blade(MESH_TET10, sizes);
  const shb_provenance provenance = {"", "", "", "bench"};
  blade.blades                    = blades;
  blade.root_width                = .033; /* between the sides of the disc */
  blade.disc_bore                 = .15;
  blade.disc_web                  = .02;
  blade.disc_rim                  = .03;
  return mesh_blade_write(&blade, path, &provenance, NULL);
}

shb_status z_notch_mesh(mesh_kind kind, const z_notch_sizes *sizes, mesh_fe *mesh) {
  char      path[] = "/tmp/shb_bench_XXXXXX.msh";
  const int handle = mkstemps(path, 4);
  SHB_CHECK(handle >= 0, SHB_ERR_IO, "%s: cannot be made", path);
  close(handle);
  shb_status status = z_notch_write(kind, sizes, path);
  if (status == SHB_OK) status = read_mesh(path, mesh);
  unlink(path);
  return status;
}
