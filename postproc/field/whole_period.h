/* Motion and stress of every node at any instant of the period of one kept point, for any blade of
 * the ring. */
#ifndef POSTPROC_FIELD_WHOLE_PERIOD_H
#define POSTPROC_FIELD_WHOLE_PERIOD_H

#include "mesh/base/axes.h"
#include "postproc/field/blade_field.h"

/* Blade b of the ring is blade 0 turned by 2 pi b/N about the engine axis. Its harmonic k lags by
 * b k phi/nu (mhb/structure/receptance.h). Displacements, stresses and static parts turn with
 * it. */
typedef struct {
  const post_blade_field *field;
  int                     branch, point;  /* of the response; -1: of a mode */
  int                     mode, diameter; /* of the modal file, from 1, and its nodal diameter, -1
                                           * without a disc; mode 0: a point of the response */
  int                     n_harmonics;    /* the highest that moves */
  int                     order;          /* nu: the motion repeats after nu excitation periods */
  double                  frequency;      /* Hz, of the excitation */
  bool                    closes;         /* the wave around the ring; else only blade 0 counts */
  double                  lag;            /* rad, of the right neighbour at harmonic 1 */
  int                     engine_order, blades;
  bool                    turns_right; /* the rotor */
  mesh_axis               axis;
  double                 *displacement; /* [2 k + (0 real, 1 imaginary)][n][3] m, mesh axes */
  double                 *stress;       /* [2 k + part][n][6] Pa */
} post_period;

/* The point response->branch[branch].modal.point[kept]. The field must outlive the period. Errors:
 * SHB_ERR_IO no memory. */
shb_status post_period_create(const post_blade_field *field, const mhb_response *response,
                              int branch, int kept, mesh_axis axis, post_period *period);
/* Free vibration in a mode, such that the greatest displacement of a node is `size`, m. Of a disc
 * it is the wave of a nodal diameter that runs forwards.
 *   mode       in  from 1
 *   diameter   in  of a disc, one of field->diameter that was read; else -1
 *   frequency  in  Hz */
shb_status post_period_of_mode(const post_blade_field *field, int mode, int diameter,
                               double frequency, double size, mesh_axis axis, post_period *period);
void       post_period_free(post_period *period); /* also on a zeroed struct */

/* s, after which the motion repeats. */
double post_period_seconds(const post_period *period);
/* rad, of harmonic k of a blade against blade 0. */
double post_period_lag(const post_period *period, int blade, int k);

/* The vibration with its mean, without the static part at speed.
 *   instant       in   0..1 of the period
 *   displacement  out  [n][3] m
 *   stress        out  [n][6] Pa; may be NULL */
void post_period_at(const post_period *period, int blade, double instant, double *displacement,
                    double *stress);

/* Turn vectors [n][3] or stresses [n][6] from blade 0 to a blade, in place. */
void post_period_turn_vectors(const post_period *period, int blade, int n, double *vectors);
void post_period_turn_stresses(const post_period *period, int blade, int n, double *stresses);

/* Over so many instants.
 *   largest                out  [n] greatest von Mises stress of the vibration with its mean, Pa
 *   greatest_displacement  out  of any node from its mean, m
 * SHB_ERR_IO: no memory. */
shb_status post_period_extremes(const post_period *period, int instants, double *largest,
                                double *greatest_displacement);

#endif
