/* The modal file: exact round trip, optional parts, and faults named in the message. */
#include <math.h>

#include "modal/model/model.h"
#include "tests/support/files.h"

#include <hdf5_hl.h>

enum { MODES = 4, PAIRS = 2, PROBES = 3, LOADS = 2, CONTACTS = 12, RIGHT_ONLY = 6, RESIDUAL = 5 };

static double *numbers(size_t n, double seed) {
  double *out = malloc(n * sizeof *out);
  assert_non_null(out);
  for (size_t i = 0; i < n; i++) out[i] = sin(seed + 2.385 * (double)i) * 1e-3;
  return out;
}

static double complex *waves(size_t n, double seed) {
  double         *re = numbers(n, seed), *im = numbers(n, seed + 1);
  double complex *out = malloc(n * sizeof *out);
  assert_non_null(out);
  for (size_t i = 0; i < n; i++) out[i] = re[i] + I * im[i];
  free(re);
  free(im);
  return out;
}

static double *symmetric(int n, double seed) {
  double *out = numbers((size_t)(n * n), seed);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++) out[i * n + j] = out[j * n + i];
  return out;
}

static double *squares(int n, double seed) {
  double *out = numbers((size_t)n, seed);
  for (int i = 0; i < n; i++) out[i] *= out[i];
  return out;
}

/* All parts if full; else the fewest that a file may hold. */
static modal_model sample(bool full) {
  static const char *const name[] = {"tip", "mi-corde \xc3\xa9", "root"};
  modal_model              model  = {.n_modes = MODES, .n_pairs = PAIRS, .n_load = LOADS};
  model.frequency                 = numbers(MODES, 1);
  model.damping_ratio             = numbers(MODES, 2);
  for (int i = 0; i < MODES; i++) model.frequency[i] = 103.25 * (i + 1);
  for (int i = 0; i < MODES; i++) model.damping_ratio[i] = 0.002 * i;
  model.right       = numbers(PAIRS * 3 * MODES, 3);
  model.modal_force = waves((LOADS + 1) * MODES, 4);
  if (!full) return model;
  model.n_probes             = PROBES;
  model.has_left             = true;
  model.left                 = numbers(PAIRS * 3 * MODES, 5);
  model.residual_flexibility = symmetric(CONTACTS, 6);
  for (int i = 0; i < CONTACTS; i++) /* flexibility is not negative */
    model.residual_flexibility[i * (CONTACTS + 1)] =
        fabs(model.residual_flexibility[i * (CONTACTS + 1)]);
  model.residual_inertia       = symmetric(CONTACTS, 7);
  model.load_residual          = waves((LOADS + 1) * CONTACTS, 8);
  model.probe                  = numbers(PROBES * 3 * MODES, 9);
  model.probe_contact_residual = numbers(PROBES * 3 * CONTACTS, 10);
  model.probe_load_residual    = waves((LOADS + 1) * 3 * PROBES, 11);
  model.residual_fourth        = symmetric(CONTACTS, 20);
  model.load_fourth            = waves((LOADS + 1) * CONTACTS, 23);
  model.probe_contact_fourth   = numbers(PROBES * 3 * CONTACTS, 24);
  model.probe_load_fourth      = waves((LOADS + 1) * 3 * PROBES, 25);
  model.tail_order             = 6;
  model.contact_tail           = squares(2 * CONTACTS, 21);
  model.load_tail              = squares(2 * (LOADS + 1), 22);
  model.n_residual             = RESIDUAL;
  model.residual_frequency     = numbers(RESIDUAL, 26);
  for (int i = 0; i < RESIDUAL; i++) model.residual_frequency[i] = 700.5 + 50 * i;
  model.residual_shape        = numbers(CONTACTS * RESIDUAL, 27);
  model.residual_force        = waves((LOADS + 1) * RESIDUAL, 28);
  model.residual_probe        = numbers(PROBES * 3 * RESIDUAL, 29);
  model.load_inertia          = waves((LOADS + 1) * CONTACTS, 15);
  model.probe_contact_inertia = numbers(PROBES * 3 * CONTACTS, 17);
  model.probe_load_inertia    = waves((LOADS + 1) * 3 * PROBES, 18);
  model.normal                = numbers(PAIRS * 3, 12);
  model.area                  = numbers(PAIRS, 13);
  model.eigen_residual        = numbers(MODES, 14);
  model.probe_name            = calloc(PROBES, sizeof *model.probe_name);
  for (int i = 0; i < PROBES; i++) model.probe_name[i] = strdup(name[i]);
  for (int i = 0; i < PAIRS; i++) {
    model.area[i] = 1e-5 * (i + 1);
    for (int j = 0; j < 3; j++) model.normal[3 * i + j] = (double[]){0.6, 0.8, 0}[j];
  }
  return model;
}

