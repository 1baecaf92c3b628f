/* A sector whose disc is many times stiffer than its blade moves as the clamped blade, through
 * modes, balance and contact. The difference falls as the inverse stiffness, and nothing of it is
 * left in the limit. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/blade/blade.h"
#include "mesh/blade/disc.h"
#include "mesh/core/cyclic_sides.h"
#include "mhb/branches/forced_response.h"
#include "modal/common/session.h"
#include "modal/stage/sector_solve.h"
#include "tests/support/check.h"
#include "tests/support/fem.h"
#include "tests/support/read_mesh.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/sector.h"
#include "tests/support/sector_case.h"

enum { BLADES = 6, MODES = 12, ORDER = 2 };

static mhb_settings balance_case(double first) {
  return (mhb_settings){.engine_order = ORDER,
                        .blades       = BLADES,
                        .mu           = 0.3,
                        .kv           = 8e5,
                        .ku           = {5e5, 0, 5e5},
                        .n_preloads   = 1,
                        .n0           = {2},
                        .frequency    = {0.9 * first, 1.15 * first},
                        .harmonics    = 5,
                        .subharmonics = 1,
                        .scale        = 1,
                        .tolerance    = 1e-8,
                        .max_points   = 5000,
                        .stability    = MHB_STABILITY_NEVER,
                        .lasting      = MHB_LASTING_NEVER};
}

/* Highest points: open, stuck, and with friction. */
typedef struct {
  double at[3], amplitude[3];
} peaks;

static void find_peaks(const mhb_response *r, peaks *out) {
  *out = (peaks){{0}, {0}};
  for (int i = 0; i < r->n_branches; i++) {
    const mhb_branch *b     = &r->branch[i];
    const int         which = b->kind == MHB_BRANCH_OPEN ? 0 : b->kind == MHB_BRANCH_STUCK ? 1 : 2;
    for (int p = 0; p < b->n_points; p++) {
      if (b->special[p] != MHB_PEAK) continue;
      const double output = mhb_response_output(r, b, p);
      if (output <= out->amplitude[which]) continue;
      out->amplitude[which] = output;
      out->at[which]        = b->frequency[p];
    }
  }
}

static void sweep(const modal_model *model, const mhb_settings *s, peaks *out) {
  mhb_response *r;
  assert_ok(mhb_forced_response(model, s, NULL, NULL, NULL, &r));
  find_peaks(r, out);
  mhb_response_destroy(r);
}

static void clamped_blade(const mesh_fe *clamped, const modal_settings *settings, double *first,
                          mhb_settings *s, peaks *out) {
  modal_result result;
  assert_ok(modal_solve(PETSC_COMM_SELF, clamped, settings, NULL, &result));
  *first = result.model.frequency[0];
  if (s->frequency[1] == 0) *s = balance_case(*first);
  sweep(&result.model, s, out);
  modal_result_free(&result);
}

/* mesh: with region 1, the disc. */
static void on_disc(const mesh_fe *mesh, const modal_settings *asked, const mhb_settings *of,
                    double stiffer, peaks *out) {
  modal_settings     settings  = *asked;
  const modal_region region[2] = {
      {"blade", steel}, {"disc", {.E = stiffer * steel.E, .nu = steel.nu, .rho = steel.rho}}};
  modal_result result;
  modal_sector all;
  mhb_settings s     = *of;
  settings.n_regions = 2;
  settings.region    = region;
  assert_ok(modal_solve(PETSC_COMM_SELF, mesh, &settings, NULL, &result));
  assert_ok(modal_sector_solve(mesh, &settings, NULL, &result, NULL, &all));
  s.nodal_diameters = &all.models;
  sweep(&all.models.model[0], &s, out);
  modal_sector_free(&all, &result);
  modal_result_free(&result);
}

