#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "cases/schema/case.h"
#include "cases/schema/case_paths.h"
#include "cases/schema/stage_settings.h"
#include "mesh/base/constants.h"
#include "tests/support/scratch.h"

enum { ALL = CASE_MESH | CASE_MODAL | CASE_MHB | CASE_POST };

static const double degree = SHB_PI / 180;

static bool near(double a, double b) {
  return fabs(a - b) <= 1e-15 * fabs(b);
}

/* Reads text as folder/name; returns the status and the printed text (malloc'ed). */
static shb_status read_text(const char *folder, const char *name, const char *text, case_file *file,
                            char **said) {
  char   path[2 * SCRATCH_PATH];
  size_t size = 0;
  snprintf(path, sizeof path, "%s/%s", folder, name);
  scratch_write(folder, name, text, strlen(text));
  FILE *errors = open_memstream(said, &size);
  assert_non_null(errors);
  shb_status status = case_read(path, ALL, errors, file);
  fclose(errors);
  return status;
}

static void every_value_arrives(void **state) {
  (void)state;
  char folder[SCRATCH_PATH], *said, *text = scratch_case(NULL, NULL);
  scratch_create(folder);
  case_file f;
  assert_int_equal(read_text(folder, "x.yaml", text, &f, &said), SHB_OK);
  assert_string_equal(said, "");
  assert_string_equal(f.text, text);
  assert_string_equal(f.name, "odd_blade");
  assert_string_equal(f.folder, folder);
  assert_true(f.has_mesh && !f.mesh_file && !f.modal_file);
  const mesh_blade *b = &f.blade;
  assert_true(b->root_length == 0.061 && b->root_width == 0.043 && b->root_height == 0.019);
  assert_int_equal(b->n_sections, 2);
  assert_true(b->section[0].radius == 0.31 && b->section[0].chord == 0.053);
  assert_true(b->section[0].camber == 0.003 && near(b->section[0].twist, 20 * degree));
  assert_true(b->section[1].radius == 0.47 && b->section[1].thickness == 0.0029);
  assert_true(b->section[1].camber == 0 && b->section[1].twist == 0);
  assert_true(b->shroud_length == 0.037 && b->shroud_thickness == 0.0061 &&
              b->shroud_contact == 0.023);
  assert_true(b->size == 0.008 && b->shroud_size == 0.004 && b->elements == MESH_HEX20);
  assert_true(b->blades == 37 && b->axis == MESH_AXIS_MY);
  assert_true(near(b->psi, 35 * degree) && near(b->phi, -3 * degree));
  assert_true(f.materials[0].material.E == 207e9 && f.materials[0].material.nu == 0.29 &&
              f.materials[0].material.rho == 7850);
  assert_true(f.blades == 37 && f.axis == MESH_AXIS_MY && near(f.speed[0], 2900 * 6 * degree));
  assert_true(f.modes == 17 && f.damping.ratio == 0.0023);
  assert_true(f.engine_order == 7 && f.loads[0].load.kind == FEM_LOAD_PRESSURE &&
              f.loads[0].load.pressure == 210);
  assert_int_equal(f.loads[0].load.n_harmonics, 3);
  assert_true(f.loads[0].load.factor[0] == 0 && f.loads[0].load.factor[1] == 1 &&
              f.loads[0].load.factor[2] == 0);
  assert_true(cabs(f.loads[0].load.factor[3] - 0.21 * I) < 1e-16);
  assert_int_equal(f.n_probes, 2);
  assert_string_equal(f.probe[0].name, "tip");
  assert_true(f.probe[0].at[0] == 0.001 && f.probe[0].at[1] == 0.002 && f.probe[0].at[2] == 0.47);
  assert_string_equal(f.probe[1].name, "mid");
  assert_int_equal(f.interfaces[0].points, 4);
  const mhb_settings *m = &f.mhb;
  assert_true(!m->to_ground && m->engine_order == 7 && m->blades == 37 && m->has_psi && m->has_phi);
  assert_true(near(m->psi, 35 * degree) && near(m->phi, -3 * degree));
  assert_true(m->mu == 0.31 && m->kv == 0.8e6 && m->preload == MHB_INTERFERENCE);
  assert_true(m->ku[0] == 0.5e6 && m->ku[1] == -70e3 && m->ku[2] == 0.6e6);
  assert_int_equal(m->n_preloads, 3);
  assert_true(m->n0[0] == -20 && m->n0[1] == 0 && m->n0[2] == 300);
  assert_true(m->frequency[0] == 90 && m->frequency[1] == 120);
  assert_true(m->harmonics == 7 && m->subharmonics == 2 && m->scale == 1.3);
  assert_true(m->tolerance == 2e-9 && m->max_points == 777);
  assert_int_equal(m->stability, MHB_STABILITY_ALWAYS);
  char *output = case_output(&f, ".modal.h5"), wanted[2 * SCRATCH_PATH];
  snprintf(wanted, sizeof wanted, "%s/odd_blade.modal.h5", folder);
  assert_string_equal(output, wanted);
  free(output);
  case_free(&f);
  free(said);
  free(text);
  scratch_remove(folder);
}