static const shb_provenance from = {"case.yaml", "name: x\n", "modes = 4\n", "shroudhb-modal"};

static void write_model(const char *name, const modal_model *model) {
  hid_t file;
  assert_ok(h5_create(scratch(name), &file));
  assert_ok(modal_model_write(file, model, &from));
  assert_ok(h5_close(file));
}

/* Open for changes in place, as another program might. */
static hid_t edit(const char *name) {
  hid_t file = H5Fopen(scratch(name), H5F_ACC_RDWR, H5P_DEFAULT);
  assert_true(file >= 0);
  return file;
}

static shb_status read_only(const char *path) {
  modal_model model;
  shb_status  status = modal_model_read(path, &model);
  if (status == SHB_OK) modal_model_free(&model);
  return status;
}

#define assert_same(a, b, member, count) \
  assert_memory_equal((a).member, (b).member, (count) * sizeof *(a).member)

static void test_round_trip(void **state) {
  (void)state;
  modal_model wrote = sample(true), read;
  write_model("full.h5", &wrote);
  assert_ok(modal_model_read(scratch("full.h5"), &read));
  assert_int_equal(read.n_modes, MODES);
  assert_int_equal(read.n_pairs, PAIRS);
  assert_int_equal(read.n_probes, PROBES);
  assert_int_equal(read.n_load, LOADS);
  assert_true(read.has_left);
  assert_same(wrote, read, frequency, MODES);
  assert_same(wrote, read, damping_ratio, MODES);
  assert_same(wrote, read, eigen_residual, MODES);
  assert_same(wrote, read, right, PAIRS * 3 * MODES);
  assert_same(wrote, read, left, PAIRS * 3 * MODES);
  assert_same(wrote, read, residual_flexibility, CONTACTS * CONTACTS);
  assert_same(wrote, read, residual_inertia, CONTACTS * CONTACTS);
  assert_same(wrote, read, modal_force, (LOADS + 1) * MODES);
  assert_same(wrote, read, load_residual, (LOADS + 1) * CONTACTS);
  assert_same(wrote, read, probe, PROBES * 3 * MODES);
  assert_same(wrote, read, probe_contact_residual, PROBES * 3 * CONTACTS);
  assert_same(wrote, read, probe_load_residual, (LOADS + 1) * 3 * PROBES);
  assert_same(wrote, read, residual_fourth, CONTACTS * CONTACTS);
  assert_int_equal(read.tail_order, 6);
  assert_same(wrote, read, contact_tail, 2 * CONTACTS);
  assert_same(wrote, read, load_tail, 2 * (LOADS + 1));
  assert_same(wrote, read, load_fourth, (LOADS + 1) * CONTACTS);
  assert_same(wrote, read, probe_contact_fourth, PROBES * 3 * CONTACTS);
  assert_same(wrote, read, probe_load_fourth, (LOADS + 1) * 3 * PROBES);
  assert_int_equal(read.n_residual, RESIDUAL);
  assert_same(wrote, read, residual_frequency, RESIDUAL);
  assert_same(wrote, read, residual_shape, CONTACTS * RESIDUAL);
  assert_same(wrote, read, residual_force, (LOADS + 1) * RESIDUAL);
  assert_same(wrote, read, residual_probe, PROBES * 3 * RESIDUAL);
  assert_same(wrote, read, load_inertia, (LOADS + 1) * CONTACTS);
  assert_same(wrote, read, probe_contact_inertia, PROBES * 3 * CONTACTS);
  assert_same(wrote, read, probe_load_inertia, (LOADS + 1) * 3 * PROBES);
  assert_same(wrote, read, normal, PAIRS * 3);
  assert_same(wrote, read, area, PAIRS);
  for (int i = 0; i < PROBES; i++) assert_string_equal(wrote.probe_name[i], read.probe_name[i]);
  modal_model_free(&wrote);
  modal_model_free(&read);
  assert_null(read.frequency);
}

