#include "cases/designs/study_schema.h"

#include <string.h>

#include "cases/designs/study_keys.h"
#include "cases/designs/study_optimise.h"
#include "cases/parse/key_table.h"
#include "cases/schema/key_schema.h"

static const char QUANTITY[] =
    "{\"anyOf\": [{\"type\": \"number\"}, {\"$ref\": \"#/definitions/quantity\"}]}";

/* The paths of a key with indices of lists, one at the end for a number of a vector. */
static void print_pattern(const char *path, FILE *out) {
  fputs("\"^", out);
  for (const char *c = path; *c; c++) {
    if (*c == '.')
      fputs("\\\\.", out);
    else if (*c == '[')
      fputs("\\\\[[0-9]+\\\\]", out);
    else if (*c != ']')
      fputc(*c, out);
  }
  fputs("(\\\\[[0-9]+\\\\])?$\"", out);
}

/* The numbers of a case, as patterns of paths or as paths without an index, which editors complete;
 * each with the same form of value. */
static void print_paths(bool patterns, const char *form, FILE *out) {
  const case_keys keys  = case_key_table();
  bool            first = true;
  for (int i = 0; i < keys.n; i++) {
    const case_key *key = &keys.key[i];
    if (!case_types[key->type].number || (!patterns && strchr(key->path, '['))) continue;
    fputs(first ? "\n    " : ",\n    ", out);
    first = false;
    if (patterns)
      print_pattern(key->path, out);
    else
      fprintf(out, "\"%s\"", key->path);
    fputs(": {\"description\": ", out);
    case_print_json_string(key->help, out);
    fprintf(out, ", \"$ref\": \"#/definitions/%s\"}", form);
  }
}

/* A mapping from numbers of a case to values of one form. */
static void print_keys(const char *name, const char *form, FILE *out) {
  fprintf(
      out,
      "  \"%s\": {\"type\": \"object\", \"minProperties\": 1, \"additionalProperties\": false,\n"
      "   \"properties\": {",
      name);
  print_paths(false, form, out);
  fputs("},\n   \"patternProperties\": {", out);
  print_paths(true, form, out);
  fputs("}},\n", out);
}

static void print_distributions(FILE *out) {
  fputs(
      "  \"distribution\": {\"type\": \"object\", \"additionalProperties\": false, "
      "\"properties\": {\n    \"relative\": {\"type\": \"boolean\"}",
      out);
  for (int i = 0; i < PLAN_N_DISTRIBUTIONS; i++) {
    int n = plan_distribution_parameters((plan_kind)i);
    fprintf(
        out,
        ",\n    \"%s\": {\"type\": \"array\", \"minItems\": %d, \"maxItems\": %d, \"items\": %s}",
        plan_distribution_name((plan_kind)i), n, n, QUANTITY);
  }
  fputs("}},\n", out);
}

static void print_definitions(FILE *out) {
  fputs("\"definitions\": {\n  ", out);
  case_print_quantity_definition(out);
  fprintf(out,
          ",\n  \"count\": {\"type\": \"integer\", \"minimum\": 1, \"maximum\": %d},\n"
          "  \"seed\": {\"type\": \"integer\", \"minimum\": 0},\n"
          "  \"values\": {\"anyOf\": [%s, {\"type\": \"array\", \"minItems\": 1, \"items\": %s},\n"
          "   {\"type\": \"object\", \"additionalProperties\": false, \"required\": [\"from\", "
          "\"to\"],\n    \"properties\": {\"from\": %s, \"to\": %s,\n     \"points\": {\"$ref\": "
          "\"#/definitions/count\"}, \"scale\": {\"enum\": [\"linear\", \"log\"]}}}]},\n",
          STUDY_MOST_DESIGNS, QUANTITY, QUANTITY, QUANTITY, QUANTITY);
  print_distributions(out);
  fprintf(out, "  \"limits\": {\"type\": \"object\", \"additionalProperties\": %s}},\n", QUANTITY);
}

static void print_optimise(FILE *out) {
  fprintf(
      out,
      "  \"optimise\": {\"type\": \"object\", \"additionalProperties\": false,\n"
      "   \"required\": [\"minimise\"], \"properties\": {\"minimise\": {\"type\": \"string\"},\n"
      "    \"at_most\": {\"$ref\": \"#/definitions/limits\"}, \"at_least\": {\"$ref\": "
      "\"#/definitions/limits\"},\n    \"evaluations\": {\"type\": \"integer\", \"minimum\": 5},\n"
      "    \"starts\": {\"type\": \"integer\", \"minimum\": 1, \"maximum\": %d},\n"
      "    \"seed\": {\"$ref\": \"#/definitions/seed\"},\n    \"algorithm\": {\"enum\": [",
      STUDY_MOST_STARTS);
  for (int i = 0; i < STUDY_N_ALGORITHMS; i++)
    fprintf(out, "%s\"%s\"", i ? ", " : "", study_algorithm_name((study_algorithm)i));
  fputs("]}}},\n", out);
}

/* A plan that draws samples, {sobol: 256, seed: 1}. */
static void print_sampled(const char *name, FILE *out) {
  fprintf(out,
          ",\n   {\"type\": \"object\", \"additionalProperties\": false, \"required\": [\"%s\"],\n"
          "    \"properties\": {\"%s\": {\"$ref\": \"#/definitions/count\"}, \"seed\": {\"$ref\": "
          "\"#/definitions/seed\"}}}",
          name, name);
}

static void print_plan(FILE *out) {
  fputs(
      "  \"plan\": {\"anyOf\": [{\"const\": \"grid\"},\n"
      "   {\"type\": \"object\", \"additionalProperties\": false, \"required\": [\"table\"],\n"
      "    \"properties\": {\"table\": {\"type\": \"string\"}}}",
      out);
  print_sampled("sobol", out);
  print_sampled("latin_hypercube", out);
  fputs("]},\n", out);
}

void study_print_schema(FILE *out) {
  fputs(
      "{\"$schema\": \"http://json-schema.org/draft-07/schema#\",\n"
      "\"title\": \"shroudhb study file\",\n",
      out);
  print_definitions(out);
  fputs(
      "\"type\": \"object\", \"additionalProperties\": false, \"required\": [\"case\"],\n"
      "\"properties\": {\n"
      "  \"name\": {\"type\": [\"string\", \"number\"]},\n  \"case\": {\"type\": \"string\"},\n",
      out);
  print_keys("vary", "values", out);
  print_plan(out);
  print_keys("uncertain", "distribution", out);
  print_optimise(out);
  fputs(
      "  \"samples\": {\"$ref\": \"#/definitions/count\"},\n"
      "  \"seed\": {\"$ref\": \"#/definitions/seed\"},\n"
      "  \"outputs\": {\"type\": \"array\", \"minItems\": 1, \"items\": {\"type\": "
      "\"string\"}}}}\n",
      out);
}
