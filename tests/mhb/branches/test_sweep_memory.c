/* The memory that a sweep is foreseen to take, against that of runs, and what is refused. The runs
 * are of one blade, of Coriolis terms, of a ring of different blades, and with stability. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "mesh/base/memory.h"
#include "mesh/base/progress.h"
#include "mhb/branches/forced_response.h"
#include "mhb/branches/sweep_memory.h"
#include "mhb/mistuning/deviations.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "tests/support/check.h"
#include "tests/support/little_memory.h"
#include "tests/support/random_disc.h"
#include "tests/support/random_model.h"

typedef struct {
  const char *name;
  int         pairs, harmonics, blades; /* blades 1: on the ground */
  bool        mistuned, coriolis, stability, disc;
} scene;

typedef struct {
  modal_model           model;
  mhb_settings          settings;
  mhb_mistuned_ring    *ring;
  modal_nodal_diameters disc; /* owner of the model, if there is one */
  const modal_model    *whole;
} sweep;

static void make(const scene *c, sweep *s) {
  *s              = (sweep){.settings = random_settings(c->harmonics)};
  const int parts = c->blades > 1 ? WITH_LEFT : 0;
  if (c->disc) {
    random_disc(c->pairs, c->blades, parts | WITH_RESIDUAL, false, 5, &s->disc);
    s->model                    = s->disc.model[0];
    s->settings.nodal_diameters = &s->disc;
  } else {
    random_model(c->pairs, parts, 5, &s->model);
  }
  s->whole                 = &s->model;
  s->settings.blades       = c->blades;
  s->settings.to_ground    = c->blades == 1;
  s->settings.stability    = c->stability ? MHB_STABILITY_ALWAYS : MHB_STABILITY_NEVER;
  s->settings.frequency[0] = 1.00 / 6.283185307179586;
  s->settings.frequency[1] = 1.01 / 6.283185307179586;
  s->settings.search       = (mhb_search_settings){0};
  s->settings.n0[0]        = 0.05; /* most contact points slip */
  if (c->coriolis) {
    const int m       = s->model.n_modes;
    s->model.coriolis = calloc((size_t)(m * m), sizeof(double));
    for (int i = 0; i + 1 < m; i++) {
      s->model.coriolis[i * m + i + 1]   = 0.1;
      s->model.coriolis[(i + 1) * m + i] = -0.1;
    }
  }
  if (!c->mistuned) return;
  double deviation[100];
  assert_int_equal(mhb_deviations_random(0.01, 7, 0, c->blades, deviation), SHB_OK);
  assert_int_equal(mhb_mistuned_ring_create(&s->model, &s->settings, deviation, 1, &s->ring),
                   SHB_OK);
  s->settings.ring = s->ring;
  s->whole         = &s->ring->whole;
}

static void drop(sweep *s) {
  mhb_mistuned_ring_destroy(s->ring);
  if (s->settings.nodal_diameters)
    modal_nodal_diameters_free(&s->disc);
  else
    modal_model_free(&s->model);
}

/* What a process of its own tells: its points, and its most memory in bytes. */
typedef struct {
  int    points;
  double peak;
} measured;

static measured run(const scene *c) {
  int   ends[2], points = -1, status;
  pid_t child;
  assert_int_equal(pipe(ends), 0);
  child = fork();
  if (child == 0) {
    sweep         s;
    mhb_response *r     = NULL;
    shb_progress  quiet = shb_progress_start("test", true, false);
    make(c, &s);
    if (mhb_forced_response(s.whole, &s.settings, NULL, NULL, &quiet, &r) == SHB_OK || r)
      points = r->branch[0].n_points + r->branch[1].n_points + r->branch[2].n_points;
    else
      fprintf(stderr, "%s\n", shb_message());
    if (write(ends[1], &points, sizeof points) != sizeof points) _exit(1);
    _exit(0);
  }
  struct rusage used;
  assert_int_equal(wait4(child, &status, 0, &used), child);
  assert_int_equal(status, 0);
  assert_int_equal(read(ends[0], &points, sizeof points), sizeof points);
  close(ends[0]);
  close(ends[1]);
  assert_true(points > 1);
  return (measured){points, 1024. * (double)used.ru_maxrss};
}

/* Bytes above those of a small sweep; told and measured agree within the band. */
static void memory_is_that_of_runs(void **state) {
  (void)state;
  static const scene least  = {"", 1, 2, 3, true, false, true, false};
  static const scene rows[] = {
      {"one blade, one contact point", 1, 90, 1, false, false, false, false},
      {"one blade, ten contact points", 10, 20, 1, false, false, false, false},
      {"the same with Coriolis terms", 10, 12, 1, false, true, false, false},
      {"30 different blades", 1, 11, 30, true, false, false, false},
      {"8 different blades, four contact points", 4, 5, 8, true, false, false, false},
      {"wave of 30 blades, stability", 2, 2, 30, false, false, true, false},
      {"30 different blades, stability", 1, 4, 30, true, false, true, false},
      {"disc of 12 sectors, ten contact points", 10, 12, 12, false, false, false, true},
      {"disc of 8 sectors, 25 contact points", 25, 7, 8, false, false, false, true},
      {"disc of 20 sectors, stability", 1, 5, 20, false, false, true, true},
  };
  const measured base    = run(&least);
  int            outside = 0; /* of the band */
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const measured found = run(&rows[i]);
    sweep          s;
    make(&rows[i], &s);
    mhb_sweep_size size = mhb_sweep_size_of(s.whole, &s.settings);
    assert_int_equal(size.points, 1000);
    size.points            = found.points;
    const double told      = 1e-6 * mhb_sweep_bytes(&size);
    const double megabytes = 1e-6 * (found.peak - base.peak);
    printf("%-42s %2d harmonics, %3d points: told %6.1f MB, measured %6.1f MB, ratio %.2f\n",
           rows[i].name, rows[i].harmonics, found.points, told, megabytes, told / megabytes);
    outside += !(told > 0.8 * megabytes && told < 3 * megabytes);
    drop(&s);
  }
  assert_int_equal(outside, 0);
}

