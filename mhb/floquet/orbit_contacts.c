#include "mhb/floquet/orbit_contacts.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/contact/slip.h"
#include "mhb/numerics/fourier.h"

/* Distance from an opening, in periods, at which the direction of friction is sampled. */
static const double NEAR = 1e-8;

mhb_orbit_contacts *mhb_orbit_contacts_create(const mhb_modal_structure     *s,
                                              const mhb_transition_schedule *schedule,
                                              mhb_contact_evaluator *contact, int m,
                                              int n_samples) {
  mhb_orbit_contacts *d = shb_alloc_zeroed(1, sizeof *d);
  size_t contacts = (size_t)s->contacts, n = 3 * contacts, orbits = (size_t)schedule->orbits;
  d->structure        = s;
  d->schedule         = schedule;
  d->contact          = contact;
  d->m                = m;
  d->nb               = mhb_real_size(m);
  d->capacity         = s->contacts / schedule->orbits * n_samples;
  shb_arena *arena    = &d->arena;
  d->own              = shb_arena_take(arena, 3 * orbits * (size_t)d->nb, sizeof(double));
  d->motion           = shb_arena_take(arena, 3 * orbits * (size_t)d->nb, sizeof(double));
  d->sample           = shb_alloc_zeroed(orbits * (size_t)d->capacity, sizeof *d->sample);
  d->n_taken          = shb_arena_take(arena, orbits, sizeof(int));
  d->point            = shb_arena_take(arena, contacts, sizeof *d->point);
  d->solution_columns = shb_arena_take(arena, 2 * n, sizeof(mhb_columns));
  d->force_rate       = shb_arena_take(arena, n, sizeof(double));
  d->force_jump       = shb_arena_take(arena, n, sizeof(double));
  d->elastic_feedback = shb_arena_take(arena, n, sizeof(double));
  d->basis            = shb_arena_take(arena, 2 * (size_t)d->nb, sizeof(double));
  const int groups    = mhb_modal_structure_groups(s);
  mhb_ring_band_create(groups, 3 * s->contacts / groups, &d->band);
  return d;
}

void mhb_orbit_contacts_destroy(mhb_orbit_contacts *d) {
  if (!d) return;
  mhb_ring_band_destroy(&d->band);
  shb_arena_free(&d->arena);
  free(d->sample);
  free(d);
}

static int orbit_of(const mhb_orbit_contacts *d, int contact) {
  return mhb_transition_schedule_orbit(d->schedule, contact);
}

/* ---- the periodic motion ---- */

/* Harmonic k of row r of the solution's x or p. */
static double complex harmonic(const mhb_orbit_contacts *d, const double *x, int r, int k) {
  const double *a = x + (size_t)r * (size_t)mhb_real_size(d->solution->m);
  return k > d->solution->m ? 0 : k ? CMPLX(a[2 * k - 1], a[2 * k]) : a[0];
}

/* Harmonic k of a wave in blade `blade`, by that of blade 0: it lags by k b 2 pi E/N. */
static double complex lag(const mhb_orbit_contacts *d, int k, int blade) {
  const mhb_modal_structure *s = d->structure;
  return cexp(-I * SHB_TWO_PI * (double)((long)k * blade * s->wave % s->blades) / s->blades);
}

/* Harmonic k of (R p)_r. */
static double complex flexibility_motion(const mhb_orbit_contacts *d, int k, int r) {
  const mhb_modal_structure *s = d->structure;
  const int                  n = 3 * s->contacts, given = 3 * d->schedule->orbits;
  double complex             sum = 0;
  for (int c = 0; c < n; c++) {
    double complex pk = harmonic(d, d->solution->p, c % given, k);
    if (c >= given) pk *= lag(d, k, c / given); /* equal blades: p is that of blade 0 */
    sum += s->flexibility[(size_t)r * (size_t)n + (size_t)c] * pk;
  }
  return sum;
}

/* Harmonic k of row r of a motion: out <- a, in the time of the row's own blade. */
static void put_harmonic(const mhb_orbit_contacts *d, int k, int r, double complex a, double *out) {
  const int blade = r / (3 * d->structure->pairs);
  double   *to    = out + (size_t)r * (size_t)d->nb;
  if (blade > 0) a *= conj(lag(d, k, blade));
  to[k ? 2 * k - 1 : 0] = creal(a);
  if (k) to[2 * k] = cimag(a);
}

static void set_modal_motion(mhb_orbit_contacts *d) {
  for (int r = 0; r < 3 * d->schedule->orbits; r++)
    for (int k = 0; k <= d->m; k++) {
      double complex u = harmonic(d, d->solution->x, r, k);
      put_harmonic(d, k, r, u, d->own);
      if (d->structure->flexibility) u += flexibility_motion(d, k, r);
      put_harmonic(d, k, r, u, d->motion);
    }
}

