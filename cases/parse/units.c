#include "cases/parse/units.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

enum { LENGTH, MASS, TIME, ANGLE, N_DIMENSIONS, LONGEST = 80 };

/* Products of two smaller numbers, such as friction times preload, may vanish. */
static const double SMALLEST = 1e-100;

/* A named unit: factor 10^power in SI. */
typedef struct {
  const char *name, *prefixes;
  double      factor;
  int         power;
  int         dimension[N_DIMENSIONS]; /* exponents of m, kg, s, rad */
} named_unit;

static const named_unit units[] = {
    {"m", "numck", 1, 0, {1, 0, 0, 0}},
    {"g", "mk", 1, -3, {0, 1, 0, 0}},
    {"t", "", 1, 3, {0, 1, 0, 0}},
    {"s", "num", 1, 0, {0, 0, 1, 0}},
    {"N", "umkMG", 1, 0, {1, 1, -2, 0}},
    {"Pa", "mkMG", 1, 0, {-1, 1, -2, 0}},
    {"J", "umk", 1, 0, {2, 1, -2, 0}},
    {"bar", "m", 1, 5, {-1, 1, -2, 0}},
    {"Hz", "mkMG", 1, 0, {0, 0, -1, 0}},
    {"rad", "um", 1, 0, {0, 0, 0, 1}},
    {"deg", "", SHB_PI / 180, 0, {0, 0, 0, 1}},
    {"\u00B0", "", SHB_PI / 180, 0, {0, 0, 0, 1}},
    {"rev", "", SHB_TWO_PI, 0, {0, 0, 0, 1}},
    {"rpm", "", SHB_PI / 30, 0, {0, 0, -1, 1}},
    {"%", "", 1, -2, {0, 0, 0, 0}},
};

static const struct {
  const char *text;
  char        letter; /* in named_unit.prefixes */
  int         power;
} prefixes[] = {{"", 0, 0},          {"n", 'n', -9}, {"u", 'u', -6}, {"\u00B5", 'u', -6},
                {"\u03BC", 'u', -6}, {"m", 'm', -3}, {"c", 'c', -2}, {"k", 'k', 3},
                {"M", 'M', 6},       {"G", 'G', 9}};

typedef struct {
  double factor;
  int    power;
  int    dimension[N_DIMENSIONS];
} scale;

#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

/* Finds the unit and prefix that make up exactly n bytes of text. */
static bool find_unit(const char *text, size_t n, const named_unit **unit, int *power) {
  for (int u = 0; u < COUNT(units); u++) {
    size_t tail = strlen(units[u].name);
    if (tail > n || memcmp(text + n - tail, units[u].name, tail) != 0) continue;
    for (int p = 0; p < COUNT(prefixes); p++) {
      size_t head = strlen(prefixes[p].text);
      if (head + tail != n || memcmp(text, prefixes[p].text, head) != 0) continue;
      if (p > 0 && !strchr(units[u].prefixes, prefixes[p].letter)) continue;
      *unit  = &units[u];
      *power = prefixes[p].power;
      return true;
    }
  }
  return false;
}

/* Reads one factor of a unit, such as "mm2" or "m^3", and moves *text past it. */
static bool read_factor(const char **text, int sign, scale *out) {
  const char       *at = *text;
  size_t            n  = strcspn(at, "/*.^0123456789 ");
  const named_unit *unit;
  int               prefix, exponent = 1;
  if (n == 0 || !find_unit(at, n, &unit, &prefix)) return false;
  at += n;
  if (*at == '^') at++;
  if (*at >= '1' && *at <= '9') exponent = *at++ - '0';
  if (at[-1] == '^') return false;
  exponent *= sign;
  out->power += exponent * (unit->power + prefix);
  out->factor *= pow(unit->factor, exponent);
  for (int d = 0; d < N_DIMENSIONS; d++) out->dimension[d] += exponent * unit->dimension[d];
  *text = at;
  return true;
}

static bool read_unit(const char *text, scale *out) {
  *out = (scale){.factor = 1};
  if (*text == '\0') return true;
  int sign = 1;
  if (text[0] == '1' && text[1] == '/') { /* 1/s */
    text += 2;
    sign = -1;
  }
  while (read_factor(&text, sign, out)) {
    if (*text == '\0') return true;
    if (*text != '/' && *text != '*' && *text != '.') return false;
    if (*text == '/') sign = -1; /* N/m/s: everything after the first / divides */
    text++;
  }
  return false;
}

static size_t count_digits(const char *text) {
  return strspn(text, "0123456789");
}

