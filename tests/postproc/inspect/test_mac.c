/* Comparison of two modal files with known MAC. */
#include <unistd.h>

#include "modal/model/model.h"
#include "postproc/inspect/mac.h"
#include "tests/support/check.h"
#include "tests/support/scratch_folder.h"

enum { MODES = 3, NODES = 5 };

static const shb_provenance PROVENANCE = {"case.yaml", "name: x\n", "a = 1\n", "shroudhb-modal"};

typedef struct {
  double factor;  /* of the frequencies */
  bool   swapped; /* modes 1 and 2 exchanged, sign of the first changed */
  double angle;   /* rotation of mode 3 towards mode 1 */
  int    pairs, nodes;
  double stretch; /* factor of the mesh coordinates */
  char   probe[8];
} variant;

static const variant usual = {1, false, 0, 2, NODES, 1, "tip"};

/* Orthogonal unit vectors of n values, modes of the variant. */
static void shapes(const variant *v, size_t n, double *to) {
  const double c = cos(v->angle), s = sin(v->angle);
  memset(to, 0, MODES * n * sizeof *to);
  to[0 * n + 1] = v->swapped ? 0 : 2.385;
  to[0 * n + 2] = v->swapped ? -1.7 : 0;
  to[1 * n + 1] = v->swapped ? 2.385 : 0;
  to[1 * n + 2] = v->swapped ? 0 : 1.7;
  to[2 * n + 0] = c;
  to[2 * n + 1] = s;
}

static const char *write_file(const variant *v, const char *name) {
  double frequency[MODES] = {107.5 * v->factor, 210.25 * v->factor, 499 * v->factor};
  double damping[MODES]   = {0.001, 0.002, 0.003}, right[6 * MODES], side[MODES * 6];
  double probe[3 * MODES], nodal[MODES * 3 * 8], nodes[3 * 8];
  double _Complex force[MODES] = {1, 2, 3};
  char        *names[1]        = {(char *)v->probe};
  const size_t n               = 3 * (size_t)v->pairs;
  const char  *out             = scratch(name);
  shapes(v, n, side);
  for (size_t i = 0; i < MODES * n; i++) right[(i % n) * MODES + i / n] = side[i];
  memset(probe, 0, sizeof probe);
  shapes(v, 3 * (size_t)v->nodes, nodal);
  for (int i = 0; i < 3 * v->nodes; i++) nodes[i] = v->stretch * (0.1 * i * i - 0.3);
  modal_model m = {.n_modes       = MODES,
                   .n_pairs       = v->pairs,
                   .n_probes      = 1,
                   .frequency     = frequency,
                   .damping_ratio = damping,
                   .right         = right,
                   .modal_force   = force,
                   .probe_name    = names,
                   .probe         = probe};
  hid_t       file;
  assert_ok(h5_create(out, &file));
  assert_ok(modal_model_write(file, &m, &PROVENANCE));
  assert_ok(h5_write_double(file, "/mesh/nodes", H5_SHAPE((hsize_t)v->nodes, 3), nodes, "m", "x"));
  assert_ok(h5_write_double(file, "/modes/shape", H5_SHAPE(MODES, (hsize_t)v->nodes, 3), nodal,
                            "kg^-1/2", "shapes"));
  assert_ok(h5_close(file));
  return out;
}

static shb_status compare(const variant *b, char **text) {
  const char *path[2];
  path[0]            = write_file(&usual, "a.modal.h5");
  path[1]            = write_file(b, "b.modal.h5");
  post_buffer out    = {0};
  shb_status  status = post_compare(path, false, &out);
  *text              = out.text;
  return status;
}

static void a_file_is_like_itself(void **state) {
  (void)state;
  char *text;
  assert_ok(compare(&usual, &text));
  assert_has(text, "MAC of the shapes at all 5 nodes of the same mesh");
  assert_has(text, "      1        107.5      1        107.5          +0   1.000\n");
  assert_has(text, "      2  0.000 1.000 0.000\n");
  free(text);
}

/* Modes of other order, sign and frequency are matched; a rotated one has the square of the
 * cosine. */
static void modes_are_found_again(void **state) {
  (void)state;
  variant b = usual;
  char   *text;
  b.factor  = 1.02;
  b.swapped = true;
  b.angle   = 0.4;
  assert_ok(compare(&b, &text));
  assert_has(text, "      1        107.5      2      214.455       +99.5   1.000\n");
  assert_has(text, "      2       210.25      1       109.65       -47.8   1.000\n");
  assert_has(text,
             "      3          499      3       508.98          +2   0.848\n"); /* cos^2 0.4 */
  assert_has(text, "      1  0.000 1.000 0.152\n");
  free(text);
}

static void other_meshes_compare_what_is_condensed(void **state) {
  (void)state;
  variant b = usual;
  char   *text;
  b.stretch = 1 + 1e-6;
  assert_ok(compare(&b, &text));
  assert_has(text,
             "the meshes differ: MAC of 9 condensed values: 2 contact pairs, one side, 1 "
             "common probe\n");
  assert_has(text, "      3          499      3          499          +0   1.000\n");
  free(text);
  b.nodes = 4;
  b.pairs = 1;
  assert_ok(compare(&b, &text));
  assert_has(text, "MAC of 3 condensed values: 1 common probe\n");
  assert_has(text, "none alike"); /* the probe does not move in this file */
  free(text);
}

static void nothing_in_common_is_refused(void **state) {
  (void)state;
  variant b = usual;
  char   *text;
  b.nodes = 4;
  b.pairs = 1;
  strcpy(b.probe, "top");
  assert_int_equal(compare(&b, &text), SHB_ERR_INPUT);
  assert_has(shb_message(), "the mode shapes cannot be compared: other meshes");
  assert_has_not(shb_message(), "\n");
  free(text);
  const char *none[2] = {"/nowhere/a.modal.h5", "/nowhere/b.modal.h5"};
  post_buffer out     = {0};
  assert_int_equal(post_compare(none, false, &out), SHB_ERR_IO);
  post_buffer_free(&out);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_file_is_like_itself),
                                     cmocka_unit_test(modes_are_found_again),
                                     cmocka_unit_test(other_meshes_compare_what_is_condensed),
                                     cmocka_unit_test(nothing_in_common_is_refused)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
