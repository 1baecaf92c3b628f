#include "mhb/response/response.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/contact/law.h"
#include "mhb/numerics/extent.h"
#include "mhb/response/face_wear.h"
#include "mhb/response/response_fields.h"

enum { FIRST_POINTS = 64 };

mhb_response *mhb_response_create(int n_pairs, int n_probes, int n_harmonics) {
  if (n_pairs < 0 || n_probes < 0 || n_harmonics < 0) return NULL;
  mhb_response *response = shb_alloc_zeroed(1, sizeof *response);
  response->n_pairs      = n_pairs;
  response->n_probes     = n_probes;
  response->n_harmonics  = n_harmonics;
  response->subharmonics = 1;
  response->probe_name   = shb_alloc_zeroed((size_t)n_probes, sizeof *response->probe_name);
  return response;
}

mhb_response *mhb_response_like(const mhb_response *response) {
  mhb_response *like =
      mhb_response_create(response->n_pairs, response->n_probes, response->n_harmonics);
  like->subharmonics      = response->subharmonics;
  like->parameter         = response->parameter;
  like->n_multipliers     = response->n_multipliers;
  like->ring              = response->ring;
  like->output_harmonic   = response->output_harmonic;
  like->quantity          = response->quantity;
  like->n_interfaces      = response->n_interfaces;
  like->tracks_multiplier = response->tracks_multiplier;
  return like;
}

static void free_curve(mhb_lasting_curve *curve) {
  free(curve->frequency);
  free(curve->mean);
  free(curve->worst);
  *curve = (mhb_lasting_curve){0};
}

static void free_modal(mhb_modal_motion *modal) {
  free(modal->point);
  free(modal->amplitude);
  free(modal->force);
  free(modal->scale);
  *modal = (mhb_modal_motion){0};
}

static void free_branch(mhb_branch *branch) {
  for (int i = 0; i < MHB_N_FIELDS; i++) free(mhb_field_get(branch, &mhb_fields[i]));
  mhb_unfinished_destroy(branch->unfinished);
  free(branch->reason);
  free(branch->search);
  free(branch->lasting);
  free_curve(&branch->lasting_curve);
  free_modal(&branch->modal);
  mhb_face_wear_free(&branch->wear);
}

const char *mhb_branch_kind_name(mhb_branch_kind kind) {
  static const char *const name[MHB_N_BRANCH_KINDS] = {"nonlinear", "open", "stuck", "integration",
                                                       "tracked"};
  return name[kind];
}

const char *mhb_special_name(int special) {
  static const char *const name[MHB_N_SPECIALS] = {"",     "fold",           "peak",
                                                   "flip", "Neimark-Sacker", "optimum"};
  return name[special];
}

bool mhb_response_is_linear(const mhb_response *r, const mhb_branch *b, int point) {
  const double *share = b->state + 3 * (size_t)point * (size_t)r->n_pairs;
  for (int a = 0; a < r->n_pairs; a++)
    if (share[3 * a] < 1 && share[3 * a + 2] < 1) return false;
  return true;
}

int mhb_response_harmonic(const mhb_response *r, const mhb_branch *b) {
  const int k = (b->order > 1 ? b->order : 1) * (r->output_harmonic > 1 ? r->output_harmonic : 1);
  return k <= b->n_harmonics ? k : b->n_harmonics;
}

double mhb_response_amplitude(const mhb_response *r, const mhb_branch *b, int point, int place) {
  const size_t          K     = (size_t)b->n_harmonics + 1;
  const bool            probe = place < r->n_probes;
  const size_t          rows  = (size_t)(probe ? r->n_probes : r->n_pairs);
  const size_t          row = (size_t)point * rows + (size_t)(probe ? place : place - r->n_probes);
  const double complex *x   = (probe ? b->probe : b->motion) + row * 3 * K;
  const double complex *driven = x + mhb_response_harmonic(r, b);
  double complex        unused[3];
  if (r->quantity == MHB_OUTPUT_PEAK_TO_PEAK) return mhb_extent_of(3, b->n_harmonics, x).length;
  if (r->quantity == MHB_OUTPUT_RSS)
    return mhb_rss_weight((double complex[3]){driven[0], driven[K], driven[2 * K]}, unused);
  return mhb_semi_major_axis(3, driven, (int)K);
}

double mhb_response_output(const mhb_response *r, const mhb_branch *b, int point) {
  return mhb_response_amplitude(r, b, point, 0);
}

void mhb_response_note_search(mhb_branch *branch, const mhb_search *search) {
  branch->search =
      shb_realloc(branch->search, (size_t)branch->n_searches + 1, sizeof *branch->search);
  branch->search[branch->n_searches++] = *search;
}

