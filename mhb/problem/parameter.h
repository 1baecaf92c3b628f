/* Operating point, continuation parameters, and the derivative of the contact force by them.
 *
 * The law has no length of its own, so that a change of a parameter is a change of the motion
 * (Euler's theorem). With the force p = (n, f), motion u = (v, u_t), n = max(kv v + n0, 0), Ku = k
 * K and the friction limit mu n:
 *   n depends on v by kv v + n0 alone   d p/d n0 = (1/kv) d p/d v_0,  kv d p/d kv = (d p/d v) v
 *   f(c u_t; c mu) = c f(u_t; mu)       mu d f/d mu = f - (d f/d u_t) u_t
 *   f(u_t; c k)    = f(c u_t; k)        k  d f/d k  = (d f/d u_t) u_t
 * Exact wherever the derivative by the motion is. At mu = 0, and at kv = 0 with n0 <= 0, it is
 * taken as 0. */
#ifndef MHB_PROBLEM_PARAMETER_H
#define MHB_PROBLEM_PARAMETER_H

#include "mhb/contact/law.h"
#include "mhb/problem/settings.h"

typedef struct {
  double omega;      /* rad/s, of the excitation */
  double n0;         /* N, of the interface, as all below */
  double scale, mu;  /* - */
  double ku[3], kv;  /* N/m */
  int preloads_tied; /* the preloads of all interfaces move alike, from where this one is tied_n0 */
  double tied_n0;    /* N */
} mhb_operating_point;

/* The operating point of the settings, at the low end of the range and the first preload. */
mhb_operating_point mhb_operating_point_of(const mhb_settings *settings);

/* As in a case file: frequency, n0, scale, mu, ku, kv. */
const char *mhb_parameter_name(mhb_parameter parameter);
const char *mhb_parameter_unit(mhb_parameter parameter); /* Hz, N, "", "", N/m, N/m */

/* Conversion between a value (frequency: rad/s) and the number shown to users (Hz); all other
 * parameters are shown as they are. */
double mhb_parameter_shown(mhb_parameter parameter, double value);
double mhb_parameter_value(mhb_parameter parameter, double shown);

/* Low (0) or high (1) end of the settings' range. */
double mhb_parameter_end(const mhb_settings *settings, mhb_parameter parameter, int high);

/* Value of a parameter. ku: the first of its three numbers; the others stay in proportion. */
double mhb_parameter_get(const mhb_operating_point *condition, mhb_parameter parameter);
void   mhb_parameter_set(mhb_operating_point *condition, mhb_parameter parameter, double value);

/* Least admissible value. A negative scale is a load of opposite phase. */
double mhb_parameter_least(mhb_parameter parameter);

/* The law of a pair with this share of the interface. */
mhb_law mhb_operating_point_law(const mhb_operating_point *condition, mhb_preload preload,
                                double share);

/* Motion of a pair and the force on it, in real form. */
typedef struct {
  int           nb; /* coefficients an axis */
  const double *u;  /* [3 (v, u, w)][nb] motion, m */
  const double *p;  /* [3][nb] force, N */
  const double *dp; /* [3 nb][3 nb] its derivative by the motion, N/m */
} mhb_pair_force;

/* Derivative of the force on a pair by the parameter, at fixed motion; 0 for frequency and scale.
 *   share   in   of the interface
 *   change  out  [3][nb] N per unit */
void mhb_parameter_force(const mhb_operating_point *condition, mhb_parameter parameter,
                         const mhb_law *law, double share, const mhb_pair_force *pair,
                         double *change);

#endif
