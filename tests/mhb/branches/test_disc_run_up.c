/* Run-up of a sector with a disc. Between the speeds of the file it is as near to the sector at
 * that speed as a clamped blade is. A stiff disc gives the clamped blade's run-up. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/core/cyclic_sides.h"
#include "mhb/branches/forced_response.h"
#include "mhb/structure/receptance.h"
#include "modal/common/session.h"
#include "modal/model/reduce.h"
#include "modal/stage/speed_range.h"
#include "tests/support/check.h"
#include "tests/support/fem.h"
#include "tests/support/sector.h"
#include "tests/support/sector_case.h"

enum { BLADES = 6, MODES = 12, ORDER = 8, SPEEDS = 3, TOP = 4 }; /* nodal diameters 0 and 2 */

static const double speeds[SPEEDS] = {1200, 1400, 1600}; /* rad/s */

static mhb_settings balance_case(void) {
  return (mhb_settings){.engine_order = ORDER,
                        .blades       = BLADES,
                        .mu           = 0.3,
                        .kv           = 8e5,
                        .ku           = {5e5, 0, 5e5},
                        .n_preloads   = 1,
                        .n0           = {2},
                        .frequency    = {1600, 2000},
                        .harmonics    = TOP,
                        .subharmonics = 1,
                        .scale        = 1,
                        .tolerance    = 1e-8,
                        .max_points   = 5000,
                        .stability    = MHB_STABILITY_NEVER,
                        .lasting      = MHB_LASTING_NEVER};
}

/* turning: with Coriolis terms. */
static modal_settings stage_case(fem_turning turning) {
  static fem_load load;
  modal_settings  settings = sector_case(BLADES, MODES);
  load                     = sector_load;
  load.n_harmonics         = 2;
  load.factor[2]           = -0.2 + 0.5 * I;
  settings.loads           = &load;
  settings.coriolis        = turning;
  settings.speed           = speeds[SPEEDS - 1];
  settings.n_speeds        = SPEEDS;
  settings.speeds          = speeds;
  return settings;
}

/* The run-up of a blade or of a sector. */
typedef struct {
  mhb_speed_table *blade;
  mhb_disc_table  *disc;
  mhb_disc_speeds *top;
  mhb_settings     settings;
} run_up;

static run_up clamped(const mesh_fe *sector, const modal_settings *settings) {
  run_up       r    = {.settings = balance_case()};
  mesh_fe      mesh = sector_clamp_disc(sector);
  modal_speeds all;
  modal_result result;
  assert_ok(modal_speed_range_solve(PETSC_COMM_SELF, &mesh, settings, NULL, &all, NULL, &result));
  result.model = (modal_model){0}; /* the table takes it over */
  assert_ok(mhb_speed_table_create(&all, "blade", ORDER, r.settings.frequency, &r.blade));
  assert_int_equal(r.blade->n_dropped, 0);
  r.settings.run_up = r.blade;
  modal_speed_range_free(&all, &result);
  modal_result_free(&result);
  free(mesh.set[MESH_ROOT].nodes);
  return r;
}

static run_up on_disc(const mesh_fe *mesh, const modal_settings *settings) {
  run_up              r = {.settings = balance_case()};
  modal_speeds        all;
  modal_sector        sector = {0};
  modal_sector_speeds taken;
  modal_result        result;
  assert_ok(modal_speed_range_solve(PETSC_COMM_SELF, mesh, settings, NULL, &all, &sector, &result));
  assert_int_equal(all.n, 0);
  taken         = sector.speeds;
  sector.speeds = (modal_sector_speeds){0};
  result.model  = (modal_model){0};
  for (int i = 0; i < sector.models.n; i++)
    sector.models.model[i] = sector.models.imaginary[i] = sector.models.backward[i] =
        (modal_model){0};
  assert_ok(mhb_disc_table_create(&taken, "disc", ORDER, r.settings.frequency, &r.disc));
  assert_ok(mhb_disc_table_check(r.disc, "disc"));
  r.top = mhb_disc_speeds_create(r.disc);
  mhb_disc_speeds_set_all(r.top);
  r.settings.run_up          = r.disc->table[0];
  r.settings.disc_run_up     = r.disc;
  r.settings.nodal_diameters = &r.top->now;
  modal_sector_speeds_free(&taken);
  modal_sector_free(&sector, &result);
  modal_result_free(&result);
  return r;
}

