/* The response file: exact round trip, growth, publishing without harm to an earlier result,
 * messages on faults. */
#include <math.h>
#include <signal.h>
#include <sys/resource.h>

#include "mesh/base/constants.h"
#include "mesh/base/progress.h"
#include "mhb/response/response.h"
#include "tests/support/files.h"

#include <hdf5_hl.h>

enum { PAIRS = 2, PROBES = 2, M = 3, K = M + 1, MULTIPLIERS = 4 };

static const shb_provenance from = {"case.yaml", "name: x\n", "mu = 0.3\n", "shroudhb-mhb"};

static double value(int branch, int point, int array, int i) {
  return sin(1 + 3.7 * branch + .31 * point + 17.3 * array + 2.385 * i);
}

static void fill_waves(double complex *to, int n, int branch, int point, int array) {
  for (int i = 0; i < n; i++)
    to[i] = value(branch, point, array, i) + I * value(branch, point, array + 1, i);
}

static void fill_point(mhb_response *response, int branch) {
  const int   point   = mhb_response_point(response, branch);
  mhb_branch *b       = &response->branch[branch];
  const int   contact = response->n_pairs * 3 * K, probes = response->n_probes * 3 * K;
  b->frequency[point] = 90 + .01 * point;
  b->n0[point]        = 100;
  fill_waves(b->motion + point * contact, contact, branch, point, 1);
  fill_waves(b->force + point * contact, contact, branch, point, 3);
  if (probes) fill_waves(b->probe + point * probes, probes, branch, point, 5);
  b->stable[point]  = point % 3 - 1;
  b->special[point] = point % 3;
  if (b->kind == MHB_BRANCH_NONLINEAR) {
    b->judged[point] = point % 4;
    b->loss[point]   = (point + 1) % 4;
    fill_waves(b->multipliers + point * MULTIPLIERS, MULTIPLIERS, branch, point, 9);
    b->lasting_mean[point]        = value(branch, point, 11, 0);
    b->lasting_worst[point]       = value(branch, point, 12, 0);
    b->lasting_error[point]       = 1e-3 * point;
    b->lasting_side[point]        = point % 41 - 1;
    b->lasting_offset[point]      = value(branch, point, 13, 0);
    b->lasting_periods[point]     = 25 * point;
    b->lasting_starts[point]      = point % 18;
    b->lasting_reached[point]     = point % 5;
    b->lasting_least[point]       = 0.7 / (point + 1);
    b->lasting_least_worst[point] = 0.8 / (point + 1);
    b->lasting_kind[point]        = point % MHB_LASTING_KINDS;
  }
  for (int i = 0; i < response->n_pairs * 3; i++)
    b->state[point * response->n_pairs * 3 + i] = fabs(value(branch, point, 7, i));
  for (int i = 0; i < response->n_pairs; i++)
    b->dissipation[point * response->n_pairs + i] = value(branch, point, 8, i);
  b->iterations[point]       = point % 7;
  b->seconds[point]          = 1e-3 * point;
  b->error_newton[point]     = 1e-12 * point;
  b->error_truncation[point] = 1e-5 * point;
  if (b->error_truncation_max) b->error_truncation_max[point] = 2e-5 * point;
  b->error_sampling[point] = 1e-9 * point;
  b->error_modal[point]    = 1e-4 * point;
  b->mark[point]           = (point + branch) % (MHB_ALL_MARKS + 1);
}

static double *list(int n, double step) {
  double *out = malloc((size_t)n * sizeof *out);
  assert_non_null(out);
  for (int i = 0; i < n; i++) out[i] = step * (i + 1);
  return out;
}

