/* Maps of the contact: the way of slip in closed form, work equal to dissipation, sums of the nodes
 * equal to totals. */
#include "mhb/response/face_wear.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/scratch.h"

enum { PAIRS = 3, NODES = 4 };

/* u = A cos t along one direction at constant load: the slider goes 4 (A - mu n0/k) a cycle. */
static void way_of_a_straight_motion(void **state) {
  (void)state;
  const mhb_law          law       = {.mu = .37, .kv = 1.9, .ku = {2.3, 0, 2.3}, .n0 = 1.7};
  const double           A         = 1.213;
  double                 motion[9] = {0, 0, 0, 0, A, 0, 0, 0, 0}, way, work;
  mhb_contact_evaluator *contact;
  assert_int_equal(mhb_contact_evaluator_create(1, 7, 1e-8, &contact), SHB_OK);
  mhb_slip_way(contact, &law, motion, 1, 16, &way, &work);
  const double wanted = 4 * (A - law.mu * law.n0 / law.ku[0]);
  print_message("way %.12g, by hand %.12g\n", way, wanted);
  assert_near(way, wanted, 1e-9);
  assert_near(work, law.mu * law.n0 * wanted, 1e-9);
  motion[4] = .9 * law.mu * law.n0 / law.ku[0]; /* it sticks */
  mhb_slip_way(contact, &law, motion, 1, 16, &way, &work);
  assert_true(way == 0 && work == 0);
  mhb_contact_evaluator_destroy(contact);
}

/* Motion in the plane, with lift-off: work along the way is the dissipation, to second order. */
static void work_is_the_dissipation(void **state) {
  (void)state;
  const mhb_law    law        = {.mu = .4, .kv = .8, .ku = {1.1, .2, .9}, .n0 = .5};
  const double     motion[15] = {.1, .7, .2, -.1, .05, .03, 1.1, .3, .1, -.2, .02, -.5, .9, .2, .1};
  double           force[3 * 31], error[3], way[4], work;
  mhb_contact_info info;
  mhb_contact_evaluator *contact;
  assert_int_equal(mhb_contact_evaluator_create(2, 15, 1e-10, &contact), SHB_OK);
  mhb_contact_force(contact, &law, motion, force, NULL, &info);
  assert_true(info.share[MHB_SLIDE] > .1 && info.share[MHB_SEPARATE] > .05);
  for (int i = 0; i < 4; i++) {
    mhb_slip_way(contact, &law, motion, 2, 64 << i, &way[i], &work);
    if (i < 3) error[i] = fabs(work / info.slip_work - 1);
    print_message("%d samples: way %.9g, work %.9g of %.9g\n", 64 << i, way[i], work,
                  info.slip_work);
  }
  assert_below(error[2], 2e-4);
  assert_true(error[0] / error[2] > 9); /* 16 for second order */
  assert_true(fabs(way[0] - way[1]) / fabs(way[2] - way[3]) > 9);
  mhb_contact_evaluator_destroy(contact);
}

/* Sum over the nodes of a map times the area of each; at row `row` of the map. */
static double sum_of(hid_t file, const char *name, int row) {
  h5_shape shape = H5_SHAPE(0, NODES), area = H5_SHAPE(NODES);
  double  *map, *size, sum = 0;
  assert_int_equal(h5_read_double(file, name, &shape, &map), SHB_OK);
  assert_int_equal(h5_read_double(file, "/contact_face/area", &area, &size), SHB_OK);
  for (int i = 0; i < NODES; i++) sum += size[i] * map[row * NODES + i];
  free(map);
  free(size);
  return sum;
}

/* Pair 0 has two nodes, the others one each. */
static modal_contact_face face_of(const modal_model *model, double *area) {
  static double node[3 * NODES] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  static int    element[NODES] = {0, 1, 2, 3}, entry_node[NODES] = {0, 1, 2, 3};
  static int    entry_pair[NODES] = {0, 0, 1, 2};
  static double part[NODES]       = {1, 1, 1, 1};
  for (int i = 0; i < NODES; i++) area[i] = model->area[entry_pair[i]] * (i < 2 ? .5 : 1);
  return (modal_contact_face){.n_nodes    = NODES,
                              .n_elements = 1,
                              .corners    = NODES,
                              .node       = node,
                              .area       = area,
                              .element    = element,
                              .n_entries  = NODES,
                              .entry_node = entry_node,
                              .entry_pair = entry_pair,
                              .entry_part = part};
}

static void check_peak(hid_t file, const mhb_response *r, const modal_model *model, int row) {
  const mhb_branch *b     = &r->branch[2];
  const int         point = b->wear.point[row];
  double            lost = 0, load = 0, area = 0;
  for (int a = 0; a < PAIRS; a++) {
    const size_t at = (size_t)point * PAIRS + (size_t)a;
    lost += b->dissipation[at];
    load += creal(b->force[3 * at * (size_t)(b->n_harmonics + 1)]);
    area += model->area[a];
    const double slipping = b->wear.state[3 * (row * PAIRS + a) + MHB_SLIDE];
    assert_int_equal(b->wear.slip[row * PAIRS + a] > 0, slipping > 0);
  }
  double told = sum_of(file, "/branch_2/face/dissipation", row);
  double n0   = sum_of(file, "/branch_2/face/pressure", row) - load;
  print_message("peak at %.4f Hz: dissipation %.6e, by nodes %.6e; preload %.6f\n",
                b->frequency[point], lost, told, n0);
  assert_below(fabs(told - lost), 1e-13 * fabs(lost) + 1e-18);
  assert_near(n0, .3, 1e-9);
}

static void sums_are_the_totals(void **state) {
  (void)state;
  static const shb_provenance from = {"case.yaml", "name: x\n", "mu = 0.4\n", "shroudhb-mhb"};
  char                        folder[SCRATCH_PATH], path[2 * SCRATCH_PATH];
  double                      area[NODES];
  modal_model                 model;
  mhb_response               *r;
  hid_t                       file;
  mhb_settings                s = random_settings(3);
  random_model(PAIRS, WITH_LEFT | WITH_AREAS, 4, &model);
  modal_contact_face face = face_of(&model, area);
  s.frequency[0]          = 1 / SHB_TWO_PI;
  s.frequency[1]          = 1.05 / SHB_TWO_PI;
  s.n_preloads            = 1;
  s.n0[0]                 = .3;
  s.stability             = MHB_STABILITY_NEVER;
  s.face                  = &face;
  scratch_create(folder);
  snprintf(path, sizeof path, "%s/r.h5", folder);
  if (mhb_forced_response(&model, &s, path, &from, NULL, &r) != SHB_OK)
    fail_msg("%s", shb_message());
  assert_true(r->branch[2].wear.n > 0);
  assert_int_equal(h5_open(path, &file), SHB_OK);
  for (int row = 0; row < r->branch[2].wear.n; row++) check_peak(file, r, &model, row);
  h5_shape element = H5_SHAPE(1, NODES);
  int     *corner;
  assert_int_equal(h5_read_int(file, "/contact_face/quadrangles", &element, &corner), SHB_OK);
  free(corner);
  h5_close(file);
  mhb_response_destroy(r);
  modal_model_free(&model);
  scratch_remove(folder);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(way_of_a_straight_motion),
      cmocka_unit_test(work_is_the_dissipation),
      cmocka_unit_test(sums_are_the_totals),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
