/* Residual terms of a fine contact face: seconds of the modal stage, and of three solutions a
 * column with the same factor and modes. Columns are three dofs at each corner of both
 * contact faces of the z-notch blade (hexahedra). Threads as OMP_NUM_THREADS says.
 *
 *   bench_residuals SHROUD...    sizes of the shroud's elements in mm: 4 2 1.4
 *   bench_residuals --quick      5 mm: fails if an error is above its bound
 *
 * The error of R2 is relative to its greatest entry. That of s^2 R3 is relative to the greatest
 * entry of R, for a third of the frequency of the last mode. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "fem/solver/petsc_error.h"
#include "mesh/base/clock.h"
#include "modal/common/session.h"
#include "modal/condense/condense.h"
#include "modal/condense/residual_chain.h"
#include "tests/support/z_notch.h"

enum { MODES = 20, BATCH = 80, BLOCKS = MODAL_RESIDUAL_BLOCKS };

typedef struct {
  double wall, cpu;
} seconds;

static seconds now(void) {
  return (seconds){shb_seconds(), shb_processor_seconds()};
}

static seconds since(seconds t) {
  const seconds end = now();
  return (seconds){end.wall - t.wall, end.cpu - t.cpu};
}

/* Three dofs at each corner node of the set. */
static shb_status add_corners(const mesh_fe *mesh, int set, modal_dofs *dofs) {
  static const double one   = 1;
  const int           nodes = mesh_topology_of(mesh->kind)->face_nodes;
  bool               *seen  = calloc((size_t)mesh->n_nodes, sizeof *seen);
  shb_status          end   = SHB_OK;
  SHB_CHECK(seen, SHB_ERR_IO, "out of memory");
  for (int f = 0; f < mesh->set[set].n && end == SHB_OK; f++)
    for (int k = 0; k < nodes / 2 && end == SHB_OK; k++) {
      const int node = mesh->set[set].nodes[f * nodes + k];
      if (seen[node]) continue;
      seen[node] = true;
      for (int a = 0; a < 3 && end == SHB_OK; a++)
        modal_dofs_add(dofs, 1, &node, &one, (double[3]){a == 0, a == 1, a == 2});
    }
  free(seen);
  return end;
}

/* R, R2, R3 [n][n] by three solutions a column. */
static PetscErrorCode solve_all(const fem_system *system, const modal_eigen *eigen,
                                const modal_condensation *to, double *const term[BLOCKS]) {
  const int            n = to->contact.n;
  modal_residual_chain chain;
  PetscFunctionBeginUser;
  PetscCall(modal_residual_chain_create(system, eigen, &to->contact, &to->probe, BATCH, &chain));
  for (int first = 0; first < n; first += BATCH) {
    const int count = n - first < BATCH ? n - first : BATCH;
    PetscCall(modal_residual_chain_compute(&chain, &to->contact, first, count, BLOCKS));
    for (int t = 0; t < BLOCKS; t++)
      for (int r = 0; r < n; r++)
        memcpy(term[t] + (size_t)r * (size_t)n + (size_t)first, chain.sample[t] + (size_t)r * BATCH,
               (size_t)count * sizeof(double));
  }
  PetscCall(modal_residual_chain_destroy(&chain));
  PetscFunctionReturn(0);
}

/* Greatest difference of two arrays; *most: greatest entry of the second. */
static double difference(const double *a, const double *b, size_t n, double *most) {
  double off = 0;
  *most      = 0;
  for (size_t i = 0; i < n; i++) {
    off   = fmax(off, fabs(a[i] - b[i]));
    *most = fmax(*most, fabs(b[i]));
  }
  return off;
}

static shb_status measure(const fem_system *system, const modal_eigen *eigen,
                          const modal_condensation *to, bool *good) {
  const size_t size = (size_t)to->contact.n * (size_t)to->contact.n;
  const double s    = eigen->lambda[MODES - 1] / 9;
  double      *term[BLOCKS], most[BLOCKS], off[BLOCKS];
  modal_model  model;
  seconds      began = now();
  SHB_TRY(modal_condense(system, eigen, to, NULL, &model));
  const seconds own = since(began);
  struct rusage use;
  getrusage(RUSAGE_SELF, &use);
  for (int t = 0; t < BLOCKS; t++) {
    term[t] = malloc(size * sizeof *term[t]);
    SHB_CHECK(term[t], SHB_ERR_IO, "out of memory");
  }
  began = now();
  FEM_PETSC(solve_all(system, eigen, to, term));
  const seconds whole        = since(began);
  const double *mine[BLOCKS] = {model.residual_flexibility, model.residual_inertia,
                                model.residual_fourth};
  for (int t = 0; t < BLOCKS; t++) off[t] = difference(mine[t], term[t], size, &most[t]);
  printf("%8d %8d  %7.2f %7.2f  %7.2f %7.2f  %5.2f  %6.0f  %.1e  %.1e\n", (int)system->n_free,
         to->contact.n, own.wall, own.cpu, whole.wall, whole.cpu, own.cpu / whole.cpu,
         (double)use.ru_maxrss / 1024, off[1] / most[1], s * s * off[2] / most[0]);
  *good = *good && off[0] < 1e-10 * most[0] && off[1] < 1e-10 * most[1] &&
          s * s * off[2] < 1e-8 * most[0];
  for (int t = 0; t < BLOCKS; t++) free(term[t]);
  modal_model_free(&model);
  return SHB_OK;
}

static shb_status measure_face(double shroud, bool *good) {
  const fem_material         steel    = {.E = 2.1e11, .nu = .3, .rho = 7850};
  const modal_eigen_settings settings = {.modes = MODES};
  const z_notch_sizes        sizes    = {9, shroud, 0};
  mesh_fe                    mesh;
  fem_system                 system;
  modal_eigen                eigen;
  modal_condensation         to = {.has_left = true, .damping = {.ratio = .002}};
  SHB_TRY(z_notch_mesh(MESH_HEX20, &sizes, &mesh));
  SHB_TRY(add_corners(&mesh, MESH_CONTACT_RIGHT, &to.contact));
  to.n_pairs = to.contact.n / 3;
  SHB_TRY(add_corners(&mesh, MESH_CONTACT_LEFT, &to.contact));
  SHB_TRY(modal_load_create(&mesh, 0, NULL, NULL, &to.load));
  FEM_PETSC(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_STANDARD, &system));
  FEM_PETSC(modal_eigen_solve(&system, &settings, &eigen));
  SHB_TRY(measure(&system, &eigen, &to, good));
  modal_load_free(&to.load);
  modal_dofs_free(&to.contact);
  FEM_PETSC(modal_eigen_destroy(&eigen));
  FEM_PETSC(fem_system_destroy(&system));
  mesh_fe_free(&mesh);
  return SHB_OK;
}

int main(int argc, char **argv) {
  int           words = 1;
  modal_session session;
  const bool    quick = argc == 2 && strcmp(argv[1], "--quick") == 0;
  bool          good  = argc > 1;
  char        **first = argv;
  if (argc < 2) fprintf(stderr, "usage: bench_residuals --quick | SHROUD...   (mm)\n");
  if (modal_session_start(&words, &first, &session) != SHB_OK) return 4;
  printf("   nodes  columns  s: wall     cpu  by three solutions  share  MB     R2       R3\n");
  for (int a = 1; a < argc && good; a++)
    if (measure_face(quick ? 5 : atof(argv[a]), &good) != SHB_OK) {
      fprintf(stderr, "%s\n", shb_message());
      good = false;
    }
  modal_session_end(&session, SHB_OK);
  return good ? 0 : argc > 1 ? 1 : 2;
}