static mhb_response *sample(int n_probes, int points) {
  mhb_response *response = mhb_response_create(PAIRS, n_probes, M);
  assert_non_null(response);
  for (int i = 0; i < n_probes; i++) response->probe_name[i] = strdup(i ? "root" : "tip \xcf\x88");
  response->engine_order   = 5;
  response->blades         = 40;
  response->psi            = .61;
  response->phi            = -.2;
  response->subharmonics   = 2;
  response->n_multipliers  = MULTIPLIERS;
  response->n_modes        = 3;
  response->mode_frequency = list(3, 103.25);
  response->mode_damping   = list(3, .002);
  response->eigen_residual = list(3, 1e-11);
  for (int i = 0; i < 3; i++) {
    const int branch = mhb_response_branch(response, (mhb_branch_kind)i);
    assert_int_equal(branch, i);
    for (int j = 0; j < (i == 1 ? 0 : points); j++) fill_point(response, i); /* the second: empty */
  }
  response->branch[0].reason  = strdup("end of range");
  response->branch[0].lasting = strdup("2 points of 9 modulated, and a sweep");
  mhb_response_lasting_curve(&response->branch[0], 7);
  for (int i = 0; i < 7; i++) {
    response->branch[0].lasting_curve.frequency[i] = 90 + i;
    response->branch[0].lasting_curve.mean[i]      = value(0, i, 14, 0);
    response->branch[0].lasting_curve.worst[i]     = value(0, i, 15, 0);
  }
  response->branch[0].complete = true;
  response->branch[2].reason   = strdup("the step became too small at 98.2 Hz");
  return response;
}

#define assert_same(a, b, member, count) \
  assert_memory_equal((a)->member, (b)->member, (size_t)(count) * sizeof *(a)->member)

static void assert_same_branch(const mhb_response *response, const mhb_branch *a,
                               const mhb_branch *b) {
  const int n = a->n_points, contact = n * PAIRS * 3 * K;
  assert_int_equal(a->kind, b->kind);
  assert_int_equal(a->complete, b->complete);
  assert_string_equal(a->reason ? a->reason : "", b->reason);
  assert_int_equal(n, b->n_points);
  assert_int_equal(!a->lasting, !b->lasting);
  if (a->lasting) assert_string_equal(a->lasting, b->lasting);
  assert_int_equal(a->lasting_curve.n, b->lasting_curve.n);
  if (a->lasting_curve.n > 0) {
    assert_same(&a->lasting_curve, &b->lasting_curve, frequency, a->lasting_curve.n);
    assert_same(&a->lasting_curve, &b->lasting_curve, mean, a->lasting_curve.n);
    assert_same(&a->lasting_curve, &b->lasting_curve, worst, a->lasting_curve.n);
  }
  if (n == 0) return;
  assert_same(a, b, frequency, n);
  assert_same(a, b, n0, n);
  assert_same(a, b, motion, contact);
  assert_same(a, b, force, contact);
  if (response->n_probes) assert_same(a, b, probe, n * response->n_probes * 3 * K);
  assert_same(a, b, stable, n);
  assert_same(a, b, special, n);
  if (a->kind == MHB_BRANCH_NONLINEAR) {
    assert_same(a, b, judged, n);
    assert_same(a, b, loss, n);
    assert_same(a, b, multipliers, n * MULTIPLIERS);
    assert_same(a, b, lasting_mean, n);
    assert_same(a, b, lasting_worst, n);
    assert_same(a, b, lasting_error, n);
    assert_same(a, b, lasting_side, n);
    assert_same(a, b, lasting_offset, n);
    assert_same(a, b, lasting_periods, n);
    assert_same(a, b, lasting_starts, n);
    assert_same(a, b, lasting_reached, n);
    assert_same(a, b, lasting_least, n);
    assert_same(a, b, lasting_least_worst, n);
    assert_same(a, b, lasting_kind, n);
    assert_same(a, b, error_truncation_max, n);
  } else {
    assert_true(!b->judged && !b->loss && !b->multipliers);
  }
  assert_same(a, b, state, n * PAIRS * 3);
  assert_same(a, b, dissipation, n * PAIRS);
  assert_same(a, b, iterations, n);
  assert_same(a, b, seconds, n);
  assert_same(a, b, error_newton, n);
  assert_same(a, b, error_truncation, n);
  assert_same(a, b, error_sampling, n);
  assert_same(a, b, error_modal, n);
  assert_same(a, b, mark, n);
}