/* Time derivative of the motion of a contact, of x[orbit][3][nb] in the time of its own blade. */
static void motion_rate(mhb_orbit_contacts *d, const double *x, int contact, double at,
                        double rate[3]) {
  double *basis = d->basis, *slope = basis + d->nb;
  mhb_basis(d->m, SHB_TWO_PI * mhb_transition_schedule_phase(d->schedule, contact, at), basis,
            slope);
  const double *of = x + (size_t)(3 * orbit_of(d, contact)) * (size_t)d->nb;
  for (int i = 0; i < 3; i++) {
    double sum = 0;
    for (int k = 1; k < d->nb; k++) sum += slope[k] * of[i * d->nb + k];
    rate[i] = d->omega * sum;
  }
}

/* Normal load and friction direction of a slipping contact; in the first pass only the phase is
 * collected. */
static void take_sample(mhb_orbit_contacts *d, int contact, double at) {
  int                 orbit = orbit_of(d, contact);
  mhb_contact_sample *sample =
      &d->sample[(size_t)orbit * (size_t)d->capacity + (size_t)d->n_taken[orbit]];
  d->n_taken[orbit]++;
  if (d->first_pass) {
    sample->phase = mhb_transition_schedule_phase(d->schedule, contact, at);
    return;
  }
  mhb_contact_state *point = &d->point[contact];
  double             size  = hypot(sample->f[0], sample->f[1]);
  point->n                 = sample->n;
  for (int k = 0; k < 2; k++) point->e[k] = size > 0 ? sample->f[k] / size : k == 0;
}

static int is_slipping(const mhb_contact_state *point) {
  return point->state == MHB_SLIDE && point->law->mu > 0;
}

static bool is_spring(const mhb_law *law, mhb_state state) {
  return state == MHB_STICK || (state == MHB_SLIDE && !(law->mu > 0));
}

bool mhb_orbit_contacts_is_spring(const mhb_orbit_contacts *d, int contact) {
  return is_spring(d->point[contact].law, d->point[contact].state);
}

/* ---- rates with residual flexibility: p' = (I + G R)^-1 G w', u' = w' - R p' ---- */

/* Rows of contact j of I + G R, and of G w'. R couples the contacts of neighbouring groups. */
static void rate_rows(mhb_orbit_contacts *d, int j, double at, double *rate) {
  int    n = 3 * d->structure->contacts, block = d->band.block, group[3];
  int    n_groups = mhb_ring_band_neighbours(&d->band, 3 * j / block, group);
  double G[3][3], w[3];
  mhb_linearised_law_rate(&d->point[j], G);
  motion_rate(d, d->motion, j, at, w);
  for (int r = 0; r < 3; r++) {
    const double *R = d->structure->flexibility + (size_t)(3 * j) * (size_t)n;
    rate[3 * j + r] = G[r][0] * w[0] + G[r][1] * w[1] + G[r][2] * w[2];
    for (int i = 0; i < n_groups * block; i++) {
      int c = group[i / block] * block + i % block;
      *mhb_ring_band_at(&d->band, 3 * j + r, c) =
          (c == 3 * j + r) + G[r][0] * R[c] + G[r][1] * R[n + c] + G[r][2] * R[2 * n + c];
    }
  }
}

/* x[n] <- (I + G R)^-1 x by the factors of force_rates. */
static void solve_rates(mhb_orbit_contacts *d, double *x) {
  int          n       = d->band.n;
  mhb_columns *columns = d->solution_columns;
  for (int i = 0; i < n; i++) columns[i] = (mhb_columns){x[i]};
  mhb_ring_band_solve(&d->band, columns, columns + n);
  for (int i = 0; i < n; i++) x[i] = columns[i][0];
}

/* Factors of I + G R, and p' into rate[n]. Returns 0 if singular. */
static int force_rates(mhb_orbit_contacts *d, double at, double *rate) {
  mhb_ring_band_clear(&d->band);
  for (int j = 0; j < d->structure->contacts; j++) rate_rows(d, j, at, rate);
  if (!mhb_ring_band_factor(&d->band)) return 0;
  solve_rates(d, rate);
  return 1;
}

/* out = -R p */
static void elastic_feedback(const mhb_modal_structure *s, const double *p, double *out) {
  int n = 3 * s->contacts;
  for (int r = 0; r < n; r++) {
    out[r] = 0;
    for (int c = 0; c < n; c++) out[r] -= s->flexibility[(size_t)r * (size_t)n + (size_t)c] * p[c];
  }
}