/* The tolerance belongs to auto: 1e-4 by default, and nothing with a number of harmonics. */
static void automatic_harmonics(void **state) {
  (void)state;
  static const struct {
    const char *text;
    int         harmonics;
    double      tolerance;
  } rows[] = {{"harmonics: auto", 0, 1e-4},
              {"harmonics: auto\n  tolerance: 0.02 %", 0, 2e-4},
              {"harmonics: 6", 6, 0}};
  char folder[SCRATCH_PATH], *said;
  scratch_create(folder);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char     *text = scratch_case("harmonics: 7", rows[i].text);
    case_file f;
    assert_int_equal(read_text(folder, "c.yaml", text, &f, &said), SHB_OK);
    assert_int_equal(f.mhb.harmonics, rows[i].harmonics);
    assert_true(f.mhb.motion_tolerance == rows[i].tolerance);
    char *settings = case_settings(&f, CASE_MHB);
    assert_int_equal(strstr(settings, "mhb.tolerance = ") != NULL, rows[i].harmonics == 0);
    assert_int_equal(strstr(settings, "mhb.harmonics = auto") != NULL, rows[i].harmonics == 0);
    free(settings);
    case_free(&f);
    free(said);
    free(text);
  }
  scratch_remove(folder);
}

static void accuracy_in_words(void **state) {
  (void)state;
  static const struct {
    const char *text;
    double      tolerance;
  } rows[] = {{"fast", 1e-3}, {"balanced", 1e-5}, {"exact", 1e-8}, {"1e-14", 1e-14}, {"0.01", .01}};
  char folder[SCRATCH_PATH], *said;
  scratch_create(folder);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char     *text = scratch_case("2e-9", rows[i].text);
    case_file f;
    assert_int_equal(read_text(folder, "c.yaml", text, &f, &said), SHB_OK);
    assert_true(f.mhb.tolerance == rows[i].tolerance);
    case_free(&f);
    free(said);
    free(text);
  }
  scratch_remove(folder);
}

static const char least[] =
    "modal: {file: sub/other.modal.h5}\n"
    "contact: {to: ground, mu: 0.4, ku: 0.5, kv: 0.8, n0: {from: -0.2, to: 1, points: 4}}\n"
    "mhb: {frequency: [0.14, 0.25]}\n";