static void round_trip(int n_probes, int points) {
  mhb_response *wrote = sample(n_probes, points), *read;
  assert_ok(mhb_response_write(wrote, scratch("trip.h5"), &from));
  assert_ok(mhb_response_read(scratch("trip.h5"), &read));
  assert_int_equal(read->n_pairs, PAIRS);
  assert_int_equal(read->n_probes, n_probes);
  assert_int_equal(read->n_harmonics, M);
  assert_int_equal(read->subharmonics, 2);
  assert_int_equal(read->engine_order, 5);
  assert_int_equal(read->blades, 40);
  assert_true(read->psi == .61 && read->phi == -.2);
  assert_int_equal(read->n_modes, 3);
  assert_int_equal(read->n_multipliers, MULTIPLIERS);
  assert_same(wrote, read, mode_frequency, 3);
  assert_same(wrote, read, mode_damping, 3);
  assert_same(wrote, read, eigen_residual, 3);
  for (int i = 0; i < n_probes; i++) assert_string_equal(wrote->probe_name[i], read->probe_name[i]);
  assert_int_equal(read->n_branches, 3);
  for (int i = 0; i < 3; i++) assert_same_branch(wrote, &wrote->branch[i], &read->branch[i]);
  mhb_response_destroy(wrote);
  mhb_response_destroy(read);
}

/* The speed of each point, and the mark; files without it have one speed. */
static void run_up_tells_its_speeds(void **state) {
  (void)state;
  mhb_response *wrote = sample(PROBES, 7), *read;
  hid_t         file;
  double       *speed = NULL;
  h5_shape      shape = H5_SHAPE(7);
  wrote->run_up = wrote->lacks_diameters = true;
  assert_ok(mhb_response_write(wrote, scratch("speeds.h5"), &from));
  assert_ok(mhb_response_read(scratch("speeds.h5"), &read));
  assert_true(read->run_up && read->lacks_diameters);
  assert_ok(h5_open(scratch("speeds.h5"), &file));
  assert_ok(h5_read_double(file, "/branch_0/speed", &shape, &speed));
  for (int i = 0; i < 7; i++)
    assert_true(fabs(speed[i] * 5 / (SHB_TWO_PI * wrote->branch[0].frequency[i]) - 1) < 1e-14);
  assert_ok(h5_close(file));
  free(speed);
  mhb_response_destroy(read);
  wrote->run_up = wrote->lacks_diameters = false;
  assert_ok(mhb_response_write(wrote, scratch("one.h5"), &from));
  assert_ok(mhb_response_read(scratch("one.h5"), &read));
  assert_false(read->run_up || read->lacks_diameters);
  mhb_response_destroy(wrote);
  mhb_response_destroy(read);
}

static void test_round_trip(void **state) {
  (void)state;
  round_trip(PROBES, 7);
  round_trip(0, 7);
  round_trip(PROBES, 0);
}

/* Branches of order 6 have 9 harmonics in a response of order 2 with M harmonics. Their arrays are
 * as wide as their harmonics, in the file too. */
static mhb_response *with_further(void) {
  mhb_response *response = sample(PROBES, 5);
  for (int i = 0; i < 3; i++) { /* main branches 2, 3; then of 3, of 2, of 2 */
    int branch;
    if (i == 0) branch = mhb_response_branch(response, MHB_BRANCH_NONLINEAR);
    branch         = mhb_response_branch(response, MHB_BRANCH_NONLINEAR);
    mhb_branch *b  = &response->branch[branch];
    b->order       = 6;
    b->n_harmonics = 9;
    b->origin      = i == 1 ? MHB_FROM_SEARCH : MHB_FROM_FLIP;
    b->main        = i == 0 ? 3 : 2;
    for (int p = 0; p < 4; p++) {
      mhb_response_point(response, branch);
      b->frequency[p] = 10 * (i + 1) + p;
      for (int k = 0; k < PAIRS * 3 * 10; k++)
        b->motion[p * PAIRS * 3 * 10 + k] = CMPLX(100 * i + p, k);
    }
  }
  response->branch[2].searched       = false;
  response->branch[1].flips_untraced = 7;
  mhb_response_note_search(
      &response->branch[3],
      &(mhb_search){.value = 15, .order = 2, .starts = 5, .seed = 9, .found = 2, .untraced = 3});
  return response;
}

