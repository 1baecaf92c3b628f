/* The keys of a case that a study varies, or that are uncertain. Values are SI. */
#ifndef CASES_DESIGNS_STUDY_KEYS_H
#define CASES_DESIGNS_STUDY_KEYS_H

#include <stdbool.h>

#include "cases/designs/output_names.h"
#include "cases/designs/study_table.h"
#include "cases/parse/keys.h"
#include "cases/parse/yaml.h"
#include "cases/plan/distribution.h"

enum { STUDY_MAX_KEYS = 32, STUDY_KEY_TEXT = CASE_PATH + 16 };

typedef struct {
  char              path[CASE_PATH]; /* "mesh.blade.sections[4].thickness" */
  char              unit[STUDY_UNIT_TEXT];
  bool              whole;    /* takes whole numbers only */
  bool              is_range; /* from, to instead of a list */
  bool              log;      /* a range in steps of equal ratio */
  double            from, to;
  int               n;     /* values of the list, or points of the range; 0: the range has none */
  double           *value; /* [n] */
  bool              is_uncertain;
  bool              is_ratio; /* its values are factors of the varied key `nominal` */
  int               nominal;
  plan_distribution distribution;
} study_key;

/* The varied keys stand before the uncertain ones. */
typedef struct {
  int       n, n_uncertain;
  study_key key[STUDY_MAX_KEYS];
} study_keys;

/* Read the mapping of varied keys. Faults are recorded, here and below. */
void study_keys_read(case_issues *issues, const case_node *node, study_keys *keys);
void study_keys_free(study_keys *keys);

/* Set path, unit and kind of a key. False if the path is no number of a case. */
bool study_key_start(case_issues *issues, const case_node *node, const char *path, study_key *key);

/* Read a number in the unit of a key. False after a fault. */
bool study_key_number(case_issues *issues, const study_key *key, const case_node *node,
                      double *value);

/* "contact.n0", or "contact.n0 (ratio)" */
void study_key_name(const study_key *key, char out[STUDY_KEY_TEXT]);

/* The value at u in (0, 1): of the range, by equal shares of the list, or the quantile. */
double study_key_at(const study_key *key, double u);

#endif
