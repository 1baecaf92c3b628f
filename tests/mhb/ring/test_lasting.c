/* Settling beside a wave: the rules on made-up series, a modulated ring against slow integration,
 * the rule of pairs, and what is not computed. */
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "mesh/base/constants.h"
#include "mhb/integration/integrator.h"
#include "mhb/ring/lasting.h"
#include "mhb/ring/ring_output.h"
#include "mhb/ring/side_waves.h"
#include "tests/support/check.h"
#include "tests/support/main_curve.h"
#include "tests/support/random_model.h"

/* ---- rules ---- */

enum { BLOCKS = 18, PEAKS = 400 };

typedef struct {
  double mean[BLOCKS], spread[BLOCKS], peak[PEAKS];
} made_up;

/* Blocks of mean m with noise, a spread that falls by a factor a block, peaks up to m w. */
static mhb_lasting_series make(made_up *x, double m, double noise, double spread, double factor,
                               double w) {
  for (int i = 0; i < BLOCKS; i++) {
    x->mean[i]   = m * (1 + noise * sin(7.3 * i * i));
    x->spread[i] = spread * pow(factor, i);
  }
  for (int i = 0; i < PEAKS; i++) x->peak[i] = m * (1 + (w - 1) * i / (PEAKS - 1));
  return (mhb_lasting_series){BLOCKS, PEAKS, x->mean, x->spread, x->peak, false};
}

typedef struct {
  double mean, noise, spread, factor, worst; /* of the first start */
  double other, share;                       /* mean of the second over that; of five lines */
  bool   last, decided;
  int    kind;
} rule;

/* Motions that two starts of these series show, 0: more is wanted. The larger becomes lead. */
static int decide(const mhb_lasting_series s[2], bool last, mhb_motion *lead) {
  const mhb_motion a = mhb_motion_of(&s[0], last), b = mhb_motion_of(&s[1], last);
  *lead = a;
  if (mhb_starts_agree(&a, &b, BLOCKS)) {
    *lead = mhb_motions_joined(&a, &b);
    return 1;
  }
  if (mhb_start_judge(&a, BLOCKS, last, INFINITY) == MHB_START_GOES_ON) return 0;
  const mhb_start_verdict second = mhb_start_judge(&b, BLOCKS, last, mhb_motion_distance(&a, &b));
  if (second == MHB_START_IS_NEW && mhb_motion_worst(&b, b.wave) > mhb_motion_worst(&a, a.wave))
    *lead = b;
  return second == MHB_START_IS_NEW ? 2 : second == MHB_START_JOINS ? 1 : 0;
}

static void the_rules_hold(void **state) {
  (void)state;
  static const rule rules[] = {
      {1.001, 1e-4, 1e-3, 1, 1, 1, 1, false, true, MHB_LASTING_WAVE},
      {1.001, 1e-4, .1, .85, 1, 1, 1, false, true, MHB_LASTING_WAVE},   /* comes back */
      {1.001, 1e-4, .1, .97, 1.03, 1, 1, true, true, MHB_LASTING_MILD}, /* too slowly */
      {1.001, 1e-4, .1, .97, 1.03, 1, 1, false, false, MHB_LASTING_UNKNOWN},
      {1.001, 1e-4, .01, 1.1, 1.03, 1, 1, false, false, MHB_LASTING_UNKNOWN}, /* still grows */
      {.97, 1e-3, .1, 1, 1.05, 1, .9, false, true, MHB_LASTING_MILD},
      {.90, 1e-3, .1, 1, 1.05, 1, .9, false, true, MHB_LASTING_MODULATED}, /* by the mean */
      {.99, 1e-3, .1, 1, 1.2, 1, .9, false, true, MHB_LASTING_MODULATED},  /* by the worst */
      {1.3, 1e-3, .4, 1, 1.4, 1, .4, false, true, MHB_LASTING_IRREGULAR},
      {1.2, 1e-3, .3, 1, 1.2, 1.1, .9, true, true, MHB_LASTING_SEVERAL},
      {1.2, 1e-3, .3, 1, 1.2, 1.1, .9, false, false, MHB_LASTING_UNKNOWN}, /* more is wanted */
      {1.2, .2, .3, 1, 1.2, 1, .9, false, false, MHB_LASTING_UNKNOWN},     /* not settled */
      {.43, 1e-4, 1e-3, 1, 1, 1, 1, false, true, MHB_LASTING_SEVERAL},     /* another wave */
  };
  for (size_t i = 0; i < sizeof rules / sizeof *rules; i++) {
    const rule        *r = &rules[i];
    made_up            x[2];
    mhb_lasting_series s[2] = {
        make(&x[0], r->mean, r->noise, r->spread, r->factor, r->worst),
        make(&x[1], r->mean * r->other, r->noise, r->spread, r->factor, r->worst)};
    mhb_motion lead;
    const int  n = decide(s, r->last, &lead);
    print_message("%2zu: %d motions, mean %.4f worst %.4f error %.4f\n", i, n, lead.half.mean,
                  lead.worst, lead.half.error);
    assert_int_equal(n > 0, r->decided);
    if (n > 0) assert_int_equal(mhb_lasting_kind_of(n, &lead, r->share), r->kind);
    if (n > 1) assert_within(lead.half.mean, r->mean * r->other, .01);
  }
}

