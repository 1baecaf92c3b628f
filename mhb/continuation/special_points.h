/* Folds (the parameter turns) and peaks (an amplitude turns down) of a step of a path, in order along it. */
#ifndef MHB_CONTINUATION_SPECIAL_POINTS_H
#define MHB_CONTINUATION_SPECIAL_POINTS_H

#include "mhb/continuation/arclength.h"

enum { MHB_MAX_SPECIAL_POINTS = 16 };

/* A point of the path between now and next. */
typedef struct {
  int    special; /* MHB_FOLD, MHB_PEAK */
  int    output;  /* of a peak */
  double place;   /* of the chord; before it is located: by linear interpolation */
  double value, residual;
  int    iterations;
} mhb_special_point;

typedef struct {
  int               n;
  mhb_special_point mark[MHB_MAX_SPECIAL_POINTS];
  int               slot[MHB_MAX_SPECIAL_POINTS]; /* where in x the motion of each is */
  double           *x;                            /* [MHB_MAX_SPECIAL_POINTS][most unknowns] m */
  bool              unmarked;                     /* there is a fold that could not be located */
  bool              away; /* the residual's workspace was left elsewhere than at next */
} mhb_special_points;

/* Errors: SHB_ERR_IO no memory. */
shb_status mhb_special_points_create(mhb_special_points *landmarks, int most_unknowns);
void       mhb_special_points_destroy(mhb_special_points *landmarks);

/* Locate all of a step by the sign changes of the tangent's parameter and of the slopes [n_outputs] at now and next, sort them by
 * where they were found, and keep one of those at the same place. */
void mhb_special_points_find(mhb_special_points *landmarks, mhb_arclength *path, int n_outputs,
                             const double *before, const double *after);

/* Whether the parameter runs back from one point of the step to the next without a fold: two or more turns lie in it, which the signs
 * at its ends do not tell. */
bool mhb_special_points_miss_fold(const mhb_special_points *landmarks, const mhb_arclength *path);

/* path->probe and the residual's workspace <- one of them. */
void mhb_special_points_visit(const mhb_special_points *landmarks, mhb_arclength *path, int i);

#endif
