/* The settings of a stage change if, and only if, a key changes on which it depends. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "cases/schema/case.h"
#include "cases/schema/stage_settings.h"
#include "tests/support/scratch.h"

enum { ALL = CASE_MESH | CASE_MODAL | CASE_MHB | CASE_POST, N_STAGES = 3 };

#define COUNT(array) (sizeof(array) / sizeof *(array))

static const case_stage stages[N_STAGES] = {CASE_MESH, CASE_MODAL, CASE_MHB};

static void settings_of(const char *from, const char *to, char *settings[N_STAGES]) {
  char folder[SCRATCH_PATH], path[2 * SCRATCH_PATH], *text = scratch_case(from, to);
  scratch_create(folder);
  scratch_write(folder, "c.yaml", text, strlen(text));
  snprintf(path, sizeof path, "%s/c.yaml", folder);
  case_file file;
  if (case_read(path, ALL, stderr, &file) != SHB_OK) fail_msg("'%s' was refused", to);
  for (int i = 0; i < N_STAGES; i++) {
    settings[i] = case_settings(&file, stages[i]);
    assert_non_null(settings[i]);
  }
  case_free(&file);
  free(text);
  scratch_remove(folder);
}

static void only_what_matters(void **state) {
  (void)state;
  static const struct {
    const char *from, *to;
    int         stages; /* that change */
  } rows[] = {{"odd_blade", "other", 0},
              {"name: odd_blade", "# comment\nname: odd_blade", 0},
              {"207 GPa", "207e9", 0},
              {"[-20 N, 0, 0.3 kN]", "[-20, 0 N, 300 N]", 0},
              {"37 mm", "38 mm", CASE_MESH},
              {"20 deg", "21 deg", CASE_MESH},
              {"2.9 mm", "2.8 mm", CASE_MESH},
              {"shroud_size: 4 mm", "shroud_size: 3 mm", CASE_MESH},
              {"207 GPa", "207.0001 GPa", CASE_MODAL},
              {"rho: 7.85", "rho: 7.86", CASE_MODAL},
              {"blades: 37", "blades: 38", CASE_MESH | CASE_MODAL | CASE_MHB},
              {"2900 rpm", "2901 rpm", CASE_MODAL},
              {"-y", "y", CASE_MESH | CASE_MODAL},
              {"modes: 17", "modes: 18", CASE_MODAL},
              {"modes: 17", "modes: auto", CASE_MODAL},
              {"modes: 17", "modes: 17, nodal_diameters: auto", 0},
              {"modes: 17", "modes: 17, nodal_diameters: all", CASE_MODAL},
              {"modes: 17", "modes: 17, nodal_diameters: [0, 5]", CASE_MODAL},
              {"0.23 %", "0.24 %", CASE_MODAL},
              {"engine_order: 7", "engine_order: 8", CASE_MHB},
              {"210 Pa", "211 Pa", CASE_MODAL},
              {"pressure: 210 Pa", "traction: [210 Pa, 0, 0]", CASE_MODAL},
              {"pressure: 210 Pa", "force: {vector: [210 N, 0, 0]}", CASE_MODAL},
              {"90 deg", "91 deg", CASE_MODAL},
              {"mid:", "middle:", CASE_MODAL},
              {"tip: [1 mm", "tip: [1.1 mm", CASE_MODAL},
              {"neighbour", "ground", CASE_MODAL | CASE_MHB},
              {"35 deg", "36 deg", CASE_MESH | CASE_MODAL | CASE_MHB},
              {"  phi: -3 deg\n", "", CASE_MESH | CASE_MODAL | CASE_MHB},
              {"points: 4", "points: all", CASE_MODAL},
              {"0.31\n", "0.32\n", CASE_MHB},
              {"-70 kN", "-71 kN", CASE_MHB},
              {"kv: 0.8", "kv: 0.9", CASE_MHB},
              {"0.3 kN", "0.4 kN", CASE_MHB},
              {"interference", "equilibrium", CASE_MHB},
              {"0.12 kHz", "0.13 kHz", CASE_MHB},
              {"  harmonics: 7", "  harmonics: 8", CASE_MHB},
              {"subharmonics: 2", "subharmonics: 1", CASE_MHB},
              {"scale: 1.3", "scale: 1.4", CASE_MHB},
              {"2e-9", "1e-9", CASE_MHB},
              {"2e-9", "fast", CASE_MHB},
              {"2e-9", "0.002e-6", 0},
              {"777", "778", CASE_MHB},
              {"777", "777\n  flips: mark", CASE_MHB},
              {"777", "777\n  flips: follow", 0},
              {"777", "777\n  search: {starts: auto}", 0},
              {"777", "777\n  search: {starts: 0, orders: [2], at: [100]}", CASE_MHB},
              {"777", "777\n  search: {starts: 9}", CASE_MHB}};
  char *before[N_STAGES], *after[N_STAGES];
  settings_of(NULL, NULL, before);
  for (size_t row = 0; row < COUNT(rows); row++) {
    settings_of(rows[row].from, rows[row].to, after);
    for (int i = 0; i < N_STAGES; i++) {
      bool changed = strcmp(before[i], after[i]) != 0;
      if (changed != ((rows[row].stages & (int)stages[i]) != 0))
        fail_msg("'%s' for '%s': settings of stage %d %s\n%s", rows[row].to, rows[row].from,
                 stages[i], changed ? "changed" : "did not change", after[i]);
      free(after[i]);
    }
  }
  for (int i = 0; i < N_STAGES; i++) free(before[i]);
}

