/* Worst places of the blade at one point of a response: stresses over a period, Goodman's line. */
#ifndef POSTPROC_FIELD_PEAK_STRESS_H
#define POSTPROC_FIELD_PEAK_STRESS_H

#include "postproc/field/blade_field.h"

enum { POST_PLACES = 10 };

/* Goodman's line in the diagram of Haigh; endurance 0: not given. */
typedef struct {
  double endurance, ultimate; /* Pa: amplitude borne without mean stress; tensile strength */
} post_goodman;

/* Of the whole body, or with several materials of each node. */
typedef struct {
  double              endurance, ultimate; /* of the body; not used with regions */
  const int          *region;              /* [node] its material, or NULL */
  int                 n_regions;
  const post_goodman *of; /* [n_regions] */
} post_fatigue;

/* Whether any material has a line. */
bool post_fatigue_given(const post_fatigue *fatigue);

/* Of the vibration alone (harmonics from 1 on) but for mean. The signed von Mises stress has the
 * sign of the principal stress of greatest modulus. */
typedef struct {
  int    node;
  double amplitude; /* Pa, half the range of the signed von Mises stress over a period */
  double principal; /* Pa, greatest modulus of a principal stress in a period */
  double mean;      /* Pa, signed von Mises stress of static stress and harmonic 0 */
  double safety;    /* 1/(amplitude/endurance + max(mean, 0)/ultimate); NAN without a line there */
} post_worst_place;

/* The worst places, by safety, or by amplitude where no material has a line. *n is at most
 * POST_PLACES. A place is no nearer to a worse one than 5 % of the greatest dimension of the blade.
 *
 * A bound of each node's amplitude decides which nodes are looked at, so no node is missed. A
 * period is sampled at 24 instants of the highest harmonic above 1e-3 of the node's largest, at
 * least 64. Each extreme is then refined by golden section. Harmonics below 1e-6 are left out. The
 * signed stress jumps where its sign changes: an amplitude there errs by 1e-3.
 *   stress  in  as of post_blade_stress
 * Errors: SHB_ERR_IO no memory. */
shb_status post_peak_stress(const post_blade_field *field, int n_harmonics, const double *stress,
                            const post_fatigue *fatigue, post_worst_place place[POST_PLACES],
                            int *n);

/* The same at a kept point, from its amplitudes. Errors: SHB_ERR_IO no memory. */
shb_status post_worst_places(const post_blade_field *field, const mhb_branch *branch, int kept,
                             const post_fatigue *fatigue, post_worst_place place[POST_PLACES],
                             int *n);

/* Signed von Mises stress; greatest modulus of its principal stresses. Pa. */
double post_signed_mises(const double stress[POST_STRESSES]);
double post_greatest_principal(const double stress[POST_STRESSES]);

#endif
