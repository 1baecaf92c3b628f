/* Coriolis terms of a sector with a disc, file to file, against the explicit ring of all sectors.
 *
 * The ring has a Coriolis force of its own: element by element, with the cross product as the
 * derivative of a rotation. It knows no nodal diameter and no complex shape. */
#include <complex.h>
#include <lapacke.h>
#include <math.h>
#include <petscksp.h>

#include "fem/body/equilibrium.h"
#include "mesh/base/constants.h"
#include "mesh/core/cyclic_sides.h"
#include "mhb/structure/gyroscopic.h"
#include "modal/common/session.h"
#include "modal/model/residual_series.h"
#include "modal/stage/stage.h"
#include "tests/support/box.h"
#include "tests/support/fem.h"
#include "tests/support/files.h"
#include "tests/support/sector.h"
#include "tests/support/sector_case.h"

enum { BLADES = 6, MODES = 24 };

static const double         speed      = 1500;
static const shb_provenance provenance = {"case.yaml", "name: case\n", "modal.modes = 24\n",
                                          "shroudhb-modal"};

static modal_settings settings_at(double omega, int modes) {
  modal_settings settings = sector_case(BLADES, modes);
  settings.speed          = omega;
  settings.coriolis       = FEM_TURNS_LEFT;
  return settings;
}

/* The sector, and its ring at the equilibrium of a speed. */
typedef struct {
  mesh_fe      mesh;
  sector_ring  ring;
  fem_element *element;
  modal_result result; /* for the contact dofs */
} scene;

static void make(const char *name, double omega, int modes, modal_nodal_diameters *models) {
  const modal_settings settings = settings_at(omega, modes);
  assert_ok(modal_stage(PETSC_COMM_WORLD, scratch("sector.msh"), scratch(name), &settings,
                        &provenance, NULL));
  assert_ok(modal_nodal_diameters_read(scratch(name), models));
}

/* ------------------------------------------------------------------ the ring's Coriolis force */

/* force[n_nodes][3] = G motion, kg/s times it, of a rotor that turns left at speed 1. */
static void ring_coriolis(const scene *s, const double complex *motion, double complex *force) {
  const mesh_fe *mesh  = &s->ring.mesh;
  const double   angle = 0.3;
  double         m[MESH_NODES * MESH_NODES], x[MESH_NODES][3];
  memset(force, 0, 3 * (size_t)mesh->n_nodes * sizeof *force);
  for (int e = 0; e < mesh->n_elements; e++) {
    const int *node = mesh->connectivity + s->element->n * e;
    for (int i = 0; i < s->element->n; i++)
      memcpy(x[i], mesh->coordinates + 3 * node[i], sizeof x[i]);
    fem_element_mass(s->element, steel.rho, (const double(*)[3])x, m);
    for (int j = 0; j < s->element->n; j++)
      for (int part = 0; part < 2; part++) {
        double v[3], forth[3], back[3];
        for (int d = 0; d < 3; d++) {
          const double complex z = motion[3 * node[j] + d];
          v[d]                   = part ? cimag(z) : creal(z);
        }
        mesh_axis_rotate(MESH_AXIS_X, angle, v, forth);
        mesh_axis_rotate(MESH_AXIS_X, -angle, v, back);
        for (int i = 0; i < s->element->n; i++)
          for (int d = 0; d < 3; d++) /* towards -tangential: a negative rotation */
            force[3 * node[i] + d] += (part ? I : 1) * m[s->element->n * i + j] * -2 *
                                      (forth[d] - back[d]) / (2 * sin(angle));
      }
  }
}

/* The wave of a shape [n_nodes][3] of the sector, on all nodes of the ring. */
static void spread_shape(const scene *s, int wave, const double complex *shape,
                         double complex *motion) {
  for (int b = 0; b < BLADES; b++)
    for (int i = 0; i < s->mesh.n_nodes; i++) {
      const double complex phase = cexp(-I * SHB_TWO_PI * wave * b / BLADES);
      double               part[2][3];
      for (int d = 0; d < 3; d++) {
        part[0][d] = creal(phase * shape[3 * i + d]);
        part[1][d] = cimag(phase * shape[3 * i + d]);
      }
      for (int p = 0; p < 2; p++)
        mesh_axis_rotate(MESH_AXIS_X, SHB_TWO_PI * b / BLADES, part[p], part[p]);
      for (int d = 0; d < 3; d++)
        motion[3 * s->ring.node[b * s->mesh.n_nodes + i] + d] = CMPLX(part[0][d], part[1][d]);
    }
}

