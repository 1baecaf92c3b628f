#include "cases/schema/stage_settings.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/parse/key_table.h"
#include "cases/parse/value.h"

/* Prints one value of the file, or of an element whose slots start at base. */
static void print_value(FILE *out, const case_key *key, const char *path, const case_file *file,
                        const void *base) {
  case_value_print(&(case_printed){out, key, path, file, (const char *)base + key->at});
}

/* Prints the rows of a list, element by element. */
static void print_list(FILE *out, const case_key *list, const case_file *file, int stages) {
  case_keys   keys = case_key_table();
  const char *base = (const char *)file + list->at;
  int         n    = *(const int *)((const char *)file + list->count_at);
  for (int i = 0; i < n; i++, base += list->each)
    for (int k = 0; k < keys.n; k++) {
      const case_key *key  = &keys.key[k];
      const char     *rest = case_key_in_list(key->path, list->path);
      char            path[CASE_PATH];
      if (!rest || !(key->stages & stages) || !case_key_applies(key, file, base)) continue;
      case_path(path, "%s[%d].%s", list->path, i, rest);
      print_value(out, key, path, file, base);
    }
}

/* Prints a row of the key table; of a list the rows on which one of stages depends. */
static void print_key(FILE *out, const case_key *key, const case_file *file, int stages) {
  if (strstr(key->path, "[].")) return; /* the list prints its rows */
  if (key->type == CASE_LIST) {
    print_list(out, key, file, stages);
  } else {
    print_value(out, key, key->path, file, file);
  }
}

char *case_settings(const case_file *file, case_stage stage) {
  char  *text = NULL;
  size_t size = 0;
  FILE  *out  = open_memstream(&text, &size);
  if (!out) return NULL;
  case_keys keys = case_key_table();
  for (int i = 0; i < keys.n; i++)
    if ((keys.key[i].stages & (int)stage) && case_key_applies(&keys.key[i], file, file))
      print_key(out, &keys.key[i], file, (int)stage);
  if (fclose(out) != 0) {
    free(text);
    return NULL;
  }
  return text;
}