static void a_modal_file_needs_little(void **state) {
  (void)state;
  char folder[SCRATCH_PATH], sub[SCRATCH_PATH + 8], *said;
  scratch_create(folder);
  snprintf(sub, sizeof sub, "%s/sub", folder);
  assert_int_equal(mkdir(sub, 0700), 0);
  scratch_write(sub, "other.modal.h5", "x", 1);
  case_file f;
  assert_int_equal(read_text(folder, "three degrees.yaml", least, &f, &said), SHB_OK);
  assert_string_equal(f.name, "three degrees");
  char wanted[2 * SCRATCH_PATH];
  snprintf(wanted, sizeof wanted, "%s/other.modal.h5", sub);
  assert_string_equal(f.modal_file, wanted);
  char *path = case_modal_path(&f);
  assert_string_equal(path, wanted);
  free(path);
  assert_true(f.mhb.to_ground && !f.mhb.has_psi && !f.mhb.has_phi && f.mhb.engine_order == 0);
  assert_true(f.mhb.ku[0] == 0.5 && f.mhb.ku[1] == 0 && f.mhb.ku[2] == 0.5);
  static const double n0[] = {-0.2, 0.2, 0.6, 1};
  assert_int_equal(f.mhb.n_preloads, 4);
  for (int i = 0; i < 4; i++) assert_true(fabs(f.mhb.n0[i] - n0[i]) < 1e-15);
  assert_true(f.mhb.n0[0] == -0.2 && f.mhb.n0[3] == 1);
  /* defaults */
  assert_true(f.mhb.harmonics == 3 && f.mhb.subharmonics == 1 && f.mhb.scale == 1);
  assert_true(f.mhb.tolerance == 1e-8 && f.mhb.max_points == 20000 && f.interfaces[0].points == 1);
  assert_int_equal(f.mhb.stability, MHB_STABILITY_AUTO);
  assert_true(f.mhb.flips && f.mhb.search.starts == MHB_SEARCH_PEAKS && f.mhb.search.n_at == 0);
  assert_true(f.mhb.search.n_orders == 3 && f.mhb.search.order[2] == 3);
  assert_true(f.mhb.preload == MHB_EQUILIBRIUM && f.loads[0].load.factor[1] == 1 &&
              f.loads[0].load.n_harmonics == 1);
  case_free(&f);
  free(said);
  /* the neighbour needs the inter-blade phase */
  char text[sizeof least];
  snprintf(text, sizeof text, "%s", least);
  memcpy(strstr(text, "to: ground,"), "           ", 11);
  assert_int_equal(read_text(folder, "y.yaml", text, &f, &said), SHB_ERR_INPUT);
  assert_non_null(strstr(said, "error: rotor: missing; expected a mapping with blades"));
  assert_non_null(strstr(said, "error: excitation: missing; expected a mapping with engine_order"));
  assert_non_null(strstr(said, "\n2 errors\n"));
  free(said);
  scratch_remove(sub);
  scratch_remove(folder);
}

/* A stage requires its own keys only, but all keys given must be valid. */
static void stages_ask_for_their_own(void **state) {
  (void)state;
  static const char mesh_only[] =
      "mesh: {blade: {root: {length: 61 mm, width: 43 mm, height: 19 mm}, size: 8 mm,\n"
      "  sections: [{radius: 0.3, chord: 5 cm, thickness: 5 mm}, {radius: 0.4, chord: 5 cm, "
      "thickness: 3 mm}],\n"
      "  shroud: {length: 37 mm, thickness: 6 mm, contact: 23 mm}}}\n"
      "rotor: {blades: 37}\n";
  char   folder[SCRATCH_PATH], path[2 * SCRATCH_PATH], *said = NULL;
  size_t size = 0;
  scratch_create(folder);
  scratch_write(folder, "case.yaml", mesh_only, strlen(mesh_only));
  snprintf(path, sizeof path, "%s/case.yaml", folder);
  case_file f;
  assert_int_equal(case_read(path, CASE_MESH, stderr, &f), SHB_OK);
  /* case.yaml takes the name of its folder */
  assert_string_equal(f.name, strrchr(folder, '/') + 1);
  case_free(&f);
  FILE *errors = open_memstream(&said, &size);
  assert_int_equal(case_read(path, CASE_MESH | CASE_MODAL, errors, &f), SHB_ERR_INPUT);
  fclose(errors);
  assert_non_null(strstr(said, "error: material: missing"));
  assert_null(strstr(said, "mhb"));
  free(said);
  scratch_remove(folder);
}

