/* What a stretch of a period makes of a small disturbance of (q, q', friction): for a blade on the ground the monodromy matrix, for a
 * ring its columns for the disturbances of one cell (bloch.h), over 1/chunks of a period, the blades renamed (transition_schedule.h).
 *
 * Sub-steps (variational.h) are split at the transitions of every contact; the law is linearised at their middles
 * (linearised_law.h, orbit_contacts.h). States that are carried: q and q' of every mode and blade, and at the start two frictions for a
 * contact that sticks but does not stay so, one for a contact that slips. */
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
  double *u, *matrix; /* [3 contacts], [.][.] the start with residual flexibility */
  int    *pivot;      /* [3 contacts] */
  int     blades, n;  /* of a cell; its states */
  double *M;          /* [cell][n][n] column-major */
} mhb_monodromy;

/* finest: the greatest refinement there is room for. SHB_ERR_IO: no memory. Structure, timetable and contact must outlive it. */
shb_status mhb_monodromy_create(const mhb_modal_structure     *structure,
                                const mhb_transition_schedule *schedule,
                                mhb_contact_evaluator *contact, int m, int substeps, int finest,
                                mhb_monodromy **monodromy);
void       mhb_monodromy_destroy(mhb_monodromy *monodromy);

/* M for a solution and the timetable set from it, with substeps * refinement sub-steps, each piece between events cut
 * that much finer; omega: of the fundamental.
 * NULL, or why not. */
const char *mhb_monodromy_set(mhb_monodromy *monodromy, const mhb_solution *solution, double omega,
                              int refinement);

#endif
