/* What a contact does over a sub-step of the variational equation, and at its transitions. */
#ifndef MHB_VARIATION_VARIATIONAL_LAW_H
#define MHB_VARIATION_VARIATIONAL_LAW_H

#include <stdbool.h>

/* Linearised law of one contact over one sub-step, for y = (dv, sigma) at its start and D:
 *   mean force       mean_y y + mean_du D/2
 *   change of force  df_y y + df_du D
 *   sigma at the end state_y y + state_du D */
typedef struct {
  double mean_y[3][3], mean_du[3][3], df_y[3][3], df_du[3][3]; /* N/m or -, by column of y or D */
  double state_y[2][3], state_du[2][3];
} mhb_linearised_law;

/* Jump at a transition of a contact: sigma = set y. With residual flexibility alpha = measure . y
 * times the workspace's du and dsigma is added to the rows of all contacts. */
typedef struct {
  int    contact;
  bool   stuck; /* from here on */
  double set[2][3], measure[3];
} mhb_saltation;

#endif
