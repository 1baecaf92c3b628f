/* Keys that are lists of mappings: materials by volumes, loads, interfaces. */
#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "cases/schema/case.h"
#include "cases/schema/case_paths.h"
#include "cases/schema/stage_settings.h"
#include "tests/support/scratch.h"

enum { ALL = CASE_MESH | CASE_MODAL | CASE_MHB };

static const char head[] =
    "mesh:\n"                                           /* 1 */
    "  file: b.msh\n"                                   /* 2 */
    "  groups: {airfoil: {nearest: [0, 1 mm, 0.4]}}\n"; /* 3 */

static const char materials[] =
    "materials:\n"                                                    /* 4 */
    "  - {group: root part, E: 207 GPa, nu: 0.29, rho: 7.85 g/cm3}\n" /* 5 */
    "  - {group: airfoil, E: 127 GPa, nu: 0.38, G: 120 GPa, rho: 8500, axis_1: [0, 0, "
    "2]}\n"; /* 6 */

static const char rest[] =
    "rotor: {axis: x}\n"
    "modal: {damping: 0.2 %}\n"
    "excitation: {pressure: 1 Pa}\n"
    "contact: {to: ground, mu: 0.4, ku: 0.5, kv: 0.8, n0: 1}\n"
    "mhb: {frequency: [0.14, 0.25]}\n";

/* *said is malloc'ed. */
static shb_status judge(const char *text, char **said, case_file *file) {
  char   folder[SCRATCH_PATH], path[2 * SCRATCH_PATH];
  size_t size = 0;
  scratch_create(folder);
  scratch_write(folder, "b.msh", "x", 1);
  scratch_write(folder, "c.yaml", text, strlen(text));
  snprintf(path, sizeof path, "%s/c.yaml", folder);
  FILE      *errors = open_memstream(said, &size);
  shb_status status = case_read(path, ALL, errors, file);
  fclose(errors);
  scratch_remove(folder);
  return status;
}

/* One change of the case, the first error without the file's name, and the number of errors. */
typedef struct {
  const char *from, *to, *says;
  int         n;
} fault;

static void check_faults(const char *whole, const fault *rows, size_t n) {
  for (size_t i = 0; i < n; i++) {
    char        text[4096], ending[32], *said;
    case_file   file;
    const char *at = strstr(whole, rows[i].from);
    assert_non_null(at);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - whole), whole, rows[i].to,
             at + strlen(rows[i].from));
    shb_status status = judge(text, &said, &file);
    if (status == SHB_OK) fail_msg("'%s' was taken", rows[i].to);
    snprintf(ending, sizeof ending, "\n%d error%s\n", rows[i].n, rows[i].n == 1 ? "" : "s");
    const char *first = strstr(said, "c.yaml:");
    if (!first || strncmp(first + 7, rows[i].says, strlen(rows[i].says)) != 0 ||
        !strstr(said, ending))
      fail_msg("expected %s and %sfound %s", rows[i].says, ending, said);
    free(said);
  }
}

static void materials_are_read(void **state) {
  (void)state;
  char      whole[2048], *said;
  case_file file;
  snprintf(whole, sizeof whole, "%s%s%s", head, materials, rest);
  if (judge(whole, &said, &file) != SHB_OK) fail_msg("%s", said);
  free(said);
  assert_int_equal(file.n_materials, 2);
  assert_string_equal(file.materials[0].group, "root part");
  const fem_material *steel = &file.materials[0].material, *crystal = &file.materials[1].material;
  assert_true(steel->E == 207e9 && steel->nu == .29 && fabs(steel->rho - 7850) < 1e-9);
  assert_true(!steel->anisotropic && crystal->anisotropic && crystal->rho == 8500);
  assert_true(file.source.rules.n_volumes == 2 && file.source.rules.n_more == 0);
  assert_int_equal(file.source.rules.volume[0].rule.kind, MESH_RULE_NONE);
  assert_int_equal(file.source.rules.volume[1].rule.kind, MESH_RULE_NEAREST);
  assert_true(case_mesh_is_made(&file));
  char *mesh = case_settings(&file, CASE_MESH), *modal = case_settings(&file, CASE_MODAL);
  assert_non_null(strstr(mesh, "mesh.groups.airfoil = nearest 0 0.001"));
  assert_non_null(strstr(mesh, "materials[1].group = airfoil\n"));
  assert_null(strstr(mesh, "materials[1].E"));
  assert_non_null(strstr(modal, "materials[1].G = 120000000000\n"));
  assert_null(strstr(modal, "material.E"));
  free(mesh);
  free(modal);
  case_free(&file);
}

