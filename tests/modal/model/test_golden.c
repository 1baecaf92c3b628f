/* The modal file is pinned. Files of versions 1 to 3, written by an earlier program, are read and
 * written again. Datasets, shapes, types, values, attributes and dimension scales are the same.
 * What the HDF5 library lays out by itself is not compared: it differs between its versions.
 *
 * Argument: the folder of the golden files. */
#include "modal/model/sector_speeds.h"
#include "tests/support/files.h"

#include <hdf5_hl.h>

static const char *folder;

static const char *golden(const char *name) {
  static char path[1024];
  snprintf(path, sizeof path, "%s/%s.modal.h5", folder, name);
  return path;
}

/* ---------------------------------------------------------------- comparison of two files */

/* Stamps of the run that wrote the file. */
static bool is_stamp(const char *name) {
  static const char *const stamp[] = {"revision",  "command",  "case_path",
                                      "case_text", "settings", "created"};
  for (size_t i = 0; i < sizeof stamp / sizeof *stamp; i++)
    if (strcmp(name, stamp[i]) == 0) return true;
  return false;
}

/* Written by the modal stage beside the model. */
static bool is_of_the_stage(const char *path) {
  return strcmp(path, "contact/coordinates") == 0;
}

typedef struct {
  hid_t       other;
  int         count;           /* datasets, groups and attributes */
  const char *path;            /* of the object whose attributes are compared */
  char        difference[512]; /* the first one */
} comparison;

/* Record a difference, which ends the comparison. */
static herr_t differ(comparison *c, const char *name, const char *how) {
  snprintf(c->difference, sizeof c->difference, "%s: %s", name, how);
  return 1;
}

/* All values of a dataset or attribute as bytes, in memory of their stored type. Texts follow each
 * other. */
static char *bytes_of(hid_t object, hid_t type, hid_t space, bool is_set, size_t *size) {
  const size_t n = (size_t)H5Sget_simple_extent_npoints(space), each = H5Tget_size(type);
  char        *raw = calloc(n * each + 1, 1);
  assert_non_null(raw);
  assert_true((is_set ? H5Dread(object, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, raw)
                      : H5Aread(object, type, raw)) >= 0);
  *size = n * each;
  if (H5Tis_variable_str(type) <= 0) return raw;
  char *text = calloc(1, 1);
  *size      = 0;
  for (size_t i = 0; i < n; i++) {
    const char  *word   = ((char **)raw)[i];
    const size_t length = strlen(word) + 1;
    text                = realloc(text, *size + length);
    memcpy(text + *size, word, length);
    *size += length;
  }
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, raw);
  free(raw);
  return text;
}

static herr_t compare_values(comparison *c, const char *name, bool is_set, hid_t a, hid_t b) {
  hid_t type[2] = {is_set ? H5Dget_type(a) : H5Aget_type(a),
                   is_set ? H5Dget_type(b) : H5Aget_type(b)};
  hid_t space[2] = {is_set ? H5Dget_space(a) : H5Aget_space(a),
                    is_set ? H5Dget_space(b) : H5Aget_space(b)};
  size_t size[2];
  if (H5Tequal(type[0], type[1]) <= 0) return differ(c, name, "another type");
  if (H5Sextent_equal(space[0], space[1]) <= 0) return differ(c, name, "another shape");
  char      *value[2] = {bytes_of(a, type[0], space[0], is_set, &size[0]),
                         bytes_of(b, type[1], space[1], is_set, &size[1])};
  const bool same     = size[0] == size[1] && memcmp(value[0], value[1], size[0]) == 0;
  for (int i = 0; i < 2; i++) {
    free(value[i]);
    H5Tclose(type[i]);
    H5Sclose(space[i]);
  }
  return same ? 0 : differ(c, name, "other values");
}

static herr_t name_of_scale(hid_t set, unsigned dim, hid_t scale, void *name) {
  (void)set;
  (void)dim;
  return H5DSget_scale_name(scale, name, 256) > 0 ? 1 : -1;
}

/* References to dimension scales are addresses, which may differ. */
static herr_t compare_scales(comparison *c, hid_t a, hid_t b) {
  const hid_t space = H5Dget_space(a);
  const int   rank  = H5Sget_simple_extent_ndims(space);
  H5Sclose(space);
  for (unsigned i = 0; i < (unsigned)rank; i++) {
    char name[2][256] = {"", ""};
    assert_true(H5DSiterate_scales(a, i, NULL, name_of_scale, name[0]) >= 0);
    assert_true(H5DSiterate_scales(b, i, NULL, name_of_scale, name[1]) >= 0);
    if (strcmp(name[0], name[1]) != 0) return differ(c, c->path, "another dimension scale");
  }
  return 0;
}

