#include "mhb/integration/amplitudes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

/* Below this size of x the series is used. */
static const double SMALL = 3;

void mhb_amplitudes_responses(double complex x, double complex response[MHB_POWERS]) {
  enum { LAST = MHB_POWERS - 1, TERMS = 40 };
  static const double inverse_factorial[MHB_POWERS] = {1,       1,        1. / 2,  1. / 6,
                                                       1. / 24, 1. / 120, 1. / 720};
  if (cabs(x) >= SMALL) {
    response[0] = cexp(x);
    for (int k = 0; k < LAST; k++) response[k + 1] = (response[k] - inverse_factorial[k]) / x;
    return;
  }
  double complex term = inverse_factorial[LAST], sum = 0;
  for (int n = 1; n <= TERMS; n++) {
    sum += term;
    term *= x / (n + LAST);
  }
  response[LAST] = sum;
  for (int k = LAST; k > 0; k--) response[k - 1] = x * response[k] + inverse_factorial[k - 1];
}

/* ---- groups ---- */

/* Adds all modes that G joins to those of the group that begins at `first`. Returns its end. */
static int collect(const double *G, int modes, bool *taken, int *member, int first) {
  int end = first + 1;
  for (int at = first; at < end; at++)
    for (int j = 0; j < modes; j++) {
      if (taken[j] || G[(size_t)member[at] * (size_t)modes + (size_t)j] == 0) continue;
      taken[j]      = true;
      member[end++] = j;
    }
  return end;
}

static void set_groups(const double *G, bool *taken, mhb_amplitudes *a) {
  for (int i = 0; i < a->modes; i++) {
    if (taken[i]) continue;
    const int first         = a->first[a->n_groups];
    taken[i]                = true;
    a->member[first]        = i;
    a->first[++a->n_groups] = collect(G, a->modes, taken, a->member, first);
  }
}

/* Numbers of the groups before one, in to_state and to_amplitude. */
static size_t offset_of(const mhb_amplitudes *a, int group) {
  size_t sum = 0;
  for (int g = 0; g < group; g++) {
    const size_t size = (size_t)(a->first[g + 1] - a->first[g]);
    sum += 2 * size * size;
  }
  return sum;
}

/* ---- amplitudes of a group ---- */

static shb_status solve_group(const modal_model *model, const mhb_modal_structure *s,
                              const int *member, int n, mhb_damped_modes *modes) {
  const size_t    m = (size_t)model->n_modes, size = (size_t)n;
  double          omega[size], loss[size];
  double complex *G = shb_alloc(size * size, sizeof *G);
  *modes            = (mhb_damped_modes){0};
  for (int i = 0; i < n; i++) {
    omega[i] = s->omega[member[i]];
    loss[i]  = 2 * s->zeta[member[i]] * omega[i];
    for (int j = 0; j < n; j++)
      G[i * n + j] = model->coriolis[(size_t)member[i] * m + (size_t)member[j]];
  }
  shb_status status = mhb_damped_modes_solve(n, omega, loss, G, modes);
  free(G);
  return status;
}

/* Rows of motion and force for the amplitudes of a group. */
static void set_rows(const mhb_amplitudes *a, int group, const double *shape, size_t rows) {
  const int             first = a->first[group], n = a->first[group + 1] - first;
  const size_t          m = (size_t)a->modes, at = offset_of(a, group);
  const double complex *out = a->to_state + at, *in = a->to_amplitude + at;
  for (size_t r = 0; r < rows; r++)
    for (int i = 0; i < n; i++) {
      double complex motion = 0, force = 0;
      for (int j = 0; j < n; j++) {
        const double phi = shape[r * m + (size_t)a->member[first + j]];
        motion += phi * out[j * n + i];
        force += in[i * 2 * n + n + j] * phi;
      }
      const size_t to   = 2 * r * m + (size_t)(first + i);
      a->motion[to]     = creal(motion); /* Re(motion a) */
      a->motion[to + m] = -cimag(motion);
      a->force[to]      = creal(force);
      a->force[to + m]  = cimag(force);
    }
}

