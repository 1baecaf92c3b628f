#include "mhb/structure/modal_structure.h"

#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/structure/ring_receptance.h"
#include "modal/model/nodal_diameters.h"

/* T0^T x of a pair in a mode, negative on the left. */
static double shape_of(const mhb_receptance *r, int side, int row, int mode) {
  const double *x   = side ? r->model->left : r->model->right;
  double        sum = 0;
  for (int axis = 0; axis < 3; axis++)
    sum += r->T0[(row / 3) * 9 + axis * 3 + row % 3] * x[(row / 3 * 3 + axis) * r->n_modes + mode];
  return side ? -sum : sum;
}

/* Residual flexibility of a model that has released it: the first side has the sum of both. */
static double lent_flexibility(const mhb_receptance *r, int s, int row, int t, int column) {
  const mhb_cyclic_flexibility *f = r->residual_terms->contact[0];
  const size_t                  n = (size_t)r->n, at = (size_t)row * n + (size_t)column;
  if (s == t) return s ? 0 : f->self[at];
  return s ? f->coupling[at] : f->coupling[(size_t)column * n + (size_t)row];
}

/* Motion on side s by a unit contact force on side t of the same blade: modes from `first` on, and
 * residual flexibility. */
static double flexibility(const mhb_receptance *r, int s, int row, int t, int column, int first) {
  const modal_model *model = r->model;
  int                n = r->n, nc = n * (model->has_left ? 2 : 1);
  double             sum = 0;
  for (int k = 0; k < 9 && model->residual_flexibility; k++) {
    int to = s * n + row / 3 * 3 + k / 3, by = t * n + column / 3 * 3 + k % 3;
    sum += r->T0[(row / 3) * 9 + k / 3 * 3 + row % 3] *
           r->T0[(column / 3) * 9 + k % 3 * 3 + column % 3] *
           model->residual_flexibility[(size_t)to * (size_t)nc + (size_t)by];
  }
  if (!model->residual_flexibility && r->residual_terms->contact[0])
    sum = lent_flexibility(r, s, row, t, column);
  if (s != t) sum = -sum;
  for (int i = first; i < r->n_modes; i++) {
    double w = SHB_TWO_PI * model->frequency[i];
    sum += shape_of(r, s, row, i) * shape_of(r, t, column, i) / (w * w);
  }
  return sum;
}

enum { SELF, NEXT, PREVIOUS, BLOCKS };

/* Contact 0 lies between the right side of blade 0 and the left side of blade 1. */
static void set_blocks(const mhb_receptance *r, mhb_modal_structure *s) {
  static const int of[2][2] = {{SELF, PREVIOUS}, {NEXT, SELF}}; /* [to][by] */
  const size_t     n3       = (size_t)r->n;
  memset(s->block, 0, BLOCKS * n3 * n3 * sizeof *s->block);
  for (int k = 0; k < s->sides * s->sides; k++) {
    const int to = k / s->sides, by = k % s->sides;
    double   *block = s->block + (size_t)of[to][by] * n3 * n3;
    for (size_t i = 0; i < n3 * n3; i++)
      block[i] += flexibility(r, to, (int)(i / n3), by, (int)(i % n3), s->modes);
  }
}

/* Add a block to the rows of every blade's contacts. */
static void spread(mhb_modal_structure *s, const double *block, int step) {
  const size_t n3 = 3 * (size_t)s->pairs, n = 3 * (size_t)s->contacts;
  for (int b = 0; b < s->blades; b++) {
    const size_t row = (size_t)b * n3, column = (size_t)((b + step) % s->blades) * n3;
    for (size_t i = 0; i < n3 * n3; i++)
      s->flexibility[(row + i / n3) * n + column + i % n3] += block[i];
  }
}

/* R of a mistuned ring: the own R of every blade between the contacts on both sides. A blade is one
 * to ground whose pairs are those of the right and then of the left side (blade_model.h). */
static void spread_blades(const mhb_ring_receptance *ring, mhb_modal_structure *s) {
  const int    n3 = ring->n;
  const size_t n  = 3 * (size_t)s->contacts;
  for (int k = 0; k < 4 * s->blades; k++) {
    const int blade = k / 4, to = k / 2 % 2, by = k % 2;
    double   *block = s->flexibility + (size_t)(3 * mhb_modal_structure_contact(s, blade, to)) * n +
                    3 * mhb_modal_structure_contact(s, blade, by);
    for (int i = 0; i < n3 * n3; i++)
      block[(size_t)(i / n3) * n + (size_t)(i % n3)] +=
          flexibility(ring->blade[blade], 0, to * n3 + i / n3, 0, by * n3 + i % n3, s->modes);
  }
}

