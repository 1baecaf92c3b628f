/* Coulomb friction and unilateral contact without springs, by time steps: the limit of an infinite
 * contact stiffness. It shares nothing with the contact law, the balance or the integrator but the
 * modal model.
 *
 *   q'' + 2 zeta w q' + w^2 q = F(t) - B^T p,   u = B q + x(t) - R p
 *   v <= 0, n >= 0, v n = 0;   |f| <= mu n, and the contact slides along f where |f| = mu n
 *
 * u holds v, the motion into the wall, and two tangential ones of each pair; p = (n - n0, f). The
 * contact has no mass: its forces follow from the modes at once. This massless boundary, with the
 * modes stepped by the leapfrog rule and the contacts solved by projected Gauss-Seidel, is that of
 * Monjaraz-Tec, Gross, Krack (Computers & Structures 260, 2022). Sliding is of first order in the
 * step. */
#ifndef TESTS_HARD_RIGID_CONTACT_H
#define TESTS_HARD_RIGID_CONTACT_H

#include <complex.h>

#include "modal/model/model.h"

typedef struct {
  double mu, pressure, omega; /* -, Pa at rest, rad/s */
  int    steps, periods;      /* a period; at most */
} rigid_contact;

typedef struct {
  double complex probe[3];          /* m, first harmonic of the first probe */
  double         stuck, slip, open; /* mean shares of the pairs and the period */
  double         change;            /* of the modes over the last period, relative */
  double         sweeps;            /* of Gauss-Seidel a step, on average */
} rigid_motion;

/* Angular frequencies of the blade whose contact is held by all its pairs, [modes] rad/s. */
void rigid_contact_frequencies(const modal_model *model, double *omega);

/* March from the motion of the held contact until it repeats to 1e-9. The model must be one to
 * ground, with areas, normals and residual flexibility. */
void rigid_contact_march(const modal_model *model, const rigid_contact *contact, rigid_motion *out);

#endif