/* Which motion a further start has reached: a known one 0.5 % or 5 % away, or none that is known. A
 * start whose mean still scatters by 2 % belongs to a known motion if it does not drift. */
static void a_start_joins_or_goes_on(void **state) {
  (void)state;
  static const struct {
    double            noise, factor, away;
    int               blocks;
    bool              last;
    mhb_start_verdict verdict;
  } rows[] = {
      {1e-3, 1, .5, 5, false, MHB_START_JOINS},     {1e-3, 1, 1.5, 5, false, MHB_START_GOES_ON},
      {1e-3, 1, 5, 18, false, MHB_START_GOES_ON},   {1e-3, 1, 5, 27, false, MHB_START_IS_NEW},
      {.06, 1, .5, 5, false, MHB_START_JOINS},      {.06, 1, 5, 27, false, MHB_START_GOES_ON},
      {.2, 1, .5, 5, false, MHB_START_GOES_ON},     {1e-3, 1.1, .5, 5, false, MHB_START_GOES_ON},
      {.2, 1, 5, 40, true, MHB_START_UNTOLD},       {.2, 1, 1.5, 40, true, MHB_START_JOINS},
      {.2, 1, INFINITY, 40, true, MHB_START_IS_NEW}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    made_up            x;
    mhb_lasting_series s      = make(&x, 1.2, rows[i].noise, .1, rows[i].factor, 1.3);
    s.blocks                  = 16;
    const mhb_motion        m = mhb_motion_of(&s, rows[i].last);
    const mhb_start_verdict v = mhb_start_judge(&m, rows[i].blocks, rows[i].last, rows[i].away);
    print_message("%2zu: error %.4f, settled %d, calm %d: verdict %d\n", i, m.half.error, m.settled,
                  m.calm, (int)v);
    assert_int_equal(v, rows[i].verdict);
  }
}

/* ---- a modulated ring ---- */

enum { HARMONICS = 7 };

typedef struct {
  modal_model   model;
  mhb_settings  settings;
  mhb_response *curves;
  mhb_wave      wave;
} modulated;

/* Six blades, engine order 1, lightly damped: at 0.923 rad/s the wave slips, opens, and is
 * modulated. The modulated point that is nearest. */
static void create(modulated *c, double omega) {
  random_model(1, WITH_LEFT, 1, &c->model);
  for (int i = 0; i < 6; i++) c->model.damping_ratio[i] = .003;
  c->settings              = random_settings(HARMONICS);
  c->settings.tolerance    = 1e-8;
  c->settings.n0[0]        = .15;
  c->settings.frequency[0] = .85 / SHB_TWO_PI;
  c->settings.frequency[1] = .95 / SHB_TWO_PI;
  c->settings.stability    = MHB_STABILITY_ALWAYS;
  assert_ok(main_curve(&c->model, &c->settings, HARMONICS, NULL, &c->curves));
  const mhb_branch *b  = &c->curves->branch[0];
  int               at = -1;
  for (int i = 0; i < b->n_points; i++)
    if (b->stable[i] == 0 && b->loss[i] == MHB_LOSS_NEIMARK_SACKER &&
        (at < 0 ||
         fabs(SHB_TWO_PI * b->frequency[i] - omega) < fabs(SHB_TWO_PI * b->frequency[at] - omega)))
      at = i;
  assert_true(at >= 0);
  size_t row = 3 * (size_t)(b->n_harmonics + 1);
  c->wave    = (mhb_wave){SHB_TWO_PI * b->frequency[at], .15, b->n_harmonics,
                          b->force + (size_t)at * row, 0};
}