static void set_flexibility(const mhb_receptance *r, mhb_modal_structure *s) {
  const size_t n = 3 * (size_t)s->contacts, square = (size_t)r->n * (size_t)r->n;
  if (s->block) set_blocks(r, s);
  if (!s->flexibility) return;
  memset(s->flexibility, 0, n * n * sizeof *s->flexibility);
  if (s->mistuned) {
    spread_blades(r->ring, s);
    return;
  }
  if (s->disc) {
    mhb_disc_modes_add_map(s->disc, s->disc->flexibility, s->flexibility);
    return;
  }
  spread(s, s->block + SELF * square, 0);
  if (s->sides == 1) return;
  spread(s, s->block + NEXT * square, 1);
  spread(s, s->block + PREVIOUS * square, s->blades - 1);
}

/* The receptance of a blade; of equal blades their own. */
static const mhb_receptance *blade_of(const mhb_receptance *r, int blade) {
  return r->ring ? r->ring->blade[blade] : r;
}

static void take_arrays(const mhb_receptance *r, bool whole, mhb_modal_structure *s) {
  const mhb_receptance *blade = blade_of(r, 0);
  const size_t n = 3 * (size_t)s->contacts, m = (size_t)s->modes, side = m * 3 * (size_t)s->pairs;
  const modal_model *model = blade->model;
  const bool         flexible =
      model->residual_flexibility || model->residual_diagonal || s->modes < blade->n_modes;
  if (!s->disc) {
    s->omega = shb_arena_take(&s->arena, m * (s->mistuned ? (size_t)s->blades : 1), sizeof(double));
    s->zeta  = shb_arena_take(&s->arena, m, sizeof(double));
    s->shape = shb_arena_take(&s->arena, (size_t)s->sides * side, sizeof(double));
  }
  if (flexible && !s->disc && !s->mistuned)
    s->block = shb_arena_take(&s->arena, BLOCKS * (size_t)r->n * (size_t)r->n, sizeof(double));
  if (flexible && whole) s->flexibility = shb_arena_take(&s->arena, n * n, sizeof(double));
}

shb_status mhb_modal_structure_create(const mhb_receptance *r, const mhb_settings *settings,
                                      int modes, mhb_structure_extent extent,
                                      mhb_modal_structure *s) {
  const modal_nodal_diameters *of        = settings->nodal_diameters;
  const int                    own_modes = blade_of(r, 0)->n_modes;
  const int ground = settings->to_ground, blades = of ? of->blades : ground ? 1 : settings->blades;
  *s = (mhb_modal_structure){
      .blades   = blades,
      .sides    = ground ? 1 : 2,
      .modes    = modes < own_modes ? modes : own_modes,
      .pairs    = r->ring ? r->ring->n / 3 : r->model->n_pairs,
      .wave     = ground && !of ? 0 : (int)mhb_settings_wave_number(settings, blades),
      .mistuned = r->ring != NULL};
  s->contacts = s->blades * s->pairs;
  if (of || (!r->ring && r->model->coriolis && extent != MHB_STRUCTURE_BLADES))
    SHB_TRY(mhb_disc_modes_create(r, settings, blades, s->modes, &s->disc));
  take_arrays(r, extent != MHB_STRUCTURE_LEAN, s);
  mhb_modal_structure_set(r, s);
  return SHB_OK;
}

void mhb_modal_structure_set(const mhb_receptance *r, mhb_modal_structure *s) {
  const int n3 = 3 * s->pairs, side = s->modes * n3;
  if (s->disc) mhb_disc_modes_set(r, s->disc);
  for (int k = 0; k < s->modes * (s->mistuned ? s->blades : 1) && !s->disc; k++) {
    const modal_model *blade = blade_of(r, k / s->modes)->model;
    s->omega[k]              = SHB_TWO_PI * blade->frequency[k % s->modes];
    s->zeta[k % s->modes]    = blade->damping_ratio[k % s->modes];
  }
  for (int k = 0; k < s->sides * side && !s->disc; k++) {
    const int to = k / side, row = k % n3, mode = k % side / n3;
    s->shape[k] =
        s->mistuned ? shape_of(blade_of(r, 0), 0, to * n3 + row, mode) : shape_of(r, to, row, mode);
  }
  set_flexibility(r, s);
}

void mhb_modal_structure_destroy(mhb_modal_structure *s) {
  mhb_disc_modes_destroy(s->disc);
  shb_arena_free(&s->arena);
  *s = (mhb_modal_structure){0};
}
