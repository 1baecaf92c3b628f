/* The two files by which Dakota drives a program: parameters in, results out.
 *
 * Parameters stand in the standard format (value, tag) or that of aprepro ({ tag = value }). The
 * active set says what is wanted of each response: 1 the value, 2 the gradient by the derivative
 * variables. Source: Dakota 6 user's manual, "Parameters file format", "Results file format". */
#ifndef CASES_STUDY_DAKOTA_FILES_H
#define CASES_STUDY_DAKOTA_FILES_H

#include <stdbool.h>
#include <stddef.h>

enum { DAKOTA_MOST = 64, DAKOTA_TAG = 128 };

typedef struct {
  int    n_variables;
  char   variable[DAKOTA_MOST][DAKOTA_TAG]; /* descriptors */
  double value[DAKOTA_MOST];
  int    n_responses;
  char   response[DAKOTA_MOST][DAKOTA_TAG]; /* descriptors */
  int    active[DAKOTA_MOST];               /* 1 value, 2 gradient, 4 Hessian, added */
  int    n_derivatives;
  int    derivative[DAKOTA_MOST]; /* variable, from 0 */
} dakota_parameters;

/* Read a parameters file. False with a reason, one line. */
bool dakota_read(const char *path, dakota_parameters *parameters, char *why, size_t size);

/* The key or output that a descriptor stands for, for descriptors of letters, digits and
 * underscores. "__" is a dot, and a number between two of them is an index. contact__n0 and
 * mesh__blade__sections__4__thickness are keys. Other descriptors are left as they are. */
void dakota_path(const char *descriptor, char path[2 * DAKOTA_TAG]);

/* Publish a results file: values [n_responses] and gradients [n_responses][n_derivatives] where
 * they are active. False: it cannot be written. */
bool dakota_write(const char *path, const dakota_parameters *parameters, const double *value,
                  const double *gradient);

/* Publish a results file that says that the evaluation failed, and why. */
bool dakota_fail(const char *path, const char *reason);

#endif
