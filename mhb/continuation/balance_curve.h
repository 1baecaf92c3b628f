/* The balance of harmonics as a system whose curves are traced (curve.h). */
#ifndef MHB_CONTINUATION_BALANCE_CURVE_H
#define MHB_CONTINUATION_BALANCE_CURVE_H

#include "mhb/continuation/arclength.h"
#include "mhb/continuation/linear_corrector.h"
#include "mhb/continuation/linear_resonances.h"

typedef struct {
  mhb_curve_system      base; /* first: the functions of the system get it back */
  mhb_balance          *balance;
  mhb_newton           *newton;
  mhb_linear_corrector *linear;
  mhb_resonances        resonances; /* in the range; none unless the frequency is followed */
} mhb_balance_curve;

/* Curves of a balance, which must outlive it, in its parameter from low to high. */
mhb_arclength *mhb_balance_curve_create(mhb_balance *balance, double low, double high);

/* The system of a curve that mhb_balance_curve_create made, and its balance. */
static inline mhb_balance_curve *mhb_balance_curve_of(const mhb_arclength *curve) {
  return (mhb_balance_curve *)curve->system;
}
static inline mhb_balance *mhb_curve_balance(const mhb_arclength *curve) {
  return mhb_balance_curve_of(curve)->balance;
}

#endif