static double complex inner(size_t n, const double complex *a, const double complex *b) {
  double complex sum = 0;
  for (size_t i = 0; i < n; i++) sum += conj(a[i]) * b[i];
  return sum;
}

/* The matrix in the file is phi^H G phi of the ring. It does no work. */
static void the_matrix_is_that_of_the_ring(void **state) {
  scene          *s = *state;
  const size_t    n = 3 * (size_t)s->mesh.n_nodes, all = 3 * (size_t)s->ring.mesh.n_nodes;
  double complex *wave = malloc(MODES * all * sizeof *wave), *force = malloc(all * sizeof *wave);
  modal_nodal_diameters models;
  hid_t                 file;
  assert_true(wave && force);
  make("speed.modal.h5", speed, MODES, &models);
  assert_ok(h5_open(scratch("speed.modal.h5"), &file));
  for (int d = 0; d <= BLADES / 2; d++) {
    char            path[64];
    h5_shape        shape = H5_SHAPE(MODES, (hsize_t)s->mesh.n_nodes, 3);
    double complex *phi;
    double          most = 0, off = 0, other = 0, work = 0;
    modal_wave      w;
    int             missing;
    assert_true(modal_nodal_diameters_wave(&models, d, &w, &missing));
    snprintf(path, sizeof path, "/nodal_diameter_%d/modes/shape", d);
    assert_ok(h5_read_complex(file, path, &shape, &phi));
    for (size_t j = 0; j < MODES; j++) spread_shape(s, d, phi + n * j, wave + all * j);
    for (int j = 0; j < MODES; j++) {
      ring_coriolis(s, wave + all * (size_t)j, force);
      for (int i = 0; i < MODES; i++) {
        const double complex wanted = speed * inner(all, wave + all * (size_t)i, force) / BLADES;
        const double complex found  = mhb_gyroscopic_element(&w, i, j);
        most                        = fmax(most, cabs(wanted));
        off                         = fmax(off, cabs(found - wanted));
        other                       = fmax(other, cabs(found + wanted));
        work = fmax(work, cabs(found + conj(mhb_gyroscopic_element(&w, j, i))));
      }
    }
    print_message("nodal diameter %d: largest term %.4g 1/s, off by %.1e; not skew by %.1e\n", d,
                  most, off / most, work);
    check_below(off, 1e-11 * most, "Coriolis matrix");
    assert_true(other > most && work == 0);
    free(phi);
  }
  assert_ok(h5_close(file));
  modal_nodal_diameters_free(&models);
  free(wave), free(force);
}

/* ------------------------------------------------------------------ the ring, driven directly */

typedef struct {
  fem_system system; /* K at the equilibrium */
  Mat        factor; /* of K - w^2 M */
} driven;

static void drive_at(const scene *s, double omega, double w, driven *d) {
  const fem_body  body = {&s->ring.mesh, &steel, s->element, {MESH_AXIS_X, omega}, 0};
  fem_equilibrium at;
  MatFactorInfo   info;
  Mat             A;
  assert_int_equal(
      fem_system_create(PETSC_COMM_SELF, &s->ring.mesh, &steel, FEM_STANDARD, &d->system), 0);
  assert_int_equal(fem_equilibrium_solve(&body, &d->system, NULL, &at), 0);
  assert_int_equal(fem_system_shifted(&d->system, w * w, &A), 0);
  assert_int_equal(MatSetOption(A, MAT_SPD, PETSC_FALSE), 0);
  assert_int_equal(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE), 0);
  assert_int_equal(MatGetFactor(A, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &d->factor), 0);
  assert_int_equal(MatFactorInfoInitialize(&info), 0);
  assert_int_equal(MatCholeskyFactorSymbolic(d->factor, A, NULL, &info), 0);
  assert_int_equal(MatCholeskyFactorNumeric(d->factor, A, &info), 0);
  MatDestroy(&A);
  fem_equilibrium_free(&at);
}

static void drive_end(driven *d) {
  MatDestroy(&d->factor);
  fem_system_destroy(&d->system);
}

