#include "cases/parse/key_listing.h"

#include <string.h>

#include "cases/parse/key_table.h"

static void print_key(const case_key *key, FILE *out) {
  char range[128];
  case_key_range(key, range, sizeof range);
  if (key->words) snprintf(range, sizeof range, "%s", key->words);
  for (char *c = range; key->words && *c; c++)
    if (*c == ' ') *c = '|';
  const char *fallback = key->fallback ? key->fallback : key->required ? "required" : "-";
  fprintf(out, "%-31s %-14s %-6s %-30s %-16s %s\n", key->path, case_types[key->type].name,
          key->unit[0] ? key->unit : "-", range[0] ? range : "-", fallback, key->help);
}

void case_print_key_table(case_keys keys, FILE *out) {
  fprintf(out, "%-31s %-14s %-6s %-30s %-16s %s\n", "key", "value", "unit", "range (in SI)",
          "default", "meaning");
  for (int i = 0; i < keys.n; i++) {
    const char  *path = keys.key[i].path, *last = i > 0 ? keys.key[i - 1].path : "";
    const size_t n = strcspn(path, ".{");
    if (strncmp(path, last, n) != 0 || !strchr(".{", last[n])) fputc('\n', out);
    print_key(&keys.key[i], out);
  }
}

void case_print_keys(FILE *out) {
  case_print_key_table(case_key_table(), out);
  fputs(
      "\nNumbers may carry a unit (6000 rpm, 35 deg, 2 MN/m, 7.85 g/cm3, 0.2 %); bare numbers are "
      "SI.\n",
      out);
}

/* ---------------------------------------------------------------- the reference page */

/* The condition of a key in words. NULL if there is none, or if the key decides it itself. */
static const char *applies_text(const case_key *key) {
  const char *when = case_condition_words(key->only ? key->only : key->when);
  char        own[96], leaf[96];
  snprintf(own, sizeof own, "with `%s`", key->path);
  snprintf(leaf, sizeof leaf, "with `%s`", case_key_leaf(key->path));
  return when && (strcmp(when, own) == 0 || strcmp(when, leaf) == 0) ? NULL : when;
}

/* Prints a cell of a Markdown table, in which | must be escaped. */
static void print_cell(const char *text, FILE *out) {
  for (; *text; text++) {
    if (*text == '|') fputc('\\', out);
    fputc(*text, out);
  }
}

static void print_row(const case_key *key, const char *block, FILE *out) {
  char        range[128];
  const char *path = case_key_below(key->path, block), *applies = applies_text(key);
  case_key_range(key, range, sizeof range);
  fprintf(out, "| `%s` | ", path ? path : key->path);
  print_cell(case_types[key->type].name, out);
  fprintf(out, " | %s | ", key->unit);
  for (const char *c = key->words; c && *c; c++) fputs(*c == ' ' ? ", " : (char[2]){*c, 0}, out);
  if (key->words && range[0]) fputs(", ", out);
  fprintf(out, "%s | ", range);
  if (key->fallback) fprintf(out, "`%s`", key->fallback);
  if (!key->fallback && key->required) fputs("required", out);
  fprintf(out, " | %s | ", applies ? applies : "");
  print_cell(key->help, out);
  fputs(" |\n", out);
}

static void print_block(const char *block, FILE *out) {
  fprintf(out, "\n## %s\n\n", block);
  fputs("| key | value | unit | range, words | default | when | meaning |\n", out);
  fputs("|---|---|---|---|---|---|---|\n", out);
}

void case_print_reference(FILE *out) {
  static const char head[] =
      "# Case reference\n"
      "\n"
      "`shroudhb keys --markdown` prints this page, and a test compares the two.\n"
      "\n"
      "Every key of a case file is listed, block by block, with the block's name left out.\n"
      "`[]` stands for an entry of a list: `blade.sections[].radius` in the table of `mesh` is "
      "the\n"
      "radius of each section in the list `mesh.blade.sections`.\n"
      "\n"
      "- **unit, range**: SI units; angles are in rad, so 1.5708 is 90 deg.\n"
      "- **default**: *required* means that the file must give the key where it applies.\n"
      "- **when**: the key is read only then; an empty cell means always.\n"
      "\n"
      "A number may carry a unit: `6000 rpm`, `35 deg`, `2 MN/m`, `7.85 g/cm3`, `0.2 %`.\n"
      "A bare number is in the SI unit of its key, which is rad/s for the speed and rad for "
      "angles.\n"
      "The units are m, g, t, s, N, Pa, J, bar, Hz, rad, deg, °, rev, rpm and %.\n"
      "Prefixes are n, u (or µ), m, c, k, M and G where they are customary.\n"
      "`shroudhb check CASE.yaml` finds all errors of a file at once and runs nothing.\n";
  case_keys keys = case_key_table();
  char      block[CASE_LONGEST_WORD], last[CASE_LONGEST_WORD] = "";
  fputs(head, out);
  for (int i = 0; i < keys.n; i++) {
    case_key_part(keys.key[i].path, "", block);
    if (strcmp(block, last) != 0) print_block(block, out);
    print_row(&keys.key[i], block, out);
    strcpy(last, block);
  }
}
