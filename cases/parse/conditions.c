#include "cases/parse/conditions.h"

#include "mesh/core/file_format.h"

bool case_condition_holds(case_condition condition, const case_file *file, const void *element) {
  const bool            own       = !file->modal_file;
  const case_material  *material  = element;
  const case_load      *load      = element;
  const case_interface *interface = element;
#define HOLDS(name, test, ...) \
  case name:                   \
    return test;
  switch (condition) {
    CASE_CONDITIONS(HOLDS)
    default:
      return true;
  }
}

const char *case_condition_words(case_condition condition) {
#define WORDS(name, test, words, ...) [name] = words,
  static const char *const text[]            = {CASE_CONDITIONS(WORDS)};
  return text[condition];
}

const char *case_condition_needed(case_condition condition) {
#define NEEDED(name, test, words, needed) [name] = (needed),
  static const char *const text[]                = {CASE_CONDITIONS(NEEDED)};
  return text[condition];
}
