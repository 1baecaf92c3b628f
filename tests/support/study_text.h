/* YAML texts as nodes, with the faults that are found in them. */
#ifndef TESTS_SUPPORT_STUDY_TEXT_H
#define TESTS_SUPPORT_STUDY_TEXT_H

#include "cases/parse/yaml.h"
#include "tests/support/check.h"

typedef struct {
  case_issues issues;
  case_node  *root;
} study_text;

/* text must outlive it. */
static inline study_text study_text_parse(const char *text) {
  study_text t = {.issues = case_issues_start("study.yaml", text, strlen(text))};
  t.root       = case_document_parse(&t.issues);
  assert_non_null(t.root);
  assert_int_equal(t.issues.n, 0);
  return t;
}

static inline void study_text_free(study_text *t) {
  case_document_free(t->root);
  case_issues_free(&t->issues);
}

/* The faults are one, whose text has a part; part NULL: there is none. */
static inline void study_text_check(const study_text *t, const char *part) {
  if (!part && t->issues.n > 0) fail_msg("unexpected: %s", t->issues.issue[0].text);
  if (!part) return;
  assert_int_equal(t->issues.n, 1);
  assert_has(t->issues.issue[0].text, part);
}

#endif
