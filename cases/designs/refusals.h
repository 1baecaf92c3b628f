/* Designs that the case refuses, gathered by the key at fault: one line a key, with the first such
 * design. */
#ifndef CASES_DESIGNS_REFUSALS_H
#define CASES_DESIGNS_REFUSALS_H

#include "cases/designs/study_keys.h"
#include "cases/parse/diagnostics.h"

enum { REFUSALS_TOLD = 5, REFUSAL_TEXT = 512 };

typedef struct {
  int  key;       /* the varied key at fault; -1: none of them is */
  int  design, n; /* the first such design, and how many there are */
  char text[REFUSAL_TEXT];
} refusal;

typedef struct {
  int     n, n_designs; /* keys at fault, and designs that are refused */
  refusal told[REFUSALS_TOLD];
} refusals;

/* Take a refused design.
 *   messages   in  all that reading the case said, one or more lines
 *   case_path  in  the path of the case, with which its messages begin */
void refusals_take(refusals *r, const study_keys *keys, int design, const char *messages,
                   const char *case_path);

/* Record one issue a key, at its value in the study file.
 *   root    in  the study file
 *   design  in  [][keys.n] values of the designs
 *   at      in  the place of what is at fault in no varied key */
void refusals_report(const refusals *r, const study_keys *keys, const double *design,
                     const case_node *root, const case_node *at, case_issues *issues);

/* The first message of a case, without the name of its file. */
void refusal_line(const char *messages, const char *case_path, char *out, size_t size);

#endif
