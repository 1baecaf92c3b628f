#include "mhb/floquet/monodromy.h"
#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/numerics/lu.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Shorter intervals between events, in periods, are skipped. */
static const double SHORT = 1e-13;

mhb_monodromy *mhb_monodromy_create(const mhb_modal_structure     *s,
                                    const mhb_transition_schedule *schedule,
                                    mhb_contact_evaluator *contact, int m, int substeps, int finest,
                                    bool condensed) {
  mhb_monodromy *d      = shb_alloc_zeroed(1, sizeof *d);
  int            blades = schedule->cell, capacity = 2 * blades * (s->modes + s->pairs);
  int            pieces = schedule->capacity + 1;
  int            steps  = finest * ((int)(substeps * schedule->span) + 1 + pieces);
  size_t         cells  = (size_t)(s->blades / blades);
  d->blades             = blades;
  d->structure          = s;
  d->schedule           = schedule;
  d->substeps           = substeps;
  d->column             = shb_arena_take(&d->arena, (size_t)s->contacts, sizeof *d->column);
  d->u                  = shb_arena_take(&d->arena, 3 * (size_t)s->contacts, sizeof *d->u);
  d->matrix =
      shb_arena_take(&d->arena, 9 * (size_t)s->contacts * (size_t)s->contacts, sizeof *d->matrix);
  d->is_spring = shb_arena_take(&d->arena, (size_t)s->contacts, sizeof *d->is_spring);
  d->of_u      = shb_arena_take(&d->arena, (size_t)s->contacts, sizeof *d->of_u);
  d->of_sigma  = shb_arena_take(&d->arena, (size_t)s->contacts, sizeof *d->of_sigma);
  d->pivot     = shb_arena_take(&d->arena, 3 * (size_t)s->contacts, sizeof *d->pivot);
  d->steps     = shb_arena_take(&d->arena, (size_t)pieces, sizeof *d->steps);
  d->n_events  = -1;
  d->M = shb_arena_take(&d->arena, cells * (size_t)capacity * (size_t)capacity, sizeof *d->M);
  if (condensed) d->springs = mhb_stuck_springs_create(s);
  d->variational = mhb_variational_create(s, d->springs, capacity);
  d->orbit       = mhb_orbit_contacts_create(s, schedule, contact, m, steps + pieces + 1);
  return d;
}

void mhb_monodromy_destroy(mhb_monodromy *d) {
  if (!d) return;
  mhb_variational_destroy(d->variational);
  mhb_stuck_springs_destroy(d->springs);
  mhb_orbit_contacts_destroy(d->orbit);
  shb_arena_free(&d->arena);
  free(d);
}

void mhb_monodromy_forget(mhb_monodromy *d) {
  mhb_variational_forget(d->variational);
  if (d->springs) mhb_stuck_springs_forget(d->springs);
}

/* Rows q and v of all blades. */
static int modal_states(const mhb_modal_structure *s) {
  return 2 * s->modes * s->blades;
}

static int friction_states(const mhb_monodromy *d, int contact) {
  return mhb_friction_states(d->schedule->state[contact], d->schedule->constant_state[contact],
                             d->orbit->point[contact].law->mu);
}

/* ---- columns ---- */

/* Forces of a contact at the start: dp = of_u (v, u, w) + of_sigma sigma. */
static void start_force(const mhb_contact_state *point, int constant_state, double of_u[3][3],
                        double of_sigma[3][2]) {
  const mhb_law *law = point->law;
  memset(of_u, 0, sizeof(double) * 9);
  memset(of_sigma, 0, sizeof(double) * 6);
  if (point->state == MHB_SEPARATE) return;
  of_u[0][0] = law->kv;
  if (law->mu == 0) return;
  if (point->state == MHB_STICK && constant_state) mhb_linearised_law_rate(point, of_u);
  for (int i = 0; i < 2; i++) {
    if (point->state == MHB_STICK && !constant_state) of_sigma[1 + i][i] = 1;
    if (point->state != MHB_SLIDE) continue;
    of_u[1 + i][0]     = law->mu * law->kv * point->e[i];
    of_sigma[1 + i][0] = i ? point->e[0] : -point->e[1];
  }
}

/* With residual flexibility du = B dq - R dp(du, sigma): factors of d->matrix = I + R of_u. */
static int start_matrix(mhb_monodromy *d) {
  const mhb_modal_structure *s = d->structure;
  int                        n = 3 * s->contacts;
  for (int column = 0; column < n; column++) {
    double of_u[3][3], of_sigma[3][2];
    int    j = column / 3, c = column % 3;
    start_force(&d->orbit->point[j], d->schedule->constant_state[j], of_u, of_sigma);
    for (int r = 0; r < n; r++) {
      const double *R   = s->flexibility + (size_t)r * (size_t)n + (size_t)(3 * j);
      double        sum = r == column;
      for (int k = 0; k < 3; k++) sum += R[k] * of_u[k][c];
      d->matrix[(size_t)r * (size_t)n + (size_t)column] = sum;
    }
  }
  return mhb_factor_real(n, d->matrix, d->pivot);
}

