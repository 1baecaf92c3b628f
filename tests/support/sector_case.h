/* Settings of the modal stage for the sector of sector.h. */
#ifndef TESTS_SUPPORT_SECTOR_CASE_H
#define TESTS_SUPPORT_SECTOR_CASE_H

#include "modal/stage/stage.h"
#include "tests/support/fem.h"

static const modal_probe sector_probe[1] = {{"tip", {0.02, -0.03, 0.17}}};

/* All nodal diameters, one contact point, a pressure in the first harmonic. */
static inline modal_settings sector_case(int blades, int modes) {
  return (modal_settings){
      .material = steel,
      .axis     = MESH_AXIS_X,
      .blades   = blades,
      .modes    = modes,
      .damping  = {.ratio = 0.002},
      .load     = {.kind = FEM_LOAD_PRESSURE, .pressure = 2385, .n_harmonics = 1, .factor = {0, 1}},
      .n_probes = 1,
      .probe    = sector_probe,
      .points   = 1,
      .n_diameters = -1};
}

#endif
