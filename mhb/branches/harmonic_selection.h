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

enum { MHB_MAX_RUNGS = 9, MHB_MOST_HARMONICS = 31 };

/* All for m harmonics. */
typedef struct {
  mhb_settings    settings;
  mhb_residual   *residual;
  int             owned; /* the residual is ours */
  mhb_path       *path;
  mhb_truncation *truncation;
} mhb_rung;

typedef struct {
  const modal_model  *model;
  const mhb_settings *settings;
  double              low, high; /* of the parameter followed */
  mhb_parameter       parameter;
  mhb_condition       at_start;
  int                 n, m[MHB_MAX_RUNGS];
  mhb_rung           *rung[MHB_MAX_RUNGS]; /* NULL until first needed */
  int                 at, highest;         /* the rung in use; the highest used so far */
  int                 wanted;              /* what the last estimate asks for */
  int                 linear;              /* nothing was left out there */
  int                 from_linear;         /* nor at the last accepted point */
  int                 quiet;               /* points in a row that ask for a lower one */
} mhb_harmonics;

/* The numbers of harmonics a sweep may use, ascending: 1, 3, 5, 7, 9, 13, 17, 21, 31 (times the subharmonics, 31 at most) from
 * the load's highest harmonic on; one if they are not to be chosen. */
int mhb_harmonics_ladder(const modal_model *model, const mhb_settings *settings,
                         int m[MHB_MAX_RUNGS]);

/* Beginning at the given residual, whose settings, condition and parameter are used and which must outlive it. Makes one rung: not thread
 * safe (FFTW's planner). Errors: SHB_ERR_IO no memory. */
shb_status mhb_harmonics_create(mhb_residual *residual, mhb_harmonics **harmonics);
void       mhb_harmonics_destroy(mhb_harmonics *harmonics);

static inline mhb_rung *mhb_harmonics_rung(const mhb_harmonics *h) {
  return h->rung[h->at];
}

/* Make sure of a rung. Not thread safe (FFTW's planner). Errors: as mhb_residual_create. */
shb_status mhb_harmonics_make(mhb_harmonics *harmonics, int rung);

/* Unknowns of the highest rung. */
int mhb_harmonics_most_unknowns(const mhb_harmonics *harmonics);

/* Errors of a solution the residual of the rung in use was just evaluated at: fills truncation and modal of the point. */
void mhb_harmonics_errors(mhb_harmonics *harmonics, mhb_path_point *point);

/* The same, and which rung they ask for: where contacts begin to slip or open, and while they do so for less than a quarter of the period, no fewer than
 * seven harmonics, for a curve of fewer may go on smoothly where that of many turns back, and is then lost to it. */
void mhb_harmonics_estimate(mhb_harmonics *harmonics, mhb_path_point *point);

/* The rung that the last estimate asks for, above the one in use; -1: the one in use will do. */
int mhb_harmonics_higher(const mhb_harmonics *harmonics);

/* The last estimate is that of an accepted point. */
void mhb_harmonics_accept(mhb_harmonics *harmonics);

/* The rung to go down to after an accepted point, -1: none. Counts the points. */
int mhb_harmonics_lower(mhb_harmonics *harmonics);

/* Go on from path->now of the rung in use at another one that is there: its path->now becomes the same point, solved anew at
 * the same frequency. step: with the motion that the last estimate, made there, adds. Stays where it is if that does not
 * converge near by. */
mhb_reason mhb_harmonics_move(mhb_harmonics *harmonics, int rung, int step);

#endif
