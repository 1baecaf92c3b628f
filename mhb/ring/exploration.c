#include "mhb/ring/exploration.h"

#include <math.h>

enum {
  AGREE_BLOCKS   = 18, /* two settled starts that agree are a motion */
  SEVERAL_BLOCKS = 27  /* a settled start that stays apart is one */
};

/* Blocks after which a start is read: 5 leave three that count. */
static const int targets[] = {5, 8, 12, AGREE_BLOCKS, SEVERAL_BLOCKS, MHB_START_BLOCKS};

static const double LEAST_START = 0.03, MOST_START = 0.1; /* relative disturbances */
static const double DIFFERENT = 2;                        /* mhb_motion_distance */

/* ---- decision ---- */

static double larger(double a, double b) {
  return a > b ? a : b;
}

mhb_start_verdict mhb_start_judge(const mhb_motion *m, int blocks, bool last, double away) {
  const bool told = m->wave || m->settled;
  if (away < 1 && (told || m->calm)) return MHB_START_JOINS;
  if (away > DIFFERENT && told && (last || blocks >= SEVERAL_BLOCKS)) return MHB_START_IS_NEW;
  if (!last) return MHB_START_GOES_ON;
  if (away <= DIFFERENT) return MHB_START_JOINS;
  return isinf(away) ? MHB_START_IS_NEW : MHB_START_UNTOLD;
}

bool mhb_starts_agree(const mhb_motion *a, const mhb_motion *b, int blocks) {
  const bool told = (a->wave && b->wave) || (a->settled && b->settled);
  return blocks >= AGREE_BLOCKS && told && mhb_motion_distance(a, b) < 1;
}

mhb_motion mhb_motions_joined(const mhb_motion *a, const mhb_motion *b) {
  return (mhb_motion){.wave        = a->wave && b->wave,
                      .settled     = a->settled && b->settled,
                      .starts      = a->starts + b->starts,
                      .half        = {.mean  = 0.5 * (a->half.mean + b->half.mean),
                                      .error = larger(a->half.error, b->half.error)},
                      .last        = 0.5 * (a->last + b->last),
                      .worst       = 0.5 * (a->worst + b->worst),
                      .worst_error = larger(a->worst_error, b->worst_error)};
}

/* ---- starts ---- */

/* The first two are the smallest and the largest. */
static double size_of(int start) {
  const double part = (start - 1.) / (MHB_LASTING_STARTS - 1);
  return start == 0   ? LEAST_START
         : start == 1 ? MOST_START
                      : LEAST_START + (MOST_START - LEAST_START) * part;
}

/* Whether one more start may begin beside those that run. */
static bool may_begin(const mhb_exploration *x) {
  int running = 0;
  if (x->begun == (x->noise ? MHB_LASTING_STARTS : 1)) return false;
  for (int c = 0; c < x->starts->ring.model->copies; c++) running += x->starts->runs[c];
  return x->begun < 2 || x->most_periods == 0 ||
         x->periods + running * targets[0] * MHB_START_BLOCK < x->most_periods;
}

static void begin(mhb_exploration *x, int copy) {
  mhb_starts *s = x->starts;
  mhb_ring_load(&s->ring, copy, x->from, s->output.space);
  if (x->noise) mhb_ring_disturb_copy(&s->ring, copy, &s->output, size_of(x->begun), x->noise);
  mhb_start_begin(s, copy);
  x->blocks[copy] = 0;
  x->begun++;
}

/* ---- groups ---- */

/* The start of a copy belongs to a group, and ends there. */
static void join(mhb_exploration *x, int copy, int which) {
  mhb_motion_group *g = &x->group[which];
  mhb_starts       *s = x->starts;
  s->runs[copy]       = false;
  x->blocks[copy]     = 0;
  x->told++;
  x->last = copy;
  if (g->n_states < s->ring.model->copies)
    mhb_ring_save(&s->ring, copy, s->output.space, &g->state[g->n_states++]);
}

