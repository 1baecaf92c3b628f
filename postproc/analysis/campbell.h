/* Campbell diagram: frequencies of the tracked modes over the rotor speed, engine-order lines, and
 * their crossings. */
#ifndef POSTPROC_ANALYSIS_CAMPBELL_H
#define POSTPROC_ANALYSIS_CAMPBELL_H

#include <stdbool.h>

#include "modal/model/nodal_diameters.h"
#include "modal/model/speeds.h"
#include "postproc/draw/text_buffer.h"

typedef struct {
  const modal_speeds *speeds;
  int                 engine_order; /* E of the excitation; 0: none */
  /* [speed][n_stuck] Hz, rising: the ring with stuck contacts at the nodal diameter of E; NULL:
   * not known */
  int           n_stuck;
  const double *stuck;
  bool          stuck_unknown; /* the response is of a version that stored none */
  int blades, diameter; /* of a disc: N, and the nodal diameter of its modes; blades 0: none */
} post_campbell;

/* A resonance: the line of an engine order meets a mode. */
typedef struct {
  bool   stuck;        /* of the ring with stuck contacts, else of the free blade */
  int    order, track; /* track from 0 */
  double speed;        /* rad/s */
  double frequency;    /* Hz */
} post_crossing;

/* Crossings of the excited orders E k (harmonics k of the load) within the speed range, by
 * ascending speed. Of a disc only the orders count that meet its nodal diameter. Between the speeds
 * of the file lambda is the spline in Omega^2 (modal/model/spline.h). crossing: malloc'ed. Errors:
 * SHB_ERR_IO no memory. */
shb_status post_campbell_crossings(const post_campbell *campbell, int *n, post_crossing **crossing);

/* A stand-alone picture, light or dark as the viewer prefers. */
void post_campbell_picture(const post_campbell *campbell, const char *case_name, post_buffer *out);

/* The section of the report: n diagrams, one a nodal diameter, each with a table of its
 * crossings. */
void post_campbell_section(int n, const post_campbell *campbell, post_buffer *out);

/* Style rules that the page needs for it. */
extern const char post_campbell_css[];

/* Text table of the tracked frequencies, a line for each track; the first 12 unless all. */
void post_campbell_table(const modal_speeds *speeds, bool all, post_buffer *out);

#endif
