#include <sys/stat.h>
#include <unistd.h>

#include "postproc/report/publish.h"
#include "tests/support/check.h"
#include "tests/support/fixture.h"

static char folder[] = "/tmp/shroudhb-publish-XXXXXX";
static char response[256], html[256], csv[256], svg[256];

static int make_folder(void **state) {
  (void)state;
  if (!mkdtemp(folder)) return -1;
  snprintf(response, sizeof response, "%s/x.response.h5", folder);
  snprintf(html, sizeof html, "%s/x.html", folder);
  snprintf(csv, sizeof csv, "%s/x.csv", folder);
  snprintf(svg, sizeof svg, "%s/x.svg", folder);
  return 0;
}

static int remove_folder(void **state) {
  (void)state;
  char command[300];
  snprintf(command, sizeof command, "rm -r %s", folder);
  return system(command);
}

static void write_response(const fixture_options *o) {
  const shb_provenance provenance = {"case.yaml", fixture_hostile, "a = 1\n", "shroudhb-mhb"};
  mhb_response        *r          = fixture_response(o);
  assert_non_null(r);
  assert_ok(mhb_response_write(r, response, &provenance));
  mhb_response_destroy(r);
}

static char *contents(const char *path) {
  struct stat info;
  if (stat(path, &info) != 0) return NULL;
  char *text = calloc((size_t)info.st_size + 1, 1);
  FILE *file = fopen(path, "rb");
  assert_int_equal(fread(text, 1, (size_t)info.st_size, file), info.st_size);
  fclose(file);
  return text;
}

static const char *integration; /* of the next publish, or NULL */

static shb_status publish(char **summary) {
  const post_job job      = {"x",  response, html, csv,  svg,         NULL, integration,
                             NULL, NULL,     NULL, NULL, MESH_AXIS_X, 0};
  shb_progress   progress = shb_progress_start("post", true, false);
  return post_publish(&job, &progress, summary);
}

static void whole(void **state) {
  (void)state;
  fixture_options o       = fixture_usual();
  char           *summary = NULL, *text;
  write_response(&o);
  assert_ok(publish(&summary));
  assert_has(summary, "lowest (n0 = 100");
  assert_null(strchr(summary, '\n'));
  free(summary);
  text = contents(html);
  assert_has(text, "<!DOCTYPE html>");
  assert_has(text, "</html>");
  assert_has(text, "shroudhb-mhb"); /* provenance of the file */
  assert_has(text, "&lt;script&gt;alert(1)");
  free(text);
  text = contents(csv);
  assert_memory_equal(text, "branch,kind,n0_N,", 17);
  free(text);
  text = contents(svg);
  assert_has(text, "</svg>");
  free(text);
}

static int count(const char *text, const char *what) {
  int n = 0;
  for (const char *at = text; (at = strstr(at, what)) != NULL; at++) n++;
  return n;
}

/* Points by time integration: dots on the curves of their preload, rows of the table, no peaks. */
static void with_points(void **state) {
  (void)state;
  fixture_options o = fixture_usual();
  char            path[300];
  write_response(&o);
  mhb_response *whole, *points;
  assert_ok(publish(NULL));
  char *without = contents(html);
  assert_ok(mhb_response_read(response, &whole));
  points = mhb_response_create(whole->n_pairs, whole->n_probes, whole->n_harmonics);
  int branch, at;
  branch = mhb_response_branch(points, MHB_BRANCH_INTEGRATION);
  for (int i = 0; i < 3; i++) {
    size_t row     = 3 * (size_t)whole->n_probes * ((size_t)whole->n_harmonics + 1);
    at             = mhb_response_point(points, branch);
    mhb_branch *to = &points->branch[0], *from = &whole->branch[0];
    to->frequency[at] = from->frequency[10 * i];
    to->n0[at]        = 100;
    to->multiple[at]  = i > 0;
    to->stable[at]    = i > 0 ? 1 : -1;
    to->periods[at]   = 321;
    memcpy(to->probe + (size_t)at * row, from->probe + (size_t)(10 * i) * row,
           row * sizeof *to->probe);
  }
  snprintf(path, sizeof path, "%s/points.h5", folder);
  const shb_provenance provenance = {.case_text = "name: x\n"};
  assert_ok(mhb_response_write(points, path, &provenance));
  integration = path;
  assert_ok(publish(NULL));
  integration = NULL;
  char *text  = contents(svg);
  assert_int_equal(count(text, "<circle class=\"integration aperiodic c"), 1);
  assert_int_equal(count(text, "<circle class=\"integration c"), 2);
  assert_has(text, "time integration</text>");
  free(text);
  text = contents(csv);
  assert_int_equal(count(text, ",integration,100,"), 3);
  free(text);
  text = contents(html);
  assert_int_equal(count(text, "\"dots\":true"), 1);
  assert_int_equal(count(text, "edge of range") + count(text, ">peak<"),
                   count(without, "edge of range") + count(without, ">peak<"));
  assert_has(text, "<td>963</td>"); /* periods */
  free(text);
  free(without);
  mhb_response_destroy(whole);
  mhb_response_destroy(points);
  unlink(path);
}

/* A response that cannot be shown leaves earlier results unchanged and no partial file. */
static void untouched(void **state) {
  (void)state;
  fixture_options o = fixture_usual();
  write_response(&o);
  assert_ok(publish(NULL));
  char *before = contents(html), *after;
  o.n_preloads = 0;
  o.limits     = false;
  write_response(&o); /* no branch at all */
  assert_int_equal(publish(NULL), SHB_ERR_INPUT);
  assert_has(shb_message(), "no point");
  assert_has(shb_message(), response);
  assert_int_equal(truncate(response, 3000), 0);
  assert_int_equal(publish(NULL), SHB_ERR_IO);
  unlink(response);
  assert_int_equal(publish(NULL), SHB_ERR_IO);
  after = contents(html);
  assert_string_equal(before, after);
  free(before);
  free(after);
  char command[300];
  snprintf(command, sizeof command, "ls %s | grep -q tmp", folder);
  assert_int_not_equal(system(command), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(whole), cmocka_unit_test(with_points),
                                     cmocka_unit_test(untouched)};
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