void mhb_response_destroy(mhb_response *response) {
  if (!response) return;
  for (int i = 0; i < response->n_branches; i++) free_branch(&response->branch[i]);
  for (int i = 0; i < response->n_probes; i++) free(response->probe_name[i]);
  for (int i = 0; response->interface_name && i < response->n_interfaces; i++)
    free(response->interface_name[i]);
  free(response->interface_name);
  free(response->interface);
  mhb_samples_destroy(response->samples);
  free(response->track);
  free(response->output);
  free(response->branch);
  free(response->probe_name);
  free(response->mode_frequency);
  free(response->mode_damping);
  free(response->eigen_residual);
  free(response);
}

void mhb_response_interfaces(mhb_response *response, int n, char *const *name, const int *interface,
                             int lead) {
  const size_t pairs       = (size_t)response->n_pairs;
  response->interface_name = shb_alloc_zeroed((size_t)n, sizeof *response->interface_name);
  response->interface      = shb_alloc(pairs, sizeof *response->interface);
  response->lead           = lead;
  response->n_interfaces   = n;
  memcpy(response->interface, interface, pairs * sizeof *interface);
  for (int i = 0; i < n; i++) response->interface_name[i] = shb_text(name[i]);
}

int mhb_response_branch(mhb_response *response, mhb_branch_kind kind) {
  int n = response->n_branches;
  if (n == response->capacity) {
    response->capacity = n > 8 ? 2 * n : 16;
    response->branch =
        shb_realloc(response->branch, (size_t)response->capacity, sizeof *response->branch);
  }
  response->branch[n] = (mhb_branch){.kind        = kind,
                                     .order       = response->subharmonics,
                                     .n_harmonics = response->n_harmonics,
                                     .main        = n,
                                     .searched    = true};
  return response->n_branches++;
}

static void grow(const mhb_response *response, mhb_branch *branch) {
  int capacity = branch->capacity ? 2 * branch->capacity : FIRST_POINTS;
  for (int i = 0; i < MHB_N_FIELDS; i++) {
    if (!mhb_field_kept(response, branch, &mhb_fields[i])) continue;
    const size_t row = mhb_field_row(response, branch, &mhb_fields[i]);
    mhb_field_set(branch, &mhb_fields[i],
                  shb_realloc(mhb_field_get(branch, &mhb_fields[i]), (size_t)capacity, row));
  }
  branch->capacity = capacity;
}

int mhb_response_point(mhb_response *response, int branch) {
  mhb_branch *b = &response->branch[branch];
  if (b->n_points == b->capacity) grow(response, b);
  for (int i = 0; i < MHB_N_FIELDS; i++) {
    if (!mhb_field_kept(response, b, &mhb_fields[i])) continue;
    size_t row = mhb_field_row(response, b, &mhb_fields[i]);
    memset((char *)mhb_field_get(b, &mhb_fields[i]) + (size_t)b->n_points * row, 0, row);
  }
  return b->n_points++;
}

/* Moves the last of n rows to place at, byte by byte: no memory is needed. */
static void rotate(char *data, size_t row, size_t at, size_t n) {
  for (size_t i = n - 1; i > at; i--)
    for (size_t k = 0; k < row; k++) {
      char swap               = data[i * row + k];
      data[i * row + k]       = data[(i - 1) * row + k];
      data[(i - 1) * row + k] = swap;
    }
}

void mhb_response_place(mhb_response *response, int branch, int at) {
  mhb_branch *b = &response->branch[branch];
  for (int i = 0; i < MHB_N_FIELDS; i++)
    if (mhb_field_kept(response, b, &mhb_fields[i]))
      rotate(mhb_field_get(b, &mhb_fields[i]), mhb_field_row(response, b, &mhb_fields[i]),
             (size_t)at, (size_t)b->n_points);
}

/* to <- `rows` rows of harmonics, `after` bytes each, of which `before` are given. From the last
 * on: both may begin at the same place. */
static void spread(char *to, size_t after, const char *from, size_t before, size_t rows) {
  for (size_t i = rows; i-- > 0;) {
    memmove(to + i * after, from + i * before, before);
    memset(to + i * after + before, 0, after - before);
  }
}

/* Bytes of the harmonics of one row; 0: the field has none. */
static size_t harmonics_of(const mhb_branch *branch, const mhb_field *f) {
  return strchr(f->dims, 'k') ? ((size_t)branch->n_harmonics + 1) * mhb_field_bytes(f->kind) : 0;
}

