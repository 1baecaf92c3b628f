/* The condition of a flip or a Neimark-Sacker point, g = 0: a multiplier is on the unit circle
 * (followed_multiplier.h). Its derivative on the surface of solutions (docs/theory/tracking.md).
 *
 * Solutions of the balance are a surface z(s, q), z = (x, xi): s along a response curve, q the
 * parameter. g is computed there only, so its derivative is known along two directions:
 *
 *   T          [r_x r_xi] T = 0,             the response curve
 *   (Y, 1)     [r_x r_xi] Y = -r_q, cY = 0,  c the border of the response curve's tangent
 *
 *   dg = g_T c dz/(cT) + g_Y dq
 *
 * g_T and g_Y are one-sided differences over a step of 1e-6 |z|, at the same sub-steps. Their error
 * is some 1e-5, which slows Newton's method slightly and leaves its limit as it is. */
#ifndef MHB_TRACKING_MULTIPLIER_CONDITION_H
#define MHB_TRACKING_MULTIPLIER_CONDITION_H

#include "mhb/balance/balance.h"
#include "mhb/floquet/followed_multiplier.h"

typedef struct mhb_multiplier_condition mhb_multiplier_condition;

/* A place where g is linearised. */
typedef struct {
  mhb_evaluation *evaluation;       /* of the balance at z, value; NULL: to be evaluated */
  const double   *z;                /* [n + 1] */
  double          value;            /* q */
  const double   *along, *to_value; /* [n + 1] T, Y */
  const double   *border;           /* [n + 1] c */
} mhb_multiplier_base;

/* The linearised condition. */
typedef struct {
  mhb_multiplier_place place;
  double               along, by_value; /* g_T, g_Y */
} mhb_multiplier_slope;

/* flip: of a real multiplier, else of a complex one. rate: d omega/d xi. The balance must outlive
 * it. */
shb_status mhb_multiplier_condition_create(mhb_balance *balance, mhb_parameter parameter, bool flip,
                                           double rate, mhb_multiplier_condition **condition);
void       mhb_multiplier_condition_destroy(mhb_multiplier_condition *condition);

/* Choose the multiplier at a solution x[n] near its crossing. Returns NULL, or why there is
 * none. */
const char *mhb_multiplier_condition_choose(mhb_multiplier_condition *condition, const double *x,
                                            double omega, double value);

/* g and its derivative. The balance is left at another evaluation. Returns NULL, or why the
 * multiplier is not found. */
const char *mhb_multiplier_condition_linearise(mhb_multiplier_condition  *condition,
                                               const mhb_multiplier_base *base,
                                               mhb_multiplier_slope      *slope);

/* From now on the multiplier is looked for where the place linearised last lets it expect. */
void mhb_multiplier_condition_accept(mhb_multiplier_condition *condition);

/* The multipliers at an evaluated solution z, as along a response curve. *finer: they took other
 * sub-steps than those in use. */
void mhb_multiplier_condition_judge(mhb_multiplier_condition *condition, mhb_evaluation *evaluation,
                                    const double *z, mhb_multipliers *multipliers, bool *finer);

/* Take over the sub-steps of the last verdict; solutions change a little. */
void mhb_multiplier_condition_adapt(mhb_multiplier_condition *condition);

#endif
