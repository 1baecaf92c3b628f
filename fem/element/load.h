/* External excitation: one spatial pattern times a complex factor a harmonic.
 * (Plain data here; assembly into PETSc vectors is declared in fem/body/assemble.h, so that the case reader needs no PETSc.) */
#ifndef FEM_ELEMENT_LOAD_H
#define FEM_ELEMENT_LOAD_H

#include <complex.h>
#include <stdbool.h>

enum { FEM_MAX_LOAD_HARMONICS = 64 };

typedef enum { FEM_LOAD_PRESSURE, FEM_LOAD_TRACTION, FEM_LOAD_FORCE, FEM_LOAD_FIELD } fem_load_kind;

typedef struct {
  fem_load_kind kind;
  const char   *group;       /* of faces that pressure and traction act on; NULL: load */
  double        pressure;    /* Pa, on group load; positive pushes into the surface */
  double        traction[3]; /* Pa, mesh axes, on group load */
  double        force[3];    /* N, mesh axes, at the node nearest to at */
  bool          has_at;      /* false: the force acts at the first probe's node */
  double        at[3];       /* m */
  const char            *
      field; /* file of nodal values a harmonic (modal/condense/load_patterns.h); factors do not count then */
  int            n_harmonics; /* K; factor[0..K] */
  double complex factor[FEM_MAX_LOAD_HARMONICS +
                        1]; /* excitation at harmonic k = factor[k] times the pattern */
} fem_load;

#endif
