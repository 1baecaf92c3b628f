/* The linearised balance of many contact pairs by GMRES with a low-rank preconditioner:
 *
 *   (I + R P) x + column sigma = rhs,   row . x + corner sigma = rhs_border
 *
 * P: stiffness of the pairs, a block each. With R replaced by X K X^H (contact_basis.h) it is
 *
 *   [ I + T K     X^H P column     ] [ y     ]   [ X^H P rhs              ]
 *   [ - row X K   corner - row.col ] [ sigma ] = [ rhs_border - row . rhs ],   T = X^H P X,
 *   x = rhs - X K y - column sigma                                            (Woodbury's identity)
 *
 * a few dozen unknowns whatever the number of pairs. Bordered it is regular at folds. GMRES removes
 * what the basis leaves out, a factor of about the basis' bound an iteration. R is never formed. */
#ifndef MHB_LOW_RANK_WOODBURY_H
#define MHB_LOW_RANK_WOODBURY_H

#include "mhb/contact/law.h"
#include "mhb/low_rank/contact_basis.h"
#include "mhb/low_rank/gmres.h"

/* Form of a pair's stiffness. */
typedef enum {
  MHB_BLOCK_NONE,   /* 0 */
  MHB_BLOCK_SPRING, /* diag(kv, Ku) of the law; at k = 0 diag(kv, 0) */
  MHB_BLOCK_FULL    /* all harmonics are coupled */
} mhb_block;

enum { MHB_MOST_ITERATIONS = 60 };

typedef struct {
  mhb_receptance_product *product; /* the caller's */
  int                     n3, m, nb, n, n_pairs;
  double                  low, high; /* rad/s */
  mhb_contact_basis      *basis;     /* NULL: none yet, or there is no small one */
  double                 *stiffness; /* [n3] of the basis */
  int                     without;   /* 1: no small basis at that stiffness */
  mhb_gmres              *gmres;

  /* of the system that was factored */
  const mhb_block *form;         /* [pairs] */
  const double    *full;         /* [pair][3 nb][3 nb] */
  const mhb_law   *law;          /* [pair] */
  const double    *column, *row; /* copies [n+1], or NULL */
  int              size;         /* basis->size + 1 with a border */
  int              sign;         /* of the small matrix' determinant */
  int              iterations;   /* of the last solution */
  double           negligible;   /* part of the receptance that this solution leaves out */

  double *border[2]; /* [n+1] copies of column and row */
  double *T, *G;     /* [room][room] */
  double *KX;        /* [size] row X K */
  int    *pivot;
  int     room;           /* rows there is room for */
  double *y, *Ky, *small; /* [room] */
  double *force, *part;   /* [n], [n3][2] */
  double *rows;           /* [room][16 pairs 3 nb] */
  double *turned, *image; /* [3 nb][3 nb in lanes] P of a pair by columns; a column of P X */
  double *solution;       /* [n+1] */

  shb_arena arena, of_basis; /* the arrays; those whose size is that of the basis */
} mhb_woodbury;

/* On a product, which must outlive it; excitation frequencies low..high rad/s. */
mhb_woodbury *mhb_woodbury_create(mhb_receptance_product *product, const mhb_law *law, double low,
                                  double high);
void          mhb_woodbury_destroy(mhb_woodbury *woodbury);

/* Basis and K for these laws at the product's frequency. 0: there is no small basis. Allocates only
 * where the basis is made. */
int mhb_woodbury_prepare(mhb_woodbury *woodbury, const mhb_law *law);

/* Factor at the product's frequency, which is up to date. full, form and law must stay until the
 * last solution. Both borders are NULL or [n+1] with the same corner last. 0: singular, or there is
 * no small basis. Allocates only where the basis is made. */
int mhb_woodbury_factor(mhb_woodbury *woodbury, const mhb_block *form, const double *full,
                        const mhb_law *law, const double *column, const double *row);

/* rhs[n or n+1] <- solution to a residual of tolerance |rhs|. 0: not reached; rhs is as it was. */
int mhb_woodbury_solve(mhb_woodbury *woodbury, double tolerance, double *rhs);

/* Sign of the determinant of the whole system: that of the small one, corrected by the negative
 * Ritz values of the last solution. */
int mhb_woodbury_sign(const mhb_woodbury *woodbury);

#endif
