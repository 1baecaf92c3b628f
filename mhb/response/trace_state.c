#include "mhb/response/trace_state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

enum { FIRST_NUMBERS = 256 };

void mhb_trace_state_free(mhb_trace_state *state) {
  free(state->number);
  *state = (mhb_trace_state){0};
}

static void read_numbers(mhb_trace_state *s, double *number, size_t n) {
  if (n > s->n - s->at) s->failed = true;
  if (s->failed) return;
  memcpy(number, s->number + s->at, sizeof *number * n);
  s->at += n;
}

static void write_numbers(mhb_trace_state *s, const double *number, size_t n) {
  if (s->failed) return;
  if (s->n + n > s->room) {
    s->room   = 2 * (s->n + n) + FIRST_NUMBERS;
    s->number = shb_realloc(s->number, s->room, sizeof *s->number);
  }
  for (size_t i = 0; i < n; i++) s->number[s->n++] = isfinite(number[i]) ? number[i] : 0;
}

void mhb_trace_state_numbers(mhb_trace_state *s, double *number, size_t n) {
  if (s->reads)
    read_numbers(s, number, n);
  else
    write_numbers(s, number, n);
}

void mhb_trace_state_code(mhb_trace_state *s, int *number, int least, int most) {
  double value = *number;
  mhb_trace_state_numbers(s, &value, 1);
  if (value != floor(value) || value < least || value > most) s->failed = true;
  if (!s->failed) *number = (int)value;
}

void mhb_trace_state_whole(mhb_trace_state *s, int *number) {
  static const int FAR = 1000000000;
  mhb_trace_state_code(s, number, -FAR, FAR);
}

void mhb_trace_state_flag(mhb_trace_state *s, bool *flag) {
  int value = *flag;
  mhb_trace_state_code(s, &value, 0, 1);
  *flag = value != 0;
}
