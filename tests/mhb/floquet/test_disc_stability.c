/* Stability of a wave on a flexible disc, by nodal diameters, against the ring of all sectors.
 *
 * The ring is one structure with eight contacts to the ground. Its multipliers know no nodal
 * diameter, no renaming of sectors and no Bloch wave. */
#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "tests/support/check.h"
#include "tests/support/lumped_disc.h"
#include "tests/support/periodic.h"

enum { N = DISC_SECTORS, FEW = 9, SUBSTEPS = 256, MOST = 2 * N * (DISC_DOFS + 1) };

typedef struct {
  lumped_disc           disc;
  modal_nodal_diameters waves;
  mhb_settings          settings; /* of one sector */
} sector;

static void sector_create_spinning(int engine_order, int modes, double coupling, double load,
                                   double n0, double spin, sector *s) {
  s->disc      = lumped_disc_of(coupling, 1.7);
  s->disc.spin = spin;
  lumped_disc_waves(&s->disc, modes, &s->waves);
  s->settings                 = lumped_disc_settings(engine_order, FEW);
  s->settings.n_preloads      = 1;
  s->settings.n0[0]           = n0;
  s->settings.scale           = load;
  s->settings.nodal_diameters = &s->waves;
}

static void sector_create(int engine_order, int modes, double coupling, double load, double n0,
                          sector *s) {
  sector_create_spinning(engine_order, modes, coupling, load, n0, 0, s);
}

/* all[3 N][2 m + 1] <- the motion of one contact in every sector, b E k/N of a turn later. */
static void expand(int engine_order, const double *x, double *all) {
  const int nb = 2 * FEW + 1;
  for (int b = 0; b < N; b++)
    for (int d = 0; d < 3; d++)
      for (int k = 0; k <= FEW; k++) {
        const double        *from = x + d * nb;
        double              *to   = all + (3 * b + d) * nb;
        const double complex turn = cexp(-I * SHB_TWO_PI * k * engine_order * b / N);
        const double complex a    = k ? CMPLX(from[2 * k - 1], from[2 * k]) * turn : from[0];
        to[k ? 2 * k - 1 : 0]     = creal(a);
        if (k) to[2 * k] = cimag(a);
      }
}

typedef struct {
  int         engine_order;
  double      w, load, n0; /* rad/s, -, N */
  mhb_verdict verdict;
  double      spin; /* rad/s, with Coriolis terms */
} place;

/* Multipliers of the wave by nodal diameters, and of the ring of all sectors at the same motion. */
typedef struct {
  mhb_multipliers mine, wanted;
  double          apart, share[3]; /* of the sets; of the period stuck, slipping, open */
} comparison;

static comparison compare(const place *at, int substeps) {
  static double         x[3 * N * (2 * FEW + 1)];
  static double complex one[MOST], all[MOST];
  comparison            c;
  sector                s;
  modal_model           ring;
  periodic              wave, whole;
  sector_create_spinning(at->engine_order, DISC_DOFS, 0.8, at->load, at->n0, at->spin, &s);
  lumped_disc_ring(&s.disc, at->engine_order, &ring);
  const mhb_settings of_ring = lumped_disc_ring_settings(&s.settings);
  periodic_create(&s.waves.model[0], &s.settings, at->w, NULL, &wave);
  expand(at->engine_order, wave.x, x);
  periodic_create(&ring, &of_ring, at->w, x, &whole);
  c.mine   = periodic_multipliers(&wave, substeps, one);
  c.wanted = periodic_multipliers(&whole, substeps, all);
  c.apart  = distance_to(one, c.mine.n, all, c.wanted.n);
  memcpy(c.share, wave.residual->eval->info[0].share, sizeof c.share);
  periodic_destroy(&wave);
  periodic_destroy(&whole);
  modal_model_free(&ring);
  modal_nodal_diameters_free(&s.waves);
  return c;
}

static void multipliers_are_those_of_the_ring(void **state) {
  static const place places[] = {
      {3, 0.93, 5, 0.4, MHB_STABLE, 0},    {1, 0.86, 5, 0.4, MHB_STABLE, 0},
      {2, 0.93, 5, 0.4, MHB_STABLE, 0},    {4, 0.93, 5, 0.4, MHB_STABLE, 0},
      {6, 0.93, 12, 0.1, MHB_STABLE, 0},   {11, 0.80, 12, 0.1, MHB_UNSTABLE, 0},
      {3, 0.93, 5, 0.4, MHB_STABLE, 0.1},  {5, 0.93, 5, 0.4, MHB_STABLE, 0.1},
      {4, 0.93, 5, 0.4, MHB_STABLE, -0.1}, {11, 0.80, 12, 0.1, MHB_UNSTABLE, 0.05}};
  (void)state;
  for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
    const place     *at = &places[i];
    const comparison c  = compare(at, SUBSTEPS);
    print_message(
        "E = %d, %.2f rad/s, spin %g: largest %.8f, of the ring %.8f; %d multipliers, apart %.1e; "
        "slipping %.2f, open %.2f\n",
        at->engine_order, at->w, at->spin, c.mine.largest, c.wanted.largest, c.mine.n, c.apart,
        c.share[1], c.share[2]);
    assert_int_equal(c.mine.verdict, at->verdict);
    assert_int_equal(c.wanted.verdict, at->verdict);
    assert_int_equal(c.mine.n, c.wanted.n);
    assert_int_equal(c.mine.n_stuck, c.wanted.n_stuck);
    assert_int_equal(c.mine.n_zero, c.wanted.n_zero);
    assert_below(fabs(c.mine.largest - c.wanted.largest), 1e-5);
    assert_below(c.apart, 5e-5);
    assert_true(c.share[1] > 0.2);
  }
}

