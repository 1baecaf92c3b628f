#include "cases/schema/stage_settings.h"

#include <complex.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/parse/damping.h"
#include "cases/parse/groups.h"
#include "cases/parse/key_table.h"
#include "cases/parse/keys.h"
#include "mesh/base/shortest.h"

static void print_word(FILE *out, const char *words, int index) {
  for (; index > 0; index--) words = strchr(words, ' ') + 1;
  fprintf(out, "%.*s", (int)strcspn(words, " "), words);
}

/* The path as in the case file, so that settings do not depend on the working folder. */
static const char *inside(const case_file *file, const char *path) {
  size_t n = strlen(file->folder);
  return strncmp(path, file->folder, n) == 0 && path[n] == '/' ? path + n + 1 : path;
}

static void print_factors(FILE *out, const char *path, const fem_load *load) {
  for (int k = 0; k <= load->n_harmonics; k++) {
    const double parts[2] = {creal(load->factor[k]), cimag(load->factor[k])};
    if (load->factor[k] == 0) continue;
    fprintf(out, "%s.%d = ", path, k);
    shb_print_shortest(out, 2, parts);
    fputc('\n', out);
  }
}

static void print_probes(FILE *out, const char *path, const case_file *file) {
  for (int i = 0; i < file->n_probes; i++) {
    fprintf(out, "%s.%s = ", path, file->probe[i].name);
    shb_print_shortest(out, 3, file->probe[i].at);
    fputc('\n', out);
  }
}

static void print_gauges(FILE *out, const char *path, const case_file *file) {
  for (int i = 0; i < file->n_gauges; i++) {
    fprintf(out, "%s.%s = ", path, file->gauge[i].name);
    shb_print_shortest(out, 3, file->gauge[i].at);
    fputs("; ", out);
    shb_print_shortest(out, 3, file->gauge[i].direction);
    fputc('\n', out);
  }
}

/* Prints one number if the three are equal. */
static void print_triple(FILE *out, const double v[3]) {
  shb_print_shortest(out, v[0] == v[1] && v[1] == v[2] ? 1 : 3, v);
}

static void print_saved(FILE *out, const case_key *key, const mhb_save_settings *save) {
  if (save->what == MHB_SAVE_LISTED)
    shb_print_shortest(out, save->n, save->frequency);
  else
    print_word(out, key->words, (int)save->what);
}

/* Of a file its content counts, not its name. */
static void print_mistuning(FILE *out, const case_file *file, const case_mistuning *m) {
  char fingerprint[17] = "-", deviation[SHB_SHORTEST];
  if (m->kind == CASE_MISTUNED_LIST) shb_print_shortest(out, m->n, m->each);
  if (m->kind == CASE_MISTUNED_RANDOM)
    fprintf(out, "deviation %s seed %d samples %d", shb_shortest(m->deviation, deviation), m->seed,
            m->samples);
  if (m->kind != CASE_MISTUNED_FILE) return;
  if (shb_fingerprint(m->file, fingerprint) != SHB_OK) strcpy(fingerprint, "-");
  fprintf(out, "file %s %s", inside(file, m->file), fingerprint);
  if (m->hz) fprintf(out, " Hz mean %s", shb_shortest(m->mean, deviation));
}

static void print_scalar(FILE *out, const case_key *key, const case_file *file, const void *slot) {
  switch (key->type) {
    case CASE_INTEGER:
    case CASE_COUNT:
      fprintf(out, "%d", *(const int *)slot);
      break;
    case CASE_AUTO:
      if (*(const int *)slot < key->least)
        fputs("auto", out);
      else
        fprintf(out, "%d", *(const int *)slot);
      break;
    case CASE_CHOICE:
      print_word(out, key->words, *(const int *)slot);
      break;
    case CASE_SWITCH:
      print_word(out, key->words, *(const bool *)slot);
      break;
    case CASE_LABEL:
      fputs(slot, out);
      break;
    case CASE_WORD:
      fputs(*(char *const *)slot, out);
      break;
    case CASE_FILE_NAME:
      fputs(*(char *const *)slot ? inside(file, *(char *const *)slot) : "-", out);
      break;
    case CASE_PRELOADS:
      shb_print_shortest(out, *(const int *)((const char *)slot - key->at + key->count_at), slot);
      break;
    case CASE_PLACES:
      shb_print_shortest(out, file->mhb.search.n_at, slot);
      break;
    case CASE_ORDERS:
      for (int i = 0; i < file->mhb.search.n_orders; i++)
        fprintf(out, "%s%d", i ? " " : "", ((const int *)slot)[i]);
      break;
    case CASE_POINTS:
      if (!file->integrate.listed) fprintf(out, "%d points", file->integrate.n_frequencies);
      if (file->integrate.listed) shb_print_shortest(out, file->integrate.n_frequencies, slot);
      break;
    case CASE_SAVED:
      print_saved(out, key, slot);
      break;
    case CASE_MISTUNING:
      print_mistuning(out, file, slot);
      break;
    case CASE_INTERVAL:
    case CASE_SWEEP:
      shb_print_shortest(out, 2, slot);
      break;
    case CASE_DAMPING:
      case_damping_print(out, slot);
      break;
    case CASE_TRIPLE:
      print_triple(out, slot);
      break;
    case CASE_VECTOR:
    case CASE_STIFFNESS:
      shb_print_shortest(out, 3, slot);
      break;
    default:
      shb_print_shortest(out, 1, slot);
  }
}

/* auto depends on the engine order and goes by what the file holds
 * (cases/schema/nodal_diameters.h). */
static void print_diameters(FILE *out, const char *path, const case_diameters *diameters) {
  if (diameters->what == CASE_DIAMETERS_AUTO) return;
  fprintf(out, "%s =%s", path, diameters->what == CASE_DIAMETERS_ALL ? " all" : "");
  for (int i = 0; i < diameters->n; i++) fprintf(out, " %d", diameters->list[i]);
  fputc('\n', out);
}

/* Prints one value of the file, or of an element whose slots start at base. */
static void print_value(FILE *out, const case_key *key, const char *path, const case_file *file,
                        const void *base) {
  const void *slot = (const char *)base + key->at;
  if (key->type == CASE_FACTORS) {
    print_factors(out, path, slot);
  } else if (key->type == CASE_GROUPS) {
    case_groups_print(out, path, slot);
  } else if (key->type == CASE_DIAMETERS) {
    print_diameters(out, path, slot);
  } else if (key->type == CASE_PROBES) {
    print_probes(out, path, file);
  } else if (key->type == CASE_GAUGES) {
    print_gauges(out, path, file);
  } else {
    fprintf(out, "%s = ", path);
    print_scalar(out, key, file, slot);
    fputc('\n', out);
  }
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