/* A disc of steel under two excitations of the same lag between the blades. */
static void same_wave(int blades, int order, int beyond) {
  modal_settings    settings = sector_case(blades, MODES);
  mesh_cyclic_sides sides;
  modal_result      result;
  modal_sector      all;
  peaks             at[2];
  use_elements(MESH_HEX20);
  mesh_fe mesh = make_bladed_sector(blades, blades == 2 ? 2 : 1);
  assert_ok(mesh_cyclic_pair(&mesh, MESH_AXIS_X, blades, &sides));
  assert_ok(mesh_fe_orient(&mesh, MESH_AXIS_X));
  assert_ok(modal_solve(PETSC_COMM_SELF, &mesh, &settings, NULL, &result));
  assert_ok(modal_sector_solve(&mesh, &settings, NULL, &result, NULL, &all));
  const int    met  = modal_nodal_diameters_find(&all.models, modal_nodal_diameter(order, blades));
  mhb_settings s    = balance_case(all.models.model[met].frequency[0]);
  s.blades          = blades;
  s.nodal_diameters = &all.models;
  for (int i = 0; i < 2; i++) {
    s.engine_order = i ? beyond : order;
    sweep(&all.models.model[0], &s, &at[i]);
  }
  for (int i = 0; i < 3; i++) {
    print_message("%d blades, engine orders %d and %d: %.6g m at %.6g Hz, %.6g at %.6g\n", blades,
                  order, beyond, at[0].amplitude[i], at[0].at[i], at[1].amplitude[i], at[1].at[i]);
    assert_true(at[0].amplitude[i] > 0);
    assert_near(at[1].amplitude[i] / at[0].amplitude[i], 1, 1e-9);
    assert_near(at[1].at[i] / at[0].at[i], 1, 1e-9);
  }
  modal_sector_free(&all, &result);
  modal_result_free(&result);
  mesh_fe_free(&mesh);
}

/* Engine orders above N/2, also with two blades. */
static void an_order_above_half_the_blades_is_its_wave(void **state) {
  (void)state;
  same_wave(BLADES, ORDER, ORDER + BLADES);
  same_wave(2, 1, 3);
}

/* Heights and frequencies: [6]. */
static void relative(const peaks *disc, const peaks *clamped, double off[6]) {
  for (int i = 0; i < 3; i++) {
    off[2 * i]     = disc->amplitude[i] / clamped->amplitude[i] - 1;
    off[2 * i + 1] = disc->at[i] / clamped->at[i] - 1;
  }
}

static double greatest(int n, const double *x) {
  double most = 0;
  for (int i = 0; i < n; i++) most = fmax(most, fabs(x[i]));
  return most;
}

/* Off the clamped blade at 1, 1e4, 1e5 times the stiffness, and in the limit. */
static void compare(const mesh_fe *marked, const mesh_fe *clamped, const modal_settings *settings,
                    mhb_settings s, double off[3][6], double limit[6], peaks *of_clamped) {
  static const char *const kind[]   = {"open", "stuck", "friction"};
  const double             factor[] = {1, 1e4, 1e5};
  peaks                    disc;
  double                   first;
  clamped_blade(clamped, settings, &first, &s, of_clamped);
  for (int k = 0; k < 3; k++) {
    on_disc(marked, settings, &s, factor[k], &disc);
    relative(&disc, of_clamped, off[k]);
    for (int i = 0; i < 3; i++)
      print_message("disc %5.0e times stiffer, %s: %.6g m at %.6g Hz, off by %.1e and %.1e\n",
                    factor[k], kind[i], disc.amplitude[i], disc.at[i], off[k][2 * i],
                    off[k][2 * i + 1]);
  }
  for (int i = 0; i < 6; i++) limit[i] = off[2][i] - (off[1][i] - off[2][i]) / 9;
  print_message("in the limit off by %.1e\n", greatest(6, limit));
}

static void a_stiff_disc_is_a_clamp(void **state) {
  (void)state;
  const modal_settings settings = sector_case(BLADES, MODES);
  mesh_cyclic_sides    sides;
  mesh_fe              mesh;
  peaks                of;
  double               off[3][6], limit[6];
  use_elements(MESH_HEX20);
  mesh = make_bladed_sector(BLADES, 1);
  assert_ok(mesh_cyclic_pair(&mesh, MESH_AXIS_X, BLADES, &sides));
  assert_ok(mesh_fe_orient(&mesh, MESH_AXIS_X));
  mesh_fe clamped = sector_clamp_disc(&mesh), marked = mesh;
  sector_mark_disc(&marked);
  compare(&marked, &clamped, &settings, (mhb_settings){0}, off, limit, &of);
  /* friction counts, and so does a disc of steel */
  for (int i = 0; i < 2; i++) assert_true(of.amplitude[2] < 0.9 * of.amplitude[i]);
  assert_true(greatest(6, off[0]) > 1e-2);
  /* the blade is as thick as the disc: its clamp gives more than that of a slender one */
  assert_below(greatest(6, off[1]), 1.3e-4);
  assert_below(greatest(6, limit), 1e-6);
  free(clamped.set[MESH_ROOT].nodes);
  free(marked.region);
  mesh_fe_free(&mesh);
}

