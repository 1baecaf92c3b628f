/* A ring of lumped sectors on a flexible disc, in two ways: by nodal diameters, and explicitly.
 *
 * A sector has four masses with three displacements each: disc, blade, right and left shroud. Disc
 * masses are coupled to the next ones by springs whose ends have different directions, so that
 * shapes of travelling waves are complex. Damping is proportional to stiffness. Axes are
 * cylindrical. */
#ifndef TESTS_SUPPORT_LUMPED_DISC_H
#define TESTS_SUPPORT_LUMPED_DISC_H

#include "mhb/problem/settings.h"
#include "modal/model/sector_speeds.h"

enum {
  DISC_SECTORS = 8,
  DISC_DOFS    = 12, /* of a sector: disc, blade, right, left */
  DISC_BLADE   = 3,  /* first dof of the blade mass, where the probe is */
  DISC_RIGHT   = 6,
  DISC_LEFT    = 9,
  DISC_ALL     = DISC_SECTORS * DISC_DOFS,
  DISC_LOADS   = 3 /* load harmonics 0 (real), 1, 2 */
};

typedef struct {
  double         own[DISC_DOFS][DISC_DOFS];  /* A: K u = A u_b + B u_(b+1) + B^T u_(b-1) */
  double         next[DISC_DOFS][DISC_DOFS]; /* B */
  double         mass[DISC_DOFS];            /* diagonal */
  double         damping;                    /* s: C = damping K */
  double         spin; /* rad/s about the axial direction: 2 spin [e]x of every mass; 0: none */
  double complex load[DISC_LOADS][DISC_DOFS];
} lumped_disc;

/*   coupling  in  N/m, springs between the disc masses
 *   ground    in  N/m, springs from the disc mass to the axis */
lumped_disc lumped_disc_of(double coupling, double ground);

/* The same on a rotor: its blades and its coupling are stiffened by the speed, rad/s.
 *   coriolis  in  spin over speed; 0: without Coriolis terms */
lumped_disc lumped_disc_spinning(double speed, double coriolis);

/* n of them from `lowest` to 1 rad/s, with the lowest modes and overlaps. */
void lumped_disc_speeds(int n, double lowest, double coriolis, int modes, modal_sector_speeds *out);

/* Element of the Coriolis matrix of a sector, kg/s. */
double lumped_disc_coriolis(const lumped_disc *disc, int i, int j);

/* Nodal diameters 0..N/2 with the lowest modes, and residual terms of the others. */
void lumped_disc_waves(const lumped_disc *disc, int modes, modal_nodal_diameters *out);

/* The clamped sector with the lowest modes, without coupling of discs, and residual terms. */
void lumped_disc_blade(const lumped_disc *disc, int modes, modal_model *out);

/* All modes of the explicit ring: N pairs to ground, whose motion is the right shroud less the next
 * left one. The load is that of an engine order; the probe is that of sector 0. */
void lumped_disc_ring(const lumped_disc *disc, int engine_order, modal_model *out);

/* Settings of the neighbour's contact, and of the same contact in the model of the ring. */
mhb_settings lumped_disc_settings(int engine_order, int harmonics);
mhb_settings lumped_disc_ring_settings(const mhb_settings *settings);

#endif