/* x = (K - w^2 M)^-1 f, f of all nodes. */
static void solve_real(const scene *s, const driven *d, const double complex *f,
                       double complex *x) {
  const int nodes = s->ring.mesh.n_nodes;
  double   *nodal = malloc(3 * (size_t)nodes * sizeof *nodal), *value;
  Vec       b, y;
  assert_non_null(nodal);
  assert_int_equal(MatCreateVecs(d->system.K, &b, &y), 0);
  for (int part = 0; part < 2; part++) {
    assert_int_equal(VecZeroEntries(b), 0);
    assert_int_equal(VecGetArray(b, &value), 0);
    for (int i = 0; i < 3 * nodes; i++) {
      const PetscInt row = d->system.row[i / 3];
      if (row >= 0) value[3 * row + i % 3] = part ? cimag(f[i]) : creal(f[i]);
    }
    assert_int_equal(VecRestoreArray(b, &value), 0);
    assert_int_equal(MatSolve(d->factor, b, y), 0);
    assert_int_equal(fem_system_gather(&d->system, y, nodal), 0);
    for (int i = 0; i < 3 * nodes; i++) x[i] = (part ? x[i] : 0) + (part ? I : 1) * nodal[i];
  }
  VecDestroy(&b);
  VecDestroy(&y);
  free(nodal);
}

/* Motion of contact dof p of sector 0 by a wave of unit forces on contact dof l. The Coriolis force
 * is iterated on. */
static double complex ring_receptance(const scene *s, const driven *d, double omega, double w,
                                      int wave, int p, int l) {
  const modal_dofs *dof = &s->result.to.contact;
  const size_t      all = 3 * (size_t)s->ring.mesh.n_nodes;
  double complex   *f = calloc(3 * all, sizeof *f), *g = f + all, *x = g + all, sum = 0;
  double            last = 0;
  assert_non_null(f);
  for (int b = 0; b < BLADES; b++)
    for (int e = dof->start[l]; e < dof->start[l + 1]; e++) {
      double turned[3];
      mesh_axis_rotate(MESH_AXIS_X, SHB_TWO_PI * b / BLADES, dof->weight + 3 * e, turned);
      for (int i = 0; i < 3; i++)
        f[3 * s->ring.node[b * s->mesh.n_nodes + dof->node[e]] + i] +=
            turned[i] * cexp(-I * SHB_TWO_PI * wave * b / BLADES);
    }
  for (int turn = 0; turn < 200; turn++) {
    ring_coriolis(s, x, g);
    double change = 0, size = 0;
    for (size_t i = 0; i < all; i++) {
      const double complex next = f[i] - I * w * omega * g[i];
      g[i]                      = next;
    }
    double complex *before = malloc(all * sizeof *before);
    memcpy(before, x, all * sizeof *x);
    solve_real(s, d, g, x);
    for (size_t i = 0; i < all; i++) {
      change = fmax(change, cabs(x[i] - before[i]));
      size   = fmax(size, cabs(x[i]));
    }
    free(before);
    last = change / size;
    if (last < 1e-13) break;
  }
  check_below(last, 1e-12, "iteration");
  for (int e = dof->start[p]; e < dof->start[p + 1]; e++)
    for (int i = 0; i < 3; i++)
      sum += dof->weight[3 * e + i] * x[3 * s->ring.node[dof->node[e]] + i];
  free(f);
  return sum;
}

/* ------------------------------------------------------------------ the reduced model */

static double complex contact_shape(const modal_wave *w, int c, int i) {
  const modal_model *m = w->model, *im = w->imaginary;
  const int          right = 3 * m->n_pairs, row = c < right ? c : c - right;
  const size_t       k = (size_t)row * (size_t)m->n_modes + (size_t)i;
  return c < right ? modal_wave_value(w, m->right, im ? im->right : NULL, k)
                   : modal_wave_value(w, m->left, im ? im->left : NULL, k);
}

/* Undamped receptance between contact dofs p and l; sign of the Coriolis terms: 1, or 0, -1. */
static double complex receptance(const modal_wave *w, double omega, int p, int l, double sign) {
  const modal_model *m = w->model, *im = w->imaginary;
  const int          n = modal_model_contact_dofs(m), modes = m->n_modes;
  const size_t       k      = (size_t)p * (size_t)n + (size_t)l;
  const modal_series series = modal_series_at(m, omega);
  double complex    *A      = calloc((size_t)modes * (size_t)(modes + 1), sizeof *A),
                 *x         = A + modes * modes;
  double complex sum        = 0;
  int            pivot[modes];
  double         slope;
  assert_non_null(A);
  for (int j = 0; j < modes; j++) {
    for (int i = 0; i < modes; i++)
      A[j * modes + i] = I * omega * sign * mhb_gyroscopic_element(w, i, j);
    A[j * modes + j] += pow(SHB_TWO_PI * m->frequency[j], 2) - omega * omega;
    x[j] = conj(contact_shape(w, l, j));
  }
  assert_int_equal(LAPACKE_zgesv(LAPACK_COL_MAJOR, modes, 1, A, modes, pivot, x, modes), 0);
  for (int i = 0; i < modes; i++) sum += contact_shape(w, p, i) * x[i];
  const double *re[]    = {m->residual_flexibility, m->residual_inertia, m->residual_fourth};
  const double *part[3] = {NULL};
  if (im)
    part[0] = im->residual_flexibility, part[1] = im->residual_inertia,
    part[2] = im->residual_fourth;
  for (int t = 0; t < 3; t++) sum += series.weight[t] * modal_wave_value(w, re[t], part[t], k);
  for (int i = 0; i < m->n_residual; i++) {
    const double  *shape = im ? im->residual_shape : NULL;
    const size_t   r     = (size_t)m->n_residual;
    double complex a     = modal_wave_value(w, m->residual_shape, shape, (size_t)p * r + (size_t)i);
    double complex b     = modal_wave_value(w, m->residual_shape, shape, (size_t)l * r + (size_t)i);
    sum += modal_series_mode(m, i, &series, &slope) * a * conj(b);
  }
  free(A);
  return sum;
}

