#include "cases/designs/study_table.h"

#include "cases/parse/key_listing.h"
#include "cases/parse/value.h"

enum { MOST_SEED = 1000000000, MOST_EVALUATIONS = 100000 };

/* clang-format off */
static const case_key table[] = {
    {"name", CASE_WORD, "",
     .help = "name of the study and its files; default: the name of this file"},
    {"case", CASE_FILE_NAME, "", .required = true,
     .help = "the case of which keys are varied"},

    {"vary", CASE_KEYS, "",
     .help = "{KEY: values}: keys of the case that are numbers, such as contact.n0 or "
             "mesh.blade.sections[2].twist; a value, a list, or a range:"},
    {"vary{}.from", CASE_NUMBER, "", .required = true,
     .help = "lower end of the range, in the unit of the key"},
    {"vary{}.to", CASE_NUMBER, "", .required = true,
     .help = "upper end"},
    {"vary{}.points", CASE_INTEGER, "", 1, STUDY_MOST_DESIGNS,
     .help = "values of a grid, both ends among them; other plans and optimise need none"},
    {"vary{}.scale", CASE_CHOICE, "", .words = "linear log", .fallback = "linear",
     .help = "steps of equal difference or of equal ratio"},

    {"plan", CASE_CHOICE, "", .words = "grid", .fallback = "grid",
     .help = "every combination of the values, or one of:"},
    {"plan.sobol", CASE_INTEGER, "", 1, STUDY_MOST_DESIGNS,
     .help = "so many points of Sobol's sequence"},
    {"plan.latin_hypercube", CASE_INTEGER, "", 1, STUDY_MOST_DESIGNS,
     .help = "so many points, each key stratified"},
    {"plan.table", CASE_FILE_NAME, "",
     .help = "CSV file: keys in the first line, a design a line"},
    {"plan.seed", CASE_INTEGER, "", 0, MOST_SEED, .fallback = "1",
     .help = "of sobol and latin_hypercube"},

    {"uncertain", CASE_KEYS, "",
     .help = "{KEY: distribution}: keys of the case that scatter, each with one of:"},
    {"uncertain{}.uniform", CASE_INTERVAL, "",
     .help = "[low, high]"},
    {"uncertain{}.log_uniform", CASE_INTERVAL, "",
     .help = "[low, high], uniform in the logarithm"},
    {"uncertain{}.normal", CASE_INTERVAL, "",
     .help = "[mean, deviation]"},
    {"uncertain{}.lognormal", CASE_INTERVAL, "",
     .help = "[mean, deviation] of the value itself"},
    {"uncertain{}.triangular", CASE_NUMBERS, "",
     .help = "[low, mode, high]"},
    {"uncertain{}.truncated_normal", CASE_NUMBERS, "",
     .help = "[mean, deviation, low, high]"},
    {"uncertain{}.relative", CASE_SWITCH, "", .words = "false true", .fallback = "false",
     .help = "the distribution is that of the ratio to the varied value of the key"},
    {"samples", CASE_INTEGER, "", STUDY_LEAST_SAMPLES, STUDY_MOST_DESIGNS,
     .help = "of the uncertain keys, for each design of the varied ones"},
    {"seed", CASE_INTEGER, "", 0, MOST_SEED, .fallback = "1",
     .help = "of the samples"},

    {"outputs", CASE_NAMES, "", .fallback = "[peak, frequency]",
     .help = "what is told of each design (docs/user/study.md)"},

    {"optimise.minimise", CASE_WORD, "", .required = true,
     .help = "the output that is to become small"},
    {"optimise.at_most", CASE_KEYS, "",
     .help = "{OUTPUT: value}: upper limits"},
    {"optimise.at_least", CASE_KEYS, "",
     .help = "{OUTPUT: value}: lower limits"},
    {"optimise.evaluations", CASE_INTEGER, "", STUDY_LEAST_A_START, MOST_EVALUATIONS,
     .fallback = "200",
     .help = "designs of all starts together"},
    {"optimise.starts", CASE_INTEGER, "", 1, STUDY_MOST_STARTS, .fallback = "4",
     .help = "searches from places of their own"},
    {"optimise.seed", CASE_INTEGER, "", 0, MOST_SEED, .fallback = "1",
     .help = "of these places"},
    {"optimise.algorithm", CASE_CHOICE, "", .words = "sbplx crs isres direct slope",
     .help = "default: slope where the derivative of the peak is known, else sbplx"},
};
/* clang-format on */

case_keys study_key_table(void) {
  return (case_keys){sizeof table / sizeof *table, table};
}

bool study_table_read(case_issues *issues, const char *row, const char *path, const case_node *node,
                      void *slot) {
  return case_value_read(issues, case_key_find(study_key_table(), row), path, node, NULL, slot);
}

void study_table_default(const char *row, void *slot) {
  const case_key *key  = case_key_find(study_key_table(), row);
  case_issues     none = case_issues_start("default", "", 0);
  case_plain      plain;
  if (case_plain_value(key->fallback, &plain))
    case_value_read(&none, key, row, &plain.value, NULL, slot);
  case_issues_free(&none);
}

void study_table_refuse(case_issues *issues, const char *block, const char *path,
                        const case_node *node) {
  char hint[512];
  case_key_suggest(study_key_table(), block, node->key, hint, sizeof hint);
  case_issue_add(issues, node->key_line, node->key_column, path, "%s%sunknown key%s",
                 block[0] ? node->key : "", block[0] ? ": " : "", hint);
}

void study_print_keys(FILE *out) {
  case_print_key_table(study_key_table(), out);
  fputs("\nA value of a key is a number in its unit, as in a case.\n", out);
}
