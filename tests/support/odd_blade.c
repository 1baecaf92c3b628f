#include "tests/support/odd_blade.h"

#include "mesh/base/constants.h"

mesh_blade odd_blade(void) {
  const double degree = SHB_PI / 180;
  return (mesh_blade){.blades           = 43,
                      .axis             = MESH_AXIS_X,
                      .psi              = 35 * degree,
                      .root_length      = 0.066,
                      .root_width       = 0.033,
                      .root_height      = 0.017,
                      .n_sections       = 3,
                      .section          = {{0.25, 0.058, 0.0092, 0.0103, -11 * degree},
                                           {0.34, 0.051, 0.0071, 0.0071, -24 * degree},
                                           {0.43, 0.044, 0.0052, 0.0042, -38 * degree}},
                      .shroud_length    = 0.045,
                      .shroud_thickness = 0.0081,
                      .shroud_contact   = 0.021,
                      .size             = 0.011,
                      .shroud_size      = 0.007};
}