static void test_further_branches(void **state) {
  (void)state;
  mhb_response *wrote = with_further(), *read;
  mhb_response_sort(wrote);
  static const double first[] = {20, 30, 10};
  for (int i = 0; i < 3; i++) assert_true(wrote->branch[4 + i].frequency[0] == first[i]);
  assert_ok(mhb_response_write(wrote, scratch("further.h5"), &from));
  assert_ok(mhb_response_read(scratch("further.h5"), &read));
  assert_int_equal(read->n_branches, 7);
  for (int i = 0; i < 7; i++) {
    const mhb_branch *a = &wrote->branch[i], *b = &read->branch[i];
    assert_int_equal(b->order, i < 4 ? 2 : 6);
    assert_int_equal(b->n_harmonics, i < 4 ? M : 9);
    assert_int_equal(b->main, i < 4 ? i : i < 6 ? 2 : 3);
    assert_true(b->origin == a->origin && b->searched == (i != 2));
    if (i >= 4) assert_same(a, b, motion, 4 * PAIRS * 3 * 10);
    assert_int_equal(b->n_searches, i == 3);
    assert_int_equal(b->flips_untraced, i == 1 ? 7 : 0);
  }
  const mhb_search *search = &read->branch[3].search[0];
  assert_true(search->value == 15 && search->order == 2 && search->starts == 5);
  assert_true(search->seed == 9 && search->found == 2 && search->untraced == 3);
  bool drop[7] = {[4] = true};
  mhb_response_drop(read, drop);
  assert_int_equal(read->n_branches, 6);
  assert_true(read->branch[4].frequency[0] == 30 && read->branch[5].main == 3);
  const int to                 = mhb_response_branch(read, MHB_BRANCH_NONLINEAR);
  read->branch[to].n_harmonics = read->branch[4].n_harmonics;
  mhb_response_copy_points(read, to, read, 4, 3, 0);
  for (int p = 0; p < 4; p++) {
    const double complex *u = read->branch[to].motion + p * PAIRS * 3 * 10;
    assert_true(read->branch[to].frequency[p] == 33 - p && u[7] == CMPLX(200 + 3 - p, 7));
  }
  mhb_response_copy_points(read, to, read, 4, 1, 2);
  assert_true(read->branch[to].n_points == 6 && read->branch[to].frequency[4] == 31 &&
              read->branch[to].frequency[5] == 32);
  mhb_response *like = mhb_response_like(read);
  assert_true(like && like->n_branches == 0 && like->n_pairs == read->n_pairs &&
              like->n_multipliers == read->n_multipliers);
  mhb_response_destroy(like);
  mhb_response_destroy(wrote);
  mhb_response_destroy(read);
}

/* A file read back can be continued. */
static void test_growth(void **state) {
  (void)state;
  mhb_response *response = sample(PROBES, 70), *read;
  mhb_branch   *b        = &response->branch[0];
  int           point    = mhb_response_point(response, 0);
  assert_int_equal(point, 70);
  b = &response->branch[0];
  for (int i = 0; i < PAIRS * 3 * K; i++) assert_true(b->motion[point * PAIRS * 3 * K + i] == 0);
  assert_true(b->frequency[point] == 0 && b->stable[point] == 0 && b->seconds[point] == 0);
  b->n_points--; /* taken back, and asked for again: zeroed again */
  b->seconds[point] = 3;
  point             = mhb_response_point(response, 0);
  assert_true(response->branch[0].seconds[point] == 0);
  response->branch[0].frequency[point] = 1;
  assert_ok(mhb_response_write(response, scratch("grow.h5"), &from));
  assert_ok(mhb_response_read(scratch("grow.h5"), &read));
  fill_point(read, 0);
  assert_int_equal(read->branch[0].n_points, 72);
  assert_true(read->branch[0].frequency[69] == response->branch[0].frequency[69]);
  mhb_response_destroy(read);
  mhb_response_destroy(response);
}

