/* The map of small disturbances of (q, q', friction) over a segment of the period
 * (transition_schedule.h): the monodromy matrix of a blade on the ground; for a ring the columns of
 * one cell's disturbances, blades renamed (bloch.h).
 *
 * Sub-steps (variational.h) end at the transitions of every contact. The law is linearised at their
 * middles (linearised_law.h, orbit_contacts.h). States: q and q' of every mode and blade; at the
 * start two frictions of a contact that sticks, one of a contact that slips, none of one that
 * sticks for the whole period. */
#ifndef MHB_FLOQUET_MONODROMY_H
#define MHB_FLOQUET_MONODROMY_H

#include "mhb/floquet/orbit_contacts.h"

typedef struct {
  const mhb_modal_structure     *structure;
  const mhb_transition_schedule *schedule;
  mhb_variational               *variational;
  mhb_orbit_contacts            *orbit;
  int                            substeps; /* a period of the fundamental */
  int                           *column;   /* [contact] its first friction state */
  double *u, *matrix;                      /* [3 contacts]; its square, I + R dp/du at the start */
  int    *pivot;                           /* [3 contacts] */
  int     blades, n;                       /* of a cell; its states */
  double *M;                               /* [cell][n][n] column-major */
} mhb_monodromy;

/* finest: the greatest refinement. SHB_ERR_IO: no memory. Structure, schedule and contact must
 * outlive it. */
shb_status mhb_monodromy_create(const mhb_modal_structure     *structure,
                                const mhb_transition_schedule *schedule,
                                mhb_contact_evaluator *contact, int m, int substeps, int finest,
                                mhb_monodromy **monodromy);
void       mhb_monodromy_destroy(mhb_monodromy *monodromy);

/* Set M for a solution and the schedule set from it. Each interval between events has refinement
 * times as many sub-steps; omega: of the fundamental, rad/s.
 * Returns NULL, or the reason of a failure. */
const char *mhb_monodromy_set(mhb_monodromy *monodromy, const mhb_solution *solution, double omega,
                              int refinement);

#endif