/* The places and orders of the search count only if there is a search. */
static void search_settings(void **state) {
  (void)state;
  static const char *const rows[][2] = {
      {"{starts: 9}", "mhb.search.starts = 9\nmhb.search.orders = 1 2 3\n"},
      {"{starts: 9, at: [100, 0.11 kHz], orders: [2, 5]}",
       "mhb.search.starts = 9\nmhb.search.at = 100 110\nmhb.search.orders = 2 5\n"}};
  for (size_t i = 0; i < COUNT(rows); i++) {
    char *settings[N_STAGES], text[128];
    snprintf(text, sizeof text, "777\n  search: %s", rows[i][0]);
    settings_of("777", text, settings);
    assert_non_null(strstr(settings[2], rows[i][1]));
    for (int k = 0; k < N_STAGES; k++) free(settings[k]);
  }
}

static void the_text_itself(void **state) {
  (void)state;
  char *settings[N_STAGES];
  settings_of(NULL, NULL, settings);
  assert_string_equal(settings[2],
                      "rotor.blades = 37\n"
                      "excitation.engine_order = 7\n"
                      "contact.to = neighbour\n"
                      "contact.psi = 0.6108652381980153\n"
                      "contact.phi = -0.05235987755982989\n"
                      "contact.mu = 0.31\n"
                      "contact.ku = 500000 -70000 600000\n"
                      "contact.kv = 800000\n"
                      "contact.n0 = -20 0 300\n"
                      "contact.preload = interference\n"
                      "contact.accuracy = 2e-09\n"
                      "mhb.frequency = 90 120\n"
                      "mhb.harmonics = 7\n"
                      "mhb.subharmonics = 2\n"
                      "mhb.scale = 1.3\n"
                      "mhb.max_points = 777\n"
                      "mhb.stability = always\n"
                      "mhb.lasting = auto\n"
                      "mhb.save = peaks\n"
                      "mhb.flips = follow\n"
                      "mhb.search.starts = auto\n");
  assert_non_null(strstr(settings[0], "mesh.blade.sections[1].thickness = 0.0029\n"));
  assert_non_null(strstr(settings[0], "contact.psi = 0.61086523819801"));
  assert_null(strstr(settings[0], "material"));
  assert_non_null(strstr(settings[1], "excitation.harmonics.1 = 1 0\n"));
  assert_non_null(strstr(settings[1], "probe.tip = 0.001 0.002 0.47\n"));
  assert_null(strstr(settings[1], "excitation.force"));
  for (int i = 0; i < N_STAGES; i++) free(settings[i]);
}

/* The working folder does not matter. */
static void paths_are_those_of_the_case(void **state) {
  (void)state;
  static const char text[] =
      "modal: {file: m.h5}\n"
      "contact: {to: ground, mu: 0.4, ku: 0.5, kv: 0.8, n0: 1}\n"
      "mhb: {frequency: [0.14, 0.25]}\n";
  char folder[SCRATCH_PATH], path[2 * SCRATCH_PATH];
  scratch_create(folder);
  scratch_write(folder, "m.h5", "x", 1);
  scratch_write(folder, "c.yaml", text, strlen(text));
  snprintf(path, sizeof path, "%s/c.yaml", folder);
  case_file file;
  assert_int_equal(case_read(path, ALL, stderr, &file), SHB_OK);
  char *settings = case_settings(&file, CASE_MHB);
  assert_ptr_equal(strstr(settings, "modal.file = m.h5\ncontact.to = ground\n"), settings);
  assert_null(strstr(settings, "blades"));
  free(settings);
  case_free(&file);
  scratch_remove(folder);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(only_what_matters), cmocka_unit_test(search_settings),
      cmocka_unit_test(the_text_itself), cmocka_unit_test(paths_are_those_of_the_case)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
