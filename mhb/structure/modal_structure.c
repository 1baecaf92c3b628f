#include "mhb/structure/modal_structure.h"

#include <string.h>

#include "mesh/base/constants.h"
#include "modal/model/nodal_diameters.h"

/* Wave number E' = (E + N l)/nu of the fundamental. */
static int wave_of(const mhb_settings *s, int blades) {
  const mhb_settings own = {
      .engine_order = s->engine_order, .blades = blades, .subharmonics = s->subharmonics};
  return (int)((s->engine_order + (long)blades * mhb_wave_shift(&own)) / s->subharmonics);
}

/* T0^T x of a pair in a mode, negative on the left. */
static double shape_of(const mhb_receptance *r, int side, int row, int mode) {
  const double *x   = side ? r->model->left : r->model->right;
  double        sum = 0;
  for (int axis = 0; axis < 3; axis++)
    sum += r->T0[(row / 3) * 9 + axis * 3 + row % 3] * x[(row / 3 * 3 + axis) * r->n_modes + mode];
  return side ? -sum : sum;
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
  if (s != t) sum = -sum;
  for (int i = first; i < r->n_modes; i++) {
    double w = SHB_TWO_PI * model->frequency[i];
    sum += shape_of(r, s, row, i) * shape_of(r, t, column, i) / (w * w);
  }
  return sum;
}

static void set_flexibility(const mhb_receptance *r, mhb_modal_structure *s) {
  int n3 = r->n, n = 3 * s->contacts;
  for (int k = 0; k < s->blades * s->sides * s->sides; k++) {
    int blade = k / (s->sides * s->sides), to = k / s->sides % s->sides, by = k % s->sides;
    int row0    = 3 * mhb_modal_structure_contact(s, blade, to);
    int column0 = 3 * mhb_modal_structure_contact(s, blade, by);
    for (int row = 0; row < n3; row++)
      for (int column = 0; column < n3; column++)
        s->flexibility[(size_t)(row0 + row) * (size_t)n + (size_t)(column0 + column)] +=
            flexibility(r, to, row, by, column, s->modes);
  }
}

static void take_arrays(const mhb_receptance *r, mhb_modal_structure *s) {
  const size_t n = 3 * (size_t)s->contacts, m = (size_t)s->modes, side = m * (size_t)r->n;
  if (!s->disc) {
    s->omega = shb_arena_take(&s->arena, m, sizeof(double));
    s->zeta  = shb_arena_take(&s->arena, m, sizeof(double));
    s->shape = shb_arena_take(&s->arena, (size_t)s->sides * side, sizeof(double));
  }
  if (r->model->residual_flexibility || s->modes < r->n_modes)
    s->flexibility = shb_arena_take(&s->arena, n * n, sizeof(double));
}

shb_status mhb_modal_structure_create(const mhb_receptance *r, const mhb_settings *settings,
                                      int modes, mhb_modal_structure *s) {
  const modal_model           *model = r->model;
  const modal_nodal_diameters *of    = settings->nodal_diameters;
  const int ground = settings->to_ground, blades = of ? of->blades : ground ? 1 : settings->blades;
  *s          = (mhb_modal_structure){.blades = blades,
                                      .sides  = ground ? 1 : 2,
                                      .modes  = modes < r->n_modes ? modes : r->n_modes,
                                      .pairs  = model->n_pairs,
                                      .wave   = ground && !of ? 0 : wave_of(settings, blades)};
  s->contacts = s->blades * s->pairs;
  if (of) SHB_TRY(mhb_disc_modes_create(r, settings, s->modes, &s->disc));
  take_arrays(r, s);
  if (s->arena.failed) {
    mhb_modal_structure_destroy(s);
    SHB_FAIL(SHB_ERR_IO, "out of memory for the structure of %d contacts", s->contacts);
  }
  mhb_modal_structure_set(r, s);
  return SHB_OK;
}

void mhb_modal_structure_set(const mhb_receptance *r, mhb_modal_structure *s) {
  const size_t side = (size_t)s->modes * (size_t)r->n, n = 3 * (size_t)s->contacts;
  if (s->flexibility) memset(s->flexibility, 0, n * n * sizeof *s->flexibility);
  if (s->disc) {
    if (s->flexibility) mhb_disc_modes_add_map(s->disc, s->disc->flexibility, s->flexibility);
    return;
  }
  for (int i = 0; i < s->modes; i++) {
    s->omega[i] = SHB_TWO_PI * r->model->frequency[i];
    s->zeta[i]  = r->model->damping_ratio[i];
  }
  for (size_t k = 0; k < (size_t)s->sides * side; k++)
    s->shape[k] = shape_of(r, k >= side, (int)(k % (size_t)r->n), (int)(k % side) / r->n);
  if (s->flexibility) set_flexibility(r, s);
}

void mhb_modal_structure_destroy(mhb_modal_structure *s) {
  mhb_disc_modes_destroy(s->disc);
  shb_arena_free(&s->arena);
  *s = (mhb_modal_structure){0};
}
