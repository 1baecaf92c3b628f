/* Numbers as a designer reads them: a prefix that fits, a fixed count of digits, a true minus sign. UTF-8. */
#ifndef POSTPROC_DRAW_NUMBER_FORMAT_H
#define POSTPROC_DRAW_NUMBER_FORMAT_H

enum { POST_NUMBER = 64 }; /* bytes that hold any printed number with its unit */

typedef struct {
  const char *name;  /* "µm" */
  double      scale; /* 1e-6: value in SI / scale is printed */
} post_unit;

/* The unit in which largest (SI, sign ignored) reads best; not finite or 0 gives the SI unit's usual choice. */
post_unit post_unit_length(double largest);    /* m mm µm nm pm */
post_unit post_unit_force(double largest);     /* MN kN N */
post_unit post_unit_stiffness(double largest); /* GN/m MN/m kN/m N/m */
post_unit post_unit_energy(double largest);    /* kJ J mJ µJ nJ */

/* value with digits significant digits, trailing zeros kept ("1.240"), powers as ×10⁻⁵; not finite: "–". Returns out. */
char *post_number(char out[POST_NUMBER], double value, int digits);
/* The same without trailing zeros ("100"). */
char *post_plain(char out[POST_NUMBER], double value, int digits);
/* post_number, a no-break space, the unit. */
char *post_measure(char out[POST_NUMBER], double value, post_unit unit, int digits);
/* A negative power of ten as one ("10⁻⁸"); all else, and 0.1, as post_plain of three digits. */
char *post_power(char out[POST_NUMBER], double value);
/* A ratio in percent: two significant digits, "71 %", "0.034 %"; not finite: "–". */
char *post_percent(char out[POST_NUMBER], double ratio);

#endif
