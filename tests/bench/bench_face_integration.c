/* Time integration of a contact face: ms a period against the error.
 *
 *   bench_face_integration                         a beam whose shroud face has 22 patches
 *   bench_face_integration --quick                 the same, few steps
 *   bench_face_integration FILE N0 HZ SCALE        a modal file: contact and excitation of
 *                                                  cases/z_notch_blade, to the ground
 *   bench_face_integration --ring FILE N0 HZ SCALE the same as a ring
 *
 * N0 is the preload in N, SCALE multiplies the load. The motion starts from rest and is integrated
 * for 20 periods. Rows: joint steps, and steps that end at events. Error: of the state at the end,
 * relative, against joint steps four times as many as the most here. The exit code depends on
 * errors only: the most joint steps reach GOAL. */
#include <cblas.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "mesh/base/constants.h"
#include "mhb/integration/steady_state.h"
#include "modal/model/model.h"
#include "tests/support/shroud_face.h"
#include "tests/support/z_notch_settings.h"

enum { PERIODS = 20, PATCHES = 22, LEVELS = 4 };

static const double GOAL = 1e-5;

typedef struct {
  modal_model  model;
  mhb_settings settings;
  double       omega;
  int          steps; /* the fewest */
} scene;

/* Of the periods of one run. */
typedef struct {
  double  ms, events, sweeps, forced; /* a period; sweeps: a step */
  double *state;
} outcome;

static shb_status run(const scene *s, bool joint, int steps, outcome *o) {
  mhb_integrator *g;
  int             done = 0;
  SHB_TRY(mhb_integrator_create_as(&s->model, &s->settings, 7, joint, &g));
  mhb_integrator_set(g, s->omega, s->settings.n0[0], steps);
  mhb_integrator_rest(g);
  clock_t began = clock();
  while (done < PERIODS && mhb_integrator_period(g)) done++;
  *o = (outcome){.ms     = 1e3 * (double)(clock() - began) / CLOCKS_PER_SEC / PERIODS,
                 .events = (double)g->count.events / PERIODS,
                 .forced = (double)g->count.forced / PERIODS,
                 .sweeps = joint ? (double)g->joint->sweeps / PERIODS / steps : 0,
                 .state  = malloc(sizeof(double) * (size_t)mhb_integrator_size(g))};
  if (o->state) mhb_integrator_get(g, o->state);
  mhb_integrator_destroy(g);
  SHB_CHECK(o->state, SHB_ERR_IO, "out of memory");
  SHB_CHECK(done == PERIODS, SHB_NOT_CONVERGED, "forces not found in period %d", done + 1);
  return SHB_OK;
}

/* Distance of a state from another of the same scene; -1: not known. */
static double distance(const scene *s, const double *a, const double *b) {
  mhb_integrator *g;
  if (mhb_integrator_create_as(&s->model, &s->settings, 7, true, &g) != SHB_OK) return -1;
  mhb_integrator_set(g, s->omega, s->settings.n0[0], s->steps);
  mhb_integrator_rest(g);
  double apart = mhb_steady_state_distance(g, a, b);
  mhb_integrator_destroy(g);
  return apart;
}

static double print_row(const scene *s, bool joint, int steps, const outcome *exact) {
  const char *way   = joint ? "joint steps" : "steps to events";
  outcome     o     = {0};
  double      error = INFINITY;
  if (run(s, joint, steps, &o) == SHB_OK) {
    error = distance(s, o.state, exact->state);
    printf("%-16s %6d %12.2f %10.1e %10.1f %8.1f %8.2f\n", way, steps, o.ms, error, o.events,
           o.sweeps, o.forced);
  } else {
    printf("%-16s %6d %s\n", way, steps, shb_message());
  }
  fflush(stdout);
  free(o.state);
  return error;
}

/* Returns whether the goal is missed. */
static int table(const scene *s, bool quick) {
  const int last = quick ? 1 : LEVELS - 1;
  outcome   exact;
  double    error = INFINITY;
  if (run(s, true, s->steps << (last + 2), &exact) != SHB_OK) {
    fprintf(stderr, "bench_face_integration: %s\n", shb_message());
    return 1;
  }
  printf("%-16s %6s %12s %10s %10s %8s %8s\n", "way", "steps", "ms a period", "error", "events",
         "sweeps", "forced");
  for (int k = quick ? last : 0; k <= last; k++) error = print_row(s, true, s->steps << k, &exact);
  if (!quick) print_row(s, false, s->steps, &exact);
  free(exact.state);
  return !(error < GOAL);
}

static shb_status read_scene(char **argument, bool ring, scene *s) {
  s->settings           = z_notch_settings();
  s->settings.n0[0]     = atof(argument[1]);
  s->settings.harmonics = 7;
  s->settings.scale     = atof(argument[3]);
  s->steps              = 48;
  s->omega              = SHB_TWO_PI * atof(argument[2]);
  if (!ring) {
    s->settings.to_ground = true;
    s->settings.blades    = 1;
  }
  return modal_model_read(argument[0], &s->model);
}

int main(int argc, char **argv) {
  openblas_set_num_threads(1); /* small systems: others would only wait, and count as time */
  scene      s      = {.omega = SHB_TWO_PI * 268, .steps = 384};
  bool       quick  = argc == 2 && strcmp(argv[1], "--quick") == 0;
  bool       ring   = argc == 6 && strcmp(argv[1], "--ring") == 0;
  shb_status status = SHB_OK;
  if (argc == 1 || quick) {
    shroud_face_model(PATCHES, 150, &s.model);
    s.settings = shroud_face_settings(7);
  } else if (argc == 5 || ring) {
    status = read_scene(argv + 1 + ring, ring, &s);
  } else {
    fprintf(stderr,
            "bench_face_integration: usage: bench_face_integration [--quick | [--ring] FILE "
            "N0 HZ SCALE]\n");
    return SHB_ERR_INPUT;
  }
  if (status != SHB_OK) fprintf(stderr, "bench_face_integration: %s\n", shb_message());
  int missed = status != SHB_OK || table(&s, quick);
  modal_model_free(&s.model);
  return missed;
}
