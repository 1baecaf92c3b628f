/* The conditions under which keys are read: one row each. */
#ifndef CASES_PARSE_CONDITIONS_H
#define CASES_PARSE_CONDITIONS_H

#include <stdbool.h>

#include "cases/parse/case_file.h"

/* clang-format off */

/* ROW(name, test, words, needed)
 *   test    by file and by what the key belongs to: material, load, interface; own: the modes are
 *           computed here
 *   words   of the reference page; NULL: none
 *   needed  the message about a key that is given where it is not read; NULL: told elsewhere */
#define CASE_CONDITIONS(ROW)                                                                       \
  ROW(CASE_ALWAYS, true, NULL, NULL)                                                               \
  ROW(CASE_IF_BLADE, own && !file->mesh_file, "parametric blade", NULL)                            \
  ROW(CASE_IF_DISC, own && !file->mesh_file && file->has_disc, "with `mesh.blade.disc`", NULL)     \
  ROW(CASE_IF_MESH_FILE, own && file->mesh_file, "with `mesh.file`",                               \
      "only says something with mesh.file")                                                        \
  ROW(CASE_IF_SIZE, own && file->mesh_file &&                                                      \
      MESH_FORMAT_IS_SOLID(mesh_format_of(file->mesh_file)),                                       \
      "`mesh.file` is a solid", "only says something with mesh.file")                              \
  ROW(CASE_IF_OWN_MODES, own, "without `modal.file`", NULL)                                        \
  ROW(CASE_IF_MODAL_FILE, !own, "instead of `mesh`", NULL)                                         \
  ROW(CASE_IF_MATERIAL, own && !file->has_materials, "one material", NULL)                         \
  ROW(CASE_IF_MATERIALS, own && file->has_materials, "several materials", NULL)                    \
  ROW(CASE_IF_CRYSTAL, material->constants.G[0] != 0, "with `G`", NULL)                            \
  /* auto depends on the engine order: schema/nodal_diameters.h goes by what the file holds */     \
  ROW(CASE_IF_DIAMETERS, file->diameters.what != CASE_DIAMETERS_AUTO, "without `modal.file`",      \
      NULL)                                                                                        \
  ROW(CASE_IF_AUTO_MODES, own && file->modes == 0, "`modal.modes: auto`", NULL)                    \
  ROW(CASE_IF_INTERFACE, !file->has_interfaces, "one interface", NULL)                             \
  ROW(CASE_IF_POINTS, own && !file->has_interfaces, "one interface, without `modal.file`", NULL)   \
  ROW(CASE_IF_INTERFACES, file->has_interfaces, "several interfaces", NULL)                        \
  ROW(CASE_IF_PATCHES, own && case_points_are_auto(file), "`contact.points: auto`",                \
      "only says something with contact.points: auto")                                             \
  ROW(CASE_IF_PSI, interface->mhb.has_psi, NULL, NULL)                                             \
  ROW(CASE_IF_PHI, interface->mhb.has_phi, NULL, NULL)                                             \
  ROW(CASE_IF_VARIED, file->n_interfaces > 1 && file->mhb.parameter != MHB_IN_FREQUENCY &&         \
      file->mhb.parameter != MHB_IN_SCALE,                                                         \
      "several interfaces, with `mhb.vary`", NULL)                                                 \
  ROW(CASE_IF_ORDER, !file->mhb.to_ground || file->run_up,                                         \
      "contact to the neighbour, or a run-up", NULL)                                               \
  ROW(CASE_IF_RIGHT, file->mhb.turns_right, NULL, NULL)                                            \
  ROW(CASE_IF_RUN_UP, file->run_up, NULL, NULL)                                                    \
  ROW(CASE_IF_SECTOR, (own && !file->mesh_file) || !file->mhb.to_ground,                           \
      "contact to the neighbour, or parametric blade", NULL)                                       \
  ROW(CASE_IF_MISTUNED, file->mistuning.kind != CASE_TUNED, "blades that differ", NULL)            \
  ROW(CASE_IF_LOAD, own && !file->has_loads, "one load", NULL)                                     \
  ROW(CASE_IF_LOADS, own && file->has_loads, "several loads", NULL)                                \
  ROW(CASE_IF_PRESSURE, load->load.kind == FEM_LOAD_PRESSURE, "one of four loads", NULL)           \
  ROW(CASE_IF_TRACTION, load->load.kind == FEM_LOAD_TRACTION, "one of four loads", NULL)           \
  ROW(CASE_IF_FORCE, load->load.kind == FEM_LOAD_FORCE, "one of four loads", NULL)                 \
  ROW(CASE_IF_FORCE_AT, load->load.kind == FEM_LOAD_FORCE && load->load.has_at,                    \
      "with `force`", NULL)                                                                        \
  ROW(CASE_IF_FIELD, load->load.kind == FEM_LOAD_FIELD, "one of four loads", NULL)                 \
  ROW(CASE_IF_FACTORS, load->load.kind != FEM_LOAD_FIELD, "not with `field`", NULL)                \
  ROW(CASE_IF_OUTPUT, file->converge_output != NULL, NULL, NULL)                                   \
  ROW(CASE_IF_AUTO, file->mhb.harmonics == 0, "`mhb.harmonics: auto`", NULL)                       \
  ROW(CASE_IF_FOLLOWED, element == file->vary[file->mhb.parameter], "one of five", NULL)           \
  ROW(CASE_IF_TRACKED, file->mhb.track != MHB_TRACK_NOTHING, "`mhb.track` not `nothing`", NULL)    \
  ROW(CASE_IF_STABILITY, file->mhb.stability != MHB_STABILITY_NEVER,                               \
      "`mhb.stability` not `never`", "only says something with mhb.stability: auto or always")     \
  ROW(CASE_IF_SEARCH, file->mhb.search.starts > 0, "`mhb.search.starts` above 0",                  \
      "only says something with mhb.search.starts above 0")                                        \
  ROW(CASE_IF_SEARCH_AT, file->mhb.search.starts > 0 && file->mhb.search.n_at > 0,                 \
      "`mhb.search.starts` above 0", "only says something with mhb.search.starts above 0")         \
  ROW(CASE_IF_SWEEP, file->integrate.start == MHB_START_FROM_STATE,                                \
      "`integrate.start: state`", "only says something with integrate.start: state")               \
  ROW(CASE_IF_NOT_SCALED, file->mhb.parameter != MHB_IN_SCALE, "not with `mhb.vary.scale`",        \
      "leave it out: curves follow mhb.vary.scale instead")

/* clang-format on */

#define CASE_CONDITION_NAME(name, ...) name,
typedef enum { CASE_CONDITIONS(CASE_CONDITION_NAME) CASE_N_CONDITIONS } case_condition;

/* element: the material, load, interface or other part of the file that the key belongs to. */
bool case_condition_holds(case_condition condition, const case_file *file, const void *element);

/* In the words of the reference page; NULL: none. */
const char *case_condition_words(case_condition condition);

/* The message about a key that is given where the condition does not hold; NULL: none. */
const char *case_condition_needed(case_condition condition);

#endif