static void faults_of_materials(void **state) {
  (void)state;
  static const fault rows[] = {
      {", rho: 8500", "", "6:5: error: materials[1].rho: missing; expected a number in kg/m3\n", 1},
      {"E: 127", "Y: 127", "6:5: error: materials[1].E: missing; expected a number or three", 2},
      {"nu: 0.38", "nu: 0.58", "6:38: error: materials[1].nu: is 0.58, must be above -1", 1},
      {", G: 120 GPa", "",
       "6:5: error: materials[1].G: missing; without it the material is isotropic", 1},
      {"nu: 0.38, G: 120 GPa", "nu: [0.9, 0.9, 0.9], G: 120 GPa",
       "6:58: error: materials[1].G: E, nu and G are those of no stable material", 1},
      {"group: root part", "group: airfoil",
       "6:13: error: materials[1].group: 'airfoil' has a material already\n", 1},
      {"group: airfoil", "group: air",
       "3:12: error: mesh.groups.airfoil: unknown group; known are root, ", 1},
      {"group: airfoil", "group: a/b",
       "6:13: error: materials[1].group: 'a/b' cannot be the name of a group", 1},
      {"nearest: [0, 1 mm, 0.4]", "radius: 1 mm",
       "3:12: error: mesh.groups.airfoil: is a volume (materials names it); expected", 1},
      {"materials:\n", "material: {E: 1 GPa, nu: 0, rho: 1000}\nmaterials:\n",
       "6:3: error: materials: give either material or materials, not both\n", 1},
      {"materials:\n", "materials: []\nname: x\nprobe:\n",
       "4:12: error: materials: has 0 materials, must have 1 to 16\n", 2},
  };
  char whole[2048];
  snprintf(whole, sizeof whole, "%s%s%s", head, materials, rest);
  check_faults(whole, rows, sizeof rows / sizeof *rows);
}

static const char loads[] =
    "mesh:\n"                                                                          /* 1 */
    "  file: b.msh\n"                                                                  /* 2 */
    "  groups: {suction: {name: S}}\n"                                                 /* 3 */
    "material: {E: 1 GPa, nu: 0, rho: 1000}\n"                                         /* 4 */
    "rotor: {axis: x}\n"                                                               /* 5 */
    "modal: {damping: 0.2 %}\n"                                                        /* 6 */
    "excitation:\n"                                                                    /* 7 */
    "  loads:\n"                                                                       /* 8 */
    "    - {pressure: 210 Pa, harmonics: {1: [1, 0 deg], 2: [0.5, 90 deg]}}\n"         /* 9 */
    "    - {pressure: -90 Pa, group: suction}\n"                                       /* 10 */
    "    - {force: {at: [0, 0, 1 mm], vector: [5 N, 0, 0]}, harmonics: {0: [1, 0]}}\n" /* 11 */
    "contact: {to: ground, mu: 0.4, ku: 0.5, kv: 0.8, n0: 1}\n"                        /* 12 */
    "mhb: {frequency: [0.14, 0.25], harmonics: 2}\n";                                  /* 13 */

