#include "cases/schema/key_schema.h"

#include <string.h>

#include "cases/parse/key_table.h"
#include "cases/parse/reader.h"
#include "cases/schema/motion.h"

/* ---------------------------------------------------------------- JSON */

void case_print_json_string(const char *text, FILE *out) {
  fputc('"', out);
  for (; *text; text++) {
    if (*text == '"' || *text == '\\') fputc('\\', out);
    fputc(*text, out);
  }
  fputc('"', out);
}

/* The words of a key as the items of a JSON list. */
static void print_words(const char *words, FILE *out) {
  for (const char *c = words; *c;) {
    size_t n = strcspn(c, " ");
    fprintf(out, "%s\"%.*s\"", c == words ? "" : ", ", (int)n, c);
    c += n + (c[n] == ' ');
  }
}

/* ---------------------------------------------------------------- values */

/* The bounds of a bare number, in SI. */
static void print_bounds(const case_key *key, FILE *out) {
  if (key->least == 0 && key->most == 0) return;
  fprintf(out, ", \"%s\": %.15g, \"%s\": %.15g", key->above ? "exclusiveMinimum" : "minimum",
          key->least, key->below ? "exclusiveMaximum" : "maximum", key->most);
}

/* A bare number, or a number with its unit. */
static void print_number(const case_key *key, FILE *out) {
  fputs("{\"anyOf\": [{\"type\": \"number\"", out);
  print_bounds(key, out);
  fputs("}, {\"$ref\": \"#/definitions/quantity\"}]}", out);
}

static void print_integer(const case_key *key, FILE *out) {
  fputs("{\"type\": \"integer\"", out);
  print_bounds(key, out);
  fputc('}', out);
}

/* A list of numbers. most = 0: as many as one likes. */
static void print_numbers(const case_key *key, int least, int most, FILE *out) {
  fputs("{\"type\": \"array\", \"items\": ", out);
  print_number(key, out);
  fprintf(out, ", \"minItems\": %d", least);
  if (most > 0) fprintf(out, ", \"maxItems\": %d", most);
  fputc('}', out);
}

static void print_number_or_numbers(const case_key *key, int least, int most, FILE *out) {
  print_number(key, out);
  fputs(", ", out);
  print_numbers(key, least, most, out);
}

static void print_integers(const case_key *key, FILE *out) {
  fputs("{\"type\": \"array\", \"minItems\": 1, \"items\": ", out);
  print_integer(key, out);
  fputc('}', out);
}

/* A mapping whose keys are names of the user's choice. */
static void print_mapping(const char *keys, FILE *out) {
  fprintf(out, "{\"type\": \"object\", \"propertyNames\": {\"pattern\": \"%s\"}}", keys);
}

static void print_words_or(const case_key *key, FILE *out) {
  fputs("{\"enum\": [", out);
  print_words(key->words, out);
  /* YAML 1.1 reads yes and no as true and false */
  if (strcmp(key->words, "no yes") == 0) fputs(", true, false", out);
  fputs("]}", out);
}

/* Forms of the types that hold several numbers, or mappings. */
static void print_composite(const case_key *key, FILE *out) {
  switch (key->type) {
    case CASE_VECTOR:
      print_numbers(key, 3, 3, out);
      break;
    case CASE_INTERVAL:
      print_numbers(key, 2, 2, out);
      break;
    case CASE_PLACES:
      print_numbers(key, 1, 0, out);
      break;
    case CASE_ORDERS:
      print_integers(key, out);
      break;
    case CASE_FACTORS:
      print_mapping("^[0-9]+$", out);
      break;
    case CASE_PROBES:
    case CASE_GAUGES:
    case CASE_GROUPS:
      print_mapping("", out);
      break;
    default:
      fputs("{\"type\": \"array\"}", out);
      break;
  }
}

/* What may stand in place of the first form, after a comma; nothing for most types. */
static void print_alternative(const case_key *key, FILE *out) {
  switch (key->type) {
    case CASE_COUNT:
      fputs(", {\"const\": \"all\"}", out);
      if (key->words) fprintf(out, ", {\"const\": \"%s\"}", key->words);
      break;
    case CASE_AUTO:
      fputs(", {\"const\": \"auto\"}", out);
      break;
    case CASE_ACCURACY:
      fputs(", ", out);
      print_number(key, out);
      break;
    case CASE_PRELOADS:
      fputs(", ", out);
      print_mapping("^(from|to|points)$", out);
      break;
    case CASE_POINTS:
    case CASE_SAVED:
      fputs(", ", out);
      print_numbers(key, 1, 0, out);
      break;
    case CASE_DIAMETERS:
      fputs(", ", out);
      print_integers(key, out);
      break;
    case CASE_MISTUNING:
      fputs(", ", out);
      print_mapping("^(file|unit|mean|deviation|seed|samples)$", out);
      break;
    case CASE_DAMPING:
      fputs(", ", out);
      print_mapping("^(loss_factor|rayleigh)$", out);
      break;
    default:
      break;
  }
}

