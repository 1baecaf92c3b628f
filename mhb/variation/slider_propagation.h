/* The sub-step of variational.h for a blade on the ground with many contacts. Only those that slip
 * or are open take work.
 *
 * The states of a column are q, v and the slider forces z = K u - p of stuck_springs.h. While a
 * contact sticks its z does not change, so the contact is a spring of the structure. Let A be the
 * contacts that slip or are open, D the change of u over a sub-step and t that of z:
 *   t = (K - df_du) D - df_y y on A,   D = L~ a + S t,
 *   a = dq_free - E L^T P,   L^T P = L^T K L~ (q + a/2) - L~^T z + (L - L~)^T t/2
 *                                    + L^T (mean_y y - K u + z + (mean_du - K) D/2) on A.
 * Without a, D on A follows from a system of three unknowns a contact. The result is that of
 * variational.h but for rounding. */
#ifndef MHB_VARIATION_SLIDER_PROPAGATION_H
#define MHB_VARIATION_SLIDER_PROPAGATION_H

#include "mhb/variation/stuck_springs.h"
#include "mhb/variation/variational_law.h"

typedef struct {
  const mhb_stuck_springs *springs;
  int                      columns, width; /* in use; length of a row */
  int                      capacity;       /* greatest width */
  /* rows, all [width]: */
  double   *Y;    /* q [m] | v [m] | u [n] | sigma [2 contacts]; the latter two of contacts in A */
  double   *z;    /* [n] */
  double   *held; /* [n] force of a stuck contact less K u - z: what its sub-steps of slip erred */
  double   *g;    /* [m] L~^T z - L^T held */
  int       n_active, *active; /* A, ascending */
  bool     *is_active;         /* [contact] */
  bool      gathered;          /* the copies below are those of A */
  double   *stuck;             /* [3 active][m] rows of L~ */
  double   *answer;            /* [2][3 active][m] rows of L, of -(L - L~)/2 */
  double   *slider;            /* [3 active][3 active] of S */
  double   *system;            /* [3 active][3 active], factored */
  int      *pivot;
  double   *feedback;   /* [3 active][m] transposed: a -= feedback^T D */
  double   *laws;       /* [3 active][m] scratch */
  double    h;          /* s; negative: none */
  double   *propagator; /* [m][PROPAGATOR] */
  double   *inverse;    /* [m][m] (I + E L^T K L~/2)^-1 */
  double   *half;       /* [m][m] inverse E/2 */
  double   *work;       /* [3 m + 9 contacts + 3][width] */
  shb_arena arena;
} mhb_slider_propagation;

/* Room for capacity columns. The springs must outlive it. */
mhb_slider_propagation *mhb_slider_propagation_create(const mhb_stuck_springs *springs,
                                                      int                      capacity);
void                    mhb_slider_propagation_destroy(mhb_slider_propagation *propagation);

/* All rows zero, for a number of columns. */
void mhb_slider_propagation_clear(mhb_slider_propagation *propagation, int columns);

/* The columns are set: q, v, u and sigma of all contacts, and their forces by u and sigma.
 *   is_stuck  in  [contact]
 *   of_u, of_sigma  in  [contact][3][3], [contact][3][2] of the force */
void mhb_slider_propagation_begin(mhb_slider_propagation *propagation, const bool *is_stuck,
                                  const double (*of_u)[3][3], const double (*of_sigma)[3][2]);

/* Sub-steps of h seconds from here on. Returns 0 if singular. */
int mhb_slider_propagation_set_step(mhb_slider_propagation *propagation, double h);

/* Factor the system of A for the linearised laws [contact]. Returns 0 if singular. */
int mhb_slider_propagation_factor(mhb_slider_propagation   *propagation,
                                  const mhb_linearised_law *linearised);

/* One sub-step of all columns. */
void mhb_slider_propagation_step(mhb_slider_propagation   *propagation,
                                 const mhb_linearised_law *linearised);

/* A transition of a contact. du, dsigma, dp as in variational.h. */
void mhb_slider_propagation_jump(mhb_slider_propagation *propagation, const mhb_saltation *jump,
                                 const double *du, const double *dsigma, const double *dp);

/* sigma of all contacts is valid after this. */
void mhb_slider_propagation_finish(mhb_slider_propagation *propagation);

#endif
