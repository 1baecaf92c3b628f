/* The stage of a sector with a disc, file to file, against the explicit ring of all sectors. */
#include <complex.h>
#include <math.h>
#include <omp.h>
#include <petscksp.h>

#include "fem/body/equilibrium.h"
#include "fem/body/stress.h"
#include "mesh/base/constants.h"
#include "mesh/core/cyclic_sides.h"
#include "mesh/io/inp_write.h"
#include "modal/common/session.h"
#include "modal/model/residual_series.h"
#include "modal/model/sector_speeds.h"
#include "modal/stage/stage.h"
#include "tests/support/box.h"
#include "tests/support/fem.h"
#include "tests/support/files.h"
#include "tests/support/sector.h"
#include "tests/support/sector_case.h"

enum { BLADES = 6, MODES = 20 };

static modal_settings default_settings(void) {
  modal_settings  settings = sector_case(BLADES, MODES);
  static fem_load load;
  load             = *settings.loads;
  load.n_harmonics = 2;
  load.factor[0]   = 0.3;
  load.factor[2]   = -0.2 + 0.5 * I;
  settings.loads   = &load;
  return settings;
}

static const shb_provenance provenance = {"case.yaml", "name: case\n", "modal.modes = 20\n",
                                          "shroudhb-modal"};

/* The sector, the ring of it, and both their systems at rest. */
typedef struct {
  mesh_fe               mesh;
  sector_ring           ring;
  fem_system            whole;
  modal_result          result;
  modal_nodal_diameters models; /* as read from the file */
} scene;

static void create(scene *s) {
  modal_settings    settings = default_settings();
  mesh_cyclic_sides sides;
  use_elements(MESH_HEX20);
  s->mesh = make_bladed_sector(BLADES, 1);
  assert_ok(box_write(&s->mesh, scratch("sector.msh")));
  assert_ok(modal_stage(PETSC_COMM_WORLD, scratch("sector.msh"), scratch("sector.modal.h5"),
                        &settings, &provenance, NULL));
  assert_ok(modal_nodal_diameters_read(scratch("sector.modal.h5"), &s->models));
  assert_ok(mesh_cyclic_pair(&s->mesh, MESH_AXIS_X, BLADES, &sides));
  assert_ok(mesh_fe_orient(&s->mesh, MESH_AXIS_X));
  assert_ok(modal_solve(PETSC_COMM_WORLD, &s->mesh, &settings, NULL, &s->result));
  s->ring = make_sector_ring(&s->mesh, MESH_AXIS_X, BLADES);
  assert_int_equal(
      fem_system_create(PETSC_COMM_SELF, &s->ring.mesh, &steel, FEM_STANDARD, &s->whole), 0);
}

static void destroy(scene *s) {
  modal_nodal_diameters_free(&s->models);
  modal_result_free(&s->result);
  fem_system_destroy(&s->whole);
  free_sector_ring(&s->ring);
  mesh_fe_free(&s->mesh);
}

/* ------------------------------------------------------------------ the ring, driven directly */

/* Factor of K - omega^2 M of the ring, which is indefinite. */
static Mat factor_at(const scene *s, double omega) {
  MatFactorInfo info;
  Mat           A, factor;
  assert_int_equal(fem_system_shifted(&s->whole, omega * omega, &A), 0);
  assert_int_equal(MatSetOption(A, MAT_SPD, PETSC_FALSE), 0);
  assert_int_equal(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE), 0);
  assert_int_equal(MatGetFactor(A, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &factor), 0);
  assert_int_equal(MatFactorInfoInitialize(&info), 0);
  assert_int_equal(MatCholeskyFactorSymbolic(factor, A, NULL, &info), 0);
  assert_int_equal(MatCholeskyFactorNumeric(factor, A, &info), 0);
  MatDestroy(&A);
  return factor;
}

/* f += factor times the force of dof c on sector b, turned by b sectors. */
static void add_force(const scene *s, const modal_dofs *dofs, int c, int b, double factor, Vec f) {
  double *value;
  assert_int_equal(VecGetArray(f, &value), 0);
  for (int e = dofs->start[c]; e < dofs->start[c + 1]; e++) {
    double         turned[3];
    const PetscInt row = s->whole.row[s->ring.node[b * s->mesh.n_nodes + dofs->node[e]]];
    mesh_axis_rotate(MESH_AXIS_X, SHB_TWO_PI * b / BLADES, dofs->weight + 3 * e, turned);
    for (int d = 0; d < 3 && row >= 0; d++) value[3 * row + d] += factor * turned[d];
  }
  assert_int_equal(VecRestoreArray(f, &value), 0);
}

/* Response of all nodes of the ring to the travelling wave sum_c weight[c] dof c.
 *   wave  in   n, sector b lags by 2 pi n b/N
 *   out   out  [ring nodes][3] */
