#include "cases/study/output_names.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/parse/keys.h"

static const struct {
  const char *name, *unit;
} words[] = {{"peak", "m"},
             {"frequency", "Hz"},
             {"peak_to_peak", "m"},
             {"stable", "-"},
             {"dissipation", "J"}};
enum { N_WORDS = sizeof words / sizeof *words };

static void set(study_output *out, study_quantity quantity, int index, const char *name,
                const char *unit) {
  *out = (study_output){.quantity = quantity, .index = index};
  snprintf(out->name, sizeof out->name, "%s", name);
  snprintf(out->unit, sizeof out->unit, "%s", unit);
}

/* Read "modes[I].frequency". Returns 1 if it is one, 0 if not, -1 with a reason if it is wrong. */
static int parse_mode(const char *name, const case_file *file, study_output *out, char *why,
                      size_t size) {
  char *end;
  if (strncmp(name, "modes[", 6) != 0) return 0;
  long i = strtol(name + 6, &end, 10);
  if (end == name + 6 || strcmp(end, "].frequency") != 0) {
    snprintf(why, size, "'%s': expected modes[I].frequency, I from 1", name);
    return -1;
  }
  if (i < 1 || (file->modes > 0 && !file->modal_file && i > file->modes)) {
    snprintf(why, size, "'%s': the modes of the case are 1 to %d", name, file->modes);
    return -1;
  }
  set(out, STUDY_MODE_FREQUENCY, (int)i - 1, name, "Hz");
  return 1;
}

bool study_output_parse(const char *name, const case_file *file, study_output *out, char *why,
                        size_t size) {
  for (int i = 0; i < N_WORDS; i++)
    if (strcmp(name, words[i].name) == 0) {
      set(out, (study_quantity)i, 0, name, words[i].unit);
      return true;
    }
  int mode = parse_mode(name, file, out, why, size);
  if (mode) return mode > 0;
  for (int i = 0; i < file->n_probes; i++)
    if (strcmp(name, file->probe[i].name) == 0) {
      set(out, STUDY_PROBE, i, name, "m");
      return true;
    }
  why[0] = '\0';
  case_append(why, size, "'%s' is no output of this case; known: ", name);
  for (int i = 0; i < N_WORDS; i++) case_append(why, size, "%s, ", words[i].name);
  for (int i = 0; i < file->n_probes; i++) case_append(why, size, "%s, ", file->probe[i].name);
  case_append(why, size, "modes[I].frequency");
  return false;
}
