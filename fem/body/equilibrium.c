#include "fem/body/equilibrium.h"

#include <math.h>
#include <petscksp.h>
#include <stdlib.h>
#include <string.h>

#include "fem/body/tangent.h"
#include "fem/solver/factor.h"
#include "mesh/base/memory.h"

enum {
  MAX_ITERATIONS = 25,  /* Newton iterations in a load step */
  MAX_HALVINGS   = 6,   /* halvings of the load step */
  MAX_KEPT       = 12,  /* CG iterations with a kept factor; a new one costs 30 to 70 solves */
  MAX_SOLVES     = 100, /* CG iterations in a linear system */
};

/* Relative correction; the remaining error is about its square. */
static const double tolerance_u = 1e-9;

typedef enum { WORKING, CONVERGED, FAILED, INTERRUPTED } newton_outcome;

typedef struct {
  fem_body         body; /* at the speed and pressure of the load step */
  fem_system      *system;
  shb_progress    *progress;
  fem_equilibrium *out;
  fem_factor      *factor;
  KSP              ksp;
  Vec              R, d;             /* unbalanced forces; direction */
  double          *u, *step, *trial; /* [n_nodes][3]: displacement, direction, u + alpha step */
  double           slope;            /* d . R at u */
} newton;

/* ------------------------------------------------------------------ linear systems */

static PetscErrorCode create_solver(newton *n) {
  PC pc;
  PetscFunctionBeginUser;
  PetscCall(fem_factor_create(n->system->K, 0, &n->factor));
  PetscCall(KSPCreate(n->system->comm, &n->ksp));
  PetscCall(KSPSetOperators(n->ksp, n->system->K, n->system->K));
  PetscCall(KSPSetType(n->ksp, KSPCG));
  PetscCall(KSPGetPC(n->ksp, &pc));
  PetscCall(fem_factor_set_pc(n->factor, pc));
  PetscFunctionReturn(0);
}

/* Solve once, with the existing factor or a new one. */
static PetscErrorCode solve_with(newton *n, bool refactor, KSPConvergedReason *reason,
                                 PetscInt *count) {
  bool definite = true;
  PetscFunctionBeginUser;
  *count = 0;
  if (refactor) {
    PetscCall(fem_factor_update(n->factor, n->system->K, &definite));
    n->out->factorisations++;
  }
  if (!definite) {
    *reason = KSP_DIVERGED_INDEFINITE_MAT;
    PetscFunctionReturn(0);
  }
  PetscCall(KSPSolve(n->ksp, n->R, n->d));
  PetscCall(KSPGetConvergedReason(n->ksp, reason));
  PetscCall(KSPGetIterationNumber(n->ksp, count));
  n->out->solves += (int)*count;
  PetscFunctionReturn(0);
}

/* d = -K^-1 R to a relative tolerance. found: false if K is not positive definite. */
static PetscErrorCode find_direction(newton *n, double tolerance, bool *refactor, bool *found) {
  KSPConvergedReason reason;
  PetscInt           count;

  PetscFunctionBeginUser;
  PetscCall(KSPSetTolerances(n->ksp, tolerance, PETSC_DEFAULT, PETSC_DEFAULT, MAX_SOLVES));
  PetscCall(solve_with(n, *refactor, &reason, &count));
  if (reason < 0 && reason != KSP_DIVERGED_INDEFINITE_MAT && !*refactor)
    PetscCall(solve_with(n, true, &reason, &count));
  *refactor = count > MAX_KEPT;
  *found    = reason > 0;
  PetscCall(VecScale(n->d, -1));
  PetscFunctionReturn(0);
}

/* ------------------------------------------------------------------ line search */

/* Slope of the potential at u + alpha d along d. Leaves R at u + alpha d. */
static PetscErrorCode slope_at(newton *n, double alpha, double *slope) {
  const size_t size = 3 * (size_t)n->system->n_nodes;
  PetscFunctionBeginUser;
  for (size_t i = 0; i < size; i++) n->trial[i] = n->u[i] + alpha * n->step[i];
  PetscCall(fem_residual_assemble(&n->body, n->system, n->trial, n->R));
  PetscCall(VecDot(n->d, n->R, slope));
  PetscFunctionReturn(0);
}