/* The last point moved to another place keeps all its values. */
/* Whether the points of a wide branch are those of a narrow one, with zeros above. */
static void assert_wider(const mhb_branch *narrow, const mhb_branch *wide) {
  const int K_wide = wide->n_harmonics + 1;
  assert_int_equal(wide->n_points, narrow->n_points);
  for (int row = 0; row < narrow->n_points * PAIRS * 3; row++)
    for (int k = 0; k < K_wide; k++)
      assert_true(wide->motion[row * K_wide + k] == (k < K ? narrow->motion[row * K + k] : 0));
  for (int row = 0; row < narrow->n_points * PROBES * 3; row++)
    for (int k = 0; k < K_wide; k++)
      assert_true(wide->probe[row * K_wide + k] == (k < K ? narrow->probe[row * K + k] : 0));
  for (int p = 0; p < narrow->n_points; p++)
    assert_true(wide->frequency[p] == narrow->frequency[p] && wide->stable[p] == narrow->stable[p]);
}

/* In place, and by copies into a branch of more and of fewer harmonics. */
static void branches_get_room_for_more_harmonics(void **state) {
  (void)state;
  enum { WIDE = M + 4, POINTS = 70 };
  mhb_response *a  = mhb_response_create(PAIRS, PROBES, M);
  mhb_response *b  = mhb_response_create(PAIRS, PROBES, WIDE);
  a->n_multipliers = b->n_multipliers = MULTIPLIERS;
  for (int i = 0; i < 2; i++) mhb_response_branch(a, MHB_BRANCH_NONLINEAR);
  mhb_response_branch(b, MHB_BRANCH_NONLINEAR);
  for (int p = 0; p < POINTS; p++) fill_point(a, 0);
  mhb_response_copy_points(b, 0, a, 0, 0, POINTS - 1);
  assert_wider(&a->branch[0], &b->branch[0]);
  mhb_response_copy_points(a, 1, a, 0, 0, POINTS - 1);
  mhb_response_widen(a, &a->branch[1], M); /* it has them */
  assert_int_equal(a->branch[1].n_harmonics, M);
  mhb_response_widen(a, &a->branch[1], WIDE);
  assert_wider(&a->branch[0], &a->branch[1]);
  mhb_response_copy_points(a, 0, b, 0, 0, 0);
  assert_int_equal(a->branch[0].n_harmonics, WIDE);
  assert_true(a->branch[0].n_points == POINTS + 1);
  for (int i = 0; i < PAIRS * 3 * (WIDE + 1); i++)
    assert_true(a->branch[0].force[POINTS * PAIRS * 3 * (WIDE + 1) + i] == b->branch[0].force[i]);
  mhb_response_destroy(a);
  mhb_response_destroy(b);
}

static void test_placed(void **state) {
  (void)state;
  mhb_response *response = sample(PROBES, 9), *wanted = sample(PROBES, 9);
  mhb_branch   *a = &response->branch[0], *b = &wanted->branch[0];
  const int     contact = PAIRS * 3 * K;
  mhb_response_place(response, 0, 8); /* where it is */
  assert_same_branch(response, a, b);
  mhb_response_place(response, 0, 3);
  assert_int_equal(a->n_points, 9);
  for (int i = 0; i < 9; i++) {
    int source = i < 3 ? i : i == 3 ? 8 : i - 1;
    assert_true(a->frequency[i] == b->frequency[source]);
    assert_int_equal(a->loss[i], b->loss[source]);
    assert_memory_equal(a->motion + i * contact, b->motion + source * contact,
                        (size_t)contact * sizeof *a->motion);
    assert_memory_equal(a->multipliers + i * MULTIPLIERS, b->multipliers + source * MULTIPLIERS,
                        MULTIPLIERS * sizeof *a->multipliers);
  }
  mhb_response_destroy(response);
  mhb_response_destroy(wanted);
}