static void loads_are_read(void **state) {
  (void)state;
  char     *said;
  case_file file;
  if (judge(loads, &said, &file) != SHB_OK) fail_msg("%s", said);
  free(said);
  assert_int_equal(file.n_loads, 3);
  const fem_load *a = &file.loads[0].load, *b = &file.loads[1].load, *c = &file.loads[2].load;
  assert_true(a->kind == FEM_LOAD_PRESSURE && a->pressure == 210 && a->n_harmonics == 2);
  assert_true(cabs(a->factor[2] - .5 * I) < 1e-15 && a->factor[1] == 1);
  assert_true(b->pressure == -90 && b->n_harmonics == 1 && b->factor[1] == 1);
  assert_string_equal(a->group, "load");
  assert_string_equal(b->group, "suction");
  assert_true(c->kind == FEM_LOAD_FORCE && c->has_at && c->at[2] == .001 && c->force[0] == 5);
  assert_true(c->n_harmonics == 0 && c->factor[0] == 1);
  assert_int_equal(file.source.rules.n_more, 1);
  assert_string_equal(file.source.rules.more[0].name, "suction");
  assert_string_equal(file.source.rules.more[0].rule.name, "S");
  char *mesh = case_settings(&file, CASE_MESH), *modal = case_settings(&file, CASE_MODAL);
  assert_non_null(strstr(mesh, "excitation.loads[1].group = suction\n"));
  assert_null(strstr(mesh, "pressure"));
  assert_non_null(strstr(modal, "excitation.loads[0].harmonics.2 = "));
  assert_non_null(strstr(modal, "excitation.loads[2].force.vector = 5 0 0\n"));
  assert_null(strstr(modal, "excitation.pressure"));
  free(mesh);
  free(modal);
  case_free(&file);
}

static void faults_of_loads(void **state) {
  (void)state;
  static const fault rows[] = {
      {"pressure: 210 Pa", "presure: 210 Pa",
       "9:8: error: excitation.loads[0].presure: unknown key; did you mean 'pressure'?\n", 1},
      {"pressure: 210 Pa, ", "",
       "9:7: error: excitation.loads[0]: missing; expected one of pressure, traction, force and "
       "field\n",
       1},
      {"pressure: 210 Pa", "pressure: 210 Pa, traction: [1, 0, 0]",
       "9:36: error: excitation.loads[0].traction: give only one of", 1},
      {"-90 Pa", "0 Pa", "10:18: error: excitation.loads[1].pressure: is 0; nothing would move\n",
       1},
      {"at: [0, 0, 1 mm], ", "",
       "11:24: error: excitation.loads[2].force.vector: has no place to act", 1},
      {", vector: [5 N, 0, 0]", "",
       "11:15: error: excitation.loads[2].force.vector: missing; expected [x, y, z] in N\n", 1},
      {"vector: [5 N, 0, 0]", "vektor: [5 N, 0, 0]",
       "11:34: error: excitation.loads[2].force.vektor: unknown key; did you mean 'vector'?", 1},
      {"harmonics: 2}", "harmonics: 1}",
       "9:37: error: excitation.loads[0].harmonics: harmonic 2 would be left out", 1},
      {"  loads:\n", "  pressure: 3 Pa\n  loads:\n",
       "8:13: error: excitation.pressure: put it into excitation.loads", 1},
      {"group: suction", "group: load",
       "3:12: error: mesh.groups.suction: unknown group; known are root", 1},
      {"pressure: -90 Pa", "field: none.h5", "10:15: error: excitation.loads[1].field: ", 1},
  };
  check_faults(loads, rows, sizeof rows / sizeof *rows);
}

static const char faces[] =
    "mesh: {file: b.msh}\n"                                            /* 1 */
    "material: {E: 1 GPa, nu: 0, rho: 1000}\n"                         /* 2 */
    "rotor: {axis: x, blades: 30}\n"                                   /* 3 */
    "modal: {damping: 0.2 %}\n"                                        /* 4 */
    "excitation: {engine_order: 3, pressure: 1 Pa}\n"                  /* 5 */
    "contact:\n"                                                       /* 6 */
    "  accuracy: fast\n"                                               /* 7 */
    "  interfaces:\n"                                                  /* 8 */
    "    - {name: shroud, mu: 0.3, ku: 2, kv: 3, n0: 20, points: 4}\n" /* 9 */
    "    - {name: mid, right: mr, left: ml, mu: 0.1, ku: [1, 0, 2], kv: 2, n0: [-1, 50], psi: 5 "
    "deg}\n"                                          /* 10 */
    "mhb: {frequency: [0.14, 0.25], harmonics: 2}\n"; /* 11 */