static void test_least(void **state) {
  (void)state;
  modal_model wrote = sample(false), read;
  write_model("least.h5", &wrote);
  assert_ok(modal_model_read(scratch("least.h5"), &read));
  assert_false(read.has_left);
  assert_int_equal(read.n_probes, 0);
  assert_true(!read.left && !read.residual_flexibility && !read.residual_inertia &&
              !read.residual_fourth && !read.load_residual && !read.load_inertia &&
              !read.probe_contact_inertia && !read.probe_load_inertia && !read.probe &&
              !read.normal && !read.area);
  assert_same(wrote, read, right, PAIRS * 3 * MODES);
  assert_same(wrote, read, modal_force, (LOADS + 1) * MODES);
  modal_model_free(&wrote);
  modal_model_free(&read);
}

/* 25 arrays, the names, and 5 dimension scales of their own. */
static void test_described(void **state) {
  (void)state;
  modal_model model = sample(true);
  write_model("described.h5", &model);
  assert_int_equal(assert_described(scratch("described.h5")), 33);
  hid_t file;
  char *text;
  assert_ok(h5_open(scratch("described.h5"), &file));
  assert_ok(h5_check_format(file, "shroudhb modal model", 1));
  assert_ok(h5_read_attribute_text(file, "/contact/right/shape", "units", &text));
  assert_string_equal(text, "kg^-1/2");
  free(text);
  hid_t shape = H5Dopen2(file, "/contact/right/shape", H5P_DEFAULT);
  for (unsigned i = 0; i < 3; i++) assert_int_equal(H5DSget_num_scales(shape, i), 1);
  H5Dclose(shape);
  assert_ok(h5_close(file));
  modal_model_free(&model);
}

static void test_format(void **state) {
  (void)state;
  modal_model model = sample(false);
  write_model("format.h5", &model);
  hid_t file = edit("format.h5");
  assert_ok(h5_write_attribute_int(file, "/", "format_version", 4));
  H5Fclose(file);
  assert_refused(read_only(scratch("format.h5")), SHB_ERR_INPUT, "format_version is 4");
  file = edit("format.h5");
  assert_ok(h5_write_attribute_text(file, "/", "format", "shroudhb response"));
  H5Fclose(file);
  assert_refused(read_only(scratch("format.h5")), SHB_ERR_INPUT, "is a \"shroudhb response\" file");
  file = edit("format.h5");
  H5Adelete(file, "format");
  H5Fclose(file);
  assert_refused(read_only(scratch("format.h5")), SHB_ERR_INPUT,
                 "format.h5: is not a shroudhb modal");
  modal_model_free(&model);
}

static void test_truncated(void **state) {
  (void)state;
  modal_model model = sample(true);
  write_model("whole.h5", &model);
  assert_prefixes_refused(scratch("whole.h5"), 101, read_only);
  assert_refused(read_only(scratch("none.h5")), SHB_ERR_IO, "No such file");
  modal_model_free(&model);
}