void mhb_response_widen(const mhb_response *response, mhb_branch *branch, int n_harmonics) {
  mhb_branch wide  = *branch;
  wide.n_harmonics = n_harmonics;
  for (int i = 0; i < MHB_N_FIELDS && branch->n_harmonics < n_harmonics; i++) {
    const mhb_field *f      = &mhb_fields[i];
    const size_t     before = harmonics_of(branch, f), after = harmonics_of(&wide, f);
    if (before == 0 || !mhb_field_kept(response, branch, f) || branch->capacity == 0) continue;
    const size_t row = mhb_field_row(response, branch, f) / before; /* rows of a point */
    char *data       = shb_realloc(mhb_field_get(branch, f), (size_t)branch->capacity * row, after);
    mhb_field_set(branch, f, data);
    spread(data, after, data, before, (size_t)branch->n_points * row);
  }
  if (branch->n_harmonics < n_harmonics) branch->n_harmonics = n_harmonics;
}

void mhb_response_copy_points(mhb_response *to, int to_branch, const mhb_response *from,
                              int from_branch, int first, int last) {
  const mhb_branch *a    = &from->branch[from_branch];
  mhb_branch       *b    = &to->branch[to_branch];
  int               step = first <= last ? 1 : -1;
  mhb_response_widen(to, b, a->n_harmonics);
  for (int i = first; i != last + step; i += step) {
    const int point = mhb_response_point(to, to_branch);
    for (int k = 0; k < MHB_N_FIELDS; k++) {
      const mhb_field *f = &mhb_fields[k];
      if (!mhb_field_kept(to, b, f)) continue;
      const size_t row = mhb_field_row(to, b, f), own = mhb_field_row(from, a, f);
      const size_t before = own == row ? row : harmonics_of(a, f);
      const size_t after  = own == row ? row : harmonics_of(b, f);
      spread((char *)mhb_field_get(b, f) + (size_t)point * row, after,
             (char *)mhb_field_get(a, f) + (size_t)i * own, before, row / after);
    }
  }
}

void mhb_response_lasting_curve(mhb_branch *branch, int n) {
  mhb_lasting_curve *c = &branch->lasting_curve;
  free_curve(c);
  if (n == 0) return;
  c->frequency = shb_alloc_zeroed((size_t)n, sizeof(double));
  c->mean      = shb_alloc_zeroed((size_t)n, sizeof(double));
  c->worst     = shb_alloc_zeroed((size_t)n, sizeof(double));
  c->n         = n;
}

double mhb_response_lasting_missed(int starts) {
  return pow(5. / 6, starts);
}

void mhb_response_copy_lasting(mhb_branch *to, const mhb_branch *from) {
  const mhb_lasting_curve *a = &from->lasting_curve, *b = &to->lasting_curve;
  const size_t             size = sizeof(double) * (size_t)a->n;
  free(to->lasting);
  to->lasting = from->lasting ? shb_text(from->lasting) : NULL;
  mhb_response_lasting_curve(to, a->n);
  if (a->n == 0) return;
  memcpy(b->frequency, a->frequency, size);
  memcpy(b->mean, a->mean, size);
  memcpy(b->worst, a->worst, size);
}

void mhb_response_modal(const mhb_response *response, mhb_branch *branch, int n, int n_contact) {
  mhb_modal_motion *modal = &branch->modal;
  const size_t      rows  = (size_t)n * ((size_t)branch->n_harmonics + 1);
  free_modal(modal);
  if (n == 0) return;
  modal->point     = shb_alloc_zeroed((size_t)n, sizeof *modal->point);
  modal->amplitude = shb_alloc_zeroed(rows * (size_t)response->n_modes, sizeof *modal->amplitude);
  modal->force     = shb_alloc_zeroed(rows * (size_t)n_contact, sizeof *modal->force);
  modal->scale     = shb_alloc_zeroed((size_t)n, sizeof *modal->scale);
  modal->n         = n;
  modal->n_contact = n_contact;
}

void mhb_response_drop(mhb_response *response, const bool *drop) {
  int n = response->n_branches, kept = 0, to[n + 1];
  for (int i = 0; i < n; i++) {
    to[i] = kept;
    if (drop[i]) free_branch(&response->branch[i]);
    if (!drop[i]) response->branch[kept++] = response->branch[i];
  }
  response->n_branches = kept;
  for (int i = 0; i < kept; i++) response->branch[i].main = to[response->branch[i].main];
}

/* Insertion sort: stable, and there are few branches. Main branches keep their places, so that main
 * stays right. */