static void solve_wave(const scene *s, Mat factor, int wave, const modal_dofs *dofs, int n,
                       const double complex *weight, double complex *out) {
  const size_t size  = 3 * (size_t)s->ring.mesh.n_nodes;
  double      *nodal = malloc(size * sizeof *nodal);
  Vec          f, x;
  assert_non_null(nodal);
  assert_int_equal(MatCreateVecs(s->whole.K, &f, &x), 0);
  memset(out, 0, size * sizeof *out);
  for (int imaginary = 0; imaginary < 2; imaginary++) {
    assert_int_equal(VecZeroEntries(f), 0);
    for (int b = 0; b < BLADES; b++)
      for (int c = 0; c < n; c++) {
        const double complex now = weight[c] * cexp(-I * SHB_TWO_PI * wave * b / BLADES);
        add_force(s, dofs, c, b, imaginary ? cimag(now) : creal(now), f);
      }
    assert_int_equal(MatSolve(factor, f, x), 0);
    assert_int_equal(fem_system_gather(&s->whole, x, nodal), 0);
    for (size_t i = 0; i < size; i++) out[i] += (imaginary ? I : 1) * nodal[i];
  }
  VecDestroy(&f);
  VecDestroy(&x);
  free(nodal);
}

/* The same at the dofs at of sector 0: out[at->n]. */
static void drive(const scene *s, Mat factor, int wave, const modal_dofs *dofs, int n,
                  const double complex *weight, const modal_dofs *at, double complex *out) {
  double complex *all = malloc(3 * (size_t)s->ring.mesh.n_nodes * sizeof *all);
  assert_non_null(all);
  solve_wave(s, factor, wave, dofs, n, weight, all);
  for (int r = 0; r < at->n; r++) {
    out[r] = 0;
    for (int e = at->start[r]; e < at->start[r + 1]; e++)
      for (int d = 0; d < 3; d++)
        out[r] += at->weight[3 * e + d] * all[3 * s->ring.node[at->node[e]] + d];
  }
  free(all);
}

/* ------------------------------------------------------------------ the models of the file */

/* Rows and columns of an array of a wave: real part and imaginary part, or NULL. */
static double complex at(const modal_wave *w, const double *re, const double *im, size_t i) {
  return modal_wave_value(w, re, im, i);
}

/* Shape of mode i at contact dof c. */
static double complex contact_shape(const modal_wave *w, int c, int i) {
  const modal_model *m = w->model, *im = w->imaginary;
  const int          right = 3 * m->n_pairs, row = c < right ? c : c - right;
  const size_t       k = (size_t)row * (size_t)m->n_modes + (size_t)i;
  return c < right ? at(w, m->right, im ? im->right : NULL, k)
                   : at(w, m->left, im ? im->left : NULL, k);
}

/* Undamped receptance between contact dofs p and l. */
static double complex receptance(const modal_wave *w, double omega, int p, int l) {
  const modal_model *m = w->model, *im = w->imaginary;
  const int          n      = modal_model_contact_dofs(m);
  const modal_series series = modal_series_at(m, omega);
  const size_t       k      = (size_t)p * (size_t)n + (size_t)l;
  double complex     sum    = 0;
  double             slope;
  for (int i = 0; i < m->n_modes; i++)
    sum += contact_shape(w, p, i) * conj(contact_shape(w, l, i)) /
           (pow(SHB_TWO_PI * m->frequency[i], 2) - omega * omega);
  sum += series.weight[0] * at(w, m->residual_flexibility, im ? im->residual_flexibility : NULL, k);
  sum += series.weight[1] * at(w, m->residual_inertia, im ? im->residual_inertia : NULL, k);
  sum += series.weight[2] * at(w, m->residual_fourth, im ? im->residual_fourth : NULL, k);
  for (int i = 0; i < m->n_residual; i++) {
    const double  *re = m->residual_shape, *part = im ? im->residual_shape : NULL;
    const size_t   r = (size_t)m->n_residual;
    double complex a = at(w, re, part, (size_t)p * r + (size_t)i);
    double complex b = at(w, re, part, (size_t)l * r + (size_t)i);
    sum += modal_series_mode(m, i, &series, &slope) * a * conj(b);
  }
  return sum;
}

