/* Modal models at several speeds of the rotor, their modes tracked from one speed to the next. Free of PETSc.
 *
 * In the file: groups /speed_0, /speed_1, ... with a model each, by ascending speed, and /speeds (docs/user/own_modes.md). Track t is mode t of the
 * first speed, carried on by the mode most like it at the next: MAC = (phi^T M psi)^2, every mode taken once. Signs follow the tracks. */
#ifndef MODAL_MODEL_SPEEDS_H
#define MODAL_MODEL_SPEEDS_H

#include "modal/model/model.h"

enum { MODAL_SPEEDS_VERSION = 2 }; /* of the file format, with more than one speed */

typedef struct {
  int          n, n_modes;
  double      *speed; /* [n] rad/s, ascending */
  modal_model *model; /* [n] */
  int         *mode;  /* [n][n_modes] mode of the model that belongs to track t */
  double *mac; /* [n][n_modes] of that mode with the track's at the speed before; 1 at the first */
  double *
      overlap; /* [n][n_modes][n_modes] phi_i^T M psi_j of mode i of the first speed, j of this one, or NULL */
} modal_speeds;

/* Below this MAC a track is not the same mode any more. */
extern const double modal_speeds_alike;

/* Room for n speeds of n_modes modes; models zeroed. SHB_ERR_IO no memory. */
shb_status modal_speeds_create(int n, int n_modes, modal_speeds *speeds);

/* The track's frequency at speed s, Hz. */
double modal_speeds_frequency(const modal_speeds *speeds, int s, int track);

/* Groups of the open file, whose own model is written; format_version becomes 2. */
shb_status modal_speeds_write(hid_t file, const modal_speeds *speeds);

/* n = 0 if the file holds one speed only. Errors: as modal_model_read; SHB_ERR_INPUT models that do not fit together. */
shb_status modal_speeds_read(const char *path, modal_speeds *speeds);

void modal_speeds_free(modal_speeds *speeds); /* also on a zeroed struct */

#endif