/* Both integrate with the same sub-steps but over other intervals: what is between them is the
 * error of the sub-steps, of fourth order. */
static void the_distance_is_that_of_the_substeps(void **state) {
  const place  at     = {4, 0.93, 5, 0.4, MHB_STABLE, 0};
  const double coarse = compare(&at, 64).apart, fine = compare(&at, 256).apart;
  (void)state;
  print_message("apart %.1e with 64 sub-steps, %.1e with 256\n", coarse, fine);
  assert_true(fine < coarse / 16);
}

/* Stuck or open throughout: eigenvalues of the linear structure. */
static void linear_limits_are_those_of_the_ring(void **state) {
  static const place places[] = {{3, 0.93, 0.01, 0.4, MHB_STABLE, 0},
                                 {5, 0.93, 0.01, -0.4, MHB_STABLE, 0},
                                 {3, 0.93, 0.01, 0.4, MHB_STABLE, 0.1},
                                 {5, 0.93, 0.01, -0.4, MHB_STABLE, -0.1}};
  (void)state;
  for (int i = 0; i < 4; i++) {
    const comparison c = compare(&places[i], SUBSTEPS);
    print_message("%s, spin %g: apart %.1e\n", i % 2 ? "open" : "stuck", places[i].spin, c.apart);
    assert_int_equal(c.mine.n, 2 * N * DISC_DOFS);
    assert_below(c.apart, 1e-11);
    assert_near(c.share[i % 2 ? 2 : 0], 1, 0);
  }
}

static mhb_multipliers of_sector(const place *at, const modal_model *model,
                                 const mhb_settings *settings, int max_states,
                                 double complex *copy) {
  periodic        p;
  mhb_floquet    *floquet;
  mhb_multipliers out;
  periodic_create(model, settings, at->w, NULL, &p);
  assert_ok(mhb_floquet_create(p.residual->receptance, settings, SUBSTEPS, max_states, &floquet));
  mhb_floquet_evaluate(floquet, &p.solution, &out);
  for (int i = 0; i < out.n; i++) copy[i] = out.multiplier[i];
  mhb_floquet_destroy(floquet);
  periodic_destroy(&p);
  return out;
}

/* A disc that couples nothing gives the clamped blade. */
static void an_uncoupled_disc_is_clamped_blades(void **state) {
  static double complex one[MOST], all[MOST];
  const place places[] = {{3, 0.93, 5, 0.4, MHB_STABLE, 0}, {2, 0.93, 12, 0.1, MHB_STABLE, 0}};
  (void)state;
  for (int i = 0; i < 2; i++)
    for (int modes = 6; modes <= DISC_DOFS; modes += 6) {
      sector      s;
      modal_model blade;
      sector_create(places[i].engine_order, modes, 0, places[i].load, places[i].n0, &s);
      lumped_disc_blade(&s.disc, modes, &blade);
      mhb_settings clamped    = s.settings;
      clamped.nodal_diameters = NULL;
      const mhb_multipliers a = of_sector(&places[i], &s.waves.model[0], &s.settings, 0, one);
      const mhb_multipliers b = of_sector(&places[i], &blade, &clamped, 0, all);
      assert_int_equal(a.n, b.n);
      assert_int_equal(a.verdict, b.verdict);
      const double off = distance_to(one, a.n, all, b.n);
      print_message("E = %d, %d modes: apart %.1e, largest %.6f\n", places[i].engine_order, modes,
                    off, a.largest);
      assert_below(off, 1e-7);
      modal_model_free(&blade);
      modal_nodal_diameters_free(&s.waves);
    }
}

/* A disturbance may have any nodal diameter. */
static void all_nodal_diameters_are_needed(void **state) {
  (void)state;
  sector s;
  sector_create(2, 6, 0.8, 5, 0.4, &s);
  assert_true(mhb_judges_stability(&s.settings));
  s.waves.n--;
  assert_false(mhb_judges_stability(&s.settings));
  s.waves.n++;
  s.settings.stability = MHB_STABILITY_NEVER;
  assert_false(mhb_judges_stability(&s.settings));
  modal_nodal_diameters_free(&s.waves);
}

/* Modes that answer statically, because of the number of states or in the file. */
static void higher_modes_may_answer_statically(void **state) {
  static double complex copy[MOST];
  const place           at = {3, 0.93, 5, 0.4, MHB_STABLE, 0};
  mhb_multipliers       out[3];
  (void)state;
  for (int i = 0; i < 3; i++) {
    sector s;
    sector_create(at.engine_order, i == 2 ? 6 : DISC_DOFS, 0.8, at.load, at.n0, &s);
    out[i] = of_sector(&at, &s.waves.model[0], &s.settings, i == 1 ? 2 * N * 7 : 0, copy);
    modal_nodal_diameters_free(&s.waves);
  }
  print_message("largest with 12 modes %.6f, 6 of 12 %.6f, 6 in the file %.6f\n", out[0].largest,
                out[1].largest, out[2].largest);
  assert_int_equal(out[1].modes, 6);
  assert_int_equal(out[2].modes, 6);
  assert_near(out[1].largest, out[0].largest, 1e-3);
  assert_near(out[2].largest, out[1].largest, 1e-4);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(multipliers_are_those_of_the_ring),
      cmocka_unit_test(the_distance_is_that_of_the_substeps),
      cmocka_unit_test(linear_limits_are_those_of_the_ring),
      cmocka_unit_test(an_uncoupled_disc_is_clamped_blades),
      cmocka_unit_test(all_nodal_diameters_are_needed),
      cmocka_unit_test(higher_modes_may_answer_statically),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