/* Response of contact dof p, or with probe that of the probe's axis p, to load harmonic h. */
static double complex load_response(const modal_wave *w, double omega, int p, int h,
                                    bool at_probe) {
  const modal_model    *m = w->model, *im = w->imaginary, *l = w->loads;
  const modal_series    series = modal_series_at(m, omega);
  const int             nc = modal_model_contact_dofs(m), q3 = 3 * m->n_probes;
  const double complex *term[3]   = {l->load_residual, l->load_inertia, l->load_fourth};
  const double complex *probes[3] = {l->probe_load_residual, l->probe_load_inertia,
                                     l->probe_load_fourth};
  double complex        sum       = 0;
  double                slope;
  for (int i = 0; i < m->n_modes; i++) {
    const double complex shape = at_probe ? at(w, m->probe, im ? im->probe : NULL,
                                               (size_t)p * (size_t)m->n_modes + (size_t)i)
                                          : contact_shape(w, p, i);
    sum += shape * l->modal_force[h * m->n_modes + i] /
           (pow(SHB_TWO_PI * m->frequency[i], 2) - omega * omega);
  }
  for (int t = 0; t < 3; t++)
    sum += series.load_weight[t] * (at_probe ? probes[t][h * q3 + p] : term[t][h * nc + p]);
  for (int i = 0; i < m->n_residual; i++) {
    const double  *re   = at_probe ? m->residual_probe : m->residual_shape;
    const double  *part = !im ? NULL : at_probe ? im->residual_probe : im->residual_shape;
    double complex psi  = at(w, re, part, (size_t)p * (size_t)m->n_residual + (size_t)i);
    sum +=
        modal_series_mode(m, i, &series, &slope) * psi * l->residual_force[h * m->n_residual + i];
  }
  return sum;
}

/* ------------------------------------------------------------------ tests */

/* Greatest difference of the contact receptances of a wave, and of those of the opposite wave,
 * relative to the greatest receptance. */
static void compare_contact(const scene *s, Mat factor, double omega, int wave, double *off,
                            double *wrong) {
  const modal_condensation *to    = &s->result.to;
  const double complex      force = 1;
  double                    most = 0, here = 0, against = 0;
  double complex            out[16];
  modal_wave                w, opposite;
  int                       missing;
  assert_true(to->contact.n <= 16);
  assert_true(modal_nodal_diameters_wave(&s->models, wave, &w, &missing));
  assert_true(modal_nodal_diameters_wave(&s->models, -wave, &opposite, &missing));
  for (int l = 0; l < to->contact.n; l++) {
    modal_dofs one = to->contact;
    one.n          = 1;
    one.start      = to->contact.start + l;
    drive(s, factor, wave, &one, 1, &force, &to->contact, out);
    for (int p = 0; p < to->contact.n; p++) {
      most    = fmax(most, cabs(out[p]));
      here    = fmax(here, cabs(out[p] - receptance(&w, omega, p, l)));
      against = fmax(against, cabs(out[p] - receptance(&opposite, omega, p, l)));
    }
  }
  *off = fmax(*off, here / most);
  if (wave % (BLADES / 2)) *wrong = fmin(*wrong, against / most);
}

/* The same of the response to each load harmonic at the contact or at the probe. */
static void compare_load(const scene *s, Mat factor, double omega, int wave, bool at_probe,
                         double *off) {
  const modal_condensation *to    = &s->result.to;
  const modal_dofs         *there = at_probe ? &to->probe : &to->contact;
  double complex            out[16];
  modal_wave                w;
  int                       missing;
  assert_true(there->n <= 16);
  assert_true(modal_nodal_diameters_wave(&s->models, wave, &w, &missing));
  for (int h = 0; h <= to->load.n_harmonics; h++) {
    double most = 0, here = 0;
    drive(s, factor, wave, &to->load.dofs, to->load.dofs.n, to->load.weight + h * to->load.dofs.n,
          there, out);
    for (int p = 0; p < there->n; p++) {
      most = fmax(most, cabs(out[p]));
      here = fmax(here, cabs(out[p] - load_response(&w, omega, p, h, at_probe)));
    }
    *off = fmax(*off, here / most);
  }
}

/* Every nodal diameter and its backward wave, up to a third of the last mode. Compared are all
 * contact receptances and the response of contact and probe to each load harmonic. */
static void receptances_of_the_ring(void **state) {
  static const double bound = 1e-9;
  scene              *s     = *state;
  const double        last  = SHB_TWO_PI * s->models.model[0].frequency[MODES - 1];
  for (int f = 0; f < 3; f++) {
    const double omega    = f * last / 6;
    Mat          factor   = factor_at(s, omega);
    double       worst[3] = {0}, wrong = INFINITY;
    for (int wave = 0; wave < BLADES; wave++) {
      compare_contact(s, factor, omega, wave, &worst[0], &wrong);
      compare_load(s, factor, omega, wave, false, &worst[1]);
      compare_load(s, factor, omega, wave, true, &worst[2]);
    }
    print_message(
        "%.5g Hz: contact off by %.1e, load at contact %.1e, at probe %.1e; opposite sign "
        "%.1e\n",
        omega / SHB_TWO_PI, worst[0], worst[1], worst[2], wrong);
    for (int i = 0; i < 3; i++) check_below(worst[i], bound, "receptance");
    assert_true(wrong > 1e-4);
    MatDestroy(&factor);
  }
}

