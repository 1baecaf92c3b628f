/* Factor and solves of the stiffness matrix of the z-notch blade, ten-node tetrahedra. Rows by
 * number of threads: seconds by the clock, and the backward error of the solutions.
 *
 *   bench_solver RUNG...    10k 43k 170k, by nodes
 *   bench_solver --quick    2k: fails if threads change a bit, or an error is above 1e-15
 *
 * A column of solves is ms a right-hand side with so many at once. */
#include <math.h>
#include <omp.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "fem/body/assemble.h"
#include "fem/solver/factor.h"
#include "mesh/base/clock.h"
#include "modal/common/session.h"
#include "tests/support/z_notch.h"

typedef struct {
  const char   *name;
  z_notch_sizes sizes;
} rung;

static const rung rungs[] = {
    {"2k", {14, 9, 0}}, {"10k", {6.5, 4, 0}}, {"43k", {3.34, 2.25, 0}}, {"170k", {1.93, 1.35, 0}}};

enum { RUNGS = sizeof rungs / sizeof *rungs, COUNTS = 4, MOST = 128 };

static const int counts[COUNTS] = {1, 4, 8, MOST};

static Mat columns(const fem_system *system, int n) {
  Mat B = NULL;
  if (MatCreateDense(PETSC_COMM_SELF, PETSC_DECIDE, PETSC_DECIDE, 3 * system->n_free, n, NULL, &B))
    return NULL;
  return MatSetRandom(B, NULL) ? NULL : B;
}

/* |K x - b| / (|K| |x|) of the last column. */
static PetscErrorCode backward_error(const fem_system *system, Mat X, Mat B, double *error) {
  Vec      x, b, r;
  double   K, length, norm;
  PetscInt n;
  PetscFunctionBeginUser;
  PetscCall(MatGetSize(X, NULL, &n));
  PetscCall(MatCreateVecs(system->K, NULL, &r));
  PetscCall(MatNorm(system->K, NORM_FROBENIUS, &K));
  PetscCall(MatDenseGetColumnVecRead(X, n - 1, &x));
  PetscCall(MatDenseGetColumnVecRead(B, n - 1, &b));
  PetscCall(MatMult(system->K, x, r));
  PetscCall(VecAXPY(r, -1, b));
  PetscCall(VecNorm(r, NORM_2, &norm));
  PetscCall(VecNorm(x, NORM_2, &length));
  *error = norm / (K * length);
  PetscCall(MatDenseRestoreColumnVecRead(B, n - 1, &b));
  PetscCall(MatDenseRestoreColumnVecRead(X, n - 1, &x));
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(0);
}

/* One row. The sum of the bits of all solutions goes into *bits. */
static PetscErrorCode measure(const fem_system *system, int threads, double *worst,
                              unsigned long *bits) {
  fem_factor *factor;
  bool        definite;
  PetscFunctionBeginUser;
  omp_set_num_threads(threads);
  PetscCall(fem_factor_create(system->K, 0, &factor));
  double began = shb_seconds(), ms[COUNTS];
  PetscCall(fem_factor_update(factor, system->K, &definite));
  const double factorising = shb_seconds() - began;
  for (int i = 0; i < COUNTS; i++) {
    Mat           B = columns(system, counts[i]), X = columns(system, counts[i]);
    double        error = 0;
    const double *x;
    PetscCheck(B && X, PETSC_COMM_SELF, PETSC_ERR_MEM, "columns");
    PetscCall(fem_factor_solve_many(factor, B, X)); /* takes its memory */
    began = shb_seconds();
    PetscCall(fem_factor_solve_many(factor, B, X));
    ms[i] = 1e3 * (shb_seconds() - began) / counts[i];
    PetscCall(backward_error(system, X, B, &error));
    *worst = fmax(*worst, error);
    PetscCall(MatDenseGetArrayRead(X, &x));
    for (int k = 0; k < 3 * system->n_free * counts[i]; k++) {
      unsigned long word;
      memcpy(&word, x + k, sizeof word);
      *bits = *bits * 31 + word;
    }
    PetscCall(MatDenseRestoreArrayRead(X, &x));
    PetscCall(MatDestroy(&B));
    PetscCall(MatDestroy(&X));
  }
  printf("%8d %7d %8.3f  %8.2f %8.2f %8.2f %8.2f  %.1e\n", (int)system->n_free, threads,
         factorising, ms[0], ms[1], ms[2], ms[3], *worst);
  PetscCall(fem_factor_destroy(&factor));
  PetscFunctionReturn(0);
}

static PetscErrorCode measure_rung(const rung *r, bool *good) {
  const fem_material steel = {.E = 2.1e11, .nu = .3, .rho = 7850};
  mesh_fe            mesh;
  fem_system         system;
  unsigned long      bits[2] = {0};
  double             worst   = 0;
  PetscFunctionBeginUser;
  PetscCheck(z_notch_mesh(MESH_TET10, &r->sizes, &mesh) == SHB_OK, PETSC_COMM_SELF, PETSC_ERR_LIB,
             "%s", shb_message());
  PetscCall(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_STANDARD, &system));
  for (int t = 1; t <= 2; t++) PetscCall(measure(&system, t, &worst, &bits[t - 1]));
  *good = *good && bits[0] == bits[1] && worst < 1e-15;
  if (bits[0] != bits[1]) printf("the threads change the numbers\n");
  PetscCall(fem_system_destroy(&system));
  mesh_fe_free(&mesh);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv) {
  int           words = 1;
  modal_session session;
  const bool    quick = argc == 2 && strcmp(argv[1], "--quick") == 0;
  bool          good  = argc > 1;
  char        **first = argv;
  if (argc < 2) fprintf(stderr, "usage: bench_solver --quick | RUNG...   (2k 10k 43k 170k)\n");
  if (modal_session_start(&words, &first, &session) != SHB_OK) return 4;
  printf("   nodes threads factor, s   ms: 1        4        8      %d  worst error\n", MOST);
  for (int i = 0; i < RUNGS && good; i++)
    for (int a = 1; a < argc; a++)
      if (strcmp(quick ? "2k" : argv[a], rungs[i].name) == 0)
        good = measure_rung(&rungs[i], &good) == 0 && good;
  modal_session_end(&session, SHB_OK);
  return good ? 0 : argc > 1 ? 1 : 2;
}
