#include "mhb/monodromy.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double TWO_PI = 6.283185307179586476925;

/* Pieces shorter than this, in periods, are passed over. */
static const double SHORT = 1e-13;

shb_status mhb_monodromy_create(const mhb_structure *s, const mhb_timetable *timetable,
                                mhb_contact *contact, int m, int substeps, mhb_monodromy **out) {
  mhb_monodromy *d = calloc(1, sizeof *d);
  SHB_CHECK(d, SHB_ERR_IO, "out of memory");
  int    capacity = 2 * s->modes * s->blades + 2 * s->contacts, pieces = timetable->capacity + 1;
  int    steps      = 2 * ((int)(substeps * timetable->span) + 1 + pieces);
  size_t square     = (size_t)capacity * (size_t)capacity;
  d->structure      = s;
  d->timetable      = timetable;
  d->substeps       = substeps;
  d->column         = calloc((size_t)s->contacts, sizeof *d->column);
  d->u              = calloc(3 * (size_t)s->contacts, sizeof *d->u);
  d->matrix         = calloc(9 * (size_t)s->contacts * (size_t)s->contacts, sizeof *d->matrix);
  d->pivot          = calloc(3 * (size_t)s->contacts, sizeof *d->pivot);
  d->M              = calloc(square, sizeof *d->M);
  d->power          = calloc(square, sizeof *d->power);
  d->product        = calloc(square, sizeof *d->product);
  shb_status status = SHB_OK;
  if (!(d->column && d->u && d->matrix && d->pivot && d->M && d->power && d->product))
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__,
                      "out of memory for the stability of %d states", capacity);
  if (status == SHB_OK) status = mhb_variation_create(s, capacity, &d->variation);
  if (status == SHB_OK)
    status = mhb_passage_create(s, timetable, contact, m, steps + pieces + 1, &d->passage);
  if (status != SHB_OK) {
    mhb_monodromy_destroy(d);
    return status;
  }
  *out = d;
  return SHB_OK;
}

void mhb_monodromy_destroy(mhb_monodromy *d) {
  if (!d) return;
  mhb_variation_destroy(d->variation);
  mhb_passage_destroy(d->passage);
  free(d->column);
  free(d->u);
  free(d->matrix);
  free(d->pivot);
  free(d->M);
  free(d->power);
  free(d->product);
  free(d);
}

static int modal_states(const mhb_structure *s) {
  return 2 * s->modes * s->blades;
}

static int friction_states(const mhb_monodromy *d, int contact) {
  return mhb_friction_states(d->timetable->state[contact], d->timetable->permanent[contact],
                             d->passage->touch[contact].law->mu);
}

/* ---- columns ---- */

/* Forces of a contact by its rows at the start: p = of_u (v, u, w) + of_sigma sigma. */
static void start_force(const mhb_touch *touch, int permanent, double of_u[3][3],
                        double of_sigma[3][2]) {
  const mhb_law *law = touch->law;
  memset(of_u, 0, sizeof(double) * 9);
  memset(of_sigma, 0, sizeof(double) * 6);
  if (touch->state == MHB_SEPARATE) return;
  of_u[0][0] = law->kv;
  if (law->mu == 0) return;
  if (touch->state == MHB_STICK && permanent) mhb_tangent_rate(touch, of_u);
  for (int i = 0; i < 2; i++) {
    if (touch->state == MHB_STICK && !permanent) of_sigma[1 + i][i] = 1;
    if (touch->state != MHB_SLIDE) continue;
    of_u[1 + i][0]     = law->mu * law->kv * touch->e[i];
    of_sigma[1 + i][0] = i ? touch->e[0] : -touch->e[1];
  }
}

/* With residual flexibility u solves u = B q - R p(u, sigma): d->matrix = I + R p_u, factorized. */
static int start_matrix(mhb_monodromy *d) {
  const mhb_structure *s = d->structure;
  int                  n = 3 * s->contacts;
  for (int column = 0; column < n; column++) {
    double of_u[3][3], of_sigma[3][2];
    int    j = column / 3, c = column % 3;
    start_force(&d->passage->touch[j], d->timetable->permanent[j], of_u, of_sigma);
    for (int r = 0; r < n; r++) {
      const double *R   = s->flexibility + (size_t)r * (size_t)n + (size_t)(3 * j);
      double        sum = r == column;
      for (int k = 0; k < 3; k++) sum += R[k] * of_u[k][c];
      d->matrix[(size_t)r * (size_t)n + (size_t)column] = sum;
    }
  }
  return mhb_lu(n, d->matrix, d->pivot);
}