static void print_motions(const mhb_lasting *r) {
  print_message("%d starts, %d periods:", r->starts, r->periods);
  for (int i = 0; i < r->n_motions; i++)
    print_message(" %.4f/%.4f by %d", r->motion[i].half.mean, r->motion[i].worst,
                  r->motion[i].starts);
  print_message("\n");
}

static void destroy(modulated *c) {
  mhb_response_destroy(c->curves);
  modal_model_free(&c->model);
}

/* Peaks of probe 0 of every blade in the slow integrator. */
typedef struct {
  int            blades, modes, n;
  double complex free[3][3];    /* [harmonic][axis] without contact */
  double         x[2048][6][3]; /* of a period */
} listener;

static void listen(void *context, const mhb_integrator *g, double t0, double h) {
  listener *o = context;
  (void)h;
  if (o->n >= 2048) return;
  for (int b = 0; b < o->blades; b++)
    for (int c = 0; c < 3; c++) {
      double sum = 0, phase = g->omega * t0 - mhb_integrator_lag(g, b);
      for (int k = 0; k < 3; k++) sum += creal(o->free[k][c] * cexp(I * k * phase));
      for (int i = 0; i < o->modes; i++)
        sum += g->receptance->model->probe[c * o->modes + i] * g->z[b * o->modes + i];
      o->x[o->n][b][c] = sum;
    }
  o->n++;
}

static double mean_peak(const listener *o) {
  double sum = 0;
  for (int b = 0; b < o->blades; b++) {
    double mean[3] = {0}, peak = 0;
    for (int i = 0; i < o->n; i++)
      for (int c = 0; c < 3; c++) mean[c] += o->x[i][b][c] / o->n;
    for (int i = 0; i < o->n; i++) {
      double square = 0;
      for (int c = 0; c < 3; c++) square += pow(o->x[i][b][c] - mean[c], 2);
      peak = fmax(peak, sqrt(square));
    }
    sum += peak / o->blades;
  }
  return sum;
}

/* Mean over blades and the last half of the periods of the peaks, over that of the first period of
 * the wave, by mhb/integration. */
static double slow_mean(const modulated *c, int periods) {
  mhb_integrator *g;
  static listener o;
  int             K = c->wave.n_harmonics + 1;
  double complex  force[3 * K], none[3] = {0}, motion[6];
  double          sum = 0, wave = 0;
  assert_ok(mhb_integrator_create(&c->model, &c->settings, HARMONICS, &g));
  mhb_integrator_set(g, c->wave.omega, c->wave.n0, 48);
  for (int k = 0; k < K; k++)
    for (int i = 0; i < 3; i++) force[k * 3 + i] = c->wave.force[i * K + k];
  o = (listener){.blades = g->blades, .modes = g->modes};
  for (int k = 0; k < 3; k++) {
    mhb_receptance_probe(g->receptance, k, none, motion);
    memcpy(o.free[k], motion, sizeof o.free[k]);
  }
  mhb_integrator_balance(g, c->wave.n_harmonics, force);
  g->watch   = listen;
  g->context = &o;
  for (int i = 0; i < periods; i++) {
    o.n = 0;
    assert_true(mhb_integrator_period(g));
    if (i == 0) wave = mean_peak(&o);
    if (i == 0)
      for (int k = 0; k < 2 * g->blades * g->modes; k++) g->z[k] *= 1 + .1 * sin(2.385 * k);
    if (i >= periods / 2) sum += mean_peak(&o) / (periods - periods / 2);
  }
  mhb_integrator_destroy(g);
  return sum / wave;
}

