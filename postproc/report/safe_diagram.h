/* SAFE diagram (ZZENF): natural frequencies of the ring over the nodal diameter, and where the
 * excitation is. A resonance needs both: the frequency, and the shape over the blades.
 *
 * Harmonic k of the load meets waves of nodal diameter kE mod N, or N less that, whichever is at
 * most N/2. */
#ifndef POSTPROC_REPORT_SAFE_DIAGRAM_H
#define POSTPROC_REPORT_SAFE_DIAGRAM_H

#include "mhb/response/response.h"
#include "mhb/run_up/stuck_frequencies.h"
#include "postproc/draw/text_buffer.h"

typedef struct post_safe {
  int     blades, engine_order;
  int     n_families;           /* mode families drawn */
  double *open, *stuck;         /* [blades/2 + 1][n_families] Hz */
  int     n_driven, driven[16]; /* harmonics of the load with a force */
  double  range[2];             /* of the curves, Hz */
  double  speed;                /* of the rotor, rad/s; 0: not known */
  bool    disc;                 /* the blades share a flexible disc */
  bool    known;                /* false: the file is of a version that stored no frequencies */
} post_safe;

/* The families of a response file that a diagram over its range shows. Frequencies at nodal
 * diameters that the file lacks are NAN.
 *   model  in  of the response: its frequencies tell how many families there are in the range
 *   range  in  of the curves, Hz */
void post_safe_create(const mhb_diagrams *diagrams, const modal_model *model,
                      const mhb_response *response, const double range[2], double speed,
                      post_safe *safe);
void post_safe_free(post_safe *safe);

/* ,"safe":{...} of the page's numbers (report.schema.json), and its table as HTML; nothing without
 * families. */
void post_safe_data(const post_safe *safe, post_buffer *out);
void post_safe_table(const post_safe *safe, post_buffer *out);

#endif
