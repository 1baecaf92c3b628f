#include <sys/stat.h>
#include <unistd.h>

#include "postproc/publish.h"
#include "tests/postproc/check.h"
#include "tests/postproc/fixture.h"

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

static shb_status publish(char **summary) {
  const post_job job      = {"x", response, html, csv, svg, NULL};
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
  assert_has(text, "shroudhb-mhb"); /* provenance came through the file */
  assert_has(text, "&lt;script&gt;alert(1)");
  free(text);
  text = contents(csv);
  assert_memory_equal(text, "branch,kind,n0_N,", 17);
  free(text);
  text = contents(svg);
  assert_has(text, "</svg>");
  free(text);
}

/* A response that cannot be shown leaves the earlier results as they are, and nothing half written. */
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
  const struct CMUnitTest tests[] = {cmocka_unit_test(whole), cmocka_unit_test(untouched)};
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
