/* The command line of `shroudhb field`. */
#ifndef CASES_FIELD_FIELD_OPTIONS_H
#define CASES_FIELD_FIELD_OPTIONS_H

#include <stdbool.h>

/* Numbers are below 0 where not given. */
typedef struct {
  const char *response;       /* NAME.response.h5; NAME.modal.h5 with mode */
  const char *modal;          /* NULL: NAME.modal.h5 beside it */
  int         branch, point;  /* as `inspect` counts them */
  int         peak;           /* rank by height, from 1 */
  int         mode, diameter; /* of the modal file: from 1; from 0 */
  int         steps;          /* of the period */
  double      scale;          /* of the picture */
  bool        ring, face;
} field_options;

/* Take the options with values out of argv; *argc is what is left for command_parse. Returns a
 * value below 0 to go on, else the exit code, after a message. */
int field_options_take(int *argc, char **argv, field_options *out);

/* Length of NAME in NAME.response.h5, NAME.modal.h5 or NAME.h5. */
int field_stem(const char *path);

#endif
