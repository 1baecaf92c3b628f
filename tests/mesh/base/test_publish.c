/* Published files are whole or absent; temporary files do not stay. */
#include "mesh/base/publish.h"

#include <dirent.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "mesh/base/crash_guard.h"
#include "tests/support/check.h"
#include "tests/support/scratch_folder.h"

static void path_of(const char *name, char path[sizeof scratch_folder + 64]) {
  snprintf(path, sizeof scratch_folder + 64, "%s/%s", scratch_folder, name);
}

static void write_text(const char *path, const char *text) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

static void assert_holds(const char *path, const char *wanted) {
  char  text[64] = "";
  FILE *file     = fopen(path, "rb");
  assert_non_null(file);
  text[fread(text, 1, sizeof text - 1, file)] = 0;
  fclose(file);
  assert_string_equal(text, wanted);
}

static void renames_over_an_earlier_file(void **state) {
  (void)state;
  char path[sizeof scratch_folder + 64];
  path_of("result", path);
  write_text(path, "earlier");
  char *temporary = shb_publish_temporary(path);
  assert_non_null(temporary);
  write_text(temporary, "later");
  assert_holds(path, "earlier");
  assert_ok(shb_publish(temporary, path));
  assert_holds(path, "later");
  assert_int_not_equal(access(temporary, F_OK), 0);
  free(temporary);
}

static void a_folder_is_made_with_those_above(void **state) {
  (void)state;
  char path[sizeof scratch_folder + 64], file[sizeof scratch_folder + 64];
  path_of("a/b/c", path);
  assert_ok(shb_make_folder(path));
  assert_ok(shb_make_folder(path)); /* it is there */
  assert_int_equal(access(path, W_OK), 0);
  path_of("a/b/c/", path);
  assert_ok(shb_make_folder(path));
  path_of("file", file);
  write_text(file, "text");
  assert_int_equal(shb_make_folder(file), SHB_ERR_IO);
  assert_has(shb_message(), "file: this folder cannot be made: Not a directory");
  path_of("file/below", path);
  assert_int_equal(shb_make_folder(path), SHB_ERR_IO);
}

static void a_link_is_not_replaced(void **state) {
  (void)state;
  char path[sizeof scratch_folder + 64], target[sizeof scratch_folder + 64];
  path_of("link", path);
  path_of("target", target);
  write_text(target, "target");
  assert_int_equal(symlink(target, path), 0);
  char *temporary = shb_publish_temporary(path);
  write_text(temporary, "new");
  assert_int_equal(shb_publish(temporary, path), SHB_ERR_IO);
  assert_has(shb_message(), "is a link");
  assert_holds(target, "target");
  assert_int_not_equal(access(temporary, F_OK), 0);
  free(temporary);
}

static void a_folder_that_is_absent_is_told(void **state) {
  (void)state;
  char path[sizeof scratch_folder + 64];
  path_of("absent/result", path);
  char *temporary = shb_publish_temporary(path);
  assert_int_equal(shb_publish(temporary, path), SHB_ERR_IO);
  assert_has(shb_message(), "cannot be written");
  free(temporary);
}

static void unfinished_files_are_removed_at_an_end_at_once(void **state) {
  (void)state;
  char path[sizeof scratch_folder + 64], name[sizeof path + 32];
  int  end;
  path_of("unfinished", path);
  const pid_t child = fork();
  if (child == 0) {
    write_text(shb_publish_temporary(path), "half");
    shb_end_at_once("", 7);
  }
  assert_int_equal(waitpid(child, &end, 0), child);
  assert_int_equal(WEXITSTATUS(end), 7);
  snprintf(name, sizeof name, "%s.tmp.%d", path, (int)child);
  assert_int_not_equal(access(name, F_OK), 0);
}

/* FNV-1a of the empty text and of "a", from the definition of the hash. */
/* A killed process leaves its file; one that runs keeps its own. */
static void orphans_are_removed(void **state) {
  (void)state;
  char path[sizeof scratch_folder + 64], orphan[sizeof path + 32], ours[sizeof path + 32];
  char other[sizeof path + 32], msh[sizeof path + 32];
  path_of("orphaned", path);
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitpid(child, NULL, 0);
  snprintf(orphan, sizeof orphan, "%s.tmp.%d", path, (int)child);
  snprintf(ours, sizeof ours, "%s.tmp.%d", path, (int)getppid());
  snprintf(other, sizeof other, "%s.tmp.%d.old", path, (int)child);
  snprintf(msh, sizeof msh, "%s.tmp.%d.msh", path, (int)child);
  write_text(msh, "half");
  write_text(orphan, "half");
  write_text(ours, "half");
  write_text(other, "half");
  setenv("SLURM_NNODES", "2", 1);
  free(shb_publish_temporary(path));
  assert_int_equal(access(orphan, F_OK), 0);
  unsetenv("SLURM_NNODES");
  free(shb_publish_temporary(path));
  assert_int_not_equal(access(orphan, F_OK), 0);
  assert_int_not_equal(access(msh, F_OK), 0);
  assert_int_equal(access(ours, F_OK), 0);
  assert_int_equal(access(other, F_OK), 0);
  unlink(ours);
  unlink(other);
}