/* The blade and disc of cases/bladed_disc, of coarser elements. */
static mesh_blade slender_blade(void) {
  const double degree = SHB_PI / 180;
  return (mesh_blade){.blades           = 40,
                      .axis             = MESH_AXIS_X,
                      .psi              = 35 * degree,
                      .elements         = MESH_TET10,
                      .root_length      = 0.068,
                      .root_width       = 0.03,
                      .root_height      = 0.018,
                      .n_sections       = 5,
                      .section          = {{0.25, 0.058, 0.009, 0.011, -10 * degree},
                                           {0.3, 0.054, 0.0076, 0.009, -19 * degree},
                                           {0.35, 0.05, 0.0062, 0.007, -28 * degree},
                                           {0.4, 0.047, 0.0051, 0.0054, -36 * degree},
                                           {0.445, 0.045, 0.0044, 0.0042, -42 * degree}},
                      .shroud_length    = 0.046,
                      .shroud_thickness = 0.007,
                      .shroud_contact   = 0.024,
                      .disc_bore        = 0.12,
                      .disc_web         = 0.012,
                      .disc_rim         = 0.025,
                      .size             = 0.02};
}

/* Region 1: elements below the top of the rim, whose nodes the clamped mesh holds. */
static void split_at_the_rim(const mesh_blade *blade, mesh_fe *mesh, mesh_fe *clamped) {
  const int each  = mesh_topology_of(mesh->kind)->nodes;
  const int width = mesh_topology_of(mesh->kind)->face_nodes;
  double    radius[4];
  int      *node = calloc((size_t)(mesh->n_nodes + width), sizeof *node), count = 0;
  bool     *held = calloc((size_t)mesh->n_nodes, sizeof *held);
  mesh_disc_radii(blade, radius);
  mesh->n_regions = 2;
  mesh->region    = calloc((size_t)mesh->n_elements, sizeof *mesh->region);
  assert_true(node && held && mesh->region);
  for (int e = 0; e < mesh->n_elements; e++) {
    const int *nodes = mesh->connectivity + each * e;
    mesh->region[e]  = 1;
    for (int i = 0; i < each; i++) {
      const double *x = mesh->coordinates + 3 * nodes[i];
      if (hypot(x[1], x[2]) > radius[3] + 1e-6) mesh->region[e] = 0;
    }
    for (int i = 0; i < each; i++) held[nodes[i]] |= mesh->region[e] == 1;
  }
  for (int i = 0; i < mesh->n_nodes; i++)
    if (held[i]) node[count++] = i;
  while (count % width) node[count++] = node[0];
  *clamped                = *mesh;
  clamped->image          = NULL;
  clamped->n_regions      = 0;
  clamped->region         = NULL;
  clamped->set[MESH_ROOT] = (mesh_face_set){count / width, node};
  free(held);
}

/* Proportions of a turbine: what a clamp of 1e4 times the stiffness gives is below 1e-4. */
static void a_slender_blade_on_a_stiff_disc(void **state) {
  (void)state;
  static const shb_provenance origin     = {"case.yaml", "", "", "test"};
  static const modal_probe    tip        = {"tip", {0, 0, 0.452}};
  static const int            diameter[] = {0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20};
  const mesh_blade            blade      = slender_blade();
  modal_settings              settings   = sector_case(blade.blades, 20);
  fem_load                    load       = sector_load;
  mhb_settings                s          = balance_case(100);
  mesh_cyclic_sides           sides;
  mesh_fe                     mesh, clamped;
  peaks                       of;
  double                      off[3][6], limit[6];
  load.pressure        = 1000;
  settings.loads       = &load;
  settings.probe       = &tip;
  settings.n_diameters = 11;
  settings.diameter    = diameter;
  s.blades             = blade.blades;
  s.n0[0]              = 15;
  s.frequency[0]       = 90;
  s.frequency[1]       = 270;
  use_elements(MESH_TET10);
  assert_ok(mesh_blade_write(&blade, scratch("blade.msh"), &origin, NULL));
  assert_ok(read_mesh(scratch("blade.msh"), &mesh));
  assert_ok(mesh_cyclic_pair(&mesh, blade.axis, blade.blades, &sides));
  split_at_the_rim(&blade, &mesh, &clamped);
  compare(&mesh, &clamped, &settings, s, off, limit, &of);
  for (int i = 0; i < 2; i++) assert_true(of.amplitude[2] < 0.9 * of.amplitude[i]);
  assert_true(greatest(6, off[0]) > 1e-2);
  assert_below(greatest(6, off[1]), 1e-4);
  assert_below(greatest(6, limit), 1e-6);
  free(clamped.set[MESH_ROOT].nodes);
  mesh_fe_free(&mesh);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_stiff_disc_is_a_clamp),
                                     cmocka_unit_test(a_slender_blade_on_a_stiff_disc),
                                     cmocka_unit_test(an_order_above_half_the_blades_is_its_wave)};
  modal_session           session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failures = cmocka_run_group_tests(tests, scratch_make, scratch_remove);
  modal_session_end(&session, SHB_OK);
  return failures;
}
