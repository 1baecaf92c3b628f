/* A sector of few dofs, and its matrices at a nodal diameter dense. */
#ifndef TESTS_SUPPORT_SMALL_WAVE_H
#define TESTS_SUPPORT_SMALL_WAVE_H

#include "modal/condense/condense.h"
#include "modal/cyclic/wave_modes.h"

enum { SMALL_BLADES = 6 };

/* A leaning annular sector about the x axis of two layers of hexahedra; its inner face is clamped.
 * Shapes at nodal diameters 1 and 2 are complex. */
typedef struct {
  mesh_fe              mesh;
  fem_element         *element;
  fem_body             body;
  fem_system           system;
  fem_sector           sector;
  fem_hermitian_order *order;
} small_sector;

/* Within a modal session (modal/common/session.h). */
void small_sector_create(small_sector *s);
void small_sector_free(small_sector *s);

/* Matrices [n][n] by columns. */
typedef struct {
  int             n, nodal; /* nodal: 3 n_nodes */
  double complex  phase;    /* e^(-j theta) */
  double complex *C;        /* [n][nodal] motion of all nodes by dofs */
  double complex *K, *M;    /* C^H K C of the formula in fem/body/sector.h, and C^H M C */
  double         *lambda;   /* [n] of K phi = lambda M phi, ascending */
  double complex *phi;      /* [n][n], phi^H M phi = 1 */
} dense_wave;

void dense_wave_create(const small_sector *s, int diameter, dense_wave *w);
void dense_wave_free(dense_wave *w);

/* Y = A X of count columns, A [n][n] by columns. */
void dense_multiply(int n, const double complex *A, int count, const double complex *X,
                    double complex *Y);

/* X = K^-1 X of count columns. */
void dense_wave_solve(const dense_wave *w, int count, double complex *X);

/* X -= phi phi^H M X of the lowest modes. */
void dense_wave_project_out(const dense_wave *w, int modes, int count, double complex *X);

/* Complex random numbers. To be freed. */
double complex *random_complex(size_t n, uint64_t seed);

/* Greatest |a - b| over the greatest |b|. */
double complex_difference(size_t n, const double complex *a, const double complex *b);

/* Contact dofs at pairs of nodes on both sides (the first on cyclic_right), one probe, and loads of
 * two patterns in harmonics 0 and 1. Freed by small_condensation_free. */
void small_condensation(const small_sector *s, int n_pairs, modal_condensation *to);
void small_condensation_free(modal_condensation *to);

/* C^H b_c of all dofs, [dofs->n][n]. To be freed. */
double complex *dense_wave_columns(const dense_wave *w, const modal_dofs *dofs);

#endif