static void interfaces_are_read(void **state) {
  (void)state;
  char     *said;
  case_file file;
  if (judge(faces, &said, &file) != SHB_OK) fail_msg("%s", said);
  free(said);
  const mhb_settings *mhb = &file.mhb;
  assert_true(mhb->n_interfaces == 2 && mhb->lead == 1 && !mhb->together); /* the one with a list */
  assert_string_equal(mhb->interface[0].name, "shroud");
  assert_true(mhb->interface[0].mu == .3 && mhb->interface[0].n_preloads == 1);
  assert_true(mhb->mu == .1 && mhb->ku[2] == 2 && mhb->n_preloads == 2 && mhb->n0[1] == 50);
  assert_true(mhb->interface[1].has_psi && !mhb->interface[0].has_psi);
  assert_true(file.interfaces[0].points == 4 && file.interfaces[1].points == 1);
  assert_string_equal(file.interfaces[0].left, "contact_left");
  assert_int_equal(file.source.rules.n_more, 2);
  assert_string_equal(file.source.rules.more[1].name, "ml");
  char *balance = case_settings(&file, CASE_MHB), *modal = case_settings(&file, CASE_MODAL);
  assert_non_null(strstr(balance, "contact.interfaces[1].n0 = -1 50\n"));
  assert_non_null(strstr(balance, "contact.interfaces[0].name = shroud\n"));
  assert_null(strstr(balance, "contact.mu"));
  assert_null(strstr(balance, "right"));
  assert_non_null(strstr(modal, "contact.interfaces[1].right = mr\n"));
  assert_null(strstr(modal, "].mu"));
  free(balance);
  free(modal);
  case_free(&file);
}

static const char own_modes[] =
    "modal: {file: b.msh}\n"                                                               /* 1 */
    "contact: {psi: 0, to: ground, interfaces: [{name: a, mu: 1, ku: 2, kv: 1, n0: 1}]}\n" /* 2 */
    "mhb: {frequency: [0.14, 0.25]}\n";                                                    /* 3 */

/* A key that both the modal file and the list leave no room for gets one remedy. */
static void a_fault_has_one_remedy(void **state) {
  (void)state;
  static const fault rows[] = {
      {"{psi: 0, ", "{psi: 0, ", "2:16: error: contact.psi: put it into contact.interfaces", 1}};
  check_faults(own_modes, rows, 1);
}

static void faults_of_interfaces(void **state) {
  (void)state;
  static const fault rows[] = {
      {", n0: 20", "", "9:7: error: contact.interfaces[0].n0: missing; expected a number, a list",
       1},
      {"n0: 20", "n0: [1, 2, 3]",
       "10:75: error: contact.interfaces[1].n0: has 2 preloads, shroud has 3; lists must be", 1},
      {"[-1, 50]", "[50, 50]", "10:75: error: contact.interfaces[1].n0: has 50 N twice", 1},
      {"name: mid", "name: shroud",
       "10:14: error: contact.interfaces[1].name: there is another one of that name\n", 1},
      {", left: ml", "",
       "10:7: error: contact.interfaces[1].left: its group is one of another interface", 1},
      {"left: ml", "left: mr",
       "10:36: error: contact.interfaces[1].left: is the group of its right face\n", 1},
      {"  accuracy: fast\n", "  mu: 0.2\n",
       "7:7: error: contact.mu: put it into contact.interfaces", 1},
      {"{file: b.msh}", "{file: b.msh, groups: {mx: {name: a}}}",
       "1:30: error: mesh.groups.mx: unknown group", 1},
      {"harmonics: 2}", "harmonics: 2, vary: {interface: all}}",
       "11:64: error: mhb.vary.interface: only says something with", 1},
      {"[0.14, 0.25]", "0.2, vary: {n0: [1, 2], interface: tip}",
       "10:75: error: contact.interfaces[1].n0: must be one number", 2},
      {"mu: 0.3", "mu: -0.3", "9:26: error: contact.interfaces[0].mu: is -0.3, must be 0 to", 1},
      {"name: mid", "name: mid, to: ground",
       "10:23: error: contact.interfaces[1].to: is ground, that of shroud is neighbour", 1},
      {"name: mid", "name: mid, to: sector",
       "10:23: error: contact.interfaces[1].to: 'sector' is not known; expected one of neighbour",
       1},
      {"points: 4", "points: auto",
       "10:7: error: contact.interfaces[1].points: is a number, that of shroud is auto", 1},
      {"  accuracy: fast\n", "  tolerance: 1e-4\n",
       "7:14: error: contact.tolerance: only says something with contact.points: auto", 1},
  };
  check_faults(faces, rows, sizeof rows / sizeof *rows);
}