/* A file of a version without multipliers is read, and can be written and continued. */
static void test_earlier_version(void **state) {
  (void)state;
  static const char *const missing[] = {"/branch_0/judged",      "/branch_0/loss",
                                        "/branch_0/multipliers", "/branch_0/mark",
                                        "/branch_2/mark",        "/multiplier"};
  mhb_response            *wrote     = sample(PROBES, 5), *read;
  assert_ok(mhb_response_write(wrote, scratch("earlier.h5"), &from));
  hid_t file = H5Fopen(scratch("earlier.h5"), H5F_ACC_RDWR, H5P_DEFAULT);
  assert_true(file >= 0);
  for (int i = 0; i < 6; i++) assert_true(H5Ldelete(file, missing[i], H5P_DEFAULT) >= 0);
  H5Fclose(file);
  assert_ok(mhb_response_read(scratch("earlier.h5"), &read));
  assert_int_equal(read->n_multipliers, 0);
  assert_null(read->branch[0].multipliers);
  for (int i = 0; i < 5; i++) {
    assert_int_equal(read->branch[0].judged[i], MHB_NOT_JUDGED);
    assert_int_equal(read->branch[0].loss[i], MHB_NO_LOSS);
    assert_true(read->branch[0].mark[i] == 0 && read->branch[2].mark[i] == 0);
    assert_int_equal(read->branch[0].stable[i], wrote->branch[0].stable[i]);
  }
  const int point                  = mhb_response_point(read, 0);
  read->branch[0].frequency[point] = 1;
  assert_ok(mhb_response_write(read, scratch("earlier2.h5"), &from));
  mhb_response_destroy(read);
  assert_ok(mhb_response_read(scratch("earlier2.h5"), &read));
  assert_int_equal(read->branch[0].n_points, 6);
  mhb_response_destroy(read);
  mhb_response_destroy(wrote);
}

static void test_described(void **state) {
  (void)state;
  mhb_response *response = sample(PROBES, 5);
  assert_ok(mhb_response_write(response, scratch("described.h5"), &from));
  assert_int_equal(assert_described(scratch("described.h5")), 3 * 16 + 3 + 5 + 9 + 16);
  hid_t file;
  char *text;
  assert_ok(h5_open(scratch("described.h5"), &file));
  assert_ok(h5_check_format(file, "shroudhb response", 1));
  assert_ok(h5_read_attribute_text(file, "/branch_2", "reason", &text));
  assert_string_equal(text, response->branch[2].reason);
  free(text);
  assert_ok(h5_read_attribute_text(file, "/", "settings", &text));
  assert_string_equal(text, from.settings);
  free(text);
  hid_t motion    = H5Dopen2(file, "/branch_0/motion", H5P_DEFAULT);
  hid_t frequency = H5Dopen2(file, "/branch_0/frequency", H5P_DEFAULT);
  assert_int_equal(H5DSis_attached(motion, frequency, 0), 1);
  for (unsigned i = 1; i < 4; i++) assert_int_equal(H5DSget_num_scales(motion, i), 1);
  H5Dclose(motion);
  H5Dclose(frequency);
  assert_ok(h5_close(file));
  mhb_response_destroy(response);
}

static shb_status read_only(const char *path) {
  mhb_response *response;
  shb_status    status = mhb_response_read(path, &response);
  if (status == SHB_OK) mhb_response_destroy(response);
  if (status != SHB_OK) assert_null(response);
  return status;
}

static void test_truncated(void **state) {
  (void)state;
  mhb_response *response = sample(PROBES, 3);
  assert_ok(mhb_response_write(response, scratch("whole.h5"), &from));
  assert_prefixes_refused(scratch("whole.h5"), 211, read_only);
  mhb_response_destroy(response);
}

/* Replaces a dataset by values of a shape (NULL: removes it). The reader's message must contain
 * text. */
typedef struct {
  const char *path;
  h5_shape    shape;
  double      fill;
  const char *text;
} fault;

static void check_fault(const fault *f) {
  double data[200];
  for (int i = 0; i < 200; i++) data[i] = f->fill;
  hid_t file = H5Fopen(scratch("fault.h5"), H5F_ACC_RDWR, H5P_DEFAULT);
  assert_true(file >= 0 && H5Ldelete(file, f->path, H5P_DEFAULT) >= 0);
  if (f->shape.rank)
    assert_true(H5LTmake_dataset_double(file, f->path, f->shape.rank, f->shape.dim, data) >= 0);
  H5Fclose(file);
  assert_refused(read_only(scratch("fault.h5")), SHB_ERR_INPUT, f->text);
}