/* A motion that is known from now on. More than can be kept are not told apart. */
static bool add_group(mhb_exploration *x, const mhb_motion *m) {
  if (x->n_groups == MHB_LASTING_MOTIONS) return false;
  x->group[x->n_groups++].motion = *m;
  return true;
}

static int nearest(const mhb_exploration *x, const mhb_motion *m, double *away) {
  int best = 0;
  *away    = INFINITY;
  for (int i = 0; i < x->n_groups; i++) {
    const double d = mhb_motion_distance(&x->group[i].motion, m);
    if (d < *away) best = i;
    *away = fmin(d, *away);
  }
  return best;
}

/* Another start, still under way, that shows the same motion as a copy; -1: none. */
static int like(const mhb_exploration *x, int copy) {
  for (int c = 0; c < x->starts->ring.model->copies; c++) {
    const int blocks = x->blocks[c] < x->blocks[copy] ? x->blocks[c] : x->blocks[copy];
    if (c != copy && x->starts->runs[c] && mhb_starts_agree(&x->now[c], &x->now[copy], blocks))
      return c;
  }
  return -1;
}

static void give_up(mhb_exploration *x, int copy) {
  x->starts->runs[copy] = false;
  x->error              = larger(x->error, x->now[copy].half.error);
  x->blocks[copy]       = 0;
}

/* What a start shows after a block, if it is read then. */
static void judge(mhb_exploration *x, int copy) {
  const int blocks = x->starts->start[copy].periods / MHB_START_BLOCK;
  bool      read   = false;
  double    away, mean[MHB_START_BLOCKS], spread[MHB_START_BLOCKS];
  for (size_t t = 0; t < sizeof targets / sizeof *targets; t++) read = read || targets[t] == blocks;
  if (!read || (x->patient && blocks < AGREE_BLOCKS)) return;
  const bool               last   = blocks == MHB_START_BLOCKS;
  const mhb_lasting_series all    = mhb_starts_series(x->starts, 1, &copy, mean, spread, x->peaks);
  mhb_motion              *m      = &x->now[copy];
  *m                              = mhb_motion_of(&all, last);
  x->blocks[copy]                 = blocks;
  const int               known   = nearest(x, m, &away);
  const mhb_start_verdict verdict = mhb_start_judge(m, blocks, last, away);
  const int               other   = verdict == MHB_START_GOES_ON ? like(x, copy) : -1;
  if (verdict == MHB_START_JOINS) {
    x->group[known].motion.starts++;
    join(x, copy, known);
  } else if (other >= 0) {
    const mhb_motion both = mhb_motions_joined(m, &x->now[other]);
    if (!add_group(x, &both)) return;
    join(x, other, x->n_groups - 1);
    join(x, copy, x->n_groups - 1);
  } else if (verdict == MHB_START_IS_NEW && add_group(x, m)) {
    join(x, copy, x->n_groups - 1);
  } else if (verdict != MHB_START_GOES_ON) {
    give_up(x, copy);
  }
}

void mhb_explore(mhb_exploration *x) {
  mhb_starts *s      = x->starts;
  const int   copies = s->ring.model->copies;
  for (int c = 0; c < copies; c++) s->runs[c] = false;
  for (;;) {
    int running = 0;
    for (int c = 0; c < copies; c++) {
      if (!s->runs[c] && may_begin(x)) begin(x, c);
      running += s->runs[c];
    }
    if (running == 0) return;
    x->stopped = !mhb_starts_block(s, x->go_on, x->context);
    if (x->stopped) return;
    x->periods += running * MHB_START_BLOCK;
    for (int c = 0; c < copies; c++)
      if (s->runs[c]) judge(x, c);
  }
}

void mhb_motion_groups_free(mhb_motion_group *group, int n) {
  for (int i = 0; i < n; i++)
    for (int k = 0; k < MHB_LANES; k++) shb_arena_free(&group[i].state[k].arena);
}
