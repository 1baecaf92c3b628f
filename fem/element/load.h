/* External excitation: one spatial pattern times a complex factor a harmonic.
 *
 * Plain data without PETSc, as the case reader needs it. */
#ifndef FEM_ELEMENT_LOAD_H
#define FEM_ELEMENT_LOAD_H

#include <complex.h>
#include <stdbool.h>

enum { FEM_MAX_LOAD_HARMONICS = 64 };

typedef enum { FEM_LOAD_PRESSURE, FEM_LOAD_TRACTION, FEM_LOAD_FORCE, FEM_LOAD_FIELD } fem_load_kind;

typedef struct {
  fem_load_kind  kind;
  const char    *group;       /* faces of pressure and traction; NULL: group load */
  double         pressure;    /* Pa, positive pushes into the surface */
  double         traction[3]; /* Pa, mesh axes */
  double         force[3];    /* N, mesh axes, at the node nearest to at */
  bool           has_at;      /* false: the force acts at the first probe's node */
  double         at[3];       /* m */
  const char    *field;       /* file of nodal values; factor is then unused */
  int            n_harmonics; /* K; factor[0..K] */
  double complex factor[FEM_MAX_LOAD_HARMONICS +
                        1]; /* excitation at harmonic k = factor[k] times the pattern */
} fem_load;

#endif