/* Each interface has all keys of its own. A list of one is as the block of the only one. */
static void keys_of_each_interface(void **state) {
  (void)state;
  static const char rest_of_it[] =
      "material: {E: 1 GPa, nu: 0, rho: 1000}\n"
      "rotor: {axis: x, blades: 30}\n"
      "modal: {damping: 0.2 %}\n"
      "excitation: {pressure: 1 Pa, harmonics: {2: [1, 0]}}\n"
      "mhb: {frequency: [0.14, 0.25], harmonics: 2}\n"
      "mesh: {file: b.msh}\n";
  static const char *const contact[] = {
      "contact: {to: ground, mu: 0.3, ku: 2, kv: 3, n0: [20, 30], points: auto, psi: 5 deg}\n",
      "contact: {interfaces: [{name: casing, to: ground, mu: 0.3, ku: 2, kv: 3, n0: [20, 30], "
      "points: auto, psi: 5 deg}]}\n",
      "contact: {to: ground, interfaces: [{name: casing, mu: 0.3, ku: 2, kv: 3, n0: [20, 30], "
      "points: auto, psi: 5 deg}]}\n"};
  for (int i = 0; i < 3; i++) {
    char      whole[2048], *said;
    case_file file;
    snprintf(whole, sizeof whole, "%s%s", rest_of_it, contact[i]);
    if (judge(whole, &said, &file) != SHB_OK) fail_msg("%s", said);
    free(said);
    const mhb_settings  *mhb = &file.mhb;
    const mhb_interface *own = &mhb->interface[0];
    assert_int_equal(mhb->n_interfaces, 1);
    assert_string_equal(own->name, i ? "casing" : "");
    assert_true(mhb->to_ground && own->to_ground && own->has_psi && mhb->has_psi);
    assert_true(mhb->mu == .3 && mhb->kv == 3 && mhb->n_preloads == 2 && mhb->n0[1] == 30);
    assert_true(case_points_are_auto(&file));
    assert_string_equal(file.interfaces[0].right, "contact_right");
    assert_string_equal(file.source.contact[0].right, "contact_right");
    assert_int_equal(file.source.n_contacts, 1);
    /* the load has harmonic 2 and no trace of the default, harmonic 1 */
    assert_true(file.n_loads == 1 && file.loads[0].load.n_harmonics == 2);
    assert_true(file.loads[0].load.factor[1] == 0 && file.loads[0].load.factor[2] == 1);
    case_free(&file);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(keys_of_each_interface), cmocka_unit_test(materials_are_read),
      cmocka_unit_test(faults_of_materials),    cmocka_unit_test(loads_are_read),
      cmocka_unit_test(faults_of_loads),        cmocka_unit_test(interfaces_are_read),
      cmocka_unit_test(faults_of_interfaces),   cmocka_unit_test(a_fault_has_one_remedy),
  };
  return cmocka_run_group_tests_name("cases.lists", tests, NULL, NULL);
}