/* Without a required dataset the file is refused by name; without an optional one it is read. */
static void test_missing(void **state) {
  (void)state;
  static const struct {
    const char *path;
    bool        optional;
  } part[]          = {{"/modes/frequency", false},
                       {"/modes/damping_ratio", false},
                       {"/contact/right/shape", false},
                       {"/contact/left/shape", false}, /* the group stays: half a left side */
                       {"/load/modal_force", false},
                       {"/probe/name", false},
                       {"/probe/shape", false},
                       {"/probe", true},
                       {"/modes/residual", true},
                       {"/residual_modes", true},
                       {"/residual_modes/frequency", false},
                       {"/residual_modes/contact", false},
                       {"/residual_modes/load", true},
                       {"/residual_modes/probe", true},
                       {"/load/residual_response", true},
                       {"/probe/contact_residual", true},
                       {"/probe/load_residual", true},
                       {"/contact/residual_tail", true},
                       {"/load/residual_tail", true},
                       {"/load/residual_fourth", true},
                       {"/probe/contact_fourth", true},
                       {"/probe/load_fourth", true},
                       {"/load/residual_inertia", true},
                       {"/probe/contact_inertia", true},
                       {"/probe/load_inertia", true},
                       {"/contact/normal", true},
                       {"/contact/area", true}};
  modal_model model = sample(true);
  for (size_t i = 0; i < sizeof part / sizeof *part; i++) {
    write_model("missing.h5", &model);
    hid_t file = edit("missing.h5");
    assert_true(H5Ldelete(file, part[i].path, H5P_DEFAULT) >= 0);
    H5Fclose(file);
    if (part[i].optional) {
      assert_ok(read_only(scratch("missing.h5")));
    } else {
      char text[64];
      snprintf(text, sizeof text, "missing.h5: %s is missing", part[i].path);
      assert_refused(read_only(scratch("missing.h5")), SHB_ERR_INPUT, text);
    }
  }
  modal_model_free(&model);
}

/* Tables and summaries know probes by their names. */
static void test_names(void **state) {
  (void)state;
  char        empty[] = "", red[] = "a\x1b[31mred\nb", turned[] = "x\u202ey", formula[] = "=1+2";
  modal_model model  = sample(true);
  char *const own    = model.probe_name[0];
  char *const name[] = {empty, red, turned};
  for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
    model.probe_name[0] = name[i];
    write_model("names.h5", &model);
    assert_refused(read_only(scratch("names.h5")), SHB_ERR_INPUT,
                   "names.h5: /probe/name: name 0 (from 0) is empty, or holds a control");
  }
  model.probe_name[0] = formula; /* no cell of a table begins so */
  write_model("names.h5", &model);
  assert_ok(read_only(scratch("names.h5")));
  model.probe_name[0] = model.probe_name[1];
  write_model("names.h5", &model);
  assert_refused(read_only(scratch("names.h5")), SHB_ERR_INPUT,
                 "names.h5: /probe/name: names 0 and 1 (from 0) are both");
  model.probe_name[0] = own;
  modal_model_free(&model);
}

/* Residual terms are optional, except below residual modes, which need them. */
static void test_residual_modes_need_terms(void **state) {
  (void)state;
  static const char *const term[] = {"/contact/residual_flexibility", "/contact/residual_inertia",
                                     "/contact/residual_fourth"};
  modal_model              model  = sample(true);
  for (size_t i = 0; i < 2 * sizeof term / sizeof *term; i++) {
    write_model("terms.h5", &model);
    hid_t file = edit("terms.h5");
    assert_true(H5Ldelete(file, term[i / 2], H5P_DEFAULT) >= 0);
    if (i % 2) assert_true(H5Ldelete(file, "/residual_modes", H5P_DEFAULT) >= 0);
    H5Fclose(file);
    if (i % 2)
      assert_ok(read_only(scratch("terms.h5")));
    else
      assert_refused(read_only(scratch("terms.h5")), SHB_ERR_INPUT,
                     "/residual_modes count beside /contact/residual_flexibility, "
                     "residual_inertia and residual_fourth only");
  }
  modal_model_free(&model);
}