/* Motion u of the contacts at the start by a unit disturbance. contact < 0: of mode i of a blade,
 * otherwise of friction state i of the contact. */
static void start_motion(mhb_monodromy *d, int contact, int blade, int i, double *u) {
  const mhb_modal_structure *s  = d->structure;
  int                        n3 = 3 * s->pairs, n = 3 * s->contacts;
  memset(u, 0, sizeof(double) * (size_t)n);
  if (contact < 0 && s->disc) mhb_disc_modes_add_motion(s->disc, blade, i, u);
  for (int side = 0; contact < 0 && !s->disc && side < s->sides; side++) {
    int first = 3 * mhb_modal_structure_contact(s, blade, side);
    for (int r = 0; r < n3; r++)
      u[first + r] += s->shape[(size_t)(side * s->modes + i) * (size_t)n3 + (size_t)r];
  }
  if (!s->flexibility) return;
  if (contact >= 0) {
    double of_u[3][3], of_sigma[3][2];
    start_force(&d->orbit->point[contact], d->schedule->constant_state[contact], of_u, of_sigma);
    for (int r = 0; r < n; r++)
      for (int k = 0; k < 3; k++)
        u[r] -= s->flexibility[(size_t)r * (size_t)n + (size_t)(3 * contact + k)] * of_sigma[k][i];
  }
  mhb_solve_real(n, d->matrix, d->pivot, u);
}

/* Rows u of a column, and sigma of contacts that stick for the whole period. */
static void put_motion(mhb_monodromy *d, int column, const double *u) {
  const mhb_modal_structure *s     = d->structure;
  int                        first = modal_states(s), n = 3 * s->contacts;
  for (int r = 0; r < n; r++) *mhb_variational_at(d->variational, first + r, column) = u[r];
  for (int j = 0; j < s->contacts; j++) {
    const mhb_law *law = d->orbit->point[j].law;
    if (!d->schedule->constant_state[j] || d->orbit->point[j].state != MHB_STICK || law->mu == 0)
      continue;
    const double *su = u + 3 * j + 1;
    *mhb_variational_at(d->variational, first + n + 2 * j, column) =
        law->ku[0] * su[0] + law->ku[1] * su[1];
    *mhb_variational_at(d->variational, first + n + 2 * j + 1, column) =
        law->ku[1] * su[0] + law->ku[2] * su[1];
  }
}

/* A unit of mode i of a blade: of q in one column, of v in another. */
static void start_mode(mhb_monodromy *d, int blade, int i) {
  const mhb_modal_structure *s = d->structure;
  int state = blade * s->modes + i, half = s->modes * d->blades, rows = s->modes * s->blades;
  *mhb_variational_at(d->variational, state, state)               = 1;
  *mhb_variational_at(d->variational, rows + state, half + state) = 1;
  start_motion(d, -1, blade, i, d->u);
  put_motion(d, state, d->u);
}

/* The slider forces of the columns. */
static void start_sliders(mhb_monodromy *d) {
  for (int j = 0; j < d->structure->contacts; j++) {
    d->is_spring[j] = mhb_orbit_contacts_is_spring(d->orbit, j);
    start_force(&d->orbit->point[j], d->schedule->constant_state[j], d->of_u[j], d->of_sigma[j]);
  }
  mhb_slider_propagation_begin(d->variational->sliders, d->is_spring, d->of_u, d->of_sigma);
}

/* Columns: q of the cell's blades, v, frictions. */
static int start_columns(mhb_monodromy *d) {
  const mhb_modal_structure *s = d->structure;
  int first = modal_states(s) + 3 * s->contacts, contacts = d->blades * s->pairs;
  d->n = 2 * s->modes * d->blades;
  for (int j = 0; j < contacts; j++) {
    d->column[j] = d->n;
    d->n += friction_states(d, j);
  }
  mhb_variational_clear(d->variational, d->n);
  if (s->flexibility && !start_matrix(d)) return 0;
  for (int i = 0; i < s->modes * d->blades; i++) start_mode(d, i / s->modes, i % s->modes);
  for (int j = 0; j < contacts; j++)
    for (int i = 0; i < friction_states(d, j); i++) {
      start_motion(d, j, 0, i, d->u);
      put_motion(d, d->column[j] + i, d->u);
      *mhb_variational_at(d->variational, first + 2 * j + i, d->column[j] + i) = 1;
    }
  mhb_variational_begin(d->variational);
  if (d->springs) start_sliders(d);
  return 1;
}