/* Whole runs of one preload with curves of hundreds of points, measured once; the program itself
 * takes 30 MB. Fewer contacts move than the estimate takes for moving. */
static void memory_is_that_of_whole_runs(void **state) {
  (void)state;
  static const struct {
    int    pairs, harmonics;
    double megabytes;
  } whole[] = {{1, 200, 301}, {4, 200, 1014}, {7, 120, 485}, {8, 120, 549},
               {20, 31, 178}, {60, 7, 128},   {120, 7, 239}};
  for (size_t i = 0; i < sizeof whole / sizeof *whole; i++) {
    mhb_sweep_size size = {
        .pairs = whole[i].pairs, .harmonics = whole[i].harmonics, .wave = 1, .points = 1000};
    const double told  = 1e-6 * mhb_sweep_bytes(&size);
    const double ratio = told / (whole[i].megabytes - 30);
    printf("%3d contact points, %3d harmonics: %.0f MB, %.2f of the measured\n", size.pairs,
           size.harmonics, told, ratio);
    assert_true(ratio > 0.95 && ratio < 2.5);
  }
}

/* Bytes rise with every size. */
static void more_takes_more(void **state) {
  (void)state;
  static const mhb_sweep_size size = {
      .pairs = 9, .harmonics = 7, .blades = 12, .wave = 12, .modes = 6, .points = 1000};
  for (int i = 0; i < 5; i++) {
    mhb_sweep_size more = size;
    if (i == 0) more.pairs++;
    if (i == 1) more.harmonics++;
    if (i == 2) more.blades++;
    if (i == 3) more.points++;
    if (i == 4) more.stability = true;
    assert_true(mhb_sweep_bytes(&more) > mhb_sweep_bytes(&size));
  }
}

/* In a process with little address space: what does not fit is refused, with the largest that
 * does. */
static void too_large_is_refused(void) {
  static const scene ring = {"", 4, 20, 50, true, false, false, false};
  sweep              s;
  int                threads;
  make(&ring, &s);
  assert_int_equal(mhb_sweep_threads(s.whole, &s.settings, &threads), SHB_OK);
  assert_true(threads >= 1);
  double left = little_memory_limit(1.5e9); /* the system of the whole ring takes some GB */
  assert_int_equal(mhb_sweep_threads(s.whole, &s.settings, &threads), SHB_ERR_INPUT);
  puts(shb_message());
  assert_null(strchr(shb_message(), '\n'));
  assert_non_null(strstr(shb_message(), "50 different blades, 4 contact points and 20 harmonics"));
  for (int i = 0; i < 3; i++) {
    static const char *const key[] = {"mhb.harmonics: ", "contact.points: ", "rotor.blades: "};
    mhb_sweep_size           size  = mhb_sweep_size_of(s.whole, &s.settings);
    int *member                    = i == 0 ? &size.harmonics : i == 1 ? &size.pairs : &size.blades;
    *member                        = little_memory_number(key[i]);
    assert_true(mhb_sweep_bytes(&size) <= left + 2e6);
    (*member)++;
    assert_true(mhb_sweep_bytes(&size) > left - 2e6);
  }
  s.settings.sharing = 4; /* a quarter each */
  assert_int_equal(mhb_sweep_threads(s.whole, &s.settings, &threads), SHB_ERR_INPUT);
  puts(shb_message());
  assert_non_null(strstr(shb_message(), "for each of 4 processes"));
  /* a smaller ring fits once or twice, but not four times */
  s.settings.harmonics = 4;
  mhb_sweep_size size  = mhb_sweep_size_of(s.whole, &s.settings);
  left                 = shb_memory_available();
  while (4 * mhb_sweep_bytes(&size) < left) size.harmonics++;
  s.settings.harmonics = size.harmonics;
  assert_int_equal(mhb_sweep_threads(s.whole, &s.settings, &threads), SHB_ERR_INPUT);
  puts(shb_message());
  assert_int_equal(little_memory_number("processes: "), 3);
  s.settings.sharing = 3;
  assert_int_equal(mhb_sweep_threads(s.whole, &s.settings, &threads), SHB_OK);
  assert_int_equal(threads, 1);
  drop(&s);
}

static void what_does_not_fit_is_refused(void **state) {
  (void)state;
  little_memory_run(too_large_is_refused);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(memory_is_that_of_runs),
      cmocka_unit_test(memory_is_that_of_whole_runs),
      cmocka_unit_test(more_takes_more),
      cmocka_unit_test(what_does_not_fit_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
