/* Flexible GMRES without restart (Saad 1993) of a real system A x = b.
 *
 * The preconditioned vectors are kept, so that the solution needs no further product. Each new
 * vector is orthogonalised twice. */
#ifndef MHB_LOW_RANK_GMRES_H
#define MHB_LOW_RANK_GMRES_H

#include "mesh/base/arena.h"
#include "mesh/base/status.h"

/* z[n] <- M^-1 v[n], Az[n] <- A z. 0: failed. */
typedef int (*mhb_gmres_apply)(void *context, const double *v, double *z, double *Az);

typedef struct {
  int       n, most;    /* unknowns; iterations at most */
  int       iterations; /* of the last solution */
  double    residual;   /* |A x - b|/|b| of it, by the recurrence */
  double   *V, *Z;      /* [most + 1][n] orthonormal, [most][n] preconditioned */
  double   *H;          /* [most][most + 1] by columns: A Z = V H */
  double   *R, *g;      /* [most][most + 1] triangular factor of H; [most + 1] */
  double   *c, *s, *y;  /* [most] rotations; coefficients */
  double   *project;    /* [most + 1] */
  double   *wr, *wi;    /* [most] Ritz values */
  shb_arena arena;
} mhb_gmres;

mhb_gmres *mhb_gmres_create(int n, int most);
void       mhb_gmres_destroy(mhb_gmres *gmres);

/* x[size] <- solution to |A x - b| <= tolerance |b|, size <= n. 0: not reached; x is the best
 * then. */
int mhb_gmres_solve(mhb_gmres *gmres, int size, mhb_gmres_apply apply, void *context,
                    const double *b, double tolerance, double *x);

/* Number of negative real Ritz values of A M^-1 in the last solution. These are its negative
 * eigenvalues, as far as the iterations have seen them. */
int mhb_gmres_negative(mhb_gmres *gmres);

#endif
