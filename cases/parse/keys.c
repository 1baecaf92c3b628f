#include "cases/parse/keys.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

const case_key *case_key_find(case_keys keys, const char *path) {
  for (int i = 0; i < keys.n; i++)
    if (strcmp(keys.key[i].path, path) == 0) return &keys.key[i];
  return NULL;
}

const char *case_key_below(const char *path, const char *block) {
  size_t n = strlen(block);
  if (n == 0) return path;
  return strncmp(path, block, n) == 0 && path[n] == '.' ? path + n + 1 : NULL;
}

const char *case_key_in_list(const char *path, const char *list) {
  const size_t n = strlen(list);
  return strncmp(path, list, n) == 0 && strncmp(path + n, "[].", 3) == 0 ? path + n + 3 : NULL;
}

bool case_key_applies(const case_key *key, const case_file *file, const void *base) {
  const void *element = (const char *)base + key->element;
  return case_condition_holds(key->when, file, element) &&
         case_condition_holds(key->only, file, element);
}

bool case_key_is_block(case_keys keys, const char *path) {
  for (int i = 0; i < keys.n; i++)
    if (case_key_below(keys.key[i].path, path)) return true;
  return false;
}

const char *case_key_leaf(const char *path) {
  const char *dot = strrchr(path, '.');
  return dot ? dot + 1 : path;
}

void case_append(char *buffer, size_t size, const char *format, ...) {
  size_t  used = strlen(buffer);
  va_list args;
  va_start(args, format);
  if (used < size) vsnprintf(buffer + used, size - used, format, args);
  va_end(args);
}

static int lower(char c) {
  return c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c;
}

bool case_key_part(const char *path, const char *block, char part[CASE_LONGEST_WORD]) {
  const char *rest = case_key_below(path, block);
  if (!rest) return false;
  size_t n = strcspn(rest, ".[{");
  if (n >= CASE_LONGEST_WORD) n = CASE_LONGEST_WORD - 1;
  memcpy(part, rest, n);
  part[n] = '\0';
  return true;
}

static void list_block(case_keys keys, const char *block, char *text, size_t size) {
  char part[CASE_LONGEST_WORD], last[CASE_LONGEST_WORD] = "";
  case_append(text, size, "; known here: ");
  for (int i = 0; i < keys.n; i++) {
    if (!case_key_part(keys.key[i].path, block, part) || strcmp(part, last) == 0) continue;
    case_append(text, size, "%s%s", last[0] ? ", " : "", part);
    strcpy(last, part);
  }
}

bool case_key_nearest(case_keys keys, const char *block, const char *word, char *best) {
  char part[CASE_LONGEST_WORD];
  int  length = (int)strlen(word), least = length < 6 ? 2 : 1 + length / 3;
  best[0] = '\0';
  for (int i = 0; i < keys.n; i++) {
    if (!case_key_part(keys.key[i].path, block, part)) continue;
    if (abs(length - (int)strlen(part)) > least) continue; /* as many edits at least */
    int  distance = case_edit_distance(word, part);
    bool nearer = distance < least, alike = lower(part[0]) == lower(word[0]),
         tie = distance == least;
    if (tie && best[0]) nearer = alike && lower(best[0]) != lower(word[0]);
    if (!nearer || distance >= (int)strlen(part)) continue;
    least = distance;
    strcpy(best, part);
  }
  return best[0] != '\0';
}

void case_key_suggest(case_keys keys, const char *block, const char *word, char *text,
                      size_t size) {
  char best[CASE_LONGEST_WORD];
  bool near  = case_key_nearest(keys, block, word, best),
       close = near && case_edit_distance(word, best) < 2;
  text[0]    = '\0';
  for (int i = 0; i < keys.n && !close; i++) {
    const char *path = keys.key[i].path;
    if (strcasecmp(case_key_leaf(path), word) != 0) continue;
    case_append(text, size, "; did you mean '%s'?", path);
    return;
  }
  if (near) {
    case_append(text, size, "; did you mean '%s'?", best);
  } else {
    list_block(keys, block, text, size);
  }
}

void case_key_range(const case_key *key, char *text, size_t size) {
  text[0] = '\0';
  if (key->least == 0 && key->most == 0) return;
  if (!key->above && !key->below) {
    case_append(text, size, "%g to %g", key->least, key->most);
    return;
  }
  case_append(text, size, key->above ? "above %g" : "%g", key->least);
  case_append(text, size, key->below ? " and below %g" : " to %g", key->most);
}