/* Of the first start alone the motion would be told as one. */
static void a_modulated_ring_has_the_statistics_of_slow_integration(void **state) {
  (void)state;
  modulated   c;
  mhb_lasting fast;
  double      away = 1;
  create(&c, .9233);
  assert_ok(mhb_lasting_settle(&c.model, &c.settings, &c.wave, NULL, &fast));
  double slow = slow_mean(&c, 400);
  print_message("kind %d: mean %.4f +- %.4f, worst %.4f, side wave %d at %+.4f; slow mean %.4f\n",
                fast.kind, fast.mean, fast.error, fast.worst, fast.diameter, fast.offset, slow);
  print_motions(&fast);
  for (int i = 0; i < fast.n_motions; i++)
    away = fmin(away, fabs(fast.motion[i].half.mean / slow - 1));
  assert_below(away, .01);
  assert_true(fast.worst > fast.mean);
  destroy(&c);
}

/* Two motions live at this frequency, each reached by about half of all starts (bench_lasting
 * --starts). */
static void several_motions_are_found_and_told(void **state) {
  (void)state;
  modulated   c;
  mhb_lasting r;
  int         sum = 0;
  create(&c, .9233);
  assert_ok(mhb_lasting_settle(&c.model, &c.settings, &c.wave, NULL, &r));
  print_motions(&r);
  for (int i = 0; i < r.n_motions; i++) sum += r.motion[i].starts;
  assert_int_equal(r.kind, MHB_LASTING_SEVERAL);
  assert_int_equal(r.n_motions, 2);
  assert_int_equal(r.starts, MHB_LASTING_STARTS);
  assert_int_equal(sum, r.starts);
  assert_in_range(r.reached, 4, 13);
  assert_true(r.worst > 1.1 * r.least_worst && r.mean > 1.03 * r.least);
  /* 17 starts in coarse steps, and all copies that measure */
  assert_below(r.periods, (MHB_LASTING_STARTS * 18 + MHB_LANES * 8) * MHB_START_BLOCK);
  destroy(&c);
}

/* With two starts only; then from the state of a neighbour, whose motion is the larger one. */
static void a_neighbours_motion_is_carried_on(void **state) {
  (void)state;
  modulated       c, next;
  mhb_lasting     few, other;
  mhb_ring_state  from = {.omega = 0}, to = {.omega = 0};
  mhb_lasting_run short_ = {.most_periods = 1}, keep = {.state = &from},
                  carry = {.from = &from, .state = &to};
  create(&c, .9248);
  create(&next, .9233);
  next.wave.lowest = c.wave.lowest = next.wave.omega;
  assert_ok(mhb_lasting_settle(&c.model, &c.settings, &c.wave, &short_, &few));
  print_motions(&few);
  assert_int_equal(few.starts, 2);
  assert_int_equal(few.n_motions, 1);
  assert_ok(mhb_lasting_settle(&next.model, &next.settings, &next.wave, &keep, &other));
  print_motions(&other);
  assert_true(other.size > 1.03 * few.size);
  const double before = few.worst;
  assert_ok(mhb_lasting_settle(&c.model, &c.settings, &c.wave, &carry, &few));
  print_motions(&few);
  assert_int_equal(few.n_motions, 2);
  assert_int_equal(few.kind, MHB_LASTING_SEVERAL);
  assert_int_equal(few.starts, 2);
  assert_int_equal(few.reached, 0);
  assert_near(few.least_worst, before, 1e-12);
  assert_true(few.worst > 1.1 * before && to.omega > 0);
  const double worst = few.worst;
  const int    n     = few.n_motions;
  assert_ok(mhb_lasting_settle(&c.model, &c.settings, &c.wave, &carry, &few)); /* known now */
  assert_true(few.worst == worst && few.n_motions == n);
  shb_arena_free(&from.arena);
  shb_arena_free(&to.arena);
  destroy(&c);
  destroy(&next);
}

/* Copies side by side, each from a state of its own, against rings alone: the same operations in
 * other lanes. */
