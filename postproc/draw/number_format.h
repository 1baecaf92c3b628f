/* Numbers for readers: a fitting unit prefix, a fixed number of digits, a true minus sign.
 * UTF-8. */
#ifndef POSTPROC_DRAW_NUMBER_FORMAT_H
#define POSTPROC_DRAW_NUMBER_FORMAT_H

enum { POST_NUMBER = 64 }; /* bytes of any printed number with its unit */

typedef struct {
  const char *name;  /* "µm" */
  double      scale; /* 1e-6: printed is value in SI / scale */
} post_unit;

/* Unit in which largest (SI, any sign) reads best. The usual unit if largest is 0 or not finite. */
post_unit post_unit_length(double largest);    /* m mm µm nm pm */
post_unit post_unit_force(double largest);     /* MN kN N */
post_unit post_unit_stiffness(double largest); /* GN/m MN/m kN/m N/m */
post_unit post_unit_energy(double largest);    /* kJ J mJ µJ nJ */

/* value with digits significant digits and trailing zeros ("1.240"); powers as x10^-5 in
 * superscripts; a dash if not finite. Returns out. */
char *post_number(char out[POST_NUMBER], double value, int digits);
/* As post_number, without trailing zeros ("100"). */
char *post_plain(char out[POST_NUMBER], double value, int digits);
/* post_number, a no-break space, the unit. */
char *post_measure(char out[POST_NUMBER], double value, post_unit unit, int digits);
/* A negative power of ten as one (10 with a superscript); other numbers, and 0.1, as post_plain of
 * three digits. */
char *post_power(char out[POST_NUMBER], double value);
/* A ratio in percent with two significant digits, "71 %", "0.034 %"; a dash if not finite. */
char *post_percent(char out[POST_NUMBER], double ratio);

#endif