static void destroy(run_up *r) {
  mhb_speed_table_destroy(r->blade);
  mhb_disc_speeds_destroy(r->top);
  mhb_disc_table_destroy(r->disc);
}

static const modal_model *model_of(const run_up *r) {
  return r->disc ? &r->top->now.model[0] : r->blade->common;
}

/* ---- between the speeds ---- */

/* The largest relative difference of a harmonic's receptance and response to the load. */
static double apart(const mhb_receptance *a, const mhb_receptance *b) {
  double worst = 0;
  for (int k = 0; k <= TOP; k++) {
    double size = 0, off = 0;
    for (int i = 0; i < 9; i++) {
      size = fmax(size, cabs(b->R[9 * k + i]));
      off  = fmax(off, cabs(a->R[9 * k + i] - b->R[9 * k + i]));
    }
    worst = fmax(worst, off / size);
    size = off = 0;
    for (int i = 0; i < 3; i++) {
      size = fmax(size, cabs(b->free[3 * k + i]));
      off  = fmax(off, cabs(a->free[3 * k + i] - b->free[3 * k + i]));
    }
    if (size > 0) worst = fmax(worst, off / size);
  }
  return worst;
}

static double blade_between(const run_up *r, const mesh_fe *sector, double speed,
                            fem_turning turning) {
  modal_settings  settings = stage_case(turning);
  mhb_settings    plain    = balance_case();
  mesh_fe         mesh     = sector_clamp_disc(sector);
  modal_result    result;
  mhb_receptance *between, *exact;
  settings.n_speeds = 0;
  settings.speed    = speed;
  assert_ok(modal_solve(PETSC_COMM_SELF, &mesh, &settings, NULL, &result));
  modal_model_drop_residual_modes(&result.model);
  assert_ok(mhb_receptance_create(model_of(r), &r->settings, TOP, &between));
  assert_ok(mhb_receptance_create(&result.model, &plain, TOP, &exact));
  mhb_receptance_at(between, ORDER * speed, TOP);
  mhb_receptance_at(exact, ORDER * speed, TOP);
  const double off = apart(between, exact);
  mhb_receptance_destroy(between);
  mhb_receptance_destroy(exact);
  modal_result_free(&result);
  free(mesh.set[MESH_ROOT].nodes);
  return off;
}

static double disc_between(const run_up *r, const mesh_fe *mesh, double speed,
                           fem_turning turning) {
  modal_settings  settings = stage_case(turning);
  mhb_settings    plain    = balance_case();
  modal_result    result;
  modal_sector    all;
  mhb_receptance *between, *exact;
  settings.n_speeds = 0;
  settings.speed    = speed;
  assert_ok(modal_solve(PETSC_COMM_SELF, mesh, &settings, NULL, &result));
  assert_ok(modal_sector_solve(mesh, &settings, NULL, &result, NULL, &all));
  for (int i = 0; i < all.models.n; i++)
    modal_wave_drop_residual_modes(&all.models.model[i], &all.models.imaginary[i],
                                   &all.models.backward[i]);
  result.model          = all.models.model[0]; /* as it is now */
  plain.nodal_diameters = &all.models;
  assert_ok(mhb_receptance_create(model_of(r), &r->settings, TOP, &between));
  assert_ok(mhb_receptance_create(&all.models.model[0], &plain, TOP, &exact));
  mhb_receptance_at(between, ORDER * speed, TOP);
  mhb_receptance_at(exact, ORDER * speed, TOP);
  const double off = apart(between, exact);
  mhb_receptance_destroy(between);
  mhb_receptance_destroy(exact);
  modal_sector_free(&all, &result);
  modal_result_free(&result);
  return off;
}

