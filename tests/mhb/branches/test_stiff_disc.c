/* A sector whose disc is many times stiffer than its blade moves as the clamped blade, through
 * modes, balance and contact. The difference falls as the inverse stiffness, and nothing of it is
 * left in the limit. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/core/cyclic_sides.h"
#include "mhb/branches/forced_response.h"
#include "modal/common/session.h"
#include "modal/stage/sector_solve.h"
#include "tests/support/check.h"
#include "tests/support/fem.h"
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

static void clamped_blade(const mesh_fe *sector, double *first, peaks *out) {
  modal_settings settings = sector_case(BLADES, MODES);
  mesh_fe        mesh     = sector_clamp_disc(sector);
  modal_result   result;
  assert_ok(modal_solve(PETSC_COMM_SELF, &mesh, &settings, NULL, &result));
  *first               = result.model.frequency[0];
  const mhb_settings s = balance_case(*first);
  sweep(&result.model, &s, out);
  modal_result_free(&result);
  free(mesh.set[MESH_ROOT].nodes);
}

static void on_disc(const mesh_fe *sector, double stiffer, double first, peaks *out) {
  modal_settings     settings  = sector_case(BLADES, MODES);
  mesh_fe            mesh      = *sector;
  const modal_region region[2] = {
      {"blade", steel}, {"disc", {.E = stiffer * steel.E, .nu = steel.nu, .rho = steel.rho}}};
  modal_result result;
  modal_sector all;
  mhb_settings s = balance_case(first);
  sector_mark_disc(&mesh);
  settings.n_regions = 2;
  settings.region    = region;
  assert_ok(modal_solve(PETSC_COMM_SELF, &mesh, &settings, NULL, &result));
  assert_ok(modal_sector_solve(&mesh, &settings, NULL, &result, NULL, &all));
  s.nodal_diameters = &all.models;
  sweep(&all.models.model[0], &s, out);
  modal_sector_free(&all, &result);
  modal_result_free(&result);
  free(mesh.region);
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

static void a_stiff_disc_is_a_clamp(void **state) {
  (void)state;
  static const char *const kind[]   = {"open", "stuck", "friction"};
  const double             factor[] = {1, 1e4, 1e5};
  mesh_cyclic_sides        sides;
  mesh_fe                  mesh;
  peaks                    clamped, disc;
  double                   first, off[3][6], limit[6];
  use_elements(MESH_HEX20);
  mesh = make_bladed_sector(BLADES, 1);
  assert_ok(mesh_cyclic_pair(&mesh, MESH_AXIS_X, BLADES, &sides));
  assert_ok(mesh_fe_orient(&mesh, MESH_AXIS_X));
  clamped_blade(&mesh, &first, &clamped);
  for (int k = 0; k < 3; k++) {
    on_disc(&mesh, factor[k], first, &disc);
    relative(&disc, &clamped, off[k]);
    for (int i = 0; i < 3; i++)
      print_message("disc %5.0e times stiffer, %s: %.6g m at %.6g Hz, off by %.1e and %.1e\n",
                    factor[k], kind[i], disc.amplitude[i], disc.at[i], off[k][2 * i],
                    off[k][2 * i + 1]);
  }
  for (int i = 0; i < 6; i++) limit[i] = off[2][i] - (off[1][i] - off[2][i]) / 9;
  print_message("in the limit off by %.1e\n", greatest(6, limit));
  /* friction counts, and so does a disc of steel */
  for (int i = 0; i < 2; i++) assert_true(clamped.amplitude[2] < 0.9 * clamped.amplitude[i]);
  assert_true(greatest(6, off[0]) > 1e-2);
  /* the blade is as thick as the disc: its clamp gives more than that of a slender one */
  assert_below(greatest(6, off[1]), 1.3e-4);
  assert_below(greatest(6, limit), 1e-6);
  mesh_fe_free(&mesh);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_stiff_disc_is_a_clamp),
                                     cmocka_unit_test(an_order_above_half_the_blades_is_its_wave)};
  modal_session           session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failures = cmocka_run_group_tests(tests, NULL, NULL);
  modal_session_end(&session, SHB_OK);
  return failures;
}
