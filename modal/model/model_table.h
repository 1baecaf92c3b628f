/* The modal model of a blade: its arrays, and the table of their datasets, one row each.
 *
 * Cylindrical axes (tangential x, axial y, radial z) at contact and probe nodes. Contact dofs are
 * ordered c = (side * n_pairs + pair) * 3 + axis, side 0 right, 1 left. Their number is n_contact =
 * 3 n_pairs * (has_left ? 2 : 1).
 *
 * The modes left out contribute residual + omega^2 inertia + omega^4 fourth to every receptance
 * from contact and load to contact and probes. Residual modes add the higher orders
 * (modal/model/residual_series.h). Optional parts are NULL.
 *
 * Writing, reading, checks, copies, fewer modes, fewer pairs and freeing go through the table. A
 * new dataset is a member and a row (docs/developer/extending.md). */
#ifndef MODAL_MODEL_MODEL_TABLE_H
#define MODAL_MODEL_MODEL_TABLE_H

#include <complex.h>
#include <stdbool.h>

#include "modal/hdf5/h5.h"

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

typedef enum {
  MODAL_REAL,  /* double */
  MODAL_SPLIT, /* double; of a travelling wave, the imaginary model has the imaginary parts */
  MODAL_LOAD,  /* double complex; the load of the backward wave has its own */
  MODAL_INDEX, /* int */
  MODAL_NAMES  /* char *, each malloc'ed */
} modal_kind;

typedef enum {
  MODAL_KEPT, /* modes kept, and places */
  MODAL_R,    /* coefficient of omega^0 of the modes left out */
  MODAL_R2,   /* of omega^2 */
  MODAL_R3,   /* of omega^4 */
  MODAL_TAIL, /* what the coefficients and residual modes leave out */
  MODAL_RESIDUAL_MODES,
  MODAL_INTERFACES, /* written for two interfaces or more */
  MODAL_SIDES       /* in the file of both sides, written by the modal stage; the right is kept */
} modal_part;

typedef struct modal_dataset modal_dataset;

/* SHB_ERR_INPUT: the values that were read cannot be. path: in messages. imaginary: NULL: real. */
typedef shb_status (*modal_dataset_check)(const modal_dataset *row, const char *path,
                                          const modal_model *model, const modal_model *imaginary);

/* Each letter of dims names a dimension, a digit is its size:
 *
 *   m  modes              p  pairs           l  pairs with a left side
 *   k  load harmonics     q  probes          Q  probe dofs, 3 q
 *   r  residual modes     c  contact dofs    i  contact interfaces */
struct modal_dataset {
  const char         *path, *dims;
  modal_kind          kind;
  modal_part          part;
  size_t              offset; /* of the array in modal_model */
  const char         *units, *long_name;
  const char         *with;     /* must be there where this is; ".": always; NULL: optional */
  bool                zeros;    /* optional, and zero where a file with residual modes lacks it */
  const char         *backward; /* long name of the backward wave's; NULL: that it is as this one */
  modal_dataset_check check;
};

/* In the order in which they are written. The last has no path. */
extern const modal_dataset modal_datasets[];

/* A size of a model that the first dimension of a dataset gives. */
typedef struct {
  char        letter;
  const char *path, *noun;
  int         least, most;
  const char *note;   /* ends the message; NULL: nothing */
  size_t      offset; /* of the number in modal_model */
  int         beyond; /* what the dataset holds more */
} modal_size;

/* In the order in which they are read. The last has no path. */
extern const modal_size modal_sizes[];

hsize_t modal_size_of(const modal_model *model, char letter);
/* Shape of the array of a model with these sizes; without elements where one of them is 0. */
h5_shape modal_dataset_shape(const modal_dataset *row, const modal_model *sizes);
size_t   modal_dataset_count(const modal_dataset *row, const modal_model *sizes);
size_t   modal_dataset_width(const modal_dataset *row); /* bytes of an element */
/* Dataset that labels a dimension; NULL: none. */
const char *modal_scale_of(char letter);

void *modal_dataset_get(const modal_dataset *row, const modal_model *model);
void  modal_dataset_set(const modal_dataset *row, modal_model *model, void *data);
void  modal_dataset_free(const modal_dataset *row, modal_model *model); /* NULL afterwards */

/* A copy of the array, of a model with these sizes; NULL: there is none. */
void *modal_dataset_copy(const modal_dataset *row, const modal_model *sizes,
                         const modal_model *model);

/* Allocate the arrays of the modes and, of a body with contact, those of the modes left out, as
 * zeros. Coriolis terms, residual modes and arrays of a contact or a side that is not there stay
 * NULL.
 *
 *   model                in out  its sizes
 *   imaginary, backward  out     of a travelling wave; NULL: real */
void modal_model_allocate(modal_model *model, modal_model *imaginary, modal_model *backward);

/* A model of the same sizes without arrays. */
modal_model modal_model_sizes(const modal_model *model);

/* Copy the arrays to a model of these sizes, or of fewer load harmonics, or without probes.
 *
 *   copy  in   its sizes */
void modal_model_copy(const modal_model *model, modal_model *copy);

/* Whether the row is one of the terms R, R2 and R3. */
bool modal_dataset_is_term(const modal_dataset *row);

/* Whether it is a term or a tail. */
bool modal_dataset_is_residual(const modal_dataset *row);

#endif
