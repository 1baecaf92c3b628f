/* How many harmonics a point needs: the levels between which the tracing of a curve moves.
 *
 * A level is a number of harmonics m, with the balance and the curve at it. After each point the
 * truncation estimate delta tells the error of the harmonics left out. Its amplification is
 * |delta|/|delta_k, k > m|. The lowest level suffices whose share left out, amplified, stays below
 * a safe part of the tolerance. The tail of the spectrum gives that share.
 *
 * A higher level is taken at once, and the step is repeated. A lower one is taken only after some
 * points in a row have asked for it with a margin (hysteresis).
 *
 * settings->motion_tolerance = 0: one level, settings->harmonics. */
#ifndef MHB_BRANCHES_HARMONIC_SELECTION_H
#define MHB_BRANCHES_HARMONIC_SELECTION_H

#include "mhb/balance/modal_error.h"
#include "mhb/balance/spatial_error.h"
#include "mhb/balance/truncation_error.h"
#include "mhb/continuation/balance_curve.h"
#include "mhb/continuation/events.h"

/* The ladder goes to MHB_USUAL_HARMONICS whatever the size, beyond where a point needs it. */
enum { MHB_MAX_LEVELS = 13, MHB_USUAL_HARMONICS = 31, MHB_MOST_HARMONICS = 127 };

typedef struct {
  mhb_settings       settings;
  mhb_balance       *balance;
  bool               owns_balance;
  mhb_arclength     *curve;
  mhb_truncation    *truncation;
  mhb_spatial_error *spatial; /* NULL: not estimated */
  mhb_events         events;  /* of a step of the curve */
} mhb_harmonic_level;

typedef struct {
  const modal_model  *model;
  const mhb_settings *settings;
  double              low, high; /* range of the parameter */
  mhb_parameter       parameter;
  mhb_operating_point at_start;
  int                 n, m[MHB_MAX_LEVELS];  /* numbers of harmonics, rising */
  mhb_harmonic_level *level[MHB_MAX_LEVELS]; /* NULL until first needed */
  int                 at, highest;           /* the level in use; the highest used so far */
  int                 wanted;                /* the level that the last estimate asks for */
  int                 least;                 /* no lower level is used */
  bool                linear;                /* nothing was left out there */
  bool                from_linear;           /* nor at the last accepted point */
  int n_lower_wanted; /* points in a row that ask for a lower level; negative: not yet counted */
} mhb_harmonic_levels;

/* The numbers of harmonics a sweep may use, rising: 1, 3, 5, 7, 9, 13, 17, 21, 31 (times the
 * subharmonics, 31 at most) from the load's highest harmonic on. 45, 63, 91, 127 follow as far as
 * they are affordable: 127 for one pair, 63 for two, none for more. The balance of twice as many
 * has 1600 unknowns at most. A disc of which nodal diameters are missing has none of these. One, if
 * they are not to be chosen. Returns how many. */
int mhb_harmonic_levels_ladder(const modal_model *model, const mhb_settings *settings,
                               int m[MHB_MAX_LEVELS]);

/* Of a ladder, the highest of the usual ones; the only one if none is. */
int mhb_harmonic_levels_usual(int n, const int *m);

/* Starts at the given balance, which must outlive it, with its settings, operating point and
 * parameter. */
shb_status mhb_harmonic_levels_create(mhb_balance *balance, mhb_harmonic_levels **levels);
void       mhb_harmonic_levels_destroy(mhb_harmonic_levels *levels);

/* Use a level, made if it is not there. Errors: as of mhb_balance_create. */
shb_status mhb_harmonic_levels_use(mhb_harmonic_levels *levels, int level);

/* The lowest level of m harmonics or more. */
int mhb_harmonic_levels_of(const mhb_harmonic_levels *levels, int m);

static inline mhb_harmonic_level *mhb_harmonic_levels_current(const mhb_harmonic_levels *levels) {
  return levels->level[levels->at];
}

/* Whether no usual level is above the one in use. */
bool mhb_harmonic_levels_all_usual(const mhb_harmonic_levels *levels);

/* Unknowns at the highest level. */
int mhb_harmonic_levels_most_unknowns(const mhb_harmonic_levels *levels);

/* Fill truncation and modal error of a point of the level in use, linearised there. An estimate of
 * first order is told threefold. */
void mhb_harmonic_levels_errors(mhb_harmonic_levels *levels, mhb_curve_point *point);

/* Spatial error of a point of the level in use (mhb_spatial_error_at), which is linearised there;
 * -1 without another model of the faces. */
double mhb_harmonic_levels_spatial(const mhb_harmonic_levels *levels, const mhb_curve_point *point);

/* Truncation and modal error, and note the level they ask for. Seven harmonics are the least where
 * contacts begin to slip or open, and while they do so for less than a quarter of the period. A
 * curve of fewer harmonics may go on smoothly there where that of many turns back. */
void mhb_harmonic_levels_estimate(mhb_harmonic_levels *levels, mhb_curve_point *point);

/* Look at the curve where the truncation error of a point is above the tolerance, the errors being
 * those estimated last. Beside a fold the curve with twice the harmonics may pass near by where its
 * solution at the same value is far off. There the error told is the distance of the curve: the
 * motion, or how far it is moved along the parameter. A frequency is compared with the least
 * damping ratio: no linear resonance is steeper. */
void mhb_harmonic_levels_settle(mhb_harmonic_levels *levels, mhb_curve_point *point);

/* The level that a point between two others asks for, which only the whole tolerance moves; -1: the
 * one in use suffices. */
int mhb_harmonic_levels_of_event(mhb_harmonic_levels *levels, mhb_curve_point *point);

/* The level above the one in use that the last estimate asks for; -1: the one in use suffices. */
int mhb_harmonic_levels_higher(const mhb_harmonic_levels *levels);

/* The least level of another attempt at a curve that ended because the one asked for was out of
 * reach. It is a usual one: a whole curve of more takes a hundred times as long, and those are for
 * the points that need them. */
int mhb_harmonic_levels_needed(const mhb_harmonic_levels *levels);

/* The last estimate was that of an accepted point. */
void mhb_harmonic_levels_accept(mhb_harmonic_levels *levels);

/* The level to go down to after an accepted point; -1: none. Counts the points. */
int mhb_harmonic_levels_lower(mhb_harmonic_levels *levels);

/* Move curve->current to another level: the same point, solved anew at the same value.
 *   with_step  add the correction of the last estimate, which was made at current
 *   *moved     false: no solution near by; the level in use stays
 * Errors: as of mhb_harmonic_levels_use. */
shb_status mhb_harmonic_levels_move(mhb_harmonic_levels *levels, int level, bool with_step,
                                    bool *moved);

#endif
