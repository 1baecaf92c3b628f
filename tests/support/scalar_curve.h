/* Curves f(x, value) = 0 of one unknown, as a system of continuation without a contact law. */
#ifndef TESTS_SUPPORT_SCALAR_CURVE_H
#define TESTS_SUPPORT_SCALAR_CURVE_H

#include "mhb/continuation/curve.h"

/* f at (x, value), with its derivatives. */
typedef double (*scalar_function)(double x, double value, double *f_x, double *f_value);

/* A curve of f between two values. The caller destroys it by mhb_arclength_destroy. Optional
 * functions of its system are NULL; a test may set them. */
mhb_arclength *scalar_curve(scalar_function f, double low, double high);

/* point <- (x, value), linearised, with the tangent in the sense of (dx, dvalue). Fails the test if
 * there is no tangent. */
void scalar_point(mhb_arclength *curve, double x, double value, double dx, double dvalue,
                  mhb_curve_point *point);

/* current and next <- two points, the tangents in the sense from the first to the second. */
void scalar_step(mhb_arclength *curve, double x, double value, double next_x, double next_value);

/* (x - 3)^2 + value^2 = 1: folds at value = -1 and 1. */
double scalar_circle(double x, double value, double *f_x, double *f_value);

/* x = 2 + value. */
double scalar_line(double x, double value, double *f_x, double *f_value);

/* value^2 = (x - 2)^3: at value 0 there is no tangent. */
double scalar_cusp(double x, double value, double *f_x, double *f_value);

/* x = 2 + value up to the kink at value = 0, and x = 2 + value + sqrt(value) beyond it, as at the
 * onset of slip: vertical there. */
double scalar_root_kink(double x, double value, double *f_x, double *f_value);

/* x^2 + 1 + value^2 = 0 has no real solution. */
double scalar_nowhere(double x, double value, double *f_x, double *f_value);

#endif