/* Row of M: a state of a cell <- a variational row. */
static void put_row(mhb_monodromy *d, int from, int cell, int state) {
  size_t  n = (size_t)d->n;
  double *S = d->M + (size_t)cell * n * n + state;
  for (int column = 0; column < d->n; column++)
    S[(size_t)column * n] = *mhb_variational_at(d->variational, from, column);
}

/* M from the rows at the end, blades renamed: blade b becomes blade b - blade_shift. */
static void set_matrix(mhb_monodromy *d) {
  const mhb_modal_structure *s    = d->structure;
  int                        rows = s->modes * s->blades, half = s->modes * d->blades;
  for (int b = 0; b < s->blades; b++) {
    int name = ((b - d->schedule->blade_shift) % s->blades + s->blades) % s->blades;
    int cell = name / d->blades, to = name % d->blades;
    for (int i = 0; i < s->modes; i++) {
      put_row(d, b * s->modes + i, cell, to * s->modes + i);
      put_row(d, rows + b * s->modes + i, cell, half + to * s->modes + i);
    }
    for (int a = 0; a < s->pairs; a++) {
      int j = b * s->pairs + a, k = to * s->pairs + a;
      for (int i = 0; i < friction_states(d, k); i++)
        put_row(d, 2 * rows + 3 * s->contacts + 2 * j + i, cell, d->column[k] + i);
    }
  }
}

/* ---- integration ---- */

/* The interval before event `piece`. Returns 0 if a system was singular. */
static int integrate_interval(mhb_monodromy *d, int piece, double from, double to, int refinement) {
  double length = to - from, period = SHB_TWO_PI / d->orbit->omega;
  if (length < SHORT) return 1;
  int    first_pass = d->orbit->first_pass, slip = mhb_orbit_contacts_any_slips(d->orbit);
  int    steps = refinement * d->steps[piece];
  double h     = length / steps;
  if (!first_pass && !mhb_variational_set_step(d->variational, h * period)) return 0;
  for (int i = 0; i < steps; i++) {
    if (slip || i == 0) {
      if (!mhb_orbit_contacts_linearise(d->orbit, from + (i + 0.5) * h, h * period, i == 0,
                                        d->variational->linearised))
        return 0;
      if (!first_pass && !mhb_variational_factor(d->variational)) return 0;
    }
    if (!first_pass) mhb_variational_step(d->variational);
  }
  return 1;
}

/* The segment: in the first pass phases of samples are collected, in the second it is integrated.
 * Returns 0 if a system was singular. */
static int run_pass(mhb_monodromy *d, int first_pass, int refinement) {
  const mhb_transition_schedule *t = d->schedule;
  mhb_orbit_contacts_begin(d->orbit, first_pass);
  if (!first_pass && !start_columns(d)) return 0;
  double now = 0;
  for (int i = 0; i < t->n_events; i++) {
    if (!integrate_interval(d, i, now, t->event[i].at, refinement)) return 0;
    if (!mhb_orbit_contacts_event(d->orbit, &t->event[i], d->variational)) return 0;
    now = t->event[i].at;
  }
  if (!integrate_interval(d, t->n_events, now, t->span, refinement)) return 0;
  if (!first_pass) mhb_variational_finish(d->variational);
  return 1;
}

/* Sub-steps of each interval between events, at least one. */
static void set_steps(mhb_monodromy *d) {
  const mhb_transition_schedule *t   = d->schedule;
  double                         now = 0;
  d->n_events                        = t->n_events;
  for (int i = 0; i <= t->n_events; i++) {
    double to   = i < t->n_events ? t->event[i].at : t->span;
    d->steps[i] = (int)fmax(1, ceil(d->substeps * (to - now) - 1e-9));
    now         = to;
  }
}

const char *mhb_monodromy_set(mhb_monodromy *d, const mhb_solution *solution, double omega,
                              int refinement, bool keep) {
  if (!keep || d->n_events != d->schedule->n_events) set_steps(d);
  if (d->springs && !mhb_stuck_springs_set(d->springs, solution->law))
    return "the equations of the contacts are singular";
  mhb_orbit_contacts_set_solution(d->orbit, solution, omega);
  run_pass(d, 1, refinement);
  if (!mhb_orbit_contacts_evaluate_samples(d->orbit)) return "the contact law lost its way";
  if (!run_pass(d, 0, refinement)) return "the equations of the contacts are singular";
  set_matrix(d);
  return NULL;
}
