/* A design study in memory: designs, their outputs, and what was concluded from them.
 *
 * A design is one set of values of the varied keys of a case. Unknown numbers are NAN. */
#ifndef POSTPROC_STUDY_DESIGN_STUDY_H
#define POSTPROC_STUDY_DESIGN_STUDY_H

#include <stdbool.h>

#include "mesh/base/status.h"

enum { STUDY_NAME = 256, STUDY_UNIT = 32, STUDY_DIGEST = 17, STUDY_CURVE = 200 };

typedef enum {
  STUDY_WAITING,
  STUDY_DONE,
  STUDY_FAILED,        /* no output; the reason says why */
  STUDY_NOT_CONVERGED, /* outputs of an incomplete curve; the reason says where */
  STUDY_N_STATES
} study_state;

/* A varied key, an output, or a parameter of the derivatives. */
typedef struct {
  char   name[STUDY_NAME]; /* "contact.n0", "peak", "modes[1].frequency" */
  char   unit[STUDY_UNIT]; /* SI; "-" for a pure number */
  double at;               /* of a derivative: the parameter's value in the case; else unused */
} study_column;

/* Response curves of one design, thinned to STUDY_CURVE points. */
typedef struct {
  int     n;
  int    *branch;    /* [n] branches follow one another */
  double *frequency; /* [n] Hz */
  double *amplitude; /* [n] m, first harmonic of the first output of the response */
  int    *stable;    /* [n] 1, 0, -1: not judged */
} study_curve;

typedef struct {
  study_state state;
  double     *key;                  /* [n_keys] SI */
  double     *value, *error;        /* [n_outputs] SI; NAN: unknown */
  double     *derivative;           /* [n_derivatives] d peak / d parameter; NAN: not judged */
  char       *reason;               /* NULL if there is none */
  char        digest[STUDY_DIGEST]; /* of everything that the outputs depend on; "": not computed */
  double      seconds;              /* CPU, when it was computed; 0: it is equal to another */
  int         tried_from; /* design from whose peak this one was tried again; -1: it was not */
  study_curve curve;
} study_design;

/* Result of an optimisation; all empty without one. */
typedef struct {
  char  method[STUDY_NAME];    /* algorithm and library; "": no optimisation */
  char  objective[STUDY_NAME]; /* output that was minimised */
  char *note;                  /* warnings, one a line; or NULL */
  int   best;                  /* design; -1: none meets the constraints */
  int  *on_bound;              /* [n_keys] -1 at the lower bound, 1 at the upper, else 0 */
  int   n_history;
  int  *history; /* [n_history] designs in the order of evaluation */
} study_optimum;

/* Statistics over the samples of uncertain keys; all empty without them. */
typedef struct {
  int     n_samples, n_failed;
  int     n_percentiles;
  double *level;                                         /* [n_percentiles] in percent */
  double *mean, *deviation;                              /* [n_outputs] */
  double *percentile, *percentile_low, *percentile_high; /* [n_outputs][n_percentiles] */
  double  confidence;                                    /* of all intervals, e.g. 0.95 */
  bool    has_sobol;
  double *first, *first_low, *first_high; /* [n_outputs][n_keys] Sobol' indices, first order */
  double *total, *total_low, *total_high; /* the same, total */
} study_uncertainty;

/* Statistics over the samples of uncertain keys at each design of varied keys, a group; all empty
 * without both. */
typedef struct {
  int     n_groups, n_varied; /* the varied keys are the first keys of the study */
  int     n_percentiles;
  int    *n_samples, *n_failed;                          /* [n_groups] */
  double *level;                                         /* [n_percentiles] in percent */
  double *key;                                           /* [n_groups][n_varied] */
  double *mean, *deviation;                              /* [n_groups][n_outputs] */
  double *percentile, *percentile_low, *percentile_high; /* [n_groups][n_outputs][n_percentiles] */
  double  confidence;                                    /* of the intervals */
} study_robust;

typedef struct {
  char             *name, *text, *case_text; /* text of the study file and of its case */
  char             *path, *case_path;        /* as given */
  char              plan[STUDY_NAME];        /* "grid", "sobol", ...; "optimise"; "uncertain" */
  bool              finished;
  int               n_keys, n_outputs, n_derivatives;
  study_column     *key, *output, *derivative;
  int               n, capacity;
  study_design     *design; /* [n] */
  study_optimum     optimum;
  study_uncertainty uncertainty;
  study_robust      robust;
} design_study;

/* Set up a study without designs; all columns are empty. Free it in any case. Errors: SHB_ERR_IO
 * no memory. */
shb_status design_study_create(int n_keys, int n_outputs, int n_derivatives, design_study *study);
void       design_study_free(design_study *study);

/* Append a design with these values [n_keys]; it waits. NULL: no memory. Pointers to designs become
 * invalid, those inside a design stay. */
study_design *design_study_add(design_study *study, const double *key);

/* Take the arrays of the optimum (n_history) or the statistics (n_percentiles). They are NAN or 0.
 * Errors: SHB_ERR_IO no memory. */
shb_status design_study_take_optimum(design_study *study, int n_history);
shb_status design_study_take_uncertainty(design_study *study, int n_percentiles, bool sobol);
shb_status design_study_take_robust(design_study *study, int n_groups, int n_varied,
                                    int n_percentiles);

/* Replace the reason of a design. */
void study_design_set_reason(study_design *design, const char *text);

/* Take memory for n points of a curve; the old one is freed. Errors: SHB_ERR_IO no memory. */
shb_status study_curve_take(study_curve *curve, int n);

/* "done", "failed", "not converged", "not run" */
const char *study_state_name(study_state state);

/* Index of an output by its name; -1: none. */
int design_study_output(const design_study *study, const char *name);

/* Number of designs in a state. */
int design_study_count(const design_study *study, study_state state);

#endif