/* Rates of the motion of one contact; with residual flexibility of all. Returns 0 if singular. */
static int set_rates(mhb_orbit_contacts *d, int contact, double at) {
  const mhb_modal_structure *s = d->structure;
  if (!s->flexibility) {
    motion_rate(d, d->motion, contact, at, d->point[contact].rate);
    return 1;
  }
  if (!force_rates(d, at, d->force_rate)) return 0;
  elastic_feedback(s, d->force_rate, d->elastic_feedback);
  for (int j = 0; j < s->contacts; j++) {
    motion_rate(d, d->motion, j, at, d->point[j].rate);
    for (int k = 0; k < 3; k++) d->point[j].rate[k] += d->elastic_feedback[3 * j + k];
  }
  return 1;
}

void mhb_orbit_contacts_set_solution(mhb_orbit_contacts *d, const mhb_solution *solution,
                                     double omega) {
  d->solution = solution;
  d->omega    = omega;
  set_modal_motion(d);
}

void mhb_orbit_contacts_begin(mhb_orbit_contacts *d, int first_pass) {
  const mhb_modal_structure *s = d->structure;
  d->first_pass                = first_pass;
  memset(d->n_taken, 0, sizeof *d->n_taken * (size_t)d->schedule->orbits);
  for (int j = 0; j < s->contacts; j++) {
    mhb_contact_state *point = &d->point[j];
    *point                   = (mhb_contact_state){.law   = &d->solution->law[orbit_of(d, j)],
                                                   .state = (mhb_state)d->schedule->state[j]};
    if (s->flexibility && is_slipping(point)) take_sample(d, j, NEAR);
  }
}

int mhb_orbit_contacts_evaluate_samples(mhb_orbit_contacts *d) {
  for (int a = 0; a < d->schedule->orbits; a++) {
    if (d->n_taken[a] == 0) continue;
    const double *x = d->own + (size_t)(3 * a) * (size_t)d->nb;
    mhb_contact_time_history(d->contact, &d->solution->law[a], x, d->n_taken[a],
                             d->sample + (size_t)a * (size_t)d->capacity, &d->info);
    if (!mhb_transition_schedule_usable(&d->info)) return 0;
  }
  return 1;
}

/* ---- sub-steps ---- */

int mhb_orbit_contacts_any_slips(const mhb_orbit_contacts *d) {
  for (int j = 0; j < d->structure->contacts; j++)
    if (is_slipping(&d->point[j])) return 1;
  return 0;
}

int mhb_orbit_contacts_linearise(mhb_orbit_contacts *d, double middle, double h, int first,
                                 mhb_linearised_law *linearised) {
  const mhb_modal_structure *s = d->structure;
  for (int j = 0; j < s->contacts; j++)
    if (is_slipping(&d->point[j])) take_sample(d, j, middle);
  if (d->first_pass) return 1;
  if (s->flexibility && mhb_orbit_contacts_any_slips(d) && !set_rates(d, 0, middle)) return 0;
  for (int j = 0; j < s->contacts; j++) {
    int slipping = is_slipping(&d->point[j]);
    if (!slipping && !first) continue;
    if (slipping && !s->flexibility) set_rates(d, j, middle);
    mhb_linearised_law_at(&d->point[j], h, &linearised[j]);
  }
  return 1;
}

/* ---- events ---- */

/* Direction of slip at a closing (eq. 15), by the rate of the solution's motion. */
static void closing_direction(mhb_orbit_contacts *d, int contact, double at) {
  mhb_contact_state *point   = &d->point[contact];
  const mhb_law     *law     = point->law;
  const double       K[2][2] = {{law->ku[0], law->ku[1]}, {law->ku[1], law->ku[2]}};
  double             u[3];
  motion_rate(d, d->own, contact, at, u);
  double x[2] = {K[0][0] * u[1] + K[0][1] * u[2], K[1][0] * u[1] + K[1][1] * u[2]};
  mhb_slip_return(K, law->mu * law->kv * u[0], x, point->e);
  point->n = 0;
}

/* du, dsigma of all contacts by the force jump[n] alpha; sigma of the contact itself is set by
 * mhb_saltation. */
static void set_coupled_jump(mhb_orbit_contacts *d, int contact, const double *jump,
                             mhb_variational *v) {
  elastic_feedback(d->structure, jump, v->du);
  memcpy(v->dp, jump, sizeof *v->dp * (size_t)(3 * d->structure->contacts));
  for (int j = 0; j < d->structure->contacts; j++) {
    const mhb_contact_state *point = &d->point[j];
    const double            *f     = jump + 3 * j + 1;
    double                  *out   = v->dsigma + 2 * j;
    out[0] = out[1] = 0;
    if (j == contact || point->state == MHB_SEPARATE || point->law->mu == 0) continue;
    out[0] = point->state == MHB_STICK ? f[0] : point->e[0] * f[1] - point->e[1] * f[0];
    out[1] = point->state == MHB_STICK ? f[1] : 0;
  }
}