/* Length of the decimal number at the start of text; 0 if there is none. mantissa: length without
 * the exponent. */
static size_t measure(const char *text, size_t *mantissa) {
  const char *at    = text + (*text == '+' || *text == '-');
  size_t      whole = count_digits(at), part = 0;
  at += whole;
  if (*at == '.') {
    part = count_digits(at + 1);
    at += 1 + part;
  }
  if (whole + part == 0) return 0;
  *mantissa = (size_t)(at - text);
  if (*at == 'e' || *at == 'E') {
    const char *digits = at + 1 + (at[1] == '+' || at[1] == '-');
    size_t      n      = count_digits(digits);
    if (n > 0) at = digits + n;
  }
  return (size_t)(at - text);
}

static void not_a_number(const char *text, const char *unit, char why[CASE_WHY]) {
  char        fixed[LONGEST + 1];
  const char *comma = strchr(text, ',');
  size_t      mantissa;
  if (comma && strlen(text) < sizeof fixed) {
    snprintf(fixed, sizeof fixed, "%s", text);
    fixed[comma - text] = '.';
    if (measure(fixed, &mantissa) > (size_t)(comma - text)) {
      snprintf(why, CASE_WHY, "'%.80s' is not a number; write %s with a decimal point", text,
               fixed);
      return;
    }
  }
  snprintf(why, CASE_WHY, "'%.80s' is not a number; expected %s%s", text,
           *unit ? "a number in " : "a number", unit);
}

/* mantissa 10^power by one decimal conversion, so that a prefix adds no rounding. */
static bool convert(const char *text, size_t mantissa, size_t length, int power, double *value) {
  char buffer[LONGEST + 24];
  long exponent = length > mantissa ? strtol(text + mantissa + 1, NULL, 10) : 0;
  if (exponent > 100000) exponent = 100000;
  if (exponent < -100000) exponent = -100000;
  snprintf(buffer, sizeof buffer, "%.*se%ld", (int)mantissa, text, exponent + power);
  errno   = 0;
  *value  = strtod(buffer, NULL);
  bool in = isfinite(*value) && (*value != 0 || errno != ERANGE);
  return in;
}

bool case_quantity(const char *text, const char *unit, double *value, char why[CASE_WHY]) {
  size_t mantissa = 0, length = strlen(text) <= LONGEST ? measure(text, &mantissa) : 0;
  scale  expected, given;
  if (length == 0) {
    not_a_number(text, unit, why);
    return false;
  }
  const char *name = text + length + strspn(text + length, " ");
  if (!read_unit(name, &given)) {
    bool number = strchr("xX,_0123456789.+-", *name) != NULL; /* 0x10, 0,3, 1.2.3, 3-4 */
    if (number) {
      not_a_number(text, unit, why);
    } else {
      snprintf(why, CASE_WHY, "'%.80s': unknown unit '%.40s'; expected %s", text, name,
               *unit ? unit : "a number without a unit");
    }
    return false;
  }
  if (*name) read_unit(unit, &expected);
  if (*name && memcmp(given.dimension, expected.dimension, sizeof given.dimension) != 0) {
    snprintf(why, CASE_WHY, "'%.80s' has unit %.40s, expected %s", text, name,
             *unit ? unit : "a number without a unit");
    return false;
  }
  if (!convert(text, mantissa, length, given.power, value)) {
    snprintf(why, CASE_WHY, "'%.80s' is out of the range of a number", text);
    return false;
  }
  if (given.factor != 1) *value *= given.factor;
  if (*value != 0 && fabs(*value) < SMALLEST) {
    snprintf(why, CASE_WHY, "'%.80s' is too small to compute with; give 0, or at least %g", text,
             SMALLEST);
    return false;
  }
  if (isfinite(*value)) return true;
  snprintf(why, CASE_WHY, "'%.80s' is out of the range of a number", text);
  return false;
}

bool case_integer(const char *text, int *value, char why[CASE_WHY]) {
  const char *digits = text + (*text == '+' || *text == '-');
  size_t      n      = count_digits(digits);
  if (n == 0 || digits[n] != '\0') {
    snprintf(why, CASE_WHY,
             strcmp(text, "auto") == 0 ? "auto is not available; give a number"
                                       : "'%.80s' is not a whole number",
             text);
    return false;
  }
  errno     = 0;
  long wide = strtol(text, NULL, 10);
  if (errno == ERANGE || wide > INT_MAX || wide < INT_MIN) {
    snprintf(why, CASE_WHY, "'%.80s' is too large", text);
    return false;
  }
  *value = (int)wide;
  return true;
}
