/* The blade on the ground, or the ring of N blades, as one linear structure in modal coordinates.
 *
 * To the neighbour (sides = 2) contact j = blade * pairs + pair lies between the right side of its
 * blade and the left side of the next one. To ground (sides = 1) there is one blade. Motion du = B
 * dq - R dp, force on the modes -B^T dp.
 *
 * Of a mistuned ring (settings->ring) all blades have the same shapes and damping ratios.
 * With settings->nodal_diameters the blades are also coupled by their disc (disc_modes.h); then the
 * modes are those of the nodal diameters. So they are with Coriolis terms. */
#ifndef MHB_STRUCTURE_MODAL_STRUCTURE_H
#define MHB_STRUCTURE_MODAL_STRUCTURE_H

#include "mesh/base/arena.h"
#include "mhb/problem/settings.h"
#include "mhb/structure/disc_modes.h"
#include "mhb/structure/receptance.h"

typedef struct {
  int     blades, sides, modes, pairs, contacts;
  int     wave;         /* E of the fundamental: the next blade lags by 2 pi E/N */
  bool    mistuned;     /* every blade its own frequencies and flexibility */
  double *omega, *zeta; /* [modes] rad/s, -; mistuned: omega[blade][modes] */
  double *shape;        /* [side][mode][3 pairs] (v, u, w) by the mode, kg^-1/2; left: negative */
  /* [self, next, previous][3 pairs][3 pairs] R of a blade's contacts by forces on its own and on
   * the neighbours', m/N. NULL: none, a disc, or mistuned. */
  double *block;
  double *flexibility; /* [3 contacts][3 contacts] R of all; NULL: none, or not asked for */
  /* NULL: blades that their contacts alone couple. Else omega, zeta and shape are NULL. */
  mhb_disc_modes *disc;
  shb_arena       arena;
} mhb_modal_structure;

typedef enum {
  MHB_STRUCTURE_LEAN,  /* without R of all contacts, whose memory grows with their square */
  MHB_STRUCTURE_WHOLE, /* with it */
  MHB_STRUCTURE_BLADES /* the same, by the modes of the blades also with Coriolis terms, which are
                        * left to the caller; no nodal diameters */
} mhb_structure_extent;

/* The lowest modes stay dynamic. The others answer statically and are added to R, as is residual
 * flexibility. Residual inertia is left out: u = B q - R p + R2 p'' cannot be integrated forward in
 * time. SHB_ERR_INPUT: a nodal diameter of the disc is missing. */
shb_status mhb_modal_structure_create(const mhb_receptance *receptance,
                                      const mhb_settings *settings, int modes,
                                      mhb_structure_extent extent, mhb_modal_structure *structure);
/* Anew for the same modes, after the receptance went to another speed of a run-up. */
void mhb_modal_structure_set(const mhb_receptance *receptance, mhb_modal_structure *structure);
void mhb_modal_structure_destroy(mhb_modal_structure *structure);

/* [modes] rad/s of a blade; not of a disc. */
static inline const double *mhb_modal_structure_omega(const mhb_modal_structure *s, int blade) {
  return s->omega + (s->mistuned ? blade * s->modes : 0);
}

/* Groups of contacts that are coupled with the neighbouring groups only: the blades; on a disc all
 * contacts are one group. */
static inline int mhb_modal_structure_groups(const mhb_modal_structure *s) {
  return s->disc ? 1 : s->blades;
}

/* First contact of the side of a blade. */
static inline int mhb_modal_structure_contact(const mhb_modal_structure *s, int blade, int side) {
  return (side == 0 || blade > 0 ? blade - side : s->blades - 1) * s->pairs;
}

#endif