/* Replace a dataset by other reals. */
static void replace(const char *name, const char *path, h5_shape shape, const double *data) {
  hid_t file = edit(name);
  assert_true(H5Ldelete(file, path, H5P_DEFAULT) >= 0);
  assert_ok(h5_write_double(file, path, shape, data, "-", "replaced"));
  H5Fclose(file);
}

static void test_shapes(void **state) {
  (void)state;
  static const struct {
    const char *path;
    h5_shape    shape;
    const char *text;
  } wrong[] = {
      {"/modes/frequency", {2, {1, 4}}, "/modes/frequency has shape [1, 4] where [any] is wanted"},
      {"/modes/frequency", {1, {0}}, "holds 0 modes"},
      {"/modes/damping_ratio", {1, {1}}, "/modes/damping_ratio has shape [1] where [4] is wanted"},
      {"/modes/damping_ratio", {0, {0}}, "/modes/damping_ratio has shape [] where [4]"},
      {"/contact/right/shape", {3, {2, 3, 5}}, "has shape [2, 3, 5] where [any, 3, 4] is wanted"},
      {"/contact/right/shape", {3, {2, 2, 4}}, "has shape [2, 2, 4] where [any, 3, 4] is wanted"},
      {"/contact/right/shape", {3, {0, 3, 4}}, "holds 0 contact pairs"},
      {"/contact/left/shape", {3, {1, 3, 4}}, "has shape [1, 3, 4] where [2, 3, 4] is wanted"},
      {"/contact/residual_flexibility", {2, {6, 6}}, "has shape [6, 6] where [12, 12] is wanted"},
      {"/contact/residual_inertia", {2, {12, 6}}, "has shape [12, 6] where [12, 12] is wanted"},
      {"/load/modal_force", {1, {4}}, "/load/modal_force has shape [4] where [any, 4] is wanted"},
      {"/load/modal_force", {2, {0, 4}}, "holds 0 harmonics"},
      {"/load/residual_response", {2, {2, 12}}, "has shape [2, 12] where [3, 12] is wanted"},
      {"/probe/shape", {3, {3, 4, 3}}, "has shape [3, 4, 3] where [3, 3, 4] is wanted"},
      {"/probe/contact_residual", {2, {3, 12}}, "has shape [3, 12] where [9, 12] is wanted"},
      {"/probe/load_residual", {2, {3, 3}}, "has shape [3, 3] where [3, 9] is wanted"},
      {"/contact/residual_fourth", {2, {6, 12}}, "has shape [6, 12] where [12, 12] is wanted"},
      {"/load/residual_inertia", {2, {3, 6}}, "has shape [3, 6] where [3, 12] is wanted"},
      {"/residual_modes/contact", {2, {12, 4}}, "has shape [12, 4] where [12, 5] is wanted"},
      {"/residual_modes/probe", {2, {3, 5}}, "has shape [3, 5] where [9, 5] is wanted"},
      {"/contact/residual_tail", {2, {12, 3}}, "has shape [12, 3] where [12, 2] is wanted"},
      {"/probe/contact_inertia", {2, {9, 6}}, "has shape [9, 6] where [9, 12] is wanted"},
      {"/probe/load_inertia", {2, {2, 9}}, "has shape [2, 9] where [3, 9] is wanted"},
      {"/contact/normal", {2, {3, 3}}, "has shape [3, 3] where [2, 3] is wanted"},
      {"/contact/area", {1, {1}}, "/contact/area has shape [1] where [2] is wanted"},
  };
  modal_model model = sample(true);
  double     *ones  = numbers(200, 1);
  for (int i = 0; i < 200; i++) ones[i] = 0.5;
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    write_model("shape.h5", &model);
    replace("shape.h5", wrong[i].path, wrong[i].shape, ones);
    assert_refused(read_only(scratch("shape.h5")), SHB_ERR_INPUT, wrong[i].text);
  }
  free(ones);
  modal_model_free(&model);
}