/* Stress of the ring in a complex motion of all its nodes. */
static void ring_stress(const scene *s, const double complex *motion, double complex *stress) {
  const size_t n = (size_t)s->ring.mesh.n_nodes;
  fem_body body  = {&s->ring.mesh, &steel, make_element_tables(FEM_STANDARD), {MESH_AXIS_X, 0}, 0};
  double  *part  = malloc(6 * n * sizeof *part);
  float   *value = malloc(12 * n * sizeof *value);
  assert_true(part && value);
  for (size_t i = 0; i < 3 * n; i++) part[i] = creal(motion[i]), part[3 * n + i] = cimag(motion[i]);
  fem_nodal_stress_change(&body, NULL, 2, part, value);
  for (size_t i = 0; i < 6 * n; i++) stress[i] = CMPLX(value[i], value[6 * n + i]);
  free((void *)body.element), free(part), free(value);
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

/* Largest difference of a field of the sector and that of sector 0 in the ring, relative. sides:
 * the same at the nodes of cyclic_right alone. */
static double off_by(const scene *s, int width, const double complex *own,
                     const double complex *ring, double *sides) {
  double off = 0, most = 0, at_sides = 0;
  for (int i = 0; i < s->mesh.n_nodes; i++)
    for (int c = 0; c < width; c++) {
      const double complex there = ring[width * s->ring.node[i] + c];
      const double         here  = cabs(own[width * i + c] - there);
      most                       = fmax(most, cabs(there));
      off                        = fmax(off, here);
      if (s->mesh.image[i] >= 0) at_sides = fmax(at_sides, here);
    }
  *sides = at_sides / most;
  return off / most;
}

static double complex *read_field(hid_t file, int n, const char *name, int rows, int nodes,
                                  int width) {
  h5_shape        shape = H5_SHAPE((hsize_t)rows, (hsize_t)nodes, (hsize_t)width);
  double complex *data;
  char            path[64];
  snprintf(path, sizeof path, "/nodal_diameter_%d/%s", n, name);
  assert_ok(h5_read_complex(file, path, &shape, &data));
  return data;
}

/* The stress of each mode is that of the ring in the mode's wave. On the cyclic sides the elements
 * of two sectors meet. */
static void stresses_of_the_ring(void **state) {
  scene          *s    = *state;
  const size_t    ring = (size_t)s->ring.mesh.n_nodes, n = (size_t)s->mesh.n_nodes;
  double complex *motion = malloc(3 * ring * sizeof *motion);
  double complex *wanted = malloc(6 * ring * sizeof *wanted);
  hid_t           file;
  assert_true(motion && wanted);
  assert_ok(h5_open(scratch("sector.modal.h5"), &file));
  for (int d = 0; d <= BLADES / 2; d++) {
    double complex *phi    = read_field(file, d, "modes/shape", MODES, s->mesh.n_nodes, 3);
    double complex *stress = read_field(file, d, "modes/stress", MODES, s->mesh.n_nodes, 6);
    double          worst = 0, worst_side = 0, side;
    for (size_t i = 0; i < MODES; i += 3) {
      spread_shape(s, d, phi + 3 * n * i, motion);
      ring_stress(s, motion, wanted);
      worst      = fmax(worst, off_by(s, 6, stress + 6 * n * i, wanted, &side));
      worst_side = fmax(worst_side, side);
    }
    print_message("nodal diameter %d: stress of the modes off by %.1e, on the sides %.1e\n", d,
                  worst, worst_side);
    check_below(worst, 3e-7, "stress of a mode, in single precision");
    free(phi), free(stress);
  }
  assert_ok(h5_close(file));
  free(motion), free(wanted);
}

/* Modes and residual columns together give motion and stress of the ring at every node. It bears a
 * static wave of unit forces, forwards and backwards. */
static void columns_of_the_ring(void **state) {
  scene               *s       = *state;
  const modal_dofs    *dof     = &s->result.to.contact;
  const int            columns = dof->n + s->result.to.load.dofs.n, nodes = s->mesh.n_nodes;
  const size_t         ring = (size_t)s->ring.mesh.n_nodes, n = (size_t)nodes;
  const double complex one    = 1;
  double complex      *motion = malloc(3 * ring * sizeof *motion), *u = malloc(3 * n * sizeof *u);
  double complex *wanted = malloc(6 * ring * sizeof *wanted), *sigma = malloc(6 * n * sizeof *u);
  Mat             factor = factor_at(s, 0);
  hid_t           file;
  assert_true(motion && wanted && u && sigma);
  assert_ok(h5_open(scratch("sector.modal.h5"), &file));
  for (int wave = 0; wave < BLADES; wave++) {
    const int       d        = modal_nodal_diameter(wave, BLADES);
    const bool      backward = d != wave;
    double complex *phi      = read_field(file, d, "modes/shape", MODES, nodes, 3);
    double complex *stress   = read_field(file, d, "modes/stress", MODES, nodes, 6);
    double complex *column   = read_field(file, d, "residual/shape", columns, nodes, 3);
    double complex *pressed  = read_field(file, d, "residual/stress", columns, nodes, 6);
    double          worst[2] = {0}, side;
    modal_wave      w;
    int             missing;
    assert_true(modal_nodal_diameters_wave(&s->models, wave, &w, &missing));
    for (int c = 0; c < dof->n; c++) {
      modal_dofs single = *dof;
      single.n          = 1;
      single.start      = dof->start + c;
      solve_wave(s, factor, wave, &single, 1, &one, motion);
      ring_stress(s, motion, wanted);
      for (size_t i = 0; i < 3 * n; i++) u[i] = column[3 * n * (size_t)c + i];
      for (size_t i = 0; i < 6 * n; i++) sigma[i] = pressed[6 * n * (size_t)c + i];
      if (backward)
        for (size_t i = 0; i < 6 * n; i++) {
          sigma[i] = conj(sigma[i]);
          if (i < 3 * n) u[i] = conj(u[i]);
        }
      for (size_t i = 0; i < MODES; i++) {
        const double complex q =
            conj(contact_shape(&w, c, (int)i)) / pow(SHB_TWO_PI * w.model->frequency[i], 2);
        for (size_t k = 0; k < 3 * n; k++)
          u[k] += q * (backward ? conj(phi[3 * n * i + k]) : phi[3 * n * i + k]);
        for (size_t k = 0; k < 6 * n; k++)
          sigma[k] += q * (backward ? conj(stress[6 * n * i + k]) : stress[6 * n * i + k]);
      }
      worst[0] = fmax(worst[0], off_by(s, 3, u, motion, &side));
      worst[1] = fmax(worst[1], off_by(s, 6, sigma, wanted, &side));
    }
    print_message("wave %d: static motion off by %.1e, stress %.1e\n", wave, worst[0], worst[1]);
    check_below(worst[0], 1e-6, "motion, columns in single precision");
    check_below(worst[1], 1e-6, "stress, in single precision");
    free(phi), free(stress), free(column), free(pressed);
  }
  assert_ok(h5_close(file));
  MatDestroy(&factor);
  free(motion), free(wanted), free(u), free(sigma);
}

/* The shapes in the file move the sides as a wave does. The check of completeness and the contact
 * patches are there; the root has no model. */
static void content_of_the_file(void **state) {
  scene *s = *state;
  hid_t  file;
  char  *by;
  assert_ok(h5_open(scratch("sector.modal.h5"), &file));
  assert_false(h5_exists(file, "/modes"));
  assert_true(h5_exists(file, "/mesh/sets/cyclic_left"));
  assert_true(h5_exists(file, "/nodal_diameter_0/contact/nodes"));
  for (int n = 0; n <= BLADES / 2; n++) {
    char path[64];
    snprintf(path, sizeof path, "/nodal_diameter_%d/modes", n);
    assert_ok(h5_read_attribute_text(file, path, "checked", &by));
    assert_string_equal(by, n > 0 ? "restart" : "inertia"); /* the mesh is small */
    free(by);
    h5_shape        shape = H5_SHAPE(MODES, (hsize_t)s->mesh.n_nodes, 3);
    double complex *phi;
    snprintf(path, sizeof path, "/nodal_diameter_%d/modes/shape", n);
    assert_ok(h5_read_complex(file, path, &shape, &phi));
    double off = 0, most = 0;
    for (int i = 0; i < s->mesh.n_nodes; i++) {
      double re[3], im[3];
      if (s->mesh.image[i] < 0) continue;
      const double complex *left = phi + 3 * s->mesh.image[i], *right = phi + 3 * i;
      const double complex  phase = cexp(-I * SHB_TWO_PI * n / BLADES);
      for (int d = 0; d < 3; d++) re[d] = creal(phase * left[d]), im[d] = cimag(phase * left[d]);
      mesh_axis_rotate(MESH_AXIS_X, SHB_TWO_PI / BLADES, re, re);
      mesh_axis_rotate(MESH_AXIS_X, SHB_TWO_PI / BLADES, im, im);
      for (int d = 0; d < 3; d++) {
        off  = fmax(off, cabs(right[d] - CMPLX(re[d], im[d])));
        most = fmax(most, cabs(right[d]));
      }
    }
    check_below(off, 1e-12 * most, "motion of the sides");
    free(phi);
  }
  assert_ok(h5_close(file));
}

static int ascending(const void *a, const void *b) {
  const double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}

/* The static equilibrium of the sector at speed is that of the ring. So are the frequencies about
 * it, with stress stiffening and spin softening. */
static void at_speed(void **state) {
  scene                *s        = *state;
  modal_settings        settings = default_settings();
  modal_nodal_diameters models;
  const fem_body        body = {
             &s->ring.mesh, &steel, make_element_tables(FEM_STANDARD), {MESH_AXIS_X, 1500}, 1e6};
  fem_equilibrium      ring;
  fem_system           system;
  modal_eigen_settings wanted = {.modes = 12};
  modal_eigen          eigen;
  double               all[BLADES * MODES], off = 0, most = 0, worst = 0, *u, *stress;
  int                  n_all = 0;
  settings.speed             = 1500;
  settings.pressure          = 1e6;
  assert_ok(modal_stage(PETSC_COMM_WORLD, scratch("sector.msh"), scratch("speed.modal.h5"),
                        &settings, &provenance, NULL));
  assert_ok(modal_nodal_diameters_read(scratch("speed.modal.h5"), &models));
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &s->ring.mesh, &steel, FEM_STANDARD, &system),
                   0);
  assert_int_equal(fem_equilibrium_solve(&body, &system, NULL, &ring), 0);
  assert_int_equal(modal_eigen_solve(&system, &wanted, &eigen), 0);
  hid_t    file;
  h5_shape shape = H5_SHAPE((hsize_t)s->mesh.n_nodes, 3);
  assert_ok(h5_open(scratch("speed.modal.h5"), &file));
  assert_ok(h5_read_double(file, "/static/displacement", &shape, &u));
  shape.dim[1] = 6;
  assert_ok(h5_read_double(file, "/static/nodal_stress", &shape, &stress));
  assert_ok(h5_close(file));
  double(*wanted_stress)[FEM_STRESSES] =
      malloc((size_t)s->ring.mesh.n_nodes * sizeof *wanted_stress);
  double stressed = 0, apart = 0;
  assert_non_null(wanted_stress);
  fem_nodal_stress(&body, ring.displacement, wanted_stress);
  for (int i = 0; i < 6 * s->mesh.n_nodes; i++) {
    const double there = wanted_stress[s->ring.node[i / 6]][i % 6];
    stressed           = fmax(stressed, fabs(there));
    apart              = fmax(apart, fabs(stress[i] - there));
  }
  print_message("static stress %.3g MPa off by %.1e\n", stressed / 1e6, apart / stressed);
  check_below(apart, 1e-9 * stressed, "static stress");
  free(wanted_stress), free(stress);
  for (int i = 0; i < 3 * s->mesh.n_nodes; i++) {
    const double there = ring.displacement[3 * s->ring.node[i / 3] + i % 3];
    most               = fmax(most, fabs(there));
    off                = fmax(off, fabs(u[i] - there));
  }
  for (int n = 0; n <= BLADES / 2; n++)
    for (int i = 0; i < MODES; i++) {
      all[n_all++] = models.model[n].frequency[i];
      if (n % (BLADES / 2)) all[n_all++] = models.model[n].frequency[i];
    }
  qsort(all, (size_t)n_all, sizeof *all, ascending);
  for (int i = 0; i < wanted.modes; i++)
    worst = fmax(worst, fabs(sqrt(eigen.lambda[i]) / SHB_TWO_PI / all[i] - 1));
  print_message(
      "at speed: displacement %.3g m off by %.1e, first mode %.6g Hz (at rest %.6g), "
      "frequencies off by %.1e\n",
      most, off / most, all[0], s->models.model[BLADES / 2].frequency[0], worst);
  check_below(off, 1e-9 * most, "displacement");
  check_below(worst, 1e-9, "frequencies");
  assert_true(fabs(all[0] / s->models.model[BLADES / 2].frequency[0] - 1) > 1e-3);
  free(u);
  free((void *)body.element);
  modal_eigen_destroy(&eigen);
  fem_equilibrium_free(&ring);
  fem_system_destroy(&system);
  modal_nodal_diameters_free(&models);
}