/* Stick to slip: dp jumps along (I + G R)^-1 (0, Ku e) to the friction limit; G of the stuck
 * state. */
static int elastic_onset(mhb_orbit_contacts *d, double at, mhb_saltation *jump,
                         mhb_variational *v) {
  const mhb_contact_state *point = &d->point[jump->contact];
  const double            *e = point->e, *ku = point->law->ku, mu = point->law->mu;
  int                      n = 3 * d->structure->contacts, a = 3 * jump->contact;
  if (!force_rates(d, at, d->force_rate)) return 0;
  memset(d->force_jump, 0, sizeof(double) * (size_t)n);
  d->force_jump[a + 1] = ku[0] * e[0] + ku[1] * e[1];
  d->force_jump[a + 2] = ku[1] * e[0] + ku[2] * e[1];
  solve_rates(d, d->force_jump);
  const double *k = d->force_jump + a;
  double        s = e[0] * k[1] + e[1] * k[2] - mu * k[0], across = e[0] * k[2] - e[1] * k[1];
  double measure[3] = {-mu * point->law->kv / s, e[0] / s, e[1] / s}, q[3] = {0, -e[1], e[0]};
  for (int i = 0; i < 3; i++) {
    jump->measure[i] = measure[i];
    jump->set[0][i]  = q[i] - across * measure[i];
  }
  for (int i = 0; i < n; i++) d->force_jump[i] = -d->force_jump[i];
  set_coupled_jump(d, jump->contact, d->force_jump, v);
  return 1;
}

/* Opening and closing: the event shifts by -dv/v', and with it the jump of p'. */
static int elastic_contact(mhb_orbit_contacts *d, double at, mhb_state to, mhb_saltation *jump,
                           mhb_variational *v) {
  mhb_contact_state *point = &d->point[jump->contact];
  mhb_state          from  = point->state;
  int                n = 3 * d->structure->contacts, a = 3 * jump->contact;
  if (!set_rates(d, jump->contact, at)) return 0;
  double speed = point->rate[0];
  point->state = to;
  int ok       = force_rates(d, at, d->force_jump);
  point->state = from;
  for (int i = 0; i < n; i++) d->force_jump[i] -= d->force_rate[i];
  jump->measure[0] = 1 / speed;
  for (int i = 0; i < 2 && to == MHB_STICK && point->law->mu > 0; i++)
    jump->set[i][0] = d->force_jump[a + 1 + i] / speed;
  set_coupled_jump(d, jump->contact, d->force_jump, v);
  return ok;
}

/* Sample the direction of a contact between stick and slip; with residual flexibility of every
 * slipping contact. At an opening, where n = 0, shortly before it. */
static void sample_slipping(mhb_orbit_contacts *d, const mhb_event *event, int changes_slip) {
  double at = event->state == MHB_SEPARATE ? event->at - NEAR : event->at;
  for (int j = 0; j < d->structure->contacts; j++) {
    int coupled = d->structure->flexibility && is_slipping(&d->point[j]);
    if (coupled || (changes_slip && j == event->contact)) take_sample(d, j, at);
  }
}

int mhb_orbit_contacts_event(mhb_orbit_contacts *d, const mhb_event *event, mhb_variational *v) {
  mhb_contact_state *point = &d->point[event->contact];
  mhb_state          from = point->state, to = (mhb_state)event->state;
  int                friction = point->law->mu > 0, ok = 1;
  int                changes_slip = friction && from != MHB_SEPARATE && to != MHB_SEPARATE;
  mhb_saltation      jump         = {.contact = event->contact, .stuck = is_spring(point->law, to)};
  sample_slipping(d, event, changes_slip);
  if (!d->first_pass) {
    if (friction && from == MHB_SEPARATE && to == MHB_SLIDE)
      closing_direction(d, event->contact, event->at);
    if (!d->structure->flexibility || (changes_slip && to == MHB_STICK)) {
      ok = set_rates(d, event->contact, event->at);
      mhb_saltation_at(point, to, &jump); /* measure 0: no other contact jumps */
    } else if (changes_slip) {
      ok = elastic_onset(d, event->at, &jump, v);
    } else {
      ok = elastic_contact(d, event->at, to, &jump, v);
    }
    mhb_variational_saltation(v, &jump);
  }
  point->state = to;
  return ok;
}
