/* A list of numbers that determine how a curve goes on, as the file of a run under way has it. */
#ifndef MHB_RESPONSE_TRACE_STATE_H
#define MHB_RESPONSE_TRACE_STATE_H

#include <stdbool.h>
#include <stddef.h>

/* Changes with the meaning of the numbers. States of another version are not used. */
enum { MHB_TRACE_STATE_VERSION = 5 };

/* A list of numbers that is written or read from its front to its back. One function that passes
 * all numbers of an object, each by its address, then does both. */
typedef struct {
  double *number; /* [n] */
  size_t  n, room, at;
  bool    reads;  /* the numbers go to the addresses, else they come from there */
  bool    failed; /* other numbers than the reader wants */
} mhb_trace_state;

void mhb_trace_state_free(mhb_trace_state *state); /* it is empty then: zeroed */

/* Pass numbers. A number that is not finite is written as 0: it belongs to a start that failed. */
void mhb_trace_state_numbers(mhb_trace_state *state, double *number, size_t n);
void mhb_trace_state_whole(mhb_trace_state *state, int *number);
void mhb_trace_state_flag(mhb_trace_state *state, bool *flag);

/* Pass a whole number that must lie in least..most. */
void mhb_trace_state_code(mhb_trace_state *state, int *number, int least, int most);

#endif
