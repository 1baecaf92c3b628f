/* Settings of the modal stage for the sector of sector.h. */
#ifndef TESTS_SUPPORT_SECTOR_CASE_H
#define TESTS_SUPPORT_SECTOR_CASE_H

#include "modal/stage/stage.h"
#include "tests/support/one_of_each.h"

static const modal_probe sector_probe[1] = {{"tip", {0.02, -0.03, 0.17}}};

/* All nodal diameters, one contact point, a pressure in the first harmonic. */
static const fem_load sector_load = {
    .kind = FEM_LOAD_PRESSURE, .pressure = 2385, .n_harmonics = 1, .factor = {0, 1}};

static inline modal_settings sector_case(int blades, int modes) {
  const modal_settings own = {.axis        = MESH_AXIS_X,
                              .blades      = blades,
                              .modes       = modes,
                              .damping     = {.ratio = 0.002},
                              .n_probes    = 1,
                              .probe       = sector_probe,
                              .n_diameters = -1};
  return one_of_each(own, 1, false, sector_load);
}

#endif