static herr_t compare_attribute(hid_t object, const char *name, const H5A_info_t *info, void *of) {
  comparison *c = of;
  (void)info;
  char label[512];
  snprintf(label, sizeof label, "%s, attribute %s", c->path, name);
  if (H5Aexists_by_name(c->other, c->path, name, H5P_DEFAULT) <= 0)
    return differ(c, label, "missing");
  c->count++;
  if (is_stamp(name) || strcmp(name, "DIMENSION_LIST") == 0 || strcmp(name, "REFERENCE_LIST") == 0)
    return 0;
  const hid_t  a     = H5Aopen(object, name, H5P_DEFAULT);
  const hid_t  b     = H5Aopen_by_name(c->other, c->path, name, H5P_DEFAULT, H5P_DEFAULT);
  const herr_t found = compare_values(c, label, false, a, b);
  H5Aclose(a);
  H5Aclose(b);
  return found;
}

static herr_t compare_object(hid_t file, const char *path, const H5O_info_t *info, void *of) {
  comparison *c = of;
  if (is_of_the_stage(path)) return 0;
  if (!h5_exists(c->other, path)) return differ(c, path, "missing");
  c->path       = path;
  const hid_t a = H5Oopen(file, path, H5P_DEFAULT), b = H5Oopen(c->other, path, H5P_DEFAULT);
  H5O_info_t  there;
  assert_true(H5Oget_info(b, &there) >= 0);
  assert_int_equal(info->type, there.type);
  herr_t found = H5Aiterate2(a, H5_INDEX_NAME, H5_ITER_INC, NULL, compare_attribute, c);
  if (found == 0 && info->type == H5O_TYPE_DATASET) found = compare_values(c, path, true, a, b);
  if (found == 0 && info->type == H5O_TYPE_DATASET) found = compare_scales(c, a, b);
  c->count++;
  H5Oclose(a);
  H5Oclose(b);
  return found;
}

/* Returns the number of datasets, groups and attributes. difference: the first one, or empty. */
static int compare_files(const char *first, const char *second, char difference[512]) {
  hid_t      file[2];
  comparison c[2] = {{0}};
  assert_ok(h5_open(first, &file[0]));
  assert_ok(h5_open(second, &file[1]));
  for (int i = 0; i < 2 && !c[0].difference[0]; i++) {
    c[i].other = file[1 - i];
    assert_true(H5Ovisit(file[i], H5_INDEX_NAME, H5_ITER_INC, compare_object, &c[i]) >= 0);
  }
  for (int i = 0; i < 2; i++) assert_ok(h5_close(file[i]));
  strcpy(difference, c[c[0].difference[0] ? 0 : 1].difference);
  return c[0].count;
}

/* ---------------------------------------------------------------- reading and writing again */

static const shb_provenance now = {"another.yaml", "name: y\n", "modes = 4\n", "test"};

static void rewrite_blade(const char *from, hid_t file) {
  modal_model  model;
  modal_speeds speeds;
  assert_ok(modal_model_read(from, &model));
  assert_ok(modal_speeds_read(from, &speeds));
  assert_ok(modal_model_write(file, &model, &now));
  if (speeds.n > 0) assert_ok(modal_speeds_write(file, &speeds));
  modal_model_free(&model);
  modal_speeds_free(&speeds);
}

static void rewrite_disc(const char *from, hid_t file) {
  modal_nodal_diameters disc;
  modal_sector_speeds   speeds;
  assert_ok(modal_nodal_diameters_read(from, &disc));
  assert_ok(modal_sector_speeds_read(from, &speeds));
  assert_ok(h5_write_provenance(file, "shroudhb modal model", MODAL_DIAMETERS_VERSION, &now));
  assert_ok(modal_nodal_diameters_write(file, &disc));
  assert_ok(modal_sector_speeds_write(file, &speeds));
  modal_nodal_diameters_free(&disc);
  modal_sector_speeds_free(&speeds);
}

