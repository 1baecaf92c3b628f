#include "postproc/draw/number_format.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static post_unit choose(const post_unit *unit, int n, double largest, int usual) {
  largest = fabs(largest);
  if (!isfinite(largest) || largest == 0) return unit[usual];
  for (int i = 0; i < n; i++)
    if (largest >= 0.9995 * unit[i].scale) return unit[i];
  return unit[n - 1];
}

post_unit post_unit_length(double largest) {
  static const post_unit unit[] = {
      {"m", 1}, {"mm", 1e-3}, {"µm", 1e-6}, {"nm", 1e-9}, {"pm", 1e-12}};
  return choose(unit, 5, largest, 2);
}

post_unit post_unit_force(double largest) {
  static const post_unit unit[] = {{"MN", 1e6}, {"kN", 1e3}, {"N", 1}};
  return choose(unit, 3, fabs(largest) >= 1e4 ? largest : 1, 2);
}

post_unit post_unit_stiffness(double largest) {
  static const post_unit unit[] = {{"GN/m", 1e9}, {"MN/m", 1e6}, {"kN/m", 1e3}, {"N/m", 1}};
  return choose(unit, 4, largest, 1);
}

post_unit post_unit_energy(double largest) {
  static const post_unit unit[] = {{"kJ", 1e3}, {"J", 1}, {"mJ", 1e-3}, {"µJ", 1e-6}, {"nJ", 1e-9}};
  return choose(unit, 5, largest, 2);
}

/* "1.2e-05" -> "1.2×10⁻⁵", "-3" -> "−3", "12." -> "12" */
static void typeset(const char *plain, char out[POST_NUMBER]) {
  static const char *const super[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  size_t                   used = 0;
  const char              *c    = plain;
  if (*c == '-') {
    used += (size_t)snprintf(out, POST_NUMBER, "−");
    c++;
  }
  for (; *c && *c != 'e'; c++)
    if (*c != '.' || (c[1] >= '0' && c[1] <= '9')) out[used++] = *c;
  out[used] = '\0';
  if (*c != 'e') return;
  int power = atoi(c + 1);
  used += (size_t)snprintf(out + used, POST_NUMBER - used, "×10%s", power < 0 ? "⁻" : "");
  char digits[16];
  snprintf(digits, sizeof digits, "%d", abs(power));
  for (const char *d = digits; *d; d++)
    used += (size_t)snprintf(out + used, POST_NUMBER - used, "%s", super[*d - '0']);
}

/* Format value with the given digits: plain from 1e-4 up to a million (or to all digits, if more),
 * else with a power of ten. */
static char *format(char out[POST_NUMBER], double value, int digits, bool zeros) {
  if (!isfinite(value)) return strcpy(out, "–");
  if (value == 0) return strcpy(out, "0");
  char plain[48];
  if (digits > 15) digits = 15;
  snprintf(plain, sizeof plain, "%.*e", digits - 1, value);
  int  power = atoi(strchr(plain, 'e') + 1), decimals = digits - 1 - power;
  bool as_power = power < -4 || power >= (digits > 6 ? digits : 6);
  if (!as_power)
    snprintf(plain, sizeof plain, "%.*f", decimals > 0 ? decimals : 0, strtod(plain, NULL));
  else if (!zeros)
    snprintf(plain, sizeof plain, "%.*g", digits, value);
  if (!zeros && !as_power && strchr(plain, '.')) {
    char *end = plain + strlen(plain);
    while (end[-1] == '0') *--end = '\0';
  }
  typeset(plain, out);
  return out;
}

char *post_number(char out[POST_NUMBER], double value, int digits) {
  return format(out, value, digits, true);
}

char *post_plain(char out[POST_NUMBER], double value, int digits) {
  return format(out, value, digits, false);
}

char *post_measure(char out[POST_NUMBER], double value, post_unit unit, int digits) {
  post_number(out, value / unit.scale, digits);
  if (!isfinite(value)) return out;
  size_t used = strlen(out);
  snprintf(out + used, POST_NUMBER - used, "\u00a0%s", unit.name);
  return out;
}

char *post_percent(char out[POST_NUMBER], double ratio) {
  if (!isfinite(ratio)) return strcpy(out, "–");
  post_plain(out, 100 * ratio, 2);
  if (fabs(ratio) >= 0.995) snprintf(out, POST_NUMBER, "%.0f", 100 * ratio);
  size_t used = strlen(out);
  snprintf(out + used, POST_NUMBER - used, "\u00a0%%");
  return out;
}

char *post_power(char out[POST_NUMBER], double value) {
  static const char *const digit[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  int                      power = value > 1e-99 && value < 1 ? (int)lround(-log10(value)) : 0;
  if (power < 2 || fabs(value * pow(10, power) - 1) > 1e-6) return post_plain(out, value, 3);
  snprintf(out, POST_NUMBER, "10⁻%s%s", power >= 10 ? digit[power / 10] : "", digit[power % 10]);
  return out;
}