static void copies_are_rings_of_their_own(void **state) {
  (void)state;
  enum { COPIES = 3, PERIODS = 4, MOST = 400 };
  modulated c;
  double    away = 0, size = 0;
  create(&c, .9233);
  mhb_ring_model *m[2];
  mhb_ring        ring[2];
  mhb_ring_output out[2];
  double          q[2][MOST], v[2][MOST], space[4 * MOST];
  for (int i = 0; i < 2; i++) {
    assert_ok(mhb_ring_model_create_copies(&c.model, &c.settings, .15, c.wave.omega, i ? COPIES : 1,
                                           &m[i]));
    mhb_ring_model_set(m[i], c.wave.omega, 64);
    mhb_ring_create(m[i], &ring[i]);
    mhb_ring_output_create(&ring[i], &out[i]);
    assert_true(m[i]->modes * m[i]->lanes <= MOST);
    mhb_ring_start(&ring[i], c.wave.n_harmonics, c.wave.force);
  }
  for (int k = 0; k < COPIES; k++) {
    mhb_noise noise = {.state = 7 + (unsigned)k};
    mhb_ring_disturb_copy(&ring[1], k, &out[1], .05, &noise);
  }
  mhb_ring_state kept = {.omega = 0};
  for (int i = 0; i < PERIODS; i++) mhb_ring_period(&ring[1]);
  mhb_ring_get(&ring[1], q[1], v[1]);
  for (int k = 0; k < COPIES; k++) {
    mhb_noise noise = {.state = 7 + (unsigned)k};
    mhb_ring_start(&ring[0], c.wave.n_harmonics, c.wave.force);
    mhb_ring_disturb_copy(&ring[0], 0, &out[0], .05, &noise);
    for (int i = 0; i < PERIODS; i++) {
      mhb_ring_period(&ring[0]);
      if (i > 0) continue; /* a state is kept and taken up again */
      mhb_ring_save(&ring[0], 0, space, &kept);
      mhb_ring_load(&ring[0], 0, &kept, space);
    }
    mhb_ring_get(&ring[0], q[0], v[0]);
    for (int i = 0; i < m[0]->modes * m[0]->blades; i++) {
      const int mode = i / m[0]->blades, b = i % m[0]->blades;
      away = fmax(away,
                  fabs(q[0][mode * m[0]->lanes + b] - q[1][mode * m[1]->lanes + b * COPIES + k]));
      size = fmax(size, fabs(q[0][mode * m[0]->lanes + b]));
    }
  }
  print_message("copies and rings alone: apart %.1e\n", away / size);
  assert_below(away / size, 1e-11);
  shb_arena_free(&kept.arena);
  for (int i = 0; i < 2; i++) {
    mhb_ring_output_destroy(&out[i]);
    mhb_ring_destroy(&ring[i]);
    mhb_ring_model_destroy(m[i]);
  }
  destroy(&c);
}

static void seventeen_starts_leave_five_per_cent(void **state) {
  (void)state;
  assert_below(mhb_response_lasting_missed(MHB_LASTING_STARTS), .05);
  assert_true(mhb_response_lasting_missed(MHB_LASTING_STARTS - 1) > .05);
}

/* Side waves of the same ring after 200 periods from a disturbed start. The partner of the
 * strongest is among the next four. */
static void side_waves_come_in_pairs(void **state) {
  (void)state;
  enum { PERIODS = 64, N = 6 };
  modulated       c;
  mhb_ring_model *m;
  mhb_ring        ring;
  mhb_ring_output out;
  mhb_noise       noise = {.state = 1};
  mhb_side_waves  found;
  double         *x = calloc((size_t)(PERIODS * MHB_SIDE_SAMPLES * 3 * N), sizeof *x);
  create(&c, .9233);
  assert_ok(mhb_ring_model_create(&c.model, &c.settings, .15, c.wave.omega, &m));
  mhb_ring_model_set(m, c.wave.omega, 256);
  mhb_ring_create(m, &ring);
  mhb_ring_output_create(&ring, &out);
  mhb_ring_start(&ring, c.wave.n_harmonics, c.wave.force);
  mhb_ring_disturb(&ring, &out, .05, &noise);
  for (int i = -200; i < PERIODS; i++) {
    mhb_ring_period(&ring);
    for (int j = 0; i >= 0 && j < MHB_SIDE_SAMPLES * 3; j++)
      for (int b = 0; b < N; b++)
        x[(i * MHB_SIDE_SAMPLES * 3 + j) * N + b] =
            ring.output[((j / 3 * 4 + 3) * 3 + j % 3) * m->lanes + b];
  }
  mhb_side_waves_find(x, PERIODS, N, 1, &found);
  const mhb_side_wave *a = &found.wave[0], *b = NULL;
  for (int i = 1; i < MHB_SIDE_WAVES; i++)
    if ((a->diameter + found.wave[i].diameter) % N == 2 &&
        fabs(a->offset + found.wave[i].offset) < 2e-3)
      b = &found.wave[i];
  assert_non_null(b);
  print_message("side waves %d at %+.4f (%.3f), %d at %+.4f (%.3f)\n", a->diameter, a->offset,
                a->size, b->diameter, b->offset, b->size);
  free(x);
  mhb_ring_output_destroy(&out);
  mhb_ring_destroy(&ring);
  mhb_ring_model_destroy(m);
  destroy(&c);
}

