/* The response file NAME.response.h5: what the harmonic balance found, branch by branch. */
#ifndef MHB_RESPONSE_RESPONSE_H
#define MHB_RESPONSE_RESPONSE_H

#include <complex.h>
#include <stdbool.h>

#include "mesh/base/publish.h"
#include "mesh/base/status.h"
#include "mhb/problem/settings.h"

/* The balance, its linear limits, and single points by time integration. */
typedef enum {
  MHB_BRANCH_NONLINEAR,
  MHB_BRANCH_OPEN,
  MHB_BRANCH_STUCK,
  MHB_BRANCH_INTEGRATION,
  MHB_N_BRANCH_KINDS
} mhb_branch_kind;

/* How a branch was come by: followed from the low end of the range, from a solution found by search, from a flip; aside: on the way of
 * the main branch, a curve that is closed or leaves by the low end. */
typedef enum { MHB_FROM_END, MHB_FROM_SEARCH, MHB_FROM_FLIP, MHB_FROM_DETACHED } mhb_origin;

/* special of mhb_branch; the last two: where a multiplier leaves or enters the unit circle at -1, or a pair does */
enum { MHB_ORDINARY, MHB_FOLD, MHB_PEAK, MHB_FLIP, MHB_NEIMARK_SACKER, MHB_N_SPECIALS };

/* judged of mhb_branch: what stable rests on. Parity: of the folds passed since a point judged by its multipliers. */
enum {
  MHB_BY_FOLDS,           /* parity: multipliers were not computed */
  MHB_BY_MULTIPLIERS,     /* all inside the unit circle, or some well outside */
  MHB_MARGINAL_BY_FOLDS,  /* the largest is at 1 within what can be told: parity */
  MHB_UNDECIDED_BY_FOLDS, /* multipliers could not be computed: parity */
  MHB_N_JUDGED
};

/* loss of mhb_branch: what made an unstable point so. */
enum { MHB_NO_LOSS, MHB_LOSS_FOLD, MHB_LOSS_FLIP, MHB_LOSS_NEIMARK_SACKER, MHB_N_LOSSES };

/* Multipliers kept a point. */
enum { MHB_KEPT_MULTIPLIERS = 8 };

/* One curve. Array layouts: motion, force [point][pair][3 (v,u,w)][k = 0..m]; probe [point][probe][3 (tangential,
 * axial, radial)][k]; state [point][pair][3 (stuck, slipping, open)]; signals x(t) = Re sum_k A_k exp(j k w t / nu), with m and
 * nu of the branch: the harmonic of the excitation is k = nu. */
typedef struct {
  mhb_branch_kind kind;
  mhb_origin      origin;
  int     order, n_harmonics; /* nu, m; as the response's unless set before the first point */
  int     main; /* index of the branch of the same preload that begins at the end of the range */
  bool    searched; /* of that branch: what was to be found beside it is there */
  char   *reason;   /* how the branch ended: "end of range", or why not */
  bool    complete; /* the range was covered */
  int     n_points, capacity;
  double *frequency;    /* [point] Hz, of the excitation's first harmonic */
  double *n0;           /* [point] N, total of the interface, of several: of the one that leads */
  double *interface_n0; /* [point][n_interfaces] N */
  double *value;        /* [point] of the parameter that is followed; Hz for the frequency */
  double complex *motion, *force, *probe;
  int            *stable; /* [point] 1 stable, 0 unstable, -1 not known */
  int *special; /* [point] MHB_ORDINARY ...; peak: of any probe or contact motion, first harmonic */
  /* nonlinear branches only */
  int *judged; /* [point] MHB_BY_FOLDS ... */
  int *loss;   /* [point] MHB_NO_LOSS ... */
  double complex     *
      multipliers; /* [point][n_multipliers] the largest, by falling modulus; 0: not computed, or no more */
  int    *harmonics;       /* [point] of the balance there, at most n_harmonics; 0: not known */
  int    *truncation_kind; /* [point] mhb_truncation_kind */
  double *state;
  double *dissipation; /* [point][pair] J a cycle */
  int    *iterations;  /* [point] */
  double *seconds;     /* [point] */
  double *error_newton, *error_truncation, *error_sampling,
      *error_modal; /* [point] relative to the motion's norm */
  /* integration branches only */
  int *
      multiple; /* [point] the motion repeats after so many periods of the fundamental; 0: it does not */
  int    *periods;  /* [point] that were integrated */
  double *distance; /* [point] of the return map, relative */
  double *line_frequency,
      *line_amplitude; /* [point][n_lines] Hz, m: spectrum of what does not repeat, largest first */
} mhb_branch;

typedef struct {
  int           n_pairs, n_probes, n_harmonics, subharmonics, n_branches, capacity;
  char        **probe_name;
  mhb_branch   *branch;
  mhb_parameter parameter;      /* what is followed */
  int           n_multipliers;  /* kept a point; 0: none, set before the first point */
  int           n_interfaces;   /* 0: one, without a name; set before the first point */
  int           lead;           /* whose parameter is followed */
  char        **interface_name; /* [n_interfaces] */
  int          *interface;      /* [pair] which one; NULL without */
  int           n_lines;        /* of spectra of integrated points; 0: none, set likewise */
  /* copied from the modal model for the report */
  int     n_modes;
  double *mode_frequency, *mode_damping, *eigen_residual; /* [m]; eigen_residual may be NULL */
  int     engine_order, blades;
  bool
         run_up; /* the speed goes with the frequency, along the engine order; modes are those at the top of the range */
  double psi, phi; /* rad, mean of the pairs */
} mhb_response;

mhb_response *mhb_response_create(int n_pairs, int n_probes, int n_harmonics); /* NULL: no memory */
void          mhb_response_destroy(mhb_response *response);

/* A response without branches for the same pairs, probes, interfaces and kept multipliers, for work
 * that is not to be seen yet. NULL: no memory. */
mhb_response *mhb_response_like(const mhb_response *response);

/* Takes over names and places of n >= 2 interfaces: name[n], interface[pair] are copied. SHB_ERR_IO. */
shb_status mhb_response_interfaces(mhb_response *response, int n, char *const *name,
                                   const int *interface, int lead);

/* Append an empty branch, its own main one; its index through *index. */
shb_status mhb_response_branch(mhb_response *response, mhb_branch_kind kind, int *index);
/* Make room for one more point (zeroed) and return its index through *point; branch arrays may move. */
shb_status mhb_response_point(mhb_response *response, int branch, int *point);
/* Move the last point of a branch to place at; those from there on move up by one. */
void mhb_response_place(mhb_response *response, int branch, int at);
/* Append points first..last of a branch of another response of the same shape, in this order: from the
 * last to the first if first > last. Both branches have as many harmonics. SHB_ERR_IO: no memory. */
shb_status mhb_response_copy_points(mhb_response *to, int to_branch, const mhb_response *from,
                                    int from_branch, int first, int last);
/* Drop the branches for which drop is true, [n_branches]; main follows. */
void mhb_response_drop(mhb_response *response, const bool *drop);
/* Further branches after all others, those of one main branch together, in the order in which they were found. */
void mhb_response_sort(mhb_response *response);

/* Take over the branches of other, which is left without; they keep their harmonics.
 * SHB_ERR_INPUT: other pairs, probes or subharmonics. */
shb_status mhb_response_merge(mhb_response *response, mhb_response *other);

/* Publish (temporary, fsync, rename) / read back with full checks. */
shb_status mhb_response_write(const mhb_response *response, const char *path,
                              const shb_provenance *provenance);
shb_status mhb_response_read(const char *path, mhb_response **response);

#endif
