#include "mhb/response/modal_motion.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/problem/other_pairs.h"
#include "mhb/structure/receptance.h"

/* A curve passes a frequency of the list between point i - 1 and point i, or ends on it. */
static void mark_passed(const mhb_branch *b, double f, bool *wanted) {
  for (int i = 0; i < b->n_points; i++) {
    double here = b->frequency[i] - f, before = i > 0 ? b->frequency[i - 1] - f : here;
    if (here == 0)
      wanted[i] = true;
    else if (before * here < 0)
      wanted[fabs(before) < fabs(here) ? i - 1 : i] = true;
  }
}

static void mark_peaks(const mhb_response *response, const mhb_branch *b, bool *wanted) {
  double most    = -1;
  int    highest = 0;
  for (int i = 0; i < b->n_points; i++) {
    double output = mhb_response_output(response, b, i);
    wanted[i]     = b->special[i] == MHB_PEAK;
    if (output > most) most = output, highest = i;
  }
  wanted[highest] = true;
}

/* wanted[points], zeroed before. Returns their number. */
static int choose(const mhb_response *response, const mhb_branch *b, const mhb_save_settings *save,
                  bool *wanted) {
  int n = 0;
  if (save->what == MHB_SAVE_PEAKS) mark_peaks(response, b, wanted);
  for (int i = 0; save->what == MHB_SAVE_LISTED && i < save->n; i++)
    mark_passed(b, save->frequency[i], wanted);
  for (int i = 0; i < b->n_points; i++) {
    wanted[i] = wanted[i] || save->what == MHB_SAVE_ALL;
    n += wanted[i];
  }
  return n;
}

/* force[side][pair][axis] <- -T^H p, on the blade. */
static void contact_force(const mhb_receptance *r, int k, const double complex *p,
                          double complex *force) {
  const mhb_relative *t = &r->part->relative;
  for (int side = 0; side < t->sides; side++)
    for (int c = 0; c < r->n; c++) {
      double complex sum = 0;
      for (int row = c - c % 3; row < c - c % 3 + 3; row++)
        sum -= conj(mhb_relative_weight(t, row, side, c % 3, r->phase[k])) * p[row];
      force[side * r->n + c] = sum;
    }
}

/* to[n] <- force on the pairs of the modal file, which the pairs of the response may join. */
static void put_force(const mhb_other_pairs *pairs, int sides, const double complex *own, int n,
                      double complex *to) {
  if (pairs && pairs->finer)
    modal_joining_spread(pairs->joining, sides, own, to);
  else
    memcpy(to, own, (size_t)n * sizeof *to);
}

/* The amplitudes and forces of one point. */
static void fill_point(const mhb_response *response, const mhb_other_pairs *pairs, mhb_branch *b,
                       int at, mhb_receptance *r) {
  const int             point = b->modal.point[at], sides = r->part->relative.sides;
  const size_t          K = (size_t)b->n_harmonics + 1, n = (size_t)r->n;
  const double complex *force = b->force + (size_t)point * n * K;
  double complex        p[n], own[(size_t)sides * n];
  mhb_receptance_set_frequency(r, SHB_TWO_PI * b->frequency[point]);
  if (response->parameter == MHB_IN_SCALE) mhb_receptance_scale(r, b->value[point]);
  for (size_t k = 0; k < K; k++) {
    for (size_t row = 0; row < n; row++) p[row] = force[row * K + k];
    const size_t row = (size_t)at * K + k;
    mhb_receptance_amplitudes(r, (int)k, p, b->modal.amplitude + row * (size_t)response->n_modes);
    contact_force(r, (int)k, p, own);
    put_force(pairs, sides, own, b->modal.n_contact,
              b->modal.force + row * (size_t)b->modal.n_contact);
  }
  b->modal.scale[at] = r->scale;
}

/* The receptance of the last branch serves the next one of the same order and harmonics. */
static shb_status renew(const modal_model *model, const mhb_settings *settings, const mhb_branch *b,
                        mhb_receptance **r) {
  mhb_settings own = *settings;
  if (*r && (*r)->nu == b->order && (*r)->n_harmonics == b->n_harmonics) return SHB_OK;
  mhb_receptance_destroy(*r);
  *r               = NULL;
  own.subharmonics = b->order;
  return mhb_receptance_create(model, &own, b->n_harmonics, r);
}

static shb_status keep(const modal_model *model, const mhb_settings *settings,
                       const mhb_response *response, mhb_branch *b, mhb_receptance **r) {
  const mhb_other_pairs *other = settings->other_pairs;
  const int              sides = settings->to_ground ? 1 : 2;
  const int              pairs = other && other->finer ? other->model->n_pairs : response->n_pairs;
  if (b->n_points == 0) {
    mhb_response_modal(response, b, 0, 0);
    return SHB_OK;
  }
  bool      *wanted = shb_alloc_zeroed((size_t)b->n_points, sizeof *wanted);
  int        n = choose(response, b, &settings->save, wanted), at = 0;
  shb_status status = SHB_OK;
  mhb_response_modal(response, b, n, 3 * pairs * sides);
  if (n > 0) status = renew(model, settings, b, r);
  for (int i = 0; status == SHB_OK && n > 0 && i < b->n_points; i++) {
    if (!wanted[i]) continue;
    b->modal.point[at] = i;
    fill_point(response, settings->other_pairs, b, at++, *r);
  }
  free(wanted);
  return status;
}

shb_status mhb_modal_motion_keep(const modal_model *model, const mhb_settings *settings,
                                 mhb_response *response) {
  mhb_receptance *r      = NULL;
  shb_status      status = SHB_OK;
  if (settings->run_up || settings->ring) return SHB_OK; /* no model of theirs is in a file */
  for (int i = 0; status == SHB_OK && i < response->n_branches; i++)
    status = keep(model, settings, response, &response->branch[i], &r);
  mhb_receptance_destroy(r);
  return status;
}