/* First zero in (0, 1) of the cubic through (0, g[0]), (1/3, g[1]), (2/3, g[2]), (1, g[3]) with
 * g[0] < 0 < g[3]. */
static double first_zero(const double g[4]) {
  enum { SAMPLES = 64 };
  double c[4]; /* divided differences */
  memcpy(c, g, sizeof c);
  for (int order = 1; order < 4; order++)
    for (int i = 3; i >= order; i--) c[i] = (c[i] - c[i - 1]) * 3 / order;
  double low = 0, high = 1;
  for (int s = 1; s <= SAMPLES; s++) {
    double t     = (double)s / SAMPLES;
    double value = c[0] + t * (c[1] + (t - 1. / 3) * (c[2] + (t - 2. / 3) * c[3]));
    if (value < 0) continue;
    high = t;
    low  = t - 1. / SAMPLES;
    break;
  }
  for (int s = 0; s < 40; s++) {
    double t                    = (low + high) / 2;
    double value                = c[0] + t * (c[1] + (t - 1. / 3) * (c[2] + (t - 2. / 3) * c[3]));
    *(value < 0 ? &low : &high) = t;
  }
  return (low + high) / 2;
}

/* Step length along d: 1, unless the step passes the minimum of the potential by far. Leaves R at u
 * + alpha d. */
static PetscErrorCode line_search(newton *n, double *alpha) {
  double g[4], at;

  PetscFunctionBeginUser;
  g[0]   = n->slope;
  *alpha = 1;
  PetscCall(slope_at(n, 1, &g[3]));
  if (g[3] <= .5 * fabs(g[0])) PetscFunctionReturn(0);
  PetscCall(slope_at(n, 1. / 3, &g[1]));
  PetscCall(slope_at(n, 2. / 3, &g[2]));
  *alpha = first_zero(g);
  PetscCall(slope_at(n, *alpha, &at));
  PetscFunctionReturn(0);
}

/* ------------------------------------------------------------------ Newton */

static double max_norm(const double *v, size_t n) {
  double most = 0;
  for (size_t i = 0; i < n; i++)
    if (!(fabs(v[i]) <= most)) most = fabs(v[i]); /* also true for NaN */
  return most;
}

static PetscErrorCode is_interrupted(const newton *n, bool *yes) {
  int stop = shb_interrupted();
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &stop, 1, MPI_INT, MPI_MAX, n->system->comm));
  *yes = stop != 0;
  PetscFunctionReturn(0);
}

/* One Newton step with the current K. change: |alpha d| / |u|. */
static PetscErrorCode newton_step(newton *n, bool *refactor, double *change,
                                  newton_outcome *result) {
  const size_t size      = 3 * (size_t)n->system->n_nodes;
  const double tolerance = PetscMin(1e-2, PetscMax(1e-7, .1 * *change));
  double       alpha;
  bool         found = false, stop = false;

  PetscFunctionBeginUser;
  PetscCall(is_interrupted(n, &stop));
  *result = stop ? INTERRUPTED : FAILED;
  if (stop) PetscFunctionReturn(0);
  PetscCall(find_direction(n, tolerance, refactor, &found));
  PetscCall(VecDot(n->d, n->R, &n->slope));
  n->out->iterations++;
  if (!found || !(n->slope <= 0)) PetscFunctionReturn(0);
  PetscCall(fem_system_share(n->system, n->d, n->step));
  PetscCall(line_search(n, &alpha));
  PetscCall(PetscArraycpy(n->u, n->trial, size));
  *change = alpha * max_norm(n->step, size) / max_norm(n->u, size);
  if (!isfinite(*change)) PetscFunctionReturn(0);
  n->out->correction = *change;
  *result            = alpha == 1 && *change <= tolerance_u ? CONVERGED : WORKING;
  PetscFunctionReturn(0);
}

/* Newton iterations at the load of body, from u and the current tangent. Leaves K at the
 * solution. */
