/* The modes of a modal file in numbers, for programs and for `shroudhb check`. */
#ifndef POSTPROC_SUMMARY_MODE_SUMMARY_H
#define POSTPROC_SUMMARY_MODE_SUMMARY_H

#include "postproc/summary/json.h"

typedef struct {
  int     n;
  double *frequency, *damping;  /* [n] Hz, - */
  int    *diameter;             /* [n] nodal diameter of each; NULL: a clamped blade */
  double *mass_along, *inertia; /* [n][3] kg, [n] kg m2: effective; NULL: not in the file */
  double  mass;                 /* kg, of the body; NAN if unknown */
  double  speed;                /* rad/s, 0 at rest */
  double  static_stress;        /* Pa, greatest von Mises; NAN without static loads */
  double  static_displacement;  /* m, greatest */
} post_modes;

/* Errors: as modal_model_read. To be freed in any case. */
shb_status post_modes_read(const char *path, post_modes *modes);
void       post_modes_free(post_modes *modes);

/* Put the keys mass, rotor_speed, static and modes into an object that is open. */
void post_modes_put(const post_modes *modes, post_json *json);

#endif
