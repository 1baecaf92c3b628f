/* The response file NAME.response.h5: what the harmonic balance found, branch by branch. */
#ifndef MHB_RESPONSE_H
#define MHB_RESPONSE_H

#include <complex.h>
#include <stdbool.h>

#include "mesh/publish.h"
#include "mesh/status.h"

typedef enum { MHB_BRANCH_NONLINEAR, MHB_BRANCH_OPEN, MHB_BRANCH_STUCK } mhb_branch_kind;

/* One curve. Array layouts: motion, force [point][pair][3 (v,u,w)][k = 0..m]; probe [point][probe][3 (tangential,
 * axial, radial)][k]; state [point][pair][3 (stuck, slipping, open)]; signals x(t) = Re sum_k A_k exp(j k w t). */
typedef struct {
  mhb_branch_kind kind;
  char           *reason;   /* how the branch ended: "end of range", or why not */
  bool            complete; /* the range was covered */
  int             n_points, capacity;
  double         *frequency; /* [point] Hz, of the excitation's first harmonic */
  double         *n0;        /* [point] N, total of the interface */
  double complex *motion, *force, *probe;
  int            *stable; /* [point] 1 stable, 0 unstable, -1 not known */
  int *
      special; /* [point] 0 ordinary, 1 fold, 2 peak (of any probe or contact motion, first harmonic) */
  double *state;
  double *dissipation; /* [point][pair] J a cycle */
  int    *iterations;  /* [point] */
  double *seconds;     /* [point] */
  double *error_newton, *error_truncation, *error_sampling,
      *error_modal; /* [point] relative to the motion's norm */
} mhb_branch;

typedef struct {
  int         n_pairs, n_probes, n_harmonics, subharmonics, n_branches, capacity;
  char      **probe_name;
  mhb_branch *branch;
  /* copied from the modal model for the report */
  int     n_modes;
  double *mode_frequency, *mode_damping, *mode_residual; /* [m]; mode_residual may be NULL */
  int     engine_order, blades;
  double  psi, phi; /* rad, mean of the pairs */
} mhb_response;

mhb_response *mhb_response_create(int n_pairs, int n_probes, int n_harmonics); /* NULL: no memory */
void          mhb_response_destroy(mhb_response *response);

/* Append an empty branch; its index through *index. */
shb_status mhb_response_branch(mhb_response *response, mhb_branch_kind kind, int *index);
/* Make room for one more point (zeroed) and return its index through *point; branch arrays may move. */
shb_status mhb_response_point(mhb_response *response, int branch, int *point);

/* Publish (temporary, fsync, rename) / read back with full checks. */
shb_status mhb_response_write(const mhb_response *response, const char *path,
                              const shb_provenance *provenance);
shb_status mhb_response_read(const char *path, mhb_response **response);

#endif
