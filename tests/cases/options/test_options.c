/* Command lines by the table of commands: what they say, what is refused, what is passed on. */
#include <fcntl.h>
#include <unistd.h>

#include "cases/options/command_table.h"
#include "cases/options/options.h"
#include "tests/support/check.h"

enum { WORDS = 24 };

static char said[2048]; /* on standard error, by the last line read */

/* Reads a line of words with a blank between. */
static int read_line(command_id id, const char *line, command_options *out) {
  static char words[512];
  char       *argv[WORDS] = {NULL}, *rest = words, *word;
  int         argc = 0, ends[2], kept = dup(STDERR_FILENO);
  snprintf(words, sizeof words, "%s", line);
  argv[argc++] = (char *)command_row_of(id)->name;
  while ((word = strtok_r(rest, " ", &rest)) != NULL) argv[argc++] = word;
  assert_int_equal(pipe(ends), 0);
  dup2(ends[1], STDERR_FILENO);
  const int code = options_read(command_row_of(id), argc, argv, out);
  fflush(stderr);
  dup2(kept, STDERR_FILENO);
  close(kept);
  close(ends[1]);
  const ssize_t n     = read(ends[0], said, sizeof said - 1);
  said[n > 0 ? n : 0] = '\0';
  close(ends[0]);
  return code;
}

static void options_and_files_come_in_any_order(void **state) {
  (void)state;
  command_options o;
  assert_true(read_line(COMMAND_MESH, "--set a=1 c.yaml --force --inp --into=there --set b=2", &o) <
              0);
  assert_string_equal(o.path, "c.yaml");
  assert_true(o.force && o.inp && !o.quiet && o.n_set == 2);
  assert_string_equal(o.set[1], "b=2");
  assert_string_equal(o.into, "there");
  assert_true(read_line(COMMAND_POST, "a.yaml --json -- --b.yaml", &o) < 0);
  assert_string_equal(o.other, "--b.yaml");
  assert_true(o.json && o.design < 0 && o.scale < 0);
}

static void numbers_have_a_range(void **state) {
  (void)state;
  command_options o;
  assert_true(read_line(COMMAND_FIELD, "--branch 2 --point=31 --scale 1.5 r.h5", &o) < 0);
  assert_true(o.branch == 2 && o.point == 31 && o.peak < 0 && o.scale == 1.5);
  assert_true(read_line(COMMAND_FIELD, "--peak r.h5", &o) < 0 && o.peak < 0);
  assert_true(read_line(COMMAND_FIELD, "--peak 3 r.h5", &o) < 0 && o.peak == 3);
  assert_string_equal(o.path, "r.h5");
  assert_int_equal(read_line(COMMAND_FIELD, "--steps 1 r.h5", &o), SHB_ERR_INPUT);
  assert_has(said, "--steps needs a number from 2 to 1000");
  assert_int_equal(read_line(COMMAND_STUDY, "--design 0 s.yaml", &o), SHB_ERR_INPUT);
  assert_has(said, "--design needs the number of a design, from 1");
  assert_int_equal(read_line(COMMAND_FIELD, "--scale -2 r.h5", &o), SHB_ERR_INPUT);
  assert_has(said, "--scale needs a number above 0");
}

static void what_is_wrong_is_one_line(void **state) {
  static const struct {
    command_id  id;
    const char *line, *part;
  } row[] = {
      {COMMAND_MHB, "", "no file given"},
      {COMMAND_MHB, "a b", "one file is enough; unexpected 'b'"},
      {COMMAND_POST, "a b c", "two files are enough; unexpected 'c'"},
      {COMMAND_MHB, "a --nonsense", "unknown option '--nonsense'"},
      {COMMAND_MHB, "a -x", "unknown option '-x'"},
      {COMMAND_MHB, "a -xyz b", "unknown option '-xyz'"},
      {COMMAND_MHB, "a --quiet=yes", "--quiet takes no argument; unexpected 'yes'"},
      {COMMAND_RUN, "a --svg b", "--svg goes with contact, not with run"},
      {COMMAND_MHB, "--no-report a", "--no-report goes with run, post, not with mhb"},
      {COMMAND_MHB, "a --set", "--set needs KEY=VALUE, such as contact.mu=0.4"},
      {COMMAND_MHB, "a --into=", "--into needs the name of a folder"},
      {COMMAND_CONTACT, "a --svg --quiet", "--svg needs the name of a file to write"},
      {COMMAND_CONTACT, "a --svg b --svg c", "one --svg is enough; unexpected 'c'"},
      {COMMAND_CONVERGE, "--finer --no-mesh a", "one mode at a time; unexpected '--no-mesh'"}};
  (void)state;
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    command_options o;
    assert_int_equal(read_line(row[i].id, row[i].line, &o), SHB_ERR_INPUT);
    assert_has(said, row[i].part);
    assert_true(strchr(said, '\n') == said + strlen(said) - 1);
  }
}

static void another_command_gets_what_it_knows(void **state) {
  (void)state;
  command_options o, again;
  const char     *words[COMMAND_WORDS];
  char            line[256] = "";
  assert_true(read_line(COMMAND_RUN, "--no-report --quiet --set a=1 --into there -- -c.yaml", &o) <
              0);
  int n = options_words(command_row_of(COMMAND_MHB), &o, words, 0);
  for (int i = 0; i < n; i++) snprintf(line + strlen(line), 64, "%s%s", i ? " " : "", words[i]);
  assert_string_equal(line, "--quiet --set a=1 --into there -- -c.yaml");
  assert_true(read_line(COMMAND_MHB, line, &again) < 0);
  assert_string_equal(again.path, "-c.yaml");
  n = options_words(command_row_of(COMMAND_POST), &o, words, 0);
  assert_string_equal(words[1], "--no-report");
  assert_null(words[n]);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(options_and_files_come_in_any_order),
                                     cmocka_unit_test(numbers_have_a_range),
                                     cmocka_unit_test(what_is_wrong_is_one_line),
                                     cmocka_unit_test(another_command_gets_what_it_knows)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
