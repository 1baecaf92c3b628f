/* The map of small disturbances of (q, q', friction) over a segment of the period
 * (transition_schedule.h). For a blade on the ground it is the monodromy matrix. For a ring it is
 * the columns of one cell's disturbances, blades renamed (bloch.h). A mistuned ring is one cell.
 *
 * Sub-steps (variational.h) end at the transitions of every contact. The law is linearised at their
 * middles (linearised_law.h, orbit_contacts.h). The states are q and q' of every mode and blade,
 * and the frictions at the start. A sticking contact has two of these, a slipping one has one. A
 * contact that sticks for the whole period has none. */
#ifndef MHB_FLOQUET_MONODROMY_H
#define MHB_FLOQUET_MONODROMY_H

#include <stdbool.h>

#include "mesh/base/arena.h"
#include "mhb/floquet/orbit_contacts.h"

typedef struct {
  const mhb_modal_structure     *structure;
  const mhb_transition_schedule *schedule;
  mhb_stuck_springs             *springs; /* NULL: contacts are not condensed */
  mhb_variational               *variational;
  mhb_orbit_contacts            *orbit;
  int                            substeps; /* a period of the fundamental */
  int                           *column;   /* [contact] its first friction state */
  double *u, *matrix;                      /* [3 contacts]; its square, I + R dp/du at the start */
  int    *pivot;                           /* [3 contacts] */
  bool   *is_spring;                       /* [contact] at the start */
  double (*of_u)[3][3], (*of_sigma)[3][2]; /* [contact] forces at the start */
  int       blades, n;                     /* of a cell; its states */
  double   *M;                             /* [cell][n][n] column-major */
  int      *steps;    /* [capacity of events + 1] sub-steps of each interval, of refinement 1 */
  int       n_events; /* when they were set; -1: never */
  shb_arena arena;
} mhb_monodromy;

/* finest: the greatest refinement. condensed: stuck contacts are springs of the structure, which is
 * cheaper with many contacts; of a blade on the ground without Coriolis terms only. SHB_ERR_IO: no
 * memory. Structure, schedule and contact must outlive it. */
mhb_monodromy *mhb_monodromy_create(const mhb_modal_structure     *structure,
                                    const mhb_transition_schedule *schedule,
                                    mhb_contact_evaluator *contact, int m, int substeps, int finest,
                                    bool condensed);
void           mhb_monodromy_destroy(mhb_monodromy *monodromy);

/* The structure has changed. */
void mhb_monodromy_forget(mhb_monodromy *monodromy);

/* Set M for a solution and the schedule set from it. Each interval between events has refinement
 * times as many sub-steps; omega: of the fundamental, rad/s.
 *   keep  in  the sub-steps of the last call, if it had as many events: M is then a smooth function
 *             of a solution near that
 * Returns NULL, or the reason of a failure. */
const char *mhb_monodromy_set(mhb_monodromy *monodromy, const mhb_solution *solution, double omega,
                              int refinement, bool keep);

#endif