static PetscErrorCode iterate(newton *n, bool *refactor, newton_outcome *result) {
  double change = 1;
  PetscFunctionBeginUser;
  PetscCall(fem_residual_assemble(&n->body, n->system, n->u, n->R));
  for (int i = 0; i < MAX_ITERATIONS; i++) {
    PetscCall(newton_step(n, refactor, &change, result));
    if (*result == FAILED || *result == INTERRUPTED) PetscFunctionReturn(0);
    PetscCall(fem_tangent_assemble(&n->body, n->u, n->system));
    if (*result == CONVERGED) PetscFunctionReturn(0);
    shb_progress_show(n->progress, 10, "static equilibrium: Newton correction %.1e", change);
  }
  *result = FAILED;
  PetscFunctionReturn(0);
}

/* ------------------------------------------------------------------ load steps */

/* A share of the loads of the case. */
static void set_load(newton *n, const fem_body *whole, double share) {
  n->body.rotation.speed = whole->rotation.speed * sqrt(share);
  n->body.pressure       = whole->pressure * share;
}

static PetscErrorCode raise_load(newton *n, const fem_body *whole, newton_outcome *result) {
  const size_t size  = 3 * (size_t)n->system->n_nodes;
  const double speed = whole->rotation.speed;
  const char  *name  = speed == 0 ? "pressure" : "speed";
  double       load = 0, step = 1, *u_converged; /* load: share of Omega^2 and pressure */
  bool         refactor = true;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(size, &u_converged));
  while (load < 1) {
    double next = PetscMin(1, load + step);
    int    made = n->out->factorisations;
    set_load(n, whole, next);
    PetscCall(iterate(n, &refactor, result));
    if (*result == INTERRUPTED) break;
    if (*result == CONVERGED) {
      PetscCall(PetscArraycpy(u_converged, n->u, size));
      n->out->steps++;
      load = next;
      continue;
    }
    step /= 2;
    if (step < 1. / (1 << MAX_HALVINGS)) PetscCall(PetscFree(u_converged));
    PetscCheck(step >= 1. / (1 << MAX_HALVINGS), n->system->comm, PETSC_ERR_USER_INPUT,
               "rotor.%s: no static equilibrium at %.6g rad/s%s: Newton failed in load step %d, "
               "between %.6g and %.6g rad/s; give a lower %s, or check material.E, material.rho "
               "and that the mesh is in metres",
               name, speed, whole->pressure != 0 ? " and this pressure" : "", n->out->steps + 1,
               speed * sqrt(load), n->body.rotation.speed, name);
    PetscCall(PetscArraycpy(n->u, u_converged, size));
    set_load(n, whole, load);
    PetscCall(fem_tangent_assemble(&n->body, n->u, n->system));
    refactor = n->out->factorisations > made; /* the factor belongs to a rejected state */
  }
  PetscCall(PetscFree(u_converged));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_equilibrium_solve(const fem_body *body, fem_system *system,
                                     shb_progress *progress, fem_equilibrium *out) {
  const size_t   size   = 3 * (size_t)system->n_nodes;
  newton         n      = {.body = *body, .system = system, .progress = progress, .out = out};
  newton_outcome result = FAILED;

  PetscFunctionBeginUser;
  memset(out, 0, sizeof *out);
  out->displacement = shb_alloc_zeroed(size + 1, sizeof(double));
  n.u               = out->displacement;
  PetscCall(PetscMalloc2(size, &n.step, size, &n.trial));
  PetscCall(MatCreateVecs(system->K, &n.d, &n.R));
  PetscErrorCode code = create_solver(&n);
  if (!code) code = raise_load(&n, body, &result);
  PetscCall(KSPDestroy(&n.ksp));
  PetscCall(fem_factor_destroy(&n.factor));
  PetscCall(VecDestroy(&n.d));
  PetscCall(VecDestroy(&n.R));
  PetscCall(PetscFree2(n.step, n.trial));
  PetscCall(code);
  if (result != CONVERGED) fem_equilibrium_free(out);
  PetscFunctionReturn(0);
}

void fem_equilibrium_free(fem_equilibrium *equilibrium) {
  free(equilibrium->displacement);
  memset(equilibrium, 0, sizeof *equilibrium);
}