/* Motion of the contacts at the start for a unit of mode i of a blade (contact < 0), or of friction state i of a contact. */
static void start_motion(mhb_monodromy *d, int contact, int blade, int i, double *u) {
  const mhb_structure *s  = d->structure;
  int                  n3 = 3 * s->pairs, n = 3 * s->contacts;
  memset(u, 0, sizeof(double) * (size_t)n);
  for (int side = 0; contact < 0 && side < s->sides; side++) {
    int first = 3 * mhb_structure_contact(s, blade, side);
    for (int r = 0; r < n3; r++)
      u[first + r] += s->shape[(size_t)(side * s->modes + i) * (size_t)n3 + (size_t)r];
  }
  if (!s->flexibility) return;
  if (contact >= 0) {
    double of_u[3][3], of_sigma[3][2];
    start_force(&d->passage->touch[contact], d->timetable->permanent[contact], of_u, of_sigma);
    for (int r = 0; r < n; r++)
      for (int k = 0; k < 3; k++)
        u[r] -= s->flexibility[(size_t)r * (size_t)n + (size_t)(3 * contact + k)] * of_sigma[k][i];
  }
  mhb_lu_solve(n, d->matrix, d->pivot, u);
}

/* Rows u, and the friction of contacts that stick throughout. */
static void put_motion(mhb_monodromy *d, int column, const double *u) {
  const mhb_structure *s     = d->structure;
  int                  first = modal_states(s), n = 3 * s->contacts;
  for (int r = 0; r < n; r++) *mhb_variation_at(d->variation, first + r, column) = u[r];
  for (int j = 0; j < s->contacts; j++) {
    const mhb_law *law = d->passage->touch[j].law;
    if (!d->timetable->permanent[j] || d->passage->touch[j].state != MHB_STICK || law->mu == 0)
      continue;
    const double *su = u + 3 * j + 1;
    *mhb_variation_at(d->variation, first + n + 2 * j, column) =
        law->ku[0] * su[0] + law->ku[1] * su[1];
    *mhb_variation_at(d->variation, first + n + 2 * j + 1, column) =
        law->ku[1] * su[0] + law->ku[2] * su[1];
  }
}

static int start_columns(mhb_monodromy *d) {
  const mhb_structure *s     = d->structure;
  int                  modal = s->modes * s->blades, column = 2 * modal, n = 3 * s->contacts;
  d->n = column;
  for (int j = 0; j < s->contacts; j++) d->n += friction_states(d, j);
  mhb_variation_clear(d->variation, d->n);
  if (s->flexibility && !start_matrix(d)) return 0;
  for (int i = 0; i < 2 * modal; i++) *mhb_variation_at(d->variation, i, i) = 1;
  for (int i = 0; i < modal; i++) {
    start_motion(d, -1, i / s->modes, i % s->modes, d->u);
    put_motion(d, i, d->u);
  }
  for (int j = 0; j < s->contacts; j++) {
    d->column[j] = column;
    for (int i = 0; i < friction_states(d, j); i++, column++) {
      start_motion(d, j, 0, i, d->u);
      put_motion(d, column, d->u);
      *mhb_variation_at(d->variation, 2 * modal + n + 2 * j + i, column) = 1;
    }
  }
  return 1;
}

/* Row of the variation that holds state i of blade b's successor by `shift` names: where state i comes from. */
static void put_row(mhb_monodromy *d, int from, int state) {
  for (int column = 0; column < d->n; column++)
    d->M[(size_t)column * (size_t)d->n + (size_t)state] =
        *mhb_variation_at(d->variation, from, column);
}

/* The end of the stretch, blades renamed: what blade b holds is now blade b - shift. */
static void take_matrix(mhb_monodromy *d) {
  const mhb_structure *s     = d->structure;
  int                  modal = s->modes * s->blades, n = 3 * s->contacts;
  for (int b = 0; b < s->blades; b++) {
    int to = ((b - d->timetable->shift) % s->blades + s->blades) % s->blades;
    for (int i = 0; i < s->modes; i++) {
      put_row(d, b * s->modes + i, to * s->modes + i);
      put_row(d, modal + b * s->modes + i, modal + to * s->modes + i);
    }
    for (int a = 0; a < s->pairs; a++) {
      int j = b * s->pairs + a, k = to * s->pairs + a;
      for (int i = 0; i < friction_states(d, k); i++)
        put_row(d, 2 * modal + n + 2 * j + i, d->column[k] + i);
    }
  }
}

