/* One start of a ring, integrated by blocks of periods, with what is read from each. */
#ifndef MHB_RING_DISTURBED_START_H
#define MHB_RING_DISTURBED_START_H

#include "mhb/ring/motions.h"
#include "mhb/ring/ring_output.h"

enum {
  MHB_START_BLOCK  = 25, /* periods of the fundamental */
  MHB_START_BLOCKS = 40, /* at most */
  MHB_START_LINES  = 64  /* periods whose samples are kept: lines to 1e-3 of the frequency */
};

/* Called after every period; false: stop. May be NULL. */
typedef bool (*mhb_go_on)(void *context);

typedef struct {
  mhb_ring        ring;
  mhb_ring_output output;
  int             periods;
  double          mean[MHB_START_BLOCKS], spread[MHB_START_BLOCKS];
  double         *peak;    /* [period][blades] over the wave's */
  double         *sample;  /* [MHB_START_LINES][MHB_SIDE_SAMPLES][3][blades], the last, in turn */
  double complex *pattern; /* [3][blades] undoes the lag of the wave, or the balance's motion */
  double complex  sum[3];  /* of the block: first harmonics, [0] alone if mistuned; their squares */
  double          square, peaks;
  shb_arena       arena;
} mhb_start;

/* The model must outlive it. SHB_ERR_IO: no memory. */
shb_status mhb_start_create(mhb_ring_model *model, mhb_start *start);
void       mhb_start_destroy(mhb_start *start);

/* Forget what was read; the state of the ring stays. */
void mhb_start_begin(mhb_start *start);

/* Integrate to a number of blocks. scale: the wave's peak, m. false: stopped. */
bool mhb_start_advance(mhb_start *start, int blocks, double scale, mhb_go_on go_on, void *context);

/* peaks [period][blades] of the half that counts; the series borrows them. */
mhb_lasting_series mhb_start_series(const mhb_start *start, double *peaks);

#endif