static void test_faults(void **state) {
  (void)state;
  static const fault faults[] = {
      {"/pair", {0}, 0, "/pair is missing"},
      {"/harmonic", {2, {2, 2}}, 1, "/pair and /harmonic must be lists"},
      {"/branch_1", {0}, 0, "/branch_1 is missing"},
      {"/branch_2", {1, {3}}, 0, "/branch_2 is not a readable group"},
      {"/branch_0/frequency", {0}, 0, "/branch_0/frequency is missing"},
      {"/branch_0/frequency", {1, {5}}, -1, "/branch_0/frequency: value 0 (from 0) is -1 Hz"},
      {"/branch_0/frequency", {1, {4}}, 1, "/branch_0/n0 has shape [5] where [4] is wanted"},
      {"/branch_0/frequency", {2, {5, 1}}, 1, "/branch_0/frequency must be a list"},
      {"/branch_0/motion", {4, {5, 2, 3, 3}}, 1, "where [5, 2, 3, 4] is wanted"},
      {"/branch_0/motion", {4, {5, 2, 3, 4}}, NAN, "/branch_0/motion: the value at [0, 0, 0, 0]"},
      {"/branch_2/stable", {1, {5}}, 2, "/branch_2/stable: value 0 (from 0) is 2; 1, 0 or -1"},
      {"/branch_2/stable", {1, {5}}, .5, "/branch_2/stable holds 0.5 where whole numbers"},
      {"/branch_2/special", {1, {5}}, 6, "/branch_2/special: value 0 (from 0) is 6; 0 to 5"},
      {"/branch_2/mark", {1, {5}}, 8, "/branch_2/mark: value 0 (from 0) is 8; 0 to 7"},
      {"/branch_0/judged", {1, {5}}, 6, "/branch_0/judged: value 0 (from 0) is 6; 0 to 5"},
      {"/branch_0/loss", {1, {5}}, -1, "/branch_0/loss: value 0 (from 0) is -1; 0 to 3"},
      {"/branch_0/multipliers", {2, {5, 3}}, 1, "where [5, 4] is wanted"},
      {"/multiplier", {2, {2, 2}}, 1, "/multiplier must be a list"},
      {"/branch_2/error/modal", {0}, 0, "/branch_2/error/modal is missing"},
      {"/branch_2/state", {3, {5, 3, 2}}, 0, "has shape [5, 3, 2] where [5, 2, 3] is wanted"},
      {"/probe/name", {0}, 0, "/probe/name is missing"},
      {"/modes/damping_ratio", {1, {2}}, 0, "has shape [2] where [3] is wanted"},
  };
  mhb_response *response = sample(PROBES, 5);
  for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
    assert_ok(mhb_response_write(response, scratch("fault.h5"), &from));
    check_fault(&faults[i]);
  }
  mhb_response_destroy(response);
}

static void test_attribute_faults(void **state) {
  (void)state;
  static const struct {
    const char *group, *name, *value, *text;
  } wrong[] = {{"/", "format", "shroudhb modal model", "is a \"shroudhb modal model\" file"},
               {"/branch_0", "kind", "linear",
                "kind must be nonlinear, open, stuck, integration or tracked"},
               {"/branch_0", "complete", "yes", "/branch_0: attribute complete must be a number"},
               {"/", "psi", "35 deg", "attribute psi must be a number"},
               {"/", "branches", NULL, "attribute branches is missing"},
               {"/branch_0", "kind", NULL, "kind must be nonlinear"}};
  mhb_response *response = sample(PROBES, 5);
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    assert_ok(mhb_response_write(response, scratch("wrong.h5"), &from));
    hid_t file = H5Fopen(scratch("wrong.h5"), H5F_ACC_RDWR, H5P_DEFAULT);
    if (wrong[i].value) {
      assert_ok(h5_write_attribute_text(file, wrong[i].group, wrong[i].name, wrong[i].value));
    } else {
      assert_true(H5Adelete_by_name(file, wrong[i].group, wrong[i].name, H5P_DEFAULT) >= 0);
    }
    H5Fclose(file);
    assert_refused(read_only(scratch("wrong.h5")), SHB_ERR_INPUT, wrong[i].text);
  }
  mhb_response_destroy(response);
}