static void compare_between(const mesh_fe *mesh, fem_turning turning) {
  const modal_settings settings = stage_case(turning);
  run_up               blade = clamped(mesh, &settings), disc = on_disc(mesh, &settings);
  static const double  place[] = {1200, 1310, 1480, 1600};
  for (int i = 0; i < 4; i++) {
    const double b = blade_between(&blade, mesh, place[i], turning);
    const double d = disc_between(&disc, mesh, place[i], turning);
    print_message("%s%g rad/s: clamped blade off by %.1e, sector by %.1e\n",
                  turning ? "Coriolis terms, " : "", place[i], b, d);
    assert_below(b, i % 3 ? 1e-4 : 1e-9);
    assert_below(d, i % 3 ? fmax(5 * b, 1e-9) : 1e-9); /* at a speed of the file: exact */
  }
  destroy(&blade);
  destroy(&disc);
}

static void between_speeds_it_is_as_near_as_a_blade(void **state) {
  compare_between(*state, FEM_TURNS_UNSAID);
}

static void with_coriolis_terms_too(void **state) {
  compare_between(*state, FEM_TURNS_LEFT);
}

/* ---- stability ---- */

static mhb_response *along_scale(const run_up *r, const mhb_settings *settings) {
  mhb_settings  s = *settings;
  mhb_response *response;
  s.frequency[0] = s.frequency[1] = 1720;
  s.parameter                     = MHB_IN_SCALE;
  s.range[0]                      = 0.5;
  s.range[1]                      = 2;
  s.stability                     = MHB_STABILITY_ALWAYS;
  assert_ok(mhb_forced_response(model_of(r), &s, NULL, NULL, NULL, &response));
  return response;
}

/* The main curve: the last one with friction. */
static const mhb_branch *main_curve(const mhb_response *r) {
  const mhb_branch *found = NULL;
  for (int i = 0; i < r->n_branches; i++)
    if (r->branch[i].kind != MHB_BRANCH_OPEN && r->branch[i].kind != MHB_BRANCH_STUCK)
      found = &r->branch[i];
  assert_non_null(found);
  return found;
}

/* Multipliers are those of the structure frozen at the point's speed, with all its nodal
 * diameters. */
static void compare_multipliers(const mesh_fe *mesh, fem_turning turning) {
  const modal_settings settings = stage_case(turning);
  run_up               r        = on_disc(mesh, &settings);
  mhb_settings         frozen   = r.settings;
  double               worst    = 0;
  frozen.run_up                 = NULL;
  frozen.disc_run_up            = NULL;
  mhb_disc_speeds_set(r.top, SHB_TWO_PI * 1720);
  mhb_disc_speeds_set_all(r.top);
  mhb_response     *a = along_scale(&r, &r.settings), *b = along_scale(&r, &frozen);
  const mhb_branch *p = main_curve(a), *q = main_curve(b);
  assert_true(a->n_multipliers > 0);
  for (int i = 0; i < 2 * a->n_multipliers; i++) {
    const int    m = i % a->n_multipliers, last = i / a->n_multipliers;
    const size_t at = (size_t)(last * (p->n_points - 1) * a->n_multipliers + m);
    const size_t by = (size_t)(last * (q->n_points - 1) * a->n_multipliers + m);
    const double x = cabs(p->multipliers[at]), y = cabs(q->multipliers[by]);
    assert_true(y > 0.5 && y < 1);
    worst = fmax(worst, fabs(x - y));
  }
  print_message("%s%d multipliers at both ends of the scale off by %.1e\n",
                turning ? "Coriolis terms, " : "", a->n_multipliers, worst);
  assert_below(worst, 1e-7);
  mhb_response_destroy(a);
  mhb_response_destroy(b);
  destroy(&r);
}

