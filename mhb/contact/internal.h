/* The workspace of the contact law, private to the modules that make it up: contact (entry), slider
 * (one period), sensitivity (the derivative), force_integrals, time_history.
 *
 * Derivative columns are the coefficients of v, u, w, nb = 2m+1 each, then one for the slider at
 * the start of a lap. One is enough. Where slip begins, the slider's change (dz_1, dz_2) enters by
 * one number, v.dz. All that follows in the lap is proportional to it. */
#ifndef MHB_CONTACT_INTERNAL_H
#define MHB_CONTACT_INTERNAL_H

#include "mesh/base/arena.h"
#include "mhb/contact/contact.h"
#include "mhb/contact/dense_output.h"
#include "mhb/contact/slip.h"
#include "mhb/contact/static_friction.h"
#include "mhb/contact/transitions.h"
#include "mhb/numerics/fourier.h"

typedef enum { MHB_NO_COLUMNS, MHB_SLIDER_COLUMN, MHB_ALL_COLUMNS } mhb_sensitivity_mode;

/* The derivative of a lap by the slider z at its start. */
typedef struct {
  int    slipped;  /* 0: no slip yet, dz is the identity */
  double v[2];     /* dtheta at the first slip is v.dz */
  double work;     /* change of the slip work by v.dz */
  double onset[2]; /* the same by dz, at the first slip */
} mhb_slider_sensitivity;

/* Forces are in units of `scale`. sums = 2(H+m)+1, the basis of products of force and motion. */
struct mhb_contact_evaluator {
  int                   m, H, nb, nf;  /* harmonics of motion and force; nb = 2m+1, nf = 2H+1 */
  int                   slider_column; /* 3 nb */
  int                   stride;        /* columns, rounded up to lanes */
  double                tolerance;
  mhb_signals           signals; /* (n, x_1, x_2) */
  mhb_collocation       rule;
  mhb_slip              slip;
  mhb_panel             panel;
  mhb_contact_intervals intervals;
  mhb_static_friction   static_friction; /* of a contact that stays closed */
  double                scale;           /* force scale, N */
  double                K[2][2];         /* Ku/scale */
  double                kv;              /* kv/scale */
  double                force_level; /* max(mean normal load, friction_level): errors refer to it */
  double                friction_level; /* min(mu mean normal load, swing of x) */
  double                mean_harmonic;  /* of the motion, weighted by amplitude */
  double               *coefficients;   /* [3][nb] of (n, x_1, x_2) */
  /* integrals over the recorded lap */
  mhb_lanes *slip_sums;       /* [nf][4] slip: friction times basis, and its change by v.dz */
  mhb_lanes *load_sums;       /* [sums][2] slip: mu kv e times basis */
  double    *f;               /* [2][nf] friction times basis */
  double    *f_slider;        /* [2][nf] its change by v.dz */
  double    *first_stick;     /* [sums] basis, until the first slip */
  double    *stick_integrals; /* [sums] basis, over all stick pieces */
  double    *basis_integrals; /* [sums] basis, over one piece */
  double    *basis_products;  /* [nf][nb] */
  double    *J;               /* [2][nf][stride] derivative of f */
  double     squared_error;   /* sum of the squares of the panels' errors */
  /* derivatives of the state */
  mhb_sensitivity_mode   mode;
  mhb_slider_sensitivity lap;
  double                *Z[2];    /* [stride] of the slider while stuck */
  double                *T;       /* [stride] of theta while slipping */
  double                *rhs;     /* [nodes][stride + MHB_LANES] of the linearised slip equation */
  double                *T_nodes; /* [nodes][stride] T at the nodes of a panel */
  mhb_lanes             *node_basis;  /* [sums], then [2][nf] times mu n w q */
  double                *event_basis; /* [2][nb] basis and slope at an event */
  /* results */
  int               record; /* this lap's force is wanted */
  mhb_contact_info *info;
  mhb_dense_output  dense_output;  /* of the recorded lap */
  double           *history_force; /* [3][nf] force of a time history */
  shb_arena         arena;
};

#endif