/* ---- what is not computed ---- */

static bool few_calls(void *context) {
  return ++*(int *)context < 20;
}

static void an_interrupted_point_is_not_computed(void **state) {
  (void)state;
  modulated       c;
  mhb_lasting     result;
  int             calls = 0;
  mhb_lasting_run run   = {.go_on = few_calls, .context = &calls};
  create(&c, .9233);
  assert_ok(mhb_lasting_settle(&c.model, &c.settings, &c.wave, &run, &result));
  assert_int_equal(result.kind, MHB_LASTING_UNKNOWN);
  assert_int_equal(calls, 20);
  destroy(&c);
}

/* Stiffness 1e8 times that of the modes: no number of steps up to 4096 is stable. */
static void a_contact_too_stiff_is_not_computed(void **state) {
  (void)state;
  modulated   c;
  mhb_lasting result;
  create(&c, .9233);
  c.settings.kv = 1e8;
  assert_ok(mhb_lasting_settle(&c.model, &c.settings, &c.wave, NULL, &result));
  assert_int_equal(result.kind, MHB_LASTING_UNKNOWN);
  destroy(&c);
}

/* ---- memory ---- */

/* Most memory, bytes, of a process of its own that settles a ring of so many blades. */
static double memory_of(int blades) {
  int           status;
  struct rusage used;
  const pid_t   child = fork();
  if (child == 0) {
    modulated             c;
    mhb_lasting           result;
    const mhb_lasting_run few = {.most_periods = 1};
    create(&c, .9233);
    c.settings.blades = blades;
    _exit(mhb_lasting_settle(&c.model, &c.settings, &c.wave, &few, &result) != SHB_OK ||
          result.kind == MHB_LASTING_UNKNOWN);
  }
  assert_int_equal(wait4(child, &status, 0, &used), child);
  assert_int_equal(status, 0);
  return 1024. * (double)used.ru_maxrss;
}

/* The memory that is foreseen against that of runs. */
static void memory_is_foreseen(void **state) {
  enum { FEW = 6, MANY = 120 };
  (void)state;
  const double told = mhb_lasting_bytes(MANY, 1, 6, false) - mhb_lasting_bytes(FEW, 1, 6, false);
  const double measured = memory_of(MANY) - memory_of(FEW);
  print_message("%d blades: told %.1f MB, measured %.1f MB\n", MANY, 1e-6 * told, 1e-6 * measured);
  assert_true(told > 0.8 * measured && told < 3 * measured);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(memory_is_foreseen),
      cmocka_unit_test(the_rules_hold),
      cmocka_unit_test(a_start_joins_or_goes_on),
      cmocka_unit_test(copies_are_rings_of_their_own),
      cmocka_unit_test(a_modulated_ring_has_the_statistics_of_slow_integration),
      cmocka_unit_test(several_motions_are_found_and_told),
      cmocka_unit_test(a_neighbours_motion_is_carried_on),
      cmocka_unit_test(seventeen_starts_leave_five_per_cent),
      cmocka_unit_test(side_waves_come_in_pairs),
      cmocka_unit_test(an_interrupted_point_is_not_computed),
      cmocka_unit_test(a_contact_too_stiff_is_not_computed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
