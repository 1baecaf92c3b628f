/* Run-up of a sector with a disc. Every nodal diameter has a table, and a model at the speed of an
 * excitation frequency. */
#ifndef MHB_RUN_UP_DISC_SPEEDS_H
#define MHB_RUN_UP_DISC_SPEEDS_H

#include "mhb/run_up/speed_model.h"
#include "modal/model/sector_speeds.h"

/* Threads may share it. */
typedef struct mhb_disc_table {
  int               blades, n; /* N, nodal diameters held */
  int              *diameter;  /* [n] ascending from 0 */
  mhb_speed_table **table;     /* [n] with as many modes each */
} mhb_disc_table;

/* As mhb_speed_table_create; speeds are taken over, and empty afterwards. */
shb_status mhb_disc_table_create(modal_sector_speeds *speeds, const char *path, int engine_order,
                                 const double frequency[2], mhb_disc_table **table);
void       mhb_disc_table_destroy(mhb_disc_table *table);

/* mhb_speed_model_check at every nodal diameter. */
shb_status mhb_disc_table_check(const mhb_disc_table *table, const char *path);

/* The models at one speed; one a thread. */
typedef struct {
  const mhb_disc_table *table;
  mhb_speed_model     **at;         /* [n] */
  bool                 *used;       /* [n] set by mhb_disc_speeds_set; that of 0 always */
  modal_nodal_diameters now, slope; /* models of at, and their derivatives; not to be freed */
} mhb_disc_speeds;

/* At no frequency yet. The table must outlive it. */
mhb_disc_speeds *mhb_disc_speeds_create(const mhb_disc_table *table);
void             mhb_disc_speeds_destroy(mhb_disc_speeds *speeds);

/* Models of the nodal diameters that are used <- at an excitation frequency, rad/s. */
void mhb_disc_speeds_set(mhb_disc_speeds *speeds, double omega);

/* All of them at the frequency of that of 0. */
void mhb_disc_speeds_set_all(mhb_disc_speeds *speeds);

/* The derivatives of those that are used. */
void mhb_disc_speeds_differentiate(mhb_disc_speeds *speeds);

/* The speed model of a wave whose next blade lags by 2 pi wave/N; NULL: not held. */
mhb_speed_model *mhb_disc_speeds_use(mhb_disc_speeds *speeds, long wave);

#endif