/* A mesh of Abaqus's format gives the same. One thread or several: the same numbers. */
static void any_format_and_number_of_threads(void **state) {
  scene                *s        = *state;
  modal_settings        settings = default_settings();
  modal_nodal_diameters models[2];
  mesh_fe               mesh = make_bladed_sector(BLADES, 1);
  const int             most = omp_get_max_threads();
  assert_ok(mesh_inp_write(&mesh, scratch("sector.inp")));
  for (int i = 0; i < 2; i++) {
    omp_set_num_threads(i ? 3 : 1);
    assert_ok(modal_stage(PETSC_COMM_WORLD, scratch("sector.inp"), scratch("inp.modal.h5"),
                          &settings, &provenance, NULL));
    assert_ok(modal_nodal_diameters_read(scratch("inp.modal.h5"), &models[i]));
  }
  omp_set_num_threads(most);
  for (int n = 0; n <= BLADES / 2; n++)
    for (int i = 0; i < MODES; i++) {
      assert_true(models[0].model[n].frequency[i] == models[1].model[n].frequency[i]);
      assert_near(models[0].model[n].frequency[i] / s->models.model[n].frequency[i], 1, 1e-10);
    }
  for (int i = 0; i < 3 * MODES; i++)
    assert_true(models[0].imaginary[1].right[i] == models[1].imaginary[1].right[i]);
  for (int i = 0; i < 2; i++) modal_nodal_diameters_free(&models[i]);
  mesh_fe_free(&mesh);
}