/* A write that fails leaves the earlier result and no temporary file. */
static void test_earlier_result_untouched(void **state) {
  (void)state;
  mhb_response *response = sample(PROBES, 5), *large = sample(PROBES, 500);
  size_t        size, size_after;
  assert_ok(mhb_response_write(response, scratch("kept.h5"), &from));
  char *before = slurp(scratch("kept.h5"), &size);
  int   files  = files_in_scratch();
  assert_refused(mhb_response_write(large, scratch("no/kept.h5"), &from), SHB_ERR_IO,
                 "no/kept.h5: cannot be written: No such file");
  struct rlimit limit, tight;
  void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
  getrlimit(RLIMIT_FSIZE, &limit);
  tight          = limit;
  tight.rlim_cur = 100000;
  setrlimit(RLIMIT_FSIZE, &tight);
  shb_status status = mhb_response_write(large, scratch("kept.h5"), &from);
  setrlimit(RLIMIT_FSIZE, &limit);
  signal(SIGXFSZ, handler);
  assert_int_equal(status, SHB_ERR_IO);
  assert_non_null(strstr(shb_message(), "kept.h5: cannot be written: File too large; the earlier"));
  char *after = slurp(scratch("kept.h5"), &size_after);
  assert_int_equal(size, size_after);
  assert_memory_equal(before, after, size);
  assert_int_equal(files_in_scratch(), files);
  assert_ok(mhb_response_write(large, scratch("kept.h5"), &from)); /* and then it works */
  free(before);
  free(after);
  mhb_response_destroy(response);
  mhb_response_destroy(large);
}

/* A response is published every ten seconds of a run: prints the cost of 5000 points, and of 300
 * branches. */
static void test_large(void **state) {
  (void)state;
  mhb_response *long_ = sample(PROBES, 2500), *many = sample(PROBES, 1);
  for (int i = 0, branch; i < 300; i++) {
    branch = mhb_response_branch(many, MHB_BRANCH_NONLINEAR);
    fill_point(many, branch);
  }
  double start = shb_seconds();
  assert_ok(mhb_response_write(long_, scratch("long.h5"), &from));
  double middle = shb_seconds();
  assert_ok(mhb_response_write(many, scratch("many.h5"), &from));
  double end = shb_seconds();
  printf("5000 points %.1f ms, 303 branches %.1f ms\n", 1e3 * (middle - start),
         1e3 * (end - middle));
  assert_ok(read_only(scratch("long.h5")));
  assert_ok(read_only(scratch("many.h5")));
  mhb_response_destroy(long_);
  mhb_response_destroy(many);
}

/* A file of a run that has more to do says so; one without the word is finished. */
static void unfinished_runs_are_told(void **state) {
  (void)state;
  mhb_response *r = sample(PROBES, 3), *read;
  for (int unfinished = 0; unfinished < 2; unfinished++) {
    r->unfinished = unfinished;
    assert_ok(mhb_response_write(r, scratch("part.h5"), &from));
    assert_ok(mhb_response_read(scratch("part.h5"), &read));
    assert_int_equal(read->unfinished, unfinished);
    mhb_response_destroy(read);
  }
  mhb_response_destroy(r);
}

static void test_create(void **state) {
  (void)state;
  assert_null(mhb_response_create(-1, 0, 1));
  assert_null(mhb_response_create(1, -1, 1));
  assert_null(mhb_response_create(1, 0, -1));
  mhb_response_destroy(NULL);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_round_trip),
      cmocka_unit_test(unfinished_runs_are_told),
      cmocka_unit_test(run_up_tells_its_speeds),
      cmocka_unit_test(test_further_branches),
      cmocka_unit_test(test_growth),
      cmocka_unit_test(branches_get_room_for_more_harmonics),
      cmocka_unit_test(test_placed),
      cmocka_unit_test(test_earlier_version),
      cmocka_unit_test(test_described),
      cmocka_unit_test(test_truncated),
      cmocka_unit_test(test_faults),
      cmocka_unit_test(test_attribute_faults),
      cmocka_unit_test(test_earlier_result_untouched),
      cmocka_unit_test(test_large),
      cmocka_unit_test(test_create),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
