/* Elements compared: error of the first ten frequencies of one blade against processor time. Rows:
 * tetrahedra, tetrahedra that are smaller at the re-entrant edges, tetrahedra with 27 points where
 * curved ("full"), and hexahedra. The blade is that of cases/z_notch_blade.
 *
 *   bench_elements          all (four minutes); fails if hexahedra are less than 15 times cheaper
 *                           than tetrahedra at 0.1 %
 *   bench_elements hex20    one kind
 *   bench_elements --quick  coarse meshes only; fails if hexahedra are not better
 *
 * The error of a row is the largest of the ten. The reference is a mesh of hexahedra finer than any
 * row's. Its own error is printed: 3x3x3 points, extrapolated from 6 and 3 mm. Seconds are
 * processor time of assembly, factor and modes, the least of up to three runs; meshing is listed
 * beside it. "seconds at 0.1 %" is interpolated in the logarithms, or extrapolated from the last
 * two rows. The verdict does not depend on it. The first row of hexahedra within 0.1 % is compared
 * with the finest row of tetrahedra, which is not within 0.1 %. */
#include <math.h>
#include <slepceps.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

#include "mesh/base/constants.h"
#include "modal/eigen/eigen.h"
#include "tests/support/z_notch.h"

enum { MODES = 10, MOST = 8 };

typedef struct {
  const char   *name;
  mesh_kind     kind;
  fem_rules     rules;
  int           n_quick, n;
  z_notch_sizes at[MOST];
} ladder;

/* What a ladder is judged by. */
typedef struct {
  double within[2]; /* error and s of its first row within the target; 0, 0: none */
  double last[2];   /* of its last row */
  double at_target; /* s, interpolated or extrapolated */
} outcome;

typedef struct {
  int    nodes;
  double mesh, solve; /* s */
  double frequency[MODES];
} row;

static const ladder ladders[] = {
    {"tet10",
     MESH_TET10,
     FEM_STANDARD,
     2,
     6,
     {{14, 9, 0}, {10, 6, 0}, {6.5, 4, 0}, {4.5, 3, 0}, {3, 2, 0}, {2.4, 1.6, 0}}},
    {"graded tet10",
     MESH_TET10,
     FEM_STANDARD,
     2,
     4,
     {{14, 9, 3}, {10, 6, 2}, {8, 5, 1.5}, {6.5, 4, 1}}},
    {"full tet10", MESH_TET10, FEM_FULL, 2, 4, {{14, 9, 0}, {10, 6, 0}, {6.5, 4, 0}, {4.5, 3, 0}}},
    {"hex20",
     MESH_HEX20,
     FEM_STANDARD,
     3,
     6,
     {{20, 14, 0}, {14, 10, 0}, {10, 8, 0}, {8, 6, 0}, {6, 5, 0}, {5, 4, 0}}}};

enum { LADDERS = sizeof ladders / sizeof *ladders };

static const double goal = 1e-3, times = 15; /* error; times cheaper */

static double processor_time(void) {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return (double)usage.ru_utime.tv_sec + 1e-6 * (double)usage.ru_utime.tv_usec +
         (double)usage.ru_stime.tv_sec + 1e-6 * (double)usage.ru_stime.tv_usec;
}

static PetscErrorCode find_modes(const mesh_fe *mesh, fem_rules rules, double frequency[MODES]) {
  const fem_material         steel  = {.E = 2.1e11, .nu = .3, .rho = 7850};
  const modal_eigen_settings wanted = {.modes = MODES};
  fem_system                 system;
  modal_eigen                eigen;

  PetscFunctionBeginUser;
  PetscCall(fem_system_create(PETSC_COMM_SELF, mesh, &steel, rules, &system));
  PetscCall(modal_eigen_solve(&system, &wanted, &eigen));
  for (int i = 0; i < MODES; i++) frequency[i] = sqrt(eigen.lambda[i]) / SHB_TWO_PI;
  PetscCall(modal_eigen_destroy(&eigen));
  PetscCall(fem_system_destroy(&system));
  PetscFunctionReturn(0);
}

static bool run(mesh_kind kind, const z_notch_sizes *s, fem_rules rules, row *r) {
  mesh_fe mesh;
  double  started = processor_time();
  if (z_notch_mesh(kind, s, &mesh) != SHB_OK) {
    fprintf(stderr, "bench_elements: %s\n", shb_message());
    return false;
  }
  r->nodes  = mesh.n_nodes;
  r->mesh   = processor_time() - started;
  r->solve  = INFINITY;
  bool good = true;
  for (int i = 0; good && i < 3 && (i == 0 || r->solve < 3); i++) {
    started  = processor_time();
    good     = find_modes(&mesh, rules, r->frequency) == 0;
    r->solve = fmin(r->solve, processor_time() - started);
  }
  mesh_fe_free(&mesh);
  return good;
}

static double worst(const double frequency[MODES], const double reference[MODES]) {
  double most = 0;
  for (int i = 0; i < MODES; i++) most = fmax(most, fabs(frequency[i] / reference[i] - 1));
  return most;
}