/* Each of several speeds is that of a file of its own; the fields are those of the main one. */
static void several_speeds(void **state) {
  (void)state;
  modal_settings        settings = default_settings();
  const double          speed[3] = {1500, 0, 900}; /* the last is the main one */
  const int             list[]   = {1, 3};
  modal_sector_speeds   all;
  modal_nodal_diameters one, main;
  settings.modes       = 8;
  settings.n_diameters = 2;
  settings.diameter    = list;
  settings.speed       = speed[2];
  settings.n_speeds    = 3;
  settings.speeds      = speed;
  assert_ok(modal_stage(PETSC_COMM_WORLD, scratch("sector.msh"), scratch("speeds.modal.h5"),
                        &settings, &provenance, NULL));
  assert_ok(modal_sector_speeds_read(scratch("speeds.modal.h5"), &all));
  assert_ok(modal_nodal_diameters_read(scratch("speeds.modal.h5"), &main));
  assert_int_equal(all.n, 3);
  settings.n_speeds = 0;
  for (int s = 0; s < 3; s++) {
    double worst   = 0;
    settings.speed = all.at[0].speed[s];
    assert_true(s == 0 || all.at[0].speed[s] > all.at[0].speed[s - 1]);
    assert_ok(modal_stage(PETSC_COMM_WORLD, scratch("sector.msh"), scratch("one.modal.h5"),
                          &settings, &provenance, NULL));
    assert_ok(modal_nodal_diameters_read(scratch("one.modal.h5"), &one));
    for (int n = 0; n < 3; n++) {
      const modal_model *a = &all.at[n].model[s], *b = &one.model[n];
      assert_int_equal(all.diameter[n], one.diameter[n]);
      for (int i = 0; i < settings.modes; i++) {
        assert_near(a->frequency[i] / b->frequency[i], 1, 1e-12);
        worst = fmax(worst, fabs(cabs(a->modal_force[settings.modes + i]) /
                                     cabs(b->modal_force[settings.modes + i]) -
                                 1));
        if (settings.speed == speed[2]) assert_true(main.model[n].frequency[i] == a->frequency[i]);
      }
      for (int i = 0; i < 36; i++)
        assert_near(a->residual_flexibility[i] / b->residual_flexibility[0],
                    b->residual_flexibility[i] / b->residual_flexibility[0], 1e-9);
    }
    print_message("%g rad/s: modal forces off by %.1e\n", settings.speed, worst);
    assert_below(worst, 1e-7);
    modal_nodal_diameters_free(&one);
  }
  for (int n = 0; n < 3; n++) /* eight modes of the first speed are nearly those of the last */
    for (int t = 0; t < 6; t++) assert_true(all.at[n].mac[2 * settings.modes + t] > 0.5);
  modal_nodal_diameters_free(&main);
  modal_sector_speeds_free(&all);
}

