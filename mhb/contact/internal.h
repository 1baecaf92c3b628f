/* The workspace of the contact law, for the files that make it up: contact (entry and assembly), lap (the slider through
 * one period), columns (its derivative). Nobody else includes this.
 *
 * Derivative columns are the coefficients of v, u, w, nb = 2m+1 each, then one for the slider at the start of a lap that
 * never opens. One is enough: where slip begins, the slider's change (dz_1, dz_2) enters by one number, v.dz, and all
 * that follows in the lap is proportional to it. */
#ifndef MHB_CONTACT_INTERNAL_H
#define MHB_CONTACT_INTERNAL_H

#include "mhb/contact/contact.h"
#include "mhb/contact/dense_output.h"
#include "mhb/contact/slip.h"
#include "mhb/contact/static_friction.h"
#include "mhb/contact/transitions.h"
#include "mhb/numerics/fourier.h"

typedef enum { MHB_NO_COLUMNS, MHB_SLIDER_COLUMN, MHB_ALL_COLUMNS } mhb_sensitivity_mode;

/* The slider's own derivative in a lap. */
typedef struct {
  int    slipped; /* 0: still the identity */
  double v[2];    /* dtheta at the first slip of the lap is v.dz */
  double work;    /* change of the slip work by v.dz, and before that by dz itself */
  double onset[2];
} mhb_slider_sensitivity;

struct mhb_contact_evaluator {
  int                   m, H, nb, nf; /* nb = 2m+1, nf = 2H+1 */
  int                   slider;       /* the slider's column, 3 nb */
  int                   stride;       /* columns, rounded up to lanes */
  double                tolerance;
  mhb_signals           signals;
  mhb_collocation       rule;
  mhb_slip              slip;
  mhb_panel             panel;
  mhb_contact_intervals closed;
  mhb_static_friction   stuck;   /* of a contact that stays closed */
  double                scale;   /* force scale, N */
  double                K[2][2]; /* Ku/scale */
  double                kv;      /* kv/scale */
  double  force; /* the mean normal load or the friction it allows: what errors are relative to */
  double  friction; /* the friction it allows, or all the motion can do; both in units of scale */
  double  content;  /* harmonic that stands for the motion's, amplitude weighted */
  double *scaled;   /* [3][nb] coefficients of (n, x_1, x_2) */
  mhb_lanes
      *sum; /* [nf][4] slip: integrals of friction times basis, and their change by the slider */
  mhb_lanes           *load;     /* [2(H+m)+1][2] slip: integrals of mu kv e times basis */
  double              *f;        /* [2][nf] integrals of friction times basis */
  double              *f_slider; /* [2][nf] their change by v.dz */
  double              *first; /* [2(H+m)+1] integrals of the basis until the first slip of a lap */
  double              *stick; /* [2(H+m)+1] the same over all stick pieces */
  double              *piece; /* the same, one piece */
  double              *product;    /* [nf][nb] */
  double              *J;          /* [2][nf][stride] */
  double              *Z[2];       /* [stride] derivative of the slider while stuck */
  double              *T;          /* [stride] derivative of theta while slipping */
  double              *drive;      /* [nodes][stride] of the linearised slip equation */
  double              *node_T;     /* [nodes][stride] */
  mhb_lanes           *node_basis; /* [nf], then [2][nf] weighted by the direction across */
  double              *basis0;     /* [2][nb] basis and slope at an event */
  mhb_sensitivity_mode columns;
  mhb_slider_sensitivity memory;
  int                    record;  /* this lap's force is wanted */
  double                 squares; /* sum of the squares of the panels' errors */
  mhb_contact_info      *info;
  mhb_dense_output       pieces; /* of the recorded lap, for a trace */
  double                *traced; /* [3][nf] force of a trace */
};

#endif
