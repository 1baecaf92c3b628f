/* Campbell diagram: frequencies of the tracked modes over the rotor's speed, with engine-order lines and where they cross. */
#ifndef POSTPROC_ANALYSIS_CAMPBELL_H
#define POSTPROC_ANALYSIS_CAMPBELL_H

#include "modal/model/speeds.h"
#include "postproc/draw/text_buffer.h"

typedef struct {
  const modal_speeds *speeds;
  int                 engine_order; /* E of the excitation; 0: none */
} post_campbell;

/* A resonance: the order's line meets a mode. */
typedef struct {
  int    order, track; /* track from 0 */
  double speed;        /* rad/s */
  double frequency;    /* Hz */
} post_crossing;

/* Crossings of the excited orders E k (harmonics k of the load) inside the range of speeds, by speed; between the speeds of the file lambda is the
 * spline in Omega^2 (modal/model/spline.h). crossing: malloc'ed. SHB_ERR_IO no memory. */
shb_status post_campbell_crossings(const post_campbell *campbell, int *n, post_crossing **crossing);

/* A picture of its own, light or dark as the viewer wants. */
void post_campbell_picture(const post_campbell *campbell, const char *case_name, post_buffer *out);

/* The report's section: diagram and table of the crossings. */
void post_campbell_section(const post_campbell *campbell, post_buffer *out);

/* What the page's style must know of it. */
extern const char post_campbell_css[];

/* For a terminal: tracked frequencies, a line a track, the first 12 unless all. */
void post_campbell_table(const modal_speeds *speeds, bool all, post_buffer *out);

#endif