/* Largest difference of the contact receptances of two models up to a frequency, Hz, relative to
 * the largest one. */
static double apart(const modal_nodal_diameters *a, const modal_nodal_diameters *b, double band) {
  const int nc  = modal_model_contact_dofs(&a->model[0]);
  double    off = 0;
  for (int wave = 0; wave < BLADES; wave++)
    for (double hz = band / 10; hz < band * 1.01; hz += band / 10) {
      modal_wave w, x;
      int        missing;
      double     here = 0, most = 0;
      assert_true(modal_nodal_diameters_wave(a, wave, &w, &missing));
      assert_true(modal_nodal_diameters_wave(b, wave, &x, &missing));
      for (int p = 0; p < nc; p++)
        for (int l = 0; l < nc; l++) {
          const double complex there = receptance(&x, SHB_TWO_PI * hz, p, l);
          here = fmax(here, cabs(receptance(&w, SHB_TWO_PI * hz, p, l) - there));
          most = fmax(most, cabs(there));
        }
      off = fmax(off, here / most);
    }
  return off;
}

/* modes: auto keeps its tolerance at every nodal diameter, with as many modes at each. */
static void as_many_modes_as_needed(void **state) {
  scene         *s        = *state;
  modal_settings settings = default_settings();
  int            before   = 0;
  settings.modes          = 0;
  settings.band           = 6000;
  for (settings.tolerance = 1e-4; settings.tolerance > 1e-12; settings.tolerance /= 1e6) {
    modal_nodal_diameters models;
    assert_ok(modal_stage(PETSC_COMM_WORLD, scratch("sector.msh"), scratch("auto.modal.h5"),
                          &settings, &provenance, NULL));
    assert_ok(modal_nodal_diameters_read(scratch("auto.modal.h5"), &models));
    const double off = apart(&models, &s->models, settings.band);
    const int    n   = models.model[0].n_modes;
    print_message(
        "tolerance %.0e: %d modes, %.5g to %.5g Hz at nodal diameter 0, receptances off "
        "by %.1e\n",
        settings.tolerance, n, models.model[0].frequency[0], models.model[0].frequency[n - 1], off);
    assert_true(n >= before && n < MODES);
    for (int d = 0; d < models.n; d++)
      assert_true(models.model[d].frequency[n - 1] > 1.2 * settings.band);
    check_below(off, settings.tolerance, "receptance");
    before = n;
    modal_nodal_diameters_free(&models);
  }
}