static shb_status set_group(const modal_model *model, const mhb_modal_structure *s,
                            const double *shape, int group, mhb_amplitudes *a) {
  const int        first = a->first[group], n = a->first[group + 1] - first;
  const size_t     at = offset_of(a, group);
  mhb_damped_modes modes;
  shb_status       status = solve_group(model, s, a->member + first, n, &modes);
  for (int i = 0; i < n && status == SHB_OK; i++) {
    a->pole[first + i] = modes.pole[i];
    for (int j = 0; j < 2 * n; j++) {
      a->to_state[at + (size_t)(j * n + i)]         = 2 * modes.to_state[j * 2 * n + i];
      a->to_amplitude[at + (size_t)(i * 2 * n + j)] = modes.to_amplitude[i * 2 * n + j];
    }
  }
  mhb_damped_modes_free(&modes);
  if (status == SHB_OK) set_rows(a, group, shape, 3 * (size_t)(s->sides * s->pairs));
  return status;
}

/* ---- states ---- */

void mhb_amplitudes_take(const mhb_amplitudes *a, double *z, double *v) {
  double re[a->modes], im[a->modes];
  for (int g = 0; g < a->n_groups; g++) {
    const int             first = a->first[g], n = a->first[g + 1] - first;
    const double complex *in = a->to_amplitude + offset_of(a, g);
    for (int i = 0; i < n; i++) {
      double complex sum = 0;
      for (int j = 0; j < 2 * n; j++)
        sum += in[i * 2 * n + j] * (j < n ? z : v)[a->member[first + j % n]];
      re[first + i] = creal(sum);
      im[first + i] = cimag(sum);
    }
  }
  memcpy(z, re, sizeof re);
  memcpy(v, im, sizeof im);
}

void mhb_amplitudes_give(const mhb_amplitudes *a, double *z, double *v) {
  double q[a->modes], rate[a->modes];
  for (int g = 0; g < a->n_groups; g++) {
    const int             first = a->first[g], n = a->first[g + 1] - first;
    const double complex *out = a->to_state + offset_of(a, g);
    for (int j = 0; j < 2 * n; j++) {
      double sum = 0;
      for (int i = 0; i < n; i++) sum += creal(out[j * n + i] * CMPLX(z[first + i], v[first + i]));
      (j < n ? q : rate)[a->member[first + j % n]] = sum;
    }
  }
  memcpy(z, q, sizeof q);
  memcpy(v, rate, sizeof rate);
}

/* ---- life cycle ---- */

static shb_status make(const modal_model *model, const mhb_modal_structure *s, const double *shape,
                       mhb_amplitudes *a) {
  const size_t m = (size_t)a->modes, rows = 3 * (size_t)(s->sides * s->pairs);
  bool        *taken = shb_arena_take(&a->arena, m, sizeof *taken);
  a->pole            = shb_arena_take(&a->arena, m, sizeof *a->pole);
  a->first           = shb_arena_take(&a->arena, m + 1, sizeof *a->first);
  a->member          = shb_arena_take(&a->arena, m, sizeof *a->member);
  a->motion          = shb_arena_take(&a->arena, 2 * rows * m, sizeof *a->motion);
  a->force           = shb_arena_take(&a->arena, 2 * rows * m, sizeof *a->force);
  set_groups(model->coriolis, taken, a);
  const size_t all = offset_of(a, a->n_groups);
  a->to_state      = shb_arena_take(&a->arena, all, sizeof *a->to_state);
  a->to_amplitude  = shb_arena_take(&a->arena, all, sizeof *a->to_amplitude);
  for (int g = 0; g < a->n_groups; g++) SHB_TRY(set_group(model, s, shape, g, a));
  return SHB_OK;
}

shb_status mhb_amplitudes_create(const modal_model *model, const mhb_modal_structure *s,
                                 const double *shape, mhb_amplitudes **out) {
  mhb_amplitudes *a = shb_alloc_zeroed(1, sizeof *a);
  a->modes          = s->modes;
  shb_status status = make(model, s, shape, a);
  if (status != SHB_OK) {
    mhb_amplitudes_destroy(a);
    return status;
  }
  *out = a;
  return SHB_OK;
}

void mhb_amplitudes_destroy(mhb_amplitudes *a) {
  if (!a) return;
  shb_arena_free(&a->arena);
  free(a);
}