/* Greatest difference from the ring over all waves, relative to the greatest receptance. */
static double difference(const scene *s, const driven *d, const modal_nodal_diameters *models,
                         double omega, double w, double sign) {
  const int n   = 3;
  double    off = 0, most = 0;
  for (int wave = 1; wave < BLADES; wave += 2)
    for (int l = 0; l < n; l += 2) {
      modal_wave of;
      int        missing;
      assert_true(modal_nodal_diameters_wave(models, wave, &of, &missing));
      for (int p = 0; p < n; p += 2) {
        const double complex wanted = ring_receptance(s, d, omega, w, wave, p, l);
        most                        = fmax(most, cabs(wanted));
        off                         = fmax(off, cabs(receptance(&of, w, p, l, sign) - wanted));
      }
    }
  return off / most;
}

/* Contact receptances of all waves, forwards and backwards: the error is what the modes left out
 * add. It falls with the modes kept, and is of first order in the speed. */
static void receptances_of_the_ring(void **state) {
  scene                *s = *state;
  modal_nodal_diameters models;
  double                off[3];
  const double          w = 4000;
  for (int k = 0; k < 3; k++) {
    const double omega = k == 1 ? speed / 4 : speed / 2;
    const int    modes = k == 2 ? 2 * MODES : MODES;
    driven       d;
    make("part.modal.h5", omega, modes, &models);
    drive_at(s, omega, w, &d);
    off[k]               = difference(s, &d, &models, omega, w, 1);
    const double without = difference(s, &d, &models, omega, w, 0);
    const double wrong   = difference(s, &d, &models, omega, w, -1);
    print_message(
        "%g rad/s, %d modes, first %.5g rad/s: off by %.2e; without Coriolis terms %.2e, "
        "with the other sign %.2e\n",
        omega, modes, SHB_TWO_PI * models.model[1].frequency[0], off[k], without, wrong);
    assert_true(without > 20 * off[k] && wrong > 1.5 * without);
    drive_end(&d);
    modal_nodal_diameters_free(&models);
  }
  assert_near(off[0] / off[1], 2, 0.1);
  check_below(off[2], off[0] / 8, "error with twice as many modes");
}

static int set_up(void **state) {
  static scene      s;
  mesh_cyclic_sides sides;
  modal_settings    settings = settings_at(speed, MODES);
  if (scratch_make(state)) return 1;
  use_elements(MESH_HEX20);
  s.mesh = make_bladed_sector(BLADES, 1);
  assert_ok(box_write(&s.mesh, scratch("sector.msh")));
  assert_ok(mesh_cyclic_pair(&s.mesh, MESH_AXIS_X, BLADES, &sides));
  assert_ok(mesh_fe_orient(&s.mesh, MESH_AXIS_X));
  s.element = make_element_tables(FEM_STANDARD);
  assert_ok(modal_solve(PETSC_COMM_WORLD, &s.mesh, &settings, NULL, &s.result));
  s.ring = make_sector_ring(&s.mesh, MESH_AXIS_X, BLADES);
  *state = &s;
  return 0;
}

static int tear_down(void **state) {
  scene *s = *state;
  modal_result_free(&s->result);
  free_sector_ring(&s->ring);
  mesh_fe_free(&s->mesh);
  free(s->element);
  return scratch_remove(state);
}

int main(int argc, char **argv) {
  modal_session           session;
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_matrix_is_that_of_the_ring),
                                     cmocka_unit_test(receptances_of_the_ring)};
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failed    = cmocka_run_group_tests(tests, set_up, tear_down);
  session.fault = false;
  modal_session_end(&session, SHB_OK);
  return failed;
}
