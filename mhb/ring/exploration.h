/* Where many starts of a ring lead: groups of starts that reach the same motion.
 *
 * Starts run side by side, one in each copy of the ring; where one ends the next begins. A start
 * ends as soon as it is told apart: at a motion that is known, or at another one.
 * Rules: docs/theory/lasting.md. */
#ifndef MHB_RING_EXPLORATION_H
#define MHB_RING_EXPLORATION_H

#include "mhb/ring/disturbed_start.h"

/* MHB_LASTING_STARTS: the fewest with (5/6)^n < 0.05. */
enum { MHB_LASTING_STARTS = 17, MHB_LASTING_MOTIONS = 32 };

/* A motion, and states in which starts that reached it ended. */
typedef struct {
  mhb_motion     motion;
  int            n_states;
  mhb_ring_state state[MHB_LANES];
} mhb_motion_group;

typedef struct {
  mhb_starts           *starts;
  mhb_go_on             go_on; /* as of mhb_starts_block */
  void                 *context;
  const mhb_ring_state *from;         /* where starts begin */
  mhb_noise            *noise;        /* that disturbs them; NULL: one start, undisturbed */
  int                   most_periods; /* that starts may take, beside the first two; 0: any */
  bool                  patient;      /* no start is told apart before two may agree */
  double               *peaks;        /* space of mhb_starts_series for one start */
  /* out, and in if some motions are known: */
  int               n_groups;
  mhb_motion_group *group;   /* [MHB_LASTING_MOTIONS] */
  int               told;    /* starts that were told apart */
  int               periods; /* of all starts */
  double            error;   /* largest standard error of a start that was not told apart */
  int               last;    /* copy of the start that was told apart last */
  bool              stopped;
  /* scratch */
  int        begun;
  mhb_motion now[MHB_LANES];    /* what a copy showed when it was read last */
  int        blocks[MHB_LANES]; /* then; 0: not yet */
} mhb_exploration;

/* Run all starts. */
void mhb_explore(mhb_exploration *x);

/* Free the states. */
void mhb_motion_groups_free(mhb_motion_group *group, int n);

/* ---- the decision ---- */

typedef enum {
  MHB_START_GOES_ON,
  MHB_START_JOINS,  /* the motion that is nearest */
  MHB_START_IS_NEW, /* it has reached another motion */
  MHB_START_UNTOLD  /* it does not settle, and is no start that counts */
} mhb_start_verdict;

/* On a start after some blocks. last: no more can be had. away: mhb_motion_distance to the nearest
 * motion that is known, INFINITY: none is. */
mhb_start_verdict mhb_start_judge(const mhb_motion *m, int blocks, bool last, double away);

/* Whether two starts, after so many blocks at least, show one motion that was not known before. */
bool mhb_starts_agree(const mhb_motion *a, const mhb_motion *b, int blocks);

/* Both as one motion. */
mhb_motion mhb_motions_joined(const mhb_motion *a, const mhb_motion *b);

#endif
