/* Modal model of one blade and its file: the structural data of the harmonic balance. Free of
 * PETSc.
 *
 * Cylindrical axes (tangential x, axial y, radial z) at contact and probe nodes. Contact dofs are
 * ordered c = (side * n_pairs + pair) * 3 + axis, side 0 right, 1 left. Their number is n_contact =
 * 3 n_pairs * (has_left ? 2 : 1).
 *
 * The modes left out contribute residual + omega^2 inertia + omega^4 fourth to every receptance
 * from contact and load to contact and probes. Residual modes add the higher orders
 * (modal/model/residual_series.h). Optional parts are NULL. */
#ifndef MODAL_MODEL_MODEL_H
#define MODAL_MODEL_MODEL_H

#include <complex.h>
#include <stdbool.h>

#include "modal/hdf5/h5.h"

/* Version of the file format with nodal diameters (nodal_diameters.h), and the newest that is
 * read. */
enum { MODAL_DIAMETERS_VERSION = 3, MODAL_NEWEST = MODAL_DIAMETERS_VERSION };

typedef struct {
  int     n_modes, n_pairs, n_probes, n_load; /* n_load = K: load harmonics 0..K */
  int     n_interfaces;                       /* 0: one, without a name */
  char  **interface_name;                     /* [n_interfaces] */
  int    *interface;                          /* [pair] which one; NULL without */
  bool    has_left;                           /* false: contact to ground */
  double *frequency;                          /* [m] Hz */
  double *damping_ratio;                      /* [m] */
  double *coriolis;     /* [m][m] 1/s, phi^T G phi at the rotor speed: skew-symmetric; NULL: none */
  double *right, *left; /* [pair][3][m] kg^-1/2 */
  double *residual_flexibility; /* [n_contact][n_contact] m/N, or NULL */
  double *residual_inertia;     /* [n_contact][n_contact] m s2/N, or NULL: coefficient of omega^2 */
  double *residual_fourth;      /* [n_contact][n_contact] m s4/N, or NULL: coefficient of omega^4 */
  /* [term][n_contact] of R, R2, R3: a contact dof with itself, where matrices are released; NULL:
   * none is */
  double         *residual_diagonal;
  int             n_residual; /* residual modes that stand for the modes left out; 0: none */
  double         *residual_frequency; /* [r] Hz, ascending */
  double         *residual_shape;     /* [n_contact][r] kg^-1/2 */
  double complex *residual_force;     /* [K+1][r] N kg^-1/2 */
  double         *residual_probe;     /* [3 q][r] kg^-1/2 */
  /* Order r of the tail a w^2r + b w^(2r+2) + ... that terms and residual modes leave out. */
  int             tail_order;
  double         *contact_tail;  /* [n_contact][2] a, b of a contact dof with itself, or NULL */
  double         *load_tail;     /* [K+1][2] of a load harmonic, or NULL */
  double complex *modal_force;   /* [K+1][m] N kg^-1/2 */
  double complex *load_residual; /* /load/residual_response [K+1][n_contact] m, or NULL */
  double complex *load_inertia;  /* /load/residual_inertia [K+1][n_contact] m s2, or NULL */
  double complex *load_fourth;   /* /load/residual_fourth [K+1][n_contact] m s4, or NULL */
  char          **probe_name;    /* [q] */
  double         *probe;         /* [q][3][m] kg^-1/2 */
  double         *probe_contact_residual; /* [3 q][n_contact] m/N, or NULL */
  double complex *probe_load_residual;    /* [K+1][3 q] m, or NULL */
  double         *probe_contact_inertia;  /* [3 q][n_contact] m s2/N, or NULL */
  double complex *probe_load_inertia;     /* [K+1][3 q] m s2, or NULL */
  double         *probe_contact_fourth;   /* [3 q][n_contact] m s4/N, or NULL */
  double complex *probe_load_fourth;      /* [K+1][3 q] m s4, or NULL */
  double         *normal;         /* [pair][3] v axis in the pair's cylindrical axes, or NULL */
  double         *area;           /* [pair] m2, or NULL */
  double         *position;       /* [pair][3] m, of the right side, mesh axes, or NULL */
  double         *eigen_residual; /* [m] relative eigen residual, or NULL */
} modal_model;

/* Number of contact dofs, 3 n_pairs for each side. */
int modal_model_contact_dofs(const modal_model *model);

/* Whether harmonic k of the load moves a mode. */
bool modal_model_is_driven(const modal_model *model, int k);

/* Write the datasets of docs/user/files.md into an open file, with the attributes format and
 * provenance. */
shb_status modal_model_write(hid_t file, const modal_model *model,
                             const shb_provenance *provenance);

/* The same datasets in a group of an open file, without attributes. */
shb_status modal_model_write_at(hid_t at, const modal_model *model);

/* Read the datasets from a group; path names it in messages. model is zeroed before the call and
 * freed by the caller in any case. */
shb_status modal_model_read_at(hid_t at, const char *path, modal_model *model);

/* Both for a travelling wave, whose shapes and residual terms are complex. imaginary holds the
 * imaginary parts of shapes, residual terms and residual modes at contact and probes. The rest of
 * it is NULL, its sizes are 0. NULL: real. */
shb_status modal_model_write_complex_at(hid_t at, const modal_model *model,
                                        const modal_model *imaginary);
shb_status modal_model_read_complex_at(hid_t at, const char *path, modal_model *model,
                                       modal_model *imaginary);

/* Read complex data whose imaginary parts must vanish. SHB_ERR_INPUT: one does not. */
shb_status modal_model_read_real_at(hid_t at, const char *path, modal_model *model);

/* The response to the load, of the model's sizes: its datasets below the group backward. */
shb_status modal_model_write_backward_at(hid_t at, const modal_model *model,
                                         const modal_model *loads);
/* loads <- from there; without the group the conjugate of the model's own load. loads is zeroed
 * before the call and freed by the caller in any case. */
shb_status modal_model_read_backward_at(hid_t at, const modal_model *model, modal_model *loads);

/* Read and check a modal file, whatever program wrote it; of nodal diameters, that of 0. Errors:
 * SHB_ERR_IO missing, not HDF5, or truncated; SHB_ERR_INPUT foreign format, missing dataset, wrong
 * shape, value not finite, frequency not positive or descending, damping outside [0, 1). */
shb_status modal_model_read(const char *path, modal_model *model);

/* Free the residual matrices from a term on (0 R, 1 R2, 2 R3). Their diagonals are kept, for the
 * error estimate of the series. All that is made of the matrices must be made before. Nothing
 * happens without all three of them. SHB_ERR_IO: no memory; the model is as before. */
shb_status modal_model_release_terms(modal_model *model, int first);

void modal_model_free(modal_model *model);

#endif
