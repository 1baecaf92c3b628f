/* Speed against error: what `shroudhb converge` found, rung by rung, and what follows from it. */
#ifndef POSTPROC_ANALYSIS_CONVERGENCE_H
#define POSTPROC_ANALYSIS_CONVERGENCE_H

#include <stdbool.h>

#include "mesh/base/publish.h"
#include "postproc/draw/text_buffer.h"

/* Each ladder varies one setting. Errors are against the finest rung of its own, those of auto against that of the harmonics,
 * of bare against that of the modes, of together (settings combined) against that of the harmonics. */
typedef enum {
  POST_LADDER_HARMONICS,
  POST_LADDER_AUTO,
  POST_LADDER_ACCURACY,
  POST_LADDER_MODES,
  POST_LADDER_BARE, /* modes without residual flexibility */
  POST_LADDER_MESH,
  POST_LADDER_TOGETHER,
  POST_N_LADDERS
} post_ladder;

typedef enum {
  POST_RUNG_WAITING,    /* not run: interrupted before */
  POST_RUNG_DONE,       /* every curve covered the range */
  POST_RUNG_INCOMPLETE, /* a curve did not */
  POST_RUNG_FAILED      /* no curve at all */
} post_rung_state;

enum { POST_RUNG_NAME = 64 };

typedef struct {
  post_ladder     ladder;
  char            name[POST_RUNG_NAME];
  post_rung_state state;
  bool            reference; /* the finest of its ladder */
  bool            of_case;   /* as the case has it */
  double          unknowns;  /* of the balance; of the finite elements for a mesh */
  double
      seconds;   /* s of one core: the balance; with meshing and modes for a mesh. NAN: not known */
  double total;  /* s, with the program's start and reading */
  double memory; /* greatest, bytes */
  double peak, frequency, curve; /* relative errors; NAN: not compared. 0 for a reference */
  double
      integration; /* error of the amplitude at the points of time integration; NAN: there are none */
} post_rung;

typedef struct {
  char       output[160]; /* "tip motion" */
  double     tolerance;
  int        n_preloads;
  int        n_points; /* of time integration that the rungs were compared with */
  int        n, capacity;
  post_rung *rung; /* [n] ladder by ladder, coarse to fine */
  char      *note; /* what must be known besides, sentences; or NULL */
} post_convergence;

const char *post_ladder_name(post_ladder ladder); /* "harmonics" */
const char *post_ladder_key(post_ladder ladder);  /* "mhb.harmonics" */

/* Append a zeroed rung; NULL: no memory. The others may move. */
post_rung *post_convergence_add(post_convergence *study);
void       post_convergence_free(post_convergence *study);

/* The greatest of the three errors; NAN if one is not known. */
double post_rung_error(const post_rung *rung);
/* Whether it was compared, is complete and errs by no more than the tolerance. References are not compared with anything. */
bool post_rung_meets(const post_convergence *study, const post_rung *rung);
/* The fewest seconds of those that meet the tolerance; -1: none does. */
int post_cheapest(const post_convergence *study, post_ladder ladder);
/* The finest rung of a ladder, -1 if it was not reached. */
int post_reference(const post_convergence *study, post_ladder ladder);

/* Aligned table for a terminal. */
void post_convergence_table(const post_convergence *study, const char *case_name, post_buffer *out);
/* One sentence a ladder, and the cheapest setting of all; a line each. */
void post_convergence_conclusion(const post_convergence *study, post_buffer *out);
/* RFC 4180: ladder, rung, of_case, state, unknowns, seconds, total_seconds, memory_bytes, peak_error, frequency_error, curve_error,
 * integration_error, verdict (reference, yes, no; empty: not compared). What is not known is left empty. */
void post_convergence_csv(const post_convergence *study, post_buffer *out);

/* NAME.converge.h5 (format "shroudhb convergence"): write whole, read back with checks.
 * Errors: SHB_ERR_IO; SHB_ERR_INPUT (reading) foreign format, lists of different length, codes out of range. */
shb_status post_convergence_write(const post_convergence *study, const char *path,
                                  const shb_provenance *provenance);
shb_status post_convergence_read(const char *path, post_convergence *study);

#endif