static void multipliers_are_those_of_the_speed(void **state) {
  compare_multipliers(*state, FEM_TURNS_UNSAID);
  compare_multipliers(*state, FEM_TURNS_LEFT);
}

/* ---- a stiff disc ---- */

/* Height and place of the highest peak with friction. */
static void find_peak(const run_up *r, double peak[2]) {
  mhb_response *response;
  assert_ok(mhb_forced_response(model_of(r), &r->settings, NULL, NULL, NULL, &response));
  assert_true(response->run_up);
  peak[0] = peak[1] = 0;
  for (int i = 0; i < response->n_branches; i++) {
    const mhb_branch *b = &response->branch[i];
    if (b->kind == MHB_BRANCH_OPEN || b->kind == MHB_BRANCH_STUCK) continue;
    assert_true(b->complete);
    for (int p = 0; p < b->n_points; p++) {
      const double output = mhb_response_output(response, b, p);
      if (b->special[p] != MHB_PEAK || output <= peak[0]) continue;
      peak[0] = output;
      peak[1] = b->frequency[p];
    }
  }
  mhb_response_destroy(response);
}

static void a_stiff_disc_is_a_clamp(void **state) {
  mesh_fe             mesh     = **(const mesh_fe **)state;
  modal_settings      settings = stage_case(FEM_TURNS_UNSAID);
  run_up              blade    = clamped(&mesh, &settings);
  static const double factor[] = {1, 1e4, 1e5};
  double              wanted[2], found[2], off[3][2];
  find_peak(&blade, wanted);
  sector_mark_disc(&mesh);
  for (int k = 0; k < 3; k++) {
    const modal_region region[2] = {
        {"blade", steel}, {"disc", {.E = factor[k] * steel.E, .nu = steel.nu, .rho = steel.rho}}};
    settings.n_regions = 2;
    settings.region    = region;
    run_up disc        = on_disc(&mesh, &settings);
    find_peak(&disc, found);
    for (int i = 0; i < 2; i++) off[k][i] = found[i] / wanted[i] - 1;
    print_message("disc %.0e times stiffer: %.6g m at %.6g Hz, off by %.1e and %.1e\n", factor[k],
                  found[0], found[1], off[k][0], off[k][1]);
    destroy(&disc);
  }
  for (int i = 0; i < 2; i++) {
    const double limit = off[2][i] - (off[1][i] - off[2][i]) / 9;
    print_message("in the limit off by %.1e\n", limit);
    assert_below(fabs(off[2][i]), 3e-5);
    assert_below(fabs(limit), 1e-6);
  }
  assert_true(fabs(off[0][0]) > 1e-2); /* a disc of steel counts */
  free(mesh.region);
  destroy(&blade);
}

static int set_up(void **state) {
  static mesh_fe    mesh;
  mesh_cyclic_sides sides;
  use_elements(MESH_HEX20);
  mesh   = make_bladed_sector(BLADES, 1);
  *state = &mesh;
  return mesh_cyclic_pair(&mesh, MESH_AXIS_X, BLADES, &sides) != SHB_OK ||
         mesh_fe_orient(&mesh, MESH_AXIS_X) != SHB_OK;
}

static int tear_down(void **state) {
  mesh_fe_free(*state);
  return 0;
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(between_speeds_it_is_as_near_as_a_blade),
                                     cmocka_unit_test(with_coriolis_terms_too),
                                     cmocka_unit_test(multipliers_are_those_of_the_speed),
                                     cmocka_unit_test(a_stiff_disc_is_a_clamp)};
  modal_session           session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failures = cmocka_run_group_tests(tests, set_up, tear_down);
  modal_session_end(&session, SHB_OK);
  return failures;
}