/* The forms that a value may take, separated by commas. */
static void print_forms(const case_key *key, FILE *out) {
  switch (key->type) {
    case CASE_NUMBER:
      print_number(key, out);
      break;
    case CASE_INTEGER:
    case CASE_COUNT:
    case CASE_AUTO:
    case CASE_POINTS:
      print_integer(key, out);
      break;
    case CASE_CHOICE:
    case CASE_SWITCH:
    case CASE_ACCURACY:
    case CASE_SAVED:
    case CASE_DIAMETERS:
      print_words_or(key, out);
      break;
    case CASE_WORD:
    case CASE_LABEL:
    case CASE_FILE_NAME:
      fputs("{\"type\": [\"string\", \"number\"]}", out);
      break;
    case CASE_TRIPLE:
    case CASE_STIFFNESS:
      print_number_or_numbers(key, 3, 3, out);
      break;
    case CASE_SWEEP:
      print_number_or_numbers(key, 2, 2, out);
      break;
    case CASE_MISTUNING:
      print_numbers(key, 1, 0, out);
      break;
    case CASE_PRELOADS:
    case CASE_DAMPING:
      print_number_or_numbers(key, 1, 0, out);
      break;
    default:
      print_composite(key, out);
      break;
  }
  print_alternative(key, out);
}

/* ---------------------------------------------------------------- blocks */

static void print_block(case_keys keys, const char *block, int depth, FILE *out);

static void print_key(const case_key *key, case_keys keys, int depth, FILE *out) {
  fputs("{\"description\": ", out);
  case_print_json_string(key->help, out);
  if (key->type == CASE_LIST) {
    char items[2 * CASE_LONGEST_WORD];
    snprintf(items, sizeof items, "%s[]", key->path);
    fprintf(out,
            ", \"type\": \"array\", \"minItems\": %g, \"maxItems\": %g, \"items\": ", key->least,
            key->most);
    print_block(keys, items, depth, out);
  } else {
    fputs(", \"anyOf\": [", out);
    print_forms(key, out);
    fputc(']', out);
  }
  fputc('}', out);
}

/* The keys that every mapping of this block must have. */
static void print_required(case_keys keys, const char *block, FILE *out) {
  bool first = true;
  for (int i = 0; i < keys.n; i++) {
    const char *rest = case_key_below(keys.key[i].path, block);
    if (!rest || strpbrk(rest, ".[") || !keys.key[i].required || keys.key[i].when != CASE_ALWAYS)
      continue;
    fprintf(out, "%s\"%s\"", first ? ", \"required\": [" : ", ", rest);
    first = false;
  }
  if (!first) fputc(']', out);
}

static void print_block(case_keys keys, const char *block, int depth, FILE *out) {
  char part[CASE_LONGEST_WORD], last[CASE_LONGEST_WORD] = "", path[4 * CASE_LONGEST_WORD];
  fputs("{\"type\": \"object\", \"additionalProperties\": false", out);
  if (block[0]) print_required(keys, block, out);
  fputs(", \"properties\": {", out);
  for (int i = 0; i < keys.n; i++) {
    if (!case_key_part(keys.key[i].path, block, part) || strcmp(part, last) == 0) continue;
    fprintf(out, "%s\n%*s\"%s\": ", last[0] ? "," : "", 2 * depth, "", part);
    strcpy(last, part);
    snprintf(path, sizeof path, "%s%s%s", block, block[0] ? "." : "", part);
    const case_key *key = case_key_find(keys, path);
    if (key) print_key(key, keys, depth + 1, out);
    if (!key) print_block(keys, path, depth + 1, out);
  }
  fputs("}}", out);
}

void case_print_quantity_definition(FILE *out) {
  fputs(
      "\"quantity\": {\"type\": \"string\", \"description\": \"a number with its unit\",\n"
      "  \"pattern\": \"^[-+]?([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][-+]?[0-9]+)? *[^ 0-9].*$\"}",
      out);
}

static void print_schema(const char *title, case_keys keys, FILE *out) {
  fprintf(out,
          "{\"$schema\": \"http://json-schema.org/draft-07/schema#\",\n"
          "\"title\": \"shroudhb %s file\",\n\"definitions\": {",
          title);
  case_print_quantity_definition(out);
  fputs("},\n\"allOf\": [", out);
  print_block(keys, "", 1, out);
  fputs("]}\n", out);
}

void case_print_schema(FILE *out) {
  print_schema("case", case_key_table(), out);
}

void case_print_motion_schema(FILE *out) {
  case_key row[CASE_MAX_KEYS];
  print_schema("motion", case_motion_keys(row), out);
}