/* One wrong number in one array. */
typedef struct {
  size_t      offset; /* of the array in modal_model */
  size_t      index;
  double      value;
  const char *text;
} fault;

/* The model is written without the value, which another program then puts there. The writer
 * refuses it. */
static void check_not_finite(modal_model *model, double *at, double value, const char *text) {
  const double kept   = *at;
  const size_t length = strcspn(text, ":");
  char         path[80];
  double       raw[1024];
  hid_t        file;
  *at = value;
  assert_ok(h5_create(scratch("value.h5"), &file));
  assert_refused(modal_model_write(file, model, &from), SHB_ERR_INPUT, text);
  h5_abandon(file);
  *at = kept;
  write_model("value.h5", model);
  snprintf(path, sizeof path, "%.*s", (int)length, text);
  file      = edit("value.h5");
  hid_t set = H5Dopen2(file, path, H5P_DEFAULT), type = H5Dget_type(set);
  assert_true(H5Dget_storage_size(set) <= sizeof raw);
  assert_true(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, raw) >= 0);
  size_t i = 0;
  while (raw[i] != kept) i++;
  raw[i] = value;
  assert_true(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, raw) >= 0);
  H5Tclose(type);
  H5Dclose(set);
  H5Fclose(file);
  assert_refused(read_only(scratch("value.h5")), SHB_ERR_INPUT, text);
}

static void test_values(void **state) {
  (void)state;
#define IN(member) offsetof(modal_model, member)
  static const fault faults[] = {
      {IN(frequency), 0, -1, "/modes/frequency: value 0 (from 0) is -1 Hz; a frequency is 0"},
      {IN(frequency), 0, -3, "value 0 (from 0) is -3 Hz"},
      {IN(frequency), 2, 200, "value 2 (from 0), 200 Hz, is below the one before"},
      {IN(frequency), 1, NAN, "/modes/frequency: the value at [1] (from 0) is not a number"},
      {IN(damping_ratio), 3, 1, "/modes/damping_ratio: value 3 (from 0) is 1; it must be"},
      {IN(damping_ratio), 3, -1e-9, "/modes/damping_ratio: value 3 (from 0) is -1e-09"},
      {IN(right), 7, INFINITY, "/contact/right/shape: the value at [0, 1, 3] (from 0) is infinite"},
      {IN(left), 0, NAN, "/contact/left/shape: the value at [0, 0, 0]"},
      {IN(residual_flexibility), 5, 1, "/contact/residual_flexibility is not symmetric: [0, 5]"},
      {IN(residual_flexibility), 0, -1,
       "/contact/residual_flexibility: value [0, 0] is -1 m/N; what modes leave out cannot be "
       "negative"},
      {IN(residual_inertia), 30, 1, "/contact/residual_inertia is not symmetric"},
      {IN(residual_inertia), 0, NAN, "/contact/residual_inertia: the value at [0, 0]"},
      {IN(modal_force), 3, NAN, "/load/modal_force: the value at [0, 1]"},
      {IN(load_residual), 0, NAN, "/load/residual_response: the value at [0, 0]"},
      {IN(probe), 0, NAN, "/probe/shape: the value at [0, 0, 0]"},
      {IN(probe_contact_residual), 0, NAN, "/probe/contact_residual: the value"},
      {IN(probe_load_residual), 1, NAN, "/probe/load_residual: the value"},
      {IN(residual_fourth), 30, 1, "/contact/residual_fourth is not symmetric"},
      {IN(contact_tail), 2, -1, "/contact/residual_tail: value [1, 0] is -1; a sum of squares"},
      {IN(residual_frequency), 0, 0, "/residual_modes/frequency: value 0 (from 0) is 0 Hz"},
      {IN(residual_frequency), 1, 3, "value 1 (from 0) is 3 Hz; all must be positive, and ascend"},
      {IN(residual_shape), 6, NAN, "/residual_modes/contact: the value at [1, 1]"},
      {IN(residual_fourth), 0, NAN, "/contact/residual_fourth: the value at [0, 0]"},
      {IN(load_inertia), 2, NAN, "/load/residual_inertia: the value at [0, 1]"},
      {IN(probe_contact_inertia), 12, NAN, "/probe/contact_inertia: the value at [1, 0]"},
      {IN(probe_load_inertia), 0, NAN, "/probe/load_inertia: the value at [0, 0]"},
      {IN(normal), 3, 0.7, "/contact/normal: row 1 (from 0) has length 1.06301; unit vectors"},
      {IN(area), 1, 0, "/contact/area: value 1 (from 0) is 0 m^2; all must be positive"},
  };
  for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
    modal_model model = sample(true);
    double     *array;
    memcpy(&array, (char *)&model + faults[i].offset, sizeof array);
    if (isfinite(faults[i].value)) {
      array[faults[i].index] = faults[i].value;
      write_model("value.h5", &model);
      assert_refused(read_only(scratch("value.h5")), SHB_ERR_INPUT, faults[i].text);
    } else {
      check_not_finite(&model, array + faults[i].index, faults[i].value, faults[i].text);
    }
    modal_model_free(&model);
  }
}

