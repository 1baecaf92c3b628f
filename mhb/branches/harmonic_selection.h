/* How many harmonics a point needs: the ladder of solvers between which a curve moves.
 *
 * A rung is a number of harmonics with all that a curve needs at it. After each point the truncation estimate delta tells what
 * was left out; with its amplification |delta|/|delta_k, k > m| the tail of the spectrum tells which rung would do: the
 * first one whose share left out, amplified, stays below SAFETY tolerance |x|. Upwards that rung is taken at once and the step is
 * repeated; downwards only after some points in a row that ask for it with a margin, so that a path does not flicker.
 *
 * settings->motion_tolerance = 0: one rung, settings->harmonics. */
#ifndef MHB_BRANCHES_HARMONIC_SELECTION_H
#define MHB_BRANCHES_HARMONIC_SELECTION_H

#include "mhb/balance/modal_error.h"
#include "mhb/balance/truncation_error.h"
#include "mhb/continuation/arclength.h"

enum { MHB_MAX_LEVELS = 9, MHB_MOST_HARMONICS = 31 };

/* All for m harmonics. */
typedef struct {
  mhb_settings    settings;
  mhb_balance    *residual;
  int             owned; /* the residual is ours */
  mhb_arclength  *path;
  mhb_truncation *truncation;
} mhb_harmonic_level;

typedef struct {
  const modal_model  *model;
  const mhb_settings *settings;
  double              low, high; /* of the parameter followed */
  mhb_parameter       parameter;
  mhb_operating_point at_start;
  int                 n, m[MHB_MAX_LEVELS];
  mhb_harmonic_level *rung[MHB_MAX_LEVELS]; /* NULL until first needed */
  int                 at, highest;          /* the rung in use; the highest used so far */
  int                 wanted;               /* what the last estimate asks for */
  int                 linear;               /* nothing was left out there */
  int                 from_linear;          /* nor at the last accepted point */
  int                 quiet;                /* points in a row that ask for a lower one */
} mhb_harmonic_levels;

/* The numbers of harmonics a sweep may use, ascending: 1, 3, 5, 7, 9, 13, 17, 21, 31 (times the subharmonics, 31 at most) from
 * the load's highest harmonic on; one if they are not to be chosen. */
int mhb_harmonic_levels_ladder(const modal_model *model, const mhb_settings *settings,
                               int m[MHB_MAX_LEVELS]);

/* Beginning at the given residual, whose settings, condition and parameter are used and which must outlive it. Makes one rung: not thread
 * safe (FFTW's planner). Errors: SHB_ERR_IO no memory. */
shb_status mhb_harmonic_levels_create(mhb_balance *residual, mhb_harmonic_levels **harmonics);
void       mhb_harmonic_levels_destroy(mhb_harmonic_levels *harmonics);

static inline mhb_harmonic_level *mhb_harmonic_levels_current(const mhb_harmonic_levels *h) {
  return h->rung[h->at];
}

/* Make sure of a rung. Not thread safe (FFTW's planner). Errors: as mhb_balance_create. */
shb_status mhb_harmonic_levels_make(mhb_harmonic_levels *harmonics, int rung);

/* Unknowns of the highest rung. */
int mhb_harmonic_levels_most_unknowns(const mhb_harmonic_levels *harmonics);

/* Errors of a solution the residual of the rung in use was just evaluated at: fills truncation and modal of the point. */
void mhb_harmonic_levels_errors(mhb_harmonic_levels *harmonics, mhb_curve_point *point);

/* The same, and which rung they ask for: where contacts begin to slip or open, and while they do so for less than a quarter of the period, no fewer than
 * seven harmonics, for a curve of fewer may go on smoothly where that of many turns back, and is then lost to it. */
void mhb_harmonic_levels_estimate(mhb_harmonic_levels *harmonics, mhb_curve_point *point);

/* The rung that the last estimate asks for, above the one in use; -1: the one in use will do. */
int mhb_harmonic_levels_higher(const mhb_harmonic_levels *harmonics);

/* The last estimate is that of an accepted point. */
void mhb_harmonic_levels_accept(mhb_harmonic_levels *harmonics);

/* The rung to go down to after an accepted point, -1: none. Counts the points. */
int mhb_harmonic_levels_lower(mhb_harmonic_levels *harmonics);

/* Go on from path->now of the rung in use at another one that is there: its path->now becomes the same point, solved anew at
 * the same frequency. step: with the motion that the last estimate, made there, adds. Stays where it is if that does not
 * converge near by. */
mhb_reason mhb_harmonic_levels_move(mhb_harmonic_levels *harmonics, int rung, int step);

#endif