/* ---- the whole period ---- */

static int run_piece(mhb_monodromy *d, double from, double to, int refinement) {
  double length = to - from, period = TWO_PI / d->passage->omega;
  if (length < SHORT) return 1;
  int    noting = d->passage->collecting, slip = mhb_passage_slips(d->passage);
  int    steps = refinement * (int)ceil(d->substeps * length - 1e-9);
  double h     = length / steps;
  if (!noting) mhb_variation_length(d->variation, h * period);
  for (int i = 0; i < steps; i++) {
    if (slip || i == 0) {
      if (!mhb_passage_relate(d->passage, from + (i + .5) * h, h * period, i == 0,
                              d->variation->relation))
        return 0;
      if (!noting && !mhb_variation_couple(d->variation)) return 0;
    }
    if (!noting) mhb_variation_step(d->variation);
  }
  return 1;
}

/* One stretch: note where the contacts must be looked at, or integrate. 0: something was singular. */
static int walk(mhb_monodromy *d, int noting, int refinement) {
  const mhb_timetable *t = d->timetable;
  mhb_passage_begin(d->passage, noting);
  if (!noting && !start_columns(d)) return 0;
  double now = 0;
  for (int i = 0; i < t->n_events; i++) {
    if (!run_piece(d, now, t->event[i].at, refinement)) return 0;
    if (!mhb_passage_event(d->passage, &t->event[i], d->variation)) return 0;
    now = t->event[i].at;
  }
  if (!run_piece(d, now, t->span, refinement)) return 0;
  if (!noting) mhb_variation_settle(d->variation);
  return 1;
}

/* power = M^chunks, by squaring. */
static void raise(mhb_monodromy *d, int chunks) {
  int n = d->n, bit = 1;
  while (bit <= chunks / 2) bit *= 2;
  memcpy(d->power, d->M, sizeof(double) * (size_t)n * (size_t)n);
  for (bit /= 2; bit > 0; bit /= 2) {
    const double *by[2] = {d->power, d->M};
    for (int k = 0; k < 1 + ((chunks & bit) != 0); k++) {
      cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, n, n, 1, d->power, n,
                  k == 0 ? d->power : by[1], n, 0, d->product, n);
      double *swap = d->power;
      d->power     = d->product;
      d->product   = swap;
    }
  }
}

/* State i of a blade -> the same state of the blade `names` further on. */
static int renamed(const mhb_monodromy *d, int state, int names) {
  const mhb_structure *s     = d->structure;
  int                  modal = s->modes * s->blades;
  if (state < 2 * modal) {
    int half = state / modal, blade = state % modal / s->modes, mode = state % s->modes;
    return half * modal + (blade + names) % s->blades * s->modes + mode;
  }
  int j = 0;
  while (j + 1 < s->contacts && d->column[j + 1] <= state) j++;
  return d->column[(j + names * s->pairs) % s->contacts] + state - d->column[j];
}

/* M^chunks, the blades' names changed back. */
static void whole_period(mhb_monodromy *d) {
  const mhb_timetable *t     = d->timetable;
  size_t               n     = (size_t)d->n;
  int                  names = (int)((long)t->shift * t->chunks % d->structure->blades);
  raise(d, t->chunks);
  for (int row = 0; row < d->n; row++) {
    size_t to = (size_t)renamed(d, row, names);
    for (size_t c = 0; c < n; c++) d->M[c * n + to] = d->power[c * n + (size_t)row];
  }
}

const char *mhb_monodromy_set(mhb_monodromy *d, const mhb_solution *solution, double omega,
                              int refinement) {
  mhb_passage_solution(d->passage, solution, omega);
  walk(d, 1, refinement);
  if (!mhb_passage_trace(d->passage)) return "the contact law lost its way";
  if (!walk(d, 0, refinement)) return "the equations of the contacts are singular";
  take_matrix(d);
  if (d->timetable->chunks > 1) whole_period(d);
  return NULL;
}