/* log seconds is linear in log error between rows, and beyond the last two. */
static double seconds_at(double target, int n, const double *error, const double *seconds) {
  int i = 1;
  while (i < n - 1 && error[i] > target) i++;
  double slope = log(seconds[i] / seconds[i - 1]) / log(error[i] / error[i - 1]);
  return seconds[i] * pow(target / error[i], slope);
}

/* Rows of one kind. */
static bool measure(const ladder *l, bool quick, const double reference[MODES], outcome *out) {
  const int n           = quick ? l->n_quick : l->n;
  double    error[MOST] = {0}, seconds[MOST] = {0};
  for (int i = 0; i < n; i++) {
    row r;
    if (!run(l->kind, &l->at[i], l->rules, &r)) return false;
    error[i]   = worst(r.frequency, reference);
    seconds[i] = r.solve;
    if (error[i] <= goal && out->within[1] == 0)
      memcpy(out->within, (double[]){error[i], seconds[i]}, sizeof out->within);
    printf("%-13s %5.1f %5.1f %5.1f %8d %8.2f %8.2f   %.1e\n", l->name, l->at[i].size,
           l->at[i].shroud, l->at[i].edge, r.nodes, r.mesh, r.solve, error[i]);
    fflush(stdout);
  }
  memcpy(out->last, (double[]){error[n - 1], seconds[n - 1]}, sizeof out->last);
  out->at_target = seconds_at(goal, n, error, seconds);
  printf("%-13s seconds at 0.1 %%: %.3g%s\n", l->name, out->at_target,
         error[n - 1] > goal ? " (extrapolated)" : "");
  return true;
}

/* The frequencies go to their limit as h^(2 x .5445): the order of a right re-entrant edge. */
static double extrapolated_difference(const row *coarse, const row *fine,
                                      const double reference[MODES]) {
  const double ratio = pow(2, 2 * .5445);
  double       limit[MODES];
  for (int i = 0; i < MODES; i++)
    limit[i] = fine->frequency[i] + (fine->frequency[i] - coarse->frequency[i]) / (ratio - 1);
  return worst(limit, reference);
}

static bool make_reference(bool quick, double reference[MODES]) {
  const z_notch_sizes coarse = {6, 6, 0}, fine = {3, 3, 0};
  row                 reduced, full[2];
  if (!run(MESH_HEX20, quick ? &coarse : &fine, FEM_STANDARD, &reduced)) return false;
  memcpy(reference, reduced.frequency, sizeof reduced.frequency);
  printf("reference: hex20, %g mm, %d nodes, %.1f s\n", quick ? 6. : 3., reduced.nodes,
         reduced.solve);
  if (quick) return true;
  if (!run(MESH_HEX20, &coarse, FEM_FULL, &full[0])) return false;
  if (!run(MESH_HEX20, &fine, FEM_FULL, &full[1])) return false;
  printf("3x3x3 points: %.1e from it, extrapolated %.1e\n", worst(full[1].frequency, reference),
         extrapolated_difference(&full[0], &full[1], reference));
  return true;
}

/* Speed and error in a row, and what is to hold: a bound that no extrapolation enters. */
static bool judge(const outcome *hex, const outcome *other, const char *name) {
  const bool   reached = other->within[1] > 0;
  const double least   = (reached ? other->within[1] : other->last[1]) / hex->within[1];
  const bool   good    = hex->within[1] > 0 && least >= times;
  printf(
      "hex20 %.1e in %.2f s, %s %.1e in %.1f s: %s%.0f times cheaper at 0.1 %% (extrapolated "
      "%.3g); "
      "wanted %.0f: %s\n",
      hex->within[0], hex->within[1], name, reached ? other->within[0] : other->last[0],
      reached ? other->within[1] : other->last[1], reached ? "" : "more than ", least,
      other->at_target / hex->at_target, times, good ? "yes" : "NO");
  return good;
}

int main(int argc, char **argv) {
  const bool  quick = argc > 1 && strcmp(argv[1], "--quick") == 0;
  const char *only  = argc > 1 && !quick ? argv[1] : NULL;
  double      reference[MODES];
  outcome     out[LADDERS] = {0};
  if (SlepcInitialize(NULL, NULL, NULL, NULL)) return 1;
  bool good = make_reference(quick, reference);
  if (good)
    printf("\nelements       size shroud edge mm  nodes   mesh s  solve s   worst of %d\n", MODES);
  for (int k = 0; good && k < LADDERS; k++)
    if (!only || strcmp(only, ladders[k].name) == 0)
      good = measure(&ladders[k], quick, reference, &out[k]);
  if (good && !quick && !only) {
    good = judge(&out[LADDERS - 1], &out[0], ladders[0].name);
    judge(&out[LADDERS - 1], &out[1], ladders[1].name);
  }
  if (good && quick) good = out[LADDERS - 1].last[0] < .2 * fmin(out[0].last[0], out[1].last[0]);
  SlepcFinalize();
  return good ? 0 : 1;
}