void mhb_response_sort(mhb_response *response) {
  mhb_branch *b = response->branch;
  for (int i = 1; i < response->n_branches; i++) {
    mhb_branch moved = b[i];
    int        at    = i;
    if (moved.main == i) continue;
    for (; at > 0 && b[at - 1].main != at - 1 && b[at - 1].main > moved.main; at--)
      b[at] = b[at - 1];
    b[at] = moved;
  }
}

shb_status mhb_response_merge(mhb_response *response, mhb_response *other) {
  SHB_CHECK(response->n_pairs == other->n_pairs && response->n_probes == other->n_probes &&
                response->subharmonics == other->subharmonics &&
                response->n_interfaces == other->n_interfaces &&
                response->parameter == other->parameter,
            SHB_ERR_INPUT,
            "%d pairs, %d probes, subharmonics %d do not go with %d, %d, %d; make both files from "
            "one case",
            other->n_pairs, other->n_probes, other->subharmonics, response->n_pairs,
            response->n_probes, response->subharmonics);
  int before = response->n_branches, index = 0;
  for (int i = 0; i < other->n_branches; i++) {
    mhb_branch *branch      = &other->branch[i];
    index                   = mhb_response_branch(response, branch->kind);
    response->branch[index] = *branch;
    response->branch[index].main += before;
    memset(branch, 0, sizeof *branch);
  }
  other->n_branches = 0;
  if (other->n_lines > response->n_lines) response->n_lines = other->n_lines;
  return SHB_OK;
}

/* ---- a curve under way ---- */

mhb_unfinished *mhb_unfinished_create(const mhb_response *like) {
  mhb_unfinished *u = shb_alloc_zeroed(1, sizeof *u);
  u->segments       = mhb_response_like(like);
  return u;
}

void mhb_unfinished_destroy(mhb_unfinished *u) {
  if (!u) return;
  for (int i = 0; i < u->n; i++) mhb_trace_state_free(&u->state[i]);
  free(u->state);
  mhb_response_destroy(u->segments);
  free(u);
}

static void copy_segment(mhb_unfinished *u, const mhb_response *segments, int i,
                         const mhb_trace_state *state) {
  int               index = 0;
  const mhb_branch *from  = &segments->branch[i];
  index                   = mhb_response_branch(u->segments, from->kind);
  if (from->n_points > 0)
    mhb_response_copy_points(u->segments, index, segments, i, 0, from->n_points - 1);
  mhb_trace_state *to = &u->state[u->n++];
  mhb_trace_state_numbers(to, state->number, state->n);
}

mhb_unfinished *mhb_unfinished_copy(const mhb_response *segments, int n,
                                    const mhb_trace_state *state) {
  mhb_unfinished *u = mhb_unfinished_create(segments);
  u->state          = shb_alloc_zeroed((size_t)n, sizeof *u->state);
  for (int i = 0; i < n; i++) copy_segment(u, segments, i, &state[i]);
  return u;
}

bool mhb_friction_loads_others(int n_pairs, int on_contact, const bool *free_mean,
                               const double *share) {
  bool sticks = false, moves = false, shares = false;
  for (int first = 0; first < n_pairs; first += on_contact) {
    int touch = 0, stuck = 0;
    for (int a = first; a < first + on_contact; a++) {
      const double *of = share + 3 * a;
      touch += of[MHB_SEPARATE] < 1;
      stuck += free_mean[a];
      moves = moves || (of[MHB_SEPARATE] < 1 && of[MHB_STICK] < 1);
    }
    sticks = sticks || stuck > 0;
    shares = shares || (stuck > 0 && touch > 1);
  }
  return shares || (sticks && moves);
}

bool mhb_branch_marked(const mhb_branch *branch, int point) {
  return (branch->mark[point] & MHB_ABOVE_TOLERANCE) != 0;
}

mhb_marks mhb_response_marks(const mhb_response *response) {
  mhb_marks          marks = {0};
  const mhb_samples *s     = response->samples;
  for (int i = 0; s && i < s->preloads; i++) {
    marks.samples += mhb_samples_done(s, i);
    marks.marked_samples += mhb_samples_marked(s, i);
  }
  for (int i = 0; i < response->n_branches; i++) {
    const mhb_branch *b = &response->branch[i];
    if (b->kind != MHB_BRANCH_NONLINEAR && b->kind != MHB_BRANCH_TRACKED) continue;
    marks.points += b->n_points;
    for (int p = 0; p < b->n_points; p++) {
      if (!mhb_branch_marked(b, p)) continue;
      const int harmonics = b->harmonics ? b->harmonics[p] : b->n_harmonics;
      marks.marked++;
      marks.largest = fmax(marks.largest, b->error_truncation[p]);
      if (harmonics > marks.harmonics) marks.harmonics = harmonics;
    }
  }
  return marks;
}
