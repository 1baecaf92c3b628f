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

/* ---------------------------------------------------------------- values */

/* A list of numbers or whole numbers. most = 0: as many as one likes. */
static void print_array(const case_key *key, char item, int least, int most, FILE *out);

/* The words of a key as the items of a JSON list. */
static void print_words(const char *words, FILE *out) {
  for (const char *c = words; *c;) {
    size_t n = strcspn(c, " ");
    fprintf(out, "%s\"%.*s\"", c == words ? "" : ", ", (int)n, c);
    c += n + (c[n] == ' ');
  }
  /* YAML 1.1 reads yes and no as true and false */
  if (strcmp(words, "no yes") == 0) fputs(", true, false", out);
}

/* The bounds of a bare number, in SI. */
static void print_bounds(const case_key *key, FILE *out) {
  if (key->least == 0 && key->most == 0) return;
  fprintf(out, ", \"%s\": %.15g, \"%s\": %.15g", key->above ? "exclusiveMinimum" : "minimum",
          key->least, key->below ? "exclusiveMaximum" : "maximum", key->most);
}

/* One of the forms of a type, as case_types names them:
 *
 *   N, I       a bare number or one with its unit; a whole number
 *   2, 3, *    a list of so many numbers, of any number of them; J of whole numbers
 *   W, w       one of the words of the key; the same where the key has any
 *   =WORD      this word
 *   S, A       a text; any list
 *   {PATTERN}  a mapping whose keys are of this pattern */
static void print_form(const case_key *key, const char *form, int length, FILE *out) {
  switch (form[0]) {
    case 'N':
      fputs("{\"anyOf\": [{\"type\": \"number\"", out);
      print_bounds(key, out);
      fputs("}, {\"$ref\": \"#/definitions/quantity\"}]}", out);
      break;
    case 'I':
      fputs("{\"type\": \"integer\"", out);
      print_bounds(key, out);
      fputc('}', out);
      break;
    case '2':
    case '3':
      print_array(key, 'N', form[0] - '0', form[0] - '0', out);
      break;
    case '*':
    case 'J':
      print_array(key, form[0] == 'J' ? 'I' : 'N', 1, 0, out);
      break;
    case 'W':
      fputs("{\"enum\": [", out);
      print_words(key->words, out);
      fputs("]}", out);
      break;
    case 'w':
      fprintf(out, "{\"const\": \"%s\"}", key->words);
      break;
    case '=':
      fprintf(out, "{\"const\": \"%.*s\"}", length - 1, form + 1);
      break;
    case '{':
      fprintf(out, "{\"type\": \"object\", \"propertyNames\": {\"pattern\": \"%.*s\"}}", length - 2,
              form + 1);
      break;
    default:
      fprintf(out, "{\"type\": %s}", form[0] == 'S' ? "[\"string\", \"number\"]" : "\"array\"");
  }
}

static void print_array(const case_key *key, char item, int least, int most, FILE *out) {
  fputs("{\"type\": \"array\", \"items\": ", out);
  print_form(key, &item, 1, out);
  fprintf(out, ", \"minItems\": %d", least);
  if (most > 0) fprintf(out, ", \"maxItems\": %d", most);
  fputc('}', out);
}

/* The forms that a value may take, separated by commas. */
static void print_forms(const case_key *key, FILE *out) {
  const char *forms = case_types[key->type].forms;
  for (const char *form = forms; *form;) {
    const int n = (int)strcspn(form, " ");
    if (form[0] != 'w' || key->words) {
      if (form > forms) fputs(", ", out);
      print_form(key, form, n, out);
    }
    form += n + (form[n] == ' ');
  }
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
    if (!rest || strpbrk(rest, ".[") || !keys.key[i].required || keys.key[i].when != CASE_ALWAYS ||
        keys.key[i].only != CASE_ALWAYS)
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