static void forces_and_tractions(void **state) {
  (void)state;
  char folder[SCRATCH_PATH], *said;
  scratch_create(folder);
  case_file f;
  char     *text =
      scratch_case("pressure: 210 Pa", "force: {at: [1 mm, 0, 0.4], vector: [5 N, -1 kN, 0]}");
  assert_int_equal(read_text(folder, "x.yaml", text, &f, &said), SHB_OK);
  assert_true(f.loads[0].load.kind == FEM_LOAD_FORCE && f.loads[0].load.has_at &&
              f.loads[0].load.at[0] == 0.001);
  assert_true(f.loads[0].load.force[0] == 5 && f.loads[0].load.force[1] == -1000);
  case_free(&f);
  free(said);
  free(text);
  text =
      scratch_case("pressure: 210 Pa", "force: {vector: [5 N, 1 N, 0]}"); /* at the first probe */
  assert_int_equal(read_text(folder, "x.yaml", text, &f, &said), SHB_OK);
  assert_true(f.loads[0].load.kind == FEM_LOAD_FORCE && !f.loads[0].load.has_at);
  case_free(&f);
  free(said);
  free(text);
  text = scratch_case("pressure: 210 Pa", "traction: [0, 3 kPa, -1 kPa]");
  assert_int_equal(read_text(folder, "x.yaml", text, &f, &said), SHB_OK);
  assert_true(f.loads[0].load.kind == FEM_LOAD_TRACTION && f.loads[0].load.traction[1] == 3000);
  case_free(&f);
  free(said);
  free(text);
  text = scratch_case("points: 4", "points: all");
  assert_int_equal(read_text(folder, "x.yaml", text, &f, &said), SHB_OK);
  assert_int_equal(f.interfaces[0].points, 0);
  case_free(&f);
  free(said);
  free(text);
  scratch_remove(folder);
}

static void values_of_several_forms(void **state) {
  (void)state;
  static const char DAMPING[] = "damping: 0.23 %", SPEED[] = "2900 rpm";
  static const struct {
    const char *old, *text, *setting;
  } rows[] = {
      {SPEED, "2900 rpm, coriolis: yes", "rotor.coriolis = left\n"},
      {SPEED, "2900 rpm, turns: right, coriolis: yes", "rotor.coriolis = right\n"},
      {SPEED, "2900 rpm, turns: right", "rotor.coriolis = no\n"},
      {DAMPING, "damping: 0.25 %", "modal.damping = 0.0025\n"},
      {DAMPING, "damping: [0.125, 0.25 %, 0.5]", "modal.damping = 0.125 0.0025 0.5\n"},
      {DAMPING, "damping: {loss_factor: 0.25}", "modal.damping = loss_factor 0.25\n"},
      {DAMPING, "damping: {rayleigh: [12.5, 0.25 s]}", "modal.damping = rayleigh 12.5 0.25\n"},
  };
  char folder[SCRATCH_PATH], *said;
  scratch_create(folder);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    case_file f;
    char     *text = scratch_case(rows[i].old, rows[i].text);
    assert_int_equal(read_text(folder, "x.yaml", text, &f, &said), SHB_OK);
    char *settings = case_settings(&f, CASE_MODAL);
    if (!strstr(settings, rows[i].setting)) fail_msg("no %s in %s", rows[i].setting, settings);
    free(settings), free(said), free(text);
    case_free(&f);
  }
  scratch_remove(folder);
}

/* Single crystals: constants along the axes and their stiffness. Without G nothing changes. */
static void materials_with_axes(void **state) {
  (void)state;
  char folder[SCRATCH_PATH], *said, *settings;
  scratch_create(folder);
  case_file f;
  char     *text = scratch_case("E: 207 GPa", "E: 127 GPa, G: 120 GPa, axis_1: [1, 1, 0]");
  assert_int_equal(read_text(folder, "x.yaml", text, &f, &said), SHB_OK);
  assert_true(f.materials[0].material.anisotropic && f.materials[0].material.rho == 7850);
  double S11 = 1 / 127e9, S12 = -.29 / 127e9, C44 = 120e9;
  double C11 = (S11 + S12) / ((S11 - S12) * (S11 + 2 * S12)),
         C12 = -S12 / ((S11 - S12) * (S11 + 2 * S12)); /* turned by 45 deg about axis 3 */
  assert_true(fabs(f.materials[0].material.C[0][0] / ((C11 + C12) / 2 + C44) - 1) < 1e-12);
  assert_true(fabs(f.materials[0].material.C[2][2] / C11 - 1) < 1e-12);
  settings = case_settings(&f, CASE_MODAL);
  assert_non_null(strstr(settings, "material.E = 127000000000\n"));
  assert_non_null(strstr(settings, "material.axis_1 = 1 1 0\n"));
  free(settings), free(said), free(text);
  case_free(&f);
  text = scratch_case("E: 207 GPa", "E: [90 GPa, 150 GPa, 210 GPa], G: [61 GPa, 47 GPa, 83 GPa]");
  assert_int_equal(read_text(folder, "x.yaml", text, &f, &said), SHB_OK);
  assert_true(f.materials[0].material.anisotropic && f.materials[0].material.E == 210e9 &&
              f.materials[0].material.C[5][5] == 83e9);
  free(said), free(text);
  case_free(&f);
  text = scratch_case(NULL, NULL);
  assert_int_equal(read_text(folder, "x.yaml", text, &f, &said), SHB_OK);
  assert_false(f.materials[0].material.anisotropic);
  settings = case_settings(&f, CASE_MODAL);
  assert_null(strstr(settings, "material.G"));
  free(settings), free(said), free(text);
  case_free(&f);
  scratch_remove(folder);
}

