/* Curves of solutions of r(x, value) = 0: points, systems, and the curve that is traced.
 *
 * A system has n equations in n unknowns and a parameter. A balance of harmonics is one
 * (balance_curve.h). The tests trace scalar ones. */
#ifndef MHB_CONTINUATION_CURVE_H
#define MHB_CONTINUATION_CURVE_H

#include <stdbool.h>

#include "mesh/base/status.h"
#include "mhb/balance/newton.h"

/* A point of a curve. It owns its evaluation, so it can be used again without a new one. */
typedef struct {
  double         *x;           /* [n] m */
  double          value;       /* of the parameter; rad/s for the frequency */
  double         *tangent;     /* [n + 1] d(x, value) along the curve, unit length in y */
  double         *r, *slope;   /* [n] residual at (x, value), its derivative by the value */
  mhb_evaluation *evaluation;  /* of a balance: forces, derivative, kinds of pairs; else NULL */
  int             orientation; /* sign of det [J slope; tangent]: constant but at bifurcations */
  int             iterations;  /* corrections that led here */
  bool            near;        /* x is near that of the last evaluation, which may help the next */
  double          residual;    /* |r|/|x| */
  double          truncation;  /* relative error of the harmonics left out, of the kind below */
  double          truncation_max;  /* the largest within the period, over the same amplitude */
  double          modal;           /* relative error of the modes left out */
  int             truncation_kind; /* mhb_truncation_kind */
} mhb_curve_point;

typedef struct mhb_curve_system mhb_curve_system;
typedef struct mhb_arclength    mhb_arclength;
struct mhb_curve_system {
  int    n;        /* unknowns */
  double least;    /* below it no value makes sense */
  bool   relative; /* a change of the value is compared with the value itself, not with the range */
  bool   plain;    /* where no ordinary step converges it is the user who tries others */
  bool   smooth;   /* the residual is accurate enough for chord steps */
  bool   costly;   /* a correction that gains little is given up: a shorter step costs less */
  bool   bends;    /* steps are predicted by a parabola: a correction costs much */
  bool   brief_events; /* events are located to 1e-8 of the value, with few factors */
  int    row_length;   /* x is [n / row_length][row_length]; a finer system of the same curve has as
                      * many rows, longer ones, that begin with the same unknowns */
  int    copies;       /* of a solution that are the same motion, itself included; 1: none */

  void (*destroy)(mhb_curve_system *system); /* the system and all that it owns */
  /* NULL where points need none. */
  mhb_evaluation *(*evaluation_create)(mhb_curve_system *system);
  void (*evaluation_destroy)(mhb_curve_system *system, mhb_evaluation *evaluation);

  /* r, slope and all derivatives at the point, into the point. */
  void (*linearise)(mhb_curve_system *system, mhb_curve_point *point);
  /* r alone, into the point, whose derivatives stay as they are. */
  void (*evaluate)(mhb_curve_system *system, mhb_curve_point *point);
  /* Factor [J column; row] with J as linearised at the point; both [n + 1], the corner last.
   * 0: singular. */
  int (*factor)(mhb_curve_system *system, const mhb_curve_point *point, const double *column,
                const double *row);
  /* rhs[n + 1] <- solution with the last factors. 0: not a number. */
  int (*solve)(mhb_curve_system *system, double *rhs);
  /* Sign of the determinant of the last factors. */
  int (*sign)(const mhb_curve_system *system);
  /* Damped Newton method at the point's value from its x. */
  mhb_reason (*solve_at_value)(mhb_curve_system *system, double tolerance, mhb_curve_point *point);

  /* to[n] <- copy j of x[n], 0 < j < copies. */
  void (*copy)(const mhb_curve_system *system, const double *x, int j, double *to);

  /* Each of the following may be NULL: the system has none of it. */

  /* x[n] <- another start of Newton's method at a value; false: there is no start `which`. */
  bool (*start_of_newton)(mhb_curve_system *system, double value, int which, double *x);
  /* Whether the law is linear at the point and about it. */
  bool (*is_linear)(const mhb_curve_system *system, const mhb_curve_point *point);
  /* mhb_arclength_correct without factors. The law must stay as at regime, a linear point. 0: it
   * does not. */
  int (*correct_linear)(mhb_arclength *curve, const mhb_curve_point *regime, const double *normal,
                        mhb_curve_point *point);
  /* Unit of the value at a point. INFINITY: the whole range. */
  double (*unit_of_value)(const mhb_curve_system *system, const mhb_curve_point *point);
  /* The longest change of the value, in a direction, that resolves the resonances known so far. */
  double (*resonance_step_limit)(const mhb_curve_system *system, double value, int direction);
  /* Whether the step from current to next skips a resonance. From then on resonance_step_limit
   * resolves it. */
  bool (*resonance_skipped)(mhb_arclength *curve);
};

/* A curve while it is traced. */
struct mhb_arclength {
  mhb_curve_system *system; /* owned */
  int               n;
  double            low, high;       /* range of the value */
  double            parameter_scale; /* unit of the value */
  double          amplitude_at_rest; /* unit of x where nothing moves: |dx/dvalue| over the range */
  double          step, longest;     /* the next step's length; the longest allowed */
  double          tolerance;         /* of |r|/|x| */
  double          roundoff_level; /* a residual below it that stagnates is accepted as round-off */
  int             orientation;    /* of the curve */
  int             n_reversed;     /* points in a row with the other orientation */
  mhb_curve_point current, next;  /* the ends of the last step */
  mhb_curve_point trial;          /* a point located on it */
  mhb_curve_point bracket[3];     /* of a search on it: both ends, and a former one */
  double         *chord;          /* [n + 1] direction of a step or a search */
  double         *former_tangent; /* [n + 1] where the last step began, if steps are bent */
  double          former_step;    /* its length in y; 0: there was none */
  double         *column, *row, *delta; /* [n + 1] of the bordered system */
};

/* Takes over the system. */
mhb_arclength *mhb_arclength_create(mhb_curve_system *system, double low, double high);
void           mhb_arclength_destroy(mhb_arclength *curve);

/* A point of a curve with its own arrays; destroy accepts a zeroed one. */
void mhb_curve_point_create(mhb_curve_system *system, mhb_curve_point *point);
void mhb_curve_point_destroy(mhb_curve_system *system, mhb_curve_point *point);

/* current <- next */
void mhb_arclength_advance(mhb_arclength *curve);

#endif
