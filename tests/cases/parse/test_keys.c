#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "cases/parse/key_listing.h"
#include "cases/parse/key_table.h"
#include "cases/parse/keys.h"
#include "cases/parse/units.h"
#include "cases/parse/value.h"

static void rows_are_sound(void **state) {
  (void)state;
  case_keys keys = case_key_table();
  for (int i = 0; i < keys.n; i++) {
    const case_key *key = &keys.key[i];
    char            why[CASE_WHY];
    double          value;
    assert_ptr_equal(case_key_find(keys, key->path), key); /* paths are unique */
    assert_true(key->help && key->help[0]);
    assert_true(key->least <= key->most);
    assert_true(key->stages != 0);
    assert_false(case_key_is_block(keys, key->path));
    /* the reader knows the unit */
    char text[32];
    snprintf(text, sizeof text, "1 %s", key->unit);
    if (!case_quantity(text, key->unit, &value, why)) fail_msg("%s: %s", key->path, why);
    assert_true(value == 1);
    /* the key's block stays together */
    bool worded = key->type == CASE_CHOICE || key->type == CASE_SWITCH ||
                  key->type == CASE_ACCURACY || key->type == CASE_WORD_OR_NUMBERS ||
                  key->type == CASE_WORD_OR_INTEGERS;
    if (key->type != CASE_COUNT) /* may have a word besides all */
      assert_true(worded == (key->words != NULL));
  }
}

static void assert_same_value(const case_node *one, const case_node *other) {
  assert_int_equal(one->kind, other->kind);
  assert_int_equal(one->n, other->n);
  if (one->kind == CASE_SCALAR) assert_string_equal(one->text, other->text);
  for (int i = 0; i < one->n; i++) assert_same_value(&one->child[i], &other->child[i]);
}

static void defaults_can_be_read(void **state) {
  (void)state;
  case_keys keys = case_key_table();
  int       n = 0, n_plain = 0;
  for (int i = 0; i < keys.n; i++) {
    const case_key *key = &keys.key[i];
    if (!key->fallback) continue;
    case_file   file   = {.folder = "."};
    case_issues issues = case_issues_start("d", key->fallback, strlen(key->fallback));
    case_node  *node   = case_document_parse(&issues);
    case_plain  plain;
    assert_non_null(node);
    if (case_plain_value(key->fallback, &plain)) { /* as libyaml reads it */
      assert_same_value(&plain.value, node);
      n_plain++;
    }
    if (!case_value_read(&issues, key, key->path, node, &file, (char *)&file + key->at))
      fail_msg("%s: default %s", key->path, key->fallback);
    case_document_free(node);
    case_issues_free(&issues);
    n++;
  }
  assert_true(n > n_plain && n_plain > 40);
}

static void edit_distances(void **state) {
  (void)state;
  assert_int_equal(case_edit_distance("mue", "mu"), 1);
  assert_int_equal(case_edit_distance("fiel", "file"), 1); /* swap */
  assert_int_equal(case_edit_distance("MU", "mu"), 0);
  assert_int_equal(case_edit_distance("", "mu"), 2);
  assert_int_equal(case_edit_distance("frequency", "frequency"), 0);
  assert_int_equal(case_edit_distance("kitten", "sitting"), 3);
}

static void the_manual_lists_every_key(void **state) {
  (void)state;
  char  *text = NULL;
  size_t size = 0;
  FILE  *out  = open_memstream(&text, &size);
  case_print_keys(out);
  fclose(out);
  case_keys keys = case_key_table();
  for (int i = 0; i < keys.n; i++) {
    char line[96];
    snprintf(line, sizeof line, "\n%s ", keys.key[i].path);
    if (!strstr(text, line)) fail_msg("%s is not listed", keys.key[i].path);
    assert_non_null(strstr(text, keys.key[i].help));
  }
  assert_non_null(strstr(text, "neighbour|ground"));
  assert_non_null(
      strstr(text, "\ncontact.accuracy                word or number -      fast|balanced|exact "));
  assert_non_null(strstr(text, "above -1 and below 0.5"));
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rows_are_sound), cmocka_unit_test(defaults_can_be_read),
      cmocka_unit_test(edit_distances), cmocka_unit_test(the_manual_lists_every_key)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