/*   wanted  in  objects and attributes in the file */
static void check_rewritten(const char *name, void (*rewrite)(const char *, hid_t), int wanted) {
  hid_t file;
  char  difference[512];
  assert_ok(h5_create(scratch("again.h5"), &file));
  rewrite(golden(name), file);
  assert_ok(h5_close(file));
  const int count = compare_files(golden(name), scratch("again.h5"), difference);
  if (difference[0]) fail_msg("%s: %s", name, difference);
  printf("%s: %d objects and attributes are the same\n", name, count);
  assert_int_equal(count, wanted);
}

static void version_1_is_written_as_it_was_read(void **state) {
  (void)state;
  check_rewritten("blade", rewrite_blade, 176);
  check_rewritten("ground", rewrite_blade, 52);
  check_rewritten("untouched", rewrite_blade, 55);
}

static void version_2_is_written_as_it_was_read(void **state) {
  (void)state;
  check_rewritten("speeds", rewrite_blade, 537);
}

static void version_3_is_written_as_it_was_read(void **state) {
  (void)state;
  check_rewritten("disc", rewrite_disc, 530);
  check_rewritten("disc_speeds", rewrite_disc, 1135);
}

static void change_value(hid_t file) {
  static const double area[] = {1.1e-5, 2.3e-5};
  assert_ok(h5_replace_double(file, "contact/area", H5_SHAPE(2), area));
}

static void change_unit(hid_t file) {
  assert_ok(h5_write_attribute_text(file, "contact/area", "units", "mm^2"));
}

static void drop_dataset(hid_t file) {
  assert_true(H5Ldelete(file, "probe/load_fourth", H5P_DEFAULT) >= 0);
}

static void add_dataset(hid_t file) {
  assert_ok(h5_write_counter(file, "contact/more", 2, "more"));
}

static void detach_scale(hid_t file) {
  const hid_t set   = H5Dopen2(file, "contact/normal", H5P_DEFAULT);
  const hid_t scale = H5Dopen2(file, "contact/pair", H5P_DEFAULT);
  assert_true(H5DSdetach_scale(set, scale, 0) >= 0);
  H5Dclose(set);
  H5Dclose(scale);
}

static void each_difference_is_found(void **state) {
  static const struct {
    void (*change)(hid_t file);
    const char *difference;
  } row[] = {{change_value, "contact/area: other values"},
             {change_unit, "contact/area, attribute units: other values"},
             {drop_dataset, "probe/load_fourth: missing"},
             {add_dataset, "contact/more: missing"},
             {detach_scale, "contact/normal: another dimension scale"}};
  (void)state;
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    hid_t file;
    char  difference[512];
    assert_ok(h5_create_like(golden("blade"), scratch("changed.h5"), &file));
    row[i].change(file);
    assert_ok(h5_close(file));
    compare_files(golden("blade"), scratch("changed.h5"), difference);
    assert_string_equal(difference, row[i].difference);
  }
}

/* ---------------------------------------------------------------- each dataset in its place */

typedef enum { REAL, SPLIT, LOAD } kind;

#define AT(name) offsetof(modal_model, name)
static const struct {
  const char *path;
  size_t      offset;
  kind        kind;
} place[] = {
    {"modes/frequency", AT(frequency), REAL},
    {"modes/damping_ratio", AT(damping_ratio), REAL},
    {"modes/residual", AT(eigen_residual), REAL},
    {"modes/coriolis", AT(coriolis), SPLIT},
    {"contact/right/shape", AT(right), SPLIT},
    {"contact/left/shape", AT(left), SPLIT},
    {"contact/residual_flexibility", AT(residual_flexibility), SPLIT},
    {"contact/residual_inertia", AT(residual_inertia), SPLIT},
    {"contact/residual_fourth", AT(residual_fourth), SPLIT},
    {"contact/residual_tail", AT(contact_tail), REAL},
    {"residual_modes/frequency", AT(residual_frequency), REAL},
    {"residual_modes/contact", AT(residual_shape), SPLIT},
    {"residual_modes/load", AT(residual_force), LOAD},
    {"residual_modes/probe", AT(residual_probe), SPLIT},
    {"contact/normal", AT(normal), REAL},
    {"contact/area", AT(area), REAL},
    {"contact/coordinates", AT(position), REAL},
    {"load/modal_force", AT(modal_force), LOAD},
    {"load/residual_response", AT(load_residual), LOAD},
    {"load/residual_inertia", AT(load_inertia), LOAD},
    {"load/residual_fourth", AT(load_fourth), LOAD},
    {"load/residual_tail", AT(load_tail), REAL},
    {"probe/shape", AT(probe), SPLIT},
    {"probe/contact_residual", AT(probe_contact_residual), SPLIT},
    {"probe/contact_inertia", AT(probe_contact_inertia), SPLIT},
    {"probe/contact_fourth", AT(probe_contact_fourth), SPLIT},
    {"probe/load_residual", AT(probe_load_residual), LOAD},
    {"probe/load_inertia", AT(probe_load_inertia), LOAD},
    {"probe/load_fourth", AT(probe_load_fourth), LOAD},
};

