/* The program shroudhb-post, named by the environment variable SHROUDHB_POST. */
#include <sys/wait.h>
#include <unistd.h>

#include "postproc/study/study_file.h"
#include "tests/support/check.h"
#include "tests/support/fixture.h"
#include "tests/support/studies.h"

static char folder[] = "/tmp/shroudhb-post-XXXXXX";

static int make_folder(void **state) {
  (void)state;
  return mkdtemp(folder) && getenv("SHROUDHB_POST") ? 0 : -1;
}

static int remove_folder(void **state) {
  (void)state;
  char command[300];
  snprintf(command, sizeof command, "rm -r %s", folder);
  return system(command);
}

/* Exit code of the program with arguments, run in the folder; standard output and error in out and
 * error. */
static int run(const char *arguments, char out[65536], char error[4096]) {
  char command[1024];
  snprintf(command, sizeof command, "cd %s && %s %s >out 2>error", folder, getenv("SHROUDHB_POST"),
           arguments);
  int status = system(command);
  for (int i = 0; i < 2; i++) {
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, i ? "error" : "out");
    FILE  *file          = fopen(path, "rb");
    size_t n             = fread(i ? error : out, 1, i ? 4095 : 65535, file);
    (i ? error : out)[n] = '\0';
    fclose(file);
  }
  return WEXITSTATUS(status);
}

static int lines(const char *text) {
  int n = 0;
  for (; *text; text++) n += *text == '\n';
  return n;
}

static void inspect(void **state) {
  (void)state;
  static char          out[65536], error[4096];
  const shb_provenance provenance = {"case.yaml", "name: x\n", "a = 1\n", "shroudhb-mhb"};
  fixture_options      o          = fixture_usual();
  mhb_response        *r          = fixture_response(&o);
  char                 path[256];
  snprintf(path, sizeof path, "%s/x.response.h5", folder);
  assert_ok(mhb_response_write(r, path, &provenance));
  mhb_response_destroy(r);
  assert_int_equal(run("--inspect x.response.h5", out, error), SHB_OK);
  assert_has(out, "7 nonlinear curves");
  assert_has_not(out, "\033"); /* not a terminal */
  assert_string_equal(error, "");
  assert_int_equal(run("--inspect none.h5", out, error), SHB_ERR_IO);
  assert_string_equal(out, "");
  assert_int_equal(lines(error), 1);
  assert_has(error, "none.h5");
  assert_int_equal(run("--inspect case.yaml", out, error), SHB_ERR_IO);
  assert_int_equal(truncate(path, 20000), 0);
  assert_int_equal(run("--inspect x.response.h5", out, error), SHB_ERR_IO);
  assert_int_equal(lines(error), 1);
  assert_has(error, "truncated");
}

/* A study file that cannot be read is one line; nothing is written. */
static void study(void **state) {
  (void)state;
  static char out[65536], error[4096];
  char        path[256];
  assert_int_equal(run("none.study.h5", out, error), SHB_ERR_IO);
  assert_int_equal(lines(error), 1);
  assert_has(error, "none.study.h5");
  snprintf(path, sizeof path, "%s/none.study.html", folder);
  assert_int_equal(access(path, F_OK), -1);
  design_study s;
  studies_make(STUDIES_PAIR, &s);
  snprintf(path, sizeof path, "%s/pair.study.h5", folder);
  assert_ok(study_file_write(&s, path));
  design_study_free(&s);
  assert_int_equal(run("pair.study.h5", out, error), SHB_OK);
  assert_string_equal(error, "");
  assert_has(out, "pair.study.html: Design 25 has the lowest peak, ");
  snprintf(path, sizeof path, "%s/pair.study.html", folder);
  assert_int_equal(access(path, R_OK), 0);
}

static void usage(void **state) {
  (void)state;
  static char out[65536], error[4096];
  assert_int_equal(run("--help", out, error), SHB_OK);
  assert_has(out, "usage: shroudhb post");
  assert_int_equal(run("", out, error), SHB_ERR_INPUT);
  assert_int_equal(lines(error), 1);
  assert_int_equal(run("--colour x.yaml", out, error), SHB_ERR_INPUT);
  assert_has(error, "--colour");
  assert_int_equal(run("a.yaml b.yaml", out, error), SHB_ERR_IO);
  assert_has(error, "a.yaml");
  assert_int_equal(lines(error), 1);
  assert_int_equal(run("--summary a.yaml b.yaml", out, error), SHB_ERR_INPUT);
  assert_has(error, "--summary takes one case; unexpected 'b.yaml'");
  assert_int_equal(run("--inspect a.h5 b.h5 c.h5", out, error), SHB_ERR_INPUT);
  assert_has(error, "two files are enough; unexpected 'c.h5'");
  assert_int_equal(run("--inspect a.h5 b.h5", out, error), SHB_ERR_IO);
  assert_has(error, "a.h5");
  assert_int_equal(run("none.yaml", out, error), SHB_ERR_IO);
  assert_int_equal(lines(error), 1);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(inspect), cmocka_unit_test(study),
                                     cmocka_unit_test(usage)};
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
