/* Settings of the modal stage with one material, one load and one contact interface. */
#ifndef TESTS_SUPPORT_ONE_OF_EACH_H
#define TESTS_SUPPORT_ONE_OF_EACH_H

#include "modal/stage/solve.h"
#include "tests/support/fem.h"

/* The settings with steel, the load and the usual contact faces. What they refer to is that of the
 * last call.
 *   load  in  kind pressure of 0: no load */
static inline modal_settings one_of_each(modal_settings s, int points, bool to_ground,
                                         fem_load load) {
  static modal_region  region;
  static modal_contact contact;
  static fem_load      only;
  region      = (modal_region){NULL, steel};
  contact     = (modal_contact){"", "contact_right", "contact_left", to_ground, points, NULL, NULL};
  only        = load;
  s.n_regions = 1;
  s.region    = &region;
  s.n_contacts = 1;
  s.contact    = &contact;
  s.n_loads    = 1;
  s.loads      = &only;
  return s;
}

#endif