/* The same file with the line ends, byte order mark and file end of other editors. */
static void line_ends_and_marks(void **state) {
  (void)state;
  char folder[SCRATCH_PATH], *said, *text = scratch_case(NULL, NULL), *other = malloc(8192);
  scratch_create(folder);
  char *to = stpcpy(other, "\xEF\xBB\xBF");
  for (const char *at = text; *at; at++) {
    if (*at == '\n') *to++ = '\r';
    *to++ = *at;
  }
  *to = '\0';
  case_file f;
  assert_int_equal(read_text(folder, "x.yaml", other, &f, &said), SHB_OK);
  assert_int_equal(f.mhb.max_points, 777);
  case_free(&f);
  free(said);
  text[strlen(text) - 1] = '\0'; /* no newline at the end */
  assert_int_equal(read_text(folder, "x.yaml", text, &f, &said), SHB_OK);
  case_free(&f);
  free(said);
  free(text);
  free(other);
  scratch_remove(folder);
}

/* A file cut anywhere is read or refused, and nothing worse. */
static void truncated_anywhere(void **state) {
  (void)state;
  char folder[SCRATCH_PATH], path[2 * SCRATCH_PATH], *text = scratch_case(NULL, NULL);
  scratch_create(folder);
  snprintf(path, sizeof path, "%s/x.yaml", folder);
  FILE *nowhere = fopen("/dev/null", "w");
  int   good    = 0;
  for (size_t n = 0; n < strlen(text); n++) {
    scratch_write(folder, "x.yaml", text, n);
    case_file  f;
    shb_status status = case_read(path, ALL, nowhere, &f);
    assert_true(status == SHB_OK || status == SHB_ERR_INPUT);
    good += status == SHB_OK;
    if (status == SHB_OK) case_free(&f);
  }
  assert_true(good > 0 && good < 150); /* only files that end after mhb.frequency can be valid */
  fclose(nowhere);
  free(text);
  scratch_remove(folder);
}

/* Every byte is replaced by characters with a meaning in YAML. */
static void one_byte_wrong(void **state) {
  (void)state;
  static const char bytes[] = "[]{}:,-\t\n'\"&*!#%|>?@`~\x01\x80\xFF";
  char              folder[SCRATCH_PATH], path[2 * SCRATCH_PATH], *text = scratch_case(NULL, NULL);
  scratch_create(folder);
  snprintf(path, sizeof path, "%s/x.yaml", folder);
  FILE  *nowhere = fopen("/dev/null", "w");
  size_t length  = strlen(text);
  for (size_t i = 0; i < length; i++) {
    char kept = text[i];
    text[i]   = bytes[i % (sizeof bytes - 1)];
    scratch_write(folder, "x.yaml", text, length);
    case_file  f;
    shb_status status = case_read(path, ALL, nowhere, &f);
    assert_true(status == SHB_OK || status == SHB_ERR_INPUT);
    if (status == SHB_OK) case_free(&f);
    text[i] = kept;
  }
  fclose(nowhere);
  free(text);
  scratch_remove(folder);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_value_arrives),
                                     cmocka_unit_test(automatic_harmonics),
                                     cmocka_unit_test(accuracy_in_words),
                                     cmocka_unit_test(a_modal_file_needs_little),
                                     cmocka_unit_test(stages_ask_for_their_own),
                                     cmocka_unit_test(forces_and_tractions),
                                     cmocka_unit_test(materials_with_axes),
                                     cmocka_unit_test(values_of_several_forms),
                                     cmocka_unit_test(line_ends_and_marks),
                                     cmocka_unit_test(truncated_anywhere),
                                     cmocka_unit_test(one_byte_wrong)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