/* Asymmetry by rounding is accepted: 1e-7 of the largest value, not 1e-5. */
static void test_symmetry_bound(void **state) {
  (void)state;
  modal_model model = sample(true);
  double      kept = model.residual_flexibility[3], largest = 0;
  for (int i = 0; i < CONTACTS * CONTACTS; i++)
    largest = fmax(largest, fabs(model.residual_flexibility[i]));
  model.residual_flexibility[3] = kept + 1e-7 * largest;
  write_model("symmetry.h5", &model);
  assert_ok(read_only(scratch("symmetry.h5")));
  model.residual_flexibility[3] = kept + 1e-5 * largest;
  write_model("symmetry.h5", &model);
  assert_refused(read_only(scratch("symmetry.h5")), SHB_ERR_INPUT, "not symmetric");
  modal_model_free(&model);
}

/* Real numbers in place of complex ones, single precision, and texts in place of numbers. */
static void test_other_types(void **state) {
  (void)state;
  modal_model model = sample(false), read;
  write_model("types.h5", &model);
  double *force = numbers((LOADS + 1) * MODES, 3);
  replace("types.h5", "/load/modal_force", H5_SHAPE(LOADS + 1, MODES), force);
  assert_ok(modal_model_read(scratch("types.h5"), &read));
  for (int i = 0; i < (LOADS + 1) * MODES; i++) assert_true(read.modal_force[i] == force[i]);
  modal_model_free(&read);
  free(force);
  hid_t         file = edit("types.h5");
  const float   f[]  = {100, 200.5f, 300, 400};
  const hsize_t m    = MODES;
  assert_true(H5Ldelete(file, "/modes/frequency", H5P_DEFAULT) >= 0);
  assert_true(H5LTmake_dataset_float(file, "/modes/frequency", 1, &m, f) >= 0);
  H5Fclose(file);
  assert_ok(modal_model_read(scratch("types.h5"), &read));
  assert_true(read.frequency[1] == 200.5);
  modal_model_free(&read);
  file = edit("types.h5");
  assert_true(H5Ldelete(file, "/modes/frequency", H5P_DEFAULT) >= 0);
  assert_true(H5LTmake_dataset_string(file, "/modes/frequency", "100 200") >= 0);
  H5Fclose(file);
  assert_refused(read_only(scratch("types.h5")), SHB_ERR_INPUT, "where [any] is wanted");
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_round_trip),     cmocka_unit_test(test_least),
      cmocka_unit_test(test_described),      cmocka_unit_test(test_format),
      cmocka_unit_test(test_truncated),      cmocka_unit_test(test_missing),
      cmocka_unit_test(test_names),          cmocka_unit_test(test_residual_modes_need_terms),
      cmocka_unit_test(test_shapes),         cmocka_unit_test(test_values),
      cmocka_unit_test(test_symmetry_bound), cmocka_unit_test(test_other_types),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