static void fingerprints_are_fnv_1a(void **state) {
  (void)state;
  char path[sizeof scratch_folder + 64], hash[17];
  path_of("hashed", path);
  write_text(path, "");
  assert_ok(shb_fingerprint(path, hash));
  assert_string_equal(hash, "cbf29ce484222325");
  write_text(path, "a");
  assert_ok(shb_fingerprint(path, hash));
  assert_string_equal(hash, "af63dc4c8601ec8c");
  path_of("nothing", path);
  assert_int_equal(shb_fingerprint(path, hash), SHB_ERR_IO);
}

static void names_show_what_they_are(void **state) {
  (void)state;
  static const char *const        plain[]   = {"tip",   "-rf", "=1+2", "two words", "a.b_c+d",
                                               "größe", "翼",  "\xc3", "\xe2\x80"},
                           *const refused[] = {"",
                                               "a\nb",
                                               "\x1b[31mred",
                                               "a\tb",
                                               "\x7f",
                                               "\xc2\x85",     /* U+0085 */
                                               "a\u200fb",     /* right-to-left mark */
                                               "x\u202egnp.b", /* right-to-left override */
                                               "\u2066",
                                               "\ufeffname",
                                               "\u061c"};
  for (size_t i = 0; i < sizeof plain / sizeof *plain; i++)
    assert_true(shb_name_is_plain(plain[i]));
  for (size_t i = 0; i < sizeof refused / sizeof *refused; i++)
    assert_false(shb_name_is_plain(refused[i]));
}

/* What a message repeats cannot command a terminal, nor show another text than there is. */
static void messages_show_what_they_are(void **state) {
  (void)state;
  static const char *const rows[][2] = {{"größe\t翼\n𝜇", "größe 翼 𝜇"},
                                        {"\x1b[31m", "?[31m"},
                                        {"a\u202eb\u2066", "a?b?"},
                                        {"\xc2\x85", "?"},
                                        {"\xff"
                                         "a\xe2\x80",
                                         "?a??"},
                                        {"\xc0\xaf", "??"}, /* '/', too long */
                                        {"\ufffd", "\ufffd"}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char text[64];
    snprintf(text, sizeof text, "%s", rows[i][0]);
    shb_plain_text(text);
    assert_string_equal(text, rows[i][1]);
  }
}

static int n_entries(void) {
  int  n    = 0;
  DIR *list = opendir(scratch_folder);
  assert_non_null(list);
  while (readdir(list)) n++;
  closedir(list);
  return n;
}

static void assert_told(const char *name, const char *why) {
  assert_int_equal(shb_publish_check(scratch(name)), SHB_ERR_IO);
  assert_has(shb_message(), scratch(name));
  assert_has(shb_message(), why);
}

static void a_folder_that_takes_files_is_left_as_it_was(void **state) {
  const int before = n_entries();
  (void)state;
  assert_ok(shb_publish_check(scratch("result.h5")));
  assert_int_equal(n_entries(), before);
}

static void what_is_in_the_way_is_told(void **state) {
  (void)state;
  assert_told("absent/result.h5", ": cannot be written: No such file or directory");
  assert_int_equal(mkdir(scratch("a folder"), 0755), 0);
  assert_told("a folder", ": cannot be written: Is a directory");
  assert_int_equal(mkfifo(scratch("pipe"), 0644), 0);
  assert_told("pipe", ": is a link, a device or a pipe");
  assert_told("pipe/result.h5", ": cannot be written: Not a directory");
  assert_int_equal(symlink("a folder", scratch("way")), 0);
  assert_told("way", ": is a link, a device or a pipe");
  assert_ok(shb_publish_check(scratch("way/result.h5")));
}

/* What a process of its own finds: 0, or the exit code. */
static int found(void (*prepare)(void), const char *why) {
  int         status;
  const pid_t child = fork();
  if (child == 0) {
    prepare();
    const shb_status told = shb_publish_check(scratch("result.h5"));
    _exit(told == SHB_ERR_IO && strstr(shb_message(), why) ? 0 : 1);
  }
  waitpid(child, &status, 0);
  return status;
}

/* Root may write everywhere. */
static void as_nobody(void) {
  if (geteuid() == 0 && setuid(65534) != 0) _exit(2);
}

static void without_space(void) {
  const struct rlimit limit = {100, 100};
  if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(2);
}

static void no_permission_and_no_space_are_told(void **state) {
  (void)state;
  assert_int_equal(chmod(scratch_folder, 0555), 0);
  assert_int_equal(found(as_nobody, ": cannot be written: Permission denied"), 0);
  assert_int_equal(chmod(scratch_folder, 0755), 0);
  assert_int_equal(found(without_space, ": cannot be written: "), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(renames_over_an_earlier_file),
      cmocka_unit_test(a_folder_that_takes_files_is_left_as_it_was),
      cmocka_unit_test(what_is_in_the_way_is_told),
      cmocka_unit_test(no_permission_and_no_space_are_told),
      cmocka_unit_test(a_folder_is_made_with_those_above),
      cmocka_unit_test(a_link_is_not_replaced),
      cmocka_unit_test(a_folder_that_is_absent_is_told),
      cmocka_unit_test(unfinished_files_are_removed_at_an_end_at_once),
      cmocka_unit_test(orphans_are_removed),
      cmocka_unit_test(fingerprints_are_fnv_1a),
      cmocka_unit_test(names_show_what_they_are),
      cmocka_unit_test(messages_show_what_they_are)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
