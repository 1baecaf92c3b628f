#include "mhb/integration/integration_memory.h"

#include <complex.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>

#include "mesh/base/memory.h"
#include "mhb/integration/contact_step.h"
#include "mhb/integration/steady_state.h"
#include "modal/model/residual_series.h"

static const double real = sizeof(double), complex_number = sizeof(double complex);

/* Heap and scratch of a thread that are no large arrays: the smallest runs of
 * test_integration_memory. */
static const double A_THREAD = 1e6;

mhb_integration_size mhb_integration_size_of(const modal_model *model, const mhb_settings *s,
                                             int harmonics, int points) {
  return (mhb_integration_size){.pairs     = model->n_pairs,
                                .blades    = s->to_ground ? 1 : s->blades,
                                .both      = !s->to_ground,
                                .residual  = model->residual_flexibility != NULL,
                                .inertia   = model->residual_inertia != NULL,
                                .coriolis  = model->coriolis != NULL,
                                .modes     = model->n_modes,
                                .probes    = model->n_probes,
                                .harmonics = harmonics,
                                .points    = points,
                                .threads   = omp_get_max_threads()};
}

/* The structure that is integrated. */
typedef struct {
  double pairs, blades, rows, modes; /* of a blade; rows: dofs of both sides */
  double neighbours;                 /* blades whose contacts move a blade, itself included */
  double harmonics;
} structure;

static structure structure_of(const mhb_integration_size *z) {
  const double joined = z->dense ? z->blades : 1;
  structure    s      = {.pairs      = joined * z->pairs,
                         .blades     = z->dense ? 1 : z->blades,
                         .rows       = 3. * z->pairs * joined * (z->both ? 2 : 1),
                         .modes      = joined * z->modes,
                         .neighbours = 1,
                         .harmonics  = z->harmonics + 1.};
  if (z->both && !z->dense) s.neighbours = z->blades < 3 ? z->blades : 3;
  if (z->inertia) s.modes += fmin(s.rows, MHB_INERTIA_MODES);
  return s;
}

/* Joint steps: modes, flexibility, and what the contacts do. */
static double of_joint_steps(const structure *s) {
  const double each = sizeof(mhb_contact_path) + real * 2 * MHB_STAGE_FORCES;
  return real * s->modes * (MHB_MODAL_STEP_ROWS + MHB_STAGES * (MHB_STAGES + s->blades)) +
         real * s->neighbours * 9 * s->pairs * s->pairs + s->pairs * sizeof(mhb_contact_spring) +
         s->blades * s->pairs * each;
}

/* Compliances of the contacts over the usual step and over a shorter one. */
static double of_steps(const structure *s) {
  enum { STEPS = 2, SQUARE = MHB_STAGE_FORCES * MHB_STAGE_FORCES };
  const double pair = real * s->neighbours * s->pairs * s->pairs;
  return STEPS * (pair * SQUARE + s->pairs * sizeof(mhb_stuck_factor) +
                  real * MHB_MODAL_STEP_ROWS * s->modes) +
         45 * pair; /* moments: 3 x 3 x 5 */
}

/* Receptances, shapes by harmonic in two forms, residual terms, and flexibilities; that of a ring
 * joins all its contacts. */
static double of_structure(const mhb_integration_size *z, const structure *s) {
  enum { SHAPES = 3, SQUARES = 3, OF_INERTIA = 4, BLOCKS = 6 };
  const double n = 3 * s->pairs, squares = SQUARES + (z->inertia ? OF_INERTIA : 0);
  const double ring =
      s->neighbours > 1 && z->residual ? n * n * (s->blades * s->blades + BLOCKS) : 0;
  const double terms = z->residual ? n + MODAL_TERMS * 3. * z->probes : 0;
  return complex_number * s->harmonics * n * (n + 2 * s->modes + terms) +
         real * (SHAPES * s->rows * s->modes + squares * s->rows * s->rows + ring);
}

/* With Coriolis terms: matrix and factor of each harmonic, gyroscopic modes, motion and force of
 * the amplitudes. The matrix of joined blades is small beside these. */
static double of_coriolis(const mhb_integration_size *z, const structure *s) {
  enum { SQUARES = 2, OF_MODES = 6, AMPLITUDES = 4 };
  if (!z->coriolis) return 0;
  return complex_number * s->modes * s->modes * (SQUARES * s->harmonics + OF_MODES) +
         real * AMPLITUDES * s->rows * s->modes;
}

/* States of the last periods, and harmonics of the last one. */
static double of_steady_state(const structure *s) {
  enum { HISTORY = 2 * MHB_STEADY_STATE_MULTIPLE + 1 };
  const double contacts = s->blades * s->pairs;
  return real * HISTORY * 2 * (s->blades * s->modes + contacts) +
         contacts * (3 * complex_number * s->harmonics + sizeof(mhb_contact_point) +
                     sizeof(mhb_contact_step));
}

static double of_a_thread(const mhb_integration_size *z) {
  const structure s     = structure_of(z);
  const bool      joint = s.pairs >= MHB_JOINT_PAIRS && !z->coriolis;
  return (joint ? of_joint_steps(&s) : of_steps(&s)) + of_structure(z, &s) + of_coriolis(z, &s) +
         of_steady_state(&s) + A_THREAD;
}

/* Motion and force of a point, once where it is found and once as it is written; its start. */
static double of_points(const mhb_integration_size *z) {
  enum { COPIES = 2, STARTS = 1 };
  const double joined = z->dense ? z->blades : 1, n = 3 * joined * z->pairs;
  const double found = 2 * n + 3 * joined * z->probes;
  return complex_number * z->points * (z->harmonics + 1.) * (COPIES * found + STARTS * n);
}

/* Blades joined to one structure: its squares are there before it is integrated. */
static double of_joining(const mhb_integration_size *z) {
  enum { SQUARES = 6 };
  const structure s = structure_of(z);
  return z->dense ? real * s.rows * (SQUARES * s.rows + 2 * s.modes) : 0;
}

double mhb_integration_bytes(const mhb_integration_size *size) {
  return of_a_thread(size) + of_points(size) + of_joining(size);
}

static double bytes_of(const void *size) {
  return mhb_integration_bytes(size);
}

static shb_status refuse(const mhb_integration_size *size, double left) {
  mhb_integration_size    z        = *size;
  const shb_memory_number number[] = {{"contact.points", &z.pairs, 1},
                                      {"integrate.harmonics", &z.harmonics, 1},
                                      {"rotor.blades", &z.blades, 2},
                                      {"points", &z.points, 1}};
  char                    ring[32] = "", what[160];
  if (z.blades > 1) snprintf(ring, sizeof ring, "%d blades, ", z.blades);
  snprintf(what, sizeof what,
           "the time integration of %s%d contact point%s, %d harmonics and %d points", ring,
           z.pairs, z.pairs == 1 ? "" : "s", z.harmonics, z.points);
  return shb_memory_refuse(&(shb_memory_need){what, bytes_of, &z, 4, number, left, 1});
}

shb_status mhb_integration_threads(const mhb_integration_size *size, int *threads) {
  const double left = shb_memory_available(), all = mhb_integration_bytes(size);
  *threads = size->threads;
  if (all > left) return refuse(size, left);
  const double more = (left - all) / of_a_thread(size); /* threads beside the first */
  if (more < *threads - 1) *threads = 1 + (int)more;
  return SHB_OK;
}
