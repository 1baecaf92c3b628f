/* Starts of a ring, integrated side by side by blocks of periods, with what is read from each. */
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

/* What was read from one copy of the ring. */
typedef struct {
  int            periods;
  double         mean[MHB_START_BLOCKS], spread[MHB_START_BLOCKS];
  double        *peak;   /* [period][blades] over the wave's */
  double        *sample; /* [MHB_START_LINES][MHB_SIDE_SAMPLES][3][blades], the last, in turn */
  double complex sum[3]; /* of the block: first harmonics, [0] alone if mistuned; their squares */
  double         square, peaks;
} mhb_start;

/* A start in each copy of a ring. */
typedef struct {
  mhb_ring        ring;
  mhb_ring_output output;
  double          scale;   /* m, the wave's peak in the steps at hand */
  double complex *pattern; /* [3][blades] undoes the lag of the wave, or the balance's motion */
  mhb_start       start[MHB_LANES];
  bool            runs[MHB_LANES]; /* this copy is read */
  shb_arena       arena;
} mhb_starts;

/* The model must outlive them. None runs. */
void mhb_starts_create(mhb_ring_model *model, mhb_starts *starts);
void mhb_starts_destroy(mhb_starts *starts);

/* A copy's start begins: what was read is forgotten, the state of the ring stays. */
void mhb_start_begin(mhb_starts *starts, int copy);

/* Integrate a block of periods. false: stopped. */
bool mhb_starts_block(mhb_starts *starts, mhb_go_on go_on, void *context);

/* Series of copies that have run for as many periods, as one: means of their blocks, and the peaks
 * of all. peaks: space for those of the half that counts. The series borrows it, mean and spread
 * [MHB_START_BLOCKS]. */
mhb_lasting_series mhb_starts_series(const mhb_starts *starts, int n, const int *copy, double *mean,
                                     double *spread, double *peaks);

#endif
