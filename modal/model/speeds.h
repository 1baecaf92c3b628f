/* Modal models at several rotor speeds, with modes tracked from one speed to the next. Free of
 * PETSc.
 *
 * In the file: groups /speed_0, /speed_1, ... hold one model each, by ascending speed; /speeds
 * holds the tracks (docs/user/own_modes.md). Track t starts at mode t of the first speed. At the
 * next speed it takes the mode with the largest MAC = |phi^H M psi|^2, every mode once. Signs of
 * real modes follow the tracks.
 *
 * Of a sector with a disc each group /nodal_diameter_n holds its own (sector_speeds.h). */
#ifndef MODAL_MODEL_SPEEDS_H
#define MODAL_MODEL_SPEEDS_H

#include <stdbool.h>

#include "modal/model/model.h"

enum { MODAL_SPEEDS_VERSION = 2 }; /* version of the file format with several speeds */

typedef struct {
  int          n, n_modes;
  double      *speed;   /* [n] rad/s, ascending */
  modal_model *model;   /* [n] */
  int         *mode;    /* [n][n_modes] mode of the model that belongs to track t */
  double      *mac;     /* [n][n_modes] MAC with the track's mode at the speed before; first: 1 */
  double      *overlap; /* [n][n_modes][n_modes] phi_i^H M psi_j, i of the first speed; or NULL */
  /* Of a travelling wave with complex shapes, all three; else NULL. */
  modal_model *imaginary, *backward; /* [n] as in modal/model/nodal_diameters.h */
  double      *overlap_imaginary;    /* of overlap */
} modal_speeds;

/* Below this MAC a track has lost its mode. */
extern const double modal_speeds_mac_limit;

/* Allocate n speeds of n_modes modes; models are zeroed. */
void modal_speeds_create(int n, int n_modes, modal_speeds *speeds);

/* Make them those of a travelling wave: the three arrays, zero. */
void modal_speeds_make_complex(modal_speeds *speeds);

/* Frequency of a track at speed s, Hz. */
double modal_speeds_frequency(const modal_speeds *speeds, int s, int track);

/* Write /speeds and the groups of all speeds to an open modal file that already holds its own
 * model. Sets format_version to MODAL_SPEEDS_VERSION. */
shb_status modal_speeds_write(hid_t file, const modal_speeds *speeds);

/* Read them; n = 0 if the file holds one speed only. Errors: as modal_model_read; SHB_ERR_INPUT
 * also if the models do not fit together. */
shb_status modal_speeds_read(const char *path, modal_speeds *speeds);

/* The same in a group of an open file, without the version. */
shb_status modal_speeds_write_at(hid_t at, const modal_speeds *speeds);

/* Read them from a group; label names it in messages. is_complex: with the three arrays of a wave.
 * speeds is zeroed before the call and freed by the caller in any case. */
shb_status modal_speeds_read_at(hid_t at, const char *label, bool is_complex, modal_speeds *speeds);

void modal_speeds_free(modal_speeds *speeds); /* also on a zeroed struct */

#endif