/* A list of nodal diameters, with 0 added. */
static void a_list_of_nodal_diameters(void **state) {
  scene                *s        = *state;
  modal_settings        settings = default_settings();
  const int             list[]   = {2};
  modal_nodal_diameters models;
  settings.n_diameters = 1;
  settings.diameter    = list;
  assert_ok(modal_stage(PETSC_COMM_WORLD, scratch("sector.msh"), scratch("list.modal.h5"),
                        &settings, &provenance, NULL));
  assert_ok(modal_nodal_diameters_read(scratch("list.modal.h5"), &models));
  assert_int_equal(models.n, 2);
  assert_int_equal(models.diameter[0], 0);
  assert_int_equal(models.diameter[1], 2);
  for (int i = 0; i < MODES; i++)
    assert_true(models.model[1].frequency[i] == s->models.model[2].frequency[i]);
  modal_nodal_diameters_free(&models);
}

static void refused(const modal_settings *settings, const char *mesh, const char *text) {
  assert_refused(modal_stage(PETSC_COMM_WORLD, scratch(mesh), scratch("refused.modal.h5"), settings,
                             &provenance, NULL),
                 SHB_ERR_INPUT, text);
  assert_int_not_equal(access(scratch("refused.modal.h5"), F_OK), 0);
}

static void bad_input(void **state) {
  (void)state;
  modal_settings settings = default_settings();
  const int      above[]  = {1, 4};
  settings.blades         = 7;
  refused(
      &settings, "sector.msh",
      "the cyclic sides are 60 deg apart, a sector of 6 blades; rotor.blades is 7 (51.4286 deg)");
  settings        = default_settings();
  settings.blades = 0;
  refused(&settings, "sector.msh", "rotor.blades: the mesh has cyclic sides");
  settings             = default_settings();
  settings.n_diameters = 2;
  settings.diameter    = above;
  refused(&settings, "sector.msh", "modal.nodal_diameters: 4 is above N/2 = 3 of 6 blades");
  settings       = default_settings();
  settings.check = MODAL_CHECK_INERTIA;
  refused(&settings, "sector.msh", "modal.check: inertia");
}

/* Two blades: both cyclic sides lie half a turn apart, and nodal diameters 0 and 1 are real. */
static void two_blades(void **state) {
  (void)state;
  modal_settings        settings = default_settings();
  mesh_fe               mesh     = make_bladed_sector(2, 2);
  modal_nodal_diameters models;
  settings.blades = 2;
  assert_ok(box_write(&mesh, scratch("two.msh")));
  assert_ok(modal_stage(PETSC_COMM_WORLD, scratch("two.msh"), scratch("two.modal.h5"), &settings,
                        &provenance, NULL));
  assert_ok(modal_nodal_diameters_read(scratch("two.modal.h5"), &models));
  assert_int_equal(models.n, 2);
  assert_null(models.imaginary[1].right);
  assert_true(models.model[1].frequency[0] > 0);
  modal_nodal_diameters_free(&models);
  mesh_fe_free(&mesh);
}

static int set_up(void **state) {
  static scene s;
  if (scratch_make(state)) return 1;
  create(&s);
  *state = &s;
  return 0;
}

static int tear_down(void **state) {
  destroy(*state);
  return scratch_remove(state);
}

int main(int argc, char **argv) {
  modal_session           session;
  const struct CMUnitTest tests[] = {cmocka_unit_test(receptances_of_the_ring),
                                     cmocka_unit_test(stresses_of_the_ring),
                                     cmocka_unit_test(columns_of_the_ring),
                                     cmocka_unit_test(content_of_the_file),
                                     cmocka_unit_test(at_speed),
                                     cmocka_unit_test(several_speeds),
                                     cmocka_unit_test(as_many_modes_as_needed),
                                     cmocka_unit_test(a_list_of_nodal_diameters),
                                     cmocka_unit_test(any_format_and_number_of_threads),
                                     cmocka_unit_test(two_blades),
                                     cmocka_unit_test(bad_input)};
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failed    = cmocka_run_group_tests(tests, set_up, tear_down);
  session.fault = false;
  modal_session_end(&session, SHB_OK);
  return failed;
}
