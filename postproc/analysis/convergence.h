/* Convergence study: computing time against error of every rung, and the conclusions. */
#ifndef POSTPROC_ANALYSIS_CONVERGENCE_H
#define POSTPROC_ANALYSIS_CONVERGENCE_H

#include <stdbool.h>

#include "mesh/base/publish.h"
#include "postproc/draw/text_buffer.h"

/* Each ladder varies one setting. Errors are relative to the finest rung of the same ladder. The
 * ladders auto and together (settings combined) refer to the finest harmonics, bare to the finest
 * modes. */
typedef enum {
  POST_LADDER_HARMONICS,
  POST_LADDER_AUTO,
  POST_LADDER_ACCURACY,
  POST_LADDER_MODES,
  POST_LADDER_BARE, /* modes without residual flexibility */
  POST_LADDER_MESH,
  POST_LADDER_TOGETHER,
  POST_LADDER_POINTS, /* contact points; files hold these numbers, so it is the last */
  POST_N_LADDERS
} post_ladder;

typedef enum {
  POST_RUNG_WAITING,    /* interrupted before */
  POST_RUNG_DONE,       /* every curve covered the range */
  POST_RUNG_INCOMPLETE, /* a curve did not */
  POST_RUNG_FAILED      /* no curve at all */
} post_rung_state;

enum { POST_RUNG_NAME = 64 };

typedef struct {
  post_ladder     ladder;
  char            name[POST_RUNG_NAME];
  post_rung_state state;
  bool            reference; /* finest rung of its ladder */
  bool            of_case;   /* setting of the case */
  double          unknowns;  /* of the harmonic balance; of the finite elements for a mesh */
  /* s on one core, of the harmonic balance; for a mesh with meshing and modes. NAN: unknown. */
  double seconds;
  double total;                  /* s, including start and reading */
  double memory;                 /* peak, bytes */
  double peak, frequency, curve; /* relative errors; 0 for a reference, NAN: not compared */
  /* Error of the amplitude at the points of time integration; NAN: no such points. */
  double integration;
} post_rung;

typedef struct {
  char       output[160]; /* "tip motion" */
  double     tolerance;
  int        n_preloads;
  int        n_points; /* points of time integration compared with */
  int        n, capacity;
  post_rung *rung; /* [n] by ladder, coarse to fine */
  char      *note; /* further remarks, sentences; or NULL */
} post_convergence;

const char *post_ladder_name(post_ladder ladder); /* "harmonics" */

/* Append a zeroed rung; NULL: no memory. Pointers to other rungs become invalid. */
post_rung *post_convergence_add(post_convergence *study);
void       post_convergence_free(post_convergence *study);

/* Largest of the three errors; NAN if one is unknown. */
double post_rung_error(const post_rung *rung);
/* True if the rung was compared, is complete, and its error is within the tolerance. References are
 * never compared. */
bool post_rung_meets(const post_convergence *study, const post_rung *rung);
/* Index of the fastest rung that meets the tolerance; -1: none. */
int post_cheapest(const post_convergence *study, post_ladder ladder);
/* Index of the finest rung of a ladder; -1 if it was not reached. */
int post_reference(const post_convergence *study, post_ladder ladder);

/* Aligned table for a terminal. */
void post_convergence_table(const post_convergence *study, const char *case_name, post_buffer *out);
/* A sentence for each ladder, and the fastest setting of all; one per line. */
void post_convergence_conclusion(const post_convergence *study, post_buffer *out);
/* CSV (RFC 4180) with the columns ladder, rung, of_case, state, unknowns, seconds, total_seconds,
 * memory_bytes, peak_error, frequency_error, curve_error, integration_error, verdict (reference,
 * yes, no; empty: not compared). Unknown values are empty. */
void post_convergence_csv(const post_convergence *study, post_buffer *out);

/* Write and read NAME.converge.h5 (format "shroudhb convergence"). Errors: SHB_ERR_IO; on reading
 * also SHB_ERR_INPUT foreign format, lists of different length, codes out of range. */
shb_status post_convergence_write(const post_convergence *study, const char *path,
                                  const shb_provenance *provenance);
shb_status post_convergence_read(const char *path, post_convergence *study);

#endif
