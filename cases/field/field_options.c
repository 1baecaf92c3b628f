#include "cases/field/field_options.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/status.h"
#include "postproc/field/field_grid.h"

static int refuse(const char *option, const char *text) {
  fprintf(stderr, "shroudhb: error: %s needs %s; see --help\n", option, text);
  return SHB_ERR_INPUT;
}

/* A whole number from low to high; false after a message. */
static bool read_number(const char *option, const char *word, int low, int high, int *out) {
  char *end;
  errno           = 0;
  const long read = word ? strtol(word, &end, 10) : 0;
  if (!word || end == word || *end != '\0' || errno || read < low || read > high) {
    char text[64];
    snprintf(text, sizeof text,
             high == INT_MAX ? "a whole number from %d" : "a number from %d to %d", low, high);
    refuse(option, text);
    return false;
  }
  *out = (int)read;
  return true;
}

/* Take an option with a value. 1: taken, 0: another word, -1: after a message. */
static int take(const char *word, const char *value, field_options *out) {
  const struct {
    const char *option;
    int         low, high, *to;
  } numbers[] = {{"--branch", 0, INT_MAX, &out->branch},
                 {"--point", 0, INT_MAX, &out->point},
                 {"--peak", 1, INT_MAX, &out->peak},
                 {"--mode", 1, INT_MAX, &out->mode},
                 {"--nodal-diameter", 0, INT_MAX, &out->diameter},
                 {"--steps", POST_LEAST_STEPS, POST_MOST_STEPS, &out->steps}};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
    if (strcmp(word, numbers[i].option) == 0)
      return read_number(word, value, numbers[i].low, numbers[i].high, numbers[i].to) ? 1 : -1;
  if (strcmp(word, "--modal") == 0) {
    out->modal = value;
    return value ? 1 : (refuse(word, "the name of a file"), -1);
  }
  if (strcmp(word, "--scale") != 0) return 0;
  char *end  = NULL;
  out->scale = value ? strtod(value, &end) : 0;
  return end && end != value && *end == '\0' && out->scale > 0 && out->scale < 1e12
             ? 1
             : (refuse(word, "a number above 0"), -1);
}

/* --peak alone is the default. */
static bool is_bare_peak(const char *word, const char *value) {
  return strcmp(word, "--peak") == 0 && (!value || strspn(value, "0123456789") != strlen(value));
}

int field_options_take(int *argc, char **argv, field_options *out) {
  *out = (field_options){
      .branch = -1, .point = -1, .peak = -1, .mode = -1, .diameter = -1, .steps = -1, .scale = -1};
  int n = 1;
  for (int i = 1; i < *argc; i++) {
    const char *value = i + 1 < *argc ? argv[i + 1] : NULL;
    if (strcmp(argv[i], "--ring") == 0) {
      out->ring = true;
    } else if (strcmp(argv[i], "--face") == 0) {
      out->face = true;
    } else if (!is_bare_peak(argv[i], value)) {
      const int taken = take(argv[i], value, out);
      if (taken < 0) return SHB_ERR_INPUT;
      if (taken == 0) argv[n++] = argv[i];
      i += taken;
    }
  }
  *argc = n;
  if (out->point >= 0 && out->branch < 0) return refuse("--point", "--branch");
  if (out->point >= 0 && out->peak >= 0) return refuse("--peak", "no --point");
  if (out->face && out->ring) return refuse("--face", "no --ring");
  if (out->mode >= 0 && (out->branch >= 0 || out->peak >= 0 || out->face || out->modal))
    return refuse("--mode", "no --branch, --point, --peak, --face, --modal");
  if (out->diameter >= 0 && out->mode < 0) return refuse("--nodal-diameter", "--mode");
  return -1;
}

int field_stem(const char *path) {
  static const char *const ending[] = {".response.h5", ".modal.h5", ".h5"};
  const size_t             n        = strlen(path);
  for (size_t i = 0; i < sizeof ending / sizeof *ending; i++) {
    const size_t m = strlen(ending[i]);
    if (n > m && strcmp(path + n - m, ending[i]) == 0) return (int)(n - m);
  }
  return (int)n;
}
