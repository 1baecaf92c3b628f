/* Stress and motion of the blade at every node, from the modal file and the amplitudes of a
 * response. */
#ifndef POSTPROC_FIELD_BLADE_FIELD_H
#define POSTPROC_FIELD_BLADE_FIELD_H

#include <complex.h>

#include "mesh/core/fe_mesh.h"
#include "mhb/response/response.h"

/* Components xx, yy, zz, xy, yz, xz. */
enum { POST_STRESSES = 6 };

/* Fields of one nodal diameter of a disc, as those of a blade below; all NULL where no harmonic of
 * the response has it. */
typedef struct {
  double complex *stress, *residual;
  double complex *shape, *residual_shape; /* with motion */
  double         *frequency;              /* [n_modes] Hz */
} post_wave_field;

/* Of a disc the fields are those of one sector. They are in wave, and stress, residual, shape and
 * residual_shape are NULL. */
typedef struct {
  int             n_nodes, n_modes;    /* n_nodes = 0: the file has no stresses */
  int             n_contact, n_column; /* columns of /residual: contact dofs, load patterns */
  int             n_load;              /* K: load harmonics 0..K */
  double         *nodes;               /* [n][3] m */
  double         *stress;              /* [n_modes][n][6] Pa kg^-1/2 */
  double         *residual;            /* [n_column][n][6] Pa/N */
  double complex *load_weight;         /* [K + 1][n_column - n_contact] */
  double         *static_stress;       /* [n][6] Pa; NULL at rest */
  /* of a disc; they come with post_blade_field_match */
  int              n_waves;      /* nodal diameters in the file; 0: a blade without a disc */
  int              blades;       /* N */
  int              engine_order; /* of the response */
  bool             turns_right;  /* its rotor */
  int             *diameter;     /* [n_waves] */
  post_wave_field *wave;         /* [n_waves] */
  bool             motion;       /* whether shapes are wanted */
  /* only of post_blade_field_read_motion */
  mesh_fe mesh;                /* kind, elements and nodes; owns the connectivity only */
  double *shape;               /* [n_modes][n][3] kg^-1/2 */
  double *residual_shape;      /* [n_column][n][3] m/N */
  double *static_displacement; /* [n][3] m; NULL at rest */
} post_blade_field;

/* Read the modal file. Files of other programs have no stresses: n_nodes is 0. Errors: those of
 * h5_open and h5_read_double. To be freed in any case. */
shb_status post_blade_field_read(const char *path, post_blade_field *field);
/* The same with shapes and elements. */
shb_status post_blade_field_read_motion(const char *path, post_blade_field *field);
void       post_blade_field_free(post_blade_field *field); /* also on a zeroed struct */

/* SHB_ERR_INPUT unless the response has as many modes and contact dofs as the field. Of a disc, the
 * nodal diameters that its kept points need are read from the modal file at path. Errors: those of
 * h5_open and h5_read_complex too. */
shb_status post_blade_field_match(post_blade_field *field, const mhb_response *response,
                                  const char *path);

/* Read the modes of nodal diameter n from the modal file at path, without the residual columns. It
 * must be one of field->diameter. Errors: those of h5_open and h5_read_complex. */
shb_status post_blade_field_read_wave(post_blade_field *field, const char *path, int n);

/* Index in field->wave of the nodal diameter of harmonic k of a branch. -1: the file lacks it. Of a
 * blade without a disc it is 0. *backward: the harmonic has the conjugate fields. */
int post_blade_wave(const post_blade_field *field, const mhb_branch *branch, int k, bool *backward);

/* The highest harmonic in which anything moves at a kept point. */
int post_blade_harmonics(const mhb_branch *branch, int n_modes, int kept);

/* Harmonics 0..m of the stress at a kept point: out[2 k + (0 real, 1 imaginary)][n][6] Pa, without
 * the static stress; m as of post_blade_harmonics. Errors: SHB_ERR_IO no memory. */
shb_status post_blade_stress(const post_blade_field *field, const mhb_branch *branch, int kept,
                             double *out);
/* The same of the displacement, [..][n][3] m in mesh axes; needs post_blade_field_read_motion. */
shb_status post_blade_displacement(const post_blade_field *field, const mhb_branch *branch,
                                   int kept, double *out);

/* force[n_column] <- what the residual columns are multiplied by at harmonic k, N. */
void post_blade_forces(const post_blade_field *field, const mhb_branch *branch, int kept, int k,
                       double complex *force);

/* Which of n volumes by name each node belongs to; of several the stiffest, whose stress the node
 * has.
 *   region  out  [n_nodes] malloc'ed; NULL if the file has one material, or not these volumes
 * Errors: those of h5_read_int. */
shb_status post_blade_regions(const char *path, int n_nodes, int n, const char *const *name,
                              const double *stiffness, int **region);

#endif
