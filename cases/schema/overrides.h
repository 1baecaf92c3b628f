/* Overrides of single keys of a case: `--set contact.mu=0.4`, and the designs of a study.
 *
 * An override changes the tree of the document before the key table reads it. Units, ranges and
 * conditions are thus checked as if the value stood in the file. */
#ifndef CASES_SCHEMA_OVERRIDES_H
#define CASES_SCHEMA_OVERRIDES_H

#include "cases/parse/diagnostics.h"
#include "cases/parse/keys.h"
#include "cases/parse/yaml.h"

/* Texts "PATH=VALUE". PATH is the path of a key, such as mesh.blade.sections[4].thickness or
 * contact.n0[2]. VALUE is YAML: "5 N", "[0.2, 0.3]", "{1: [1, 0 deg]}". */
typedef struct {
  int                n;
  const char *const *text;     /* [n] */
  const char        *into;     /* folder of the output files; NULL: that of the case file */
  const char        *document; /* text of the case file, read before; NULL: it is read */
  case_keys          keys;     /* rows CASE_KEYS are blocks whose names may hold dots; may be {0} */
} case_overrides;

/* Apply the overrides in their order. A missing key or block is added; an entry of a list must be
 * there. The nodes of override i get the line -1 - i, by which issues are shown. Faults are
 * recorded. */
void case_overrides_apply(case_issues *issues, const case_overrides *overrides, case_node **root);

/* The text of a case with its overrides as comments below; malloc'ed, NULL: no memory. */
char *case_overrides_text(const case_overrides *overrides, const char *text);

#endif