static const double *member(const modal_model *model, size_t offset) {
  const double *data;
  memcpy(&data, (const char *)model + offset, sizeof data);
  return data;
}

/* Values of a dataset of complex or real numbers beside the members. */
static void check_place(hid_t group, const char *path, const double *re, const double *im) {
  h5_shape        shape;
  double complex *value;
  assert_ok(h5_shape_of(group, path, &shape));
  assert_ok(h5_read_complex(group, path, &shape, &value));
  assert_non_null(re);
  for (size_t i = 0; i < h5_count(shape); i++)
    if (re[i] != creal(value[i]) || (im ? im[i] : 0) != cimag(value[i]))
      fail_msg("%s: value %zu is in another place", path, i);
  free(value);
}

static void check_load(hid_t group, const char *path, const double *data) {
  h5_shape        shape;
  double complex *value;
  assert_ok(h5_shape_of(group, path, &shape));
  assert_ok(h5_read_complex(group, path, &shape, &value));
  assert_non_null(data);
  if (memcmp(value, data, h5_count(shape) * sizeof *value) != 0)
    fail_msg("%s is in another place", path);
  free(value);
}

/*   im, back  in  of a travelling wave; NULL: real */
static void check_places(hid_t group, const modal_model *re, const modal_model *im,
                         const modal_model *back) {
  int checked = 0;
  for (size_t i = 0; i < sizeof place / sizeof *place; i++) {
    const char *path = place[i].path;
    char        backward[128];
    if (!h5_exists(group, path)) continue;
    checked++;
    if (place[i].kind != LOAD) {
      const bool split = im && place[i].kind == SPLIT;
      check_place(group, path, member(re, place[i].offset),
                  split ? member(im, place[i].offset) : NULL);
      continue;
    }
    check_load(group, path, member(re, place[i].offset));
    snprintf(backward, sizeof backward, "backward/%s", path);
    if (back) check_load(group, backward, member(back, place[i].offset));
  }
  assert_in_range(checked, sizeof place / sizeof *place - 1, sizeof place / sizeof *place);
}

static void every_dataset_is_read_into_its_place(void **state) {
  (void)state;
  modal_model model;
  hid_t       file;
  assert_ok(modal_model_read(golden("blade"), &model));
  assert_ok(h5_open(golden("blade"), &file));
  check_places(file, &model, NULL, NULL);
  assert_int_equal(model.tail_order, 6);
  assert_int_equal(model.n_interfaces, 2);
  assert_string_equal(model.interface_name[1], "snubber");
  assert_true(model.interface[0] == 0 && model.interface[1] == 1);
  assert_string_equal(model.probe_name[0], "tip");
  modal_model_free(&model);
  assert_ok(h5_close(file));
}

static void the_parts_of_a_wave_are_read_into_their_places(void **state) {
  (void)state;
  modal_nodal_diameters disc;
  hid_t                 file;
  assert_ok(modal_nodal_diameters_read(golden("disc"), &disc));
  assert_ok(h5_open(golden("disc"), &file));
  for (int i = 0; i < disc.n; i++) {
    char name[32];
    snprintf(name, sizeof name, "nodal_diameter_%d", disc.diameter[i]);
    const hid_t group = H5Gopen2(file, name, H5P_DEFAULT);
    const bool  wave  = disc.diameter[i] == 1;
    check_places(group, &disc.model[i], wave ? &disc.imaginary[i] : NULL,
                 wave ? &disc.backward[i] : NULL);
    H5Gclose(group);
  }
  modal_nodal_diameters_free(&disc);
  assert_ok(h5_close(file));
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(version_1_is_written_as_it_was_read),
      cmocka_unit_test(version_2_is_written_as_it_was_read),
      cmocka_unit_test(version_3_is_written_as_it_was_read),
      cmocka_unit_test(each_difference_is_found),
      cmocka_unit_test(every_dataset_is_read_into_its_place),
      cmocka_unit_test(the_parts_of_a_wave_are_read_into_their_places),
  };
  if (argc != 2) return 2;
  folder = argv[1];
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
